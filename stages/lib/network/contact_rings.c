// SPDX-License-Identifier: GPL-3.0-or-later
// A ring stands around the middle m of the gap between two grains that share a face.
// The throat from node a to node b, a side of this face, faces the part
//     share = angle(a - m, b - m) / sum of these angles around the face,
// and leaves, when gas enters it at a suction p,
//     volume = share V(p, separation),   V of the exact bridge at that suction,
// reduced together with its other parts if they exceed MOST_IN_RINGS of the throat.
//
// At contact V ~ p^-2, and a ring is there at any suction and any contact angle below
// 90 degrees; across a gap there is none above a suction that falls with the contact
// angle. Below a suction of tension cos(angle) over the effective radius a ring reaches
// around its smaller grain and has long met others: it is taken at that suction.
// Two grains hold no ring across a gap wider than 2 tension cos(angle) / p: no
// liquid has that suction between plates so far apart.
#include "network/contact_rings.h"

#include "basics/memory.h"
#include "bridges/bridges.h"

#include <math.h>
#include <stdlib.h>

// ---- where rings may stand ----------------------------------------------------------

static bool holds_ring(const struct network *network, int face)
{
    const int32_t *grain = network->face_particles[face];
    return grain[1] >= 0 && !is_auxiliary(&network->packing, grain[0]) &&
           !is_auxiliary(&network->packing, grain[1]);
}

// Separation at FACE; MIDDLE of the gap, or of what two grains share.
static double gap_at(const struct network *network, int face, struct vector *middle)
{
    const int32_t *grain = network->face_particles[face];
    const double *radius = network->packing.radius;
    const struct vector centre = network->packing.position[grain[0]];
    const struct vector apart = subtract(second_grain(network, face), centre);
    const double along = norm(apart);
    const double separation = along - radius[grain[0]] - radius[grain[1]];
    *middle = add(centre, scale((radius[grain[0]] + separation / 2) / along, apart));
    return separation;
}

static double angle_between(struct vector a, struct vector b)
{
    return atan2(norm(cross(a, b)), dot(a, b));
}

// Angles under which throats are seen from their rings; SUM (n_face) of each ring.
static void find_angles(const struct network *network, struct contact_rings *rings,
                        const struct vector *middle, double *sum)
{
    const struct throat_sides *parts = &rings->parts;
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        for (int64_t k = parts->offset[t]; k < parts->offset[t + 1]; k++) {
            const int face = parts->face[k];
            if (!isfinite(rings->separation[face])) continue;
            const struct throat_side side = throat_side(network, parts, t, k);
            rings->share[k] = angle_between(subtract(side.first, middle[face]),
                                            subtract(side.second, middle[face]));
            sum[face] += rings->share[k];
        }
    }
}

enum status contact_rings_init(const struct network *network,
                               struct contact_rings *rings, struct reason *reason)
{
    *rings = (struct contact_rings){0};
    const enum status status = throat_sides_init(network, &rings->parts, reason);
    if (status) return status;
    rings->n_part = (int)rings->parts.offset[network->n_throat];
    rings->share = NEW_ARRAY(double, rings->n_part);
    rings->separation = NEW_ARRAY(double, network->n_face);
    struct vector *middle = NEW_ARRAY(struct vector, network->n_face);
    double *sum = NEW_ARRAY(double, network->n_face);
    int n = 0;
    for (int face = 0; face < network->n_face; face++) {
        rings->separation[face] = INFINITY;
        if (!holds_ring(network, face)) continue;
        rings->separation[face] = gap_at(network, face, &middle[face]);
        n++;
    }
    find_angles(network, rings, middle, sum);
    for (int k = 0; k < rings->n_part; k++)
        if (sum[rings->parts.face[k]] > 0) rings->share[k] /= sum[rings->parts.face[k]];
    free(middle);
    free(sum);
    if (n > 0) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "/faces/particles: rings need two grains that share a face "
                  "(tessellate in three dimensions makes them)");
}

void contact_rings_free(struct contact_rings *rings)
{
    throat_sides_free(&rings->parts);
    free(rings->share);
    free(rings->separation);
    *rings = (struct contact_rings){0};
}

// ---- what they hold -----------------------------------------------------------------

// Volume (m3) of the ring at FACE and that suction; 0: there is none.
static enum status ring_volume(const struct network *network,
                               const struct contact_rings *rings, int face,
                               const struct ring_liquid *liquid, double suction,
                               double *volume)
{
    const double angle = liquid->contact_angle, separation = rings->separation[face];
    const int32_t *grain = network->face_particles[face];
    const double sum =
        network->packing.radius[grain[0]] + network->packing.radius[grain[1]];
    const double radius =
        2 * network->packing.radius[grain[0]] * network->packing.radius[grain[1]] / sum;
    suction = fmax(suction, liquid->surface_tension * cos(angle) / radius);
    *volume = 0;
    if (!(separation * suction < 2 * liquid->surface_tension * cos(angle)))
        return STATUS_OK;
    const struct bridge bridge = {.radius = {network->packing.radius[grain[0]],
                                             network->packing.radius[grain[1]]},
                                  .contact_angle = {angle, angle},
                                  .surface_tension = liquid->surface_tension};
    struct bridge_state state;
    struct reason unused;
    const enum status status =
        bridge_at_suction(&bridge, separation, suction, &state, volume, &unused);
    if (status) *volume = 0;
    return status == STATUS_NO ? STATUS_OK : status;
}

static enum status refuse_ring(const struct network *network,
                               const struct contact_rings *rings, int face,
                               struct reason *reason)
{
    const int32_t *grain = network->face_particles[face];
    const double apart = rings->separation[face];
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "/faces/particles: row %d: no ring was found between grains %d and "
                  "%d, of radii %.4g and %.4g m, which %s by %.4g m",
                  face, grain[0], grain[1], network->packing.radius[grain[0]],
                  network->packing.radius[grain[1]],
                  apart < 0 ? "overlap" : "are apart", fabs(apart));
}

bool limit_parts(const struct network *network, const struct contact_rings *rings,
                 int throat, double *volume)
{
    const int64_t begin = rings->parts.offset[throat],
                  end = rings->parts.offset[throat + 1];
    const double most = MOST_IN_RINGS * throat_volume(network, throat);
    double sum = 0;
    for (int64_t k = begin; k < end; k++)
        sum += volume[k];
    if (!(sum > most)) return false;
    for (int64_t k = begin; k < end; k++)
        volume[k] *= most / sum;
    return true;
}

// Parts by their rings: those of face f are part[first[f]] .. part[first[f+1] - 1].
struct parts_of_rings {
    int *first, *part, *throat; // (n_face+1), (n_part), (n_part) by part
};

static struct parts_of_rings sort_by_rings(const struct network *network,
                                           const struct contact_rings *rings)
{
    const struct throat_sides *parts = &rings->parts;
    struct parts_of_rings by = {NEW_ARRAY(int, network->n_face + 2),
                                NEW_ARRAY(int, rings->n_part),
                                NEW_ARRAY(int, rings->n_part)};
    for (int k = 0; k < rings->n_part; k++)
        by.first[parts->face[k] + 2]++;
    for (int f = 0; f < network->n_face; f++)
        by.first[f + 2] += by.first[f + 1];
    for (int t = 0; t < network->n_throat; t++)
        for (int64_t k = parts->offset[t]; k < parts->offset[t + 1]; k++) {
            by.throat[k] = t;
            by.part[by.first[parts->face[k] + 1]++] = (int)k; // moves to its end
        }
    return by;
}

// Rising suctions; a handful.
static void sort_by_suction(int *part, int n, const int *throat, const double *suction)
{
    for (int k = 1; k < n; k++) {
        const int moved = part[k];
        int to = k;
        for (; to > 0 && suction[throat[part[to - 1]]] > suction[throat[moved]]; to--)
            part[to] = part[to - 1];
        part[to] = moved;
    }
}

// The N parts of the ring at FACE, not yet limited, at rising suctions: once it has
// broken it stays broken, and equal suctions are solved once.
static enum status find_parts(const struct network *network,
                              const struct contact_rings *rings,
                              const struct ring_liquid *liquid, int face,
                              const int *part, int n, const int *throat,
                              const double *suction, double *volume)
{
    double solved = 0, whole = INFINITY;
    for (int k = 0; k < n; k++) {
        const double p = suction[throat[part[k]]];
        volume[part[k]] = 0;
        if (!(p > 0) || !(rings->share[part[k]] > 0) || !(whole > 0)) continue;
        if (p > solved) {
            const enum status status =
                ring_volume(network, rings, face, liquid, p, &whole);
            if (status) return status;
            solved = p;
        }
        volume[part[k]] = rings->share[part[k]] * whole;
    }
    return STATUS_OK;
}

enum status ring_volumes(const struct network *network,
                         const struct contact_rings *rings,
                         const struct ring_liquid *liquid, const double *suction,
                         double *volume, int *limited, struct reason *reason)
{
    struct parts_of_rings by = sort_by_rings(network, rings);
    int failed = network->n_face;
#pragma omp parallel for schedule(dynamic, 64) reduction(min : failed)
    for (int f = 0; f < network->n_face; f++) {
        int *part = by.part + by.first[f];
        const int n = by.first[f + 1] - by.first[f];
        sort_by_suction(part, n, by.throat, suction);
        if (find_parts(network, rings, liquid, f, part, n, by.throat, suction, volume))
            failed = f < failed ? f : failed;
    }
    free(by.first);
    free(by.part);
    free(by.throat);
    if (failed < network->n_face) return refuse_ring(network, rings, failed, reason);
    *limited = 0;
    for (int t = 0; t < network->n_throat; t++)
        *limited += limit_parts(network, rings, t, volume);
    return STATUS_OK;
}

enum status whole_rings(const struct network *network,
                        const struct contact_rings *rings,
                        const struct ring_liquid *liquid, double suction,
                        const bool *wanted, double *whole, struct reason *reason)
{
    int failed = network->n_face;
#pragma omp parallel for schedule(dynamic, 64) reduction(min : failed)
    for (int f = 0; f < network->n_face; f++) {
        whole[f] = 0;
        if (wanted[f] && ring_volume(network, rings, f, liquid, suction, &whole[f]))
            failed = f < failed ? f : failed;
    }
    if (failed == network->n_face) return STATUS_OK;
    return refuse_ring(network, rings, failed, reason);
}
