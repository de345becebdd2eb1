// SPDX-License-Identifier: GPL-3.0-or-later
// The largest stable time step. Leapfrog with stiffness K, dashpots C that see the
// velocity of half a step before, and masses M is stable if and only if no motion x has
//     x.(dt^2 K + 2 dt C) x > 4 x.M x,
// rotations included. The energy of a pair is a square of the difference between the
// motions of its two grains. So it is at most twice the sum of what each grain would
// give with the other at rest. That bounds K and C by one 6x6 block for each grain
// (rows 0-2 translation, 3-5 rotation, scaled by sqrt of the mobilities):
//     block = sum over contacts of weight (along n n^T + across (1 - n n^T) ...),
// with weight 2, or 1 beside a grain or wall that cannot move. With k and c the largest
// eigenvalues of the two blocks, dt solves dt^2 k + 2 dt c = 4.
//
// This is exact on a bonded cubic lattice and on the safe side elsewhere. Every pair in
// the list counts as touching, as it may soon. [K 4.47] knows neither rotation, nor
// dashpots, nor that a grain has several contacts. A Hertz contact counts with its
// stiffness at the overlap that it has, or is expected to have.
#include "dem/engine.h"

#include "basics/memory.h"

#include <math.h>

struct block {
    double a[6][6];
};

// Stiffnesses (or dampings) that one grain feels at one contact, n outward: along n,
// across n at the end of ARM, twisting about n, and bending.
struct resistance {
    struct vector normal;
    double arm;
    double along, across, twist, bending;
};

static void add_resistance(struct block *block, const struct resistance *r,
                           double weight, const double mobility[2])
{
    const double n[3] = {r->normal.x, r->normal.y, r->normal.z};
    const double cross_n[3][3] = {{0, -n[2], n[1]}, {n[2], 0, -n[0]}, {-n[1], n[0], 0}};
    const double turning = r->across * r->arm * r->arm + r->bending;
    const double mixed = weight * sqrt(mobility[0] * mobility[1]);
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) {
            const double nn = n[k] * n[l], plane = (k == l) - nn;
            block->a[k][l] +=
                weight * mobility[0] * (r->along * nn + r->across * plane);
            block->a[k + 3][l + 3] +=
                weight * mobility[1] * (r->twist * nn + turning * plane);
            block->a[k][l + 3] -= mixed * r->across * r->arm * cross_n[k][l];
            block->a[k + 3][l] -= mixed * r->across * r->arm * cross_n[l][k];
        }
}

static double trace(const struct block *block)
{
    double sum = 0;
    for (int k = 0; k < 6; k++)
        sum += block->a[k][k];
    return sum;
}

static void square_over(struct block *block, double divisor)
{
    struct block old;
    for (int k = 0; k < 6; k++)
        for (int l = 0; l < 6; l++)
            old.a[k][l] = block->a[k][l] / divisor;
    for (int k = 0; k < 6; k++)
        for (int l = 0; l <= k; l++) { // it is symmetric
            double sum = 0;
            for (int m = 0; m < 6; m++)
                sum += old.a[k][m] * old.a[l][m];
            block->a[k][l] = block->a[l][k] = sum;
        }
}

// A positive semidefinite block squared again and again, scaled: of its 2^n-th power
// the 2^n-th root of the trace bounds the largest eigenvalue, for n = 10 within 0.2 %,
// for n = 6 within 3 %.
struct powers {
    struct block block;
    double logarithm;
};
enum { SQUARINGS = 10, FEW_SQUARINGS = 6 };

static void square(struct powers *p)
{
    const double t = trace(&p->block);
    if (!(t > 0)) return;
    square_over(&p->block, t);
    p->logarithm = 2 * (p->logarithm + log(t));
}

// After N squarings.
static double eigenvalue_bound(const struct powers *p, int n)
{
    const double t = trace(&p->block);
    return t > 0 ? exp((p->logarithm + log(t)) / (1 << n)) : 0;
}

// Springs and dashpots of a grain at one contact; weight as in the head of this file.
struct grain_stiffness {
    struct resistance spring, dashpot;
    double weight;
};

// The tangents of LAW at OVERLAP. Nothing shears without friction or a bond.
static struct contact_law tangents(const struct dem *dem, struct contact_law law,
                                   double overlap, bool bonded)
{
    if (dem->features & FEATURE_HERTZ) {
        const double root = sqrt(overlap), fourth = sqrt(root);
        law.normal_stiffness *= 1.5 * root;
        law.shear_stiffness *= root;
        law.normal_damping *= fourth;
        law.shear_damping *= fourth;
    }
    const bool bond_grips = bonded && dem->features & FEATURE_CONTACT_BOND;
    if (!(law.friction > 0) && !bond_grips) law.shear_stiffness = 0;
    if (!(law.friction > 0) && !bonded) law.shear_damping = 0;
    return law;
}

// Force over overlap, as the rolling spring counts it.
static double secant(const struct dem *dem, struct contact_law law, double overlap)
{
    const bool hertz = dem->features & FEATURE_HERTZ;
    return law.normal_stiffness * (hertz ? sqrt(overlap) : 1);
}

// The overlap that a contact is taken to have; negative when it does not count.
static double overlap_of(const struct dem *dem, double overlap, bool bonded, bool now)
{
    if (now) return bonded ? fmax(overlap, 0) : overlap;
    return fmax(overlap, dem->expected_overlap);
}

static struct grain_stiffness pair_stiffness(const struct dem *dem, int pair,
                                             int particle, bool now)
{
    const int32_t *const ends = dem->pairs.particle[pair];
    const bool is_first = ends[0] == particle;
    const int other = is_first ? ends[1] : ends[0];
    const struct pair_geometry geometry = pair_geometry(dem, pair, 0);
    const bool bonded = is_bonded(dem, pair);
    const double overlap = overlap_of(dem, geometry.overlap, bonded, now);
    if (overlap < 0) return (struct grain_stiffness){.weight = 0};

    const struct contact_law pair_law = law_of_pair(dem, pair);
    const struct contact_law law = tangents(dem, pair_law, overlap, bonded);
    const double radius =
        bonded ? dem->pairs.bonds[pair / PAIRS_IN_GROUP].radius[pair % PAIRS_IN_GROUP]
               : 0;
    const double area = M_PI * radius * radius, inertia = 0.25 * area * radius * radius;
    const double normal = dem->bond_normal_stiffness, shear = dem->bond_shear_stiffness;
    const struct rolling_law rolling = pair_rolling(dem, pair);
    const struct vector outward = scale(is_first ? 1 : -1, geometry.normal);
    const double arm = dem->place[particle].radius - 0.5 * geometry.overlap;
    return (struct grain_stiffness){
        .spring = {.normal = outward,
                   .arm = arm,
                   .along = law.normal_stiffness + normal * area,
                   .across = law.shear_stiffness + shear * area,
                   .twist = shear * 2 * inertia,
                   .bending =
                       normal * inertia +
                       rolling_stiffness(&rolling, secant(dem, pair_law, overlap))},
        .dashpot = {.normal = outward,
                    .arm = arm,
                    .along = law.normal_damping,
                    .across = law.shear_damping,
                    .bending = rolling_damping(dem, &rolling, overlap)},
        .weight = dem->mobility[other][0] > 0 ? 2 : 1};
}

static struct grain_stiffness wall_stiffness(const struct dem *dem,
                                             const struct wall_pair *pair, bool now)
{
    const double overlap = overlap_of(dem, pair->depth, false, now);
    if (overlap < 0) return (struct grain_stiffness){.weight = 0};
    const struct contact_law law = tangents(dem, pair->law, overlap, false);
    const double arm = dem->place[pair->particle].radius;
    const bool rolls = dem->features & FEATURE_ROLLING;
    const struct rolling_law rolling =
        rolls ? pair->rolling : (struct rolling_law){0, 0};
    return (struct grain_stiffness){
        .spring = {.normal = pair->normal,
                   .arm = arm,
                   .along = law.normal_stiffness,
                   .across = law.shear_stiffness,
                   .bending =
                       rolling_stiffness(&rolling, secant(dem, pair->law, overlap))},
        .dashpot = {.normal = pair->normal,
                    .arm = arm,
                    .along = law.normal_damping,
                    .across = law.shear_damping,
                    .bending = rolling_damping(dem, &rolling, overlap)},
        .weight = 1};
}

// Solves dt^2 k + 2 dt c = 4; infinite when nothing resists.
static double largest_step(double k, double c)
{
    return 4 / (c + sqrt(c * c + 4 * k));
}

// Blocks of all contacts of PARTICLE.
static void add_contacts(const struct dem *dem, int particle, bool now,
                         struct block *stiffness, struct block *damping)
{
    const int *offset = dem->pair_offset + particle;
    const int n_pair = offset[1] - offset[0];
    const struct wall_pair *walls = dem->wall_pair + dem->wall_offset[particle];
    const int n_wall = dem->wall_offset[particle + 1] - dem->wall_offset[particle];
    for (int k = 0; k < n_pair + n_wall; k++) {
        const struct grain_stiffness contact =
            k < n_pair ? pair_stiffness(dem, dem->pair_of[offset[0] + k], particle, now)
                       : wall_stiffness(dem, &walls[k - n_pair], now);
        if (contact.weight <= 0) continue;
        add_resistance(stiffness, &contact.spring, contact.weight,
                       dem->mobility[particle]);
        add_resistance(damping, &contact.dashpot, contact.weight,
                       dem->mobility[particle]);
    }
}

// Limit of one grain, but at most LEAST, the limit of the others: most grains are let
// go by the first bounds, which cost little. Springs and dashpots count HARDER times;
// SQUARINGS as above.
static double grain_limit(const struct dem *dem, int particle, bool now, double harder,
                          int squarings, double least)
{
    struct powers stiffness = {.logarithm = 0}, damping = {.logarithm = 0};
    add_contacts(dem, particle, now, &stiffness.block, &damping.block);
    if (largest_step(harder * trace(&stiffness.block), harder * trace(&damping.block)) >
        least * (1 + 1e-9))
        return least;
    for (int n = 0;; n++) {
        const double limit = largest_step(harder * eigenvalue_bound(&stiffness, n),
                                          harder * eigenvalue_bound(&damping, n));
        if (n == squarings) return fmin(least, limit);
        if (limit > least * (1 + 1e-9)) return least;
        square(&stiffness);
        square(&damping);
    }
}

// The limit, but at most MOST.
static double limit_up_to(const struct dem *dem, bool now, double most)
{
    // Against the motion, local damping makes springs and dashpots stronger by its
    // share: springs would allow its square root, dashpots do not.
    const double weaker = 1 + dem->local_damping;
    double limit = most * weaker;
    for (int i = 0; i < dem->n_particle; i++)
        limit = grain_limit(dem, i, now, 1, SQUARINGS, limit);
    return limit / weaker;
}

double stability_limit(const struct dem *dem, bool now)
{
    return limit_up_to(dem, now, INFINITY);
}

// Limit for two grains like this one in contact, whether any is near or not.
static double two_grain_limit(const struct dem *dem, int particle, double harder)
{
    const double radius = dem->place[particle].radius;
    const double *mobility = dem->mobility[particle];
    const double along = 2 * mobility[0];
    const double across = along + 2 * radius * radius * mobility[1];
    const struct contact_law law =
        tangents(dem, pair_law(dem, particle, particle), dem->expected_overlap, false);
    const double overlap = dem->expected_overlap;
    const struct rolling_law rolling = rolling_of_two(dem, particle);
    const double k = rolling_stiffness(
        &rolling, secant(dem, pair_law(dem, particle, particle), overlap));
    const double c = rolling_damping(dem, &rolling, overlap);
    return largest_step(
        harder * fmax(fmax(along * law.normal_stiffness, across * law.shear_stiffness),
                      2 * mobility[1] * k),
        harder * fmax(fmax(along * law.normal_damping, across * law.shear_damping),
                      2 * mobility[1] * c));
}

double limit_of_two(const struct dem *dem)
{
    double limit = INFINITY;
    for (int i = 0; i < dem->n_particle; i++)
        limit = fmin(limit, two_grain_limit(dem, i, 1 + dem->local_damping));
    return limit;
}

double sharp_grain_limit(const struct dem *dem, int particle, bool now, double most)
{
    return grain_limit(dem, particle, now, 1 + dem->local_damping, FEW_SQUARINGS, most);
}

// The least of all, for any number of threads: a grain is let go only if it is above.
double sharp_stability_limit(const struct dem *dem, bool now)
{
    double limit = limit_of_two(dem);
#pragma omp parallel for num_threads(dem->threads) reduction(min : limit)
    for (int i = 0; i < dem->n_particle; i++)
        limit = grain_limit(dem, i, now, 1 + dem->local_damping, SQUARINGS, limit);
    return isinf(limit) ? 1 : limit;
}

double automatic_time_step(const struct dem *dem)
{
    double limit = dem->time_step_limit;
    for (int i = 0; i < dem->n_particle; i++)
        limit = fmin(limit, two_grain_limit(dem, i, 1) / (1 + dem->local_damping));
    return dem->automatic_share * (isinf(limit) ? 1 : limit);
}

void shorten_time_step(struct dem *dem)
{
    // Above this it does not matter by how much.
    const double enough = 1.001 * dem->time_step / dem->automatic_share;
    const double limit = limit_up_to(dem, false, enough);
    if (dem->automatic_share * limit >= dem->time_step) return;
    dem->time_before += (double)(dem->cycle - dem->step_since) * dem->time_step;
    dem->step_since = dem->cycle;
    dem->time_step_limit = limit;
    dem->time_step = dem->automatic_share * limit;
    dem->step_was_shortened = true;
}

double dem_time_step_limit(const struct dem *dem)
{
    return dem->time_step_limit * dem->unit.time;
}

double dem_time_step_limit_now(const struct dem *dem)
{
    return stability_limit(dem, true) * dem->unit.time;
}
