// SPDX-License-Identifier: GPL-3.0-or-later
// What each throat loses while the gas stays as it is:
//     evaporation[t] = sum over its wet nodes of vapour_evaporation(node) *
//                      section[t] / sum of sections with liquid at the node,
// then the flow moves liquid from throat to throat within clusters (viscous.h), and
// what is left is the loss: positive where a meniscus recedes, negative where a throat
// refills.
#include "losses.h"

#include "basics/memory.h"

#include <stdlib.h>

struct losses losses_init(int n_throat)
{
    return (struct losses){.loss = NEW_ARRAY(struct loss, n_throat),
                           .evaporation = NEW_ARRAY(double, n_throat),
                           .evaporating = NEW_ARRAY(int, n_throat)};
}

void losses_free(struct losses *losses)
{
    free(losses->loss);
    free(losses->evaporation);
    free(losses->evaporating);
    *losses = (struct losses){0};
}

double liquid_section(const struct occupancy *occupancy, int throat)
{
    if (occupancy->clusters.of_throat[throat] < 0) return 0;
    return occupancy->volume[throat] / occupancy->network->throat_length[throat];
}

double liquid_sections_at(const struct occupancy *occupancy, int node)
{
    const struct incidence *incidence = &occupancy->incidence;
    double sum = 0;
    for (int k = incidence->offset[node]; k < incidence->offset[node + 1]; k++)
        sum += liquid_section(occupancy, incidence->throat[k]);
    return sum;
}

static void share_evaporation(struct losses *losses, const struct occupancy *occupancy,
                              int node)
{
    const double evaporation = vapour_evaporation(&occupancy->vapour, node);
    if (!(evaporation > 0)) return; // shut in
    const int begin = occupancy->incidence.offset[node];
    const int end = occupancy->incidence.offset[node + 1];
    const double section = liquid_sections_at(occupancy, node);
    for (int k = begin; k < end; k++) {
        const int throat = occupancy->incidence.throat[k];
        const double share =
            evaporation * (liquid_section(occupancy, throat) / section);
        if (!(share > 0)) continue;
        if (losses->evaporation[throat] == 0)
            losses->evaporating[losses->n_evaporating++] = throat;
        losses->evaporation[throat] += share;
    }
}

static int compare_losses(const void *a, const void *b)
{
    const struct loss *l = a, *m = b;
    return (l->throat > m->throat) - (l->throat < m->throat);
}

void losses_sort(struct losses *losses)
{
    if (losses->n > 0)
        qsort(losses->loss, (size_t)losses->n, sizeof *losses->loss, compare_losses);
}

enum status losses_find(struct losses *losses, struct occupancy *occupancy,
                        struct liquid_flow *flow, struct reason *reason)
{
    losses->n = 0;
    losses->n_evaporating = 0;
    for (int k = 0; k < occupancy->n_wet; k++)
        share_evaporation(losses, occupancy, occupancy->wet[k]);
    const enum status status = liquid_flow_find(flow, occupancy, losses->evaporation,
                                                losses->loss, &losses->n, reason);
    for (int k = 0; k < losses->n_evaporating; k++)
        losses->evaporation[losses->evaporating[k]] = 0;
    losses_sort(losses);
    return status;
}
