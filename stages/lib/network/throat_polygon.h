// SPDX-License-Identifier: GPL-3.0-or-later
// The polygon of grains around a throat, from the faces that meet in it: its corners
// are the centres of the grains, seen along the throat. Each face gives a side of it,
// the angles at both its grains, what these cover twice, and the gap between them. Of a
// face with a wall, or with an auxiliary grain, only the grain's own half counts, up to
// the throat.
#pragma once

#include "network/open_section.h"
#include "network/throat_sides.h"

// Room for the polygon of one throat at a time, which `section` holds.
struct throat_polygon {
    struct open_section section;
    struct seen_face *face;
    struct vector *centre; // of section.grain, from a place on the throat
    int32_t *number;       // of section.grain, in the packing
    struct vector axis[2]; // across the throat
    double from_first;     // of the way along the throat: that place
};

// Room for throats with up to MOST sides (throat_sides.most), one for each thread; the
// caller frees it with throat_polygon_free. One for each thread: it is room to work in,
// and its section points into it.
struct throat_polygon throat_polygon_init(int most);
void throat_polygon_free(struct throat_polygon *polygon);

// Fills the section of THROAT, in place of the one before; m. The sides must be those
// of the diagram: no nodes merged, no cells left out. The throat's direction is taken
// from the grains, as its own nodes may be nearer to each other than rounding. A
// polygon without area has no direction: area and length are 0. O(sides), but for the
// search of a grain among those seen already, O(sides^2).
void throat_polygon_fill(struct throat_polygon *polygon, const struct network *network,
                         const struct throat_sides *sides, int throat);
