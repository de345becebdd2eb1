// SPDX-License-Identifier: GPL-3.0-or-later
// With the potentials p of the nodes as they were found last, and what throats
// evaporate now:
//     a meniscus begins to move where arm (p - entry potential) < evaporation, and then
//         inflow = arm (p - entry potential),
//     one in a full throat stops where inflow > evaporation,
//     loss = scale (evaporation - inflow),
// so that the losses add up to what the cluster evaporates (viscous_events.h). The flow
// is found again when throats with flow->step of the cluster's liquid have emptied or
// refilled, when it evaporates so much more or less (also as parts leave it), or when
// the scale is far from 1: then a throat that fed the others has emptied.
//
// Tried instead of a scale: all potentials fall by the same amount until other menisci
// feed the cluster, as without viscosity. At 1e-6 m2/s this saves three of four
// solutions, but the error is up to four times as large.
#include "kept_flow.h"

#include <math.h>

static const double LEAST_SCALE = 0.7, LARGEST_SCALE = 1.5;

static struct cluster_memory *memory_of(const struct liquid_flow *flow, int cluster)
{
    return &flow->solver->cluster[cluster];
}

void kept_flow_note(const struct liquid_flow *flow,
                    const struct cluster_problem *problem)
{
    const struct flow_solver *solver = flow->solver;
    struct cluster_memory *memory = memory_of(flow, problem->cluster);
    memory->evaporation = problem->evaporation;
    memory->liquid = memory->changed = 0;
    for (enum throat_list l = 0; l < LISTS; l++)
        for (int t = first_throat(solver, problem, l); t >= 0; t = next_throat(flow, t))
            memory->liquid += compensated_value(solver->occupancy->liquid[t]);
}

bool kept_flow_is_known(const struct liquid_flow *flow, int cluster)
{
    return memory_of(flow, cluster)->liquid > 0;
}

bool kept_flow_may_serve(const struct liquid_flow *flow, int cluster,
                         double evaporation, double scale)
{
    const struct cluster_memory *memory = memory_of(flow, cluster);
    return memory->liquid > 0 && flow->solver->occupancy->clusters.size[cluster] > 1 &&
           memory->changed <= flow->step * memory->liquid &&
           fabs(evaporation - memory->evaporation) <=
               flow->step * fabs(memory->evaporation) &&
           scale > LEAST_SCALE && scale < LARGEST_SCALE;
}

// Potentials are relative to the throat that gas entered most easily when they were
// found.
double kept_flow_inflow(const struct liquid_flow *flow, int cluster, int throat)
{
    int n;
    const double behind = potential_of_ends(flow, cluster, throat, &n);
    const int reference = memory_of(flow, cluster)->reference;
    const double entry = menisci_potential(&flow->menisci, throat, reference);
    return n > 0 ? n * meniscus_arm(flow, throat, n) * (behind - entry) : 0;
}

void kept_flow_stop(struct liquid_flow *flow, int cluster, int throat)
{
    flow->moving[throat] = false;
    memory_of(flow, cluster)->changed += flow->solver->occupancy->volume[throat];
}
