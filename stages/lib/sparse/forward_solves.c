// SPDX-License-Identifier: GPL-3.0-or-later
// Forward solves L y = b for sparse b, and products of such solutions, which are
// entries of B^T A^-1 B = (L^-1 B)^T (L^-1 B). y is zero except on the reach of b in
// the elimination tree: the paths from its rows to the root, in ascending order [Davis
// 2006, 3.2].
//
// One column is stored as such. Two to eight are stored side by side in four or eight
// lanes, the unused ones 0, and one sweep through the supernodes serves all of them.
// With y_c the columns of a group and p the rows of its reach
//     product:  product_kl = sum_p a_pk b_pl, over supernodes that both reaches have;
//     apply:    product_c = sum_p y_pc half_p;
//     subtract: half_p -= sum_c share_c y_pc.
#include "supernodal_internal.h"

#include "basics/memory.h"
#include "basics/sorted.h"
#include "dense_kernels.h"
#include "vector_kernels.h"

#include <stdlib.h>
#include <string.h>

static void find_reach(struct supernodal *f, int count, const int *index,
                       struct forward_solves *solves)
{
    int capacity = 0;
    for (int k = 0; k < count; k++)
        for (int s = index[k] < 0 ? -1 : f->super_of[f->place[index[k]]];
             s >= 0 && !f->in_reach[s]; s = f->super[s].parent) {
            f->in_reach[s] = true;
            GROW_ARRAY(solves->super, solves->n_super, capacity);
            solves->super[solves->n_super++] = s;
            solves->size += f->super[s].columns;
        }
    for (int k = 0; k < solves->n_super; k++)
        f->in_reach[solves->super[k]] = false;
    if (solves->n_super > 0)
        qsort(solves->super, (size_t)solves->n_super, sizeof(int), rising_ints);
}

// Solves in one supernode, and moves its numbers from X to TO, their place in SOLVES.
static double *solve_supernode(struct supernodal *f, const struct supernode *super,
                               struct forward_solves *solves, double *x, double *to)
{
    const int lanes = solves->lanes;
    if (lanes == 1)
        forward_through(f, super, x);
    else
        (lanes == 4 ? forward_four : vector_kernels()->forward_eight)(super, x);
    const size_t numbers = (size_t)super->columns * (size_t)lanes;
    memcpy(to, x + (long)super->first * lanes, numbers * sizeof *to);
    memset(x + (long)super->first * lanes, 0, numbers * sizeof *to);
    solves->work += (double)numbers * super->rows;
    return to + numbers;
}

static void begin_forward_solves(struct supernodal *f, int columns, int count,
                                 const int *index, const double *value, double *x,
                                 struct forward_solves *solves)
{
    const int lanes = columns == 1 ? 1 : columns <= 4 ? 4 : BATCH;
    *solves = (struct forward_solves){.columns = columns, .lanes = lanes};
    find_reach(f, columns * count, index, solves);
    solves->value =
        allocate_uncleared((size_t)lanes * (size_t)solves->size, sizeof *solves->value);
    for (int c = 0; c < columns; c++)
        for (int k = c * count; k < (c + 1) * count; k++)
            if (index[k] >= 0) x[f->place[index[k]] * lanes + c] = value[k];
}

// Supernode by supernode, for all groups that reach it, while its panel is in the
// cache.
void supernodal_forward_solves(struct supernodal *f, int groups, const int *columns,
                               int count, const int *index, const double *value,
                               struct forward_solves *solves)
{
    double *x[MOST_SOLVES], *to[MOST_SOLVES];
    int at[MOST_SOLVES] = {0};
    for (int g = 0; g < groups; g++) {
        const long first = (long)g * BATCH * count;
        x[g] = f->lanes + (long)g * f->n * BATCH;
        begin_forward_solves(f, columns[g], count, index + first, value + first, x[g],
                             &solves[g]);
        to[g] = solves[g].value;
    }
    for (int s = 0; s < f->n_super; s++)
        for (int g = 0; g < groups; g++)
            if (at[g] < solves[g].n_super && solves[g].super[at[g]] == s) {
                to[g] = solve_supernode(f, &f->super[s], &solves[g], x[g], to[g]);
                at[g]++;
            }
}

void forward_solves_free(struct forward_solves *solves)
{
    free(solves->super);
    free(solves->value);
    *solves = (struct forward_solves){0};
}

// ---- products -----------------------------------------------------------------------

// B has four or eight lanes.
static void add_product(int n, const double *a, int a_lanes, const double *b,
                        int b_lanes, double sum[BATCH][BATCH])
{
    (b_lanes == 4 ? add_product_of_four
                  : vector_kernels()->add_product_of_eight)(n, a, a_lanes, b, sum);
}

// Runs over both reaches; supernodes that they share in succession go in one product.
void forward_solves_product(const struct supernodal *f, const struct forward_solves *a,
                            const struct forward_solves *b, double *product)
{
    if (b->lanes == 1 && a->lanes > 1) {
        double turned[BATCH];
        forward_solves_product(f, b, a, turned);
        memcpy(product, turned, (size_t)a->columns * sizeof *product);
        return;
    }
    double sum[BATCH][BATCH] = {{0}};
    long from_a = 0, from_b = 0;
    for (int k = 0, l = 0; k < a->n_super && l < b->n_super;) {
        int n = 0;
        for (; k < a->n_super && l < b->n_super && a->super[k] == b->super[l]; k++, l++)
            n += f->super[a->super[k]].columns;
        const double *of_a = a->value + from_a * a->lanes;
        const double *of_b = b->value + from_b * b->lanes;
        if (b->lanes > 1)
            add_product(n, of_a, a->lanes, of_b, b->lanes, sum);
        else
            sum[0][0] += dot_product(n, of_a, of_b);
        from_a += n, from_b += n;
        if (k == a->n_super || l == b->n_super) break;
        if (a->super[k] < b->super[l])
            from_a += f->super[a->super[k++]].columns;
        else
            from_b += f->super[b->super[l++]].columns;
    }
    for (int i = 0; i < a->columns; i++)
        memcpy(product + (size_t)i * (size_t)b->columns, sum[i],
               (size_t)b->columns * sizeof *product);
}

void forward_solves_apply(const struct supernodal *f,
                          const struct forward_solves *solves, const double *half,
                          double *product)
{
    double sum[BATCH][BATCH] = {{0}};
    const double *from = solves->value;
    for (int k = 0; k < solves->n_super; k++) {
        const struct supernode *super = &f->super[solves->super[k]];
        const double *at = half + super->first;
        if (solves->lanes == 1)
            sum[0][0] += dot_product(super->columns, from, at);
        else
            add_product(super->columns, at, 1, from, solves->lanes, sum);
        from += (long)super->columns * solves->lanes;
    }
    memcpy(product, sum[0], (size_t)solves->columns * sizeof *product);
}

void forward_solves_subtract(const struct supernodal *f,
                             const struct forward_solves *solves, const double *share,
                             double *half)
{
    const int lanes = solves->lanes;
    const double *from = solves->value;
    for (int k = 0; k < solves->n_super; k++) {
        const struct supernode *super = &f->super[solves->super[k]];
        for (int i = 0; i < super->columns; i++, from += lanes)
            for (int c = 0; c < solves->columns; c++)
                half[super->first + i] =
                    fma(-share[c], from[c], half[super->first + i]);
    }
}
