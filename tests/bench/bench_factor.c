// SPDX-License-Identifier: GPL-3.0-or-later
// Seconds of a factor of a bonded cubic lattice's stiffness by our supernodal kernels
// and by CHOLMOD, with the BLAS that the program is linked with; one ordering for all,
// the least of ROUNDS:
//
//     bench_factor SIDE HEIGHT [ROUNDS]
#include "basics/memory.h"
#include "sparse/cholmod_serial.h"
#include "sparse/supernodal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { BLOCK = 6 }; // displacement and rotation of a grain

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// A joint couples all numbers of two grains; rows are diagonally dominant.
static void add_block(cholmod_triplet *entries, int i, int j)
{
    for (int a = 0; a < BLOCK; a++)
        for (int b = 0; b < BLOCK; b++) {
            if (i == j && b > a) continue;
            const double value =
                i == j && a == b ? 50 : 0.9 * sin(1 + i + 2.0 * j + 3 * a + 5 * b);
            add_entry(entries, BLOCK * i + a, BLOCK * j + b, value);
        }
}

static cholmod_sparse *lattice(cholmod_common *common, int side, int height)
{
    const int n = side * side * height;
    cholmod_triplet *entries =
        new_entries(common, BLOCK * n, (size_t)(4 * BLOCK * BLOCK * n));
    for (int i = 0; i < n; i++) {
        add_block(entries, i, i);
        if (i % side) add_block(entries, i, i - 1);
        if (i / side % side) add_block(entries, i, i - side);
        if (i >= side * side) add_block(entries, i, i - side * side);
    }
    return take_matrix(common, entries);
}

static double time_ours(const cholmod_sparse *matrix, int rounds, double *work)
{
    struct supernodal *factor =
        supernodal_create((int)matrix->nrow, matrix->p, matrix->i);
    double best = INFINITY;
    for (int k = 0; k < rounds; k++) {
        const double began = seconds();
        if (!supernodal_factor(factor, matrix->x)) exit(1);
        best = fmin(best, seconds() - began);
    }
    *work = supernodal_work(factor);
    supernodal_free(factor);
    return best;
}

static double time_cholmod(cholmod_sparse *matrix, int kind, int rounds)
{
    cholmod_common common;
    cholmod_serial_start(&common);
    common.supernodal = kind;
    common.final_ll = 1;
    cholmod_factor *factor = cholmod_analyze(matrix, &common);
    double best = INFINITY;
    for (int k = 0; k < rounds; k++) {
        const double began = seconds();
        if (!cholmod_factorize(matrix, factor, &common) || common.status != CHOLMOD_OK)
            exit(1);
        best = fmin(best, seconds() - began);
    }
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
    return best;
}

int main(int argc, char **argv)
{
    if (argc < 3) return 64;
    const int rounds = argc > 3 ? atoi(argv[3]) : 3;
    cholmod_common common;
    cholmod_serial_start(&common);
    cholmod_sparse *matrix = lattice(&common, atoi(argv[1]), atoi(argv[2]));
    double work;
    const double ours = time_ours(matrix, rounds, &work);
    const double super = time_cholmod(matrix, CHOLMOD_SUPERNODAL, rounds);
    const double simplicial = time_cholmod(matrix, CHOLMOD_SIMPLICIAL, rounds);
    printf("%zu unknowns, %.2g multiplications: ours %.3f s, CHOLMOD supernodal %.3f, "
           "simplicial %.3f\n",
           matrix->nrow, work, ours, super, simplicial);
    cholmod_free_sparse(&matrix, &common);
    cholmod_finish(&common);
}
