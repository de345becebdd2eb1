// SPDX-License-Identifier: GPL-3.0-or-later
// The inwards packing method [K 3.1.2, Fig. 3.2]: the front is a queue of pairs of
// neighbours; a new grain touches both of a pair and makes new pairs. Its centre is an
// intersection of two loci, circles of radius r_a + r and r_b + r, or a line at r from
// a wall. With the centres `far` apart the foot on their line is at
//     from = (far + (r_a - r_b) (r_a + r_b) / far) / 2,
// and the points are sqrt((r_a - from) (r_a + from)) to either side: products instead
// of differences of squares, so that grains touch to the last digit.
//
// Densification: the largest grain that touches both of a pair and overlaps no other is
// found by bisection between half their gap and the largest radius, to the last digit.
#include "basics/memory.h"
#include "basics/sorted.h"
#include "grids.h"
#include "pack.h"

#include <float.h>
#include <stdlib.h>

// Walls are negative numbers among the grains of a pair: x lower, x upper, z lower, z
// upper of a box; the rim of a disc.
enum { WALL_FIRST = -1, WALLS_OF_BOX = 4, MAX_NEAR = 4096, MAX_VISITS = 8 };

struct pair {
    int a, b;   // a is a grain
    int visits; // failed attempts
};

struct spiral {
    const struct domain *domain;
    const struct sizes *sizes;
    gsl_rng *random;
    struct grids *grids;
    int count; // 0: until it is full
    double slack;
    int n_wall;
    struct pair *along_wall; // a stack: follows the walls before anything else
    int n_along, capacity_along;
    struct pair *front; // a queue, from NEXT on: round after round
    int next, n_front, capacity_front;
    int near[MAX_NEAR];
};

// Where the centre of a grain can be that touches one thing: on a circle, or on a line
// across an axis.
struct locus {
    int axis;             // of a line: 0 or 2; of a circle -1
    double value;         // of a line, m
    struct vector centre; // of a circle
    double radius;
};

static struct locus locus_of(const struct spiral *spiral, int thing, double radius)
{
    const struct domain *domain = spiral->domain;
    if (thing >= 0)
        return (struct locus){-1, 0, grids_centre(spiral->grids, thing),
                              grids_radius(spiral->grids, thing) + radius};
    if (domain->shape == DOMAIN_SPHERE)
        return (struct locus){-1, 0, domain->centre, domain->radius - radius};
    const int wall = WALL_FIRST - thing, axis = wall / 2 * 2;
    const double value = wall % 2 ? component(domain->upper, axis) - radius
                                  : component(domain->lower, axis) + radius;
    return (struct locus){.axis = axis, .value = value};
}

// The two points of circle A on B, a circle or a line; false when there are none.
static bool meet(struct locus a, struct locus b, struct vector points[2])
{
    struct vector along, side;
    double from;
    if (b.axis >= 0) {
        along = b.axis == 0 ? (struct vector){1, 0, 0} : (struct vector){0, 0, 1};
        from = b.value - component(a.centre, b.axis);
    } else {
        struct vector apart = subtract(b.centre, a.centre);
        apart.y = 0;
        const double far = norm(apart);
        if (far == 0) return false;
        along = scale(1 / far, apart);
        from = (far + (a.radius - b.radius) / far * (a.radius + b.radius)) / 2;
    }
    const double square = (a.radius - from) * (a.radius + from);
    if (!(square >= 0)) return false;
    side = scale(sqrt(square), (struct vector){-along.z, 0, along.x});
    const struct vector foot = add(a.centre, scale(from, along));
    points[0] = add(foot, side);
    points[1] = subtract(foot, side);
    return true;
}

static bool is_free(const struct spiral *spiral, struct vector place, double radius)
{
    int other;
    return domain_holds(spiral->domain, place, radius) &&
           !grids_near(spiral->grids, place, radius, -spiral->slack, &other, 1);
}

// Distance to the nearest wall, m.
static double depth(const struct spiral *spiral, struct vector place)
{
    const struct domain *domain = spiral->domain;
    if (domain->shape == DOMAIN_SPHERE)
        return domain->radius - distance(place, domain->centre);
    return fmin(fmin(place.x - domain->lower.x, domain->upper.x - place.x),
                fmin(place.z - domain->lower.z, domain->upper.z - place.z));
}

static double wall_gap(const struct spiral *spiral, int thing, struct vector place,
                       double radius)
{
    const struct locus locus = locus_of(spiral, thing, radius);
    if (locus.axis >= 0) return fabs(component(place, locus.axis) - locus.value);
    return locus.radius - distance(place, locus.centre);
}

static void queue(struct spiral *spiral, struct pair pair)
{
    GROW_ARRAY(spiral->front, spiral->n_front, spiral->capacity_front);
    spiral->front[spiral->n_front++] = pair;
}

// Pairs grain NEW with the walls and the earlier grains at most one diameter of the
// smaller away: a gap that a grain could bridge.
static void add_pairs(struct spiral *spiral, int new)
{
    const struct vector place = grids_centre(spiral->grids, new);
    const double radius = grids_radius(spiral->grids, new);
    for (int wall = 0; wall < spiral->n_wall; wall++) {
        if (wall_gap(spiral, WALL_FIRST - wall, place, radius) > 2 * radius) continue;
        GROW_ARRAY(spiral->along_wall, spiral->n_along, spiral->capacity_along);
        spiral->along_wall[spiral->n_along++] =
            (struct pair){new, WALL_FIRST - wall, 0};
    }
    const int count =
        grids_near(spiral->grids, place, radius, 2 * radius, spiral->near, MAX_NEAR);
    qsort(spiral->near, (size_t)count, sizeof *spiral->near, rising_ints);
    for (int k = 0; k < count; k++) {
        const int other = spiral->near[k];
        const double its = grids_radius(spiral->grids, other);
        const double gap =
            distance(place, grids_centre(spiral->grids, other)) - radius - its;
        if (other < new &&gap <= 2 * fmin(radius, its))
            queue(spiral, (struct pair){other, new, 0});
    }
}

static void place_grain(struct spiral *spiral, struct vector place, double radius)
{
    grids_add(spiral->grids, place, radius);
    add_pairs(spiral, grids_count(spiral->grids) - 1);
}

// The place where a grain touches both of PAIR and overlaps no other, the outer one
// first.
static bool find_place(const struct spiral *spiral, struct pair pair, double radius,
                       struct vector *place)
{
    struct vector points[2];
    if (!meet(locus_of(spiral, pair.a, radius), locus_of(spiral, pair.b, radius),
              points))
        return false;
    const int outer = depth(spiral, points[1]) < depth(spiral, points[0]);
    for (int k = 0; k < 2; k++) {
        *place = points[k ^ outer];
        if (is_free(spiral, *place, radius)) return true;
    }
    return false;
}

static bool next_pair(struct spiral *spiral, struct pair *pair)
{
    if (spiral->n_along) {
        *pair = spiral->along_wall[--spiral->n_along];
        return true;
    }
    if (spiral->next == spiral->n_front) return false;
    *pair = spiral->front[spiral->next++];
    return true;
}

static bool complete(const struct spiral *spiral)
{
    return spiral->count && grids_count(spiral->grids) >= spiral->count;
}

// It lies on the floor: in the lower corner of a box, at the lowest point of a disc.
static void place_first(struct spiral *spiral, double radius)
{
    const struct domain *domain = spiral->domain;
    struct vector corner = domain->centre;
    corner.z = domain->lower.z + radius;
    if (domain->shape == DOMAIN_BOX) corner.x = domain->lower.x + radius;
    place_grain(spiral, corner, radius);
}

// A radius that does not fit at a pair is kept for the next pair, so that the grains
// placed have the distribution drawn; the pair is tried with other radii later.
static void fill(struct spiral *spiral)
{
    place_first(spiral, sizes_draw(spiral->sizes, spiral->random));
    const int most_visits = spiral->sizes->distribution == SIZES_ONE ? 1 : MAX_VISITS;
    double radius = sizes_draw(spiral->sizes, spiral->random);
    struct pair pair;
    while (!complete(spiral) && next_pair(spiral, &pair)) {
        struct vector place;
        const bool found = find_place(spiral, pair, radius, &place);
        if (found) place_grain(spiral, place, radius);
        if (found) radius = sizes_draw(spiral->sizes, spiral->random);
        if (!found) pair.visits++;
        if (pair.visits < most_visits) queue(spiral, pair);
    }
}

// ---- densification ------------------------------------------------------------------

static bool fits(const struct spiral *spiral, struct pair pair, int side, double radius,
                 struct vector *place)
{
    struct vector points[2];
    if (!meet(locus_of(spiral, pair.a, radius), locus_of(spiral, pair.b, radius),
              points))
        return false;
    *place = points[side];
    return is_free(spiral, *place, radius);
}

// The largest grain that touches both of PAIR and overlaps no third grain or wall: by
// bisection to the last digit.
static bool grow_grain(const struct spiral *spiral, struct pair pair, int side,
                       double least, double most, struct vector *place, double *radius)
{
    const struct vector from = grids_centre(spiral->grids, pair.a);
    const double own = grids_radius(spiral->grids, pair.a);
    const double gap = pair.b < 0
                           ? wall_gap(spiral, pair.b, from, own)
                           : distance(from, grids_centre(spiral->grids, pair.b)) - own -
                                 grids_radius(spiral->grids, pair.b);
    double low = fmax(least, gap / 2 * (1 + 1e-9)), high = most;
    struct vector ignored;
    if (low > high || !fits(spiral, pair, side, low, place)) return false;
    if (fits(spiral, pair, side, high, &ignored)) low = high;
    for (;;) {
        const double half = low + (high - low) / 2;
        if (!(low < half && half < high)) break;
        *(fits(spiral, pair, side, half, &ignored) ? &low : &high) = half;
    }
    *radius = low;
    return fits(spiral, pair, side, low, place);
}

static void fill_voids(struct spiral *spiral, double least)
{
    spiral->next = spiral->n_front = spiral->n_along = 0;
    const int count = grids_count(spiral->grids);
    for (int i = 0; i < count; i++)
        add_pairs(spiral, i);
    struct pair pair;
    while (!complete(spiral) && next_pair(spiral, &pair))
        for (int side = 0; side < 2; side++) {
            struct vector place;
            double radius;
            if (grow_grain(spiral, pair, side, least, spiral->sizes->largest, &place,
                           &radius))
                place_grain(spiral, place, radius);
        }
}

// ---- the method ---------------------------------------------------------------------

static enum status check_walls(const struct domain *domain, struct reason *reason)
{
    if (domain->periodic[0] || domain->periodic[1] || domain->periodic[2])
        return refuse(
            reason, STATUS_BAD_DATA,
            "pack.periodic: must be false for inward_spiral: it starts at the "
            "walls");
    if (domain->cut != CUT_NONE)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.domain.cut.shape: must be none for inward_spiral");
    return STATUS_OK;
}

enum status inward_spiral(const struct domain *domain, const struct sizes *sizes,
                          int count, bool densify, double least, gsl_rng *random,
                          struct packing *packing, struct reason *reason)
{
    const enum status status = check_walls(domain, reason);
    if (status) return status;
    const struct vector edge = subtract(domain->upper, domain->lower);
    const double expected = edge.x / sizes->smallest * edge.z / sizes->smallest / 4;
    const double extent = fmax(norm(domain->lower), norm(domain->upper));
    struct spiral spiral = {.domain = domain,
                            .sizes = sizes,
                            .random = random,
                            .grids = grids_create(domain, fmin(least, sizes->smallest),
                                                  sizes->largest, fmin(expected, 1e6)),
                            .count = count,
                            .slack = 2 * DBL_EPSILON * extent,
                            .n_wall = domain->shape == DOMAIN_BOX ? WALLS_OF_BOX : 1};
    fill(&spiral);
    if (densify) fill_voids(&spiral, least);
    *packing = packing_in(domain, grids_count(spiral.grids));
    for (int i = 0; i < packing->n_particle; i++) {
        packing->position[i] = grids_centre(spiral.grids, i);
        packing->radius[i] = grids_radius(spiral.grids, i);
    }
    grids_free(spiral.grids);
    free(spiral.along_wall);
    free(spiral.front);
    return STATUS_OK;
}
