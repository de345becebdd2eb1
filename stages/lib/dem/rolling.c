// SPDX-License-Identifier: GPL-3.0-or-later
// Coefficients of rolling resistance, and its step at walls (between grains:
// pair_rolling.h has the law). With R* and the secant stiffness k of the contact,
//     arm = mu_r R*,   k_r = 9/4 k arm^2,   c_r = 2 eta sqrt(I_r k_r),
//     1 / I_r = 1 / (I_i + m_i R_i^2) + 1 / (I_j + m_j R_j^2)
// (Ai et al. 2011; the stiffness is theirs, after Jiang, Yu & Harris 2005). At a wall
// R* is the grain's radius and the second term of 1 / I_r is 0. With Hertz k = k_n
// U^0.5, so that c_r, as given here, is times U^0.25.
#include "dem/engine.h"

#include <math.h>

// I + m R^2.
static double inertia_about_contact(const struct dem *dem, int i)
{
    const double radius = dem->place[i].radius;
    return 1.4 * dem->mass[i] * radius * radius;
}

double rolling_stiffness(const struct rolling_law *law, double stiffness)
{
    return 2.25 * stiffness * law->arm * law->arm;
}

double rolling_damping(const struct dem *dem, const struct rolling_law *law,
                       double overlap)
{
    return law->damping * (dem->features & FEATURE_HERTZ ? sqrt(sqrt(overlap)) : 1);
}

static struct rolling_law rolling_law(const struct dem *dem, int first, int second,
                                      double radius, double inertia, double stiffness)
{
    const double damping = 0.5 * (dem->material[first].rolling_damping +
                                  dem->material[second].rolling_damping);
    struct rolling_law law = {
        .arm = dem->pair_rolling_friction[dem->n_material * first + second] * radius};
    law.damping = 2 * damping * sqrt(inertia * rolling_stiffness(&law, stiffness));
    return law;
}

static struct rolling_law rolling_between(const struct dem *dem, int i, int j,
                                          double stiffness)
{
    const double a = dem->place[i].radius, b = dem->place[j].radius;
    const double p = inertia_about_contact(dem, i), q = inertia_about_contact(dem, j);
    return rolling_law(dem, dem->material_of[i], dem->material_of[j], a * b / (a + b),
                       p * q / (p + q), stiffness);
}

struct rolling_law rolling_of_two(const struct dem *dem, int i)
{
    return rolling_between(dem, i, i, pair_law(dem, i, i).normal_stiffness);
}

void set_pair_rolling(struct dem *dem, int pair, double stiffness)
{
    const int32_t *end = dem->pairs.particle[pair];
    const struct rolling_law law = rolling_between(dem, end[0], end[1], stiffness);
    struct rolling_group *group = &dem->pairs.rolling[pair / PAIRS_IN_GROUP];
    group->arm[pair % PAIRS_IN_GROUP] = law.arm;
    group->damping[pair % PAIRS_IN_GROUP] = law.damping;
}

struct rolling_law pair_rolling(const struct dem *dem, int pair)
{
    if (!dem->pairs.rolling) return (struct rolling_law){0, 0};
    const struct rolling_group *group = &dem->pairs.rolling[pair / PAIRS_IN_GROUP];
    const int lane = pair % PAIRS_IN_GROUP;
    return (struct rolling_law){group->arm[lane], group->damping[lane]};
}

void set_wall_rolling(const struct dem *dem, struct wall_pair *pair)
{
    const int i = pair->particle, kind = dem->material_of[i];
    const struct dem_wall *wall = &dem->wall[pair->wall].is;
    pair->rolling = rolling_law(dem, kind, wall->elastic ? wall->material : kind,
                                dem->place[i].radius, inertia_about_contact(dem, i),
                                pair->law.normal_stiffness);
}

double rolling_energy(const struct rolling_law *law, double stiffness,
                      struct vector moment)
{
    const double rolling = rolling_stiffness(law, stiffness);
    return rolling > 0 ? 0.5 * dot(moment, moment) / rolling : 0;
}

double pair_rolling_energy(const struct dem *dem, int pair, double stiffness)
{
    if (!dem->pairs.rolling) return 0;
    const struct rolling_law law = pair_rolling(dem, pair);
    return rolling_energy(&law, stiffness,
                          lane_vector(dem->pairs.rolling[pair / PAIRS_IN_GROUP].moment,
                                      pair % PAIRS_IN_GROUP));
}

struct vector advance_wall_rolling(struct wall_pair *pair,
                                   const struct wall_rolling *step, double *slip,
                                   double *dashpots)
{
    const struct rolling_law *law = &pair->rolling;
    const double stiffness = rolling_stiffness(law, step->stiffness);
    const double limit = law->arm * step->normal_force;
    const struct vector kept = scale(step->retained, step->turned);
    *slip += rolling_energy(law, step->stiffness_before, step->turned) -
             rolling_energy(law, step->stiffness, kept);
    const struct vector trial =
        subtract(kept, scale(stiffness * step->time_step, step->rolling));
    const double size = norm(trial);
    pair->rolling_moment = size > limit ? scale(limit / size, trial) : trial;
    if (size > limit) { // the mean moment times what rolled on
        const struct vector on = subtract(trial, pair->rolling_moment);
        if (stiffness > 0)
            *slip += 0.5 * dot(add(kept, pair->rolling_moment), on) / stiffness;
        return pair->rolling_moment;
    }
    const double damping = law->damping * step->damping;
    *dashpots += damping * dot(step->rolling, step->rolling) * step->time_step;
    return subtract(pair->rolling_moment, scale(damping, step->rolling));
}
