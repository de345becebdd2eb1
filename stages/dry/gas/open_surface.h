// SPDX-License-Identifier: GPL-3.0-or-later
// The side of the body that is open to the air, seen along the columns of the boundary
// layer.
#ifndef CRAQUELURE_OPEN_SURFACE_H
#define CRAQUELURE_OPEN_SURFACE_H

#include "network/network.h"
#include "planar_region.h"

struct open_surface {
    const struct network *network;
    int wall;
    double unit;          // m
    struct planar corner; // lower, of the rectangle, m
    struct planar_region region;
};

// What the faces in WALL cover; where there are none (a layer of grains, cells left
// out, networks from elsewhere) the rectangle that the throats span. It repeats where
// the box does; along an axis without extent it is as wide as the box. Lengths are in
// units of UNIT (m). Keeps NETWORK. The caller frees it with open_surface_free.
struct open_surface open_surface_of(const struct network *network, int wall,
                                    double unit);

// Where NODE is on the face; its edge, for a node beyond.
struct planar place_on_face(const struct open_surface *face, int node);

void open_surface_free(struct open_surface *face);

#endif
