// SPDX-License-Identifier: GPL-3.0-or-later
#include "nodes.h"

#include "basics/memory.h"
#include "geometry/exact.h"
#include "rows.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// Nodes closer to a wall, or wall nodes closer to each other, than this are taken to
// coincide; in units. A thousand times what rounding the generators does.
static const double coincide = 1e-9;

// Determinants below this, of the product of the edges, lose digits that matter.
static const double flat = 1e-3;

static bool repeats(const struct generators *generators)
{
    return generators->repeats[0] || generators->repeats[1] || generators->repeats[2];
}

// The point of equal power to the four corners: 2 (x_k - x_0).c = |x_k - x_0|^2 - w_k +
// w_0 for c relative to corner 0, so that no large numbers are subtracted.
static struct vector power_centre(const struct generators *generators,
                                  const int32_t corner[4])
{
    const struct vector origin = generators->position[corner[0]];
    struct vector row[3];
    double right[3];
    for (int k = 0; k < 3; k++) {
        row[k] = subtract(generators->position[corner[k + 1]], origin);
        // Weights first: those of a grain and its image cancel, however close they are.
        right[k] = 0.5 * (dot(row[k], row[k]) + (generators->weight[corner[0]] -
                                                 generators->weight[corner[k + 1]]));
    }
    const struct vector across[3] = {cross(row[1], row[2]), cross(row[2], row[0]),
                                     cross(row[0], row[1])};
    const double determinant = dot(row[0], across[0]);
    if (fabs(determinant) < flat * norm(row[0]) * norm(row[1]) * norm(row[2]))
        return exact_power_centre(generators->position, generators->weight, corner);
    struct vector centre = {0};
    // The second pass takes off what the first left by rounding.
    for (int pass = 0; pass < 2; pass++) {
        struct vector correction = {0};
        double residual[3];
        for (int k = 0; k < 3; k++)
            residual[k] = right[k] - dot(row[k], centre);
        for (int k = 0; k < 3; k++)
            correction = add(correction, scale(residual[k] / determinant, across[k]));
        centre = add(centre, correction);
    }
    return add(origin, centre);
}

static bool near_grain(const struct generators *generators, const int32_t corner[4])
{
    for (int k = 0; k < 4; k++)
        if (corner[k] < generators->n_particle) return true;
    return false;
}

// Puts a node exactly on every wall it is close to; returns those walls.
static uint8_t snap_to_walls(const struct generators *generators,
                             struct vector *position, bool *outside)
{
    uint8_t walls = 0;
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        if (!generators->walled[wall / 2]) continue;
        const double at = wall % 2 ? component(generators->box, wall / 2) : 0;
        const double beyond =
            (wall % 2 ? 1 : -1) * (component(*position, wall / 2) - at);
        if (fabs(beyond) < coincide) {
            walls |= (uint8_t)(1 << wall);
            set_component(position, wall / 2, at);
        } else if (beyond > 0) {
            *outside = true;
        }
    }
    return walls;
}

// ---- names --------------------------------------------------------------------------

static void put_in_order(const struct generators *generators, int32_t *a, int32_t *b)
{
    const bool swap = compare_generators(generators, *a, *b) > 0;
    const int32_t first = swap ? *b : *a;
    *b = swap ? *a : *b;
    *a = first;
}

static void sort_corners(const struct generators *generators, const int32_t cell[4],
                         int32_t corner[4])
{
    memcpy(corner, cell, 4 * sizeof *corner);
    put_in_order(generators, &corner[0], &corner[1]);
    put_in_order(generators, &corner[2], &corner[3]);
    put_in_order(generators, &corner[0], &corner[2]);
    put_in_order(generators, &corner[1], &corner[3]);
    put_in_order(generators, &corner[1], &corner[2]);
}

// A cell is named after its corners in order, and where they are relative to the first:
// cells that are copies of each other have one name. False when that does not fit.
static bool name_cell(const struct generators *generators, const int32_t cell[4],
                      struct row *name)
{
    enum { IMAGES = 343, MIDDLE = 171 }; // of image_number
    int32_t corner[4];
    sort_corners(generators, cell, corner);
    for (int k = 0; k < 4; k++)
        name->key[k] =
            corner[k] < generators->n_base ? corner[k] : generators->base[corner[k]];
    for (int k = 1; k < 4 && generators->n > generators->n_base; k++) {
        const struct image apart = image_difference(generators->image[corner[k]],
                                                    generators->image[corner[0]]);
        if (is_far(apart)) return false;
        name->key[4] = name->key[4] * IMAGES + image_number(apart) + MIDDLE;
    }
    return true;
}

// Of the cells near grains; NULL when one has no name.
static struct row *sorted_names(const struct generators *generators,
                                const struct triangulation *triangulation, int *count)
{
    const int n_cell = triangulation->n_cell;
    struct row *names = allocate_aligned((size_t)n_cell, sizeof *names);
    bool named = true;
#pragma omp parallel for reduction(&& : named)
    for (int c = 0; c < n_cell; c++) {
        const int32_t *corner = triangulation->cell[c].vertex;
        names[c].item = near_grain(generators, corner) ? c : -1;
        if (names[c].item == c)
            named = name_cell(generators, corner, &names[c]) && named;
    }
    *count = 0;
    for (int c = 0; c < n_cell; c++)
        if (names[c].item == c) names[(*count)++] = names[c];
    if (named) return sort_rows(names, *count);
    free(names);
    return NULL;
}

// ---- places -------------------------------------------------------------------------

// One for all cells of one name, and those united with it on a wall.
struct place {
    int parent;             // itself, or a place it coincides with
    struct image of_parent; // the repetition of the box in which it does
    struct image within;    // its first cell has it in, when seen from a grain
};

struct places {
    int n;
    struct place *place;
    struct vector *position;
    uint8_t *walls;
};

enum { FIRST_OF_NAME = 1 }; // in cell.seen

// Gives every named cell its place, and marks the first of each name. Cells come in any
// order: they are asked for in time.
static int number_places(struct triangulation *triangulation, const struct row *names,
                         int count)
{
    enum { AHEAD = 16 };
    int n = 0;
#pragma omp parallel for
    for (int c = 0; c < triangulation->n_cell; c++)
        triangulation->cell[c].node = -1;
    for (int k = 0; k < count; k++) {
        const int later = k + AHEAD < count ? k + AHEAD : k;
        __builtin_prefetch(&triangulation->cell[names[later].item], 1);
        struct cell *cell = &triangulation->cell[names[k].item];
        const bool first =
            !k || memcmp(names[k].key, names[k - 1].key, sizeof names->key);
        n += first;
        cell->node = n - 1;
        cell->seen = first ? FIRST_OF_NAME : 0;
    }
    return n;
}

static struct image first_image(const struct generators *generators,
                                const int32_t cell[4])
{
    int32_t corner[4];
    sort_corners(generators, cell, corner);
    return generators->image[corner[0]];
}

// Where the first cell of a name has its node, when its first corner is one of the
// grains themselves; then moved into the box.
static void find_place(const struct generators *generators, const struct cell *cell,
                       struct places *places, bool *outside)
{
    int32_t corner[4];
    sort_corners(generators, cell->vertex, corner);
    const struct image none = {0}, first = generators->image[corner[0]];
    struct vector at = power_centre(generators, corner);
    at = moved(generators, at, image_difference(none, first));
    const uint8_t walls = snap_to_walls(generators, &at, outside);
    if (walls) places->walls[cell->node] = walls;
    struct image within = {0};
    for (int axis = 0; axis < 3 && repeats(generators); axis++)
        if (generators->repeats[axis])
            within.along[axis] =
                (int8_t)floor(component(at, axis) / component(generators->box, axis));
    if (repeats(generators)) places->place[cell->node].within = within;
    places->position[cell->node] =
        moved(generators, at, image_difference(none, within));
}

// Where a cell has its place, seen from where the cell is.
static void move_to_place(const struct generators *generators,
                          const struct places *places, struct cell *cell)
{
    const bool periodic = repeats(generators);
    if (periodic)
        cell->image = image_sum(places->place[cell->node].within,
                                first_image(generators, cell->vertex));
    cell->at = moved(generators, places->position[cell->node], cell->image);
    cell->seen = periodic || places->walls[cell->node] ? SHARES_NODE : 0;
}

static struct places find_places(const struct generators *generators,
                                 struct triangulation *triangulation,
                                 const struct row *names, int count, bool *outside)
{
    const int n = number_places(triangulation, names, count);
    struct places places = {.n = n,
                            .place = NEW_ARRAY(struct place, n),
                            .position = NEW_ARRAY(struct vector, n),
                            .walls = NEW_ARRAY(uint8_t, n)};
    bool beyond = false;
    for (int i = 0; i < n; i++)
        places.place[i].parent = i;
#pragma omp parallel for reduction(|| : beyond)
    for (int c = 0; c < triangulation->n_cell; c++) {
        struct cell *cell = &triangulation->cell[c];
        if (cell->node < 0 || cell->seen != FIRST_OF_NAME) continue;
        find_place(generators, cell, &places, &beyond);
        move_to_place(generators, &places, cell);
    }
#pragma omp parallel for
    for (int c = 0; c < (n < count ? triangulation->n_cell : 0); c++) // copies
        if (triangulation->cell[c].node >= 0 && !triangulation->cell[c].seen)
            move_to_place(generators, &places, &triangulation->cell[c]);
    *outside = beyond;
    return places;
}

// The place that I is united with, and the repetition in which it is I.
static int root_of(const struct places *places, int i, struct image *image)
{
    *image = (struct image){0};
    while (places->place[i].parent != i) {
        *image = image_sum(*image, places->place[i].of_parent);
        i = places->place[i].parent;
    }
    return i;
}

static void unite(struct places *places, int a, struct image in_a, int b,
                  struct image in_b)
{
    struct image from_a, from_b;
    const int first = root_of(places, a, &from_a), second = root_of(places, b, &from_b);
    if (first == second) return;
    in_a = image_sum(in_a, from_a);
    in_b = image_sum(in_b, from_b);
    struct place *later = &places->place[first > second ? first : second];
    later->parent = first > second ? second : first;
    later->of_parent =
        first > second ? image_difference(in_b, in_a) : image_difference(in_a, in_b);
}

static void unite_on_walls(const struct triangulation *triangulation,
                           struct places *places)
{
    for (int c = 0; c < triangulation->n_cell; c++) {
        const struct cell *cell = &triangulation->cell[c];
        if (!cell->seen || !places->walls[cell->node]) continue;
        for (int k = 0; k < 4; k++) {
            if (cell->neighbour[k] < c) continue;
            const struct cell *other = &triangulation->cell[cell->neighbour[k]];
            if (other->node >= 0 && places->walls[other->node] &&
                distance(cell->at, other->at) <= coincide)
                unite(places, cell->node, cell->image, other->node, other->image);
        }
    }
}

// Those places become nodes that are not united with an earlier one, in the order of
// the names. Takes over what PLACES holds of them; returns their numbers.
static int *number_nodes(struct places *places, struct nodes *nodes)
{
    int *number = NEW_ARRAY(int, places->n);
    for (int i = 0; i < places->n; i++) {
        if (places->place[i].parent != i) continue;
        places->position[nodes->n] = places->position[i];
        places->walls[nodes->n] = places->walls[i];
        number[i] = nodes->n++;
    }
    nodes->position = places->position;
    nodes->walls = places->walls;
    return number;
}

// From the place of a cell to its node.
static void move_to_node(const struct generators *generators,
                         const struct places *places, const int *number,
                         const struct nodes *nodes, struct cell *cell)
{
    struct image image;
    const int root = root_of(places, cell->node, &image);
    if (root != cell->node) {
        cell->image = image_sum(cell->image, image);
        cell->at = moved(generators, nodes->position[number[root]], cell->image);
    }
    cell->node = number[root];
}

// ---- what was left out --------------------------------------------------------------

// The cell of a grain among its corners is unbounded.
static bool is_open(const struct generators *generators, const struct cell *cell)
{
    for (int k = 0; k < 4; k++)
        for (int m = 0; m < 4 && cell->neighbour[k] < 0; m++)
            if (m != k && cell->vertex[m] < generators->n_particle) return true;
    return false;
}

// An image left out is farther from the box than the reach; it could change a cell only
// from inside the sphere around the node that no generator has less power to.
static bool is_complete(const struct generators *generators, const struct cell *cell)
{
    if (is_open(generators, cell)) return false;
    if (!repeats(generators)) return true;
    const int32_t corner = cell->vertex[0];
    const struct vector to = subtract(generators->position[corner], cell->at);
    const double power = dot(to, to) - generators->weight[corner];
    const double radius = sqrt(fmax(0, power + generators->largest_weight));
    for (int axis = 0; axis < 3; axis++) {
        if (!generators->repeats[axis]) continue;
        const double x = component(cell->at, axis);
        if (x - radius <= -generators->reach ||
            x + radius >= component(generators->box, axis) + generators->reach)
            return false;
    }
    return true;
}

enum status find_nodes(const struct generators *generators,
                       struct triangulation *triangulation, struct nodes *nodes,
                       struct reason *reason)
{
    int count;
    *nodes = (struct nodes){0};
    struct row *names = sorted_names(generators, triangulation, &count);
    if (!names)
        return refuse(reason, STATUS_BAD_DATA,
                      "/domain/upper: the box is too narrow for a network that "
                      "repeats: grains meet that are more than %d boxes apart",
                      FARTHEST_IMAGE);
    bool outside;
    struct places places =
        find_places(generators, triangulation, names, count, &outside);
    free(names);
    unite_on_walls(triangulation, &places);
    int *number = number_nodes(&places, nodes);
    bool complete = !outside;
#pragma omp parallel for reduction(&& : complete)
    for (int c = 0; c < triangulation->n_cell; c++) {
        struct cell *cell = &triangulation->cell[c];
        if (cell->node < 0) continue;
        move_to_node(generators, &places, number, nodes, cell);
        complete = is_complete(generators, cell) && complete;
    }
    nodes->complete = complete;
    free(number);
    free(places.place);
    return STATUS_OK;
}

void nodes_free(struct nodes *nodes)
{
    free(nodes->position);
    free(nodes->walls);
    *nodes = (struct nodes){0};
}
