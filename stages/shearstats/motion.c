// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a motion. A moment M about a point p that has moved by u, of a force F, is
// about an axis a through the point o
//     (M + (p + u - o) x F) . a.
//
// All that is read is checked where it is read: contacts that name walls that are not
// there, rows of contacts that do not add up, a box that changes. So nothing behind
// needs a check of its own.
#include "motion.h"

#include "basics/memory.h"
#include "basics/status.h"

#include <math.h>
#include <stdlib.h>

// NAN bounds nothing: comparisons with it are false.
static void find_window(struct motion *motion, double from, double to, const char *path)
{
    const double *time = motion->snapshot_time;
    motion->first = 0;
    motion->last = motion->n_snapshot;
    while (motion->first < motion->last && time[motion->first] < from)
        motion->first++;
    while (motion->last > motion->first && time[motion->last - 1] > to)
        motion->last--;
    if (motion->first == motion->last)
        die(STATUS_BAD_DATA,
            "%s: /snapshots/time: none of %d snapshots is in the window: time.from and "
            "time.to choose it",
            input_name(path), motion->n_snapshot);
}

// A running sum of the rows of each snapshot: contact_first[s].
static void read_contacts(struct motion *motion, const struct artifact *input)
{
    int rows, n_contact;
    int64_t *count = artifact_get(input, "/snapshots/contacts", &rows);
    motion->pair = artifact_get(input, "/contacts/particles", &n_contact);
    motion->force = artifact_get(input, "/contacts/force", NULL);
    motion->point = artifact_get(input, "/contacts/position", NULL);
    motion->overlap = artifact_get(input, "/contacts/overlap", NULL);
    if (artifact_has_dataset(input, "/contacts/bridge_volume") &&
        artifact_has_dataset(input, "/contacts/bridge_force")) {
        motion->bridge_volume = artifact_get(input, "/contacts/bridge_volume", NULL);
        motion->bridge_force = artifact_get(input, "/contacts/bridge_force", NULL);
    }
    motion->contact_first = NEW_ARRAY(int64_t, rows + 1);
    for (int s = 0; s < rows; s++)
        motion->contact_first[s + 1] = motion->contact_first[s] + count[s];
    free(count);
    if (motion->contact_first[rows] != n_contact)
        die(STATUS_BAD_DATA,
            "%s: /snapshots/contacts: must sum to the rows of /contacts, %d, got %lld",
            input_name(input->path), n_contact, (long long)motion->contact_first[rows]);
    for (int k = 0; k < n_contact; k++) {
        const int32_t a = motion->pair[k][0], b = motion->pair[k][1];
        if (a < 0 || a == b || b < -motion->n_wall)
            die(STATUS_BAD_DATA,
                "%s: /contacts/particles: row %d: must be a grain and another, or -1-w "
                "for one of %d walls, got %d and %d",
                input_name(input->path), k, motion->n_wall, a, b);
    }
}

// The number of groups is that of the dataset, which also counts groups that are not
// driven.
static void read_sums(struct motion *motion, const struct artifact *input)
{
    motion->time = artifact_get(input, "/history/time", &motion->n_time);
    motion->wall_point = artifact_get(input, "/walls/point", &motion->n_wall);
    motion->wall_force = artifact_get(input, "/history/wall_force", NULL);
    motion->wall_moment = artifact_get(input, "/history/wall_moment", NULL);
    motion->wall_displacement = artifact_get(input, "/history/wall_displacement", NULL);
    struct dataset_values forces = artifact_get_values(input, "/history/group_force");
    motion->n_group = (int)forces.extent[1];
    free(forces.value);
    motion->group_force = artifact_get(input, "/history/group_force", NULL);
    motion->group_moment = artifact_get(input, "/history/group_moment", NULL);
    motion->group_displacement =
        artifact_get(input, "/history/group_displacement", NULL);
}

// The box at the first snapshot of the window; one that repeats must stay. Along other
// axes the box may follow walls: it is used for nothing there.
static void read_box(struct motion *motion, const struct artifact *input)
{
    struct vector *lower = artifact_get(input, "/snapshots/box_lower", NULL);
    struct vector *upper = artifact_get(input, "/snapshots/box_upper", NULL);
    motion->lower = lower[motion->first];
    motion->upper = upper[motion->first];
    const struct vector edge = subtract(motion->upper, motion->lower);
    for (int s = motion->first; s < motion->last; s++)
        for (int axis = 0; axis < 3; axis++) {
            if (!motion->periodic[axis]) continue;
            const double now = component(subtract(upper[s], lower[s]), axis);
            if (fabs(now - component(edge, axis)) > 1e-9 * component(edge, axis))
                die(STATUS_BAD_DATA,
                    "%s: /snapshots/box_upper: row %d: the box that repeats along %c "
                    "has changed: choose a time.from and time.to in which it has not",
                    input_name(input->path), s, "xyz"[axis]);
        }
    free(lower);
    free(upper);
}

// Parameters of the run that made the motion, for the names of its walls and groups. A
// motion of another program has none; names are numbers then.
struct motion read_motion(const struct artifact *input, double from, double to)
{
    struct motion motion = {0};
    struct packing packing = artifact_get_packing(input);
    for (int axis = 0; axis < 3; axis++)
        motion.periodic[axis] = packing.periodic[axis];
    packing_free(&packing);
    motion.radius = artifact_get(input, "/particles/radius", &motion.n_particle);
    motion.mass = artifact_get(input, "/particles/mass", NULL);
    motion.driven = artifact_get(input, "/particles/driven", NULL);
    motion.snapshot_time = artifact_get(input, "/snapshots/time", &motion.n_snapshot);
    if (motion.n_particle == 0)
        die(STATUS_BAD_DATA, "%s: /particles: has no grains", input_name(input->path));
    find_window(&motion, from, to, input->path);
    read_box(&motion, input);
    motion.position = artifact_get(input, "/snapshots/position", NULL);
    motion.velocity = artifact_get(input, "/snapshots/velocity", NULL);
    read_sums(&motion, input);
    read_contacts(&motion, input);
    char *text = artifact_get_text(input, "parameters");
    motion.scene = text ? json_loads(text, 0, NULL) : NULL;
    free(text);
    return motion;
}

void motion_free(struct motion *motion)
{
    void *const owned[] = {
        motion->radius,        motion->mass,          motion->driven,
        motion->snapshot_time, motion->position,      motion->velocity,
        motion->pair,          motion->contact_first, motion->force,
        motion->point,         motion->overlap,       motion->bridge_volume,
        motion->bridge_force,  motion->time,          motion->wall_point,
        motion->wall_force,    motion->wall_moment,   motion->wall_displacement,
        motion->group_force,   motion->group_moment,  motion->group_displacement};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    json_decref(motion->scene);
    *motion = (struct motion){0};
}

struct vector shortest_image(const struct motion *motion, struct vector between)
{
    const struct vector edge = subtract(motion->upper, motion->lower);
    for (int axis = 0; axis < 3; axis++) {
        if (!motion->periodic[axis]) continue;
        const double length = component(edge, axis), x = component(between, axis);
        set_component(&between, axis, x - length * rint(x / length));
    }
    return between;
}

static double moment_about(struct vector moment, struct vector arm, struct vector force,
                           struct vector axis)
{
    return dot(add(moment, cross(arm, force)), axis);
}

double wall_torque(const struct motion *motion, int t, int w, struct vector point,
                   struct vector axis)
{
    const size_t k = (size_t)t * (size_t)motion->n_wall + (size_t)w;
    const struct vector at = add(motion->wall_point[w], motion->wall_displacement[k]);
    return moment_about(motion->wall_moment[k], subtract(at, point),
                        motion->wall_force[k], axis);
}

double group_torque(const struct motion *motion, int t, int g, struct vector about,
                    struct vector point, struct vector axis)
{
    const size_t k = (size_t)t * (size_t)motion->n_group + (size_t)g;
    const struct vector at = add(about, motion->group_displacement[k]);
    return moment_about(motion->group_moment[k], subtract(at, point),
                        motion->group_force[k], axis);
}
