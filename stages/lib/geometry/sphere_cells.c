// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of a box, each with all spheres whose surface comes within `reach` of it, the
// largest first. Where the box repeats, spheres are copied across its sides. Cells
// widen until the lists are short on average, so memory stays O(n) for any range of
// radii: from 1.6 cbrt(volume / n) on the width doubles until there are at most 2 n +
// 64 cells and 64 n members; reach = 0.2 times the narrowest width.
#include "geometry/sphere_cells.h"

#include "basics/memory.h"

#include <stdlib.h>

// ---- spheres ------------------------------------------------------------------------

struct spheres {
    struct sphere *sphere;
    int n, capacity;
};

static void add_sphere(struct spheres *all, struct sphere sphere)
{
    GROW_ARRAY(all->sphere, all->n, all->capacity);
    all->sphere[all->n++] = sphere;
}

static struct spheres find_spheres(const struct packing *packing)
{
    struct spheres all = {0};
    for (int i = 0; i < packing->n_particle; i++)
        if (!is_auxiliary(packing, i))
            add_sphere(&all, (struct sphere){packing->position[i], packing->radius[i]});
    return all;
}

// In place of sphere K its copies along AXIS that come near the box. Those half a box
// beyond it are never the nearest to what is in it.
static void copy_along(struct spheres *all, const struct sphere_cells *cells, int k,
                       int axis)
{
    const struct sphere sphere = all->sphere[k];
    const double period = cells->period[axis], lower = cells->lower[axis];
    const double x = component(sphere.centre, axis);
    const double far = fmin(sphere.radius + cells->reach, period / 2);
    const double first = ceil((lower - x - far) / period),
                 last = floor((lower + period - x + far) / period);
    const int count = (int)(last - first) + 1;
    for (int copied = 0; copied < count; copied++) {
        struct sphere copy = sphere;
        set_component(&copy.centre, axis, x + (first + copied) * period);
        if (copied == 0)
            all->sphere[k] = copy;
        else
            add_sphere(all, copy);
    }
}

static int compare_spheres(const void *a, const void *b)
{
    const struct sphere *s = a, *t = b;
    return (s->radius < t->radius) - (s->radius > t->radius);
}

// Copied where the box repeats, the largest first.
static void arrange_spheres(struct spheres *all, const struct sphere_cells *cells)
{
    for (int axis = 0; axis < 3; axis++) {
        const int before = all->n;
        for (int k = 0; k < before && cells->repeats[axis]; k++)
            copy_along(all, cells, k, axis);
    }
    if (all->n > 0)
        qsort(all->sphere, (size_t)all->n, sizeof *all->sphere, compare_spheres);
}

// ---- cells --------------------------------------------------------------------------

// Extent along an axis: the box where it repeats, otherwise that of the grains.
static double length_along(struct sphere_cells *cells, const struct packing *packing,
                           int axis)
{
    double lower = INFINITY, upper = -INFINITY, widest = 0;
    if (packing->periodic[axis]) {
        cells->lower[axis] = component(packing->lower, axis);
        return component(packing->upper, axis) - cells->lower[axis];
    }
    for (int i = 0; i < packing->n_particle; i++) {
        const double x = component(packing->position[i], axis);
        lower = fmin(lower, x);
        upper = fmax(upper, x);
        widest = fmax(widest, packing->radius[i]);
    }
    cells->lower[axis] = lower;
    return fmax(upper - lower, widest);
}

struct range {
    int first[3], last[3];
};

// Cells that the box around a sphere meets; none outside a box that repeats.
static struct range cells_of(const struct sphere_cells *cells, struct sphere sphere)
{
    struct range range;
    const double reach = sphere.radius + cells->reach;
    for (int axis = 0; axis < 3; axis++) {
        const double x = component(sphere.centre, axis);
        const int first = sphere_cell_along(cells, axis, x - reach),
                  last = sphere_cell_along(cells, axis, x + reach);
        range.first[axis] = first > 0 ? first : 0;
        range.last[axis] = last < cells->count[axis] ? last : cells->count[axis] - 1;
    }
    return range;
}

static double count_cells(const struct sphere_cells *cells)
{
    return (double)cells->count[0] * cells->count[1] * cells->count[2];
}

static double count_members(const struct sphere_cells *cells, const struct spheres *all)
{
    double sum = 0;
    for (int k = 0; k < all->n; k++) {
        const struct range range = cells_of(cells, all->sphere[k]);
        double product = 1;
        for (int axis = 0; axis < 3; axis++)
            product *= range.last[axis] - range.first[axis] + 1;
        sum += product;
    }
    return sum;
}

// Widths and reaches that cost least among those tried, for the throats of packings of
// 34 and 64 % solids.
static void size_cells(struct sphere_cells *cells, const struct spheres *all,
                       const double length[3])
{
    enum { MOST_MEMBERS = 64 }; // a sphere, on average
    const double volume = length[0] * length[1] * length[2];
    double width = 1.6 * cbrt(volume / fmax(all->n, 1));
    do {
        double narrowest = INFINITY;
        for (int axis = 0; axis < 3; axis++) {
            cells->count[axis] = (int)fmin(fmax(length[axis] / width, 1), 1 << 20);
            cells->per_length[axis] = cells->count[axis] / length[axis];
            narrowest = fmin(narrowest, length[axis] / cells->count[axis]);
        }
        cells->reach = 0.2 * narrowest;
        width *= 2;
    } while (count_cells(cells) > 2.0 * all->n + 64 ||
             count_members(cells, all) > MOST_MEMBERS * (double)all->n);
}

// The members of each cell follow each other from NEXT of it on, which moves on.
static void fill_cells(struct sphere_cells *cells, const struct spheres *all,
                       int64_t *next)
{
    for (int k = 0; k < all->n; k++) {
        const struct range range = cells_of(cells, all->sphere[k]);
        for (int x = range.first[0]; x <= range.last[0]; x++)
            for (int y = range.first[1]; y <= range.last[1]; y++)
                for (int z = range.first[2]; z <= range.last[2]; z++) {
                    const int64_t to =
                        next[((int64_t)x * cells->count[1] + y) * cells->count[2] +
                             z]++;
                    if (cells->sphere) cells->sphere[to] = all->sphere[k];
                }
    }
}

struct sphere_cells sphere_cells_init(const struct packing *packing)
{
    struct sphere_cells cells = {0};
    double length[3];
    for (int axis = 0; axis < 3; axis++) {
        length[axis] = length_along(&cells, packing, axis);
        cells.repeats[axis] = packing->periodic[axis];
        cells.period[axis] = cells.repeats[axis] ? length[axis] : 0;
    }
    struct spheres all = find_spheres(packing);
    size_cells(&cells, &all, length);
    arrange_spheres(&all, &cells);
    cells.largest = all.n ? all.sphere[0].radius : 0;
    const size_t n = (size_t)count_cells(&cells);
    cells.offset = NEW_ARRAY(int64_t, n + 2);
    fill_cells(&cells, &all, cells.offset + 2);
    for (size_t c = 0; c < n; c++)
        cells.offset[c + 2] += cells.offset[c + 1];
    cells.sphere =
        allocate_uncleared((size_t)cells.offset[n + 1], sizeof *cells.sphere);
    fill_cells(&cells, &all, cells.offset + 1);
    free(all.sphere);
    return cells;
}

void sphere_cells_free(struct sphere_cells *cells)
{
    free(cells->offset);
    free(cells->sphere);
    *cells = (struct sphere_cells){0};
}
