// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the diagram of moved grains is still the same. A regular triangulation that
// is regular at every facet, between the two cells on its sides, is regular as a whole
// (Edelsbrunner and Shah 1996): no grain of the cell across a facet may have less
// power
//     |x_grain - node|^2 - R^2
// to a node than the node's own grains have. The cell across a facet is the node at
// the other end of a throat, so neighbouring nodes are all that must be looked at.
// Nodes on the surface of a hole are an exception: cells reach through it to any other
// such node.
#include "move.h"

#include "basics/memory.h"

#include <stdlib.h>

// Smaller differences, relative to the mean diameter (squared for powers), are
// rounding.
static const double NEGLIGIBLE = 1e-9;

struct state {
    const struct network *network;
    const struct neighbour_grains *around;
    double diameter;
};

static double power(const struct packing *packing, struct grain_beside beside,
                    struct vector from)
{
    const struct vector to = to_grain(packing, beside, from);
    const double radius = packing->radius[beside.grain];
    return dot(to, to) - radius * radius;
}

static bool is_around(const struct neighbour_grains *around, int node,
                      struct grain_beside beside)
{
    for (int64_t k = around->offset[node]; k < around->offset[node + 1]; k++)
        if (same_grain(around->at[k], beside)) return true;
    return false;
}

static double largest_own_power(const struct state *state, int node)
{
    double largest = -HUGE_VAL;
    for (int64_t k = state->around->offset[node]; k < state->around->offset[node + 1];
         k++)
        largest = fmax(largest, power(&state->network->packing, state->around->at[k],
                                      state->network->node_position[node]));
    return largest;
}

// Whether a grain of the node OTHER, seen in IMAGE, has less power to NODE than its
// own.
static bool is_overtaken(const struct state *state, int node, int other,
                         struct image image)
{
    const struct neighbour_grains *around = state->around;
    const double own =
        largest_own_power(state, node) - NEGLIGIBLE * state->diameter * state->diameter;
    for (int64_t k = around->offset[other]; k < around->offset[other + 1]; k++) {
        const struct grain_beside beside = {around->at[k].grain,
                                            image_sum(around->at[k].image, image)};
        if (!is_around(around, node, beside) &&
            power(&state->network->packing, beside,
                  state->network->node_position[node]) < own)
            return true;
    }
    return false;
}

static bool is_on_hole(const struct state *state, int node)
{
    return state->around->walls[node] >> WALL_INNER & 1;
}

// Whether a node is beyond the walls, in a hole, or off the surface of the hole it was
// on.
static bool is_outside(const struct state *state, int node)
{
    const struct packing *packing = &state->network->packing;
    const double slack = NEGLIGIBLE * state->diameter;
    const struct vector at = state->network->node_position[node];
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        const double beyond = component(at, wall / 2) - wall_position(packing, wall);
        if (!packing->periodic[wall / 2] && (wall % 2 ? beyond : -beyond) > slack)
            return true;
    }
    for (int k = 0; k < packing->n_body; k++) {
        const struct body body = body_near(packing, k, at);
        if (body_holds(&body, at) != body.within &&
            distance(body_nearest(&body, at), at) > slack)
            return true;
    }
    return is_on_hole(state, node) &&
           distance(nearest_on_wall(packing, WALL_INNER, at), at) > slack;
}

// The periodic image of GRAIN that is nearest to FROM.
static struct image nearest_image_of(const struct packing *packing, struct vector from,
                                     int grain)
{
    const struct vector to = subtract(packing->position[grain], from);
    struct image image = {0};
    for (int axis = 0; axis < 3; axis++) {
        const double edge =
            component(packing->upper, axis) - component(packing->lower, axis);
        if (packing->periodic[axis])
            image.along[axis] = (int8_t)-nearbyint(component(to, axis) / edge);
    }
    return image;
}

// ---- holes --------------------------------------------------------------------------

// Whether a throat passes through a hole, other than along its surface.
static bool is_interrupted(const struct state *state, int t)
{
    const struct network *network = state->network;
    const int32_t *end = network->throat_nodes[t];
    if (is_on_hole(state, end[0]) && is_on_hole(state, end[1])) return false;
    const struct vector from = network->node_position[end[0]],
                        along = along_throat(network, t);
    for (int k = 0; k < network->packing.n_body; k++) {
        const struct body body =
            body_near(&network->packing, k, add(from, scale(0.5, along)));
        double span[2];
        if (!body.within && body_span(&body, from, add(from, along), span) &&
            (fmin(span[1], 1) - fmax(span[0], 0)) * norm(along) >
                NEGLIGIBLE * state->diameter)
            return true;
    }
    return false;
}

// Marks the grains (n_particle) around nodes on holes: their cells may reach through
// these to any other such node. The caller frees it.
static bool *grains_at_holes(const struct state *state)
{
    bool *at_hole = NEW_ARRAY(bool, state->network->packing.n_particle);
    for (int i = 0; i < state->network->n_node; i++)
        for (int64_t k = state->around->offset[i];
             k < state->around->offset[i + 1] && is_on_hole(state, i); k++)
            at_hole[state->around->at[k].grain] = true;
    return at_hole;
}

static bool is_overtaken_through_hole(const struct state *state, int node,
                                      const bool *at_hole)
{
    const struct network *network = state->network;
    if (!is_on_hole(state, node)) return false;
    const double own =
        largest_own_power(state, node) - NEGLIGIBLE * state->diameter * state->diameter;
    for (int i = 0; i < network->packing.n_particle; i++) {
        if (!at_hole[i]) continue;
        const struct grain_beside beside = {
            i, nearest_image_of(&network->packing, network->node_position[node], i)};
        if (power(&network->packing, beside, network->node_position[node]) < own &&
            !is_around(state->around, node, beside))
            return true;
    }
    return false;
}

// -------------------------------------------------------------------------------------

// (n_node) The caller frees it.
static bool *find_changed(const struct state *state)
{
    const struct network *network = state->network;
    bool *changed = NEW_ARRAY(bool, network->n_node);
    bool *at_hole = grains_at_holes(state);
    for (int i = 0; i < network->n_node; i++)
        changed[i] =
            is_outside(state, i) || is_overtaken_through_hole(state, i, at_hole);
    free(at_hole);
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *end = network->throat_nodes[t];
        const struct image image =
            network->throat_image ? network->throat_image[t] : (struct image){0};
        changed[end[0]] = changed[end[0]] || is_overtaken(state, end[0], end[1], image);
        changed[end[1]] = changed[end[1]] ||
                          is_overtaken(state, end[1], end[0], image_opposite(image));
        if (is_interrupted(state, t)) changed[end[0]] = changed[end[1]] = true;
    }
    return changed;
}

int count_changed_nodes(const struct network *before,
                        const struct neighbour_grains *around,
                        const struct network *after)
{
    double diameter = 0;
    for (int i = 0; i < before->packing.n_particle; i++)
        diameter += 2 * before->packing.radius[i] / before->packing.n_particle;
    bool *was = find_changed(&(struct state){before, around, diameter});
    bool *is = find_changed(&(struct state){after, around, diameter});
    int count = 0;
    for (int i = 0; i < before->n_node; i++)
        count += is[i] && !was[i];
    free(was);
    free(is);
    return count;
}
