// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors in three dimensions, by value. An array of struct vector has the layout of an
// (n,3) dataset of doubles. Nothing is scaled: squares of lengths must neither overflow
// nor vanish: lengths from about 1e-150 to 1e150, in whatever unit they are. All are
// plain sums and products in the order written, so the same digits everywhere. By
// value, because compilers keep three doubles in registers; small names, because
// formulas are read more often than written.
#pragma once

#include <assert.h>
#include <math.h>

// In the unit of the context: m, N, m/s, or scaled.
struct vector {
    double x, y, z;
};

static_assert(sizeof(struct vector) == 3 * sizeof(double), "an (n,3) dataset");

static inline struct vector as_vector(const double a[3])
{
    return (struct vector){a[0], a[1], a[2]};
}

// A + B; below A - B, and S times A.
static inline struct vector add(struct vector a, struct vector b)
{
    return (struct vector){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vector subtract(struct vector a, struct vector b)
{
    return (struct vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct vector scale(double s, struct vector a)
{
    return (struct vector){s * a.x, s * a.y, s * a.z};
}

// x, y, z in this order, not fused.
static inline double dot(struct vector a, struct vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// A x B: right-handed, |A| |B| sin of the angle between them. 0 for parallel ones to
// rounding only: test lengths against a tolerance, not against 0.
static inline struct vector cross(struct vector a, struct vector b)
{
    return (struct vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                           a.x * b.y - a.y * b.x};
}

// |A|, and |A - B|; 0 for equal places. The square root is the nearest number to that
// of the rounded square; no scaling, see the head.
static inline double norm(struct vector a)
{
    return sqrt(dot(a, a));
}

static inline double distance(struct vector a, struct vector b)
{
    return norm(subtract(a, b));
}

// Halfway from A to B; A itself when they are equal, without rounding.
static inline struct vector midpoint(struct vector a, struct vector b)
{
    return add(a, scale(0.5, subtract(b, a)));
}

// The volume of a box with the edges A.
static inline double box_volume(struct vector a)
{
    return a.x * a.y * a.z;
}

// Component 0, 1 or 2. AXIS 2 is taken for any other number.
static inline double component(struct vector a, int axis)
{
    return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

// Changes one of A, the others stay.
static inline void set_component(struct vector *a, int axis, double value)
{
    *(axis == 0 ? &a->x : axis == 1 ? &a->y : &a->z) = value;
}

// The largest absolute value of a component.
static inline double largest_component(struct vector a)
{
    const double x = fabs(a.x), y = fabs(a.y), z = fabs(a.z);
    const double more = x > y ? x : y;
    return more > z ? more : z;
}
