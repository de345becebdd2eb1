// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiffness.h"

#include "basics/memory.h"
#include "sparse/plain_cholmod.h"

#include <stdlib.h>
#include <string.h>

enum { DEGREES = 6 }; // of freedom of a grain: three shifts, three turns

static_assert(sizeof(struct displacement) == DEGREES * sizeof(double), "six numbers");

// A block of 6 by 6 below the diagonal, of the row grain in the columns of the other.
struct block {
    int32_t column, row;
};

struct stiffness {
    int n, n_joint;
    const struct joint *joint;
    int32_t *number; // (n) among those that move, or -1
    int n_moving;
    struct block *block; // sorted; those on the diagonal too
    int n_block;
    int *block_of; // (n_joint) below the diagonal, or -1
    int *diagonal; // (n_moving) blocks
    cholmod_common common;
    cholmod_sparse *matrix;
    cholmod_factor *factor;
    cholmod_dense *load, *loads;     // (n_moving * DEGREES) by 1 and by 3
    cholmod_dense *solved, *work[2]; // CHOLMOD's own
};

// ---- pattern ------------------------------------------------------------------------

static int compare_blocks(const void *a, const void *b)
{
    const struct block *p = a, *q = b;
    if (p->column != q->column) return p->column < q->column ? -1 : 1;
    return (p->row > q->row) - (p->row < q->row);
}

static struct block block_between(const struct stiffness *s, const struct joint *joint)
{
    const int32_t a = s->number[joint->grain[0]];
    const int32_t b = joint->grain[1] < 0 ? -1 : s->number[joint->grain[1]];
    return a < b ? (struct block){a, b} : (struct block){b, a};
}

static void list_blocks(struct stiffness *s)
{
    s->block = NEW_ARRAY(struct block, s->n_moving + s->n_joint);
    int count = 0;
    for (int k = 0; k < s->n_moving; k++)
        s->block[count++] = (struct block){k, k};
    for (int j = 0; j < s->n_joint; j++) {
        const struct block block = block_between(s, &s->joint[j]);
        if (block.column >= 0) s->block[count++] = block;
    }
    qsort(s->block, (size_t)count, sizeof *s->block, compare_blocks);
    for (int k = 0; k < count; k++)
        if (!s->n_block || compare_blocks(&s->block[s->n_block - 1], &s->block[k]))
            s->block[s->n_block++] = s->block[k];
}

static int find_block(const struct stiffness *s, struct block block)
{
    if (block.column < 0) return -1;
    const struct block *found =
        bsearch(&block, s->block, (size_t)s->n_block, sizeof block, compare_blocks);
    return (int)(found - s->block);
}

// Lower triangle by columns; the upper halves of diagonal blocks are there and ignored.
static void lay_out(struct stiffness *s)
{
    const size_t n = (size_t)s->n_moving * DEGREES;
    s->matrix = cholmod_allocate_sparse(n, n, (size_t)s->n_block * DEGREES * DEGREES, 1,
                                        1, -1, CHOLMOD_REAL, &s->common);
    int *start = s->matrix->p, *row = s->matrix->i, at = 0;
    for (int first = 0, end; first < s->n_block; first = end) {
        const int32_t column = s->block[first].column;
        for (end = first; end < s->n_block && s->block[end].column == column;)
            end++;
        for (int c = 0; c < DEGREES; c++) {
            start[column * DEGREES + c] = at;
            for (int k = first; k < end; k++)
                for (int r = 0; r < DEGREES; r++)
                    row[at++] = s->block[k].row * DEGREES + r;
        }
        s->diagonal[column] = first;
    }
    start[n] = at;
}

struct stiffness *stiffness_new(int n, const uint8_t *fixed, int n_joint,
                                const struct joint *joint)
{
    struct stiffness *s = NEW_ARRAY(struct stiffness, 1);
    s->n = n;
    s->n_joint = n_joint;
    s->joint = joint;
    s->number = NEW_ARRAY(int32_t, n);
    for (int i = 0; i < n; i++)
        s->number[i] = fixed[i] ? -1 : s->n_moving++;
    s->diagonal = NEW_ARRAY(int, s->n_moving);
    s->block_of = NEW_ARRAY(int, n_joint);
    list_blocks(s);
    for (int j = 0; j < n_joint; j++)
        s->block_of[j] = find_block(s, block_between(s, &joint[j]));
    plain_cholmod_start(&s->common);
    lay_out(s);
    const size_t size = (size_t)s->n_moving * DEGREES;
    if (size > 0) s->factor = cholmod_analyze(s->matrix, &s->common);
    s->load = cholmod_zeros(size, 1, CHOLMOD_REAL, &s->common);
    s->loads = cholmod_zeros(size, 3, CHOLMOD_REAL, &s->common);
    return s;
}

void stiffness_free(struct stiffness *s)
{
    if (!s) return;
    cholmod_free_sparse(&s->matrix, &s->common);
    cholmod_free_factor(&s->factor, &s->common);
    cholmod_free_dense(&s->load, &s->common);
    cholmod_free_dense(&s->loads, &s->common);
    cholmod_free_dense(&s->solved, &s->common);
    cholmod_free_dense(&s->work[0], &s->common);
    cholmod_free_dense(&s->work[1], &s->common);
    cholmod_finish(&s->common);
    free(s->number);
    free(s->block);
    free(s->block_of);
    free(s->diagonal);
    free(s);
}

// ---- numbers ------------------------------------------------------------------------

// Where the numbers of BLOCK begin in the matrix; its next column lies *STRIDE further.
static double *numbers_of(const struct stiffness *s, int block, int *stride)
{
    const struct block *b = &s->block[block];
    const int *start = s->matrix->p, column = b->column * DEGREES;
    *stride = start[column + 1] - start[column];
    return (double *)s->matrix->x + start[column] +
           (block - s->diagonal[b->column]) * DEGREES;
}

// What the loads of a joint do to the grain at END, six rows: B^T.
static void arms_of(const struct joint *joint, int end, double arm[STRAINS][DEGREES])
{
    for (int k = 0; k < STRAINS; k++) {
        const struct displacement row = joint_arm(joint, end, k);
        memcpy(arm[k], &row, sizeof row);
    }
}

static void add_block(struct stiffness *s, int block,
                      const double left[STRAINS][DEGREES],
                      const double right[STRAINS][DEGREES],
                      const double tangent[STRAINS])
{
    int stride;
    double *numbers = numbers_of(s, block, &stride);
    for (int k = 0; k < STRAINS; k++)
        for (int c = 0; c < DEGREES; c++)
            for (int r = 0; r < DEGREES; r++)
                numbers[c * stride + r] += tangent[k] * left[k][r] * right[k][c];
}

static void add_joint(struct stiffness *s, int j, const double tangent[STRAINS])
{
    const struct joint *joint = &s->joint[j];
    double arm[2][STRAINS][DEGREES];
    int32_t number[2];
    for (int end = 0; end < 2; end++) {
        number[end] = joint->grain[end] < 0 ? -1 : s->number[joint->grain[end]];
        if (number[end] < 0) continue;
        arms_of(joint, end, arm[end]);
        add_block(s, s->diagonal[number[end]], arm[end], arm[end], tangent);
    }
    if (s->block_of[j] < 0) return;
    const int lower = number[0] < number[1] ? 0 : 1;
    add_block(s, s->block_of[j], arm[1 - lower], arm[lower], tangent);
}

bool stiffness_factor(struct stiffness *s, const double (*tangent)[STRAINS],
                      double soft)
{
    if (s->n_moving == 0) return true;
    memset(s->matrix->x, 0, s->matrix->nzmax * sizeof(double));
    for (int j = 0; j < s->n_joint; j++)
        add_joint(s, j, tangent[j]);
    for (int k = 0; k < s->n_moving; k++) {
        int stride;
        double *numbers = numbers_of(s, s->diagonal[k], &stride);
        for (int r = 0; r < DEGREES; r++)
            numbers[r * stride + r] += soft;
    }
    return cholmod_factorize(s->matrix, s->factor, &s->common) &&
           s->common.status == CHOLMOD_OK;
}

// ---- answers ------------------------------------------------------------------------

static void scatter(const struct stiffness *s, const struct displacement *moving,
                    struct displacement *answer)
{
    for (int i = 0; i < s->n; i++)
        answer[i] = s->number[i] < 0 ? (struct displacement){{0, 0, 0}, {0, 0, 0}}
                                     : moving[s->number[i]];
}

static const struct displacement *solve(struct stiffness *s, cholmod_dense *load)
{
    if (!cholmod_solve2(CHOLMOD_A, s->factor, load, NULL, &s->solved, NULL, &s->work[0],
                        &s->work[1], &s->common))
        return NULL;
    return s->solved->x;
}

bool stiffness_solve(struct stiffness *s, const struct displacement *load,
                     struct displacement *answer)
{
    struct displacement *moving = s->load->x;
    for (int i = 0; i < s->n; i++)
        if (s->number[i] >= 0) moving[s->number[i]] = load[i];
    const struct displacement *solved = s->n_moving ? solve(s, s->load) : moving;
    if (!solved) return false;
    scatter(s, solved, answer);
    return true;
}

bool stiffness_solve_joint(struct stiffness *s, int j, int first,
                           struct displacement *answer)
{
    const struct joint *joint = &s->joint[j];
    struct displacement *loads = s->loads->x;
    for (int k = 0; k < 3; k++)
        for (int end = 0; end < 2; end++) {
            const int32_t grain = joint->grain[end];
            if (grain >= 0 && s->number[grain] >= 0)
                loads[k * s->n_moving + s->number[grain]] =
                    joint_arm(joint, end, first + k);
        }
    const struct displacement *solved = s->n_moving ? solve(s, s->loads) : loads;
    for (int k = 0; solved && k < 3; k++)
        scatter(s, solved + k * s->n_moving, answer + (size_t)k * (size_t)s->n);
    memset(loads, 0, 3 * (size_t)s->n_moving * sizeof *loads);
    return solved;
}
