// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium of a bridge: the arc that meets both bodies at their contact angles and
// encloses a given volume. Lengths are in effective radii [G 1], volumes in their
// cubes.
//
// The branch of equilibria at one volume begins at contact, is stable while the gap
// grows along it, and turns back at the widest gap; bridges beyond the turning point
// exist and are not stable. Between equal bodies a second family, without mirror
// symmetry, may take over before. Functions at a volume start from contact and follow
// the branch, so many bridges cost less together (follow_to_turning).
#pragma once

#include "basics/status.h"
#include "bridges/meridian.h"

struct equilibrium {
    struct arc arc;
    double gap;
    // Positive on the stable branch. Zero where the bridge ruptures, in a turning point
    // of the gap or, between equal bodies, where the symmetric bridge gives way to
    // others.
    double stability;
    int steps; // of Newton's method, in all
};

// The stable bridge at GAP. Returns STATUS_OK, STATUS_NO when the bodies are too far
// apart for one, or STATUS_NOT_CONVERGED.
enum status find_equilibrium(const struct bodies *bodies, double volume, double gap,
                             struct equilibrium *found);

// The stable bridge with the widest gap, at which it ruptures: a turning point of the
// gap, or where symmetry breaks.
enum status find_rupture(const struct bodies *bodies, double volume,
                         struct equilibrium *found);

// The bridge in the turning point of the gap: the last symmetric one, whether or not
// symmetry broke before.
enum status find_turning(const struct bodies *bodies, double volume,
                         struct equilibrium *found);

// The bridge at GAP whose liquid is joined to other liquid of the mean curvature
// CURVATURE (above 0), and its VOLUME: on the branch on which a higher curvature leaves
// less. STATUS_NO: no bridge holds out against it there; STATUS_NOT_CONVERGED: none was
// found though the gap is short.
enum status find_at_curvature(const struct bodies *bodies, double curvature, double gap,
                              struct equilibrium *found, double *volume);

// Bridges at COUNT rising gaps from contact to the turning point, each from those
// before it: several times faster than one by one where gaps are close. Gaps beyond it
// by less than 1e-4 of it get the last bridge. Those past the break of symmetry are not
// stable.
enum status follow_to_turning(const struct bodies *bodies, double volume, int count,
                              const double *gap, struct equilibrium *found);
