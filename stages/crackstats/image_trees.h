// SPDX-License-Identifier: GPL-3.0-or-later
// Grains joined by bonds, and which periodic image of the others each of them lies in.
#pragma once

#include "geometry/packing.h"

#include <stdbool.h>
#include <stdint.h>

// One grain in the tree of what hangs together.
struct image_tree {
    int parent;
    struct image image; // seen from the parent
    // of a root:
    int grains;
    bool around[3]; // along x, y, z: whether its bonds lead around the box
};

// N grains, none joined. The caller frees them.
struct image_tree *image_trees_init(int n);

// The root of the tree of GRAIN; *IMAGE: of GRAIN, seen from there. O(log n).
int find_image_root(const struct image_tree *trees, int grain, struct image *image);

// Joins grains A and B by a bond to the image B_FROM_A of B, seen from A.
void join_images(struct image_tree *trees, int a, int b, struct image b_from_a);
