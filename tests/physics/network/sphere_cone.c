// SPDX-License-Identifier: GPL-3.0-or-later
// Tetrahedra less a ball about one corner, against boxes cut by spheres in closed form,
// and against themselves.
#include "../../test.h"
#include "../support_lattice.h"
#include "geometry/sphere_box_volume.h"
#include "geometry/tetra_ball_volume.h"

#include <stdlib.h>

// A face of the box at the end of AXIS (SIDE 0 or 1), as two triangles.
static double over_face(double radius, const struct vector corner[2], int axis,
                        int side)
{
    struct vector at[4];
    for (int k = 0; k < 4; k++) { // around the face
        const int u = (k == 1 || k == 2), v = k >= 2;
        set_component(&at[k], axis, component(corner[side], axis));
        set_component(&at[k], (axis + 1) % 3, component(corner[u], (axis + 1) % 3));
        set_component(&at[k], (axis + 2) % 3, component(corner[v], (axis + 2) % 3));
    }
    const double sum = tetrahedron_outside_ball(radius, at[0], at[1], at[2]) +
                       tetrahedron_outside_ball(radius, at[0], at[2], at[3]);
    return side ? sum : -sum;
}

static double outside_in_box(double radius, struct vector lower, struct vector upper)
{
    const struct vector corner[2] = {lower, upper};
    double sum = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 2; side++)
            sum += over_face(radius, corner, axis, side);
    return sum;
}

// The centre inside and outside the box, the sphere inside, poking through faces, edges
// and corners, and around it all.
TEST(boxes_lose_what_the_sphere_takes)
{
    uint64_t seed = 1;
    for (int trial = 0; trial < 10000; trial++) {
        struct vector lower, upper;
        double volume = 1;
        for (int axis = 0; axis < 3; axis++) {
            const double low = 3 * next_random(&seed) - 2,
                         edge = 0.1 + 2 * next_random(&seed);
            set_component(&lower, axis, low);
            set_component(&upper, axis, low + edge);
            volume *= edge;
        }
        const double radius = 2 * next_random(&seed);
        const double expected = volume - sphere_in_box(radius, lower, upper);
        const double ball = 4 * M_PI / 3 * radius * radius * radius;
        assert_true(fabs(outside_in_box(radius, lower, upper) - expected) <
                    1e-13 * fmax(1, ball));
    }
}

static struct vector random_point(uint64_t *seed)
{
    return (struct vector){next_random(seed) - 0.5, next_random(seed) - 0.5,
                           next_random(seed) - 0.5};
}

// Cut in three from any point of its plane, inside or not; the other way round; at any
// scale that is a power of two, to the last bit.
TEST(triangles_add_up)
{
    uint64_t seed = 2;
    for (int trial = 0; trial < 10000; trial++) {
        const struct vector a = random_point(&seed), b = random_point(&seed),
                            c = random_point(&seed);
        const double radius = next_random(&seed), u = 3 * next_random(&seed) - 1,
                     v = 3 * next_random(&seed) - 1;
        const struct vector middle =
            add(a, add(scale(u, subtract(b, a)), scale(v, subtract(c, a))));
        const double whole = tetrahedron_outside_ball(radius, a, b, c);
        const double parts = tetrahedron_outside_ball(radius, middle, a, b) +
                             tetrahedron_outside_ball(radius, middle, b, c) +
                             tetrahedron_outside_ball(radius, middle, c, a);
        assert_true(fabs(whole - parts) < 1e-12);
        assert_true(fabs(whole + tetrahedron_outside_ball(radius, a, c, b)) < 1e-15);
        const double unit = 0x1p-30;
        assert_true(tetrahedron_outside_ball(unit * radius, scale(unit, a),
                                             scale(unit, b), scale(unit, c)) ==
                    unit * unit * unit * whole);
    }
}

// Flat, a point, with the origin in its plane or on an edge's line: nothing, not NaN.
TEST(degenerate_triangles_are_nothing)
{
    const struct vector x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    assert_true(tetrahedron_outside_ball(0.5, x, x, x) == 0);
    assert_true(tetrahedron_outside_ball(0.5, x, y, y) == 0);
    assert_true(tetrahedron_outside_ball(0.5, x, y, scale(0.5, add(x, y))) == 0);
    assert_true(tetrahedron_outside_ball(0.5, x, y, scale(-1, x)) == 0);
    const double octant = tetrahedron_outside_ball(0.5, x, y, z);
    assert_true(fabs(octant - (1. / 6 - M_PI / 48)) < 1e-16); // 1/sqrt 3 away: inside
    // the foot on a corner: by symmetry a 48th of a cube, radius 1, edge 2
    const struct vector p = {1, 1, 0}, q = {1, 1, 1};
    assert_true(fabs(tetrahedron_outside_ball(1, x, p, q) - (8 - 4 * M_PI / 3) / 48) <
                1e-16);
}
