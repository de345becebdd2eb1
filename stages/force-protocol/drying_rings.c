// SPDX-License-Identifier: GPL-3.0-or-later
// A ring consists of parts, one for each throat around its contact (drying.json). What
// is left of part k is the mean saturation of the rings at both nodes of its throat:
//     volume = sum of volume_k (s_i + s_j) / 2,
//     bare   = sum of volume_k (1 - S_k) / sum of volume_k,  S_k of the throat,
//     pull   = bare F(volume, gap),
// F the exact bridge of that volume, from tables (bridges/ratios.h, error below 1e-5).
// A full throat draws by its suction, so the ring counts as far as gas has bared it,
// as with rings.left=volume. F goes to 2 pi R sigma cos(theta) at contact as the volume
// goes to 0: a ring pulls to its last. A ring across a gap breaks before.
#include "drying_rings.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// A ring whose volume is this part of the whole, or less, is outside of the tables,
// which then go on by its scaling.
static const double LEAST_PART = 1e-3;

// The rings of each grain: by counting, in their order.
static void list_by_grain(struct drying_rings *rings, int n_grain)
{
    rings->begin = NEW_ARRAY(int, n_grain + 2);
    rings->of_grain = NEW_ARRAY(int, 2 * (size_t)rings->n);
    for (int r = 0; r < rings->n; r++)
        for (int end = 0; end < 2; end++)
            rings->begin[rings->grain[r][end] + 2]++;
    for (int i = 0; i < n_grain; i++)
        rings->begin[i + 2] += rings->begin[i + 1];
    for (int r = 0; r < rings->n; r++)
        for (int end = 0; end < 2; end++) // moves the begin of the grain to its end
            rings->of_grain[rings->begin[rings->grain[r][end] + 1]++] = r;
}

static void measure(struct drying_rings *rings, const struct network *network, int r,
                    struct bridge_sizes *sizes)
{
    const struct ring_record *record = rings->record;
    const int32_t *grain = network->face_particles[record->face[r]];
    const double first = network->packing.radius[grain[0]],
                 second = network->packing.radius[grain[1]];
    const struct vector apart = subtract(second_grain(network, record->face[r]),
                                         network->packing.position[grain[0]]);
    rings->grain[r][0] = grain[0];
    rings->grain[r][1] = grain[1];
    rings->direction[r] = scale(1 / norm(apart), apart);
    rings->radius[r] = 2 * first * second / (first + second);
    rings->asymmetry[r] = bridge_asymmetry(first, second);
    rings->gap[r] = fmax(0, record->separation[r]) / rings->radius[r];
    for (int64_t k = record->offset[r]; k < record->offset[r + 1]; k++)
        rings->whole[r] += record->volume[k];
    sizes->radius[0] = fmin(sizes->radius[0], fmin(first, second));
    sizes->radius[1] = fmax(sizes->radius[1], fmax(first, second));
    sizes->volume[0] = fmin(sizes->volume[0], LEAST_PART * rings->whole[r]);
    sizes->volume[1] = fmax(sizes->volume[1], rings->whole[r]);
}

enum status drying_rings_init(const struct network *network,
                              const struct ring_record *record, double surface_tension,
                              double contact_angle, struct drying_rings *rings,
                              struct reason *reason)
{
    const int n = record->n;
    *rings = (struct drying_rings){.n = n,
                                   .record = record,
                                   .surface_tension = surface_tension,
                                   .grain = allocate((size_t)n, sizeof *rings->grain),
                                   .direction = NEW_ARRAY(struct vector, n),
                                   .radius = NEW_ARRAY(double, n),
                                   .asymmetry = NEW_ARRAY(double, n),
                                   .gap = NEW_ARRAY(double, n),
                                   .whole = NEW_ARRAY(double, n)};
    struct bridge_sizes sizes = {.radius = {INFINITY, 0}, .volume = {INFINITY, 0}};
    for (int r = 0; r < n; r++) {
        if (network->face_particles[record->face[r]][1] < 0)
            return refuse(reason, STATUS_BAD_DATA,
                          "/rings/face: row %d: must be a face between two grains", r);
        measure(rings, network, r, &sizes);
    }
    list_by_grain(rings, network->packing.n_particle);
    if (n == 0) return STATUS_OK;
    return bridge_ratios_create(&sizes, contact_angle, &rings->table, reason);
}

void drying_rings_free(struct drying_rings *rings)
{
    free(rings->grain);
    free(rings->direction);
    free(rings->radius);
    free(rings->asymmetry);
    free(rings->gap);
    free(rings->whole);
    free(rings->begin);
    free(rings->of_grain);
    bridge_ratios_free(rings->table);
    *rings = (struct drying_rings){0};
}

// Volume of ring R now (m3); BARE is what gas has bared of it, from 0 to 1.
static double volume_now(const struct drying_rings *rings,
                         const struct liquid_loads *liquid, int r, double *bare)
{
    const struct ring_record *record = rings->record;
    double left = 0, covered = 0;
    for (int64_t k = record->offset[r]; k < record->offset[r + 1]; k++) {
        const int throat = record->throat[k];
        left += record->volume[k] * liquid_loads_rings(liquid, throat);
        covered += record->volume[k] * liquid_loads_filling(liquid, throat);
    }
    *bare = fmax(0, 1 - covered / rings->whole[r]);
    return left;
}

void drying_rings_pull(const struct drying_rings *rings,
                       const struct liquid_loads *liquid, double *pull)
{
#pragma omp parallel for schedule(static)
    for (int r = 0; r < rings->n; r++) {
        const double radius = rings->radius[r];
        double bare, force = 0;
        const double volume =
            volume_now(rings, liquid, r, &bare) / (radius * radius * radius);
        if (bare > 0 && volume > 0)
            bridge_ratios_forces(rings->table, 1, &rings->asymmetry[r], &volume,
                                 &rings->gap[r], &force);
        pull[r] = bare * force * rings->surface_tension * radius;
    }
}

struct vector drying_rings_force(const struct drying_rings *rings, const double *pull,
                                 int grain)
{
    struct vector force = {0};
    for (int k = rings->begin[grain]; k < rings->begin[grain + 1]; k++) {
        const int r = rings->of_grain[k];
        const double sign = rings->grain[r][0] == grain ? 1 : -1;
        force = add(force, scale(sign * pull[r], rings->direction[r]));
    }
    return force;
}
