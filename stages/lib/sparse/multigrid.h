// SPDX-License-Identifier: GPL-3.0-or-later
// Potentials in a network of conductances of which some sites are free and all others
// held at 0, by conjugate gradients. What preconditions them: sites are put together in
// groups by their strongest links, these again, and so on; each group moves as one
// [Notay 2010, doi:10.1002/nla.741, K-cycle]. The groups are found once for the whole
// network, what is free may change from solve to solve.
#ifndef CRAQUELURE_MULTIGRID_H
#define CRAQUELURE_MULTIGRID_H

#include <stdbool.h>

struct link {
    int site[2];
    double conductance;
};

struct multigrid_level {
    int n;
    int *begin;          // (n+1) of each site's links
    int *neighbour;      // (begin[n])
    double *conductance; // (begin[n])
    double *ground;      // (n) to sites held at 0
    double *diagonal;    // (n) all conductances of a free site; 0: not free
    int *group;          // (n) site of the next level, ascending; NULL at the last
    int *coarse_link;    // (begin[n]) where it is there; -1: within a group
    double *given, *solution, *residual, *direction[2], *image[2]; // (n) scratch
};

struct multigrid {
    int n_level;
    struct multigrid_level *level; // (n_level) the first has all links
    int *place; // (n) where a site is in the levels: near to those it is linked with
    double *factor; // Cholesky's, of the last level
};

// N sites, SHUNT (n) their conductances to a fixed potential. The caller frees it.
struct multigrid multigrid_make(int n, int n_link, const struct link *link,
                                const double *shunt);

// Takes note of which sites are free now: those whose diagonal on the first level is
// above 0. The caller keeps that up to date.
void multigrid_renew(struct multigrid *multigrid);

// Solves A x = b on the free sites, from X = 0, where A has the diagonal of the first
// level. Arrays by place. Stops when the sum of |b - A x| is LEAST or less; false if
// that takes too many rounds. RESIDUAL begins as b and ends as b - A x. What sites held
// at 0 have in it is passed over.
bool multigrid_solve(struct multigrid *multigrid, double least, double *residual,
                     double *x);

void multigrid_free(struct multigrid *multigrid);

#endif
