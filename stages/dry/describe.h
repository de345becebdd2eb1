// SPDX-License-Identifier: GPL-3.0-or-later
// The model of liquid and menisci in words: lines of the artifact's `model`. They say
// what a reader cannot see in the numbers, and what the model leaves out.
#pragma once

#include "dry/run/drying.h"

#include <stddef.h>

// Both write at most SIZE bytes to TEXT, without the last line's end, and return it.
// HISTORY gives what the viscous flow cost; it must be complete.
const char *describe_liquid(const struct drying_conditions *conditions,
                            const struct drying_history *history, char *text,
                            size_t size);

// A line each for what is switched on, and one for all that is left out. Lines end with
// "\n" but the last.
const char *describe_switches(const struct drying_conditions *conditions, char *text,
                              size_t size);
