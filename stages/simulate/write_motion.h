// SPDX-License-Identifier: GPL-3.0-or-later
// The motion artifact, or the packing at the end.
#ifndef CRAQUELURE_SIMULATE_WRITE_MOTION_H
#define CRAQUELURE_SIMULATE_WRITE_MOTION_H

#include "artifacts/artifact.h"
#include "run.h"

// Puts all that OUTCOME recorded of SCENE into ARTIFACT, a motion.
void put_motion(struct artifact *artifact, const struct scene *scene,
                const struct outcome *outcome);

// Puts the grains as they are at the end into ARTIFACT, a packing: with their
// velocities, and with the bonds that hold.
void put_final_packing(struct artifact *artifact, const struct scene *scene,
                       const struct outcome *outcome);

#endif
