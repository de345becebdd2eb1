// SPDX-License-Identifier: GPL-3.0-or-later
// Vapour in the gas as a network of conductances [K 3.9]. With the scaled potential
//     phi = ln((p_g - p_v) / (p_g - p_sat)) / ln((p_g - p_inf) / (p_g - p_sat)),
// 0 above flat menisci and 1 in the drying air, inner nodes of the gas balance,
//     sum_j conductance_ij (phi_i - phi_j) = 0,
// so each can be eliminated as soon as it dries (star-mesh transformation,
// elimination/kron_fronts.h). Then the conductance to the air times the potential
// difference, 1, is what a wet node evaporates; their sum is the rate. The levels of
// the boundary layer are eliminated once, before the run. Where the front is wide the
// potentials are kept instead (kept_vapour.h).
#include "vapour.h"

#include "basics/memory.h"
#include "geometry/space_filling_curve.h"
#include "nested_dissection_order.h"

#include <math.h>
#include <stdlib.h>

// Diffusion in the gas and at the wall in series (Bosanquet): 1/D + 1/D_K, where D_K
// grows with the radius.
static double throat_conductance(const struct network *network, int throat,
                                 double length, double knudsen_radius)
{
    const double slowed = 1 + knudsen_radius / hydraulic_radius(network, throat);
    return diffusive_conductance(network, throat, length) / slowed;
}

// --- the boundary layer ------------------------------------------------------------

static int level_site(const struct boundary_layer *layer, int n_node, int level, int i)
{
    return level == 0 ? layer->exposed[i] : n_node + (level - 1) * layer->n_exposed + i;
}

// Room for the links of a level, or of all levels.
static int most_level_links(const struct boundary_layer *layer)
{
    return layer->n_exposed + layer->n_lateral;
}

// LINK becomes the links of the lattice along LEVEL, and from it to the next, which are
// not to the air. Returns how many.
static int level_links(const struct boundary_layer *layer, int n_node, int level,
                       struct link *link)
{
    int n = 0;
    for (int i = 0; level + 1 < layer->layers && i < layer->n_exposed; i++)
        link[n++] = (struct link){{level_site(layer, n_node, level, i),
                                   level_site(layer, n_node, level + 1, i)},
                                  layer->area[i] / layer->spacing};
    // Half a cell stands on the surface [K 3.3.5].
    const double height = level == 0 ? 0.5 : 1;
    for (int k = 0; k < layer->n_lateral; k++)
        link[n++] =
            (struct link){{level_site(layer, n_node, level, layer->lateral[k][0]),
                           level_site(layer, n_node, level, layer->lateral[k][1])},
                          height * layer->lateral_conductance[k]};
    return n;
}

static void link_level(struct kron_fronts *mesh, const struct boundary_layer *layer,
                       int n_node, int level)
{
    struct link *link = NEW_ARRAY(struct link, most_level_links(layer));
    const int n = level_links(layer, n_node, level, link);
    for (int l = 0; l < n; l++)
        kron_fronts_link(mesh, link[l].site[0], link[l].site[1], link[l].conductance);
    free(link);
}

// From the air down: each level is eliminated when the one below is linked to it.
static void add_by_levels(struct kron_fronts *mesh, const struct boundary_layer *layer,
                          int n_node)
{
    for (int level = layer->layers - 1; level >= 0; level--) {
        link_level(mesh, layer, n_node, level);
        for (int i = 0; level + 1 < layer->layers && i < layer->n_exposed; i++)
            kron_fronts_eliminate(mesh, level_site(layer, n_node, level + 1, i));
    }
}

static void add_by_columns(struct kron_fronts *mesh, const struct network *network,
                           const struct boundary_layer *layer)
{
    for (int level = 0; level < layer->layers; level++)
        link_level(mesh, layer, network->n_node, level);
    int *order = nested_dissection_order(network, layer);
    for (int k = 0; k < layer->n_exposed; k++)
        for (int level = layer->layers - 1; level > 0; level--)
            kron_fronts_eliminate(mesh,
                                  level_site(layer, network->n_node, level, order[k]));
    free(order);
}

// Eliminates the lattice down to its feet. The front is one level (n_exposed sites), or
// the columns of a separator, about 2 sqrt(n_exposed) of them with all their layers:
// the order with the smaller front is taken.
static void add_boundary_layer(struct kron_fronts *mesh, const struct network *network,
                               const struct boundary_layer *layer)
{
    const int n_node = network->n_node, top = layer->layers - 1;
    for (int i = 0; i < layer->n_exposed; i++)
        kron_fronts_link_air(mesh, level_site(layer, n_node, top, i),
                             layer->area[i] / layer->spacing);
    if (2 * sqrt(layer->n_exposed) * layer->layers < layer->n_exposed)
        add_by_columns(mesh, network, layer);
    else
        add_by_levels(mesh, layer, n_node);
}

// Nodes along a curve, then the lattice level by level.
static int *order_of_sites(const struct vapour *vapour, const struct network *network)
{
    int32_t *curve = order_along_curve(network->n_node, network->node_position);
    int *order = NEW_ARRAY(int, vapour->n_site);
    for (int i = 0; i < vapour->n_site; i++)
        order[i] = i < network->n_node ? curve[i] : i;
    free(curve);
    return order;
}

// The same lattice and the throats, for potentials that are kept.
static struct kept_vapour *keep_vapour(const struct vapour *vapour,
                                       const struct network *network,
                                       const struct boundary_layer *layer, double step)
{
    const int n_node = network->n_node, air = vapour->n_site;
    struct link *link = NEW_ARRAY(
        struct link, (size_t)layer->layers * (size_t)most_level_links(layer) +
                         (size_t)layer->n_exposed + (size_t)network->n_throat);
    int n = 0;
    for (int i = 0; i < layer->n_exposed; i++)
        link[n++] =
            (struct link){{level_site(layer, n_node, layer->layers - 1, i), air},
                          layer->area[i] / layer->spacing};
    for (int level = 0; level < layer->layers; level++)
        n += level_links(layer, n_node, level, link + n);
    const int n_open = n;
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK)
            link[n++] = (struct link){
                {network->throat_nodes[t][0], network->throat_nodes[t][1]},
                vapour->conductance[t]};
    struct kept_vapour *kept = kept_vapour_create(
        n_node, vapour->n_site, n, n_open, link, order_of_sites(vapour, network), step);
    free(link);
    return kept;
}

struct vapour vapour_init(const struct network *network, double length,
                          double knudsen_radius, const struct boundary_layer *layer,
                          double tolerance, double step)
{
    struct vapour vapour = {.n_site = network->n_node +
                                      (layer->layers - 1) * layer->n_exposed,
                            .conductance = NEW_ARRAY(double, network->n_throat)};
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK)
            vapour.conductance[t] =
                throat_conductance(network, t, length, knudsen_radius);
    if (step > 0) {
        vapour.kept = keep_vapour(&vapour, network, layer, step);
        return vapour;
    }
    vapour.mesh = kron_fronts_init(vapour.n_site, tolerance > 0);
    add_boundary_layer(&vapour.mesh, network, layer);
    return vapour;
}

void vapour_free(struct vapour *vapour)
{
    kept_vapour_free(vapour->kept);
    kron_fronts_free(&vapour->mesh);
    free(vapour->conductance);
    *vapour = (struct vapour){0};
}

// --- drying ------------------------------------------------------------------------

void vapour_open_throat(struct vapour *vapour, int throat, int a, int b)
{
    if (vapour->kept)
        kept_vapour_open(vapour->kept, a, b, vapour->conductance[throat]);
    else
        kron_fronts_link(&vapour->mesh, a, b, vapour->conductance[throat]);
}

void vapour_dry_node(struct vapour *vapour, int node)
{
    if (vapour->kept)
        kept_vapour_dry(vapour->kept, node);
    else
        kron_fronts_eliminate(&vapour->mesh, node);
}

void vapour_forget_reached(struct vapour *vapour)
{
    struct air_links *air = vapour->kept ? &vapour->kept->air : &vapour->mesh.air;
    air->n_reached = 0;
}

double vapour_rate(const struct vapour *vapour)
{
    return compensated_value(vapour_air(vapour)->all);
}

double vapour_pace(const struct vapour *vapour)
{
    return vapour->kept ? kept_vapour_pace(vapour->kept) : 1;
}

double vapour_evaporation(const struct vapour *vapour, int node)
{
    return air_links_of(vapour_air(vapour), node);
}

void vapour_state(struct vapour *vapour, struct checkpoint_stream *stream)
{
    if (vapour->kept)
        kept_vapour_state(vapour->kept, stream);
    else
        kron_fronts_state(&vapour->mesh, stream);
}

bool vapour_fits(const struct vapour *vapour)
{
    return vapour->kept ? kept_vapour_fits(vapour->kept)
                        : kron_fronts_fit(&vapour->mesh);
}
