// SPDX-License-Identifier: GPL-3.0-or-later
// Pendular rings: the liquid that stays at contacts when throats empty.
#pragma once

#include "solid_angle_patches.h"

enum ring_rule {
    RING_NONE,
    RING_VOLUME,  // of a given part of the cube of the effective radius [G 1]
    RING_SUCTION, // in equilibrium with liquid of a given suction
    RING_DRYING   // those that the drying left (drying_rings.h)
};

struct ring_law {
    enum ring_rule rule;
    double volume;          // RING_VOLUME: 1
    double suction;         // RING_SUCTION: Pa, above 0
    double surface_tension; // N/m
    double contact_angle;   // rad
};

struct pendular_rings {
    struct patches patches; // N, for a unit of a throat's emptiness
    int count;              // pairs of grains that can hold one
    int cut_off;            // of these, in equilibrium only with more than the cube of
                            // the effective radius, and taken to hold that
    double largest;         // N, force of a whole ring
};

// The ring between two grains that share a face pulls them together by the exact law
// (bridges/bridges.h); grains too far apart for it have none, nor do grains
// and walls, and those that overlap pull as if they touched.
// Each throat beside the face leaves behind the part of the ring that it faces: by its
// angle seen from the foot of the face, so that the force grows as the throats around
// a contact empty and is whole in the end. STATUS_NOT_CONVERGED as bridge_solve.
// OpenMP. The caller frees the patches.
enum status find_pendular_rings(struct sectors *sectors, const struct ring_law *law,
                                struct pendular_rings *rings, struct reason *reason);

// The bridge between spheres of these radii (m) and SEPARATION (m) by LAW: its volume
// (m3), 0 for none, and force (N).
enum status solve_ring(const double radius[2], double separation,
                       const struct ring_law *law, double *volume, double *force,
                       struct reason *reason);
