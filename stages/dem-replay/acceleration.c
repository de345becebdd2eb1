// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceleration.h"

#include "basics/memory.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH = 16 };

struct acceleration {
    int n, count;
    double *taken[DEPTH];   // (n) steps taken
    double *changed[DEPTH]; // (n) what each changed of the step that came next
    double *axis[DEPTH];    // (n) work: those, orthogonal
    double *last, *sent;    // (n) the step before, as given and as taken
    bool has_last;
};

struct acceleration *acceleration_new(int n)
{
    struct acceleration *a = NEW_ARRAY(struct acceleration, 1);
    a->n = n;
    for (int k = 0; k < DEPTH; k++) {
        a->taken[k] = NEW_ARRAY(double, n);
        a->changed[k] = NEW_ARRAY(double, n);
        a->axis[k] = NEW_ARRAY(double, n);
    }
    a->last = NEW_ARRAY(double, n);
    a->sent = NEW_ARRAY(double, n);
    return a;
}

void acceleration_free(struct acceleration *a)
{
    if (!a) return;
    for (int k = 0; k < DEPTH; k++) {
        free(a->taken[k]);
        free(a->changed[k]);
        free(a->axis[k]);
    }
    free(a->last);
    free(a->sent);
    free(a);
}

void acceleration_clear(struct acceleration *a)
{
    a->count = 0;
    a->has_last = false;
}

static double product(const struct acceleration *a, const double *x, const double *y)
{
    double sum = 0;
    for (int i = 0; i < a->n; i++)
        sum += x[i] * y[i];
    return sum;
}

static void take_off(const struct acceleration *a, double share, const double *x,
                     double *y)
{
    for (int i = 0; i < a->n; i++)
        y[i] -= share * x[i];
}

// The oldest goes when there is no room.
static double *new_column(double *column[DEPTH], int count)
{
    double *oldest = column[0];
    if (count < DEPTH) return column[count];
    memmove(column, column + 1, (DEPTH - 1) * sizeof *column);
    return column[DEPTH - 1] = oldest;
}

// What the step that was taken last changed.
static void learn(struct acceleration *a, const double *step)
{
    double *changed = new_column(a->changed, a->count);
    memcpy(new_column(a->taken, a->count), a->sent, (size_t)a->n * sizeof *a->sent);
    for (int i = 0; i < a->n; i++)
        changed[i] = step[i] - a->last[i];
    if (a->count < DEPTH) a->count++;
}

// SHARE (count) of what was changed that comes nearest to STEP, by Gram and Schmidt.
// Columns that say nothing new have none.
static void combine(const struct acceleration *a, const double *step, double *share)
{
    double upper[DEPTH][DEPTH], along[DEPTH];
    for (int k = 0; k < a->count; k++) {
        memcpy(a->axis[k], a->changed[k], (size_t)a->n * sizeof(double));
        const double whole = sqrt(product(a, a->axis[k], a->axis[k]));
        for (int l = 0; l < k; l++) {
            upper[l][k] = product(a, a->axis[l], a->axis[k]);
            take_off(a, upper[l][k], a->axis[l], a->axis[k]);
        }
        const double left = sqrt(product(a, a->axis[k], a->axis[k]));
        upper[k][k] = left > 1e-10 * whole ? left : INFINITY;
        for (int i = 0; i < a->n; i++)
            a->axis[k][i] /= upper[k][k];
        along[k] = product(a, a->axis[k], step);
    }
    for (int k = a->count - 1; k >= 0; k--) {
        share[k] = along[k];
        for (int l = k + 1; l < a->count; l++)
            share[k] -= upper[k][l] * share[l];
        share[k] /= upper[k][k];
    }
}

void accelerate(struct acceleration *a, double *step)
{
    double share[DEPTH];
    if (a->has_last) learn(a, step);
    memcpy(a->last, step, (size_t)a->n * sizeof *step);
    a->has_last = true;
    combine(a, step, share);
    for (int k = 0; k < a->count; k++)
        for (int i = 0; i < a->n; i++)
            step[i] -= share[k] * (a->taken[k][i] + a->changed[k][i]);
    memcpy(a->sent, step, (size_t)a->n * sizeof *step);
}
