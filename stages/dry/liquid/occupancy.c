// SPDX-License-Identifier: GPL-3.0-or-later
#include "occupancy.h"

#include "basics/memory.h"

#include <stdlib.h>

static void fill_throats(struct phases *phases, double length)
{
    const struct network *network = phases->network;
    phases->volume = NEW_ARRAY(double, network->n_throat);
    phases->liquid = NEW_ARRAY(struct compensated, network->n_throat);
    phases->liquid_beside = NEW_ARRAY(int, network->n_node);
    struct compensated total = {0};
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        phases->volume[t] = throat_volume(network, t) / (length * length * length);
        phases->liquid[t].value = phases->volume[t];
        compensated_add(&total, phases->volume[t]);
        phases->n_full++;
        for (int end = 0; end < 2; end++)
            phases->liquid_beside[network->throat_nodes[t][end]]++;
    }
    phases->capacity = phases->initial_liquid = compensated_value(total);
    phases->total_liquid.value = phases->initial_liquid;
}

static void add_wet(struct phases *phases, int node)
{
    if (phases->wet_place[node] >= 0) return;
    phases->wet_place[node] = phases->n_wet;
    phases->wet[phases->n_wet++] = node;
}

static void remove_wet(struct phases *phases, int node)
{
    const int place = phases->wet_place[node];
    if (place < 0) return;
    const int last = phases->wet[--phases->n_wet];
    phases->wet[place] = last;
    phases->wet_place[last] = place;
    phases->wet_place[node] = -1;
}

static enum status expose_surface(struct phases *phases, struct reason *reason)
{
    for (int i = 0; i < phases->layer.n_exposed; i++) {
        add_wet(phases, phases->layer.exposed[i]);
        clusters_add_menisci(&phases->clusters, phases->layer.exposed[i]);
    }
    for (int t = 0; t < phases->network->n_throat; t++) {
        const int cluster = phases->clusters.of_throat[t];
        if (cluster >= 0 && clusters_invasion_throat(&phases->clusters, cluster) < 0)
            return refuse(
                reason, STATUS_BAD_DATA,
                "/throats/nodes: row %d: no way leads from this throat to the "
                "open wall, its liquid cannot dry",
                t);
    }
    return STATUS_OK;
}

// Lower and upper change places.
static unsigned opposite(unsigned walls)
{
    const unsigned lower = WALL_X_LOWER | WALL_Y_LOWER | WALL_Z_LOWER;
    return (walls & lower) << 1 | (walls >> 1 & lower);
}

enum status phases_make(const struct network *network, unsigned open_walls,
                        const struct phases_form *form, struct boundary_layer layer,
                        struct phases *phases, struct reason *reason)
{
    *phases = (struct phases){.network = network,
                              .incidence = network_incidence(network),
                              .far_walls = opposite(open_walls) & ~open_walls,
                              .layer = layer,
                              .gas = NEW_ARRAY(bool, network->n_node),
                              .wet = NEW_ARRAY(int, network->n_node),
                              .wet_place = NEW_ARRAY(int, network->n_node)};
    for (int i = 0; i < network->n_node; i++)
        phases->wet_place[i] = -1;
    fill_throats(phases, form->length);
    phases->vapour = vapour_make(network, form->length, form->knudsen_radius,
                                 &phases->layer, form->vapour_tolerance);
    phases->clusters =
        clusters_make(network, &phases->incidence, form->ease, form->gas_parts);
    return expose_surface(phases, reason);
}

void phases_empty_throat(struct phases *phases, int throat)
{
    phases->n_full--;
    phases->liquid[throat] = (struct compensated){0};
    vapour_open_throat(&phases->vapour, throat,
                       phases->network->throat_nodes[throat][0],
                       phases->network->throat_nodes[throat][1]);
    clusters_empty_throat(&phases->clusters, throat);
    for (int end = 0; end < 2; end++) {
        const int node = phases->network->throat_nodes[throat][end];
        phases->gas[node] = true;
        phases->breakthrough |=
            (phases->network->node_walls[node] & phases->far_walls) != 0;
        if (--phases->liquid_beside[node] > 0) {
            add_wet(phases, node);
        } else {
            remove_wet(phases, node);
            vapour_dry_node(&phases->vapour, node);
        }
    }
}

double phases_saturation(const struct phases *phases, int throat)
{
    if (!(phases->volume[throat] > 0)) return 0;
    return compensated_value(phases->liquid[throat]) / phases->volume[throat];
}

void phases_free(struct phases *phases)
{
    vapour_free(&phases->vapour);
    clusters_free(&phases->clusters);
    boundary_layer_free(&phases->layer);
    incidence_free(&phases->incidence);
    free(phases->volume);
    free(phases->liquid);
    free(phases->gas);
    free(phases->liquid_beside);
    free(phases->wet);
    free(phases->wet_place);
    *phases = (struct phases){0};
}

void phases_state(struct phases *phases, struct checkpoint_stream *stream)
{
    const int n_node = phases->network->n_node, n_throat = phases->network->n_throat;
    stream_sums(stream, phases->liquid, n_throat);
    stream_sums(stream, &phases->total_liquid, 1);
    stream_numbers(stream, &phases->initial_liquid, 1);
    stream_integer(stream, &phases->n_full, 0, n_throat);
    stream_flags(stream, phases->gas, n_node);
    stream_integers(stream, phases->liquid_beside, n_node, 0, n_throat);
    stream_integer(stream, &phases->n_wet, 0, n_node);
    stream_integers(stream, phases->wet, phases->n_wet, 0, n_node - 1);
    stream_integers(stream, phases->wet_place, n_node, -1, phases->n_wet - 1);
    stream_flags(stream, &phases->breakthrough, 1);
    star_mesh_state(&phases->vapour.mesh, stream);
    clusters_state(&phases->clusters, stream);
}
