// SPDX-License-Identifier: GPL-3.0-or-later
// Artifacts that are JSON: "schema" names what it is, the schema's "members" say what
// it must hold. Only presence and type of the first level are checked.
//
// Used by stages whose result is small and meant for other programs to read as it is
// (rings, bridge, crackstats, check), and by those that read any artifact (inspect,
// artdiff, report). finish_json (artifact.h) adds the provenance.
#pragma once

#include "artifacts/schema.h"
#include "basics/file.h"
#include "basics/status.h"

#include <jansson.h>
#include <stdbool.h>

// Whether they begin as JSON does, not as HDF5.
bool is_document(const struct bytes *bytes);

// Whether they may go on as JSON or as HDF5 (for read_whole_of).
bool may_be_either(const struct bytes *beginning);

// Reads and checks it; PATH is for messages. Exits 65 when it is not an artifact or
// breaks its schema. The caller owns it. BYTES are only read.
json_t *document_of(const char *path, const struct bytes *bytes);

// Every member that SCHEMA asks for is there and of its type; else STATUS_BAD_DATA with
// the member in REASON. A type that ends in "?" may be null; members that SCHEMA does
// not list are let through.
enum status check_document(const json_t *document, const struct schema *schema,
                           struct reason *reason);

// Writes DOCUMENT to PATH ("-": standard output), whole or not at all, with a line for
// every value and numbers in 17 digits, and frees it. Exits 73 or 74.
void write_json(const char *path, json_t *document);
