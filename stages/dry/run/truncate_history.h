// SPDX-License-Identifier: GPL-3.0-or-later
// A drying that ends before the last throat has emptied.
#pragma once

#include "drying.h"

// Ends HISTORY of NETWORK at SATURATION, which its last step alone has passed: that
// step becomes the moment at which the saturation, linear in time as that of every
// throat, was just that. Events behind the new end go, and so does what evaporated
// after it. In the last step no throat empties before its end. O(n_change).
void truncate_history(struct drying_history *history, const struct network *network,
                      double saturation);
