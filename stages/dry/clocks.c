// SPDX-License-Identifier: GPL-3.0-or-later
#include "clocks.h"

#include "basics/memory.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

// Throats that have this part of their volume left, or less, when another empties would
// have emptied with it but for rounding.
static const double TIE = 1e-12;

struct account {
    int n_charge;            // that are above 0
    struct compensated rate; // their sum
    int clock;               // -1: none runs
    bool touched;
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

static void start_clock(struct clocks *clocks, int owner, int throat)
{
    const int n = clocks->n++, place = losing_place(clocks, n, throat);
    memmove(clocks->losing + place + 1, clocks->losing + place,
            (size_t)(n - place) * sizeof *clocks->losing);
    clocks->losing[place] = throat;
    clocks->account[owner].clock = n;
    clocks->owner[n] = owner;
    clocks->throat[n] = throat;
    clocks->left[n] = clocks->saturation[throat] * clocks->phases->volume[throat];
    clocks->left_lost[n] = 0;
}

static void stop_clock(struct clocks *clocks, int clock)
{
    const int last = --clocks->n, throat = clocks->throat[clock];
    const int place = losing_place(clocks, clocks->n + 1, throat);
    memmove(clocks->losing + place, clocks->losing + place + 1,
            (size_t)(last - place) * sizeof *clocks->losing);
    clocks->saturation[throat] = (clocks->left[clock] + clocks->left_lost[clock]) /
                                 clocks->phases->volume[throat];
    clocks->account[clocks->owner[clock]].clock = -1;
    if (clock == last) return;
    clocks->owner[clock] = clocks->owner[last];
    clocks->throat[clock] = clocks->throat[last];
    clocks->rate[clock] = clocks->rate[last];
    clocks->left[clock] = clocks->left[last];
    clocks->left_lost[clock] = clocks->left_lost[last];
    clocks->account[clocks->owner[clock]].clock = clock;
}

// --- charges -----------------------------------------------------------------------

static struct account *touch(struct clocks *clocks, int owner)
{
    while (owner >= clocks->n_account) {
        GROW_ARRAY(clocks->account, clocks->n_account, clocks->account_capacity);
        clocks->account[clocks->n_account++] = (struct account){.clock = -1};
    }
    struct account *account = &clocks->account[owner];
    if (!account->touched) clocks->touched[clocks->n_touched++] = owner;
    account->touched = true;
    return account;
}

static int owner_of(const struct clocks *clocks, int throat)
{
    return clocks->by_throat ? throat : clocks->phases->clusters.of_throat[throat];
}

static void charge(struct account *account, double amount)
{
    compensated_add(&account->rate, amount);
    account->n_charge += amount > 0 ? 1 : -1;
    if (account->n_charge == 0) account->rate = (struct compensated){0};
}

static void recharge(struct account *account, double before, double now)
{
    if (now > 0) charge(account, now);
    if (before > 0) charge(account, -before);
}

// The one account of all the throats with liquid at the node, -1 if there are several.
static int sole_owner(const struct clocks *clocks, int node)
{
    const struct incidence *incidence = &clocks->phases->incidence;
    int sole = -1;
    for (int k = incidence->offset[node]; k < incidence->offset[node + 1]; k++) {
        if (clocks->share[k] == 0) continue;
        const int owner = owner_of(clocks, incidence->throat[k]);
        if (sole >= 0 && owner != sole) return -1;
        sole = owner;
    }
    return sole;
}

// What the node evaporates now is charged instead of what was before.
static void charge_node(struct clocks *clocks, int node, double evaporation)
{
    const struct incidence *incidence = &clocks->phases->incidence;
    const double before = clocks->charged[node];
    if (evaporation == before) return;
    if (before == 0) clocks->sole[node] = sole_owner(clocks, node);
    clocks->charged[node] = evaporation;
    if (clocks->sole[node] >= 0) {
        recharge(touch(clocks, clocks->sole[node]), before, evaporation);
        return;
    }
    for (int k = incidence->offset[node]; k < incidence->offset[node + 1]; k++)
        if (clocks->share[k] > 0)
            recharge(touch(clocks, owner_of(clocks, incidence->throat[k])),
                     before * clocks->share[k], evaporation * clocks->share[k]);
}

// Shares are proportional to the cross-sections of the throats that hold liquid.
static void share_node(struct clocks *clocks, int node)
{
    const struct phases *phases = clocks->phases;
    const int begin = phases->incidence.offset[node];
    const int end = phases->incidence.offset[node + 1];
    double sum = 0;
    for (int k = begin; k < end; k++) {
        const int throat = phases->incidence.throat[k];
        clocks->share[k] =
            phases->clusters.of_throat[throat] < 0
                ? 0
                : phases->volume[throat] / phases->network->throat_length[throat];
        sum += clocks->share[k];
    }
    for (int k = begin; k < end; k++)
        clocks->share[k] /= sum > 0 ? sum : 1;
}

// The charges of a throat that has left cluster FROM go with it. Where the node was
// charged as a whole, it is free to be charged anew.
static void move_charges(struct clocks *clocks, int throat, int from)
{
    const struct phases *phases = clocks->phases;
    for (int end = 0; end < 2; end++) {
        const int node = phases->network->throat_nodes[throat][end];
        if (!(clocks->charged[node] > 0)) continue;
        if (clocks->sole[node] >= 0) {
            charge_node(clocks, node, 0);
            continue;
        }
        int k = phases->incidence.offset[node];
        while (phases->incidence.throat[k] != throat)
            k++;
        const double amount = clocks->charged[node] * clocks->share[k];
        charge(touch(clocks, owner_of(clocks, throat)), amount);
        charge(touch(clocks, from), -amount);
    }
}

static void charge_ends(struct clocks *clocks, int throat)
{
    for (int end = 0; end < 2; end++) {
        const int node = clocks->phases->network->throat_nodes[throat][end];
        charge_node(clocks, node, vapour_evaporation(&clocks->phases->vapour, node));
    }
}

// --- the clocks --------------------------------------------------------------------

static int throat_of(const struct clocks *clocks, int owner)
{
    struct clusters *clusters = &clocks->phases->clusters;
    if (clocks->by_throat) return clusters->of_throat[owner] < 0 ? -1 : owner;
    return clusters->size[owner] > 0 ? clusters_invasion_throat(clusters, owner) : -1;
}

static void set_clock(struct clocks *clocks, int owner)
{
    struct account *account = &clocks->account[owner];
    account->touched = false;
    const double rate = compensated_value(account->rate);
    if (account->clock >= 0) {
        const int throat = clocks->throat[account->clock];
        if (!(rate > 0) || owner_of(clocks, throat) != owner)
            stop_clock(clocks, account->clock);
    }
    if (!(rate > 0)) return;
    if (account->clock < 0) {
        const int throat = throat_of(clocks, owner);
        if (throat < 0) return;
        start_clock(clocks, owner, throat);
    }
    clocks->rate[account->clock] = rate;
}

static void set_touched(struct clocks *clocks)
{
    for (int k = 0; k < clocks->n_touched; k++)
        set_clock(clocks, clocks->touched[k]);
    clocks->n_touched = 0;
}

struct clocks clocks_make(struct phases *phases, bool by_throat)
{
    const int n = phases->network->n_throat;
    struct clocks clocks = {.phases = phases,
                            .by_throat = by_throat,
                            .charged = NEW_ARRAY(double, phases->network->n_node),
                            .sole = NEW_ARRAY(int, phases->network->n_node),
                            .share = NEW_ARRAY(double, 2 * (size_t)n),
                            .touched = NEW_ARRAY(int, n),
                            .owner = NEW_ARRAY(int, n),
                            .throat = NEW_ARRAY(int, n),
                            .rate = NEW_ARRAY(double, n),
                            .left = NEW_ARRAY(double, n),
                            .left_lost = NEW_ARRAY(double, n),
                            .losing = NEW_ARRAY(int, n),
                            .saturation = NEW_ARRAY(double, n)};
    for (int t = 0; t < n; t++)
        clocks.saturation[t] = phases_saturation(phases, t);
    for (int i = 0; i < phases->network->n_node; i++)
        share_node(&clocks, i);
    for (int k = 0; k < phases->n_wet; k++)
        charge_node(&clocks, phases->wet[k],
                    vapour_evaporation(&phases->vapour, phases->wet[k]));
    set_touched(&clocks);
    return clocks;
}

void clocks_free(struct clocks *clocks)
{
    free(clocks->charged);
    free(clocks->sole);
    free(clocks->share);
    free(clocks->account);
    free(clocks->touched);
    free(clocks->owner);
    free(clocks->throat);
    free(clocks->rate);
    free(clocks->left);
    free(clocks->left_lost);
    free(clocks->losing);
    free(clocks->saturation);
    free(clocks->ended);
    *clocks = (struct clocks){0};
}

double clocks_saturation(const struct clocks *clocks, int throat)
{
    const int owner = owner_of(clocks, throat);
    if (owner < 0) return 0;
    const int clock = owner < clocks->n_account ? clocks->account[owner].clock : -1;
    if (clock < 0 || clocks->throat[clock] != throat) return clocks->saturation[throat];
    return (clocks->left[clock] + clocks->left_lost[clock]) /
           clocks->phases->volume[throat];
}

double clocks_imbalance(const struct clocks *clocks)
{
    const struct vapour *vapour = &clocks->phases->vapour;
    const double rate = vapour_rate(vapour) / vapour_scale(vapour);
    struct compensated sum = {.value = -rate};
    for (int k = 0; k < clocks->n; k++)
        compensated_add(&sum, clocks->rate[k]);
    return clocks->n > 0 ? compensated_value(sum) / rate : 0;
}

// --- events ------------------------------------------------------------------------

static double time_to_first(const struct clocks *clocks)
{
    double shortest = INFINITY;
    for (int k = 0; k < clocks->n; k++) {
        const double time = clocks->left[k] / clocks->rate[k];
        shortest = time < shortest ? time : shortest;
    }
    return shortest;
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
        const int throat = clocks->throat[k];
        if (clocks->left[k] > TIE * phases->volume[throat]) continue;
        compensated_add(&phases->total_liquid, -clocks->left[k]);
        compensated_add(&phases->total_liquid, -clocks->left_lost[k]);
        clocks->left[k] = clocks->left_lost[k] = 0;
        GROW_ARRAY(clocks->ended, clocks->n_ended, clocks->ended_capacity);
        clocks->ended[clocks->n_ended++] = throat;
    }
    if (clocks->n_ended > 1)
        qsort(clocks->ended, (size_t)clocks->n_ended, sizeof *clocks->ended,
              compare_numbers);
}

double clocks_advance(struct clocks *clocks)
{
    struct phases *phases = clocks->phases;
    if (clocks->n == 0) return -1;
    const double span = time_to_first(clocks);
    const double duration = span / vapour_scale(&phases->vapour);
    compensated_add(&phases->total_liquid, -vapour_rate(&phases->vapour) * duration);
    pass(clocks, span);
    end_throats(clocks);
    return duration;
}

static void empty_throat(struct clocks *clocks, int throat)
{
    struct phases *phases = clocks->phases;
    const int32_t *node = phases->network->throat_nodes[throat];
    const int owner = owner_of(clocks, throat);
    for (int end = 0; end < 2; end++)
        charge_node(clocks, node[end], 0);
    phases_empty_throat(phases, throat);
    for (int end = 0; end < 2; end++)
        share_node(clocks, node[end]);
    const struct clusters *clusters = &phases->clusters;
    const int n_moved = clocks->by_throat ? 0 : clusters->n_moved;
    for (int k = 0; k < n_moved; k++)
        move_charges(clocks, clusters->moved[k], owner);
    for (int k = 0; k < n_moved; k++)
        charge_ends(clocks, clusters->moved[k]);
    charge_ends(clocks, throat);
}

bool clocks_empty_ended(struct clocks *clocks)
{
    struct phases *phases = clocks->phases;
    struct vapour *vapour = &phases->vapour;
    for (int k = 0; k < clocks->n_ended; k++) {
        touch(clocks, owner_of(clocks, clocks->ended[k]));
        empty_throat(clocks, clocks->ended[k]);
    }
    const bool is_settled = vapour_settle(vapour);
    int n_changed;
    const int *changed = vapour_changes(vapour, &n_changed);
    for (int k = 0; k < n_changed; k++)
        charge_node(clocks, changed[k], vapour_evaporation(vapour, changed[k]));
    vapour_forget_changes(vapour);
    set_touched(clocks);
    return is_settled;
}

// --- state -------------------------------------------------------------------------

static void accounts_state(struct clocks *clocks, struct state *state)
{
    int64_t n = clocks->n_account;
    clocks->account = state_room(state, clocks->account, &n, sizeof *clocks->account);
    if (state->restoring) clocks->n_account = clocks->account_capacity = (int)n;
    for (int k = 0; k < clocks->n_account; k++) {
        struct account *account = &clocks->account[k];
        state_integer(state, &account->n_charge, 0, INT_MAX);
        state_sums(state, &account->rate, 1);
        state_integer(state, &account->clock, -1, clocks->n - 1);
        account->touched = false;
    }
}

void clocks_state(struct clocks *clocks, struct state *state)
{
    const struct network *network = clocks->phases->network;
    state_integer(state, &clocks->n, 0, network->n_throat);
    accounts_state(clocks, state);
    state_numbers(state, clocks->charged, network->n_node);
    state_integers(state, clocks->sole, network->n_node, -1, clocks->n_account - 1);
    state_numbers(state, clocks->share, 2 * (int64_t)network->n_throat);
    state_integers(state, clocks->owner, clocks->n, 0, clocks->n_account - 1);
    state_integers(state, clocks->throat, clocks->n, 0, network->n_throat - 1);
    state_integers(state, clocks->losing, clocks->n, 0, network->n_throat - 1);
    state_numbers(state, clocks->rate, clocks->n);
    state_numbers(state, clocks->left, clocks->n);
    state_numbers(state, clocks->left_lost, clocks->n);
    state_numbers(state, clocks->saturation, network->n_throat);
}
