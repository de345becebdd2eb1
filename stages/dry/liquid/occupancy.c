// SPDX-License-Identifier: GPL-3.0-or-later
// Where gas and liquid are, and everything that an emptied throat changes [K 3.4.2,
// step 6]: vapour diffuses through it, its cluster may split, its two nodes fill with
// gas. A node with gas and liquid beside it is wet: it evaporates. A node without
// liquid beside it is dry and is eliminated from the vapour's system. Breakthrough is
// gas at a closed wall opposite an open one. In code order, for a throat with the nodes
// i and j: its liquid becomes 0, vapour_open_throat links i and j,
// clusters_empty_throat splits its cluster, then at each node the number of liquid
// throats falls by one: above 0 it is wet, at 0 it is dry. Volumes are compensated
// sums, since a drying subtracts millions of small losses from them.
#include "occupancy.h"

#include "basics/memory.h"

#include <stdlib.h>

static void leave_in_rings(struct occupancy *occupancy, int throat, double left)
{
    occupancy->volume[throat] -= left;
    occupancy->liquid[throat].value = occupancy->volume[throat];
}

// Nodes that hold rings dry later than their throats.
static void place_rings(struct occupancy *occupancy)
{
    const int n = occupancy->network->n_node;
    if (!occupancy->rings) return;
    occupancy->has_rings = NEW_ARRAY(bool, n);
    for (int i = 0; i < n; i++) {
        occupancy->has_rings[i] = occupancy->rings->at_node[i] > 0;
        occupancy->n_liquid += occupancy->has_rings[i];
    }
}

// With films all liquid of a cluster stays together, and feeds the rings at its nodes.
static void add_films(struct occupancy *occupancy)
{
    const struct network *network = occupancy->network;
    occupancy->clusters.never_part = true;
    occupancy->feeder = NEW_ARRAY(int, network->n_node);
    for (int i = 0; i < network->n_node; i++)
        occupancy->feeder[i] = -1;
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2 && occupancy->clusters.of_throat[t] >= 0; end++)
            occupancy->feeder[network->throat_nodes[t][end]] =
                occupancy->clusters.of_throat[t];
}

// Throats of other kinds have volume 0 and never liquid.
static void fill_throats(struct occupancy *occupancy, double length)
{
    const struct network *network = occupancy->network;
    occupancy->volume = NEW_ARRAY(double, network->n_throat);
    occupancy->liquid = NEW_ARRAY(struct compensated, network->n_throat);
    occupancy->liquid_beside = NEW_ARRAY(int, network->n_node);
    const struct ring_stores *rings = occupancy->rings;
    struct compensated total = {0};
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        occupancy->volume[t] = throat_volume(network, t) / (length * length * length);
        occupancy->liquid[t].value = occupancy->volume[t];
        compensated_add(&total, occupancy->volume[t]);
        if (rings) leave_in_rings(occupancy, t, rings->of_throat[t]);
        occupancy->n_liquid++;
        for (int end = 0; end < 2; end++)
            occupancy->liquid_beside[network->throat_nodes[t][end]]++;
    }
    occupancy->capacity = occupancy->initial_liquid = compensated_value(total);
    occupancy->total_liquid.value = occupancy->initial_liquid;
}

// A set with O(1) insertion and removal: `wet` in any order, `wet_place` where each
// stands.
static void add_wet(struct occupancy *occupancy, int node)
{
    if (occupancy->wet_place[node] >= 0) return;
    occupancy->wet_place[node] = occupancy->n_wet;
    occupancy->wet[occupancy->n_wet++] = node;
}

// The last one takes the place.
static void remove_wet(struct occupancy *occupancy, int node)
{
    const int place = occupancy->wet_place[node];
    if (place < 0) return;
    const int last = occupancy->wet[--occupancy->n_wet];
    occupancy->wet[place] = last;
    occupancy->wet_place[last] = place;
    occupancy->wet_place[node] = -1;
}

// A cluster without a meniscus has no throat that gas could enter: it would never dry,
// and a run would not end.
static enum status expose_surface(struct occupancy *occupancy, struct reason *reason)
{
    for (int i = 0; i < occupancy->layer.n_exposed; i++) {
        add_wet(occupancy, occupancy->layer.exposed[i]);
        clusters_add_menisci(&occupancy->clusters, occupancy->layer.exposed[i]);
    }
    for (int t = 0; t < occupancy->network->n_throat; t++) {
        const int cluster = occupancy->clusters.of_throat[t];
        if (cluster >= 0 && clusters_invasion_throat(&occupancy->clusters, cluster) < 0)
            return refuse(
                reason, STATUS_BAD_DATA,
                "/throats/nodes: row %d: no way leads from this throat to the "
                "open wall, its liquid cannot dry",
                t);
    }
    return STATUS_OK;
}

// The walls opposite WALLS: the bits of the lower and upper wall of each axis swapped.
static unsigned opposite(unsigned walls)
{
    const unsigned lower = WALL_X_LOWER | WALL_Y_LOWER | WALL_Z_LOWER;
    return (walls & lower) << 1 | (walls >> 1 & lower);
}

enum status occupancy_init(const struct network *network, unsigned open_walls,
                           const struct occupancy_form *form,
                           struct boundary_layer layer, struct occupancy *occupancy,
                           struct reason *reason)
{
    *occupancy = (struct occupancy){.network = network,
                                    .incidence = network_incidence(network),
                                    .far_walls = opposite(open_walls) & ~open_walls,
                                    .layer = layer,
                                    .length = form->length,
                                    .film_law = form->film_law,
                                    .rings = form->rings,
                                    .gas = NEW_ARRAY(bool, network->n_node),
                                    .wet = NEW_ARRAY(int, network->n_node),
                                    .wet_place = NEW_ARRAY(int, network->n_node)};
    for (int i = 0; i < network->n_node; i++)
        occupancy->wet_place[i] = -1;
    fill_throats(occupancy, form->length);
    place_rings(occupancy);
    occupancy->vapour = vapour_init(network, form->length, form->knudsen_radius,
                                    &occupancy->layer, form->vapour_tolerance,
                                    form->vapour_step);
    occupancy->clusters = clusters_init(network, &occupancy->incidence,
                                        form->entry_priority, form->gas_parts);
    if (form->films) add_films(occupancy);
    return expose_surface(occupancy, reason);
}

// Without liquid the vapour passes through the node.
static void dry_node(struct occupancy *occupancy, int node)
{
    remove_wet(occupancy, node);
    vapour_dry_node(&occupancy->vapour, node);
}

// The vapour's throat is opened before its nodes are dried, because elimination of a
// node needs all its links.
void occupancy_empty_throat(struct occupancy *occupancy, int throat)
{
    occupancy->n_liquid--;
    occupancy->liquid[throat] = (struct compensated){0};
    vapour_open_throat(&occupancy->vapour, throat,
                       occupancy->network->throat_nodes[throat][0],
                       occupancy->network->throat_nodes[throat][1]);
    clusters_empty_throat(&occupancy->clusters, throat);
    for (int end = 0; end < 2; end++) {
        const int node = occupancy->network->throat_nodes[throat][end];
        occupancy->gas[node] = true;
        occupancy->breakthrough |=
            (occupancy->network->node_walls[node] & occupancy->far_walls) != 0;
        if (--occupancy->liquid_beside[node] > 0 || node_has_rings(occupancy, node))
            add_wet(occupancy, node);
        else
            dry_node(occupancy, node);
    }
}

void occupancy_dry_rings(struct occupancy *occupancy, int node)
{
    occupancy->n_liquid--;
    occupancy->has_rings[node] = false;
    dry_node(occupancy, node);
}

double occupancy_saturation(const struct occupancy *occupancy, int throat)
{
    if (!(occupancy->volume[throat] > 0)) return 0;
    return compensated_value(occupancy->liquid[throat]) / occupancy->volume[throat];
}

void occupancy_free(struct occupancy *occupancy)
{
    vapour_free(&occupancy->vapour);
    clusters_free(&occupancy->clusters);
    boundary_layer_free(&occupancy->layer);
    incidence_free(&occupancy->incidence);
    free(occupancy->volume);
    free(occupancy->liquid);
    free(occupancy->gas);
    free(occupancy->liquid_beside);
    free(occupancy->has_rings);
    free(occupancy->feeder);
    free(occupancy->wet);
    free(occupancy->wet_place);
    *occupancy = (struct occupancy){0};
}

// What follows from network and conditions (volumes, incidence, layer) is not kept.
void occupancy_state(struct occupancy *occupancy, struct checkpoint_stream *stream)
{
    const int n_node = occupancy->network->n_node,
              n_throat = occupancy->network->n_throat;
    stream_sums(stream, occupancy->liquid, n_throat);
    stream_sums(stream, &occupancy->total_liquid, 1);
    stream_numbers(stream, &occupancy->initial_liquid, 1);
    stream_integer(stream, &occupancy->n_liquid, 0, n_place_of(occupancy));
    stream_flags(stream, occupancy->gas, n_node);
    stream_integers(stream, occupancy->liquid_beside, n_node, 0, n_throat);
    if (occupancy->has_rings) stream_flags(stream, occupancy->has_rings, n_node);
    stream_integer(stream, &occupancy->n_wet, 0, n_node);
    stream_integers(stream, occupancy->wet, occupancy->n_wet, 0, n_node - 1);
    stream_integers(stream, occupancy->wet_place, n_node, -1, occupancy->n_wet - 1);
    stream_flags(stream, &occupancy->breakthrough, 1);
    vapour_state(&occupancy->vapour, stream);
    clusters_state(&occupancy->clusters, stream);
}
