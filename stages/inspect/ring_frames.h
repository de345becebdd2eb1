// SPDX-License-Identifier: GPL-3.0-or-later
// Rings of liquid around contacts, as frames beside those of the throats.
#pragma once

#include "artifacts/artifact.h"
#include "frames.h"

// A drying's rings as lines between the centres of their grains, from frame to frame.
// It points to NETWORK.
struct ring_frames {
    const struct network *network;
    struct ring_record record;
    double *saturation; // (n_node) of the rings there
    int n_line;
    int *ring;          // (n_line) that is drawn
    int32_t (*line)[2]; // (n_line)
    double *volume;     // (n_line) m3
    struct frames frames;
};

// PREFIX: of files. Rings across a side of a box that repeats are not drawn. The caller
// ends with ring_frames_end, which writes the list of frames.
struct ring_frames ring_frames_begin(const struct artifact *artifact,
                                     const struct network *network, const char *prefix);
void ring_frames_end(struct ring_frames *rings);

// Takes the next STEP, one after the other from 0 on.
void ring_frames_step(struct ring_frames *rings, int step);

// A frame at TIME (s), with the SATURATION (n_throat) of throats then.
void ring_frames_add(struct ring_frames *rings, double time, const double *saturation);
