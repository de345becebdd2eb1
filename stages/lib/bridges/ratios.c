// SPDX-License-Identifier: GPL-3.0-or-later
// Tables at seventeen ratios of radii, and forces between them.
//
// Each table has its own gap A of rupture, and zeta by that (table_layout.h). Between
// the ratios 1/A and F (1 + a/C)^2 at the same zeta are interpolated, each by a
// polynomial through the six nearest: where in zeta a bridge lies, and so its steep
// end, is that of its own ratio. Of equal grains A here is where they rupture, also by
// a break of symmetry, as that is what slightly unequal ones come near to.
//
// Only those patches are made that a pair of the given grains can need: of a smallest
// grain a and a largest one b, effective radii at the asymmetry e = s^3 are from a (1 +
// e) to b (1 - e).
#include "bridges/ratios.h"

#include "basics/memory.h"
#include "bridges/table_make.h"

#include <stdlib.h>

enum { RATIOS = 17, INTERVALS = RATIOS - 1, STENCIL = 6 };

// For one patch of volumes.
struct ratio_patch {
    double inverse[RATIOS][TURNING_ORDER]; // 1/A as polynomials in u
    double steepness;                      // 1/C
    alignas(64) eight force[PLACES][RATIOS][2];
};

// Patches from FIRST to LAST; none if FIRST is above.
struct range {
    int first, last;
};

struct bridge_ratios {
    struct range equal_range, range[INTERVALS];
    bool as_it_is; // equal grains only, and no volume to be taken as another
    struct bridge_table *equal; // with the patches that are needed
    struct ratio_patch *patch;  // (VOLUMES), likewise; NULL: all grains are equal
};

double bridge_asymmetry(double first_radius, double second_radius)
{
    const double rounding = 1e-12;
    const double apart = fabs(first_radius - second_radius);
    const double sum = first_radius + second_radius;
    return apart > rounding * sum ? cbrt(apart / sum) : 0;
}

// Of the six tables about an interval.
static int first_of_stencil(int interval)
{
    const int first = interval - STENCIL / 2 + 1, most = RATIOS - STENCIL;
    return first < 0 ? 0 : first > most ? most : first;
}

static double clamp(double value, double least, double most)
{
    return fmin(fmax(value, least), most);
}

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

static void find_ranges(const struct bridge_sizes *sizes, struct bridge_ratios *ratios)
{
    const double *radius = sizes->radius;
    const double least = sizes->volume[0] / (radius[1] * radius[1] * radius[1]);
    const double most = sizes->volume[1] / (radius[0] * radius[0] * radius[0]);
    const double largest = bridge_asymmetry(radius[0], radius[1]);
    ratios->equal_range = patches_of(sizes, radius[0], radius[1]);
    ratios->as_it_is =
        !(largest > 0) && least >= BRIDGE_TABLE_LEAST && most <= BRIDGE_TABLE_MOST;
    for (int k = 0; k < INTERVALS; k++) {
        const double e = difference_at(k);
        ratios->range[k] = (struct range){0, -1};
        if (largest > 0 && k < (largest + 1e-9) * INTERVALS)
            ratios->range[k] =
                patches_of(sizes, radius[0] * (1 + e),
                           fmax(radius[1] * (1 - e), radius[0] * (1 + e)));
    }
}

// Whether a bridge of volumes PATCH may need table K.
static bool needs(const struct bridge_ratios *ratios, int patch, int k)
{
    for (int i = 0; i < INTERVALS; i++) {
        const int first = first_of_stencil(i);
        const struct range range = ratios->range[i];
        if (k >= first && k < first + STENCIL && patch >= range.first &&
            patch <= range.last)
            return true;
    }
    return false;
}

// A patch to be made, of table TABLE or, if below 0, of equal grains.
struct task {
    int patch, table;
    enum status status;
};

static struct task *list_tasks(const struct bridge_ratios *ratios, int *count)
{
    struct task *task = NEW_ARRAY(struct task, VOLUMES * (RATIOS + 1));
    *count = 0;
    for (int patch = 0; patch < VOLUMES; patch++) {
        const struct range equal = ratios->equal_range;
        if (patch >= equal.first && patch <= equal.last)
            task[(*count)++] = (struct task){.patch = patch, .table = -1};
        for (int k = 0; k < RATIOS; k++)
            if (needs(ratios, patch, k))
                task[(*count)++] = (struct task){.patch = patch, .table = k};
    }
    return task;
}

// ---- making it ----------------------------------------------------------------------

static void fill_equal(struct bridge_ratios *ratios, const struct bodies *bodies,
                       struct task *task)
{
    struct bridge_table *table = ratios->equal;
    const int p = task->patch;
    task->status =
        make_patch(bodies, p, false, &table->volume[p], table->end[p], table->force[p]);
}

static void fill_ratio(struct bridge_ratios *ratios, const struct bodies *bodies,
                       struct task *task)
{
    struct ratio_patch *to = &ratios->patch[task->patch];
    struct volume_patch at;
    double end[ORDER];
    eight force[PLACES][2];
    task->status = make_patch(bodies, task->patch, true, &at, end, force);
    memcpy(to->inverse[task->table], at.turning, sizeof at.turning);
    for (int place = 0; place < PLACES; place++)
        memcpy(to->force[place][task->table], force[place], sizeof force[place]);
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
            status = refuse(reason, STATUS_NOT_CONVERGED,
                            "no table: a bridge of %g effective radii cubed was not "
                            "solved",
                            patch_volume(p, 0));
        else if (task[k].table < 0)
            ratios->equal->breaks =
                ratios->equal->breaks || breaks_in(ratios->equal->end[p]);
        else
            ratios->patch[p].steepness = 1 / (1.2 * sqrt(patch_volume(p, 0)));
    }
    free(task);
    return status;
}

static enum status check_sizes(const struct bridge_sizes *sizes, struct reason *reason)
{
    const double *radius = sizes->radius, *volume = sizes->volume;
    if (radius[0] > 0 && radius[1] >= radius[0] && isfinite(radius[1]) &&
        volume[0] > 0 && volume[1] >= volume[0] && isfinite(volume[1]))
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
    if (bridge_asymmetry(sizes->radius[0], sizes->radius[1]) > 0)
        ratios->patch = allocate_aligned(VOLUMES, sizeof *ratios->patch);
    status = fill_all(ratios, contact_angle, reason);
    if (status)
        bridge_ratios_free(ratios);
    else
        *result = ratios;
    return status;
}

void bridge_ratios_free(struct bridge_ratios *ratios)
{
    if (!ratios) return;
    free(ratios->equal);
    free(ratios->patch);
    free(ratios);
}

// ---- reading it ---------------------------------------------------------------------

// Of a pair: six tables from FIRST on, and what each counts for.
struct blend {
    int first;
    double weight[STENCIL];
};

// Lagrange's polynomials at T from the first of the tables on.
static struct blend blend_at(double asymmetry, int interval)
{
    static const double scale[STENCIL] = {-1. / 120, 1. / 24,  -1. / 12,
                                          1. / 12,   -1. / 24, 1. / 120};
    struct blend blend = {.first = first_of_stencil(interval)};
    const double t = asymmetry * INTERVALS - blend.first;
    double below = 1;
    for (int k = 0; k < STENCIL; k++) {
        blend.weight[k] = scale[k] * below;
        below *= t - k;
    }
    double above = 1;
    for (int k = STENCIL - 1; k >= 0; k--) {
        blend.weight[k] *= above;
        above *= t - k;
    }
    return blend;
}

// Where a volume lies among the patches of RANGE; one outside is taken as the nearest,
// and SHRINK is what a gap is then multiplied by.
struct chosen {
    struct volume_place at;
    double volume, shrink;
};

static struct chosen choose_volume(struct range range, double volume)
{
    struct chosen chosen = {place_volume(volume), volume, 1};
    const bool is_less = chosen.at.patch < range.first || volume < BRIDGE_TABLE_LEAST;
    const bool is_more = chosen.at.patch > range.last || volume > BRIDGE_TABLE_MOST;
    if (!is_less && !is_more) return chosen;
    chosen.at.patch = is_less ? range.first : range.last;
    chosen.at.u = is_less ? -1 : 1 - 1e-9; // not the first of the next patch
    chosen.volume = patch_volume(chosen.at.patch, chosen.at.u);
    chosen.shrink = cbrt(chosen.volume / volume);
    return chosen;
}

static int interval_of(double asymmetry)
{
    return (int)clamp(asymmetry * INTERVALS, 0, INTERVALS - 1);
}

static double inverse_at(const struct ratio_patch *patch, const struct blend *blend,
                         double u)
{
    double sum = 0;
    for (int k = 0; k < STENCIL; k++)
        sum += blend->weight[k] * POLYNOMIAL(patch->inverse[blend->first + k], u);
    return sum;
}

// Between grains of unequal radii.
static double unequal_force(const struct bridge_ratios *ratios, double asymmetry,
                            double volume, double given_gap)
{
    const int interval = interval_of(asymmetry);
    const struct blend blend = blend_at(asymmetry, interval);
    const struct chosen chosen = choose_volume(ratios->range[interval], volume);
    const struct ratio_patch *patch = &ratios->patch[chosen.at.patch];
    const double gap = fmax(given_gap, 0) * chosen.shrink;
    const double rest = 1 - gap * inverse_at(patch, &blend, chosen.at.u);
    if (!(rest > 0)) return 0;
    const double shrink = 1 / (1 + gap * patch->steepness);
    const double x = along(WIDE * sqrt(rest * shrink));
    const int place = x < PLACES ? (int)x : PLACES - 1;
    eight row[2] = {{0}, {0}};
    for (int k = 0; k < STENCIL; k++) {
        const float weight = (float)blend.weight[k];
        row[0] += weight * patch->force[place][blend.first + k][0];
        row[1] += weight * patch->force[place][blend.first + k][1];
    }
    const four term = terms_of(row, (float)chosen.at.u, (float)(2 * (x - place) - 1));
    return shrink * shrink * (double)((term[0] + term[1]) + (term[2] + term[3]));
}

static double equal_force(const struct bridge_ratios *ratios, double volume, double gap)
{
    const struct chosen chosen = choose_volume(ratios->equal_range, volume);
    return bridge_table_force(ratios->equal, chosen.volume, gap * chosen.shrink);
}

void bridge_ratios_forces(const struct bridge_ratios *ratios, int count,
                          const double *asymmetry, const double *volume,
                          const double *gap, double *force)
{
    if (ratios->as_it_is) {
        bridge_table_forces(ratios->equal, count, volume, gap, force);
        return;
    }
    for (int k = 0; k < count; k++)
        force[k] = asymmetry[k] > 0
                       ? unequal_force(ratios, asymmetry[k], volume[k], gap[k])
                       : equal_force(ratios, volume[k], gap[k]);
}

double bridge_ratios_rupture(const struct bridge_ratios *ratios, double asymmetry,
                             double volume)
{
    if (!(asymmetry > 0)) {
        const struct chosen chosen = choose_volume(ratios->equal_range, volume);
        return bridge_table_rupture(ratios->equal, chosen.volume) / chosen.shrink;
    }
    const int interval = interval_of(asymmetry);
    const struct blend blend = blend_at(asymmetry, interval);
    const struct chosen chosen = choose_volume(ratios->range[interval], volume);
    const struct ratio_patch *patch = &ratios->patch[chosen.at.patch];
    return 1 / (inverse_at(patch, &blend, chosen.at.u) * chosen.shrink);
}
