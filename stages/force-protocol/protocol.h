// SPDX-License-Identifier: GPL-3.0-or-later
// Capillary forces over time, from who holds liquid when [K 3.6, 5.2, 5.3].
#ifndef CRAQUELURE_PROTOCOL_H
#define CRAQUELURE_PROTOCOL_H

#include "throat_loads.h"

// Everything that the forces of one run follow from.
struct process {
    const struct network *network;
    const struct liquid_record *record;
    const struct suction_law *law;
    const struct throat_loads *loads;
};

struct protocol {
    int n_time;
    double *time, *saturation; // (n_time) s, 1
    struct vector *force;      // (n_time * n_particle) N
    double *liquid;            // (n_time * n_particle) kg around each grain; NULL: it
                               // weighs nothing
};

// The forces at the N_TIME TIMES, increasing, which it takes over. Between steps of the
// drying they are linear in time, but for SUCTION_FIELD. The caller frees with
// protocol_free.
struct protocol make_protocol(const struct process *process, double *times, int n_time);
void protocol_free(struct protocol *protocol);

// The largest force on a grain at any time (N).
double largest_force(const struct protocol *protocol, int n_particle);

// By how much the force on a grain changes at most from one time to the next (N).
double largest_change(const struct protocol *protocol, int n_particle);

// How far the true force on a grain is at most from the one interpolated between two
// times (N): measured at all steps of the drying, on both sides where forces jump.
double interpolation_error(const struct process *process,
                           const struct protocol *protocol);

// field_error of the process; for SUCTION_FIELD.
double process_field_error(const struct process *process);

// Net force and moment about the middle of the box at any time, at most, of the largest
// sums of their parts' magnitudes. A box that repeats has no moment: 0.
void net_load(const struct protocol *protocol, const struct packing *packing,
              double *force, double *moment);

#endif
