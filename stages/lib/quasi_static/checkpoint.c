// SPDX-License-Identifier: GPL-3.0-or-later
// What the next equilibrium follows from, as named arrays, and back: grains, pairs with
// their history, and counts. The factor and the contact solver only speed it up; but
// rounding depends on them, so they are dropped when this is kept.
//
// A table is a list of members of a struct and their places in a row; the same table
// serves both directions (copy_table), so these cannot differ. Whole numbers of pairs
// go as one array of KINDS columns. Names in files are older than those in the code
// ("joints" are contact pairs) and stay.
//
// The trap: a run that is kept drops its factor and goes on with a new one; a restored
// run begins with a new one, too. If only one of them did, their digits would differ.
#include "quasi_static_internal.h"

#include "large/large_state.h"
#include "splitting/splitting.h"

#include "basics/memory.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static const double LARGEST = 1e150, MOST_COUNTED = 0x1p31;

// From so many factors or loads on a checkpoint costs little: one factor more.
enum { MANY_FACTORS = 16, MANY_LOADS = 256 };

// Dropping the cache costs a factor, so a checkpoint waits until the cache has served
// many loads.
bool quasi_static_cache_is_old(const struct quasi_static *qs)
{
    return qs->factors >= MANY_FACTORS || qs->n_load >= MANY_LOADS;
}

// The last increment is a guess for the next one, so it goes as well.
void quasi_static_drop_cache(struct quasi_static *qs)
{
    contact_solver_clear(qs->contacts);
    memset(qs->last_increment, 0, (size_t)qs->n_pair * sizeof *qs->last_increment);
    qs->factors = qs->n_load = 0;
    splitting_free(qs->splitting);
    qs->splitting = NULL;
    if (qs->large) qs->large->factor_is_stale = true;
}

// ---- which numbers ------------------------------------------------------------------

struct part {
    size_t offset; // in a row
    int count;
};

// The numbers of N_PART parts, of doubles, in each of COUNT rows STRIDE bytes apart.
struct table {
    const char *name;
    void *row;
    int count;
    size_t stride;
    const struct part *part;
    int n_part;
};

static const struct part of_pairs[] = {
    {offsetof(struct contact_pair, axis), 9},
    {offsetof(struct contact_pair, arm), 2},
    {offsetof(struct contact_pair, overlap), 1},
    {offsetof(struct contact_pair, bond_radius), 1},
    {offsetof(struct contact_pair, bond_stiffness), COMPONENTS},
    {offsetof(struct contact_pair, free_stretch), 1},
    {offsetof(struct contact_pair, normal_stiffness), 1},
    {offsetof(struct contact_pair, shear_stiffness), 1},
    {offsetof(struct contact_pair, friction), 1},
    {offsetof(struct contact_pair, deformation), COMPONENTS},
    {offsetof(struct contact_pair, contact.anchor), 2}};
static const struct part of_frame[] = {{offsetof(struct pair_frame, axis), 9},
                                       {offsetof(struct pair_frame, arm), 2}};
static const struct part of_displacement[] = {{0, 6}}, of_vector[] = {{0, 3}},
                         of_number[] = {{0, 1}};

#define PARTS(part) part, sizeof(part) / sizeof *(part)
enum { TABLES = 7 };

// Large displacements have frames that turn, those at the start, and places of the last
// search besides; grains that shrink, by how much.
static int list_tables(const struct quasi_static *qs, struct table table[TABLES])
{
    const struct large_state *large = qs->large;
    int n = 3;
    table[0] = (struct table){"joints", qs->pair, qs->n_pair, sizeof *qs->pair,
                              PARTS(of_pairs)};
    table[1] = (struct table){"displacements", qs->previous, qs->n,
                              sizeof *qs->previous, PARTS(of_displacement)};
    table[2] = (struct table){"largest_load", (void *)&qs->largest_load, 1,
                              sizeof qs->largest_load, PARTS(of_number)};
    if (qs->shrinkage)
        table[n++] = (struct table){"shrinkage", qs->shrinkage, qs->n,
                                    sizeof *qs->shrinkage, PARTS(of_number)};
    if (!large) return n;
    table[n++] = (struct table){"joints_at_start", large->start, qs->n_pair,
                                sizeof *large->start, PARTS(of_frame)};
    table[n++] = (struct table){"joints_before", large->previous, qs->n_pair,
                                sizeof *large->previous, PARTS(of_frame)};
    table[n++] = (struct table){"searched_at", large->searched_at, qs->n,
                                sizeof *large->searched_at, PARTS(of_vector)};
    return n;
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

static void save_kinds(const struct quasi_static *qs, struct array_list *list)
{
    int32_t(*kind)[KINDS] = allocate((size_t)qs->n_pair, sizeof *kind);
    for (int j = 0; j < qs->n_pair; j++) {
        const struct contact_pair *pair = &qs->pair[j];
        const int32_t each[KINDS] = {pair->grain[0],
                                     pair->grain[1],
                                     pair->bond,
                                     pair->is_bonded,
                                     pair->is_detached,
                                     pair->is_point,
                                     (int32_t)pair->contact.state};
        memcpy(kind[j], each, sizeof each);
    }
    add_array(list, "joint_kinds", ARRAY_INT32, KINDS * (int64_t)qs->n_pair, kind);
    free(kind);
}

static void save_cracks(const struct quasi_static *qs, struct array_list *list)
{
    const int n = qs->n_crack;
    int32_t *bond = NEW_ARRAY(int32_t, n);
    uint8_t *mode = NEW_ARRAY(uint8_t, n);
    int64_t *cycle = NEW_ARRAY(int64_t, n);
    struct vector *position = NEW_ARRAY(struct vector, n);
    for (int k = 0; k < n; k++) {
        bond[k] = qs->crack[k].bond;
        mode[k] = qs->crack[k].mode;
        cycle[k] = qs->crack[k].cycle;
        position[k] = qs->crack[k].position;
    }
    uint8_t *intact = NEW_ARRAY(uint8_t, qs->packing->n_bond);
    quasi_static_bonds_intact(qs, intact);
    add_array(list, "bond_intact", ARRAY_UINT8, qs->packing->n_bond, intact);
    free(intact);
    add_array(list, "crack_bond", ARRAY_INT32, n, bond);
    add_array(list, "crack_mode", ARRAY_UINT8, n, mode);
    add_array(list, "crack_cycle", ARRAY_INT64, n, cycle);
    add_array(list, "crack_position", ARRAY_FLOAT64, 3 * (int64_t)n, position);
    free(bond);
    free(mode);
    free(cycle);
    free(position);
}

// Contact bonds have an overlap of -infinity [make_contact_pairs.c]; no file holds it.
// restore_points puts the infinity back.
static void bound_numbers(double *number, int64_t count)
{
    for (int64_t k = 0; k < count; k++)
        if (number[k] < -LARGEST) number[k] = -LARGEST;
}

struct array_list quasi_static_save(const struct quasi_static *qs)
{
    struct array_list list = {NULL, 0};
    struct table table[TABLES];
    const int n_table = list_tables(qs, table);
    for (int t = 0; t < n_table; t++) {
        const int64_t count = (int64_t)width_of(&table[t]) * table[t].count;
        double *number = NEW_ARRAY(double, count);
        copy_table(&table[t], number, true);
        bound_numbers(number, count);
        add_array(&list, table[t].name, ARRAY_FLOAT64, count, number);
        free(number);
    }
    const int64_t counted[COUNTS] = {
        qs->iterations,       qs->n_detached,    qs->first_detached, qs->n_unconverged,
        qs->last_unconverged, qs->n_instability, qs->last_unstable};
    add_array(&list, "counted", ARRAY_INT64, COUNTS, counted);
    add_array(&list, "is_gone", ARRAY_UINT8, qs->n, qs->is_detached);
    save_kinds(qs, &list);
    save_cracks(qs, &list);
    return list;
}

// ---- in -----------------------------------------------------------------------------

// Whole numbers first: they say how many pairs there are. moments_left_out is of the
// setup.
static bool restore_kinds(struct quasi_static *qs, struct array_reader *reader)
{
    const int64_t n = array_count(reader->list, "joint_kinds") / KINDS;
    const double most = qs->n > qs->packing->n_bond ? qs->n : qs->packing->n_bond;
    const int32_t(*kind)[KINDS] =
        read_array(reader, "joint_kinds", ARRAY_INT32, KINDS * n, -1, most);
    if (!kind) return false;
    for (int64_t j = 0; j < n && !reader->failed; j++)
        reader->failed = kind[j][0] < 0 || kind[j][0] >= qs->n || kind[j][1] >= qs->n ||
                         kind[j][2] >= qs->packing->n_bond || kind[j][6] < 0 ||
                         kind[j][6] > CONTACT_NEW;
    if (reader->failed) {
        refuse(reader->reason, STATUS_BAD_DATA, "joint_kinds: there are none such");
        return false;
    }
    qs->n_pair = (int)n;
    qs->pair = reallocate(qs->pair, (size_t)n, sizeof *qs->pair);
    for (int j = 0; j < qs->n_pair; j++)
        qs->pair[j] =
            (struct contact_pair){.moments_left_out = qs->setup.bond.moments_left_out,
                                  .grain = {kind[j][0], kind[j][1]},
                                  .bond = kind[j][2],
                                  .is_bonded = kind[j][3],
                                  .is_detached = kind[j][4],
                                  .is_point = kind[j][5],
                                  .contact.state = (enum contact_state)kind[j][6]};
    return true;
}

static bool restore_cracks(struct quasi_static *qs, struct array_reader *reader)
{
    const int64_t n = array_count(reader->list, "crack_bond");
    const int32_t *bond =
        read_array(reader, "crack_bond", ARRAY_INT32, n, 0, qs->packing->n_bond - 1);
    const uint8_t *mode = read_array(reader, "crack_mode", ARRAY_UINT8, n, 0, 1);
    const int64_t *cycle =
        read_array(reader, "crack_cycle", ARRAY_INT64, n, 0, MOST_COUNTED);
    const struct vector *position =
        read_array(reader, "crack_position", ARRAY_FLOAT64, 3 * n, -LARGEST, LARGEST);
    if (reader->failed) return false;
    qs->n_crack = qs->crack_capacity = (int)n;
    qs->crack = reallocate(qs->crack, (size_t)n, sizeof *qs->crack);
    for (int k = 0; k < qs->n_crack; k++)
        qs->crack[k] = (struct dem_crack){.bond = bond[k],
                                          .mode = mode[k],
                                          .cycle = cycle[k],
                                          .position = position[k]};
    return true;
}

// Numbers of events and which grain was last: they go into the summary only, but a
// restored run must write the same.
static bool restore_counted(struct quasi_static *qs, struct array_reader *reader)
{
    const int64_t *counted =
        read_array(reader, "counted", ARRAY_INT64, COUNTS, 0, MOST_COUNTED);
    const uint8_t *is_detached =
        read_array(reader, "is_gone", ARRAY_UINT8, qs->n, 0, 1);
    if (reader->failed) return false;
    int *const of[COUNTS] = {&qs->iterations,       &qs->n_detached,
                             &qs->first_detached,   &qs->n_unconverged,
                             &qs->last_unconverged, &qs->n_instability,
                             &qs->last_unstable};
    for (int k = 0; k < COUNTS; k++)
        *of[k] = (int)counted[k];
    for (int i = 0; i < qs->n; i++)
        qs->is_detached[i] = is_detached[i];
    return true;
}

static void restore_points(struct quasi_static *qs)
{
    for (int j = 0; j < qs->n_pair; j++)
        if (qs->pair[j].overlap <= -LARGEST) qs->pair[j].overlap = -INFINITY;
}

// The iterate is that of the last equilibrium: roll_back_state makes it from what was
// read.
enum status quasi_static_restore(struct quasi_static *qs, const struct array_list *list,
                                 struct reason *reason)
{
    struct array_reader reader = {.list = list, .reason = reason};
    if (!restore_kinds(qs, &reader) || !restore_cracks(qs, &reader) ||
        !restore_counted(qs, &reader))
        return STATUS_BAD_DATA;
    if (qs->large) large_state_allocate_pairs(qs);
    allocate_pair_arrays(qs);
    struct table table[TABLES];
    const int n_table = list_tables(qs, table);
    for (int t = 0; t < n_table; t++) {
        const int64_t count = (int64_t)width_of(&table[t]) * table[t].count;
        const double *number =
            read_array(&reader, table[t].name, ARRAY_FLOAT64, count, -LARGEST, LARGEST);
        if (!number) return STATUS_BAD_DATA;
        copy_table(&table[t], (double *)number, false);
    }
    restore_points(qs);
    roll_back_state(qs);
    quasi_static_drop_cache(qs);
    return STATUS_OK;
}
