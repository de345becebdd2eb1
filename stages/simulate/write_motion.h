// SPDX-License-Identifier: GPL-3.0-or-later
// The motion artifact, or the packing at the end. Lengths, times and forces in SI,
// shapes as in schemas/motion.json and schemas/packing.json. The caller owns ARTIFACT
// and finishes it.
#pragma once

#include "artifacts/artifact.h"
#include "run.h"

// Puts all that OUTCOME recorded of SCENE into ARTIFACT, a motion. The packing in it is
// that of the start; grains at the end are the last snapshot.
void put_motion(struct artifact *artifact, const struct scene *scene,
                const struct outcome *outcome);

// Puts the grains as they are at the end into ARTIFACT, a packing: with their
// velocities, and with the bonds that hold. Broken bonds are left out, not marked:
// whatever reads a packing takes its bonds as intact. Spins are lost, a packing has
// none. Positions are those of the engine; in a box that repeats they may lie outside
// of it.
void put_final_packing(struct artifact *artifact,
                       const struct simulate_parameters *parameters,
                       const struct scene *scene, const struct outcome *outcome);
