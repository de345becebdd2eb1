// SPDX-License-Identifier: GPL-3.0-or-later
// Voronoi cells in a rectangle, each found on its own. Cell i starts as the rectangle
// and is clipped by the perpendicular bisector to each neighbour j, nearest bins
// first:
//     (at - away/2) . away > 0   is nearer to j, where away = point[j] - point[i].
// It is finished when the next ring of bins is farther away than twice its farthest
// corner: no bisector beyond can reach it. All coordinates are relative to the cell's
// own point, so that small cells keep their digits. Where the rectangle is periodic, a
// cell is also bounded by the bisectors to its own images, half a period away.
#include "planar_cells.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// Edges narrower than this part of the points' distance are rounding.
static const double MIN_WIDTH = 1e-12;

// Points in bins, as compressed rows.
struct bins {
    int count[2];
    struct planar size;
    int *offset, *point;
};

// A convex polygon; side k runs from corner k to the next and belongs to NEIGHBOUR, -1
// where it is the rectangle's.
struct polygon {
    struct corner {
        struct planar at;
        int neighbour;
        double distance; // of that neighbour
    } * corner, *before;
    int n, capacity;
};

struct cutting {
    const struct planar *point;
    const struct planar_region *region;
    const struct rectangle *rectangle;
    struct bins bins;
    struct polygon cell;
    struct planar_cells *cells;
    int edge_capacity;
};

static int clamp(double value, int most)
{
    return value < 0 ? 0 : value > most ? most : (int)value;
}

// About one point a bin, bins about square.
static int bin_of(const struct bins *bins, struct planar at)
{
    const int x = clamp(at.x / bins->size.x, bins->count[0] - 1);
    return x + bins->count[0] * clamp(at.y / bins->size.y, bins->count[1] - 1);
}

static struct bins sort_into_bins(const struct planar *point, int n,
                                  struct planar rectangle)
{
    const double edge = sqrt(rectangle.x * rectangle.y / n);
    struct bins bins = {
        .count = {1 + clamp(rectangle.x / edge, n), 1 + clamp(rectangle.y / edge, n)}};
    bins.size =
        (struct planar){rectangle.x / bins.count[0], rectangle.y / bins.count[1]};
    const size_t count = (size_t)bins.count[0] * (size_t)bins.count[1];
    bins.offset = NEW_ARRAY(int, count + 2);
    bins.point = NEW_ARRAY(int, n);
    int *end = bins.offset + 1; // becomes the offsets of the next
    for (int i = 0; i < n; i++)
        end[bin_of(&bins, point[i]) + 1]++;
    for (size_t bin = 0; bin < count; bin++)
        end[bin + 1] += end[bin];
    for (int i = 0; i < n; i++)
        bins.point[end[bin_of(&bins, point[i])]++] = i;
    return bins;
}

// Where the rectangle repeats, a cell reaches no farther than half way to its own
// image.
static void begin_cell(struct cutting *cutting, struct planar at)
{
    const struct rectangle *whole = cutting->rectangle;
    const struct planar size = whole->size;
    const double left = whole->periodic_x ? -size.x / 2 : -at.x;
    const double right = whole->periodic_x ? size.x / 2 : size.x - at.x;
    const double low = whole->periodic_y ? -size.y / 2 : -at.y;
    const double high = whole->periodic_y ? size.y / 2 : size.y - at.y;
    const struct planar corner[4] = {
        {left, low}, {right, low}, {right, high}, {left, high}};
    cutting->cell.n = 4;
    for (int k = 0; k < 4; k++)
        cutting->cell.corner[k] = (struct corner){corner[k], -1, 0};
}

// Signed distance beyond the bisector to the point at AWAY, times |AWAY|; at most 0 on
// the cell's own side.
static double beyond(struct planar at, struct planar away)
{
    return (at.x - away.x / 2) * away.x + (at.y - away.y / 2) * away.y;
}

static struct planar between(struct planar a, double a_beyond, struct planar b,
                             double b_beyond)
{
    const double t = a_beyond / (a_beyond - b_beyond);
    return (struct planar){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
}

static void add_corner(struct polygon *cell, struct planar at,
                       const struct corner *side)
{
    cell->corner[cell->n++] = (struct corner){at, side->neighbour, side->distance};
}

// Removes the part of the cell nearer to the point at AWAY: NEIGHBOUR or its image.
static void cut(struct polygon *cell, struct planar away, int neighbour)
{
    bool reaches = false;
    for (int k = 0; k < cell->n; k++)
        reaches |= beyond(cell->corner[k].at, away) > 0;
    if (!reaches) return;

    if (cell->n + 2 > cell->capacity) {
        cell->capacity = 2 * cell->capacity;
        const size_t capacity = (size_t)cell->capacity;
        cell->corner = reallocate(cell->corner, capacity, sizeof *cell->corner);
        cell->before = reallocate(cell->before, capacity, sizeof *cell->before);
    }
    struct corner *old = cell->corner;
    const int n = cell->n;
    const struct corner new_side = {.neighbour = neighbour,
                                    .distance = hypot(away.x, away.y)};
    cell->corner = cell->before;
    cell->before = old;
    cell->n = 0;
    for (int k = 0; k < n; k++) {
        const struct corner *from = &old[k], *to = &old[(k + 1) % n];
        const double here = beyond(from->at, away), there = beyond(to->at, away);
        if (here <= 0) add_corner(cell, from->at, from);
        if (here <= 0 && there > 0)
            add_corner(cell, between(from->at, here, to->at, there), &new_side);
        if (here > 0 && there <= 0)
            add_corner(cell, between(from->at, here, to->at, there), from);
    }
}

static double farthest_corner(const struct polygon *cell)
{
    double farthest = 0;
    for (int k = 0; k < cell->n; k++)
        farthest = fmax(farthest, hypot(cell->corner[k].at.x, cell->corner[k].at.y));
    return farthest;
}

// Maps the bin at PLACE along an axis, which may lie beyond the rectangle, to its
// periodic image inside; MOVED is the offset. False if there is no such bin.
static bool find_image(int *place, int count, double edge, bool periodic, double *moved)
{
    const int image = (int)floor((double)*place / count);
    *moved = image * edge;
    *place -= image * count;
    return image == 0 || periodic;
}

static void cut_by_bin(struct cutting *cutting, int i, int x, int y)
{
    const struct rectangle *whole = cutting->rectangle;
    const struct bins *bins = &cutting->bins;
    struct planar moved;
    if (!find_image(&x, bins->count[0], whole->size.x, whole->periodic_x, &moved.x) ||
        !find_image(&y, bins->count[1], whole->size.y, whole->periodic_y, &moved.y))
        return;
    const int bin = x + bins->count[0] * y;
    for (int k = bins->offset[bin]; k < bins->offset[bin + 1]; k++) {
        const int j = bins->point[k];
        if (j == i) continue; // its images are taken care of from the beginning
        const struct planar *a = &cutting->point[i], *b = &cutting->point[j];
        cut(&cutting->cell,
            (struct planar){b->x - a->x + moved.x, b->y - a->y + moved.y}, j);
    }
}

// Lower bound of the distance from a point in a bin to one in ring RING around it.
static double nearest_in_ring(const struct cutting *cutting, int ring)
{
    const struct bins *bins = &cutting->bins;
    const struct rectangle *whole = cutting->rectangle;
    double nearest = INFINITY;
    if (whole->periodic_x || ring < bins->count[0]) nearest = (ring - 1) * bins->size.x;
    if (whole->periodic_y || ring < bins->count[1])
        nearest = fmin(nearest, (ring - 1) * bins->size.y);
    return nearest;
}

static void cut_cell(struct cutting *cutting, int i)
{
    const int bin = bin_of(&cutting->bins, cutting->point[i]);
    const int x = bin % cutting->bins.count[0], y = bin / cutting->bins.count[0];
    begin_cell(cutting, cutting->point[i]);
    cut_by_bin(cutting, i, x, y);
    for (int ring = 1;
         nearest_in_ring(cutting, ring) <= 2 * farthest_corner(&cutting->cell); ring++)
        for (int along = -ring; along < ring; along++) {
            cut_by_bin(cutting, i, x + along, y - ring);
            cut_by_bin(cutting, i, x + ring, y + along);
            cut_by_bin(cutting, i, x - along, y + ring);
            cut_by_bin(cutting, i, x - ring, y - along);
        }
}

// Area of the finished cell; only its part in the region if that ENDS within the cell.
static double area_of(const struct cutting *cutting, int i, bool ends)
{
    static const struct planar_region whole = {0};
    const struct polygon *cell = &cutting->cell;
    struct planar *corner = NEW_ARRAY(struct planar, cell->n);
    for (int k = 0; k < cell->n; k++)
        corner[k] = cell->corner[k].at;
    const double area = area_in_region(ends ? cutting->region : &whole,
                                       cutting->point[i], corner, cell->n);
    free(corner);
    return area;
}

// Adds the finished cell's edges to points of higher index; those to lower ones were
// added by the other cell.
static void add_edges(struct cutting *cutting, int i, bool ends)
{
    struct planar_cells *cells = cutting->cells;
    const struct polygon *cell = &cutting->cell;
    const struct planar at = cutting->point[i];
    for (int k = 0; k < cell->n; k++) {
        const struct corner *from = &cell->corner[k];
        const struct corner *to = &cell->corner[(k + 1) % cell->n];
        if (from->neighbour <= i) continue;
        const double width = ends ? length_in_region(cutting->region, cutting->point[i],
                                                     from->at, to->at)
                                  : hypot(to->at.x - from->at.x, to->at.y - from->at.y);
        if (width <= MIN_WIDTH * from->distance) continue;
        GROW_ARRAY(cells->edge, cells->n_edge, cutting->edge_capacity);
        cells->edge[cells->n_edge++] =
            (struct planar_edge){.point = {i, from->neighbour},
                                 .width = width,
                                 .distance = from->distance,
                                 .end = {{at.x + from->at.x, at.y + from->at.y},
                                         {at.x + to->at.x, at.y + to->at.y}}};
    }
}

static int compare_edges(const void *a, const void *b)
{
    const struct planar_edge *e = a, *f = b;
    for (int end = 0; end < 2; end++)
        if (e->point[end] != f->point[end])
            return e->point[end] < f->point[end] ? -1 : 1;
    if (e->distance != f->distance) return e->distance < f->distance ? -1 : 1;
    return (e->width > f->width) - (e->width < f->width);
}

struct planar_cells planar_cells_init(const struct planar *point, int n,
                                      const struct planar_region *region)
{
    struct planar_cells cells = {.area = NEW_ARRAY(double, n)};
    if (n == 0) return cells;
    struct cutting cutting = {.point = point,
                              .region = region,
                              .rectangle = &region->rectangle,
                              .bins = sort_into_bins(point, n, region->rectangle.size),
                              .cell = {.capacity = 16},
                              .cells = &cells};
    cutting.cell.corner = NEW_ARRAY(struct corner, cutting.cell.capacity);
    cutting.cell.before = NEW_ARRAY(struct corner, cutting.cell.capacity);
    for (int i = 0; i < n; i++) {
        cut_cell(&cutting, i);
        const bool ends =
            !region_holds(region, point[i], farthest_corner(&cutting.cell));
        cells.area[i] = area_of(&cutting, i, ends);
        add_edges(&cutting, i, ends);
    }
    if (cells.n_edge > 0)
        qsort(cells.edge, (size_t)cells.n_edge, sizeof *cells.edge, compare_edges);
    free(cutting.cell.corner);
    free(cutting.cell.before);
    free(cutting.bins.offset);
    free(cutting.bins.point);
    return cells;
}

void planar_cells_free(struct planar_cells *cells)
{
    free(cells->area);
    free(cells->edge);
    *cells = (struct planar_cells){0};
}
