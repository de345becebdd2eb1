// SPDX-License-Identifier: GPL-3.0-or-later
// Which menisci move, cluster by cluster [K 3.10]. For given moving menisci the
// potentials p solve node balances with
//     p = entry potential                    at a moving meniscus (first kind),
//     inflow = evaporation                   at a stationary one (second kind),
// and the states must be consistent:
//     p behind a stationary meniscus >= its entry potential   (else it begins to move),
//     inflow <= evaporation in a full throat that moves       (else it stops).
// This is an obstacle problem with an M-matrix: revising states in this order raises
// pressures only, so it ends. loss = evaporation - inflow, negative where a throat
// refills. Many clusters need no solution: if all that evaporates, through all throats
// in series, drops the potential by less than the margin between the two easiest
// menisci, only the easiest one moves (only_one_moves).
#include "viscous.h"

#include "basics/memory.h"
#include "cluster_flow.h"
#include "kept_flow.h"
#include "losses.h"

#include <math.h>
#include <stdlib.h>

// Rounds in which the states of menisci are found. From the second on no meniscus
// changes back, so this is far more than any network needs.
enum { MAX_ROUNDS = 200 };

// In the first rounds only menisci begin to move whose shortfall is at least this part
// of the largest; after that all that must, as when a viscous cluster begins to dry.
enum { SELECTIVE_ROUNDS = 20 };
static const double BEGIN_FRACTION = 0.5;

// Where a flow is kept, rounds that change menisci need not find it better.
static const double ROUGH_TARGET = 1e-3;

struct liquid_flow liquid_flow_init(const struct occupancy *occupancy, double length,
                                    double step, struct menisci menisci)
{
    const struct network *network = occupancy->network;
    struct liquid_flow flow = {.network = network,
                               .menisci = menisci,
                               .step = step,
                               .conductance = NEW_ARRAY(double, network->n_throat),
                               .resistance = NEW_ARRAY(double, network->n_throat),
                               .moving = NEW_ARRAY(bool, network->n_throat),
                               .pressure = NEW_ARRAY(double, network->n_node),
                               .solver = flow_solver_create(occupancy)};
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        flow.conductance[t] = hydraulic_conductance(network, t, length);
        flow.resistance[t] = 1 / flow.conductance[t];
    }
    return flow;
}

void liquid_flow_follow(struct liquid_flow *flow, const struct occupancy *occupancy,
                        int throat)
{
    flow->moving[throat] = false;
    flow_solver_follow(flow->solver, occupancy, throat);
}

void liquid_flow_free(struct liquid_flow *flow)
{
    flow_solver_free(flow->solver);
    menisci_free(&flow->menisci);
    free(flow->conductance);
    free(flow->resistance);
    free(flow->moving);
    free(flow->response);
    free(flow->excess);
    free(flow->found);
    free(flow->pressure);
    *flow = (struct liquid_flow){0};
}

void liquid_flow_respond(struct liquid_flow *flow)
{
    flow->response = NEW_ARRAY(double, flow->network->n_throat);
    flow->excess = NEW_ARRAY(double, flow->network->n_throat);
    flow->found = NEW_ARRAY(double, flow->network->n_throat);
}

// --- the menisci ---------------------------------------------------------------------

static bool is_full(const struct liquid_flow *flow, int throat)
{
    return throat_is_full(flow->solver->occupancy, throat);
}

// Potential at which the meniscus of THROAT moves.
static double entry(const struct liquid_flow *flow,
                    const struct cluster_problem *problem, int throat)
{
    return menisci_potential(&flow->menisci, throat, problem->reference);
}

// Potential behind a stationary meniscus: mean of its ends, less the drop in its
// throat.
static double potential_at_mouth(const struct liquid_flow *flow,
                                 const struct cluster_problem *problem, int throat)
{
    int n;
    const double mean = potential_of_ends(flow, problem->cluster, throat, &n);
    const double arm = n * meniscus_arm(flow, throat, n);
    const double alone = mean - flow->solver->evaporation[throat] / arm;
    if (!flow->response) return alone;
    const double part = flow->response[throat] / arm;
    return (alone + part * end_potential(flow, throat, problem->reference)) /
           (1 + part);
}

// Whether more flows to a full throat than evaporates, but for rounding.
static bool must_stop(const struct liquid_flow *flow,
                      const struct cluster_problem *problem, int throat)
{
    return is_full(flow, throat) &&
           flow->solver->evaporation[throat] - flow->solver->inflow[throat] <
               -problem->target * problem->flow;
}

// Initial guess: menisci that moved before, those in throats partly empty, and if there
// is none, the one that gas enters most easily.
static void start_menisci(struct liquid_flow *flow,
                          const struct cluster_problem *problem)
{
    bool any = false;
    for (int t = first_meniscus(flow, problem); t >= 0; t = next_throat(flow, t)) {
        flow->moving[t] |= !is_full(flow, t);
        any |= flow->moving[t];
    }
    if (!any) flow->moving[problem->reference] = true;
}

// How far the potential behind a meniscus that stays is below that at which it moves.
static double shortfall(const struct liquid_flow *flow,
                        const struct cluster_problem *problem, int throat)
{
    return entry(flow, problem, throat) - potential_at_mouth(flow, problem, throat);
}

// Stops all menisci that must stop, and starts those that fall short most: this raises
// the pressure behind the others. Returns how many have changed.
static int revise_menisci(struct liquid_flow *flow,
                          const struct cluster_problem *problem, double begin_fraction)
{
    int n = 0;
    double most = 0;
    for (int t = first_meniscus(flow, problem); t >= 0; t = next_throat(flow, t)) {
        if (!flow->moving[t]) {
            most = fmax(most, shortfall(flow, problem, t));
        } else if (must_stop(flow, problem, t)) {
            flow->moving[t] = false;
            n++;
        }
    }
    for (int t = first_meniscus(flow, problem); most > 0 && t >= 0;
         t = next_throat(flow, t)) {
        const double residual = flow->moving[t] ? 0 : shortfall(flow, problem, t);
        if (!(residual > 0 && residual >= begin_fraction * most)) continue;
        flow->moving[t] = true;
        n++;
    }
    return n;
}

static enum status find_menisci(struct liquid_flow *flow,
                                struct cluster_problem *problem, struct reason *reason)
{
    start_menisci(flow, problem);
    problem->target = fmax(ROUGH_TARGET * (flow->step > 0), flow_target(flow));
    for (int round = 0; round < MAX_ROUNDS; round++) {
        const enum status status = cluster_flow_solve(flow, problem, reason);
        if (status) return status;
        flow->rounds++;
        const double begin_fraction = round < SELECTIVE_ROUNDS ? BEGIN_FRACTION : 0;
        if (revise_menisci(flow, problem, begin_fraction) > 0) continue;
        if (fmin(problem->target, problem->error) <= flow_target(flow)) {
            flow->residual = fmax(flow->residual, problem->error);
            return STATUS_OK;
        }
        problem->target = flow_target(flow);
    }
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "no consistent menisci after %d rounds in a cluster of %d throats",
                  MAX_ROUNDS, problem->n_throat);
}

// --- one cluster ---------------------------------------------------------------------

static void add_loss(struct loss *loss, int *n_loss, int throat, double rate)
{
    if (rate != 0) loss[(*n_loss)++] = (struct loss){throat, rate};
}

// Losses of the moving menisci. The largest takes up the error of the balances, so that
// a cluster loses exactly what it evaporates.
static void collect_losses(const struct liquid_flow *flow,
                           const struct cluster_problem *problem, struct loss *loss,
                           int *n_loss)
{
    const int first = *n_loss;
    int largest = first;
    double sum = 0;
    for (int t = first_meniscus(flow, problem); t >= 0; t = next_throat(flow, t)) {
        if (!flow->moving[t]) continue;
        double rate = flow->solver->evaporation[t] - flow->solver->inflow[t];
        if (is_full(flow, t)) rate = fmax(rate, 0);
        add_loss(loss, n_loss, t, rate);
        sum += rate;
    }
    for (int k = first; k < *n_loss; k++)
        if (fabs(loss[k].rate) > fabs(loss[largest].rate)) largest = k;
    if (*n_loss == first + 1)
        loss[first].rate = fmax(problem->evaporation,
                                is_full(flow, loss[first].throat) ? 0 : -INFINITY);
    else if (*n_loss > first)
        loss[largest].rate += problem->evaporation - sum;
}

// Pressures at the nodes, relative to the gas. AT_REST: nothing flows, and the pressure
// is that at which gas enters the reference throat.
static void write_pressures(struct liquid_flow *flow,
                            const struct cluster_problem *problem, bool at_rest)
{
    const struct menisci *menisci = &flow->menisci;
    const double reference = -menisci->tension / menisci->radius[problem->reference];
    list_nodes(flow, problem);
    for (int k = 0; k < flow->solver->n_node; k++) {
        const int node = flow->solver->node[k];
        const double above =
            at_rest ? 0 : node_potential(flow->solver, problem->cluster, node);
        flow->pressure[node] =
            reference + above + menisci_weight(menisci, problem->reference, node);
    }
}

// Counts menisci, and those in throats partly empty; finds the two easiest to enter.
static void count_menisci(const struct liquid_flow *flow,
                          struct cluster_problem *problem)
{
    int second = -1;
    for (int t = first_meniscus(flow, problem); t >= 0; t = next_throat(flow, t)) {
        problem->n_partial += !is_full(flow, t);
        problem->evaporation += flow->solver->evaporation[t];
        problem->turnover += fabs(flow->solver->evaporation[t]);
        if (problem->n_meniscus++ == 0) {
            problem->reference = t;
        } else if (entry(flow, problem, t) > 0) {
            second = problem->reference;
            problem->reference = t;
        } else if (second < 0 ||
                   entry(flow, problem, t) > entry(flow, problem, second)) {
            second = t;
        }
    }
    if (second >= 0) problem->margin = -entry(flow, problem, second);
}

// Upper bound of the resistance of any path: all throats in series. Throats only leave
// a cluster, so an older value is still a bound.
static double resistance_of(struct liquid_flow *flow,
                            const struct cluster_problem *problem)
{
    struct flow_solver *solver = flow->solver;
    struct cluster_memory *memory = &solver->cluster[problem->cluster];
    if (memory->size > 0 && problem->n_throat > 0.8 * memory->size)
        return memory->resistance;
    memory->size = problem->n_throat;
    memory->resistance = 0;
    for (enum throat_list l = 0; l < LISTS; l++)
        for (int t = first_throat(solver, problem, l); t >= 0; t = next_throat(flow, t))
            memory->resistance += flow->resistance[t];
    return memory->resistance;
}

// Whether a throat is partly empty that gas does not enter most easily. It refills from
// the one that gas does, even where nothing evaporates.
static bool others_are_partial(const struct liquid_flow *flow,
                               const struct cluster_problem *problem)
{
    return problem->n_partial > !is_full(flow, problem->reference);
}

// Whether only the easiest meniscus can move: along any path the potential drops by
// less than its margin over the next.
static bool only_one_moves(struct liquid_flow *flow,
                           const struct cluster_problem *problem)
{
    if (problem->n_meniscus == 1) return true;
    if (others_are_partial(flow, problem)) return false;
    return problem->evaporation * resistance_of(flow, problem) < problem->margin;
}

static void move_reference(struct liquid_flow *flow,
                           const struct cluster_problem *problem)
{
    for (int t = first_meniscus(flow, problem); t >= 0; t = next_throat(flow, t))
        flow->moving[t] = false;
    flow->moving[problem->reference] = true;
}

// Where vapour responds: results for each meniscus, and what the cluster evaporates.
static void keep_menisci(struct liquid_flow *flow, struct cluster_problem *problem)
{
    const struct flow_solver *solver = flow->solver;
    problem->evaporation = 0;
    for (int t = first_meniscus(flow, problem); t >= 0; t = next_throat(flow, t)) {
        const bool responds = !flow->moving[t] && flow->response[t] > 0;
        flow->found[t] = flow->moving[t] ? solver->evaporation[t] - solver->inflow[t]
                                         : -shortfall(flow, problem, t);
        problem->evaporation += responds ? solver->inflow[t] : solver->evaporation[t];
    }
}

// Whether none of its menisci moves and no vapour gets to or from them.
static bool is_shut_in(const struct liquid_flow *flow,
                       const struct cluster_problem *problem)
{
    for (int t = first_meniscus(flow, problem); t >= 0; t = next_throat(flow, t))
        if (flow->moving[t] || flow->response[t] > 0) return false;
    return true;
}

static void keep_as_is(struct liquid_flow *flow, const struct cluster_problem *problem)
{
    for (int t = first_meniscus(flow, problem); t >= 0; t = next_throat(flow, t))
        flow->found[t] = flow->excess[t];
}

// Where vapour responds: solves for the menisci states that are given.
static enum status find_given(struct liquid_flow *flow, struct cluster_problem *problem,
                              struct loss *loss, int *n_loss, struct reason *reason)
{
    if (problem->n_throat == 1) return STATUS_OK;
    count_menisci(flow, problem);
    if (is_shut_in(flow, problem)) {
        keep_as_is(flow, problem);
        return STATUS_OK;
    }
    const enum status status = cluster_flow_solve(flow, problem, reason);
    if (status) return status;
    flow->residual = fmax(flow->residual, problem->error);
    keep_menisci(flow, problem);
    collect_losses(flow, problem, loss, n_loss);
    if (flow->wants_pressures) write_pressures(flow, problem, false);
    flow->solutions++;
    flow->rounds++;
    return STATUS_OK;
}

static enum status find_losses(struct liquid_flow *flow,
                               struct cluster_problem *problem, struct loss *loss,
                               int *n_loss, struct reason *reason)
{
    if (flow->response) return find_given(flow, problem, loss, n_loss, reason);
    flow->solver->cluster[problem->cluster].liquid = 0; // of a flow that was kept
    count_menisci(flow, problem);
    if (!(problem->turnover > 0) && !others_are_partial(flow, problem)) {
        if (flow->wants_pressures) write_pressures(flow, problem, true);
        return STATUS_OK;
    }
    const bool decided = only_one_moves(flow, problem);
    if (decided && (problem->n_throat == 1 || !flow->wants_pressures)) {
        move_reference(flow, problem);
        add_loss(loss, n_loss, problem->reference, problem->evaporation);
        return STATUS_OK;
    }
    const enum status status = find_menisci(flow, problem, reason);
    if (status) return status;
    if (flow->step > 0) kept_flow_note(flow, problem);
    collect_losses(flow, problem, loss, n_loss);
    if (flow->wants_pressures) write_pressures(flow, problem, false);
    flow->solutions++;
    return STATUS_OK;
}

static struct cluster_problem problem_of(const struct liquid_flow *flow, int cluster)
{
    return (struct cluster_problem){.cluster = cluster,
                                    .n_throat =
                                        flow->solver->occupancy->clusters.size[cluster],
                                    .target = flow_target(flow)};
}

enum status liquid_flow_find(struct liquid_flow *flow,
                             const struct occupancy *occupancy,
                             const double *evaporation, struct loss *loss, int *n_loss,
                             struct reason *reason)
{
    flow->solver->occupancy = occupancy;
    flow->solver->evaporation = evaporation;
    for (int i = 0; flow->wants_pressures && i < flow->network->n_node; i++)
        flow->pressure[i] = 0;
    enum status status = STATUS_OK;
    for (int c = 0; !status && c < occupancy->clusters.n_id; c++) {
        struct cluster_problem problem = problem_of(flow, c);
        if (problem.n_throat > 0)
            status = find_losses(flow, &problem, loss, n_loss, reason);
    }
    return status;
}

enum status liquid_flow_find_in(struct liquid_flow *flow, int cluster,
                                struct loss *loss, int *n_loss, struct reason *reason)
{
    struct cluster_problem problem = problem_of(flow, cluster);
    return find_losses(flow, &problem, loss, n_loss, reason);
}

void liquid_flow_forget(struct liquid_flow *flow, const struct occupancy *occupancy)
{
    flow_solver_forget(flow->solver, occupancy);
}
