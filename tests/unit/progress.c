// SPDX-License-Identifier: GPL-3.0-or-later
// The time left that a progress bar shows: exact where work is even, and without jumps
// where it is not.
#include "../test.h"

#include "basics/progress.h"

static const double SINCE = 0.1; // s, between two draws

// Work that takes 100 s at one speed.
TEST(is_exact_where_work_is_even)
{
    double left = -1;
    for (double time = 1; time < 100; time += SINCE) {
        left = progress_time_left(time, time / 100, left, SINCE);
        assert_within(left, 100 - time, 1e-9);
    }
}

// Five portions of 12 s each, of which one hears only at its end: at the mean speed so
// far the time left would rise from 0 to 48 s within the first, and fall by a half at
// its end.
TEST(does_not_jump_where_it_is_not)
{
    double left = -1;
    for (double time = 1; time < 60; time += SINCE) {
        const double fraction = 0.2 * floor(time / 12) + 0.02;
        const double before = left;
        left = progress_time_left(time, fraction, left, SINCE);
        assert_true(left >= 0);
        if (before >= 0) assert_within(left, before, 0.06 * before + 2 * SINCE);
    }
    assert_true(left < 15);
}
