// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of nodes that have left have no links; each is tied to the ground, so that the
// factor exists.
#include "rough_factor.h"

#include "basics/memory.h"
#include "elimination/approximate_cholesky.h"

#include <stdlib.h>

// To make a factor takes as long as so many steps.
enum { STEPS_OF_FACTOR = 40, ARRAYS = 4 };

struct rough_factor {
    struct approximate_cholesky *factor; // NULL: to be made
    double steps, decades; // with it, so far; steps count what it took to make
    double *array[ARRAYS]; // (n)
};

struct rough_factor *rough_factor_create(int n)
{
    struct rough_factor *rough = NEW_ARRAY(struct rough_factor, 1);
    for (int k = 0; k < ARRAYS; k++)
        rough->array[k] = NEW_ARRAY(double, n);
    return rough;
}

static void forget(struct rough_factor *rough)
{
    approximate_cholesky_free(rough->factor);
    rough->factor = NULL;
}

void rough_factor_free(struct rough_factor *rough)
{
    if (!rough) return;
    forget(rough);
    for (int k = 0; k < ARRAYS; k++)
        free(rough->array[k]);
    free(rough);
}

static struct conductance_matrix matrix_of(const struct cluster_laplacian *graph)
{
    const int n = graph->n;
    int n_link = 0;
    struct link *link = NEW_ARRAY(struct link, graph->offset[n] / 2 + n);
    for (int i = 0; i < n; i++) {
        const bool present = graph->present[i] != 0;
        const double ground = present ? graph->ground[i] : 1;
        if (ground > 0) link[n_link++] = (struct link){{i, n}, ground};
        for (int k = graph->offset[i]; present && k < graph->offset[i + 1]; k++)
            if (graph->column[k] > i && graph->conductance[k] > 0)
                link[n_link++] =
                    (struct link){{i, graph->column[k]}, graph->conductance[k]};
    }
    const struct conductance_matrix matrix =
        conductance_matrix_of_links(n, n + 1, n_link, link);
    free(link);
    return matrix;
}

void rough_factor_follow(struct rough_factor *rough,
                         const struct cluster_laplacian *graph)
{
    if (rough->factor) return;
    struct conductance_matrix matrix = matrix_of(graph);
    rough->factor = approximate_cholesky_create(&matrix);
    rough->steps = STEPS_OF_FACTOR;
    rough->decades = 0;
    conductance_matrix_free(&matrix);
}

void rough_factor_apply(const struct rough_factor *rough, const double *b, double *z)
{
    approximate_cholesky_apply(rough->factor, b, z);
}

void rough_factor_took(struct rough_factor *rough, int steps, double decades)
{
    rough->steps += steps;
    rough->decades += decades;
    if (steps * rough->decades > rough->steps * decades) forget(rough);
}

double **rough_factor_scratch(struct rough_factor *rough)
{
    return rough->array;
}
