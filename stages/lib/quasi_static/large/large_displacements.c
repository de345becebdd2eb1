// SPDX-License-Identifier: GPL-3.0-or-later
// Large displacements: deformation in frames that turn with the pairs, so B and K
// change with the iterate u. Newton's method looks for
//     load - damping dashpot_force - B(u)^T response - (1 - s) r0 = 0,
// s the load factor and r0 the residual at the last equilibrium, with
//     K = B^T tangent B + geometric stiffness + regularisation + stabilisation.
#include "increment.h"
#include "load_stepping.h"
#include "stabilisation.h"

#include <string.h>

static void update_large_deformation(struct quasi_static *qs)
{
    struct large_state *large = qs->large;
    for (int j = 0; j < qs->n_pair; j++) {
        const int32_t *grain = qs->pair[j].grain;
        const struct vector still = {0, 0, 0};
        struct displacement by[2];
        for (int end = 0; end < 2; end++)
            if (grain[end] >= 0) by[end] = displacement_since_previous(qs, grain[end]);
        const struct vector second =
            grain[1] < 0 ? still : qs->displacement[grain[1]].translation;
        const struct pair_motion motion = {
            .start = &large->start[j],
            .previous = &large->previous[j],
            .translation = subtract(second, qs->displacement[grain[0]].translation),
            .by = {&by[0], grain[1] < 0 ? NULL : &by[1]}};
        large_deformation(&qs->pair[j], &motion, qs->deformation[j],
                          &large->current[j]);
    }
}

// B(u)^T response of pair J, on the grain at END.
static struct displacement grain_load_of(const struct quasi_static *qs, int j, int end)
{
    struct contact_pair pair = qs->pair[j];
    set_frame(&pair, &qs->large->current[j]);
    return pair_load_on_grain(&pair, end, qs->response[j].load);
}

static void subtract_large_loads(struct quasi_static *qs)
{
    update_large_deformation(qs);
    for (int j = 0; j < qs->n_pair; j++) {
        const struct contact_pair *pair = &qs->pair[j];
        qs->response[j] = pair_respond(pair, qs->deformation[j]);
        for (int end = 0; end < 2; end++)
            if (pair->grain[end] >= 0)
                displacement_subtract(&qs->residual[pair->grain[end]],
                                      grain_load_of(qs, j, end));
    }
    for (int i = 0; i < qs->n; i++)
        displacement_subtract(&qs->residual[i],
                              displacement_scaled(1 - qs->large->load_factor,
                                                  qs->large->residual_at_start[i]));
    if (qs->setup.is_free) project_rigid_load(qs);
}

static bool factor_large(struct quasi_static *qs)
{
    const double(*tangent)[COMPONENTS] = (const double(*)[COMPONENTS])qs->tangent;
    struct large_state *large = qs->large;
    large_linearise(qs);
    if (qs->setup.is_free) large->stabilisation = find_stabilisation(qs);
    const double more =
        large->stabilisation + large->mass_damping * qs->damping / (1 + qs->damping);
    const struct stiffness_terms terms = {
        .tangent = tangent,
        .geometric = large->geometric,
        .soft = {qs->regularisation[0] + more, qs->regularisation[1] + more}};
    large->is_unstable =
        !stiffness_factor(qs->matrix, &terms) || !stiffness_is_positive(qs->matrix);
    return !large->is_unstable;
}

// Dashpots have the material part of K only: the geometric part of a step is not
// theirs. Anderson acceleration takes steps of a linear iteration: none with active
// pairs.
static void adjust_large_step(struct quasi_static *qs)
{
    if (qs->damping > 0) subtract_geometric_load(qs, qs->step, qs->rhs);
    if (qs->setup.is_free) remove_rigid_motion(qs, qs->step);
    if (qs->damping > 0 ||
        (contact_solver_count(qs->contacts) > 0 && !qs->setup.is_free))
        anderson_begin(&qs->large->acceleration, 6 * qs->n);
    else
        anderson_step(&qs->large->acceleration, &qs->step[0].translation.x);
}

static void commit_frames(struct quasi_static *qs)
{
    memcpy(qs->large->previous, qs->large->current,
           (size_t)qs->n_pair * sizeof *qs->large->previous);
}

const struct kinematics large_displacements = {.subtract_internal_loads =
                                                   subtract_large_loads,
                                               .factor = factor_large,
                                               .adjust_step = adjust_large_step,
                                               .commit = commit_frames,
                                               .solve = solve_increment,
                                               .balance = step_load};
