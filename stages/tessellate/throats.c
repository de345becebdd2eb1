// SPDX-License-Identifier: GPL-3.0-or-later
// Throats: the edges of the diagram, dual to the facets of the triangulation.
#include "assemble.h"

#include "basics/memory.h"
#include "rows.h"

#include <stdlib.h>
#include <string.h>

// Throats as seen from facets.
struct candidates {
    struct row *row; // the two nodes, the image of the second; which of those below
    double *radius;  // in units; may be below 0 where grains overlap
    double *length;  // in units
    int count, capacity;
};

double clearance_of(struct vector centre, double radius, const struct vector end[2],
                    enum clearance how)
{
    const struct vector along = subtract(end[1], end[0]);
    const struct vector to = subtract(centre, end[0]);
    const double length2 = dot(along, along);
    double t = length2 > 0 ? dot(to, along) / length2 : 0;
    if (how == CLEARANCE_SEGMENT) t = fmin(fmax(t, 0), 1);
    return norm(subtract(to, scale(t, along))) - radius;
}

// The least clearance to the grains of the facet opposite corner K of CELL.
static double facet_clearance(const struct assembly *assembly, int cell, int k,
                              const struct vector end[2])
{
    double least = HUGE_VAL;
    for (int m = 0; m < 4; m++) {
        const int32_t point = assembly->triangulation->cell[cell].vertex[m];
        if (m == k || assembly->generators->wall[point] >= 0) continue;
        const int32_t grain = assembly->generators->particle[point];
        least = fmin(least,
                     clearance_of(assembly->generators->position[point],
                                  assembly->radius[grain], end, assembly->clearance));
    }
    return least;
}

// Each facet has many copies where the box repeats: the one whose first corner is a
// grain itself counts. Where nothing repeats, that is each facet with a grain.
static bool facet_counts(const struct assembly *assembly, int cell, int k)
{
    const struct generators *generators = assembly->generators;
    const int32_t *corner = assembly->triangulation->cell[cell].vertex;
    int32_t first = -1;
    for (int m = 0; m < 4; m++)
        if (m != k &&
            (first < 0 || compare_generators(generators, corner[m], first) < 0))
            first = corner[m];
    return first < generators->n_particle;
}

static void append(struct candidates *candidates, const struct row *row, double radius,
                   double length)
{
    if (candidates->count == candidates->capacity) {
        const size_t capacity =
            candidates->capacity ? 2 * (size_t)candidates->capacity : 1024;
        candidates->row = reallocate(candidates->row, capacity, sizeof *row);
        candidates->radius =
            reallocate(candidates->radius, capacity, sizeof *candidates->radius);
        candidates->length =
            reallocate(candidates->length, capacity, sizeof *candidates->length);
        candidates->capacity = (int)capacity;
    }
    candidates->row[candidates->count] = *row;
    candidates->row[candidates->count].item = candidates->count;
    candidates->radius[candidates->count] = radius;
    candidates->length[candidates->count++] = length;
}

// False when a throat would join a node to its own image.
static bool find_candidates(const struct assembly *assembly,
                            struct candidates *candidates)
{
    const struct triangulation *cells = assembly->triangulation;
    for (int c = 0; c < cells->n_cell; c++) {
        const struct cell *from = &cells->cell[c];
        for (int k = 0; k < 4; k++) {
            const int d = from->neighbour[k];
            if (d < c || from->node < 0 || !facet_counts(assembly, c, k)) continue;
            const struct cell *to = &cells->cell[d];
            const int32_t a = from->node, b = to->node;
            const struct image apart = a < b ? image_difference(to->image, from->image)
                                             : image_difference(from->image, to->image);
            const bool united = same_image(apart, (struct image){0}); // on a wall
            if (a == b && united) continue;
            if (a == b) return false;
            const struct vector end[2] = {from->at, to->at};
            append(candidates,
                   &(struct row){
                       .key = {a < b ? a : b, a < b ? b : a, image_number(apart)}},
                   facet_clearance(assembly, c, k, end), distance(end[0], end[1]));
        }
    }
    return true;
}

// A throat in a wall is seen from the facets of several images: one throat, as wide as
// the narrowest of them says.
static int fuse_in_walls(const struct nodes *nodes, struct candidates *candidates)
{
    struct row *row = candidates->row;
    int kept = 0;
    for (int k = 0; k < candidates->count; k++) {
        struct row *last = kept ? &row[kept - 1] : NULL;
        const bool same = last && !memcmp(last->key, row[k].key, sizeof last->key) &&
                          (nodes->walls[last->key[0]] & nodes->walls[last->key[1]]);
        if (!same)
            row[kept++] = row[k];
        else if (candidates->radius[row[k].item] < candidates->radius[last->item])
            last->item = row[k].item;
    }
    return kept;
}

// The images of second nodes.
static void store_images(const struct row *row, struct network *network)
{
    network->throat_image = NEW_ARRAY(struct image, network->n_throat);
    for (int t = 0; t < network->n_throat; t++)
        network->throat_image[t] = numbered_image(row[t].key[2]);
}

static void store(const struct candidates *candidates, double unit,
                  struct network *network)
{
    const int count = network->n_throat;
    network->throat_nodes = allocate((size_t)count, sizeof *network->throat_nodes);
    network->throat_radius = NEW_ARRAY(double, count);
    network->throat_length = NEW_ARRAY(double, count);
    network->throat_kind = NEW_ARRAY(uint8_t, count);
    for (int t = 0; t < count; t++) {
        const struct row *row = &candidates->row[t];
        for (int end = 0; end < 2; end++)
            network->throat_nodes[t][end] = row->key[end];
        network->throat_length[t] = unit * candidates->length[row->item];
        network->throat_radius[t] = unit * fmax(0, candidates->radius[row->item]);
    }
    if (is_periodic(&network->packing)) store_images(candidates->row, network);
}

enum status assemble_throats(const struct assembly *assembly, struct network *network,
                             struct reason *reason)
{
    struct candidates candidates = {0};
    enum status status = STATUS_OK;
    if (!find_candidates(assembly, &candidates))
        status = refuse(reason, STATUS_BAD_DATA,
                        "/domain/upper: the box is too narrow for a network that "
                        "repeats: a throat would join a node to its own image");
    if (!status) {
        candidates.row = sort_rows(candidates.row, candidates.count);
        network->n_throat = fuse_in_walls(assembly->nodes, &candidates);
        store(&candidates, assembly->generators->unit, network);
    }
    free(candidates.row);
    free(candidates.radius);
    free(candidates.length);
    return status;
}
