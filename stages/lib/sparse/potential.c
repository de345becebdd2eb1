// SPDX-License-Identifier: GPL-3.0-or-later
#include "potential.h"

#include "basics/compensated.h"
#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

struct potential potential_make(int n_site, int n_link, const struct link *link,
                                const double *air)
{
    struct potential potential = {.n_site = n_site,
                                  .grid = multigrid_make(n_site, n_link, link, air),
                                  .air = NEW_ARRAY(double, n_site),
                                  .all = NEW_ARRAY(double, n_site),
                                  .value = NEW_ARRAY(double, n_site),
                                  .inflow = NEW_ARRAY(double, n_site)};
    const struct multigrid_level *level = &potential.grid.level[0];
    for (int p = 0; p < n_site; p++) {
        potential.air[p] = potential.all[p] = level->ground[p];
        for (int k = level->begin[p]; k < level->begin[p + 1]; k++)
            potential.all[p] += level->conductance[k];
    }
    return potential;
}

void potential_free(struct potential *potential)
{
    multigrid_free(&potential->grid);
    free(potential->air);
    free(potential->all);
    free(potential->value);
    free(potential->inflow);
    *potential = (struct potential){0};
}

void potential_free_site(struct potential *potential, int site)
{
    const int place = potential->grid.place[site];
    potential->grid.level[0].diagonal[place] = potential->all[place];
}

// Returns the sum of sizes where sites are free.
static double find_inflow(struct potential *potential)
{
    const struct multigrid_level *level = &potential->grid.level[0];
    const double *value = potential->value;
    double left_over = 0;
    struct compensated rate = {0};
    for (int p = 0; p < potential->n_site; p++) {
        double sum = potential->air[p] * (1 - value[p]);
        for (int k = level->begin[p]; k < level->begin[p + 1]; k++)
            sum += level->conductance[k] * (value[level->neighbour[k]] - value[p]);
        potential->inflow[p] = sum;
        const bool is_free = level->diagonal[p] > 0;
        if (is_free) left_over += fabs(sum);
        compensated_add(&rate, is_free ? sum * (1 - value[p]) : sum);
    }
    potential->rate = compensated_value(rate);
    return left_over;
}

bool potential_solve(struct potential *potential, double least)
{
    const int n = potential->n_site;
    double *rise = NEW_ARRAY(double, n), left_over = find_inflow(potential);
    multigrid_renew(&potential->grid);
    // Twice, if rounding has hidden something.
    for (int round = 0; left_over > least && round < 2; round++) {
        multigrid_solve(&potential->grid, 0.9 * least, potential->inflow, rise);
        for (int p = 0; p < n; p++)
            potential->value[p] += rise[p];
        left_over = find_inflow(potential);
    }
    free(rise);
    return left_over <= least;
}
