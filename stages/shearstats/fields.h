// SPDX-License-Identifier: GPL-3.0-or-later
// Fields in each cell, from the sums of one or more snapshots.
//
// Sums of snapshots, blocks or threads may be added before, not fields: quotients of
// sums are no sums. fields.c has the formula of each field; field_kinds.h its place and
// unit.
#pragma once

#include "field_kinds.h"
#include "sums.h"

// From SUM over SNAPSHOTS snapshots. In a cylinder the components are r, angle, z. The
// caller frees them with fields_free. SUM (n_cell, SUM_ALL) as add_snapshot leaves it,
// SNAPSHOTS >= 1.
struct fields make_fields(const struct grid *grid, const double *sum, int snapshots);
void fields_free(struct fields *fields);
