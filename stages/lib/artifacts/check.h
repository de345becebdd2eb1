// SPDX-License-Identifier: GPL-3.0-or-later
// Checks an open HDF5 file against a schema.
//
// check_links comes first, by itself, and in an opening of its own; then check_file.
// Both go before any getter (artifact.h): these trust that extents fit into an int and
// that every value has the type that the schema says. Neither prints nor ends the
// program, so that read.c can name the file and write.c can blame whoever is to blame.
#pragma once

#include "artifacts/schema.h"
#include "basics/status.h"

#include <stddef.h>

// All that the file's links lead to lies in it, which its digest vouches for. Else
// returns STATUS_BAD_DATA with the object in REASON. Follows nothing: to be asked
// before anything is opened.
enum status check_links(hid_t file, struct reason *reason);

// Every dataset is there, has the kind of numbers and the shape that the schema says,
// with equal symbols meaning equal extents, and every value keeps its rules. IMAGE_SIZE
// bounds what a dataset may claim to hold. Returns STATUS_BAD_DATA with dataset, row,
// rule and value in REASON at the first breach, STATUS_NO where that is only a number
// too large. Reads each dataset once, in blocks. O(values), in memory O(1).
enum status check_file(hid_t file, const struct schema *schema, size_t image_size,
                       struct reason *reason);
