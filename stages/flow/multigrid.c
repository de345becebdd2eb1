// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The coarsest grid is solved by a dense factor; grids that do not shrink by SLOW are
// taken for the coarsest.
enum { COARSEST = 100, MOST_LEVELS = 30, DENSE_MOST = 1000 };
static const double slow = 0.8;

// Only throats this wide, of the widest at a pore, join it to another.
static const double strong = 0.25;

// A coarse grid that has come down to this after one iteration needs no second [Notay
// 2010, 4.1].
static const double enough = 0.25;

struct level {
    struct matrix matrix;                // of the finest: the caller's
    int *aggregate;                      // (n) where each goes on the next level
    double *x, *b, *r;                   // (n) solution, right side, residual
    double *first, *first_image, *image; // (n) of the K-cycle
};

struct multigrid {
    int n_level;
    struct level level[MOST_LEVELS];
    double *factor; // (n, n) Cholesky factor of the coarsest
};

// ---- coarsening ---------------------------------------------------------------------

// Joins each to the one beyond its widest throat that is still free, in order; where
// none wide enough is, to the one beyond its widest throat, whatever that belongs to.
static int join(const struct matrix *matrix, int *aggregate)
{
    int count = 0;
    for (int i = 0; i < matrix->n; i++)
        aggregate[i] = -1;
    for (int i = 0; i < matrix->n; i++) {
        if (aggregate[i] >= 0) continue;
        double widest = 0, widest_free = 0;
        int neighbour = -1, partner = -1;
        for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++) {
            const int j = matrix->column[k];
            if (j >= matrix->n || j == i) continue;
            const double value = matrix->value[k];
            if (value > widest) widest = value, neighbour = j;
            if (aggregate[j] < 0 && value > widest_free)
                widest_free = value, partner = j;
        }
        if (partner >= 0 && widest_free >= strong * widest) {
            aggregate[i] = aggregate[partner] = count++;
        } else if (neighbour >= 0 && aggregate[neighbour] >= 0) {
            aggregate[i] = aggregate[neighbour];
        } else {
            aggregate[i] = count++;
        }
    }
    return count;
}

// The members of each aggregate: member[start[a]] .. member[start[a+1]].
static void list_members(const int *aggregate, int n, int count, int *start,
                         int *member)
{
    for (int i = 0; i < n; i++)
        start[aggregate[i] + 1]++;
    for (int a = 0; a < count; a++)
        start[a + 1] += start[a];
    for (int i = n - 1; i >= 0; i--)
        member[--start[aggregate[i] + 1]] = i;
    memmove(start, start + 1, sizeof *start * (size_t)count);
    start[count] = n;
}

// The matrix of the aggregates: what leads out of one in sum.
static struct matrix collect(const struct matrix *fine, const int *aggregate, int count)
{
    struct matrix coarse = {.n = count, .n_all = count};
    coarse.offset = NEW_ARRAY(int, count + 1);
    coarse.column = NEW_ARRAY(int, fine->offset[fine->n]);
    coarse.value = NEW_ARRAY(double, fine->offset[fine->n]);
    coarse.diagonal = NEW_ARRAY(double, count);
    int *start = NEW_ARRAY(int, count + 2), *member = NEW_ARRAY(int, fine->n);
    int *place = NEW_ARRAY(int, count);
    list_members(aggregate, fine->n, count, start, member);
    int n_entry = 0;
    for (int a = 0; a < count; a++) {
        const int row = coarse.offset[a] = n_entry;
        for (int m = start[a]; m < start[a + 1]; m++) {
            const int i = member[m];
            coarse.diagonal[a] += fine->diagonal[i];
            for (int k = fine->offset[i]; k < fine->offset[i + 1]; k++) {
                if (fine->column[k] >= fine->n) continue;
                const int to = aggregate[fine->column[k]];
                if (to == a) {
                    coarse.diagonal[a] -= fine->value[k];
                } else if (place[to] > row && coarse.column[place[to] - 1] == to) {
                    coarse.value[place[to] - 1] += fine->value[k];
                } else {
                    coarse.column[n_entry] = to;
                    coarse.value[n_entry++] = fine->value[k];
                    place[to] = n_entry;
                }
            }
        }
    }
    coarse.offset[count] = n_entry;
    free(start);
    free(member);
    free(place);
    return coarse;
}

static struct matrix coarsen(const struct matrix *fine, int *aggregate)
{
    const int n_pair = join(fine, aggregate);
    struct matrix pairs = collect(fine, aggregate, n_pair);
    int *second = NEW_ARRAY(int, n_pair);
    const int count = join(&pairs, second);
    struct matrix coarse = collect(&pairs, second, count);
    for (int i = 0; i < fine->n; i++)
        aggregate[i] = second[aggregate[i]];
    matrix_free(&pairs);
    free(second);
    return coarse;
}

// Of a matrix small enough to be dense; a pivot lost to rounding is taken as the
// diagonal, which the iteration around bears.
static double *factorise_dense(const struct matrix *matrix)
{
    const int n = matrix->n;
    double *l = NEW_ARRAY(double, (size_t)n *(size_t)n);
#define L(i, j) l[(size_t)(i) * (size_t)n + (size_t)(j)]
    for (int i = 0; i < n; i++) {
        L(i, i) = matrix->diagonal[i];
        for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
            if (matrix->column[k] < n) L(i, matrix->column[k]) -= matrix->value[k];
    }
    for (int j = 0; j < n; j++) {
        double pivot = L(j, j);
        for (int k = 0; k < j; k++)
            pivot -= L(j, k) * L(j, k);
        if (!(pivot > 1e-14 * matrix->diagonal[j])) pivot = matrix->diagonal[j];
        L(j, j) = sqrt(pivot);
        for (int i = j + 1; i < n; i++) {
            double sum = L(i, j);
            for (int k = 0; k < j; k++)
                sum -= L(i, k) * L(j, k);
            L(i, j) = sum / L(j, j);
        }
    }
    return l;
}

static void solve_dense(const double *l, int n, const double *b, double *x)
{
    for (int i = 0; i < n; i++) {
        double sum = b[i];
        for (int k = 0; k < i; k++)
            sum -= L(i, k) * x[k];
        x[i] = sum / L(i, i);
    }
    for (int i = n - 1; i >= 0; i--) {
        double sum = x[i];
        for (int k = i + 1; k < n; k++)
            sum -= L(k, i) * x[k];
        x[i] = sum / L(i, i);
    }
#undef L
}

static void give_room(struct level *level)
{
    const int n = level->matrix.n;
    double **const array[] = {&level->x,     &level->b,           &level->r,
                              &level->first, &level->first_image, &level->image};
    for (size_t k = 0; k < sizeof array / sizeof *array; k++)
        *array[k] = NEW_ARRAY(double, n);
    level->aggregate = NEW_ARRAY(int, n);
}

struct multigrid *multigrid_make(const struct matrix *matrix)
{
    struct multigrid *multigrid = NEW_ARRAY(struct multigrid, 1);
    multigrid->level[0].matrix = *matrix;
    for (int l = 0;; l++) {
        struct level *level = &multigrid->level[l];
        const int n = level->matrix.n;
        multigrid->n_level = l + 1;
        give_room(level);
        if (n <= COARSEST || l + 1 == MOST_LEVELS) break;
        struct matrix coarse = coarsen(&level->matrix, level->aggregate);
        if (coarse.n > slow * n) {
            matrix_free(&coarse);
            break;
        }
        level[1].matrix = coarse;
    }
    const struct matrix *last = &multigrid->level[multigrid->n_level - 1].matrix;
    if (last->n <= DENSE_MOST) multigrid->factor = factorise_dense(last);
    return multigrid;
}

void multigrid_free(struct multigrid *multigrid)
{
    if (!multigrid) return;
    for (int l = 0; l < multigrid->n_level; l++) {
        struct level *level = &multigrid->level[l];
        if (l > 0) matrix_free(&level->matrix);
        free(level->aggregate);
        free(level->x);
        free(level->b);
        free(level->r);
        free(level->first);
        free(level->first_image);
        free(level->image);
    }
    free(multigrid->factor);
    free(multigrid);
}

// ---- cycle --------------------------------------------------------------------------

// One sweep of Gauss and Seidel down or up the rows; from 0 at first, when SWEEP is 1.
static void sweep_down(const struct matrix *matrix, const double *b, double *x)
{
    const int n = matrix->n;
    for (int i = 0; i < n; i++) {
        double sum = b[i];
        for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
            if (matrix->column[k] < i) sum += matrix->value[k] * x[matrix->column[k]];
        x[i] = sum / matrix->diagonal[i];
    }
}

static void sweep_up(const struct matrix *matrix, const double *b, double *x)
{
    const int n = matrix->n;
    for (int i = n - 1; i >= 0; i--) {
        double sum = b[i];
        for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
            if (matrix->column[k] < n) sum += matrix->value[k] * x[matrix->column[k]];
        x[i] = sum / matrix->diagonal[i];
    }
}

static void cycle(struct multigrid *multigrid, int l, const double *b, double *x);

// At most two iterations of conjugate gradients on a coarse level, each preconditioned
// by the cycle from there: the right side B of level L is used up, the answer in X.
static void solve_coarse(struct multigrid *multigrid, int l)
{
    struct level *level = &multigrid->level[l];
    const struct matrix *matrix = &level->matrix;
    const int n = matrix->n;
    if (l + 1 == multigrid->n_level) {
        cycle(multigrid, l, level->b, level->x);
        return;
    }
    cycle(multigrid, l, level->b, level->first);
    matrix_multiply(matrix, level->first, level->first_image);
    const double rho = dot_product(level->first, level->first_image, n);
    const double alpha = dot_product(level->first, level->b, n);
    const double before = dot_product(level->b, level->b, n);
    if (!(rho > 0)) {
        memset(level->x, 0, sizeof *level->x * (size_t)n);
        return;
    }
    const double step = alpha / rho;
    for (int i = 0; i < n; i++)
        level->b[i] -= step * level->first_image[i];
    if (dot_product(level->b, level->b, n) <= enough * enough * before) {
        for (int i = 0; i < n; i++)
            level->x[i] = step * level->first[i];
        return;
    }
    cycle(multigrid, l, level->b, level->x);
    matrix_multiply(matrix, level->x, level->image);
    const double gamma = dot_product(level->x, level->first_image, n);
    const double beta = dot_product(level->x, level->image, n);
    const double alpha2 = dot_product(level->x, level->b, n);
    const double rho2 = beta - gamma * gamma / rho;
    const double along = rho2 > 0 ? alpha2 / rho2 : 0;
    const double back = step - (rho2 > 0 ? gamma * alpha2 / (rho * rho2) : 0);
    for (int i = 0; i < n; i++)
        level->x[i] = back * level->first[i] + along * level->x[i];
}

// One cycle of level L: X approximates the solution for B. Symmetric.
static void cycle(struct multigrid *multigrid, int l, const double *b, double *x)
{
    struct level *level = &multigrid->level[l];
    const struct matrix *matrix = &level->matrix;
    const int n = matrix->n;
    if (l + 1 == multigrid->n_level) {
        if (multigrid->factor) {
            solve_dense(multigrid->factor, n, b, x);
        } else {
            sweep_down(matrix, b, x);
            sweep_up(matrix, b, x);
        }
        return;
    }
    sweep_down(matrix, b, x);
    matrix_multiply(matrix, x, level->r);
    struct level *next = &multigrid->level[l + 1];
    memset(next->b, 0, sizeof *next->b * (size_t)next->matrix.n);
    for (int i = 0; i < n; i++)
        next->b[level->aggregate[i]] += b[i] - level->r[i];
    solve_coarse(multigrid, l + 1);
    for (int i = 0; i < n; i++)
        x[i] += next->x[level->aggregate[i]];
    sweep_up(matrix, b, x);
}

// ---- conjugate gradients ------------------------------------------------------------

// Flexible, for the cycle is not quite linear.
int multigrid_solve(struct multigrid *multigrid, const double *b, double *x,
                    double reduction, int most)
{
    const struct matrix *matrix = &multigrid->level[0].matrix;
    const int n = matrix->n;
    double *r = duplicate(b, (size_t)n, sizeof *r), *z = NEW_ARRAY(double, n);
    double *p = NEW_ARRAY(double, n), *image = NEW_ARRAY(double, n);
    memset(x, 0, sizeof *x * (size_t)n);
    const double aim = reduction * sqrt(dot_product(b, b, n));
    double curvature = 0;
    int iteration = 0;
    while (iteration < most && sqrt(dot_product(r, r, n)) > aim) {
        cycle(multigrid, 0, r, z);
        const double overlap =
            iteration ? dot_product(z, image, n) / curvature : 0; // along the last p
#pragma omp parallel for schedule(static) if (n > 20000)
        for (int i = 0; i < n; i++)
            p[i] = z[i] - overlap * p[i];
        matrix_multiply(matrix, p, image);
        curvature = dot_product(p, image, n);
        if (!(curvature > 0)) break;
        const double step = dot_product(p, r, n) / curvature;
#pragma omp parallel for schedule(static) if (n > 20000)
        for (int i = 0; i < n; i++) {
            x[i] += step * p[i];
            r[i] -= step * image[i];
        }
        iteration++;
    }
    free(r);
    free(z);
    free(p);
    free(image);
    return iteration;
}
