// SPDX-License-Identifier: GPL-3.0-or-later
// Checks a restored state part by part. Each function compares a list with what it is
// derived from: sizes with members, places with what stands there, flags with counts.
// A state that passes cannot lead the run outside its arrays or into an endless loop.
//
// In this order, which run_fits keeps: clusters, occupancy, vapour, what has changed
// since the last step, losses, history, timers, films. The stream has checked by then
// that each index lies in its array (go_on_from asks it first), so these functions may
// use indices before they know that they make sense.
//
// It is not checked that numbers are those of a drying: volumes, rates and factors may
// be wrong. The restart artifact has the digests of parameters and inputs for that.
// Each function is linear in what it looks at.
#include "check_state.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"
#include "dry/inviscid/evaporation_shares.h"
#include "dry/inviscid/film_supply.h"
#include "film_history.h"

#include <math.h>
#include <stdlib.h>

// ---- clusters ----------------------------------------------------------------------

// Each identity has as many throats as its size says, or is listed once as unused.
static bool identities_fit(const struct clusters *clusters)
{
    const int n = clusters->n_id, n_throat = clusters->network->n_throat;
    int *size = NEW_ARRAY(int, n);
    bool *is_unused = NEW_ARRAY(bool, n), fits = true;
    for (int t = 0; t < n_throat; t++)
        if (clusters->of_throat[t] >= 0) size[clusters->of_throat[t]]++;
    for (int k = 0; k < clusters->n_unused; k++) {
        fits &= !is_unused[clusters->unused[k]];
        is_unused[clusters->unused[k]] = true;
    }
    for (int c = 0; c < n; c++)
        fits &= size[c] == clusters->size[c] && (size[c] == 0) == is_unused[c];
    fits &= clusters->count == n - clusters->n_unused;
    free(size);
    free(is_unused);
    return fits;
}

// A cluster is one connected component of the liquid, and all of it. Throats at a node
// that joins must be of one cluster; so no component has two clusters. Components are
// as many as clusters in use; so no cluster has two components, unless films join what
// gas has parted.
static bool pieces_fit(const struct clusters *clusters)
{
    const struct incidence *incidence = clusters->incidence;
    const int n_throat = clusters->network->n_throat;
    int *parent = NEW_ARRAY(int, n_throat), pieces = 0;
    bool fits = true;
    for (int t = 0; t < n_throat; t++)
        parent[t] = t;
    for (int i = 0; i < clusters->network->n_node; i++) {
        int before = -1;
        for (int k = incidence->offset[i];
             clusters->joins[i] && k < incidence->offset[i + 1]; k++) {
            const int throat = incidence->throat[k];
            if (clusters->of_throat[throat] < 0) continue;
            if (before >= 0) {
                fits &= clusters->of_throat[before] == clusters->of_throat[throat];
                unite_sets(parent, before, throat);
            }
            before = throat;
        }
    }
    for (int t = 0; t < n_throat; t++)
        pieces += clusters->of_throat[t] >= 0 && parent[t] == t;
    free(parent);
    return fits && (clusters->never_part ? pieces >= clusters->count
                                         : pieces == clusters->count);
}

// A heap holds no throat twice, and all menisci of its cluster, of which there are
// some.
static bool heap_fits(const struct clusters *clusters, int cluster, int menisci,
                      int *last_heap)
{
    const struct rank_heap *heap = &clusters->heap[cluster];
    for (int k = 0; k < heap->n; k++) {
        if (k > 0 && heap->rank[(k - 1) / 2] >= heap->rank[k]) return false;
        const int throat = clusters->throat_at_rank[heap->rank[k]];
        if (last_heap[throat] == cluster) return false;
        last_heap[throat] = cluster;
        menisci -= clusters->of_throat[throat] == cluster && clusters->meniscus[throat];
    }
    return menisci == 0;
}

static bool menisci_fit(const struct clusters *clusters)
{
    const int n_throat = clusters->network->n_throat;
    int *menisci = NEW_ARRAY(int, clusters->n_id),
        *last_heap = NEW_ARRAY(int, n_throat);
    bool fits = true;
    for (int t = 0; t < n_throat; t++) {
        last_heap[t] = -1;
        if (clusters->of_throat[t] >= 0 && clusters->meniscus[t])
            menisci[clusters->of_throat[t]]++;
    }
    for (int c = 0; c < clusters->n_id; c++)
        fits &= (menisci[c] > 0 || clusters->size[c] == 0) &&
                heap_fits(clusters, c, menisci[c], last_heap);
    free(menisci);
    free(last_heap);
    return fits;
}

// ---- occupancy ---------------------------------------------------------------------

// Whether there is liquid in a throat, or in the rings of a node.
static bool is_liquid(const struct occupancy *occupancy, int place)
{
    const int n_throat = occupancy->network->n_throat;
    return place < n_throat ? occupancy->clusters.of_throat[place] >= 0
                            : node_has_rings(occupancy, place - n_throat);
}

// The counts of throats with liquid are right, in all and at each node; in all, nodes
// with rings count too.
static bool liquid_fits(const struct occupancy *occupancy)
{
    const struct network *network = occupancy->network;
    int *beside = NEW_ARRAY(int, network->n_node), n_liquid = 0;
    bool fits = true;
    for (int t = 0; t < network->n_throat; t++) {
        if (occupancy->clusters.of_throat[t] < 0) continue;
        fits &= network->throat_kind[t] == THROAT_NETWORK;
        n_liquid++;
        for (int end = 0; end < 2; end++)
            beside[network->throat_nodes[t][end]]++;
    }
    for (int i = 0; i < network->n_node; i++)
        fits &= beside[i] == occupancy->liquid_beside[i];
    for (int i = 0; i < network->n_node; i++)
        n_liquid += node_has_rings(occupancy, i);
    free(beside);
    return fits && n_liquid == occupancy->n_liquid;
}

// Wet nodes are listed once each, have liquid or rings, and menisci in its throats.
static bool wet_nodes_fit(const struct occupancy *occupancy)
{
    const struct clusters *clusters = &occupancy->clusters;
    const struct incidence *incidence = &occupancy->incidence;
    int placed = 0;
    for (int i = 0; i < occupancy->network->n_node; i++)
        placed += occupancy->wet_place[i] >= 0;
    for (int w = 0; w < occupancy->n_wet; w++) {
        const int node = occupancy->wet[w];
        if (occupancy->wet_place[node] != w ||
            (occupancy->liquid_beside[node] == 0 && !node_has_rings(occupancy, node)))
            return false;
        for (int k = incidence->offset[node]; k < incidence->offset[node + 1]; k++)
            if (clusters->of_throat[incidence->throat[k]] >= 0 &&
                !clusters->meniscus[incidence->throat[k]])
                return false;
    }
    return placed == occupancy->n_wet;
}

// ---- timers ------------------------------------------------------------------------

// A timer belongs to a reservoir that has no other, and to a throat or rings of it with
// liquid; or it is listed once as unused.
static bool owners_fit(const struct emptying_times *times)
{
    const struct occupancy *occupancy = times->occupancy;
    int running = 0, unused = 0;
    for (int k = 0; k < times->n; k++) {
        const int owner = times->owner[k], throat = times->throat[k];
        if (!(times->rate[k] >= 0)) return false;
        if (owner < 0) {
            if (times->shares[k] > 0 || times->has_sum[k] || throat >= 0) return false;
            continue;
        }
        running++;
        if (times->timer[owner] != k || throat < 0 ||
            (times->shares[k] == 0 && !times->films) || !is_liquid(occupancy, throat) ||
            reservoir_of(times, throat) != owner)
            return false;
    }
    bool *seen = NEW_ARRAY(bool, times->n);
    for (int k = 0; k < times->n_unused; k++) {
        unused += times->owner[times->unused[k]] < 0 && !seen[times->unused[k]];
        seen[times->unused[k]] = true;
    }
    free(seen);
    return unused == times->n_unused && running + unused == times->n &&
           running == times->n_losing;
}

// The throats that lose are those of the timers, in ascending order.
static bool losing_fit(const struct emptying_times *times)
{
    for (int l = 0; l < times->n_losing; l++) {
        const int throat = times->losing[l];
        if (l > 0 && times->losing[l - 1] >= throat) return false;
        const int owner = reservoir_of(times, throat);
        if (owner < 0 || times->timer[owner] < 0 ||
            times->throat[times->timer[owner]] != throat)
            return false;
    }
    return true;
}

// Whether TIMER supplies a share of NODE: as the reservoir of THROAT, a throat there;
// or, where none there holds liquid, as its rings or as what feeds these.
static bool may_share(const struct emptying_times *times, int timer, int node,
                      int throat)
{
    const struct occupancy *occupancy = times->occupancy;
    const int owner = times->owner[timer];
    if (occupancy->liquid_beside[node] > 0 || !node_has_rings(occupancy, node))
        return owner == reservoir_of(times, throat);
    return owner == occupancy->network->n_throat + node ||
           (occupancy->feeder && owner == occupancy->feeder[node]);
}

// Each share and its place at a node point at each other, and timers count them. A
// place is one throat at one node, a row of the incidence.
static bool shares_fit(const struct emptying_times *times)
{
    const struct incidence *incidence = &times->occupancy->incidence;
    int *count = NEW_ARRAY(int, times->n), placed = 0;
    bool fits = true;
    for (int k = 0; k < 2 * times->occupancy->network->n_throat; k++)
        placed += times->share_place[k] >= 0;
    for (int k = 0; k < times->n_share; k++) {
        const struct evaporation_share *share = &times->share[k];
        const int at = times->share_incidence[k];
        const int node = times->air->site[share->air_place];
        count[share->timer]++;
        fits &= times->share_place[at] == k && share->part >= 0 &&
                at >= incidence->offset[node] && at < incidence->offset[node + 1] &&
                may_share(times, share->timer, node, incidence->throat[at]);
    }
    for (int k = 0; k < times->n; k++)
        fits &= count[k] == times->shares[k];
    free(count);
    return fits && placed == times->n_share;
}

// ---- the history -------------------------------------------------------------------

static bool lies_up_to(const double *value, int64_t n, double most)
{
    for (int64_t k = 0; k < n; k++)
        if (!(value[k] >= 0 && value[k] <= most)) return false;
    return true;
}

static bool rises(const double *value, int n)
{
    for (int k = 1; k < n; k++)
        if (value[k] < value[k - 1]) return false;
    return true;
}

// Times may be equal, as far as their digits reach, but never fall. Saturations and
// rates are only bounded.
static bool history_fits(const struct recorder *recorder)
{
    const struct drying_history *history = recorder->history;
    const int n = history->n_step, n_event = history->n_event;
    for (int k = 0; k < n; k++)
        if (history->change_offset[k + 1] < history->change_offset[k]) return false;
    if (history->films && history->films->n != n) return false;
    return history->change_offset[0] == 0 &&
           history->change_offset[n] == recorder->n_change &&
           lies_up_to(history->change_saturation, recorder->n_change, 1) &&
           lies_up_to(history->saturation, n, 1) &&
           lies_up_to(history->rate, n, INFINITY) &&
           lies_up_to(history->time, n, INFINITY) && rises(history->time, n) &&
           lies_up_to(history->event_time, n_event, INFINITY) &&
           rises(history->event_time, n_event);
}

// ---- the run -----------------------------------------------------------------------

// Throats and rings that have ended since the last step are listed once each. FLAGGED:
// is_ended marks exactly these; else they must be empty.
static bool ended_fit(const struct run *run, bool flagged)
{
    const int n = n_place_of(&run->occupancy);
    bool *seen = NEW_ARRAY(bool, n), fits = true;
    for (int k = 0; k < run->n_ended; k++) {
        const int place = run->ended[k];
        fits &= !seen[place] && (flagged || !is_liquid(&run->occupancy, place));
        seen[place] = true;
    }
    for (int t = 0; t < n && flagged; t++)
        fits &= seen[t] == run->is_ended[t];
    free(seen);
    return fits;
}

// Losses are of throats with liquid, in ascending order.
static bool losses_fit(const struct run *run)
{
    for (int k = 0; k < run->losses.n; k++) {
        const int throat = run->losses.loss[k].throat;
        if (run->occupancy.clusters.of_throat[throat] < 0 ||
            (k > 0 && run->losses.loss[k - 1].throat >= throat))
            return false;
    }
    return true;
}

bool run_fits(const struct run *run)
{
    const struct occupancy *occupancy = &run->occupancy;
    const struct clusters *clusters = &occupancy->clusters;
    const bool has_timers =
        run->conditions->liquid != LIQUID_VISCOUS && !run->conditions->kelvin;
    return identities_fit(clusters) && pieces_fit(clusters) && menisci_fit(clusters) &&
           liquid_fits(occupancy) && wet_nodes_fit(occupancy) &&
           vapour_fits(&occupancy->vapour) && ended_fit(run, !has_timers) &&
           losses_fit(run) && history_fits(&run->recorder) &&
           (!has_timers || (owners_fit(&run->times) && losing_fit(&run->times) &&
                            shares_fit(&run->times) &&
                            (!run->times.films || film_supply_fits(&run->times))));
}
