// SPDX-License-Identifier: GPL-3.0-or-later
// The mean over the runs that have a number, n of them, and how sure it is:
//     mean           = sum / n
//     standard error = deviation / sqrt(n),   deviation with n - 1
//     half width     = t(n - 1) standard error,   t of Student.
// NAN is a run that has none. With one run the errors are 0, not unknown: readers of
// the artifact look at n.
#include "over_runs.h"

#include "basics/memory.h"
#include "statistics/sample.h"

#include <math.h>
#include <stdlib.h>

struct over_runs over_runs(const double *value, int n, double confidence)
{
    double *known = NEW_ARRAY(double, n);
    struct over_runs over = {0};
    for (int k = 0; k < n; k++)
        if (!isnan(value[k])) known[over.n++] = value[k];
    const struct sample sample = {known, over.n};
    if (over.n > 0) over.mean = sample_mean(sample);
    if (over.n > 1) {
        over.standard_error = sample_deviation(sample) / sqrt(over.n);
        over.half_width = half_width(sample, confidence);
    }
    free(known);
    return over;
}
