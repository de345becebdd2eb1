// SPDX-License-Identifier: GPL-3.0-or-later
// Which repetition of a periodic box something lies in: whole boxes along x, y, z. {0,
// 0, 0} is the box itself. Seen from A, B lies in the image of B less that of A; seen
// from B, A lies in the opposite one. Sums of images that are not far stay within
// int8_t; whether they are not far again, is_far says. Why not positions outside of the
// box: an image is exact, so a network across a side closes on itself without rounding.
#pragma once

#include <stdbool.h>
#include <stdint.h>

enum { FARTHEST_IMAGE = 3 }; // what three bits a direction can hold

// Three bytes: there is one for each throat and node.
struct image {
    int8_t along[3];
};

// A + B, and A - B. Images add as vectors do: B from A and C from B give C from A.
static inline struct image image_sum(struct image a, struct image b)
{
    for (int axis = 0; axis < 3; axis++)
        a.along[axis] = (int8_t)(a.along[axis] + b.along[axis]);
    return a;
}

static inline struct image image_difference(struct image a, struct image b)
{
    for (int axis = 0; axis < 3; axis++)
        a.along[axis] = (int8_t)(a.along[axis] - b.along[axis]);
    return a;
}

// The same pair seen from its other end. A throat from A to B in image i is one from B
// to A in image -i: each is stored once, from its lower end.
static inline struct image image_opposite(struct image a)
{
    return image_difference((struct image){0}, a);
}

static inline bool same_image(struct image a, struct image b)
{
    return a.along[0] == b.along[0] && a.along[1] == b.along[1] &&
           a.along[2] == b.along[2];
}

// Whether a component is beyond FARTHEST_IMAGE, where images have no number.
static inline bool is_far(struct image a)
{
    for (int axis = 0; axis < 3; axis++)
        if (a.along[axis] > FARTHEST_IMAGE || a.along[axis] < -FARTHEST_IMAGE)
            return true;
    return false;
}

// A number that orders images as their components do; different for images that are not
// far. Base 7, from -171 to 171.
static inline int32_t image_number(struct image a)
{
    enum { STEP = 2 * FARTHEST_IMAGE + 1 };
    return (a.along[0] * STEP + a.along[1]) * STEP + a.along[2];
}

// The image that is not far and has this number.
static inline struct image numbered_image(int32_t number)
{
    enum { STEP = 2 * FARTHEST_IMAGE + 1, ORIGIN = 171 }; // the number of 3, 3, 3
    number += ORIGIN;
    return (struct image){{(int8_t)(number / (STEP * STEP) - FARTHEST_IMAGE),
                           (int8_t)(number / STEP % STEP - FARTHEST_IMAGE),
                           (int8_t)(number % STEP - FARTHEST_IMAGE)}};
}
