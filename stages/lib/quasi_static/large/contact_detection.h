// SPDX-License-Identifier: GPL-3.0-or-later
// Grains that have come near each other become contact pairs.
#pragma once

#include "large_state.h"

// Seeks pairs where grains have moved far enough since the last search, and adds those
// that are new: then all arrays of pairs are made anew and the residual is that of all.
// Whether any of the new pairs touch.
bool detect_contacts(struct quasi_static *qs);
