// SPDX-License-Identifier: GPL-3.0-or-later
// Douglas and Rachford's splitting (the alternating direction method of multipliers):
// grains move by u, contacts deform by z of their own, and springs of stiffness rho
// join both. K is of bonds and dashpots E, B maps u to the three deformations of a
// contact (normal, two shears), u0 is the last state. In the order of the code:
//     p(z) + rho z = q                                  [contact_law, closed form]
//     (K + E + rho B^T B) u = load + E u0 + B^T (rho z - p)       [one factor, one
//     solve] q <- q + rho (B u - z)                            [Anderson acceleration]
// At the fixed point B u = z and p is the force of the contact at B u. Friction is
// Coulomb's with the normal force of the same iterate. Where contacts are much stiffer
// than bonds, rho of about a bond's stiffness converges fastest: it is what a contact
// feels of the body. Sums in the order of the pairs.
// Source: Lions & Mercier 1979; for contact Tasora et al. 2021.
#include "splitting_internal.h"

#include <math.h>
#include <string.h>

void begin_splitting(struct quasi_static *qs, struct splitting *s)
{
    for (int c = 0; c < s->n_near; c++) {
        const struct contact_pair *pair = &qs->pair[s->near[c]];
        struct contact_pair contact = *pair;
        contact.is_bonded = false;
        const struct pair_response response = pair_respond(&contact, pair->deformation);
        for (int k = 0; k < 3; k++)
            s->force[3 * c + k] =
                response.load[k] + s->stiffness * pair->deformation[k];
    }
}

// Place Z and force P of the contact that springs RHO pull with Q.
static void contact_law(const struct contact_pair *pair, double rho, const double q[3],
                        double z[3], double p[3])
{
    const double along = pair->normal_stiffness, across = pair->shear_stiffness;
    for (int k = 0; k < 3; k++) {
        z[k] = q[k] / rho;
        p[k] = 0;
    }
    if (pair->is_detached || z[0] > pair->overlap) return;
    z[0] = (q[0] + along * pair->overlap) / (along + rho);
    p[0] = along * (z[0] - pair->overlap);
    if (pair->contact.state == CONTACT_OPEN) return; // closes without shear
    const double *anchor = pair->contact.anchor;
    for (int k = 0; k < 2; k++)
        p[1 + k] =
            across * ((q[1 + k] + across * anchor[k]) / (across + rho) - anchor[k]);
    const double size = sqrt(p[1] * p[1] + p[2] * p[2]);
    const double limit = -pair->friction * p[0];
    for (int k = 1; k < 3; k++) {
        if (size > limit) p[k] *= limit / size;
        z[k] = (q[k] - p[k]) / rho;
    }
}

static bool factor(struct quasi_static *qs, struct splitting *s)
{
    memset(s->values, 0, (size_t)qs->n_pair * sizeof *s->values);
    for (int c = 0; c < s->n_near; c++) {
        const struct contact_pair *pair = &qs->pair[s->near[c]];
        if (pair->is_detached) continue;
        double *tangent = s->values[s->near[c]];
        for (int k = 0; k < COMPONENTS; k++)
            tangent[k] = (pair->is_bonded ? pair->bond_stiffness[k] : 0) +
                         (k < 3 ? s->stiffness : 0);
    }
    s->is_split_stale = false;
    const struct stiffness_terms terms = {
        .tangent = (const double(*)[COMPONENTS])s->values,
        .soft = {qs->regularisation[0], qs->regularisation[1]},
        .dashpot = s->dashpot};
    return stiffness_factor(s->split, &terms);
}

static void move_contacts(struct quasi_static *qs, struct splitting *s)
{
    for (int i = 0; i < qs->n; i++) {
        s->right[i] = qs->load[i];
        displacement_subtract(&s->right[i],
                              displacement_scaled(-s->dashpot[i], qs->previous[i]));
    }
    for (int c = 0; c < s->n_near; c++) {
        const struct contact_pair *pair = &qs->pair[s->near[c]];
        double load[COMPONENTS] = {0};
        contact_law(pair, s->stiffness, s->force + (ptrdiff_t)3 * c, s->place[c], load);
        if (pair->is_detached) continue;
        for (int k = 0; k < 3; k++)
            load[k] -= s->stiffness * s->place[c][k];
        if (pair->is_bonded)
            load[NORMAL] -= pair->bond_stiffness[NORMAL] * pair->free_stretch;
        pair_subtract_load(pair, load, s->right);
    }
}

// The largest change of q is returned.
static double move_grains(struct quasi_static *qs, struct splitting *s)
{
    double most = 0;
    stiffness_begin(s->split, s->right);
    stiffness_finish(s->split, qs->displacement);
    for (int c = 0; c < s->n_near; c++) {
        const struct contact_pair *pair = &qs->pair[s->near[c]];
        double deformation[COMPONENTS];
        pair_deformation(pair, &qs->displacement[pair->grain[0]],
                         pair->grain[1] < 0 ? NULL : &qs->displacement[pair->grain[1]],
                         deformation);
        for (int k = 0; k < 3; k++) {
            const double apart = deformation[k] - s->place[c][k];
            const double change = pair->is_detached ? 0 : s->stiffness * apart;
            s->change[3 * c + k] = change;
            if (!(fabs(change) <= most)) most = fabs(change);
        }
    }
    return most;
}

bool split_contacts(struct quasi_static *qs, struct splitting *s, double enough)
{
    enum { MOST = 600 };
    if (s->is_split_stale && !factor(qs, s)) return false;
    anderson_normal_begin(&s->of_forces);
    for (int k = 0; k < MOST; k++) {
        move_contacts(qs, s);
        const double left = move_grains(qs, s);
        if (left <= enough) return true;
        if (!isfinite(left)) return false;
        anderson_normal_step(&s->of_forces, s->change);
        for (int l = 0; l < 3 * s->n_near; l++)
            s->force[l] += s->change[l];
    }
    return false;
}
