// SPDX-License-Identifier: GPL-3.0-or-later
// A run is divided into blocks of snapshots, one after the other. Each block is summed
// by itself, by one thread; the run is the sum of its blocks in their order. Whatever
// is fitted to the run is fitted to each block, too, and
//     block error = deviation of the blocks / sqrt(their number).
//
// With n snapshots in the window, block b of B has those from n b / B to n (b + 1) / B,
// rounded down, so that no two blocks differ by more than one snapshot. The order of
// the additions does not depend on the number of threads.
//
// The smoothing that fit_band takes off again is that of the kernel and that of the
// cells along r: a mean over an interval of length `spacing` adds the variance
// spacing^2 / 12 of a uniform distribution.
//
// The trap: snapshots that follow each other closely are correlated, and so are short
// blocks; the block error is then too small (docs/shearstats.md).
#include "basics/memory.h"
#include "statistics/sample.h"
#include "study.h"

#include <math.h>
#include <stdlib.h>

// Sums of each block, (blocks, n_cell, SUM_ALL), and how many snapshots it has.
struct block_sums {
    int n;
    size_t width; // n_cell SUM_ALL
    int *snapshots;
    double *sum;
};

// At most one block a snapshot: MOST is what the user asked for.
static struct block_sums sum_blocks(const struct study *study,
                                    const struct motion *motion, int most, int threads)
{
    const int n_snapshot = motion->last - motion->first;
    struct block_sums blocks = {.n = most < n_snapshot ? most : n_snapshot,
                                .width = (size_t)grid_cells(&study->grid) * SUM_ALL};
    blocks.snapshots = NEW_ARRAY(int, blocks.n);
    blocks.sum = NEW_ARRAY(double, (size_t)blocks.n *blocks.width);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int b = 0; b < blocks.n; b++) {
        const int from = motion->first + (int)((long)n_snapshot * b / blocks.n);
        const int to = motion->first + (int)((long)n_snapshot * (b + 1) / blocks.n);
        blocks.snapshots[b] = to - from;
        for (int s = from; s < to; s++)
            add_snapshot(motion, s, &study->frame, &study->grid,
                         blocks.sum + (size_t)b * blocks.width);
    }
    return blocks;
}

static double *add_blocks(const struct block_sums *blocks)
{
    double *sum = NEW_ARRAY(double, blocks->width);
    for (int b = 0; b < blocks->n; b++)
        for (size_t k = 0; k < blocks->width; k++)
            sum[k] += blocks->sum[(size_t)b * blocks->width + k];
    return sum;
}

// NAN for fewer than two.
static double block_error(const double *value, int n)
{
    return n < 2 ? NAN : sample_deviation((struct sample){value, n}) / sqrt(n);
}

// Standard deviation of what smooths a profile along r: the kernel, and the cells.
static double smoothing_along_r(const struct study *study)
{
    const double spacing = study->grid.axis[0].spacing;
    return sqrt(study->smoothing * study->smoothing + spacing * spacing / 12);
}

// Blocks in which a level does not converge are left out of its block error, not
// counted as 0. The profile is kept for the run alone.
static void fit_run_levels(const struct study *study, const struct block_sums *blocks,
                           const double *sum, struct run_result *run)
{
    const struct split_cell *cell = &study->cell;
    const int n = cell->n_level, n_r = study->grid.axis[0].n;
    const double smoothing = smoothing_along_r(study);
    run->level = NEW_ARRAY(struct band_fit, n);
    run->turned = NEW_ARRAY(double, (size_t)n *(size_t)n_r);
    run->turned_counts = NEW_ARRAY(bool, (size_t)n *(size_t)n_r);
    run->centre_block_error = NEW_ARRAY(double, n);
    run->width_block_error = NEW_ARRAY(double, n);
    fit_levels(&study->grid, sum, run->snapshots, cell, smoothing, run->level);
    for (int k = 0; k < n; k++)
        level_profile(&study->grid, sum, run->snapshots, cell, cell->height[k],
                      run->turned + (size_t)k * (size_t)n_r,
                      run->turned_counts + (size_t)k * (size_t)n_r);
    struct band_fit *fit = NEW_ARRAY(struct band_fit, n * blocks->n);
    for (int b = 0; b < blocks->n; b++)
        fit_levels(&study->grid, blocks->sum + (size_t)b * blocks->width,
                   blocks->snapshots[b], cell, smoothing, fit + (size_t)b * (size_t)n);
    double *centre = NEW_ARRAY(double, blocks->n),
           *width = NEW_ARRAY(double, blocks->n);
    for (int k = 0; k < n; k++) {
        int fitted = 0;
        for (int b = 0; b < blocks->n; b++) {
            if (!fit[b * n + k].converged) continue;
            centre[fitted] = fit[b * n + k].centre;
            width[fitted++] = fit[b * n + k].width;
        }
        run->centre_block_error[k] = block_error(centre, fitted);
        run->width_block_error[k] = block_error(width, fitted);
    }
    free(fit);
    free(centre);
    free(width);
}

// A block has fewer snapshots, hence noisier fields, and other cells may flow in it:
// that is part of the scatter which the error measures.
static void fit_run_rheology(const struct study *study, const struct block_sums *blocks,
                             struct run_result *run)
{
    double *friction = NEW_ARRAY(double, blocks->n);
    double *cohesion = NEW_ARRAY(double, blocks->n);
    int fitted = 0;
    run->line = fit_rheology(&study->grid, &run->fields, &study->flowing);
    for (int b = 0; b < blocks->n; b++) {
        struct fields fields =
            make_fields(&study->grid, blocks->sum + (size_t)b * blocks->width,
                        blocks->snapshots[b]);
        const struct line_fit line =
            fit_rheology(&study->grid, &fields, &study->flowing);
        fields_free(&fields);
        if (line.n < 3) continue;
        friction[fitted] = line.friction;
        cohesion[fitted++] = line.cohesion;
    }
    run->friction_block_error = block_error(friction, fitted);
    run->cohesion_block_error = block_error(cohesion, fitted);
    free(friction);
    free(cohesion);
}

// Needs the fits of the run, because they say where the band is. The volume of each
// zone counts cells by their centres, so that counts can be turned into densities.
static void count_separations(const struct study *study, const struct motion *motion,
                              struct run_result *run)
{
    const struct band_fit *fit = study->cell.n_level > 0 ? run->level : NULL;
    run->separations.width = study->class_width;
    for (int s = motion->first; s < motion->last; s++)
        add_separations(&run->separations, motion, s, &study->frame, &study->cell, fit);
    for (int cell = 0; cell < grid_cells(&study->grid); cell++) {
        if (*field_at(&run->fields, cell, FIELD_FRACTION) <
                study->flowing.least_fraction ||
            !run->fields.filled[cell])
            continue;
        const int zone =
            inside_band(&study->cell, fit, cell_centre(&study->grid, cell, 0),
                        cell_centre(&study->grid, cell, 2));
        run->zone_volume[zone] += cell_volume(&study->grid, cell);
    }
}

// 1 but for rounding if the grid holds all that the kernel spreads.
static double share_inside(const struct study *study, const struct motion *motion,
                           const double *sum, int snapshots)
{
    double all = 0, inside = 0;
    for (int i = 0; i < motion->n_particle; i++)
        if (!motion->driven[i]) all += motion->mass[i];
    for (int cell = 0; cell < grid_cells(&study->grid); cell++)
        inside += sum[(size_t)cell * SUM_ALL + SUM_MASS];
    return inside / (all * snapshots);
}

// The only refusal, of names that are not there, comes before anything is allocated.
enum status add_run(struct study *study, const struct motion *motion,
                    const struct shearstats_parameters *parameters, int threads,
                    struct reason *reason)
{
    struct part part;
    const enum status status =
        find_part(motion, parameters->walls, parameters->groups, &part, reason);
    if (status) return status;
    struct run_result *run = &study->run[study->n_run++];
    struct block_sums blocks =
        sum_blocks(study, motion, (int)parameters->blocks, threads);
    double *sum = add_blocks(&blocks);
    run->snapshots = motion->last - motion->first;
    run->mass_inside = share_inside(study, motion, sum, run->snapshots);
    run->fields = make_fields(&study->grid, sum, run->snapshots);
    if (study->cell.n_level > 0) fit_run_levels(study, &blocks, sum, run);
    fit_run_rheology(study, &blocks, run);
    count_separations(study, motion, run);
    study->has_part = study->cell.n_level > 0 && part.n_wall + part.n_group > 0;
    if (study->has_part)
        run->torque = mean_torque(motion, &part, study->frame.point, study->frame.axis,
                                  parameters->rate, parameters->from, parameters->to,
                                  (int)parameters->blocks);
    free(sum);
    free(blocks.sum);
    free(blocks.snapshots);
    return STATUS_OK;
}
