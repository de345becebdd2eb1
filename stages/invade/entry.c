// SPDX-License-Identifier: GPL-3.0-or-later
// Entry pressures of throats or nodes, as wide as their widest throat:
//     pressure = 2 sigma cos(theta) / r - rho g z,
// z above the lower side of the box, relative to the liquid there. Without gravity the
// order of invasion uses radii themselves, so that equal throats tie exactly. The
// height of a throat is the mean of those of its two nodes. With gravity the priority
// is minus the pressure: the largest priority comes first, as the widest throat does
// without. A node without a throat has the radius 0 and so an infinite pressure.
#include "entry.h"

#include "basics/memory.h"
#include "network/checks.h"

#include <math.h>
#include <stdlib.h>

static enum status check(const struct network *network,
                         const struct entry_conditions *conditions,
                         struct reason *reason)
{
    int n = 0;
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        const double volume = throat_volume(network, t);
        n++;
        const enum status status = check_throat_radius(network, t, reason);
        if (status) return status;
        if (!(volume > 0) || !isfinite(volume))
            return refuse(reason, STATUS_BAD_DATA,
                          "%s: row %d: the throat must hold more than nothing, holds "
                          "%g m3 (merge-nodes removes those without length)",
                          network->throat_volume ? "/throats/volume"
                                                 : "/throats/length",
                          t, volume);
    }
    if (n == 0)
        return refuse(
            reason, STATUS_BAD_DATA,
            "/throats/kind: no throat holds liquid, there is nothing to invade: all "
            "are imposed empty, or closed by grains");
    return check_gravity(network, conditions->gravity, reason);
}

static double height_of(const struct network *network, int node)
{
    return network->node_position[node].z - network->packing.lower.z;
}

// Radii, m, and heights above the floor, m, of throats or nodes.
static void measure_throats(const struct network *network, double *radius,
                            double *height)
{
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *ends = network->throat_nodes[t];
        radius[t] = network->throat_radius[t];
        height[t] = (height_of(network, ends[0]) + height_of(network, ends[1])) / 2;
    }
}

static void measure_nodes(const struct network *network, double *radius, double *height)
{
    for (int i = 0; i < network->n_node; i++)
        height[i] = height_of(network, i);
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2; end++) {
            double *r = &radius[network->throat_nodes[t][end]];
            if (network->throat_kind[t] == THROAT_NETWORK)
                *r = fmax(*r, network->throat_radius[t]);
        }
}

enum status entry_init(const struct network *network, enum invasion_rule rule,
                       const struct entry_conditions *conditions, struct entry *entry,
                       struct reason *reason)
{
    *entry = (struct entry){0};
    const enum status status = check(network, conditions, reason);
    if (status) return status;
    const bool throats = rule == INVADE_THROATS;
    entry->n = throats ? network->n_throat : network->n_node;
    entry->pressure = NEW_ARRAY(double, entry->n);
    entry->entry_priority = NEW_ARRAY(double, entry->n);
    double *height = NEW_ARRAY(double, entry->n);
    if (throats)
        measure_throats(network, entry->entry_priority, height);
    else
        measure_nodes(network, entry->entry_priority, height);
    const double tension =
        2 * conditions->surface_tension * cos(conditions->contact_angle * (M_PI / 180));
    // The density of a liquid without weight need not be known.
    const double weight =
        conditions->gravity > 0 ? conditions->liquid_density * conditions->gravity : 0;
    for (int i = 0; i < entry->n; i++) {
        entry->pressure[i] = tension / entry->entry_priority[i] - weight * height[i];
        if (weight != 0) entry->entry_priority[i] = -entry->pressure[i];
    }
    free(height);
    return STATUS_OK;
}

void entry_free(struct entry *entry)
{
    free(entry->pressure);
    free(entry->entry_priority);
    *entry = (struct entry){0};
}
