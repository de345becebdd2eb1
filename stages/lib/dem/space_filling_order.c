// SPDX-License-Identifier: GPL-3.0-or-later
// Grains numbered along Hilbert's curve, so that neighbours in space are neighbours in
// memory. Small scenes fit in the cache in any order and keep the one they came in. In
// order: arrays of grains moved; pairs, walls and bonds relabelled, with their
// histories. A pair whose grains change places has its history turned round
// (carry_over).
#include "dem/engine.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"
#include "geometry/space_filling_curve.h"

#include <stdlib.h>
#include <string.h>

enum { LEAST_TO_ORDER = 4096 };

// The order of the grains where they are now.
static int32_t *order_now(const struct dem *dem)
{
    struct vector *place = NEW_ARRAY(struct vector, dem->n_particle);
    for (int i = 0; i < dem->n_particle; i++)
        place[i] = position_now(dem, i);
    int32_t *order = order_along_curve(dem->n_particle, place);
    free(place);
    return order;
}

// ARRAY[k] becomes what ARRAY[order[k]] was.
static void reorder(void *array, size_t size, const int32_t *order, int n)
{
    if (!array) return;
    char *old = duplicate(array, (size_t)n, size), *new = array;
    for (int k = 0; k < n; k++)
        memcpy(new + (size_t)k *size, old + (size_t)order[k] * size, size);
    free(old);
}
#define REORDER(array) reorder(array, sizeof *(array), order, dem->n_particle)

static void reorder_grains(struct dem *dem, const int32_t *order)
{
    REORDER(dem->id);
    REORDER(dem->start);
    REORDER(dem->place);
    const size_t each = dem->motion_stride * sizeof *dem->velocity;
    reorder(dem->velocity, each, order,
            dem->n_particle); // and spins, if they lie between
    if (dem->motion_stride == 4) reorder(dem->spin, each, order, dem->n_particle);
    REORDER(dem->external);
    REORDER(dem->applied);
    REORDER(dem->mobility);
    REORDER(dem->mass);
    if (dem->inertia_factor) REORDER(dem->inertia_factor);
    REORDER(dem->weight);
    REORDER(dem->material_of);
    REORDER(dem->group_of);
    REORDER(dem->lever);
    REORDER(dem->place_at_search);
    REORDER(dem->half_skin);
    REORDER(dem->grain_ledger);
    for (int k = 0; k < dem->n_particle; k++)
        dem->index[dem->id[k]] = k;
}

// Sets PAIR to the new indices of its grains, lower first; returns whether they changed
// places.
static bool relabel(int32_t pair[2], const int32_t *new_number)
{
    const int32_t a = new_number[pair[0]], b = new_number[pair[1]];
    pair[0] = a < b ? a : b;
    pair[1] = a < b ? b : a;
    return a > b;
}

struct moved_pair {
    int32_t particle[2]; // new numbers
    int32_t from;        // pair in the old list
    bool swapped;
};

// Histories of all pairs in their new order. Rows and laws are left to the search that
// follows.
static void reorder_pairs(struct dem *dem, const int32_t *new_number)
{
    const int n = dem->pairs.n_pair;
    struct moved_pair *moved = NEW_ARRAY(struct moved_pair, n);
    for (int p = 0; p < n; p++) {
        memcpy(moved[p].particle, dem->pairs.particle[p], sizeof moved[p].particle);
        moved[p].swapped = relabel(moved[p].particle, new_number);
        moved[p].from = p;
    }
    qsort(moved, (size_t)n, sizeof *moved, compare_pairs); // by the two grains
    struct pair_list old = dem->pairs;
    int32_t(*particle)[2] = allocate((size_t)n, sizeof *particle);
    int32_t *bond = old.bond ? NEW_ARRAY(int32_t, n) : NULL;
    for (int p = 0; p < n; p++) {
        memcpy(particle[p], moved[p].particle, sizeof *particle);
        if (bond) bond[p] = old.bond[moved[p].from];
    }
    new_pairs(dem, n, particle, bond);
    for (int p = 0; p < n; p++)
        carry_over(&dem->pairs, p, &old, moved[p].from, moved[p].swapped);
    give_back_pairs(dem, &old);
    free(moved);
}

static int by_wall(const void *a, const void *b)
{
    const struct wall_pair *p = a, *q = b;
    const int order = (p->particle > q->particle) - (p->particle < q->particle);
    return order ? order : (p->wall > q->wall) - (p->wall < q->wall);
}

static void renumber(struct dem *dem, const int32_t *order)
{
    int32_t *new_number = NEW_ARRAY(int32_t, dem->n_particle);
    for (int k = 0; k < dem->n_particle; k++)
        new_number[order[k]] = k;
    reorder_grains(dem, order);
    for (int b = 0; b < dem->n_bond; b++)
        relabel(dem->bond_particle[b], new_number);
    for (int k = 0; k < dem->n_wall_pair; k++)
        dem->wall_pair[k].particle = new_number[dem->wall_pair[k].particle];
    if (dem->n_wall_pair > 0)
        qsort(dem->wall_pair, (size_t)dem->n_wall_pair, sizeof *dem->wall_pair,
              by_wall);
    reorder_pairs(dem, new_number);
    free(new_number);
}

void renumber_grains(struct dem *dem)
{
    dem->searches_in_order = 0;
    if (dem->n_particle < LEAST_TO_ORDER) return;
    close_pair_ledger(dem);
    int32_t *order = order_now(dem);
    renumber(dem, order);
    free(order);
}

void set_grain_order(struct dem *dem, const int32_t *id)
{
    int32_t *order = NEW_ARRAY(int32_t, dem->n_particle);
    for (int k = 0; k < dem->n_particle; k++)
        order[k] = dem->index[id[k]];
    renumber(dem, order);
    free(order);
}
