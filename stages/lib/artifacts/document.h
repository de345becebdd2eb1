// SPDX-License-Identifier: GPL-3.0-or-later
// Artifacts that are JSON.
#ifndef CRAQUELURE_DOCUMENT_H
#define CRAQUELURE_DOCUMENT_H

#include "basics/file.h"

#include <jansson.h>
#include <stdbool.h>

// Whether they begin as JSON does, not as HDF5.
bool is_document(const struct bytes *bytes);

// Reads and checks it; PATH is for messages. Exits 65 when it is not an artifact or
// breaks its schema. The caller owns it.
json_t *document_of(const char *path, const struct bytes *bytes);

#endif
