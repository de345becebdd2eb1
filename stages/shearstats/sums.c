// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over a snapshot, with W the share of a point in a cell (grid.h). Over grains i
//     mass = sum m W(x_i),   momentum = sum m v W(x_i),   flux = sum m v v W(x_i),
// and over contacts with the force f on the second and the branch l from the first
//     stress = sum f l int_0^1 W(x + s l) ds      (compression is positive),
// [Goldhirsch 2010]; f is divided into that of the bridge, -pull n, and the rest. At
// walls and driven grains the branch ends at the contact c, where the boundary's force
// is kept: traction = sum f W(c) [Weinhart et al. 2012]. Then
//     d momentum/dt + div(flux + stress) = traction + body
// holds exactly where W depends on differences of coordinates only.
//
// The integral is Gauss's with three points on each of equal pieces of l, at most
// a quarter of the half width of the kernel long; the weights sum to 1, so that the sum
// of f l over the grid keeps all of its digits. Force and branch are turned to the
// local directions of each point. In a cylinder r v_angle stands beside v_angle, for
// the angular velocity.
//
// The branch may leave the box on one side: its points are spread where they are, and
// the grid brings them back if its axis repeats.
#include "sums.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

static const int SYMMETRIC[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

// ---- grains -------------------------------------------------------------------------

// (n_particle, 2): contacts, bridges. Both ends count, so that their mean over the
// grains is a coordination number. Walls and driven grains count as neighbours, not as
// grains.
static double *count_neighbours(const struct motion *motion, int s)
{
    double *count = NEW_ARRAY(double, 2 * (size_t)motion->n_particle);
    for (int64_t k = motion->contact_first[s]; k < motion->contact_first[s + 1]; k++) {
        const bool touches = motion->overlap[k] >= 0;
        const bool joined = motion->bridge_volume && motion->bridge_volume[k] > 0;
        for (int end = 0; end < 2; end++) {
            const int32_t grain = motion->pair[k][end];
            if (grain < 0) continue;
            double *of = count + 2 * (size_t)grain;
            of[0] += touches;
            of[1] += joined;
        }
    }
    return count;
}

// m r v beside m v, because means of r v and of v over a cell are two numbers.
static void add_grains(const struct motion *motion, int s, const struct frame *frame,
                       const struct grid *grid, double *sum)
{
    const size_t row = (size_t)s * (size_t)motion->n_particle;
    double *neighbours = count_neighbours(motion, s);
    for (int i = 0; i < motion->n_particle; i++) {
        if (motion->driven[i]) continue;
        const struct place place = place_of(frame, motion->position[row + (size_t)i]);
        const double m = motion->mass[i], r = motion->radius[i];
        double v[3], value[GRAIN_SUMS];
        local_components(&place, motion->velocity[row + (size_t)i], v);
        value[SUM_MASS] = m;
        value[SUM_VOLUME] = 4.0 / 3 * M_PI * r * r * r;
        value[SUM_COUNT] = 1;
        value[SUM_INERTIA] = m * place.r * place.r;
        for (int a = 0; a < 3; a++) {
            value[SUM_MOMENTUM + a] = m * v[a];
            value[SUM_TURNING + a] = m * place.r * v[a];
        }
        for (int k = 0; k < 6; k++)
            value[SUM_FLUX + k] = m * v[SYMMETRIC[k][0]] * v[SYMMETRIC[k][1]];
        value[SUM_TOUCHING] = neighbours[2 * (size_t)i];
        value[SUM_JOINED] = neighbours[2 * (size_t)i + 1];
        spread(grid, place.at, value, GRAIN_SUMS, sum, SUM_ALL);
    }
    free(neighbours);
}

// ---- contacts -----------------------------------------------------------------------

static struct vector centre(const struct motion *motion, int s, int32_t grain)
{
    return motion->position[(size_t)s * (size_t)motion->n_particle + (size_t)grain];
}

struct vector contact_normal(const struct motion *motion, int s, int64_t k)
{
    const int32_t *pair = motion->pair[k];
    const struct vector to =
        pair[1] < 0 ? motion->point[k] : centre(motion, s, pair[1]);
    const struct vector between =
        shortest_image(motion, subtract(to, centre(motion, s, pair[0])));
    const double length = norm(between);
    return length > 0 ? scale(1 / length, between) : (struct vector){0, 0, 0};
}

bool branch_of(const struct motion *motion, int s, int64_t k, struct vector *from,
               struct vector *along)
{
    const int32_t a = motion->pair[k][0], b = motion->pair[k][1];
    const bool a_free = !motion->driven[a], b_free = b >= 0 && !motion->driven[b];
    if (!a_free && !b_free) return false;
    const struct vector start = a_free ? centre(motion, s, a) : motion->point[k];
    const struct vector end = b_free ? centre(motion, s, b) : motion->point[k];
    *from = start;
    *along = shortest_image(motion, subtract(end, start));
    return true;
}

// A contact's force on the second, that of its bridge apart, its branch and normal.
struct contact {
    struct vector force, bridge, from, branch, normal;
    bool touches;
};

// At S along the branch, from 0 to 1, with the share WEIGHT of the contact.
static void add_point(const struct frame *frame, const struct grid *grid,
                      const struct contact *contact, double s, double weight,
                      double *sum)
{
    const struct place place =
        place_of(frame, add(contact->from, scale(s, contact->branch)));
    double force[3], bridge[3], branch[3], normal[3], value[CONTACT_SUMS];
    local_components(&place, contact->force, force);
    local_components(&place, contact->bridge, bridge);
    local_components(&place, contact->branch, branch);
    local_components(&place, contact->normal, normal);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            value[3 * a + b] = weight * force[a] * branch[b];
            value[SUM_BRIDGE - SUM_CONTACT + 3 * a + b] =
                weight * bridge[a] * branch[b];
        }
    const double touching = contact->touches ? weight : 0;
    for (int k = 0; k < 6; k++)
        value[SUM_FABRIC - SUM_CONTACT + k] =
            touching * normal[SYMMETRIC[k][0]] * normal[SYMMETRIC[k][1]];
    value[SUM_CONTACTS - SUM_CONTACT] = touching;
    spread(grid, place.at, value, CONTACT_SUMS, sum + SUM_CONTACT, SUM_ALL);
}

// Weights 5, 8, 5 over 18 are Gauss's for an interval of length 1: exact for
// polynomials of degree 5 on each piece. A branch that is absurdly long (a bad image)
// is cut into 1000 at most.
static void add_branch(const struct frame *frame, const struct grid *grid, double piece,
                       const struct contact *contact, double *sum)
{
    const double gauss[3] = {-sqrt(0.6), 0, sqrt(0.6)};
    const double weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    const int pieces = (int)fmin(fmax(ceil(norm(contact->branch) / piece), 1), 1000);
    for (int p = 0; p < pieces; p++)
        for (int k = 0; k < 3; k++)
            add_point(frame, grid, contact, (p + 0.5 + 0.5 * gauss[k]) / pieces,
                      weight[k] / pieces, sum);
}

// A quarter of the half width of the kernel; unspread, of a cell. HUGE_VAL, a single
// piece, where no axis is divided: shares are all 1 then.
static double longest_piece(const struct grid *grid)
{
    double piece = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const struct grid_axis *axis = &grid->axis[k];
        if (!axis->everywhere)
            piece = fmin(piece, axis->half_width > 0 ? 0.25 * axis->half_width
                                                     : 0.25 * axis->spacing);
    }
    return piece;
}

// The force of the boundary on the grain, where it acts.
static void add_traction(const struct motion *motion, int64_t k,
                         const struct frame *frame, const struct grid *grid,
                         double *sum)
{
    const int32_t a = motion->pair[k][0], b = motion->pair[k][1];
    const bool on_second = motion->driven[a];
    if (!on_second && b >= 0 && !motion->driven[b]) return;
    const struct place place = place_of(frame, motion->point[k]);
    double value[3];
    local_components(&place, scale(on_second ? 1 : -1, motion->force[k]), value);
    spread(grid, place.at, value, 3, sum + SUM_TRACTION, SUM_ALL);
}

// A bridge pulls: its force on the second points back along the normal, hence the sign.
static void add_contacts(const struct motion *motion, int s, const struct frame *frame,
                         const struct grid *grid, double *sum)
{
    const double piece = longest_piece(grid);
    for (int64_t k = motion->contact_first[s]; k < motion->contact_first[s + 1]; k++) {
        struct contact contact = {.touches = motion->overlap[k] >= 0};
        if (!branch_of(motion, s, k, &contact.from, &contact.branch)) continue;
        contact.normal = contact_normal(motion, s, k);
        if (motion->bridge_force)
            contact.bridge = scale(-motion->bridge_force[k], contact.normal);
        contact.force = subtract(motion->force[k], contact.bridge);
        add_branch(frame, grid, piece, &contact, sum);
        add_traction(motion, k, frame, grid, sum);
    }
}

void add_snapshot(const struct motion *motion, int s, const struct frame *frame,
                  const struct grid *grid, double *sum)
{
    add_grains(motion, s, frame, grid, sum);
    add_contacts(motion, s, frame, grid, sum);
}
