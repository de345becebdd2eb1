// SPDX-License-Identifier: GPL-3.0-or-later
// Small displacements: directions and arms are those of the packing, so B is constant
// and K changes with the state of contacts and bonds only. It is factored again when
// the contact solver has spent 16 times as many multiplications as a factor takes.
//
// A load is solved by newton_step until the largest residual is below `well`, a small
// part of the tolerance, so that the rounding of one load does not add to that of the
// next. Where no equilibrium is found, fragments that nothing holds are detached, if
// they would move beyond SMALL_LIMIT or keep a residual; each detachment begins the
// load anew, and there are at most as many as fragments.
#include "quasi_static_internal.h"
#include "splitting/splitting.h"

#include <math.h>

static void subtract_small_loads(struct quasi_static *qs)
{
    update_deformation(qs);
    for (int j = 0; j < qs->n_pair; j++) {
        qs->response[j] = pair_respond(&qs->pair[j], qs->deformation[j]);
        pair_subtract_load(&qs->pair[j], qs->response[j].load, qs->residual);
    }
}

static bool factor_small(struct quasi_static *qs)
{
    const double(*tangent)[COMPONENTS] = (const double(*)[COMPONENTS])qs->tangent;
    const double more = qs->factored_dashpot = dashpot_in_stiffness(qs);
    const struct stiffness_terms terms = {
        .tangent = tangent,
        .soft = {qs->regularisation[0] + more, qs->regularisation[1] + more}};
    return stiffness_factor(qs->matrix, &terms);
}

// To TARGET_FRACTION of the tolerance, or as far below the tolerance as steps reduce
// the residual to a tenth.
static bool solve_small(struct quasi_static *qs)
{
    enum { ROUNDS = 20 };
    update_residual(qs);
    qs->tolerance_now = qs->setup.tolerance * qs->largest_load;
    if (qs->damping > 0)
        qs->tolerance_now = fmax(qs->tolerance_now, 1e-3 * largest_residual(qs));
    const double well = (qs->damping > 0 ? 1 : TARGET_FRACTION) * qs->tolerance_now;
    if (largest_residual(qs) <= well) return true; // the load is the same
    bool is_fresh = qs->factors == 0 ||
                    qs->factored_dashpot != dashpot_in_stiffness(qs) ||
                    contact_solver_work(qs->contacts) > 16 * stiffness_work(qs->matrix);
    if (is_fresh && !factor_tangent(qs)) return false;
    double before = INFINITY;
    for (int round = 0; round < ROUNDS; round++) {
        const double left = largest_residual(qs);
        if (left <= well || (left <= qs->tolerance_now && left >= 0.1 * before))
            return true;
        before = left;
        if (newton_step(qs, &is_fresh)) continue;
        if (!frictionless_step(qs)) break;
        is_fresh = false;
    }
    update_residual(qs);
    return largest_residual(qs) <= qs->tolerance_now;
}

// Fragments that nothing holds are detached where they move far or find no rest; others
// that find none go on moving under the next load.
static enum status balance_small(struct quasi_static *qs, struct reason *reason)
{
    (void)reason;
    const double enough = qs->setup.tolerance * qs->largest_load;
    update_fragments(qs);
    bool rests;
    do {
        roll_back_state(qs);
        rests = settle(qs);
    } while (detach_beyond(qs, qs->displacement, SMALL_LIMIT) ||
             (!rests && detach_beyond(qs, qs->residual, enough)));
    if (!rests) {
        if (!qs->is_unconverged) qs->n_unconverged++;
        qs->is_unconverged = true;
        qs->last_unconverged = grain_of_largest_residual(qs);
        commit_state(qs);
    }
    return STATUS_OK;
}

const struct kinematics small_displacements = {.subtract_internal_loads =
                                                   subtract_small_loads,
                                               .factor = factor_small,
                                               .solve = solve_small,
                                               .balance = balance_small};
