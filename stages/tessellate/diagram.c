// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagram.h"

#include "assemble.h"
#include "basics/memory.h"

#include <stdlib.h>

// Images of grains farther from a wall than this many mean spacings are made only when
// the cells show that they are needed.
static const double first_reach = 2;

// The edge of the box's share of a grain, or the diameter where grains overlap that
// much; mean diameters.
static double mean_spacing(const struct packing *packing)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    const double diameter = mean_diameter(packing);
    const double share = edge.x / diameter * (edge.y / diameter) * (edge.z / diameter);
    return fmax(1, cbrt(share / packing->n_particle));
}

static enum status check_packing(const struct packing *packing, struct reason *reason)
{
    if (packing->n_particle == 0)
        return refuse(reason, STATUS_BAD_DATA, "/particles/position: no grains");
    for (int axis = 0; axis < 3; axis++)
        if (packing->periodic[axis])
            return refuse(
                reason, STATUS_BAD_DATA,
                "/domain/periodic: row %d: periodic boxes cannot be tessellated "
                "yet; pack with periodic=[false,false,false]",
                axis);
    return STATUS_OK;
}

// Grains inside a larger one, which have no cell in a power diagram.
static int count_hidden(const struct generators *generators,
                        const struct triangulation *triangulation)
{
    bool *used = NEW_ARRAY(bool, generators->n);
    for (int c = 0; c < triangulation->n_cell; c++)
        for (int k = 0; k < 4; k++)
            used[triangulation->vertex[c][k]] = true;
    int hidden = 0;
    for (int i = 0; i < generators->n_particle; i++)
        hidden += !used[i];
    free(used);
    return hidden;
}

// Reflects ever deeper layers until the cells of all grains lie inside the box: then
// the images left out could not have cut them.
static enum status triangulate_in_box(const struct packing *packing, bool power,
                                      struct generators *generators,
                                      struct triangulation *triangulation,
                                      struct nodes *nodes, struct reason *reason)
{
    double reach = first_reach * mean_spacing(packing);
    for (;;) {
        const enum status status =
            mirror_grains(packing, reach, power, generators, reason);
        if (status) return status;
        if (triangulate(generators->position, power ? generators->weight : NULL,
                        generators->n, triangulation))
            return refuse(reason, STATUS_BAD_DATA,
                          "the grains do not span three dimensions");
        *nodes = find_nodes(generators, triangulation);
        const bool all = generators->n == generators->n_particle * (1 + WALL_COUNT);
        if (nodes->farthest_outside == 0 || all) return STATUS_OK;
        nodes_free(nodes);
        triangulation_free(triangulation);
        generators_free(generators);
        reach *= 2;
    }
}

static void copy_packing(const struct packing *from, struct packing *to)
{
    *to = *from;
    to->position =
        duplicate(from->position, (size_t)from->n_particle, sizeof *to->position);
    to->radius = duplicate(from->radius, (size_t)from->n_particle, sizeof *to->radius);
    to->bond = duplicate(from->bond, (size_t)from->n_bond, sizeof *to->bond);
}

static void copy_nodes(const struct nodes *nodes, const struct generators *generators,
                       struct network *network)
{
    const struct packing *packing = &network->packing;
    network->n_node = nodes->n;
    network->node_walls = duplicate(nodes->walls, (size_t)nodes->n, 1);
    network->node_position = NEW_ARRAY(struct vector, nodes->n);
    for (int i = 0; i < nodes->n; i++) {
        network->node_position[i] =
            add(packing->lower, scale(generators->unit, nodes->position[i]));
        for (int axis = 0; axis < 3; axis++) // upper walls exactly where the box says
            if (nodes->walls[i] & (2 << 2 * axis))
                set_component(&network->node_position[i], axis,
                              component(packing->upper, axis));
    }
}

enum status tessellate(const struct packing *packing, const struct tessellation *how,
                       struct network *network, struct tessellation_report *report,
                       struct reason *reason)
{
    struct generators generators = {0};
    struct triangulation triangulation = {0};
    struct nodes nodes = {0};
    *network = (struct network){0};
    *report = (struct tessellation_report){0};
    enum status status = check_packing(packing, reason);
    if (!status)
        status = triangulate_in_box(packing, how->power, &generators, &triangulation,
                                    &nodes, reason);
    if (!status) {
        report->hidden = count_hidden(&generators, &triangulation);
        double *radius = NEW_ARRAY(double, packing->n_particle);
        for (int i = 0; i < packing->n_particle; i++)
            radius[i] = packing->radius[i] / generators.unit;
        const struct assembly assembly = {&generators, &triangulation, &nodes, radius,
                                          how->clearance};
        copy_packing(packing, &network->packing);
        copy_nodes(&nodes, &generators, network);
        report->n_closed = assemble_throats(&assembly, network);
        assemble_faces(&assembly, network);
        free(radius);
    }
    nodes_free(&nodes);
    triangulation_free(&triangulation);
    generators_free(&generators);
    return status;
}
