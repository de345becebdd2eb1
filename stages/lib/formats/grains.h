// SPDX-License-Identifier: GPL-3.0-or-later
// Grains of other makers: text, and dumps of LAMMPS. Packings have no bonds, and all
// grains are solid.
//
// TEXT is only read, and need not end with a null. Numbers are taken as they stand:
// metres, radii and so on are for read_grains and convert_grains
// (artifacts/read_grains.h), which stages call.
#pragma once

#include "basics/file.h"
#include "basics/status.h"
#include "geometry/packing.h"

// Grains from text, one "x y z r" a line in metres, perhaps below the names of columns
// (heading.h); "#" begins a comment. The box is theirs (lowest and highest grain
// surfaces). UNIT: metres a unit of length, by the names of columns; 0 where that is a
// metre, or they name none. STATUS_BAD_DATA with the line in REASON. On success the
// caller frees *PACKING.
enum status import_text(const struct bytes *text, struct packing *packing, double *unit,
                        struct reason *reason);

// Walls where the grains end.
void box_around(struct packing *packing);

// Of the mark with which Windows begins text in UTF-8; 0 without one.
size_t size_of_mark(const struct bytes *text);

// A copy that ends with a null, without the mark of UTF-8, for the caller to free;
// STATUS_BAD_DATA when there are nulls within.
enum status copy_text(const struct bytes *text, char **copy, struct reason *reason);

// Whether this is a LAMMPS dump in text.
bool is_lammps(const struct bytes *text);

// Metres a unit of length, by the units that a dump names (dump_modify units yes); 0
// where that is a metre, or it names none, or lj.
double lammps_unit(const struct bytes *text);

// One frame of it, from 0 (-1: the last), in the order of the grains' ids. Positions
// x|xu|xs|xsu (and so on), radius or diameter; box and periodic sides as it says.
// Lengths are in the units of the dump. *DIAMETERS becomes true where the radii are
// diameters by the name of their column, and is else left as it is. STATUS_BAD_DATA
// with the line in REASON. On success the caller frees *PACKING.
enum status import_lammps(const struct bytes *text, int64_t frame,
                          struct packing *packing, bool *diameters,
                          struct reason *reason);
