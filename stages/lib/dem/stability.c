// SPDX-License-Identifier: GPL-3.0-or-later
// The largest stable time step. Leapfrog with stiffness K, dashpots C that see the
// velocity of half a step before, and masses M is stable if and only if no motion x has
//     x.(dt^2 K + 2 dt C) x > 4 x.M x,
// rotations included. The energy of one pair is a square of the difference of what its
// two grains do, so it is at most twice the sum of what each does with the other at
// rest. That bounds K and C by 6x6 blocks of single grains, exactly so on a bonded
// cubic lattice; elsewhere the limit is on the safe side. Every pair in the list counts
// as touching, as it may soon. [K 4.47] knows neither rotation, nor dashpots, nor that
// a grain has several contacts.
#include "dem/engine.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct block {
    double a[6][6];
};

// What resists one grain at one contact, n outward: along n, across n at the end of
// ARM, twisting about n and bending.
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
    const struct block old = *block;
    for (int k = 0; k < 6; k++)
        for (int l = 0; l < 6; l++) {
            double sum = 0;
            for (int m = 0; m < 6; m++)
                sum += (old.a[k][m] / divisor) * (old.a[m][l] / divisor);
            block->a[k][l] = sum;
        }
}

// The largest eigenvalue of a positive semidefinite block, at most 0.2 % more: the
// 2^10th root of the trace of its 2^10th power.
static double largest_eigenvalue(struct block block)
{
    double logarithm = 0;
    enum { SQUARINGS = 10 };
    for (int k = 0; k < SQUARINGS; k++) {
        const double t = trace(&block);
        if (!(t > 0)) return 0;
        square_over(&block, t);
        logarithm = 2 * (logarithm + log(t));
    }
    return exp((logarithm + log(trace(&block))) / (1 << SQUARINGS));
}

// Springs and dashpots at slot S of a grain; the weight is 2 beside a grain that moves.
struct joint {
    struct resistance spring, dashpot;
    double weight;
};

static struct joint pair_joint(const struct dem *dem, int pair, int particle)
{
    const struct contact_law *law = &dem->law;
    const struct pair_group *g = &dem->pairs.group[pair / PAIRS_IN_GROUP];
    const int lane = pair % PAIRS_IN_GROUP;
    const int *const ends = dem->pairs.particle[pair];
    const bool is_first = ends[0] == particle;
    const int other = is_first ? ends[1] : ends[0];
    const struct pair_geometry lie = pair_geometry(dem, pair, 0);
    const struct vector outward = scale(is_first ? 1 : -1, lie.normal);
    const double arm = dem->place[particle].radius - 0.5 * lie.overlap;
    const bool held = g->normal_strength[lane] >= 0;
    const double radius = held ? g->bond_radius[lane] : 0,
                 area = M_PI * radius * radius;
    const double inertia = 0.25 * area * radius * radius;
    const bool grips = law->friction > 0;
    const double shear = grips ? law->shear_stiffness : 0;
    const double normal_damping = law->normal_damping * g->root_mass[lane];
    const double shear_damping =
        grips || held ? law->shear_damping * g->root_mass[lane] : 0;
    return (struct joint){
        .spring = {.normal = outward,
                   .arm = arm,
                   .along = law->normal_stiffness + law->bond_normal_stiffness * area,
                   .across = shear + law->bond_shear_stiffness * area,
                   .twist = law->bond_shear_stiffness * 2 * inertia,
                   .bending = law->bond_normal_stiffness * inertia},
        .dashpot = {.normal = outward,
                    .arm = arm,
                    .along = normal_damping,
                    .across = shear_damping},
        .weight = dem->mobility[other][0] > 0 ? 2 : 1};
}

static struct joint wall_joint(const struct dem *dem, const struct wall_pair *pair)
{
    const struct contact_law *law = &dem->wall_law;
    const struct vector outward = scale(-1, dem->wall[pair->wall].normal);
    const double arm = dem->place[pair->particle].radius;
    const double grip = law->friction > 0;
    return (struct joint){
        .spring = {.normal = outward,
                   .arm = arm,
                   .along = law->normal_stiffness,
                   .across = grip * law->shear_stiffness},
        .dashpot = {.normal = outward,
                    .arm = arm,
                    .along = law->normal_damping * pair->root_mass,
                    .across = grip * law->shear_damping * pair->root_mass},
        .weight = 1};
}

// Which pair, or -1-k for wall pair k, writes to each slot.
static int *slot_owners(const struct dem *dem)
{
    int *owner = NEW_ARRAY(int, dem->slot_offset[dem->n_particle]);
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        const struct pair_group *g = &dem->pairs.group[p / PAIRS_IN_GROUP];
        owner[g->first_slot[p % PAIRS_IN_GROUP]] = p;
        owner[g->second_slot[p % PAIRS_IN_GROUP]] = p;
    }
    for (int k = 0; k < dem->n_wall_pair; k++)
        owner[dem->wall_pair[k].slot] = -1 - k;
    return owner;
}

static double grain_limit(const struct dem *dem, const int *owner, int particle)
{
    struct block stiffness = {{{0}}}, damping = {{{0}}};
    for (int s = dem->slot_offset[particle]; s < dem->slot_offset[particle + 1]; s++) {
        const struct joint joint =
            owner[s] >= 0 ? pair_joint(dem, owner[s], particle)
                          : wall_joint(dem, &dem->wall_pair[-1 - owner[s]]);
        add_resistance(&stiffness, &joint.spring, joint.weight,
                       dem->mobility[particle]);
        add_resistance(&damping, &joint.dashpot, joint.weight, dem->mobility[particle]);
    }
    const double k = largest_eigenvalue(stiffness), c = largest_eigenvalue(damping);
    return 4 / (c + sqrt(c * c + 4 * k)); // dt^2 k + 2 dt c = 4; infinite when alone
}

double stability_limit(const struct dem *dem)
{
    int *owner = slot_owners(dem);
    double limit = INFINITY;
    for (int i = 0; i < dem->n_particle; i++)
        limit = fmin(limit, grain_limit(dem, owner, i));
    free(owner);
    return limit;
}
