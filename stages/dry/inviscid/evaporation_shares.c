// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaporation_shares.h"

#include "dry/liquid/losses.h"

#include <math.h>
#include <string.h>

// Sums keep twice the digits of a number, so that all are left when this part is.
static const double LEAST_PART = 1e-10;

void touch_clock(struct clocks *clocks, int k)
{
    if (clocks->is_touched[k]) return;
    clocks->is_touched[k] = true;
    clocks->touched[clocks->n_touched++] = k;
}

// Of the account; a new one has no throat yet.
static int clock_of(struct clocks *clocks, int owner)
{
    if (clocks->clock[owner] >= 0) return clocks->clock[owner];
    const int k =
        clocks->n_unused > 0 ? clocks->unused[--clocks->n_unused] : clocks->n++;
    clocks->clock[owner] = k;
    clocks->owner[k] = owner;
    clocks->throat[k] = -1;
    return k;
}

static double amount_of(const struct clocks *clocks, const struct charge *charge)
{
    return charge->share * clocks->phases->vapour.mesh.air[charge->node];
}

static void add_to_sum(struct clocks *clocks, int k, double amount)
{
    if (!clocks->has_sum[k]) {
        clocks->has_sum[k] = true;
        clocks->sum[k] = (struct compensated){clocks->rate[k], 0};
        clocks->summed[k] = clocks->rate[k];
    }
    compensated_add(&clocks->sum[k], amount);
    clocks->summed[k] = fmax(clocks->summed[k], compensated_value(clocks->sum[k]));
}

static void remove_charge(struct clocks *clocks, int place)
{
    const int last = --clocks->n_charge;
    struct charge *charge = &clocks->charge[place];
    touch_clock(clocks, charge->clock);
    add_to_sum(clocks, charge->clock, -amount_of(clocks, charge));
    if (--clocks->charges[charge->clock] == 0) {
        clocks->sum[charge->clock] = (struct compensated){0};
        clocks->summed[charge->clock] = 0;
    }
    clocks->charge_place[clocks->charge_incidence[last]] = place;
    clocks->charge_place[clocks->charge_incidence[place]] = -1;
    *charge = clocks->charge[last];
    clocks->charge_incidence[place] = clocks->charge_incidence[last];
}

// To an account that the node charges already, or a new one.
static void add_charge(struct clocks *clocks, int node, int incidence, double share)
{
    const int owner = account_of(clocks, clocks->phases->incidence.throat[incidence]);
    const int clock = clock_of(clocks, owner);
    for (int k = clocks->phases->incidence.offset[node]; k < incidence; k++) {
        const int place = clocks->charge_place[k];
        if (place < 0 || clocks->charge[place].clock != clock) continue;
        clocks->charge[place].share += share;
        return;
    }
    touch_clock(clocks, clock);
    clocks->charges[clock]++;
    clocks->charge_place[incidence] = clocks->n_charge;
    clocks->charge_incidence[clocks->n_charge] = incidence;
    clocks->charge[clocks->n_charge++] = (struct charge){share, node, clock};
}

// By the throats that hold liquid now: shares are proportional to their cross-sections.
void charge_by_node(struct clocks *clocks, int node)
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
    for (int k = begin; k < end; k++) {
        const int place = clocks->charge_place[k];
        if (place < 0) continue;
        const struct charge *charge = &clocks->charge[place];
        add_to_sum(clocks, charge->clock, amount_of(clocks, charge));
    }
}

void charge_by_ends(struct clocks *clocks, int throat)
{
    for (int end = 0; end < 2; end++)
        charge_by_node(clocks, clocks->phases->network->throat_nodes[throat][end]);
}

static int most_charged(const struct clocks *clocks)
{
    int most = 0;
    for (int k = 1; k < clocks->n; k++)
        if (clocks->charges[k] > clocks->charges[most]) most = k;
    return most;
}

// That of the liquid's largest piece, which gets about half of them, in eight parts:
// each addition waits for the one before it.
void charges_add_up(struct clocks *clocks)
{
    enum { PARTS = 8 };
    double part[PARTS] = {0};
    const int most = most_charged(clocks);
    memset(clocks->rate, 0, (size_t)clocks->n * sizeof *clocks->rate);
    for (int k = 0; k < clocks->n_charge; k++) {
        const int clock = clocks->charge[k].clock;
        double *sum = clock == most ? &part[k % PARTS] : &clocks->rate[clock];
        *sum += amount_of(clocks, &clocks->charge[k]);
    }
    for (int l = 0; l < PARTS; l++)
        clocks->rate[most] += part[l];
    memset(clocks->has_sum, 0, (size_t)clocks->n * sizeof *clocks->has_sum);
}

void charges_set_rate(struct clocks *clocks, int k)
{
    if (clocks->has_sum[k]) clocks->rate[k] = compensated_value(clocks->sum[k]);
}

bool charges_lack_digits(const struct clocks *clocks)
{
    for (int l = 0; l < clocks->n_touched; l++) {
        const int k = clocks->touched[l];
        if (clocks->has_sum[k] &&
            compensated_value(clocks->sum[k]) < LEAST_PART * clocks->summed[k])
            return true;
    }
    return false;
}

void charges_state(struct clocks *clocks, struct checkpoint_stream *stream)
{
    const struct network *network = clocks->phases->network;
    const int n_incidence = 2 * network->n_throat;
    stream_integer(stream, &clocks->n_charge, 0, n_incidence);
    for (int k = 0; k < clocks->n_charge; k++) {
        struct charge *charge = &clocks->charge[k];
        stream_numbers(stream, &charge->share, 1);
        stream_integer(stream, &charge->node, 0, network->n_node - 1);
        stream_integer(stream, &charge->clock, 0, clocks->n - 1);
    }
    stream_integers(stream, clocks->charge_incidence, clocks->n_charge, 0,
                    n_incidence - 1);
    stream_integers(stream, clocks->charge_place, n_incidence, -1,
                    clocks->n_charge - 1);
}
