// SPDX-License-Identifier: GPL-3.0-or-later
// Capillary forces on the grains over time, from the liquid in each throat [K 3.6,
// 5.2, 5.3].
#ifndef CRAQUELURE_PROTOCOL_H
#define CRAQUELURE_PROTOCOL_H

#include "throat_loads.h"

// Everything that determines the forces of one run. It owns nothing.
struct process {
    const struct network *network;
    const struct liquid_record *record;
    const struct suction_law *law;
    const struct throat_loads *loads;
};

// It owns its arrays. Row m of .force and .liquid is of time m: grain i is at
// m n_particle + i.
struct protocol {
    int n_time;
    double *time, *saturation; // (n_time) s, 1
    struct vector *force;      // (n_time * n_particle) N
    double *liquid;            // (n_time * n_particle) kg around each grain; NULL: it
                               // weighs nothing
};

// The forces at N_TIME increasing TIMES (s), which the protocol takes over. Between
// steps of the drying they are linear in time, except with SUCTION_FIELD. OpenMP. The
// caller frees with protocol_free.
struct protocol protocol_init(const struct process *process, double *times, int n_time);
void protocol_free(struct protocol *protocol);

// The largest force on a grain at any time (N).
double largest_force(const struct protocol *protocol, int n_particle);

// The largest change of a force on a grain from one time to the next (N).
double largest_change(const struct protocol *protocol, int n_particle);

// The largest distance (N) between the force on a grain and the one interpolated
// between two times: measured at all steps of the drying, on both sides where forces
// jump.
double interpolation_error(const struct process *process,
                           const struct protocol *protocol);

// field_error of the process; for SUCTION_FIELD.
double process_field_error(const struct process *process);

// The largest net force, and net moment about the middle of the box, at any time, each
// relative to the largest sum of magnitudes of its parts. In a periodic box the moment
// is not defined: 0.
void net_load(const struct protocol *protocol, const struct packing *packing,
              double *force, double *moment);

#endif
