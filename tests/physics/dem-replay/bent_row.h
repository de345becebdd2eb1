// SPDX-License-Identifier: GPL-3.0-or-later
// A row of grains in a plane, held at its first and pulled at its last, as a chain of
// hinges: integrated by Runge and Kutta's method, and its Euler load in closed form.
#pragma once

#include "equilibrium_scene.h"

static inline double bending_stiffness(void) // k^n I
{
    return bond_stiffness * M_PI / 4 * pow(radius_fraction * RADIUS, 4);
}

enum { HINGES = 10, ROW = HINGES + 1 };

// A row in a plane held at its first grain, pulled at its last with FORCE at ANGLE to
// it. Every bond carries that force. With the directions of bonds, gamma, known, so are
// its stretch and, by the sum of moments from the end on, the turns of grains; its
// shear is the sum of d (d gamma - mean turn) on the way.
struct row {
    double force, angle;
    double direction[HINGES];
};

static inline void solve_dense(int n, double matrix[n][n], double *x)
{
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k; i < n; i++)
            if (fabs(matrix[i][k]) > fabs(matrix[best][k])) best = i;
        for (int c = 0; c < n; c++) {
            const double kept = matrix[k][c];
            matrix[k][c] = matrix[best][c];
            matrix[best][c] = kept;
        }
        const double kept = x[k];
        x[k] = x[best];
        x[best] = kept;
        for (int i = k + 1; i < n; i++) {
            const double factor = matrix[i][k] / matrix[k][k];
            for (int c = k; c < n; c++)
                matrix[i][c] -= factor * matrix[k][c];
            x[i] -= factor * x[k];
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        for (int c = k + 1; c < n; c++)
            x[k] -= matrix[k][c] * x[c];
        x[k] /= matrix[k][k];
    }
}

// d gamma where the force grows by GROWTH and turns by TURNING. Everything is linear in
// the rates: column c of the system is what a rate of direction c alone makes of
// k d (gamma' - mean turn') - q',  and the last what the force's own makes of it.
static inline void row_rates(const struct row *row, double growth, double turning,
                             double rate[HINGES])
{
    const double glue = bond_stiffness * bond_area(), bend = bending_stiffness();
    double system[HINGES][HINGES];
    for (int c = 0; c <= HINGES; c++) {
        double q_rate[HINGES], turn_rate[HINGES + 1] = {0}, bend_rate[HINGES], sum = 0;
        double length[HINGES];
        for (int b = HINGES - 1; b >= 0; b--) {
            const double along = cos(row->angle - row->direction[b]);
            const double across = sin(row->angle - row->direction[b]);
            const double grows = c == HINGES ? growth : 0;
            const double turns = c == HINGES ? -turning : b == c;
            length[b] = 2 * RADIUS + row->force * along / glue;
            const double longer = (grows * along + turns * row->force * across) / glue;
            q_rate[b] = grows * across - turns * row->force * along;
            const double moment_rate =
                0.5 * (longer * row->force * across + length[b] * q_rate[b]);
            bend_rate[b] = (sum + moment_rate) / bend;
            sum += 2 * moment_rate;
        }
        for (int b = 0; b < HINGES; b++) {
            turn_rate[b + 1] = turn_rate[b] + bend_rate[b];
            const double mean = 0.5 * (turn_rate[b] + turn_rate[b + 1]);
            const double value = glue * length[b] * ((b == c) - mean) - q_rate[b];
            if (c < HINGES)
                system[b][c] = value;
            else
                rate[b] = -value;
        }
    }
    solve_dense(HINGES, system, rate);
}

// Runge and Kutta's way on to FORCE at ANGLE.
static inline struct row bend_row(struct row row, double force, double angle, int steps)
{
    const double more = (force - row.force) / steps, turn = (angle - row.angle) / steps;
    for (int k = 0; k < steps; k++) {
        const double at[4] = {0, 0.5, 0.5, 1};
        const double weight[4] = {1. / 6, 1. / 3, 1. / 3, 1. / 6};
        double rate[HINGES] = {0}, sum[HINGES] = {0};
        for (int stage = 0; stage < 4; stage++) {
            struct row trial = row;
            trial.force += at[stage] * more;
            trial.angle += at[stage] * turn;
            for (int b = 0; b < HINGES; b++)
                trial.direction[b] += at[stage] * rate[b];
            row_rates(&trial, more, turn, rate);
            for (int b = 0; b < HINGES; b++)
                sum[b] += weight[stage] * rate[b];
        }
        for (int b = 0; b < HINGES; b++)
            row.direction[b] += sum[b];
        row.force += more;
        row.angle += turn;
    }
    return row;
}

static inline struct vector end_of(const struct row *row)
{
    const double glue = bond_stiffness * bond_area();
    struct vector end = {0, 0, 0};
    for (int b = 0; b < HINGES; b++) {
        const double gamma = row->direction[b];
        const double length = 2 * RADIUS + row->force * cos(row->angle - gamma) / glue;
        end = add(end, (struct vector){length * cos(gamma), length * sin(gamma), 0});
    }
    end.x -= HINGES * 2 * RADIUS;
    return end;
}

// A row held at its first grain and pushed at its end buckles where
//     P c d = 4 B tan^2(pi / 4 N),  c = k A d / (k A d - P),  d = 2 r - P / k A
// for N hinges: q_b = P gamma_b = k A d (gamma_b - mean turn) and the sum of moments
// are solved by turns sin(b pi / 2 N).
static inline double buckling_load(void)
{
    const double glue = bond_stiffness * bond_area();
    const double wanted = 4 * bending_stiffness() * pow(tan(M_PI / 4 / HINGES), 2);
    double low = 0, high = 0.25 * glue * 2 * RADIUS;
    for (int k = 0; k < 200; k++) {
        const double load = 0.5 * (low + high), d = 2 * RADIUS - load / glue;
        const double bends = load * d * glue * d / (glue * d - load);
        *(bends < wanted ? &low : &high) = load;
    }
    return low;
}

// Pushed a little from the side until it is bent, and then along.
static inline struct row buckled_row(double force)
{
    const double aside = M_PI - 0.2;
    const struct row bent = bend_row((struct row){.angle = aside}, force, aside, 400);
    return bend_row(bent, force, M_PI, 400);
}
