// SPDX-License-Identifier: GPL-3.0-or-later
// Open shares of the faces of a grid that spheres cut.
//
// A sphere of radius r at distance d from the plane of a face covers a disc of
//     rho = sqrt(r^2 - d^2)
// in it, and of the face its part in the rectangle,
//     disc_in_rectangle = Q(x1, y1) - Q(x0, y1) - Q(x1, y0) + Q(x0, y0),
// Q(x, y) that part of the disc below x and below y:
//     rho^2/2 (pi/2 + asin x/rho + asin y/rho) + (x sqrt(rho^2 - x^2) + y sqrt(..))/2 +
//     x y
// where (x, y) lies in the disc; segments of the disc otherwise.
#include "support_grid.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// Of a disc of radius 1, what lies beyond x.
static double segment(double x)
{
    return acos(x) - x * sqrt(1 - x * x);
}

// Of a disc of radius 1, what lies below X and below Y.
static double corner(double x, double y)
{
    x = fmax(-1, fmin(1, x));
    y = fmax(-1, fmin(1, y));
    if (x * x + y * y < 1)
        return 0.5 * (M_PI_2 + asin(x) + asin(y) + x * sqrt(1 - x * x) +
                      y * sqrt(1 - y * y)) +
               x * y;
    if (x < 0) return y < 0 ? 0 : segment(-x);
    return y < 0 ? segment(-y) : M_PI - segment(x) - segment(y);
}

double disc_in_rectangle(double radius, const double lower[2], const double upper[2])
{
    const double x0 = lower[0] / radius, y0 = lower[1] / radius, x1 = upper[0] / radius,
                 y1 = upper[1] / radius;
    return radius * radius *
           (corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0));
}

double void_share(const struct packing *packing)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    double solid = 0;
    for (int i = 0; i < packing->n_particle; i++)
        if (!is_auxiliary(packing, i))
            solid += 4 * M_PI / 3 * pow(packing->radius[i], 3);
    return 1 - solid / (edge.x * edge.y * edge.z);
}

struct sphere {
    double at[3], radius; // from the lower corner, in the grid's unit
};

// The covered share of the face between LOWER and UPPER, from the disc's centre.
static double covered(double rho, const double lower[2], const double upper[2])
{
    double near = 0, far = 0;
    for (int b = 0; b < 2; b++) {
        const double gap = fmax(0, fmax(lower[b], -upper[b]));
        const double reach = fmax(fabs(lower[b]), fabs(upper[b]));
        near += gap * gap;
        far += reach * reach;
    }
    if (near >= rho * rho) return 0;
    if (far <= rho * rho) return 1;
    return disc_in_rectangle(rho, lower, upper) /
           ((upper[0] - lower[0]) * (upper[1] - lower[1]));
}

// Covers the faces across axis A in the plane of those of the cells I.
static void cover_plane(struct grid *grid, int a, int i, const double at[3], double rho)
{
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    const double hb = grid->spacing[b], hc = grid->spacing[c];
    int from[3], to[3];
    for (int e = 0; e < 3; e++) {
        from[e] = (int)fmax(1, floor((at[e] - rho) / grid->spacing[e]) + 1);
        to[e] = (int)fmin(grid->n[e], ceil((at[e] + rho) / grid->spacing[e]));
    }
    for (int k = from[c]; k <= to[c]; k++)
        for (int j = from[b]; j <= to[b]; j++) {
            const double lower[2] = {(j - 1) * hb - at[b], (k - 1) * hc - at[c]};
            const double upper[2] = {lower[0] + hb, lower[1] + hc};
            const size_t face = (size_t)i * grid->stride[a] +
                                (size_t)j * grid->stride[b] +
                                (size_t)k * grid->stride[c];
            const float open = grid->open[a][face] - (float)covered(rho, lower, upper);
            grid->open[a][face] = open > 1e-6F ? open : 0;
        }
}

static void cover_axis(struct grid *grid, int a, const struct sphere *sphere)
{
    const double h = grid->spacing[a], x = sphere->at[a], r = sphere->radius;
    const int last = (int)fmin(grid->n[a] + 1, floor((x + r) / h) + 1);
    for (int i = (int)fmax(1, ceil((x - r) / h) + 1); i <= last; i++) {
        const double d = (i - 1) * h - x, square = r * r - d * d;
        if (square > 0) cover_plane(grid, a, i, sphere->at, sqrt(square));
    }
}

// The images of a sphere that may reach into the box.
static void cover_images(struct grid *grid, int a, const struct sphere *sphere)
{
    for (int code = 0; code < 27; code++) {
        const int shift[3] = {code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1};
        struct sphere image = *sphere;
        bool reaches = true;
        for (int e = 0; e < 3; e++) {
            image.at[e] += shift[e] * grid->edge[e];
            if (shift[e] && !grid->periodic[e]) reaches = false;
            if (image.at[e] + image.radius < 0 ||
                image.at[e] - image.radius > grid->edge[e])
                reaches = false;
        }
        if (reaches) cover_axis(grid, a, &image);
    }
}

static void size_grid(struct grid *grid, const struct packing *packing, int cells)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    grid->unit = cbrt(edge.x * edge.y * edge.z);
    grid->size = 1;
    for (int a = 0; a < 3; a++) {
        grid->edge[a] = component(edge, a) / grid->unit;
        grid->n[a] = (int)fmax(1, rint(cells * grid->edge[a]));
        grid->spacing[a] = grid->edge[a] / grid->n[a];
        grid->periodic[a] = packing->periodic[a];
        grid->stride[a] = grid->size;
        grid->size *= (size_t)grid->n[a] + 2;
    }
}

struct grid grid_of(const struct packing *packing, int cells)
{
    struct grid grid = {0};
    size_grid(&grid, packing, cells);
#pragma omp parallel for schedule(static, 1)
    for (int a = 0; a < 3; a++) {
        grid.open[a] = NEW_ARRAY(float, grid.size);
        for (size_t c = 0; c < grid.size; c++)
            grid.open[a][c] = 1;
        for (int p = 0; p < packing->n_particle; p++) {
            if (is_auxiliary(packing, p)) continue;
            struct sphere sphere = {.radius = packing->radius[p] / grid.unit};
            for (int e = 0; e < 3; e++)
                sphere.at[e] =
                    component(subtract(packing->position[p], packing->lower), e) /
                    grid.unit;
            cover_images(&grid, a, &sphere);
        }
    }
    return grid;
}

void grid_free(struct grid *grid)
{
    for (int a = 0; a < 3; a++)
        free(grid->open[a]);
    *grid = (struct grid){0};
}
