// SPDX-License-Identifier: GPL-3.0-or-later
// Fields are means over the runs; those of the grains, over the runs that have any in
// the cell. Standard errors are those of these means.
//
// What a field is a mean over decides which runs have it (enum field_basis): a density
// of 0 in an empty cell is a value, a velocity there is none. `filled` and `flowing`
// say how many runs have grains, or flow, in a cell.
#include "basics/memory.h"
#include "over_runs.h"
#include "write_shearstats.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void put_grid(struct artifact *artifact, const struct grid *grid)
{
    const int n = grid_cells(grid);
    double *centre = NEW_ARRAY(double, 3 * n), *volume = NEW_ARRAY(double, n);
    int64_t counts[3];
    double lower[3], spacing[3];
    for (int axis = 0; axis < 3; axis++) {
        counts[axis] = grid->axis[axis].n;
        lower[axis] = grid->axis[axis].lower;
        spacing[axis] = grid->axis[axis].spacing;
    }
    for (int cell = 0; cell < n; cell++) {
        volume[cell] = cell_volume(grid, cell);
        for (int axis = 0; axis < 3; axis++)
            centre[3 * cell + axis] = cell_centre(grid, cell, axis);
    }
    artifact_put(artifact, "/grid/counts", counts, 3);
    artifact_put(artifact, "/grid/lower", lower, 3);
    artifact_put(artifact, "/grid/spacing", spacing, 3);
    artifact_put(artifact, "/grid/centre", centre, n);
    artifact_put(artifact, "/grid/volume", volume, n);
    free(centre);
    free(volume);
}

static bool is_known(const struct fields *fields, int cell, enum field_basis basis)
{
    return basis == OF_VOLUME   ? true
           : basis == OF_GRAINS ? fields->filled[cell] > 0
                                : *field_at(fields, cell, FIELD_CONTACTS) > 0;
}

// The numbers of FIELD over the runs, (n_cell, its width). With one run there is no
// standard error, and its dataset is left out.
static void put_field(struct artifact *artifact, const struct study *study,
                      enum field field, double confidence)
{
    const int n = grid_cells(&study->grid), width = field_kinds[field].width;
    double *mean = NEW_ARRAY(double, n *width), *error = NEW_ARRAY(double, n *width);
    double *value = NEW_ARRAY(double, study->n_run);
    for (int cell = 0; cell < n; cell++)
        for (int k = 0; k < width; k++) {
            for (int r = 0; r < study->n_run; r++) {
                const struct fields *fields = &study->run[r].fields;
                const bool known = is_known(fields, cell, field_kinds[field].basis);
                value[r] = known ? field_at(fields, cell, field)[k] : NAN;
            }
            const struct over_runs over = over_runs(value, study->n_run, confidence);
            mean[cell * width + k] = over.mean;
            error[cell * width + k] = over.standard_error;
        }
    char name[64];
    snprintf(name, sizeof name, "/fields/%s", field_kinds[field].name);
    artifact_put(artifact, name, mean, n);
    snprintf(name, sizeof name, "/standard_errors/%s", field_kinds[field].name);
    if (study->n_run > 1) artifact_put(artifact, name, error, n);
    free(mean);
    free(error);
    free(value);
}

// Counted over runs, so that a reader can require a cell to be filled in all.
static void put_filled(struct artifact *artifact, const struct study *study)
{
    const int n = grid_cells(&study->grid);
    int32_t *filled = NEW_ARRAY(int32_t, n), *flowing = NEW_ARRAY(int32_t, n);
    for (int r = 0; r < study->n_run; r++)
        for (int cell = 0; cell < n; cell++) {
            const struct fields *fields = &study->run[r].fields;
            filled[cell] += fields->filled[cell];
            flowing[cell] += is_flowing(&study->grid, fields, cell, &study->flowing);
        }
    artifact_put(artifact, "/fields/filled", filled, n);
    artifact_put(artifact, "/fields/flowing", flowing, n);
    free(filled);
    free(flowing);
}

void put_fields(struct artifact *artifact, const struct study *study, double confidence)
{
    put_grid(artifact, &study->grid);
    for (int field = 0; field < FIELD_KINDS; field++)
        put_field(artifact, study, (enum field)field, confidence);
    put_filled(artifact, study);
    int64_t *snapshots = NEW_ARRAY(int64_t, study->n_run);
    double *inside = NEW_ARRAY(double, study->n_run);
    for (int r = 0; r < study->n_run; r++) {
        snapshots[r] = study->run[r].snapshots;
        inside[r] = study->run[r].mass_inside;
    }
    artifact_put(artifact, "/runs/snapshots", snapshots, study->n_run);
    artifact_put(artifact, "/runs/mass_inside", inside, study->n_run);
    free(snapshots);
    free(inside);
    artifact_put_number(artifact, "/summary/runs", study->n_run);
    artifact_put_number(artifact, "/summary/smoothing_length", study->smoothing);
    artifact_put_number(artifact, "/summary/mean_diameter", study->diameter);
    artifact_put_number(artifact, "/summary/confidence", confidence);
}
