// SPDX-License-Identifier: GPL-3.0-or-later
// The broken bonds join their grains (image_trees.h); each cluster is counted at the
// root of its tree. Along an axis that repeats it spans if its bonds lead around the
// box. Along one that does not it spans if it has a grain at either end:
//     x - radius < lowest surface + near,  x + radius > highest surface - near,
// with `near` the mean radius. Ends are those of the solid grains, not of the box.
#include "clusters.h"

#include "geometry/porosity.h"
#include "image_trees.h"

#include <stdlib.h>

// What lies in the cluster of a root.
struct content {
    int bonds;
    bool at_lower[3], at_upper[3];
};

// Marks the roots of grains at either end. Auxiliary grains set no end. They may be
// marked, which does no harm: without a bond they are in no cluster.
static void mark_ends(const struct packing *packing, const struct image_tree *trees,
                      int axis, struct content *content)
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
        struct image image;
        struct content *of = &content[find_image_root(trees, i, &image)];
        of->at_lower[axis] |= x - packing->radius[i] < lowest + near;
        of->at_upper[axis] |= x + packing->radius[i] > highest - near;
    }
}

struct clusters find_clusters(const struct run *run, struct sizes *sizes)
{
    const struct packing *packing = &run->packing;
    struct image_tree *trees = image_trees_init(packing->n_particle);
    struct content *content = NEW_ARRAY(struct content, packing->n_particle);
    for (int k = 0; k < run->n_crack; k++) {
        const int32_t *pair = packing->bond[run->bond[k]];
        join_images(trees, pair[0], pair[1], bond_image(packing, run->bond[k]));
    }
    for (int k = 0; k < run->n_crack; k++) {
        struct image image;
        content[find_image_root(trees, packing->bond[run->bond[k]][0], &image)].bonds++;
    }
    for (int axis = 0; axis < 3; axis++)
        if (!packing->periodic[axis]) mark_ends(packing, trees, axis, content);
    struct clusters found = {0};
    for (int i = 0; i < packing->n_particle; i++) {
        const struct content *of = &content[i];
        if (of->bonds == 0) continue;
        found.count++;
        if (of->bonds > found.largest) found.largest = of->bonds;
        for (int axis = 0; axis < 3; axis++)
            found.spans[axis] |=
                trees[i].around[axis] || (of->at_lower[axis] && of->at_upper[axis]);
        add_size(sizes, of->bonds);
    }
    free(content);
    free(trees);
    return found;
}
