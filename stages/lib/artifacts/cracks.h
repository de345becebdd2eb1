// SPDX-License-Identifier: GPL-3.0-or-later
// The bonds that broke, as a response or a motion has them: those of /cracks, and those
// that were broken when it began.
#pragma once

#include "artifacts/artifact.h"

// It owns its arrays. Bonds are rows of /bonds; a mode is 0 in tension, 1 in shear. The
// schema has checked ranges and order; whether a bond breaks twice is for the caller to
// see.
struct cracks {
    int n;
    int32_t *bond;      // (n)
    double *time;       // (n) s, nondecreasing
    double *saturation; // (n) of the network at that time; NULL: a motion has none
    uint8_t *mode;      // (n)

    // Broken before, in replays that this one goes on from, then under the weight
    // alone.
    int n_before;
    int32_t *bond_before; // (n_before)
    uint8_t *mode_before; // (n_before)
};

// Reads them; the caller frees them with cracks_free. ARTIFACT must be a response or a
// motion.
struct cracks artifact_get_cracks(const struct artifact *artifact);

// Frees the arrays and empties CRACKS; safe on an empty one.
void cracks_free(struct cracks *cracks);
