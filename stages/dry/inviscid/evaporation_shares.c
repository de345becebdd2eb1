// SPDX-License-Identifier: GPL-3.0-or-later
// The rate of each timer, kept up to date as nodes and throats change:
//     rate[k] = sum over shares of k of part * conductance of its node to the air,
//     part = section of the reservoir's throats at the node / section of all there,
// before films change it (film_supply.h).
// Small changes are added to and subtracted from a compensated sum. Subtraction loses
// digits when little is left of a large sum (MIN_PART); then all rates are summed
// again, as positive numbers. share_incidence and share_place point at each other, so
// that a share is found from the node and removed in O(1).
#include "evaporation_shares.h"

#include "dry/liquid/losses.h"

#include <math.h>
#include <string.h>

// Compensated sums have twice the digits of a double: a sum that has shrunk to this
// part still has all the digits of a double.
static const double MIN_PART = 1e-10;

// The same where gains (share_gain) are added to sums: a share that is subtracted is
// rounded otherwise than the gains that it consists of.
static const double MIN_PART_WITH_GAINS = 1e-3;

void mark_dirty(struct emptying_times *times, int timer)
{
    if (times->is_dirty[timer]) return;
    times->is_dirty[timer] = true;
    times->dirty[times->n_dirty++] = timer;
}

int timer_of(struct emptying_times *times, int owner)
{
    if (times->timer[owner] >= 0) return times->timer[owner];
    const int k = times->n_unused > 0 ? times->unused[--times->n_unused] : times->n++;
    times->timer[owner] = k;
    times->owner[k] = owner;
    times->throat[k] = -1;
    return k;
}

static double amount_of(const struct emptying_times *times,
                        const struct evaporation_share *share)
{
    return share->part * times->air->conductance[share->air_place];
}

static void add_to_sum(struct emptying_times *times, int k, double amount)
{
    if (!times->has_sum[k]) {
        times->has_sum[k] = true;
        times->sum[k] = (struct compensated){times->rate[k], 0};
        times->summed[k] = times->rate[k];
    }
    compensated_add(&times->sum[k], amount);
    times->summed[k] = fmax(times->summed[k], compensated_value(times->sum[k]));
}

static void remove_share(struct emptying_times *times, int place)
{
    const int last = --times->n_share;
    struct evaporation_share *share = &times->share[place];
    mark_dirty(times, share->timer);
    add_to_sum(times, share->timer, -amount_of(times, share));
    if (--times->shares[share->timer] == 0) {
        times->sum[share->timer] = (struct compensated){0};
        times->summed[share->timer] = 0;
    }
    times->share_place[times->share_incidence[last]] = place;
    times->share_place[times->share_incidence[place]] = -1;
    *share = times->share[last];
    times->share_incidence[place] = times->share_incidence[last];
}

// Adds PART to the share that the reservoir has of NODE already, or makes a new share.
static void add_share(struct emptying_times *times, int node, int incidence, int owner,
                      double part)
{
    const int timer = timer_of(times, owner);
    for (int k = times->occupancy->incidence.offset[node]; k < incidence; k++) {
        const int place = times->share_place[k];
        if (place < 0 || times->share[place].timer != timer) continue;
        times->share[place].part += part;
        return;
    }
    mark_dirty(times, timer);
    times->shares[timer]++;
    times->share_place[incidence] = times->n_share;
    times->share_incidence[times->n_share] = incidence;
    times->share[times->n_share++] =
        (struct evaporation_share){part, times->air->place[node], timer};
}

// What supplies the rings at NODE: themselves, or liquid that films join to them.
static int reservoir_of_rings(const struct emptying_times *times, int node)
{
    const struct occupancy *occupancy = times->occupancy;
    const int feeder = occupancy->feeder ? occupancy->feeder[node] : -1;
    return feeder >= 0 && occupancy->clusters.size[feeder] > 0
               ? feeder
               : occupancy->network->n_throat + node;
}

// Shares are proportional to the cross-sections of the throats that hold liquid now.
void share_by_node(struct emptying_times *times, int node)
{
    const struct occupancy *occupancy = times->occupancy;
    const int begin = occupancy->incidence.offset[node];
    const int end = occupancy->incidence.offset[node + 1];
    for (int k = begin; k < end; k++)
        if (times->share_place[k] >= 0) remove_share(times, times->share_place[k]);
    if (!(vapour_evaporation(&occupancy->vapour, node) > 0)) return;
    const double sum = liquid_sections_at(occupancy, node);
    for (int k = begin; k < end; k++) {
        const double section =
            liquid_section(occupancy, occupancy->incidence.throat[k]);
        const int throat = occupancy->incidence.throat[k];
        if (section > 0)
            add_share(times, node, k, reservoir_of(times, throat), section / sum);
    }
    if (!(sum > 0) && node_has_rings(occupancy, node))
        add_share(times, node, begin, reservoir_of_rings(times, node), 1);
    for (int k = begin; k < end; k++) {
        const int place = times->share_place[k];
        if (place < 0) continue;
        const struct evaporation_share *share = &times->share[place];
        add_to_sum(times, share->timer, amount_of(times, share));
    }
}

void share_gain(struct emptying_times *times, int node, double gain)
{
    const struct incidence *incidence = &times->occupancy->incidence;
    for (int k = incidence->offset[node]; k < incidence->offset[node + 1]; k++) {
        const int place = times->share_place[k];
        if (place < 0) continue;
        const struct evaporation_share *share = &times->share[place];
        mark_dirty(times, share->timer);
        add_to_sum(times, share->timer, share->part * gain);
    }
}

void share_by_ends(struct emptying_times *times, int throat)
{
    for (int end = 0; end < 2; end++)
        share_by_node(times, times->occupancy->network->throat_nodes[throat][end]);
}

static int most_shares(const struct emptying_times *times)
{
    int most = 0;
    for (int k = 1; k < times->n; k++)
        if (times->shares[k] > times->shares[most]) most = k;
    return most;
}

// The largest cluster has about half of all shares. Its sum is split in eight parts,
// since each addition to one number waits for the previous one.
void evaporation_shares_add_up(struct emptying_times *times)
{
    enum { PARTS = 8 };
    double part[PARTS] = {0};
    const int most = most_shares(times);
    memset(times->rate, 0, (size_t)times->n * sizeof *times->rate);
    for (int k = 0; k < times->n_share; k++) {
        const int timer = times->share[k].timer;
        double *sum = timer == most ? &part[k % PARTS] : &times->rate[timer];
        *sum += amount_of(times, &times->share[k]);
    }
    for (int l = 0; l < PARTS; l++)
        times->rate[most] += part[l];
    memset(times->has_sum, 0, (size_t)times->n * sizeof *times->has_sum);
}

void evaporation_shares_set_rate(struct emptying_times *times, int timer)
{
    if (times->has_sum[timer])
        times->rate[timer] = compensated_value(times->sum[timer]);
}

bool evaporation_shares_lack_digits(const struct emptying_times *times)
{
    const double least = times->occupancy->vapour.kept ? MIN_PART_WITH_GAINS : MIN_PART;
    for (int l = 0; l < times->n_dirty; l++) {
        const int k = times->dirty[l];
        if (times->has_sum[k] &&
            compensated_value(times->sum[k]) < least * times->summed[k])
            return true;
    }
    return false;
}

void evaporation_shares_state(struct emptying_times *times,
                              struct checkpoint_stream *stream)
{
    const struct network *network = times->occupancy->network;
    const int n_incidence = 2 * network->n_throat;
    stream_integer(stream, &times->n_share, 0, n_incidence);
    for (int k = 0; k < times->n_share; k++) {
        struct evaporation_share *share = &times->share[k];
        stream_numbers(stream, &share->part, 1);
        int node = stream->restoring ? 0 : times->air->site[share->air_place];
        stream_integer(stream, &node, 0, network->n_node - 1);
        share->air_place = times->air->place[node];
        stream->failed |= share->air_place < 0;
        stream_integer(stream, &share->timer, 0, times->n - 1);
    }
    stream_integers(stream, times->share_incidence, times->n_share, 0, n_incidence - 1);
    stream_integers(stream, times->share_place, n_incidence, -1, times->n_share - 1);
}
