// SPDX-License-Identifier: GPL-3.0-or-later
// A table from exact solutions. In each patch of volumes, at Chebyshev's nodes of u and
// w,
//     value = F (1 + a/C)^2 at zeta(w), with 1/A a polynomial in u through turning
//     points,
// are interpolated by a polynomial in each direction (fit_place), bicubic. The exact
// bridges of one volume come from one continuation with rising gaps
// (follow_to_turning). `measure` then compares with exact solutions between the nodes,
// at the border of two patches. Patches are independent: OpenMP shares them out.
#include "bridges/table_make.h"
#include "basics/memory.h"

#include <stdlib.h>

double chebyshev_node(int k, int count)
{
    return cos(M_PI * (k + 0.5) / count);
}

void fit_polynomial(const double *value, int count, double *power)
{
    static const double powers[TURNING_ORDER][TURNING_ORDER] = {
        {1},           {0, 1},           {-1, 0, 2},
        {0, -3, 0, 4}, {1, 0, -8, 0, 8}, {0, 5, 0, -20, 0, 16}};
    memset(power, 0, (size_t)count * sizeof *power);
    for (int n = 0; n < count; n++) {
        double sum = 0;
        for (int k = 0; k < count; k++)
            sum += value[k] * cos(M_PI * n * (k + 0.5) / count);
        sum *= (n ? 2.0 : 1.0) / count;
        for (int p = 0; p <= n; p++)
            power[p] += sum * powers[n][p];
    }
}

// zeta of node J of a place, from 0 at the turning point up.
static double zeta_at(int place, double w)
{
    const double x = place + 0.5 * (w + 1);
    return (x < 2 * NARROW ? 0.5 * x : x - NARROW) / WIDE;
}

enum status sample_forces(const struct bodies *bodies, double volume,
                          const struct volume_patch *at, double u,
                          double values[SAMPLES])
{
    const double inverse = POLYNOMIAL(at->turning, u), steepness = at->steepness;
    double gap[SAMPLES];
    struct equilibrium found[SAMPLES];
    for (int s = 0; s < SAMPLES; s++) { // from contact on: gaps rise
        const double zeta =
            zeta_at(PLACES - 1 - s / ORDER, chebyshev_node(s % ORDER, ORDER));
        gap[s] = (1 - zeta * zeta) / (inverse + zeta * zeta * steepness);
    }
    const enum status status = follow_to_turning(bodies, volume, SAMPLES, gap, found);
    if (status) return status;
    for (int s = 0; s < SAMPLES; s++) {
        const double stretch = 1 + gap[s] * steepness;
        const int place = PLACES - 1 - s / ORDER;
        values[place * ORDER + s % ORDER] =
            2 * M_PI * arc_force(bodies, &found[s].arc) * stretch * stretch;
    }
    return STATUS_OK;
}

// Fits 1/A: A of turning points, or if BROKEN of rupture.
static enum status fit_turning(const struct bodies *bodies, int patch, bool broken,
                               struct volume_patch *at)
{
    double inverse[TURNING_ORDER];
    for (int k = 0; k < TURNING_ORDER; k++) {
        struct equilibrium last;
        const double volume = patch_volume(patch, chebyshev_node(k, TURNING_ORDER));
        const enum status status =
            (broken ? find_rupture : find_turning)(bodies, volume, &last);
        if (status) return status;
        inverse[k] = 1 / last.gap;
    }
    fit_polynomial(inverse, TURNING_ORDER, at->turning);
    return STATUS_OK;
}

// zeta where the bridge ruptures; nearer to 0 than 1e-4 nobody can tell.
static enum status fit_end(const struct bodies *bodies, int patch,
                           const struct volume_patch *at, double end[ORDER])
{
    double zeta[ORDER];
    for (int k = 0; k < ORDER; k++) {
        struct equilibrium last;
        const double u = chebyshev_node(k, ORDER);
        const enum status status = find_rupture(bodies, patch_volume(patch, u), &last);
        if (status) return status;
        const double rest = 1 - last.gap * POLYNOMIAL(at->turning, u);
        zeta[k] = sqrt(fmax(rest, 0) / (1 + last.gap * at->steepness));
        if (zeta[k] < 1e-4) zeta[k] = 0;
    }
    fit_polynomial(zeta, ORDER, end);
    return STATUS_OK;
}

// Where symmetry breaks well before the turning point, that is too far to make forces
// steep, and the branch may wind on its way there: then A is where the bridge ruptures.
static enum status fit_volumes(const struct bodies *bodies, int patch,
                               struct volume_patch *at, double end[ORDER])
{
    const double well_before = 0.1;
    at->steepness = 1 / (1.2 * sqrt(patch_volume(patch, 0)));
    enum status status = fit_turning(bodies, patch, false, at);
    if (!status) status = fit_end(bodies, patch, at, end);
    if (!status && end[0] < well_before) return STATUS_OK;
    memset(end, 0, ORDER * sizeof *end);
    return fit_turning(bodies, patch, true, at);
}

void fit_place(int volumes, const double value[][SAMPLES], size_t place, float8 row[])
{
    double across[ORDER][TURNING_ORDER], power[TURNING_ORDER];
    for (int v = 0; v < volumes; v++) {
        fit_polynomial(&value[v][place * ORDER], ORDER, power);
        for (int j = 0; j < ORDER; j++)
            across[j][v] = power[j];
    }
    for (int j = 0; j < ORDER; j++) {
        fit_polynomial(across[j], volumes, power);
        for (int i = 0; i < volumes; i++)
            row[i / 2][i % 2 * ORDER + j] = (float)power[i];
    }
}

enum status fill_patch(const struct bodies *bodies, int patch,
                       struct bridge_table *table)
{
    struct volume_patch *at = &table->volume[patch];
    double value[ORDER][SAMPLES];
    enum status status = fit_volumes(bodies, patch, at, table->end[patch]);
    for (int v = 0; v < ORDER && !status; v++) {
        const double u = chebyshev_node(v, ORDER);
        status = sample_forces(bodies, patch_volume(patch, u), at, u, value[v]);
    }
    for (size_t place = 0; place < PLACES && !status; place++)
        fit_place(ORDER, value, place, table->force[patch][place]);
    return status;
}

// The largest error of stable bridges at places between the nodes, on the border of two
// patches.
static enum status measure(const struct bodies *bodies,
                           const struct bridge_table *table, int patch, double *error)
{
    enum { CHECKS = 2 * PLACES };
    const double volume = patch_volume(patch, -1);
    double gap[CHECKS], inverse;
    struct equilibrium found[CHECKS];
    const struct volume_patch *at = &table->volume[patch];
    inverse = POLYNOMIAL(at->turning, -1.0);
    for (int k = 0; k < CHECKS; k++) { // ends and middles of places, from contact on
        const double zeta = zeta_at(PLACES - 1 - k / 2, k % 2 ? 0 : 1);
        const double square = zeta * zeta;
        gap[k] = (1 - square) / (inverse + square * at->steepness);
    }
    const enum status status = follow_to_turning(bodies, volume, CHECKS, gap, found);
    if (status) return status;
    *error = 0;
    for (int k = 0; k < CHECKS; k++) {
        const double exact = 2 * M_PI * arc_force(bodies, &found[k].arc);
        const struct place place = place_of(table, volume, gap[k]);
        const double least = BRIDGE_TABLE_FLOOR * place.scale;
        const double ours = bridge_table_force(table, volume, gap[k]);
        if (!(place.scale > 0)) break; // ruptured
        *error = fmax(*error, fabs(ours - exact) / fmax(fabs(exact), least));
    }
    return STATUS_OK;
}

enum status bridge_table_create(const double radius[2], const double contact_angle[2],
                                struct bridge_table **table, struct reason *reason)
{
    const double first = 1 / radius[0], second = 1 / radius[1];
    const double scale = 2 / (first + second);
    if (!(first >= 0 && second >= 0 && isfinite(scale)))
        return refuse(reason, STATUS_BAD_DATA, "no bridge between radii %g and %g",
                      radius[0], radius[1]);
    const struct bodies bodies = {{first * scale, second * scale},
                                  {contact_angle[0], contact_angle[1]}};
    struct bridge_table *made = aligned_alloc(64, sizeof *made);
    if (!made) return refuse(reason, STATUS_INTERNAL, "out of memory");
    *table = made;
    enum status status[VOLUMES];
    double error[VOLUMES];
#pragma omp parallel for schedule(dynamic)
    for (int patch = 0; patch < VOLUMES; patch++)
        status[patch] = fill_patch(&bodies, patch, made);
    made->breaks = false;
    for (int patch = 0; patch < VOLUMES; patch++)
        made->breaks = made->breaks || (!status[patch] && breaks_in(made->end[patch]));
#pragma omp parallel for schedule(dynamic)
    for (int patch = 0; patch < VOLUMES; patch++)
        if (!status[patch])
            status[patch] = measure(&bodies, made, patch, &error[patch]);
    made->error = 0;
    for (int patch = 0; patch < VOLUMES; patch++) {
        if (status[patch]) {
            free(made);
            return refuse(
                reason, STATUS_NOT_CONVERGED,
                "no table: a bridge of %g effective radii cubed was not solved",
                patch_volume(patch, 0));
        }
        made->error = fmax(made->error, error[patch]);
    }
    return STATUS_OK;
}
