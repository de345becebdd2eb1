// SPDX-License-Identifier: GPL-3.0-or-later
// A fixed point x = G(x) from the last few steps G(x) - x (Anderson 1965): near it, and
// where G is linear, as fast as GMRES (Walker and Ni 2011). No derivative is needed.
// The caller evaluates G, calls anderson_step and adds the step to x; the residual, the
// limit and the failure are the caller's. With f = G(x) - x the next x is x + f - sum_k
// c_k dG_k, c by least squares so that sum_k c_k df_k is nearest to f (anderson.c). Any
// units, if those of all unknowns are alike: the norm adds them up.
//
//     anderson_begin(&anderson, n);
//     do {
//         step_i = G(x)_i - x_i;               the caller's
//         size = norm of step;
//         anderson_step(&anderson, step);
//         x_i += step_i;
//     } while (size > tolerance && count++ < most);
// A step costs O(n ANDERSON_DEPTH). Not safe for threads; G may use some. A step that
// is much larger than the last one drops all that is remembered.
#pragma once

enum { ANDERSON_DEPTH = 20 };

struct anderson {
    int n, n_kept; // unknowns; differences kept, the newest first; -1: no last
    double *last_residual, *last_step; // (n) the last step, as given and as taken
    double norm;                       // of the former
    // (n) each: changes of G(x) - x and of G(x) from one x to the next.
    double *residual_change[ANDERSON_DEPTH], *image_change[ANDERSON_DEPTH];
    double *basis[ANDERSON_DEPTH]; // orthonormal basis of residual_change
};

// Room for up to MOST unknowns. The caller frees it with anderson_free. Room: O(MOST
// ANDERSON_DEPTH).
struct anderson anderson_init(int most);
void anderson_free(struct anderson *anderson);

// Begins a new problem of N unknowns, or another G: forgets all steps.
void anderson_begin(struct anderson *anderson, int n);

// STEP (n) is G(x) - x at the x where the last step led; it becomes the step to take.
// The first step after anderson_begin is G(x) - x itself.
void anderson_step(struct anderson *anderson, double *step);
