// SPDX-License-Identifier: GPL-3.0-or-later
// One load after another. Unknown are the displacements u (six of each grain) and the
// history of contacts and bonds. For each load, in code order,
//     load = force - what is taken off a free body            (external_load.c)
//     balance: residual(u) = load - B^T response(B u) = 0     (the kinematics' balance)
//     the most overloaded bond breaks                         (break_bonds.c)
// until none is at its strength; then displacements are checked: small ones must stay
// below SMALL_LIMIT mean radii, and no number may be NAN.
//
// Units: length is the mean radius, stiffness the largest of a bond k^n A or a grain,
// so forces are in their product. The regularisation on the diagonal of K is 1e-9 of
// the softest pair: it makes K regular where nothing holds a grain, and matters nowhere
// else. Which kinematics there is, small or large displacements, is chosen once.
#include "quasi_static_internal.h"

#include "large/large_state.h"
#include "splitting/splitting.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdlib.h>

// ---- begin and end ------------------------------------------------------------------

static void find_units(struct quasi_static *qs)
{
    const struct packing *packing = qs->packing;
    for (int i = 0; i < packing->n_particle; i++)
        qs->length += packing->radius[i] / packing->n_particle;
    double radius = 0; // of the thickest bond
    for (int b = 0; b < packing->n_bond; b++)
        radius = fmax(radius, fmin(packing->radius[packing->bond[b][0]],
                                   packing->radius[packing->bond[b][1]]));
    radius *= qs->setup.bond.radius_fraction;
    const double glue = qs->setup.bond.kind == DEM_CONTACT_BOND
                            ? 0
                            : qs->setup.bond.normal_stiffness * M_PI * radius * radius;
    qs->stiffness = fmax(glue, qs->setup.material.normal_stiffness);
}

static double softest_pair(const struct quasi_static *qs)
{
    double least = 1;
    for (int j = 0; j < qs->n_pair; j++) {
        const double each[] = {qs->pair[j].bond_stiffness[NORMAL],
                               qs->pair[j].normal_stiffness};
        for (int k = 0; k < 2; k++)
            if (each[k] > 0) least = fmin(least, each[k]);
    }
    return least;
}

// The regularisation is much softer than any bond or contact: it makes K regular where
// nothing holds a grain, and matters nowhere else. Large displacements have dashpots of
// their own (large/implicit_dynamics.c).
static void find_diagonals(struct quasi_static *qs)
{
    const double softest = softest_pair(qs);
    qs->regularisation[0] = qs->regularisation[1] = 1e-9 * softest;
    if (!qs->setup.large_displacements) qs->grain_dashpot = 0.03 * softest;
}

// The largest force with which an overlap of the packing pushes a grain that may move,
// or a contact bond over a gap pulls it. Where loads are far smaller, or none, their
// share would be less than the rounding of what these forces leave.
static double largest_push_at_start(const struct quasi_static *qs)
{
    const double none[COMPONENTS] = {0};
    double most = 0;
    for (int j = 0; j < qs->n_pair; j++) {
        const int32_t *grain = qs->pair[j].grain;
        const bool is_held =
            qs->setup.fixed[grain[0]] && (grain[1] < 0 || qs->setup.fixed[grain[1]]);
        if (!is_held)
            most = fmax(most, fabs(pair_respond(&qs->pair[j], none).load[NORMAL]));
    }
    return most;
}

// Each pair must be near in one image only: twice the longest distance at which two
// grains are a pair, as in the engine of cycles.
static enum status check_periods(const struct packing *packing, struct reason *reason)
{
    double largest = 0;
    for (int i = 0; i < packing->n_particle; i++)
        largest = fmax(largest, packing->radius[i]);
    const double least = 2 * (1 + SEARCH_RANGE) * 2 * largest;
    for (int axis = 0; axis < 3; axis++) {
        const double period =
            component(packing->upper, axis) - component(packing->lower, axis);
        if (packing->periodic[axis] && !(period >= least))
            return refuse(reason, STATUS_BAD_DATA,
                          "periodic box is %g m along %c, needs at least %g m", period,
                          "xyz"[axis], least);
    }
    return STATUS_OK;
}

static int count_joined_pairs(const struct packing *packing)
{
    int32_t(*pair)[2] = duplicate(packing->bond, (size_t)packing->n_bond, sizeof *pair);
    int count = 0;
    if (packing->n_bond > 0)
        qsort(pair, (size_t)packing->n_bond, sizeof *pair, compare_pairs);
    for (int b = 0; b < packing->n_bond; b++)
        count += b == 0 || compare_pairs(pair[b - 1], pair[b]) != 0;
    free(pair);
    return count;
}

// A pair must have one bond at most, and a direction. The engine of cycles refuses the
// same.
static enum status check_pairs(const struct quasi_static *qs, struct reason *reason)
{
    const double *radius = qs->packing->radius;
    const int n_joined = count_joined_pairs(qs->packing);
    if (n_joined != qs->packing->n_bond)
        return refuse(reason, STATUS_BAD_DATA, "%d bonds join only %d pairs of grains",
                      qs->packing->n_bond, n_joined);
    for (int j = 0; j < qs->n_pair; j++) {
        const struct contact_pair *pair = &qs->pair[j];
        const int a = pair->grain[0], b = pair->grain[1];
        if (b < 0) continue;
        const double apart = qs->length * (pair->arm[0] + pair->arm[1]);
        if (!(apart > 1e-9 * (radius[a] + radius[b])))
            return refuse(reason, STATUS_BAD_DATA, "grains %d and %d coincide", a, b);
    }
    return STATUS_OK;
}

enum status quasi_static_create(struct quasi_static **result,
                                const struct quasi_static_setup *setup,
                                struct reason *reason)
{
    const int n = setup->packing->n_particle;
    *result = NULL;
    enum status status = check_periods(setup->packing, reason);
    if (status) return status;
    struct quasi_static *qs = NEW_ARRAY(struct quasi_static, 1);
    qs->packing = setup->packing;
    qs->setup = *setup;
    qs->n = n;
    find_units(qs);
    if (n > 0 && !(qs->stiffness > 0)) {
        free(qs);
        return refuse(reason, STATUS_BAD_DATA,
                      "neither contacts nor bonds resist: there is no equilibrium");
    }
    const struct contact_pair_setup pairs = pair_setup_of(qs);
    qs->pair = make_contact_pairs(&pairs, &qs->n_pair);
    status = check_pairs(qs, reason);
    if (status) {
        free(qs->pair);
        free(qs);
        return status;
    }
    struct displacement **const of_grains[] = {
        &qs->displacement, &qs->load, &qs->dashpot_force, &qs->residual, &qs->step,
        &qs->previous,     &qs->rhs};
    for (size_t k = 0; k < sizeof of_grains / sizeof *of_grains; k++)
        *of_grains[k] = NEW_ARRAY(struct displacement, n);
    qs->is_detached = NEW_ARRAY(bool, n);
    qs->fragments = fragments_init(n);
    if (setup->shrinks) qs->shrinkage = NEW_ARRAY(double, n);
    find_diagonals(qs);
    qs->largest_load = largest_push_at_start(qs);
    allocate_pair_arrays(qs);
    qs->may_detach = !setup->large_displacements;
    qs->kinematics = qs->may_detach ? &small_displacements : &large_displacements;
    if (setup->large_displacements) qs->large = large_state_create(qs);
    *result = qs;
    return STATUS_OK;
}

void quasi_static_free(struct quasi_static *qs)
{
    if (!qs) return;
    fragments_free(&qs->fragments);
    free_pair_arrays(qs);
    large_state_free(qs->large);
    splitting_free(qs->splitting);
    void *const owned[] = {qs->pair,          qs->displacement, qs->load,
                           qs->dashpot_force, qs->residual,     qs->step,
                           qs->previous,      qs->rhs,          qs->is_detached,
                           qs->crack,         qs->shrinkage};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free(qs);
}

// ---- one load -----------------------------------------------------------------------

static enum status refuse_numbers(int grain, struct reason *reason)
{
    return refuse(
        reason, STATUS_NOT_CONVERGED,
        "the equilibrium of grain %d cannot be computed: stiffnesses differ by too "
        "many orders of magnitude (engine=explicit solves no equations)",
        grain);
}

static enum status check_displacements(const struct quasi_static *qs,
                                       struct reason *reason)
{
    for (int i = 0; i < qs->n; i++) {
        if (qs->is_detached[i] || displacement_size(qs->displacement[i]) <= SMALL_LIMIT)
            continue;
        if (isnan(displacement_size(qs->displacement[i])))
            return refuse_numbers(i, reason);
        if (qs->large) continue;
        return refuse(
            reason, STATUS_NOT_CONVERGED,
            "grain %d moves %.3g mean radii: displacements are not small (use "
            "quasi_static.large_displacements=true, engine=explicit or stiffer bonds)",
            i, displacement_size(qs->displacement[i]));
    }
    for (int j = 0; j < qs->n_pair; j++) {
        const double *load = qs->response[j].load;
        if (!qs->pair[j].is_detached && isnan(load[0] + load[1] + load[2]))
            return refuse_numbers(qs->pair[j].grain[0], reason);
    }
    return STATUS_OK;
}

enum status quasi_static_solve(struct quasi_static *qs, const struct vector *force,
                               struct reason *reason)
{
    qs->force = force;
    qs->n_load++;
    apply_external_load(qs);
    update_load_scale(qs);
    if (qs->large) qs->large->work_spent = 0;
    qs->is_breaking = qs->is_unconverged = false;
    do {
        const enum status status = qs->kinematics->balance(qs, reason);
        if (status) return status;
    } while (break_most_overloaded(qs));
    return check_displacements(qs, reason);
}
