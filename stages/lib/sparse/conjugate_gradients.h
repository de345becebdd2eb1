// SPDX-License-Identifier: GPL-3.0-or-later
// Preconditioned conjugate gradients.
#ifndef CRAQUELURE_CONJUGATE_GRADIENTS_H
#define CRAQUELURE_CONJUGATE_GRADIENTS_H

// A symmetric positive definite matrix of N rows, and one whose inverse is near its.
struct linear_problem {
    int n;
    void *context; // given to both
    void (*multiply)(void *context, const double *x, double *image);
    void (*precondition)(void *context, const double *residual, double *z);
    double *work[3]; // (n) each, overwritten
};

// Solves from X = 0 until the norm of what RESIDUAL (n) lacks, first the right side, is
// TOLERANCE or less, or after MOST iterations, or when the preconditioner proves not
// positive definite. RESIDUAL comes back as it follows from step to step. Returns how
// many iterations were done. The same digits for any number of threads.
int conjugate_gradients(const struct linear_problem *problem, double *residual,
                        double *x, double tolerance, int most);

// The same for what is still lacking after an earlier call with the same work, in any
// unit: goes on from its last direction, nearly as if it had not been interrupted.
int resume_conjugate_gradients(const struct linear_problem *problem, double *residual,
                               double *x, double tolerance, int most);

// A sum in blocks of fixed length: the same for any number of threads.
double sum_of_products(const double *x, const double *y, int n);

#endif
