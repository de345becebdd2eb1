// SPDX-License-Identifier: GPL-3.0-or-later
// Union-find over grains with periodic images. Each grain of a tree knows in which
// image of its parent it lies, and find_image_root adds these up on the way. Of a bond
// a - b,
//     apart = a_from_root + b_from_a - b_from_root
// is where the other tree's root is, seen from the first one's. Two trees become one,
// the smaller below the larger, so that ways stay short (O(log n)) without shortening
// them. If both grains are in one tree already and `apart` is not 0, the bond closes a
// loop around the box along those axes. A loop that closes on itself without leading
// around has `apart` 0.
#include "image_trees.h"

#include "basics/memory.h"

struct image_tree *image_trees_init(int n)
{
    struct image_tree *trees = NEW_ARRAY(struct image_tree, n);
    for (int i = 0; i < n; i++)
        trees[i] = (struct image_tree){.parent = i, .grains = 1};
    return trees;
}

int find_image_root(const struct image_tree *trees, int grain, struct image *image)
{
    *image = (struct image){0};
    while (trees[grain].parent != grain) {
        *image = image_sum(*image, trees[grain].image);
        grain = trees[grain].parent;
    }
    return grain;
}

void join_images(struct image_tree *trees, int a, int b, struct image b_from_a)
{
    struct image a_from_root, b_from_root;
    int root = find_image_root(trees, a, &a_from_root);
    int other = find_image_root(trees, b, &b_from_root);
    // Where the other tree's root is, seen from the first one's.
    struct image apart =
        image_sum(a_from_root, image_difference(b_from_a, b_from_root));
    if (root == other) {
        for (int axis = 0; axis < 3; axis++)
            trees[root].around[axis] |= apart.along[axis] != 0;
        return;
    }
    if (trees[root].grains < trees[other].grains) {
        const int kept = root;
        root = other;
        other = kept;
        apart = image_opposite(apart);
    }
    trees[other].parent = root;
    trees[other].image = apart;
    trees[root].grains += trees[other].grains;
    for (int axis = 0; axis < 3; axis++)
        trees[root].around[axis] |= trees[other].around[axis];
}
