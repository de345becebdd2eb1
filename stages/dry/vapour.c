// SPDX-License-Identifier: GPL-3.0-or-later
#include "vapour.h"

#include "basics/memory.h"

#include <stdlib.h>

// Sites that share tiles of the mesh: about as many as have eight wet ones among them.
enum { REGION_SITES = 24 };

static double throat_conductance(const struct network *network, int throat,
                                 double length)
{
    const double radius = network->throat_radius[throat] / length;
    return M_PI * radius * radius / (network->throat_length[throat] / length);
}

// --- regions -----------------------------------------------------------------------

// The network's nodes in connected groups, searched breadth first.
static int group_nodes(const struct network *network, int *region)
{
    struct incidence incidence = network_incidence(network);
    int *queue = NEW_ARRAY(int, network->n_node);
    int n_region = 0;
    for (int i = 0; i < network->n_node; i++)
        region[i] = -1;
    for (int seed = 0; seed < network->n_node; seed++) {
        if (region[seed] >= 0) continue;
        int n = 0;
        queue[n++] = seed;
        region[seed] = n_region;
        for (int next = 0; next < n; next++)
            for (int k = incidence.offset[queue[next]];
                 k < incidence.offset[queue[next] + 1] && n < REGION_SITES; k++) {
                const int32_t *ends = network->throat_nodes[incidence.throat[k]];
                const int other = ends[0] == queue[next] ? ends[1] : ends[0];
                if (region[other] >= 0) continue;
                region[other] = n_region;
                queue[n++] = other;
            }
        n_region++;
    }
    free(queue);
    incidence_free(&incidence);
    return n_region;
}

// Those of the boundary layer, which are gone before drying begins, in groups of eight.
static int group_sites(struct vapour *vapour, const struct network *network)
{
    vapour->region = NEW_ARRAY(int, vapour->n_site);
    const int n_region = group_nodes(network, vapour->region);
    for (int i = network->n_node; i < vapour->n_site; i++)
        vapour->region[i] = n_region + (i - network->n_node) / TILE_LANES;
    return n_region + (vapour->n_site - network->n_node) / TILE_LANES + 1;
}

// --- the boundary layer ------------------------------------------------------------

static int level_site(const struct boundary_layer *layer, int n_node, int level, int i)
{
    return level == 0 ? layer->exposed[i] : n_node + (level - 1) * layer->n_exposed + i;
}

static void link_level(struct vapour *vapour, const struct boundary_layer *layer,
                       int n_node, int level)
{
    struct star_mesh *mesh = &vapour->mesh;
    for (int i = 0; i < layer->n_exposed; i++) {
        const int site = level_site(layer, n_node, level, i);
        const double conductance = layer->area[i] / layer->spacing;
        if (level + 1 == layer->layers)
            star_mesh_link_air(mesh, site, conductance);
        else
            star_mesh_link(mesh, site, level_site(layer, n_node, level + 1, i),
                           conductance);
    }
    // Half a cell stands on the surface [K 3.3.5].
    const double height = level == 0 ? 0.5 : 1;
    for (int k = 0; k < layer->n_lateral; k++)
        star_mesh_link(mesh, level_site(layer, n_node, level, layer->lateral[k][0]),
                       level_site(layer, n_node, level, layer->lateral[k][1]),
                       height * layer->lateral_conductance[k]);
}

// From the air down: each level is eliminated when the one below is linked to it.
static void add_boundary_layer(struct vapour *vapour,
                               const struct boundary_layer *layer, int n_node)
{
    for (int level = layer->layers - 1; level >= 0; level--) {
        link_level(vapour, layer, n_node, level);
        for (int i = 0; level + 1 < layer->layers && i < layer->n_exposed; i++)
            star_mesh_eliminate(&vapour->mesh, level_site(layer, n_node, level + 1, i));
    }
}

struct vapour vapour_make(const struct network *network, double length,
                          const struct boundary_layer *layer)
{
    struct vapour vapour = {.n_site = network->n_node +
                                      (layer->layers - 1) * layer->n_exposed,
                            .conductance = NEW_ARRAY(double, network->n_throat)};
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK)
            vapour.conductance[t] = throat_conductance(network, t, length);
    const int n_region = group_sites(&vapour, network);
    vapour.mesh = star_mesh_make(vapour.n_site, n_region, vapour.region);
    add_boundary_layer(&vapour, layer, network->n_node);
    return vapour;
}

void vapour_free(struct vapour *vapour)
{
    star_mesh_free(&vapour->mesh);
    free(vapour->conductance);
    free(vapour->region);
    *vapour = (struct vapour){0};
}

// --- drying ------------------------------------------------------------------------

void vapour_open_throat(struct vapour *vapour, int throat, int a, int b)
{
    star_mesh_link(&vapour->mesh, a, b, vapour->conductance[throat]);
}

void vapour_dry_node(struct vapour *vapour, int node)
{
    star_mesh_eliminate(&vapour->mesh, node);
    const double rate = vapour_rate(vapour);
    const double bound = vapour->mesh.dropped / rate;
    if (rate > 0 && bound > vapour->residual) vapour->residual = bound;
}

double vapour_rate(const struct vapour *vapour)
{
    return compensated_value(vapour->mesh.all_air);
}

double vapour_evaporation(const struct vapour *vapour, int node)
{
    return star_mesh_air(&vapour->mesh, node);
}

enum status vapour_check(const struct vapour *vapour, struct reason *reason)
{
    if (vapour->residual < VAPOUR_TOLERANCE) return STATUS_OK;
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "the evaporation of wet nodes may be off by %.3g of the drying rate, "
                  "allowed is %g",
                  vapour->residual, VAPOUR_TOLERANCE);
}
