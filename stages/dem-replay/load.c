// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of the load, and the forces of a step. A load is stored row by row: the force on
// grain i at step k is force[k n_particle + i]. Steps below 0 have the weight in place
// of a row. The forces of a step are a copy, since engines take net loads off them.
#include "replay_engine.h"

#include <string.h>

bool is_loaded(const struct load *load, int n, int step)
{
    const struct vector *force = load->force + (size_t)step * (size_t)n;
    if (load->shrinks || load->drains) return true;
    for (int i = 0; i < n; i++)
        if (norm(force[i]) > 0) return true;
    return false;
}

void take_forces(struct run *run)
{
    const size_t n = (size_t)run->packing->n_particle;
    const struct vector *force = run->place.step < 0
                                     ? run->settings->weight
                                     : run->load->force + (size_t)run->place.step * n;
    memcpy(run->force, force, n * sizeof *run->force);
}
