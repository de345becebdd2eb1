// SPDX-License-Identifier: GPL-3.0-or-later
#include "liquid_loads.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"

#include <stdlib.h>

static bool is_at_last_step(const struct filling *filling)
{
    return filling->step + 1 >= filling->record->drying.n_step;
}

static double step_time(const struct filling *filling, int step)
{
    return filling->record->drying.time[step];
}

static bool has_meniscus_at(const struct filling *filling, int node)
{
    return filling->gas[node] || filling->record->exposed[node];
}

// At the step itself.
static bool holds_liquid(const struct filling *filling, int throat)
{
    return filling->before[throat] > 0;
}

// --- clusters ----------------------------------------------------------------------

static void unite_at_nodes(const struct filling *filling, int *set)
{
    const struct network *network = filling->network;
    int *first = NEW_ARRAY(int, network->n_node);
    for (int i = 0; i < network->n_node; i++)
        first[i] = -1;
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2 && holds_liquid(filling, t); end++) {
            const int node = network->throat_nodes[t][end];
            if (filling->gas[node]) continue;
            if (first[node] >= 0)
                unite_sets(set, first[node], t);
            else
                first[node] = t;
        }
    free(first);
}

int filling_clusters(const struct filling *filling, int *cluster)
{
    const int n = filling->network->n_throat;
    int *set = NEW_ARRAY(int, n);
    for (int t = 0; t < n; t++)
        set[t] = t;
    unite_at_nodes(filling, set);
    int count = 0;
    for (int t = 0; t < n; t++) {
        cluster[t] = holds_liquid(filling, t) ? set_root(set, t) : -1;
        count += cluster[t] == t;
    }
    free(set);
    return count;
}

// By how much still liquid is below its pressure at z = 0 in the middle of THROAT.
static double above(const struct filling *filling, int throat)
{
    const double weight = filling->law.weight;
    return weight > 0 ? weight * throat_middle(filling->network, throat).z : 0;
}

static void find_cluster_suction(const struct filling *filling)
{
    const struct network *network = filling->network;
    const int n = network->n_throat;
    int *cluster = NEW_ARRAY(int, n);
    double *least = NEW_ARRAY(double, n); // at z = 0, of the cluster so named
    filling_clusters(filling, cluster);
    for (int t = 0; t < n; t++)
        least[t] = INFINITY;
    for (int t = 0; t < n; t++) {
        const int32_t *node = network->throat_nodes[t];
        if (cluster[t] < 0 || !(network->throat_radius[t] > 0) ||
            !(has_meniscus_at(filling, node[0]) || has_meniscus_at(filling, node[1])))
            continue;
        const double entry = filling->law.meniscus / network->throat_radius[t];
        least[cluster[t]] = fmin(least[cluster[t]], entry - above(filling, t));
    }
    for (int t = 0; t < n; t++)
        if (cluster[t] >= 0)
            filling->suction[t] = least[cluster[t]] < INFINITY
                                      ? least[cluster[t]] + above(filling, t)
                                      : filling->law.uniform;
    free(least);
    free(cluster);
}

// --- the field of viscous liquid ---------------------------------------------------

static double suction_at(const struct filling *filling, const double *pressure,
                         int throat)
{
    const int32_t *node = filling->network->throat_nodes[throat];
    double sum = 0;
    int count = 0;
    for (int end = 0; end < 2; end++) {
        if (pressure[node[end]] == 0) continue; // gas
        sum -= pressure[node[end]];
        count++;
    }
    if (count > 0) return sum / count;
    const double radius = filling->network->throat_radius[throat];
    return radius > 0 ? filling->law.meniscus / radius : filling->law.uniform;
}

// Whether the throat has liquid at an end in the COUNT snapshots from FIRST on.
static bool is_wet(const struct filling *filling, int first, int count, int throat)
{
    const int32_t *node = filling->network->throat_nodes[throat];
    const size_t n = (size_t)filling->network->n_node;
    for (int s = first; s < first + count; s++) {
        const double *pressure = filling->record->pressure + (size_t)s * n;
        if (pressure[node[0]] == 0 && pressure[node[1]] == 0) return false;
    }
    return true;
}

double field_error(const struct filling *filling)
{
    const double *time = filling->record->snapshot_time;
    const size_t n = (size_t)filling->network->n_throat;
    double sum = 0, count = 0;
    for (int s = 1; s + 1 < filling->record->n_snapshot; s++) {
        const double length = time[s + 1] - time[s - 1];
        const double share = length > 0 ? (time[s] - time[s - 1]) / length : 0;
        const double *now = filling->field + (size_t)s * n;
        for (size_t t = 0; t < n; t++) {
            if (!is_wet(filling, s - 1, 3, (int)t)) continue;
            const double before = now[t - n], after = now[t + n];
            sum += fabs(now[t] - (before + share * (after - before)));
            count++;
        }
    }
    return sum / count / filling->law.uniform;
}

static double *field_of(const struct filling *filling)
{
    const struct filling_record *record = filling->record;
    const size_t n_throat = (size_t)filling->network->n_throat;
    const size_t n_node = (size_t)filling->network->n_node;
    double *field = NEW_ARRAY(double, (size_t)record->n_snapshot *n_throat);
    for (size_t s = 0; s < (size_t)record->n_snapshot; s++)
        for (size_t t = 0; t < n_throat; t++)
            field[s * n_throat + t] =
                suction_at(filling, record->pressure + s * n_node, (int)t);
    return field;
}

static void interpolate_field(const struct filling *filling, double time)
{
    const struct filling_record *record = filling->record;
    const size_t n = (size_t)filling->network->n_throat;
    int after = 0;
    while (after < record->n_snapshot && record->snapshot_time[after] <= time)
        after++;
    const int before = after > 0 ? after - 1 : 0;
    if (after == record->n_snapshot) after--;
    const double length = record->snapshot_time[after] - record->snapshot_time[before];
    const double share =
        length > 0 ? (time - record->snapshot_time[before]) / length : 0;
    const double *from = filling->field + (size_t)before * n;
    const double *to = filling->field + (size_t)after * n;
    for (size_t t = 0; t < n; t++)
        filling->suction[t] = from[t] + share * (to[t] - from[t]);
}

// --- time --------------------------------------------------------------------------

// What has emptied by this step leaves gas in its nodes.
static void note_gas(struct filling *filling)
{
    const struct drying_record *record = &filling->record->drying;
    const int step = filling->step;
    for (int64_t k = record->offset[step]; k < record->offset[step + 1]; k++) {
        const int throat = record->throat[k];
        if (record->throat_saturation[k] > 0 ||
            filling->network->throat_kind[throat] != THROAT_NETWORK)
            continue;
        for (int end = 0; end < 2; end++)
            filling->gas[filling->network->throat_nodes[throat][end]] = true;
        filling->stale = true;
    }
}

static void find_suction(struct filling *filling)
{
    if (filling->law.rule == SUCTION_CLUSTERS && filling->stale)
        find_cluster_suction(filling);
    filling->stale = false;
    if (filling->law.rule != SUCTION_FIELD) return;
    const double begin = step_time(filling, filling->step);
    const double end =
        is_at_last_step(filling) ? begin : step_time(filling, filling->step + 1);
    interpolate_field(filling, begin + filling->share * (end - begin));
}

static void step_on(struct filling *filling)
{
    filling->step++;
    apply_changes(&filling->record->drying, filling->step, filling->before);
    note_gas(filling);
    filling->share = 0;
    if (!is_at_last_step(filling))
        apply_changes(&filling->record->drying, filling->step + 1, filling->after);
}

void filling_advance(struct filling *filling)
{
    step_on(filling);
    find_suction(filling);
}

void filling_to_end_of_step(struct filling *filling)
{
    filling->share = is_at_last_step(filling) ? 0 : 1;
    find_suction(filling);
}

void filling_to(struct filling *filling, double time)
{
    while (!is_at_last_step(filling) && step_time(filling, filling->step + 1) <= time)
        step_on(filling);
    filling->share = 0;
    if (!is_at_last_step(filling)) {
        const double begin = step_time(filling, filling->step);
        const double length = step_time(filling, filling->step + 1) - begin;
        filling->share =
            fmax(0, (time - begin) / length); // the next is later than TIME
    }
    find_suction(filling);
}

double filling_saturation(const struct filling *filling)
{
    const double *saturation = filling->record->drying.saturation;
    const double before = saturation[filling->step];
    if (is_at_last_step(filling)) return before;
    return before + filling->share * (saturation[filling->step + 1] - before);
}

// --- what it does ------------------------------------------------------------------

static int count_menisci(const struct filling *filling, int throat)
{
    const int32_t *node = filling->network->throat_nodes[throat];
    return has_meniscus_at(filling, node[0]) + has_meniscus_at(filling, node[1]);
}

void filling_loads(const struct filling *filling, int throat, double load[LOADS])
{
    const double before = filling->before[throat];
    const double saturation =
        before + filling->share * (filling->after[throat] - before);
    const double suction =
        filling->suction ? filling->suction[throat] : filling->law.uniform;
    const double line =
        filling->law.contact_line * filling->network->throat_radius[throat];
    const bool takes_part = filling->network->throat_kind[throat] == THROAT_NETWORK;
    load[LOAD_SUCTION] = saturation > 0 ? saturation * suction : 0;
    load[LOAD_CONTACT_LINE] =
        holds_liquid(filling, throat) ? line * count_menisci(filling, throat) : 0;
    load[LOAD_EMPTINESS] = takes_part ? 1 - saturation : 0;
    load[LOAD_WEIGHT] =
        filling->law.weight > 0 && saturation > 0
            ? filling->law.weight * saturation * throat_volume(filling->network, throat)
            : 0;
}

struct filling filling_begin(const struct network *network,
                             const struct filling_record *record,
                             const struct suction_law *law)
{
    const int n = network->n_throat;
    struct filling filling = {.network = network,
                              .record = record,
                              .law = *law,
                              .before = full_saturations(network),
                              .gas = NEW_ARRAY(bool, network->n_node),
                              .stale = true};
    if (law->rule != SUCTION_UNIFORM) filling.suction = NEW_ARRAY(double, n);
    if (law->rule == SUCTION_FIELD) filling.field = field_of(&filling);
    apply_changes(&record->drying, 0, filling.before);
    note_gas(&filling);
    filling.after = duplicate(filling.before, (size_t)n, sizeof *filling.after);
    if (!is_at_last_step(&filling)) apply_changes(&record->drying, 1, filling.after);
    find_suction(&filling);
    return filling;
}

void filling_free(struct filling *filling)
{
    free(filling->before);
    free(filling->after);
    free(filling->gas);
    free(filling->suction);
    free(filling->field);
    *filling = (struct filling){0};
}
