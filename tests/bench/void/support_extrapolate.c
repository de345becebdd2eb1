// SPDX-License-Identifier: GPL-3.0-or-later
// Richardson's extrapolation with an order that is measured.
//
// Unknowns: limit, C and p of value = limit + C n^-p on grids of n cells; p from
//     (v1 - v2) / (v2 - v3) = (n1^-p - n2^-p) / (n2^-p - n3^-p)
// by bisection (the right side grows with p), then limit = v3 - (v2 - v3) s,
// s = n3^-p / (n2^-p - n3^-p).
#include "support_extrapolate.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

static const double lowest = 1, highest = 3, usual = 2;

static double ratio(const int n[RESOLUTIONS], double p)
{
    return (pow(n[0], -p) - pow(n[1], -p)) / (pow(n[1], -p) - pow(n[2], -p));
}

static double limit_with(const int n[RESOLUTIONS], const double v[RESOLUTIONS],
                         double p)
{
    return v[2] - (v[1] - v[2]) / (pow((double)n[2] / n[1], p) - 1);
}

static double order_of(const int n[RESOLUTIONS], const double v[RESOLUTIONS])
{
    const double seen = (v[0] - v[1]) / (v[1] - v[2]);
    if (!(seen > ratio(n, lowest)) || !(seen < ratio(n, highest))) return usual;
    double low = lowest, high = highest;
    for (int step = 0; step < 60; step++) {
        const double middle = 0.5 * (low + high);
        if (ratio(n, middle) < seen)
            low = middle;
        else
            high = middle;
    }
    return low;
}

struct limit extrapolate(const int cells[RESOLUTIONS], const double value[RESOLUTIONS])
{
    struct limit limit = {.order = order_of(cells, value)};
    limit.value = limit_with(cells, value, limit.order);
    double error = 0.5 * fabs(limit.value - value[RESOLUTIONS - 1]);
    for (int k = 0; k < 2; k++)
        error =
            fmax(error, fabs(limit.value - limit_with(cells, value, 1.5 + 0.5 * k)));
    limit.error = error / fabs(limit.value);
    return limit;
}

static void print_numbers(const char *key, int n, const double *number)
{
    printf(", \"%s\": [", key);
    for (int k = 0; k < n; k++)
        printf("%s%.7g", k ? ", " : "", number[k]);
    printf("]");
}

void print_limits(double porosity, const int cells[RESOLUTIONS], int n,
                  double (*value)[RESOLUTIONS])
{
    double limit[3] = {0}, error[3] = {0}, order[3] = {0};
    printf("{\"porosity\": %.7g, \"resolutions\": [%d, %d, %d]", porosity, cells[0],
           cells[1], cells[2]);
    for (int along = 0; along < n; along++) {
        const struct limit found = extrapolate(cells, value[along]);
        limit[along] = found.value;
        error[along] = found.error;
        order[along] = found.order;
    }
    printf(", \"values\": [");
    for (int along = 0; along < n; along++)
        printf("%s[%.8g, %.8g, %.8g]", along ? ", " : "", value[along][0],
               value[along][1], value[along][2]);
    printf("]");
    print_numbers("order", n, order);
    print_numbers("extrapolated", n, limit);
    print_numbers("error", n, error);
    printf("}\n");
}
