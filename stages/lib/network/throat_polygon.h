// SPDX-License-Identifier: GPL-3.0-or-later
// The polygon of grains around a throat, from the faces that meet in it.
#ifndef CRAQUELURE_THROAT_POLYGON_H
#define CRAQUELURE_THROAT_POLYGON_H

#include "network/open_section.h"
#include "network/throat_sides.h"

// Room for the polygon of one throat at a time, which `section` holds.
struct throat_polygon {
    struct open_section section;
    struct seen_face *face;
    struct vector *centre; // of section.grain, from the throat's first node
    struct vector axis[2]; // across the throat
};

// Room for throats with up to MOST sides; the caller frees it.
struct throat_polygon throat_polygon_init(int most);
void throat_polygon_free(struct throat_polygon *polygon);

// Fills the section of THROAT. The sides must be those of the diagram: no nodes merged,
// no cells left out. A polygon without area has no direction: area and length are 0.
void throat_polygon_fill(struct throat_polygon *polygon, const struct network *network,
                         const struct throat_sides *sides, int throat);

#endif
