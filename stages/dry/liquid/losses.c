// SPDX-License-Identifier: GPL-3.0-or-later
#include "losses.h"

#include "basics/memory.h"

#include <stdlib.h>

struct losses losses_make(int n_throat)
{
    return (struct losses){.loss = NEW_ARRAY(struct loss, n_throat),
                           .charge = NEW_ARRAY(double, n_throat),
                           .charged = NEW_ARRAY(int, n_throat)};
}

void losses_free(struct losses *losses)
{
    free(losses->loss);
    free(losses->charge);
    free(losses->charged);
    *losses = (struct losses){0};
}

double liquid_section(const struct phases *phases, int throat)
{
    if (phases->clusters.of_throat[throat] < 0) return 0;
    return phases->volume[throat] / phases->network->throat_length[throat];
}

static void charge_throats(struct losses *losses, const struct phases *phases, int node)
{
    const double evaporation = vapour_evaporation(&phases->vapour, node);
    if (!(evaporation > 0)) return; // shut in
    const int begin = phases->incidence.offset[node];
    const int end = phases->incidence.offset[node + 1];
    double section = 0;
    for (int k = begin; k < end; k++)
        section += liquid_section(phases, phases->incidence.throat[k]);
    for (int k = begin; k < end; k++) {
        const int throat = phases->incidence.throat[k];
        const double charge = evaporation * (liquid_section(phases, throat) / section);
        if (!(charge > 0)) continue;
        if (losses->charge[throat] == 0) losses->charged[losses->n_charged++] = throat;
        losses->charge[throat] += charge;
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

enum status losses_find(struct losses *losses, struct phases *phases,
                        struct liquid_flow *flow, struct reason *reason)
{
    losses->n = 0;
    losses->n_charged = 0;
    for (int k = 0; k < phases->n_wet; k++)
        charge_throats(losses, phases, phases->wet[k]);
    const enum status status = liquid_flow_find(flow, phases, losses->charge,
                                                losses->loss, &losses->n, reason);
    for (int k = 0; k < losses->n_charged; k++)
        losses->charge[losses->charged[k]] = 0;
    losses_sort(losses);
    return status;
}
