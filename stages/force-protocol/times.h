// SPDX-License-Identifier: GPL-3.0-or-later
// The times of the protocol, from the start to the end of drying.
#ifndef CRAQUELURE_TIMES_H
#define CRAQUELURE_TIMES_H

#include "protocol.h"

// COUNT even times, at least 2 [K 5.2]. The caller frees them.
double *uniform_times(const struct drying_record *record, int count);

// As few times as it takes for no force on a grain to change by more than BOUND, of the
// largest force on any grain at any time, from one to the next. What changes at once,
// where pressures jump or two times of the drying are equal, is one change whatever its
// size. COUNT is how many it takes; NULL: that is more than MOST. The caller frees
// them.
double *adaptive_times(const struct process *process, double bound, int most,
                       double *count);

#endif
