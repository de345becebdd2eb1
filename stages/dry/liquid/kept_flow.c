// SPDX-License-Identifier: GPL-3.0-or-later
// With the potentials p of the nodes and the inflows as they were found last, and what
// throats evaporate now:
//     a meniscus begins to move where arm (p - entry potential) < evaporation, and then
//         inflow = arm (p - entry potential),
//     one in a full throat stops where inflow > evaporation,
//     loss = evaporation - inflow,   share = wanted / lost,
//     loss *= share   of all that lose,
// so that the losses add up to what the cluster evaporates. A throat that empties hands
// its loss to the others in this way: a change that the next solution spreads as the
// flow does. The flow is found again when throats with flow->step of the cluster's
// liquid have emptied or refilled, when it evaporates so much more or less, or when the
// share is far from 1: then the throat that emptied was the one that fed the others.
#include "kept_flow.h"

#include <math.h>

static const double LEAST_SHARE = 0.7, LARGEST_SHARE = 1.5;

static struct cluster_memory *memory_of(const struct liquid_flow *flow,
                                        const struct cluster_problem *problem)
{
    return &flow->solver->cluster[problem->cluster];
}

static double loss_of(const struct liquid_flow *flow, int throat)
{
    return flow->solver->evaporation[throat] - flow->solver->inflow[throat];
}

void kept_flow_note(const struct liquid_flow *flow,
                    const struct cluster_problem *problem)
{
    const struct flow_solver *solver = flow->solver;
    struct cluster_memory *memory = memory_of(flow, problem);
    memory->evaporation = problem->evaporation;
    memory->liquid = memory->changed = 0;
    for (enum throat_list l = 0; l < LISTS; l++)
        for (int t = first_throat(solver, problem, l); t >= 0; t = next_throat(flow, t))
            memory->liquid += compensated_value(solver->occupancy->liquid[t]);
}

static bool has_changed_little(const struct liquid_flow *flow,
                               const struct cluster_problem *problem)
{
    const struct cluster_memory *memory = memory_of(flow, problem);
    return problem->n_throat > 1 &&
           memory->changed <= flow->step * memory->liquid &&
           fabs(problem->evaporation - memory->evaporation) <=
               flow->step * fabs(memory->evaporation);
}

// What flows to the meniscus of THROAT if that moves. Potentials are relative to the
// throat that gas entered most easily when they were found.
static double inflow_if_moving(const struct liquid_flow *flow,
                               const struct cluster_problem *problem, int throat)
{
    int n;
    const double behind = potential_of_ends(flow, problem->cluster, throat, &n);
    const int reference = memory_of(flow, problem)->reference;
    const double entry = menisci_potential(&flow->menisci, throat, reference);
    return n > 0 ? n * meniscus_arm(flow, throat, n) * (behind - entry) : 0;
}

// The menisci of throats that have refilled.
static void stop_menisci(struct liquid_flow *flow,
                         const struct cluster_problem *problem)
{
    const struct occupancy *occupancy = flow->solver->occupancy;
    for (int t = first_meniscus(flow, problem); t >= 0; t = next_throat(flow, t)) {
        if (!flow->moving[t] || !throat_is_full(occupancy, t) || loss_of(flow, t) >= 0)
            continue;
        flow->moving[t] = false;
        memory_of(flow, problem)->changed += occupancy->volume[t];
    }
}

static void begin_to_move(struct liquid_flow *flow,
                          const struct cluster_problem *problem, int throat)
{
    struct flow_solver *solver = flow->solver;
    const double inflow = inflow_if_moving(flow, problem, throat);
    if (!(inflow < solver->evaporation[throat])) return;
    flow->moving[throat] = true;
    solver->inflow[throat] = inflow;
}

bool kept_flow_goes_on(struct liquid_flow *flow, const struct cluster_problem *problem)
{
    struct flow_solver *solver = flow->solver;
    if (!(memory_of(flow, problem)->liquid > 0)) return false;
    stop_menisci(flow, problem);
    if (!has_changed_little(flow, problem)) return false;
    double lost = 0, gained = 0;
    for (int t = first_meniscus(flow, problem); t >= 0; t = next_throat(flow, t)) {
        if (!flow->moving[t]) begin_to_move(flow, problem, t);
        const double loss = flow->moving[t] ? loss_of(flow, t) : 0;
        if (loss > 0)
            lost += loss;
        else
            gained -= loss;
    }
    const double share = (problem->evaporation + gained) / lost;
    if (!(share > LEAST_SHARE && share < LARGEST_SHARE)) return false;
    for (int t = first_meniscus(flow, problem); t >= 0; t = next_throat(flow, t))
        if (flow->moving[t] && loss_of(flow, t) > 0)
            solver->inflow[t] = solver->evaporation[t] - share * loss_of(flow, t);
    return true;
}
