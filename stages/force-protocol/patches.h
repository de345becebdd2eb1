// SPDX-License-Identifier: GPL-3.0-or-later
// Which patch of each grain's surface faces each throat [K 3.21, 5.1; in three
// dimensions].
#ifndef CRAQUELURE_PATCHES_H
#define CRAQUELURE_PATCHES_H

#include "basics/status.h"
#include "network/network.h"

// The integral of the unit normal over the patch of a grain's unit sphere that faces a
// throat; its length is at most pi. Those of one grain sum to zero to rounding,
// whatever the cell looks like, so a grain with liquid all around feels nothing
// [K 3.22].
struct patch {
    int32_t throat, particle;
    struct vector normal;
};

// Every patch, by grain, then by throat. Each face of a grain's cell is fanned from
// where the line between the two grains crosses it (for a wall: the grain's foot on
// it); the triangles are projected on the sphere, and the two on both sides of a throat
// are its patch. In a layer of grains it is the lune of the sphere between the two ends
// of the throat, which is K's form times pi/2. STATUS_BAD_DATA when two neighbours in a
// face's loop are not joined by a throat. The caller frees *PATCHES.
enum status find_patches(const struct network *network, struct patch **patches,
                         int *count, struct reason *reason);

// The normals of a closed cell add up to nothing. STATUS_BAD_DATA when a grain has a
// cell that the tessellation left open (boundary=eliminate): it would be pulled
// by liquid all around it.
enum status check_closed(const struct patch *patches, int count, struct reason *reason);

// Takes out the patches of throats that lie in one of WALLS (bits of enum wall);
// returns how many are left.
int drop_patches_in_walls(const struct network *network, unsigned walls,
                          struct patch *patches, int count);

#endif
