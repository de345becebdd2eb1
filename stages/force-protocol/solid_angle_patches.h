// SPDX-License-Identifier: GPL-3.0-or-later
// The pull of each throat on each grain beside it, for a unit of its load [K
// 3.13-3.21, 5.1].
#pragma once

#include "basics/status.h"
#include "throat_face_sectors.h"

enum form {
    // The suction on the patch of the grain's surface that faces the throat: R^2 times
    // the integral of the unit normal over it. In a layer it is the lune of the sphere
    // between the two ends of the throat. Those of one grain sum to zero to rounding,
    // whatever the cell looks like [K 3.22].
    FORM_SOLID_ANGLE,
    // The same and the pull of the menisci where the liquid ends, along the contact
    // lines and as large as the suction over the opening between two grains: together
    // they are the suction over the part of the cell's faces beside the throat, so that
    // two grains pull each other equally.
    FORM_FACES,
    FORM_CENTRES, // [K 5.1] R^2 times the direction to the middle of the throat
    FORM_ARCS     // [K 3.20, 3.21] R times the arc of the circle, in a layer; times R
};

// The pull of one throat on one grain, for a unit of the throat's load.
struct patch {
    int32_t throat, particle;
    struct vector pull;
};

// Sorted by grain, then by throat; one for each pair. Auxiliary grains have none. Free
// with patches_free.
struct patches {
    int n;
    struct patch *patch;
    int *begin; // (n_particle+1) patches of each grain
    int capacity;
};

// The pulls of a unit of suction in each throat (m2). The caller frees them.
struct patches find_patches(struct sectors *sectors, enum form form);

// The pull of a unit contact line in each throat: a circle around it, of radius r, that
// pulls with sigma sin(theta) towards the middle of the throat [K 3.16]. Each grain has
// the arc between the faces on both sides, and the integral over that is r times the
// sum of the unit vectors towards both neighbours, whatever the angle: two grains pull
// each other equally here as well. For a unit of r sigma sin(theta) (1).
struct patches find_contact_lines(struct sectors *sectors);

// Patches of what MAKE returns for each wedge.
typedef struct vector pull_of_sector(const struct sectors *, const struct sector *,
                                     const void *context);
pull_of_sector *pull_of(enum form form); // its context is not looked at
struct patches collect_patches(struct sectors *sectors, pull_of_sector *make,
                               const void *context);
void patches_free(struct patches *patches);

// Adds PULL to what THROAT does to GRAIN: throats in rising order, of any grain or of
// one grain after the other. In the first case patches_sort must follow.
void patches_add(struct patches *patches, int throat, int grain, struct vector pull);
void patches_sort(struct patches *patches, int n_particle);

// STATUS_BAD_DATA when a node lies in the centre of a grain: it is in no direction.
enum status check_patches(const struct patches *patches, struct reason *reason);

// Removes the patches of throats that lie in one of WALLS (bits of enum wall), but not
// of those that only face it where cells were left out.
void drop_patches_in_walls(const struct sectors *sectors, unsigned walls,
                           struct patches *patches);
