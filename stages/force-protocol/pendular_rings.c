// SPDX-License-Identifier: GPL-3.0-or-later
// Liquid rings at contacts. A ring of a given volume has the force of the exact bridge
// (bridges/bridges.h). A ring in equilibrium with a suction needs its volume V first:
//     suction(V, separation) = law.suction,
// solved for log V. The suction falls with V, except next to rupture, where it falls
// again towards small V: so there is a maximum, and below rupture no bridge at all.
// Regula falsi with every third step a bisection finds the root of larger volume; when
// a smaller trial has less suction than a larger one, the maximum is found first by
// golden section, and if it is below law.suction there is no ring. Suction is concave
// over log V, which bounds the maximum and ends that search early. Contacts of one
// shape are solved once.
#include "pendular_rings.h"

#include "basics/memory.h"
#include "bridges/bridges.h"

#include <stdlib.h>

// Dimensionless volumes between which the one in equilibrium is looked for. Where even
// the largest has more suction than the liquid, the ring is taken to have that volume.
static const double MIN_VOLUME = 1e-9, MAX_VOLUME = 1;

static double cubed(double x)
{
    return x * x * x;
}

static struct bridge bridge_of(const double radius[2], const struct ring_law *law,
                               double volume)
{
    struct bridge bridge = {.radius = {radius[0], radius[1]},
                            .contact_angle = {law->contact_angle, law->contact_angle},
                            .surface_tension = law->surface_tension};
    bridge.volume = volume * cubed(bridge_effective_radius(&bridge));
    return bridge;
}

// --- one ring ----------------------------------------------------------------------

// A trial volume: its suction, and log(suction / law.suction); -INFINITY where there is
// no suction, INFINITY where the bridge ruptures.
struct trial {
    double log_volume, suction, excess;
};

// Twice the rupture distance of [G 2] is certainly beyond rupture.
static bool ruptures(const struct bridge *bridge, double separation)
{
    return separation > 2 * bridge_rupture_distance(bridge);
}

static enum status try_volume(const double radius[2], double separation,
                              const struct ring_law *law, struct trial *trial,
                              struct reason *reason)
{
    const struct bridge bridge = bridge_of(radius, law, exp(trial->log_volume));
    struct bridge_state state;
    trial->excess = INFINITY;
    if (ruptures(&bridge, separation)) return STATUS_OK;
    const enum status status = bridge_solve(&bridge, separation, &state, reason);
    trial->suction = state.suction;
    trial->excess = status == STATUS_NO ? INFINITY
                    : state.suction > 0 ? log(state.suction / law->suction)
                                        : -INFINITY;
    return status == STATUS_NO ? STATUS_OK : status;
}

// Upper bound of the suction between the first and the last of three trials: suction is
// concave over the logarithm of the volume.
static double suction_bound(const struct trial of[3])
{
    const double left = of[1].log_volume - of[0].log_volume;
    const double right = of[2].log_volume - of[1].log_volume;
    return of[1].suction + fmax((of[1].suction - of[2].suction) * left / right,
                                (of[1].suction - of[0].suction) * right / left);
}

// The middle one of three trials has the most suction, but too little. Golden-section
// search for one that has enough, until the bound says that there is none.
static enum status find_most_suction(const double radius[2], double separation,
                                     const struct ring_law *law, struct trial of[3],
                                     struct reason *reason)
{
    static const double narrow = 1e-6;
    while (of[1].excess < 0 && suction_bound(of) > law->suction &&
           of[2].log_volume - of[0].log_volume > narrow) {
        const double left = of[1].log_volume - of[0].log_volume;
        const double right = of[2].log_volume - of[1].log_volume;
        const int side = right > left ? 2 : 0;
        struct trial trial = {.log_volume = of[1].log_volume +
                                            (side ? 0.382 * right : -0.382 * left)};
        const enum status status = try_volume(radius, separation, law, &trial, reason);
        if (status) return status;
        if (trial.suction > of[1].suction) {
            of[2 - side] = of[1];
            of[1] = trial;
        } else
            of[side] = trial;
    }
    return STATUS_OK;
}

// The dimensionless volume in equilibrium; *VOLUME is 0 where there is none. Regula
// falsi, every third step a bisection; once a trial has less suction than a larger one,
// from the one that has the most.
static enum status find_volume(const double radius[2], double separation,
                               const struct ring_law *law, double *volume,
                               struct reason *reason)
{
    static const double accuracy = 1e-12;
    struct trial low = {log(MIN_VOLUME), 0, INFINITY};
    struct trial high = {log(MAX_VOLUME), -INFINITY, -INFINITY};
    struct trial beyond = high;
    *volume = 0;
    // Between plates this far apart no liquid has that suction, still less between
    // spheres.
    if (separation * law->suction >= 2 * law->surface_tension * cos(law->contact_angle))
        return STATUS_OK;
    for (int step = 1; high.log_volume - low.log_volume > accuracy; step++) {
        const double share = low.excess / (low.excess - high.excess);
        struct trial trial = {
            .log_volume = low.log_volume +
                          (step % 3 && isfinite(share) && share > 0 ? share : 0.5) *
                              (high.log_volume - low.log_volume)};
        const enum status status = try_volume(radius, separation, law, &trial, reason);
        if (status) return status;
        if (isinf(low.excess) && trial.excess < 0 && trial.suction < high.suction) {
            struct trial of[3] = {trial, high, beyond};
            const enum status failed =
                find_most_suction(radius, separation, law, of, reason);
            if (failed || of[1].excess < 0) return failed;
            trial = of[1];
            high = of[2];
        }
        if (fabs(trial.excess) <= accuracy) low = high = trial;
        if (trial.excess > 0) {
            low = trial;
        } else {
            beyond = high;
            high = trial;
        }
    }
    if (low.excess < INFINITY) *volume = exp(low.log_volume);
    return STATUS_OK;
}

enum status solve_ring(const double radius[2], double separation,
                       const struct ring_law *law, double *volume, double *force,
                       struct reason *reason)
{
    double part = law->volume;
    *volume = *force = 0;
    if (law->rule == RING_SUCTION) {
        const enum status status = find_volume(radius, separation, law, &part, reason);
        if (status) return status;
    }
    if (!(part > 0)) return STATUS_OK;
    const struct bridge bridge = bridge_of(radius, law, part);
    if (ruptures(&bridge, separation)) return STATUS_OK;
    struct bridge_state state;
    const enum status status = bridge_solve(&bridge, separation, &state, reason);
    if (status == STATUS_NO) return STATUS_OK; // it ruptures
    if (status) return status;
    *volume = bridge.volume;
    *force = state.force;
    return STATUS_OK;
}

// --- all of them -------------------------------------------------------------------

// Between two grains that share a face.
struct ring {
    int32_t grain[2]; // the lower first; the second below 0: none
    double radius[2]; // m, of the two
    double gap;       // m; 0 where they overlap
    double angle;     // sum over the throats beside the face, each from both its sides;
                      // 4 pi where the foot lies within it
    double volume;    // m3
    double force;     // N
};

// The index of the ring of a sector: its face, or in a layer, and where the face is
// missing, its throat.
static int ring_at(const struct sectors *sectors, const struct sector *sector)
{
    return sectors->layer || sector->face < 0
               ? sectors->network->n_face + sector->throat
               : sector->face;
}

// The angle at the foot between the two ends of the throat.
static double angle_of(const struct sector *sector)
{
    const struct vector from = subtract(sector->from, sector->foot);
    const struct vector to = subtract(sector->to, sector->foot);
    return atan2(norm(cross(from, to)), dot(from, to));
}

// Walls and auxiliary grains hold no ring.
static bool has_ring(const struct sectors *sectors, const struct sector *sector)
{
    const struct packing *packing = &sectors->network->packing;
    return sector->beyond >= 0 && !is_auxiliary(packing, sector->grain) &&
           !is_auxiliary(packing, sector->beyond);
}

static void add_to_ring(const struct sectors *sectors, const struct sector *sector,
                        struct ring *ring)
{
    const double *radius = sectors->network->packing.radius;
    const int low = sector->grain < sector->beyond ? sector->grain : sector->beyond;
    const int high = sector->grain < sector->beyond ? sector->beyond : sector->grain;
    ring->grain[0] = low;
    ring->grain[1] = high;
    ring->radius[0] = radius[low];
    ring->radius[1] = radius[high];
    ring->gap = fmax(0, distance(sector->across, sector->centre) -
                            (radius[low] + radius[high]));
    ring->angle += angle_of(sector);
    if (!sectors->layer && sector->face < 0) ring->angle = 4 * M_PI;
}

// The rings at faces, then those at throats, not solved yet. The caller frees them.
static struct ring *list_rings(struct sectors *sectors, int n)
{
    struct ring *ring = NEW_ARRAY(struct ring, n);
    for (int r = 0; r < n; r++)
        ring[r].grain[1] = -1;
    for (int t = 0; t < sectors->network->n_throat; t++) {
        const int count = sectors_at(sectors, t);
        for (int k = 0; k < count; k++)
            if (has_ring(sectors, &sectors->sector[k]))
                add_to_ring(sectors, &sectors->sector[k],
                            &ring[ring_at(sectors, &sectors->sector[k])]);
    }
    return ring;
}

static enum status solve(const struct ring_law *law, struct ring *ring,
                         struct reason *reason)
{
    return solve_ring(ring->radius, ring->gap, law, &ring->volume, &ring->force,
                      reason);
}

// Whether the ring in equilibrium would be larger than find_volume looks.
static bool is_cut_off(const struct ring_law *law, const struct ring *ring)
{
    const double largest = bridge_of(ring->radius, law, MAX_VOLUME).volume;
    return law->rule == RING_SUCTION && ring->grain[1] >= 0 &&
           ring->volume > (1 - 1e-9) * largest;
}

static int by_shape(const void *a, const void *b)
{
    const struct ring *p = *(struct ring *const *)a, *q = *(struct ring *const *)b;
    const double of_p[] = {p->radius[0], p->radius[1], p->gap};
    const double of_q[] = {q->radius[0], q->radius[1], q->gap};
    for (int k = 0; k < 3; k++)
        if (of_p[k] != of_q[k]) return of_p[k] < of_q[k] ? -1 : 1;
    return 0;
}

// The rings between grains, sorted by shape. The caller frees the list.
static struct ring **sorted(struct ring *ring, int n, int *count)
{
    struct ring **list = NEW_ARRAY(struct ring *, n);
    *count = 0;
    for (int r = 0; r < n; r++)
        if (ring[r].grain[1] >= 0) list[(*count)++] = &ring[r];
    qsort(list, (size_t)*count, sizeof(struct ring *), by_shape);
    return list;
}

// Solves each shape once: contacts of equal grains are all alike. Reports the first
// failure in that order, whatever the number of threads.
static enum status solve_all(const struct ring_law *law, int n, struct ring *ring,
                             struct reason *reason)
{
    int count, failed = n;
    struct ring **list = sorted(ring, n, &count);
#pragma omp parallel for schedule(dynamic, 16) reduction(min : failed)
    for (int k = 0; k < count; k++) {
        struct reason unused;
        const bool is_known = k > 0 && by_shape(&list[k - 1], &list[k]) == 0;
        if (!is_known && solve(law, list[k], &unused)) failed = k < failed ? k : failed;
    }
    struct reason why;
    enum status status = STATUS_OK;
    if (failed < n) status = solve(law, list[failed], &why);
    for (int k = 1; k < count; k++)
        if (by_shape(&list[k - 1], &list[k]) == 0) {
            list[k]->volume = list[k - 1]->volume;
            list[k]->force = list[k - 1]->force;
        }
    const int32_t *grain = failed < n ? list[failed]->grain : NULL;
    free(list);
    if (status == STATUS_OK) return STATUS_OK;
    return refuse(reason, status, "ring between grains %d and %d: %.400s", grain[0],
                  grain[1], why.text);
}

static struct vector part_of_ring(const struct sectors *sectors,
                                  const struct sector *sector, const void *rings)
{
    if (!has_ring(sectors, sector)) return (struct vector){0};
    const struct ring *ring = (const struct ring *)rings + ring_at(sectors, sector);
    if (!(ring->angle > 0)) return (struct vector){0};
    const double share = 2 * angle_of(sector) / ring->angle;
    const struct vector apart = subtract(sector->across, sector->centre);
    return scale(share * ring->force / norm(apart), apart);
}

enum status find_pendular_rings(struct sectors *sectors, const struct ring_law *law,
                                struct pendular_rings *rings, struct reason *reason)
{
    const int n = sectors->network->n_face + sectors->network->n_throat;
    struct ring *ring = list_rings(sectors, n);
    *rings = (struct pendular_rings){0};
    const enum status status = solve_all(law, n, ring, reason);
    for (int r = 0; r < n && !status; r++) {
        rings->count += ring[r].force != 0;
        rings->cut_off += is_cut_off(law, &ring[r]);
        rings->largest = fmax(rings->largest, fabs(ring[r].force));
    }
    if (!status) rings->patches = collect_patches(sectors, part_of_ring, ring);
    free(ring);
    return status;
}
