// SPDX-License-Identifier: GPL-3.0-or-later
// The times of the protocol, from the start to the end of drying.
#pragma once

#include "process.h"

// COUNT equidistant times (s), at least 2 [K 5.2]. The caller frees them.
double *uniform_times(const struct drying_record *record, int count);

// As few times (s) as needed so that no force on a grain changes from one to the next
// by more than BOUND, relative to the largest force on any grain at any time. A jump,
// where pressures jump or two times of the drying are equal, is one change whatever its
// size. COUNT is how many are needed; returns NULL if that is more than MOST. The
// caller frees them. Walks the whole drying twice: for the largest force, then for the
// times.
double *adaptive_times(const struct process *process, double bound, int most,
                       double *count);
