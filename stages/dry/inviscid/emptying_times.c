// SPDX-License-Identifier: GPL-3.0-or-later
// Discrete-event simulation of drying without viscous flow [K 3.4.2, steps 1-6]. The
// throat of timer k loses liquid at a constant rate[k] between events:
//     left(t) = left[k] + left_lost[k] - rate[k] (t - since[k]),
//     end[k] = since[k] + left[k] / rate[k],
// and the next event is at the smallest end[k]. Only the timers marked dirty are
// advanced to now and get a new end, unless a node dries: that changes all rates.
// left_lost is what rounding takes from left (two-sum), for a throat may be advanced
// many times. Throats whose ends differ by rounding only (TIE of their volume) empty
// together: else rounding would break the symmetry of a lattice.
#include "emptying_times.h"

#include "basics/memory.h"
#include "basics/sorted.h"
#include "evaporation_shares.h"
#include "film_supply.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Throats that have this part of their volume left, or less, when another empties would
// have emptied with it but for rounding.
static const double TIE = 1e-12;

// Timers whose earliest end is kept.
enum { BLOCK = 128 };

struct timer_block {
    double end, tie; // the earliest
    bool is_stale;   // a timer has another end since
};

// Scaled, of a throat or of rings.
static double volume_of(const struct emptying_times *times, int place)
{
    const struct occupancy *occupancy = times->occupancy;
    return is_rings(times, place)
               ? occupancy->rings->at_node[place - occupancy->network->n_throat]
               : occupancy->volume[place];
}

// --- who loses ---------------------------------------------------------------------

// Starts timer K at the throat from which its reservoir loses: the throat itself, or
// the meniscus throat of the cluster that gas enters first.
static void start_timer(struct emptying_times *times, int k)
{
    const int owner = times->owner[k];
    const int throat =
        times->by_throat || is_rings(times, owner)
            ? owner
            : clusters_invasion_throat(&times->occupancy->clusters, owner);
    const int place = first_not_below(times->losing, times->n_losing, throat);
    memmove(times->losing + place + 1, times->losing + place,
            (size_t)(times->n_losing++ - place) * sizeof *times->losing);
    times->losing[place] = throat;
    times->throat[k] = throat;
    times->left[k] = times->saturation[throat] * volume_of(times, throat);
    times->left_lost[k] = 0;
    times->since[k] = times->now;
    times->nothing[k] = TIE * volume_of(times, throat);
}

// Brings LEFT up to now. Two-sum keeps what is rounded off in LEFT_LOST.
static void advance_timer(struct emptying_times *times, int k)
{
    const double left = times->left[k];
    const double amount =
        times->left_lost[k] - times->rate[k] * (times->now - times->since[k]);
    const double after = left + amount, back = after - left;
    times->left_lost[k] = (left - (after - back)) + (amount - back);
    times->left[k] = after;
    times->since[k] = times->now;
}

static void stop_timer(struct emptying_times *times, int k)
{
    const int throat = times->throat[k];
    const int place = first_not_below(times->losing, times->n_losing, throat);
    memmove(times->losing + place, times->losing + place + 1,
            (size_t)(--times->n_losing - place) * sizeof *times->losing);
    advance_timer(times, k);
    times->saturation[throat] =
        (times->left[k] + times->left_lost[k]) / volume_of(times, throat);
    times->throat[k] = -1;
}

// --- rates -------------------------------------------------------------------------

static void advance_all(struct emptying_times *times)
{
    for (int k = 0; k < times->n; k++)
        advance_timer(times, k);
    for (int k = 0; k < times->n; k++)
        times->since[k] = 0;
    times->now = 0;
}

// When timer K ends. Infinite or NaN without a rate; both compare as later than any
// end.
static inline void find_end(struct emptying_times *times, int k)
{
    const double each = 1 / times->rate[k], left = times->left[k];
    times->end[k] = times->since[k] + left * each;
    times->tie[k] = times->since[k] + (left - times->nothing[k]) * each;
}

static void renew_end(struct emptying_times *times, int k)
{
    find_end(times, k);
    times->block[k / BLOCK].is_stale = true;
}

static void renew_all_ends(struct emptying_times *times)
{
    for (int k = 0; k < times->n; k++)
        find_end(times, k);
    for (int k = 0; k < times->n; k += BLOCK)
        times->block[k / BLOCK].is_stale = true;
}

static void end_timer(struct emptying_times *times, int k)
{
    if (times->throat[k] >= 0) stop_timer(times, k);
    times->timer[times->owner[k]] = -1;
    times->owner[k] = -1;
    times->has_sum[k] = false;
    times->rate[k] = times->nothing[k] = 0;
    times->left[k] = 1;
    renew_end(times, k);
    times->unused[times->n_unused++] = k;
}

// Whether the reservoir of timer K loses anything. With films it may stop, and go on
// later with the throat that it has begun to empty.
static bool is_needed(const struct emptying_times *times, int k)
{
    return times->shares[k] > 0 ||
           (times->films &&
            (times->throat[k] >= 0 || times->films->drawn[times->owner[k]] > 0));
}

// Gives timers whose shares have changed their new rates, from now on.
static void renew_dirty(struct emptying_times *times)
{
    for (int l = 0; l < times->n_dirty; l++) {
        const int k = times->dirty[l];
        times->is_dirty[k] = false;
        if (!is_needed(times, k)) {
            end_timer(times, k);
            continue;
        }
        if (times->throat[k] < 0)
            start_timer(times, k);
        else
            advance_timer(times, k);
        evaporation_shares_set_rate(times, k);
        renew_end(times, k);
    }
    times->n_dirty = 0;
}

// If it is time, finds again which clusters films draw from, and gives them timers.
static void find_sources(struct emptying_times *times)
{
    if (film_supply_is_due(times)) film_supply_find(times);
    for (int l = 0; l < times->films->n_source; l++) {
        const int source = times->films->source[l];
        if (source < 0 || !(times->films->drawn[source] > 0)) continue;
        const int k = timer_of(times, source);
        if (times->throat[k] < 0) start_timer(times, k);
    }
}

// What follows in the vapour from nodes that have dried: returns whether what every
// other node evaporates has changed.
static bool follow_vapour(struct emptying_times *times, bool has_dried)
{
    struct kept_vapour *kept = times->occupancy->vapour.kept;
    if (!kept) return has_dried;
    if (kept_vapour_follow(kept)) return true;
    for (int k = 0; k < kept->n_gain; k++)
        share_gain(times, kept->gain_site[k], kept->gain[kept->gain_site[k]]);
    return false;
}

// New rates after an event, in which nodes may have dried. With films each event
// changes the flow in all.
static void set_rates(struct emptying_times *times, bool has_dried)
{
    const bool all_changed = follow_vapour(times, has_dried);
    for (int k = 0; k < times->air->n_reached; k++)
        share_by_node(times, times->air->reached[k]);
    vapour_forget_reached(&times->occupancy->vapour);
    const bool all =
        all_changed || times->films || evaporation_shares_lack_digits(times);
    if (all) {
        advance_all(times);
        evaporation_shares_add_up(times);
    }
    renew_dirty(times);
    if (times->films) {
        find_sources(times);
        film_supply_set_rates(times);
    }
    if (all) renew_all_ends(times);
}

struct emptying_times emptying_times_init(struct occupancy *occupancy, bool by_throat)
{
    const int n_throat = occupancy->network->n_throat;
    const int n = n_place_of(occupancy);
    struct emptying_times times = {
        .occupancy = occupancy,
        .air = vapour_air(&occupancy->vapour),
        .by_throat = by_throat,
        .n_place = n,
        .share = NEW_ARRAY(struct evaporation_share, 2 * (size_t)n),
        .share_incidence = NEW_ARRAY(int, 2 * (size_t)n),
        .share_place = NEW_ARRAY(int, 2 * (size_t)n),
        .timer = NEW_ARRAY(int, n),
        .owner = NEW_ARRAY(int, n),
        .throat = NEW_ARRAY(int, n),
        .shares = NEW_ARRAY(int, n),
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
        .block = NEW_ARRAY(struct timer_block, n / BLOCK + 1),
        .saturation = NEW_ARRAY(double, n),
        .unused = NEW_ARRAY(int, n),
        .losing = NEW_ARRAY(int, n),
        .dirty = NEW_ARRAY(int, n),
        .is_dirty = NEW_ARRAY(bool, n)};
    for (int t = 0; t < n; t++) {
        times.saturation[t] = t < n_throat ? occupancy_saturation(occupancy, t)
                              : occupancy->rings_at_start
                                  ? occupancy->rings_at_start[t - n_throat]
                                  : 1;
        times.timer[t] = -1;
    }
    for (size_t k = 0; k < 2 * (size_t)n; k++)
        times.share_place[k] = -1;
    for (int k = 0; k < occupancy->n_wet; k++)
        share_by_node(&times, occupancy->wet[k]);
    vapour_forget_reached(&occupancy->vapour);
    if (occupancy->film_law) times.films = film_supply_create(&times);
    set_rates(&times, true);
    return times;
}

void emptying_times_free(struct emptying_times *times)
{
    free(times->share);
    free(times->share_incidence);
    free(times->share_place);
    free(times->timer);
    free(times->owner);
    free(times->throat);
    free(times->shares);
    free(times->has_sum);
    free(times->sum);
    free(times->summed);
    free(times->rate);
    free(times->left);
    free(times->left_lost);
    free(times->since);
    free(times->nothing);
    free(times->end);
    free(times->tie);
    free(times->block);
    free(times->saturation);
    free(times->unused);
    free(times->losing);
    free(times->dirty);
    free(times->is_dirty);
    free(times->ended);
    film_supply_free(times->films);
    *times = (struct emptying_times){0};
}

double emptying_times_saturation(const struct emptying_times *times, int throat)
{
    const int owner = reservoir_of(times, throat);
    if (owner < 0) return 0;
    const int k = times->timer[owner];
    if (k < 0 || times->throat[k] != throat) return times->saturation[throat];
    const double lost = times->rate[k] * (times->now - times->since[k]);
    return (times->left[k] + (times->left_lost[k] - lost)) / volume_of(times, throat);
}

double emptying_times_imbalance(const struct emptying_times *times)
{
    const struct vapour *vapour = &times->occupancy->vapour;
    const double rate = vapour_rate(vapour);
    struct compensated sum = {.value = -rate};
    for (int k = 0; k < times->n; k++)
        compensated_add(&sum, times->rate[k]);
    return times->n_losing > 0 ? compensated_value(sum) / rate : 0;
}

// --- events ------------------------------------------------------------------------

// INFINITY of none. Sixteen minima side by side vectorise.
static double least_of(int n, const double *value)
{
    enum { LANES = 16 };
    double least[LANES];
    for (int l = 0; l < LANES; l++)
        least[l] = INFINITY;
    int k = 0;
    for (; k + LANES <= n; k += LANES)
        for (int l = 0; l < LANES; l++)
            least[l] = value[k + l] < least[l] ? value[k + l] : least[l];
    for (; k < n; k++)
        least[0] = fmin(least[0], value[k]);
    for (int l = 1; l < LANES; l++)
        least[0] = fmin(least[0], least[l]);
    return least[0];
}

// The earliest end; INFINITY if no throat loses.
static double first_end(struct emptying_times *times)
{
    double first = INFINITY;
    for (int begin = 0; begin < times->n; begin += BLOCK) {
        struct timer_block *block = &times->block[begin / BLOCK];
        if (block->is_stale) {
            const int n = times->n - begin < BLOCK ? times->n - begin : BLOCK;
            block->end = least_of(n, times->end + begin);
            block->tie = least_of(n, times->tie + begin);
            block->is_stale = false;
        }
        first = fmin(first, block->end);
    }
    return first;
}

static void end_throat(struct emptying_times *times, int k)
{
    struct occupancy *occupancy = times->occupancy;
    advance_timer(times, k);
    compensated_add(&occupancy->total_liquid, -times->left[k]);
    compensated_add(&occupancy->total_liquid, -times->left_lost[k]);
    times->left[k] = times->left_lost[k] = 0;
    GROW_ARRAY(times->ended, times->n_ended, times->ended_capacity);
    times->ended[times->n_ended++] = times->throat[k];
}

// Ends all throats that have lost everything.
static void end_throats(struct emptying_times *times)
{
    times->n_ended = 0;
    for (int begin = 0; begin < times->n; begin += BLOCK) {
        if (!(times->block[begin / BLOCK].tie <= times->now)) continue;
        for (int k = begin; k < begin + BLOCK && k < times->n; k++)
            if (times->tie[k] <= times->now) end_throat(times, k);
    }
    if (times->n_ended > 1)
        qsort(times->ended, (size_t)times->n_ended, sizeof *times->ended, rising_ints);
}

double emptying_times_next_loss(struct emptying_times *times)
{
    const double end = first_end(times);
    return end < INFINITY ? vapour_rate(&times->occupancy->vapour) * (end - times->now)
                          : 0;
}

double emptying_times_advance(struct emptying_times *times)
{
    struct occupancy *occupancy = times->occupancy;
    const double end = first_end(times);
    if (end == INFINITY) return -1;
    const double span = end - times->now;
    compensated_add(&occupancy->total_liquid, -vapour_rate(&occupancy->vapour) * span);
    times->now = end;
    end_throats(times);
    return span;
}

// The node dries.
static void empty_rings(struct emptying_times *times, int place)
{
    const int node = place - times->occupancy->network->n_throat;
    stop_timer(times, times->timer[place]);
    occupancy_dry_rings(times->occupancy, node);
    share_by_node(times, node);
}

// A cluster has no throat any more: from now on rings that it fed dry by themselves.
static void end_films(struct emptying_times *times)
{
    for (int k = 0; k < times->occupancy->n_wet; k++)
        share_by_node(times, times->occupancy->wet[k]);
}

// Returns whether a node dries.
static bool empty_throat(struct emptying_times *times, int throat)
{
    struct occupancy *occupancy = times->occupancy;
    const int cluster = occupancy->clusters.of_throat[throat];
    const int k = times->timer[reservoir_of(times, throat)];
    stop_timer(times, k);
    mark_dirty(times, k);
    occupancy_empty_throat(occupancy, throat);
    share_by_ends(times, throat);
    if (times->films) film_supply_empty_throat(times, throat, cluster);
    if (occupancy->feeder && occupancy->clusters.size[cluster] == 0) end_films(times);
    for (int l = 0; l < occupancy->clusters.n_moved; l++)
        share_by_ends(times, occupancy->clusters.moved[l]);
    const int32_t *node = occupancy->network->throat_nodes[throat];
    return occupancy->wet_place[node[0]] < 0 || occupancy->wet_place[node[1]] < 0;
}

void emptying_times_empty_ended(struct emptying_times *times)
{
    bool dries = false;
    for (int k = 0; k < times->n_ended; k++) {
        const int place = times->ended[k];
        if (is_rings(times, place)) empty_rings(times, place);
        dries |= is_rings(times, place) || empty_throat(times, place);
    }
    set_rates(times, dries);
}

// --- state -------------------------------------------------------------------------

void emptying_times_state(struct emptying_times *times,
                          struct checkpoint_stream *stream)
{
    const int n_place = times->n_place;
    for (int k = 0; stream->restoring && k < times->n; k++)
        if (times->owner[k] >= 0) times->timer[times->owner[k]] = -1;
    stream_integer(stream, &times->n, 0, n_place);
    stream_integer(stream, &times->n_unused, 0, n_place);
    stream_integer(stream, &times->n_losing, 0, n_place);
    evaporation_shares_state(times, stream);
    stream_integers(stream, times->owner, times->n, -1, n_place - 1);
    stream_integers(stream, times->throat, times->n, -1, n_place - 1);
    stream_integers(stream, times->shares, times->n, 0, times->n_share);
    stream_integers(stream, times->unused, times->n_unused, 0, times->n - 1);
    stream_integers(stream, times->losing, times->n_losing, 0, n_place - 1);
    stream_flags(stream, times->has_sum, times->n);
    stream_sums(stream, times->sum, times->n);
    stream_numbers(stream, times->summed, times->n);
    stream_numbers(stream, times->rate, times->n);
    stream_numbers(stream, times->left, times->n);
    stream_numbers(stream, times->left_lost, times->n);
    stream_numbers(stream, times->since, times->n);
    stream_numbers(stream, &times->now, 1);
    stream_numbers(stream, times->saturation, n_place);
    for (int k = 0; stream->restoring && k < times->n; k++) {
        if (times->owner[k] >= 0) times->timer[times->owner[k]] = k;
        const int throat = times->throat[k];
        times->nothing[k] = throat < 0 ? 0 : TIE * volume_of(times, throat);
    }
    if (stream->restoring) renew_all_ends(times);
    if (times->films) film_supply_state(times, stream);
}
