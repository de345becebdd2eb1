// SPDX-License-Identifier: GPL-3.0-or-later
#include "viscous.h"

#include "basics/memory.h"
#include "cluster_flow.h"
#include "losses.h"

#include <math.h>
#include <stdlib.h>

// Rounds in which menisci are found; from the second on none can come back, so this is
// far more than any network needs.
enum { MOST_ROUNDS = 200 };

// Menisci begin to move at once that lack at least this part of what the worst does;
// all that must after so many rounds, as when a viscous cluster begins to dry.
enum { PATIENT_ROUNDS = 20 };
static const double BEGINNERS = 0.9;

struct liquid_flow liquid_flow_make(const struct occupancy *occupancy, double length,
                                    struct menisci menisci)
{
    const struct network *network = occupancy->network;
    struct liquid_flow flow = {.network = network,
                               .menisci = menisci,
                               .conductance = NEW_ARRAY(double, network->n_throat),
                               .resistance = NEW_ARRAY(double, network->n_throat),
                               .moving = NEW_ARRAY(bool, network->n_throat),
                               .pressure = NEW_ARRAY(double, network->n_node),
                               .solver = flow_solver_make(occupancy)};
    for (int t = 0; t < network->n_throat; t++) {
        const double r = network->throat_radius[t] / length;
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        flow.conductance[t] =
            M_PI * (r * r) * (r * r) / (8 * (network->throat_length[t] / length));
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

static int first_meniscus(const struct liquid_flow *flow, const struct piece *piece)
{
    return cluster_members_first(&flow->solver->lists, piece->cluster, LIST_MENISCI);
}

static int next_throat(const struct liquid_flow *flow, int throat)
{
    return flow->solver->lists.next[throat];
}

static bool is_full(const struct liquid_flow *flow, int throat)
{
    return throat_is_full(flow->solver->occupancy, throat);
}

// Potential at which the meniscus of THROAT moves.
static double entry(const struct liquid_flow *flow, const struct piece *piece,
                    int throat)
{
    return menisci_potential(&flow->menisci, throat, piece->reference);
}

// Potential behind a meniscus to which as much flows as evaporates.
static double potential_at_mouth(const struct liquid_flow *flow,
                                 const struct piece *piece, int throat)
{
    int end[2];
    const int n = liquid_ends(flow, throat, end);
    double mean = 0;
    for (int k = 0; k < n; k++)
        mean += node_potential(flow->solver, piece->cluster, end[k]) / n;
    const double arm = n * meniscus_arm(flow, throat, n);
    const double alone = mean - flow->solver->charge[throat] / arm;
    if (!flow->response) return alone;
    const double part = flow->response[throat] / arm;
    return (alone + part * end_potential(flow, throat, piece->reference)) / (1 + part);
}

// Whether more flows to a full throat than evaporates, but for rounding.
static bool must_stop(const struct liquid_flow *flow, const struct piece *piece,
                      int throat)
{
    return is_full(flow, throat) &&
           flow->solver->charge[throat] - flow->solver->inflow[throat] <
               -FLOW_TARGET * piece->flow;
}

// Menisci as they were, those in throats partly empty, and if that is none, that which
// gas enters most easily.
static void start_menisci(struct liquid_flow *flow, const struct piece *piece)
{
    bool any = false;
    for (int t = first_meniscus(flow, piece); t >= 0; t = next_throat(flow, t)) {
        flow->moving[t] |= !is_full(flow, t);
        any |= flow->moving[t];
    }
    if (!any) flow->moving[piece->reference] = true;
}

// How far the potential behind a meniscus that stays is below that at which it moves.
static double shortfall(const struct liquid_flow *flow, const struct piece *piece,
                        int throat)
{
    return entry(flow, piece, throat) - potential_at_mouth(flow, piece, throat);
}

// Those that must stop do, and of those that must begin, those that must most: as they
// do, the pressure rises for the others. Returns how many have changed.
static int revise_menisci(struct liquid_flow *flow, const struct piece *piece,
                          double beginners)
{
    int n = 0;
    double most = 0;
    for (int t = first_meniscus(flow, piece); t >= 0; t = next_throat(flow, t)) {
        if (!flow->moving[t]) {
            most = fmax(most, shortfall(flow, piece, t));
        } else if (must_stop(flow, piece, t)) {
            flow->moving[t] = false;
            n++;
        }
    }
    for (int t = first_meniscus(flow, piece); most > 0 && t >= 0;
         t = next_throat(flow, t)) {
        const double residual = flow->moving[t] ? 0 : shortfall(flow, piece, t);
        if (!(residual > 0 && residual >= beginners * most)) continue;
        flow->moving[t] = true;
        n++;
    }
    return n;
}

static enum status find_menisci(struct liquid_flow *flow, struct piece *piece,
                                struct reason *reason)
{
    start_menisci(flow, piece);
    for (int round = 0; round < MOST_ROUNDS; round++) {
        const enum status status = cluster_flow_solve(flow, piece, reason);
        if (status) return status;
        flow->rounds++;
        const double beginners = round < PATIENT_ROUNDS ? BEGINNERS : 0;
        if (revise_menisci(flow, piece, beginners) == 0) return STATUS_OK;
    }
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "no consistent menisci after %d rounds in a cluster of %d throats",
                  MOST_ROUNDS, piece->n_throat);
}

// --- one cluster ---------------------------------------------------------------------

static void add_loss(struct loss *loss, int *n_loss, int throat, double rate)
{
    if (rate != 0) loss[(*n_loss)++] = (struct loss){throat, rate};
}

// What each moving meniscus loses. The error of the balances is left to the largest.
static void collect_losses(const struct liquid_flow *flow, const struct piece *piece,
                           struct loss *loss, int *n_loss)
{
    const int first = *n_loss;
    int largest = first;
    double sum = 0;
    for (int t = first_meniscus(flow, piece); t >= 0; t = next_throat(flow, t)) {
        if (!flow->moving[t]) continue;
        double rate = flow->solver->charge[t] - flow->solver->inflow[t];
        if (is_full(flow, t)) rate = fmax(rate, 0);
        add_loss(loss, n_loss, t, rate);
        sum += rate;
    }
    for (int k = first; k < *n_loss; k++)
        if (fabs(loss[k].rate) > fabs(loss[largest].rate)) largest = k;
    if (*n_loss == first + 1)
        loss[first].rate =
            fmax(piece->evaporation, is_full(flow, loss[first].throat) ? 0 : -INFINITY);
    else if (*n_loss > first)
        loss[largest].rate += piece->evaporation - sum;
}

// At REST: as in a cluster that does not flow, at the verge of its widest meniscus.
static void write_pressures(struct liquid_flow *flow, const struct piece *piece,
                            bool at_rest)
{
    const struct menisci *menisci = &flow->menisci;
    const double reference = -menisci->tension / menisci->radius[piece->reference];
    list_nodes(flow, piece);
    for (int k = 0; k < flow->solver->n_node; k++) {
        const int node = flow->solver->node[k];
        const double above =
            at_rest ? 0 : node_potential(flow->solver, piece->cluster, node);
        flow->pressure[node] =
            reference + above + menisci_weight(menisci, piece->reference, node);
    }
}

// Counts the menisci, and those in throats partly empty; finds where gas enters first
// and second.
static void survey(const struct liquid_flow *flow, struct piece *piece)
{
    int second = -1;
    for (int t = first_meniscus(flow, piece); t >= 0; t = next_throat(flow, t)) {
        piece->n_partial += !is_full(flow, t);
        piece->evaporation += flow->solver->charge[t];
        piece->turnover += fabs(flow->solver->charge[t]);
        if (piece->n_meniscus++ == 0) {
            piece->reference = t;
        } else if (entry(flow, piece, t) > 0) {
            second = piece->reference;
            piece->reference = t;
        } else if (second < 0 || entry(flow, piece, t) > entry(flow, piece, second)) {
            second = t;
        }
    }
    if (second >= 0) piece->margin = -entry(flow, piece, second);
}

// Of all throats of a cluster one after the other. As throats only leave, what it was
// some time ago is no less.
static double resistance_of(struct liquid_flow *flow, const struct piece *piece)
{
    struct flow_solver *solver = flow->solver;
    struct cluster_memory *memory = &solver->cluster[piece->cluster];
    if (memory->size > 0 && piece->n_throat > 0.8 * memory->size)
        return memory->resistance;
    memory->size = piece->n_throat;
    memory->resistance = 0;
    for (enum throat_list l = 0; l < LISTS; l++)
        for (int t = cluster_members_first(&solver->lists, piece->cluster, l); t >= 0;
             t = next_throat(flow, t))
            memory->resistance += flow->resistance[t];
    return memory->resistance;
}

// Whether only the meniscus that gas enters most easily can move: all that evaporates
// falls by less than the margin to the next on any way through the cluster.
static bool only_one_moves(struct liquid_flow *flow, const struct piece *piece)
{
    if (piece->n_meniscus == 1) return true;
    if (piece->n_partial > !is_full(flow, piece->reference)) return false;
    return piece->evaporation * resistance_of(flow, piece) < piece->margin;
}

static void move_reference(struct liquid_flow *flow, const struct piece *piece)
{
    for (int t = first_meniscus(flow, piece); t >= 0; t = next_throat(flow, t))
        flow->moving[t] = false;
    flow->moving[piece->reference] = true;
}

// As they are where the vapour responds, and what evaporates then.
static void keep_menisci(struct liquid_flow *flow, struct piece *piece)
{
    const struct flow_solver *solver = flow->solver;
    piece->evaporation = 0;
    for (int t = first_meniscus(flow, piece); t >= 0; t = next_throat(flow, t)) {
        const bool responds = !flow->moving[t] && flow->response[t] > 0;
        flow->found[t] = flow->moving[t] ? solver->charge[t] - solver->inflow[t]
                                         : -shortfall(flow, piece, t);
        piece->evaporation += responds ? solver->inflow[t] : solver->charge[t];
    }
}

// Whether none of its menisci moves and no vapour gets to or from them.
static bool is_shut_in(const struct liquid_flow *flow, const struct piece *piece)
{
    for (int t = first_meniscus(flow, piece); t >= 0; t = next_throat(flow, t))
        if (flow->moving[t] || flow->response[t] > 0) return false;
    return true;
}

static void keep_as_is(struct liquid_flow *flow, const struct piece *piece)
{
    for (int t = first_meniscus(flow, piece); t >= 0; t = next_throat(flow, t))
        flow->found[t] = flow->excess[t];
}

// Where the vapour responds: with menisci as they are given.
static enum status find_given(struct liquid_flow *flow, struct piece *piece,
                              struct loss *loss, int *n_loss, struct reason *reason)
{
    if (piece->n_throat == 1) return STATUS_OK;
    survey(flow, piece);
    if (is_shut_in(flow, piece)) {
        keep_as_is(flow, piece);
        return STATUS_OK;
    }
    const enum status status = cluster_flow_solve(flow, piece, reason);
    if (status) return status;
    keep_menisci(flow, piece);
    collect_losses(flow, piece, loss, n_loss);
    if (flow->wants_pressures) write_pressures(flow, piece, false);
    flow->solutions++;
    flow->rounds++;
    return STATUS_OK;
}

static enum status find_losses(struct liquid_flow *flow, struct piece *piece,
                               struct loss *loss, int *n_loss, struct reason *reason)
{
    if (flow->response) return find_given(flow, piece, loss, n_loss, reason);
    survey(flow, piece);
    if (!(piece->turnover > 0) && piece->n_partial < 2) {
        if (flow->wants_pressures) write_pressures(flow, piece, true);
        return STATUS_OK;
    }
    const bool decided = only_one_moves(flow, piece);
    if (decided && (piece->n_throat == 1 || !flow->wants_pressures)) {
        move_reference(flow, piece);
        add_loss(loss, n_loss, piece->reference, piece->evaporation);
        return STATUS_OK;
    }
    const enum status status = find_menisci(flow, piece, reason);
    if (status) return status;
    collect_losses(flow, piece, loss, n_loss);
    if (flow->wants_pressures) write_pressures(flow, piece, false);
    flow->solutions++;
    return STATUS_OK;
}

enum status liquid_flow_find(struct liquid_flow *flow,
                             const struct occupancy *occupancy, const double *charge,
                             struct loss *loss, int *n_loss, struct reason *reason)
{
    flow->solver->occupancy = occupancy;
    flow->solver->charge = charge;
    for (int i = 0; flow->wants_pressures && i < flow->network->n_node; i++)
        flow->pressure[i] = 0;
    enum status status = STATUS_OK;
    for (int c = 0; !status && c < occupancy->clusters.n_id; c++) {
        struct piece piece = {.cluster = c, .n_throat = occupancy->clusters.size[c]};
        if (piece.n_throat > 0)
            status = find_losses(flow, &piece, loss, n_loss, reason);
    }
    return status;
}

void liquid_flow_forget(struct liquid_flow *flow, const struct occupancy *occupancy)
{
    flow_solver_forget(flow->solver, occupancy);
}
