// SPDX-License-Identifier: GPL-3.0-or-later
// The radial distribution function
//     g(r) = pairs found in the shell / (references (n - 1) shell / space),
// where `shell` is the mean volume of the shell of r inside the window, over all places
// of its centre there (ball_in_window): so the finite window leaves no bias, and pairs
// of a periodic box are counted in all images. At most MOST_REFERENCES centres are
// looked around, evenly chosen.
#include "geometry/radial_distribution.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_REFERENCES = 20000, MOST_CELLS_ALONG = 512 };

// Centres in the window, those of one cell side by side.
struct cell_list {
    const struct packing *packing;
    struct window window;
    struct vector edge, width;
    int count[3];
    int n;
    int *offset;           // (cells + 1) where each cell begins
    struct vector *centre; // (n)
};

struct tally {
    double width, reach;
    int count;
    double *pairs; // (count)
};

// The window may touch the box only where the box repeats: centres beyond go back in.
static bool bring_inside(const struct cell_list *cells, struct vector *centre)
{
    for (int axis = 0; axis < 3; axis++) {
        const double low = component(cells->window.lower, axis);
        const double edge = component(cells->edge, axis);
        double at = component(*centre, axis) - low;
        if (cells->packing->periodic[axis]) at -= edge * floor(at / edge);
        if (!(at >= 0 && at <= edge)) return false;
        set_component(centre, axis, low + at);
    }
    return true;
}

static int cell_of(const struct cell_list *cells, struct vector centre)
{
    int index = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double at =
            component(centre, axis) - component(cells->window.lower, axis);
        const int along = (int)(at / component(cells->width, axis));
        const int last = cells->count[axis] - 1;
        index = index * cells->count[axis] + (along < last ? along : last);
    }
    return index;
}

// Cells of about half the reach, and not many more than there are grains.
static void shape_cells(struct cell_list *cells, double reach)
{
    cells->edge = subtract(cells->window.upper, cells->window.lower);
    const double most = cbrt(8.0 * cells->packing->n_particle) + 1;
    for (int axis = 0; axis < 3; axis++) {
        const double edge = component(cells->edge, axis);
        const double wanted = fmin(fmin(2 * edge / reach, most), MOST_CELLS_ALONG);
        cells->count[axis] = wanted < 1 ? 1 : (int)wanted;
        set_component(&cells->width, axis, edge / cells->count[axis]);
    }
}

static struct cell_list list_cells(const struct packing *packing,
                                   const struct window *window, double reach)
{
    struct cell_list cells = {.packing = packing, .window = *window};
    shape_cells(&cells, reach);
    const size_t total =
        (size_t)cells.count[0] * (size_t)cells.count[1] * (size_t)cells.count[2];
    cells.offset = NEW_ARRAY(int, total + 2);
    struct vector *inside = NEW_ARRAY(struct vector, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++) {
        inside[cells.n] = packing->position[i];
        if (!bring_inside(&cells, &inside[cells.n])) continue;
        cells.offset[cell_of(&cells, inside[cells.n++]) + 2]++;
    }
    for (size_t c = 2; c < total + 2; c++)
        cells.offset[c] += cells.offset[c - 1];
    cells.centre = NEW_ARRAY(struct vector, cells.n);
    for (int i = 0; i < cells.n; i++) // one further on, offset[c + 1] becomes the end
        cells.centre[cells.offset[cell_of(&cells, inside[i]) + 1]++] = inside[i];
    free(inside);
    return cells;
}

static void count_in_cell(const struct cell_list *cells, int cell, struct vector from,
                          int itself, struct tally *tally)
{
    for (int j = cells->offset[cell]; j < cells->offset[cell + 1]; j++) {
        const struct vector apart = subtract(cells->centre[j], from);
        const double square = dot(apart, apart);
        if (square >= tally->reach * tally->reach || j == itself) continue;
        const int k = (int)(sqrt(square) / tally->width + 0.5);
        if (k < tally->count) tally->pairs[k]++; // rounding may make it one more
    }
}

// Cells that the reach of a centre may touch, by their place along an axis; beyond the
// sides only where the box repeats.
static void cell_range(const struct cell_list *cells, struct vector centre,
                       double reach, int low[3], int high[3])
{
    for (int axis = 0; axis < 3; axis++) {
        const double width = component(cells->width, axis);
        const double at =
            component(centre, axis) - component(cells->window.lower, axis);
        low[axis] = (int)floor((at - reach) / width);
        high[axis] = (int)floor((at + reach) / width);
        if (cells->packing->periodic[axis]) continue;
        const int last = cells->count[axis] - 1;
        low[axis] = low[axis] > 0 ? low[axis] : 0;
        high[axis] = high[axis] < last ? high[axis] : last;
    }
}

// Counts what is around centre I: the cells around it, moved by whole periods. A cell
// moved by none holds the centre itself, which is not its own neighbour; its images
// are.
static void count_around(const struct cell_list *cells, int i, struct tally *tally)
{
    const struct vector centre = cells->centre[i];
    int low[3], high[3], at[3];
    cell_range(cells, centre, tally->reach, low, high);
    for (at[0] = low[0]; at[0] <= high[0]; at[0]++)
        for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
            for (at[2] = low[2]; at[2] <= high[2]; at[2]++) {
                struct vector from = centre;
                int cell = 0;
                bool moved = false;
                for (int axis = 0; axis < 3; axis++) {
                    const int n = cells->count[axis];
                    const int periods =
                        (at[axis] >= 0 ? at[axis] : at[axis] - n + 1) / n;
                    cell = cell * n + at[axis] - periods * n;
                    set_component(&from, axis,
                                  component(from, axis) -
                                      periods * component(cells->edge, axis));
                    moved = moved || periods;
                }
                count_in_cell(cells, cell, from, moved ? -1 : i, tally);
            }
}

// Volume of the ball of radius R (flat: area of the disc) as far as it lies in the
// window, averaged over all places of its centre there. From the mean over directions u
// of (1 - r |u_x| / L_x)(1 - r |u_y| / L_y)(1 - r |u_z| / L_z).
static double ball_in_window(const struct cell_list *cells, bool flat, double r)
{
    double a[3];
    for (int axis = 0; axis < 3; axis++)
        a[axis] = cells->packing->periodic[axis] || (flat && axis == 1)
                      ? 0
                      : r / component(cells->edge, axis);
    const double one = a[0] + a[1] + a[2];
    const double two = a[0] * a[1] + a[1] * a[2] + a[2] * a[0];
    const double three = a[0] * a[1] * a[2];
    if (flat) return M_PI * r * r * (1 - 4 / (3 * M_PI) * one + two / (2 * M_PI));
    return 4 * M_PI * r * r * r *
           (1.0 / 3 - one / 8 + 2 / (15 * M_PI) * two - three / (24 * M_PI));
}

double radial_reach(const struct packing *packing, const struct window *window)
{
    const struct vector edge = subtract(window->upper, window->lower);
    const bool flat = packing_is_flat(packing);
    const double n = packing->n_particle;
    double reach = 10 * (flat ? sqrt(edge.x * (edge.z / n))
                              : cbrt(edge.x * edge.y * (edge.z / n)));
    for (int axis = 0; axis < 3; axis++)
        if (!packing->periodic[axis] && !(flat && axis == 1))
            reach = fmin(reach, component(edge, axis));
    return reach;
}

bool radial_distribution(const struct packing *packing, const struct window *window,
                         double width, int count, double *value)
{
    const bool flat = packing_is_flat(packing);
    struct tally tally = {width, (count - 0.5) * width, count, value};
    struct cell_list cells = list_cells(packing, window, tally.reach);
    const int stride = 1 + (cells.n - 1) / MOST_REFERENCES;
    memset(value, 0, (size_t)count * sizeof *value);
    int references = 0;
    for (int i = 0; i < cells.n; i += stride, references++)
        count_around(&cells, i, &tally);

    const struct vector edge = cells.edge;
    const double space = flat ? edge.x * edge.z : box_volume(edge);
    for (int k = 0; k < count && cells.n > 1; k++) {
        const double inner = k ? ball_in_window(&cells, flat, (k - 0.5) * width) : 0;
        const double shell = ball_in_window(&cells, flat, (k + 0.5) * width) - inner;
        value[k] /= (double)references * (cells.n - 1) * (shell / space);
    }
    free(cells.offset);
    free(cells.centre);
    return cells.n > 1;
}
