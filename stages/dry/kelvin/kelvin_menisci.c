// SPDX-License-Identifier: GPL-3.0-or-later
#include "kelvin_menisci.h"

#include "basics/memory.h"
#include "equilibrated_menisci.h"
#include "kelvin_bodies.h"
#include "kelvin_evaporation.h"

#include <math.h>
#include <stdlib.h>

// In the first rounds all menisci that break their condition change at once; from then
// on only the first of them, which always comes to an end (Murty 1974).
enum { ROUNDS_AT_ONCE = 10, MOST_ROUNDS = 1000 };

// A meniscus this much more curved than its throat, of its potential, still floats:
// what is on the verge would change its mind for rounding.
static const double VERGE = 1e-10;

// Largest part of the rate into the air that may be lost in that: late, wet nodes have
// links that conduct a million times what leads to the air.
static const double ENOUGH = 1e-6;

static void find_outside(struct curved *curved, struct phases *phases)
{
    struct star_mesh *mesh = &phases->vapour.mesh;
    const int n_site = phases->vapour.n_site;
    int *other = NEW_ARRAY(int, n_site);
    double *link = NEW_ARRAY(double, n_site);
    star_mesh_list_fronts(mesh);
    for (int i = 0; i < n_site; i++) {
        curved->outside[i] = mesh->air[i];
        const int n = star_mesh_list_links(mesh, i, other, link);
        for (int k = 0; k < n; k++) {
            curved->outside[i] += link[other[k]];
            link[other[k]] = 0;
        }
    }
    free(other);
    free(link);
}

struct curved curved_make(struct phases *phases,
                          const struct drying_conditions *conditions)
{
    const struct network *network = phases->network;
    const int n = network->n_throat;
    struct curved curved = {.listed_at = -1,
                            .by_throat = conditions->liquid != LIQUID_INVISCID,
                            .own = NEW_ARRAY(double, n),
                            .section = NEW_ARRAY(double, n),
                            .law = kelvin_law(conditions),
                            .throat = NEW_ARRAY(int, n),
                            .potential = NEW_ARRAY(double, n),
                            .gain = NEW_ARRAY(double, n),
                            .floats = NEW_ARRAY(bool, n),
                            .flows = NEW_ARRAY(bool, n),
                            .exponent = NEW_ARRAY(double, n),
                            .place = NEW_ARRAY(int, n),
                            .floated = NEW_ARRAY(bool, n),
                            .floated_at = NEW_ARRAY(double, n),
                            .body = NEW_ARRAY(int, n),
                            .ranked = NEW_ARRAY(int, n),
                            .at_throat = NEW_ARRAY(int, n),
                            .offset = NEW_ARRAY(int, network->n_node + 1),
                            .share = NEW_ARRAY(struct share, 2 * (size_t)n),
                            .raised = NEW_ARRAY(double, network->n_node),
                            .conducted = NEW_ARRAY(double, network->n_node),
                            .outside = NEW_ARRAY(double, phases->vapour.n_site),
                            .reach = NEW_ARRAY(double, n),
                            .noise = NEW_ARRAY(double, n),
                            .level = NEW_ARRAY(double, phases->vapour.n_site),
                            .flow = NEW_ARRAY(double, phases->vapour.n_site)};
    curved.floating = floating_make(n, phases->vapour.n_site, curved.by_throat);
    for (int t = 0; t < n; t++)
        curved.section[t] = phases->volume[t] / network->throat_length[t];
    find_outside(&curved, phases);
    for (int t = 0; t < n; t++) {
        curved.place[t] = -1;
        if (network->throat_kind[t] == THROAT_NETWORK)
            curved.own[t] = kelvin_potential(
                &curved.law, curved.law.exponent / network->throat_radius[t]);
    }
    return curved;
}

void curved_free(struct curved *curved)
{
    free(curved->own);
    free(curved->section);
    free(curved->throat);
    free(curved->potential);
    free(curved->gain);
    free(curved->floats);
    free(curved->flows);
    free(curved->exponent);
    free(curved->place);
    free(curved->floated);
    free(curved->floated_at);
    free(curved->body);
    free(curved->ranked);
    free(curved->at_throat);
    free(curved->offset);
    free(curved->share);
    free(curved->raised);
    free(curved->conducted);
    free(curved->outside);
    free(curved->level);
    free(curved->flow);
    free(curved->reach);
    free(curved->noise);
    floating_free(curved->floating);
    *curved = (struct curved){0};
}

// --- menisci that are flatter ------------------------------------------------------

struct revision {
    int begun, ended;
};

static double excess(const struct curved *curved, int a)
{
    const double own = curved->own[curved->throat[a]];
    if (!curved->floats[a] || curved->flows[a] || curved->potential[a] <= own) return 0;
    return curved->potential[a] / own - 1;
}

// Those more curved than this cease to float: not all that are too much so, for others
// follow when the worst have.
static double most_excess(const struct curved *curved)
{
    double worst = 0;
    for (int a = 0; a < curved->n; a++)
        worst = fmax(worst, excess(curved, a));
    return fmax(VERGE, worst / 2);
}

// Which begin or cease to float; no more than MOST.
static struct revision revise(struct curved *curved, const struct phases *phases,
                              int most)
{
    struct revision revision = {0};
    const double most_curved = most_excess(curved);
    for (int a = 0; a < curved->n && revision.begun + revision.ended < most; a++) {
        if (curved->flows[a]) continue;
        if (excess(curved, a) > most_curved) {
            curved->floats[a] = false;
            curved->potential[a] = curved->own[curved->throat[a]];
            revision.ended++;
        } else if (!curved->floats[a] && curved->gain[a] < -10 * curved->all_noise &&
                   curved_is_full(curved, phases, a)) {
            curved->floats[a] = true;
            revision.begun++;
        }
    }
    return revision;
}

// --- all ---------------------------------------------------------------------------

static void add_losses(const struct curved *curved, const struct phases *phases,
                       struct losses *losses)
{
    for (int r = 0; r < curved->n; r++) {
        const int a = curved->ranked[r], throat = curved->throat[a];
        const double gain = curved->gain[a];
        if (curved->floats[a] || curved->flows[a] || fabs(gain) <= curved->noise[a] ||
            (gain < 0 && curved_is_full(curved, phases, a)))
            continue;
        losses->loss[losses->n++] = (struct loss){throat, gain};
    }
}

// The error of the balances is left to the largest.
static void balance(struct curved *curved, struct losses *losses)
{
    struct compensated rest = {.value = curved->rate};
    int largest = 0;
    for (int k = 0; k < losses->n; k++) {
        compensated_add(&rest, -losses->loss[k].rate);
        if (losses->loss[k].rate > losses->loss[largest].rate) largest = k;
    }
    if (losses->n > 0) losses->loss[largest].rate += compensated_value(rest);
    const double residual = fabs(compensated_value(rest)) / curved->rate;
    if (!(residual <= curved->residual)) curved->residual = residual;
}

static enum status find_potentials(struct curved *curved, const struct phases *phases,
                                   struct reason *reason)
{
    curved_find_noise(curved);
    for (int round = 0; round < MOST_ROUNDS; round++) {
        if (!float_freely(curved, phases))
            return refuse(reason, STATUS_INTERNAL, "kelvin: out of memory");
        const int most = round < ROUNDS_AT_ONCE ? curved->n : 1;
        const struct revision revision = revise(curved, phases, most);
        if (revision.begun + revision.ended == 0) return STATUS_OK;
        if (revision.ended > 0) curved_find_gains(curved, phases);
    }
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "kelvin: no consistent menisci after %d rounds, among %d",
                  MOST_ROUNDS, curved->n);
}

void curved_forget(struct curved *curved)
{
    curved->listed_at = -1;
    floating_forget(curved->floating);
}

void curved_empty_throat(struct curved *curved, struct phases *phases, int throat)
{
    floating_empty_throat(curved->floating, phases, throat);
}

// A throat has emptied.
static void begin_anew(struct curved *curved, struct phases *phases)
{
    const int n_emptied = curved->listed_at - phases->n_full;
    curved->listed_at = phases->n_full;
    curved_list_bodies(curved, phases);
    star_mesh_list_fronts(&phases->vapour.mesh);
    floating_follow(curved->floating, curved, phases, n_emptied);
    curved_find_reaches(curved, phases);
    curved_raise_nodes(curved, phases);
    curved_find_gains(curved, phases);
}

void curved_begin(struct curved *curved, struct phases *phases)
{
    if (curved->listed_at != phases->n_full) begin_anew(curved, phases);
}

enum status curved_find_others(struct curved *curved, const struct phases *phases,
                               struct reason *reason)
{
    curved_raise_nodes(curved, phases);
    curved_find_gains(curved, phases);
    return find_potentials(curved, phases, reason);
}

enum status curved_end(struct curved *curved, const struct phases *phases,
                       struct losses *losses, struct reason *reason)
{
    add_losses(curved, phases, losses);
    balance(curved, losses);
    for (int a = 0; a < curved->n; a++) {
        curved->floated[curved->body[a]] = curved->floats[a];
        curved->floated_at[curved->body[a]] = curved->potential[a];
    }
    if (curved->residual <= ENOUGH) return STATUS_OK;
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "kelvin: what %d menisci evaporate is %.3g off what goes into the "
                  "air, of that; needed is %g; the widest are driven by %.2g of what "
                  "flat ones would be",
                  curved->n, curved->residual, ENOUGH, curved_drive(curved));
}

double curved_drive(const struct curved *curved)
{
    double least = INFINITY;
    for (int a = 0; a < curved->n; a++)
        least = fmin(least, curved->potential[a]);
    return 1 - least;
}

enum status curved_find(struct curved *curved, struct phases *phases,
                        struct losses *losses, struct reason *reason)
{
    losses->n = 0;
    curved_begin(curved, phases);
    const enum status status = find_potentials(curved, phases, reason);
    return status ? status : curved_end(curved, phases, losses, reason);
}

void curved_state(struct curved *curved, const struct network *network,
                  struct checkpoint_stream *stream)
{
    const int n_throat = network->n_throat;
    stream_numbers(stream, curved->outside, network->n_node);
    stream_numbers(stream, &curved->rate, 1);
    stream_numbers(stream, &curved->residual, 1);
    stream_flags(stream, curved->floated, n_throat);
    stream_numbers(stream, curved->floated_at, n_throat);
}
