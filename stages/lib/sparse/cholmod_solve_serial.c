// SPDX-License-Identifier: GPL-3.0-or-later
// Solves L D L^T x = b with CHOLMOD's simplicial factor, faster than cholmod_solve2
// where columns are alike. Columns j, j+1, ... with the same rows below form a panel:
// the part of x in these rows is gathered once for all of its columns.
//     forward:  x_below -= L_below,j x_j,  panel by panel upwards in j;
//     backward: x_j = x_j / D_j - L_below,j . x_below,  downwards.
#include "cholmod_solve_serial.h"

enum { PARTIAL_SUMS = 4 };

// A panel: successive columns that have the same rows below the last of them, and all
// rows between.
struct panel {
    int first, width;
    int n_below;
    const int *below; // (n_below) rows
};

static struct panel panel_from(const cholmod_factor *factor, int first)
{
    const int *begin = factor->p, *row = factor->i, *size = factor->nz;
    int last = first;
    while (size[last] > 1 && row[begin[last] + 1] == last + 1 &&
           size[last + 1] == size[last] - 1)
        last++;
    return (struct panel){first, last - first + 1, size[last] - 1,
                          row + begin[last] + 1};
}

static void subtract(double *restrict to, const double *restrict column, int n,
                     double factor)
{
    for (int k = 0; k < n; k++)
        to[k] -= column[k] * factor;
}

// In partial sums that processors add side by side.
static inline double product(const double *restrict a, const double *restrict b, int n)
{
    double partial[PARTIAL_SUMS] = {0}, sum = 0;
    int k = 0;
    for (; k + PARTIAL_SUMS <= n; k += PARTIAL_SUMS)
        for (int l = 0; l < PARTIAL_SUMS; l++)
            partial[l] += a[k + l] * b[k + l];
    for (; k < n; k++)
        sum += a[k] * b[k];
    for (int l = 0; l < PARTIAL_SUMS; l++)
        sum += partial[l];
    return sum;
}

static void gather(const struct panel *panel, const double *x, double *work)
{
    for (int k = 0; k < panel->n_below; k++)
        work[k] = x[panel->below[k]];
}

// The same for a column alone.
static void forward_column(const cholmod_factor *factor, const struct panel *panel,
                           double *x)
{
    const double *column =
        (const double *)factor->x + ((const int *)factor->p)[panel->first] + 1;
    const double here = x[panel->first];
    for (int k = 0; k < panel->n_below; k++)
        x[panel->below[k]] -= column[k] * here;
}

static void backward_column(const cholmod_factor *factor, const struct panel *panel,
                            double *x)
{
    const double *column =
        (const double *)factor->x + ((const int *)factor->p)[panel->first] + 1;
    const int n = panel->n_below, *row = panel->below;
    double even = 0, odd = 0;
    int k = 0;
    for (; k + 2 <= n; k += 2) {
        even += column[k] * x[row[k]];
        odd += column[k + 1] * x[row[k + 1]];
    }
    if (k < n) even += column[k] * x[row[k]];
    x[panel->first] = x[panel->first] / column[-1] - (even + odd);
}

static void forward_panel(const cholmod_factor *factor, const struct panel *panel,
                          double *x, double *work)
{
    const int *begin = factor->p;
    gather(panel, x, work);
    for (int c = 0; c < panel->width; c++) {
        const int j = panel->first + c, inside = panel->width - 1 - c;
        const double *column = (const double *)factor->x + begin[j] + 1;
        subtract(x + j + 1, column, inside, x[j]);
        subtract(work, column + inside, panel->n_below, x[j]);
    }
    for (int k = 0; k < panel->n_below; k++)
        x[panel->below[k]] = work[k];
}

static void backward_panel(const cholmod_factor *factor, const struct panel *panel,
                           double *x, double *work)
{
    const int *begin = factor->p;
    gather(panel, x, work);
    for (int c = panel->width - 1; c >= 0; c--) {
        const int j = panel->first + c, inside = panel->width - 1 - c;
        const double *column = (const double *)factor->x + begin[j];
        x[j] = x[j] / column[0] - product(column + 1, x + j + 1, inside) -
               product(column + 1 + inside, work, panel->n_below);
    }
}

void cholmod_solve_serial(const cholmod_factor *factor, double *x, double *work)
{
    const int n = (int)factor->n;
    for (int j = 0; j < n;) {
        const struct panel panel = panel_from(factor, j);
        if (panel.width == 1)
            forward_column(factor, &panel, x);
        else
            forward_panel(factor, &panel, x, work);
        j += panel.width;
    }
    for (int j = n - 1; j >= 0;) {
        int first = j;
        const int *begin = factor->p, *row = factor->i, *size = factor->nz;
        while (first > 0 && size[first - 1] == size[first] + 1 &&
               row[begin[first - 1] + 1] == first)
            first--;
        const struct panel panel = panel_from(factor, first);
        if (panel.width == 1)
            backward_column(factor, &panel, x);
        else
            backward_panel(factor, &panel, x, work);
        j = first - 1;
    }
}
