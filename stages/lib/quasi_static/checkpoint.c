// SPDX-License-Identifier: GPL-3.0-or-later
// What the next equilibrium follows from, as named arrays, and back: grains, joints
// with their history, and what was counted. The factor and its corrections would only
// speed it up; but rounding depends on them, so they are forgotten when this is kept.
#include "quasi_static_internal.h"

#include "basics/memory.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static const double largest = 1e150, most_counted = 0x1p31;

// Factors and loads that make a state worth keeping: one factor more is little beside.
enum { MANY_FACTORS = 16, MANY_LOADS = 256 };

bool equilibrium_may_forget(const struct equilibrium *e)
{
    return e->factors >= MANY_FACTORS || e->n_load >= MANY_LOADS;
}

void equilibrium_forget(struct equilibrium *e)
{
    corrections_clear(e->corrections);
    memset(e->grown, 0, (size_t)e->n_joint * sizeof *e->grown);
    e->factors = e->n_load = 0;
    if (e->large) e->large->is_stale = true;
}

// ---- which numbers ------------------------------------------------------------------

struct part {
    size_t offset; // in a row
    int count;
};

// Of COUNT rows STRIDE bytes apart the numbers of N_PART parts, of doubles.
struct table {
    const char *name;
    void *row;
    int count;
    size_t stride;
    const struct part *part;
    int n_part;
};

static const struct part of_joint[] = {
    {offsetof(struct joint, axis), 9},
    {offsetof(struct joint, arm), 2},
    {offsetof(struct joint, overlap), 1},
    {offsetof(struct joint, bond_radius), 1},
    {offsetof(struct joint, bond_stiffness), STRAINS},
    {offsetof(struct joint, point_overlap), 1},
    {offsetof(struct joint, contact_along), 1},
    {offsetof(struct joint, contact_across), 1},
    {offsetof(struct joint, friction), 1},
    {offsetof(struct joint, strain), STRAINS},
    {offsetof(struct joint, contact.anchor), 2}};
static const struct part of_lie[] = {{offsetof(struct lie, axis), 9},
                                     {offsetof(struct lie, arm), 2}};
static const struct part of_displacement[] = {{0, 6}}, of_vector[] = {{0, 3}},
                         of_number[] = {{0, 1}};

#define PARTS(part) part, sizeof(part) / sizeof *(part)
enum { TABLES = 6 };

static int list_tables(const struct equilibrium *e, struct table table[TABLES])
{
    const struct large *large = e->large;
    table[0] = (struct table){"joints", e->joint, e->n_joint, sizeof *e->joint,
                              PARTS(of_joint)};
    table[1] = (struct table){"displacements", e->before, e->n, sizeof *e->before,
                              PARTS(of_displacement)};
    table[2] = (struct table){"largest_load", (void *)&e->largest_load, 1,
                              sizeof e->largest_load, PARTS(of_number)};
    if (!large) return 3;
    table[3] = (struct table){"joints_at_start", large->start, e->n_joint,
                              sizeof *large->start, PARTS(of_lie)};
    table[4] = (struct table){"joints_before", large->before, e->n_joint,
                              sizeof *large->before, PARTS(of_lie)};
    table[5] = (struct table){"searched_at", large->searched, e->n,
                              sizeof *large->searched, PARTS(of_vector)};
    return TABLES;
}

static int width_of(const struct table *table)
{
    int width = 0;
    for (int p = 0; p < table->n_part; p++)
        width += table->part[p].count;
    return width;
}

// Between the rows of TABLE and NUMBER, one after the other.
static void copy_table(const struct table *table, double *number, bool is_out)
{
    for (int k = 0; k < table->count; k++)
        for (int p = 0; p < table->n_part; p++) {
            const size_t bytes = (size_t)table->part[p].count * sizeof *number;
            char *at =
                (char *)table->row + (size_t)k * table->stride + table->part[p].offset;
            if (is_out)
                memcpy(number, at, bytes);
            else
                memcpy(at, number, bytes);
            number += table->part[p].count;
        }
}

// ---- out ----------------------------------------------------------------------------

enum { KINDS = 7, COUNTS = 7 };

static void save_kinds(const struct equilibrium *e, struct array_list *list)
{
    int32_t(*kind)[KINDS] = allocate((size_t)e->n_joint, sizeof *kind);
    for (int j = 0; j < e->n_joint; j++) {
        const struct joint *joint = &e->joint[j];
        const int32_t each[KINDS] = {joint->grain[0],
                                     joint->grain[1],
                                     joint->bond,
                                     joint->is_bonded,
                                     joint->is_gone,
                                     joint->is_point,
                                     (int32_t)joint->contact.touch};
        memcpy(kind[j], each, sizeof each);
    }
    add_array(list, "joint_kinds", DEM_INT32, KINDS * (int64_t)e->n_joint, kind);
    free(kind);
}

static void save_cracks(const struct equilibrium *e, struct array_list *list)
{
    const int n = e->n_crack;
    int32_t *bond = NEW_ARRAY(int32_t, n);
    uint8_t *mode = NEW_ARRAY(uint8_t, n);
    int64_t *cycle = NEW_ARRAY(int64_t, n);
    struct vector *position = NEW_ARRAY(struct vector, n);
    for (int k = 0; k < n; k++) {
        bond[k] = e->crack[k].bond;
        mode[k] = e->crack[k].mode;
        cycle[k] = e->crack[k].cycle;
        position[k] = e->crack[k].position;
    }
    uint8_t *intact = NEW_ARRAY(uint8_t, e->packing->n_bond);
    equilibrium_bonds_intact(e, intact);
    add_array(list, "bond_intact", DEM_UINT8, e->packing->n_bond, intact);
    free(intact);
    add_array(list, "crack_bond", DEM_INT32, n, bond);
    add_array(list, "crack_mode", DEM_UINT8, n, mode);
    add_array(list, "crack_cycle", DEM_INT64, n, cycle);
    add_array(list, "crack_position", DEM_FLOAT64, 3 * (int64_t)n, position);
    free(bond);
    free(mode);
    free(cycle);
    free(position);
}

// Points of glue overlap by -infinity [make_joints.c], which files do not hold.
static void bound_numbers(double *number, int64_t count)
{
    for (int64_t k = 0; k < count; k++)
        if (number[k] < -largest) number[k] = -largest;
}

struct array_list equilibrium_save(const struct equilibrium *e)
{
    struct array_list list = {NULL, 0};
    struct table table[TABLES];
    const int n_table = list_tables(e, table);
    for (int t = 0; t < n_table; t++) {
        const int64_t count = (int64_t)width_of(&table[t]) * table[t].count;
        double *number = NEW_ARRAY(double, count);
        copy_table(&table[t], number, true);
        bound_numbers(number, count);
        add_array(&list, table[t].name, DEM_FLOAT64, count, number);
        free(number);
    }
    const int64_t counted[COUNTS] = {e->iterations, e->n_gone,   e->first_gone,
                                     e->n_restless, e->restless, e->n_snap,
                                     e->snapped};
    add_array(&list, "counted", DEM_INT64, COUNTS, counted);
    add_array(&list, "is_gone", DEM_UINT8, e->n, e->is_gone);
    save_kinds(e, &list);
    save_cracks(e, &list);
    return list;
}

// ---- in -----------------------------------------------------------------------------

static bool restore_kinds(struct equilibrium *e, struct array_reader *reader)
{
    const int64_t n = array_count(reader->list, "joint_kinds") / KINDS;
    const double most = e->n > e->packing->n_bond ? e->n : e->packing->n_bond;
    const int32_t(*kind)[KINDS] =
        read_array(reader, "joint_kinds", DEM_INT32, KINDS * n, -1, most);
    if (!kind) return false;
    for (int64_t j = 0; j < n && !reader->failed; j++)
        reader->failed = kind[j][0] < 0 || kind[j][0] >= e->n || kind[j][1] >= e->n ||
                         kind[j][2] >= e->packing->n_bond || kind[j][6] < 0 ||
                         kind[j][6] > TOUCH_BEGINS;
    if (reader->failed) {
        refuse(reader->reason, STATUS_BAD_DATA, "joint_kinds: there are none such");
        return false;
    }
    e->n_joint = (int)n;
    e->joint = reallocate(e->joint, (size_t)n, sizeof *e->joint);
    for (int j = 0; j < e->n_joint; j++)
        e->joint[j] = (struct joint){.moments_left_out = e->setup.bond.moments_left_out,
                                     .grain = {kind[j][0], kind[j][1]},
                                     .bond = kind[j][2],
                                     .is_bonded = kind[j][3],
                                     .is_gone = kind[j][4],
                                     .is_point = kind[j][5],
                                     .contact.touch = (enum touch)kind[j][6]};
    return true;
}

static bool restore_cracks(struct equilibrium *e, struct array_reader *reader)
{
    const int64_t n = array_count(reader->list, "crack_bond");
    const int32_t *bond =
        read_array(reader, "crack_bond", DEM_INT32, n, 0, e->packing->n_bond - 1);
    const uint8_t *mode = read_array(reader, "crack_mode", DEM_UINT8, n, 0, 1);
    const int64_t *cycle =
        read_array(reader, "crack_cycle", DEM_INT64, n, 0, most_counted);
    const struct vector *position =
        read_array(reader, "crack_position", DEM_FLOAT64, 3 * n, -largest, largest);
    if (reader->failed) return false;
    e->n_crack = e->crack_capacity = (int)n;
    e->crack = reallocate(e->crack, (size_t)n, sizeof *e->crack);
    for (int k = 0; k < e->n_crack; k++)
        e->crack[k] = (struct dem_crack){.bond = bond[k],
                                         .mode = mode[k],
                                         .cycle = cycle[k],
                                         .position = position[k]};
    return true;
}

static bool restore_counted(struct equilibrium *e, struct array_reader *reader)
{
    const int64_t *counted =
        read_array(reader, "counted", DEM_INT64, COUNTS, 0, most_counted);
    const uint8_t *is_gone = read_array(reader, "is_gone", DEM_UINT8, e->n, 0, 1);
    if (reader->failed) return false;
    int *const of[COUNTS] = {&e->iterations, &e->n_gone, &e->first_gone, &e->n_restless,
                             &e->restless,   &e->n_snap, &e->snapped};
    for (int k = 0; k < COUNTS; k++)
        *of[k] = (int)counted[k];
    for (int i = 0; i < e->n; i++)
        e->is_gone[i] = is_gone[i];
    return true;
}

static void restore_points(struct equilibrium *e)
{
    for (int j = 0; j < e->n_joint; j++)
        if (e->joint[j].overlap <= -largest) e->joint[j].overlap = -INFINITY;
}

enum status equilibrium_restore(struct equilibrium *e, const struct array_list *list,
                                struct reason *reason)
{
    struct array_reader reader = {.list = list, .reason = reason};
    if (!restore_kinds(e, &reader) || !restore_cracks(e, &reader) ||
        !restore_counted(e, &reader))
        return STATUS_BAD_DATA;
    if (e->large) large_make_room(e);
    make_room_for_joints(e);
    struct table table[TABLES];
    const int n_table = list_tables(e, table);
    for (int t = 0; t < n_table; t++) {
        const int64_t count = (int64_t)width_of(&table[t]) * table[t].count;
        const double *number =
            read_array(&reader, table[t].name, DEM_FLOAT64, count, -largest, largest);
        if (!number) return STATUS_BAD_DATA;
        copy_table(&table[t], (double *)number, false);
    }
    restore_points(e);
    go_back(e);
    equilibrium_forget(e);
    return STATUS_OK;
}
