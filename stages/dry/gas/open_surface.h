// SPDX-License-Identifier: GPL-3.0-or-later
// The side of the body that is open to the air, seen along the columns of the boundary
// layer.
#pragma once

#include "network/network.h"
#include "planar_region.h"

struct open_surface {
    const struct network *network;
    int wall;
    double unit;          // m
    struct planar corner; // lower, of the rectangle, m
    struct planar_region region;
};

// The part of WALL that faces of the network cover; without such faces (a layer of
// grains, cells left out, imported networks) the rectangle that the throats span. It is
// periodic where the box is; along an axis without extent it is as wide as the box.
// Lengths are in units of UNIT (m). Keeps NETWORK. The caller frees it with
// open_surface_free.
struct open_surface open_surface_of(const struct network *network, int wall,
                                    double unit);

// Where NODE is on the face, in units of FACE->unit; a node beyond it is moved to its
// edge, or to its periodic image.
struct planar place_on_face(const struct open_surface *face, int node);

void open_surface_free(struct open_surface *face);
