// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers that look like chance and are the same on every machine.
#pragma once

#include "basics/memory.h"

#include <stdint.h>

// Evenly distributed in [0,1); advances STATE (splitmix64).
static inline double next_random(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

// 0 to N - 1 in some order. The caller frees it.
static inline int *shuffled(int n, uint64_t *state)
{
    int *order = NEW_ARRAY(int, n);
    for (int i = 0; i < n; i++) {
        const int other = (int)((i + 1) * next_random(state));
        order[i] = order[other];
        order[other] = i;
    }
    return order;
}
