// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary_layer.h"

#include "basics/memory.h"

#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>

struct planar {
    double x, y;
};

// One edge of one face on the wall (of a layer: one throat in it), between two exposed
// nodes.
struct wall_edge {
    int node[2]; // indices into exposed, lower first
    int face;
    double width, length;
};

struct survey {
    const struct network *network;
    int wall;
    double length;
    int *index_of; // (n_node) into exposed, -1 where not exposed
    double *area;  // (n_exposed)
    double spare;  // area of faces without an exposed node
    struct wall_edge *edge;
    int n_edge, edge_capacity;
};

static double cross_product(struct planar a, struct planar b)
{
    return a.x * b.y - a.y * b.x;
}

static struct planar difference(struct planar a, struct planar b)
{
    return (struct planar){a.x - b.x, a.y - b.y};
}

// The face's nodes in the plane of the wall, in scaled lengths about the foot of the
// grain's centre; about their mean if the foot lies outside the face, as it may between
// unequal grains, where triangles from the foot would overlap.
static void face_polygon(const struct survey *survey, int face, struct planar *corner)
{
    const struct network *network = survey->network;
    const int64_t begin = network->face_offset[face];
    const int n = (int)(network->face_offset[face + 1] - begin);
    const int axis = survey->wall / 2;
    const struct vector centre =
        network->packing.position[network->face_particles[face][0]];
    struct planar mean = {0};
    for (int k = 0; k < n; k++) {
        const struct vector apart = subtract(face_corner(network, begin + k), centre);
        corner[k].x = component(apart, (axis + 1) % 3);
        corner[k].y = component(apart, (axis + 2) % 3);
        corner[k] =
            (struct planar){corner[k].x / survey->length, corner[k].y / survey->length};
        mean = (struct planar){mean.x + corner[k].x / n, mean.y + corner[k].y / n};
    }

    double area = 0;
    for (int k = 0; k < n; k++)
        area += cross_product(corner[k], corner[(k + 1) % n]);
    bool inside = true;
    for (int k = 0; k < n; k++)
        inside &= cross_product(corner[k], corner[(k + 1) % n]) * area >= 0;
    if (!inside)
        for (int k = 0; k < n; k++)
            corner[k] = difference(corner[k], mean);
}

// Gives each exposed node of the face its area of it.
static void share_area(struct survey *survey, const int32_t *node,
                       const struct planar *corner, int n)
{
    double total = 0, exposed_total = 0;
    int n_exposed = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < n; k++) {
            const double own = (cross_product(corner[(k + n - 1) % n], corner[k]) +
                                cross_product(corner[k], corner[(k + 1) % n])) /
                               4;
            const int i = survey->index_of[node[k]];
            if (pass == 0) {
                total += own;
                exposed_total += i >= 0 ? own : 0;
                n_exposed += i >= 0;
            } else if (i >= 0) {
                const double share =
                    exposed_total != 0 ? own / exposed_total : 1.0 / n_exposed;
                survey->area[i] += fabs(own + share * (total - exposed_total));
            }
        }
    if (n_exposed == 0) survey->spare += fabs(total);
}

static void add_edge(struct survey *survey, int face, int i, int j, double width,
                     double length)
{
    if (i < 0 || j < 0 || i == j) return;
    GROW_ARRAY(survey->edge, survey->n_edge, survey->edge_capacity);
    survey->edge[survey->n_edge++] =
        (struct wall_edge){.node = {i < j ? i : j, i < j ? j : i},
                           .face = face,
                           .width = width,
                           .length = length};
}

static void survey_face(struct survey *survey, int face)
{
    const struct network *network = survey->network;
    const int32_t *node = network->face_nodes + network->face_offset[face];
    const int n = (int)(network->face_offset[face + 1] - network->face_offset[face]);
    struct planar *corner = NEW_ARRAY(struct planar, n);
    face_polygon(survey, face, corner);
    share_area(survey, node, corner, n);
    for (int k = 0; k < n; k++) {
        const struct planar a = corner[k], b = corner[(k + 1) % n];
        add_edge(survey, face, survey->index_of[node[k]],
                 survey->index_of[node[(k + 1) % n]], hypot(a.x + b.x, a.y + b.y) / 2,
                 hypot(b.x - a.x, b.y - a.y));
    }
    free(corner);
}

// Of a layer of grains: its wall is a strip as wide as the layer is thick, and falls
// into the throats that lie in it, half of each belonging to either end.
static void survey_strip(struct survey *survey)
{
    const struct network *network = survey->network;
    const double width =
        (network->packing.upper.y - network->packing.lower.y) / survey->length;
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *ends = network->throat_nodes[t];
        const unsigned walls =
            network->node_walls[ends[0]] & network->node_walls[ends[1]];
        if (!(walls >> survey->wall & 1)) continue;
        const int i = survey->index_of[ends[0]], j = survey->index_of[ends[1]];
        const double length = norm(along_throat(network, t)) / survey->length;
        const double area = length * width;
        if (i < 0 && j < 0) survey->spare += area;
        if (i >= 0) survey->area[i] += j >= 0 ? area / 2 : area;
        if (j >= 0) survey->area[j] += i >= 0 ? area / 2 : area;
        add_edge(survey, t, i, j, width, length);
    }
}

static int compare_edges(const void *a, const void *b)
{
    const struct wall_edge *e = a, *f = b;
    for (int end = 0; end < 2; end++)
        if (e->node[end] != f->node[end]) return e->node[end] < f->node[end] ? -1 : 1;
    return (e->face > f->face) - (e->face < f->face);
}

// One link for the one or two (or, after merging, more) faces beside each edge.
static enum status join_edges(struct survey *survey, struct boundary_layer *layer,
                              struct reason *reason)
{
    if (survey->n_edge > 0)
        qsort(survey->edge, (size_t)survey->n_edge, sizeof *survey->edge,
              compare_edges);
    layer->lateral = allocate((size_t)survey->n_edge, sizeof *layer->lateral);
    layer->lateral_conductance = NEW_ARRAY(double, survey->n_edge);
    for (int k = 0; k < survey->n_edge; k++) {
        const struct wall_edge *edge = &survey->edge[k];
        const bool same = k > 0 && edge->node[0] == edge[-1].node[0] &&
                          edge->node[1] == edge[-1].node[1];
        if (!(edge->length > 0))
            return refuse(
                reason, STATUS_BAD_DATA,
                "/nodes/position: nodes %d and %d of the open wall are one on "
                "the other (merge-nodes joins them)",
                layer->exposed[edge->node[0]], layer->exposed[edge->node[1]]);
        if (!same) {
            layer->lateral[layer->n_lateral][0] = edge->node[0];
            layer->lateral[layer->n_lateral][1] = edge->node[1];
            layer->n_lateral++;
        }
        layer->lateral_conductance[layer->n_lateral - 1] +=
            edge->width * layer->spacing / edge->length;
    }
    return STATUS_OK;
}

static void find_exposed(const struct network *network, int wall, int *index_of,
                         struct boundary_layer *layer)
{
    for (int i = 0; i < network->n_node; i++)
        index_of[i] = -1;
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2; end++) {
            const int node = network->throat_nodes[t][end];
            if (network->throat_kind[t] == THROAT_NETWORK &&
                (network->node_walls[node] >> wall & 1))
                index_of[node] = 0;
        }
    layer->exposed = NEW_ARRAY(int, network->n_node);
    for (int i = 0; i < network->n_node; i++)
        if (index_of[i] == 0) {
            index_of[i] = layer->n_exposed;
            layer->exposed[layer->n_exposed++] = i;
        }
}

enum { MOST_LAYERS = 10000 }; // the range of boundary_layer.layers

static enum status choose_layers(double thickness, int layers, int n_node,
                                 struct boundary_layer *layer, struct reason *reason)
{
    const double wanted = layers > 0 ? layers : fmax(1, round(thickness));
    // Levels and the network's nodes are numbered together, and each site may have many
    // links: leave room in an int.
    if (wanted > MOST_LAYERS)
        return refuse(
            reason, STATUS_BAD_DATA,
            "the boundary layer is %g throats thick: give boundary_layer.layers, at "
            "most %d",
            wanted, MOST_LAYERS);
    if (wanted * layer->n_exposed + n_node > INT_MAX / 16)
        return refuse(reason, STATUS_BAD_DATA,
                      "layers: %g over %d exposed nodes are too many", wanted,
                      layer->n_exposed);
    layer->layers = (int)wanted;
    layer->spacing = thickness / layer->layers;
    return STATUS_OK;
}

static enum status survey_wall(struct survey *survey, struct boundary_layer *layer,
                               struct reason *reason)
{
    const struct network *network = survey->network;
    if (is_layer(network)) survey_strip(survey);
    for (int face = 0; face < network->n_face; face++)
        if (network->face_particles[face][1] == -1 - survey->wall)
            survey_face(survey, face);

    double exposed_area = 0;
    for (int i = 0; i < layer->n_exposed; i++)
        exposed_area += layer->area[i];
    if (!(exposed_area > 0))
        return refuse(
            reason, STATUS_BAD_DATA,
            "/faces/particles: no face of the open wall meets an exposed node");
    for (int i = 0; i < layer->n_exposed; i++)
        layer->area[i] += survey->spare * layer->area[i] / exposed_area;
    return join_edges(survey, layer, reason);
}

enum status boundary_layer_make(const struct network *network, int wall, double length,
                                double thickness, int layers,
                                struct boundary_layer *layer, struct reason *reason)
{
    *layer = (struct boundary_layer){0};
    if (network->packing.periodic[wall / 2])
        return refuse(
            reason, STATUS_BAD_DATA,
            "/domain/periodic: the open wall cannot be on an axis along which "
            "the box repeats");

    int *index_of = NEW_ARRAY(int, network->n_node);
    find_exposed(network, wall, index_of, layer);
    layer->area = NEW_ARRAY(double, layer->n_exposed);
    struct survey survey = {.network = network,
                            .wall = wall,
                            .length = length,
                            .index_of = index_of,
                            .area = layer->area};
    enum status status =
        layer->n_exposed > 0
            ? choose_layers(thickness, layers, network->n_node, layer, reason)
            : refuse(reason, STATUS_BAD_DATA, "no throat reaches the open wall");
    if (!status) status = survey_wall(&survey, layer, reason);
    free(survey.edge);
    free(index_of);
    return status;
}

void boundary_layer_free(struct boundary_layer *layer)
{
    free(layer->exposed);
    free(layer->area);
    free(layer->lateral);
    free(layer->lateral_conductance);
    *layer = (struct boundary_layer){0};
}
