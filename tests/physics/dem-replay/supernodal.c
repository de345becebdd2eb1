// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse Cholesky factors and small dense systems against what they are put into.
#include "sparse/supernodal.h"
#include "../../test.h"
#include "basics/memory.h"
#include "sparse/dense_lu.h"
#include "sparse/vector_kernels.h"

#include <math.h>
#include <stdlib.h>

enum { SIDE = 9, N = SIDE * SIDE * SIDE };

// The lower triangle, and of the upper what must be ignored.
struct springs {
    int start[N + 1], row[5 * N];
    double value[5 * N];
};

// Between neighbours of a cube, uneven, and SOFT ones to the ground.
static struct springs *make_springs(double soft)
{
    struct springs *s = NEW_ARRAY(struct springs, 1);
    double diagonal[N] = {0};
    const int step[3] = {1, SIDE, SIDE * SIDE};
    int count = 0;
    for (int c = 0; c < N; c++) {
        s->start[c] = count;
        if (c > 0) s->row[count] = c - 1, s->value[count++] = 1e30;
        s->row[count++] = c;
        for (int axis = 0; axis < 3; axis++) {
            if (c / step[axis] % SIDE == SIDE - 1) continue;
            const double spring = 1 + (c * 7 + axis) % 5;
            s->row[count] = c + step[axis];
            s->value[count++] = -spring;
            diagonal[c] += spring;
            diagonal[c + step[axis]] += spring;
        }
    }
    s->start[N] = count;
    for (int c = 0; c < N; c++)
        for (int k = s->start[c]; k < s->start[c + 1]; k++)
            if (s->row[k] == c) s->value[k] = diagonal[c] + soft;
    return s;
}

static void multiply(const struct springs *s, const double *x, double *product)
{
    for (int i = 0; i < N; i++)
        product[i] = 0;
    for (int c = 0; c < N; c++)
        for (int k = s->start[c]; k < s->start[c + 1]; k++) {
            const int r = s->row[k];
            if (r < c) continue;
            product[r] += s->value[k] * x[c];
            if (r != c) product[c] += s->value[k] * x[r];
        }
}

// X (N), the right-hand side, becomes the answer.
static void solve(struct supernodal *factor, double *x)
{
    double half[N];
    supernodal_forward(factor, x, half);
    supernodal_backward(factor, half, x);
}

TEST(answers_are_those_of_the_matrix)
{
    struct springs *s = make_springs(0.1);
    struct supernodal *factor = supernodal_create(N, s->start, s->row);
    double x[N], product[N];
    for (int again = 0; again < 2; again++) {
        assert_true(supernodal_factor(factor, s->value));
        for (int i = 0; i < N; i++)
            x[i] = sin(i);
        solve(factor, x);
        multiply(s, x, product);
        for (int i = 0; i < N; i++)
            assert_true(fabs(product[i] - sin(i)) < 1e-12);
    }
    supernodal_free(factor);
    free(s);
}

// b^T A^-1 c by halves and by solving.
TEST(halves_make_the_same_products)
{
    struct springs *s = make_springs(0.1);
    struct supernodal *factor = supernodal_create(N, s->start, s->row);
    assert_true(supernodal_factor(factor, s->value));
    const int index[2][6] = {{3, 77, 500, 3, 77, 500}, {78, 3, 700, 78, 3, 700}};
    const double value[2][6] = {{1, 2, -1, 0.5, 0, 3}, {-1, 1, 2, 4, 0.1, 0}};
    struct forward_solves solves[2];
    for (int k = 0; k < 2; k++)
        supernodal_forward_solves(factor, 1, &(int){2}, 3, index[k], value[k],
                                  &solves[k]);
    for (int k = 0; k < 16; k++) {
        const int a = k / 8, b = k / 4 % 2, i = k / 2 % 2, j = k % 2;
        double product[4], x[N] = {0}, expected = 0;
        forward_solves_product(factor, &solves[a], &solves[b], product);
        for (int m = 0; m < 3; m++)
            x[index[b][m]] = value[b][3 * j + m];
        solve(factor, x);
        for (int m = 0; m < 3; m++)
            expected += value[a][3 * i + m] * x[index[a][m]];
        assert_true(fabs(product[2 * i + j] - expected) < 1e-13);
    }
    double half[N], other[N], x[N] = {0}, product[2];
    for (int m = 0; m < 3; m++)
        x[index[1][m]] = value[1][m];
    supernodal_forward(factor, x, half);
    forward_solves_apply(factor, &solves[1], half, product);
    supernodal_backward(factor, half, other);
    for (int k = 0; k < 2; k++) {
        double expected = 0;
        for (int m = 0; m < 3; m++)
            expected += value[1][3 * k + m] * other[index[1][m]];
        assert_true(fabs(product[k] - expected) < 1e-13);
    }
    forward_solves_subtract(factor, &solves[1], (double[]){1, 0}, half);
    for (int i = 0; i < N; i++)
        assert_true(fabs(half[i]) < 1e-13); // all of it
    forward_solves_free(&solves[0]);
    forward_solves_free(&solves[1]);
    supernodal_free(factor);
    free(s);
}

// Nothing holds the cube: a pivot is rounding, the answer to a load in balance a number
// all the same. A matrix that is none is refused.
TEST(a_pivot_of_rounding_stays_a_number)
{
    struct springs *s = make_springs(0);
    struct supernodal *factor = supernodal_create(N, s->start, s->row);
    assert_true(supernodal_factor(factor, s->value));
    double x[N] = {[0] = 1, [N - 1] = -1}, product[N];
    solve(factor, x);
    multiply(s, x, product);
    for (int i = 1; i < N - 1; i++)
        assert_true(fabs(product[i]) < 1e-6);
    s->value[0] = NAN;
    assert_false(supernodal_factor(factor, s->value));
    supernodal_free(factor);
    free(s);
    assert_null(supernodal_create(0, &(int){0}, NULL));
}

// Without a diagonal, so that pivots must be sought.
TEST(dense_systems)
{
    enum { MOST = 70 };
    for (int n = 2; n <= MOST; n++) {
        static double whole[MOST][MOST], matrix[MOST][MOST];
        double right[MOST], answer[MOST], work[MOST * DENSE_PANEL];
        int order[MOST];
        for (int i = 0; i < n; i++) {
            right[i] = cos(i);
            for (int j = 0; j < n; j++)
                whole[i][j] = matrix[i][j] = i == j ? 0 : sin(3 * i + 7 * j * j);
        }
        assert_true(dense_factor(n, matrix[0], MOST, order, work));
        dense_substitute(n, matrix[0], MOST, order, right, answer);
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++)
                right[i] -= whole[i][j] * answer[j];
            assert_true(fabs(right[i]) < 1e-11);
        }
    }
    double none[4] = {1, 2, 2, 4}, work[2 * DENSE_PANEL];
    int order[2];
    assert_false(dense_factor(2, none, 2, order, work));
}

// Vectors of four numbers or of eight: the same digits.
TEST_WHERE(has_avx512(), "no wide vectors here", vectors_of_any_width)
{
    enum { M = 51, COLUMNS = 13, K = 17 };
    double a[M * K + 8], sum[2][BATCH][BATCH] = {{{0}}}, c[2][M * COLUMNS] = {{0}};
    double d[2][M * M] = {{0}};
    double work[M * PACKED];
    double matrix[2][M * M];
    int order[2][M];
    for (int k = 0; k < M * K + 8; k++)
        a[k] = sin(k * k);
    const struct vector_kernels *const both[] = {&vector_kernels_avx2,
                                                 &vector_kernels_avx512};
    for (int wide = 0; wide < 2; wide++) {
        both[wide]->multiply_transposed(M, COLUMNS, K, a, M, a + 5, M, c[wide], M,
                                        false, work);
        both[wide]->multiply_transposed(M - 1, M - 1, K, a, M, a, M, d[wide], M, true,
                                        work);
        both[wide]->add_product_of_eight(K, a, 8, a + 9, sum[wide]);
        for (int k = 0; k < M * M; k++)
            matrix[wide][k] = sin(k * k);
        assert_true(both[wide]->factor_dense(M, matrix[wide], M, order[wide], work));
    }
    assert_memory_equal(matrix[0], matrix[1], sizeof matrix[0]);
    assert_memory_equal(order[0], order[1], sizeof order[0]);
    assert_memory_equal(c[0], c[1], sizeof c[0]);
    assert_memory_equal(sum[0], sum[1], sizeof sum[0]);
    for (int i = 0; i < M; i++)
        for (int j = 0; j < COLUMNS; j++) {
            double expected = 0;
            for (int k = 0; k < K; k++)
                expected += a[k * M + i] * a[5 + k * M + j];
            assert_true(fabs(c[1][j * M + i] - expected) < 1e-12);
        }
    for (int i = 0; i < M - 1; i++)
        for (int j = 0; j <= i; j++) {
            double expected = 0;
            for (int k = 0; k < K; k++)
                expected += a[k * M + i] * a[k * M + j];
            assert_true(fabs(d[1][j * M + i] - expected) < 1e-12);
            assert_true(d[0][j * M + i] == d[1][j * M + i]);
        }
}
