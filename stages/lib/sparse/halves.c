// SPDX-License-Identifier: GPL-3.0-or-later
// Halves of answers to sparse loads. A column alone lies as such; more lie side by side
// in four or eight lanes, the last of them perhaps 0.
#include "supernodal_state.h"

#include "basics/memory.h"
#include "basics/sorted.h"
#include "dense_kernels.h"
#include "vector_kernels.h"

#include <stdlib.h>
#include <string.h>

static void find_way(struct supernodal *f, int count, const int *index,
                     struct halves *halves)
{
    int capacity = 0;
    for (int k = 0; k < count; k++)
        for (int s = index[k] < 0 ? -1 : f->super_of[f->place[index[k]]];
             s >= 0 && !f->is_on_way[s]; s = f->super[s].parent) {
            f->is_on_way[s] = true;
            GROW_ARRAY(halves->super, halves->n_super, capacity);
            halves->super[halves->n_super++] = s;
            halves->size += f->super[s].columns;
        }
    for (int k = 0; k < halves->n_super; k++)
        f->is_on_way[halves->super[k]] = false;
    if (halves->n_super > 0)
        qsort(halves->super, (size_t)halves->n_super, sizeof(int), rising_ints);
}

// One more supernode of the way, to where its numbers lie in HALVES.
static double *go_through(struct supernodal *f, const struct supernode *super,
                          struct halves *halves, double *x, double *to)
{
    const int lanes = halves->lanes;
    if (lanes == 1)
        forward_through(f, super, x);
    else
        (lanes == 4 ? forward_four : vector_kernels()->forward_eight)(super, x);
    const size_t numbers = (size_t)super->columns * (size_t)lanes;
    memcpy(to, x + (long)super->first * lanes, numbers * sizeof *to);
    memset(x + (long)super->first * lanes, 0, numbers * sizeof *to);
    halves->work += (double)numbers * super->rows;
    return to + numbers;
}

static void begin_halves(struct supernodal *f, int columns, int count, const int *index,
                         const double *value, double *x, struct halves *halves)
{
    const int lanes = columns == 1 ? 1 : columns <= 4 ? 4 : LANES;
    *halves = (struct halves){.columns = columns, .lanes = lanes};
    find_way(f, columns * count, index, halves);
    halves->value =
        allocate_uncleared((size_t)lanes * (size_t)halves->size, sizeof *halves->value);
    for (int c = 0; c < columns; c++)
        for (int k = c * count; k < (c + 1) * count; k++)
            if (index[k] >= 0) x[f->place[index[k]] * lanes + c] = value[k];
}

// Each supernode for all groups that it is on the way of, while it is near.
void supernodal_halves(struct supernodal *f, int groups, const int *columns, int count,
                       const int *index, const double *value, struct halves *halves)
{
    double *x[HALVES], *to[HALVES];
    int at[HALVES] = {0};
    for (int g = 0; g < groups; g++) {
        const long first = (long)g * LANES * count;
        x[g] = f->lanes + (long)g * f->n * LANES;
        begin_halves(f, columns[g], count, index + first, value + first, x[g],
                     &halves[g]);
        to[g] = halves[g].value;
    }
    for (int s = 0; s < f->n_super; s++)
        for (int g = 0; g < groups; g++)
            if (at[g] < halves[g].n_super && halves[g].super[at[g]] == s) {
                to[g] = go_through(f, &f->super[s], &halves[g], x[g], to[g]);
                at[g]++;
            }
}

void halves_free(struct halves *halves)
{
    free(halves->super);
    free(halves->value);
    *halves = (struct halves){0};
}

// ---- products -----------------------------------------------------------------------

// B has four lanes or eight.
static void add_product(int n, const double *a, int a_lanes, const double *b,
                        int b_lanes, double sum[LANES][LANES])
{
    (b_lanes == 4 ? add_product_of_four
                  : vector_kernels()->add_product_of_eight)(n, a, a_lanes, b, sum);
}

// Both ways, from the first supernode that they share: where they run together, at
// once.
void halves_product(const struct supernodal *f, const struct halves *a,
                    const struct halves *b, double *product)
{
    if (b->lanes == 1 && a->lanes > 1) {
        double turned[LANES];
        halves_product(f, b, a, turned);
        memcpy(product, turned, (size_t)a->columns * sizeof *product);
        return;
    }
    double sum[LANES][LANES] = {{0}};
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
        memcpy(product + i * b->columns, sum[i], (size_t)b->columns * sizeof *product);
}

void halves_apply(const struct supernodal *f, const struct halves *halves,
                  const double *half, double *product)
{
    double sum[LANES][LANES] = {{0}};
    const double *from = halves->value;
    for (int k = 0; k < halves->n_super; k++) {
        const struct supernode *super = &f->super[halves->super[k]];
        const double *at = half + super->first;
        if (halves->lanes == 1)
            sum[0][0] += dot_product(super->columns, from, at);
        else
            add_product(super->columns, at, 1, from, halves->lanes, sum);
        from += (long)super->columns * halves->lanes;
    }
    memcpy(product, sum[0], (size_t)halves->columns * sizeof *product);
}

void halves_take_off(const struct supernodal *f, const struct halves *halves,
                     const double *share, double *half)
{
    const int lanes = halves->lanes;
    const double *from = halves->value;
    for (int k = 0; k < halves->n_super; k++) {
        const struct supernode *super = &f->super[halves->super[k]];
        for (int i = 0; i < super->columns; i++, from += lanes)
            for (int c = 0; c < halves->columns; c++)
                half[super->first + i] =
                    fma(-share[c], from[c], half[super->first + i]);
    }
}
