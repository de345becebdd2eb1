// SPDX-License-Identifier: GPL-3.0-or-later
// What impacts should give: Hertz' closed forms, rigid bodies that slide throughout,
// the contact law integrated apart from the engine, and elastic spheres with partial
// slip.
#pragma once

#include "basics/memory.h"
#include "dem_impact.h"

#include <math.h>
#include <stdlib.h>

// ---- Hertz -------------------------------------------------------------------------

struct contact_numbers {
    double mass, radius;   // effective
    double modulus;        // E*
    double normal, shear;  // F = normal U^1.5, dQ = shear U^0.5 ds
    double normal_dashpot; // times U^0.25
    double shear_dashpot;  // times U^0.25
    double friction;
};

static inline struct contact_numbers contact_numbers(const struct impact *is)
{
    const struct dem_material *a = &is->material;
    const struct dem_material *b = is->other.density > 0 ? &is->other : a;
    const bool pair = is->radius[1] > 0, rigid = !pair && !is->elastic_plane;
    const double m = sphere_mass(a->density, is->radius[0]);
    const double other = sphere_mass(b->density, is->radius[1]);
    struct contact_numbers c = {.mass = pair ? m * other / (m + other) : m,
                                .radius = is->radius[0],
                                .friction = a->friction};
    if (pair) c.radius *= is->radius[1] / (is->radius[0] + is->radius[1]);
    double normal = (1 - a->poisson_ratio * a->poisson_ratio) / a->young_modulus;
    // (2 - nu) / G, of which the tangential compliance 1/(8 a) is made
    double shear =
        2 * (2 - a->poisson_ratio) * (1 + a->poisson_ratio) / a->young_modulus;
    if (!rigid) {
        normal += (1 - b->poisson_ratio * b->poisson_ratio) / b->young_modulus;
        shear += 2 * (2 - b->poisson_ratio) * (1 + b->poisson_ratio) / b->young_modulus;
    }
    c.modulus = 1 / normal;
    c.normal = 4.0 / 3 / normal * sqrt(c.radius);
    c.shear = 8 / shear * sqrt(c.radius);
    // Antypov & Elliott (2011), eq. 17: alpha = -sqrt(5) ln e / sqrt(ln^2 e + pi^2)
    const double logarithm = log(a->restitution);
    const double alpha =
        -sqrt(5) * logarithm / sqrt(logarithm * logarithm + M_PI * M_PI);
    c.normal_dashpot = alpha * sqrt(c.mass * c.normal);
    // The same share of the critical one across.
    c.shear_dashpot = alpha * sqrt(c.mass * c.shear / 1.5);
    return c;
}

static inline double hertz_overlap(const struct impact *is)
{
    const struct contact_numbers c = contact_numbers(is);
    const double v = closing_speed(is);
    return pow(15 * c.mass * v * v / (16 * c.modulus * sqrt(c.radius)), 0.4);
}

static inline double hertz_force(const struct impact *is)
{
    return contact_numbers(is).normal * pow(hertz_overlap(is), 1.5);
}

// 2 U / v times the integral of 1/sqrt(1 - x^2.5) from 0 to 1, a beta function: 2.943.
static inline double hertz_time(const struct impact *is)
{
    const double beta = exp(lgamma(0.4) + lgamma(0.5) - lgamma(0.9));
    return 2 * 0.4 * beta * hertz_overlap(is) / closing_speed(is);
}

// ---- the law of the engine, by Runge and Kutta -------------------------------------

enum { U, U_DOT, V, W, Q, STATES }; // overlap, its rate, speed across, spin, spring

struct law_motion {
    struct contact_numbers c;
    double radius, mass, inertia;
    bool feels_dashpot; // friction
    bool slips;
};

static inline double dashpot_force(const struct contact_numbers *c, const double *y)
{
    return c->normal_dashpot * pow(fmax(y[U], 0), 0.25) * y[U_DOT];
}

static inline double friction_limit(const struct law_motion *is, const double *y)
{
    const double spring = is->c.normal * pow(fmax(y[U], 0), 1.5);
    const double whole = spring + dashpot_force(&is->c, y);
    return is->c.friction * (is->feels_dashpot ? fmax(whole, 0) : spring);
}

static inline double side_force(const struct law_motion *is, const double *y)
{
    const double overlap = fmax(y[U], 0);
    if (is->slips) return copysign(friction_limit(is, y), y[Q]);
    const double surface = y[V] + (is->radius - 0.5 * overlap) * y[W];
    return y[Q] - is->c.shear_dashpot * pow(overlap, 0.25) * surface;
}

static inline void law_rates(const struct law_motion *is, const double *y, double *rate)
{
    const double overlap = fmax(y[U], 0), arm = is->radius - 0.5 * overlap; // [K 4.9]
    const double normal = is->c.normal * pow(overlap, 1.5) + dashpot_force(&is->c, y);
    const double side = side_force(is, y);
    rate[U] = y[U_DOT];
    rate[U_DOT] = -normal / is->mass;
    rate[V] = side / is->mass;
    rate[W] = arm * side / is->inertia;
    rate[Q] = -is->c.shear * sqrt(overlap) * (y[V] + arm * y[W]);
    // An opening contact loses springs, and what they held: Q falls as sqrt(U).
    if (y[U_DOT] < 0 && !is->slips) rate[Q] += 0.5 * y[Q] * y[U_DOT] / overlap;
}

static inline void take_step(const struct law_motion *is, double *y, double h)
{
    double k[4][STATES], at[STATES];
    const double shares[4] = {0, 0.5, 0.5, 1};
    for (int s = 0; s < 4; s++) {
        for (int i = 0; i < STATES; i++)
            at[i] = y[i] + (s ? h * shares[s] * k[s - 1][i] : 0);
        law_rates(is, at, k[s]);
    }
    for (int i = 0; i < STATES; i++)
        y[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
}

// A Hertz contact with a plane, in steps so fine that they do not matter. Spin is about
// the axis that adds radius times itself to the speed of the surface.
static inline struct outcome integrate_law(const struct impact *is)
{
    struct law_motion motion = {.c = contact_numbers(is),
                                .radius = is->radius[0],
                                .feels_dashpot = is->friction_feels_dashpot};
    motion.mass = sphere_mass(is->material.density, motion.radius);
    motion.inertia = 0.4 * motion.mass * motion.radius * motion.radius;
    double y[STATES] = {0, closing_speed(is), is->velocity[0].x, -is->spin[0].y, 0};
    const double h = hertz_time(is) / 40000;
    const struct contact_numbers *c = &motion.c;
    do {
        const double surface = y[V] + (motion.radius - 0.5 * y[U]) * y[W];
        const double later = fmax(y[U] + h * y[U_DOT], 0);
        const double kept = later < y[U] ? y[Q] * sqrt(later / y[U]) : y[Q];
        const double trial = kept - c->shear * sqrt(y[U]) * surface * h;
        const double then[STATES] = {later, y[U_DOT]};
        motion.slips = fabs(trial) > friction_limit(&motion, then);
        if (motion.slips) y[Q] = copysign(y[Q], trial);
        take_step(&motion, y, h);
        const double limit = friction_limit(&motion, y);
        if (motion.slips || fabs(y[Q]) > limit) y[Q] = copysign(limit, y[Q]);
    } while (y[U] > 0);
    return (struct outcome){.velocity[0] = {y[V], 0, -y[U_DOT]},
                            .spin[0] = {0, -y[W], 0}};
}

// ---- elastic spheres with partial slip ---------------------------------------------

// What Maw, Barber & Fawcett (1976) solve. The traction is a superposition of full
// slips over discs (Jaeger 1994): with D(x), of size <= mu, for the disc at which the
// overlap was x,
//     Q = integral of D dF(x),    kappa s = integral of D dx,
// where s is the tangential displacement, F(x) Hertz' force and kappa the tangential
// over the normal stiffness, 2(1 - nu)/(2 - nu). The contact grows by discs that stick
// if they can; slip comes in from the edge until s is as it must be.

struct disc {
    double from, share; // overlap; D
};

struct slip_memory {
    struct disc *disc;
    int count;
    double top, sum, friction; // overlap now, integral of D dx
};

// Makes the integral TARGET by slip from the edge; what it then is, TARGET unless all
// slides.
static inline double slip_inwards(struct slip_memory *m, double target)
{
    const double missing = target - m->sum;
    const double limit = copysign(m->friction, missing);
    double left = missing, edge = m->top;
    while (m->count > 0 && fabs(left) > 0) {
        struct disc *last = &m->disc[m->count - 1];
        const double gain = (limit - last->share) * (edge - last->from);
        if (fabs(gain) >= fabs(left)) {
            edge -= left / (limit - last->share);
            left = 0;
            break;
        }
        left -= gain;
        edge = last->from;
        m->count--;
    }
    if (m->count == 0) edge = 0;
    m->disc[m->count++] = (struct disc){edge, limit};
    m->sum = target - left;
    return m->sum;
}

static inline double move_slip(struct slip_memory *m, double overlap, double target)
{
    if (overlap > m->top) {
        const double share = (target - m->sum) / (overlap - m->top);
        const bool sticks = fabs(share) <= m->friction;
        const double taken = sticks ? share : copysign(m->friction, share);
        m->disc[m->count++] = (struct disc){m->top, taken};
        m->sum += taken * (overlap - m->top);
        m->top = overlap;
        return sticks ? target : slip_inwards(m, target);
    }
    while (m->count > 0) {
        struct disc *last = &m->disc[m->count - 1];
        const double from = fmax(last->from, overlap);
        m->sum -= last->share * (m->top - from);
        m->top = from;
        if (last->from < overlap) break;
        m->count--;
    }
    return slip_inwards(m, target);
}

// The velocity of the surface after over the normal one, both over mu, when it comes in
// at PSI = tan(angle)/mu. All else scales out.
static inline double partial_slip_rebound(double psi, double poisson_ratio)
{
    const double kappa = 2 * (1 - poisson_ratio) / (2 - poisson_ratio);
    const int steps = 4000;
    const double peak = pow(1.25, 0.4), h = 3.2 * peak / steps; // m = k = v = 1
    struct slip_memory m = {.disc = NEW_ARRAY(struct disc, 2 * steps), .friction = 1};
    double overlap = 0, rate = 1, speed = psi, moved = 0;
    for (;;) {
        overlap += h * rate;
        if (overlap <= 0) break;
        moved = move_slip(&m, overlap, kappa * (moved + h * speed)) / kappa;
        double side = 0, end = overlap;
        for (int i = m.count - 1; i >= 0; i--) {
            side += m.disc[i].share * (pow(end, 1.5) - pow(m.disc[i].from, 1.5));
            end = m.disc[i].from;
        }
        rate -= h * pow(overlap, 1.5);
        speed -= h * 3.5 * side;
    }
    free(m.disc);
    return speed / -rate;
}
