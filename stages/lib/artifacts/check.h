// SPDX-License-Identifier: GPL-3.0-or-later
// Checks an open HDF5 file against a schema.
#ifndef CRAQUELURE_CHECK_H
#define CRAQUELURE_CHECK_H

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
// too large. Reads each dataset once, in blocks.
enum status check_file(hid_t file, const struct schema *schema, size_t image_size,
                       struct reason *reason);

#endif
