// SPDX-License-Identifier: GPL-3.0-or-later
// Which part of each wet node's evaporation each reservoir supplies: the timers' rates.
// The liquid throats at a wet node share its evaporation in proportion to their
// cross-sections; a reservoir loses the sum of its shares. Rates are scaled
// (conditions.h).
#pragma once

#include "emptying_times.h"

// The reservoir of TIMER supplies this part of what the node at a place in
// times->air evaporates. Only nodes with a path to the air have shares. PART is
// from 0 to 1; those of a node sum to 1.
struct evaporation_share {
    double part;
    int air_place, timer;
};

static inline bool is_rings(const struct emptying_times *times, int place)
{
    return place >= times->occupancy->network->n_throat;
}

// The reservoir of THROAT: itself or its cluster; -1 if a cluster would hold no liquid.
// Rings are their own.
static inline int reservoir_of(const struct emptying_times *times, int throat)
{
    return times->by_throat || is_rings(times, throat)
               ? throat
               : times->occupancy->clusters.of_throat[throat];
}

// Shares out NODE, or both nodes of THROAT, again: other throats hold liquid there than
// before, or a path to the air has opened. Marks timers whose sums change as dirty, and
// makes a timer for a reservoir that had none. O(throats at the node).
void share_by_node(struct emptying_times *times, int node);
void share_by_ends(struct emptying_times *times, int throat);

// NODE evaporates GAIN more than before; its shares stay.
void share_gain(struct emptying_times *times, int node, double gain);

// The timer of a reservoir; a new one has no throat yet, and no rate.
int timer_of(struct emptying_times *times, int owner);

// Notes that the rate of TIMER must be set again.
void mark_dirty(struct emptying_times *times, int timer);

// Sets the rate of a dirty timer from its sum.
void evaporation_shares_set_rate(struct emptying_times *times, int timer);

// Whether some dirty sum has shrunk so far that all must be summed again. Sums are
// updated by differences, whose rounding stays while the sum shrinks.
bool evaporation_shares_lack_digits(const struct emptying_times *times);

// Sets all rates, as sums of positive numbers: no cancellation.
void evaporation_shares_add_up(struct emptying_times *times);

// Keeps shares and sums, or restores them.
void evaporation_shares_state(struct emptying_times *times,
                              struct checkpoint_stream *stream);
