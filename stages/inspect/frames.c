// SPDX-License-Identifier: GPL-3.0-or-later
#include "frames.h"

#include "basics/memory.h"

#include <stdio.h>
#include <stdlib.h>

void add_frame(struct frames *frames, double time, const struct vtu_grid *grid)
{
    GROW_ARRAY(frames->frame, frames->count, frames->capacity);
    struct vtu_frame *frame = &frames->frame[frames->count];
    snprintf(frame->file, sizeof frame->file, "%s-%04d.vtu", frames->prefix,
             frames->count);
    frame->time = time;
    frames->count++;
    write_vtu(frame->file, grid);
}

void end_frames(struct frames *frames)
{
    char path[4096];
    snprintf(path, sizeof path, "%s.pvd", frames->prefix);
    write_pvd(path, frames->frame, frames->count);
    free(frames->frame);
}
