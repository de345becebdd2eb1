// SPDX-License-Identifier: GPL-3.0-or-later
// The state as named arrays, written and read back with checks. What follows from the
// state and the setup is computed again: coefficients, inverse distances, largest
// radii.
//
// A run that is restored goes on to the same bytes as one that never stopped. So the
// state has all that rounding depends on: the order of grains (`identity`) and pairs,
// the skins, and the travel since the last search.
#include "dem/state_columns.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- out ----------------------------------------------------------------------------

// Number by number, since lanes of a column do not lie together.
static struct named_array gather(const struct column *c)
{
    const size_t size = number_size(c->type);
    struct named_array array = named_array_init(c->name, c->type, c->rows * c->width);
    char *to = array.data;
    for (int64_t row = 0; row < c->rows; row++)
        for (int k = 0; k < c->width; k++, to += size)
            memcpy(to, column_address(c, row, k), size);
    return array;
}

static const char bonds_name[] = "bond_intact";

// Which bonds are intact is no column: strengths are in two arrays and -1 says it.
struct named_array *dem_save(const struct dem *dem, int *count)
{
    // Only read through the list; it serves dem_restore too.
    const struct column_list list = list_columns((struct dem *)(uintptr_t)dem);
    struct named_array *array = NEW_ARRAY(struct named_array, list.count + 1);
    for (int k = 0; k < list.count; k++)
        array[k] = gather(&list.column[k]);
    array[list.count] = named_array_init(bonds_name, ARRAY_UINT8, dem->n_bond);
    dem_bonds_intact(dem, array[list.count].data);
    *count = list.count + 1;
    return array;
}

// ---- in -----------------------------------------------------------------------------

struct saved {
    const struct named_array *array;
    int count;
    struct reason *reason;
};

// NULL with the reason where it is missing, of another type or length, or out of range.
static const struct named_array *find(const struct saved *saved, const char *name,
                                      enum array_type type, int64_t count, double least,
                                      double most)
{
    const struct named_array *array = find_array(saved->array, saved->count, name);
    return check_array(array, name, type, count, least, most, saved->reason) ==
                   STATUS_OK
               ? array
               : NULL;
}

// Number of rows of WIDTH, or -1.
static int rows_of(const struct saved *saved, const char *name, int width)
{
    const struct named_array *array = find_array(saved->array, saved->count, name);
    if (array && array->count % width == 0 && array->count / width <= INT32_MAX / 4)
        return (int)(array->count / width);
    refuse(saved->reason, STATUS_BAD_DATA, "%s: is missing, or too long", name);
    return -1;
}

// Takes the order of grains, in which each must occur once.
static enum status take_order(struct dem *dem, const struct saved *saved)
{
    const int n = dem->n_particle;
    const struct named_array *array = find(saved, "identity", ARRAY_INT32, n, 0, n - 1);
    if (!array) return STATUS_BAD_DATA;
    const int32_t *id = array->data;
    bool *seen = NEW_ARRAY(bool, n);
    int twice = -1;
    for (int i = 0; i < n; i++) {
        if (seen[id[i]]) twice = id[i];
        seen[id[i]] = true;
    }
    free(seen);
    if (twice >= 0)
        return refuse(saved->reason, STATUS_BAD_DATA, "identity: grain %d comes twice",
                      twice);
    set_grain_order(dem, id);
    return STATUS_OK;
}

// Before the list of pairs is made, because that copies strengths into its groups.
static enum status take_broken(struct dem *dem, const struct saved *saved)
{
    const struct named_array *array =
        find(saved, bonds_name, ARRAY_UINT8, dem->n_bond, 0, 1);
    if (!array) return STATUS_BAD_DATA;
    for (int b = 0; b < dem->n_bond; b++)
        if (!((const uint8_t *)array->data)[b])
            dem->bond_strength[DEM_CRACK_NORMAL][b] =
                dem->bond_strength[DEM_CRACK_SHEAR][b] = -1;
    return STATUS_OK;
}

// Checks that pairs are sorted, each once, with every bond between its grains. The
// kernel trusts the order: grains of a group follow each other, and a grain's last pair
// tells when it can move.
static enum status check_list(const struct dem *dem, int n,
                              const int32_t (*particle)[2], const int32_t *bond,
                              struct reason *reason)
{
    int n_bonded = 0;
    for (int p = 0; p < n; p++) {
        const bool ordered =
            particle[p][0] < particle[p][1] &&
            (p == 0 || compare_pairs(particle[p - 1], particle[p]) < 0);
        if (!ordered)
            return refuse(reason, STATUS_BAD_DATA,
                          "pair_particle: row %d: must come in order", p);
        if (!bond || bond[p] < 0) continue;
        n_bonded++;
        if (compare_pairs(dem->bond_particle[bond[p]], particle[p]))
            return refuse(reason, STATUS_BAD_DATA,
                          "pair_bond: row %d: bond %d joins other grains", p, bond[p]);
    }
    if (n_bonded == dem->n_bond) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA, "pair_bond: must name %d bonds, names %d",
                  dem->n_bond, n_bonded);
}

static enum status take_list(struct dem *dem, const struct saved *saved)
{
    const int n = rows_of(saved, "pair_particle", 2);
    if (n < 0) return STATUS_BAD_DATA;
    const struct named_array *pairs = find(saved, "pair_particle", ARRAY_INT32,
                                           2 * (int64_t)n, 0, dem->n_particle - 1);
    if (!pairs) return STATUS_BAD_DATA;
    const struct named_array *bonds = NULL;
    if (dem->n_bond > 0) {
        bonds = find(saved, "pair_bond", ARRAY_INT32, n, -1, dem->n_bond - 1);
        if (!bonds) return STATUS_BAD_DATA;
    }
    const int32_t *bond = bonds ? bonds->data : NULL;
    const enum status status = check_list(dem, n, pairs->data, bond, saved->reason);
    if (status != STATUS_OK) return status;
    dem->pairs.n_pair = 0; // those of the start have no history worth keeping
    take_pairs(dem, n, duplicate(pairs->data, (size_t)n, 2 * sizeof *bond),
               bond ? duplicate(bond, (size_t)n, sizeof *bond) : NULL);
    return STATUS_OK;
}

// Arrays whose lengths the setup does not know.
static enum status make_room(struct dem *dem, const struct saved *saved)
{
    const int n_wall_pair = rows_of(saved, "wall_pair_particle", 1);
    const int n_crack = rows_of(saved, "crack_bond", 1);
    if (n_wall_pair < 0 || n_crack < 0) return STATUS_BAD_DATA;
    free(dem->wall_pair);
    dem->wall_pair = allocate((size_t)n_wall_pair + 1, sizeof *dem->wall_pair);
    dem->n_wall_pair = n_wall_pair;
    dem->n_crack = n_crack;
    dem->crack_capacity = n_crack + 1;
    dem->crack =
        reallocate(dem->crack, (size_t)dem->crack_capacity, sizeof *dem->crack);
    dem->step_was_shortened = find_array(saved->array, saved->count, "time_step");
    const bool pushed = find_array(saved->array, saved->count, "applied_force");
    if (pushed && !dem->applied)
        dem->applied = NEW_ARRAY(struct vector, dem->n_particle);
    const bool evened = find_array(saved->array, saved->count, "inertia_factor");
    if (evened && !dem->inertia_factor)
        dem->inertia_factor = NEW_ARRAY(double, dem->n_particle);
    return STATUS_OK;
}

// The reverse of gather.
static enum status scatter(const struct column *c, const struct saved *saved)
{
    const struct named_array *array =
        find(saved, c->name, c->type, c->rows * c->width, c->least, c->most);
    if (!array) return STATUS_BAD_DATA;
    const size_t size = number_size(c->type);
    const char *from = array->data;
    for (int64_t row = 0; row < c->rows; row++)
        for (int k = 0; k < c->width; k++, from += size)
            memcpy(column_address(c, row, k), from, size);
    return STATUS_OK;
}

// Neither more nor fewer arrays: a file of another scene would otherwise pass in part.
static enum status take_numbers(struct dem *dem, const struct saved *saved)
{
    const struct column_list list = list_columns(dem);
    if (saved->count != list.count + 1)
        return refuse(saved->reason, STATUS_BAD_DATA,
                      "%d arrays, but this scene has %d", saved->count, list.count + 1);
    for (int k = 0; k < list.count; k++) {
        const enum status status = scatter(&list.column[k], saved);
        if (status != STATUS_OK) return status;
    }
    return STATUS_OK;
}

static enum status check_rest(const struct dem *dem, struct reason *reason)
{
    for (int k = 1; k < dem->n_wall_pair; k++) {
        const struct wall_pair *a = &dem->wall_pair[k - 1], *b = a + 1;
        if (a->particle < b->particle ||
            (a->particle == b->particle && a->wall < b->wall))
            continue;
        return refuse(reason, STATUS_BAD_DATA,
                      "wall_pair_particle: number %d: must come in order", k);
    }
    for (int axis = 0; axis < 3; axis++)
        if (!(dem->box_lower[axis] < dem->box_upper[axis]))
            return refuse(reason, STATUS_BAD_DATA,
                          "box_lower: must be below box_upper along %c", "xyz"[axis]);
    return STATUS_OK;
}

// Takes a time step that the kept run had adapted, or had shortened, but only if this
// run chooses its step too and, unless adapted, it is shorter.
static void take_time_step(struct dem *dem, double chosen)
{
    if (!dem->step_was_shortened) return;
    const bool stays =
        dem->step_is_adapted || (dem->step_is_automatic && dem->time_step < chosen);
    dem->step_was_shortened = stays;
    if (stays)
        dem->time_step_limit = dem->time_step / dem->automatic_share;
    else
        dem->time_step = chosen;
}

// Computes what follows from the state.
static void derive(struct dem *dem)
{
    dem->largest_radius = 0;
    dem->smallest_radius = INFINITY;
    for (int i = 0; i < dem->n_particle; i++) {
        dem->largest_radius = fmax(dem->largest_radius, dem->place[i].radius);
        dem->smallest_radius = fmin(dem->smallest_radius, dem->place[i].radius);
    }
    for (int axis = 0; axis < 3; axis++)
        if (dem->period[axis] > 0)
            dem->period[axis] = dem->box_upper[axis] - dem->box_lower[axis];
    if (dem->n_particle > 0) dem->law = common_law(dem);
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        struct pair_group *group = &dem->pairs.group[p / PAIRS_IN_GROUP];
        const int lane = p % PAIRS_IN_GROUP;
        group->inverse_distance[lane] = 1 / group->distance[lane];
        if (dem->pairs.laws) set_pair_law(dem, p);
        if (dem->pairs.rolling)
            set_pair_rolling(dem, p, law_of_pair(dem, p).normal_stiffness);
    }
    set_wall_laws(dem);
    list_walls_of_grains(dem);
    if (dem->liquid) count_bridges(dem);
    set_external(dem);
    set_equal_mobility(dem);
}

// In this order because each needs the one before: order of grains, bonds, pairs,
// lengths, numbers.
enum status dem_restore(struct dem *dem, const struct named_array *array, int count,
                        struct reason *reason)
{
    const struct saved saved = {array, count, reason};
    const double chosen = dem->time_step;
    enum status status = take_order(dem, &saved);
    if (status == STATUS_OK) status = take_broken(dem, &saved);
    if (status == STATUS_OK) status = take_list(dem, &saved);
    if (status == STATUS_OK) status = make_room(dem, &saved);
    if (status == STATUS_OK) status = take_numbers(dem, &saved);
    if (status == STATUS_OK) status = check_rest(dem, reason);
    if (status == STATUS_OK) take_time_step(dem, chosen);
    if (status == STATUS_OK) derive(dem);
    return status;
}
