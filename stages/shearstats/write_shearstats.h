// SPDX-License-Identifier: GPL-3.0-or-later
// The shearstats artifact: means over the runs with intervals, and each run. Shapes are
// those of schemas/shearstats.json. The caller owns ARTIFACT and finishes it.
// CONFIDENCE in (0, 1) is that of all half widths.
#pragma once

#include "artifacts/artifact.h"
#include "study.h"

// Grid, fields, summary, what flows.
void put_fields(struct artifact *artifact, const struct study *study,
                double confidence);

// Levels, profiles and torque of a split-bottom cell, the lines, separations. What
// STUDY has not (a cell, a part whose torque is asked for) is left out.
void put_statistics(struct artifact *artifact, const struct study *study,
                    double confidence);
