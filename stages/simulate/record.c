// SPDX-License-Identifier: GPL-3.0-or-later
// Every column is declared once, in record_init, and filled by name; a name that is not
// declared is not recorded. So the choice of what to record stands in one place, and a
// new column is a line there and a line where its numbers are known.
//
// When a row's numbers belong to, for a row at the time t of cycle n:
//
//     positions, box, displacements    t
//     velocities, spins, momentum      t - dt/2, as leapfrog has them [K 4.1-4.6]
//     forces, stress, contacts         the last cycle, so positions at t - dt
//
// At the start, before any cycle, forces are those of the start (dem_find_forces).
//
// Stress is that of the census times box / room: the engine divides by its box, which
// does not follow walls that close in.
//
// Forces of groups that are not driven, and angles of theirs, are 0: such a group has
// no load as one.
#include "record.h"

#include "basics/memory.h"
#include "control.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- columns ------------------------------------------------------------------------

static void declare(struct record *record, const char *dataset, enum array_type type,
                    int64_t width)
{
    record->column[record->n_column++] =
        (struct recorded_column){.dataset = dataset, .type = type, .width = width};
}

static void declare_sums(struct record *record,
                         const struct simulate_parameters *parameters,
                         const struct scene *scene)
{
    const int64_t walls = scene->setup.n_wall, groups = scene->n_group;
    const struct {
        const char *dataset;
        int64_t width;
    } sums[] = {{"/history/time", 1},
                {"/history/unbalanced_ratio", 1},
                {"/history/coordination", 1},
                {"/history/largest_overlap", 1},
                {"/history/stress", 9},
                {"/history/kinetic_energy", 1},
                {"/history/elastic_energy", 1},
                {"/history/momentum", 3},
                {"/history/box_lower", 3},
                {"/history/box_upper", 3},
                {"/history/wall_force", 3 * walls},
                {"/history/wall_moment", 3 * walls},
                {"/history/wall_displacement", 3 * walls},
                {"/history/group_force", 3 * groups},
                {"/history/group_moment", 3 * groups},
                {"/history/group_displacement", 3 * groups},
                {"/history/group_angle", groups}};
    for (size_t k = 0; k < sizeof sums / sizeof *sums; k++)
        declare(record, sums[k].dataset, ARRAY_FLOAT64, sums[k].width);
    declare(record, "/history/contacts", ARRAY_INT64, 1);
    if (scene->setup.liquid) declare(record, "/history/bridges", ARRAY_INT64, 1);
    if (!parameters->record_energy) return;
    declare(record, "/history/work", ARRAY_FLOAT64, 1);
    declare(record, "/history/dissipation", ARRAY_FLOAT64, 5);
}

struct record record_init(const struct simulate_parameters *parameters,
                          const struct scene *scene)
{
    struct record record = {0};
    const int64_t n = scene->setup.packing->n_particle;
    declare_sums(&record, parameters, scene);
    declare(&record, "/snapshots/time", ARRAY_FLOAT64, 1);
    declare(&record, "/snapshots/box_lower", ARRAY_FLOAT64, 3);
    declare(&record, "/snapshots/box_upper", ARRAY_FLOAT64, 3);
    declare(&record, "/snapshots/position", ARRAY_FLOAT64, 3 * n);
    declare(&record, "/snapshots/velocity", ARRAY_FLOAT64, 3 * n);
    declare(&record, "/snapshots/spin", ARRAY_FLOAT64, 3 * n);
    declare(&record, "/snapshots/contacts", ARRAY_INT64, 1);
    declare(&record, "/contacts/particles", ARRAY_INT32, 2);
    declare(&record, "/contacts/force", ARRAY_FLOAT64, 3);
    declare(&record, "/contacts/position", ARRAY_FLOAT64, 3);
    declare(&record, "/contacts/overlap", ARRAY_FLOAT64, 1);
    declare(&record, "/contacts/bond", ARRAY_INT32, 1);
    if (!scene->setup.liquid) return record;
    declare(&record, "/contacts/bridge_volume", ARRAY_FLOAT64, 1);
    declare(&record, "/contacts/bridge_force", ARRAY_FLOAT64, 1);
    return record;
}

void record_free(struct record *record)
{
    for (int k = 0; k < record->n_column; k++)
        free(record->column[k].data);
    *record = (struct record){0};
}

static struct recorded_column *column(struct record *record, const char *dataset)
{
    for (int k = 0; k < record->n_column; k++)
        if (!strcmp(record->column[k].dataset, dataset)) return &record->column[k];
    return NULL;
}

const struct recorded_column *recorded(const struct record *record, const char *dataset)
{
    return column((struct record *)(uintptr_t)record, dataset); // only read
}

// Doubled, so that n rows cost O(n) copies.
static void make_room(struct recorded_column *c)
{
    if (c->rows < c->capacity) return;
    c->capacity = c->capacity ? 2 * c->capacity : 1;
    c->data =
        reallocate(c->data, (size_t)(c->capacity * c->width), number_size(c->type));
}

// Does nothing where DATASET is not recorded.
static void add_row(struct record *record, const char *dataset, const void *of)
{
    struct recorded_column *c = column(record, dataset);
    if (!c) return;
    make_room(c);
    const size_t row = (size_t)c->width * number_size(c->type);
    if (row > 0) memcpy((char *)c->data + (size_t)c->rows * row, of, row);
    c->rows++;
}

static void add_number(struct record *record, const char *dataset, double value)
{
    add_row(record, dataset, &value);
}

static void add_count(struct record *record, const char *dataset, int64_t value)
{
    add_row(record, dataset, &value);
}

// ---- sums ---------------------------------------------------------------------------

// One array for three columns: forces, moments, displacements, n of each.
static void record_walls(struct record *record, const struct scene *scene,
                         const struct dem *dem)
{
    const int n = scene->setup.n_wall;
    struct vector *of = NEW_ARRAY(struct vector, 3 * n);
    for (int w = 0; w < n; w++) {
        const struct dem_wall_state state = dem_wall_state(dem, w);
        of[w] = state.force;
        of[n + w] = state.moment;
        of[2 * n + w] = state.displacement;
    }
    add_row(record, "/history/wall_force", of);
    add_row(record, "/history/wall_moment", of + n);
    add_row(record, "/history/wall_displacement", of + 2 * (size_t)n);
    free(of);
}

// NEW_ARRAY gives zeros, which stay for the groups that are not driven.
static void record_groups(struct record *record, const struct scene *scene,
                          const struct dem *dem)
{
    const int n = scene->n_group;
    struct vector *of = NEW_ARRAY(struct vector, 3 * n);
    double *angle = NEW_ARRAY(double, n);
    for (int k = 0; k < n; k++) {
        if (scene->driven_group[k] < 0) continue;
        const struct dem_group_state state =
            dem_group_state(dem, scene->driven_group[k]);
        of[k] = state.force;
        of[n + k] = state.moment;
        of[2 * n + k] = state.displacement;
        angle[k] = state.angle;
    }
    add_row(record, "/history/group_force", of);
    add_row(record, "/history/group_moment", of + n);
    add_row(record, "/history/group_displacement", of + 2 * (size_t)n);
    add_row(record, "/history/group_angle", angle);
    free(angle);
    free(of);
}

static void record_energy(struct record *record, const struct dem *dem)
{
    const struct dem_energy energy = dem_energy(dem);
    const double lost[] = {energy.dashpots, energy.slip, energy.local_damping,
                           energy.broken, energy.bridges};
    add_number(record, "/history/kinetic_energy", energy.kinetic);
    add_number(record, "/history/elastic_energy", energy.elastic);
    add_number(record, "/history/work", energy.gained);
    add_row(record, "/history/dissipation", lost);
}

// The unbalanced ratio is infinite where forces act and no contact carries any. HDF5
// would keep an infinity, but JSON and most plotting programs would not.
static double finite_ratio(double ratio)
{
    static const double most = 1e150;
    return ratio < most ? ratio : most;
}

// Over the room between planes, which follows walls as they close in. No room is left
// where planes have passed each other; there is no stress to speak of then.
static void record_stress(struct record *record, const struct scene *scene,
                          const struct dem *dem, const struct dem_census *census)
{
    struct vector lower, upper;
    dem_box(dem, &lower, &upper);
    const struct vector edge = subtract(upper, lower);
    const double between = room(scene, dem), box = box_volume(edge);
    double stress[3][3];
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
            stress[k][l] = between > 0 ? census->stress[k][l] * (box / between) : 0;
    add_row(record, "/history/stress", stress);
}

void record_sums(struct record *record, const struct scene *scene,
                 const struct dem *dem, double time)
{
    const int n = scene->setup.packing->n_particle;
    const struct dem_census census = dem_census(dem);
    const struct dem_momentum momentum = dem_momentum(dem);
    struct vector lower, upper;
    dem_box(dem, &lower, &upper);
    add_number(record, "/history/time", time);
    add_number(record, "/history/unbalanced_ratio",
               finite_ratio(dem_unbalanced_ratio(dem)));
    add_count(record, "/history/contacts", census.contacts);
    add_number(record, "/history/coordination", n > 0 ? 2.0 * census.contacts / n : 0);
    add_number(record, "/history/largest_overlap", fmax(census.largest_overlap, 0));
    record_stress(record, scene, dem, &census);
    add_row(record, "/history/momentum", &momentum.linear);
    add_row(record, "/history/box_lower", &lower);
    add_row(record, "/history/box_upper", &upper);
    record_energy(record, dem);
    record_walls(record, scene, dem);
    record_groups(record, scene, dem);
    record->largest_overlap = fmax(record->largest_overlap, census.largest_overlap);
    if (!scene->setup.liquid) return;
    int bridges;
    free(dem_bridges(dem, &bridges));
    add_count(record, "/history/bridges", bridges);
}

// ---- snapshots ----------------------------------------------------------------------

// In the engine's order, by first, then second grain, which is the same for any number
// of threads.
static void record_contacts(struct record *record, const struct dem *dem)
{
    int n;
    struct dem_contact *contact = dem_contacts(dem, &n);
    add_count(record, "/snapshots/contacts", n);
    for (int k = 0; k < n; k++) {
        add_row(record, "/contacts/particles", contact[k].particle);
        add_row(record, "/contacts/force", &contact[k].force);
        add_row(record, "/contacts/position", &contact[k].position);
        add_row(record, "/contacts/overlap", &contact[k].overlap);
        add_row(record, "/contacts/bond", &contact[k].bond);
        add_row(record, "/contacts/bridge_volume", &contact[k].bridge_volume);
        add_row(record, "/contacts/bridge_force", &contact[k].bridge_force);
    }
    free(contact);
}

void record_snapshot(struct record *record,
                     const struct simulate_parameters *parameters,
                     const struct scene *scene, const struct dem *dem, double time)
{
    const int n = scene->setup.packing->n_particle;
    struct vector *of = NEW_ARRAY(struct vector, n), lower, upper;
    dem_box(dem, &lower, &upper);
    add_number(record, "/snapshots/time", time);
    add_row(record, "/snapshots/box_lower", &lower);
    add_row(record, "/snapshots/box_upper", &upper);
    dem_positions(dem, of);
    add_row(record, "/snapshots/position", of);
    dem_velocities(dem, of);
    add_row(record, "/snapshots/velocity", of);
    dem_spins(dem, of);
    add_row(record, "/snapshots/spin", of);
    free(of);
    if (parameters->record_contacts)
        record_contacts(record, dem);
    else
        add_count(record, "/snapshots/contacts", 0);
}

// ---- checkpoint ---------------------------------------------------------------------

// 64-bit counts go one by one: the stream bounds them to 2^53, because it keeps
// integers as doubles where they may exceed 32 bits.
static void stream_column(struct recorded_column *c, struct checkpoint_stream *stream)
{
    if (c->width == 0) { // nothing but how many
        stream_long(stream, &c->rows);
        return;
    }
    stream_count(stream, &c->rows);
    c->data =
        stream_room(stream, c->data, c->rows, (size_t)c->width * number_size(c->type));
    c->capacity = stream->restoring ? c->rows : c->capacity;
    const int64_t count = c->rows * c->width;
    if (c->type == ARRAY_FLOAT64) stream_numbers(stream, c->data, count);
    if (c->type == ARRAY_INT32)
        stream_integers(stream, c->data, count, INT32_MIN, INT32_MAX);
    for (int64_t k = 0; k < count && c->type == ARRAY_INT64; k++)
        stream_long(stream, (int64_t *)c->data + k);
}

// In the order of declaration, which the scene fixes: values in a stream have no names.
void record_state(struct record *record, struct checkpoint_stream *stream)
{
    stream_numbers(stream, &record->largest_overlap, 1);
    for (int k = 0; k < record->n_column; k++)
        stream_column(&record->column[k], stream);
}
