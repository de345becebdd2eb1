// SPDX-License-Identifier: GPL-3.0-or-later
// How the grains of a packing hold one another. Contacts are always those of
// find_contacts for the same packing; directions take the nearest image where the box
// repeats.
#pragma once

#include "geometry/porosity.h"

// Pairs of grains whose surfaces are at most GAP radius sums apart; auxiliary grains
// touch nothing. The caller frees their pair. Sorted, lower grain first; GAP of 0 finds
// those that overlap or touch to the last digit: rounding parts grains of a lattice,
// which want 1e-9 or so. O(n_particle).
struct contacts find_contacts(const struct packing *packing, double gap);

// Bonds them all, and no others: what bonds there were go. Copies the pairs: CONTACTS
// stays the caller's.
void bond_contacts(struct packing *packing, const struct contacts *contacts);

// Walls of the box and surfaces of bodies that each grain touches, at most GAP radii
// off: not where the box repeats, nor along y when the packing is flat. (n_particle);
// the caller frees it.
int *wall_contacts(const struct packing *packing, double gap);

// Contacts of each grain with other grains. (n_particle); the caller frees it.
int *grain_contacts(const struct packing *packing, const struct contacts *contacts);

// How many contacts can hold a grain in place: two if it RUBS, without friction 4 (3
// when the packing is flat).
int least_contacts(const struct packing *packing, bool rubs);

// 1 for each rattler: a grain with fewer than LEAST contacts, those on WALLS included,
// those with rattlers not. (n_particle); the caller frees it. As a grain that is loose
// leaves its neighbours, these are looked at again, until none changes: O(grains +
// contacts).
uint8_t *find_rattlers(const struct packing *packing, const struct contacts *contacts,
                       const int *walls, int least);

// Mean of n n over the contacts, n the unit vector between the two centres, row by row.
// False when there is no contact; coincident grains have no direction and are left out.
// FABRIC is symmetric, of trace 1, and 0 where there is no contact.
bool fabric_tensor(const struct packing *packing, const struct contacts *contacts,
                   double fabric[9]);

// How far it is from isotropic: 0 to 1, 1 when all contacts point one way. sqrt(D / (D
// - 1)) times the norm of the deviator, D the number of dimensions; FLAT leaves y out.
double fabric_deviator(const double fabric[9], bool flat);

// How many contacts are inclined to z by so much, in COUNT equal parts of 0 to pi/2,
// relative to an isotropic packing: 1 everywhere is isotropic. DENSITY (count). In a
// flat packing isotropic is even over the angle, else over its cosine.
void contact_inclination(const struct packing *packing, const struct contacts *contacts,
                         int count, double *density);
