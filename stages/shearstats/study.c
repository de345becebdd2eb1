// SPDX-License-Identifier: GPL-3.0-or-later
// The grid spans all grains in the window of the first motion, and what the kernel
// reaches beyond them, unless told otherwise; along axes that are not divided,
// and along those that repeat, the box. A single interval that ends at a side of the
// box has the contacts with a wall there, which lie beyond it by a part of the overlap.
//
// Defaults, with d the mean diameter of the free grains: smoothing length d/2, spacing
// of cells the smoothing length, width of separation classes d/1000, levels from one d
// above the lowest centre to one d below the surface, margin of the flowing cells the
// reach of the kernel.
//
// The surface is the height below which 99 % of the centres lie in the last snapshot: a
// grain that flies above the bed must not lift the highest level out of it.
#include "study.h"

#include "basics/memory.h"
#include "kernel.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>

// ---- what the grains span -----------------------------------------------------------

struct extent {
    double lower[3], upper[3]; // of centres of free grains
    double largest;            // radius of any grain
    double bottom, top;        // along the last axis, without the highest hundredth
};

// Over all snapshots of the window for the grid, which must hold them all; the surface
// of the last one alone.
static struct extent find_extent(const struct motion *motion, const struct frame *frame)
{
    struct extent extent = {.lower = {HUGE_VAL, HUGE_VAL, HUGE_VAL},
                            .upper = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
    const size_t n = (size_t)motion->n_particle;
    double *height = NEW_ARRAY(double, n);
    size_t n_last = 0;
    for (int s = motion->first; s < motion->last; s++)
        for (size_t i = 0; i < n; i++) {
            if (motion->driven[i]) continue;
            const struct place place =
                place_of(frame, motion->position[(size_t)s * n + i]);
            for (int k = 0; k < 3; k++) {
                extent.lower[k] = fmin(extent.lower[k], place.at[k]);
                extent.upper[k] = fmax(extent.upper[k], place.at[k]);
            }
            if (s == motion->last - 1) height[n_last++] = place.at[2];
        }
    for (size_t i = 0; i < n; i++)
        extent.largest = fmax(extent.largest, motion->radius[i]);
    extent.bottom = extent.lower[2];
    if (n_last > 0) {
        gsl_sort(height, 1, n_last);
        extent.top = gsl_stats_quantile_from_sorted_data(height, 1, n_last, 0.99);
    }
    free(height);
    return extent;
}

// ---- grid ---------------------------------------------------------------------------

static double choose(double told, double otherwise)
{
    return isnan(told) ? otherwise : told;
}

// An axis that repeats must hold a whole number of cells, so their size gives way;
// otherwise the last cell may stick out. 1e-9 keeps an extent that is a multiple of the
// spacing from having one cell more.
static struct grid_axis divided(double lower, double upper, double spacing,
                                double half_width, bool repeats)
{
    const double places = (upper - lower) / spacing;
    const double n = fmax(repeats ? rint(places) : ceil(places - 1e-9), 1);
    return (struct grid_axis){.lower = lower,
                              .spacing = repeats ? (upper - lower) / n : spacing,
                              .n = (int)fmin(n, 1e9),
                              .half_width = half_width,
                              .repeats = repeats};
}

static struct grid_axis make_axis(const struct motion *motion,
                                  const struct shearstats_parameters *parameters,
                                  const struct extent *extent, double smoothing,
                                  double spacing, bool cylindrical, int k)
{
    const double reach = KERNEL_REACH * smoothing;
    const double beyond = reach + extent->largest; // contacts with walls, too
    const bool repeats = !cylindrical && motion->periodic[k];
    const bool whole = !cylindrical && !(parameters->along >> k & 1);
    const double box_lower = component(motion->lower, k);
    const double box_upper = component(motion->upper, k);
    if (cylindrical && k == 1)
        return (struct grid_axis){.spacing = 2 * M_PI, .n = 1, .everywhere = true};
    double lower = choose(parameters->lower[k], extent->lower[k] - beyond);
    double upper = choose(parameters->upper[k], extent->upper[k] + beyond);
    if (repeats || whole) {
        lower = repeats ? box_lower : choose(parameters->lower[k], box_lower);
        upper = repeats ? box_upper : choose(parameters->upper[k], box_upper);
    }
    const bool reflects = cylindrical && k == 0 && lower <= 0;
    if (reflects) lower = 0;
    if (whole) {
        const double near = 1e-9 * (box_upper - box_lower);
        const bool ends[2] = {fabs(lower - box_lower) <= near,
                              fabs(upper - box_upper) <= near};
        return (struct grid_axis){
            .lower = lower,
            .spacing = upper - lower,
            .n = 1,
            .repeats = repeats,
            .everywhere = repeats,
            .slack = {ends[0] ? extent->largest : 0, ends[1] ? extent->largest : 0}};
    }
    struct grid_axis axis = divided(lower, upper, spacing, reach, repeats);
    axis.reflects = reflects;
    return axis;
}

// Finer cells would only interpolate the kernel, and would overflow MOST_SHARES.
static enum status make_grid(struct study *study, const struct motion *motion,
                             const struct shearstats_parameters *parameters,
                             const struct extent *extent, struct reason *reason)
{
    static const double finest = 20, most_cells = 2e6;
    const double smoothing = study->smoothing;
    const double spacing =
        choose(parameters->spacing, smoothing > 0 ? smoothing : 0.5 * study->diameter);
    if (spacing < smoothing / finest)
        return refuse(reason, STATUS_BAD_DATA,
                      "shearstats.grid.spacing: must be at least a twentieth of the "
                      "smoothing length, %g m, got %g",
                      smoothing, spacing);
    double cells = 1;
    study->grid.cylindrical = study->frame.cylindrical;
    for (int k = 0; k < 3; k++) {
        study->grid.axis[k] = make_axis(motion, parameters, extent, smoothing, spacing,
                                        study->frame.cylindrical, k);
        cells *= study->grid.axis[k].n;
    }
    if (!(cells <= most_cells))
        return refuse(reason, STATUS_BAD_DATA,
                      "shearstats.grid.spacing: gives %.3g cells, %g at most: make it "
                      "larger, or divide fewer axes (grid.along)",
                      cells, most_cells);
    return STATUS_OK;
}

// ---- the whole ----------------------------------------------------------------------

// Driven grains are boundary: glued layers may have sizes of their own.
static double mean_diameter(const struct motion *motion)
{
    double sum = 0;
    int n = 0;
    for (int i = 0; i < motion->n_particle; i++) {
        if (motion->driven[i]) continue;
        sum += 2 * motion->radius[i];
        n++;
    }
    return n > 0 ? sum / n : 0;
}

// Without a rate nothing is a cell, and n_level stays 0.
static enum status make_cell(struct study *study,
                             const struct shearstats_parameters *parameters,
                             const struct extent *extent, struct reason *reason)
{
    struct split_cell *cell = &study->cell;
    const double d = study->diameter;
    *cell =
        (struct split_cell){.rate = parameters->rate,
                            .inner_turns = parameters->turning == TURNING_INNER,
                            .inner = choose(parameters->inner_radius, extent->lower[0]),
                            .outer = choose(parameters->outer_radius, extent->upper[0]),
                            .least_fraction = parameters->least_fraction};
    if (isnan(parameters->rate)) return STATUS_OK;
    const double lower = choose(parameters->level_lower, extent->bottom + d);
    const double upper = choose(parameters->level_upper, extent->top - d);
    if (!(upper > lower))
        return refuse(
            reason, STATUS_BAD_DATA,
            "shearstats.cell.upper: the levels end at %g m, below their start "
            "at %g: the bed is too low, give cell.lower and cell.upper",
            upper, lower);
    cell->n_level = (int)parameters->levels;
    study->height = NEW_ARRAY(double, cell->n_level);
    for (int k = 0; k < cell->n_level; k++)
        study->height[k] = cell->n_level == 1
                               ? 0.5 * (lower + upper)
                               : lower + (upper - lower) * k / (cell->n_level - 1);
    cell->height = study->height;
    return STATUS_OK;
}

// Ends that repeat have no wall, and the axis of a cylinder is none either.
static void make_flowing(struct study *study,
                         const struct shearstats_parameters *parameters,
                         const struct extent *extent)
{
    const double margin = choose(parameters->margin, KERNEL_REACH * study->smoothing);
    study->flowing = (struct flowing){.least_rate = parameters->least_rate,
                                      .least_fraction = parameters->least_fraction};
    for (int k = 0; k < 3; k++) {
        const bool open = study->grid.axis[k].repeats || study->grid.axis[k].reflects;
        const double within = open ? 0 : margin;
        study->flowing.lower[k] =
            study->grid.axis[k].repeats ? -HUGE_VAL : extent->lower[k] + within;
        study->flowing.upper[k] =
            study->grid.axis[k].repeats ? HUGE_VAL : extent->upper[k] - margin;
    }
}

enum status begin_study(struct study *study, const struct motion *motion,
                        const struct shearstats_parameters *parameters, int most_runs,
                        struct reason *reason)
{
    const double *p = parameters->axis_point, *a = parameters->axis_direction;
    const struct vector along = {a[0], a[1], a[2]};
    *study = (struct study){
        .frame = {.cylindrical = parameters->coordinates == COORDINATES_CYLINDRICAL,
                  .point = {p[0], p[1], p[2]},
                  .axis = scale(1 / norm(along), along)},
        .diameter = mean_diameter(motion),
        .run = NEW_ARRAY(struct run_result, most_runs)};
    if (!(study->diameter > 0))
        return refuse(reason, STATUS_BAD_DATA,
                      "/particles/driven: no grain moves freely");
    for (int k = 0; k < 3; k++)
        if (study->frame.cylindrical && motion->periodic[k])
            return refuse(reason, STATUS_BAD_DATA,
                          "/domain/periodic: the box repeats: coordinates must be "
                          "cartesian");
    study->smoothing = choose(parameters->smoothing_length, 0.5 * study->diameter);
    study->class_width = choose(parameters->class_width, 1e-3 * study->diameter);
    const struct extent extent = find_extent(motion, &study->frame);
    enum status status = make_grid(study, motion, parameters, &extent, reason);
    if (!status) status = make_cell(study, parameters, &extent, reason);
    make_flowing(study, parameters, &extent);
    return status;
}

void study_free(struct study *study)
{
    for (int r = 0; r < study->n_run; r++) {
        struct run_result *run = &study->run[r];
        fields_free(&run->fields);
        separations_free(&run->separations);
        free(run->turned);
        free(run->turned_counts);
        free(run->level);
        free(run->centre_block_error);
        free(run->width_block_error);
    }
    free(study->run);
    free(study->height);
    *study = (struct study){0};
}
