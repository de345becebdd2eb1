// SPDX-License-Identifier: GPL-3.0-or-later
// Cholesky factors of sparse symmetric positive matrices that are factored again and
// again with one pattern. CHOLMOD orders them and finds supernodes; the dense kernels
// are ours, without BLAS, so the same bytes everywhere. README.md says why this stands
// beside CHOLMOD.
//
// How it is used, for any number of matrices of one pattern:
//     struct supernodal *f = supernodal_create(n, start, row);
//     supernodal_factor(f, value);
//     supernodal_forward(f, b, half);
//     supernodal_backward(f, half, x);       A x = b
//     supernodal_free(f);
// With P A P^T = L L^T, P the order of the factor; only `half` is in that order.
// Factors work in memory of their own, so one is for one thread; several may be used
// side by side.
#pragma once

#include <stdbool.h>

struct supernodal;

// Analyses the pattern of N by N matrices whose lower triangle has, in column c, the
// rows ROW[START[c]] to ROW[START[c + 1] - 1]; entries above the diagonal are ignored.
// The caller frees the result with supernodal_free. NULL: N is 0. Rows of a column must
// rise, each once: entries at one place are not added up. START and ROW are copied as
// needed.
struct supernodal *supernodal_create(int n, const int *start, const int *row);
void supernodal_free(struct supernodal *factor);

// Factors the matrix with VALUE in the order of ROW. A pivot lost to rounding becomes
// one of the size of rounding. Returns false, and has no factor, if a pivot is not
// finite or not above 0. VALUE (start[n]) is only read.
bool supernodal_factor(struct supernodal *factor, const double *value);

// Whether the matrix last factored, with that DIAGONAL (n), was positive definite: no
// pivot was negative or mere rounding.
bool supernodal_is_positive(const struct supernodal *factor, const double *diagonal);

// Number of multiplications of one factorisation. To compare with forward_solves.work:
// when rows of corrections have cost more than a factor, a new one is due.
double supernodal_work(const struct supernodal *factor);

// The two halves of a solution: HALF (n) = L^-1 X, in the order of the factor, and X
// (n) = L^-T HALF.
void supernodal_forward(struct supernodal *factor, const double *x, double *half);
void supernodal_backward(struct supernodal *factor, const double *half, double *x);

// L^-1 of sparse right-hand sides: nonzero only on the reach of their rows, the paths
// from them to the root of the elimination tree. Products of such forward solves are
// entries of B^T A^-1 B.
enum { BATCH = 8 };
// Solutions of one group. Row i of column c, rows counted along the reach, is value[i
// lanes + c]; lanes beyond COLUMNS hold 0.
struct forward_solves {
    int columns;         // BATCH at most
    int lanes;           // that they take
    int n_super, *super; // the reach, in ascending order
    int size;            // of a column
    double work;         // multiplications that they took
    double *value;       // (size * lanes)
};

// Solves for GROUPS of right-hand sides into SOLVES (groups), with COLUMNS (groups) in
// each, BATCH at most. Column c of group g has in its COUNT rows INDEX[(g * BATCH + c)
// * count + k] the VALUE at that place; a row of -1 is skipped. The caller frees each
// of SOLVES with forward_solves_free.
enum { MOST_SOLVES = 4 };
void supernodal_forward_solves(struct supernodal *factor, int groups,
                               const int *columns, int count, const int *index,
                               const double *value, struct forward_solves *solves);
void forward_solves_free(struct forward_solves *solves);

// PRODUCT[k * b->columns + l] = column k of A times column l of B, which may be the
// same. PRODUCT (A columns * B columns). O(rows that both reaches share).
void forward_solves_product(const struct supernodal *factor,
                            const struct forward_solves *a,
                            const struct forward_solves *b, double *product);

// PRODUCT[k] = column k times HALF (n); and HALF minus the columns times SHARE
// (columns).
void forward_solves_apply(const struct supernodal *factor,
                          const struct forward_solves *solves, const double *half,
                          double *product);
void forward_solves_subtract(const struct supernodal *factor,
                             const struct forward_solves *solves, const double *share,
                             double *half);
