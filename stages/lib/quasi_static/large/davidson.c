// SPDX-License-Identifier: GPL-3.0-or-later
// The lowest mode x of a body that nothing holds, among those without momentum, by
// Davidson's method (1975): the stiffness A (pairs as factored, and geometric) on a
// basis of at most MOST vectors, its lowest Ritz pair (s, x), and as the next vector
// the residual A x - s x, preconditioned by the factor of K. K is A with the
// stabilisation, so inverse iteration with it would not find modes of A.
#include "softest_mode.h"
#include "stabilisation.h"

#include "basics/memory.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 40 }; // vectors

// Orthonormal vectors (6 n) without momentum, and the stiffness times each.
struct basis {
    int count;
    double *vector[MOST], *image[MOST];
    double product[MOST][MOST]; // of vectors and images
    double part[MOST];          // of the softest mode
};

static double product(const double *a, const double *b, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

// LOAD (n) = A MODE.
static void resist_mode(const struct quasi_static *qs, const struct displacement *mode,
                        struct displacement *load)
{
    memset(load, 0, (size_t)qs->n * sizeof *load);
    for (int j = 0; j < qs->n_pair; j++) {
        const int32_t *grain = qs->pair[j].grain;
        double deformation[COMPONENTS];
        pair_deformation(&qs->pair[j], &mode[grain[0]],
                         grain[1] < 0 ? NULL : &mode[grain[1]], deformation);
        for (int k = 0; k < COMPONENTS; k++)
            deformation[k] *= -qs->tangent[j][k];
        pair_subtract_load(&qs->pair[j], deformation, load);
    }
    struct displacement *turning = NEW_ARRAY(struct displacement, qs->n);
    subtract_geometric_load(qs, mode, turning);
    for (int i = 0; i < qs->n; i++)
        displacement_subtract(&load[i], turning[i]);
    free(turning);
}

// One more vector, K^-1 STEP orthogonal to the others. False: it depends on them.
static bool widen(struct quasi_static *qs, struct basis *basis)
{
    const int n = 6 * qs->n, k = basis->count;
    stiffness_begin(qs->matrix, qs->step);
    stiffness_finish(qs->matrix, qs->step);
    remove_momentum(qs, qs->step);
    double *vector = duplicate(qs->step, (size_t)qs->n, sizeof *qs->step);
    const double before = sqrt(product(vector, vector, n));
    for (int pass = 0; pass < 2; pass++)
        for (int l = 0; l < k; l++) {
            const double part = product(vector, basis->vector[l], n);
            for (int i = 0; i < n; i++)
                vector[i] -= part * basis->vector[l][i];
        }
    const double size = sqrt(product(vector, vector, n));
    const bool is_new = size > 1e-10 * before;
    for (int i = 0; i < n && is_new; i++)
        vector[i] /= size;
    basis->vector[k] = vector;
    basis->image[k] = NEW_ARRAY(double, n);
    basis->count++;
    if (!is_new) return false;
    resist_mode(qs, (struct displacement *)vector,
                (struct displacement *)basis->image[k]);
    for (int l = 0; l <= k; l++)
        basis->product[l][k] = basis->product[k][l] =
            product(basis->vector[l], basis->image[k], n);
    return true;
}

// The lowest Ritz value; its vector's parts of the basis.
static double soften(struct basis *basis)
{
    const size_t count = (size_t)basis->count;
    gsl_matrix *matrix = gsl_matrix_alloc(count, count);
    gsl_matrix *vectors = gsl_matrix_alloc(count, count);
    gsl_vector *values = gsl_vector_alloc(count);
    gsl_eigen_symmv_workspace *space = gsl_eigen_symmv_alloc(count);
    for (size_t k = 0; k < count; k++)
        for (size_t l = 0; l < count; l++)
            gsl_matrix_set(matrix, k, l, basis->product[k][l]);
    gsl_eigen_symmv(matrix, values, vectors, space);
    const size_t least = gsl_vector_min_index(values);
    const double stiffness = gsl_vector_get(values, least);
    for (size_t k = 0; k < count; k++)
        basis->part[k] = gsl_matrix_get(vectors, k, least);
    gsl_eigen_symmv_free(space);
    gsl_vector_free(values);
    gsl_matrix_free(vectors);
    gsl_matrix_free(matrix);
    return stiffness;
}

// STEP = OF_IMAGES A x + OF_VECTORS x.
static void combine(const struct quasi_static *qs, const struct basis *basis,
                    double of_images, double of_vectors)
{
    double *sum = &qs->step[0].translation.x;
    memset(qs->step, 0, (size_t)qs->n * sizeof *qs->step);
    for (int k = 0; k < basis->count; k++)
        for (int i = 0; i < 6 * qs->n; i++)
            sum[i] += basis->part[k] * (of_images * basis->image[k][i] +
                                        of_vectors * basis->vector[k][i]);
}

// A start without any symmetry that modes may have.
static void begin_mode(struct quasi_static *qs)
{
    for (int i = 0; i < qs->n; i++) {
        const double part = fmod(0.6180339887 * i * (double)i, 1);
        qs->step[i] = (struct displacement){{part, 0.7 - part, 0.2 * (i % 3)},
                                            {0.3, 0.6 * part, 1}};
        if (qs->is_detached[i])
            qs->step[i] = (struct displacement){{0, 0, 0}, {0, 0, 0}};
    }
}

static double find_mode(struct quasi_static *qs)
{
    struct basis basis = {.count = 0};
    const double close = 1e-9 * qs->large->stabilisation;
    double stiffness = INFINITY, fell = INFINITY;
    begin_mode(qs);
    while (basis.count < MOST && widen(qs, &basis)) {
        const double before = stiffness;
        stiffness = soften(&basis);
        const double falls = before - stiffness;
        if (fmax(falls, fell) < 1e-3 * fabs(stiffness) + close) break;
        fell = falls;
        combine(qs, &basis, 1, -stiffness);
    }
    combine(qs, &basis, 0, 1);
    for (int k = 0; k < basis.count; k++) {
        free(basis.vector[k]);
        free(basis.image[k]);
    }
    return stiffness;
}

int davidson_softest_mode(struct quasi_static *qs, double *stiffness)
{
    const double found = find_mode(qs);
    if (stiffness) *stiffness = found;
    return normalise_mode(qs);
}

// To rounding, which goes by the stabilisation.
bool davidson_is_stable(struct quasi_static *qs)
{
    double stiffness;
    davidson_softest_mode(qs, &stiffness);
    return !(stiffness < -1e-7 * qs->large->stabilisation);
}
