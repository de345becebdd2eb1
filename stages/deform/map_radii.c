// SPDX-License-Identifier: GPL-3.0-or-later
// Mapping from the old network to a new tessellation of the moved grains, by nearest
// neighbours. The middle of an old throat is moved by the mean displacement of the
// grains around its two nodes; a new throat takes its saturation, or radius, from the
// old middle nearest to its own, and the volume of liquid of an old throat goes to the
// nearest new throat that has any. So volumes are conserved, saturations are only
// interpolated, and redistribute_liquid (liquid.h) reconciles both.
#include "map_radii.h"

#include "basics/memory.h"
#include "nearest.h"
#include "network/enclosed.h"
#include "throats.h"

#include <stdlib.h>

// The middles of some throats, and their indices.
struct middles {
    int n;
    struct vector *at;
    int *throat;
};

static struct middles find_middles(const struct network *network, const double *wet)
{
    struct middles middles = {0, NEW_ARRAY(struct vector, network->n_throat),
                              NEW_ARRAY(int, network->n_throat)};
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK || (wet && !(wet[t] > 0)))
            continue;
        middles.at[middles.n] = throat_middle(network, t);
        middles.throat[middles.n++] = t;
    }
    return middles;
}

static void free_middles(struct middles *middles)
{
    free(middles->at);
    free(middles->throat);
}

// Moves the middles with the grains around them.
static void follow_grains(const struct network *before,
                          const struct neighbour_grains *around,
                          const struct packing *moved, struct middles *middles)
{
    for (int k = 0; k < middles->n; k++) {
        struct vector sum = {0};
        int64_t count = 0;
        for (int end = 0; end < 2; end++) {
            const int node = before->throat_nodes[middles->throat[k]][end];
            for (int64_t g = around->offset[node]; g < around->offset[node + 1]; g++) {
                const int grain = around->at[g].grain;
                sum = add(sum, subtract(moved->position[grain],
                                        before->packing.position[grain]));
                count++;
            }
        }
        if (count)
            middles->at[k] = add(middles->at[k], scale(1.0 / (double)count, sum));
    }
}

// The walls in which throats lie that are all imposed empty.
static unsigned empty_walls(const struct network *network)
{
    unsigned empty = 0, holding = 0;
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *end = network->throat_nodes[t];
        const unsigned in = network->node_walls[end[0]] & network->node_walls[end[1]];
        if (network->throat_kind[t] == THROAT_IMPOSED_EMPTY)
            empty |= in;
        else if (network->throat_kind[t] == THROAT_NETWORK)
            holding |= in;
    }
    return empty & ~holding;
}

static void map_saturations(const struct middles *old, const struct network *renewed,
                            const double *saturation, double *to)
{
    struct places places = places_init(&renewed->packing, old->n, old->at);
    for (int t = 0; t < renewed->n_throat; t++) {
        if (renewed->throat_kind[t] != THROAT_NETWORK) continue;
        const int k = nearest_place(&places, throat_middle(renewed, t));
        if (k >= 0) to[t] = saturation[old->throat[k]];
    }
    places_free(&places);
}

static void map_volumes(const struct middles *old, const struct network *before,
                        const double *saturation, const struct network *renewed,
                        struct mapped_liquid *mapped)
{
    struct middles wet = find_middles(renewed, mapped->saturation);
    if (!wet.n) { // too little was left for any throat to be near
        free_middles(&wet);
        wet = find_middles(renewed, NULL);
    }
    struct places places = places_init(&renewed->packing, wet.n, wet.at);
    for (int k = 0; k < old->n; k++) {
        const int t = old->throat[k];
        const int near = saturation[t] > 0 ? nearest_place(&places, old->at[k]) : -1;
        if (near < 0) continue;
        const int to = wet.throat[near];
        mapped->liquid[to] += saturation[t] * throat_volume(before, t);
        if (mapped->saturation[to] == 0)
            mapped->saturation[to] =
                fmin(1, mapped->liquid[to] / throat_volume(renewed, to));
    }
    places_free(&places);
    free_middles(&wet);
}

struct mapped_liquid map_liquid(const struct network *before,
                                const struct neighbour_grains *around,
                                const struct packing *moved, const double *saturation,
                                unsigned open_walls, struct network *renewed)
{
    struct mapped_liquid mapped = {NEW_ARRAY(double, renewed->n_throat),
                                   NEW_ARRAY(double, renewed->n_throat)};
    const unsigned empty = empty_walls(before);
    if (empty) {
        impose_empty_throats(renewed, empty);
        empty_throats_cut_off(renewed, open_walls);
    }
    struct middles old = find_middles(before, NULL);
    follow_grains(before, around, moved, &old);
    map_saturations(&old, renewed, saturation, mapped.saturation);
    map_volumes(&old, before, saturation, renewed, &mapped);
    free_middles(&old);
    return mapped;
}

enum status map_radii(const struct network *before,
                      const struct neighbour_grains *around,
                      const struct packing *moved, enum clearance how,
                      struct network *renewed, struct reason *reason)
{
    double *was = find_clearances(before, how, reason);
    double *is = was ? find_clearances(renewed, how, reason) : NULL;
    if (!is) {
        free(was);
        return STATUS_BAD_DATA;
    }
    struct middles old = find_middles(before, NULL);
    follow_grains(before, around, moved, &old);
    double *growth = find_growth(before, around, moved);
    struct places places = places_init(&renewed->packing, old.n, old.at);
    for (int t = 0; t < renewed->n_throat; t++) {
        if (renewed->throat_kind[t] != THROAT_NETWORK) continue;
        const int k = nearest_place(&places, throat_middle(renewed, t));
        if (k < 0) continue;
        const int from = old.throat[k];
        renewed->throat_radius[t] =
            moved_radius(before->throat_radius[from], growth[from], was[from], is[t]);
    }
    if (!before->throat_volume) {
        free(renewed->throat_volume);
        renewed->throat_volume = NULL;
    }
    if (!before->throat_diffusion) forget_throat_shapes(renewed); // cylinders stay so
    places_free(&places);
    free_middles(&old);
    free(growth);
    free(was);
    free(is);
    return STATUS_OK;
}
