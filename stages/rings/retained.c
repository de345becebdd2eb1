// SPDX-License-Identifier: GPL-3.0-or-later
// At each site the exact bridge at the suction (bridges.h): volume, force F and the
// half-filling angles beta on both grains. Summed over sites, in their order,
//     volume = sum of volumes,
//     pull   = sum of F normal x (distance of the centres) normal,
// whose trace over three box volumes is the mean stress by which rings press the grains
// together (Love; Weber). Two rings on a grain meet where
//     angle between their normals < beta_1 + beta_2,
// for three equal grains that touch at beta = 30 degrees. From there on liquid fills
// throats, and rings no longer tell all of it.
#include "retained.h"

#include "basics/memory.h"
#include "bridges/bridges.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdlib.h>

// ---- where rings may stand ----------------------------------------------------------

// The arc of a ring is at most 2 tension / suction high, as its own curvature is more
// than the suction asks for.
struct ring_sites sites_of(const struct packing *packing, double suction,
                           double tension)
{
    double smallest = INFINITY;
    for (int i = 0; i < packing->n_particle; i++)
        smallest = fmin(smallest, packing->radius[i]);
    const double widest = 2 * tension / suction;
    struct ring_sites sites = {0};
    int count;
    sites.grain = neighbour_pairs(packing, widest / (2 * smallest), &count);
    sites.separation = NEW_ARRAY(double, count);
    sites.normal = NEW_ARRAY(struct vector, count);
    sites.dry = NEW_ARRAY(bool, count);
    for (int k = 0; k < count; k++) {
        const int i = sites.grain[k][0], j = sites.grain[k][1];
        const struct vector apart = nearest_image(packing, i, j);
        const double distance = norm(apart);
        const double open = distance - packing->radius[i] - packing->radius[j];
        if (open > widest) continue;
        const int at = sites.count++;
        sites.grain[at][0] = i;
        sites.grain[at][1] = j;
        sites.separation[at] = open;
        sites.normal[at] = scale(1 / distance, apart);
        sites.contacts += open <= 0;
    }
    return sites;
}

void sites_free(struct ring_sites *sites)
{
    free(sites->grain);
    free(sites->separation);
    free(sites->normal);
    free(sites->dry);
    *sites = (struct ring_sites){0};
}

// ---- the rings ----------------------------------------------------------------------

struct ring {
    double volume, force, angle[2]; // half-filling, rad
    enum status status;
};

static struct ring ring_at(const struct packing *packing,
                           const struct ring_sites *sites, int k,
                           const struct liquid *liquid, double suction)
{
    const int32_t *grain = sites->grain[k];
    const struct bridge bridge = {
        .radius = {packing->radius[grain[0]], packing->radius[grain[1]]},
        .contact_angle = {liquid->angle, liquid->angle},
        .surface_tension = liquid->tension};
    struct bridge_state state = {0};
    struct ring ring = {0};
    struct reason unused;
    ring.status = bridge_at_suction(&bridge, sites->separation[k], suction, &state,
                                    &ring.volume, &unused);
    if (ring.status) return (struct ring){.status = ring.status};
    ring.force = state.force;
    ring.angle[0] = state.half_filling_angle[0];
    ring.angle[1] = state.half_filling_angle[1];
    return ring;
}

static void add_pull(const struct packing *packing, const struct ring_sites *sites,
                     int k, double force, double pull[3][3])
{
    const int32_t *grain = sites->grain[k];
    const double distance =
        sites->separation[k] + packing->radius[grain[0]] + packing->radius[grain[1]];
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            pull[a][b] += force * distance * component(sites->normal[k], a) *
                          component(sites->normal[k], b);
}

// ---- rings that meet ----------------------------------------------------------------

// The ends of rings on a grain: twice the site, and 1 for its second grain.
struct ends {
    int *first; // (n_particle + 1) of each grain in LIST
    int *list;
};

static struct ends ends_of(const struct packing *packing,
                           const struct ring_sites *sites, const struct ring *ring)
{
    const int n = packing->n_particle;
    struct ends ends = {NEW_ARRAY(int, n + 1), NEW_ARRAY(int, 2 * sites->count)};
    for (int k = 0; k < sites->count; k++)
        for (int end = 0; end < 2 && !ring[k].status; end++)
            ends.first[sites->grain[k][end] + 1]++;
    for (int i = 0; i < n; i++)
        ends.first[i + 1] += ends.first[i];
    int *next = NEW_ARRAY(int, n);
    for (int k = 0; k < sites->count; k++)
        for (int end = 0; end < 2 && !ring[k].status; end++) {
            const int i = sites->grain[k][end];
            ends.list[ends.first[i] + next[i]++] = 2 * k + end;
        }
    free(next);
    return ends;
}

static int meeting_on(const struct ring_sites *sites, const struct ring *ring,
                      const int *list, int count)
{
    int meeting = 0;
    for (int p = 0; p < count; p++)
        for (int q = p + 1; q < count; q++) {
            const int a = list[p], b = list[q];
            const double sign = a % 2 == b % 2 ? 1 : -1;
            const double cosine =
                sign * dot(sites->normal[a / 2], sites->normal[b / 2]);
            const double both = ring[a / 2].angle[a % 2] + ring[b / 2].angle[b % 2];
            meeting += both >= M_PI || cosine > cos(both);
        }
    return meeting;
}

static int count_meeting(const struct packing *packing, const struct ring_sites *sites,
                         const struct ring *ring)
{
    struct ends ends = ends_of(packing, sites, ring);
    int meeting = 0;
    for (int i = 0; i < packing->n_particle; i++)
        meeting += meeting_on(sites, ring, ends.list + ends.first[i],
                              ends.first[i + 1] - ends.first[i]);
    free(ends.first);
    free(ends.list);
    return meeting;
}

enum status retain(const struct packing *packing, struct ring_sites *sites,
                   const struct liquid *liquid, double suction,
                   struct retained *retained, struct reason *reason)
{
    struct ring *ring = NEW_ARRAY(struct ring, sites->count);
#pragma omp parallel for schedule(dynamic, 64)
    for (int k = 0; k < sites->count; k++) {
        if (sites->dry[k])
            ring[k].status = STATUS_NO;
        else
            ring[k] = ring_at(packing, sites, k, liquid, suction);
    }
    *retained = (struct retained){0};
    enum status status = STATUS_OK;
    for (int k = 0; k < sites->count && !status; k++) {
        const int32_t *grain = sites->grain[k];
        if (ring[k].status == STATUS_NOT_CONVERGED)
            status =
                refuse(reason, STATUS_NOT_CONVERGED,
                       "no ring was found between grains %d and %d, %g m apart, at "
                       "a suction of %g Pa",
                       grain[0], grain[1], sites->separation[k], suction);
        sites->dry[k] = ring[k].status;
        if (ring[k].status) continue;
        retained->rings++;
        retained->volume += ring[k].volume;
        add_pull(packing, sites, k, ring[k].force, retained->pull);
    }
    if (!status) retained->meeting = count_meeting(packing, sites, ring);
    free(ring);
    return status;
}
