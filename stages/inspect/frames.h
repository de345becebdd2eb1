// SPDX-License-Identifier: GPL-3.0-or-later
// A series of grids at rising times: one file a frame, and a list of all for ParaView.
#pragma once

#include "vtu.h"

// Begins with the prefix of its files alone.
struct frames {
    const char *prefix;
    struct vtu_frame *frame;
    int count, capacity;
};

// Writes PREFIX-0000.vtu and on. TIME: s.
void add_frame(struct frames *frames, double time, const struct vtu_grid *grid);

// Writes PREFIX.pvd, last: whoever finds it finds all its frames.
void end_frames(struct frames *frames);
