// SPDX-License-Identifier: GPL-3.0-or-later
// The region of the wall that is open to the air, as a polygon in the plane of the
// wall. Its sides are the edges that belong to one face only: each edge of each face
// is listed with the direction in which the face lies to its left, sorted by its two
// nodes, and those that occur twice with opposite directions cancel. Where the box
// repeats, the faces are the region's parts. Coordinates are in units of UNIT from the
// lower corner; axes follow the wall's normal cyclically, x -> (y, z). Where the faces
// cover the whole rectangle there are no sides at all.
#include "open_surface.h"

#include "basics/memory.h"

#include <stdlib.h>

static int lateral_axis(int wall, int k)
{
    return (wall / 2 + 1 + k) % 3;
}

// The part of the box that the network spans along AXIS; the whole box where it is
// periodic, or where the network is flat.
static void find_span(const struct network *network, int axis, double *lower,
                      double *size)
{
    const struct packing *packing = &network->packing;
    double least = INFINITY, most = -INFINITY;
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2; end++) {
            if (network->throat_kind[t] == THROAT_BOUNDARY_LAYER) continue;
            const double at =
                component(network->node_position[network->throat_nodes[t][end]], axis);
            least = fmin(least, at);
            most = fmax(most, at);
        }
    const double from = component(packing->lower, axis);
    const double box = component(packing->upper, axis) - from;
    const bool flat = !(most - least > 1e-9 * box);
    const bool whole = packing->periodic[axis] || flat;
    *lower = whole ? from : least;
    *size = whole ? box : most - least;
}

static struct planar place_of(const struct open_surface *face, struct vector at)
{
    return (struct planar){
        (component(at, lateral_axis(face->wall, 0)) - face->corner.x) / face->unit,
        (component(at, lateral_axis(face->wall, 1)) - face->corner.y) / face->unit};
}

// Moves X into the rectangle. In a flat network all nodes come to lie on its lower
// side, which gives the same areas as its middle would.
static double within(double x, double size, bool periodic)
{
    return periodic ? x - size * floor(x / size) : fmin(fmax(x, 0), size);
}

struct planar place_on_face(const struct open_surface *face, int node)
{
    const struct rectangle *whole = &face->region.rectangle;
    const struct planar at = place_of(face, face->network->node_position[node]);
    return (struct planar){within(at.x, whole->size.x, whole->periodic_x),
                           within(at.y, whole->size.y, whole->periodic_y)};
}

// ---- the sides of the region --------------------------------------------------------

// An edge of a face in the wall. The face lies to the left of AT[0] -> AT[1].
struct edge {
    int32_t low, high; // its nodes
    bool forward;      // from the lower to the higher
    bool is_last;      // of its face
    struct planar at[2];
};

struct edges {
    struct edge *edge;
    int n, capacity;
    double area; // of the faces
};

static void add_edges(const struct open_surface *face, int f, struct edges *edges)
{
    const struct network *network = face->network;
    const int64_t begin = network->face_offset[f], end = network->face_offset[f + 1];
    const struct planar origin = place_of(face, face_corner(network, begin));
    double area = 0;
    for (int64_t k = begin; k < end; k++) {
        const struct planar a = place_of(face, face_corner(network, k));
        const struct planar b =
            place_of(face, face_corner(network, k + 1 < end ? k + 1 : begin));
        area += ((a.x - origin.x) * (b.y - origin.y) -
                 (a.y - origin.y) * (b.x - origin.x)) /
                2;
    }
    for (int64_t j = begin; j < end; j++) { // counter-clockwise
        const int64_t k = area > 0 ? j : begin + end - 1 - j;
        const int64_t next = k + 1 < end ? k + 1 : begin;
        const int64_t from = area > 0 ? k : next, to = area > 0 ? next : k;
        const int32_t a = network->face_nodes[from], b = network->face_nodes[to];
        GROW_ARRAY(edges->edge, edges->n, edges->capacity);
        edges->edge[edges->n++] =
            (struct edge){a < b ? a : b,
                          a < b ? b : a,
                          a < b,
                          j + 1 == end,
                          {place_of(face, face_corner(network, from)),
                           place_of(face, face_corner(network, to))}};
    }
    edges->area += fabs(area);
}

static int compare_edges(const void *first, const void *second)
{
    const struct edge *a = first, *b = second;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    if (a->high != b->high) return a->high < b->high ? -1 : 1;
    return a->forward - b->forward;
}

static bool near_end(double x, double y, double size)
{
    return fmax(fabs(x), fabs(y)) < 1e-9 * size ||
           fmax(fabs(x - size), fabs(y - size)) < 1e-9 * size;
}

// Where the rectangle is periodic along one axis only, sides at its ends along the
// other bound nothing: there the rectangle itself ends.
static bool lies_at_end(const struct rectangle *whole, const struct planar at[2])
{
    if (whole->periodic_x == whole->periodic_y) return false;
    return whole->periodic_x ? near_end(at[0].y, at[1].y, whole->size.y)
                             : near_end(at[0].x, at[1].x, whole->size.x);
}

// Keeps the edges with a face on one side only.
static void keep_sides(const struct edges *edges, struct planar_region *region)
{
    region->side = allocate((size_t)edges->n, sizeof *region->side);
    for (int k = 0, next; k < edges->n; k = next) {
        const struct edge *edge = &edges->edge[k];
        int forward = 0;
        for (next = k; next < edges->n && edges->edge[next].low == edge->low &&
                       edges->edge[next].high == edge->high;
             next++)
            forward += edges->edge[next].forward;
        if (2 * forward == next - k) continue;
        if (2 * forward > next - k) edge = &edges->edge[next - 1];
        if (lies_at_end(&region->rectangle, edge->at)) continue;
        for (int end = 0; end < 2; end++)
            region->side[region->n_side][end] = edge->at[end];
        region->n_side++;
    }
}

// Takes the faces, whose edges are listed one face after the other, as parts.
static void take_parts(const struct edges *edges, struct planar_region *region)
{
    region->corner = NEW_ARRAY(struct planar, edges->n);
    region->part_offset = NEW_ARRAY(int, edges->n + 1);
    region->extent = allocate((size_t)edges->n, sizeof *region->extent);
    struct planar lower = {INFINITY, INFINITY}, upper = {-INFINITY, -INFINITY};
    for (int k = 0; k < edges->n; k++) {
        const struct planar at = region->corner[k] = edges->edge[k].at[0];
        lower = (struct planar){fmin(lower.x, at.x), fmin(lower.y, at.y)};
        upper = (struct planar){fmax(upper.x, at.x), fmax(upper.y, at.y)};
        if (!edges->edge[k].is_last) continue;
        region->extent[region->n_part][0] = lower;
        region->extent[region->n_part][1] = upper;
        region->part_offset[++region->n_part] = k + 1;
        lower = (struct planar){INFINITY, INFINITY};
        upper = (struct planar){-INFINITY, -INFINITY};
    }
}

// Leaves the region the whole rectangle where the faces cover it, or there are none.
static void find_sides(struct open_surface *face)
{
    const struct network *network = face->network;
    const struct planar size = face->region.rectangle.size;
    struct edges edges = {0};
    for (int f = 0; f < network->n_face; f++)
        if (network->face_particles[f][1] == -1 - face->wall)
            add_edges(face, f, &edges);
    if (edges.n > 0 && edges.area < (1 - 1e-9) * size.x * size.y) {
        if (face->region.rectangle.periodic_x || face->region.rectangle.periodic_y)
            take_parts(&edges, &face->region);
        qsort(edges.edge, (size_t)edges.n, sizeof *edges.edge, compare_edges);
        keep_sides(&edges, &face->region);
    }
    free(edges.edge);
}

struct open_surface open_surface_of(const struct network *network, int wall,
                                    double unit)
{
    struct open_surface face = {.network = network, .wall = wall, .unit = unit};
    const uint8_t *periodic = network->packing.periodic;
    struct planar size;
    find_span(network, lateral_axis(wall, 0), &face.corner.x, &size.x);
    find_span(network, lateral_axis(wall, 1), &face.corner.y, &size.y);
    face.region.rectangle = (struct rectangle){
        .size = {size.x / unit, size.y / unit},
        .periodic_x = periodic[lateral_axis(wall, 0)],
        .periodic_y = periodic[lateral_axis(wall, 1)],
    };
    find_sides(&face);
    return face;
}

void open_surface_free(struct open_surface *face)
{
    planar_region_free(&face->region);
}
