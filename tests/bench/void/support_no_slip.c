// SPDX-License-Identifier: GPL-3.0-or-later
// The points of a staggered grid that spheres cover, and how near the others are to
// them.
//
// A line of points x_i along an axis at a distance q from a sphere's centre c is solid
// between
//     c - w and c + w,   w = sqrt(r^2 - q^2).
// The point before, at x_i = c - w - theta h, sees the wall instead of its neighbour,
// hence a leak of volume / (theta h^2); so does the one behind.
#include "support_no_slip.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

static const double least_theta = 1e-3;

struct line {
    const struct grid *grid;
    struct level *level;
    unsigned char *solid;
    double offset[3]; // of point 1 from the box's lower corner, in spacings
};

// Index of a point that may lie in another box; into the box.
static size_t place(const struct grid *grid, int axis, int i)
{
    const int n = grid->n[axis];
    return (size_t)(((i - 1) % n + n) % n + 1) * grid->stride[axis];
}

// Covers the points of one line along axis A, START without its place along A.
static void cover_line(struct line *line, int a, size_t start, double centre, double w)
{
    const double h = line->grid->spacing[a];
    const double from = (centre - w) / h - line->offset[a] + 1;
    const double to = (centre + w) / h - line->offset[a] + 1;
    const int first = (int)ceil(from), last = (int)floor(to);
    if (first > last) return;
    const double conductance = line->grid->spacing[0] * line->grid->spacing[1] *
                               line->grid->spacing[2] / (h * h);
    for (int i = first; i <= last; i++)
        line->solid[start + place(line->grid, a, i)] = 1;
    line->level->leak[start + place(line->grid, a, first - 1)] +=
        (float)(conductance / fmax(least_theta, from - (first - 1)));
    line->level->leak[start + place(line->grid, a, last + 1)] +=
        (float)(conductance / fmax(least_theta, last + 1 - to));
}

// All lines along axis A through a sphere.
static void cover_sphere(struct line *line, int a, const double centre[3], double r)
{
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    const double *h = line->grid->spacing, *offset = line->offset;
    const int last_j = (int)floor((centre[b] + r) / h[b] - offset[b] + 1);
    const int last_k = (int)floor((centre[c] + r) / h[c] - offset[c] + 1);
    for (int k = (int)ceil((centre[c] - r) / h[c] - offset[c] + 1); k <= last_k; k++)
        for (int j = (int)ceil((centre[b] - r) / h[b] - offset[b] + 1); j <= last_j;
             j++) {
            const double y = (j - 1 + offset[b]) * h[b] - centre[b];
            const double z = (k - 1 + offset[c]) * h[c] - centre[c];
            const double square = r * r - y * y - z * z;
            if (square > 0)
                cover_line(line, a, place(line->grid, b, j) + place(line->grid, c, k),
                           centre[a], sqrt(square));
        }
}

// Opens the faces between points of the void, and takes the leaks of the others.
static void open_void(struct line *line)
{
    const struct grid *grid = line->grid;
    for (int k = 1; k <= grid->n[2]; k++)
        for (int j = 1; j <= grid->n[1]; j++)
            for (int i = 1; i <= grid->n[0]; i++) {
                const size_t c = cell_at(grid, i, j, k);
                const int at[3] = {i, j, k};
                if (line->solid[c]) line->level->leak[c] = 0;
                for (int a = 0; a < 3; a++) {
                    const size_t below =
                        at[a] > 1 ? c - grid->stride[a]
                                  : c + (size_t)(grid->n[a] - 1) * grid->stride[a];
                    const double h = grid->spacing[a];
                    if (!line->solid[c] && !line->solid[below])
                        line->level->conductance[a][c] =
                            (float)(grid->spacing[0] * grid->spacing[1] *
                                    grid->spacing[2] / (h * h));
                }
            }
}

struct level no_slip_level(const struct grid *grid, const struct packing *packing,
                           int axis)
{
    struct level level = level_of(grid, true);
    struct line line = {
        grid, &level, NEW_ARRAY(unsigned char, grid->size), {0.5, 0.5, 0.5}};
    line.offset[axis] = 0;
    for (int p = 0; p < packing->n_particle; p++) {
        if (is_auxiliary(packing, p)) continue;
        double centre[3];
        for (int e = 0; e < 3; e++)
            centre[e] = component(subtract(packing->position[p], packing->lower), e) /
                        grid->unit;
        for (int a = 0; a < 3; a++)
            cover_sphere(&line, a, centre, packing->radius[p] / grid->unit);
    }
    open_void(&line);
    free(line.solid);
    return level;
}
