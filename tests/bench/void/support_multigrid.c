// SPDX-License-Identifier: GPL-3.0-or-later
// Multigrid as a preconditioner of conjugate gradients, in single precision.
//
// Unknowns: a potential x in the middle of each cell. In each cell
//     sum over its six faces of g_f (x - x_other) + leak x = right.
// A coarse cell is eight fine ones of one x: its faces conduct the sum of theirs, times
// 1/2 since the way is twice as long (the correction of Braess 1995 for such coarse
// grids). Smoother: two Jacobi steps with Chebyshev's weights for the eigenvalues 0.4
// to 2 of the matrix over its diagonal, alike before and after, so that M is symmetric.
// Two coarse cycles a fine one: constants are poor corrections, and a coarse grid costs
// an eighth.
#include "support_multigrid.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SMOOTH_STEPS = 2, COARSEST_TURNS = 10, COARSEST = 4 };

static size_t at(const struct level *level, int i, int j, int k)
{
    return (size_t)i * level->stride[0] + (size_t)j * level->stride[1] +
           (size_t)k * level->stride[2];
}

// ---- the layer around ---------------------------------------------------------------

// Copies the cells of one side to the layer beyond the other, along each axis in turn,
// so that edges and corners come right as well.
#define FILL_AROUND(storage, type, name)                                               \
    storage void name(const struct level *level, type *x)                              \
    {                                                                                  \
        for (int a = 0; a < 3; a++) {                                                  \
            if (!level->periodic[a]) continue;                                         \
            const int b = (a + 1) % 3, c = (a + 2) % 3, n = level->n[a];               \
            const size_t sa = level->stride[a];                                        \
            for (int k = 0; k < level->n[c] + 2; k++)                                  \
                for (int j = 0; j < level->n[b] + 2; j++) {                            \
                    type *row = x + (size_t)j * level->stride[b] +                     \
                                (size_t)k * level->stride[c];                          \
                    row[0] = row[(size_t)n * sa];                                      \
                    row[(size_t)(n + 1) * sa] = row[sa];                               \
                }                                                                      \
        }                                                                              \
    }
FILL_AROUND(static, float, fill_around_single)
FILL_AROUND(, double, fill_around)

// ---- making the levels --------------------------------------------------------------

static void size_level(struct level *level, bool leaky)
{
    level->size = 1;
    for (int a = 0; a < 3; a++) {
        level->stride[a] = level->size;
        level->size *= (size_t)level->n[a] + 2;
    }
    for (int a = 0; a < 3; a++)
        level->conductance[a] = NEW_ARRAY(float, level->size);
    level->leak = leaky ? NEW_ARRAY(float, level->size) : NULL;
    level->inverse = NEW_ARRAY(float, level->size);
    level->x = NEW_ARRAY(float, level->size);
    level->right = NEW_ARRAY(float, level->size);
    level->spare = NEW_ARRAY(float, level->size);
}

// Closes what has no other side, and sums the six faces of each cell.
static void finish_level(struct level *level)
{
    for (int a = 0; a < 3; a++) {
        const int n = level->n[a], b = (a + 1) % 3, c = (a + 2) % 3;
        for (int k = 1; k <= level->n[c]; k++)
            for (int j = 1; j <= level->n[b]; j++) {
                float *row = level->conductance[a] + (size_t)j * level->stride[b] +
                             (size_t)k * level->stride[c];
                if (level->periodic[a])
                    row[(size_t)(n + 1) * level->stride[a]] = row[level->stride[a]];
            }
    }
    for (int k = 1; k <= level->n[2]; k++)
        for (int j = 1; j <= level->n[1]; j++)
            for (int i = 1; i <= level->n[0]; i++) {
                const size_t c = at(level, i, j, k);
                float sum = level->leak ? level->leak[c] : 0;
                for (int a = 0; a < 3; a++)
                    sum += level->conductance[a][c] +
                           level->conductance[a][c + level->stride[a]];
                level->inverse[c] = sum > 0 ? 1 / sum : 0;
            }
}

static void fill_finest(struct level *level, const struct grid *grid, int along)
{
    const double *h = grid->spacing, volume = h[0] * h[1] * h[2];
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3, n = level->n[a];
        const float inner = (float)(volume / (h[a] * h[a]));
        const float wall = a == along ? 2 * inner : 0;
        for (int k = 1; k <= level->n[c]; k++)
            for (int j = 1; j <= level->n[b]; j++)
                for (int i = 1; i <= n + 1; i++) {
                    const bool in_wall = !level->periodic[a] && (i == 1 || i == n + 1);
                    const size_t face = (size_t)i * level->stride[a] +
                                        (size_t)j * level->stride[b] +
                                        (size_t)k * level->stride[c];
                    level->conductance[a][face] =
                        grid->open[a][face] * (in_wall ? wall : inner);
                }
    }
}

static void fill_coarse_leaks(struct level *coarse, const struct level *fine)
{
    for (int k = 1; k <= fine->n[2]; k++)
        for (int j = 1; j <= fine->n[1]; j++)
            for (int i = 1; i <= fine->n[0]; i++)
                coarse->leak[at(coarse, (i + 1) / 2, (j + 1) / 2, (k + 1) / 2)] +=
                    fine->leak[at(fine, i, j, k)];
}

// Adds half of each face of FINE that lies between two cells of COARSE.
static void fill_coarse(struct level *coarse, const struct level *fine)
{
    for (int k = 1; k <= fine->n[2] + 1; k++)
        for (int j = 1; j <= fine->n[1] + 1; j++)
            for (int i = 1; i <= fine->n[0] + 1; i++) {
                const int place[3] = {i, j, k};
                for (int a = 0; a < 3; a++) {
                    // Also the upper faces of the last cells, which belong to the
                    // layer.
                    const bool last = place[a] == fine->n[a] + 1;
                    if (place[(a + 1) % 3] > fine->n[(a + 1) % 3] ||
                        place[(a + 2) % 3] > fine->n[(a + 2) % 3])
                        continue;
                    if (place[a] % 2 == 0 && !last) continue;
                    int to[3] = {(i + 1) / 2, (j + 1) / 2, (k + 1) / 2};
                    if (last) to[a] = coarse->n[a] + 1;
                    coarse->conductance[a][at(coarse, to[0], to[1], to[2])] +=
                        0.5F * fine->conductance[a][at(fine, i, j, k)];
                }
            }
}

struct level level_of(const struct grid *grid, bool leaky)
{
    struct level level = {0};
    memcpy(level.n, grid->n, sizeof level.n);
    memcpy(level.periodic, grid->periodic, sizeof level.periodic);
    size_level(&level, leaky);
    return level;
}

struct multigrid multigrid_from(struct level finest)
{
    struct multigrid multigrid = {.n_level = 1, .level = {finest}};
    struct level *level = multigrid.level;
    finish_level(level);
    for (; multigrid.n_level < MOST_LEVELS; multigrid.n_level++, level++) {
        if (level->n[0] <= COARSEST && level->n[1] <= COARSEST &&
            level->n[2] <= COARSEST)
            break;
        struct level *next = level + 1;
        for (int a = 0; a < 3; a++)
            next->n[a] = (level->n[a] + 1) / 2;
        memcpy(next->periodic, level->periodic, sizeof next->periodic);
        size_level(next, level->leak != NULL);
        fill_coarse(next, level);
        if (level->leak) fill_coarse_leaks(next, level);
        finish_level(next);
    }
    return multigrid;
}

struct multigrid multigrid_of(const struct grid *grid, int along)
{
    struct level level = level_of(grid, false);
    fill_finest(&level, grid, along);
    return multigrid_from(level);
}

void multigrid_free(struct multigrid *multigrid)
{
    for (int l = 0; l < multigrid->n_level; l++) {
        struct level *level = &multigrid->level[l];
        for (int a = 0; a < 3; a++)
            free(level->conductance[a]);
        free(level->leak);
        free(level->inverse);
        free(level->x);
        free(level->right);
        free(level->spare);
    }
    multigrid->n_level = 0;
}

// ---- the matrix ---------------------------------------------------------------------

#define EACH_ROW                                                                       \
    _Pragma("omp parallel for schedule(static)") for (int k = 1; k <= level->n[2];     \
                                                      k++) for (int j = 1;             \
                                                                j <= level->n[1]; j++)

// Flux out of cell C, of neighbours one, SY and SZ cells away.
#define FLUX_OUT(x, c)                                                                 \
    (gx[c] * (x[c] - x[c - 1]) + gx[c + 1] * (x[c] - x[c + 1]) +                       \
     gy[c] * (x[c] - x[c - sy]) + gy[c + sy] * (x[c] - x[c + sy]) +                    \
     gz[c] * (x[c] - x[c - sz]) + gz[c + sz] * (x[c] - x[c + sz]) +                    \
     (leak ? leak[c] * x[c] : 0))
#define GET_FACES                                                                      \
    const float *restrict gx = level->conductance[0],                                  \
                          *restrict gy = level->conductance[1],                        \
                          *restrict gz = level->conductance[2],                        \
                          *restrict leak = level->leak;                                \
    const size_t sy = level->stride[1], sz = level->stride[2]

void conduct(const struct level *level, double *x, double *product)
{
    GET_FACES;
    fill_around(level, x);
    EACH_ROW
    {
        const size_t from = at(level, 1, j, k), to = from + (size_t)level->n[0];
        for (size_t c = from; c < to; c++)
            product[c] = FLUX_OUT(x, c);
    }
}

// ---- the cycle ----------------------------------------------------------------------

// One Jacobi step by WEIGHT from level->x, by way of level->spare.
static void jacobi(struct level *level, float weight)
{
    GET_FACES;
    fill_around_single(level, level->x);
    const float *restrict x = level->x, *restrict right = level->right,
                          *restrict inverse = level->inverse;
    float *restrict spare = level->spare;
    EACH_ROW
    {
        const size_t from = at(level, 1, j, k), to = from + (size_t)level->n[0];
        for (size_t c = from; c < to; c++)
            spare[c] = x[c] + weight * inverse[c] * (right[c] - FLUX_OUT(x, c));
    }
    level->spare = level->x;
    level->x = spare;
}

static void smooth(struct level *level, int steps, float lowest)
{
    for (int s = 0; s < steps; s++) {
        const double root = cos(M_PI * (2 * s + 1) / (2 * steps));
        const float middle = 0.5F * (2 + lowest), half = 0.5F * (2 - lowest);
        jacobi(level, 1 / (middle - half * (float)root));
    }
}

// What is left of FINE's equations, summed over each cell of COARSE.
static void restrict_residual(const struct level *level, struct level *coarse)
{
    GET_FACES;
    fill_around_single(level, level->x);
    const float *restrict x = level->x, *restrict right = level->right;
    float *restrict sum = coarse->right;
#pragma omp parallel for schedule(static)
    for (int kk = 1; kk <= coarse->n[2]; kk++) {
        for (int jj = 1; jj <= coarse->n[1]; jj++)
            for (int ii = 1; ii <= coarse->n[0]; ii++)
                sum[at(coarse, ii, jj, kk)] = 0;
        for (int k = 2 * kk - 1; k <= 2 * kk && k <= level->n[2]; k++)
            for (int j = 1; j <= level->n[1]; j++) {
                const size_t to = at(coarse, 0, (j + 1) / 2, kk);
                const size_t from = at(level, 0, j, k);
                for (int i = 1; i <= level->n[0]; i++) {
                    const size_t c = from + (size_t)i;
                    sum[to + (size_t)((i + 1) / 2)] += right[c] - FLUX_OUT(x, c);
                }
            }
    }
}

static void add_correction(struct level *level, const struct level *coarse)
{
    EACH_ROW
    {
        const size_t to = at(level, 0, j, k),
                     from = at(coarse, 0, (j + 1) / 2, (k + 1) / 2);
        for (int i = 1; i <= level->n[0]; i++)
            level->x[to + (size_t)i] += coarse->x[from + (size_t)((i + 1) / 2)];
    }
}

// Improves level->x, for level->right.
static void cycle(struct multigrid *multigrid, int l)
{
    struct level *level = &multigrid->level[l];
    if (l == multigrid->n_level - 1) {
        for (int turn = 0; turn < COARSEST_TURNS; turn++)
            smooth(level, SMOOTH_STEPS, 0.1F);
        return;
    }
    struct level *coarse = level + 1;
    smooth(level, SMOOTH_STEPS, 0.4F);
    restrict_residual(level, coarse);
    memset(coarse->x, 0, coarse->size * sizeof *coarse->x);
    for (int turn = 0; turn < (l == 0 ? 1 : 2); turn++)
        cycle(multigrid, l + 1);
    add_correction(level, coarse);
    smooth(level, SMOOTH_STEPS, 0.4F);
}

void multigrid_cycle(struct multigrid *multigrid, const double *residual, double *z)
{
    struct level *level = multigrid->level;
    EACH_ROW
    {
        const size_t from = at(level, 1, j, k), to = from + (size_t)level->n[0];
        for (size_t c = from; c < to; c++) {
            level->right[c] = (float)residual[c];
            level->x[c] = 0;
        }
    }
    cycle(multigrid, 0);
    EACH_ROW
    {
        const size_t from = at(level, 1, j, k), to = from + (size_t)level->n[0];
        for (size_t c = from; c < to; c++)
            z[c] = level->x[c];
    }
}
