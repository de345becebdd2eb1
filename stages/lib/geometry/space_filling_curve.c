// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of all places on a cubic grid of 2^BITS cells a side, so that no axis is
// preferred; sorted, equal ones by their index.
#include "geometry/space_filling_curve.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

enum { BITS = 10 };

// Position of a cell on the curve through 2^BITS cells along each axis (Skilling 2004).
static uint32_t hilbert_key(uint32_t x[3])
{
    for (uint32_t q = 1u << (BITS - 1); q > 1; q >>= 1)
        for (int axis = 0; axis < 3; axis++) {
            const uint32_t low = q - 1;
            if (x[axis] & q) {
                x[0] ^= low;
                continue;
            }
            const uint32_t swap = (x[0] ^ x[axis]) & low;
            x[0] ^= swap;
            x[axis] ^= swap;
        }
    x[1] ^= x[0];
    x[2] ^= x[1];
    uint32_t turn = 0;
    for (uint32_t q = 1u << (BITS - 1); q > 1; q >>= 1)
        if (x[2] & q) turn ^= q - 1;
    uint32_t key = 0;
    for (int bit = BITS - 1; bit >= 0; bit--)
        for (int axis = 0; axis < 3; axis++)
            key = key << 1 | ((x[axis] ^ turn) >> bit & 1);
    return key;
}

struct keyed {
    uint32_t key;
    int32_t index;
};

static int by_key(const void *a, const void *b)
{
    const struct keyed *p = a, *q = b;
    const int order = (p->key > q->key) - (p->key < q->key);
    return order ? order : (p->index > q->index) - (p->index < q->index);
}

// LOWER gets the corner of the cube around all places; its edge.
static double cube_around(int n, const struct vector *place, double lower[3])
{
    double edge = 0;
    for (int axis = 0; axis < 3; axis++) {
        double least = INFINITY, most = -INFINITY;
        for (int i = 0; i < n; i++) {
            least = fmin(least, component(place[i], axis));
            most = fmax(most, component(place[i], axis));
        }
        lower[axis] = least;
        edge = fmax(edge, most - least);
    }
    return edge;
}

int32_t *order_along_curve(int n, const struct vector *place)
{
    double lower[3];
    const double edge = cube_around(n, place, lower);
    const double cells = edge > 0 ? ((1 << BITS) - 1) / edge : 0;
    struct keyed *keyed = NEW_ARRAY(struct keyed, n);
    for (int i = 0; i < n; i++) {
        uint32_t x[3];
        for (int axis = 0; axis < 3; axis++)
            x[axis] = (uint32_t)((component(place[i], axis) - lower[axis]) * cells);
        keyed[i] = (struct keyed){hilbert_key(x), i};
    }
    qsort(keyed, (size_t)n, sizeof *keyed, by_key);
    int32_t *order = NEW_ARRAY(int32_t, n);
    for (int k = 0; k < n; k++)
        order[k] = keyed[k].index;
    free(keyed);
    return order;
}
