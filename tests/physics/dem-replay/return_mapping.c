// SPDX-License-Identifier: GPL-3.0-or-later
// One contact solved among others (return_mapping.h): each solution is an equilibrium
// by the contact law of Newton's method, whatever the local problem.
#include "quasi_static/return_mapping.h"
#include "../../random.h"
#include "../../test.h"

#include <math.h>

static double chance(uint64_t *state)
{
    return 2 * next_random(state) - 1;
}

// Softer and stiffer than the contact, and skew: shear opens it or presses it together.
static struct local_problem any_surroundings(uint64_t *state)
{
    struct local_problem s = {.load = {0}};
    const double soft = pow(10, 3 * chance(state));
    double root[3][3];
    for (int k = 0; k < 3; k++) {
        s.given[k] = chance(state);
        for (int l = 0; l < 3; l++)
            root[k][l] = chance(state);
    }
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
            for (int i = 0; i < 3; i++)
                s.compliance[k][l] += soft * root[k][i] * root[l][i];
    return s;
}

// How far X is from where its own load leads, of what that is a difference of.
static double off(const struct contact_pair *pair, const struct local_problem *s,
                  const double x[3])
{
    double deformation[COMPONENTS] = {0}, most = 0, size = 0;
    for (int k = 0; k < 3; k++)
        deformation[k] = s->from[k] + x[k];
    const struct pair_response now = pair_respond(pair, deformation);
    for (int k = 0; k < 3; k++) {
        double there = s->given[k];
        size = fmax(size, fmax(fabs(there), fabs(x[k])));
        for (int l = 0; l < 3; l++) {
            there -= s->compliance[k][l] * now.load[l];
            size = fmax(size, fabs(s->compliance[k][l] * now.load[l]));
        }
        if (!isfinite(x[k])) return INFINITY;
        most = fmax(most, fabs(there - x[k]));
    }
    return most / size;
}

TEST(what_is_found_is_an_equilibrium)
{
    uint64_t seed = 7;
    int found = 0, slips = 0;
    for (int k = 0; k < 100000; k++) {
        const struct contact_pair pair = {
            .normal_stiffness = 1,
            .shear_stiffness = 0.8,
            .friction = pow(10, chance(&seed)),
            .overlap = 0.1 * next_random(&seed),
            .contact = {.state = CONTACT_STICKING,
                        .anchor = {chance(&seed), chance(&seed)}}};
        const struct local_problem s = any_surroundings(&seed);
        double x[3] = {chance(&seed), chance(&seed), chance(&seed)};
        if (!return_map(&pair, &s, x)) continue;
        const double deformation[COMPONENTS] = {x[0], x[1], x[2]},
                     error = off(&pair, &s, x);
        slips += pair_respond(&pair, deformation).contact.state == CONTACT_SLIPPING;
        found++;
        if (!(error < 1e-5)) fail_msg("contact %d: off by %g", k, error);
    }
    assert_true(found > 90000 && slips > 10000);
}
