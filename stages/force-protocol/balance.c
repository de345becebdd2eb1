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
#include "sparse/block_rows.h"
#include "sparse/conjugate_gradients.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>

// A grain beside a throat.
struct corner {
    int32_t throat, grain;
    struct vector arm;  // from the middle of the throat to the grain
    struct vector pull; // f0, then f
};

// The displacements of a grain in three rotations of the grains around a throat,
// orthonormal over these, or 0. Found again where they are used: kept, they would be
// half of all memory.
struct rotations {
    struct vector of[3];
};

struct throats {
    int n_throat, n_grain, n_corner, capacity;
    int most;              // corners of a throat
    struct corner *corner; // (n_corner)
    struct vector *now;    // (n_corner) the last result of balance; NULL: none is kept
    int *first;            // (n_throat+1) corners of each throat
    int *begin, *corners;  // (n_grain+1) into CORNERS (n_corner): corners of each grain
    bool *supported;       // (n_throat) a wall takes the rigid part: P is 1
    bool *closed;          // (n_grain) the pulls on it sum to zero
};

static void throats_free(struct throats *throats)
{
    free(throats->corner);
    free(throats->now);
    free(throats->first);
    free(throats->begin);
    free(throats->corners);
    free(throats->supported);
    free(throats->closed);
}

// --- corners -----------------------------------------------------------------------

// The corner of a sector, by grain and place: in a small periodic box a grain can be at
// a throat twice, in two images.
static struct corner *corner_of(struct throats *throats, const struct sector *sector)
{
    const struct vector middle = scale(0.5, add(sector->from, sector->to));
    const struct vector arm = subtract(sector->centre, middle);
    const int first = throats->first[sector->throat];
    assert(throats->corner || first == throats->n_corner);
    for (int k = first; k < throats->n_corner; k++)
        if (throats->corner[k].grain == sector->grain &&
            distance(throats->corner[k].arm, arm) <= 1e-6 * norm(arm))
            return &throats->corner[k];
    GROW_ARRAY(throats->corner, throats->n_corner, throats->capacity);
    struct corner *corner = &throats->corner[throats->n_corner++];
    *corner =
        (struct corner){.throat = sector->throat, .grain = sector->grain, .arm = arm};
    return corner;
}

// Walls and auxiliary grains are no corners: a throat beside them is supported.
static void find_corners(struct throats *throats, struct sectors *sectors,
                         enum form form)
{
    for (int t = 0; t < throats->n_throat; t++) {
        throats->first[t] = throats->n_corner;
        const int n = sectors_at(sectors, t);
        for (int k = 0; k < n; k++) {
            const struct sector *sector = &sectors->sector[k];
            const bool is_grain =
                !is_auxiliary(&sectors->network->packing, sector->grain);
            if (!is_grain || sector->beyond < 0) throats->supported[t] = true;
            if (!is_grain) continue;
            struct corner *corner = corner_of(throats, sector);
            corner->pull = add(corner->pull, pull_of(form)(sectors, sector, NULL));
        }
        if (throats->n_corner - throats->first[t] > throats->most)
            throats->most = throats->n_corner - throats->first[t];
    }
    throats->corner =
        reallocate(throats->corner, (size_t)throats->n_corner, sizeof *throats->corner);
    throats->first[throats->n_throat] = throats->n_corner;
}

static void list_by_grain(struct throats *throats)
{
    for (int k = 0; k < throats->n_corner; k++)
        throats->begin[throats->corner[k].grain + 1]++;
    for (int i = 0; i < throats->n_grain; i++)
        throats->begin[i + 1] += throats->begin[i];
    throats->corners = NEW_ARRAY(int, throats->n_corner);
    int *next = duplicate(throats->begin, (size_t)throats->n_grain + 1, sizeof *next);
    for (int k = 0; k < throats->n_corner; k++)
        throats->corners[next[throats->corner[k].grain]++] = k;
    free(next);
}

static void find_closed(struct throats *throats)
{
    for (int i = 0; i < throats->n_grain; i++) {
        struct vector sum = {0};
        double sizes = 0;
        for (int k = throats->begin[i]; k < throats->begin[i + 1]; k++) {
            const struct vector pull = throats->corner[throats->corners[k]].pull;
            sum = add(sum, pull);
            sizes += norm(pull);
        }
        throats->closed[i] = sizes > 0 && norm(sum) <= 1e-10 * sizes;
    }
}

// --- rigid motions -----------------------------------------------------------------

static struct vector mean_arm(const struct corner *corner, int n)
{
    struct vector sum = {0};
    for (int c = 0; c < n; c++)
        sum = add(sum, corner[c].arm);
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
static void find_rotations(const struct corner *corner, int n,
                           struct rotations *rotations)
{
    const struct vector middle = mean_arm(corner, n);
    double reach = 0;
    for (int c = 0; c < n; c++)
        reach = fmax(reach, norm(corner[c].arm));
    for (int k = 0; k < 3; k++) {
        struct vector axis = {0};
        set_component(&axis, k, 1);
        for (int c = 0; c < n; c++)
            rotations[c].of[k] = cross(axis, subtract(corner[c].arm, middle));
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
static void project(const struct corner *corner, int n, struct rotations *rotations,
                    struct vector *now)
{
    struct vector mean = {0};
    double share[3] = {0};
    find_rotations(corner, n, rotations);
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
            const int n = throats->first[t + 1] - throats->first[t];
            const struct corner *corner = &throats->corner[throats->first[t]];
            struct vector *now = &throats->now[throats->first[t]];
            for (int c = 0; c < n; c++)
                now[c] = subtract(corner[c].pull, multiplier[corner[c].grain]);
            if (!throats->supported[t]) project(corner, n, rotations, now);
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
            sum[i] = add(sum[i], throats->now[throats->corners[k]]);
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

// Adds to the open row what comes from the throat of the corner ROW, of all corners.
static void add_throat(const struct throats *throats, int row,
                       struct rotations *rotations, struct block_rows *rows)
{
    const int t = throats->corner[row].throat, first = throats->first[t];
    const int n = throats->first[t + 1] - first;
    const struct corner *corner = &throats->corner[first];
    const bool supported = throats->supported[t];
    if (!supported) find_rotations(corner, n, rotations);
    for (int c = 0; c < n; c++) {
        if (!throats->closed[corner[c].grain]) continue;
        if (supported && c != row - first) continue;
        add_projection(rotations, row - first, c, n, supported,
                       block_rows_at(rows, corner[c].grain));
    }
}

// The matrix that takes multipliers to sum P m on each closed grain.
static struct block_rows assemble(const struct throats *throats)
{
    struct block_rows rows = block_rows_init(throats->n_grain);
    struct rotations *rotations = NEW_ARRAY(struct rotations, throats->most);
    for (int i = 0; i < throats->n_grain; i++) {
        if (throats->closed[i])
            for (int k = throats->begin[i]; k < throats->begin[i + 1]; k++)
                add_throat(throats, throats->corners[k], rotations, &rows);
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
        sum += dot(throats->corner[k].pull, throats->corner[k].pull);
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
        const struct corner *corner = &throats->corner[k];
        const struct vector change = subtract(throats->now[k], corner->pull);
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
        for (int k = 0; k < throats->n_corner; k++)
            throats->corner[k].pull = throats->now[k];
    }
    free(multiplier);
    return status;
}

enum status find_balanced_patches(struct sectors *sectors, enum form form,
                                  struct patches *patches, double *change,
                                  struct reason *reason)
{
    const int n_throat = sectors->network->n_throat;
    const int n_grain = sectors->network->packing.n_particle;
    struct throats throats = {.n_throat = n_throat,
                              .n_grain = n_grain,
                              .first = NEW_ARRAY(int, n_throat + 1),
                              .begin = NEW_ARRAY(int, n_grain + 1),
                              .supported = NEW_ARRAY(bool, n_throat),
                              .closed = NEW_ARRAY(bool, n_grain)};
    find_corners(&throats, sectors, form);
    list_by_grain(&throats);
    find_closed(&throats);
    const enum status status = balance_pulls(&throats, change, reason);
    free(throats.now);
    throats.now = NULL;
    *patches = (struct patches){0};
    for (int k = 0; k < throats.n_corner && !status; k++)
        patches_add(patches, throats.corner[k].throat, throats.corner[k].grain,
                    throats.corner[k].pull);
    throats_free(&throats);
    patches_sort(patches, n_grain);
    return status;
}
