// SPDX-License-Identifier: GPL-3.0-or-later
#include "curved.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// In the first rounds all menisci that break their condition change at once; from then
// on only the first of them, which always comes to an end (Murty 1974).
enum { ROUNDS_AT_ONCE = 10, MOST_ROUNDS = 1000, REFINEMENTS = 4 };

// What flows between sites at different potentials is known to this part of conductance
// times potential; less is nothing.
static const double NOISE = 1e-15;

// A meniscus this much more curved than its throat, of its potential, still floats:
// what is on the verge would change its mind for rounding.
static const double VERGE = 1e-10;

// What is added to the diagonal of one of the menisci that float, of it.
static const double STAY = 1e-12;

// Largest part of the rate into the air that may be lost in that: late, wet nodes have
// links that conduct a million times what leads to the air.
static const double ENOUGH = 1e-6;

// The potential -ln(1 - p_v/p_g) falls from a flat meniscus to one of RADIUS, of its
// fall to the drying air. This form keeps its digits for wide throats.
static double own_potential(const struct drying_conditions *conditions, double radius)
{
    const double over_flat = conditions->gas_pressure - conditions->saturation_pressure;
    const double tension =
        2 * conditions->surface_tension * cos(conditions->contact_angle * (M_PI / 180));
    const double exponent =
        tension / radius * conditions->molar_mass /
        (conditions->liquid_density * GAS_CONSTANT * conditions->temperature);
    const double lowered = -conditions->saturation_pressure * expm1(-exponent);
    const double fall =
        conditions->saturation_pressure - conditions->air_vapour_pressure;
    return log1p(lowered / over_flat) / log1p(fall / over_flat);
}

enum status check_curved(const struct drying_conditions *conditions,
                         const struct network *network, struct reason *reason)
{
    for (int t = 0; conditions->kelvin && t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK &&
            !(own_potential(conditions, network->throat_radius[t]) < 1))
            return refuse(reason, STATUS_BAD_DATA,
                          "kelvin: the throat of /throats/radius row %d, %g m, never "
                          "dries: its meniscus has no more vapour than the air",
                          t, network->throat_radius[t]);
    return STATUS_OK;
}

struct curved curved_make(const struct phases *phases,
                          const struct drying_conditions *conditions)
{
    const struct network *network = phases->network;
    const int n = network->n_throat;
    struct curved curved = {.own = NEW_ARRAY(double, n),
                            .throat = NEW_ARRAY(int, n),
                            .potential = NEW_ARRAY(double, n),
                            .gain = NEW_ARRAY(double, n),
                            .floats = NEW_ARRAY(bool, n),
                            .place = NEW_ARRAY(int, n),
                            .step = NEW_ARRAY(double, n),
                            .change = NEW_ARRAY(double, n),
                            .noise = NEW_ARRAY(double, n),
                            .level = NEW_ARRAY(double, phases->vapour.n_site),
                            .flow = NEW_ARRAY(double, phases->vapour.n_site)};
    for (int t = 0; t < n; t++) {
        curved.place[t] = -1;
        if (network->throat_kind[t] == THROAT_NETWORK)
            curved.own[t] = own_potential(conditions, network->throat_radius[t]);
    }
    return curved;
}

void curved_free(struct curved *curved)
{
    free(curved->own);
    free(curved->throat);
    free(curved->potential);
    free(curved->gain);
    free(curved->floats);
    free(curved->place);
    free(curved->step);
    free(curved->change);
    free(curved->level);
    free(curved->flow);
    free(curved->noise);
    *curved = (struct curved){0};
}

// --- throats and nodes -------------------------------------------------------------

static void list_throats(struct curved *curved, struct phases *phases)
{
    curved->n = 0;
    for (int k = 0; k < phases->n_wet; k++) {
        const int node = phases->wet[k];
        for (int i = phases->incidence.offset[node];
             i < phases->incidence.offset[node + 1]; i++) {
            const int throat = phases->incidence.throat[i];
            if (!(liquid_section(phases, throat) > 0) || curved->place[throat] >= 0)
                continue;
            const int place = curved->n++;
            curved->place[throat] = place;
            curved->throat[place] = throat;
            curved->potential[place] = curved->own[throat];
            curved->floats[place] = false;
        }
    }
}

// Of a node's throats, by their sections: the mean of FROM (n), or added to TO (n) what
// the node has.
static void share_node(const struct curved *curved, const struct phases *phases,
                       int node, const double *from, double *to)
{
    const int begin = phases->incidence.offset[node];
    const int end = phases->incidence.offset[node + 1];
    double sum = 0, mean = 0;
    for (int i = begin; i < end; i++) {
        const int throat = phases->incidence.throat[i];
        const double section = liquid_section(phases, throat);
        sum += section;
        if (from && section > 0) mean += section * from[curved->place[throat]];
    }
    if (from) curved->level[node] = mean / sum;
    for (int i = begin; to && i < end; i++) {
        const int throat = phases->incidence.throat[i];
        const double section = liquid_section(phases, throat);
        if (section > 0)
            to[curved->place[throat]] += section / sum * curved->flow[node];
    }
}

// GAIN (n): what each throat evaporates at POTENTIAL (n), with the air at AIR.
static void evaporate(struct curved *curved, struct phases *phases,
                      const double *potential, double air, double *gain)
{
    const struct star_mesh *mesh = &phases->vapour.mesh;
    for (int k = 0; k < phases->n_wet; k++) {
        const int node = phases->wet[k];
        share_node(curved, phases, node, potential, NULL);
        curved->flow[node] = mesh->air[node] * (air - curved->level[node]);
    }
    star_mesh_add_flows(&phases->vapour.mesh, curved->level, curved->flow);
    for (int a = 0; a < curved->n; a++)
        gain[a] = 0;
    for (int k = 0; k < phases->n_wet; k++)
        share_node(curved, phases, phases->wet[k], NULL, gain);
}

static double rate_into_air(const struct curved *curved, const struct phases *phases)
{
    struct compensated rate = {0};
    for (int k = 0; k < phases->n_wet; k++)
        compensated_add(&rate, phases->vapour.mesh.air[phases->wet[k]] *
                                   (1 - curved->level[phases->wet[k]]));
    return compensated_value(rate);
}

// At POTENTIAL: what each throat evaporates, and how little of that is nothing.
static void find_gains(struct curved *curved, struct phases *phases)
{
    evaporate(curved, phases, curved->potential, 1, curved->gain);
    curved->rate = rate_into_air(curved, phases);
    const struct star_mesh *mesh = &phases->vapour.mesh;
    for (int k = 0; k < phases->n_wet; k++)
        curved->flow[phases->wet[k]] = mesh->air[phases->wet[k]];
    star_mesh_add_degrees(mesh, curved->level, curved->flow);
    memset(curved->noise, 0, (size_t)curved->n * sizeof *curved->noise);
    for (int k = 0; k < phases->n_wet; k++)
        share_node(curved, phases, phases->wet[k], NULL, curved->noise);
    curved->all_noise = 0;
    for (int a = 0; a < curved->n; a++) {
        curved->noise[a] *= NOISE * fabs(curved->potential[a]);
        curved->all_noise += curved->noise[a];
    }
}

// --- menisci that are flatter ------------------------------------------------------

static bool is_floating_closed(const struct curved *curved)
{
    for (int a = 0; a < curved->n; a++)
        if (curved->floats[a] && fabs(curved->gain[a]) > curved->noise[a]) return false;
    return true;
}

// How the gains of the N that float fall with their potentials, over the roots of its
// diagonal, which come back in ROOT. Where vapour cannot leave, all could float at any
// one potential: a little more on the diagonal keeps them where they are.
static double *floating_matrix(struct curved *curved, struct phases *phases,
                               const int *floating, int n, double *root)
{
    double *matrix = NEW_ARRAY(double, (size_t)n *(size_t)n);
    memset(curved->step, 0, (size_t)curved->n * sizeof *curved->step);
    for (int f = 0; f < n; f++) {
        curved->step[floating[f]] = 1;
        evaporate(curved, phases, curved->step, 0, curved->change);
        curved->step[floating[f]] = 0;
        for (int g = 0; g < n; g++)
            matrix[g * n + f] = -curved->change[floating[g]];
        root[f] = matrix[f * n + f] > 0 ? sqrt(matrix[f * n + f]) : 1;
    }
    for (int f = 0; f < n; f++)
        for (int g = 0; g < n; g++)
            matrix[g * n + f] =
                f == g ? 1 + STAY : matrix[g * n + f] / (root[f] * root[g]);
    return matrix;
}

// Cholesky's factor takes the place of the lower triangle. Not by a library: those use
// as many threads as they find, and round by their number.
static void factorise(double *matrix, int n)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) {
            double sum = matrix[i * n + j];
            for (int k = 0; k < j; k++)
                sum -= matrix[i * n + k] * matrix[j * n + k];
            matrix[i * n + j] =
                i == j ? sqrt(fmax(sum, STAY)) : sum / matrix[j * n + j];
        }
}

static void solve(const double *matrix, int n, double *x)
{
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++)
            x[i] -= matrix[i * n + k] * x[k];
        x[i] /= matrix[i * n + i];
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++)
            x[i] -= matrix[k * n + i] * x[k];
        x[i] /= matrix[i * n + i];
    }
}

// Those that float come to where they evaporate nothing.
static void float_freely(struct curved *curved, struct phases *phases)
{
    int *floating = NEW_ARRAY(int, curved->n), n = 0;
    for (int a = 0; a < curved->n; a++)
        if (curved->floats[a]) floating[n++] = a;
    double *root = NEW_ARRAY(double, n), *x = NEW_ARRAY(double, n);
    double *matrix = floating_matrix(curved, phases, floating, n, root);
    factorise(matrix, n);
    for (int k = 0; k < REFINEMENTS && !is_floating_closed(curved); k++) {
        for (int f = 0; f < n; f++)
            x[f] = curved->gain[floating[f]] / root[f];
        solve(matrix, n, x);
        for (int f = 0; f < n; f++)
            curved->potential[floating[f]] += x[f] / root[f];
        find_gains(curved, phases);
    }
    free(matrix);
    free(x);
    free(root);
    free(floating);
}

// Returns how many begin or cease to float; no more than MOST.
static int revise(struct curved *curved, const struct phases *phases, int most)
{
    int n = 0;
    for (int a = 0; a < curved->n && n < most; a++) {
        const int throat = curved->throat[a];
        const bool full = phases_saturation(phases, throat) == 1;
        const bool floats =
            full && (curved->floats[a]
                         ? curved->potential[a] <= (1 + VERGE) * curved->own[throat]
                         : curved->gain[a] < -10 * curved->all_noise);
        n += floats != curved->floats[a];
        curved->floats[a] = floats;
        if (!floats) curved->potential[a] = curved->own[throat];
    }
    return n;
}

// --- all ---------------------------------------------------------------------------

// The error of the balances is left to the largest.
static void collect(struct curved *curved, const struct phases *phases,
                    struct losses *losses)
{
    struct compensated rest = {.value = curved->rate};
    int largest = -1;
    losses->n = 0;
    for (int a = 0; a < curved->n; a++) {
        const int throat = curved->throat[a];
        const double gain = curved->gain[a];
        const bool full = phases_saturation(phases, throat) == 1;
        if (curved->floats[a] || fabs(gain) <= curved->noise[a] || (full && gain < 0))
            continue;
        compensated_add(&rest, -gain);
        losses->loss[losses->n] = (struct loss){throat, gain};
        if (largest < 0 || gain > losses->loss[largest].rate) largest = losses->n;
        losses->n++;
    }
    if (largest >= 0) losses->loss[largest].rate += compensated_value(rest);
    curved->residual =
        fmax(curved->residual, fabs(compensated_value(rest)) / curved->rate);
    losses_sort(losses);
}

static enum status find_potentials(struct curved *curved, struct phases *phases,
                                   struct reason *reason)
{
    find_gains(curved, phases);
    for (int round = 0; round < MOST_ROUNDS; round++) {
        const int most = round < ROUNDS_AT_ONCE ? curved->n : 1;
        if (revise(curved, phases, most) == 0) return STATUS_OK;
        find_gains(curved, phases);
        float_freely(curved, phases);
    }
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "kelvin: no consistent menisci after %d rounds, among %d",
                  MOST_ROUNDS, curved->n);
}

enum status curved_find(struct curved *curved, struct phases *phases,
                        struct losses *losses, struct reason *reason)
{
    list_throats(curved, phases);
    star_mesh_bring_up_to_date(&phases->vapour.mesh);
    const enum status status = find_potentials(curved, phases, reason);
    collect(curved, phases, losses);
    for (int a = 0; a < curved->n; a++)
        curved->place[curved->throat[a]] = -1;
    if (status || curved->residual <= ENOUGH) return status;
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "kelvin: what %d menisci evaporate is %.3g off what goes into the "
                  "air, of that; needed is %g",
                  curved->n, curved->residual, ENOUGH);
}

void curved_state(struct curved *curved, struct state *state)
{
    state_numbers(state, &curved->residual, 1);
}
