// SPDX-License-Identifier: GPL-3.0-or-later
// Tables at seventeen ratios of radii, from exact solutions.
//
// Only those patches are made that a pair of the given grains can need: of a smallest
// grain a and a largest one b, effective radii at the asymmetry e = s^3 are from a (1 +
// e) to b (1 - e).
#include "basics/memory.h"
#include "bridges/ratios_layout.h"
#include "bridges/table_make.h"

#include <stdlib.h>

// ---- what to make -------------------------------------------------------------------

// The patches of effective radii from LEAST to MOST.
static struct range patches_of(const struct bridge_sizes *sizes, double least,
                               double most)
{
    const double low = sizes->volume[0] / (most * most * most);
    const double high = sizes->volume[1] / (least * least * least);
    return (struct range){place_volume(low * (1 - 1e-9)).patch,
                          place_volume(high * (1 + 1e-9)).patch};
}

static double difference_at(double node)
{
    const double s = node / INTERVALS;
    return s * s * s;
}

static struct range joined(struct range a, struct range b)
{
    if (a.last < a.first) return b;
    return (struct range){a.first < b.first ? a.first : b.first,
                          a.last > b.last ? a.last : b.last};
}

// Whether any two bodies have different radii.
static bool are_unequal(const struct bridge_sizes *sizes)
{
    return sizes->plane[0] > 0 ||
           bridge_asymmetry(sizes->radius[0], sizes->radius[1]) > 0;
}

static void find_ranges(const struct bridge_sizes *sizes, struct bridge_ratios *ratios)
{
    const double *radius = sizes->radius;
    const double least = sizes->volume[0] / (radius[1] * radius[1] * radius[1]);
    const double most = sizes->volume[1] / (radius[0] * radius[0] * radius[0]);
    const double largest = bridge_asymmetry(radius[0], radius[1]);
    ratios->equal_range = patches_of(sizes, radius[0], radius[1]);
    ratios->as_it_is =
        !are_unequal(sizes) && least >= BRIDGE_TABLE_LEAST && most <= BRIDGE_TABLE_MOST;
    for (int k = 0; k < INTERVALS; k++) {
        const double e = difference_at(k);
        ratios->range[k] = (struct range){0, -1};
        if (largest > 0 && k < (largest + 1e-9) * INTERVALS)
            ratios->range[k] =
                patches_of(sizes, radius[0] * (1 + e),
                           fmax(radius[1] * (1 - e), radius[0] * (1 + e)));
    }
    struct range *last = &ratios->range[INTERVALS - 1];
    if (sizes->plane[0] > 0)
        *last = joined(*last, patches_of(sizes, sizes->plane[0], sizes->plane[1]));
}

// Whether a bridge of volumes in half octave HALF may need table K.
static bool needs(const struct bridge_ratios *ratios, int half, int k)
{
    for (int i = 0; i < INTERVALS; i++) {
        const int first = first_of_stencil(i);
        const struct range range = ratios->range[i];
        if (k >= first && k < first + STENCIL && range.last >= range.first &&
            half >= range.first / IN_HALF && half <= range.last / IN_HALF)
            return true;
    }
    return false;
}

// A patch to be made: of table TABLE, a half of an octave, or if that is below 0 of the
// table of equal grains.
struct task {
    int patch, table;
    enum status status;
};

static struct task *list_tasks(const struct bridge_ratios *ratios, int *count)
{
    struct task *task = NEW_ARRAY(struct task, VOLUMES + HALVES * RATIOS);
    *count = 0;
    for (int p = ratios->equal_range.first; p <= ratios->equal_range.last; p++)
        task[(*count)++] = (struct task){.patch = p, .table = -1};
    for (int half = 0; half < HALVES; half++)
        for (int k = 0; k < RATIOS; k++)
            if (needs(ratios, half, k))
                task[(*count)++] = (struct task){.patch = half, .table = k};
    return task;
}

// ---- making it ----------------------------------------------------------------------

static void fill_equal(struct bridge_ratios *ratios, const struct bodies *bodies,
                       struct task *task)
{
    task->status = fill_patch(bodies, task->patch, ratios->equal);
}

static double volume_in_half(int half, double u)
{
    const double eighths = 0.5 * (u + 1) * IN_HALF;
    const int whole = eighths < IN_HALF ? (int)eighths : IN_HALF - 1;
    return patch_volume(half * IN_HALF + whole, 2 * (eighths - whole) - 1);
}

static double steepness_of(int half)
{
    return 1 / (1.2 * sqrt(volume_in_half(half, 0)));
}

static void fill_ratio(struct bridge_ratios *ratios, const struct bodies *bodies,
                       struct task *task)
{
    const int half = task->patch, k = task->table;
    struct ratio_patch *to = &ratios->patch[half];
    struct volume_patch at = {.steepness = steepness_of(half)};
    double inverse[HALF_ORDER], value[HALF_ORDER][SAMPLES];
    for (int v = 0; v < HALF_ORDER && !task->status; v++) {
        struct equilibrium last;
        const double u = chebyshev_node(v, HALF_ORDER);
        task->status = find_rupture(bodies, volume_in_half(half, u), &last);
        inverse[v] = 1 / last.gap;
    }
    if (task->status) return;
    fit_polynomial(inverse, HALF_ORDER, at.turning);
    for (int v = 0; v < HALF_ORDER && !task->status; v++) {
        const double u = chebyshev_node(v, HALF_ORDER);
        task->status = sample_forces(bodies, volume_in_half(half, u), &at, u, value[v]);
    }
    if (task->status) return;
    memcpy(to->inverse[k], at.turning, sizeof at.turning);
    for (size_t place = 0; place < PLACES; place++)
        fit_place(HALF_ORDER, value, place, to->force[place][k]);
}

static void fill(struct bridge_ratios *ratios, double contact_angle, struct task *task)
{
    const double e = task->table < 0 ? 0 : difference_at(task->table);
    const struct bodies bodies = {{1 - e, 1 + e}, {contact_angle, contact_angle}};
    (task->table < 0 ? fill_equal : fill_ratio)(ratios, &bodies, task);
}

static enum status fill_all(struct bridge_ratios *ratios, double contact_angle,
                            struct reason *reason)
{
    int count;
    struct task *task = list_tasks(ratios, &count);
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < count; k++)
        fill(ratios, contact_angle, &task[k]);
    enum status status = STATUS_OK;
    for (int k = 0; k < count && !status; k++) {
        const int p = task[k].patch;
        if (task[k].status)
            status =
                refuse(reason, STATUS_NOT_CONVERGED,
                       "no table: a bridge of %g effective radii cubed was not "
                       "solved",
                       task[k].table < 0 ? patch_volume(p, 0) : volume_in_half(p, 0));
        else if (task[k].table < 0)
            ratios->equal->breaks =
                ratios->equal->breaks || breaks_in(ratios->equal->end[p]);
        else
            ratios->patch[p].steepness = steepness_of(p);
    }
    free(task);
    return status;
}

static enum status check_sizes(const struct bridge_sizes *sizes, struct reason *reason)
{
    const double *radius = sizes->radius, *volume = sizes->volume;
    if (radius[0] > 0 && radius[1] >= radius[0] && isfinite(radius[1]) &&
        volume[0] > 0 && volume[1] >= volume[0] && isfinite(volume[1]) &&
        sizes->plane[0] >= 0 && sizes->plane[1] >= sizes->plane[0] &&
        isfinite(sizes->plane[1]))
        return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "no bridges of volumes from %g to %g between radii from %g to %g",
                  volume[0], volume[1], radius[0], radius[1]);
}

enum status bridge_ratios_create(const struct bridge_sizes *sizes, double contact_angle,
                                 struct bridge_ratios **result, struct reason *reason)
{
    *result = NULL;
    enum status status = check_sizes(sizes, reason);
    if (status) return status;
    struct bridge_ratios *ratios = NEW_ARRAY(struct bridge_ratios, 1);
    find_ranges(sizes, ratios);
    ratios->equal = allocate_aligned(1, sizeof *ratios->equal);
    if (are_unequal(sizes))
        ratios->patch = allocate_aligned(HALVES, sizeof *ratios->patch);
    status = fill_all(ratios, contact_angle, reason);
    if (status)
        bridge_ratios_free(ratios);
    else
        *result = ratios;
    return status;
}
