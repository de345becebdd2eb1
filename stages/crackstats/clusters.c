// SPDX-License-Identifier: GPL-3.0-or-later
// Union-find over grains with periodic images. Each grain of a tree knows in which
// image of its parent it lies, and find_root adds these up on the way. Of a bond a - b,
//     apart = a_from_root + b_from_a - b_from_root
// is where the other tree's root is, seen from the first one's. Two trees become one,
// the smaller below the larger, so that ways stay short (O(log n)) without shortening
// them. If both grains are in one tree already and `apart` is not 0, the broken bond
// closes a loop around the box: the cluster spans those axes. A loop that closes on
// itself without leading around has `apart` 0.
//
// Along an axis that does not repeat a cluster spans if it has a grain at either end:
//     x - radius < lowest surface + near,  x + radius > highest surface - near,
// with `near` the mean radius. Ends are those of the solid grains, not of the box.
#include "clusters.h"

#include "geometry/porosity.h"

#include <stdlib.h>

// A grain in the tree of its cluster; the sums are valid at the root.
struct tree {
    int parent;
    struct image image; // seen from the parent
    // of a root:
    int grains, bonds;
    bool spans[3];
    bool at_lower[3], at_upper[3];
};

static int find_root(const struct tree *trees, int grain, struct image *image)
{
    *image = (struct image){0};
    while (trees[grain].parent != grain) {
        *image = image_sum(*image, trees[grain].image);
        grain = trees[grain].parent;
    }
    return grain;
}

static void join(struct tree *trees, int a, int b, struct image b_from_a)
{
    struct image a_from_root, b_from_root;
    int root = find_root(trees, a, &a_from_root);
    int other = find_root(trees, b, &b_from_root);
    // Where the other tree's root is, seen from the first one's.
    struct image apart =
        image_sum(a_from_root, image_difference(b_from_a, b_from_root));
    if (root == other) {
        for (int axis = 0; axis < 3; axis++)
            trees[root].spans[axis] |= apart.along[axis] != 0;
        trees[root].bonds++;
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
    trees[root].bonds += trees[other].bonds + 1;
    for (int axis = 0; axis < 3; axis++) {
        trees[root].spans[axis] |= trees[other].spans[axis];
        trees[root].at_lower[axis] |= trees[other].at_lower[axis];
        trees[root].at_upper[axis] |= trees[other].at_upper[axis];
    }
}

// Auxiliary grains set no end. They may be marked, which does no harm: without a bond
// they are in no cluster.
static void mark_ends(const struct packing *packing, struct tree *trees, int axis)
{
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (int i = 0; i < packing->n_particle; i++) {
        if (is_auxiliary(packing, i)) continue;
        const double x = component(packing->position[i], axis);
        lowest = fmin(lowest, x - packing->radius[i]);
        highest = fmax(highest, x + packing->radius[i]);
    }
    const double near = mean_radius(packing);
    for (int i = 0; i < packing->n_particle; i++) {
        const double x = component(packing->position[i], axis);
        trees[i].at_lower[axis] = x - packing->radius[i] < lowest + near;
        trees[i].at_upper[axis] = x + packing->radius[i] > highest - near;
    }
}

struct clusters find_clusters(const struct run *run, struct sizes *sizes)
{
    const struct packing *packing = &run->packing;
    struct tree *trees = NEW_ARRAY(struct tree, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++)
        trees[i] = (struct tree){.parent = i, .grains = 1};
    for (int axis = 0; axis < 3; axis++)
        if (!packing->periodic[axis]) mark_ends(packing, trees, axis);
    for (int k = 0; k < run->n_crack; k++) {
        const int32_t *pair = packing->bond[run->bond[k]];
        join(trees, pair[0], pair[1], bond_image(packing, run->bond[k]));
    }
    struct clusters found = {0};
    for (int i = 0; i < packing->n_particle; i++) {
        const struct tree *tree = &trees[i];
        if (tree->parent != i || tree->bonds == 0) continue;
        found.count++;
        if (tree->bonds > found.largest) found.largest = tree->bonds;
        for (int axis = 0; axis < 3; axis++)
            found.spans[axis] |=
                tree->spans[axis] || (tree->at_lower[axis] && tree->at_upper[axis]);
        add_size(sizes, tree->bonds);
    }
    free(trees);
    return found;
}
