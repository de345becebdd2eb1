// SPDX-License-Identifier: GPL-3.0-or-later
// How far the forces on the grains are from those interpolated between the times of the
// protocol, followed while its rows are made.
#pragma once

#include "process.h"

// The forces at the steps of the drying, which wait where they are until the rows
// around this moment are there.
struct interpolation {
    const double *time; // (n_time) s, of the protocol
    int n_time;
    struct force_steps steps;
    bool is_at_end; // of a step: the next begins at the same moment
    double now;     // s, where STEPS is
    int after;      // the first time of the protocol later than that, or the last
    bool is_over;   // the drying has no more steps
    double worst;   // N: the largest distance so far
};

// PROCESS and TIME must live as long. The caller frees with interpolation_free.
struct interpolation interpolation_begin(const struct process *process,
                                         const double *time, int n_time);
void interpolation_free(struct interpolation *interpolation);

// Measures all moments between the times ROW - 1 and ROW of the protocol, with the
// forces FORMER and FORCE (n_particle) at these: at all steps of the drying, on both
// sides where forces jump. ROW from 1 on, one after the other. Costs the forces of the
// steps between both times.
void interpolation_follow(struct interpolation *of, const struct vector *former,
                          const struct vector *force, int row);
