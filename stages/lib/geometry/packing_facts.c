// SPDX-License-Identifier: GPL-3.0-or-later
// What a packing looks like, for the warnings of packing_check.c: quantiles of radii,
// extent, grains beyond walls, empty space (share of places further than `far` from any
// grain), coincident and overlapping pairs, free grains. In code order
//     beyond_walls = 1 - (distance of the centre from the wall, inwards) / radius,
//     porosity = 1 - sum of 4/3 pi r^3 / volume of the box, or of the bodies in it,
//     far = max(2 median, cbrt(volume of the box / n)),
//     overlap = (r_i + r_j - distance) / min(r_i, r_j).
// Empty space is looked for at about 2 edge / far places along each edge; not where
// bodies bound the grains.
#include "geometry/packing_check.h"

#include "basics/memory.h"
#include "basics/sorted.h"
#include "geometry/auxiliary.h"
#include "geometry/fabric.h"
#include "geometry/neighbours.h"
#include "geometry/radius_unit.h"

#include <stdlib.h>
#include <string.h>

// Share of the sum of two radii: nearer centres coincide, to the 16 digits of
// coordinates.
static const double ONE_PLACE = 1e-12;
static const double STUCK_OUT =
    0.01; // of the radius: DEM grains press into walls by less
static const double HALVED_SLACK = 0.95; // contacts of DEM packings overlap by less

// ---- sizes --------------------------------------------------------------------------

static void measure_sizes(const struct packing *packing, struct packing_facts *facts)
{
    double *radius = NEW_ARRAY(double, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++)
        if (!is_auxiliary(packing, i)) radius[facts->n++] = packing->radius[i];
    if (facts->n) {
        qsort(radius, (size_t)facts->n, sizeof *radius, rising_doubles);
        facts->smallest = radius[0];
        facts->largest = radius[facts->n - 1];
        facts->tenth = radius[facts->n / 10];
        facts->median = radius[facts->n / 2];
        facts->ninetieth = radius[facts->n - 1 - facts->n / 10];
    }
    free(radius);
}

// ---- the box ------------------------------------------------------------------------

// How far the surface of grain I reaches beyond its worst wall, flat or round, of its
// radius: 1 when its centre lies on the wall, 2 when all of it is outside.
static double beyond_walls(const struct packing *packing, int i)
{
    double worst = -HUGE_VAL;
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        if (packing->periodic[wall / 2]) continue;
        const double x = component(packing->position[i], wall / 2);
        const double at = wall_position(packing, wall);
        worst = fmax(worst, 1 - (wall % 2 ? at - x : x - at) / packing->radius[i]);
    }
    const double depth = depth_in_bodies(packing, packing->position[i]);
    return fmax(worst, 1 - depth / packing->radius[i]);
}

static void count_one(int *count, int *first, int i)
{
    if (!(*count)++) *first = i;
}

static void measure_walls(const struct packing *packing, struct packing_facts *facts)
{
    const double rounding = 1e-9;
    for (int i = 0; i < packing->n_particle; i++) {
        if (is_auxiliary(packing, i)) continue;
        const double beyond = beyond_walls(packing, i);
        if (beyond >= 2 - rounding)
            count_one(&facts->outside, &facts->first_outside, i);
        if (beyond > 1)
            count_one(&facts->centres_outside, &facts->first_centre_outside, i);
        if (beyond <= STUCK_OUT) continue;
        facts->cut++;
        if (beyond > facts->depth) facts->deepest = i;
        facts->depth = fmax(facts->depth, beyond);
    }
}

static void measure_extent(const struct packing *packing, struct packing_facts *facts)
{
    const struct vector edge = subtract(facts->box.upper, facts->box.lower);
    facts->porosity = 1;
    for (int axis = 0; axis < 3; axis++) {
        double low = HUGE_VAL, high = -HUGE_VAL, first = HUGE_VAL, last = -HUGE_VAL;
        for (int i = 0; i < packing->n_particle; i++) {
            if (is_auxiliary(packing, i)) continue;
            const double x = component(packing->position[i], axis);
            low = fmin(low, x - packing->radius[i]);
            high = fmax(high, x + packing->radius[i]);
            first = fmin(first, x);
            last = fmax(last, x);
        }
        set_component(&facts->lower, axis, low);
        set_component(&facts->upper, axis, high);
        const bool flat = facts->n > 3 && last - first < 0.01 * facts->median;
        if (flat && facts->plane != 1) facts->plane = axis;
    }
    for (int i = 0; i < packing->n_particle; i++) {
        const double r = is_auxiliary(packing, i) ? 0 : packing->radius[i];
        facts->porosity -= 4 * M_PI / 3 * (r / edge.x) * (r / edge.y) * (r / edge.z);
    }
    facts->bounded = packing->n_body > 0;
    if (!facts->bounded) return;
    struct packing body = *packing; // without the room of auxiliary grains
    body.lower = facts->box.lower;
    body.upper = facts->box.upper;
    for (int k = 0; k < body.n_body; k++) { // cylinders end with the box
        struct body *one = &body.body[k];
        if (one->shape != BODY_CYLINDER) continue;
        one->lower.z = fmax(one->lower.z, body.lower.z);
        one->upper.z = fmin(one->upper.z, body.upper.z);
    }
    facts->porosity =
        1 - (1 - facts->porosity) * (box_volume(edge) / packing_domain_volume(&body));
}

// How far surfaces of grains reach from the middle of the body, or, with an AXIS from 0
// to 2, from the line along it through the middle.
static double reach_from_middle(const struct packing *packing,
                                const struct packing_facts *facts, int axis)
{
    const struct vector middle = midpoint(facts->lower, facts->upper);
    double reach = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        if (is_auxiliary(packing, i)) continue;
        struct vector from = subtract(packing->position[i], middle);
        if (axis < 3) set_component(&from, axis, 0);
        reach = fmax(reach, norm(from) + packing->radius[i]);
    }
    return reach;
}

// Whether the grains end at a cylinder or sphere, and leave the corners of their box
// empty. In a full box they reach there: already where four grains are side by side a
// quarter further than half its width. Not of fewer grains, which have no corners.
static void measure_roundness(const struct packing *packing,
                              struct packing_facts *facts)
{
    static const double SQUARE = 0.05; // difference of two widths, of one
    static const double AS_ROUND = 1.15, LEAST_ACROSS = 8; // largest radii
    const struct vector edge = subtract(facts->upper, facts->lower);
    for (int axis = 0; axis < 4 && !facts->bounded; axis++) {
        double least = HUGE_VAL, most = 0;
        bool ends = true;
        for (int across = 0; across < 3; across++) {
            if (across == axis) continue;
            least = fmin(least, component(edge, across));
            most = fmax(most, component(edge, across));
            ends = ends && !packing->periodic[across];
        }
        if (!ends || least < LEAST_ACROSS * facts->largest) continue;
        if (most - least > SQUARE * most) continue;
        const double reach = reach_from_middle(packing, facts, axis);
        if (reach > AS_ROUND * most / 2) continue;
        facts->round = axis;
        facts->reach = reach;
    }
}

// ---- empty space --------------------------------------------------------------------

// Places in the middles of equal cells of the box.
struct places {
    int count[3];
    double step[3];      // m
    struct vector lower; // corner of the box
    uint8_t *filled;
};

static void fill_around(const struct packing *packing, int i, double reach,
                        struct places *places)
{
    int from[3], to[3];
    double at[3];
    for (int axis = 0; axis < 3; axis++) {
        at[axis] =
            (component(packing->position[i], axis) - component(places->lower, axis)) /
                places->step[axis] -
            0.5;
        const double half = reach / places->step[axis];
        const bool repeats = packing->periodic[axis];
        const double most = places->count[axis];
        from[axis] =
            (int)ceil(fmax(at[axis] - half, repeats ? at[axis] - most / 2 : 0));
        to[axis] =
            (int)floor(fmin(at[axis] + half, repeats ? at[axis] + most / 2 : most - 1));
    }
    for (int x = from[0]; x <= to[0]; x++)
        for (int y = from[1]; y <= to[1]; y++)
            for (int z = from[2]; z <= to[2]; z++) {
                const int cell[3] = {x, y, z};
                double square = 0;
                size_t place = 0;
                for (int axis = 0; axis < 3; axis++) {
                    const double apart = (cell[axis] - at[axis]) * places->step[axis];
                    const int count = places->count[axis];
                    square += apart * apart;
                    place = place * (size_t)count +
                            (size_t)((cell[axis] % count + count) % count);
                }
                if (square <= reach * reach) places->filled[place] = 1;
            }
}

// Far is more than a diameter, or where grains are loose than the room each has.
static void measure_empty(const struct packing *packing, struct packing_facts *facts)
{
    if (!facts->n || packing->n_body) return;
    const struct vector edge = subtract(facts->box.upper, facts->box.lower);
    const double room = cbrt(edge.x) * cbrt(edge.y) * cbrt(edge.z) / cbrt(facts->n);
    facts->far = fmax(2 * facts->median, room);
    struct places places = {.lower = facts->box.lower};
    size_t all = 1;
    for (int axis = 0; axis < 3; axis++) {
        const double cells = 2 * component(edge, axis) / facts->far;
        if (!(cells < 1e6)) return;
        places.count[axis] = (int)fmax(1, rint(cells));
        places.step[axis] = component(edge, axis) / places.count[axis];
        all *= (size_t)places.count[axis];
    }
    if (all > 64 * (size_t)facts->n + 4096) return; // thinner than its grains
    places.filled = NEW_ARRAY(uint8_t, all);
    for (int i = 0; i < packing->n_particle; i++)
        if (!is_auxiliary(packing, i))
            fill_around(packing, i, packing->radius[i] + facts->far, &places);
    size_t filled = 0;
    for (size_t k = 0; k < all; k++)
        filled += places.filled[k];
    facts->empty = 1 - (double)filled / (double)all;
    free(places.filled);
}

// ---- pairs --------------------------------------------------------------------------

static void measure_pairs(const struct packing *packing,
                          const struct contacts *contacts, struct packing_facts *facts)
{
    uint8_t *overlaps = NEW_ARRAY(uint8_t, packing->n_particle);
    for (int k = 0; k < contacts->count; k++) {
        const int i = contacts->pair[k][0], j = contacts->pair[k][1];
        const double a = packing->radius[i], b = packing->radius[j];
        const double apart = norm(nearest_image(packing, i, j));
        const double overlap = (a + b - apart) / fmin(a, b);
        if (apart <= ONE_PLACE * (a + b) && !facts->coincident++)
            memcpy(facts->same, contacts->pair[k], sizeof facts->same);
        if (apart < 0.5 * HALVED_SLACK * (a + b)) facts->halved++;
        if (overlap > OVERLAP_MOST) overlaps[i] = overlaps[j] = 1;
        if (overlap > facts->overlap)
            memcpy(facts->worst, contacts->pair[k], sizeof facts->worst);
        facts->overlap = fmax(facts->overlap, overlap);
    }
    for (int i = 0; i < packing->n_particle; i++)
        facts->overlapping += overlaps[i];
    free(overlaps);
}

static void count_free(const struct packing *packing, const struct contacts *contacts,
                       double gap, struct packing_facts *facts)
{
    int *touching = grain_contacts(packing, contacts);
    int *walls = wall_contacts(packing, gap);
    for (int i = 0; i < packing->n_particle; i++)
        facts->free += !is_auxiliary(packing, i) && !touching[i] && !walls[i];
    free(touching);
    free(walls);
}

struct packing_facts packing_facts(const struct packing *packing,
                                   const struct contacts *contacts, double gap)
{
    struct packing_facts facts = {.box = box_without_auxiliary(packing),
                                  .first_outside = -1,
                                  .first_centre_outside = -1,
                                  .deepest = -1,
                                  .same = {-1, -1},
                                  .worst = {-1, -1},
                                  .plane = -1,
                                  .round = -1};
    facts.radius_unit = radius_unit(packing);
    measure_sizes(packing, &facts);
    measure_extent(packing, &facts);
    measure_roundness(packing, &facts);
    measure_walls(packing, &facts);
    measure_empty(packing, &facts);
    measure_pairs(packing, contacts, &facts);
    count_free(packing, contacts, gap, &facts);
    return facts;
}
