// SPDX-License-Identifier: GPL-3.0-or-later
// A finite-volume lattice above the open surface [K 3.3.5, Fig. 3.44]. Column i stands
// on node exposed[i] and has the Voronoi cell of that node on the surface as
// cross-section:
//     conductance along the column    area[i] / spacing
//     between neighbouring columns    lateral_width spacing / lateral_length,
// half of the latter at level 0, where only half a cell lies in the gas. The areas sum
// to the open surface whatever the network, so that a wet surface dries at area /
// thickness. Nodes behind one another, seen along the columns, share one column. A
// column whose cell lies over a hole of the surface has no area and is dropped; then
// the diagram is computed again.
#include "boundary_layer.h"

#include "basics/memory.h"
#include "open_surface.h"
#include "planar_cells.h"

#include <limits.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

// ---- the feet of the columns --------------------------------------------------------

void boundary_feet_mark(const struct network *network, int wall,
                        enum boundary_feet feet, bool *foot)
{
    enum { IN_NETWORK = 1, IN_LAYER = 2 };
    uint8_t *throats = NEW_ARRAY(uint8_t, network->n_node);
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2; end++) {
            uint8_t *here = &throats[network->throat_nodes[t][end]];
            if (network->throat_kind[t] == THROAT_NETWORK) *here |= IN_NETWORK;
            if (network->throat_kind[t] == THROAT_BOUNDARY_LAYER) *here |= IN_LAYER;
        }
    for (int i = 0; i < network->n_node; i++)
        foot[i] = throats[i] & IN_NETWORK &&
                  (feet == FEET_SURFACE ? network->node_walls[i] >> wall & 1
                                        : throats[i] & IN_LAYER);
    free(throats);
}

// Where a foot is on the face, rounded to a grid so fine that two separate columns
// never share a cell of it.
struct spot {
    int64_t x, y;
    double depth; // from the outermost inwards
    int node;
};

static int compare_spots(const void *a, const void *b)
{
    const struct spot *s = a, *t = b;
    if (s->x != t->x) return s->x < t->x ? -1 : 1;
    if (s->y != t->y) return s->y < t->y ? -1 : 1;
    if (s->depth != t->depth) return s->depth < t->depth ? -1 : 1;
    return (s->node > t->node) - (s->node < t->node);
}

// Whether only rounding separates the two: each column needs a cell of its own.
static bool same_spot(const struct spot *s, const struct spot *t)
{
    return s->x == t->x && s->y == t->y;
}

// Clears the marks of nodes that lie right behind another.
static void keep_outermost(const struct open_surface *face, int n_marked, bool *foot)
{
    const struct network *network = face->network;
    const struct planar size = face->region.rectangle.size;
    const double step = 1e-9 * sqrt(size.x * size.y / n_marked);
    const double outwards = face->wall % 2 ? 1 : -1;
    struct spot *spot = NEW_ARRAY(struct spot, n_marked);
    int n = 0;
    for (int i = 0; i < network->n_node; i++) {
        if (!foot[i]) continue;
        const struct planar at = place_on_face(face, i);
        spot[n++] = (struct spot){
            llround(at.x / step), llround(at.y / step),
            -outwards * component(network->node_position[i], face->wall / 2), i};
    }
    qsort(spot, (size_t)n, sizeof *spot, compare_spots);
    for (int k = 1; k < n; k++)
        if (same_spot(&spot[k], &spot[k - 1])) foot[spot[k].node] = false;
    free(spot);
}

static enum status find_feet(const struct open_surface *face, enum boundary_feet feet,
                             struct boundary_layer *layer, struct reason *reason)
{
    static const char *const names[] = {"-x", "+x", "-y", "+y", "-z", "+z"};
    const struct network *network = face->network;
    bool *foot = NEW_ARRAY(bool, network->n_node);
    boundary_feet_mark(network, face->wall, feet, foot);
    int n_marked = 0;
    for (int i = 0; i < network->n_node; i++)
        n_marked += foot[i];
    layer->exposed = NEW_ARRAY(int, n_marked);
    if (n_marked) keep_outermost(face, n_marked, foot);
    for (int i = 0; i < network->n_node; i++)
        if (foot[i]) layer->exposed[layer->n_exposed++] = i;
    free(foot);
    if (n_marked) return STATUS_OK;
    return feet == FEET_SURFACE
               ? refuse(reason, STATUS_BAD_DATA, "no throat reaches the open wall %s%s",
                        names[face->wall],
                        packing_is_round_across(&network->packing, face->wall / 2)
                            ? ": the body is round there, and dries through flat sides "
                              "of the box alone"
                            : "")
               : refuse(reason, STATUS_BAD_DATA,
                        "/throats/kind: no throat of the boundary layer begins at the "
                        "network (pack.extra_layer makes them)");
}

// ---- levels and exchange areas ------------------------------------------------------

enum { MAX_LAYERS = 10000 }; // the range of boundary_layer.layers

static enum status choose_layers(double thickness, int layers, int n_node,
                                 struct boundary_layer *layer, struct reason *reason)
{
    const double wanted = layers > 0 ? layers : fmax(1, round(thickness));
    // Levels and the network's nodes are numbered together, and each site may have many
    // links: leave room in an int.
    if (wanted > MAX_LAYERS)
        return refuse(
            reason, STATUS_BAD_DATA,
            "the boundary layer is %g throats thick: give boundary_layer.layers, at "
            "most %d",
            wanted, MAX_LAYERS);
    if (wanted * layer->n_exposed + n_node > INT_MAX / 16)
        return refuse(reason, STATUS_BAD_DATA,
                      "layers: %g over %d exposed nodes are too many", wanted,
                      layer->n_exposed);
    layer->layers = (int)wanted;
    layer->spacing = thickness / layer->layers;
    return STATUS_OK;
}

static struct planar_cells cells_of(const struct open_surface *face,
                                    const struct boundary_layer *layer)
{
    struct planar *place = NEW_ARRAY(struct planar, layer->n_exposed);
    for (int i = 0; i < layer->n_exposed; i++)
        place[i] = place_on_face(face, layer->exposed[i]);
    const struct planar_cells cells =
        planar_cells_init(place, layer->n_exposed, &face->region);
    free(place);
    return cells;
}

// Drops columns without area: they stand over holes of the face. Returns how many.
static int drop_empty(const double *area, struct boundary_layer *layer)
{
    double total = 0;
    for (int i = 0; i < layer->n_exposed; i++)
        total += area[i];
    int kept = 0;
    const int before = layer->n_exposed;
    for (int i = 0; i < before; i++)
        if (area[i] > 1e-12 * total / before)
            layer->exposed[kept++] = layer->exposed[i];
    layer->n_exposed = kept;
    return before - kept;
}

static void find_areas(const struct open_surface *face, bool lateral,
                       struct boundary_layer *layer)
{
    struct planar_cells cells = cells_of(face, layer);
    while (drop_empty(cells.area, layer)) {
        planar_cells_free(&cells);
        cells = cells_of(face, layer);
    }
    layer->area = cells.area;
    cells.area = NULL;
    layer->n_lateral = lateral ? cells.n_edge : 0;
    layer->lateral = allocate((size_t)layer->n_lateral, sizeof *layer->lateral);
    layer->lateral_conductance = NEW_ARRAY(double, layer->n_lateral);
    layer->lateral_width = NEW_ARRAY(double, layer->n_lateral);
    layer->lateral_length = NEW_ARRAY(double, layer->n_lateral);
    layer->lateral_edge =
        allocate((size_t)layer->n_lateral, sizeof *layer->lateral_edge);
    for (int k = 0; k < layer->n_lateral; k++) {
        const struct planar_edge *edge = &cells.edge[k];
        for (size_t end = 0; end < 2; end++) {
            layer->lateral[k][end] = edge->point[end];
            layer->lateral_edge[k][2 * end] =
                face->corner.x / face->unit + edge->end[end].x;
            layer->lateral_edge[k][2 * end + 1] =
                face->corner.y / face->unit + edge->end[end].y;
        }
        layer->lateral_width[k] = edge->width;
        layer->lateral_length[k] = edge->distance;
        layer->lateral_conductance[k] = edge->width * layer->spacing / edge->distance;
    }
    planar_cells_free(&cells);
}

enum status boundary_layer_init(const struct network *network, int wall, double length,
                                double thickness, const struct boundary_form *form,
                                struct boundary_layer *layer, struct reason *reason)
{
    *layer = (struct boundary_layer){0};
    if (network->packing.periodic[wall / 2])
        return refuse(reason, STATUS_BAD_DATA,
                      "/domain/periodic: the open wall cannot be on an axis along "
                      "which the box is periodic, %c: open another side, or cut the "
                      "body across z by pack.slab.lower and pack.slab.upper",
                      "xyz"[wall / 2]);

    struct open_surface face = open_surface_of(network, wall, length);
    enum status status = find_feet(&face, form->feet, layer, reason);
    if (!status)
        status = choose_layers(thickness, form->lumped ? 1 : form->layers,
                               network->n_node, layer, reason);
    if (!status) find_areas(&face, !form->lumped, layer);
    open_surface_free(&face);
    layer->wall = NEW_ARRAY(uint8_t, layer->n_exposed);
    memset(layer->wall, wall, (size_t)layer->n_exposed);
    return status;
}

// ---- on several walls ---------------------------------------------------------------

// Appends the N_MORE rows of MORE to the N rows of ARRAY, which may move.
static void *append_rows(void *array, int n, const void *more, int n_more, size_t size)
{
    array = reallocate(array, (size_t)n + (size_t)n_more, size);
    if (n_more > 0)
        memcpy((char *)array + (size_t)n * size, more, (size_t)n_more * size);
    return array;
}

#define APPEND(member, count)                                                          \
    to->member = append_rows(to->member, to->count, more->member, more->count,         \
                             sizeof *to->member)

static void append_layer(struct boundary_layer *to, const struct boundary_layer *more)
{
    APPEND(lateral, n_lateral);
    APPEND(lateral_conductance, n_lateral);
    APPEND(lateral_width, n_lateral);
    APPEND(lateral_length, n_lateral);
    APPEND(lateral_edge, n_lateral);
    for (int k = 0; k < more->n_lateral; k++)
        for (int end = 0; end < 2; end++)
            to->lateral[to->n_lateral + k][end] += to->n_exposed;
    APPEND(exposed, n_exposed);
    APPEND(wall, n_exposed);
    APPEND(area, n_exposed);
    to->n_exposed += more->n_exposed;
    to->n_lateral += more->n_lateral;
    to->layers = more->layers;
    to->spacing = more->spacing;
}

enum status boundary_layers_init(const struct network *network, unsigned walls,
                                 double length, double thickness,
                                 const struct boundary_form *form,
                                 struct boundary_layer *layer, struct reason *reason)
{
    *layer = (struct boundary_layer){0};
    enum status status = STATUS_OK;
    for (int wall = 0; !status && wall < WALL_COUNT; wall++) {
        if (!(walls >> wall & 1)) continue;
        struct boundary_layer more;
        status =
            boundary_layer_init(network, wall, length, thickness, form, &more, reason);
        if (!status) append_layer(layer, &more);
        boundary_layer_free(&more);
    }
    return status;
}

void boundary_layer_free(struct boundary_layer *layer)
{
    free(layer->exposed);
    free(layer->wall);
    free(layer->area);
    free(layer->lateral);
    free(layer->lateral_conductance);
    free(layer->lateral_width);
    free(layer->lateral_length);
    free(layer->lateral_edge);
    *layer = (struct boundary_layer){0};
}
