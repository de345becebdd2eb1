// SPDX-License-Identifier: GPL-3.0-or-later
#include "kelvin_viscous.h"

#include "basics/memory.h"
#include "dry/liquid/flow_solver.h"
#include "kelvin_response.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// What menisci evaporate in the gas and what flows to them in the liquid may differ by
// this part of the rate into the air, added up.
static const double AGREED = 1e-12;

// As many times more are enough where that is not found at once.
static const double ENOUGH = 10;

// By mixing; in all.
enum { PATIENT_ROUNDS = 60, MOST_ROUNDS = 200 };

// Part of a potential by which it is changed to see what follows.
static const double DIFFERENCE = 1e-4;

// In the first revisions all menisci that must stop do, and those begin to move that
// lack at least this part of what the worst of their cluster does; from then on only
// the first of them (Murty 1974).
enum { REVISIONS_AT_ONCE = 30, MOST_REVISIONS = 200 };
static const double BEGINNERS = 0.5;

// From then on one may stay that is more curved than its throat by this part: where
// next to nothing flows only the mean of a node's menisci is given, and none of the
// ways to share it may fit to the last digit.
static const double VERGE = 0.01;

// A meniscus on its way to be more curved than its throat by this part begins to move
// at once.
static const double FAR = 0.1;

struct kelvin_viscous kelvin_viscous_make(struct kelvin_menisci *kelvin,
                                          struct liquid_flow *flow)
{
    const struct network *network = flow->network;
    const int n = network->n_throat;
    struct kelvin_viscous both = {.kelvin = kelvin,
                                  .flow = flow,
                                  .excess = NEW_ARRAY(double, n),
                                  .waited = NEW_ARRAY(bool, n),
                                  .unit =
                                      kelvin->law.of_pressure * flow->menisci.pressure,
                                  .body = NEW_ARRAY(int, n),
                                  .x = NEW_ARRAY(double, n),
                                  .image = NEW_ARRAY(double, n),
                                  .lumped = NEW_ARRAY(double, n),
                                  .single = NEW_ARRAY(double, n),
                                  .anderson = anderson_make(n)};
    for (int t = 0; t < n; t++)
        both.excess[t] = -1;
    liquid_flow_respond(flow);
    return both;
}

void kelvin_viscous_free(struct kelvin_viscous *both)
{
    free(both->excess);
    free(both->waited);
    free(both->body);
    free(both->x);
    free(both->image);
    free(both->lumped);
    free(both->single);
    anderson_free(&both->anderson);
    *both = (struct kelvin_viscous){0};
}

void kelvin_viscous_state(struct kelvin_viscous *both, struct checkpoint_stream *stream)
{
    stream_numbers(stream, both->excess, both->flow->network->n_throat);
    stream_flags(stream, both->waited, both->flow->network->n_throat);
    stream_long(stream, &both->rounds);
}

// --- menisci -----------------------------------------------------------------------

static double entry_exponent(const struct kelvin_viscous *both, int throat)
{
    return both->kelvin->law.exponent / both->flow->network->throat_radius[throat];
}

// Those in throats partly empty move, those that are new, and else as they did.
static void list_menisci(struct kelvin_viscous *both, struct occupancy *occupancy)
{
    struct kelvin_menisci *kelvin = both->kelvin;
    both->n = 0;
    for (int a = 0; a < kelvin->n; a++) {
        const int throat = kelvin->throat[a];
        if (!kelvin->flows[a]) continue;
        both->body[both->n] = a;
        both->x[both->n++] = kelvin_potential(
            &kelvin->law,
            entry_exponent(both, throat) - both->unit * fmax(both->excess[throat], 0));
        both->flow->moving[throat] |=
            both->excess[throat] < 0 || !throat_is_full(occupancy, throat);
    }
}

// Of a cluster of which none moves and which did not wait, the one begins that gas
// enters most easily.
static void begin_lone(struct kelvin_viscous *both, struct occupancy *occupancy)
{
    bool *any = NEW_ARRAY(bool, occupancy->clusters.n_id);
    for (int k = 0; k < both->n; k++)
        any[occupancy->clusters.of_throat[throat_of(both, k)]] |=
            both->flow->moving[throat_of(both, k)];
    for (int k = 0; k < both->n; k++) {
        const int cluster = occupancy->clusters.of_throat[throat_of(both, k)];
        const int first = clusters_invasion_throat(&occupancy->clusters, cluster);
        if (!any[cluster] && !(both->waited[first])) both->flow->moving[first] = true;
    }
    free(any);
}

// On the way menisci may bulge, but not so far that the gas would be all vapour, or be
// more curved than their throats can hold, but not so that it would be dry (where
// vapour rounds to none, neither).
static void set_potentials(struct kelvin_viscous *both)
{
    struct kelvin_menisci *kelvin = both->kelvin;
    const double flattest =
        kelvin_potential(&kelvin->law, kelvin_least_exponent(&kelvin->law));
    for (int k = 0; k < both->n; k++) {
        const int throat = throat_of(both, k), a = both->body[k];
        const double entry = entry_exponent(both, throat);
        const double most = kelvin_potential(&kelvin->law, 2 * entry);
        const bool moves = both->flow->moving[throat];
        both->x[k] = fmin(fmax(both->x[k], flattest), most);
        kelvin->exponent[a] =
            moves ? entry
                  : fmin(kelvin_exponent_at(&kelvin->law, both->x[k]), 2 * entry);
        kelvin->potential[a] =
            moves ? kelvin_potential(&kelvin->law, entry) : both->x[k];
        both->x[k] = kelvin->potential[a];
        both->flow->excess[throat] = (entry - kelvin->exponent[a]) / both->unit;
    }
}

// The flow's answer, by the slope of the potential.
static double potential_found(const struct kelvin_viscous *both, int k)
{
    const struct liquid_flow *flow = both->flow;
    const int throat = throat_of(both, k);
    if (flow->moving[throat]) return both->x[k];
    const double slope =
        kelvin_slope(&both->kelvin->law, both->kelvin->exponent[both->body[k]]);
    return both->x[k] -
           slope * both->unit * (flow->found[throat] - flow->excess[throat]);
}

// --- the flow ----------------------------------------------------------------------

static enum status find_flow(struct kelvin_viscous *both,
                             const struct occupancy *occupancy, struct losses *losses,
                             struct reason *reason)
{
    for (int k = 0; k < both->n; k++)
        losses->charge[throat_of(both, k)] = both->kelvin->gain[both->body[k]];
    set_responses(both, occupancy);
    losses->n = 0;
    const enum status status = liquid_flow_find(both->flow, occupancy, losses->charge,
                                                losses->loss, &losses->n, reason);
    for (int k = 0; k < both->n; k++) {
        const int throat = throat_of(both, k);
        both->image[k] = potential_found(both, k);
        losses->charge[throat] = 0;
    }
    return status;
}

// --- which move --------------------------------------------------------------------

// The largest lack of each cluster.
static double *find_most(const struct kelvin_viscous *both,
                         const struct occupancy *occupancy)
{
    double *most = NEW_ARRAY(double, occupancy->clusters.n_id);
    for (int k = 0; k < both->n; k++) {
        const int throat = throat_of(both, k);
        const int cluster = occupancy->clusters.of_throat[throat];
        if (!both->flow->moving[throat])
            most[cluster] = fmax(most[cluster], -both->flow->found[throat]);
    }
    return most;
}

// Those begin to move that are more curved than their throats by FAR of it, and nearly
// the most of their cluster; those stop that take up more than NOISE, full. Returns how
// many; no more than MOST.
static int revise(struct kelvin_viscous *both, const struct occupancy *occupancy,
                  double far, double noise, int most)
{
    struct liquid_flow *flow = both->flow;
    double *worst = find_most(both, occupancy);
    int n = 0;
    for (int k = 0; k < both->n && n < most; k++) {
        const int throat = throat_of(both, k);
        const double found = flow->found[throat];
        const double enough =
            fmax(BEGINNERS * worst[occupancy->clusters.of_throat[throat]],
                 far * entry_exponent(both, throat) / both->unit);
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

static double agreement(const struct kelvin_viscous *both)
{
    return fmax(AGREED * both->kelvin->rate, both->kelvin->all_noise);
}

// No less than what evaporates would change by, added up.
static double disagreement(const struct kelvin_viscous *both)
{
    double sum = 0;
    for (int k = 0; k < both->n; k++)
        sum += both->single[k] * fabs(both->image[k] - both->x[k]);
    return sum;
}

static enum status find_image(struct kelvin_viscous *both,
                              const struct occupancy *occupancy, struct losses *losses,
                              struct reason *reason)
{
    set_potentials(both);
    const enum status status =
        kelvin_menisci_find_others(both->kelvin, occupancy, reason);
    return status ? status : find_flow(both, occupancy, losses, reason);
}

// How image less x of those menisci falls, in MATRIX (n,n), by differences.
static enum status find_slopes(struct kelvin_viscous *both,
                               const struct occupancy *occupancy, const int *which,
                               gsl_matrix *matrix, struct losses *losses,
                               struct reason *reason)
{
    const size_t bytes = (size_t)both->n * sizeof *both->x, n = matrix->size1;
    double *x = NEW_ARRAY(double, both->n), *image = NEW_ARRAY(double, both->n);
    memcpy(x, both->x, bytes);
    memcpy(image, both->image, bytes);
    enum status status = STATUS_OK;
    for (size_t c = 0; c < n && !status; c++) {
        memcpy(both->x, x, bytes);
        both->x[which[c]] *= 1 - DIFFERENCE;
        const double change = both->x[which[c]] - x[which[c]];
        status = find_image(both, occupancy, losses, reason);
        for (size_t r = 0; r < n; r++)
            gsl_matrix_set(matrix, r, c,
                           (r == c) -
                               (both->image[which[r]] - image[which[r]]) / change);
    }
    memcpy(both->x, x, bytes);
    memcpy(both->image, image, bytes);
    free(image);
    free(x);
    return status;
}

// X + MATRIX^-1 (image - x).
static enum status add_step(struct kelvin_viscous *both, const int *which,
                            gsl_matrix *matrix, struct reason *reason)
{
    const size_t n = matrix->size1;
    gsl_vector *step = gsl_vector_alloc(n);
    gsl_permutation *order = gsl_permutation_alloc(n);
    int sign;
    for (size_t r = 0; r < n; r++)
        gsl_vector_set(step, r, both->image[which[r]] - both->x[which[r]]);
    gsl_linalg_LU_decomp(matrix, order, &sign);
    double least = INFINITY;
    for (size_t r = 0; r < n; r++)
        least = fmin(least, fabs(gsl_matrix_get(matrix, r, r)));
    const bool good = least > 0;
    if (good) gsl_linalg_LU_svx(matrix, order, step);
    for (size_t r = 0; good && r < n; r++)
        both->x[which[r]] += gsl_vector_get(step, r);
    gsl_permutation_free(order);
    gsl_vector_free(step);
    if (good) return STATUS_OK;
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "kelvin: nothing determines the pressures of %d menisci", both->n);
}

// Newton's: where hardly anything flows, menisci of one node may share what it has in
// nearly any way, and mixing does not find which.
static enum status newton_step(struct kelvin_viscous *both,
                               const struct occupancy *occupancy, struct losses *losses,
                               struct reason *reason)
{
    int n = 0, *which = NEW_ARRAY(int, both->n);
    for (int k = 0; k < both->n; k++)
        if (!both->flow->moving[throat_of(both, k)]) which[n++] = k;
    gsl_matrix *matrix = gsl_matrix_alloc((size_t)n, (size_t)n);
    enum status status = find_slopes(both, occupancy, which, matrix, losses, reason);
    if (!status) status = add_step(both, which, matrix, reason);
    gsl_matrix_free(matrix);
    free(which);
    return status;
}

static void mix(struct kelvin_viscous *both)
{
    double *step = both->image;
    for (int k = 0; k < both->n; k++)
        step[k] -= both->x[k];
    anderson_step(&both->anderson, step);
    for (int k = 0; k < both->n; k++)
        both->x[k] += step[k];
}

// For menisci of which it is known which move, but for those that are far from it.
static enum status find_both(struct kelvin_viscous *both,
                             const struct occupancy *occupancy, bool revises,
                             struct losses *losses, struct reason *reason)
{
    struct kelvin_menisci *kelvin = both->kelvin;
    double apart = 0;
    int patience = PATIENT_ROUNDS;
    losses->n = 0;
    anderson_begin(&both->anderson, both->n);
    for (int round = 0; round < MOST_ROUNDS; round++) {
        enum status status = find_image(both, occupancy, losses, reason);
        if (status) return status;
        apart = disagreement(both);
        if (!isfinite(apart)) break;
        const double enough = round < patience ? 1 : ENOUGH;
        if (apart <= enough * agreement(both)) return STATUS_OK;
        both->rounds++;
        const double noise = round < patience ? kelvin->rate : agreement(both) + apart;
        if (revises && revise(both, occupancy, FAR, noise, both->n) > 0) {
            anderson_begin(&both->anderson, both->n);
            patience = round + PATIENT_ROUNDS;
        }
        if (round < patience)
            mix(both);
        else
            status = newton_step(both, occupancy, losses, reason);
        if (status) return status;
    }
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "kelvin: the evaporation of %d menisci differs from the flow to them "
                  "by %.3g of the rate into the air; the widest are driven by %.2g of "
                  "what flat ones would be",
                  both->n, apart / kelvin->rate, kelvin_drive(kelvin));
}

// A full throat that loses no more than the rate is agreed to loses nothing.
static void drop_noise(const struct kelvin_viscous *both,
                       const struct occupancy *occupancy, struct losses *losses)
{
    const double noise = agreement(both);
    int n = 0;
    for (int k = 0; k < losses->n; k++)
        if (!throat_is_full(occupancy, losses->loss[k].throat) ||
            losses->loss[k].rate > noise)
            losses->loss[n++] = losses->loss[k];
    losses->n = n;
}

static void keep(struct kelvin_viscous *both, const struct occupancy *occupancy)
{
    bool *any = NEW_ARRAY(bool, occupancy->clusters.n_id);
    for (int k = 0; k < both->n; k++)
        any[occupancy->clusters.of_throat[throat_of(both, k)]] |=
            both->flow->moving[throat_of(both, k)];
    for (int k = 0; k < both->n; k++) {
        const int throat = throat_of(both, k);
        both->excess[throat] = fmax(both->flow->excess[throat], 0);
        both->waited[throat] = !any[occupancy->clusters.of_throat[throat]];
    }
    free(any);
}

enum status kelvin_viscous_find(struct kelvin_viscous *both,
                                struct occupancy *occupancy, struct losses *losses,
                                struct reason *reason)
{
    kelvin_menisci_begin(both->kelvin, occupancy);
    list_menisci(both, occupancy);
    begin_lone(both, occupancy);
    find_drops(both, occupancy);
    for (int round = 0; round < MOST_REVISIONS; round++) {
        const bool at_once = round < REVISIONS_AT_ONCE;
        const enum status status = find_both(both, occupancy, at_once, losses, reason);
        if (status) return status;
        if (revise(both, occupancy, at_once ? 0 : VERGE, agreement(both),
                   at_once ? both->n : 1) > 0)
            continue;
        keep(both, occupancy);
        drop_noise(both, occupancy, losses);
        const enum status ended =
            kelvin_menisci_end(both->kelvin, occupancy, losses, reason);
        losses_sort(losses);
        return ended;
    }
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "kelvin: no consistent menisci after %d rounds, among %d that flow",
                  MOST_REVISIONS, both->n);
}
