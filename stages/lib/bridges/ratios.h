// SPDX-License-Identifier: GPL-3.0-or-later
// The exact force of bridges between grains of many sizes, at the price of a fit:
// tables (bridges/table.h) at seventeen ratios of radii, and between them by
// interpolation.
//
// Lengths are over each bridge's effective radius [G 1], as everywhere. What is left of
// the radii then is their asymmetry,
//     s = cbrt(|R1 - R2|/(R1 + R2)),
// 0 between equal grains, 0.97 at 1 to 20, 1 on a plane. The cube root is what makes
// forces smooth: where equal grains rupture by a break of symmetry, slightly unequal
// ones do so at a gap that is shorter by the power 2/3 of the difference.
//
// Made once for the sizes of a scene, then asked for as many forces as wanted by any
// number of threads: nothing in it changes.
#pragma once

#include "basics/status.h"

// The range of bridges that will occur: only what they need is tabulated.
struct bridge_sizes {
    double radius[2]; // of the smallest and largest grain; any unit
    double volume[2]; // of the smallest and largest bridge; its cube
    double plane[2];  // smallest and largest effective radius of bridges to planes
                      // (asymmetry 1): twice the radius of the grain; 0: none
};

struct bridge_ratios;

// For one CONTACT_ANGLE (rad). Equal radii and one volume take a hundredth of a second,
// radii of 1 to 20 some ten seconds of one core (OpenMP shares them out) and up to 20
// MB; the same numbers on every call. Returns STATUS_OK, STATUS_BAD_DATA, or
// STATUS_NOT_CONVERGED where the exact solution fails. The caller frees it.
enum status bridge_ratios_create(const struct bridge_sizes *sizes, double contact_angle,
                                 struct bridge_ratios **result, struct reason *reason);
void bridge_ratios_free(struct bridge_ratios *ratios);

// s of two grains, of which one may be a plane (INFINITY); 0 where they differ by
// rounding only.
double bridge_asymmetry(double first_radius, double second_radius);

// Forces over surface tension and effective radius, positive when they pull, of COUNT
// bridges: their asymmetries, their volumes over the cube of the effective radius,
// their gaps over it (below 0: as at contact). Between equal grains as
// bridge_table_force has them; docs/bridges.md has the errors between others. What a
// volume that is not tabulated (of bridges beyond SIZES, BRIDGE_TABLE_LEAST or
// BRIDGE_TABLE_MOST) has is told from the nearest that is: the gap of rupture as the
// cube root of the volume, the gap over which the force falls next to contact as its
// square root.
void bridge_ratios_forces(const struct bridge_ratios *ratios, int count,
                          const double *asymmetry, const double *volume,
                          const double *gap, double *force);

// The gap at which a bridge ruptures; it is longest between equal grains.
double bridge_ratios_rupture(const struct bridge_ratios *ratios, double asymmetry,
                             double volume);
