// SPDX-License-Identifier: GPL-3.0-or-later
// Inviscid and immobile liquid with the Kelvin effect: an obstacle problem for the
// potentials of the bodies. In a full throat either
//     potential = entry_potential,  evaporation >= 0     (as curved as its throat), or
//     potential < entry_potential,  evaporation = 0      (flatter: zero_flux).
// Each round solves for the equilibrated set (equilibrated_menisci.h) and revises it:
// too much curved menisci leave, full ones with condensation join. First all change at
// once, then one at a time, which always ends (Murty 1974). A throat partly empty may
// condense: its loss is negative. The largest loss takes up the error of the balance,
// which must stay below MAX_RESIDUAL.
#include "kelvin_menisci.h"

#include "basics/memory.h"
#include "equilibrated_menisci.h"
#include "kelvin_bodies.h"
#include "kelvin_evaporation.h"

#include <math.h>
#include <stdlib.h>

// In the first rounds all menisci that violate their condition change at once; after
// that only the first of them, which always ends (Murty 1974).
enum { ROUNDS_AT_ONCE = 10, MAX_ROUNDS = 1000 };

// A meniscus stays equilibrated while its potential exceeds the entry potential by at
// most this part: without hysteresis rounding would let a body at the threshold flip.
static const double HYSTERESIS = 1e-10;

// Largest error of the balance, relative to the rate into the air: late in a run, links
// between wet nodes conduct a million times more than those to the air.
static const double MAX_RESIDUAL = 1e-6;

static void find_initial_conductances(struct kelvin_menisci *kelvin,
                                      struct occupancy *occupancy)
{
    struct kron_fronts *mesh = &occupancy->vapour.mesh;
    const int n_site = occupancy->vapour.n_site;
    int *other = NEW_ARRAY(int, n_site);
    double *link = NEW_ARRAY(double, n_site);
    kron_fronts_list(mesh);
    for (int i = 0; i < n_site; i++) {
        kelvin->initial_conductance[i] = kron_fronts_air(mesh, i);
        const int n = kron_fronts_list_links(mesh, i, other, link);
        for (int k = 0; k < n; k++) {
            kelvin->initial_conductance[i] += link[other[k]];
            link[other[k]] = 0;
        }
    }
    free(other);
    free(link);
}

struct kelvin_menisci kelvin_menisci_init(struct occupancy *occupancy,
                                          const struct drying_conditions *conditions)
{
    const struct network *network = occupancy->network;
    const int n = network->n_throat;
    struct kelvin_menisci kelvin = {
        .listed_at = -1,
        .by_throat = conditions->liquid != LIQUID_INVISCID,
        .entry_potential = NEW_ARRAY(double, n),
        .section = NEW_ARRAY(double, n),
        .law = kelvin_law(conditions),
        .throat = NEW_ARRAY(int, n),
        .potential = NEW_ARRAY(double, n),
        .evaporation = NEW_ARRAY(double, n),
        .zero_flux = NEW_ARRAY(bool, n),
        .flows = NEW_ARRAY(bool, n),
        .exponent = NEW_ARRAY(double, n),
        .place = NEW_ARRAY(int, n),
        .had_zero_flux = NEW_ARRAY(bool, n),
        .zero_flux_potential = NEW_ARRAY(double, n),
        .body = NEW_ARRAY(int, n),
        .ranked = NEW_ARRAY(int, n),
        .at_throat = NEW_ARRAY(int, n),
        .offset = NEW_ARRAY(int, network->n_node + 1),
        .share = NEW_ARRAY(struct share, 2 * (size_t)n),
        .gravity_potential = NEW_ARRAY(double, network->n_node),
        .node_conductance_bound = NEW_ARRAY(double, network->n_node),
        .initial_conductance = NEW_ARRAY(double, occupancy->vapour.n_site),
        .conductance_bound = NEW_ARRAY(double, n),
        .noise = NEW_ARRAY(double, n),
        .level = NEW_ARRAY(double, occupancy->vapour.n_site),
        .flow = NEW_ARRAY(double, occupancy->vapour.n_site)};
    kelvin.equilibrated =
        equilibrated_create(n, occupancy->vapour.n_site, kelvin.by_throat);
    for (int t = 0; t < n; t++)
        kelvin.section[t] = occupancy->volume[t] / network->throat_length[t];
    find_initial_conductances(&kelvin, occupancy);
    for (int t = 0; t < n; t++) {
        kelvin.place[t] = -1;
        if (network->throat_kind[t] == THROAT_NETWORK)
            kelvin.entry_potential[t] = kelvin_potential(
                &kelvin.law, kelvin.law.exponent / network->throat_radius[t]);
    }
    return kelvin;
}

void kelvin_menisci_free(struct kelvin_menisci *kelvin)
{
    free(kelvin->entry_potential);
    free(kelvin->section);
    free(kelvin->throat);
    free(kelvin->potential);
    free(kelvin->evaporation);
    free(kelvin->zero_flux);
    free(kelvin->flows);
    free(kelvin->exponent);
    free(kelvin->place);
    free(kelvin->had_zero_flux);
    free(kelvin->zero_flux_potential);
    free(kelvin->body);
    free(kelvin->ranked);
    free(kelvin->at_throat);
    free(kelvin->offset);
    free(kelvin->share);
    free(kelvin->gravity_potential);
    free(kelvin->node_conductance_bound);
    free(kelvin->initial_conductance);
    free(kelvin->level);
    free(kelvin->flow);
    free(kelvin->conductance_bound);
    free(kelvin->noise);
    equilibrated_free(kelvin->equilibrated);
    *kelvin = (struct kelvin_menisci){0};
}

// --- menisci that are flatter ------------------------------------------------------

struct revision {
    int begun, ended;
};

static double excess_curvature(const struct kelvin_menisci *kelvin, int a)
{
    const double entry_potential = kelvin->entry_potential[kelvin->throat[a]];
    if (!kelvin->zero_flux[a] || kelvin->flows[a] ||
        kelvin->potential[a] <= entry_potential)
        return 0;
    return kelvin->potential[a] / entry_potential - 1;
}

// The excess above which menisci leave the equilibrated set: half of the largest, for
// the others often follow by themselves when the worst have left.
static double most_excess(const struct kelvin_menisci *kelvin)
{
    double worst = 0;
    for (int a = 0; a < kelvin->n; a++)
        worst = fmax(worst, excess_curvature(kelvin, a));
    return fmax(HYSTERESIS, worst / 2);
}

// Lets bodies join or leave the equilibrated set, at most MOST of them.
static struct revision revise(struct kelvin_menisci *kelvin,
                              const struct occupancy *occupancy, int most)
{
    struct revision revision = {0};
    const double most_curved = most_excess(kelvin);
    for (int a = 0; a < kelvin->n && revision.begun + revision.ended < most; a++) {
        if (kelvin->flows[a]) continue;
        if (excess_curvature(kelvin, a) > most_curved) {
            kelvin->zero_flux[a] = false;
            kelvin->potential[a] = kelvin->entry_potential[kelvin->throat[a]];
            revision.ended++;
        } else if (!kelvin->zero_flux[a] &&
                   kelvin->evaporation[a] < -10 * kelvin->all_noise &&
                   kelvin_is_full(kelvin, occupancy, a)) {
            kelvin->zero_flux[a] = true;
            revision.begun++;
        }
    }
    return revision;
}

// --- all ---------------------------------------------------------------------------

static void add_losses(const struct kelvin_menisci *kelvin,
                       const struct occupancy *occupancy, struct losses *losses)
{
    for (int r = 0; r < kelvin->n; r++) {
        const int a = kelvin->ranked[r], throat = kelvin->throat[a];
        const double evaporation = kelvin->evaporation[a];
        if (kelvin->zero_flux[a] || kelvin->flows[a] ||
            fabs(evaporation) <= kelvin->noise[a] ||
            (evaporation < 0 && kelvin_is_full(kelvin, occupancy, a)))
            continue;
        losses->loss[losses->n++] = (struct loss){throat, evaporation};
    }
}

// Adds the error of the balance to the largest loss, and notes it as residual.
static void balance(struct kelvin_menisci *kelvin, struct losses *losses)
{
    struct compensated rest = {.value = kelvin->rate};
    int largest = 0;
    for (int k = 0; k < losses->n; k++) {
        compensated_add(&rest, -losses->loss[k].rate);
        if (losses->loss[k].rate > losses->loss[largest].rate) largest = k;
    }
    if (losses->n > 0) losses->loss[largest].rate += compensated_value(rest);
    const double residual = fabs(compensated_value(rest)) / kelvin->rate;
    if (!(residual <= kelvin->residual)) kelvin->residual = residual;
}

static enum status find_potentials(struct kelvin_menisci *kelvin,
                                   const struct occupancy *occupancy,
                                   struct reason *reason)
{
    kelvin_find_noise(kelvin);
    for (int round = 0; round < MAX_ROUNDS; round++) {
        if (!solve_zero_flux(kelvin, occupancy))
            return refuse(reason, STATUS_INTERNAL, "kelvin: out of memory");
        const int most = round < ROUNDS_AT_ONCE ? kelvin->n : 1;
        const struct revision revision = revise(kelvin, occupancy, most);
        if (revision.begun + revision.ended == 0) return STATUS_OK;
        if (revision.ended > 0) kelvin_find_evaporation(kelvin, occupancy);
    }
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "kelvin: no consistent menisci after %d rounds, among %d", MAX_ROUNDS,
                  kelvin->n);
}

void kelvin_menisci_forget(struct kelvin_menisci *kelvin)
{
    kelvin->listed_at = -1;
    equilibrated_forget(kelvin->equilibrated);
}

void kelvin_menisci_empty_throat(struct kelvin_menisci *kelvin,
                                 struct occupancy *occupancy, int throat)
{
    equilibrated_empty_throat(kelvin->equilibrated, occupancy, throat);
}

// A throat has emptied: lists the bodies again, from what is known of them.
static void relist_bodies(struct kelvin_menisci *kelvin, struct occupancy *occupancy)
{
    const int n_emptied = kelvin->listed_at - occupancy->n_liquid;
    kelvin->listed_at = occupancy->n_liquid;
    kelvin_list_bodies(kelvin, occupancy);
    kron_fronts_list(&occupancy->vapour.mesh);
    equilibrated_follow(kelvin->equilibrated, kelvin, occupancy, n_emptied);
    kelvin_find_conductance_bounds(kelvin, occupancy);
    kelvin_find_gravity_potentials(kelvin, occupancy);
    kelvin_find_evaporation(kelvin, occupancy);
}

void kelvin_menisci_begin(struct kelvin_menisci *kelvin, struct occupancy *occupancy)
{
    if (kelvin->listed_at != occupancy->n_liquid) relist_bodies(kelvin, occupancy);
}

enum status kelvin_menisci_find_others(struct kelvin_menisci *kelvin,
                                       const struct occupancy *occupancy,
                                       struct reason *reason)
{
    kelvin_find_gravity_potentials(kelvin, occupancy);
    kelvin_find_evaporation(kelvin, occupancy);
    return find_potentials(kelvin, occupancy, reason);
}

enum status kelvin_menisci_end(struct kelvin_menisci *kelvin,
                               const struct occupancy *occupancy, struct losses *losses,
                               struct reason *reason)
{
    add_losses(kelvin, occupancy, losses);
    balance(kelvin, losses);
    for (int a = 0; a < kelvin->n; a++) {
        kelvin->had_zero_flux[kelvin->body[a]] = kelvin->zero_flux[a];
        kelvin->zero_flux_potential[kelvin->body[a]] = kelvin->potential[a];
    }
    if (kelvin->residual <= MAX_RESIDUAL) return STATUS_OK;
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "kelvin: the evaporation of %d menisci differs from the flow into "
                  "the air by %.3g of that; needed is %g; the widest are driven by "
                  "%.2g of what flat ones would be",
                  kelvin->n, kelvin->residual, MAX_RESIDUAL, kelvin_drive(kelvin));
}

double kelvin_drive(const struct kelvin_menisci *kelvin)
{
    double least = INFINITY;
    for (int a = 0; a < kelvin->n; a++)
        least = fmin(least, kelvin->potential[a]);
    return 1 - least;
}

enum status kelvin_menisci_find(struct kelvin_menisci *kelvin,
                                struct occupancy *occupancy, struct losses *losses,
                                struct reason *reason)
{
    losses->n = 0;
    kelvin_menisci_begin(kelvin, occupancy);
    const enum status status = find_potentials(kelvin, occupancy, reason);
    return status ? status : kelvin_menisci_end(kelvin, occupancy, losses, reason);
}

void kelvin_menisci_state(struct kelvin_menisci *kelvin, const struct network *network,
                          struct checkpoint_stream *stream)
{
    const int n_throat = network->n_throat;
    stream_numbers(stream, kelvin->initial_conductance, network->n_node);
    stream_numbers(stream, &kelvin->rate, 1);
    stream_numbers(stream, &kelvin->residual, 1);
    stream_flags(stream, kelvin->had_zero_flux, n_throat);
    stream_numbers(stream, kelvin->zero_flux_potential, n_throat);
}
