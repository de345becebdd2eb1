// SPDX-License-Identifier: GPL-3.0-or-later
// A fixed point x = G(x), found from the last few steps G(x) - x (Anderson 1965): near
// it, and where G is linear, as fast as by GMRES (Walker and Ni 2011).
#ifndef CRAQUELURE_ANDERSON_H
#define CRAQUELURE_ANDERSON_H

enum { ANDERSON_DEPTH = 20 };

struct anderson {
    int n, n_kept;       // unknowns; differences kept, the newest first; -1: no last
    double *last, *sent; // (n) the last step, as given and as taken
    double norm;         // of the former
    // (n) each: of G(x) - x and of G(x), from one x to the next.
    double *fall[ANDERSON_DEPTH], *rise[ANDERSON_DEPTH];
    double *base[ANDERSON_DEPTH]; // of the falls, at right angles
};

// Room for up to MOST unknowns. The caller frees it with anderson_free.
struct anderson anderson_make(int most);
void anderson_free(struct anderson *anderson);

// A new problem of N unknowns, or another G.
void anderson_begin(struct anderson *anderson, int n);

// STEP (n), which leads from where the last one led to G of that, becomes the one to
// take.
void anderson_step(struct anderson *anderson, double *step);

#endif
