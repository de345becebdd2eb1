// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "artifacts/artifact.h"

// Writes what changes over time in a drying, forces, response or motion artifact as
// PREFIX-0000.vtu and on, with PREFIX.pvd to open in ParaView. N_FRAME frames: a drying
// at saturations evenly spaced from full to dry, forces at evenly spaced times; a
// response or motion has one frame a snapshot, whatever N_FRAME. Exits 65 for an
// artifact in which nothing changes.
void write_series(const struct artifact *artifact, const char *prefix, int n_frame);
