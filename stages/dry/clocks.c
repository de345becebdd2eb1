// SPDX-License-Identifier: GPL-3.0-or-later
#include "clocks.h"

#include "basics/memory.h"
#include "losses.h"

#include <stdlib.h>
#include <string.h>

// Throats that have this part of their volume left, or less, when another empties would
// have emptied with it but for rounding.
static const double TIE = 1e-12;

// What a node that is linked to the air charges an account with, of what it evaporates.
struct charge {
    double share;
    int node, owner;
    int incidence; // of a throat of the account at the node
};

// --- who loses ---------------------------------------------------------------------

// Where THROAT is or belongs among the N that lose.
static int losing_place(const struct clocks *clocks, int n, int throat)
{
    int low = 0, high = n;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (clocks->losing[middle] < throat)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

// Of the throat that the account is to lose from.
static int start_clock(struct clocks *clocks, int owner)
{
    const int throat = clocks->by_throat
                           ? owner
                           : clusters_invasion_throat(&clocks->phases->clusters, owner);
    const int n = clocks->n++, place = losing_place(clocks, n, throat);
    memmove(clocks->losing + place + 1, clocks->losing + place,
            (size_t)(n - place) * sizeof *clocks->losing);
    clocks->losing[place] = throat;
    clocks->owner[n] = owner;
    clocks->throat[n] = throat;
    clocks->rate[n] = 0;
    clocks->left[n] = clocks->saturation[throat] * clocks->phases->volume[throat];
    clocks->left_lost[n] = 0;
    clocks->nothing[n] = TIE * clocks->phases->volume[throat];
    return n;
}

static void stop_clock(struct clocks *clocks, int clock)
{
    const int last = --clocks->n, throat = clocks->throat[clock];
    const int place = losing_place(clocks, clocks->n + 1, throat);
    memmove(clocks->losing + place, clocks->losing + place + 1,
            (size_t)(last - place) * sizeof *clocks->losing);
    clocks->saturation[throat] = (clocks->left[clock] + clocks->left_lost[clock]) /
                                 clocks->phases->volume[throat];
    clocks->clock[clocks->owner[clock]] = -1;
    if (clock == last) return;
    clocks->owner[clock] = clocks->owner[last];
    clocks->throat[clock] = clocks->throat[last];
    clocks->rate[clock] = clocks->rate[last];
    clocks->left[clock] = clocks->left[last];
    clocks->left_lost[clock] = clocks->left_lost[last];
    clocks->nothing[clock] = clocks->nothing[last];
    clocks->clock[clocks->owner[clock]] = clock;
}

// --- charges -----------------------------------------------------------------------

static int owner_of(const struct clocks *clocks, int throat)
{
    return clocks->by_throat ? throat : clocks->phases->clusters.of_throat[throat];
}

static void remove_charge(struct clocks *clocks, int place)
{
    const struct charge *last = &clocks->charge[--clocks->n_charge];
    clocks->charge_place[last->incidence] = place;
    clocks->charge_place[clocks->charge[place].incidence] = -1;
    clocks->charge[place] = *last;
}

// To an account that the node charges already, or a new one.
static void add_charge(struct clocks *clocks, int node, int incidence, double share)
{
    const int *throat = clocks->phases->incidence.throat;
    const int owner = owner_of(clocks, throat[incidence]);
    for (int k = clocks->phases->incidence.offset[node]; k < incidence; k++) {
        const int place = clocks->charge_place[k];
        if (place < 0 || clocks->charge[place].owner != owner) continue;
        clocks->charge[place].share += share;
        return;
    }
    clocks->charge_place[incidence] = clocks->n_charge;
    GROW_ARRAY(clocks->charge, clocks->n_charge, clocks->charge_capacity);
    clocks->charge[clocks->n_charge++] = (struct charge){share, node, owner, incidence};
}

// By the throats that hold liquid now: shares are proportional to their cross-sections.
static void charge_node(struct clocks *clocks, int node)
{
    const struct phases *phases = clocks->phases;
    const int begin = phases->incidence.offset[node];
    const int end = phases->incidence.offset[node + 1];
    double sum = 0;
    for (int k = begin; k < end; k++) {
        if (clocks->charge_place[k] >= 0)
            remove_charge(clocks, clocks->charge_place[k]);
        sum += liquid_section(phases, phases->incidence.throat[k]);
    }
    if (!(vapour_evaporation(&phases->vapour, node) > 0)) return;
    for (int k = begin; k < end; k++) {
        const double section = liquid_section(phases, phases->incidence.throat[k]);
        if (section > 0) add_charge(clocks, node, k, section / sum);
    }
}

static void charge_ends(struct clocks *clocks, int throat)
{
    for (int end = 0; end < 2; end++)
        charge_node(clocks, clocks->phases->network->throat_nodes[throat][end]);
}

// --- the clocks --------------------------------------------------------------------

// All rates anew: sums of positive numbers, so that nothing is lost.
static void set_rates(struct clocks *clocks)
{
    struct star_mesh *mesh = &clocks->phases->vapour.mesh;
    for (int k = 0; k < mesh->n_linked; k++)
        charge_node(clocks, mesh->linked[k]);
    mesh->n_linked = 0;
    memset(clocks->rate, 0, (size_t)clocks->n * sizeof *clocks->rate);
    for (int k = 0; k < clocks->n_charge; k++) {
        const struct charge *charge = &clocks->charge[k];
        const double amount = charge->share * mesh->air[charge->node];
        if (!(amount > 0)) continue;
        int *clock = &clocks->clock[charge->owner];
        if (*clock < 0) *clock = start_clock(clocks, charge->owner);
        clocks->rate[*clock] += amount;
    }
}

struct clocks clocks_make(struct phases *phases, bool by_throat)
{
    const int n = phases->network->n_throat;
    struct clocks clocks = {.phases = phases,
                            .by_throat = by_throat,
                            .charge_place = NEW_ARRAY(int, 2 * (size_t)n),
                            .clock = NEW_ARRAY(int, n),
                            .owner = NEW_ARRAY(int, n),
                            .throat = NEW_ARRAY(int, n),
                            .rate = NEW_ARRAY(double, n),
                            .left = NEW_ARRAY(double, n),
                            .left_lost = NEW_ARRAY(double, n),
                            .nothing = NEW_ARRAY(double, n),
                            .losing = NEW_ARRAY(int, n),
                            .saturation = NEW_ARRAY(double, n)};
    for (int t = 0; t < n; t++) {
        clocks.saturation[t] = phases_saturation(phases, t);
        clocks.clock[t] = -1;
        clocks.charge_place[2 * t] = clocks.charge_place[2 * t + 1] = -1;
    }
    for (int k = 0; k < phases->n_wet; k++)
        charge_node(&clocks, phases->wet[k]);
    phases->vapour.mesh.n_linked = 0;
    set_rates(&clocks);
    return clocks;
}

void clocks_free(struct clocks *clocks)
{
    free(clocks->charge);
    free(clocks->charge_place);
    free(clocks->clock);
    free(clocks->owner);
    free(clocks->throat);
    free(clocks->rate);
    free(clocks->left);
    free(clocks->left_lost);
    free(clocks->nothing);
    free(clocks->losing);
    free(clocks->saturation);
    free(clocks->ended);
    *clocks = (struct clocks){0};
}

double clocks_saturation(const struct clocks *clocks, int throat)
{
    const int owner = owner_of(clocks, throat);
    if (owner < 0) return 0;
    const int clock = clocks->clock[owner];
    if (clock < 0 || clocks->throat[clock] != throat) return clocks->saturation[throat];
    return (clocks->left[clock] + clocks->left_lost[clock]) /
           clocks->phases->volume[throat];
}

double clocks_imbalance(const struct clocks *clocks)
{
    const struct vapour *vapour = &clocks->phases->vapour;
    const double rate = vapour_rate(vapour);
    struct compensated sum = {.value = -rate};
    for (int k = 0; k < clocks->n; k++)
        compensated_add(&sum, clocks->rate[k]);
    return clocks->n > 0 ? compensated_value(sum) / rate : 0;
}

// --- events ------------------------------------------------------------------------

// INFINITY if none loses. Four at a time: they share a division.
static double time_to_first(const struct clocks *clocks)
{
    enum { LANES = 4 };
    double shortest[LANES] = {INFINITY, INFINITY, INFINITY, INFINITY};
    int k = 0;
    for (; k + LANES <= clocks->n; k += LANES)
        for (int l = 0; l < LANES; l++) {
            const double time = clocks->left[k + l] / clocks->rate[k + l];
            shortest[l] = time < shortest[l] ? time : shortest[l];
        }
    for (; k < clocks->n; k++)
        shortest[0] = fmin(shortest[0], clocks->left[k] / clocks->rate[k]);
    return fmin(fmin(shortest[0], shortest[1]), fmin(shortest[2], shortest[3]));
}

// Two-sum: what is rounded off LEFT is kept beside it.
static void pass(struct clocks *clocks, double duration)
{
    double *restrict left = clocks->left, *restrict lost = clocks->left_lost;
    const double *restrict rate = clocks->rate;
    for (int k = 0; k < clocks->n; k++) {
        const double amount = lost[k] - rate[k] * duration;
        const double after = left[k] + amount, back = after - left[k];
        lost[k] = (left[k] - (after - back)) + (amount - back);
        left[k] = after;
    }
}

static int compare_numbers(const void *a, const void *b)
{
    const int *m = a, *n = b;
    return (*m > *n) - (*m < *n);
}

// Those that have lost all.
static void end_throats(struct clocks *clocks)
{
    struct phases *phases = clocks->phases;
    clocks->n_ended = 0;
    for (int k = 0; k < clocks->n; k++) {
        if (clocks->left[k] > clocks->nothing[k]) continue;
        compensated_add(&phases->total_liquid, -clocks->left[k]);
        compensated_add(&phases->total_liquid, -clocks->left_lost[k]);
        clocks->left[k] = clocks->left_lost[k] = 0;
        GROW_ARRAY(clocks->ended, clocks->n_ended, clocks->ended_capacity);
        clocks->ended[clocks->n_ended++] = clocks->throat[k];
    }
    if (clocks->n_ended > 1)
        qsort(clocks->ended, (size_t)clocks->n_ended, sizeof *clocks->ended,
              compare_numbers);
}

double clocks_advance(struct clocks *clocks)
{
    struct phases *phases = clocks->phases;
    const double span = time_to_first(clocks);
    if (span == INFINITY) return -1;
    compensated_add(&phases->total_liquid, -vapour_rate(&phases->vapour) * span);
    pass(clocks, span);
    end_throats(clocks);
    return span;
}

static void empty_throat(struct clocks *clocks, int throat)
{
    const struct clusters *clusters = &clocks->phases->clusters;
    stop_clock(clocks, clocks->clock[owner_of(clocks, throat)]);
    phases_empty_throat(clocks->phases, throat);
    charge_ends(clocks, throat);
    for (int k = 0; k < clusters->n_moved; k++)
        charge_ends(clocks, clusters->moved[k]);
}

void clocks_empty_ended(struct clocks *clocks)
{
    for (int k = 0; k < clocks->n_ended; k++)
        empty_throat(clocks, clocks->ended[k]);
    set_rates(clocks);
}

// --- state -------------------------------------------------------------------------

static void charges_state(struct clocks *clocks, struct state *state)
{
    const struct network *network = clocks->phases->network;
    const int n_incidence = 2 * network->n_throat;
    int64_t n = clocks->n_charge;
    clocks->charge = state_room(state, clocks->charge, &n, sizeof *clocks->charge);
    if (state->restoring) clocks->n_charge = clocks->charge_capacity = (int)n;
    for (int k = 0; k < clocks->n_charge; k++) {
        struct charge *charge = &clocks->charge[k];
        state_numbers(state, &charge->share, 1);
        state_integer(state, &charge->node, 0, network->n_node - 1);
        state_integer(state, &charge->owner, 0, network->n_throat - 1);
        state_integer(state, &charge->incidence, 0, n_incidence - 1);
    }
    state_integers(state, clocks->charge_place, n_incidence, -1, (int)n - 1);
}

void clocks_state(struct clocks *clocks, struct state *state)
{
    const struct network *network = clocks->phases->network;
    const int n_throat = network->n_throat;
    if (state->restoring)
        for (int k = 0; k < clocks->n; k++)
            clocks->clock[clocks->owner[k]] = -1;
    state_integer(state, &clocks->n, 0, n_throat);
    charges_state(clocks, state);
    state_integers(state, clocks->owner, clocks->n, 0, n_throat - 1);
    state_integers(state, clocks->throat, clocks->n, 0, n_throat - 1);
    state_integers(state, clocks->losing, clocks->n, 0, n_throat - 1);
    state_numbers(state, clocks->rate, clocks->n);
    state_numbers(state, clocks->left, clocks->n);
    state_numbers(state, clocks->left_lost, clocks->n);
    state_numbers(state, clocks->saturation, n_throat);
    if (!state->restoring) return;
    for (int k = 0; k < clocks->n; k++) {
        clocks->clock[clocks->owner[k]] = k;
        clocks->nothing[k] = TIE * clocks->phases->volume[clocks->throat[k]];
    }
}
