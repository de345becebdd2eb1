// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef CRAQUELURE_PACK_METHODS_H
#define CRAQUELURE_PACK_METHODS_H

#include "basics/progress.h"
#include "domain.h"
#include "geometry/packing.h"
#include "parameters.h"

// Grains by any method but import, the domain they lie in, and how the dynamics ended
// if there was any. PACKING holds grains already, in DOMAIN, if GIVEN: those that
// moving begins from. On success the caller frees *PACKING; otherwise the
// reason names the key.
enum status make_grains(const struct pack_parameters *parameters, bool given,
                        struct progress *progress, struct domain *domain,
                        struct packing *packing, struct reached *reached,
                        struct reason *reason);

// Refuses what moving grains cannot come to [check_moved.c]: STATUS_BAD_DATA, naming
// the key.
enum status check_moved(const struct pack_parameters *parameters, bool given,
                        const struct domain *domain, const struct sizes *sizes,
                        struct reason *reason);

#endif
