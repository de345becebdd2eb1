// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a facet that lies in each grain, beside the integral over directions from
// the grain's centre of half the square of how far facet and grain both reach.
#include "../../random.h"
#include "../../test.h"
#include "flow/facet.h"

#include <math.h>

enum { DIRECTIONS = 20000 };

// How far from grain K along DIRECTION the line through A and B is; far if it is
// behind.
static double to_line(struct vector from, struct vector direction, struct vector a,
                      struct vector b)
{
    const struct vector side = subtract(b, a), to = subtract(a, from);
    const struct vector normal = subtract(
        to, scale(dot(to, side) / dot(side, side), side)); // from the grain to the line
    const double rate = dot(direction, normal);
    return rate > 0 ? dot(normal, normal) / rate : HUGE_VAL;
}

// Grain K's share of the facet, whose other corners it sees along U and V, ended by the
// line through A and B.
static double share(const struct corner *grain, struct vector u, struct vector v,
                    struct vector a, struct vector b)
{
    const struct vector first = scale(1 / norm(u), u);
    const struct vector part = subtract(v, scale(dot(v, first), first));
    const struct vector second = scale(1 / norm(part), part);
    const double angle = atan2(dot(v, second), dot(v, first));
    double sum = 0;
    for (int m = 0; m < DIRECTIONS; m++) {
        const double at = (m + 0.5) * angle / DIRECTIONS;
        const struct vector direction =
            add(scale(cos(at), first), scale(sin(at), second));
        const double far = fmin(grain->radius, to_line(grain->at, direction, a, b));
        sum += 0.5 * far * far;
    }
    return sum * angle / DIRECTIONS;
}

static struct corner random_grain(uint64_t *seed)
{
    const struct vector at = {next_random(seed), next_random(seed), next_random(seed)};
    return (struct corner){.at = at};
}

static bool overlap(const struct corner *a, const struct corner *b)
{
    return distance(a->at, b->at) < a->radius + b->radius;
}

TEST(three_grains)
{
    uint64_t seed = 7;
    int sticking_out = 0;
    for (int facet = 0; facet < 200;) {
        struct corner corner[3];
        for (int k = 0; k < 3; k++)
            corner[k] = random_grain(&seed);
        corner[0].at =
            add(scale(0.3, corner[0].at), midpoint(corner[1].at, corner[2].at));
        corner[0].radius = 0.6 * next_random(&seed);
        corner[1].radius = 0.1 * next_random(&seed);
        corner[2].radius = 0.1 * next_random(&seed);
        if (overlap(&corner[0], &corner[1]) || overlap(&corner[1], &corner[2]) ||
            overlap(&corner[2], &corner[0]))
            continue;
        const struct vector from = {-1, 0.3, 2}, to = {2, 1, -1};
        const struct facet found = measure_facet(corner, from, to, true);
        for (int k = 0; k < 3; k++) {
            const struct corner *a = &corner[(k + 1) % 3], *b = &corner[(k + 2) % 3];
            const double wanted = share(&corner[k], subtract(a->at, corner[k].at),
                                        subtract(b->at, corner[k].at), a->at, b->at);
            assert_within(found.sector[k], wanted, 1e-6 * norm(found.area));
        }
        const struct vector base = subtract(corner[2].at, corner[1].at);
        sticking_out += 2 * norm(found.area) / norm(base) < 0.9 * corner[0].radius;
        facet++;
    }
    assert_true(sticking_out > 20);
}

// A grain by a wall, a small one farther from it: the large one reaches past the line
// from the small one to the wall.
TEST(two_grains_and_a_wall)
{
    const struct vector down = {0, 0, -1};
    const struct corner corner[3] = {{.at = {0, 0, 1}, .radius = 1},
                                     {.at = {0.5, 0.3, 2.2}, .radius = 0.1},
                                     {.normal = down, .plane = 0}};
    const struct facet found = measure_facet(corner, (struct vector){1, 0, 1},
                                             (struct vector){-1, 1, 1}, true);
    const struct vector to = subtract(corner[1].at, corner[0].at);
    assert_close(found.sector[0],
                 share(&corner[0], to, down, corner[1].at, add(corner[1].at, down)),
                 1e-6);
    assert_close(
        found.sector[1],
        share(&corner[1], scale(-1, to), down, corner[0].at, add(corner[0].at, down)),
        1e-8);
}
