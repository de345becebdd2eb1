// SPDX-License-Identifier: GPL-3.0-or-later
// Points are sorted by one number,
//     when = round << 54 | bits of x, y and z, 18 each, interleaved (a Z-curve),
// with x, y and z counted in 2^18 - 1 steps of the largest extent. The round is drawn
// from the point's index by splitmix64, not by a generator with a state, so that the
// order depends on the points and their indices alone. The sort is stable: points with
// the same number keep their order.
#include "geometry/triangulation/insertion_order.h"

#include "basics/memory.h"

#include <stdlib.h>

// The bits of X, two zeros between each.
static uint64_t spread(uint64_t x)
{
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

// Eight rounds: each point has a chance of 7/8 to come in the last, else of 7/8 to come
// in the one before.
static uint64_t draw_round(int i)
{
    uint64_t x = ((uint64_t)i + 1) * 0x9e3779b97f4a7c15;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
    x = (x ^ x >> 27) * 0x94d049bb133111eb;
    x ^= x >> 31;
    return 7 - (uint64_t)__builtin_ctzll(x | 1 << 21) / 3;
}

struct turn {
    uint64_t when;
    int32_t point;
};

// By radix, from the lowest digit up: those of one time stay in order.
static struct turn *sort_turns(struct turn *turns, int n, int bits)
{
    enum { DIGIT = 12, DIGITS = 1 << DIGIT };
    struct turn *sorted = NEW_ARRAY(struct turn, n);
    for (int shift = 0; shift < bits; shift += DIGIT) {
        int begin[DIGITS + 1] = {0};
        for (int i = 0; i < n; i++)
            begin[(turns[i].when >> shift) % DIGITS + 1]++;
        for (int digit = 1; digit < DIGITS; digit++)
            begin[digit] += begin[digit - 1];
        for (int i = 0; i < n; i++)
            sorted[begin[(turns[i].when >> shift) % DIGITS]++] = turns[i];
        struct turn *other = turns;
        turns = sorted;
        sorted = other;
    }
    free(sorted);
    return turns;
}

// Biased randomised insertion order [Amenta, Choi and Rote 2003]: rounds of random
// points, each along a Z-curve, so that cavities stay small and what comes next is
// near.
int32_t *insertion_order(const struct vector *points, int n)
{
    enum { BITS = 18, ROUND_BITS = 3 };
    struct vector lower = points[0], upper = points[0];
    for (int i = 1; i < n; i++)
        for (int axis = 0; axis < 3; axis++) {
            const double x = component(points[i], axis);
            if (x < component(lower, axis)) set_component(&lower, axis, x);
            if (x > component(upper, axis)) set_component(&upper, axis, x);
        }
    const double extent = largest_component(subtract(upper, lower));
    const double cells = extent > 0 ? ((1 << BITS) - 1) / extent : 0;
    struct turn *turns = NEW_ARRAY(struct turn, n);
    for (int i = 0; i < n; i++) {
        turns[i] = (struct turn){draw_round(i) << 3 * BITS, i};
        for (int axis = 0; axis < 3; axis++) {
            const double x = component(points[i], axis) - component(lower, axis);
            turns[i].when |= spread((uint64_t)(x * cells)) << axis;
        }
    }
    turns = sort_turns(turns, n, 3 * BITS + ROUND_BITS);
    int32_t *order = NEW_ARRAY(int32_t, n);
    for (int k = 0; k < n; k++)
        order[k] = turns[k].point;
    free(turns);
    return order;
}
