// SPDX-License-Identifier: GPL-3.0-or-later
// Pulls in balance at each throat. f0 are the pulls of a form; wanted are the nearest
// f with
//     P f = f at each throat,   sum over throats of f = 0 on each closed grain,
// where P removes the rigid part (mean, and three rotations about the mean place) of
// the forces on the grains around a throat, and a grain is closed if f0 sums to 0 on
// it when all throats are full. With a multiplier m for each closed grain
//     f = P (f0 - m),   sum P m = sum P f0   on each closed grain,
// a symmetric, positive and sparse system of 3x3 blocks, assembled once and solved by
// conjugate gradients, preconditioned with the diagonal blocks. At a throat beside a
// wall or an auxiliary grain P is 1: these take the rest.
#include "balance.h"

#include "basics/memory.h"
#include "geometry/triangulation/insertion_order.h"
#include "sparse/block_rows.h"
#include "sparse/conjugate_gradients.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>

// The displacements of a grain in three rotations of the grains around a throat,
// orthonormal over these, or 0. Found again where they are used: kept, they would be
// half of all memory.
struct rotations {
    struct vector of[3];
};

// Corners, a grain beside a throat each, some 33 of a grain, throat by throat.
struct throats {
    int n_throat, n_grain, n_corner;
    const struct vector *place; // (n_grain)
    int most;                   // corners of a throat
    int *first;                 // (n_throat+1) corners of each throat
    int32_t *grain;             // (n_corner)
    struct vector *arm;         // (n_corner) from the middle of the throat to the grain
    struct vector *pull;        // (n_corner) f0, then f
    struct vector *now;  // (n_corner) the last result of balance; NULL: none is kept
    int *begin, *throat; // (n_grain+1) into THROAT (n_corner): throats of each grain
    bool *supported;     // (n_throat) a wall takes the rigid part: P is 1
    bool *closed;        // (n_grain) the pulls on it sum to zero
    int room[3];         // for grain, arm, pull
};

static void throats_free(struct throats *throats)
{
    free(throats->grain);
    free(throats->arm);
    free(throats->pull);
    free(throats->now);
    free(throats->first);
    free(throats->begin);
    free(throats->throat);
    free(throats->supported);
    free(throats->closed);
}

// --- corners -----------------------------------------------------------------------

// The corner of a sector, by grain and place: in a small periodic box a grain can be at
// a throat twice, in two images.
static int corner_of(struct throats *throats, const struct sector *sector)
{
    const struct vector middle = scale(0.5, add(sector->from, sector->to));
    const struct vector arm = subtract(sector->centre, middle);
    const int n = throats->n_corner;
    for (int k = throats->first[sector->throat]; k < n; k++)
        if (throats->grain[k] == sector->grain &&
            distance(throats->arm[k], arm) <= 1e-6 * norm(arm))
            return k;
    GROW_ARRAY(throats->grain, n, throats->room[0]);
    GROW_ARRAY(throats->arm, n, throats->room[1]);
    GROW_ARRAY(throats->pull, n, throats->room[2]);
    throats->grain[n] = sector->grain;
    throats->arm[n] = arm;
    throats->pull[n] = (struct vector){0};
    return throats->n_corner++;
}

// Walls and auxiliary grains are no corners: a throat beside them is supported. Nearly
// every corner has two sides; room that grew would leave holes behind.
static void find_corners(struct throats *throats, struct sectors *sectors,
                         enum form form)
{
    const int room = (int)(sectors->offset[throats->n_throat] / 2);
    throats->grain = NEW_ARRAY(int32_t, room);
    throats->arm = NEW_ARRAY(struct vector, room);
    throats->pull = NEW_ARRAY(struct vector, room);
    for (int k = 0; k < 3; k++)
        throats->room[k] = room;
    for (int t = 0; t < throats->n_throat; t++) {
        throats->first[t] = throats->n_corner;
        const int n = sectors_at(sectors, t);
        for (int k = 0; k < n; k++) {
            const struct sector *sector = &sectors->sector[k];
            const bool is_grain =
                !is_auxiliary(&sectors->network->packing, sector->grain);
            if (!is_grain || sector->beyond < 0) throats->supported[t] = true;
            if (!is_grain) continue;
            const int corner = corner_of(throats, sector); // the arrays may move
            throats->pull[corner] =
                add(throats->pull[corner], pull_of(form)(sectors, sector, NULL));
        }
        if (throats->n_corner - throats->first[t] > throats->most)
            throats->most = throats->n_corner - throats->first[t];
    }
    const size_t n = (size_t)throats->n_corner;
    throats->grain = reallocate(throats->grain, n, sizeof *throats->grain);
    throats->arm = reallocate(throats->arm, n, sizeof *throats->arm);
    throats->pull = reallocate(throats->pull, n, sizeof *throats->pull);
    throats->first[throats->n_throat] = throats->n_corner;
}

static void list_by_grain(struct throats *throats)
{
    for (int k = 0; k < throats->n_corner; k++)
        throats->begin[throats->grain[k] + 1]++;
    for (int i = 0; i < throats->n_grain; i++)
        throats->begin[i + 1] += throats->begin[i];
    throats->throat = NEW_ARRAY(int, throats->n_corner);
    int *next = duplicate(throats->begin, (size_t)throats->n_grain + 1, sizeof *next);
    for (int t = 0; t < throats->n_throat; t++)
        for (int k = throats->first[t]; k < throats->first[t + 1]; k++)
            throats->throat[next[throats->grain[k]]++] = t;
    free(next);
}

// The corner of GRAIN at the throat that is in place K of the lists by grain. A throat
// that is there twice has two corners of it, in the same order.
static int corner_at(const struct throats *throats, int grain, int k)
{
    const int throat = throats->throat[k];
    int corner = throats->first[throat], before = k;
    while (before > throats->begin[grain] && throats->throat[before - 1] == throat)
        before--;
    for (;; corner++)
        if (throats->grain[corner] == grain && before++ == k) return corner;
}

static void find_closed(struct throats *throats)
{
    for (int i = 0; i < throats->n_grain; i++) {
        struct vector sum = {0};
        double sizes = 0;
        for (int k = throats->begin[i]; k < throats->begin[i + 1]; k++) {
            const struct vector pull = throats->pull[corner_at(throats, i, k)];
            sum = add(sum, pull);
            sizes += norm(pull);
        }
        throats->closed[i] = sizes > 0 && norm(sum) <= 1e-10 * sizes;
    }
}

// --- rigid motions -----------------------------------------------------------------

static struct vector mean_arm(const struct vector *arm, int n)
{
    struct vector sum = {0};
    for (int c = 0; c < n; c++)
        sum = add(sum, arm[c]);
    return scale(1.0 / n, sum);
}

// Orthogonalises the Kth rotation to those before it; twice, for rounding.
static void orthogonalise(struct rotations *rotations, int n, int k)
{
    for (int former = 0; former < 2 * k; former++) {
        double share = 0;
        for (int c = 0; c < n; c++)
            share += dot(rotations[c].of[k], rotations[c].of[former % k]);
        for (int c = 0; c < n; c++)
            rotations[c].of[k] =
                subtract(rotations[c].of[k], scale(share, rotations[c].of[former % k]));
    }
}

// ROTATIONS (n) become orthonormal, about the mean place. Grains in one line have two,
// one grain none.
static void find_rotations(const struct vector *arm, int n, struct rotations *rotations)
{
    const struct vector middle = mean_arm(arm, n);
    double reach = 0;
    for (int c = 0; c < n; c++)
        reach = fmax(reach, norm(arm[c]));
    for (int k = 0; k < 3; k++) {
        struct vector axis = {0};
        set_component(&axis, k, 1);
        for (int c = 0; c < n; c++)
            rotations[c].of[k] = cross(axis, subtract(arm[c], middle));
        orthogonalise(rotations, n, k);
        double size = 0;
        for (int c = 0; c < n; c++)
            size += dot(rotations[c].of[k], rotations[c].of[k]);
        const double unit = size > 1e-20 * reach * reach ? 1 / sqrt(size) : 0;
        for (int c = 0; c < n; c++)
            rotations[c].of[k] = scale(unit, rotations[c].of[k]);
    }
}

// Removes the rigid part of NOW (n). ROTATIONS (n): workspace.
static void project(const struct vector *arm, int n, struct rotations *rotations,
                    struct vector *now)
{
    struct vector mean = {0};
    double share[3] = {0};
    find_rotations(arm, n, rotations);
    for (int c = 0; c < n; c++) {
        mean = add(mean, scale(1.0 / n, now[c]));
        for (int k = 0; k < 3; k++)
            share[k] += dot(now[c], rotations[c].of[k]);
    }
    for (int c = 0; c < n; c++) {
        now[c] = subtract(now[c], mean);
        for (int k = 0; k < 3; k++)
            now[c] = subtract(now[c], scale(share[k], rotations[c].of[k]));
    }
}

// NOW = P (pull - MULTIPLIER of the grain).
static void balance(struct throats *throats, const struct vector *multiplier)
{
    if (!throats->now) throats->now = NEW_ARRAY(struct vector, throats->n_corner);
#pragma omp parallel
    {
        struct rotations *rotations = NEW_ARRAY(struct rotations, throats->most);
#pragma omp for
        for (int t = 0; t < throats->n_throat; t++) {
            const int first = throats->first[t], end = throats->first[t + 1];
            for (int k = first; k < end; k++)
                throats->now[k] =
                    subtract(throats->pull[k], multiplier[throats->grain[k]]);
            if (!throats->supported[t])
                project(throats->arm + first, end - first, rotations,
                        throats->now + first);
        }
        free(rotations);
    }
}

// --- the multipliers ---------------------------------------------------------------

// SUM becomes the sum of NOW on each closed grain, 0 on the others.
static void sum_up(const struct throats *throats, struct vector *sum)
{
#pragma omp parallel for
    for (int i = 0; i < throats->n_grain; i++) {
        sum[i] = (struct vector){0};
        if (!throats->closed[i]) continue;
        for (int k = throats->begin[i]; k < throats->begin[i + 1]; k++)
            sum[i] = add(sum[i], throats->now[corner_at(throats, i, k)]);
    }
}

// Adds to BLOCK what P of a throat with N corners takes from corner ROW to COLUMN.
static void add_projection(const struct rotations *rotations, int row, int column,
                           int n, bool supported, double *block)
{
    for (int axis = 0; axis < 3; axis++)
        block[(ptrdiff_t)4 * axis] += (row == column) - (supported ? 0 : 1.0 / n);
    for (int k = 0; k < 3 && !supported; k++)
        for (int a = 0; a < 9; a++)
            block[a] -= component(rotations[row].of[k], a / 3) *
                        component(rotations[column].of[k], a % 3);
}

// Adds to the open row what comes from throat T, of whose corners ROW is one.
static void add_throat(const struct throats *throats, int t, int row,
                       struct rotations *rotations, struct block_rows *rows)
{
    const int first = throats->first[t], n = throats->first[t + 1] - first;
    const bool supported = throats->supported[t];
    if (!supported) find_rotations(throats->arm + first, n, rotations);
    for (int c = 0; c < n; c++) {
        const int grain = throats->grain[first + c];
        if (!throats->closed[grain]) continue;
        if (supported && c != row - first) continue;
        double *block = block_rows_at(rows, grain);
        if (block) add_projection(rotations, row - first, c, n, supported, block);
    }
}

// The matrix that takes multipliers to sum P m on each closed grain. Rows lie along a
// space-filling curve: packings come in any order, and then each row would wait for
// blocks and multipliers from everywhere.
static struct block_rows assemble(const struct throats *throats)
{
    const int n = throats->n_grain;
    struct block_rows rows =
        block_rows_init(n, n > 0 ? insertion_order(throats->place, n) : NULL);
    struct rotations *rotations = NEW_ARRAY(struct rotations, throats->most);
    for (int r = 0; r < n; r++) {
        const int i = rows.order[r];
        if (throats->closed[i])
            for (int k = throats->begin[i]; k < throats->begin[i + 1]; k++)
                add_throat(throats, throats->throat[k], corner_at(throats, i, k),
                           rotations, &rows);
        block_rows_end_row(&rows);
    }
    free(rotations);
    return rows;
}

static void multiply(void *context, const double *x, double *image)
{
    block_rows_multiply(context, x, image);
}

static void precondition(void *context, const double *residual, double *z)
{
    block_rows_precondition(context, residual, z);
}

static double pulls_squared(const struct throats *throats)
{
    double sum = 0;
    for (int k = 0; k < throats->n_corner; k++)
        sum += dot(throats->pull[k], throats->pull[k]);
    return sum;
}

// MULTIPLIER is 0 and NOW balanced with it. NOW is given up before the matrix, which is
// as large, is assembled.
static enum status find_multipliers(struct throats *throats, struct vector *multiplier,
                                    struct reason *reason)
{
    static const int most = 10000;
    const int n = 3 * throats->n_grain;
    struct vector *residual = NEW_ARRAY(struct vector, throats->n_grain);
    sum_up(throats, residual);
    free(throats->now);
    throats->now = NULL;
    struct block_rows rows = assemble(throats);
    struct linear_problem problem = {n, &rows, multiply, precondition, {0}};
    for (int k = 0; k < 3; k++)
        problem.work[k] = NEW_ARRAY(double, n);
    const double tolerance = 1e-15 * sqrt(pulls_squared(throats));
    const int count =
        conjugate_gradients(&problem, &residual->x, &multiplier->x, tolerance, most);
    const double left = sqrt(sum_of_products(&residual->x, &residual->x, n));
    for (int k = 0; k < 3; k++)
        free(problem.work[k]);
    free(residual);
    block_rows_free(&rows);
    if (left <= 10 * tolerance) return STATUS_OK;
    return refuse(
        reason, STATUS_NOT_CONVERGED,
        "the balance of the throats' pulls: %g of %g left after %d iterations", left,
        tolerance, count);
}

// --- pulls -------------------------------------------------------------------------

// Root mean square of NOW - PULL, relative to that of the pulls.
static double change_of(const struct throats *throats)
{
    double sum = 0;
    for (int k = 0; k < throats->n_corner; k++) {
        const struct vector change = subtract(throats->now[k], throats->pull[k]);
        sum += dot(change, change);
    }
    const double all = pulls_squared(throats);
    return all > 0 ? sqrt(sum / all) : 0;
}

static enum status balance_pulls(struct throats *throats, double *change,
                                 struct reason *reason)
{
    static const double rounding = 1e-12;
    struct vector *multiplier = NEW_ARRAY(struct vector, throats->n_grain);
    balance(throats, multiplier);
    *change = change_of(throats);
    enum status status = STATUS_OK;
    if (*change > rounding) {
        status = find_multipliers(throats, multiplier, reason);
        balance(throats, multiplier);
        *change = change_of(throats);
        free(throats->pull);
        throats->pull = throats->now;
        throats->now = NULL;
    }
    free(multiplier);
    return status;
}

// By grain, and of each grain by throat.
static struct patches patches_of(const struct throats *throats)
{
    struct patches patches = {.patch = NEW_ARRAY(struct patch, throats->n_corner),
                              .begin = NEW_ARRAY(int, throats->n_grain + 1),
                              .capacity = throats->n_corner};
    for (int i = 0; i < throats->n_grain; i++) {
        for (int k = throats->begin[i]; k < throats->begin[i + 1]; k++)
            patches_add(&patches, throats->throat[k], i,
                        throats->pull[corner_at(throats, i, k)]);
        patches.begin[i + 1] = patches.n;
    }
    return patches;
}

enum status find_balanced_patches(struct sectors *sectors, enum form form, bool last,
                                  struct patches *patches, double *change,
                                  struct reason *reason)
{
    const int n_throat = sectors->network->n_throat;
    const int n_grain = sectors->network->packing.n_particle;
    struct throats throats = {.n_throat = n_throat,
                              .n_grain = n_grain,
                              .place = sectors->network->packing.position,
                              .first = NEW_ARRAY(int, n_throat + 1),
                              .begin = NEW_ARRAY(int, n_grain + 1),
                              .supported = NEW_ARRAY(bool, n_throat),
                              .closed = NEW_ARRAY(bool, n_grain)};
    find_corners(&throats, sectors, form);
    if (last) sectors_free_sides(sectors);
    list_by_grain(&throats);
    find_closed(&throats);
    const enum status status = balance_pulls(&throats, change, reason);
    free(throats.now);
    free(throats.arm);
    throats.now = throats.arm = NULL;
    *patches = status ? (struct patches){0} : patches_of(&throats);
    throats_free(&throats);
    return status;
}
