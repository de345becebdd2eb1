// SPDX-License-Identifier: GPL-3.0-or-later
#include "conjugate_gradients.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int conjugate_gradients(const struct matrix *matrix, struct sampled_factor *factor,
                        const double *b, double *x, double reduction, int most)
{
    const int n = matrix->n;
    double *r = duplicate(b, (size_t)n, sizeof *r), *z = NEW_ARRAY(double, n);
    double *p = NEW_ARRAY(double, n), *image = NEW_ARRAY(double, n);
    memset(x, 0, sizeof *x * (size_t)n);
    const double aim = reduction * sqrt(dot_product(b, b, n));
    double curvature = 0;
    int iteration = 0;
    while (iteration < most && sqrt(dot_product(r, r, n)) > aim) {
        sampled_factor_apply(factor, r, z);
        const double overlap =
            iteration ? dot_product(z, image, n) / curvature : 0; // along the last p
#pragma omp parallel for schedule(static) if (n > 20000)
        for (int i = 0; i < n; i++)
            p[i] = z[i] - overlap * p[i];
        matrix_multiply(matrix, p, image);
        curvature = dot_product(p, image, n);
        if (!(curvature > 0)) break;
        const double step = dot_product(p, r, n) / curvature;
#pragma omp parallel for schedule(static) if (n > 20000)
        for (int i = 0; i < n; i++) {
            x[i] += step * p[i];
            r[i] -= step * image[i];
        }
        iteration++;
    }
    free(r);
    free(z);
    free(p);
    free(image);
    return iteration;
}
