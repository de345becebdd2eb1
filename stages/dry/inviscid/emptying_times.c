// SPDX-License-Identifier: GPL-3.0-or-later
#include "emptying_times.h"

#include "basics/memory.h"
#include "basics/sorted.h"
#include "evaporation_shares.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Throats that have this part of their volume left, or less, when another empties would
// have emptied with it but for rounding.
static const double TIE = 1e-12;

// --- who loses ---------------------------------------------------------------------

// From the throat that the account is to lose from.
static void start_clock(struct clocks *clocks, int k)
{
    const int owner = clocks->owner[k];
    const int throat = clocks->by_throat
                           ? owner
                           : clusters_invasion_throat(&clocks->phases->clusters, owner);
    const int place = first_not_below(clocks->losing, clocks->n_losing, throat);
    memmove(clocks->losing + place + 1, clocks->losing + place,
            (size_t)(clocks->n_losing++ - place) * sizeof *clocks->losing);
    clocks->losing[place] = throat;
    clocks->throat[k] = throat;
    clocks->left[k] = clocks->saturation[throat] * clocks->phases->volume[throat];
    clocks->left_lost[k] = 0;
    clocks->since[k] = clocks->now;
    clocks->nothing[k] = TIE * clocks->phases->volume[throat];
}

// Two-sum: what is rounded off LEFT is kept beside it.
static void settle_clock(struct clocks *clocks, int k)
{
    const double left = clocks->left[k];
    const double amount =
        clocks->left_lost[k] - clocks->rate[k] * (clocks->now - clocks->since[k]);
    const double after = left + amount, back = after - left;
    clocks->left_lost[k] = (left - (after - back)) + (amount - back);
    clocks->left[k] = after;
    clocks->since[k] = clocks->now;
}

static void stop_clock(struct clocks *clocks, int k)
{
    const int throat = clocks->throat[k];
    const int place = first_not_below(clocks->losing, clocks->n_losing, throat);
    memmove(clocks->losing + place, clocks->losing + place + 1,
            (size_t)(--clocks->n_losing - place) * sizeof *clocks->losing);
    settle_clock(clocks, k);
    clocks->saturation[throat] =
        (clocks->left[k] + clocks->left_lost[k]) / clocks->phases->volume[throat];
    clocks->throat[k] = -1;
}

// --- rates -------------------------------------------------------------------------

static void settle_all(struct clocks *clocks)
{
    for (int k = 0; k < clocks->n; k++)
        settle_clock(clocks, k);
    for (int k = 0; k < clocks->n; k++)
        clocks->since[k] = 0;
    clocks->now = 0;
}

// Infinite, or no number, without a rate.
static inline void find_end(struct clocks *clocks, int k)
{
    const double each = 1 / clocks->rate[k], left = clocks->left[k];
    clocks->end[k] = clocks->since[k] + left * each;
    clocks->tie[k] = clocks->since[k] + (left - clocks->nothing[k]) * each;
}

static void end_clock(struct clocks *clocks, int k)
{
    if (clocks->throat[k] >= 0) stop_clock(clocks, k);
    clocks->clock[clocks->owner[k]] = -1;
    clocks->owner[k] = -1;
    clocks->has_sum[k] = false;
    clocks->rate[k] = clocks->nothing[k] = 0;
    clocks->left[k] = 1;
    find_end(clocks, k);
    clocks->unused[clocks->n_unused++] = k;
}

// The clocks with other charges than before run on from now.
static void renew_touched(struct clocks *clocks)
{
    for (int l = 0; l < clocks->n_touched; l++) {
        const int k = clocks->touched[l];
        clocks->is_touched[k] = false;
        if (clocks->charges[k] == 0) {
            end_clock(clocks, k);
            continue;
        }
        if (clocks->throat[k] < 0)
            start_clock(clocks, k);
        else
            settle_clock(clocks, k);
        charges_set_rate(clocks, k);
        find_end(clocks, k);
    }
    clocks->n_touched = 0;
}

// ALL_CHANGED: what each node evaporates.
static void set_rates(struct clocks *clocks, bool all_changed)
{
    struct star_mesh *mesh = &clocks->phases->vapour.mesh;
    for (int k = 0; k < mesh->n_linked; k++)
        charge_by_node(clocks, mesh->linked[k]);
    mesh->n_linked = 0;
    const bool all = all_changed || charges_lack_digits(clocks);
    if (all) {
        settle_all(clocks);
        charges_add_up(clocks);
    }
    renew_touched(clocks);
    for (int k = 0; all && k < clocks->n; k++)
        find_end(clocks, k);
}

struct clocks clocks_make(struct phases *phases, bool by_throat)
{
    const int n = phases->network->n_throat;
    struct clocks clocks = {.phases = phases,
                            .by_throat = by_throat,
                            .charge = NEW_ARRAY(struct charge, 2 * (size_t)n),
                            .charge_incidence = NEW_ARRAY(int, 2 * (size_t)n),
                            .charge_place = NEW_ARRAY(int, 2 * (size_t)n),
                            .clock = NEW_ARRAY(int, n),
                            .owner = NEW_ARRAY(int, n),
                            .throat = NEW_ARRAY(int, n),
                            .charges = NEW_ARRAY(int, n),
                            .has_sum = NEW_ARRAY(bool, n),
                            .sum = NEW_ARRAY(struct compensated, n),
                            .summed = NEW_ARRAY(double, n),
                            .rate = NEW_ARRAY(double, n),
                            .left = NEW_ARRAY(double, n),
                            .left_lost = NEW_ARRAY(double, n),
                            .since = NEW_ARRAY(double, n),
                            .nothing = NEW_ARRAY(double, n),
                            .end = NEW_ARRAY(double, n),
                            .tie = NEW_ARRAY(double, n),
                            .saturation = NEW_ARRAY(double, n),
                            .unused = NEW_ARRAY(int, n),
                            .losing = NEW_ARRAY(int, n),
                            .touched = NEW_ARRAY(int, n),
                            .is_touched = NEW_ARRAY(bool, n)};
    for (int t = 0; t < n; t++) {
        clocks.saturation[t] = phases_saturation(phases, t);
        clocks.clock[t] = -1;
        clocks.charge_place[2 * t] = clocks.charge_place[2 * t + 1] = -1;
    }
    for (int k = 0; k < phases->n_wet; k++)
        charge_by_node(&clocks, phases->wet[k]);
    phases->vapour.mesh.n_linked = 0;
    set_rates(&clocks, true);
    return clocks;
}

void clocks_free(struct clocks *clocks)
{
    free(clocks->charge);
    free(clocks->charge_incidence);
    free(clocks->charge_place);
    free(clocks->clock);
    free(clocks->owner);
    free(clocks->throat);
    free(clocks->charges);
    free(clocks->has_sum);
    free(clocks->sum);
    free(clocks->summed);
    free(clocks->rate);
    free(clocks->left);
    free(clocks->left_lost);
    free(clocks->since);
    free(clocks->nothing);
    free(clocks->end);
    free(clocks->tie);
    free(clocks->saturation);
    free(clocks->unused);
    free(clocks->losing);
    free(clocks->touched);
    free(clocks->is_touched);
    free(clocks->ended);
    *clocks = (struct clocks){0};
}

double clocks_saturation(const struct clocks *clocks, int throat)
{
    const int owner = account_of(clocks, throat);
    if (owner < 0) return 0;
    const int k = clocks->clock[owner];
    if (k < 0 || clocks->throat[k] != throat) return clocks->saturation[throat];
    const double lost = clocks->rate[k] * (clocks->now - clocks->since[k]);
    return (clocks->left[k] + (clocks->left_lost[k] - lost)) /
           clocks->phases->volume[throat];
}

double clocks_imbalance(const struct clocks *clocks)
{
    const struct vapour *vapour = &clocks->phases->vapour;
    const double rate = vapour_rate(vapour);
    struct compensated sum = {.value = -rate};
    for (int k = 0; k < clocks->n; k++)
        compensated_add(&sum, clocks->rate[k]);
    return clocks->n_losing > 0 ? compensated_value(sum) / rate : 0;
}

// --- events ------------------------------------------------------------------------

// INFINITY if none loses.
static double first_end(const struct clocks *clocks)
{
    enum { LANES = 16 };
    double first[LANES];
    for (int l = 0; l < LANES; l++)
        first[l] = INFINITY;
    int k = 0;
    for (; k + LANES <= clocks->n; k += LANES)
        for (int l = 0; l < LANES; l++)
            first[l] = clocks->end[k + l] < first[l] ? clocks->end[k + l] : first[l];
    for (; k < clocks->n; k++)
        first[0] = fmin(first[0], clocks->end[k]);
    for (int l = 1; l < LANES; l++)
        first[0] = fmin(first[0], first[l]);
    return first[0];
}

static void end_throat(struct clocks *clocks, int k)
{
    struct phases *phases = clocks->phases;
    settle_clock(clocks, k);
    compensated_add(&phases->total_liquid, -clocks->left[k]);
    compensated_add(&phases->total_liquid, -clocks->left_lost[k]);
    clocks->left[k] = clocks->left_lost[k] = 0;
    GROW_ARRAY(clocks->ended, clocks->n_ended, clocks->ended_capacity);
    clocks->ended[clocks->n_ended++] = clocks->throat[k];
}

// Those that have lost all. Blocks in which none has are passed over in few steps.
static void end_throats(struct clocks *clocks)
{
    enum { BLOCK = 128 };
    clocks->n_ended = 0;
    for (int first = 0; first < clocks->n; first += BLOCK) {
        const int last = first + BLOCK < clocks->n ? first + BLOCK : clocks->n;
        int any = 0;
        for (int k = first; k < last; k++)
            any |= clocks->tie[k] <= clocks->now;
        for (int k = first; any && k < last; k++)
            if (clocks->tie[k] <= clocks->now) end_throat(clocks, k);
    }
    if (clocks->n_ended > 1)
        qsort(clocks->ended, (size_t)clocks->n_ended, sizeof *clocks->ended,
              rising_ints);
}

double clocks_advance(struct clocks *clocks)
{
    struct phases *phases = clocks->phases;
    const double end = first_end(clocks);
    if (end == INFINITY) return -1;
    const double span = end - clocks->now;
    compensated_add(&phases->total_liquid, -vapour_rate(&phases->vapour) * span);
    clocks->now = end;
    end_throats(clocks);
    return span;
}

// Returns whether a node dries.
static bool empty_throat(struct clocks *clocks, int throat)
{
    struct phases *phases = clocks->phases;
    const int k = clocks->clock[account_of(clocks, throat)];
    stop_clock(clocks, k);
    touch_clock(clocks, k);
    phases_empty_throat(phases, throat);
    charge_by_ends(clocks, throat);
    for (int l = 0; l < phases->clusters.n_moved; l++)
        charge_by_ends(clocks, phases->clusters.moved[l]);
    const int32_t *node = phases->network->throat_nodes[throat];
    return phases->liquid_beside[node[0]] == 0 || phases->liquid_beside[node[1]] == 0;
}

void clocks_empty_ended(struct clocks *clocks)
{
    bool dries = false;
    for (int k = 0; k < clocks->n_ended; k++)
        dries |= empty_throat(clocks, clocks->ended[k]);
    set_rates(clocks, dries);
}

// --- state -------------------------------------------------------------------------

void clocks_state(struct clocks *clocks, struct checkpoint_stream *stream)
{
    const int n_throat = clocks->phases->network->n_throat;
    for (int k = 0; stream->restoring && k < clocks->n; k++)
        if (clocks->owner[k] >= 0) clocks->clock[clocks->owner[k]] = -1;
    stream_integer(stream, &clocks->n, 0, n_throat);
    stream_integer(stream, &clocks->n_unused, 0, n_throat);
    stream_integer(stream, &clocks->n_losing, 0, n_throat);
    charges_state(clocks, stream);
    stream_integers(stream, clocks->owner, clocks->n, -1, n_throat - 1);
    stream_integers(stream, clocks->throat, clocks->n, -1, n_throat - 1);
    stream_integers(stream, clocks->charges, clocks->n, 0, clocks->n_charge);
    stream_integers(stream, clocks->unused, clocks->n_unused, 0, clocks->n - 1);
    stream_integers(stream, clocks->losing, clocks->n_losing, 0, n_throat - 1);
    stream_flags(stream, clocks->has_sum, clocks->n);
    stream_sums(stream, clocks->sum, clocks->n);
    stream_numbers(stream, clocks->summed, clocks->n);
    stream_numbers(stream, clocks->rate, clocks->n);
    stream_numbers(stream, clocks->left, clocks->n);
    stream_numbers(stream, clocks->left_lost, clocks->n);
    stream_numbers(stream, clocks->since, clocks->n);
    stream_numbers(stream, &clocks->now, 1);
    stream_numbers(stream, clocks->saturation, n_throat);
    for (int k = 0; stream->restoring && k < clocks->n; k++) {
        if (clocks->owner[k] >= 0) clocks->clock[clocks->owner[k]] = k;
        const int throat = clocks->throat[k];
        clocks->nothing[k] = throat < 0 ? 0 : TIE * clocks->phases->volume[throat];
        find_end(clocks, k);
    }
}
