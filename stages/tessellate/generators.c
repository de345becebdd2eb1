// SPDX-License-Identifier: GPL-3.0-or-later
// Grains and their images on a grid. All positions are rounded to a power of two,
// 2^-42 mean diameters: then reflections (2 wall - x) and copies (x + k box) are exact
// in double precision, a lattice is exactly degenerate, and the exact predicates of
// the triangulation make no slivers out of rounding noise. Reflections come before
// copies, so that mirror images are copied too. A round wall reflects each grain in
// the tangent plane of a wall larger by ROUND_CLEARANCE; the walls of the box that it
// touches make way for it.
#include "generators.h"

#include "basics/memory.h"
#include "geometry/triangulation/insertion_order.h"
#include "geometry/triangulation/regular_triangulation.h"

#include <stdlib.h>

enum { GRID_BITS = 42, SAFE_BITS = 50 };

// A power of two: 2^-42 mean diameters, or coarser where the box is so large that sums
// on the grid would not be exact; in units.
static double grid_for(double diameter, struct vector box)
{
    const double largest = fmax(box.x, fmax(box.y, box.z));
    return ldexp(1, (int)fmax(ilogb(diameter) - GRID_BITS, ilogb(largest) - SAFE_BITS));
}

static struct vector round_to(double grid, struct vector x)
{
    return (struct vector){grid * nearbyint(x.x / grid), grid * nearbyint(x.y / grid),
                           grid * nearbyint(x.z / grid)};
}

static double mean_diameter(const struct packing *packing)
{
    double sum = 0;
    for (int i = 0; i < packing->n_particle; i++)
        sum += 2 * packing->radius[i];
    return sum / packing->n_particle;
}

// The unit of length, m: the mean grain diameter, or the cube root of the box volume
// per grain where that is larger. A unit far from both would cost digits.
static double unit_of_length(const struct packing *packing)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    const double diameter = mean_diameter(packing);
    const double share = edge.x / diameter * (edge.y / diameter) * (edge.z / diameter);
    const double spacing = cbrt(share / packing->n_particle);
    return spacing > 1.1 ? spacing * diameter : diameter; // a lattice keeps its digits
}

static struct vector scaled(const struct packing *packing, struct vector x, double unit)
{
    const struct vector from_corner = subtract(x, packing->lower);
    return (struct vector){from_corner.x / unit, from_corner.y / unit,
                           from_corner.z / unit};
}

// Finds the round wall around the grains; along its round axes the box has no walls, so
// no grain is reflected in a wall of the box that it cannot reach. Bodies that grains
// lie around, and boxes within the box, need no images: they cut the network later
// (cut.h).
static void place_walls(const struct packing *packing, struct generators *generators)
{
    for (int axis = 0; axis < 3; axis++)
        generators->walled[axis] = !generators->repeats[axis];
    for (int k = 0; k < packing->n_body; k++) {
        const struct body *body = &packing->body[k];
        if (!body->within || body->shape == BODY_BOX) continue;
        generators->is_round = true;
        generators->round = *body;
        generators->round.lower = scaled(packing, body->lower, generators->unit);
        generators->round.upper = scaled(packing, body->upper, generators->unit);
        for (int axis = 0; axis < 3; axis++)
            if (body_is_round(body, axis)) generators->walled[axis] = false;
    }
}

// In m, before anything is rounded: that a centre lies on the wrong side of a body is
// said of the packing, not of the grid.
static enum status check_within(const struct packing *packing, struct reason *reason)
{
    static const char *const name[] = {"box", "cylinder", "sphere", "disc"};
    for (int k = 0; k < packing->n_body; k++)
        for (int i = 0; i < packing->n_particle; i++) {
            const struct vector at = packing->position[i];
            const struct body body = body_near(packing, k, at);
            if (body_holds(&body, at) == body.within) continue;
            return refuse(reason, STATUS_BAD_DATA,
                          "/particles/position: row %d: the centre must be %s the %s "
                          "of /domain/bodies: row %d, is at %g, %g, %g m",
                          i, body.within ? "in" : "outside", name[body.shape], k, at.x,
                          at.y, at.z);
        }
    return STATUS_OK;
}

// On the grid: a centre on a wall would coincide with its own reflection. Where the box
// repeats grains were moved into it; where a round wall is, check_within decides.
static enum status check_inside(const struct generators *generators,
                                struct reason *reason)
{
    for (int i = 0; i < generators->n_particle; i++)
        for (int axis = 0; axis < 3; axis++) {
            const double at = component(generators->point[i].at, axis);
            if (!generators->walled[axis]) continue;
            if (at > 0 && at < component(generators->box, axis)) continue;
            return refuse(
                reason, STATUS_BAD_DATA,
                "/particles/position: row %d: the centre must be inside the box "
                "along %c, between 0 and %g m from its lower side, is %g m from there",
                i, "xyz"[axis], component(generators->box, axis) * generators -> unit,
                at * generators -> unit);
        }
    return STATUS_OK;
}

static int compare_places(const void *a, const void *b, void *positions)
{
    const int32_t i = *(const int32_t *)a, j = *(const int32_t *)b;
    const struct vector *at = positions;
    for (int axis = 0; axis < 3; axis++) {
        const double x = component(at[i], axis), y = component(at[j], axis);
        if (x != y) return x < y ? -1 : 1;
    }
    return (i > j) - (i < j);
}

enum status check_distinct(const struct generators *generators, struct reason *reason)
{
    const int n = generators->n_particle;
    struct vector *at = NEW_ARRAY(struct vector, n);
    int32_t *order = NEW_ARRAY(int32_t, n);
    for (int i = 0; i < generators->n; i++)
        if (is_grain(generators, i))
            at[generators->origin[i].base] = generators->point[i].at;
    for (int i = 0; i < n; i++) {
        order[i] = i;
        for (int axis = 0; axis < 3; axis++) // an upper side that repeats is the lower
            if (generators->repeats[axis] &&
                component(at[i], axis) == component(generators->box, axis))
                set_component(&at[i], axis, 0);
    }
    qsort_r(order, (size_t)n, sizeof *order, compare_places, at);
    enum status status = STATUS_OK;
    for (int k = 1; k < n && !status; k++)
        if (norm(subtract(at[order[k]], at[order[k - 1]])) == 0)
            status =
                refuse(reason, STATUS_BAD_DATA,
                       "/particles/position: row %d: has the same centre as row %d",
                       order[k], order[k - 1]);
    free(order);
    free(at);
    return status;
}

struct vector position_in_image(const struct generators *generators,
                                struct vector position, struct image image)
{
    return add(position, (struct vector){image.along[0] * generators->box.x,
                                         image.along[1] * generators->box.y,
                                         image.along[2] * generators->box.z});
}

static void grow(struct generators *generators)
{
    const size_t capacity = 2 * (size_t)generators->capacity;
    generators->capacity *= 2;
    generators->point =
        reallocate(generators->point, capacity, sizeof *generators->point);
    generators->origin =
        reallocate(generators->origin, capacity, sizeof *generators->origin);
}

// Adds a generator, as a copy of generator FROM, whose place, base, wall or image the
// caller then changes. Pointers into the arrays do not outlive it.
static int add_like(struct generators *generators, int from)
{
    if (generators->n == generators->capacity) grow(generators);
    const int i = generators->n++;
    generators->point[i] = generators->point[from];
    generators->origin[i] = generators->origin[from];
    return i;
}

// How far generator I is from a wall of the box, inwards; in units.
static double depth(const struct generators *generators, int i, int wall)
{
    const double at = component(generators->point[i].at, wall / 2);
    return wall % 2 ? component(generators->box, wall / 2) - at : at;
}

// Reflections in planes tangent to a wall this much larger, in units, stay clear of it.
static const double ROUND_CLEARANCE = 0.25;

// Reflections are bases of their own: each is numbered by its place in the array.
static void add_round_reflections(struct generators *generators, double grid)
{
    for (int i = 0; i < generators->n_particle && generators->is_round; i++) {
        const struct vector at = generators->point[i].at;
        const struct vector out = body_outward(&generators->round, at);
        const double far = distance(at, body_nearest_round(&generators->round, at));
        if (far > generators->reach) continue;
        const int added = add_like(generators, i);
        const struct vector image = add(at, scale(2 * (far + ROUND_CLEARANCE), out));
        generators->point[added].at = round_to(grid, image);
        generators->origin[added].base = added;
        generators->origin[added].wall = WALL_OUTER;
    }
}

// Reflects the grains in the walls of the box, and also their images beyond a round
// wall, which keep WALL_OUTER as their wall.
static void add_reflections(struct generators *generators)
{
    const int before = generators->n;
    for (int i = 0; i < before; i++)
        for (int wall = 0; wall < WALL_COUNT; wall++) {
            const int axis = wall / 2;
            if (!generators->walled[axis] ||
                depth(generators, i, wall) > generators->reach)
                continue;
            const double at = wall % 2 ? component(generators->box, axis) : 0;
            const double from = component(generators->point[i].at, axis);
            const int added = add_like(generators, i);
            set_component(&generators->point[added].at, axis,
                          2 * at - from); // exact on the grid
            generators->origin[added].base = added;
            if (i < generators->n_particle)
                generators->origin[added].wall = (int8_t)wall;
        }
}

// One direction after the other, so that copies are copied too: across edges and
// corners.
static void add_copies(struct generators *generators)
{
    for (int axis = 0; axis < 3; axis++) {
        if (!generators->repeats[axis]) continue;
        const double edge = component(generators->box, axis);
        const int most = (int)fmin(ceil(generators->reach / edge), FARTHEST_IMAGE);
        const int before = generators->n;
        for (int i = 0; i < before; i++)
            for (int boxes = -most; boxes <= most; boxes++) {
                const double at =
                    component(generators->point[i].at, axis) + boxes * edge;
                if (!boxes || at < -generators->reach || at > edge + generators->reach)
                    continue;
                const int added = add_like(generators, i);
                set_component(&generators->point[added].at, axis, at);
                generators->origin[added].image.along[axis] = (int8_t)boxes;
            }
    }
}

// AT moved into a periodic box; in m, so that grains one box apart come to one place.
static struct vector wrapped(const struct packing *packing, struct vector at)
{
    for (int axis = 0; axis < 3; axis++) {
        if (!packing->periodic[axis]) continue;
        const double lower = component(packing->lower, axis);
        const double edge = component(packing->upper, axis) - lower;
        const double x = component(at, axis);
        set_component(&at, axis, x - edge * floor((x - lower) / edge));
    }
    return at;
}

// Puts generators in the order of insertion_order.h. Their origins go along, so nothing
// that is found later depends on this order.
static void sort_generators(struct generators *generators)
{
    const int n = generators->n;
    struct vector *at = NEW_ARRAY(struct vector, n);
    for (int i = 0; i < n; i++)
        at[i] = generators->point[i].at;
    int32_t *order = insertion_order(at, n);
    free(at);
    struct weighted_point *point = allocate_uncleared((size_t)n, sizeof *point);
    struct origin *origin = allocate_uncleared((size_t)n, sizeof *origin);
    for (int k = 0; k < n; k++) {
        point[k] = generators->point[order[k]];
        origin[k] = generators->origin[order[k]];
    }
    free(order);
    free(generators->point);
    free(generators->origin);
    generators->point = point;
    generators->origin = origin;
}

// Grains first, so that base i is grain i; then reflections, which are bases, too; then
// copies of all bases.
enum status place_generators(const struct packing *packing, double reach, bool power,
                             struct generators *generators, struct reason *reason)
{
    const int n = packing->n_particle, room = n + n / 2 + 64;
    *generators = (struct generators){.n = n,
                                      .n_particle = n,
                                      .capacity = room,
                                      .point = NEW_ARRAY(struct weighted_point, room),
                                      .origin = NEW_ARRAY(struct origin, room),
                                      .reach = reach,
                                      .unit = unit_of_length(packing)};
    const double unit = generators->unit;
    generators->box = scaled(packing, packing->upper, unit);
    const double grid = grid_for(mean_diameter(packing) / unit, generators->box);
    generators->box = round_to(grid, generators->box);
    for (int axis = 0; axis < 3; axis++)
        generators->repeats[axis] = packing->periodic[axis];
    place_walls(packing, generators);
    for (int i = 0; i < n; i++) {
        const double radius = packing->radius[i] / unit;
        generators->point[i].at = round_to(
            grid, scaled(packing, wrapped(packing, packing->position[i]), unit));
        generators->point[i].weight = power ? radius * radius : 0;
        generators->largest_weight =
            fmax(generators->largest_weight, generators->point[i].weight);
        generators->origin[i] = (struct origin){.particle = i, .base = i, .wall = -1};
    }
    enum status status = check_inside(generators, reason);
    if (!status) status = check_within(packing, reason);
    if (status) return status;
    add_round_reflections(generators, grid);
    add_reflections(generators);
    generators->n_base = generators->n;
    add_copies(generators);
    sort_generators(generators);
    return STATUS_OK;
}

void generators_free(struct generators *generators)
{
    free(generators->point);
    free(generators->origin);
    *generators = (struct generators){0};
}
