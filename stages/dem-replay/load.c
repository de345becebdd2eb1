// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of the load. Steps below 0 have the weight in place of a row. The forces of a
// step are a copy, since engines take net loads off them.
#include "replay_engine.h"

#include <string.h>

bool is_loaded(const struct load *load, int n, int step)
{
    const struct vector *force = load->force(load->source, step);
    if (load->shrinks || load->drains) return true;
    for (int i = 0; i < n; i++)
        if (norm(force[i]) > 0) return true;
    return false;
}

void take_forces(struct run *run)
{
    const int step = run->place.step;
    const struct vector *force =
        step < 0 ? run->settings->weight : run->load->force(run->load->source, step);
    memcpy(run->force, force, (size_t)run->packing->n_particle * sizeof *run->force);
}

// Of the grains (n_particle); NULL: not known, or before the load (ROW -1).
static const double *dryness_at(const struct run *run, int row)
{
    const struct load *load = run->load;
    if (row < 0) return NULL;
    if (load->drained)
        return load->drained + (size_t)row * (size_t)run->packing->n_particle;
    return load->dryness ? load->dryness(load->source, row) : NULL;
}

void shrinkage_by_law(const struct run *run, int row, double *strain)
{
    find_shrinkage(&run->settings->shrinkage, run->packing, row,
                   row < 0 ? 1 : run->load->saturation[row], dryness_at(run, row),
                   strain);
}
