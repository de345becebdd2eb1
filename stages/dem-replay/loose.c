// SPDX-License-Identifier: GPL-3.0-or-later
// Loose fragments: those of the graph of intact bonds without a fixed grain. Each is
// copied to a packing of its own, and the net force and moment are removed there as
// inertia forces of a rigid motion (geometry/net_load.h); what remains is in
// equilibrium with itself. Places are those of now (packing plus displacement), since a
// fragment may have turned. In a box that repeats a fragment is put together from image
// to image along its bonds, and turns as any other, unless its bonds lead back to an
// image of itself: then it repeats along that axis as the box does. Moments of all
// fragments are about one point, the lower corner of the box, so that they may be
// added.
#include "loose.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct loose_grains loose_init(int n)
{
    return (struct loose_grains){.fragments = fragments_init(n),
                                 .is_loose = NEW_ARRAY(bool, n),
                                 .place = NEW_ARRAY(struct vector, n),
                                 .repeats = NEW_ARRAY(struct repeats, n)};
}

void loose_free(struct loose_grains *loose)
{
    fragments_free(&loose->fragments);
    free(loose->is_loose);
    free(loose->place);
    free(loose->repeats);
}

static void find_fragments_of(struct fragments *fragments,
                              const struct packing *packing, const uint8_t *held,
                              const uint8_t *intact)
{
    fragments_begin(fragments);
    for (int b = 0; b < packing->n_bond; b++)
        if (intact[b])
            fragments_join(fragments, packing->bond[b][0], packing->bond[b][1]);
    fragments_end(fragments, held, NULL);
}

// ---- fragments in a box that repeats ------------------------------------------------

// The grains that intact bonds join to each: of I, GRAIN[START[I]] and on.
struct bonded {
    int *start, *grain;
};

static struct bonded bonded_init(const struct packing *packing, const uint8_t *intact)
{
    struct bonded bonded = {NEW_ARRAY(int, packing->n_particle + 2),
                            NEW_ARRAY(int, 2 * packing->n_bond + 1)};
    int *end = bonded.start + 1;
    for (int b = 0; b < packing->n_bond; b++)
        for (int k = 0; intact[b] && k < 2; k++)
            end[packing->bond[b][k] + 1]++;
    for (int i = 0; i < packing->n_particle; i++)
        end[i + 1] += end[i];
    for (int b = 0; b < packing->n_bond; b++)
        for (int k = 0; intact[b] && k < 2; k++)
            bonded.grain[end[packing->bond[b][k]]++] = packing->bond[b][1 - k];
    return bonded;
}

// Whether two images of a grain, APART, are not the same one.
static void note_repeats(struct repeats *repeats, const struct packing *packing,
                         struct vector apart)
{
    for (int axis = 0; axis < 3; axis++) {
        const double edge =
            component(packing->upper, axis) - component(packing->lower, axis);
        if (packing->periodic[axis] && fabs(component(apart, axis)) > edge / 2)
            repeats->along[axis] = 1;
    }
}

// Puts the fragment of grain ROOT together. PATH (n) is for what has been reached.
static void put_together(struct loose_grains *loose, const struct packing *packing,
                         const struct bonded *bonded, int root, bool *seen, int *path)
{
    int n = 0;
    path[n++] = root;
    seen[root] = true;
    for (int k = 0; k < n; k++) {
        const int i = path[k];
        for (int b = bonded->start[i]; b < bonded->start[i + 1]; b++) {
            const int j = bonded->grain[b];
            const struct vector place =
                add(loose->place[i], nearest_image(packing, i, j));
            if (seen[j]) {
                note_repeats(&loose->repeats[root], packing,
                             subtract(place, loose->place[j]));
                continue;
            }
            loose->place[j] = place;
            seen[j] = true;
            path[n++] = j;
        }
    }
}

static void place_fragments(struct loose_grains *loose, const struct packing *packing,
                            const uint8_t *intact)
{
    const size_t n = (size_t)packing->n_particle;
    memcpy(loose->place, packing->position, n * sizeof *loose->place);
    memset(loose->repeats, 0, n * sizeof *loose->repeats);
    if (!is_periodic(packing)) return;
    struct bonded bonded = bonded_init(packing, intact);
    bool *seen = NEW_ARRAY(bool, n);
    int *path = NEW_ARRAY(int, n);
    for (int i = 0; i < packing->n_particle; i++)
        if (loose->is_loose[i] && !seen[i])
            put_together(loose, packing, &bonded, i, seen, path);
    free(bonded.start);
    free(bonded.grain);
    free(seen);
    free(path);
}

void find_loose(struct loose_grains *loose, const struct packing *packing,
                const uint8_t *held, const struct dem *dem)
{
    const struct fragments *fragments = &loose->fragments;
    uint8_t *intact = NEW_ARRAY(uint8_t, packing->n_bond);
    dem_bonds_intact(dem, intact);
    find_fragments_of(&loose->fragments, packing, held, intact);
    loose->n_loose = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        loose->is_loose[i] = !fragments->is_held[fragments->of[i]];
        loose->n_loose += loose->is_loose[i];
    }
    place_fragments(loose, packing, intact);
    free(intact);
}

// ---- relief -------------------------------------------------------------------------

// A fragment as a packing of its own: its grain k is GRAIN[k] of the whole packing.
struct part {
    struct packing packing; // positions and radii of its own, the box of the whole
    struct vector *displacement, *force; // (packing.n_particle)
    const int *grain;
};

// Loose grains in the order of their fragments, (n_loose); the caller frees it.
static int *sort_loose(const struct loose_grains *loose, int n)
{
    int *end = NEW_ARRAY(int, n + 1), *sorted = NEW_ARRAY(int, loose->n_loose + 1);
    for (int i = 0; i < n; i++)
        end[loose->fragments.of[i] + 1] += loose->is_loose[i];
    for (int i = 0; i < n; i++)
        end[i + 1] += end[i];
    for (int i = 0; i < n; i++)
        if (loose->is_loose[i]) sorted[end[loose->fragments.of[i]]++] = i;
    free(end);
    return sorted;
}

static void gather(struct part *part, const struct packing *whole,
                   const struct loose_grains *loose, const struct vector *displacement,
                   const struct vector *force)
{
    const int root = loose->fragments.of[part->grain[0]];
    memcpy(part->packing.periodic, loose->repeats[root].along,
           sizeof part->packing.periodic);
    for (int k = 0; k < part->packing.n_particle; k++) {
        const int i = part->grain[k];
        part->packing.position[k] = loose->place[i];
        part->packing.radius[k] = whole->radius[i];
        part->displacement[k] = displacement[i];
        part->force[k] = force[i];
    }
}

static struct net_load sum_of(struct net_load a, struct net_load b)
{
    return (struct net_load){add(a.force, b.force), add(a.moment, b.moment)};
}

struct net_load relieve_loose(const struct loose_grains *loose,
                              const struct packing *packing,
                              const struct vector *displacement, struct vector *force)
{
    const int n = loose->n_loose;
    struct part part = {.packing = *packing,
                        .displacement = NEW_ARRAY(struct vector, n + 1),
                        .force = NEW_ARRAY(struct vector, n + 1)};
    part.packing.position = NEW_ARRAY(struct vector, n + 1);
    part.packing.radius = NEW_ARRAY(double, n + 1);
    const struct moving_grains moved = {.displacement = part.displacement};
    int *sorted = sort_loose(loose, packing->n_particle);
    const int32_t *fragment = loose->fragments.of;
    struct net_load sum = {{0, 0, 0}, {0, 0, 0}};
    for (int first = 0, end; first < n; first = end) {
        for (end = first + 1; end < n; end++)
            if (fragment[sorted[end]] != fragment[sorted[first]]) break;
        part.grain = sorted + first;
        part.packing.n_particle = end - first;
        gather(&part, packing, loose, displacement, force);
        sum = sum_of(sum, take_off_net_load(&part.packing, NULL, &moved, part.force));
        for (int k = 0; k < end - first; k++)
            force[part.grain[k]] = part.force[k];
    }
    void *const owned[] = {part.displacement, part.force, part.packing.position,
                           part.packing.radius, sorted};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    return sum;
}
