// SPDX-License-Identifier: GPL-3.0-or-later
// Anderson acceleration (1965) of a fixed point x = G(x), as sparse/anderson.h, but by
// normal equations: a step costs three products and a sum for each step that is kept,
// not their number again. For a G that costs little, or is not smooth: half of the
// digits are lost where steps are alike.
#pragma once

enum { ANDERSON_NORMAL_DEPTH = 24 };

// A ring of the last `depth` changes; `n_kept` is -1 before the first step.
struct anderson_normal {
    int n, depth, n_kept, newest;
    double *last_residual, *last_step; // (n) the last step, as given and as taken
    double norm;                       // of the former
    // (depth * n): changes of G(x) - x and of G(x).
    double *residual_change, *image_change;
    double gram[ANDERSON_NORMAL_DEPTH]
               [ANDERSON_NORMAL_DEPTH]; // products of residual changes
};

// For N unknowns and DEPTH steps. The caller frees it with anderson_normal_free. DEPTH
// at most ANDERSON_NORMAL_DEPTH. Room: 2 (DEPTH + 1) N numbers.
struct anderson_normal anderson_normal_init(int n, int depth);
void anderson_normal_free(struct anderson_normal *anderson);

// Forgets all steps: another G.
void anderson_normal_begin(struct anderson_normal *anderson);

// STEP (n) is G(x) - x at the x where the last step led; it becomes the step to take.
void anderson_normal_step(struct anderson_normal *anderson, double *step);
