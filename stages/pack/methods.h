// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef CRAQUELURE_PACK_METHODS_H
#define CRAQUELURE_PACK_METHODS_H

#include "basics/progress.h"
#include "domain.h"
#include "geometry/packing.h"
#include "parameters.h"

// Makes grains by any method but import, the domain they lie in, and the end state of
// the dynamics, if any. If GIVEN, PACKING and DOMAIN hold the grains that moving starts
// from. On success the caller frees *PACKING; otherwise the reason names the key.
enum status make_grains(const struct pack_parameters *parameters, bool given,
                        struct progress *progress, struct domain *domain,
                        struct packing *packing, struct reached *reached,
                        struct reason *reason);

// STATUS_BAD_DATA, naming the key, for targets that moving grains cannot reach
// [check_moved.c].
enum status check_moved(const struct pack_parameters *parameters, bool given,
                        const struct domain *domain, const struct sizes *sizes,
                        struct reason *reason);

#endif
