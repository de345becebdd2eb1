// SPDX-License-Identifier: GPL-3.0-or-later
// What --estimate prints.
#pragma once

#include "costs/costs.h"
#include "parameters/stage.h"

#include <jansson.h>

// VALUE to two digits: more would say more than is known.
json_t *rough(double value);

// Prints on standard output, as one line of JSON, COST and the sizes of BODY that the
// next stage of a chain may ask for; `range` only where seconds are not foreseen.
void print_estimate(const struct cost *cost, const struct body_size *body);

// The same, where a stage does nothing else: frees INVOCATION, and returns the status
// of main.
int end_with_estimate(struct invocation *invocation, const struct cost *cost,
                      const struct body_size *body);
