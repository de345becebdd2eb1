// SPDX-License-Identifier: GPL-3.0-or-later
// The rotation R that maximises sum b . R a, by Horn's quaternions (J. Opt. Soc. Am. A
// 4 (1987) 629): with M_ij = sum a_i b_j, R's quaternion is the eigenvector of the
// largest eigenvalue of the symmetric 4 x 4 matrix
//     | tr M     d^T           |
//     | d        M + M^T - tr M |,   d = (M_yz - M_zy, M_zx - M_xz, M_xy - M_yx),
// and that eigenvalue is the maximum. If the two largest eigenvalues are equal, as for
// directions along one line, the rotation is not determined: then there is none.
#include "rotation.h"

#include <gsl/gsl_eigen.h>

void add_products(struct products *sum, struct vector a, struct vector b)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            sum->of[i][j] += component(a, i) * component(b, j);
}

// Horn's matrix of the products OF.
static void fill(const double of[3][3], double matrix[4][4])
{
    const double trace = of[0][0] + of[1][1] + of[2][2];
    matrix[0][0] = trace;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        matrix[0][i + 1] = matrix[i + 1][0] = of[j][k] - of[k][j];
        matrix[i + 1][i + 1] = 2 * of[i][i] - trace;
        matrix[i + 1][j + 1] = matrix[j + 1][i + 1] = of[i][j] + of[j][i];
    }
}

struct rotation find_rotation(const struct products *sum)
{
    static const double alike = 1e-6; // of the largest
    double matrix[4][4], value[4], vector[4][4];
    fill(sum->of, matrix);
    const double trace = matrix[0][0];
    gsl_matrix_view m = gsl_matrix_view_array(matrix[0], 4, 4);
    gsl_matrix_view v = gsl_matrix_view_array(vector[0], 4, 4);
    gsl_vector_view e = gsl_vector_view_array(value, 4);
    gsl_eigen_symmv_workspace *workspace = gsl_eigen_symmv_alloc(4);
    gsl_eigen_symmv(&m.matrix, &e.vector, &v.matrix, workspace);
    gsl_eigen_symmv_free(workspace);
    gsl_eigen_symmv_sort(&e.vector, &v.matrix, GSL_EIGEN_SORT_VAL_DESC);
    if (!(value[0] - value[1] > alike * fabs(value[0])))
        return (struct rotation){.cosine = 1, .along = trace};
    return (struct rotation){
        vector[0][0], {vector[1][0], vector[2][0], vector[3][0]}, value[0]};
}

struct vector rotated(const struct rotation *turn, struct vector x)
{
    const struct vector across = cross(turn->axis, x);
    return add(x,
               scale(2, add(scale(turn->cosine, across), cross(turn->axis, across))));
}
