// SPDX-License-Identifier: GPL-3.0-or-later
// The void of each throat: over the faces around it, the pyramids from the grain
// centres on both sides over the triangle (face middle, node a, node b), less the balls
// of the grains (geometry/tetra_ball_volume.h). The sum over all throats is the void of
// the domain. The face middle is the mean over its rim,
//     middle = sum of length (a + b) / 2 over sides / sum of length,
// so that nodes in one place do not count twice. Volumes down to -1e-12 of the largest
// radius cubed are rounding and become 0.
#include "network/void_volume.h"

#include "basics/memory.h"
#include "geometry/tetra_ball_volume.h"
#include "network/throat_sides.h"

#include <stdlib.h>

struct vector face_middle(const struct network *network, int face)
{
    const int64_t begin = network->face_offset[face],
                  end = network->face_offset[face + 1];
    const struct vector origin = face_corner(network, begin);
    struct vector sum = {0}, from = {0};
    double rim = 0;
    for (int64_t k = begin; k < end; k++) {
        const struct vector to =
            subtract(face_corner(network, k + 1 < end ? k + 1 : begin), origin);
        const double length = distance(from, to);
        sum = add(sum, scale(length / 2, add(from, to)));
        rim += length;
        from = to;
    }
    return rim > 0 ? add(origin, scale(1 / rim, sum)) : origin;
}

// On both sides of the face where there is a grain; the loop runs counter-clockwise
// seen from the second.
static double void_beside(const struct network *network, int face, struct vector middle,
                          struct vector a, struct vector b)
{
    double volume = 0;
    for (int side = 0; side < 2; side++) {
        const int grain = network->face_particles[face][side];
        if (grain < 0 || is_auxiliary(&network->packing, grain)) continue;
        const struct vector centre =
            side ? second_grain(network, face) : network->packing.position[grain];
        const struct vector to_middle = subtract(middle, centre);
        const struct vector to_a = subtract(a, centre), to_b = subtract(b, centre);
        volume += tetrahedron_outside_ball(network->packing.radius[grain], to_middle,
                                           side ? to_b : to_a, side ? to_a : to_b);
    }
    return volume;
}

// The void of THROAT: over the faces around it, in their order.
static double void_of_throat(const struct network *network,
                             const struct throat_sides *sides,
                             const struct vector *middle, int throat)
{
    double volume = 0;
    for (int64_t k = sides->offset[throat]; k < sides->offset[throat + 1]; k++) {
        const struct throat_side side = throat_side(network, sides, throat, k);
        volume += void_beside(network, sides->face[k], middle[sides->face[k]],
                              side.forward ? side.first : side.second,
                              side.forward ? side.second : side.first);
    }
    return volume;
}

// Rounding may leave a throat between touching grains a little below nothing.
static enum status check_volumes(const struct network *network, double *volume,
                                 struct reason *reason)
{
    double largest = 0;
    for (int i = 0; i < network->packing.n_particle; i++)
        largest = fmax(largest, network->packing.radius[i]);
    for (int t = 0; t < network->n_throat; t++) {
        if (volume[t] < -1e-12 * largest * largest * largest)
            return refuse(reason, STATUS_BAD_DATA,
                          "throat %d would have a void of %g m3: a grain beside it has "
                          "its centre in another one",
                          t, volume[t]);
        volume[t] = fmax(0, volume[t]);
    }
    return STATUS_OK;
}

enum status find_void_volumes(struct network *network, struct reason *reason)
{
    struct throat_sides sides;
    enum status status = throat_sides_init(network, &sides, reason);
    if (status) return status;
    double *volume = NEW_ARRAY(double, network->n_throat);
    struct vector *middle = NEW_ARRAY(struct vector, network->n_face);
#pragma omp parallel for schedule(static)
    for (int face = 0; face < network->n_face; face++)
        middle[face] = face_middle(network, face);
#pragma omp parallel for schedule(static)
    for (int t = 0; t < network->n_throat; t++)
        volume[t] = void_of_throat(network, &sides, middle, t);
    free(middle);
    throat_sides_free(&sides);
    status = check_volumes(network, volume, reason);
    if (status) {
        free(volume);
        return status;
    }
    free(network->throat_volume);
    network->throat_volume = volume;
    return STATUS_OK;
}
