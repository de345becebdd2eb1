// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/throat_radius.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>

void draw_normal_radii(struct network *network, double mean, double deviation,
                       unsigned long seed)
{
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(generator, seed);
    for (int t = 0; t < network->n_throat; t++) {
        double *radius = &network->throat_radius[t];
        do
            *radius = mean + gsl_ran_gaussian_ziggurat(generator, deviation);
        while (*radius <= 0);
    }
    gsl_rng_free(generator);
    free(network->throat_volume); // of other radii
    network->throat_volume = NULL;
}
