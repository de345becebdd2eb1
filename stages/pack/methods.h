// SPDX-License-Identifier: GPL-3.0-or-later
// From the user's parameters to grains: which method, in which domain, how many.
#pragma once

#include "basics/progress.h"
#include "domain.h"
#include "geometry/packing.h"
#include "parameters.h"

// Makes grains by any method but import: *DOMAIN, in which they lie, *PACKING, and,
// where grains moved, the end state *REACHED. If GIVEN, the name of an input, is not
// NULL, PACKING and DOMAIN hold the grains of it that moving starts from. The seed of
// PARAMETERS decides all that is random. On success the caller frees *PACKING.
// STATUS_BAD_DATA: parameters that contradict each other, with the key in the reason;
// STATUS_NOT_CONVERGED: grains that did not fit, or a target that was not reached.
// PROGRESS is updated on the way. The same parameters give the same bytes for any
// number of threads.
enum status make_grains(const struct pack_parameters *parameters, const char *given,
                        struct progress *progress, struct domain *domain,
                        struct packing *packing, struct reached *reached,
                        struct reason *reason);

// The grains that it will make, before any is placed: exactly where they are counted by
// the parameters, else as many as fill the domain at the porosity to expect.
// STATUS_BAD_DATA as make_grains.
enum status expected_count(const struct pack_parameters *parameters, double *grains,
                           struct reason *reason);

// STATUS_BAD_DATA, naming the key, for targets that moving grains cannot reach
// [check_moved.c]. SIZES are those to be drawn or of the grains in the input GIVEN;
// DOMAIN is where they will move.
enum status check_moved(const struct pack_parameters *parameters, const char *given,
                        const struct domain *domain, const struct sizes *sizes,
                        struct reason *reason);
