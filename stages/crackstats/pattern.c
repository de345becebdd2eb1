// SPDX-License-Identifier: GPL-3.0-or-later
// The statistics of a pattern. With A the area of the box, N polygons of areas A_p, and
// h the height of the layer by the surfaces of its grains,
//     length over h  = sqrt(A / N) / h,
//     width          = median, over the broken lateral bonds in crack columns, of the
//                      growth of their horizontal length at the last snapshot,
//     opened area    = border between polygons times width, over A.
// Junctions are 2 N where every one is of three cracks and all close (Euler, on a
// torus).
#include "pattern.h"

#include "basics/memory.h"
#include "basics/sorted.h"
#include "junctions.h"
#include "run_statistics.h"

#include <math.h>
#include <stdlib.h>

// VALUE is sorted.
static double median(double *value, int n)
{
    if (n == 0) return NAN;
    qsort(value, (size_t)n, sizeof *value, rising_doubles);
    return 0.5 * (value[(n - 1) / 2] + value[n / 2]);
}

static double largest_area(const struct polygons *p)
{
    double largest = 0;
    for (int k = 0; k < p->count; k++)
        largest = fmax(largest, p->area[k]);
    return largest;
}

static double box_area(const struct columns *columns)
{
    return columns->n * columns->edge[0] * columns->edge[1];
}

// ---- width --------------------------------------------------------------------------

// How much the horizontal length of BOND has grown at the last snapshot, m.
static double opening(const struct run *run, int bond)
{
    const int32_t *end = run->packing.bond[bond];
    const struct vector *moved =
        run->displacement +
        (size_t)(run->n_snapshot - 1) * (size_t)run->packing.n_particle;
    const struct vector before = bond_vector(&run->packing, bond);
    const struct vector after = add(before, subtract(moved[end[1]], moved[end[0]]));
    return hypot(after.x, after.y) - hypot(before.x, before.y);
}

// Whether BOND is broken, lateral, and in a crack column.
static bool is_in_crack(const struct pattern *pattern, const struct run *run,
                        const uint8_t *intact, int bond)
{
    double length;
    if (intact[bond] || !is_lateral(run, bond)) return false;
    const int c = column_of_bond(&pattern->columns, run, bond, &length);
    return pattern->damage[c] >= pattern->polygons.threshold;
}

static double crack_width(const struct pattern *pattern, const struct run *run,
                          const uint8_t *intact)
{
    double *width = NEW_ARRAY(double, run->packing.n_bond);
    int n = 0;
    for (int b = 0; run->n_snapshot > 0 && b < run->packing.n_bond; b++)
        if (is_in_crack(pattern, run, intact, b)) width[n++] = opening(run, b);
    const double found = median(width, n);
    free(width);
    return found;
}

// Mean dryness of the grains that bonds in cracks joined, at the last snapshot.
static double crack_air(const struct pattern *pattern, const struct run *run,
                        const uint8_t *intact)
{
    if (!run->dryness || run->n_snapshot == 0) return NAN;
    const double *dryness =
        run->dryness + (size_t)(run->n_snapshot - 1) * (size_t)run->packing.n_particle;
    double sum = 0;
    int n = 0;
    for (int b = 0; b < run->packing.n_bond; b++) {
        if (!is_in_crack(pattern, run, intact, b)) continue;
        const int32_t *end = run->packing.bond[b];
        sum += (dryness[end[0]] + dryness[end[1]]) / 2;
        n++;
    }
    return n ? sum / n : NAN;
}

// ---- the floor ----------------------------------------------------------------------

// Of the bonds between held grains and others; NAN without any.
static double floor_broken(const struct run *run, const uint8_t *intact)
{
    int all = 0, broken = 0;
    for (int b = 0; run->held && b < run->packing.n_bond; b++) {
        const int32_t *end = run->packing.bond[b];
        if (run->held[end[0]] == run->held[end[1]]) continue;
        all++;
        broken += !intact[b];
    }
    return all ? (double)broken / all : NAN;
}

// ---- over the drying ----------------------------------------------------------------

static void follow(struct pattern *pattern, const struct run *run)
{
    uint8_t *intact = bonds_before(run);
    int next = 0;
    for (int k = 0; k < pattern->n_stage; k++) {
        struct pattern_stage *stage = &pattern->stage[k];
        stage->saturation = 1 - (k + 1.0) / pattern->n_stage;
        for (;
             next < run->n_crack && run->saturation[next] >= stage->saturation - 1e-12;
             next++)
            intact[run->bond[next]] = 0;
        double *damage = column_damage(&pattern->columns, run, intact);
        struct polygons now = find_polygons(&pattern->columns, run, intact, damage);
        stage->count = now.none ? 0 : now.count;
        stage->crack_area = now.crack_area;
        stage->largest = largest_area(&now) / box_area(&pattern->columns);
        for (int c = 0; c < pattern->columns.n; c++)
            if (isnan(pattern->opened[c]) && damage[c] >= pattern->polygons.threshold)
                pattern->opened[c] = stage->saturation;
        polygons_free(&now);
        free(damage);
    }
    free(intact);
}

// ---- statistics ---------------------------------------------------------------------

static void note_shape(double *value, const struct pattern *pattern,
                       const struct run *run, const uint8_t *intact)
{
    const struct columns *columns = &pattern->columns;
    const struct polygons *p = &pattern->polygons;
    const double box = box_area(columns), h = columns->height;
    double *area = duplicate(p->area, (size_t)p->count, sizeof *area);
    value[POLYGONS_COUNT] = p->count;
    value[POLYGONS_AREA] = box / p->count;
    value[POLYGONS_AREA_OVER_H2] = box / p->count / (h * h);
    value[POLYGONS_MEDIAN_OVER_H2] = median(area, p->count) / (h * h);
    value[POLYGONS_LENGTH_OVER_H] = sqrt(box / p->count) / h;
    value[POLYGONS_LARGEST] = largest_area(p) / box;
    value[POLYGONS_THROUGH] = p->through;
    value[POLYGONS_ISLANDS] = count_islands(columns, run, intact);
    value[POLYGONS_WIDTH] = crack_width(pattern, run, intact);
    value[POLYGONS_AIR] = crack_air(pattern, run, intact);
    value[POLYGONS_OPENED] = p->border * value[POLYGONS_WIDTH] / box;
    free(area);
}

static void note_junctions(double *value, const struct pattern *pattern)
{
    const struct junctions found =
        find_junctions(&pattern->columns, &pattern->polygons);
    value[JUNCTIONS_COUNT] = found.count;
    value[JUNCTIONS_ANGLE] = found.measured ? found.mean_largest : NAN;
    value[JUNCTIONS_T] = found.measured ? found.t_share : NAN;
    value[JUNCTIONS_Y] = found.measured ? found.y_share : NAN;
}

struct pattern find_pattern(const struct run *run, int n_stage, double *value)
{
    struct pattern pattern = {.columns = columns_init(run), .n_stage = n_stage};
    uint8_t *intact = bonds_left(run);
    pattern.damage = column_damage(&pattern.columns, run, intact);
    pattern.polygons = find_polygons(&pattern.columns, run, intact, pattern.damage);
    pattern.opened = NEW_ARRAY(double, pattern.columns.n);
    for (int c = 0; c < pattern.columns.n; c++)
        pattern.opened[c] = NAN;
    pattern.stage = NEW_ARRAY(struct pattern_stage, n_stage);
    follow(&pattern, run);
    for (int k = POLYGONS_FOUND; k < STATISTIC_COUNT; k++)
        value[k] = NAN;
    value[POLYGONS_FOUND] = !pattern.polygons.none;
    value[POLYGONS_CRACK_AREA] = pattern.polygons.crack_area;
    value[POLYGONS_IN_CRACKS] = pattern.polygons.in_cracks;
    value[POLYGONS_FLOOR_BROKEN] = floor_broken(run, intact);
    if (!pattern.polygons.none) {
        note_shape(value, &pattern, run, intact);
        note_junctions(value, &pattern);
    }
    free(intact);
    return pattern;
}

void pattern_free(struct pattern *pattern)
{
    polygons_free(&pattern->polygons);
    free(pattern->damage);
    free(pattern->opened);
    free(pattern->stage);
    *pattern = (struct pattern){0};
}
