// SPDX-License-Identifier: GPL-3.0-or-later
// The state, as named arrays. In them is what nothing else tells: how grains lie and
// move, the list of pairs with how they lay and their histories, and all that may have
// been changed since the start. What follows from that and from the setup is made anew.
//
// Forces of the last cycle are in it for who looks at them before the next one, and
// sums of losses pair by pair, as adding them up in another order would round
// otherwise.
#include "dem/engine.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- where the numbers are ----------------------------------------------------------

// WIDTH numbers in each of ROWS rows; LEAST and MOST are what they may be.
struct column {
    const char *name;
    enum dem_array_type type;
    int width;
    int64_t rows;
    void *base;
    size_t offset, stride; // bytes, from row to row or from group to group
    bool in_lanes;         // rows are the lanes of groups
    double least, most;
};

struct column_list {
    struct column column[64];
    int count;
};

// As the schemas have it: squares of what is larger would overflow.
static const double largest = 1e150, smallest = 1e-150;
static const double largest_count = 0x1p53;

size_t dem_number_size(enum dem_array_type type)
{
    switch (type) {
    case DEM_FLOAT64:
        return sizeof(double);
    case DEM_INT32:
        return sizeof(int32_t);
    case DEM_INT64:
        return sizeof(int64_t);
    default:
        return sizeof(uint8_t);
    }
}

static char *address(const struct column *c, int64_t row, int k)
{
    const size_t size = dem_number_size(c->type), at = (size_t)row;
    char *const begin = (char *)c->base + c->offset;
    if (!c->in_lanes) return begin + at * c->stride + (size_t)k * size;
    const size_t lane = at % PAIRS_IN_GROUP;
    return begin + at / PAIRS_IN_GROUP * c->stride +
           ((size_t)k * PAIRS_IN_GROUP + lane) * size;
}

static double value_at(enum dem_array_type type, const void *at)
{
    switch (type) {
    case DEM_FLOAT64:
        return *(const double *)at;
    case DEM_INT32:
        return *(const int32_t *)at;
    case DEM_INT64:
        return (double)*(const int64_t *)at;
    default:
        return *(const uint8_t *)at;
    }
}

static struct column *add_column(struct column_list *list, struct column column)
{
    list->column[list->count] = column;
    return &list->column[list->count++];
}

// ---- which there are ----------------------------------------------------------------

static void add_scalars(struct column_list *list, struct dem *dem)
{
    const struct {
        const char *name;
        enum dem_array_type type;
        int width;
        void *at;
        double least, most;
    } of[] = {{"cycle", DEM_INT64, 1, &dem->cycle, 0, largest_count},
              {"search_cycle", DEM_INT64, 1, &dem->search_cycle, 0, largest_count},
              {"searches_in_order", DEM_INT32, 1, &dem->searches_in_order, 0, 1e9},
              {"skin", DEM_FLOAT64, 1, &dem->skin, smallest, largest},
              {"travelled", DEM_FLOAT64, 1, &dem->travelled, 0, largest},
              {"closed_in", DEM_FLOAT64, 1, &dem->closed_in, 0, largest},
              {"box_lower", DEM_FLOAT64, 3, dem->box_lower, -largest, largest},
              {"box_upper", DEM_FLOAT64, 3, dem->box_upper, -largest, largest},
              {"gravity", DEM_FLOAT64, 3, &dem->gravity, -largest, largest},
              {"friction", DEM_FLOAT64, 1, dem->pair_friction, 0, largest},
              {"local_damping", DEM_FLOAT64, 1, &dem->local_damping, 0, 1},
              {"books", DEM_FLOAT64, 8, &dem->books, -largest, largest}};
    for (size_t k = 0; k < sizeof of / sizeof *of; k++)
        add_column(list, (struct column){.name = of[k].name,
                                         .type = of[k].type,
                                         .width = of[k].width,
                                         .rows = 1,
                                         .base = of[k].at,
                                         .least = of[k].least,
                                         .most = of[k].most});
}

// A member of the structs of an array.
struct where {
    void *base;
    size_t stride, offset;
};
#define OF(array, type, member)                                                        \
    ((struct where){array, sizeof(type), offsetof(type, member)})
#define WHOLE(array) ((struct where){array, sizeof *(array), 0})

static struct column *add_numbers(struct column_list *list, const char *name,
                                  struct where at, int width, int64_t rows)
{
    return add_column(list, (struct column){.name = name,
                                            .type = DEM_FLOAT64,
                                            .width = width,
                                            .rows = rows,
                                            .base = at.base,
                                            .offset = at.offset,
                                            .stride = at.stride,
                                            .least = -largest,
                                            .most = largest});
}

static struct column *add_integers(struct column_list *list, const char *name,
                                   enum dem_array_type type, struct where at,
                                   int64_t rows, double least, double most)
{
    struct column *column = add_numbers(list, name, at, 1, rows);
    column->type = type;
    column->least = least;
    column->most = most;
    return column;
}

static void add_grains(struct column_list *list, struct dem *dem)
{
    const int n = dem->n_particle;
    add_integers(list, "identity", DEM_INT32, WHOLE(dem->identity), n, 0, n - 1);
    add_numbers(list, "start", WHOLE(dem->start), 3, n);
    add_numbers(list, "displacement", OF(dem->place, struct place, displacement), 3, n);
    add_numbers(list, "radius", OF(dem->place, struct place, radius), 1, n)->least =
        smallest;
    add_numbers(list, "velocity", OF(dem->motion, struct motion, linear), 3, n);
    add_numbers(list, "spin", OF(dem->motion, struct motion, angular), 3, n);
    add_numbers(list, "mass", WHOLE(dem->mass), 1, n)->least = smallest;
    add_numbers(list, "weight", WHOLE(dem->weight), 1, n)->least = smallest;
    add_numbers(list, "mobility", WHOLE(dem->mobility), 2, n)->least = 0;
    add_numbers(list, "displacement_at_search", WHOLE(dem->place_at_search), 3, n);
    if (dem->applied) add_numbers(list, "applied_force", WHOLE(dem->applied), 3, n);
    if (dem->balance_energy)
        add_numbers(list, "grain_books", WHOLE(dem->grain_books), 2, n);
}

static void add_walls(struct column_list *list, struct dem *dem)
{
    const int n = dem->n_wall, n_pair = dem->n_wall_pair;
    struct rigid_wall *wall = dem->wall;
#define WALL(name, member, width)                                                      \
    add_numbers(list, name, OF(wall, struct rigid_wall, member), width, n)
    WALL("wall_asked_velocity", is.velocity, 3);
    WALL("wall_asked_spin", is.spin, 3);
    WALL("wall_servo_force", is.servo_force, 1);
    WALL("wall_displacement", displacement, 3);
    WALL("wall_displacement_at_search", displacement_at_search, 3);
    WALL("wall_velocity", velocity, 3);
    WALL("wall_spin", spin, 3);
    WALL("wall_force", force, 3);
    WALL("wall_moment", moment, 3);
    WALL("wall_resistance", resistance, 1);
#undef WALL
    struct wall_pair *pair = dem->wall_pair;
    add_integers(list, "wall_pair_particle", DEM_INT32,
                 OF(pair, struct wall_pair, particle), n_pair, 0, dem->n_particle - 1);
    add_integers(list, "wall_pair_wall", DEM_INT32, OF(pair, struct wall_pair, wall),
                 n_pair, 0, n - 1);
#define PAIR(name, member, width)                                                      \
    add_numbers(list, name, OF(pair, struct wall_pair, member), width, n_pair)
    PAIR("wall_pair_shear_force", shear_force, 3);
    PAIR("wall_pair_normal", normal, 3);
    PAIR("wall_pair_depth", depth, 1);
    PAIR("wall_pair_force", load, 3);
    PAIR("wall_pair_moment", moment, 3);
#undef PAIR
}

static void add_cracks(struct column_list *list, struct dem *dem)
{
    const int n = dem->n_crack;
#define CRACK(name, type, member, most)                                                \
    add_integers(list, name, type, OF(dem->crack, struct dem_crack, member), n, 0, most)
    CRACK("crack_bond", DEM_INT32, bond, dem->n_bond - 1);
    CRACK("crack_mode", DEM_UINT8, mode, DEM_CRACK_SHEAR);
    CRACK("crack_cycle", DEM_INT64, cycle, largest_count);
#undef CRACK
    add_numbers(list, "crack_position", OF(dem->crack, struct dem_crack, position), 3,
                n);
}

// A member of the groups of pairs; left out where the scene has no such groups.
static void add_lanes(struct column_list *list, const struct dem *dem, const char *name,
                      struct where at, int width)
{
    if (at.base) add_numbers(list, name, at, width, dem->pairs.n_pair)->in_lanes = true;
}

static void add_pairs(struct column_list *list, struct dem *dem)
{
    const struct pair_list *pairs = &dem->pairs;
    const int n = pairs->n_pair;
    add_integers(list, "pair_particle", DEM_INT32, WHOLE(pairs->particle), n, 0,
                 dem->n_particle - 1)
        ->width = 2;
    if (dem->n_bond > 0)
        add_integers(list, "pair_bond", DEM_INT32, WHOLE(pairs->bond), n, -1,
                     dem->n_bond - 1);
    add_integers(list, "group_idle", DEM_UINT8, WHOLE(pairs->idle), pairs->n_group, 0,
                 1);
#define LANES(name, groups, type, member, width)                                       \
    add_lanes(list, dem, name, OF(pairs->groups, type, member), width)
    LANES("pair_separation", group, struct pair_group, separation, 3);
    LANES("pair_distance", group, struct pair_group, distance, 1);
    LANES("pair_overlap", group, struct pair_group, overlap, 1);
    LANES("pair_force", load, struct load_group, force, 3);
    LANES("pair_first_moment", moment, struct moment_group, first, 3);
    LANES("pair_second_moment", moment, struct moment_group, second, 3);
    LANES("pair_shear_force", shear, struct shear_group, force, 3);
    LANES("bond_shear_force", bonds, struct bond_group, shear_force, 3);
    LANES("bond_bending", bonds, struct bond_group, bending, 3);
    LANES("bond_twist", bonds, struct bond_group, twist, 1);
    LANES("loss_dashpots", loss, struct loss_group, dashpots, 1);
    LANES("loss_slip", loss, struct loss_group, slip, 1);
    LANES("loss_broken", loss, struct loss_group, broken, 1);
    LANES("loss_bridges", loss, struct loss_group, bridges, 1);
    LANES("bridge_pull", liquid, struct liquid_group, pull, 1);
    LANES("bridge_volume", liquid, struct liquid_group, volume, 1);
    LANES("bridge_rupture", liquid, struct liquid_group, rupture, 1);
#undef LANES
}

static struct column_list list_columns(struct dem *dem)
{
    struct column_list list = {.count = 0};
    add_scalars(&list, dem);
    add_grains(&list, dem);
    add_walls(&list, dem);
    add_cracks(&list, dem);
    add_pairs(&list, dem);
    return list;
}

// ---- out ----------------------------------------------------------------------------

static struct dem_array new_array(const char *name, enum dem_array_type type,
                                  int64_t count)
{
    struct dem_array array = {.type = type, .count = count};
    snprintf(array.name, sizeof array.name, "%s", name);
    array.data = allocate((size_t)count, dem_number_size(type));
    return array;
}

static struct dem_array gather(const struct column *c)
{
    const size_t size = dem_number_size(c->type);
    struct dem_array array = new_array(c->name, c->type, c->rows * c->width);
    char *to = array.data;
    for (int64_t row = 0; row < c->rows; row++)
        for (int k = 0; k < c->width; k++, to += size)
            memcpy(to, address(c, row, k), size);
    return array;
}

static const char bonds_name[] = "bond_intact";

struct dem_array *dem_save(const struct dem *dem, int *count)
{
    // Only read through the list; it serves dem_restore too.
    const struct column_list list = list_columns((struct dem *)(uintptr_t)dem);
    struct dem_array *array = NEW_ARRAY(struct dem_array, list.count + 1);
    for (int k = 0; k < list.count; k++)
        array[k] = gather(&list.column[k]);
    array[list.count] = new_array(bonds_name, DEM_UINT8, dem->n_bond);
    dem_bonds_intact(dem, array[list.count].data);
    *count = list.count + 1;
    return array;
}

void dem_free_arrays(struct dem_array *array, int count)
{
    for (int k = 0; array && k < count; k++)
        free(array[k].data);
    free(array);
}

const struct dem_array *dem_find_array(const struct dem_array *array, int count,
                                       const char *name)
{
    for (int k = 0; k < count; k++)
        if (!strncmp(array[k].name, name, sizeof array[k].name)) return &array[k];
    return NULL;
}

enum status dem_check_array(const struct dem_array *array, const char *name,
                            enum dem_array_type type, int64_t count, double least,
                            double most, struct reason *reason)
{
    if (!array || array->type != type || array->count != count)
        return refuse(reason, STATUS_BAD_DATA,
                      "%s: must be %lld numbers of its type, as this scene has them",
                      name, (long long)count);
    for (int64_t k = 0; k < count; k++) {
        const char *at = (const char *)array->data + (size_t)k * dem_number_size(type);
        const double value = value_at(type, at);
        if (value >= least && value <= most) continue;
        return refuse(reason, STATUS_BAD_DATA,
                      "%s: number %lld: must be from %g to %g, got %g", name,
                      (long long)k, least, most, value);
    }
    return STATUS_OK;
}

// ---- in -----------------------------------------------------------------------------

struct saved {
    const struct dem_array *array;
    int count;
    struct reason *reason;
};

static const struct dem_array *find(const struct saved *saved, const char *name,
                                    enum dem_array_type type, int64_t count,
                                    double least, double most)
{
    const struct dem_array *array = dem_find_array(saved->array, saved->count, name);
    return dem_check_array(array, name, type, count, least, most, saved->reason) ==
                   STATUS_OK
               ? array
               : NULL;
}

// How many rows of WIDTH there are, or -1.
static int rows_of(const struct saved *saved, const char *name, int width)
{
    const struct dem_array *array = dem_find_array(saved->array, saved->count, name);
    if (array && array->count % width == 0 && array->count / width <= INT32_MAX / 4)
        return (int)(array->count / width);
    refuse(saved->reason, STATUS_BAD_DATA, "%s: is missing, or too long", name);
    return -1;
}

// Every grain once.
static enum status take_order(struct dem *dem, const struct saved *saved)
{
    const int n = dem->n_particle;
    const struct dem_array *array = find(saved, "identity", DEM_INT32, n, 0, n - 1);
    if (!array) return STATUS_BAD_DATA;
    const int32_t *identity = array->data;
    bool *seen = NEW_ARRAY(bool, n);
    int twice = -1;
    for (int i = 0; i < n; i++) {
        if (seen[identity[i]]) twice = identity[i];
        seen[identity[i]] = true;
    }
    free(seen);
    if (twice >= 0)
        return refuse(saved->reason, STATUS_BAD_DATA, "identity: grain %d comes twice",
                      twice);
    number_grains(dem, identity);
    return STATUS_OK;
}

static enum status take_broken(struct dem *dem, const struct saved *saved)
{
    const struct dem_array *array =
        find(saved, bonds_name, DEM_UINT8, dem->n_bond, 0, 1);
    if (!array) return STATUS_BAD_DATA;
    for (int b = 0; b < dem->n_bond; b++)
        if (!((const uint8_t *)array->data)[b])
            dem->bond_strength[DEM_CRACK_NORMAL][b] =
                dem->bond_strength[DEM_CRACK_SHEAR][b] = -1;
    return STATUS_OK;
}

// Sorted, each once, and with every bond where it belongs.
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
    const struct dem_array *pairs =
        find(saved, "pair_particle", DEM_INT32, 2 * (int64_t)n, 0, dem->n_particle - 1);
    if (!pairs) return STATUS_BAD_DATA;
    const struct dem_array *bonds = NULL;
    if (dem->n_bond > 0) {
        bonds = find(saved, "pair_bond", DEM_INT32, n, -1, dem->n_bond - 1);
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

static enum status make_room(struct dem *dem, const struct saved *saved)
{
    const int n_wall_pair = rows_of(saved, "wall_pair_particle", 1);
    const int n_crack = rows_of(saved, "crack_bond", 1);
    if (n_wall_pair < 0 || n_crack < 0) return STATUS_BAD_DATA;
    dem->wall_pair =
        reallocate(dem->wall_pair, (size_t)n_wall_pair + 1, sizeof *dem->wall_pair);
    dem->n_wall_pair = n_wall_pair;
    dem->n_crack = n_crack;
    dem->crack_capacity = n_crack + 1;
    dem->crack =
        reallocate(dem->crack, (size_t)dem->crack_capacity, sizeof *dem->crack);
    const bool pushed = dem_find_array(saved->array, saved->count, "applied_force");
    if (pushed && !dem->applied)
        dem->applied = NEW_ARRAY(struct vector, dem->n_particle);
    return STATUS_OK;
}

static enum status scatter(const struct column *c, const struct saved *saved)
{
    const struct dem_array *array =
        find(saved, c->name, c->type, c->rows * c->width, c->least, c->most);
    if (!array) return STATUS_BAD_DATA;
    const size_t size = dem_number_size(c->type);
    const char *from = array->data;
    for (int64_t row = 0; row < c->rows; row++)
        for (int k = 0; k < c->width; k++, from += size)
            memcpy(address(c, row, k), from, size);
    return STATUS_OK;
}

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

// What follows from all that.
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
    if (dem->n_particle > 0) dem->law = pair_law(dem, 0, 0);
    for (int p = 0; dem->pairs.own && p < dem->pairs.n_pair; p++)
        set_pair_law(dem, p);
    set_wall_laws(dem);
    list_walls_of_grains(dem);
    if (dem->liquid) count_bridges(dem);
    set_external(dem);
    compare_mobilities(dem);
}

enum status dem_restore(struct dem *dem, const struct dem_array *array, int count,
                        struct reason *reason)
{
    const struct saved saved = {array, count, reason};
    enum status status = take_order(dem, &saved);
    if (status == STATUS_OK) status = take_broken(dem, &saved);
    if (status == STATUS_OK) status = take_list(dem, &saved);
    if (status == STATUS_OK) status = make_room(dem, &saved);
    if (status == STATUS_OK) status = take_numbers(dem, &saved);
    if (status == STATUS_OK) status = check_rest(dem, reason);
    if (status == STATUS_OK) derive(dem);
    return status;
}
