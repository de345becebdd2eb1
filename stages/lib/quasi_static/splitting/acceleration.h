// SPDX-License-Identifier: GPL-3.0-or-later
// Anderson acceleration (1965) of a fixed point x = G(x), as sparse/anderson.h, but by
// normal equations: a step costs three products and a sum for each step that is kept,
// not their number again. That is a third of an iteration here, where an orthonormal
// basis would be twice the rest. Half of the digits are enough, because G is not
// smooth.
#ifndef CRAQUELURE_ACCELERATION_H
#define CRAQUELURE_ACCELERATION_H

enum { MOST_DEPTH = 24 };

// A ring of the last `depth` changes; `n_kept` is -1 before the first step.
struct acceleration {
    int n, depth, n_kept, newest;
    double *last_residual, *last_step; // (n) the last step, as given and as taken
    double norm;                       // of the former
    // (depth * n): changes of G(x) - x and of G(x).
    double *residual_change, *image_change;
    double gram[MOST_DEPTH][MOST_DEPTH]; // products of residual changes
};

// For N unknowns and DEPTH steps. The caller frees it with acceleration_free.
struct acceleration acceleration_init(int n, int depth);
void acceleration_free(struct acceleration *acceleration);

// Forgets all steps: another G.
void acceleration_begin(struct acceleration *acceleration);

// STEP (n) is G(x) - x at the x where the last step led; it becomes the step to take.
void acceleration_step(struct acceleration *acceleration, double *step);

#endif
