// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method for the displacements u, with the whole tangent of contacts that
// slip: their shear follows the normal force, so it is not symmetric. Each pair has
// load l and slope S at a deformation d, which is B u, or in the first step the place
// of its contact in the splitting (a little beside B u, but its state is known there):
//     residual = load - E (u - u0) - B^T (l + S (B u - d))
//     (B^T S B + E) step = residual
// The linear equations are solved with the symmetric part of S factored, and Anderson's
// acceleration, which is GMRES here. The factor stays while this is quick.
#include "splitting_internal.h"

#include <math.h>
#include <string.h>

// Load of a pair at a deformation that is MORE than where it responded.
static void linear_load(const struct pair_response *response, const double *load,
                        const double more[COMPONENTS], double result[COMPONENTS])
{
    for (int k = 0; k < 3; k++) {
        const double *slope = response->slope[k];
        result[k] = slope[0] * more[0] + slope[1] * more[1] + slope[2] * more[2];
        result[3 + k] = response->stiffness[k] * more[3 + k];
    }
    for (int k = 0; k < COMPONENTS && load; k++)
        result[k] += load[k];
}

static double dashpot_of(const struct splitting *s, int i,
                         enum newton_dashpots dashpots)
{
    return dashpots == WITH_DASHPOTS ? s->dashpot[i] : 0;
}

static void find_residual(struct quasi_static *qs, struct splitting *s,
                          enum newton_dashpots dashpots)
{
    for (int i = 0; i < qs->n; i++) {
        const struct displacement moved =
            displacement_between(&qs->previous[i], &qs->displacement[i]);
        qs->residual[i] = qs->load[i];
        displacement_subtract(&qs->residual[i],
                              displacement_scaled(dashpot_of(s, i, dashpots), moved));
    }
    deform_pairs(qs, qs->displacement, qs->increment);
    for (int j = 0; j < qs->n_pair; j++) {
        double more[COMPONENTS], load[COMPONENTS];
        for (int k = 0; k < COMPONENTS; k++)
            more[k] = qs->increment[j][k] - qs->deformation[j][k];
        linear_load(&qs->response[j], qs->response[j].load, more, load);
        pair_subtract_load(&qs->pair[j], load, qs->residual);
    }
    for (int i = 0; i < qs->n; i++)
        if (qs->setup.fixed[i] || qs->is_detached[i]) qs->residual[i] = no_displacement;
}

static void respond(struct quasi_static *qs)
{
    for (int j = 0; j < qs->n_pair; j++)
        qs->response[j] = pair_respond(&qs->pair[j], qs->deformation[j]);
}

// ---- the linear equations -----------------------------------------------------------

static bool factor(struct quasi_static *qs, struct splitting *s,
                   enum newton_dashpots dashpots)
{
    for (int j = 0; j < qs->n_pair; j++) {
        const struct pair_response *response = &qs->response[j];
        for (int k = 0; k < 3; k++) {
            s->values[j][k] = response->slope[k][k];
            s->values[j][3 + k] = response->stiffness[k];
        }
        s->across[j] = response->slope[SHEAR][SHEAR + 1];
    }
    const struct stiffness_terms terms = {
        .tangent = (const double(*)[COMPONENTS])s->values,
        .across = s->across,
        .soft = {qs->regularisation[0], qs->regularisation[1]},
        .dashpot = dashpots == WITH_DASHPOTS ? s->dashpot : NULL};
    qs->factors++;
    return stiffness_factor(s->tangent, &terms);
}

// What STEP leaves of the residual. Grains have the regularisation of the factor, too.
static double find_left(struct quasi_static *qs, struct splitting *s,
                        enum newton_dashpots dashpots, struct displacement *left)
{
    double most = 0;
    for (int i = 0; i < qs->n; i++) {
        const double held = qs->regularisation[0] + dashpot_of(s, i, dashpots);
        left[i] = qs->residual[i];
        displacement_subtract(&left[i], displacement_scaled(held, qs->step[i]));
    }
    for (int c = 0; c < s->n_near; c++) {
        const int j = s->near[c];
        const struct contact_pair *pair = &qs->pair[j];
        const int second = pair->grain[1];
        double more[COMPONENTS], load[COMPONENTS];
        if (pair->is_detached || !(pair->is_bonded || qs->response[j].contact.state))
            continue;
        pair_deformation(pair, &qs->step[pair->grain[0]],
                         second < 0 ? NULL : &qs->step[second], more);
        linear_load(&qs->response[j], NULL, more, load);
        pair_subtract_load(pair, load, left);
    }
    for (int i = 0; i < qs->n; i++) {
        if (qs->setup.fixed[i] || qs->is_detached[i]) left[i] = no_displacement;
        const double size = displacement_size(left[i]);
        if (!(size <= most)) most = size;
    }
    return most;
}

// TURNS: how many solutions with the factor it takes. False: not found.
static bool find_step(struct quasi_static *qs, struct splitting *s,
                      enum newton_dashpots dashpots, int *turns)
{
    enum { MOST = 60 };
    const double whole = largest_residual(qs);
    const double enough = fmax(1e-4 * whole, 1e-4 * qs->tolerance_now);
    memset(qs->step, 0, (size_t)qs->n * sizeof *qs->step);
    anderson_normal_begin(&s->of_step);
    for (*turns = 0; *turns < MOST; ++*turns) {
        const double left = find_left(qs, s, dashpots, s->right);
        if (left <= enough) return true;
        if (!isfinite(left)) return false;
        stiffness_begin(s->tangent, s->right);
        stiffness_finish(s->tangent, s->part);
        anderson_normal_step(&s->of_step, &s->part[0].translation.x);
        for (int i = 0; i < qs->n; i++)
            displacement_subtract(&qs->step[i], displacement_scaled(-1, s->part[i]));
    }
    return find_left(qs, s, dashpots, s->right) < 0.1 * whole;
}

// ---- steps --------------------------------------------------------------------------

// A grain that nothing holds and that a step without dashpots takes far leaves.
static void take_step(struct quasi_static *qs, struct splitting *s,
                      enum newton_dashpots dashpots)
{
    if (dashpots == WITHOUT_DASHPOTS && detach_beyond(qs, qs->step, SMALL_LIMIT))
        s->is_split_stale = true;
    for (int i = 0; i < qs->n; i++)
        if (!qs->is_detached[i])
            displacement_subtract(&qs->displacement[i],
                                  displacement_scaled(-1, qs->step[i]));
    qs->iterations++;
}

// The first steps may leave a larger residual than there was; after that one that does
// not fall shows contacts that change to and fro.
bool coupled_newton(struct quasi_static *qs, struct splitting *s,
                    enum newton_dashpots dashpots)
{
    enum { STEPS = 10, SLOW = 16, PATIENCE = 2 };
    const double well = TARGET_FRACTION * qs->tolerance_now;
    double before = INFINITY, least = INFINITY;
    int turns = SLOW, idle = 0;
    update_deformation(qs);
    for (int c = 0; c < s->n_near; c++)
        memcpy(qs->deformation[s->near[c]], s->place[c], sizeof s->place[c]);
    respond(qs);
    for (int k = 0; k <= STEPS; k++) {
        if (add_near_pairs(qs, s)) turns = SLOW;
        find_residual(qs, s, dashpots);
        const double left = largest_residual(qs);
        if (k > 0 && left <= qs->tolerance_now &&
            (left <= well || left >= 0.1 * before))
            return true;
        idle = k > 2 && left > 0.5 * least ? idle + 1 : 0;
        if (k == STEPS || !isfinite(left) || idle == PATIENCE ||
            (k > 1 && left > 3 * qs->largest_load))
            return false;
        if (k > 0) least = fmin(least, left);
        before = left;
        if (turns >= SLOW && !factor(qs, s, dashpots)) return false;
        if (!find_step(qs, s, dashpots, &turns)) {
            if (!factor(qs, s, dashpots) || !find_step(qs, s, dashpots, &turns))
                return false;
        }
        take_step(qs, s, dashpots);
        update_deformation(qs);
        respond(qs);
    }
    return false;
}
