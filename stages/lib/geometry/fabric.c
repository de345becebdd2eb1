// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts, coordination, rattlers and the fabric tensor
//     F_kl = mean over contacts of n_k n_l,
// with n the unit vector between the centres of two grains; with D dimensions (2 for a
// layer, in x and z)
//     deviator = sqrt(D / (D - 1) sum_kl (F_kl - delta_kl / D)^2),
//     density_b = share of contacts in class b over that of an isotropic packing,
//     cos(b w) - cos((b + 1) w), w = pi / (2 count); in a layer 1 / count.
// Rattlers are found by removing grains with fewer contacts than `least` until none is
// left, as each removal may make another one loose.
#include "geometry/fabric.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"

#include <stdlib.h>

struct contacts find_contacts(const struct packing *packing, double gap)
{
    struct contacts contacts;
    int n = 0, all;
    int32_t(*pair)[2] = neighbour_pairs(packing, gap, &all);
    for (int k = 0; k < all; k++) {
        const int32_t i = pair[k][0], j = pair[k][1];
        if (is_auxiliary(packing, i) || is_auxiliary(packing, j)) continue;
        pair[n][0] = i;
        pair[n++][1] = j;
    }
    contacts.count = n;
    contacts.pair = (const int32_t(*)[2])pair;
    return contacts;
}

void bond_contacts(struct packing *packing, const struct contacts *contacts)
{
    free(packing->bond);
    free(packing->bond_strength);
    packing->bond_strength = NULL;
    packing->n_bond = contacts->count;
    packing->bond =
        duplicate(contacts->pair, (size_t)contacts->count, sizeof *packing->bond);
}

static bool touches_body(const struct packing *packing, int k, int grain, double gap)
{
    const struct vector at = packing->position[grain];
    const struct body body = body_near(packing, k, at);
    return distance(at, body_nearest(&body, at)) <= packing->radius[grain] * (1 + gap);
}

int *wall_contacts(const struct packing *packing, double gap)
{
    const bool flat = packing_is_flat(packing);
    int *walls = NEW_ARRAY(int, packing->n_particle);
    for (int axis = 0; axis < 3; axis++) {
        if (packing->periodic[axis] || (axis == 1 && flat)) continue;
        if (packing_is_round_across(packing, axis)) continue;
        const double low = component(packing->lower, axis);
        const double high = component(packing->upper, axis);
        for (int i = 0; i < packing->n_particle; i++) {
            const double at = component(packing->position[i], axis);
            const double reach = packing->radius[i] * (1 + gap);
            walls[i] += (at - low <= reach) + (high - at <= reach);
        }
    }
    for (int k = 0; k < packing->n_body; k++)
        for (int i = 0; i < packing->n_particle; i++)
            walls[i] += touches_body(packing, k, i, gap);
    return walls;
}

int *grain_contacts(const struct packing *packing, const struct contacts *contacts)
{
    int *count = NEW_ARRAY(int, packing->n_particle);
    for (int k = 0; k < contacts->count; k++) {
        count[contacts->pair[k][0]]++;
        count[contacts->pair[k][1]]++;
    }
    return count;
}

// ---- rattlers -----------------------------------------------------------------------

// The neighbours of each grain, one after another.
struct neighbours {
    int *offset; // (n_particle + 1)
    int *grain;
};

static struct neighbours list_neighbours(const struct packing *packing,
                                         const struct contacts *contacts)
{
    const int n = packing->n_particle;
    struct neighbours list = {NEW_ARRAY(int, n + 1),
                              NEW_ARRAY(int, 2 * (size_t)contacts->count)};
    int *count = grain_contacts(packing, contacts);
    for (int i = 0; i < n; i++)
        list.offset[i + 1] = list.offset[i] + count[i];
    for (int k = 0; k < contacts->count; k++)
        for (int side = 0; side < 2; side++) {
            const int i = contacts->pair[k][side], j = contacts->pair[k][1 - side];
            list.grain[list.offset[i + 1] - count[i]--] = j;
        }
    free(count);
    return list;
}

int least_contacts(const struct packing *packing, bool rubs)
{
    return rubs ? 2 : packing_is_flat(packing) ? 3 : 4;
}

// A grain that is loose leaves its neighbours, which may be loose then.
uint8_t *find_rattlers(const struct packing *packing, const struct contacts *contacts,
                       const int *walls, int least)
{
    const int n = packing->n_particle;
    struct neighbours list = list_neighbours(packing, contacts);
    uint8_t *rattler = NEW_ARRAY(uint8_t, n);
    int *support = grain_contacts(packing, contacts), *loose = NEW_ARRAY(int, n);
    int found = 0;
    for (int i = 0; i < n; i++) {
        support[i] += walls[i];
        rattler[i] = support[i] < least;
        if (rattler[i]) loose[found++] = i;
    }
    for (int k = 0; k < found; k++)
        for (int at = list.offset[loose[k]]; at < list.offset[loose[k] + 1]; at++) {
            const int j = list.grain[at];
            if (rattler[j] || --support[j] >= least) continue;
            rattler[j] = 1;
            loose[found++] = j;
        }
    free(list.offset);
    free(list.grain);
    free(support);
    free(loose);
    return rattler;
}

// ---- directions ---------------------------------------------------------------------

// Unit vector between the grains of contact K; false when they coincide.
static bool direction_of(const struct packing *packing, const struct contacts *contacts,
                         int k, struct vector *direction)
{
    const struct vector apart =
        nearest_image(packing, contacts->pair[k][0], contacts->pair[k][1]);
    const double distance = norm(apart);
    if (!(distance > 0)) return false;
    *direction = scale(1 / distance, apart);
    return true;
}

bool fabric_tensor(const struct packing *packing, const struct contacts *contacts,
                   double fabric[9])
{
    int count = 0;
    for (int c = 0; c < 9; c++)
        fabric[c] = 0;
    for (int k = 0; k < contacts->count; k++) {
        struct vector n;
        if (!direction_of(packing, contacts, k, &n)) continue;
        for (int c = 0; c < 9; c++)
            fabric[c] += component(n, c / 3) * component(n, c % 3);
        count++;
    }
    for (int c = 0; c < 9 && count; c++)
        fabric[c] /= count;
    return count > 0;
}

double fabric_deviator(const double fabric[9], bool flat)
{
    const int dimensions = flat ? 2 : 3;
    double sum = 0;
    for (int c = 0; c < 9; c++) {
        if (flat && (c / 3 == 1 || c % 3 == 1)) continue;
        const double deviation = fabric[c] - (c % 4 ? 0 : 1.0 / dimensions);
        sum += deviation * deviation;
    }
    return sqrt(sum * dimensions / (dimensions - 1));
}

void contact_inclination(const struct packing *packing, const struct contacts *contacts,
                         int count, double *density)
{
    const bool flat = packing_is_flat(packing);
    const double width = M_PI_2 / count;
    int total = 0;
    for (int b = 0; b < count; b++)
        density[b] = 0;
    for (int k = 0; k < contacts->count; k++) {
        struct vector n;
        if (!direction_of(packing, contacts, k, &n)) continue;
        const int b = (int)(atan2(hypot(n.x, n.y), fabs(n.z)) / width);
        density[b < count ? b : count - 1]++;
        total++;
    }
    for (int b = 0; b < count && total; b++) {
        const double isotropic =
            flat ? 1.0 / count : cos(b * width) - cos((b + 1) * width);
        density[b] /= total * isotropic;
    }
}
