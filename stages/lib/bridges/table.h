// SPDX-License-Identifier: GPL-3.0-or-later
// The exact force of a bridge at the price of a fit: one kind of pair (contact angles,
// ratio of radii) tabulated over volume and separation.
//
// One table for one kind of pair, however large it is: lengths are in effective radii.
// So equal grains of all sizes share a table, and so do grain and plane; pairs of other
// ratios need tables of their own, or ratios.h. Once it is made it is only read, by any
// number of threads.
#pragma once

#include "basics/status.h"

// Dimensionless volumes that a table covers.
#define BRIDGE_TABLE_LEAST 0x1p-30 // 9.3e-10
#define BRIDGE_TABLE_MOST 1.0

struct bridge_table;

// Tabulates bridges between spheres whose radii are as RADIUS (any unit; INFINITY for
// a plane), with CONTACT_ANGLE (rad) on each. Takes some 300,000 exact solutions, two
// or three seconds of one core (OpenMP shares them out), and 1 MB; the same numbers on
// every call. Returns STATUS_OK, STATUS_BAD_DATA, or STATUS_NOT_CONVERGED where the
// exact solution fails. The caller frees it.
enum status bridge_table_create(const double radius[2], const double contact_angle[2],
                                struct bridge_table **table, struct reason *reason);
void bridge_table_free(struct bridge_table *table);

// The largest relative error of a force, measured between the nodes while the table was
// made: below 5e-6 up to 110 degrees and 2e-5 beyond, and for unequal bodies near 32
// degrees, where they rupture nearly by a break of symmetry. Where forces
// change sign (contact angles near 90 degrees and beyond) it is relative to at least
// BRIDGE_TABLE_FLOOR (1 + gap/(1.2 sqrt(volume)))^-2, a sixtieth of what a wetting
// liquid pulls with.
#define BRIDGE_TABLE_FLOOR 0.1
double bridge_table_error(const struct bridge_table *table);

// Force over surface tension and effective radius, positive when it pulls, of VOLUME
// over the cube of the effective radius at GAP over the effective radius. Gaps below 0
// give the force at contact; beyond rupture it is 0. Volumes outside the table are
// taken as its first or last.
double bridge_table_force(const struct bridge_table *table, double volume, double gap);

// The forces of COUNT bridges. They have the same bytes as from bridge_table_force, and
// take less time, because four are computed at once.
void bridge_table_forces(const struct bridge_table *table, int count,
                         const double *volume, const double *gap, double *force);

// The gap at which VOLUME ruptures, to a relative 1e-9, or where symmetry breaks first
// 1e-5; both in effective radii.
double bridge_table_rupture(const struct bridge_table *table, double volume);
