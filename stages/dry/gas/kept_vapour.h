// SPDX-License-Identifier: GPL-3.0-or-later
// The vapour's potentials, kept from one dried node to the next, for fronts so wide
// that their links (elimination/kron_fronts.h) are too many. A node that dries changes
// potentials near it at once, and those far away later.
//
// Potentials phi are 0 at wet nodes and 1 in the air. A dry node i takes in more than
// it passes on,
//     residual_i = sum_j conductance_ij (phi_j - phi_i) >= 0,
// until what is on its way there has reached the wet nodes or the air. So the exact
// rate lies between
//     evaporation <= rate <= evaporation + sum of residuals,
// and errors of what wet nodes evaporate add up to the sum of residuals at most. When
// this is more than STEP of the evaporation, all potentials are found again.
#pragma once

#include "elimination/air_links.h"
#include "gas_preconditioner.h"

// It owns its arrays. Sites are as in struct vapour; all is scaled (conditions.h).
struct kept_vapour {
    double step;
    struct air_links air; // what each wet site evaporates

    // Links of all sites, those of throats with liquid below 0; the air is site n. The
    // diagonal is that of sites in the gas.
    struct conductance_matrix links;
    int n_beside_air;
    int *beside_air;           // (n_beside_air) sites with links to the air
    struct compensated *level; // (n) phi, 0 outside the gas
    double *residual;          // (n) 0 outside the gas
    double on_its_way;         // sum of residuals
    double below_zero;         // of those below 0: rounding and what a solution leaves
    double reaches_wet;  // share of what was on its way that came to wet sites, at the
                         // last solution
    int n_row;           // sites in the gas: sorted, then in the order in which they
                         // came into it
    int *row_site, *row; // (n_row), and (n) the place of each; -1: none
    int *order;          // (n) all sites, near ones after each other

    int n_dried;
    int *dried; // (n_dried) sites that have dried since the last _follow
    int n_gain;
    int *gain_site; // (n_gain) wet sites that evaporate more since then
    double *gain;   // (n) how much; 0 elsewhere

    int n_queue, queue_head;
    int *queue;      // (n) a ring of sites with much on its way
    bool *is_queued; // (n)

    struct conductance_matrix balances;        // of the rows, when they were last found
    struct gas_preconditioner *preconditioner; // NULL: to be made
    int solutions;                             // with its inner rows
    double cost; // what they and these took, in iterations
    bool failed; // potentials were not found
};

// The air is not.
static inline bool is_in_gas(const struct kept_vapour *kept, int site)
{
    return site < kept->links.n && kept->row[site] >= 0;
}

// Sites up to N_WET hold liquid, those from there to N_SITE are in the gas. The first
// N_OPEN of N_LINK links are open, the others lead through throats with liquid; site
// N_SITE is the air. Takes over ORDER (n_site): near sites after each other, so that
// memory is read nearly in order. STEP > 0. Finds the potentials. The caller frees it
// with kept_vapour_free.
struct kept_vapour *kept_vapour_create(int n_wet, int n_site, int n_link, int n_open,
                                       const struct link *link, int *order,
                                       double step);
void kept_vapour_free(struct kept_vapour *kept);

// A throat of CONDUCTANCE between A and B has emptied. SITE has dried, and counts as
// wet until _follow.
void kept_vapour_open(struct kept_vapour *kept, int a, int b, double conductance);
void kept_vapour_dry(struct kept_vapour *kept, int site);

// Lets the vapour follow. Returns whether all potentials were found again; else only
// the sites with a gain evaporate more.
bool kept_vapour_follow(struct kept_vapour *kept);

// Rate over evaporation, if the same share of what is on its way reaches wet sites as
// at the last solution: from 1 to 1 + STEP.
double kept_vapour_pace(const struct kept_vapour *kept);

// Whether the state between two events may be kept now: there is no factor.
bool kept_vapour_may_be_kept(const struct kept_vapour *kept);

// Keeps or restores all but what was given to _create.
void kept_vapour_state(struct kept_vapour *kept, struct checkpoint_stream *stream);

// Whether a restored state is one of potentials.
bool kept_vapour_fits(const struct kept_vapour *kept);

// kept_vapour_solve.c: finds all potentials from those of before.
void kept_vapour_solve(struct kept_vapour *kept);

// Largest sum of the errors of what wet sites evaporate.
static inline double kept_vapour_error(const struct kept_vapour *kept)
{
    return kept->on_its_way + 2 * kept->below_zero;
}
