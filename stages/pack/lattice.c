// SPDX-License-Identifier: GPL-3.0-or-later
// Lattices of touching grains from their unit cells. A grain's place along an axis is
//     lower + radius edge (cell + place + lead),
// with edge and lead of a cell of grains of radius 1. Along an axis that repeats the
// box is whole cells with the grains in their middle; elsewhere it ends with the
// outermost grains. Grains that do not lie wholly in the domain are left out.
#include "basics/memory.h"
#include "pack.h"

enum { MAX_IN_CELL = 4 };

// Lattices by their unit cells, of touching grains of radius 1: edges, and positions of
// the grains as fractions of the edges, the lowest at 0.
struct unit_cell {
    double edge[3];
    int n;
    double place[MAX_IN_CELL][3];
};

static const struct unit_cell simple = {{2, 2, 2}, 1, {{0, 0, 0}}};

static struct unit_cell unit_cell(enum lattice lattice)
{
    const double body = 4 / sqrt(3), face = 2 * sqrt(2);
    switch (lattice) {
    case LATTICE_CUBIC:
        break;
    case LATTICE_BODY_CENTRED:
        return (struct unit_cell){{body, body, body}, 2, {{0}, {0.5, 0.5, 0.5}}};
    case LATTICE_FACE_CENTRED:
        return (struct unit_cell){
            {face, face, face}, 4, {{0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}}};
    case LATTICE_HEXAGONAL:
        return (struct unit_cell){
            {2, 2 * sqrt(3), 4 * sqrt(2. / 3)},
            4,
            {{0}, {0.5, 0.5, 0}, {0.5, 1. / 6, 0.5}, {0, 2. / 3, 0.5}}};
    case LATTICE_TRIANGULAR:
        return (struct unit_cell){{2, 2, 2 * sqrt(3)}, 2, {{0}, {0.5, 0, 0.5}}};
    case LATTICE_HONEYCOMB:
        return (struct unit_cell){
            {2 * sqrt(3), 2, 6},
            4,
            {{0}, {0, 0, 1. / 3}, {0.5, 0, 0.5}, {0.5, 0, 5. / 6}}};
    }
    return simple;
}

// Highest position of a grain along AXIS, in edges of the cell.
static double highest(const struct unit_cell *cell, int axis)
{
    double place = 0;
    for (int k = 0; k < cell->n; k++)
        place = fmax(place, cell->place[k][axis]);
    return place;
}

// Distance from the lower side of the box to the first grain. A periodic box has whole
// cells with the grains in their middle; else the box ends with the outermost grains.
// In edges of the cell.
static double lead(const struct unit_cell *cell, int axis, bool periodic)
{
    return periodic ? (1 - highest(cell, axis)) / 2 : 1 / cell->edge[axis];
}

static double extent(const struct unit_cell *cell, int axis, bool periodic,
                     int64_t count)
{
    if (periodic) return (double)count;
    return (double)(count - 1) + highest(cell, axis) + 2 / cell->edge[axis];
}

struct vector lattice_extent(enum lattice lattice, const int64_t counts[3],
                             double radius, const bool periodic[3])
{
    const struct unit_cell cell = unit_cell(lattice);
    struct vector size;
    for (int axis = 0; axis < 3; axis++)
        set_component(&size, axis,
                      radius * cell.edge[axis] *
                          extent(&cell, axis, periodic[axis], counts[axis]));
    return size;
}

enum status lattice_counts(enum lattice lattice, const struct domain *domain,
                           double radius, int64_t counts[3], struct reason *reason)
{
    const struct unit_cell cell = unit_cell(lattice);
    for (int axis = 0; axis < 3; axis++) {
        const double cells =
            (component(domain->upper, axis) - component(domain->lower, axis)) /
            (radius * cell.edge[axis]);
        counts[axis] = (int64_t)fmin(ceil(cells), 1e9);
        if (!domain->periodic[axis]) continue;
        counts[axis] = (int64_t)fmin(fmax(round(cells), 1), 1e9);
        if (fabs(cells / (double)counts[axis] - 1) > 1e-9)
            return refuse(reason, STATUS_BAD_DATA,
                          "pack.upper: must leave a whole number of lattice cells of "
                          "%.17g m along %c, which repeats, leaves %.9g",
                          radius * cell.edge[axis], "xyz"[axis], cells);
    }
    return STATUS_OK;
}

int64_t lattice_grains(enum lattice lattice, const int64_t counts[3])
{
    const double grains = (double)counts[0] * (double)counts[1] * (double)counts[2] *
                          unit_cell(lattice).n;
    return grains > 1e8 ? -1 : (int64_t)grains;
}

struct packing lattice_packing(enum lattice lattice, const int64_t counts[3],
                               double radius, const struct domain *domain)
{
    const struct unit_cell cell = unit_cell(lattice);
    double from[3];
    for (int axis = 0; axis < 3; axis++)
        from[axis] = lead(&cell, axis, domain->periodic[axis]);
    const int64_t most = lattice_grains(lattice, counts);
    struct packing packing = packing_in(domain, (int)most);
    int n = 0;
    for (int64_t k = 0; k < most; k++) { // z runs fastest, the grains of a cell faster
        const double *place = cell.place[k % cell.n];
        const int64_t c = k / cell.n;
        const int64_t at[3] = {c / counts[2] / counts[1], c / counts[2] % counts[1],
                               c % counts[2]};
        struct vector position;
        for (int axis = 0; axis < 3; axis++)
            set_component(&position, axis,
                          component(domain->lower, axis) +
                              radius * cell.edge[axis] *
                                  ((double)at[axis] + (place[axis] + from[axis])));
        if (!domain_holds(domain, position, radius)) continue;
        packing.position[n] = position;
        packing.radius[n++] = radius;
    }
    packing.n_particle = n;
    return packing;
}
