// SPDX-License-Identifier: GPL-3.0-or-later
#include "floating.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { REFINEMENTS = 4, LANES = 8 };

// What is added to the diagonal of one of the menisci that float, of it: where vapour
// cannot leave, all could float at any one potential.
static const double STAY = 1e-12;

// A diagonal of which no more is left, when links inside the body have gone off it, is
// rounding: the body stays where it is.
static const double LOST = 1e-13;

// Part of the rate that floating bodies may evaporate.
static const double CLOSED = 1e-13;

struct floating {
    int n;      // bodies
    int *body;  // (n)
    int *place; // (bodies) among them, -1: does not float
    double
        *matrix; // (n,n) how gains fall with potentials, over the roots of the diagonal
    double *root; // (n)
    double *x;    // (n) room
};

// --- the matrix --------------------------------------------------------------------

// The body at the K-th wet node if it is only one, and floats; else a number of the
// node's own.
static double group_of(const struct floating *floating, const struct curved *curved,
                       int k)
{
    const int begin = curved->offset[k];
    const int place = floating->place[curved->share[begin].body];
    const bool alone = curved->offset[k + 1] == begin + 1 && place >= 0;
    return alone ? place + 1 : -1 - k;
}

static void add_pair(struct floating *floating, const struct curved *curved, int k,
                     int l, double link)
{
    for (int i = curved->offset[k]; i < curved->offset[k + 1]; i++) {
        const int f = floating->place[curved->share[i].body];
        for (int j = curved->offset[l]; f >= 0 && j < curved->offset[l + 1]; j++) {
            const int g = floating->place[curved->share[j].body];
            if (g >= 0)
                floating->matrix[f * floating->n + g] +=
                    link * curved->share[i].part * curved->share[j].part;
        }
    }
}

static bool any_floats(const struct floating *floating, const struct curved *curved,
                       int k)
{
    for (int i = curved->offset[k]; i < curved->offset[k + 1]; i++)
        if (floating->place[curved->share[i].body] >= 0) return true;
    return false;
}

// Conductances from each node, but to others of the body it is of alone.
static void add_degrees(struct floating *floating, struct curved *curved,
                        const struct phases *phases)
{
    const struct star_mesh *mesh = &phases->vapour.mesh;
    for (int k = 0; k < phases->n_wet; k++) {
        curved->level[phases->wet[k]] = group_of(floating, curved, k);
        curved->flow[phases->wet[k]] = mesh->air[phases->wet[k]];
    }
    star_mesh_add_degrees(mesh, curved->level, curved->flow);
    for (int k = 0; k < phases->n_wet; k++)
        add_pair(floating, curved, k, k, curved->flow[phases->wet[k]]);
}

// Links between nodes of which some body floats, but not inside one body.
static void add_links(struct floating *floating, const struct curved *curved,
                      const struct phases *phases)
{
    const struct star_mesh *mesh = &phases->vapour.mesh;
    int *row = NEW_ARRAY(int, mesh->n_site), *wet = NEW_ARRAY(int, phases->n_wet);
    int n = 0;
    memset(row, -1, (size_t)mesh->n_site * sizeof *row);
    for (int k = 0; k < phases->n_wet; k++) {
        if (!any_floats(floating, curved, k)) continue;
        row[phases->wet[k]] = n;
        wet[n++] = k;
    }
    double *link = NEW_ARRAY(double, (size_t)n *(size_t)n);
    star_mesh_add_links(mesh, row, n, link);
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++)
            if (link[a * n + b] > 0 && curved->level[phases->wet[wet[a]]] !=
                                           curved->level[phases->wet[wet[b]]])
                add_pair(floating, curved, wet[a], wet[b], -link[a * n + b]);
    free(link);
    free(wet);
    free(row);
}

static void scale_matrix(struct floating *floating)
{
    const int n = floating->n;
    double *matrix = floating->matrix, *root = floating->root;
    for (int f = 0; f < n; f++)
        root[f] =
            sqrt(matrix[f * n + f] > LOST * root[f] ? matrix[f * n + f] : root[f]);
    for (int f = 0; f < n; f++)
        for (int g = 0; g < n; g++)
            matrix[f * n + g] =
                f == g ? 1 + STAY : matrix[f * n + g] / (root[f] * root[g]);
}

// In lanes of their own, so that the compiler may keep them in one register.
static double product(const double *a, const double *b, int n)
{
    double lane[LANES] = {0}, sum = 0;
    int i = 0;
    for (; i + LANES <= n; i += LANES)
        for (int l = 0; l < LANES; l++)
            lane[l] += a[i + l] * b[i + l];
    for (; i < n; i++)
        sum += a[i] * b[i];
    for (int l = 0; l < LANES; l++)
        sum += lane[l];
    return sum;
}

// Cholesky's factor takes the place of the lower triangle. Not by a library: those use
// as many threads as they find, and round by their number.
static void factorise(double *matrix, int n)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) {
            const double *a = matrix + (size_t)i * (size_t)n;
            const double *b = matrix + (size_t)j * (size_t)n;
            const double sum = a[j] - product(a, b, j);
            matrix[i * n + j] = i == j ? sqrt(fmax(sum, STAY)) : sum / b[j];
        }
}

static void make_matrix(struct floating *floating, struct curved *curved,
                        const struct phases *phases)
{
    const size_t n = (size_t)floating->n;
    memset(floating->matrix, 0, n * n * sizeof *floating->matrix);
    add_degrees(floating, curved, phases);
    for (size_t f = 0; f < n; f++)
        floating->root[f] = floating->matrix[f * n + f];
    add_links(floating, curved, phases);
    scale_matrix(floating);
    factorise(floating->matrix, floating->n);
}

static struct floating find_floating(struct curved *curved, const struct phases *phases)
{
    struct floating floating = {.body = NEW_ARRAY(int, curved->n),
                                .place = NEW_ARRAY(int, curved->n)};
    for (int a = 0; a < curved->n; a++) {
        floating.place[a] = curved->floats[a] ? floating.n : -1;
        if (curved->floats[a]) floating.body[floating.n++] = a;
    }
    const size_t n = (size_t)floating.n;
    floating.matrix = NEW_ARRAY(double, n *n);
    floating.root = NEW_ARRAY(double, n);
    floating.x = NEW_ARRAY(double, n);
    if (n > 0) make_matrix(&floating, curved, phases);
    return floating;
}

static void floating_free(struct floating *floating)
{
    free(floating->body);
    free(floating->place);
    free(floating->matrix);
    free(floating->root);
    free(floating->x);
}

// --- its solution ------------------------------------------------------------------

// The right side in X becomes the solution.
static void solve(struct floating *floating)
{
    const int n = floating->n;
    const double *matrix = floating->matrix;
    double *x = floating->x;
    for (int i = 0; i < n; i++)
        x[i] =
            (x[i] - product(matrix + (size_t)i * (size_t)n, x, i)) / matrix[i * n + i];
    for (int i = n - 1; i >= 0; i--) {
        x[i] /= matrix[i * n + i];
        for (int k = 0; k < i; k++)
            x[k] -= matrix[i * n + k] * x[i];
    }
}

// --- all ---------------------------------------------------------------------------

// Whether they evaporate nothing but rounding.
static bool is_closed(const struct floating *floating, const struct curved *curved)
{
    double gain = 0, noise = 0;
    for (int f = 0; f < floating->n; f++) {
        gain += fabs(curved->gain[floating->body[f]]);
        noise += curved->noise[floating->body[f]];
    }
    return gain <= fmax(CLOSED * curved->rate, noise);
}

void float_freely(struct curved *curved, const struct phases *phases)
{
    struct floating floating = find_floating(curved, phases);
    for (int k = 0; k < REFINEMENTS && !is_closed(&floating, curved); k++) {
        for (int f = 0; f < floating.n; f++)
            floating.x[f] = curved->gain[floating.body[f]] / floating.root[f];
        solve(&floating);
        for (int f = 0; f < floating.n; f++)
            curved->potential[floating.body[f]] += floating.x[f] / floating.root[f];
        curved_find_gains(curved, phases);
    }
    floating_free(&floating);
}
