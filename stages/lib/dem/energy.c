// SPDX-License-Identifier: GPL-3.0-or-later
// Energy, the ledger of what was gained and lost, and momentum, in SI.
//
// Kinetic: 1/2 m v^2 + 1/2 I omega^2, with I = 2/5 m R^2 and velocities brought to the
// time of the forces (half a step back), as leapfrog has them half a step ahead.
// Elastic, of a contact with overlap U, shear force F^s and the bond's F^n, F^s, M^n,
// M^s:
//     linear 1/2 k_n U^2, Hertz 2/5 k_n U^(5/2), and F^s.F^s / (2 k_s), and of its
//     rolling spring M^r.M^r / (2 k_r);
//     bond   1/2 k^n A stretch^2 + F^s.F^s / (2 k^s A) + M^s.M^s / (2 k^n I)
//            + (M^n)^2 / (2 k^s J).
// Kinetic energy and momentum leave driven groups out: what their drive does to their
// own masses is nobody's loss. Ledger: pairs book their losses by pair
// (pair_contact.h), grains theirs in grain_ledger; what belongs to pairs that are gone
// is in energy_ledger. Momentum is of the half step before, like velocities.
#include "dem/engine.h"

#include <math.h>

// Velocities at the time of the forces: half a step back.
static struct motion motion_with_forces(const struct dem *dem, int particle)
{
    const double *velocity = velocity_of(dem, particle), *spin = spin_of(dem, particle);
    struct motion now = {0};
    const struct motion load = load_on_grain(dem, particle);
    const double half = 0.5 * places_ahead(dem) * dem->time_step;
    for (int k = 0; k < 3; k++) {
        now.linear[k] =
            velocity[k] - half * dem->mobility[particle][0] * load.linear[k];
        now.angular[k] = spin[k] - half * dem->mobility[particle][1] * load.angular[k];
    }
    return now;
}

static double inertia(const struct dem *dem, int particle) // of a ball: Theta [K 4.4]
{
    const double radius = dem->place[particle].radius;
    return 0.4 * dem->mass[particle] * radius * radius;
}

// Energy of a spring from the SQUARE of its force.
static double spring_energy(double square, double stiffness)
{
    return stiffness > 0 ? 0.5 * square / stiffness : 0;
}

static double bond_energy(const struct dem *dem, int pair, double stretch)
{
    const struct bond_group *g = &dem->pairs.bonds[pair / PAIRS_IN_GROUP];
    const int lane = pair % PAIRS_IN_GROUP;
    const double radius = g->radius[lane], area = M_PI * radius * radius;
    const double bending_inertia = 0.25 * area * radius * radius;
    const struct vector shear = lane_vector(g->shear_force, lane);
    const struct vector bending = lane_vector(g->bending, lane);
    const double twist = g->twist[lane];
    const double normal = dem->bond_normal_stiffness,
                 across = dem->bond_shear_stiffness;
    const double strained = stretch - g->free_stretch[lane];
    return 0.5 * normal * area * strained * strained +
           spring_energy(dot(shear, shear), across * area) +
           spring_energy(dot(bending, bending), normal * bending_inertia) +
           spring_energy(twist * twist, across * 2 * bending_inertia);
}

static double pair_energy(const struct dem *dem, int pair)
{
    const struct contact_law law = law_of_pair(dem, pair);
    const struct pair_geometry geometry = pair_geometry(dem, pair, places_ahead(dem));
    const bool bonded = is_bonded(dem, pair);
    const bool pulls = bonded && dem->features & FEATURE_CONTACT_BOND;
    const double overlap = pulls ? geometry.overlap : fmax(geometry.overlap, 0);
    const bool hertz = dem->features & FEATURE_HERTZ;
    const double root = hertz ? sqrt(overlap) : 1;
    double energy =
        (hertz ? 0.4 : 0.5) * law.normal_stiffness * root * overlap * overlap;
    if (dem->pairs.shear) {
        const struct vector shear = lane_vector(
            dem->pairs.shear[pair / PAIRS_IN_GROUP].force, pair % PAIRS_IN_GROUP);
        energy += spring_energy(dot(shear, shear), law.shear_stiffness * root);
    }
    energy += pair_rolling_energy(dem, pair, law.normal_stiffness * root);
    if (bonded && !pulls) energy += bond_energy(dem, pair, geometry.stretch);
    return energy;
}

double booked_ahead(const struct dem *dem, int i)
{
    const double step = places_ahead(dem) * dem->time_step;
    if (is_driven(dem, i)) {
        const struct motion load = load_on_grain(dem, i);
        return 0.5 * step * group_power(dem, i, &load);
    }
    if (!(dem->mobility[i][0] > 0)) return 0;
    return step * dot(as_vector(dem->external[i]), as_vector(velocity_of(dem, i)));
}

static struct dem_energy ledger_totals(const struct dem *dem)
{
    struct dem_energy ledger = dem->energy_ledger;
    for (int p = 0; dem->pairs.loss && p < dem->pairs.n_pair; p++) {
        const struct loss_group *loss = &dem->pairs.loss[p / PAIRS_IN_GROUP];
        ledger.dashpots += loss->dashpots[p % PAIRS_IN_GROUP];
        ledger.slip += loss->slip[p % PAIRS_IN_GROUP];
        ledger.broken += loss->broken[p % PAIRS_IN_GROUP];
        ledger.bridges += loss->bridges[p % PAIRS_IN_GROUP];
    }
    for (int i = 0; dem->grain_ledger && i < dem->n_particle; i++) {
        ledger.gained += dem->grain_ledger[i][0] - booked_ahead(dem, i);
        ledger.local_damping += dem->grain_ledger[i][1];
    }
    return ledger;
}

double elastic_energy(const struct dem *dem)
{
    double sum = 0;
    for (int p = 0; p < dem->pairs.n_pair; p++)
        sum += pair_energy(dem, p);
    for (int k = 0; k < dem->n_wall_pair; k++)
        sum += wall_pair_energy(dem, &dem->wall_pair[k]);
    return sum;
}

struct dem_energy dem_energy(const struct dem *dem)
{
    struct dem_energy energy = ledger_totals(dem);
    for (int i = 0; i < dem->n_particle; i++) {
        if (is_driven(dem, i)) continue;
        const struct motion now = motion_with_forces(dem, i);
        const struct vector v = as_vector(now.linear), w = as_vector(now.angular);
        energy.kinetic +=
            0.5 * (dem->mass[i] * dot(v, v) + inertia(dem, i) * dot(w, w));
    }
    energy.elastic = elastic_energy(dem);
    const double unit = dem->unit.stiffness * dem->unit.length * dem->unit.length;
    double *const part[] = {&energy.kinetic,  &energy.elastic, &energy.gained,
                            &energy.dashpots, &energy.slip,    &energy.local_damping,
                            &energy.broken,   &energy.bridges};
    for (size_t k = 0; k < sizeof part / sizeof *part; k++)
        *part[k] *= unit;
    return energy;
}

struct dem_momentum dem_momentum(const struct dem *dem)
{
    struct vector linear = {0, 0, 0}, angular = {0, 0, 0};
    for (int i = 0; i < dem->n_particle; i++) {
        if (is_driven(dem, i)) continue;
        const struct vector p = scale(dem->mass[i], as_vector(velocity_of(dem, i)));
        const struct vector x =
            add(dem->start[i], as_vector(dem->place[i].displacement));
        const struct vector spin = as_vector(spin_of(dem, i));
        linear = add(linear, p);
        angular = add(angular, add(cross(x, p), scale(inertia(dem, i), spin)));
    }
    const double unit = dem->unit.mass * dem->unit.length / dem->unit.time;
    return (struct dem_momentum){.linear = scale(unit, linear),
                                 .angular = scale(unit * dem->unit.length, angular)};
}
