// SPDX-License-Identifier: GPL-3.0-or-later
// Any artifact as JSON.
#pragma once

#include "artifacts/artifact.h"

// Attributes, summary, and of every dataset: name, type, shape, units, minimum,
// maximum, SHA-256 of its values (little endian, in file order). The caller owns it.
// Reads all datasets, one after the other.
json_t *describe_artifact(const struct artifact *artifact);

// One dataset as nested lists, as deep as its rank; NAME with or without its first
// slash. Exits 65 when the artifact has none of that NAME. The caller owns it.
json_t *dataset_json(const struct artifact *artifact, const char *name);
