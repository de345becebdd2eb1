// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium with friction by steps in time: implicit Euler steps from u0 to u with a
// dashpot E on each grain,
//     load - B^T response(B u) - E (u - u0) = 0,
// E a share of the load over a mean radius. Each step is found by the splitting, ever
// closer until Newton's method ends it. When dashpots carry little, equilibrium without
// them is sought from there; if it is found, the steps so far count as one. Else the
// step becomes history, and the next is ten times as long. Where no step is found
// (bonds that are softer than contacts by many digits), dashpots at pairs may still
// find some [viscous_relaxation.c].
//
// A fragment that nothing holds has a dashpot of its own: it lets the fragment move by
// twice what is small, so a step shows whether it comes to rest or leaves.
#include "splitting_internal.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- a step in time -----------------------------------------------------------------

static void set_dashpots(struct quasi_static *qs, struct splitting *s, double damping)
{
    const double share = 0.2; // of the largest load, for a mean radius
    const double held = share * damping * qs->largest_load;
    double *most = NEW_ARRAY(double, qs->n);
    for (int i = 0; i < qs->n; i++) {
        double *of = &most[qs->fragments.of[i]];
        *of = fmax(*of, displacement_size(qs->load[i]));
    }
    for (int i = 0; i < qs->n; i++) {
        const int of = qs->fragments.of[i];
        const double own = fmin(1, damping) * most[of] / (2 * SMALL_LIMIT);
        s->dashpot[i] = qs->fragments.is_held[of] ? held : fmax(held, own);
    }
    free(most);
    s->is_split_stale = true;
}

static double carried_by_dashpots(const struct quasi_static *qs,
                                  const struct splitting *s)
{
    double most = 0;
    for (int i = 0; i < qs->n; i++) {
        const struct displacement moved =
            displacement_between(&qs->previous[i], &qs->displacement[i]);
        if (!qs->is_detached[i])
            most = fmax(most, s->dashpot[i] * displacement_size(moved));
    }
    return most;
}

// The splitting to a thousandth of the load. Fragments that have moved far leave.
static bool split_without_loose(struct quasi_static *qs, struct splitting *s)
{
    const double rough = 1e-3 * qs->largest_load;
    do {
        if (!split_contacts(qs, s, rough)) return false;
        s->is_split_stale |= detach_beyond(qs, qs->displacement, SMALL_LIMIT);
    } while (s->is_split_stale);
    return true;
}

enum step_end { NOT_FOUND_WITH_DASHPOTS, FOUND_WITH_DASHPOTS, FOUND_EQUILIBRIUM };

static bool newton_from(struct quasi_static *qs, struct splitting *s,
                        const struct displacement *from, enum newton_dashpots dashpots)
{
    memcpy(qs->displacement, from, (size_t)qs->n * sizeof *from);
    return coupled_newton(qs, s, dashpots);
}

// Dashpots that carry less are left out at once.
static const double LITTLE = 0.03;

static enum step_end take_step(struct quasi_static *qs, struct splitting *s)
{
    enum step_end end = NOT_FOUND_WITH_DASHPOTS;
    struct displacement *at = NEW_ARRAY(struct displacement, qs->n);
    begin_splitting(qs, s);
    double enough = 1e-5 * s->change_of_load;
    bool is_sought = true, converges = split_without_loose(qs, s);
    for (int round = 0; round < 4 && converges && !end; round++, enough *= 0.1) {
        converges = split_contacts(qs, s, enough);
        memcpy(at, qs->displacement, (size_t)qs->n * sizeof *at);
        const double carried = carried_by_dashpots(qs, s);
        const bool is_near_rest = carried < LITTLE * qs->largest_load;
        if (is_sought && is_near_rest) {
            if (newton_from(qs, s, at, WITHOUT_DASHPOTS)) end = FOUND_EQUILIBRIUM;
            is_sought = false;
        }
        if (!end && newton_from(qs, s, at, WITH_DASHPOTS)) end = FOUND_WITH_DASHPOTS;
    }
    free(at);
    return end;
}

// ---- steps --------------------------------------------------------------------------

static double furthest_held(const struct quasi_static *qs)
{
    double most = 0;
    for (int i = 0; i < qs->n; i++)
        if (qs->fragments.is_held[qs->fragments.of[i]] && !qs->is_detached[i])
            most = fmax(most, displacement_size(qs->displacement[i]));
    return most;
}

// Steps become history while what is held moves little. One that takes it further does
// not: the first is shortened, later ones are lengthened until they lead to rest, or
// show that it slides without end. A load takes grains less far than a bond that
// breaks: under it the first step may be a hundred times as long, and is often the
// last.
static bool follow(struct quasi_static *qs, struct splitting *s)
{
    const double stiffest = 1e4, endless = 1; // mean radii
    double damping = qs->is_breaking ? 1 : 0.01;
    bool has_moved = false;
    for (int64_t k = 0; k < qs->setup.most_iterations && damping <= stiffest; k++) {
        set_dashpots(qs, s, damping);
        const enum step_end end = take_step(qs, s);
        const double moved = furthest_held(qs);
        if (end == FOUND_WITH_DASHPOTS && moved <= SMALL_LIMIT) {
            commit_state(qs);
            has_moved = true;
            damping /= 10;
            detach_beyond(qs, qs->displacement, SMALL_LIMIT);
        } else if (end == FOUND_WITH_DASHPOTS) {
            roll_back_state(qs);
            if (has_moved && moved > endless) return false;
            damping *= has_moved ? 0.1 : 10;
        } else if (end == NOT_FOUND_WITH_DASHPOTS) {
            roll_back_state(qs);
            damping *= 10;
        } else {
            commit_equilibrium(qs);
            return true;
        }
    }
    return false;
}

// Newton's method without the splitting is quicker where few contacts slide.
static bool few_slide(const struct quasi_static *qs)
{
    int count = 0;
    for (int j = 0; j < qs->n_pair; j++)
        count += qs->pair[j].contact.state == CONTACT_SLIPPING;
    return 12 * count < MOST_ROWS_WITH_FRICTION;
}

bool settle(struct quasi_static *qs)
{
    const bool is_for_newton = few_slide(qs);
    qs->damping = 0;
    if (is_for_newton && relax_to_equilibrium(qs)) return true;
    const bool is_relaxed = is_for_newton && !contact_solver_is_full(qs->contacts);
    if (!is_for_newton) update_residual(qs);
    if (qs->is_unconverged || !has_splitting(qs)) return false;
    qs->tolerance_now = qs->setup.tolerance * qs->largest_load;
    if (!qs->splitting) qs->splitting = splitting_create(qs);
    qs->splitting->change_of_load = fmin(largest_residual(qs), qs->largest_load);
    if (follow(qs, qs->splitting)) return true;
    roll_back_state(qs);
    if (!is_relaxed && relax_with_most_rows(qs)) return true;
    update_residual(qs);
    return false;
}
