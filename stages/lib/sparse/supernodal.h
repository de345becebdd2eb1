// SPDX-License-Identifier: GPL-3.0-or-later
// Cholesky factors of sparse symmetric positive matrices that are factored again and
// again: CHOLMOD orders and finds columns of like pattern (supernodes), dense kernels
// of our own work on these. No BLAS, so the same bytes everywhere.
#ifndef CRAQUELURE_SUPERNODAL_H
#define CRAQUELURE_SUPERNODAL_H

#include <stdbool.h>

struct supernodal;

// For N by N matrices whose lower triangle has in column c the rows ROW[START[c]] to
// ROW[START[c + 1] - 1]; entries above the diagonal are ignored. The caller frees it
// with supernodal_free. NULL: N is 0.
struct supernodal *supernodal_new(int n, const int *start, const int *row);
void supernodal_free(struct supernodal *factor);

// VALUE as ROW. A pivot that rounding has taken becomes one of its size. False: there
// is one that no number holds.
bool supernodal_factor(struct supernodal *factor, const double *value);

// Whether the matrix last factored, with that DIAGONAL (n), was positive: whether no
// pivot was negative or what rounding leaves.
bool supernodal_is_positive(const struct supernodal *factor, const double *diagonal);

// Multiplications that a factor takes.
double supernodal_work(const struct supernodal *factor);

// The two halves of a solution: HALF (n), in the order of the factor, of the right-hand
// side X (n), and the answer X from it.
void supernodal_forward(struct supernodal *factor, const double *x, double *half);
void supernodal_backward(struct supernodal *factor, const double *half, double *x);

// L^-1 of sparse right-hand sides: not 0 only on the reach of their rows, the paths
// from them to the root of the elimination tree. Products of such forward solves are
// entries of B^T A^-1 B.
enum { BATCH = 8 };
struct forward_solves {
    int columns;         // BATCH at most
    int lanes;           // that they take
    int n_super, *super; // the reach, in ascending order
    int size;            // of a column
    double work;         // multiplications that they took
    double *value;       // (size * lanes)
};

// Of as many GROUPS of right-hand sides as SOLVES, COLUMNS (groups) in each, BATCH at
// most. Column c of group g has in COUNT rows, INDEX[(g * BATCH + c) * count + k], the
// VALUE there; in a row -1 nothing. The caller frees each of them (groups) with
// forward_solves_free.
enum { MOST_SOLVES = 4 };
void supernodal_forward_solves(struct supernodal *factor, int groups,
                               const int *columns, int count, const int *index,
                               const double *value, struct forward_solves *solves);
void forward_solves_free(struct forward_solves *solves);

// PRODUCT[k * b->columns + l] of column k of A and l of B, which may be the same.
void forward_solves_product(const struct supernodal *factor,
                            const struct forward_solves *a,
                            const struct forward_solves *b, double *product);

// PRODUCT[k] of column k with HALF (n), and HALF less the columns times SHARE
// (columns).
void forward_solves_apply(const struct supernodal *factor,
                          const struct forward_solves *solves, const double *half,
                          double *product);
void forward_solves_subtract(const struct supernodal *factor,
                             const struct forward_solves *solves, const double *share,
                             double *half);

#endif
