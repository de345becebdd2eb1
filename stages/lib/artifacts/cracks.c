// SPDX-License-Identifier: GPL-3.0-or-later
// Datasets, where * marks optional ones, which a motion never has:
//
//     /cracks          bond, time, saturation*, mode
//     /earlier_cracks* bond, mode    of a replay that goes on from an earlier one
//     /weight_cracks*  bond, mode    of a replay with gravity
#include "artifacts/cracks.h"

#include "basics/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Adds those of GROUP, if it is there.
static void add_before(struct cracks *cracks, const struct artifact *artifact,
                       const char *group)
{
    char bonds[40], modes[40];
    snprintf(bonds, sizeof bonds, "%s/bond", group);
    snprintf(modes, sizeof modes, "%s/mode", group);
    if (!artifact_has_dataset(artifact, bonds)) return;
    int n;
    int32_t *bond = artifact_get(artifact, bonds, &n);
    uint8_t *mode = artifact_get(artifact, modes, NULL);
    const size_t before = (size_t)cracks->n_before, more = (size_t)n;
    cracks->bond_before =
        reallocate(cracks->bond_before, before + more, sizeof *cracks->bond_before);
    cracks->mode_before =
        reallocate(cracks->mode_before, before + more, sizeof *cracks->mode_before);
    memcpy(cracks->bond_before + before, bond, more * sizeof *bond);
    memcpy(cracks->mode_before + before, mode, more * sizeof *mode);
    cracks->n_before += n;
    free(bond);
    free(mode);
}

struct cracks artifact_get_cracks(const struct artifact *artifact)
{
    struct cracks cracks = {0};
    cracks.bond = artifact_get(artifact, "/cracks/bond", &cracks.n);
    cracks.time = artifact_get(artifact, "/cracks/time", NULL);
    if (artifact_has_dataset(artifact, "/cracks/saturation"))
        cracks.saturation = artifact_get(artifact, "/cracks/saturation", NULL);
    cracks.mode = artifact_get(artifact, "/cracks/mode", NULL);
    add_before(&cracks, artifact, "/earlier_cracks");
    add_before(&cracks, artifact, "/weight_cracks");
    return cracks;
}

void cracks_free(struct cracks *cracks)
{
    free(cracks->bond);
    free(cracks->time);
    free(cracks->saturation);
    free(cracks->mode);
    free(cracks->bond_before);
    free(cracks->mode_before);
    *cracks = (struct cracks){0};
}
