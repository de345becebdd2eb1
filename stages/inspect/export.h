// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "artifacts/artifact.h"

// Writes the network of ARTIFACT (a network, or a drying that carries one) as the file
// OPENPNM and as the four files of the prefix STATOIL, where they are not NULL. Exits
// 65 for an artifact without a network, or with one in a box that repeats. Grains and
// faces go into the JSON graph only. Each file is written whole or not at all.
void export_network(const struct artifact *artifact, const char *openpnm,
                    const char *statoil);
