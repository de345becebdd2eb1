// SPDX-License-Identifier: GPL-3.0-or-later
// The liquid in each throat at any time of the drying, and the loads it puts on
// grains:
//     load[LOAD_SUCTION]      = S suction                          Pa
//     load[LOAD_CONTACT_LINE] = r sigma sin(theta) (its menisci)   N
//     load[LOAD_EMPTINESS]    = 1 - S
//     load[LOAD_WEIGHT]       = rho g (S V + (1 - S) V_r s)        N
// with S the saturation of the throat, linear in time within a step of the drying, V_r
// what it leaves in rings and s their saturation, below 1 only where S is 0.
// The suction is uniform [K 5.3], of each cluster (the least entry pressure less rho g
// z among its menisci; one cluster where films without resistance join all liquid), or
// interpolated from the pressure field of viscous liquid. With K's uniform suction
// loads are continuous in time; clusters make them jump when a throat empties, so the
// end of a step and the beginning of the next are told apart.
//
// `before` and `after` are S at the present step and the next; `share` is where between
// them the time is. They are replayed from the changes of the drying, forwards only. A
// step has a length of 0 where two events have one time: liquid_loads_to passes it.
#include "liquid_loads.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"

#include <assert.h>
#include <stdlib.h>

static bool is_at_last_step(const struct liquid_loads *liquid)
{
    return liquid->step + 1 >= liquid->record->drying.n_step;
}

static double step_time(const struct liquid_loads *liquid, int step)
{
    return liquid->record->drying.time[step];
}

static bool has_meniscus_at(const struct liquid_loads *liquid, int node)
{
    return liquid->gas[node] || liquid->record->exposed[node];
}

// Whether the throat holds liquid at the beginning of the step.
static bool holds_liquid(const struct liquid_loads *liquid, int throat)
{
    return liquid->before[throat] > 0;
}

// --- clusters ----------------------------------------------------------------------

// Whether THROAT can hold clusters together now.
static bool joins_liquid(const struct liquid_loads *liquid, int throat)
{
    return liquid->law.joined ? liquid->network->throat_kind[throat] == THROAT_NETWORK
                              : holds_liquid(liquid, throat);
}

static void unite_at_nodes(const struct liquid_loads *liquid, int *set)
{
    const struct network *network = liquid->network;
    int *first = NEW_ARRAY(int, network->n_node);
    for (int i = 0; i < network->n_node; i++)
        first[i] = -1;
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2 && joins_liquid(liquid, t); end++) {
            const int node = network->throat_nodes[t][end];
            if (liquid->gas[node] && !liquid->law.joined) continue;
            if (first[node] >= 0)
                unite_sets(set, first[node], t);
            else
                first[node] = t;
        }
    free(first);
}

int liquid_loads_clusters(const struct liquid_loads *liquid, int *cluster)
{
    const int n = liquid->network->n_throat;
    int *set = NEW_ARRAY(int, n);
    for (int t = 0; t < n; t++)
        set[t] = t;
    unite_at_nodes(liquid, set);
    int *lowest = NEW_ARRAY(int, n); // with liquid, of the set so named
    for (int t = 0; t < n; t++)
        lowest[t] = -1;
    int count = 0;
    for (int t = 0; t < n; t++) {
        cluster[t] = -1;
        if (!holds_liquid(liquid, t)) continue;
        const int root = set_root(set, t);
        if (lowest[root] < 0) lowest[root] = t;
        cluster[t] = lowest[root];
        count += cluster[t] == t;
    }
    free(lowest);
    free(set);
    return count;
}

// rho g z at the middle of THROAT: how far its pressure in liquid at rest is below that
// at z = 0.
static double above(const struct liquid_loads *liquid, int throat)
{
    const double weight = liquid->law.weight;
    return weight > 0 ? weight * throat_middle(liquid->network, throat).z : 0;
}

static void find_cluster_suction(const struct liquid_loads *liquid)
{
    const struct network *network = liquid->network;
    const int n = network->n_throat;
    int *cluster = NEW_ARRAY(int, n);
    assert(liquid->suction);
    double *least = NEW_ARRAY(double, n); // at z = 0, of the cluster so named
    liquid_loads_clusters(liquid, cluster);
    for (int t = 0; t < n; t++)
        least[t] = INFINITY;
    for (int t = 0; t < n; t++) {
        const int32_t *node = network->throat_nodes[t];
        if (cluster[t] < 0 || !(network->throat_radius[t] > 0) ||
            !(has_meniscus_at(liquid, node[0]) || has_meniscus_at(liquid, node[1])))
            continue;
        const double entry = liquid->law.meniscus / network->throat_radius[t];
        least[cluster[t]] = fmin(least[cluster[t]], entry - above(liquid, t));
    }
    for (int t = 0; t < n; t++)
        if (cluster[t] >= 0)
            liquid->suction[t] = least[cluster[t]] < INFINITY
                                     ? least[cluster[t]] + above(liquid, t)
                                     : liquid->law.uniform;
    free(least);
    free(cluster);
}

// --- the field of viscous liquid ---------------------------------------------------

// The mean over the ends in liquid of what their pressure is below that of the gas. A
// pressure of exactly 0 means gas, as the drying writes it.
static double suction_at(const struct liquid_loads *liquid, const double *pressure,
                         int throat)
{
    const int32_t *node = liquid->network->throat_nodes[throat];
    double sum = 0;
    int count = 0;
    for (int end = 0; end < 2; end++) {
        if (pressure[node[end]] == 0) continue; // gas
        sum -= pressure[node[end]];
        count++;
    }
    if (count > 0) return sum / count;
    const double radius = liquid->network->throat_radius[throat];
    return radius > 0 ? liquid->law.meniscus / radius : liquid->law.uniform;
}

// Whether the throat has liquid at an end in each of the COUNT snapshots from FIRST on.
static bool is_wet(const struct liquid_loads *liquid, int first, int count, int throat)
{
    const int32_t *node = liquid->network->throat_nodes[throat];
    const size_t n = (size_t)liquid->network->n_node;
    for (int s = first; s < first + count; s++) {
        const double *pressure = liquid->record->pressure + (size_t)s * n;
        if (pressure[node[0]] == 0 && pressure[node[1]] == 0) return false;
    }
    return true;
}

double field_error(const struct liquid_loads *liquid)
{
    const double *time = liquid->record->snapshot_time;
    const size_t n = (size_t)liquid->network->n_throat;
    double sum = 0, count = 0;
    for (int s = 1; s + 1 < liquid->record->n_snapshot; s++) {
        const double length = time[s + 1] - time[s - 1];
        const double share = length > 0 ? (time[s] - time[s - 1]) / length : 0;
        const double *now = liquid->field + (size_t)s * n;
        for (size_t t = 0; t < n; t++) {
            if (!is_wet(liquid, s - 1, 3, (int)t)) continue;
            const double before = now[t - n], after = now[t + n];
            sum += fabs(now[t] - (before + share * (after - before)));
            count++;
        }
    }
    return sum / count / liquid->law.uniform;
}

// The suction of every throat in every snapshot, found once: it is asked for at many
// times.
static double *field_of(const struct liquid_loads *liquid)
{
    const struct liquid_record *record = liquid->record;
    const size_t n_throat = (size_t)liquid->network->n_throat;
    const size_t n_node = (size_t)liquid->network->n_node;
    double *field = NEW_ARRAY(double, (size_t)record->n_snapshot *n_throat);
    for (size_t s = 0; s < (size_t)record->n_snapshot; s++)
        for (size_t t = 0; t < n_throat; t++)
            field[s * n_throat + t] =
                suction_at(liquid, record->pressure + s * n_node, (int)t);
    return field;
}

// Linear between the snapshots around TIME; before the first and after the last one
// that one's field.
static void interpolate_field(const struct liquid_loads *liquid, double time)
{
    const struct liquid_record *record = liquid->record;
    const size_t n = (size_t)liquid->network->n_throat;
    assert(liquid->suction && liquid->field);
    int after = 0;
    while (after < record->n_snapshot && record->snapshot_time[after] <= time)
        after++;
    const int before = after > 0 ? after - 1 : 0;
    if (after == record->n_snapshot) after--;
    const double length = record->snapshot_time[after] - record->snapshot_time[before];
    const double share =
        length > 0 ? (time - record->snapshot_time[before]) / length : 0;
    const double *from = liquid->field + (size_t)before * n;
    const double *to = liquid->field + (size_t)after * n;
    for (size_t t = 0; t < n; t++)
        liquid->suction[t] = from[t] + share * (to[t] - from[t]);
}

// --- time --------------------------------------------------------------------------

// Throats that empty at this step leave gas in their nodes.
static void note_gas(struct liquid_loads *liquid)
{
    const struct drying_record *record = &liquid->record->drying;
    const int step = liquid->step;
    for (int64_t k = record->offset[step]; k < record->offset[step + 1]; k++) {
        const int throat = record->throat[k];
        if (record->throat_saturation[k] > 0 ||
            liquid->network->throat_kind[throat] != THROAT_NETWORK)
            continue;
        for (int end = 0; end < 2; end++)
            liquid->gas[liquid->network->throat_nodes[throat][end]] = true;
        liquid->stale = true;
    }
}

static void find_suction(struct liquid_loads *liquid)
{
    if (liquid->law.rule == SUCTION_CLUSTERS && liquid->stale)
        find_cluster_suction(liquid);
    liquid->stale = false;
    if (liquid->law.rule != SUCTION_FIELD) return;
    const double begin = step_time(liquid, liquid->step);
    const double end =
        is_at_last_step(liquid) ? begin : step_time(liquid, liquid->step + 1);
    interpolate_field(liquid, begin + liquid->share * (end - begin));
}

static void step_on(struct liquid_loads *liquid)
{
    liquid->step++;
    apply_changes(&liquid->record->drying, liquid->step, liquid->before);
    note_gas(liquid);
    liquid->share = 0;
    const struct drying_record *of_rings = &liquid->record->rings.changes;
    if (liquid->rings_before)
        apply_changes(of_rings, liquid->step, liquid->rings_before);
    if (is_at_last_step(liquid)) return;
    apply_changes(&liquid->record->drying, liquid->step + 1, liquid->after);
    if (liquid->rings_after)
        apply_changes(of_rings, liquid->step + 1, liquid->rings_after);
}

void liquid_loads_advance(struct liquid_loads *liquid)
{
    step_on(liquid);
    find_suction(liquid);
}

void liquid_loads_to_end_of_step(struct liquid_loads *liquid)
{
    liquid->share = is_at_last_step(liquid) ? 0 : 1;
    find_suction(liquid);
}

// How far TIME is on the way from STEP to the next, which is later than TIME.
static double share_at(const struct drying_record *record, int step, double time)
{
    const double begin = record->time[step];
    return fmax(0, (time - begin) / (record->time[step + 1] - begin));
}

void liquid_loads_to(struct liquid_loads *liquid, double time)
{
    while (!is_at_last_step(liquid) && step_time(liquid, liquid->step + 1) <= time)
        step_on(liquid);
    liquid->share = is_at_last_step(liquid)
                        ? 0
                        : share_at(&liquid->record->drying, liquid->step, time);
    find_suction(liquid);
}

double *saturations_at(const struct drying_record *record, const double *times, int n)
{
    double *saturation = NEW_ARRAY(double, n);
    for (int m = 0, step = 0; m < n; m++) {
        while (step + 1 < record->n_step && record->time[step + 1] <= times[m])
            step++;
        const double before = record->saturation[step];
        saturation[m] = before;
        if (step + 1 < record->n_step)
            saturation[m] += share_at(record, step, times[m]) *
                             (record->saturation[step + 1] - before);
    }
    return saturation;
}

// --- what it does ------------------------------------------------------------------

static int count_menisci(const struct liquid_loads *liquid, int throat)
{
    const int32_t *node = liquid->network->throat_nodes[throat];
    return has_meniscus_at(liquid, node[0]) + has_meniscus_at(liquid, node[1]);
}

double liquid_loads_filling(const struct liquid_loads *liquid, int throat)
{
    const double before = liquid->before[throat];
    return before + liquid->share * (liquid->after[throat] - before);
}

double liquid_loads_rings(const struct liquid_loads *liquid, int throat)
{
    const int32_t *node = liquid->network->throat_nodes[throat];
    const double before = liquid->rings_before[node[0]] + liquid->rings_before[node[1]];
    const double after = liquid->rings_after[node[0]] + liquid->rings_after[node[1]];
    return (before + liquid->share * (after - before)) / 2;
}

double liquid_loads_left(const struct liquid_loads *liquid, int throat)
{
    if (!liquid->ring_part) return 0;
    return (1 - liquid_loads_filling(liquid, throat)) * liquid->ring_part[throat] *
           liquid_loads_rings(liquid, throat);
}

void liquid_loads_at(const struct liquid_loads *liquid, int throat, double load[LOADS])
{
    const double saturation = liquid_loads_filling(liquid, throat);
    const double suction =
        liquid->suction ? liquid->suction[throat] : liquid->law.uniform;
    const double line =
        liquid->law.contact_line * liquid->network->throat_radius[throat];
    const bool takes_part = liquid->network->throat_kind[throat] == THROAT_NETWORK;
    load[LOAD_SUCTION] = saturation > 0 ? saturation * suction : 0;
    load[LOAD_CONTACT_LINE] =
        holds_liquid(liquid, throat) ? line * count_menisci(liquid, throat) : 0;
    load[LOAD_EMPTINESS] = takes_part ? 1 - saturation : 0;
    load[LOAD_WEIGHT] = 0;
    if (!(liquid->law.weight > 0)) return;
    if (saturation > 0)
        load[LOAD_WEIGHT] =
            liquid->law.weight * saturation * throat_volume(liquid->network, throat);
    load[LOAD_WEIGHT] += liquid->law.weight * liquid_loads_left(liquid, throat);
}

// Before the first step rings are whole.
static void begin_rings(struct liquid_loads *liquid)
{
    const int n = liquid->network->n_node;
    const struct drying_record *changes = &liquid->record->rings.changes;
    liquid->rings_before = NEW_ARRAY(double, n);
    for (int i = 0; i < n; i++)
        liquid->rings_before[i] = 1;
    apply_changes(changes, 0, liquid->rings_before);
    liquid->rings_after = duplicate(liquid->rings_before, (size_t)n, sizeof(double));
    if (!is_at_last_step(liquid)) apply_changes(changes, 1, liquid->rings_after);
    liquid->ring_part = ring_parts(&liquid->record->rings, liquid->network);
}

struct liquid_loads liquid_loads_begin(const struct network *network,
                                       const struct liquid_record *record,
                                       const struct suction_law *law)
{
    const int n = network->n_throat;
    struct liquid_loads liquid = {.network = network,
                                  .record = record,
                                  .law = *law,
                                  .before = full_saturations(network),
                                  .gas = NEW_ARRAY(bool, network->n_node),
                                  .stale = true};
    if (law->rule != SUCTION_UNIFORM) liquid.suction = NEW_ARRAY(double, n);
    if (law->rule == SUCTION_FIELD) liquid.field = field_of(&liquid);
    apply_changes(&record->drying, 0, liquid.before);
    note_gas(&liquid);
    liquid.after = duplicate(liquid.before, (size_t)n, sizeof *liquid.after);
    if (!is_at_last_step(&liquid)) apply_changes(&record->drying, 1, liquid.after);
    if (record->rings.n > 0) begin_rings(&liquid);
    find_suction(&liquid);
    return liquid;
}

void liquid_loads_free(struct liquid_loads *liquid)
{
    free(liquid->before);
    free(liquid->after);
    free(liquid->rings_before);
    free(liquid->rings_after);
    free(liquid->ring_part);
    free(liquid->gas);
    free(liquid->suction);
    free(liquid->field);
    *liquid = (struct liquid_loads){0};
}
