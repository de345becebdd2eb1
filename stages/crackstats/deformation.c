// SPDX-License-Identifier: GPL-3.0-or-later
// Shape change of the largest fragment: the displacement gradient G that fits
//     u_i = a_i + sum_j G_ij x_j
// by least squares over its grains (GSL, truncated singular values), with x in units
// of the body around its middle, where the columns are of one size. In a box that
// repeats, x is the place in the image that the intact bonds lead to from the root of
// the fragment (image_trees.h): a fragment across a side is whole. Along an axis on
// which these bonds lead around the box, displacements repeat with the box, which keeps
// its size, so G is 0 (its column is left empty). Then
//     shrinkage = 1 - det(1 + G) = -(tr G + sum of principal minors + det G),
// which does not subtract numbers near 1.
#include "deformation.h"

#include "basics/memory.h"
#include "fragment_counts.h"
#include "image_trees.h"

#include <gsl/gsl_multifit.h>
#include <stdlib.h>
#include <string.h>

enum { MIN_GRAINS = 4 }; // for 1, x, y, z

// The grains to fit, in units of the body's size around its middle.
struct fit {
    size_t n;
    gsl_matrix *place;           // (n, 4) 1, x, y, z
    gsl_vector *displacement[3]; // (n) along x, y, z
};

static double body_size(const struct packing *packing)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    return fmax(edge.x, fmax(edge.y, edge.z));
}

// The places of all grains as INTACT bonds put them together; *AROUND: the axes on
// which the fragment of GRAIN leads around the box. (n_particle); the caller frees it.
static struct vector *places_together(const struct packing *packing,
                                      const uint8_t *intact, int grain, bool around[3])
{
    struct image_tree *trees = image_trees_init(packing->n_particle);
    for (int b = 0; b < packing->n_bond; b++)
        if (intact[b])
            join_images(trees, packing->bond[b][0], packing->bond[b][1],
                        bond_image(packing, b));
    struct vector *place = NEW_ARRAY(struct vector, packing->n_particle);
    struct image image;
    for (int i = 0; i < packing->n_particle; i++) {
        find_image_root(trees, i, &image);
        place[i] = add(packing->position[i], image_offset(packing, image));
    }
    const int root = find_image_root(trees, grain, &image);
    memcpy(around, trees[root].around, sizeof trees[root].around);
    free(trees);
    return place;
}

static void fill(struct fit *fit, const struct run *run, const uint8_t *intact,
                 const uint8_t *is_in, const struct vector *displacement)
{
    const struct packing *packing = &run->packing;
    const double size = body_size(packing);
    const struct vector middle = scale(0.5, add(packing->lower, packing->upper));
    int first = 0;
    while (!is_in[first])
        first++;
    bool around[3];
    struct vector *place = places_together(packing, intact, first, around);
    size_t row = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        if (!is_in[i]) continue;
        gsl_matrix_set(fit->place, row, 0, 1);
        for (int axis = 0; axis < 3; axis++) {
            const double x = component(place[i], axis) - component(middle, axis);
            gsl_matrix_set(fit->place, row, (size_t)axis + 1,
                           around[axis] ? 0 : x / size);
            gsl_vector_set(fit->displacement[axis], row,
                           component(displacement[i], axis) / size);
        }
        row++;
    }
    free(place);
}

// G[i][j]: change of displacement i along axis j. A direction that the grains do not
// determine, because they lie in a plane, is singular and gives 0.
static void solve(const struct fit *fit, double G[3][3])
{
    static const double singular = 1e-9;
    gsl_multifit_linear_workspace *work = gsl_multifit_linear_alloc(fit->n, 4);
    gsl_vector *found = gsl_vector_alloc(4);
    gsl_matrix *covariance = gsl_matrix_alloc(4, 4);
    for (int i = 0; i < 3; i++) {
        double residual;
        size_t rank;
        gsl_multifit_linear_tsvd(fit->place, fit->displacement[i], singular, found,
                                 covariance, &residual, &rank, work);
        for (size_t j = 0; j < 3; j++)
            G[i][j] = gsl_vector_get(found, j + 1);
    }
    gsl_matrix_free(covariance);
    gsl_vector_free(found);
    gsl_multifit_linear_free(work);
}

// 1 - det(1 + G), expanded so that the 1 cancels exactly.
static double shrinkage_of(double G[3][3])
{
    const double trace = G[0][0] + G[1][1] + G[2][2];
    const double minors = G[0][0] * G[1][1] - G[0][1] * G[1][0] + G[1][1] * G[2][2] -
                          G[1][2] * G[2][1] + G[0][0] * G[2][2] - G[0][2] * G[2][0];
    const double determinant = G[0][0] * (G[1][1] * G[2][2] - G[1][2] * G[2][1]) -
                               G[0][1] * (G[1][0] * G[2][2] - G[1][2] * G[2][0]) +
                               G[0][2] * (G[1][0] * G[2][1] - G[1][1] * G[2][0]);
    return -(trace + minors + determinant);
}

static struct deformation deformation_of(double G[3][3])
{
    return (struct deformation){shrinkage_of(G),
                                {G[0][0], G[1][1], G[2][2], 0.5 * (G[1][2] + G[2][1]),
                                 0.5 * (G[0][2] + G[2][0]), 0.5 * (G[0][1] + G[1][0])}};
}

struct deformation body_deformation(const struct run *run, int s)
{
    const struct packing *packing = &run->packing;
    const size_t n_particle = (size_t)packing->n_particle;
    const uint8_t *intact = run->intact + (size_t)s * (size_t)packing->n_bond;
    uint8_t *is_in = largest_fragment(packing, intact);
    struct fit fit = {0};
    for (size_t i = 0; i < n_particle; i++)
        fit.n += is_in[i];
    struct deformation found = {NAN, {NAN, NAN, NAN, NAN, NAN, NAN}};
    if (fit.n >= MIN_GRAINS) {
        fit.place = gsl_matrix_alloc(fit.n, 4);
        for (int axis = 0; axis < 3; axis++)
            fit.displacement[axis] = gsl_vector_alloc(fit.n);
        fill(&fit, run, intact, is_in, run->displacement + (size_t)s * n_particle);
        double G[3][3];
        solve(&fit, G);
        found = deformation_of(G);
        for (int axis = 0; axis < 3; axis++)
            gsl_vector_free(fit.displacement[axis]);
        gsl_matrix_free(fit.place);
    }
    free(is_in);
    return found;
}
