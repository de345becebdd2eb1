// SPDX-License-Identifier: GPL-3.0-or-later
// From a packing to its network. The diagram of the grains and of their images (mirror
// images in walls, copies in periodic directions) contains, seen from the grains
// alone, the diagram in the box. How many images are needed is not known in advance:
// the reach starts small and doubles until no cell of a grain could change
// (nodes.complete). Then throats and faces are read off the triangulation, bodies cut
// the network, cut cells are removed, and a layer is reduced to its plane.
#include "diagram.h"

#include "assemble.h"
#include "basics/memory.h"
#include "cut.h"
#include "network/throat_shapes.h"
#include "remove_cells.h"
#include "surface_marks.h"

#include <stdlib.h>

// Images of grains farther from a side than this many units are made only when the
// cells show that they are needed.
static const double FIRST_REACH = 2;

// Whether a larger reach would give no more images: each grain is reflected in each
// wall, and copied as far as image numbers allow.
static bool all_images(const struct generators *generators)
{
    for (int axis = 0; axis < 3; axis++) {
        const double edge = component(generators->box, axis);
        const double most = generators->repeats[axis] ? FARTHEST_IMAGE * edge : edge;
        if (generators->reach < most) return false;
    }
    return true;
}

// Centres in one plane, half way between walls: then those walls are half way between
// layers.
static enum status check_layer(const struct packing *packing, struct reason *reason)
{
    const double middle = 0.5 * (packing->lower.y + packing->upper.y);
    const double thickness = packing->upper.y - packing->lower.y;
    if (packing->periodic[1])
        return refuse(reason, STATUS_BAD_DATA,
                      "/domain/periodic: row 1: dimensions=2 needs walls along y");
    for (int i = 0; i < packing->n_particle; i++)
        if (fabs(packing->position[i].y - middle) > 1e-9 * thickness)
            return refuse(reason, STATUS_BAD_DATA,
                          "/particles/position: row %d: dimensions=2 needs all centres "
                          "half way between the walls y, at %g m, got %g m",
                          i, middle, packing->position[i].y);
    return STATUS_OK;
}

// Grains inside a larger one, which have no cell in a power diagram.
static int count_hidden(const struct generators *generators,
                        const struct triangulation *triangulation)
{
    bool *used = NEW_ARRAY(bool, generators->n);
    for (int c = 0; c < triangulation->n_cell; c++)
        for (int k = 0; k < 4; k++)
            used[triangulation->cell[c].vertex[k]] = true;
    int hidden = 0;
    for (int i = 0; i < generators->n; i++)
        hidden += is_grain(generators, i) && !used[i];
    free(used);
    return hidden;
}

// Doubles the reach of the images until none that is left out could cut the cell of a
// grain: until those cells lie inside the walls, and clear of the images left out.
static enum status triangulate_in_box(const struct packing *packing, bool power,
                                      struct generators *generators,
                                      struct triangulation *triangulation,
                                      struct nodes *nodes, struct reason *reason)
{
    double reach = FIRST_REACH;
    for (;;) {
        enum status status =
            place_generators(packing, reach, power, generators, reason);
        if (status) return status;
        const bool spans =
            !triangulate(generators->point, generators->n, triangulation);
        if (spans) status = find_nodes(generators, triangulation, nodes, reason);
        if (status || (spans && nodes->complete)) return status;
        if (all_images(generators))
            return spans ? STATUS_OK
                         : refuse(reason, STATUS_BAD_DATA,
                                  "the grains do not span three dimensions");
        nodes_free(nodes);
        triangulation_free(triangulation);
        generators_free(generators);
        reach *= 2;
    }
}

// Moves grains into a periodic box: the images of nodes are relative to these places.
static void move_inside(struct packing *packing)
{
    for (int i = 0; i < packing->n_particle; i++)
        for (int axis = 0; axis < 3; axis++) {
            const double lower = component(packing->lower, axis);
            const double edge = component(packing->upper, axis) - lower;
            const double x = component(packing->position[i], axis);
            if (packing->periodic[axis] && (x < lower || x >= lower + edge))
                set_component(&packing->position[i], axis,
                              x - edge * floor((x - lower) / edge));
        }
}

static void copy_packing(const struct packing *from, struct packing *to)
{
    *to = *from;
    to->position =
        duplicate(from->position, (size_t)from->n_particle, sizeof *to->position);
    to->radius = duplicate(from->radius, (size_t)from->n_particle, sizeof *to->radius);
    if (from->kind) to->kind = duplicate(from->kind, (size_t)from->n_particle, 1);
    to->bond = duplicate(from->bond, (size_t)from->n_bond, sizeof *to->bond);
    to->bond_strength = copy_bond_strengths(from);
    move_inside(to);
}

// Moves PACKING, so that its lower corner is at the origin: places have their digits
// there.
static void move_to_origin(struct packing *packing)
{
    const struct vector from = packing->lower;
    for (int i = 0; i < packing->n_particle; i++)
        packing->position[i] = subtract(packing->position[i], from);
    for (int k = 0; k < packing->n_body; k++) {
        packing->body[k].lower = subtract(packing->body[k].lower, from);
        packing->body[k].upper = subtract(packing->body[k].upper, from);
    }
    packing->upper = subtract(packing->upper, from);
    packing->lower = (struct vector){0};
}

// Puts the grains where the generators are: on their grid, to which nodes belong.
static void take_generators(const struct generators *generators,
                            struct packing *packing)
{
    for (int i = 0; i < generators->n; i++)
        if (is_grain(generators, i))
            packing->position[generators->origin[i].base] =
                scale(generators->unit, generators->point[i].at);
}

// Moves NETWORK, whose packing is at the origin, to where PACKING is; what lies on an
// upper wall to exactly where the box says. (Where auxiliary grains are, nodes of an
// upper wall may lie below it.)
static void move_back(const struct packing *packing, struct network *network)
{
    const struct vector wall = network->packing.upper;
    for (int i = 0; i < network->n_node; i++) {
        const struct vector from = network->node_position[i];
        struct vector *at = &network->node_position[i];
        *at = add(packing->lower, from);
        for (int axis = 0; axis < 3; axis++)
            if (component(from, axis) == component(wall, axis))
                set_component(at, axis, component(packing->upper, axis));
    }
    packing_free(&network->packing);
    copy_packing(packing, &network->packing);
}

// Moves the nodes to the network, in m.
static void move_nodes(struct nodes *nodes, const struct generators *generators,
                       struct network *network)
{
    const struct packing *packing = &network->packing;
    network->n_node = nodes->n;
    network->node_walls = nodes->walls;
    network->node_position = nodes->position;
#pragma omp parallel for
    for (int i = 0; i < nodes->n; i++) {
        struct vector *at = &network->node_position[i];
        *at = add(packing->lower, scale(generators->unit, *at));
        for (int axis = 0; axis < 3; axis++) // upper walls exactly where the box says
            if (nodes->walls[i] & (2 << 2 * axis))
                set_component(at, axis, component(packing->upper, axis));
    }
    *nodes = (struct nodes){0};
}

static int count_closed(const struct network *network)
{
    int closed = 0;
    for (int t = 0; t < network->n_throat; t++)
        closed += network->throat_radius[t] == 0;
    return closed;
}

// The grains of PACKING in units, at the rounded positions of the generators.
static struct sphere_cells cells_in_units(const struct generators *generators,
                                          const struct packing *packing)
{
    const int n = packing->n_particle;
    struct packing scaled = *packing;
    scaled.position = NEW_ARRAY(struct vector, n);
    scaled.radius = NEW_ARRAY(double, n);
    scaled.lower = (struct vector){0};
    scaled.upper = generators->box;
    for (int i = 0; i < generators->n; i++)
        if (is_grain(generators, i))
            scaled.position[generators->origin[i].base] = generators->point[i].at;
    for (int i = 0; i < n; i++)
        scaled.radius[i] = packing->radius[i] / generators->unit;
    struct sphere_cells cells = sphere_cells_init(&scaled);
    free(scaled.position);
    free(scaled.radius);
    return cells;
}

// The network of the packing that NETWORK has.
static void assemble(const struct generators *generators,
                     const struct triangulation *triangulation, struct nodes *nodes,
                     enum clearance clearance, struct network *network)
{
    double *radius = NEW_ARRAY(double, generators->n);
    for (int i = 0; i < generators->n; i++)
        radius[i] =
            network->packing.radius[generators->origin[i].particle] / generators->unit;
    struct assembly assembly = {
        generators, triangulation, nodes,
        radius,     clearance,     cells_in_units(generators, &network->packing)};
    assemble_throats(&assembly, network);
    assemble_faces(&assembly, network);
    move_nodes(nodes, generators, network);
    sphere_cells_free(&assembly.grains);
    free(radius);
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
    if (packing->n_particle == 0)
        return refuse(reason, STATUS_BAD_DATA, "/particles/position: no grains");
    enum status status = how->layer ? check_layer(packing, reason) : STATUS_OK;
    if (status) return status;
    status = triangulate_in_box(packing, how->power, &generators, &triangulation,
                                &nodes, reason);
    if (!status) report->hidden = count_hidden(&generators, &triangulation);
    if (!status && report->hidden) status = check_distinct(&generators, reason);
    if (!status) {
        copy_packing(packing, &network->packing);
        if (packing->n_body) move_to_origin(&network->packing);
        assemble(&generators, &triangulation, &nodes, how->clearance, network);
        if (packing->n_body) take_generators(&generators, &network->packing);
    }
    nodes_free(&nodes);
    triangulation_free(&triangulation);
    generators_free(&generators);
    for (int k = 0; k < packing->n_body && !status; k++)
        status = cut_network(network, k, how->clearance, reason);
    report->n_cell = packing->n_particle - report->hidden;
    if (!status && how->shapes) status = find_throat_shapes(network, reason);
    if (!status && how->entry)
        status = find_entry_radii(network, how->contact_angle, reason);
    if (!status) mark_boundary_layer(network, how->layer);
    if (!status && how->boundary == BOUNDARY_ELIMINATE)
        report->n_cell = eliminate_cut_cells(network, how->layer);
    if (!status && !report->n_cell)
        status = refuse(reason, STATUS_BAD_DATA,
                        "boundary=eliminate leaves no cell: the box cuts all of them");
    if (!status && how->layer) reduce_to_plane(network);
    if (!status && packing->n_body) move_back(packing, network);
    report->n_closed = count_closed(network);
    if (status) network_free(network);
    return status;
}
