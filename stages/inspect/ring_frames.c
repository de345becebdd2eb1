// SPDX-License-Identifier: GPL-3.0-or-later
// Points are the grains; the array of a line is what its ring holds, of the throats
// around it that have emptied (network/ring_record.h). So volumes begin at 0, rise as
// gas comes to the contact, and fall as its ring dries.
#include "ring_frames.h"

#include "basics/memory.h"

#include <stdlib.h>

// The lines: of a ring across a side that repeats the second grain is an image.
static void find_lines(struct ring_frames *rings)
{
    const struct network *network = rings->network;
    for (int r = 0; r < rings->record.n; r++) {
        const int face = rings->record.face[r];
        const int32_t *grain = network->face_particles[face];
        if (grain[1] < 0) continue;
        const struct vector *at = network->packing.position;
        if (norm(subtract(second_grain(network, face), at[grain[1]])) > 0) continue;
        rings->ring[rings->n_line] = r;
        rings->line[rings->n_line][0] = grain[0];
        rings->line[rings->n_line++][1] = grain[1];
    }
}

struct ring_frames ring_frames_begin(const struct artifact *artifact,
                                     const struct network *network, const char *prefix)
{
    struct ring_frames rings = {.network = network,
                                .record = artifact_get_rings(artifact),
                                .saturation = NEW_ARRAY(double, network->n_node),
                                .frames = {.prefix = prefix}};
    const size_t n = (size_t)rings.record.n;
    rings.ring = NEW_ARRAY(int, n);
    rings.line = allocate(n, sizeof *rings.line);
    rings.volume = NEW_ARRAY(double, n);
    for (int i = 0; i < network->n_node; i++)
        rings.saturation[i] = 1;
    find_lines(&rings);
    return rings;
}

void ring_frames_end(struct ring_frames *rings)
{
    end_frames(&rings->frames);
    ring_record_free(&rings->record);
    free(rings->saturation);
    free(rings->ring);
    free(rings->line);
    free(rings->volume);
}

void ring_frames_step(struct ring_frames *rings, int step)
{
    apply_changes(&rings->record.changes, step, rings->saturation);
}

void ring_frames_add(struct ring_frames *rings, double time, const double *saturation)
{
    const struct packing *packing = &rings->network->packing;
    for (int l = 0; l < rings->n_line; l++)
        rings->volume[l] = ring_volume(&rings->record, rings->network, rings->ring[l],
                                       saturation, rings->saturation);
    const struct vtu_array points[] = {{"radius", packing->radius, 1, NULL}, {0}};
    const struct vtu_array cells[] = {{"volume", rings->volume, 1, NULL}, {0}};
    add_frame(&rings->frames, time,
              &(struct vtu_grid){.n_point = packing->n_particle,
                                 .point = packing->position,
                                 .n_line = rings->n_line,
                                 .line = (const int32_t(*)[2])rings->line,
                                 .points = points,
                                 .cells = cells,
                                 .shown = "volume"});
}
