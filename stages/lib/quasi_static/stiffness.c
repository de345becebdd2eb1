// SPDX-License-Identifier: GPL-3.0-or-later
// K = sum over pairs of B^T tangent B, and of geometric stiffness, with a
// regularisation on the diagonal: blocks of 6 by 6 for the grains that move, three
// translations and three rotations each. Its lower triangle lies by columns; K = L L^T
// by sparse/supernodal.h, whose forward solves are L^-1 of a load.
//
// The pattern is found once: block k, of the grains `column` <= `row`, stands for all
// pairs between them, and a pair without contact or bond adds zeros. All six columns of
// a grain have the same rows, so number (r, c) of block k lies at
//     value[start[6 column] + 6 (k - diagonal[column]) + c stride + r],
//     stride = start[6 column + 1] - start[6 column].
// A fixed grain has no rows (number -1): a pair with one adds to a diagonal block only.
#include "stiffness.h"

#include "basics/memory.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { DEGREES = 6 }; // of freedom of a grain

static_assert(sizeof(struct displacement) == DEGREES * sizeof(double), "six numbers");

// A block of 6 by 6 below the diagonal, of the row grain in the columns of the other.
struct block {
    int32_t column, row;
};

struct stiffness {
    int n, n_pair;
    const struct contact_pair *pair;
    int32_t *number; // (n) among those that move, or -1
    int n_moving;
    struct block *block; // sorted; those on the diagonal too
    int n_block;
    int *block_of;    // (n_pair) below the diagonal, or -1
    int *diagonal;    // (n_moving) blocks
    int *start, *row; // lower triangle by columns, upper halves of diagonal blocks too
    double *value;
    struct supernodal *factor;
    double *load;         // (n_moving * DEGREES)
    double *begun, *left; // the same: L^-1 of the load, and of what is left of it
};

// ---- pattern ------------------------------------------------------------------------

static int compare_blocks(const void *a, const void *b)
{
    const struct block *p = a, *q = b;
    if (p->column != q->column) return p->column < q->column ? -1 : 1;
    return (p->row > q->row) - (p->row < q->row);
}

static struct block block_between(const struct stiffness *s,
                                  const struct contact_pair *pair)
{
    const int32_t a = s->number[pair->grain[0]];
    const int32_t b = pair->grain[1] < 0 ? -1 : s->number[pair->grain[1]];
    return a < b ? (struct block){a, b} : (struct block){b, a};
}

static void list_blocks(struct stiffness *s, const bool *resist)
{
    s->block = NEW_ARRAY(struct block, s->n_moving + s->n_pair);
    int count = 0;
    for (int k = 0; k < s->n_moving; k++)
        s->block[count++] = (struct block){k, k};
    for (int j = 0; j < s->n_pair; j++) {
        const struct block block = block_between(s, &s->pair[j]);
        if (block.column >= 0 && (!resist || resist[j])) s->block[count++] = block;
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
    return found ? (int)(found - s->block) : -1;
}

static void lay_out(struct stiffness *s)
{
    s->start = NEW_ARRAY(int, s->n_moving *DEGREES + 1);
    s->row = NEW_ARRAY(int, s->n_block *DEGREES *DEGREES);
    s->value = NEW_ARRAY(double, s->n_block *DEGREES *DEGREES);
    int at = 0;
    for (int first = 0, end; first < s->n_block; first = end) {
        const int32_t column = s->block[first].column;
        for (end = first; end < s->n_block && s->block[end].column == column;)
            end++;
        for (int c = 0; c < DEGREES; c++) {
            s->start[column * DEGREES + c] = at;
            for (int k = first; k < end; k++)
                for (int r = 0; r < DEGREES; r++)
                    s->row[at++] = s->block[k].row * DEGREES + r;
        }
        s->diagonal[column] = first;
    }
    s->start[(size_t)s->n_moving * DEGREES] = at;
}

struct stiffness *stiffness_create(int n, const uint8_t *fixed, int n_pair,
                                   const struct contact_pair *pair, const bool *resist)
{
    struct stiffness *s = NEW_ARRAY(struct stiffness, 1);
    s->n = n;
    s->n_pair = n_pair;
    s->pair = pair;
    s->number = NEW_ARRAY(int32_t, n);
    for (int i = 0; i < n; i++)
        s->number[i] = fixed[i] ? -1 : s->n_moving++;
    s->diagonal = NEW_ARRAY(int, s->n_moving);
    s->block_of = NEW_ARRAY(int, n_pair);
    list_blocks(s, resist);
    for (int j = 0; j < n_pair; j++)
        s->block_of[j] = find_block(s, block_between(s, &pair[j]));
    lay_out(s);
    s->factor = supernodal_create(s->n_moving * DEGREES, s->start, s->row);
    double **const of_degrees[] = {&s->load, &s->begun, &s->left};
    for (size_t k = 0; k < sizeof of_degrees / sizeof *of_degrees; k++)
        *of_degrees[k] = NEW_ARRAY(double, (size_t)s->n_moving *DEGREES);
    return s;
}

void stiffness_free(struct stiffness *s)
{
    if (!s) return;
    supernodal_free(s->factor);
    void *const owned[] = {s->number, s->block, s->block_of, s->diagonal, s->start,
                           s->row,    s->value, s->load,     s->begun,    s->left};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free(s);
}

// ---- numbers ------------------------------------------------------------------------

// Where the numbers of BLOCK begin in the matrix; its next column lies *STRIDE further.
static double *numbers_of(const struct stiffness *s, int block, int *stride)
{
    const struct block *b = &s->block[block];
    const int column = b->column * DEGREES;
    *stride = s->start[column + 1] - s->start[column];
    return s->value + s->start[column] +
           (ptrdiff_t)(block - s->diagonal[b->column]) * DEGREES;
}

// B^T of the grain at END, a row for each component.
static void kinematic_rows_of(const struct contact_pair *pair, int end,
                              double arm[COMPONENTS][DEGREES])
{
    for (int k = 0; k < COMPONENTS; k++) {
        const struct displacement row = pair_kinematic_row(pair, end, k);
        memcpy(arm[k], &row, sizeof row);
    }
}

static void add_block(struct stiffness *s, int block,
                      const double left[COMPONENTS][DEGREES],
                      const double right[COMPONENTS][DEGREES],
                      const double tangent[COMPONENTS], double across)
{
    int stride;
    double *numbers = numbers_of(s, block, &stride);
    for (int k = 0; k < COMPONENTS; k++)
        for (int c = 0; c < DEGREES; c++)
            for (int r = 0; r < DEGREES; r++)
                numbers[c * stride + r] += tangent[k] * left[k][r] * right[k][c];
    for (int c = 0; c < DEGREES && across != 0; c++)
        for (int r = 0; r < DEGREES; r++)
            numbers[c * stride + r] += across * (left[SHEAR][r] * right[SHEAR + 1][c] +
                                                 left[SHEAR + 1][r] * right[SHEAR][c]);
}

static void add_pair(struct stiffness *s, int j, const double tangent[COMPONENTS],
                     double across)
{
    const struct contact_pair *pair = &s->pair[j];
    double arm[2][COMPONENTS][DEGREES];
    int32_t number[2];
    for (int end = 0; end < 2; end++) {
        number[end] = pair->grain[end] < 0 ? -1 : s->number[pair->grain[end]];
        if (number[end] < 0) continue;
        kinematic_rows_of(pair, end, arm[end]);
        add_block(s, s->diagonal[number[end]], arm[end], arm[end], tangent, across);
    }
    if (s->block_of[j] < 0) return;
    assert(number[0] >= 0 && number[1] >= 0); // what only two that move have
    const int lower = number[0] < number[1] ? 0 : 1;
    add_block(s, s->block_of[j], arm[1 - lower], arm[lower], tangent, across);
}

static void add_rows(struct stiffness *s, int block, int row, int column,
                     const struct pair_stiffness *geometric)
{
    int stride;
    double *numbers = numbers_of(s, block, &stride);
    for (int c = 0; c < DEGREES; c++)
        for (int r = 0; r < DEGREES; r++)
            numbers[c * stride + r] +=
                geometric->block[row * DEGREES + r][column * DEGREES + c];
}

static void add_geometric(struct stiffness *s, int j,
                          const struct pair_stiffness *geometric)
{
    int32_t number[2];
    for (int end = 0; end < 2; end++) {
        const int32_t grain = s->pair[j].grain[end];
        number[end] = grain < 0 ? -1 : s->number[grain];
        if (number[end] >= 0)
            add_rows(s, s->diagonal[number[end]], end, end, geometric);
    }
    const int lower = number[0] < number[1] ? 0 : 1;
    if (s->block_of[j] >= 0) add_rows(s, s->block_of[j], 1 - lower, lower, geometric);
}

static bool resists(const double tangent[COMPONENTS])
{
    for (int k = 0; k < COMPONENTS; k++)
        if (tangent[k] != 0) return true;
    return false;
}

bool stiffness_factor(struct stiffness *s, const struct stiffness_terms *terms)
{
    if (s->n_moving == 0) return true;
    memset(s->value, 0,
           (size_t)s->start[(size_t)s->n_moving * DEGREES] * sizeof *s->value);
    for (int j = 0; j < s->n_pair; j++)
        if (resists(terms->tangent[j]))
            add_pair(s, j, terms->tangent[j], terms->across ? terms->across[j] : 0);
    for (int j = 0; j < s->n_pair && terms->geometric; j++)
        add_geometric(s, j, &terms->geometric[j]);
    for (int i = 0; i < s->n; i++) {
        if (s->number[i] < 0) continue;
        int stride;
        double *numbers = numbers_of(s, s->diagonal[s->number[i]], &stride);
        const double dashpot = terms->dashpot ? terms->dashpot[i] : 0;
        for (int r = 0; r < DEGREES; r++)
            numbers[r * stride + r] += terms->soft[r / 3] + dashpot;
    }
    return supernodal_factor(s->factor, s->value);
}

bool stiffness_is_positive(const struct stiffness *s)
{
    if (s->n_moving == 0) return true;
    double *diagonal = NEW_ARRAY(double, s->n_moving *DEGREES);
    for (int k = 0; k < s->n_moving; k++) {
        int stride;
        const double *numbers = numbers_of(s, s->diagonal[k], &stride);
        for (int r = 0; r < DEGREES; r++)
            diagonal[k * DEGREES + r] = numbers[r * stride + r];
    }
    const bool is_positive = supernodal_is_positive(s->factor, diagonal);
    free(diagonal);
    return is_positive;
}

// ---- solutions ----------------------------------------------------------------------

void stiffness_begin(struct stiffness *s, const struct displacement *load)
{
    for (int i = 0; i < s->n; i++)
        if (s->number[i] >= 0)
            memcpy(s->load + (size_t)s->number[i] * DEGREES, &load[i], sizeof load[i]);
    if (s->n_moving == 0) return;
    supernodal_forward(s->factor, s->load, s->begun);
    memcpy(s->left, s->begun, (size_t)s->n_moving * DEGREES * sizeof *s->left);
}

void stiffness_finish(struct stiffness *s, struct displacement *answer)
{
    memset(answer, 0, (size_t)s->n * sizeof *answer);
    if (s->n_moving == 0) return;
    supernodal_backward(s->factor, s->left, s->load);
    memcpy(s->left, s->begun, (size_t)s->n_moving * DEGREES * sizeof *s->left);
    for (int i = 0; i < s->n; i++)
        if (s->number[i] >= 0)
            memcpy(&answer[i], s->load + (size_t)s->number[i] * DEGREES,
                   sizeof answer[i]);
}

void stiffness_deformation(const struct stiffness *s,
                           const struct forward_solves *solves, double *deformation)
{
    forward_solves_apply(s->factor, solves, s->begun, deformation);
}

void stiffness_subtract(struct stiffness *s, const struct forward_solves *solves,
                        const double *load)
{
    forward_solves_subtract(s->factor, solves, load, s->left);
}

void stiffness_forward_solves(struct stiffness *s, int groups, const int *count,
                              const struct unit_load (*load)[BATCH],
                              struct forward_solves *solves)
{
    enum { ENDS = 2 * DEGREES };
    double value[MOST_SOLVES][BATCH][2][DEGREES] = {0};
    int index[MOST_SOLVES][BATCH][2][DEGREES] = {0};
    for (int g = 0; g < groups; g++)
        for (int k = 0; k < count[g]; k++)
            for (int end = 0; end < 2; end++) {
                const struct contact_pair *pair = &s->pair[load[g][k].pair];
                const int32_t grain = pair->grain[end];
                const int number = grain < 0 ? -1 : s->number[grain];
                const struct displacement arm =
                    pair_kinematic_row(pair, end, load[g][k].component);
                memcpy(value[g][k][end], &arm, sizeof arm);
                for (int r = 0; r < DEGREES; r++)
                    index[g][k][end][r] = number < 0 ? -1 : number * DEGREES + r;
            }
    if (s->n_moving > 0)
        supernodal_forward_solves(s->factor, groups, count, ENDS, index[0][0][0],
                                  value[0][0][0], solves);
    for (int g = 0; g < groups && s->n_moving == 0; g++)
        solves[g] = (struct forward_solves){.columns = count[g]};
}

void stiffness_product(const struct stiffness *s, const struct forward_solves *a,
                       const struct forward_solves *b, double *product)
{
    forward_solves_product(s->factor, a, b, product);
}

double stiffness_work(const struct stiffness *s)
{
    return s->factor ? supernodal_work(s->factor) : 0;
}
