// SPDX-License-Identifier: GPL-3.0-or-later
// Damage per column: with the horizontal length a_b of a lateral bond, the column that
// its middle lies in, and a Gaussian G of 0.8 mean diameters, cut off at four of these,
//     damage = G * (sum of a_b over broken bonds) / G * (sum of a_b over all),
// where * goes along x, then along y, around where the box repeats. Upright bonds weigh
// nothing: whether columns part is said by the others.
#include "columns.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

static const double SMOOTHING = 0.8, CUT_OFF = 4; // diameters; of the smoothing
// Of a column: bonds of a lattice lie on the borders of columns, to rounding.
static const double BORDER = 1e-6;

struct columns columns_init(const struct run *run)
{
    const struct packing *packing = &run->packing;
    struct columns c = {.floor = -INFINITY};
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < packing->n_particle; i++) {
        const double z = packing->position[i].z, radius = packing->radius[i];
        c.diameter += 2 * radius / packing->n_particle;
        low = fmin(low, z - radius);
        high = fmax(high, z + radius);
        if (run->held && run->held[i]) c.floor = fmax(c.floor, z);
    }
    c.top = high;
    c.height = high - low;
    if (isinf(c.floor)) c.floor = low;
    c.n = 1;
    for (int axis = 0; axis < 2; axis++) {
        c.lower[axis] = component(packing->lower, axis);
        const double edge = component(packing->upper, axis) - c.lower[axis];
        c.count[axis] = (int)fmax(1, nearbyint(2 * edge / c.diameter));
        c.edge[axis] = edge / c.count[axis];
        c.periodic[axis] = packing->periodic[axis];
        c.n *= c.count[axis];
    }
    return c;
}

// Index I of N columns, brought back into the box or, where that does not repeat, -1.
static int brought_back(int i, int n, bool periodic)
{
    if (i >= 0 && i < n) return i;
    return periodic ? ((i % n) + n) % n : -1;
}

int column_at(const struct columns *columns, double x, double y)
{
    const double at[2] = {x, y};
    int index[2];
    for (int axis = 0; axis < 2; axis++) {
        const int n = columns->count[axis];
        const double along =
            floor((at[axis] - columns->lower[axis]) / columns->edge[axis] + BORDER);
        index[axis] = columns->periodic[axis]
                          ? brought_back((int)fmod(along, n), n, true)
                          : (int)fmin(fmax(along, 0), n - 1);
    }
    return index[0] + columns->count[0] * index[1];
}

int column_beside(const struct columns *columns, int column, int dx, int dy)
{
    const int nx = columns->count[0], ny = columns->count[1];
    const int x = brought_back(column % nx + dx, nx, columns->periodic[0]);
    const int y = brought_back(column / nx + dy, ny, columns->periodic[1]);
    return x < 0 || y < 0 ? -1 : x + nx * y;
}

bool is_lateral(const struct run *run, int bond)
{
    const int32_t *end = run->packing.bond[bond];
    return !run->held || !(run->held[end[0]] || run->held[end[1]]);
}

int column_of_bond(const struct columns *columns, const struct run *run, int bond,
                   double *length)
{
    const struct vector along = bond_vector(&run->packing, bond);
    const struct vector first = run->packing.position[run->packing.bond[bond][0]];
    *length = hypot(along.x, along.y);
    return column_at(columns, first.x + 0.5 * along.x, first.y + 0.5 * along.y);
}

// Smooths VALUE along AXIS. Not normalised: it is divided by another that was smoothed.
static void smooth(const struct columns *columns, double *value, int axis)
{
    const double width = SMOOTHING * columns->diameter;
    const int reach = (int)ceil(CUT_OFF * width / columns->edge[axis]);
    double *was = duplicate(value, (size_t)columns->n, sizeof *value);
    for (int c = 0; c < columns->n; c++) {
        value[c] = 0;
        for (int k = -reach; k <= reach; k++) {
            const int from =
                column_beside(columns, c, axis == 0 ? k : 0, axis == 1 ? k : 0);
            const double away = k * columns->edge[axis] / width;
            if (from >= 0) value[c] += exp(-0.5 * away * away) * was[from];
        }
    }
    free(was);
}

double *column_damage(const struct columns *columns, const struct run *run,
                      const uint8_t *intact)
{
    double *broken = NEW_ARRAY(double, columns->n),
           *all = NEW_ARRAY(double, columns->n);
    for (int b = 0; b < run->packing.n_bond; b++) {
        if (!is_lateral(run, b)) continue;
        double length;
        const int c = column_of_bond(columns, run, b, &length);
        all[c] += length;
        if (!intact[b]) broken[c] += length;
    }
    for (int axis = 0; axis < 2; axis++) {
        smooth(columns, broken, axis);
        smooth(columns, all, axis);
    }
    for (int c = 0; c < columns->n; c++)
        broken[c] = all[c] > 0 ? broken[c] / all[c] : 0;
    free(all);
    return broken;
}
