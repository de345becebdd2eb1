// SPDX-License-Identifier: GPL-3.0-or-later
// Preconditioned conjugate gradients, with the same digits for any number of threads.
//
// Each iteration costs one product with A, one preconditioning and a few sums; work[1]
// and work[2] hold the last direction and its product, so a caller that wants to resume
// must not touch them. In exact arithmetic the error falls at least as the powers of
// (sqrt(k) - 1) / (sqrt(k) + 1), k the condition number of M^-1 A.
#pragma once

// A problem with a symmetric positive definite matrix A of N rows, and a preconditioner
// M. MULTIPLY finds A X, PRECONDITION finds Z = M^-1 RESIDUAL. Both must be linear and
// symmetric, and M positive definite; neither may change from call to call. They may
// use threads if their sums have a fixed order.
struct linear_problem {
    int n;
    void *context; // given to both
    void (*multiply)(void *context, const double *x, double *ap);
    void (*precondition)(void *context, const double *residual, double *z);
    double *work[3]; // (n) each, overwritten
};

// Solves from X = 0 until the norm of RESIDUAL (n), at first the right side, is
// TOLERANCE or less, or after MOST iterations, or when the preconditioner proves not
// positive definite. RESIDUAL is returned as updated in each step. Returns the number
// of iterations. The updated residual drifts from B - A X by rounding: whoever needs
// the true one computes it anew. No allocation.
int conjugate_gradients(const struct linear_problem *problem, double *residual,
                        double *x, double tolerance, int most);

// Continues after an earlier call with the same work, for the residual that remains, in
// any unit: begins with its last direction, nearly as if it had not been interrupted.
int resume_conjugate_gradients(const struct linear_problem *problem, double *residual,
                               double *x, double tolerance, int most);

// Sum of x_i y_i in blocks of fixed length: the same for any number of threads. Blocks
// are added in their order, each by one thread.
double sum_of_products(const double *x, const double *y, int n);
