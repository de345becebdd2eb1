// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes of the diagram: the point c of equal power to the four corners of each cell of
// the triangulation (vertex of the power or Voronoi diagram, Aurenhammer 1987),
//     2 (x_k - x_0) . c = |x_k - x_0|^2 - w_k + w_0,   k = 1, 2, 3,
// relative to x_0, by Cramer's rule with one refinement; where the determinant is
// small, exactly (exact_power_centre). Cells that are copies of each other must get
// one node: a cell is named after the bases of its sorted corners and where they lie
// relative to the first, and each name gets one place. Reflection makes nodes on walls
// degenerate on purpose: places on a wall that coincide are united (union-find over
// neighbouring cells). Numbering follows the names, not the triangulation, so that it
// is reproducible.
#include "nodes.h"

#include "basics/memory.h"
#include "cell_groups.h"
#include "geometry/triangulation/exact.h"
#include "sort_rows.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// Nodes closer to a wall, or wall nodes closer to each other, than this are taken to
// coincide; in units. A thousand times what rounding the generators does.
static const double COINCIDENCE = 1e-9;

// Determinants below this part of the product of the edges have lost too many digits.
static const double MIN_DETERMINANT = 1e-3;

static bool repeats(const struct generators *generators)
{
    return generators->repeats[0] || generators->repeats[1] || generators->repeats[2];
}

// The point of equal power to the four corners, relative to corner 0: so no large
// numbers are subtracted.
static struct vector power_centre(const struct generators *generators,
                                  const int32_t corner[4])
{
    const struct weighted_point *p[4];
    for (int k = 0; k < 4; k++)
        p[k] = &generators->point[corner[k]];
    struct vector row[3];
    double right[3], squares = MIN_DETERMINANT * MIN_DETERMINANT;
    for (int k = 0; k < 3; k++) {
        row[k] = subtract(p[k + 1]->at, p[0]->at);
        const double square = dot(row[k], row[k]);
        // Weights first: those of a grain and its image cancel, however close they are.
        right[k] = 0.5 * (square + (p[0]->weight - p[k + 1]->weight));
        squares *= square;
    }
    const struct vector across[3] = {cross(row[1], row[2]), cross(row[2], row[0]),
                                     cross(row[0], row[1])};
    const double determinant = dot(row[0], across[0]);
    if (determinant * determinant < squares) return exact_power_centre(p);
    struct vector centre = {0};
    // The second pass removes the rounding error of the first.
    for (int pass = 0; pass < 2; pass++) {
        struct vector correction = {0};
        double residual[3];
        for (int k = 0; k < 3; k++)
            residual[k] = right[k] - dot(row[k], centre);
        for (int k = 0; k < 3; k++)
            correction = add(correction, scale(residual[k] / determinant, across[k]));
        centre = add(centre, correction);
    }
    return add(p[0]->at, centre);
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
        if (fabs(beyond) < COINCIDENCE) {
            walls |= (uint8_t)(1 << wall);
            set_component(position, wall / 2, at);
        } else if (beyond > 0) {
            *outside = true;
        }
    }
    return walls;
}

// ---- names --------------------------------------------------------------------------

static void order_pair(const struct generators *generators, int32_t *a, int32_t *b)
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
    order_pair(generators, &corner[0], &corner[1]);
    order_pair(generators, &corner[2], &corner[3]);
    order_pair(generators, &corner[0], &corner[2]);
    order_pair(generators, &corner[1], &corner[3]);
    order_pair(generators, &corner[1], &corner[2]);
}

// The name of a cell: the bases of its sorted corners, and their images relative to the
// first. Cells that are copies of each other have the same name. False when the images
// are too far apart to be encoded.
static bool name_cell(const struct generators *generators, const int32_t corner[4],
                      struct row *name)
{
    enum { IMAGES = 343, MIDDLE = 171 }; // of image_number
    for (int k = 0; k < 4; k++)
        name->key[k] = generators->origin[corner[k]].base;
    name->key[4] = 0;
    for (int k = 1; k < 4 && has_copies(generators); k++) {
        const struct image apart = image_difference(
            generators->origin[corner[k]].image, generators->origin[corner[0]].image);
        if (is_far(apart)) return false;
        name->key[4] = name->key[4] * IMAGES + image_number(apart) + MIDDLE;
    }
    return true;
}

// ---- what was left out --------------------------------------------------------------

// Whether a corner is a grain whose cell is unbounded.
static bool is_open(const struct generators *generators, const struct cell *cell)
{
    for (int k = 0; k < 4; k++)
        for (int m = 0; m < 4 && cell->neighbour[k] < 0; m++)
            if (m != k && is_grain(generators, cell->vertex[m])) return true;
    return false;
}

// Whether images that were left out cannot change the cell. They are farther from the
// box than the reach, and could change it only from inside the sphere around its node,
// AT, in which a generator would have less power to AT than the corners.
static bool is_complete(const struct generators *generators, const struct cell *cell,
                        struct vector at)
{
    if (is_open(generators, cell)) return false;
    if (!repeats(generators)) return true;
    const struct weighted_point *corner = &generators->point[cell->vertex[0]];
    const struct vector to = subtract(corner->at, at);
    const double power = dot(to, to) - corner->weight;
    const double radius = sqrt(fmax(0, power + generators->largest_weight));
    for (int axis = 0; axis < 3; axis++) {
        if (!generators->repeats[axis]) continue;
        const double x = component(at, axis);
        if (x - radius <= -generators->reach ||
            x + radius >= component(generators->box, axis) + generators->reach)
            return false;
    }
    return true;
}

// ---- places -------------------------------------------------------------------------

// One place for all cells of one name, and those united with it on a wall. Numbered in
// the order of the names; other cells of a name leave their numbers unused.
enum { NO_PLACE = -1 };

struct places {
    int n;
    int32_t *back;           // how many places back the one it coincides with; 0: none
    struct image *of_parent; // the repetition of the box in which it does
    struct vector *position;
    uint8_t *walls;
};

// Gives cell C place I, seen in image IMAGE of the box. False when an image of a grain
// that was left out could change the cell.
static bool put_cell(const struct generators *generators, const struct places *places,
                     int i, struct image image, struct triangulation *triangulation,
                     int c)
{
    triangulation->node[c] = i;
    triangulation->seen[c] = repeats(generators) || places->walls[i] ? SHARES_NODE : 0;
    if (triangulation->image) triangulation->image[c] = image;
    return is_complete(generators, &triangulation->cell[c],
                       position_in_image(generators, places->position[i], image));
}

// The node of the first cell of a name, computed for its first corner at its base, then
// moved into the box. Returns the image of the box that it was in.
static struct image find_place(const struct generators *generators,
                               const int32_t corner[4], struct places *places, int i,
                               bool *outside)
{
    const struct image none = {0}, first = generators->origin[corner[0]].image;
    struct vector at = power_centre(generators, corner);
    at = position_in_image(generators, at, image_difference(none, first));
    places->walls[i] = snap_to_walls(generators, &at, outside);
    struct image within = none;
    for (int axis = 0; axis < 3 && repeats(generators); axis++)
        if (generators->repeats[axis])
            within.along[axis] =
                (int8_t)floor(component(at, axis) / component(generators->box, axis));
    places->position[i] =
        position_in_image(generators, at, image_difference(none, within));
    return within;
}

// Room for the cells of a group.
struct named {
    struct row *name; // item: which of the group
    int32_t (*corner)[4];
};

// Gives the cells of group G their places. False when one has no name (name_cell).
static bool place_group(const struct generators *generators,
                        const struct cell_groups *groups, int g,
                        struct triangulation *triangulation, struct named named,
                        struct places *places, bool *complete)
{
    const int count = groups->offset[g + 1] - groups->offset[g];
    const int begin = groups->place[generators->origin[g].base];
    const int32_t *cell = groups->cell + groups->offset[g];
    for (int k = 0; k < count; k++) {
        sort_corners(generators, triangulation->cell[cell[k]].vertex, named.corner[k]);
        if (!name_cell(generators, named.corner[k], &named.name[k])) return false;
        named.name[k].item = k;
    }
    sort_few_rows(named.name, count);
    struct image within = {0};
    bool outside = false;
    for (int k = 0, i = 0; k < count; k++) {
        const struct row *name = &named.name[k];
        const int32_t *corner = named.corner[name->item];
        const bool first = !k || memcmp(name->key, name[-1].key, sizeof name->key);
        if (first) i = begin + k;
        if (first)
            within = find_place(generators, corner, places, i, &outside);
        else
            places->back[begin + k] = NO_PLACE;
        const struct image image =
            image_sum(within, generators->origin[corner[0]].image);
        if (!put_cell(generators, places, i, image, triangulation, cell[name->item]))
            *complete = false;
    }
    *complete &= !outside;
    return true;
}

// Prefetches what a later group needs: its cells and places are scattered in memory.
PREFETCHING prefetch_group(const struct generators *generators,
                           const struct cell_groups *groups,
                           const struct places *places,
                           const struct triangulation *triangulation, int g)
{
    enum { AHEAD = 6 };
    if (g + 2 * AHEAD >= groups->n) return;
    __builtin_prefetch(&groups->place[generators->origin[g + 2 * AHEAD].base]);
    const int next = g + AHEAD, begin = groups->offset[next],
              count = groups->offset[next + 1] - begin,
              place = groups->place[generators->origin[next].base];
    for (int k = 0; k < count; k++)
        __builtin_prefetch(&triangulation->cell[groups->cell[begin + k]]);
    for (int k = 0; k < count; k += 2)
        __builtin_prefetch(&places->position[place + k], 1);
    __builtin_prefetch(&places->walls[place], 1);
}

// False when a cell has no name.
static bool find_places(const struct generators *generators,
                        struct triangulation *triangulation,
                        const struct cell_groups *groups, struct places *places,
                        bool *complete)
{
    const int n = groups->place[generators->n_base];
    *places = (struct places){.n = n,
                              .back = NEW_ARRAY(int32_t, n),
                              .of_parent = NEW_ARRAY(struct image, n),
                              .position =
                                  allocate_uncleared((size_t)n, sizeof(struct vector)),
                              .walls = NEW_ARRAY(uint8_t, n)};
    bool all_named = true, all_complete = true;
#pragma omp parallel reduction(&& : all_named, all_complete)
    {
        const struct named named = {
            NEW_ARRAY(struct row, groups->largest),
            allocate((size_t)groups->largest, sizeof *named.corner)};
#pragma omp for
        for (int g = 0; g < groups->n; g++) {
            prefetch_group(generators, groups, places, triangulation, g);
            if (!place_group(generators, groups, g, triangulation, named, places,
                             &all_complete))
                all_named = false;
        }
        free(named.name);
        free(named.corner);
    }
    *complete = all_complete;
    return all_named;
}

// The root of place I, and the image of the box in which the root lies at I.
static int root_of(const struct places *places, int i, struct image *image)
{
    *image = (struct image){0};
    while (places->back[i]) {
        *image = image_sum(*image, places->of_parent[i]);
        i -= places->back[i];
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
    const int later = first > second ? first : second;
    places->back[later] = abs(first - second);
    places->of_parent[later] =
        first > second ? image_difference(in_b, in_a) : image_difference(in_a, in_b);
}

static void unite_on_walls(const struct generators *generators,
                           const struct triangulation *triangulation,
                           struct places *places)
{
    const int32_t *place = triangulation->node;
    for (int c = 0; c < triangulation->n_cell; c++) {
        if (!triangulation->seen[c] || !places->walls[place[c]]) continue;
        const struct image image = node_image(triangulation, c);
        const struct vector at =
            position_in_image(generators, places->position[place[c]], image);
        for (int k = 0; k < 4; k++) {
            const int32_t d = triangulation->cell[c].neighbour[k];
            if (d < c || place[d] < 0 || !places->walls[place[d]]) continue;
            const struct image other = node_image(triangulation, d);
            const struct vector there =
                position_in_image(generators, places->position[place[d]], other);
            if (distance(at, there) <= COINCIDENCE)
                unite(places, place[c], image, place[d], other);
        }
    }
}

// Makes nodes of the places that are not united with an earlier one, in the order of
// the names. NODES takes over the arrays of PLACES; there, back becomes the node of
// each place, and of_parent the image of the box in which the node lies at the place.
static void number_nodes(struct places *places, struct nodes *nodes)
{
    for (int i = 0; i < places->n; i++) {
        const int back = places->back[i];
        if (back == NO_PLACE) continue;
        if (back > 0) { // to where all this is done
            places->of_parent[i] =
                image_sum(places->of_parent[i], places->of_parent[i - back]);
            places->back[i] = places->back[i - back];
            continue;
        }
        places->position[nodes->n] = places->position[i];
        places->walls[nodes->n] = places->walls[i];
        places->back[i] = nodes->n++;
    }
    nodes->position = places->position;
    nodes->walls = places->walls;
}

// From the places of cells to their nodes.
static void move_to_nodes(const struct places *places,
                          struct triangulation *triangulation)
{
#pragma omp parallel for
    for (int c = 0; c < triangulation->n_cell; c++) {
        const int32_t place = triangulation->node[c];
        if (place < 0) continue;
        triangulation->node[c] = places->back[place];
        if (triangulation->image)
            triangulation->image[c] =
                image_sum(triangulation->image[c], places->of_parent[place]);
    }
}

enum status find_nodes(const struct generators *generators,
                       struct triangulation *triangulation, struct nodes *nodes,
                       struct reason *reason)
{
    const int n_cell = triangulation->n_cell;
    *nodes = (struct nodes){0};
    triangulation->node = allocate_uncleared((size_t)n_cell, sizeof(int32_t));
    triangulation->seen = NEW_ARRAY(uint8_t, n_cell);
    if (repeats(generators)) triangulation->image = NEW_ARRAY(struct image, n_cell);
    struct cell_groups groups = group_cells(generators, triangulation);
    struct places places;
    const bool named =
        find_places(generators, triangulation, &groups, &places, &nodes->complete);
    cell_groups_free(&groups);
    if (named) {
        unite_on_walls(generators, triangulation, &places);
        number_nodes(&places, nodes);
        move_to_nodes(&places, triangulation);
    } else {
        free(places.position);
        free(places.walls);
    }
    free(places.back);
    free(places.of_parent);
    if (named) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "/domain/upper: the box is too narrow for a network that repeats: "
                  "grains meet that are more than %d boxes apart",
                  FARTHEST_IMAGE);
}

void nodes_free(struct nodes *nodes)
{
    free(nodes->position);
    free(nodes->walls);
    *nodes = (struct nodes){0};
}
