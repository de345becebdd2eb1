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
    bool is_factorised;
    // Of conjugate gradients, (n_moving * DEGREES); solved: CHOLMOD's own.
    double *residual, *direction, *image;
    cholmod_dense *right, *solved, *work[2];
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
    s->right = cholmod_zeros(size, 1, CHOLMOD_REAL, &s->common);
    s->residual = NEW_ARRAY(double, size);
    s->direction = NEW_ARRAY(double, size);
    s->image = NEW_ARRAY(double, size);
    return s;
}

void stiffness_free(struct stiffness *s)
{
    if (!s) return;
    cholmod_free_sparse(&s->matrix, &s->common);
    cholmod_free_factor(&s->factor, &s->common);
    cholmod_free_dense(&s->right, &s->common);
    cholmod_free_dense(&s->solved, &s->common);
    cholmod_free_dense(&s->work[0], &s->common);
    cholmod_free_dense(&s->work[1], &s->common);
    cholmod_finish(&s->common);
    void *const owned[] = {s->number,   s->block,     s->block_of, s->diagonal,
                           s->residual, s->direction, s->image};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
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

// What the loads of a joint do to the grain at END, and from what strains they come:
// B^T and D B, six rows each.
static void arms_of(const struct joint *joint, int end, double arm[STRAINS][DEGREES])
{
    for (int k = 0; k < STRAINS; k++) {
        const struct displacement row = joint_arm(joint, end, k);
        memcpy(arm[k], &row, sizeof row);
    }
}

static void times_tangent(const struct resistance *resistance,
                          const double arm[STRAINS][DEGREES],
                          double product[STRAINS][DEGREES])
{
    for (int k = 0; k < STRAINS; k++)
        for (int c = 0; c < DEGREES; c++)
            product[k][c] = resistance->tangent[k] * arm[k][c];
    for (int k = 0; k < 2; k++)
        for (int c = 0; c < DEGREES; c++)
            product[STRAIN_ACROSS + k][c] +=
                resistance->tangent_across * arm[STRAIN_ACROSS + 1 - k][c];
}

static void add_block(struct stiffness *s, int block,
                      const double left[STRAINS][DEGREES],
                      const double right[STRAINS][DEGREES])
{
    int stride;
    double *numbers = numbers_of(s, block, &stride);
    for (int c = 0; c < DEGREES; c++)
        for (int r = 0; r < DEGREES; r++)
            for (int k = 0; k < STRAINS; k++)
                numbers[c * stride + r] += left[k][r] * right[k][c];
}

static void add_joint(struct stiffness *s, int j, const struct resistance *resistance)
{
    const struct joint *joint = &s->joint[j];
    double arm[2][STRAINS][DEGREES], product[2][STRAINS][DEGREES];
    int32_t number[2];
    for (int end = 0; end < 2; end++) {
        number[end] = joint->grain[end] < 0 ? -1 : s->number[joint->grain[end]];
        if (number[end] < 0) continue;
        arms_of(joint, end, arm[end]);
        times_tangent(resistance, arm[end], product[end]);
        add_block(s, s->diagonal[number[end]], arm[end], product[end]);
    }
    if (s->block_of[j] < 0) return;
    const int lower = number[0] < number[1] ? 0 : 1;
    add_block(s, s->block_of[j], arm[1 - lower], product[lower]);
}

static bool factorise(struct stiffness *s, const struct resistance *resistance,
                      double soft)
{
    memset(s->matrix->x, 0, s->matrix->nzmax * sizeof(double));
    for (int j = 0; j < s->n_joint; j++)
        add_joint(s, j, &resistance[j]);
    for (int k = 0; k < s->n_moving; k++) {
        int stride;
        double *numbers = numbers_of(s, s->diagonal[k], &stride);
        for (int r = 0; r < DEGREES; r++)
            numbers[r * stride + r] += soft;
    }
    s->is_factorised = cholmod_factorize(s->matrix, s->factor, &s->common) &&
                       s->common.status == CHOLMOD_OK;
    return s->is_factorised;
}

// ---- conjugate gradients ------------------------------------------------------------

static double product_of(const double *a, const double *b, size_t n)
{
    double sum = 0;
    for (size_t k = 0; k < n; k++)
        sum += a[k] * b[k];
    return sum;
}

static struct displacement *of_grain(const struct stiffness *s, double *numbers,
                                     int32_t grain)
{
    if (grain < 0 || s->number[grain] < 0) return NULL;
    return (struct displacement *)numbers + s->number[grain];
}

// Shear strains and the others are each a product with what a joint's two grains do.
static void resist(const struct stiffness *s, const struct resistance *resistance,
                   int j, double *direction, double *image)
{
    const struct joint *joint = &s->joint[j];
    double strain[STRAINS], force[STRAINS];
    joint_strains(joint, of_grain(s, direction, joint->grain[0]),
                  of_grain(s, direction, joint->grain[1]), strain);
    for (int k = 0; k < STRAINS; k++)
        force[k] = resistance->tangent[k] * strain[k];
    for (int k = 0; k < 2; k++)
        force[STRAIN_ACROSS + k] +=
            resistance->tangent_across * strain[STRAIN_ACROSS + 1 - k];
    for (int end = 0; end < 2; end++) {
        struct displacement *load = of_grain(s, image, joint->grain[end]);
        if (!load) continue;
        const struct displacement part = joint_loads(joint, end, force);
        load->shift = add(load->shift, part.shift);
        load->turn = add(load->turn, part.turn);
    }
}

static void multiply(const struct stiffness *s, const struct resistance *resistance,
                     double soft, double *direction, double *image)
{
    const size_t n = (size_t)s->n_moving * DEGREES;
    for (size_t k = 0; k < n; k++)
        image[k] = soft * direction[k];
    for (int j = 0; j < s->n_joint; j++)
        resist(s, &resistance[j], j, direction, image);
}

// What the factor makes of the residual.
static const double *precondition(struct stiffness *s)
{
    memcpy(s->right->x, s->residual, (size_t)s->n_moving * DEGREES * sizeof(double));
    if (!cholmod_solve2(CHOLMOD_A, s->factor, s->right, NULL, &s->solved, NULL,
                        &s->work[0], &s->work[1], &s->common))
        return NULL;
    return s->solved->x;
}

enum outcome { SOLVED, SLOW, FAILED };

// ANSWER is made from 0; the residual begins as the load.
static enum outcome iterate(struct stiffness *s, const struct resistance *resistance,
                            double soft, double *answer)
{
    enum { MOST = 24 }; // steps that cost about as much as a new factor
    const double enough = 1e-3;
    const size_t n = (size_t)s->n_moving * DEGREES;
    const double target = enough * enough * product_of(s->residual, s->residual, n);
    double before = 0;
    memset(answer, 0, n * sizeof *answer);
    for (int step = 0; step < MOST; step++) {
        const double *solved = precondition(s);
        if (!solved) return FAILED;
        const double now = product_of(s->residual, solved, n);
        for (size_t k = 0; k < n; k++)
            s->direction[k] = solved[k] + (step ? now / before * s->direction[k] : 0);
        multiply(s, resistance, soft, s->direction, s->image);
        const double bend = product_of(s->direction, s->image, n);
        if (!(bend > 0)) return FAILED;
        for (size_t k = 0; k < n; k++) {
            answer[k] += now / bend * s->direction[k];
            s->residual[k] -= now / bend * s->image[k];
        }
        if (product_of(s->residual, s->residual, n) <= target) return SOLVED;
        before = now;
    }
    return SLOW;
}

static void gather(struct stiffness *s, const struct displacement *load)
{
    for (int i = 0; i < s->n; i++)
        if (s->number[i] >= 0)
            ((struct displacement *)s->residual)[s->number[i]] = load[i];
}

bool stiffness_solve(struct stiffness *s, const struct resistance *resistance,
                     double soft, const struct displacement *load,
                     struct displacement *answer)
{
    double *moving = NEW_ARRAY(double, s->n_moving *DEGREES);
    enum outcome outcome = SLOW;
    for (int turn = 0; turn < 2 && outcome == SLOW; turn++) {
        if (turn > 0 || !s->is_factorised)
            if (!factorise(s, resistance, soft)) break;
        gather(s, load);
        outcome = iterate(s, resistance, soft, moving);
    }
    for (int i = 0; i < s->n; i++)
        answer[i] = s->number[i] < 0 ? (struct displacement){{0, 0, 0}, {0, 0, 0}}
                                     : ((struct displacement *)moving)[s->number[i]];
    free(moving);
    return outcome == SOLVED;
}
