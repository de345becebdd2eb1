// SPDX-License-Identifier: GPL-3.0-or-later
// Where threads wait for each other, many times in a thousandth of a second. OpenMP's
// barrier burns the core that the one waited for may need: beside other programs two
// threads were slower than one by it. This one soon lets others go first.
#pragma once

#include <sched.h>
#include <stdatomic.h>

// Begin with {.size = threads}; there is nothing to free. It is not copied or moved
// while threads use it.
struct barrier {
    int size; // threads, each of which must come
    // Those that have come in this round; 0 or 1, changed by the last to come.
    atomic_int waiting, round;
};

// Returns when all SIZE threads have come, at once for one; what they wrote before can
// be read then. The last to come turns the round over, which lets the others go; they
// compare with the round that they saw before they came. So a thread that runs ahead
// into the next wait cannot be mistaken for one of this. All atomic operations are
// sequentially consistent, so it is a fence, too: what any thread wrote before its
// wait, all can read after theirs.
static inline void barrier_wait(struct barrier *barrier)
{
    enum { PATIENCE = 2000 }; // looks, some microseconds
    if (barrier->size == 1) return;
    const int round = atomic_load(&barrier->round);
    if (atomic_fetch_add(&barrier->waiting, 1) + 1 == barrier->size) {
        atomic_store(&barrier->waiting, 0);
        atomic_store(&barrier->round, round ^ 1);
        return;
    }
    for (int look = 0; atomic_load(&barrier->round) == round; look++)
        if (look >= PATIENCE) sched_yield();
}
