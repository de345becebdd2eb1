// SPDX-License-Identifier: GPL-3.0-or-later
// Flow and vapour together, as a fixed point of the menisci's potentials x:
//     set_potentials   exponents and potentials of all menisci from x,
//     find_others      what all evaporate at these potentials (kelvin_menisci.h),
//     find_flow        pressures for that evaporation (viscous.h), where evaporation
//                      already responds to the pressure (kelvin_response.h),
//     mapped = x - slope unit (found - excess)    the potentials of these pressures.
// x = mapped is found by Anderson mixing, and after MIXING_ROUNDS by Newton's method
// with a Jacobian of differences (GSL). Around this, the states of the menisci are
// revised: full moving ones that would take up liquid stop, stationary ones more
// curved than their throat begin to move; at first all at once, then one by one (Murty
// 1974). The trap is a cluster where next to nothing flows: then only the mean over a
// node's menisci is determined, and how they share it is not.
#include "kelvin_viscous.h"

#include "basics/memory.h"
#include "dry/liquid/flow_solver.h"
#include "kelvin_response.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Sum of the differences between what menisci evaporate in the gas and what flows to
// them in the liquid, relative to the rate into the air.
static const double COUPLING_TOLERANCE = 1e-12;

// So many times more are accepted when mixing has not converged.
static const double TOLERANCE_SLACK = 10;

// Rounds of Anderson mixing, and in all.
enum { MIXING_ROUNDS = 60, MAX_ROUNDS = 200 };

// Relative change of a potential for a column of the Jacobian.
static const double DIFFERENCE = 1e-4;

// In the first revisions all menisci that must stop do, and those begin to move whose
// shortfall is at least BEGIN_FRACTION of the largest in their cluster; after that only
// the first of them (Murty 1974).
enum { REVISIONS_AT_ONCE = 30, MAX_REVISIONS = 200 };
static const double BEGIN_FRACTION = 0.5;

// After that a stationary meniscus may be more curved than its throat by this part:
// where next to nothing flows only the mean of a node's menisci is determined, and no
// way to share it may fit to the last digit.
static const double HYSTERESIS = 0.01;

// A meniscus that is this part more curved than its throat before the fixed point has
// converged begins to move at once.
static const double CURVATURE_MARGIN = 0.1;

struct kelvin_viscous kelvin_viscous_init(struct kelvin_menisci *kelvin,
                                          struct liquid_flow *flow)
{
    const struct network *network = flow->network;
    const int n = network->n_throat;
    struct kelvin_viscous coupling = {.kelvin = kelvin,
                                      .flow = flow,
                                      .excess = NEW_ARRAY(double, n),
                                      .waited = NEW_ARRAY(bool, n),
                                      .unit = kelvin->law.exponent_per_pressure *
                                              flow->menisci.pressure,
                                      .body = NEW_ARRAY(int, n),
                                      .x = NEW_ARRAY(double, n),
                                      .mapped = NEW_ARRAY(double, n),
                                      .lumped = NEW_ARRAY(double, n),
                                      .single = NEW_ARRAY(double, n),
                                      .anderson = anderson_init(n)};
    for (int t = 0; t < n; t++)
        coupling.excess[t] = -1;
    liquid_flow_respond(flow);
    return coupling;
}

void kelvin_viscous_free(struct kelvin_viscous *coupling)
{
    free(coupling->excess);
    free(coupling->waited);
    free(coupling->body);
    free(coupling->x);
    free(coupling->mapped);
    free(coupling->lumped);
    free(coupling->single);
    anderson_free(&coupling->anderson);
    *coupling = (struct kelvin_viscous){0};
}

void kelvin_viscous_state(struct kelvin_viscous *coupling,
                          struct checkpoint_stream *stream)
{
    stream_numbers(stream, coupling->excess, coupling->flow->network->n_throat);
    stream_flags(stream, coupling->waited, coupling->flow->network->n_throat);
    stream_long(stream, &coupling->rounds);
}

// --- menisci -----------------------------------------------------------------------

static double entry_exponent(const struct kelvin_viscous *coupling, int throat)
{
    return coupling->kelvin->law.exponent /
           coupling->flow->network->throat_radius[throat];
}

// Menisci that are new or in throats partly empty move; the others keep their state.
static void list_menisci(struct kelvin_viscous *coupling, struct occupancy *occupancy)
{
    struct kelvin_menisci *kelvin = coupling->kelvin;
    coupling->n = 0;
    for (int a = 0; a < kelvin->n; a++) {
        const int throat = kelvin->throat[a];
        if (!kelvin->flows[a]) continue;
        coupling->body[coupling->n] = a;
        coupling->x[coupling->n++] = kelvin_potential(
            &kelvin->law, entry_exponent(coupling, throat) -
                              coupling->unit * fmax(coupling->excess[throat], 0));
        coupling->flow->moving[throat] |=
            coupling->excess[throat] < 0 || !throat_is_full(occupancy, throat);
    }
}

// Which clusters (n_id) have a moving meniscus.
static bool *clusters_that_move(const struct kelvin_viscous *coupling,
                                const struct occupancy *occupancy)
{
    bool *any = NEW_ARRAY(bool, occupancy->clusters.n_id);
    for (int k = 0; k < coupling->n; k++)
        any[occupancy->clusters.of_throat[throat_of(coupling, k)]] |=
            coupling->flow->moving[throat_of(coupling, k)];
    return any;
}

// In each cluster without a moving meniscus that did not wait before, the meniscus that
// gas enters most easily begins to move.
static void begin_lone(struct kelvin_viscous *coupling, struct occupancy *occupancy)
{
    bool *any = clusters_that_move(coupling, occupancy);
    for (int k = 0; k < coupling->n; k++) {
        const int cluster = occupancy->clusters.of_throat[throat_of(coupling, k)];
        const int first = clusters_invasion_throat(&occupancy->clusters, cluster);
        if (!any[cluster] && !(coupling->waited[first]))
            coupling->flow->moving[first] = true;
    }
    free(any);
}

// Iterates may bulge, or be more curved than their throats can hold, but only so far
// that the gas is never all vapour, nor without vapour.
static void set_potentials(struct kelvin_viscous *coupling)
{
    struct kelvin_menisci *kelvin = coupling->kelvin;
    const double flattest =
        kelvin_potential(&kelvin->law, kelvin_least_exponent(&kelvin->law));
    for (int k = 0; k < coupling->n; k++) {
        const int throat = throat_of(coupling, k), a = coupling->body[k];
        const double entry = entry_exponent(coupling, throat);
        const double most = kelvin_potential(&kelvin->law, 2 * entry);
        const bool moves = coupling->flow->moving[throat];
        coupling->x[k] = fmin(fmax(coupling->x[k], flattest), most);
        kelvin->exponent[a] =
            moves ? entry
                  : fmin(kelvin_exponent_at(&kelvin->law, coupling->x[k]), 2 * entry);
        kelvin->potential[a] =
            moves ? kelvin_potential(&kelvin->law, entry) : coupling->x[k];
        coupling->x[k] = kelvin->potential[a];
        coupling->flow->excess[throat] = (entry - kelvin->exponent[a]) / coupling->unit;
    }
}

// The potential for the pressure that the flow has found, linear in the pressure.
static double potential_found(const struct kelvin_viscous *coupling, int k)
{
    const struct liquid_flow *flow = coupling->flow;
    const int throat = throat_of(coupling, k);
    if (flow->moving[throat]) return coupling->x[k];
    const double slope = kelvin_slope(&coupling->kelvin->law,
                                      coupling->kelvin->exponent[coupling->body[k]]);
    return coupling->x[k] -
           slope * coupling->unit * (flow->found[throat] - flow->excess[throat]);
}

// --- the flow ----------------------------------------------------------------------

static enum status find_flow(struct kelvin_viscous *coupling,
                             const struct occupancy *occupancy, struct losses *losses,
                             struct reason *reason)
{
    for (int k = 0; k < coupling->n; k++)
        losses->evaporation[throat_of(coupling, k)] =
            coupling->kelvin->evaporation[coupling->body[k]];
    set_responses(coupling, occupancy);
    losses->n = 0;
    const enum status status =
        liquid_flow_find(coupling->flow, occupancy, losses->evaporation, losses->loss,
                         &losses->n, reason);
    for (int k = 0; k < coupling->n; k++) {
        const int throat = throat_of(coupling, k);
        coupling->mapped[k] = potential_found(coupling, k);
        losses->evaporation[throat] = 0;
    }
    return status;
}

// --- which move --------------------------------------------------------------------

// The largest shortfall of each cluster, (n_id); the caller frees it.
static double *find_most(const struct kelvin_viscous *coupling,
                         const struct occupancy *occupancy)
{
    double *most = NEW_ARRAY(double, occupancy->clusters.n_id);
    for (int k = 0; k < coupling->n; k++) {
        const int throat = throat_of(coupling, k);
        const int cluster = occupancy->clusters.of_throat[throat];
        if (!coupling->flow->moving[throat])
            most[cluster] = fmax(most[cluster], -coupling->flow->found[throat]);
    }
    return most;
}

// Revises which menisci move. A stationary one begins to move when it is more curved
// than its throat, by the fraction FAR at least and by BEGIN_FRACTION of the largest
// shortfall in its cluster. A moving one at a full throat stops when it would take up
// more than NOISE. Returns the number of changes, at most MOST.
static int revise(struct kelvin_viscous *coupling, const struct occupancy *occupancy,
                  double far, double noise, int most)
{
    struct liquid_flow *flow = coupling->flow;
    double *worst = find_most(coupling, occupancy);
    int n = 0;
    for (int k = 0; k < coupling->n && n < most; k++) {
        const int throat = throat_of(coupling, k);
        const double found = flow->found[throat];
        const double enough =
            fmax(BEGIN_FRACTION * worst[occupancy->clusters.of_throat[throat]],
                 far * entry_exponent(coupling, throat) / coupling->unit);
        const bool changes = flow->moving[throat]
                                 ? throat_is_full(occupancy, throat) && found < -noise
                                 : found < 0 && -found >= enough;
        flow->moving[throat] ^= changes;
        n += changes;
    }
    free(worst);
    return n;
}

// --- the fixed point ---------------------------------------------------------------

static double coupling_tolerance(const struct kelvin_viscous *coupling)
{
    return fmax(COUPLING_TOLERANCE * coupling->kelvin->rate,
                coupling->kelvin->all_noise);
}

// Upper bound of the change in evaporation from x to mapped, summed over the menisci.
static double coupling_residual(const struct kelvin_viscous *coupling)
{
    double sum = 0;
    for (int k = 0; k < coupling->n; k++)
        sum += coupling->single[k] * fabs(coupling->mapped[k] - coupling->x[k]);
    return sum;
}

static enum status evaluate(struct kelvin_viscous *coupling,
                            const struct occupancy *occupancy, struct losses *losses,
                            struct reason *reason)
{
    set_potentials(coupling);
    const enum status status =
        kelvin_menisci_find_others(coupling->kelvin, occupancy, reason);
    return status ? status : find_flow(coupling, occupancy, losses, reason);
}

// MATRIX (n,n): minus the Jacobian of mapped - x for the menisci WHICH, by differences.
static enum status find_jacobian(struct kelvin_viscous *coupling,
                                 const struct occupancy *occupancy, const int *which,
                                 gsl_matrix *matrix, struct losses *losses,
                                 struct reason *reason)
{
    const size_t bytes = (size_t)coupling->n * sizeof *coupling->x, n = matrix->size1;
    double *x = NEW_ARRAY(double, coupling->n),
           *mapped = NEW_ARRAY(double, coupling->n);
    memcpy(x, coupling->x, bytes);
    memcpy(mapped, coupling->mapped, bytes);
    enum status status = STATUS_OK;
    for (size_t c = 0; c < n && !status; c++) {
        memcpy(coupling->x, x, bytes);
        coupling->x[which[c]] *= 1 - DIFFERENCE;
        const double change = coupling->x[which[c]] - x[which[c]];
        status = evaluate(coupling, occupancy, losses, reason);
        for (size_t r = 0; r < n; r++)
            gsl_matrix_set(matrix, r, c,
                           (r == c) - (coupling->mapped[which[r]] - mapped[which[r]]) /
                                          change);
    }
    memcpy(coupling->x, x, bytes);
    memcpy(coupling->mapped, mapped, bytes);
    free(mapped);
    free(x);
    return status;
}

// x += MATRIX^-1 (mapped - x).
static enum status add_step(struct kelvin_viscous *coupling, const int *which,
                            gsl_matrix *matrix, struct reason *reason)
{
    const size_t n = matrix->size1;
    gsl_vector *step = gsl_vector_alloc(n);
    gsl_permutation *order = gsl_permutation_alloc(n);
    int sign;
    for (size_t r = 0; r < n; r++)
        gsl_vector_set(step, r, coupling->mapped[which[r]] - coupling->x[which[r]]);
    gsl_linalg_LU_decomp(matrix, order, &sign);
    double least = INFINITY;
    for (size_t r = 0; r < n; r++)
        least = fmin(least, fabs(gsl_matrix_get(matrix, r, r)));
    const bool good = least > 0;
    if (good) gsl_linalg_LU_svx(matrix, order, step);
    for (size_t r = 0; good && r < n; r++)
        coupling->x[which[r]] += gsl_vector_get(step, r);
    gsl_permutation_free(order);
    gsl_vector_free(step);
    if (good) return STATUS_OK;
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "kelvin: nothing determines the pressures of %d menisci",
                  coupling->n);
}

// A Newton step. Where hardly anything flows, how the menisci of one node share its
// evaporation is nearly undetermined, and mixing does not converge.
static enum status newton_step(struct kelvin_viscous *coupling,
                               const struct occupancy *occupancy, struct losses *losses,
                               struct reason *reason)
{
    int n = 0, *which = NEW_ARRAY(int, coupling->n);
    for (int k = 0; k < coupling->n; k++)
        if (!coupling->flow->moving[throat_of(coupling, k)]) which[n++] = k;
    gsl_matrix *matrix = gsl_matrix_alloc((size_t)n, (size_t)n);
    enum status status =
        find_jacobian(coupling, occupancy, which, matrix, losses, reason);
    if (!status) status = add_step(coupling, which, matrix, reason);
    gsl_matrix_free(matrix);
    free(which);
    return status;
}

static void mix(struct kelvin_viscous *coupling)
{
    double *step = coupling->mapped;
    for (int k = 0; k < coupling->n; k++)
        step[k] -= coupling->x[k];
    anderson_step(&coupling->anderson, step);
    for (int k = 0; k < coupling->n; k++)
        coupling->x[k] += step[k];
}

// Solves the fixed point for given states of the menisci; if REVISES, states that are
// far from consistent change on the way.
static enum status solve_coupling(struct kelvin_viscous *coupling,
                                  const struct occupancy *occupancy, bool revises,
                                  struct losses *losses, struct reason *reason)
{
    struct kelvin_menisci *kelvin = coupling->kelvin;
    double apart = 0;
    int last_mixing_round = MIXING_ROUNDS;
    losses->n = 0;
    anderson_begin(&coupling->anderson, coupling->n);
    for (int round = 0; round < MAX_ROUNDS; round++) {
        enum status status = evaluate(coupling, occupancy, losses, reason);
        if (status) return status;
        apart = coupling_residual(coupling);
        if (!isfinite(apart)) break;
        const double enough = round < last_mixing_round ? 1 : TOLERANCE_SLACK;
        if (apart <= enough * coupling_tolerance(coupling)) return STATUS_OK;
        coupling->rounds++;
        const double noise = round < last_mixing_round
                                 ? kelvin->rate
                                 : coupling_tolerance(coupling) + apart;
        if (revises &&
            revise(coupling, occupancy, CURVATURE_MARGIN, noise, coupling->n) > 0) {
            anderson_begin(&coupling->anderson, coupling->n);
            last_mixing_round = round + MIXING_ROUNDS;
        }
        if (round < last_mixing_round)
            mix(coupling);
        else
            status = newton_step(coupling, occupancy, losses, reason);
        if (status) return status;
    }
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "kelvin: the evaporation of %d menisci differs from the flow to them "
                  "by %.3g of the rate into the air; the widest are driven by %.2g of "
                  "what flat ones would be",
                  coupling->n, apart / kelvin->rate, kelvin_drive(kelvin));
}

// Drops losses of full throats that are below the tolerance of the fixed point.
static void drop_noise(const struct kelvin_viscous *coupling,
                       const struct occupancy *occupancy, struct losses *losses)
{
    const double noise = coupling_tolerance(coupling);
    int n = 0;
    for (int k = 0; k < losses->n; k++)
        if (!throat_is_full(occupancy, losses->loss[k].throat) ||
            losses->loss[k].rate > noise)
            losses->loss[n++] = losses->loss[k];
    losses->n = n;
}

static void keep(struct kelvin_viscous *coupling, const struct occupancy *occupancy)
{
    bool *any = clusters_that_move(coupling, occupancy);
    for (int k = 0; k < coupling->n; k++) {
        const int throat = throat_of(coupling, k);
        coupling->excess[throat] = fmax(coupling->flow->excess[throat], 0);
        coupling->waited[throat] = !any[occupancy->clusters.of_throat[throat]];
    }
    free(any);
}

enum status kelvin_viscous_find(struct kelvin_viscous *coupling,
                                struct occupancy *occupancy, struct losses *losses,
                                struct reason *reason)
{
    kelvin_menisci_begin(coupling->kelvin, occupancy);
    list_menisci(coupling, occupancy);
    begin_lone(coupling, occupancy);
    find_response_bounds(coupling, occupancy);
    for (int round = 0; round < MAX_REVISIONS; round++) {
        const bool at_once = round < REVISIONS_AT_ONCE;
        const enum status status =
            solve_coupling(coupling, occupancy, at_once, losses, reason);
        if (status) return status;
        if (revise(coupling, occupancy, at_once ? 0 : HYSTERESIS,
                   coupling_tolerance(coupling), at_once ? coupling->n : 1) > 0)
            continue;
        keep(coupling, occupancy);
        drop_noise(coupling, occupancy, losses);
        const enum status ended =
            kelvin_menisci_end(coupling->kelvin, occupancy, losses, reason);
        losses_sort(losses);
        return ended;
    }
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "kelvin: no consistent menisci after %d rounds, among %d that flow",
                  MAX_REVISIONS, coupling->n);
}
