// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef CRAQUELURE_SUMMARISE_H
#define CRAQUELURE_SUMMARISE_H

#include "count.h"

#include <jansson.h>

// Puts the counts of N_RUN runs into REPORT: cracks, periods, profile (means over the
// runs), mean, sd (null for one run) and each run's own.
void summarise(json_t *report, const struct counts *runs, int n_run, int n_slice);

#endif
