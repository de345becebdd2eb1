// SPDX-License-Identifier: GPL-3.0-or-later
// Discrete-event simulation of menisci in viscous liquid. In the order of an event:
//     the throat is brought up to date, and empties: its cluster may split;
//     what wet nodes evaporate is shared again where an end of a throat, or the vapour,
//     has changed:  share = evaporation of the node * section / sum of sections;
//     a meniscus whose throat evaporates more than would flow to it begins to move, one
//     in a full throat to which more flows stops (kept_flow.h);
//     each cluster touched gets a new scale, or its flow is found again.
// A change of the scale moves no end: they are readings of the cluster's clock,
//     reading = clock + scale (now - time).
// Both times count from when its flow was found: flows between menisci may be 1e9 times
// what evaporates, and last so small a part of the time since the start.
// Sums are changed by differences of compensated numbers, and added up whenever a flow
// is found.
#include "viscous_events.h"

#include "basics/memory.h"
#include "kept_flow.h"

#include <math.h>
#include <stdlib.h>

static int cluster_of(const struct viscous_events *events, int throat)
{
    return events->occupancy->clusters.of_throat[throat];
}

// --- clocks and ends -----------------------------------------------------------------

// Since the flow of CLUSTER was last found.
static double time_of(const struct viscous_events *events, int cluster)
{
    return compensated_difference(events->now, events->cluster[cluster].found);
}

static double reading(const struct viscous_events *events, int cluster)
{
    const struct cluster_events *its = &events->cluster[cluster];
    return its->clock + its->scale * (time_of(events, cluster) - its->time);
}

// By the clock that counts for THROAT of CLUSTER.
static double moment(const struct viscous_events *events, int cluster, int throat)
{
    return events->rate[throat] > 0 ? reading(events, cluster)
                                    : time_of(events, cluster);
}

static void bring_up(struct viscous_events *events, int cluster, int throat)
{
    if (events->rate[throat] == 0) return;
    const double until = moment(events, cluster, throat);
    compensated_add(&events->occupancy->liquid[throat],
                    -events->rate[throat] * (until - events->since[throat]));
    events->since[throat] = until;
}

static enum meniscus_queue queue_of(double rate)
{
    return rate > 0 ? QUEUE_LOSING : QUEUE_REFILLING;
}

// Of a throat whose liquid is up to date.
static void set_rate(struct viscous_events *events, int cluster, int throat,
                     double rate)
{
    const struct occupancy *occupancy = events->occupancy;
    struct cluster_events *its = &events->cluster[cluster];
    const double old = events->rate[throat];
    compensated_add(old > 0 ? &its->losing : &its->refilling, -fabs(old));
    compensated_add(rate > 0 ? &its->losing : &its->refilling, fabs(rate));
    events->rate[throat] = rate;
    if (old != 0 && (rate == 0 || queue_of(rate) != queue_of(old)))
        indexed_heap_take(&its->queue[queue_of(old)], events->end, events->place,
                          throat);
    if (rate == 0) return;
    const double left = compensated_value(occupancy->liquid[throat]);
    const double way = rate > 0 ? left : occupancy->volume[throat] - left;
    events->since[throat] = moment(events, cluster, throat);
    events->end[throat] = events->since[throat] + fmax(0, way) / fabs(rate);
    indexed_heap_put(&its->queue[queue_of(rate)], events->end, events->place, throat);
}

static double first_end(const struct viscous_events *events, int cluster,
                        enum meniscus_queue queue)
{
    const struct indexed_heap *heap = &events->cluster[cluster].queue[queue];
    return heap->n > 0 ? events->end[heap->item[0]] : INFINITY;
}

// The next event of CLUSTER, by its own time.
static struct viscous_event next_in(const struct viscous_events *events, int cluster)
{
    const struct cluster_events *its = &events->cluster[cluster];
    const double empties =
        fmax(0, first_end(events, cluster, QUEUE_LOSING) - reading(events, cluster)) /
        its->scale;
    const double refills =
        fmax(0, first_end(events, cluster, QUEUE_REFILLING) - time_of(events, cluster));
    const bool is_refill = refills <= empties;
    const struct indexed_heap *queue =
        &its->queue[is_refill ? QUEUE_REFILLING : QUEUE_LOSING];
    return (struct viscous_event){queue->n > 0 ? queue->item[0] : -1, is_refill,
                                  fmin(empties, refills)};
}

// When CLUSTER has its next event, its clock running at SCALE from now on.
static void set_scale(struct viscous_events *events, int cluster, double scale)
{
    struct cluster_events *its = &events->cluster[cluster];
    its->clock = reading(events, cluster);
    its->time = time_of(events, cluster);
    its->scale = scale;
    const double next = compensated_value(events->now) + next_in(events, cluster).span;
    events->next[cluster] = next;
    if (next < INFINITY)
        indexed_heap_put(&events->queue, events->next, events->next_place, cluster);
    else
        indexed_heap_take(&events->queue, events->next, events->next_place, cluster);
}

// --- what throats evaporate ----------------------------------------------------------

static void touch(struct viscous_events *events, int cluster)
{
    if (events->cluster[cluster].is_touched) return;
    events->cluster[cluster].is_touched = true;
    events->touched[events->n_touched++] = cluster;
}

// The meniscus of THROAT moves, and it loses LOSS from now on, below 0 only if it is
// not full.
static void lose(struct viscous_events *events, int cluster, int throat, double loss)
{
    bring_up(events, cluster, throat);
    events->flow->moving[throat] = true;
    if (loss < 0 && throat_is_full(events->occupancy, throat)) {
        kept_flow_stop(events->flow, cluster, throat);
        loss = 0;
    }
    const double scale = events->cluster[cluster].scale;
    set_rate(events, cluster, throat, loss > 0 ? loss / scale : loss);
}

static double loss_of(const struct viscous_events *events, int cluster, int throat)
{
    const double rate = events->rate[throat];
    return rate > 0 ? events->cluster[cluster].scale * rate : rate;
}

// Lets the meniscus of THROAT, which stays, move if it must.
static void begin(struct viscous_events *events, int cluster, int throat)
{
    const double loss =
        events->evaporation[throat] - kept_flow_inflow(events->flow, cluster, throat);
    if (loss > 0) lose(events, cluster, throat, loss);
}

// THROAT evaporates SHARE at END.
static void evaporate(struct viscous_events *events, int throat, int end, double share)
{
    const int cluster = cluster_of(events, throat);
    double *at_end = &events->share[2 * (size_t)throat];
    const double before = events->evaporation[throat];
    at_end[end] = share;
    events->evaporation[throat] = at_end[0] + at_end[1];
    const double more = events->evaporation[throat] - before;
    if (more == 0 || events->must_find) return;
    touch(events, cluster);
    compensated_add(&events->cluster[cluster].evaporation, more);
    if (!kept_flow_is_known(events->flow, cluster)) return;
    if (events->flow->moving[throat])
        lose(events, cluster, throat, loss_of(events, cluster, throat) + more);
    else
        begin(events, cluster, throat);
}

static void share_by_node(struct viscous_events *events, int node)
{
    const struct occupancy *occupancy = events->occupancy;
    const struct incidence *incidence = &occupancy->incidence;
    const double evaporation =
        events->pace * vapour_evaporation(&occupancy->vapour, node);
    const int from = incidence->offset[node], to = incidence->offset[node + 1];
    const double section = liquid_sections_at(occupancy, node);
    for (int k = from; k < to; k++) {
        const int throat = incidence->throat[k];
        const double its = liquid_section(occupancy, throat);
        if (!(its > 0)) continue;
        const int end = occupancy->network->throat_nodes[throat][1] == node;
        evaporate(events, throat, end, evaporation * (its / section));
    }
}

static void share_by_all(struct viscous_events *events)
{
    for (int k = 0; k < events->occupancy->n_wet; k++)
        share_by_node(events, events->occupancy->wet[k]);
}

static void find_pace(struct viscous_events *events)
{
    if (events->duration > 0) events->pace *= events->span / events->duration;
    events->span = events->duration = 0;
}

// Without kept vapour a node that dries changes what all others evaporate.
static void follow_vapour(struct viscous_events *events, bool has_dried)
{
    struct kept_vapour *kept = events->occupancy->vapour.kept;
    events->found_vapour = kept && kept_vapour_follow(kept);
    if (events->found_vapour) find_pace(events);
    if (kept ? events->found_vapour : has_dried) share_by_all(events);
    for (int k = 0; kept && !events->found_vapour && k < kept->n_gain; k++)
        share_by_node(events, kept->gain_site[k]);
}

// --- clusters ------------------------------------------------------------------------

static void reserve(struct viscous_events *events)
{
    const int before = events->capacity, n_id = events->occupancy->clusters.n_id;
    if (n_id <= before) return;
    const int capacity = events->capacity = 2 * n_id;
    const size_t n = (size_t)capacity;
    events->cluster = reallocate(events->cluster, n, sizeof *events->cluster);
    events->next = reallocate(events->next, n, sizeof(double));
    events->next_place = reallocate(events->next_place, n, sizeof(int));
    events->touched = reallocate(events->touched, n, sizeof(int));
    for (int c = before; c < capacity; c++) {
        events->cluster[c] = (struct cluster_events){.scale = 1};
        events->next_place[c] = -1;
    }
}

// Brings the menisci of CLUSTER up to now and leaves them without rates.
static void stop_all(struct viscous_events *events, int cluster)
{
    struct cluster_events *its = &events->cluster[cluster];
    for (int q = 0; q < QUEUES; q++) {
        for (int k = 0; k < its->queue[q].n; k++) {
            const int throat = its->queue[q].item[k];
            bring_up(events, cluster, throat);
            events->rate[throat] = 0;
        }
        indexed_heap_clear(&its->queue[q], events->place);
    }
    its->losing = its->refilling = (struct compensated){0};
    its->scale = 1;
    its->clock = its->time = 0;
    its->found = events->now;
}

// With the LOSSES of one cluster, or of all, which have been stopped.
static void take_losses(struct viscous_events *events, int n_loss)
{
    for (int k = 0; k < n_loss; k++) {
        const int throat = events->loss[k].throat;
        set_rate(events, cluster_of(events, throat), throat, events->loss[k].rate);
    }
}

// Its evaporation, added up.
static void add_up(struct viscous_events *events, int cluster)
{
    struct compensated sum = {0};
    const struct liquid_flow *flow = events->flow;
    for (int t = cluster_members_first(&flow->solver->members, cluster, LIST_MENISCI);
         t >= 0; t = next_throat(flow, t))
        compensated_add(&sum, events->evaporation[t]);
    events->cluster[cluster].evaporation = sum;
}

static enum status find_flow(struct viscous_events *events, int cluster,
                             struct reason *reason)
{
    int n_loss = 0;
    stop_all(events, cluster);
    add_up(events, cluster);
    const enum status status =
        liquid_flow_find_in(events->flow, cluster, events->loss, &n_loss, reason);
    if (status) return status;
    take_losses(events, n_loss);
    set_scale(events, cluster, 1);
    return STATUS_OK;
}

// The scale at which a cluster loses what it evaporates; 1 of one at rest.
static double balance(const struct viscous_events *events, int cluster)
{
    const struct cluster_events *its = &events->cluster[cluster];
    const double losing = compensated_value(its->losing);
    const double due =
        compensated_value(its->evaporation) + compensated_value(its->refilling);
    return losing > 0 || due > 0 ? due / losing : 1;
}

static void end_cluster(struct viscous_events *events, int cluster)
{
    stop_all(events, cluster);
    events->cluster[cluster].evaporation = (struct compensated){0};
    set_scale(events, cluster, 1);
}

// After what happened to its throats: a new scale, or a new flow.
static enum status settle(struct viscous_events *events, int cluster,
                          struct reason *reason)
{
    struct cluster_events *its = &events->cluster[cluster];
    its->is_touched = false;
    if (events->occupancy->clusters.size[cluster] == 0) {
        end_cluster(events, cluster);
        return STATUS_OK;
    }
    const double evaporation = compensated_value(its->evaporation);
    const double scale = balance(events, cluster);
    if (!kept_flow_may_serve(events->flow, cluster, evaporation, scale))
        return find_flow(events, cluster, reason);
    set_scale(events, cluster, scale);
    return STATUS_OK;
}

static enum status settle_touched(struct viscous_events *events, struct reason *reason)
{
    enum status status = STATUS_OK;
    for (int k = 0; k < events->n_touched; k++)
        if (!status) status = settle(events, events->touched[k], reason);
    events->n_touched = 0;
    return status;
}

// --- from event to event -------------------------------------------------------------

// Nodes that begin dry count as wet until the vapour has followed them.
static void follow_start(struct kept_vapour *kept)
{
    if (kept) kept_vapour_follow(kept);
}

struct viscous_events *viscous_events_create(struct occupancy *occupancy,
                                             struct liquid_flow *flow)
{
    const int n = occupancy->network->n_throat;
    struct viscous_events *events = NEW_ARRAY(struct viscous_events, 1);
    *events = (struct viscous_events){.occupancy = occupancy,
                                      .flow = flow,
                                      .pace = 1,
                                      .share = NEW_ARRAY(double, 2 * (size_t)n),
                                      .evaporation = NEW_ARRAY(double, n),
                                      .rate = NEW_ARRAY(double, n),
                                      .since = NEW_ARRAY(double, n),
                                      .end = NEW_ARRAY(double, n),
                                      .place = NEW_ARRAY(int, n),
                                      .loss = NEW_ARRAY(struct loss, n)};
    for (int t = 0; t < n; t++)
        events->place[t] = -1;
    viscous_events_forget(events);
    follow_start(occupancy->vapour.kept);
    return events;
}

void viscous_events_free(struct viscous_events *events)
{
    if (!events) return;
    for (int c = 0; c < events->capacity; c++)
        for (int q = 0; q < QUEUES; q++)
            indexed_heap_free(&events->cluster[c].queue[q]);
    indexed_heap_free(&events->queue);
    free(events->share);
    free(events->evaporation);
    free(events->rate);
    free(events->since);
    free(events->end);
    free(events->place);
    free(events->cluster);
    free(events->next);
    free(events->next_place);
    free(events->touched);
    free(events->loss);
    free(events);
}

void viscous_events_forget(struct viscous_events *events)
{
    for (int c = 0; c < events->capacity; c++) {
        stop_all(events, c);
        events->cluster[c].found = (struct compensated){0};
    }
    indexed_heap_clear(&events->queue, events->next_place);
    events->now = (struct compensated){0};
    events->must_find = true;
}

enum status viscous_events_find(struct viscous_events *events, struct reason *reason)
{
    if (!events->must_find) return STATUS_OK;
    int n_loss = 0;
    reserve(events);
    share_by_all(events);
    const enum status status =
        liquid_flow_find(events->flow, events->occupancy, events->evaporation,
                         events->loss, &n_loss, reason);
    if (status) return status;
    events->must_find = false;
    take_losses(events, n_loss);
    for (int c = 0; c < events->occupancy->clusters.n_id; c++) {
        add_up(events, c);
        set_scale(events, c, 1);
    }
    return STATUS_OK;
}

struct viscous_event viscous_events_next(const struct viscous_events *events)
{
    if (events->queue.n == 0) return (struct viscous_event){.throat = -1};
    return next_in(events, events->queue.item[0]);
}

double viscous_events_rate(const struct viscous_events *events)
{
    return events->pace * vapour_rate(&events->occupancy->vapour);
}

double viscous_events_advance(struct viscous_events *events, double span)
{
    struct occupancy *occupancy = events->occupancy;
    const double duration = span * events->pace / vapour_pace(&occupancy->vapour);
    compensated_add(&occupancy->total_liquid, -span * viscous_events_rate(events));
    compensated_add(&events->now, span);
    events->span += span;
    events->duration += duration;
    return duration;
}

// Its liquid becomes AMOUNT, from which it differs by rounding, and nothing is lost.
static void end_loss(struct viscous_events *events, int cluster, int throat,
                     double amount)
{
    struct occupancy *occupancy = events->occupancy;
    bring_up(events, cluster, throat);
    const double is = compensated_value(occupancy->liquid[throat]);
    compensated_add(&occupancy->total_liquid, amount - is);
    occupancy->liquid[throat] = (struct compensated){amount, 0};
    set_rate(events, cluster, throat, 0);
}

static void refill(struct viscous_events *events, int throat)
{
    const int cluster = cluster_of(events, throat);
    end_loss(events, cluster, throat, events->occupancy->volume[throat]);
    kept_flow_stop(events->flow, cluster, throat);
    touch(events, cluster);
}

// THROAT leaves CLUSTER.
static void take_evaporation(struct viscous_events *events, int cluster, int throat)
{
    compensated_add(&events->cluster[cluster].evaporation,
                    -events->evaporation[throat]);
}

// THROAT, which has moved from CLUSTER to another, takes what it has with it.
static void leave(struct viscous_events *events, int cluster, int throat)
{
    bring_up(events, cluster, throat);
    set_rate(events, cluster, throat, 0);
    take_evaporation(events, cluster, throat);
    touch(events, cluster_of(events, throat));
}

// Menisci at NODE, which gas has entered, with the ends that they have left.
static void begin_at_node(struct viscous_events *events, int node)
{
    const struct incidence *incidence = &events->occupancy->incidence;
    for (int k = incidence->offset[node]; k < incidence->offset[node + 1]; k++) {
        const int throat = incidence->throat[k], cluster = cluster_of(events, throat);
        if (cluster < 0) continue;
        touch(events, cluster);
        if (!events->flow->moving[throat] && kept_flow_is_known(events->flow, cluster))
            begin(events, cluster, throat);
    }
}

static void empty(struct viscous_events *events, int throat)
{
    struct occupancy *occupancy = events->occupancy;
    const int cluster = cluster_of(events, throat);
    const int32_t *node = occupancy->network->throat_nodes[throat];
    touch(events, cluster);
    end_loss(events, cluster, throat, 0);
    take_evaporation(events, cluster, throat);
    events->evaporation[throat] = 0;
    occupancy_empty_throat(occupancy, throat);
    liquid_flow_follow(events->flow, occupancy, throat);
    reserve(events);
    for (int k = 0; k < occupancy->clusters.n_moved; k++)
        leave(events, cluster, occupancy->clusters.moved[k]);
    for (int end = 0; end < 2; end++) {
        share_by_node(events, node[end]);
        begin_at_node(events, node[end]);
    }
    const int *wet_place = occupancy->wet_place;
    follow_vapour(events, wet_place[node[0]] < 0 || wet_place[node[1]] < 0);
}

enum status viscous_events_happen(struct viscous_events *events,
                                  struct viscous_event event, struct reason *reason)
{
    events->found_vapour = false;
    if (event.refills)
        refill(events, event.throat);
    else
        empty(events, event.throat);
    return settle_touched(events, reason);
}

double viscous_events_saturation(const struct viscous_events *events, int throat)
{
    const struct occupancy *occupancy = events->occupancy;
    if (events->rate[throat] == 0) return occupancy_saturation(occupancy, throat);
    const double until = moment(events, cluster_of(events, throat), throat);
    const double lost = events->rate[throat] * (until - events->since[throat]);
    const double left = compensated_value(occupancy->liquid[throat]) - lost;
    return fmin(1, fmax(0, left / occupancy->volume[throat]));
}
