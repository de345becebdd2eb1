// SPDX-License-Identifier: GPL-3.0-or-later
// Capillary forces on the grains over time, from the liquid in each throat [K 3.6,
// 5.2, 5.3]: one time after the other, so that those of all times need no memory.
#pragma once

#include "interpolation.h"
#include "measures.h"

// It owns its arrays, not PROCESS and TIME.
struct protocol {
    const struct process *process;
    const double *time; // (n_time) s, increasing
    int n_time;
    int row;                       // the time that .force is of; -1: before the first
    struct vector *force, *former; // (n_particle) N, at that time and the one before
    struct liquid_loads liquid;    // at that time
    struct measures measures;      // of all times so far
    struct interpolation interpolation; // the same
};

// The forces at N_TIME increasing times, at least 2; those and PROCESS must live as
// long. Between steps of the drying forces are linear in time, except with
// SUCTION_FIELD. The caller frees with protocol_free.
struct protocol protocol_begin(const struct process *process, const double *time,
                               int n_time);
void protocol_free(struct protocol *protocol);

// Goes to the next time; false: there is none. OpenMP.
bool protocol_next(struct protocol *protocol);
