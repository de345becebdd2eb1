// SPDX-License-Identifier: GPL-3.0-or-later
// Parameters that nothing uses in this scene: a stiffness beside Hertz contacts, the
// radius of a plane, the strength of bonds where there are none.
#pragma once

#include "parameters.h"

// Exits 65 with the first one that is given. EFFECTIVE has all parameters with defaults
// filled in, HAS_FORCES says that there is a second input. Velocities of groups that
// nothing uses are read_groups'.
void check_unused(const struct simulate_parameters *parameters, const json_t *effective,
                  bool has_forces);
