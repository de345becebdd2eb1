// SPDX-License-Identifier: GPL-3.0-or-later
// Sites eliminated one by one against Gaussian elimination in long double, over twelve
// decades of conductance.
#include "../../test.h"
#include "../support_lattice.h"
#include "elimination/dense_front.h"
#include "elimination/kron_fronts.h"

#include "basics/cpu_features.h"
#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>

enum { SITES = 150, AIR = SITES, LINKS = 450 };

// What flows from each site held at 0 into the air at 1 while those that are free
// balance: by elimination of the free ones from the whole matrix.
static void evaporation(long double matrix[SITES + 1][SITES + 1], const bool *free_site,
                        long double *flow)
{
    static long double left[SITES + 1][SITES + 1];
    for (int i = 0; i <= SITES; i++)
        for (int j = 0; j <= SITES; j++)
            left[i][j] = matrix[i][j];
    for (int k = 0; k < SITES; k++) {
        long double total = 0;
        for (int j = 0; j <= SITES; j++)
            total += left[k][j];
        if (!free_site[k] || total == 0) continue;
        for (int i = 0; i <= SITES; i++)
            for (int j = 0; j <= SITES; j++)
                if (i != j && i != k && j != k)
                    left[i][j] += left[i][k] * left[k][j] / total;
        for (int i = 0; i <= SITES; i++)
            left[i][k] = left[k][i] = 0;
    }
    for (int i = 0; i < SITES; i++)
        flow[i] = left[i][AIR];
}

static void link_random(struct kron_fronts *mesh,
                        long double matrix[SITES + 1][SITES + 1], double decades,
                        uint64_t *seed)
{
    const int a = (int)(next_random(seed) * SITES);
    const int b = (a + 1 + (int)(next_random(seed) * (SITES - 1))) % SITES;
    const double conductance = pow(10, decades * (next_random(seed) - 0.5));
    if (next_random(seed) < 0.05) {
        kron_fronts_link_air(mesh, a, conductance);
        matrix[a][AIR] += conductance;
        matrix[AIR][a] += conductance;
    } else {
        kron_fronts_link(mesh, a, b, conductance);
        matrix[a][b] += conductance;
        matrix[b][a] += conductance;
    }
}

static void check_elimination(double decades, uint64_t seed)
{
    static long double matrix[SITES + 1][SITES + 1];
    for (int i = 0; i <= SITES; i++)
        for (int j = 0; j <= SITES; j++)
            matrix[i][j] = 0;
    struct kron_fronts mesh = kron_fronts_init(SITES, false);
    for (int k = 0; k < LINKS; k++)
        link_random(&mesh, matrix, decades, &seed);
    bool free_site[SITES] = {false};
    for (int n = 0; n < SITES - 5; n++) {
        int site = (int)(next_random(&seed) * SITES);
        while (free_site[site])
            site = (site + 1) % SITES;
        free_site[site] = true;
        kron_fronts_eliminate(&mesh, site);
        if (n % 8 != 0) continue;
        long double flow[SITES], sum = 0;
        evaporation(matrix, free_site, flow);
        for (int i = 0; i < SITES; i++) {
            sum += flow[i];
            if (free_site[i])
                assert_true(kron_fronts_air(&mesh, i) == 0);
            else
                assert_true(fabsl(kron_fronts_air(&mesh, i) - flow[i]) <=
                            1e-14L * flow[i]);
        }
        const double all = compensated_value(mesh.air.all);
        assert_true(fabsl(all - sum) <= 1e-14L * sum);
    }
    kron_fronts_free(&mesh);
}

TEST(every_digit_over_twelve_decades)
{
    for (uint64_t seed = 1; seed <= 5; seed++)
        check_elimination(12, seed);
}

TEST(every_digit_where_conductances_are_alike)
{
    check_elimination(0, 7);
    check_elimination(1, 8);
}

// Gas that is shut in between wet sites brings nothing to the air: exactly.
TEST(shut_in_is_exactly_zero)
{
    struct kron_fronts mesh = kron_fronts_init(4, false);
    kron_fronts_link(&mesh, 0, 1, 1);
    kron_fronts_link(&mesh, 1, 2, 1);
    kron_fronts_link_air(&mesh, 3, 1);
    kron_fronts_link(&mesh, 2, 3, 1);
    kron_fronts_eliminate(&mesh, 1);
    assert_true(kron_fronts_air(&mesh, 0) == 0 && kron_fronts_air(&mesh, 2) == 0 &&
                kron_fronts_air(&mesh, 3) == 1);
    kron_fronts_eliminate(&mesh, 3);
    assert_true(kron_fronts_air(&mesh, 0) == 0 && kron_fronts_air(&mesh, 2) == 0.5);
    kron_fronts_eliminate(&mesh, 2);
    assert_true(fabs(kron_fronts_air(&mesh, 0) - 0.25) <
                1e-16); // three links and the air in series
    kron_fronts_free(&mesh);
}

enum { ROWS = 1101, SOURCES = 61 }; // as many wait, and are not added before

// A large triangle for which products of random rows wait, all between 0 and 1.
static struct dense_front wait_for_products(bool is_rounded, double row[SOURCES][ROWS],
                                            const double *factor)
{
    struct dense_front dense = {0};
    for (int i = 0; i < ROWS; i++) {
        dense_front_add_row(&dense, i);
        for (int j = 0; j < i; j++)
            dense_front_set(&dense, i, j, 1.0 / (i + j));
    }
    dense_front_enlarge(&dense, ROWS, is_rounded);
    for (int k = 0; k < SOURCES; k++)
        dense_front_add_products(&dense, ROWS, factor[k], row[k]);
    return dense;
}

struct kernels {
    dense_front_pass *pass;
    dense_front_gather *gather;
};

// By narrow vectors and by wide ones.
static void check_kernels(const struct kernels kernels[2], bool is_rounded,
                          double tolerance)
{
    static double row[SOURCES][ROWS];
    double gathered[2][ROWS] = {0};
    double factor[SOURCES];
    uint64_t seed = 5;
    for (int k = 0; k < SOURCES; k++) {
        for (int i = 0; i < ROWS; i++)
            row[k][i] = next_random(&seed);
        factor[k] = next_random(&seed);
    }
    struct dense_front dense[2];
    for (int wide = 0; wide < 2; wide++) {
        dense[wide] = wait_for_products(is_rounded, row, factor);
        assert_int_equal(dense[wide].n_pending, SOURCES);
        kernels[wide].gather(&dense[wide], ROWS, factor, gathered[wide]);
        kernels[wide].pass(&dense[wide], ROWS);
    }
    for (int i = 0; i < ROWS; i++) {
        double sum = 0;
        for (int k = 0; k < SOURCES; k++)
            sum += factor[k] * row[k][i];
        assert_true(gathered[0][i] == gathered[1][i]);
        assert_true(fabs(gathered[0][i] / sum - 1) < tolerance);
    }
    for (int i = 0; i < ROWS; i++)
        for (int j = 0; j < i; j++) {
            double sum = 1.0 / (i + j);
            for (int k = 0; k < SOURCES; k++)
                sum += factor[k] * row[k][i] * row[k][j];
            const double entry = dense_front_entry(&dense[0], i, j);
            assert_true(entry == dense_front_entry(&dense[1], i, j));
            assert_true(fabs(entry / sum - 1) < tolerance);
        }
    dense_front_free(&dense[0]);
    dense_front_free(&dense[1]);
}

// Large fronts are updated by narrow vectors or wide ones: the same digits, and near
// what the sum is.
TEST_WHERE(has_avx512(), "no wide vectors here", width_of_vectors_does_not_matter)
{
    check_kernels(
        (struct kernels[]){
            {dense_front_pass_avx2_double, dense_front_gather_avx2_double},
            {dense_front_pass_avx512_double, dense_front_gather_avx512_double}},
        false, 1e-14);
    check_kernels(
        (struct kernels[]){
            {dense_front_pass_avx2_float, dense_front_gather_avx2_float},
            {dense_front_pass_avx512_float, dense_front_gather_avx512_float}},
        true, 1e-6);
}

// Eliminates every third site of a chain in which each site is linked to the air.
static struct kron_fronts chain_in_air(int n)
{
    struct kron_fronts mesh = kron_fronts_init(n, false);
    for (int i = 0; i < n; i++) {
        kron_fronts_link_air(&mesh, i, 1 + i);
        if (i > 0) kron_fronts_link(&mesh, i - 1, i, 1.0 / i);
    }
    for (int i = 1; i < n; i += 3)
        kron_fronts_eliminate(&mesh, i);
    return mesh;
}

// More sites with air than the mesh that a state is restored to had ever had: room for
// them is made on the way.
TEST(restored_state_has_the_same_air)
{
    enum { CHAIN = 1000 };
    struct kron_fronts mesh = chain_in_air(CHAIN);
    struct checkpoint_stream kept = stream_to_keep();
    kron_fronts_state(&mesh, &kept);
    struct array_list list = stream_list(&kept, "mesh");
    stream_free(&kept);

    struct kron_fronts other = kron_fronts_init(CHAIN, false);
    struct checkpoint_stream restored = stream_to_restore(&list, "mesh");
    kron_fronts_state(&other, &restored);
    assert_true(stream_is_whole(&restored) && kron_fronts_fit(&other));
    for (int i = 0; i < CHAIN; i++)
        assert_true(kron_fronts_air(&other, i) == kron_fronts_air(&mesh, i));
    stream_free(&restored);
    free_arrays(list.array, list.count);
    kron_fronts_free(&other);
    kron_fronts_free(&mesh);
}
