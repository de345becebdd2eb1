// SPDX-License-Identifier: GPL-3.0-or-later
// Grains on a grid: positions are rounded to a power of two, 2^-40 units, so that
// lattices and periodic copies (x + k box) are exact in double precision, and
// degenerate cells are exactly degenerate. The unit is the cube root of the box volume
// per grain.
//
//     unit = (box volume / grains)^(1/3),
//     grid = the coarser of 2^-40 and 2^(exponent of the largest edge - 50),
// so that 50 bits hold any place in the box. Copies are made along one axis after the
// other, of all grains and copies there are by then. Weights are radii squared and are
// not rounded: equal grains have equal weights already.
#include "network/cell_grains.h"

#include "basics/memory.h"

#include <stdlib.h>

enum { GRID_BITS = 40, SAFE_BITS = 50 };

// The unit of length: the cube root of the box volume per grain, m.
static double unit_for(const struct packing *packing)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    return cbrt(edge.x) * cbrt(edge.y) * cbrt(edge.z) / cbrt(packing->n_particle);
}

static double rounded(double grid, double x)
{
    return grid * nearbyint(x / grid);
}

static struct vector on_grid(double grid, struct vector x)
{
    return (struct vector){rounded(grid, x.x), rounded(grid, x.y), rounded(grid, x.z)};
}

// AT moved into a periodic box.
static struct vector wrapped(const struct grains *grains, struct vector at)
{
    for (int axis = 0; axis < 3; axis++) {
        if (!grains->repeats[axis]) continue;
        const double edge = component(grains->box, axis), x = component(at, axis);
        set_component(&at, axis, x - edge * floor(x / edge));
    }
    return at;
}

static enum status check_inside(const struct grains *grains, struct reason *reason)
{
    for (int i = 0; i < grains->n_base; i++)
        for (int axis = 0; axis < 3; axis++) {
            const double x = component(grains->position[i], axis);
            const double edge = component(grains->box, axis);
            if (grains->repeats[axis] || (x > 0 && x < edge)) continue;
            return refuse(reason, STATUS_BAD_DATA,
                          "/particles/position: row %d: the centre must be inside the "
                          "box along %c, between 0 and %g m from its lower side, is "
                          "%g m from there",
                          i, "xyz"[axis], edge * grains -> unit, x * grains -> unit);
        }
    return STATUS_OK;
}

static void grow(struct grains *grains, int *capacity)
{
    if (grains->n < *capacity) return;
    *capacity = *capacity + *capacity / 2 + 64;
    const size_t room = (size_t)*capacity;
    grains->position = reallocate(grains->position, room, sizeof *grains->position);
    grains->weight = reallocate(grains->weight, room, sizeof *grains->weight);
    grains->base = reallocate(grains->base, room, sizeof *grains->base);
    grains->image = reallocate(grains->image, room, sizeof *grains->image);
}

// One direction after the other, so that copies are copied too: across edges, corners.
static void add_copies(struct grains *grains, int capacity)
{
    for (int axis = 0; axis < 3; axis++) {
        if (!grains->repeats[axis]) continue;
        const double edge = component(grains->box, axis);
        const int most = (int)fmin(ceil(grains->reach / edge), FARTHEST_IMAGE);
        const int before = grains->n;
        for (int i = 0; i < before; i++)
            for (int boxes = -most; boxes <= most; boxes++) {
                const double at = component(grains->position[i], axis) + boxes * edge;
                if (!boxes || at < -grains->reach || at > edge + grains->reach)
                    continue;
                grow(grains, &capacity);
                const int copy = grains->n++;
                grains->position[copy] = grains->position[i];
                grains->weight[copy] = grains->weight[i];
                grains->base[copy] = grains->base[i];
                grains->image[copy] = grains->image[i];
                set_component(&grains->position[copy], axis, at);
                grains->image[copy].along[axis] = (int8_t)boxes;
            }
    }
}

enum status place_grains(const struct packing *packing, double reach,
                         struct grains *grains, struct reason *reason)
{
    const int n = packing->n_particle;
    *grains = (struct grains){.n = n, .n_base = n, .reach = reach};
    if (n == 0) return refuse(reason, STATUS_BAD_DATA, "the packing holds no grains");
    if (packing->n_body > 0)
        return refuse(
            reason, STATUS_BAD_DATA,
            "/domain/bodies/shape: pores are found between the walls of the box "
            "only, not beside bodies");
    const double unit = grains->unit = unit_for(packing);
    grains->position = NEW_ARRAY(struct vector, n);
    grains->weight = NEW_ARRAY(double, n);
    grains->radius = NEW_ARRAY(double, n);
    grains->base = NEW_ARRAY(int32_t, n);
    grains->image = NEW_ARRAY(struct image, n);
    const struct vector box = scale(1 / unit, subtract(packing->upper, packing->lower));
    const double largest = fmax(box.x, fmax(box.y, box.z));
    const double grid = ldexp(1, (int)fmax(-GRID_BITS, ilogb(largest) - SAFE_BITS));
    grains->box = on_grid(grid, box);
    for (int axis = 0; axis < 3; axis++)
        grains->repeats[axis] = packing->periodic[axis];
    for (int i = 0; i < n; i++) {
        const struct vector at =
            scale(1 / unit, subtract(packing->position[i], packing->lower));
        grains->position[i] = wrapped(grains, on_grid(grid, at));
        grains->radius[i] = packing->radius[i] / unit;
        grains->weight[i] = grains->radius[i] * grains->radius[i];
        grains->base[i] = i;
    }
    const enum status status = check_inside(grains, reason);
    if (!status) add_copies(grains, n);
    return status;
}

void grains_free(struct grains *grains)
{
    free(grains->position);
    free(grains->weight);
    free(grains->radius);
    free(grains->base);
    free(grains->image);
    *grains = (struct grains){0};
}

struct vector in_image(const struct grains *grains, struct vector position,
                       struct image image)
{
    return add(position, (struct vector){image.along[0] * grains->box.x,
                                         image.along[1] * grains->box.y,
                                         image.along[2] * grains->box.z});
}

bool grains_repeat(const struct grains *grains)
{
    return grains->repeats[0] || grains->repeats[1] || grains->repeats[2];
}
