// SPDX-License-Identifier: GPL-3.0-or-later
// The pressure in every pore, from the balances of the flow [C 6, 20]. The flow is slow
// and viscous, so pressures are linear in what is imposed, and nothing has a history.
#pragma once

#include "basics/compensated.h"
#include "basics/status.h"
#include "sparse/linear_solver.h"
#include "throats.h"

// In units of length, for a viscosity of 1: a flux is then in unit^3 Pa. On one wall at
// most one of pressure and flux is imposed; without both it is closed.
struct conditions {
    double pressure[WALL_COUNT]; // piezometric, Pa; NAN: not imposed
    double flux[WALL_COUNT];     // into the box through the wall, at one pressure all
                                 // over it; NAN: not imposed
    struct vector gradient;      // mean gradient where the box repeats, Pa/unit
};

// How to solve: SOLVER_AUTO takes the faster one (sparse/linear_solver.h).
struct solving {
    enum solver solver;
    double tolerance; // on the imbalance
};

// The pressure is a periodic field plus the mean gradient times the position. Values
// are sums of two doubles: over a wide throat pressures differ by less than the last
// digit of one. Read them by pressure_drop and pore_pressure.
struct pressures {
    int n_node;                // pores behind one flux plate are one
    int32_t *node;             // (n_pore)
    int32_t *node_of_cell;     // (n_cell) the same, for loops over throats
    struct compensated *value; // (n_node) Pa, without the mean gradient
    struct vector gradient;
    double inflow[WALL_COUNT]; // through each wall into the box, unit^3 Pa
    double throughput; // sum over throats of |flux| length / largest edge of the box
    double imbalance;  // largest residual of a pore, or their sum, over the throughput
    int n_pocket;      // sets of pores with no way out
    int n_unknown, iterations;
    bool direct; // by Cholesky's factor
};

// SOURCE (n_pore) is the inflow of each pore from moving grains, or NULL. A pocket
// takes the mean pressure of the pores around it; without any, its mean_pressure is 0.
// Pores in an edge between walls of imposed pressure belong to the lower wall.
// STATUS_BAD_DATA: what flows into a pocket cannot leave it. STATUS_NOT_CONVERGED: the
// imbalance stays above the tolerance. The caller frees with pressures_free. The number
// of threads does not matter. Cost: one factor, or iterations of O(throats) each.
enum status solve_pressures(const struct grains *grains, const struct cells *cells,
                            const struct throats *throats,
                            const struct conditions *conditions, const double *source,
                            const struct solving *solving, struct pressures *pressures,
                            struct reason *reason);
void pressures_free(struct pressures *pressures);

// The walls that each pore is at, (n_pore) bits. The caller frees it.
uint8_t *walls_of_pores(const struct cells *cells);

// The one of a pore's WALLS (bits) through which fluid enters or leaves it; -1: none.
int feeding_wall(const struct conditions *conditions, unsigned walls);

// p_i - p_j over a throat, Pa, to full precision however small. From the first cell of
// THROAT to the second, the mean gradient included.
double pressure_drop(const struct pressures *pressures, const struct grains *grains,
                     const struct cells *cells, const struct throat *throat);

// Mean over the fluid, Pa, weighted by volume; 0 where there is none. Of the mean
// gradient, that in the middle of the box: no pore counts by the image that it has.
double mean_pressure(const struct pressures *pressures, const struct grains *grains,
                     const struct throats *throats);

// p_i, Pa. With the mean gradient at the centre of CELL.
double pore_pressure(const struct pressures *pressures, const struct cells *cells,
                     int cell);
