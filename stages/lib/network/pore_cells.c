// SPDX-License-Identifier: GPL-3.0-or-later
// Pores: the tetrahedra of the regular triangulation of grains and walls [C 2.1], a
// wall being a sphere of unlimited radius. The centre c of a pore has equal power to
// its four corners,
//     2 u . c = u . u - w_1 + w_0,  likewise v and w,   relative to corner 0,
// where a wall stands for the reflection of a corner grain in it. In a periodic box
// the triangulation contains copies: the cell whose first corner (in a canonical
// order) is a grain itself represents all its copies, and neighbours are looked up by
// name. Cells whose centres coincide, as on lattices, are one pore; flat cells, whose
// centre would be rounding noise, take that of a neighbour.
#include "network/pore_cells.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"
#include "geometry/triangulation/triangulation_in_walls.h"

#include <stdlib.h>

// In units: copies of grains are first made as far as this.
static const double FIRST_REACH = 2;

// A cell is flat if the determinant of its edges from one corner is below this part of
// their product: its centre would depend on the last digits of its corners.
static const double MIN_DETERMINANT = 1e-8;

// Two centres closer than this, in units, are one: rounding moves them less.
static const double COINCIDENCE = 1e-9;

const int facet_corner[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

// ---- centres ------------------------------------------------------------------------

// The four points of equal power: a wall is where the power to a grain is that to the
// grain's reflection.
struct power_points {
    struct vector point[4];
    double weight[4];
};

static struct power_points corners_of(const struct grains *grains,
                                      const struct cell *cell)
{
    struct power_points four;
    int grain = 0;
    while (cell->vertex[grain] < 0)
        grain++;
    const struct vector at = grains->position[cell->vertex[grain]];
    for (int k = 0; k < 4; k++) {
        const int32_t vertex = cell->vertex[k];
        four.point[k] = vertex < 0 ? at : grains->position[vertex];
        four.weight[k] = grains->weight[vertex < 0 ? cell->vertex[grain] : vertex];
        if (vertex >= 0) continue;
        const int wall = -1 - vertex, axis = wall / 2;
        const double plane = wall % 2 ? component(grains->box, axis) : 0;
        set_component(&four.point[k], axis, 2 * plane - component(at, axis));
    }
    return four;
}

// The point of equal power. False when the four are so nearly in one plane that digits
// would be lost.
static bool power_centre(const struct power_points *four, struct vector *centre)
{
    const struct vector a = four->point[0];
    const struct vector u = subtract(four->point[1], a),
                        v = subtract(four->point[2], a),
                        w = subtract(four->point[3], a);
    const struct vector vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
    const double determinant = dot(u, vw), uu = dot(u, u), vv = dot(v, v),
                 ww = dot(w, w);
    if (!(fabs(determinant) > MIN_DETERMINANT * sqrt(uu * vv * ww))) return false;
    const double p = uu - four->weight[1] + four->weight[0],
                 q = vv - four->weight[2] + four->weight[0],
                 r = ww - four->weight[3] + four->weight[0];
    const double half = 0.5 / determinant;
    *centre =
        add(a, add(scale(half * p, vw), add(scale(half * q, wu), scale(half * r, uv))));
    return true;
}

// Moves a centre exactly onto the walls among its corners.
static void put_on_walls(const struct grains *grains, const int32_t corner[4],
                         struct vector *at)
{
    for (int k = 0; k < 4; k++) {
        if (corner[k] >= 0) continue;
        const int wall = -1 - corner[k];
        set_component(at, wall / 2, wall % 2 ? component(grains->box, wall / 2) : 0);
    }
}

// The centres of all cells; node -1 where a cell is flat. Returns how many are.
static int find_centres(const struct grains *grains,
                        struct triangulation *triangulation, struct vector *centre)
{
    int n_flat = 0;
    triangulation->node = NEW_ARRAY(int32_t, triangulation->n_cell);
#pragma omp parallel for schedule(static) reduction(+ : n_flat)
    for (int c = 0; c < triangulation->n_cell; c++) {
        const struct cell *cell = &triangulation->cell[c];
        const struct power_points four = corners_of(grains, cell);
        triangulation->node[c] = power_centre(&four, &centre[c]) ? 0 : -1;
        n_flat += triangulation->node[c] < 0;
        put_on_walls(grains, cell->vertex, &centre[c]);
    }
    return n_flat;
}

// ---- copies -------------------------------------------------------------------------

// The name of a cell: its corners sorted by base and image. Copies of a cell have the
// same name but for FIRST, the image of their first corner.
struct name {
    int32_t corner[4], image[4]; // images from the first's
    struct image first;
    int cell;
};

static struct name name_of(const struct grains *grains, const struct cell *cell, int c)
{
    struct name name = {.cell = c};
    struct image image[4];
    for (int k = 0; k < 4; k++) {
        const int32_t vertex = cell->vertex[k];
        // Walls, which repeat themselves, come last.
        const int32_t corner =
            vertex < 0 ? grains->n_base - 1 - vertex : grains->base[vertex];
        const struct image at = vertex < 0 ? (struct image){0} : grains->image[vertex];
        int place = k;
        for (; place > 0; place--) {
            const int32_t before = name.corner[place - 1];
            if (before < corner ||
                (before == corner && image_number(image[place - 1]) < image_number(at)))
                break;
            name.corner[place] = before;
            image[place] = image[place - 1];
        }
        name.corner[place] = corner;
        image[place] = at;
    }
    name.first = image[0];
    for (int k = 0; k < 4; k++)
        name.image[k] = name.corner[k] < grains->n_base
                            ? image_number(image_difference(image[k], name.first))
                            : 0;
    return name;
}

static int compare_names(const void *a, const void *b)
{
    const struct name *x = a, *y = b;
    for (int k = 0; k < 4; k++) {
        if (x->corner[k] != y->corner[k]) return x->corner[k] < y->corner[k] ? -1 : 1;
        if (x->image[k] != y->image[k]) return x->image[k] < y->image[k] ? -1 : 1;
    }
    return 0;
}

// Whether a cell represents its copies: its first corner is a grain itself.
static bool is_representative(const struct name *name)
{
    return same_image(name->first, (struct image){0});
}

// Numbers the cells that represent their copies (node; -1 for the others) and lists the
// names of those with a copy beside them, sorted. The caller frees the list.
static struct name *number_cells(const struct grains *grains,
                                 struct triangulation *triangulation, int *n_cell,
                                 int *n_name)
{
    struct name *names = NULL;
    int count = 0, capacity = 0;
    *n_cell = 0;
    for (int c = 0; c < triangulation->n_cell; c++) {
        const struct name name = name_of(grains, &triangulation->cell[c], c);
        triangulation->node[c] = is_representative(&name) ? (*n_cell)++ : -1;
    }
    for (int c = 0; c < triangulation->n_cell; c++) {
        const struct cell *cell = &triangulation->cell[c];
        bool beside = false;
        for (int k = 0; k < 4 && triangulation->node[c] >= 0; k++)
            beside |=
                cell->neighbour[k] >= 0 && triangulation->node[cell->neighbour[k]] < 0;
        if (!beside) continue;
        GROW_ARRAY(names, count, capacity);
        names[count++] = name_of(grains, cell, c);
    }
    if (count) qsort(names, (size_t)count, sizeof *names, compare_names);
    *n_name = count;
    return names;
}

// Whether no copy that was left out could change this cell: it would have to be inside
// the sphere around the centre in which a grain has less power than the corners.
static bool is_complete(const struct grains *grains, const struct cell *cell,
                        struct vector centre, double largest_weight)
{
    for (int k = 0; k < 4; k++) {
        int walls = 0;
        for (int m = 0; m < 4; m++)
            walls += m != k && cell->vertex[m] < 0;
        if (cell->neighbour[k] < 0 && walls < 3) return false;
    }
    int grain = 0;
    while (cell->vertex[grain] < 0)
        grain++;
    const struct vector to = subtract(grains->position[cell->vertex[grain]], centre);
    const double power = dot(to, to) - grains->weight[cell->vertex[grain]];
    const double radius = sqrt(fmax(0, power + largest_weight));
    for (int axis = 0; axis < 3; axis++) {
        if (!grains->repeats[axis]) continue;
        const double x = component(centre, axis);
        if (x - radius <= -grains->reach ||
            x + radius >= component(grains->box, axis) + grains->reach)
            return false;
    }
    return true;
}

static bool are_complete(const struct grains *grains,
                         const struct triangulation *triangulation,
                         const struct vector *centre)
{
    double largest_weight = 0;
    for (int i = 0; i < grains->n_base; i++)
        largest_weight = fmax(largest_weight, grains->weight[i]);
    for (int c = 0; c < triangulation->n_cell; c++) {
        const struct cell *cell = &triangulation->cell[c];
        if (triangulation->node[c] >= 0 &&
            !is_complete(grains, cell, centre[c], largest_weight))
            return false;
    }
    return true;
}

// ---- from the triangulation ---------------------------------------------------------

// The cell that represents cell C, and the image in which it is C; -1: none, because
// too few copies were made.
static int32_t representative(const struct grains *grains,
                              const struct triangulation *triangulation, int c,
                              const struct name *names, int n_name, struct image *image)
{
    *image = (struct image){0};
    if (triangulation->node[c] >= 0) return triangulation->node[c];
    const struct name name = name_of(grains, &triangulation->cell[c], c);
    const struct name *found =
        n_name ? bsearch(&name, names, (size_t)n_name, sizeof name, compare_names)
               : NULL;
    if (!found) return -1;
    *image = name.first;
    return triangulation->node[found->cell];
}

static bool copy_cell(const struct grains *grains,
                      const struct triangulation *triangulation, int c,
                      const struct name *names, int n_name, struct pore_cell *to)
{
    const struct cell *from = &triangulation->cell[c];
    for (int k = 0; k < 4; k++) {
        const int32_t vertex = from->vertex[k];
        to->corner[k] = vertex < 0 ? vertex : grains->base[vertex];
        if (vertex >= 0) to->corner_image[k] = grains->image[vertex];
        to->neighbour[k] = -1;
        if (from->neighbour[k] < 0) continue;
        to->neighbour[k] = representative(grains, triangulation, from->neighbour[k],
                                          names, n_name, &to->neighbour_image[k]);
        if (to->neighbour[k] < 0) return false;
    }
    return true;
}

// Keeps the cells that represent their copies in CELLS; false when too few copies were
// made.
static bool keep_cells(const struct grains *grains, struct triangulation *triangulation,
                       struct cells *cells, uint8_t **is_flat)
{
    const int n = triangulation->n_cell;
    uint8_t *all_flat = NEW_ARRAY(uint8_t, n);
    struct vector *centre = NEW_ARRAY(struct vector, n);
    cells->n_flat = find_centres(grains, triangulation, centre);
    for (int c = 0; c < n; c++)
        all_flat[c] = triangulation->node[c] < 0;
    int n_name = 0;
    struct name *names = NULL;
    if (grains_repeat(grains))
        names = number_cells(grains, triangulation, &cells->n, &n_name);
    else
        for (int c = 0; c < n; c++)
            triangulation->node[c] = cells->n++;
    bool complete =
        are_complete(grains, triangulation, centre) || !grains_repeat(grains);
    cells->cell = NEW_ARRAY(struct pore_cell, cells->n);
    *is_flat = NEW_ARRAY(uint8_t, cells->n);
    for (int c = 0; c < n && complete; c++) {
        const int32_t number = triangulation->node[c];
        if (number < 0) continue;
        cells->cell[number].centre = centre[c];
        complete =
            copy_cell(grains, triangulation, c, names, n_name, &cells->cell[number]);
        (*is_flat)[number] = all_flat[c];
    }
    free(names);
    free(all_flat);
    free(centre);
    return complete;
}

// ---- pores --------------------------------------------------------------------------

// A flat cell has no volume between its neighbours: it takes the centre of the first of
// them that has one. That neighbour must have the same walls among its corners.
static void place_flat_cells(const struct grains *grains, struct cells *cells,
                             uint8_t *is_flat)
{
    for (bool settled = false; !settled;) {
        settled = true;
        for (int c = 0; c < cells->n; c++) {
            if (!is_flat[c]) continue;
            struct pore_cell *cell = &cells->cell[c];
            for (int k = 0; k < 4 && is_flat[c]; k++) {
                const int32_t other = cell->neighbour[k];
                if (other < 0 || is_flat[other] || cell->corner[k] < 0) continue;
                cell->centre = in_image(grains, cells->cell[other].centre,
                                        cell->neighbour_image[k]);
                put_on_walls(grains, cell->corner, &cell->centre);
                is_flat[c] = 0;
                settled = false;
            }
        }
    }
}

static void unite_pores(const struct grains *grains, struct cells *cells)
{
    int *set = NEW_ARRAY(int, cells->n);
    for (int c = 0; c < cells->n; c++)
        set[c] = c;
    for (int c = 0; c < cells->n; c++)
        for (int k = 0; k < 4; k++) {
            const struct pore_cell *cell = &cells->cell[c];
            const int32_t other = cell->neighbour[k];
            if (other < 0) continue;
            const struct vector there =
                in_image(grains, cells->cell[other].centre, cell->neighbour_image[k]);
            if (distance(cell->centre, there) <= COINCIDENCE) unite_sets(set, c, other);
        }
    // The root comes before its members.
    for (int c = 0; c < cells->n; c++) {
        const int root = set_root(set, c);
        cells->cell[c].pore = root == c ? cells->n_pore++ : cells->cell[root].pore;
    }
    free(set);
}

static int count_hidden(const struct grains *grains, const struct cells *cells)
{
    uint8_t *met = NEW_ARRAY(uint8_t, grains->n_base);
    for (int c = 0; c < cells->n; c++)
        for (int k = 0; k < 4; k++)
            if (cells->cell[c].corner[k] >= 0) met[cells->cell[c].corner[k]] = 1;
    int hidden = grains->n_base;
    for (int i = 0; i < grains->n_base; i++)
        hidden -= met[i];
    free(met);
    return hidden;
}

// Whether a larger reach would give no more copies.
static bool all_copies(const struct grains *grains)
{
    for (int axis = 0; axis < 3; axis++)
        if (grains->repeats[axis] &&
            grains->reach < FARTHEST_IMAGE * component(grains->box, axis))
            return false;
    return true;
}

enum status find_cells(const struct packing *packing, struct grains *grains,
                       struct cells *cells, struct reason *reason)
{
    *cells = (struct cells){0};
    for (double reach = FIRST_REACH;; reach *= 2) {
        const enum status status = place_grains(packing, reach, grains, reason);
        if (status) return status;
        unsigned walls = 0;
        for (int wall = 0; wall < WALL_COUNT; wall++)
            walls |= (grains->repeats[wall / 2] ? 0u : 1u) << wall;
        struct triangulation triangulation = {0};
        uint8_t *is_flat = NULL;
        const bool complete =
            !triangulate_in_walls(grains->position, grains->weight, grains->n, walls,
                                  grains->box, &triangulation) &&
            keep_cells(grains, &triangulation, cells, &is_flat);
        triangulation_free(&triangulation);
        if (complete) {
            place_flat_cells(grains, cells, is_flat);
            unite_pores(grains, cells);
            cells->n_hidden = count_hidden(grains, cells);
        }
        free(is_flat);
        if (complete) return STATUS_OK;
        cells_free(cells);
        if (all_copies(grains))
            return refuse(reason, STATUS_BAD_DATA,
                          "/domain/upper: the box is too narrow to repeat: grains meet "
                          "that are more than %d boxes apart",
                          FARTHEST_IMAGE);
        grains_free(grains);
    }
}

void cells_free(struct cells *cells)
{
    free(cells->cell);
    *cells = (struct cells){0};
}
