// SPDX-License-Identifier: GPL-3.0-or-later
// What can be asked of a running assembly, in SI. Forces and histories are those of the
// last force evaluation, at the places before the last displacement, and energies are
// of that moment too; momenta are of the half step before, like velocities.
#include "dem/engine.h"

#include "basics/memory.h"

#include <math.h>
#include <string.h>

int64_t dem_cycle(const struct dem *dem)
{
    return dem->cycle;
}

double dem_time_step(const struct dem *dem)
{
    return dem->time_step * dem->unit.time;
}

double dem_time_step_limit(const struct dem *dem)
{
    return dem->time_step_limit * dem->unit.time;
}

void dem_positions(const struct dem *dem, struct vector *position)
{
    for (int i = 0; i < dem->n_particle; i++)
        position[i] = scale(dem->unit.length,
                            add(dem->start[i], as_vector(dem->place[i].displacement)));
}

void dem_displacements(const struct dem *dem, struct vector *displacement)
{
    for (int i = 0; i < dem->n_particle; i++)
        displacement[i] =
            scale(dem->unit.length, as_vector(dem->place[i].displacement));
}

void dem_velocities(const struct dem *dem, struct vector *velocity)
{
    const double unit = dem->unit.length / dem->unit.time;
    for (int i = 0; i < dem->n_particle; i++)
        velocity[i] = scale(unit, as_vector(dem->motion[i].linear));
}

void dem_spins(const struct dem *dem, struct vector *spin)
{
    for (int i = 0; i < dem->n_particle; i++)
        spin[i] = scale(1 / dem->unit.time, as_vector(dem->motion[i].angular));
}

void dem_bonds_intact(const struct dem *dem, uint8_t *intact)
{
    for (int b = 0; b < dem->n_bond; b++)
        intact[b] = dem->bond_strength[DEM_CRACK_NORMAL][b] >= 0;
}

const struct dem_crack *dem_cracks(const struct dem *dem, int *count)
{
    *count = dem->n_crack;
    return dem->crack;
}

struct pair_geometry pair_geometry(const struct dem *dem, int pair, double back)
{
    const struct pair_group *g = &dem->pairs.group[pair / PAIRS_IN_GROUP];
    const int lane = pair % PAIRS_IN_GROUP;
    const int i = g->first[lane], j = g->second[lane];
    const struct vector moved = subtract(as_vector(dem->place[j].displacement),
                                         as_vector(dem->place[i].displacement));
    const struct vector moving =
        subtract(as_vector(dem->motion[j].linear), as_vector(dem->motion[i].linear));
    const struct vector apart = subtract(moved, scale(back * dem->time_step, moving));
    const struct vector start = lane_vector(g->separation, lane);
    const struct vector separation = add(start, apart);
    const double length = norm(separation);

    struct pair_geometry lie;
    lie.normal = scale(1 / length, separation);
    lie.stretch = dot(apart, add(start, separation)) / (length + g->distance[lane]);
    lie.overlap = g->overlap[lane] - lie.stretch;
    const struct vector centre =
        subtract(add(dem->start[i], as_vector(dem->place[i].displacement)),
                 scale(back * dem->time_step, as_vector(dem->motion[i].linear)));
    lie.position =
        add(centre, scale(dem->place[i].radius - 0.5 * lie.overlap, lie.normal));
    return lie;
}

// How many time steps the places are ahead of the forces.
static double ahead(const struct dem *dem)
{
    return dem->cycle > 0 ? 1 : 0;
}

static bool is_held(const struct dem *dem, int pair)
{
    return dem->pairs.group[pair / PAIRS_IN_GROUP]
               .normal_strength[pair % PAIRS_IN_GROUP] >= 0;
}

static struct vector pair_force(const struct dem *dem, int pair)
{
    const struct pair_group *g = &dem->pairs.group[pair / PAIRS_IN_GROUP];
    return as_vector(dem->slot[g->second_slot[pair % PAIRS_IN_GROUP]].linear);
}

static double wall_overlap_now(const struct dem *dem, const struct wall_pair *pair)
{
    const struct vector u =
        subtract(as_vector(dem->place[pair->particle].displacement),
                 scale(ahead(dem) * dem->time_step,
                       as_vector(dem->motion[pair->particle].linear)));
    return pair->overlap - dot(u, dem->wall[pair->wall].normal);
}

static struct dem_contact pair_contact(const struct dem *dem, int pair,
                                       const struct pair_geometry *lie)
{
    return (struct dem_contact){
        .particle = {dem->pairs.particle[pair][0], dem->pairs.particle[pair][1]},
        .bond = is_held(dem, pair) ? dem->pairs.bond[pair] : -1,
        .overlap = lie->overlap * dem->unit.length,
        .force = scale(dem->unit.stiffness * dem->unit.length, pair_force(dem, pair)),
        .position = scale(dem->unit.length, lie->position)};
}

static struct dem_contact wall_contact(const struct dem *dem,
                                       const struct wall_pair *pair, double overlap)
{
    const int i = pair->particle;
    const struct vector centre =
        subtract(add(dem->start[i], as_vector(dem->place[i].displacement)),
                 scale(ahead(dem) * dem->time_step, as_vector(dem->motion[i].linear)));
    const double arm = dem->place[i].radius - 0.5 * overlap;
    const struct vector down = scale(-arm, dem->wall[pair->wall].normal);
    return (struct dem_contact){.particle = {i, -1 - pair->wall},
                                .bond = -1,
                                .overlap = overlap * dem->unit.length,
                                .force = scale(-dem->unit.stiffness * dem->unit.length,
                                               as_vector(dem->slot[pair->slot].linear)),
                                .position = scale(dem->unit.length, add(centre, down))};
}

struct dem_contact *dem_contacts(const struct dem *dem, int *count)
{
    struct dem_contact *contact =
        NEW_ARRAY(struct dem_contact, dem->pairs.n_pair + dem->n_wall_pair);
    int n = 0;
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        const struct pair_geometry lie = pair_geometry(dem, p, ahead(dem));
        if (lie.overlap >= 0 || is_held(dem, p))
            contact[n++] = pair_contact(dem, p, &lie);
    }
    for (int k = 0; k < dem->n_wall_pair; k++) {
        const double overlap = wall_overlap_now(dem, &dem->wall_pair[k]);
        if (overlap >= 0) contact[n++] = wall_contact(dem, &dem->wall_pair[k], overlap);
    }
    *count = n;
    return contact;
}

static double mean(double sum, int count)
{
    return count > 0 ? sum / count : 0;
}

double dem_unbalanced_ratio(const struct dem *dem)
{
    double unbalanced = 0, force = 0;
    int n_free = 0, n_contact = 0;
    for (int i = 0; i < dem->n_particle; i++) {
        if (dem->mobility[i][0] <= 0) continue;
        unbalanced += norm(as_vector(load_on_grain(dem, i).linear));
        n_free++;
    }
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        const double size = norm(pair_force(dem, p));
        force += size;
        n_contact += size > 0 || is_held(dem, p);
    }
    for (int k = 0; k < dem->n_wall_pair; k++) {
        const double size = norm(as_vector(dem->slot[dem->wall_pair[k].slot].linear));
        force += size;
        n_contact += size > 0;
    }
    if (unbalanced <= 0) return 0;
    return mean(unbalanced, n_free) / mean(force, n_contact);
}

// The motion at the moment of the forces: half a step back from the last.
static struct motion motion_with_forces(const struct dem *dem, int particle)
{
    struct motion now = dem->motion[particle];
    const struct motion load = load_on_grain(dem, particle);
    const double half = 0.5 * ahead(dem) * dem->time_step;
    for (int k = 0; k < 3; k++) {
        now.linear[k] -= half * dem->mobility[particle][0] * load.linear[k];
        now.angular[k] -= half * dem->mobility[particle][1] * load.angular[k];
    }
    return now;
}

static double inertia(const struct dem *dem, int particle) // of a ball: Theta [K 4.4]
{
    const double radius = dem->place[particle].radius;
    return 0.4 * dem->mass[particle] * radius * radius;
}

// SQUARE / (2 STIFFNESS), the energy of a spring from its force squared.
static double spring_energy(double square, double stiffness)
{
    return stiffness > 0 ? 0.5 * square / stiffness : 0;
}

static double pair_energy(const struct dem *dem, int pair)
{
    const struct contact_law *law = &dem->law;
    const struct pair_group *g = &dem->pairs.group[pair / PAIRS_IN_GROUP];
    const int lane = pair % PAIRS_IN_GROUP;
    const struct pair_geometry lie = pair_geometry(dem, pair, ahead(dem));
    const struct vector shear = lane_vector(g->shear_force, lane);
    double energy = spring_energy(dot(shear, shear), law->shear_stiffness);
    if (lie.overlap > 0)
        energy += 0.5 * law->normal_stiffness * lie.overlap * lie.overlap;
    if (!is_held(dem, pair)) return energy;

    const double radius = g->bond_radius[lane], area = M_PI * radius * radius;
    const double bending_inertia = 0.25 * area * radius * radius;
    const struct vector bond_shear = lane_vector(g->bond_shear_force, lane);
    const struct vector bending = lane_vector(g->bond_bending, lane);
    const double twist = g->bond_twist[lane];
    const double normal = law->bond_normal_stiffness,
                 across = law->bond_shear_stiffness;
    return energy + 0.5 * normal * area * lie.stretch * lie.stretch +
           spring_energy(dot(bond_shear, bond_shear), across * area) +
           spring_energy(dot(bending, bending), normal * bending_inertia) +
           spring_energy(twist * twist, across * 2 * bending_inertia);
}

static double wall_energy(const struct dem *dem, const struct wall_pair *pair)
{
    const double overlap = fmax(0, wall_overlap_now(dem, pair));
    return 0.5 * dem->wall_law.normal_stiffness * overlap * overlap +
           spring_energy(dot(pair->shear_force, pair->shear_force),
                         dem->wall_law.shear_stiffness);
}

struct dem_energy dem_energy(const struct dem *dem)
{
    const double unit = dem->unit.stiffness * dem->unit.length * dem->unit.length;
    struct dem_energy energy = {0, 0};
    for (int i = 0; i < dem->n_particle; i++) {
        const struct motion now = motion_with_forces(dem, i);
        const struct vector v = as_vector(now.linear), w = as_vector(now.angular);
        energy.kinetic +=
            0.5 * unit * (dem->mass[i] * dot(v, v) + inertia(dem, i) * dot(w, w));
    }
    for (int p = 0; p < dem->pairs.n_pair; p++)
        energy.elastic += unit * pair_energy(dem, p);
    for (int k = 0; k < dem->n_wall_pair; k++)
        energy.elastic += unit * wall_energy(dem, &dem->wall_pair[k]);
    return energy;
}

struct dem_momentum dem_momentum(const struct dem *dem)
{
    struct vector linear = {0, 0, 0}, angular = {0, 0, 0};
    for (int i = 0; i < dem->n_particle; i++) {
        const struct vector p = scale(dem->mass[i], as_vector(dem->motion[i].linear));
        const struct vector x =
            add(dem->start[i], as_vector(dem->place[i].displacement));
        const struct vector spin = as_vector(dem->motion[i].angular);
        linear = add(linear, p);
        angular = add(angular, add(cross(x, p), scale(inertia(dem, i), spin)));
    }
    const double unit = dem->unit.mass * dem->unit.length / dem->unit.time;
    return (struct dem_momentum){.linear = scale(unit, linear),
                                 .angular = scale(unit * dem->unit.length, angular)};
}
