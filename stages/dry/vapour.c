// SPDX-License-Identifier: GPL-3.0-or-later
#include "vapour.h"

#include "basics/memory.h"

#include <stdlib.h>

// With a tolerance: on average, of those on the open face.
enum { SITES_A_PATCH = 40 };

// Products of links between patches that are left out, at a tolerance of 1. The less
// are left out, the fewer solutions are needed.
static const double LEFT_OUT = 3e-5;

// Diffusion in the gas and at the wall in series (Bosanquet): 1/D + 1/D_K, where D_K
// grows with the radius.
static double throat_conductance(const struct network *network, int throat,
                                 double length, double knudsen_radius)
{
    const double radius = network->throat_radius[throat] / length;
    const double slowed = 1 + knudsen_radius / network->throat_radius[throat];
    return M_PI * radius * radius / (network->throat_length[throat] / length) / slowed;
}

// --- the boundary layer ------------------------------------------------------------

static int level_site(const struct boundary_layer *layer, int n_node, int level, int i)
{
    return level == 0 ? layer->exposed[i] : n_node + (level - 1) * layer->n_exposed + i;
}

// Of level LEVEL, along it and to the next: written to LINK; returns how many.
static int link_level(const struct boundary_layer *layer, int n_node, int level,
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

static void link_sites(struct vapour *vapour, int a, int b, double conductance)
{
    if (vapour->tolerance > 0)
        loose_mesh_link(&vapour->loose, a, b, conductance);
    else
        star_mesh_link(&vapour->mesh, a, b, conductance);
}

static void link_air(struct vapour *vapour, int site, double conductance)
{
    if (vapour->tolerance > 0)
        loose_mesh_link_air(&vapour->loose, site, conductance);
    else
        star_mesh_link_air(&vapour->mesh, site, conductance);
}

static void eliminate(struct vapour *vapour, int site)
{
    if (vapour->tolerance > 0)
        loose_mesh_eliminate(&vapour->loose, site);
    else
        star_mesh_eliminate(&vapour->mesh, site);
}

// From the air down: each level is eliminated when the one below is linked to it.
static void add_boundary_layer(struct vapour *vapour,
                               const struct boundary_layer *layer, int n_node)
{
    struct link *link = NEW_ARRAY(struct link, layer->n_exposed + layer->n_lateral);
    for (int i = 0; i < layer->n_exposed; i++)
        link_air(vapour, level_site(layer, n_node, layer->layers - 1, i),
                 layer->area[i] / layer->spacing);
    for (int level = layer->layers - 1; level >= 0; level--) {
        const int n = link_level(layer, n_node, level, link);
        for (int k = 0; k < n; k++)
            link_sites(vapour, link[k].site[0], link[k].site[1], link[k].conductance);
        for (int i = 0; level + 1 < layer->layers && i < layer->n_exposed; i++)
            eliminate(vapour, level_site(layer, n_node, level + 1, i));
    }
    vapour_forget_changes(vapour);
    free(link);
}

// --- with a tolerance --------------------------------------------------------------

// All throats that may ever be gas, and the boundary layer, which is.
static struct potential make_potential(const struct network *network,
                                       const double *conductance,
                                       const struct boundary_layer *layer, int n_site)
{
    const size_t a_level = (size_t)layer->n_exposed + (size_t)layer->n_lateral;
    struct link *link = NEW_ARRAY(struct link, (size_t)network->n_throat +
                                                   a_level * (size_t)layer->layers);
    double *air = NEW_ARRAY(double, n_site);
    int n = 0;
    for (int t = 0; t < network->n_throat; t++)
        if (conductance[t] > 0)
            link[n++] = (struct link){
                {network->throat_nodes[t][0], network->throat_nodes[t][1]},
                conductance[t]};
    for (int level = 0; level < layer->layers; level++)
        n += link_level(layer, network->n_node, level, link + n);
    for (int i = 0; i < layer->n_exposed; i++)
        air[level_site(layer, network->n_node, layer->layers - 1, i)] =
            layer->area[i] / layer->spacing;
    struct potential potential = potential_make(n_site, n, link, air);
    for (int site = network->n_node; site < n_site; site++)
        potential_free_site(&potential, site);
    free(link);
    free(air);
    return potential;
}

// Columns along axis AXIS below and above squares of the open face.
static int *find_patches(const struct network *network,
                         const struct boundary_layer *layer, int axis, int n_site)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const struct vector lower = network->packing.lower;
    const struct vector extent = subtract(network->packing.upper, lower);
    const double side = sqrt(component(extent, u) * component(extent, v) *
                             SITES_A_PATCH / layer->n_exposed);
    int *patch = NEW_ARRAY(int, n_site);
    if (!(side > 0)) return patch;
    const int across = 1 + (int)(component(extent, u) / side);
    for (int i = 0; i < n_site; i++) {
        const int above =
            i < network->n_node ? 0 : (i - network->n_node) % layer->n_exposed;
        const int node = i < network->n_node ? i : layer->exposed[above];
        const struct vector at = subtract(network->node_position[node], lower);
        patch[i] =
            (int)(component(at, u) / side) + across * (int)(component(at, v) / side);
    }
    return patch;
}

// The mesh goes on from what a solution gives. Its own balances, changes that wait to
// be reported, and links left out since, have part of the tolerance each.
static void put_right(struct vapour *vapour)
{
    struct loose_mesh *mesh = &vapour->loose;
    const double least = 0.1 * vapour->tolerance * loose_mesh_rate(mesh);
    vapour->n_solutions++;
    vapour->failed |= !potential_solve(&vapour->potential, least);
    loose_mesh_begin_air(mesh);
    for (int i = 0; i < vapour->n_site; i++)
        if (!potential_is_free(&vapour->potential, i))
            loose_mesh_put_air(mesh, i, potential_inflow(&vapour->potential, i));
    loose_mesh_end_air(mesh, vapour->potential.rate);
}

struct vapour vapour_make(const struct network *network, int axis, double length,
                          double knudsen_radius, const struct boundary_layer *layer,
                          double tolerance)
{
    struct vapour vapour = {.n_site = network->n_node +
                                      (layer->layers - 1) * layer->n_exposed,
                            .conductance = NEW_ARRAY(double, network->n_throat),
                            .tolerance = tolerance};
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK)
            vapour.conductance[t] =
                throat_conductance(network, t, length, knudsen_radius);
    if (tolerance > 0) {
        vapour.potential =
            make_potential(network, vapour.conductance, layer, vapour.n_site);
        vapour.patch = find_patches(network, layer, axis, vapour.n_site);
        vapour.loose = loose_mesh_make(vapour.n_site, vapour.patch,
                                       LEFT_OUT * tolerance, 0.2 * tolerance);
    } else {
        vapour.mesh = star_mesh_make(vapour.n_site);
    }
    add_boundary_layer(&vapour, layer, network->n_node);
    return vapour;
}

void vapour_free(struct vapour *vapour)
{
    if (vapour->tolerance > 0) {
        loose_mesh_free(&vapour->loose);
        potential_free(&vapour->potential);
    } else {
        star_mesh_free(&vapour->mesh);
    }
    free(vapour->patch);
    free(vapour->conductance);
    *vapour = (struct vapour){0};
}

// --- drying ------------------------------------------------------------------------

void vapour_open_throat(struct vapour *vapour, int throat, int a, int b)
{
    link_sites(vapour, a, b, vapour->conductance[throat]);
}

void vapour_dry_node(struct vapour *vapour, int node)
{
    eliminate(vapour, node);
    if (vapour->tolerance > 0) potential_free_site(&vapour->potential, node);
}

bool vapour_settle(struct vapour *vapour)
{
    const struct loose_mesh *mesh = &vapour->loose;
    // What is lost is missing where it belongs, and the scale adds it elsewhere.
    if (vapour->tolerance > 0 && compensated_value(mesh->all_air) > 0 &&
        2 * mesh->lost > 0.6 * vapour->tolerance * loose_mesh_rate(mesh))
        put_right(vapour);
    return !vapour->failed;
}

double vapour_rate(const struct vapour *vapour)
{
    return vapour->tolerance > 0 ? loose_mesh_rate(&vapour->loose)
                                 : compensated_value(vapour->mesh.all_air);
}

double vapour_evaporation(const struct vapour *vapour, int node)
{
    return vapour->tolerance > 0 ? loose_mesh_air(&vapour->loose, node)
                                 : vapour->mesh.air[node];
}

double vapour_scale(const struct vapour *vapour)
{
    return vapour->tolerance > 0 ? loose_mesh_scale(&vapour->loose) : 1;
}

const int *vapour_changes(const struct vapour *vapour, int *n)
{
    *n = vapour->tolerance > 0 ? vapour->loose.n_changed : vapour->mesh.n_changed;
    return vapour->tolerance > 0 ? vapour->loose.changed : vapour->mesh.changed;
}

void vapour_forget_changes(struct vapour *vapour)
{
    if (vapour->tolerance > 0)
        loose_mesh_forget_changes(&vapour->loose);
    else
        star_mesh_forget_changes(&vapour->mesh);
}
