// SPDX-License-Identifier: GPL-3.0-or-later
// The list of all columns of the state, with type, shape, place in memory and range.
// Both saving and restoring go through it (restart.c), so the two cannot differ. Names
// are those in checkpoint files: they stay when a member is renamed.
//
// A column points at numbers where they lie: rows of an array, a member of structs, or
// a lane of groups, of which the address of number k in row r is
//
//     base + offset + r stride + k size                          rows
//     base + offset + (r / 8) stride + (8 k + r % 8) size        lanes
//
// Ranges are those outside of which a state cannot be one, so a damaged file is refused
// before it is used. They need not be tight.
#include "dem/state_columns.h"

// The range of the schemas: squares of larger numbers would overflow.
static const double LARGEST = 1e150, SMALLEST = 1e-150;
static const double LARGEST_COUNT = 0x1p53;

char *column_address(const struct column *c, int64_t row, int k)
{
    const size_t size = number_size(c->type), at = (size_t)row;
    char *const begin = (char *)c->base + c->offset;
    if (!c->in_lanes) return begin + at * c->stride + (size_t)k * size;
    const size_t lane = at % PAIRS_IN_GROUP;
    return begin + at / PAIRS_IN_GROUP * c->stride +
           ((size_t)k * PAIRS_IN_GROUP + lane) * size;
}

// Returned, so that callers may narrow its range.
static struct column *add_column(struct column_list *list, struct column column)
{
    list->column[list->count] = column;
    return &list->column[list->count++];
}

// Only of runs that shortened their step: others choose the same one again.
static void add_time_step(struct column_list *list, struct dem *dem)
{
    if (!dem->step_was_shortened) return;
    add_column(list, (struct column){.name = "time_step",
                                     .type = ARRAY_FLOAT64,
                                     .width = 1,
                                     .rows = 1,
                                     .base = &dem->time_step,
                                     .least = SMALLEST,
                                     .most = LARGEST});
    add_column(list, (struct column){.name = "time_before",
                                     .type = ARRAY_FLOAT64,
                                     .width = 1,
                                     .rows = 1,
                                     .base = &dem->time_before,
                                     .most = LARGEST});
    add_column(list, (struct column){.name = "step_since",
                                     .type = ARRAY_INT64,
                                     .width = 1,
                                     .rows = 1,
                                     .base = &dem->step_since,
                                     .most = LARGEST_COUNT});
}

// Gravity, friction and damping are state, because callers may change them during a
// run.
static void add_scalars(struct column_list *list, struct dem *dem)
{
    const struct {
        const char *name;
        enum array_type type;
        int width;
        void *at;
        double least, most;
    } of[] = {{"cycle", ARRAY_INT64, 1, &dem->cycle, 0, LARGEST_COUNT},
              {"search_cycle", ARRAY_INT64, 1, &dem->search_cycle, 0, LARGEST_COUNT},
              {"searches_in_order", ARRAY_INT32, 1, &dem->searches_in_order, 0, 1e9},
              {"skin", ARRAY_FLOAT64, 1, &dem->skin, SMALLEST, LARGEST},
              {"horizon", ARRAY_FLOAT64, 1, &dem->horizon, 0, LARGEST_COUNT},
              {"mean_skin", ARRAY_FLOAT64, 1, &dem->mean_skin, SMALLEST, LARGEST},
              {"used", ARRAY_FLOAT64, 1, &dem->used, 0, LARGEST},
              {"closed_in", ARRAY_FLOAT64, 1, &dem->closed_in, 0, LARGEST},
              {"box_lower", ARRAY_FLOAT64, 3, dem->box_lower, -LARGEST, LARGEST},
              {"box_upper", ARRAY_FLOAT64, 3, dem->box_upper, -LARGEST, LARGEST},
              {"gravity", ARRAY_FLOAT64, 3, &dem->gravity, -LARGEST, LARGEST},
              {"friction", ARRAY_FLOAT64, 1, dem->pair_friction, 0, LARGEST},
              {"local_damping", ARRAY_FLOAT64, 1, &dem->local_damping, 0, 1},
              {"books", ARRAY_FLOAT64, 8, &dem->energy_ledger, -LARGEST, LARGEST}};
    for (size_t k = 0; k < sizeof of / sizeof *of; k++)
        add_column(list, (struct column){.name = of[k].name,
                                         .type = of[k].type,
                                         .width = of[k].width,
                                         .rows = 1,
                                         .base = of[k].at,
                                         .least = of[k].least,
                                         .most = of[k].most});
}

// A member of the structs of an array. Where a member lies: its array, the bytes from
// row to row, and those to the member.
struct where {
    void *base;
    size_t stride, offset;
};
#define OF(array, type, member)                                                        \
    ((struct where){array, sizeof(type), offsetof(type, member)})
#define WHOLE(array) ((struct where){array, sizeof *(array), 0})
#define RECORDS(array, each) ((struct where){array, (each) * sizeof *(array), 0})

static struct column *add_numbers(struct column_list *list, const char *name,
                                  struct where at, int width, int64_t rows)
{
    return add_column(list, (struct column){.name = name,
                                            .type = ARRAY_FLOAT64,
                                            .width = width,
                                            .rows = rows,
                                            .base = at.base,
                                            .offset = at.offset,
                                            .stride = at.stride,
                                            .least = -LARGEST,
                                            .most = LARGEST});
}

static struct column *add_integers(struct column_list *list, const char *name,
                                   enum array_type type, struct where at, int64_t rows,
                                   double least, double most)
{
    struct column *column = add_numbers(list, name, at, 1, rows);
    column->type = type;
    column->least = least;
    column->most = most;
    return column;
}

// The motion of grains is kept whole, driven ones included. `identity` gives the order,
// which fixes that of all sums.
static void add_grains(struct column_list *list, struct dem *dem)
{
    const int n = dem->n_particle;
    add_integers(list, "identity", ARRAY_INT32, WHOLE(dem->id), n, 0, n - 1);
    add_numbers(list, "start", WHOLE(dem->start), 3, n);
    add_numbers(list, "displacement", OF(dem->place, struct place, displacement), 3, n);
    add_numbers(list, "radius", OF(dem->place, struct place, radius), 1, n)->least =
        SMALLEST;
    add_numbers(list, "velocity", RECORDS(dem->velocity, dem->motion_stride), 3, n);
    add_numbers(list, "spin", RECORDS(dem->spin, dem->motion_stride), 3, n);
    add_numbers(list, "mass", WHOLE(dem->mass), 1, n)->least = SMALLEST;
    add_numbers(list, "weight", WHOLE(dem->weight), 1, n)->least = SMALLEST;
    if (dem->inertia_factor)
        add_numbers(list, "inertia_factor", WHOLE(dem->inertia_factor), 1, n)->least =
            1;
    add_numbers(list, "mobility", WHOLE(dem->mobility), 2, n)->least = 0;
    add_numbers(list, "displacement_at_search", WHOLE(dem->place_at_search), 3, n);
    add_numbers(list, "half_skin", WHOLE(dem->half_skin), 1, n)->least = SMALLEST;
    if (dem->applied) add_numbers(list, "applied_force", WHOLE(dem->applied), 3, n);
    if (dem->shrinkage) add_numbers(list, "shrinkage", WHOLE(dem->shrinkage), 1, n);
    if (dem->balance_energy)
        add_numbers(list, "grain_books", WHOLE(dem->grain_ledger), 2, n);
}

// Velocities as asked for and as they are, since a servo has its own. Rows of pairs are
// kept with their last loads: what is looked at after a restart must be there.
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
    if (dem->balance_energy) WALL("wall_work", work, 1);
#undef WALL
    struct wall_pair *pair = dem->wall_pair;
    add_integers(list, "wall_pair_particle", ARRAY_INT32,
                 OF(pair, struct wall_pair, particle), n_pair, 0, dem->n_particle - 1);
    add_integers(list, "wall_pair_wall", ARRAY_INT32, OF(pair, struct wall_pair, wall),
                 n_pair, 0, n - 1);
#define PAIR(name, member, width)                                                      \
    add_numbers(list, name, OF(pair, struct wall_pair, member), width, n_pair)
    PAIR("wall_pair_shear_force", shear_force, 3);
    PAIR("wall_pair_normal", normal, 3);
    PAIR("wall_pair_depth", depth, 1);
    PAIR("wall_pair_force", load, 3);
    PAIR("wall_pair_moment", moment, 3);
    if (dem->features & FEATURE_ROLLING)
        PAIR("wall_pair_rolling_moment", rolling_moment, 3);
    if (!walls_are_wet(dem)) return;
    PAIR("wall_pair_bridge_pull", bridge_pull, 1);
    PAIR("wall_pair_bridge_volume", bridge_volume, 1);
    PAIR("wall_pair_bridge_rupture", bridge_rupture, 1);
#undef PAIR
}

// Compensated sums have two numbers each: 3 times 2 of the translation, 2 of the angle.
static void add_groups(struct column_list *list, struct dem *dem)
{
    if (dem->n_driven == 0) return;
#define GROUP(name, member, width)                                                     \
    add_numbers(list, name, OF(dem->group, struct driven_group, member), width,        \
                dem->n_driven)
    GROUP("group_asked_velocity", is.velocity, 3);
    GROUP("group_asked_spin", is.spin, 1);
    GROUP("group_translation", translation, 6);
    GROUP("group_angle", angle, 2);
    GROUP("group_velocity", velocity, 3);
    GROUP("group_spin", spin, 1);
#undef GROUP
}

static void add_cracks(struct column_list *list, struct dem *dem)
{
    const int n = dem->n_crack;
#define CRACK(name, type, member, most)                                                \
    add_integers(list, name, type, OF(dem->crack, struct dem_crack, member), n, 0, most)
    CRACK("crack_bond", ARRAY_INT32, bond, dem->n_bond - 1);
    CRACK("crack_mode", ARRAY_UINT8, mode, DEM_CRACK_SHEAR);
    CRACK("crack_cycle", ARRAY_INT64, cycle, LARGEST_COUNT);
#undef CRACK
    add_numbers(list, "crack_time", OF(dem->crack, struct dem_crack, time), 1, n);
    add_numbers(list, "crack_position", OF(dem->crack, struct dem_crack, position), 3,
                n);
}

// A member of the groups of pairs; left out where the scene has no such groups.
static void add_lanes(struct column_list *list, const struct dem *dem, const char *name,
                      struct where at, int width)
{
    if (at.base) add_numbers(list, name, at, width, dem->pairs.n_pair)->in_lanes = true;
}

// `group_idle` too: a group that was idle is skipped only if its stored loads are 0.
static void add_pairs(struct column_list *list, struct dem *dem)
{
    const struct pair_list *pairs = &dem->pairs;
    const int n = pairs->n_pair;
    add_integers(list, "pair_particle", ARRAY_INT32, WHOLE(pairs->particle), n, 0,
                 dem->n_particle - 1)
        ->width = 2;
    if (dem->n_bond > 0)
        add_integers(list, "pair_bond", ARRAY_INT32, WHOLE(pairs->bond), n, -1,
                     dem->n_bond - 1);
    add_integers(list, "group_idle", ARRAY_UINT8, WHOLE(pairs->idle), pairs->n_group, 0,
                 1);
#define PAIRS(name, groups, type, member, width)                                       \
    add_lanes(list, dem, name, OF(pairs->groups, type, member), width)
    PAIRS("pair_separation", group, struct pair_group, separation, 3);
    PAIRS("pair_distance", group, struct pair_group, distance, 1);
    PAIRS("pair_overlap", group, struct pair_group, overlap, 1);
    PAIRS("pair_force", load, struct load_group, force, 3);
    PAIRS("pair_first_moment", moment, struct moment_group, first, 3);
    PAIRS("pair_second_moment", moment, struct moment_group, second, 3);
    PAIRS("pair_shear_force", shear, struct shear_group, force, 3);
    PAIRS("pair_rolling_moment", rolling, struct rolling_group, moment, 3);
    PAIRS("bond_shear_force", bonds, struct bond_group, shear_force, 3);
    PAIRS("bond_bending", bonds, struct bond_group, bending, 3);
    PAIRS("bond_twist", bonds, struct bond_group, twist, 1);
    if (dem->shrinkage)
        PAIRS("bond_free_stretch", bonds, struct bond_group, free_stretch, 1);
    PAIRS("loss_dashpots", loss, struct loss_group, dashpots, 1);
    PAIRS("loss_slip", loss, struct loss_group, slip, 1);
    PAIRS("loss_broken", loss, struct loss_group, broken, 1);
    PAIRS("loss_bridges", loss, struct loss_group, bridges, 1);
    PAIRS("bridge_pull", liquid, struct liquid_group, pull, 1);
    PAIRS("bridge_volume", liquid, struct liquid_group, volume, 1);
    PAIRS("bridge_rupture", liquid, struct liquid_group, rupture, 1);
#undef PAIRS
}

// In an order that does not matter to files, where columns have names.
struct column_list list_columns(struct dem *dem)
{
    struct column_list list = {.count = 0};
    add_scalars(&list, dem);
    add_time_step(&list, dem);
    add_grains(&list, dem);
    add_walls(&list, dem);
    add_groups(&list, dem);
    add_cracks(&list, dem);
    add_pairs(&list, dem);
    return list;
}
