// SPDX-License-Identifier: GPL-3.0-or-later
// Grains as extended XYZ, which OVITO and ASE read.
#pragma once

#include "artifacts/artifact.h"

// Writes the grains of ARTIFACT to PATH ("-": standard output), a frame for each
// snapshot of a response, N_FRAME of forces evenly spaced in time, else one: number,
// place, radius, and what is known of force, displacement and broken bonds; in SI
// units. Exits 73 and 74.
void write_xyz(const struct artifact *artifact, const char *path, int n_frame);
