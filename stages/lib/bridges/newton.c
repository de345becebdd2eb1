// SPDX-License-Identifier: GPL-3.0-or-later
// Damped Newton's method for the four equations of a bridge, scaled to order one:
//     residual[0], [1] = miss / length   (slope and radius at the second body),
//     residual[2] = (volume + shared) / V - 1, or turn - H length,
//     residual[3] = (gap - wanted gap) / length, or direction.(x - x_from) - distance.
// For equal bodies residual[0] is reach_1 - reach_2 in logarithms: only symmetric
// bridges. A step is at most `longest` and is halved while it does not reduce the
// residuals. It is done when a step is below 1e-8, as the next would be of the order of
// its square.
#include "bridges/newton.h"

#include <math.h>

enum { MOST_STEPS = 25, HALVINGS = 4 };
static const double CONVERGED_STEP = 1e-8; // last step; the next would be of its square
static const double LONGEST_STEP = 0.7;    // of a step

struct arc arc_of(const struct unknowns *unknowns)
{
    const double *at = unknowns->at;
    return (struct arc){
        {exp(at[ARC_FIRST]), exp(at[ARC_SECOND])}, exp(at[ARC_LENGTH]), at[ARC_TURN]};
}

struct unknowns unknowns_of(const struct arc *arc)
{
    return (struct unknowns){
        {log(arc->reach[0]), log(arc->reach[1]), log(arc->length), arc->turn}};
}

struct system system_at(const struct problem *problem, const struct unknowns *unknowns)
{
    const struct arc arc = arc_of(unknowns);
    const struct span span = span_of(problem->bodies, &arc);
    const double scale = 1 / arc.length, share = 1 / problem->volume;
    struct system is = {.residual = {span.miss[0] * scale, span.miss[1] * scale,
                                     (span.volume + problem->shared) * share - 1,
                                     (span.gap - problem->gap) * scale}};
    if (problem->from) is.residual[3] = -problem->distance;
    if (problem->symmetric) is.residual[0] = unknowns->at[0] - unknowns->at[1];
    if (problem->curvature)
        is.residual[2] = arc.turn - *problem->curvature * arc.length;
    for (int n = 0; n < ARC_NUMBERS; n++) {
        is.slope[0][n] =
            problem->symmetric ? (n == 0) - (n == 1) : span.miss_slope[0][n] * scale;
        is.slope[1][n] = span.miss_slope[1][n] * scale;
        is.slope[2][n] = span.volume_slope[n] * share;
        if (problem->curvature)
            is.slope[2][n] =
                (n == ARC_TURN) - (n == ARC_LENGTH) * *problem->curvature * arc.length;
        is.slope[3][n] = span.gap_slope[n] * scale;
        if (!problem->from) continue;
        is.slope[3][n] = problem->direction[n];
        is.residual[3] +=
            problem->direction[n] * (unknowns->at[n] - problem->from->at[n]);
    }
    return is;
}

static double size_of(const double residual[ARC_NUMBERS])
{
    double sum = 0;
    for (int k = 0; k < ARC_NUMBERS; k++)
        sum += residual[k] * residual[k];
    return sum;
}

double eliminate(double matrix[ARC_NUMBERS][ARC_NUMBERS], double right[ARC_NUMBERS])
{
    enum { N = ARC_NUMBERS };
    double determinant = 1;
    for (int k = 0; k < N; k++) {
        int pivot = k;
        for (int row = k + 1; row < N; row++)
            if (fabs(matrix[row][k]) > fabs(matrix[pivot][k])) pivot = row;
        if (!(fabs(matrix[pivot][k]) > 0)) return 0;
        if (pivot != k) {
            determinant = -determinant;
            for (int n = 0; n < N; n++) {
                const double kept = matrix[k][n];
                matrix[k][n] = matrix[pivot][n];
                matrix[pivot][n] = kept;
            }
            const double kept = right[k];
            right[k] = right[pivot];
            right[pivot] = kept;
        }
        determinant *= matrix[k][k];
        for (int row = k + 1; row < N; row++) {
            const double factor = matrix[row][k] / matrix[k][k];
            for (int n = k; n < N; n++)
                matrix[row][n] -= factor * matrix[k][n];
            right[row] -= factor * right[k];
        }
    }
    for (int k = N - 1; k >= 0; k--) {
        for (int n = k + 1; n < N; n++)
            right[k] -= matrix[k][n] * right[n];
        right[k] /= matrix[k][k];
    }
    return determinant;
}

struct unknowns moved(const struct unknowns *from, const double step[ARC_NUMBERS],
                      double share)
{
    struct unknowns to;
    for (int k = 0; k < ARC_NUMBERS; k++)
        to.at[k] = from->at[k] + share * step[k];
    return to;
}

bool sensible(const struct bodies *bodies, const struct unknowns *unknowns)
{
    const struct arc arc = arc_of(unknowns);
    for (int k = 0; k < 2; k++)
        if (!(bodies->curvature[k] * arc.reach[k] < M_PI)) return false;
    return fabs(arc.turn) < 2 * M_PI && isfinite(arc.length);
}

static double longest_of(const double step[ARC_NUMBERS])
{
    double most = 0;
    for (int k = 0; k < ARC_NUMBERS; k++)
        most = fmax(most, fabs(step[k]));
    return most;
}

bool converge(const struct problem *problem, struct unknowns *unknowns, int *count)
{
    struct system is = system_at(problem, unknowns);
    for (int k = 0; k < MOST_STEPS; k++) {
        double step[ARC_NUMBERS];
        for (int n = 0; n < ARC_NUMBERS; n++)
            step[n] = -is.residual[n];
        if (eliminate(is.slope, step) == 0) return false;
        const double size = longest_of(step), before = size_of(is.residual);
        if (!isfinite(size)) return false;
        (*count)++;
        if (size < CONVERGED_STEP) {
            *unknowns = moved(unknowns, step, 1);
            return true;
        }
        double share = fmin(1, LONGEST_STEP / size);
        struct unknowns next = moved(unknowns, step, share);
        for (int h = 0;; h++) {
            if (sensible(problem->bodies, &next)) {
                is = system_at(problem, &next);
                if (size_of(is.residual) < before) break;
            }
            // Rounding may keep a converged residual from falling.
            if (h == HALVINGS) return before < RESIDUAL_ROUNDING * RESIDUAL_ROUNDING;
            share *= 0.5;
            next = moved(unknowns, step, share);
        }
        *unknowns = next;
    }
    return false;
}
