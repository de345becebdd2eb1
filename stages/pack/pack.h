// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef CRAQUELURE_PACK_H
#define CRAQUELURE_PACK_H

#include "basics/file.h"
#include "basics/status.h"
#include "geometry/packing.h"

#include <stdbool.h>

// Grains of one radius on a simple cubic lattice, touching, filling their box: COUNTS
// along x, y and z, z fastest. The caller frees the packing.
struct packing cubic_lattice(const int64_t counts[3], double radius,
                             const bool periodic[3]);

// Grains from text, one "x y z r" a line in metres; "#" begins a comment. The box is
// theirs (lowest and highest grain surfaces). STATUS_BAD_DATA with the line in REASON.
// On success the caller frees *PACKING.
enum status import_text(const struct bytes *text, struct packing *packing,
                        struct reason *reason);

// Bonds every two grains whose surfaces are at most GAP radius sums apart.
void bond_touching(struct packing *packing, double gap);

// Void share of the box, counting overlaps twice as solid.
double packing_porosity(const struct packing *packing);

// Largest overlap, of the smaller radius, and the mean number of touching neighbours
// (within GAP radius sums).
void packing_contacts(const struct packing *packing, double gap, double *max_overlap,
                      double *coordination);

#endif
