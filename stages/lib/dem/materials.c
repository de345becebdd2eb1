// SPDX-License-Identifier: GPL-3.0-or-later
// What two materials make of a contact, and masses from densities.
//
// Each law gives the coefficients of `struct contact_law` for a pair with effective
// mass m = m_i m_j / (m_i + m_j) and radius R* = R_i R_j / (R_i + R_j); at a wall
// m and R* are those of the grain. The force at overlap U and relative velocity V is
// (pairs.h)
//     F^n = k_n U - c_n V^n  (Hertz: k_n U^1.5 and c_n U^0.25),
//     F^s from k_s and c_s, at most friction times the normal force.
// Linear [K 4.22, 4.27-4.30], timed [G 2], Hertz-Mindlin [K 4.23] with Tsuji's damping.
#include "dem/engine.h"

#include <math.h>

// Two partners: materials, effective mass m_ij and radius R_i R_j / (R_i + R_j).
struct contact_partners {
    int first, second; // materials; second is -1 for a rigid wall
    double mass, radius;
};

static int pair_of(const struct dem *dem, const struct contact_partners *e)
{
    return e->first * dem->n_material + (e->second < 0 ? e->first : e->second);
}

// Two springs in series, exactly half for two equal ones. A rigid wall leaves the
// grain's.
static double in_series(double a, double b, bool rigid)
{
    if (rigid) return a;
    return a == b ? 0.5 * a : a * b / (a + b);
}

// [K 4.22, 4.27-4.30]: c = 2 zeta sqrt(m k), with the mean of the two damping ratios.
static struct contact_law linear_law(const struct dem *dem,
                                     const struct contact_partners *e)
{
    const bool rigid = e->second < 0;
    const struct material *a = &dem->material[e->first];
    const struct material *b = rigid ? a : &dem->material[e->second];
    const double normal = in_series(a->normal_stiffness, b->normal_stiffness, rigid);
    const double shear = in_series(a->shear_stiffness, b->shear_stiffness, rigid);
    const double ratio = 0.5 * (a->damping_ratio + b->damping_ratio);
    const double root = sqrt(e->mass);
    return (struct contact_law){.normal_stiffness = normal,
                                .shear_stiffness = shear,
                                .normal_damping = 2 * ratio * sqrt(normal) * root,
                                .shear_damping = 2 * ratio * sqrt(shear) * root};
}

// [G 2]: k_n = m (pi^2 + ln^2 e) / t_c^2, c_n = -2 m ln e / t_c, and 2/7 of each
// across.
static struct contact_law timed_law(const struct dem *dem,
                                    const struct contact_partners *e)
{
    const double logarithm = log(dem->pair_restitution[pair_of(dem, e)]);
    const double t = dem->contact_time;
    const double normal = e->mass * (M_PI * M_PI + logarithm * logarithm) / (t * t);
    const double damping = -2 * e->mass * logarithm / t;
    return (struct contact_law){.normal_stiffness = normal,
                                .shear_stiffness = 2.0 / 7 * normal,
                                .normal_damping = damping,
                                .shear_damping = 2.0 / 7 * damping};
}

// (1 - nu^2)/E and (2 - nu)(1 + nu)/E: what each body adds to 1/E* and to 1/(2 G*) [K
// 4.23 has the same law in other words].
double plane_strain_compliance(const struct material *m)
{
    return (1 - m->poisson_ratio * m->poisson_ratio) / m->young_modulus;
}

static double shear_compliance(const struct material *m)
{
    return (2 - m->poisson_ratio) * (1 + m->poisson_ratio) / m->young_modulus;
}

// k = 4/3 E* sqrt(R*), shear stiffness 8 G* sqrt(R* U), and damping to a restitution
// that no speed changes (Tsuji 1992; the factor sqrt(5/6) of Antypov & Elliott 2011).
static struct contact_law hertz_law(const struct dem *dem,
                                    const struct contact_partners *e)
{
    const bool rigid = e->second < 0;
    const struct material *a = &dem->material[e->first];
    const struct material *b = rigid ? a : &dem->material[e->second];
    const double normal =
        1 / (plane_strain_compliance(a) + (rigid ? 0 : plane_strain_compliance(b)));
    const double shear =
        1 / (2 * (shear_compliance(a) + (rigid ? 0 : shear_compliance(b))));
    const double root = sqrt(e->radius);
    const double logarithm = log(dem->pair_restitution[pair_of(dem, e)]);
    const double share = -logarithm / sqrt(M_PI * M_PI + logarithm * logarithm);
    const double damping = 2 * sqrt(5.0 / 6) * share;
    const double tangent = 2 * normal * root, across = 8 * shear * root;
    return (struct contact_law){.normal_stiffness = 4.0 / 3 * normal * root,
                                .shear_stiffness = across,
                                .normal_damping = damping * sqrt(tangent * e->mass),
                                .shear_damping = damping * sqrt(across * e->mass)};
}

static struct contact_law contact_law_between(const struct dem *dem,
                                              const struct contact_partners *e)
{
    struct contact_law law = dem->kind == DEM_HERTZ   ? hertz_law(dem, e)
                             : dem->kind == DEM_TIMED ? timed_law(dem, e)
                                                      : linear_law(dem, e);
    law.friction = dem->pair_friction[pair_of(dem, e)];
    return law;
}

struct contact_law pair_law(const struct dem *dem, int i, int j)
{
    const double mi = dem->mass[i], mj = dem->mass[j];
    const double ri = dem->place[i].radius, rj = dem->place[j].radius;
    const struct contact_partners e = {dem->material_of[i], dem->material_of[j],
                                       mi * mj / (mi + mj), ri * rj / (ri + rj)};
    return contact_law_between(dem, &e);
}

struct contact_law common_law(const struct dem *dem)
{
    const double factor = dem->inertia_factor ? dem->inertia_factor[0] : 1;
    const double mass = dem->mass[0] / factor, radius = dem->place[0].radius;
    const struct contact_partners e = {dem->material_of[0], dem->material_of[0],
                                       mass * mass / (mass + mass),
                                       radius * radius / (radius + radius)};
    return contact_law_between(dem, &e);
}

struct contact_law wall_law(const struct dem *dem, int i, const struct dem_wall *wall)
{
    const struct contact_partners e = {dem->material_of[i],
                                       wall->elastic ? wall->material : -1,
                                       dem->mass[i], dem->place[i].radius};
    struct contact_law law = contact_law_between(dem, &e);
    if (wall->has_friction) law.friction = wall->friction;
    return law;
}

double own_mass(const struct dem *dem, int i)
{
    const double radius = dem->place[i].radius;
    return dem->material[dem->material_of[i]].density * (4.0 / 3 * M_PI) * radius *
           radius * radius;
}

static void set_mobility(struct dem *dem, int i)
{
    const double radius = dem->place[i].radius;
    dem->mobility[i][0] = 1 / dem->mass[i];
    dem->mobility[i][1] = 1 / (0.4 * dem->mass[i] * radius * radius);
}

void set_equal_mobility(struct dem *dem)
{
    dem->equal_mobility = true;
    for (int i = 1; i < dem->n_particle && dem->equal_mobility; i++)
        dem->equal_mobility = dem->mobility[i][0] == dem->mobility[0][0] &&
                              dem->mobility[i][1] == dem->mobility[0][1];
}

// Before weights are those of a fall.
static double inertia_for(const struct dem *dem, int i, double mean)
{
    const double factor = dem->inertia_factor ? dem->inertia_factor[i] : 1;
    return factor *
           (dem->density_scaling ? mean : fmax(dem->weight[i], dem->least_mass * mean));
}

void set_masses(struct dem *dem, const uint8_t *fixed)
{
    const int n = dem->n_particle;
    double sum = 0;
    dem->largest_radius = 0;
    dem->smallest_radius = INFINITY;
    for (int i = 0; i < n; i++) {
        dem->weight[i] = own_mass(dem, i);
        sum += dem->weight[i];
        dem->largest_radius = fmax(dem->largest_radius, dem->place[i].radius);
        dem->smallest_radius = fmin(dem->smallest_radius, dem->place[i].radius);
    }
    double heavy = 0;
    for (int i = 0; i < n; i++)
        heavy += inertia_for(dem, i, sum / n);
    for (int i = 0; i < n; i++) {
        const bool holds =
            fixed ? fixed[dem->id[i]]
                  : dem->mass[i] > 0 && dem->mobility[i][0] <= 0; // as it was
        dem->mass[i] = inertia_for(dem, i, sum / n);
        if (dem->falls_alike) dem->weight[i] = dem->mass[i] * (sum / heavy);
        if (holds)
            dem->mobility[i][0] = dem->mobility[i][1] = 0;
        else
            set_mobility(dem, i);
    }
    set_equal_mobility(dem);
    if (n > 0) dem->law = common_law(dem);
}

void set_external(struct dem *dem)
{
    dem->has_external = false;
    for (int i = 0; i < dem->n_particle; i++)
        for (int axis = 0; axis < 3; axis++) {
            const double external =
                (dem->applied ? component(dem->applied[i], axis) : 0) +
                dem->weight[i] * component(dem->gravity, axis);
            dem->external[i][axis] = is_driven(dem, i) ? 0 : external;
            if (dem->external[i][axis] != 0) dem->has_external = true;
        }
}
