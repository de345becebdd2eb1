// SPDX-License-Identifier: GPL-3.0-or-later
// Laplace's equation on a grid whose faces conduct differently, and multigrid for it.
#pragma once

#include "support_grid.h"

enum { MOST_LEVELS = 12 };

// A grid of cells with a layer around; each pair of cells is two, or in the last place
// one, of each direction of the finer grid. All arrays have SIZE elements.
struct level {
    int n[3];
    size_t stride[3], size;
    uint8_t periodic[3];
    float *conductance[3]; // of the lower face of each cell; 0 closed
    float *leak;           // of each cell to a potential of 0; NULL: none
    float *inverse;        // 1 / sum of the six and the leak; 0 where all are closed
    float *x, *right, *spare;
};

struct multigrid {
    int n_level;
    struct level level[MOST_LEVELS];
};

// Of the grid's open faces: the open area over the spacing. Faces in walls are closed,
// but in those across ALONG (-1: none) they lead to a potential of 0 half a spacing
// away. The caller frees it with multigrid_free.
struct multigrid multigrid_of(const struct grid *grid, int along);

// The finest level for GRID, all of its faces closed, with leaks (0) if LEAKY; and all
// levels, from a finest one filled by the caller and taken over.
struct level level_of(const struct grid *grid, bool leaky);
struct multigrid multigrid_from(struct level finest);

void multigrid_free(struct multigrid *multigrid);

// Copies the cells of each side that repeats to the layer beyond the opposite one.
void fill_around(const struct level *level, double *x);

// PRODUCT = A X, the flux out of each cell. Fills the layer around X.
void conduct(const struct level *level, double *x, double *product);

// Z = M^-1 RESIDUAL by one W-cycle.
void multigrid_cycle(struct multigrid *multigrid, const double *residual, double *z);
