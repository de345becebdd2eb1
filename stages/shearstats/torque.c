// SPDX-License-Identifier: GPL-3.0-or-later
// The torque that turns a part of a cell. The drive balances the grains, so with the
// moments M of the grains on walls and groups of the part about the axis (motion.h),
//     torque_t = -sign(rate) sum over the part of M_t      at each row t in the window,
//     mean     = mean of torque_t,
//     error    = deviation of the means of blocks / sqrt(number of blocks).
// Blocks are equal parts of the rows, one after the other; their error is honest where
// a block is longer than the memory of the flow.
//
// The first half of the file finds the part: walls and groups by name in the scene of
// the motion, as `simulate` numbers them (box walls first, then names in the order of
// strcmp), or by number.
#include "torque.h"

#include "basics/memory.h"
#include "basics/sorted.h"
#include "statistics/sample.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- names --------------------------------------------------------------------------

// Walls of the box come first, in this order (simulate). COUNT gets how many walls the
// box has: the others are numbered from there.
static int box_walls(const struct motion *motion, const char *name, int *count)
{
    static const char *const sides[] = {"-x", "+x", "-y", "+y", "-z", "+z"};
    const json_t *box = json_object_get(motion->scene, "box");
    const json_t *walls = json_object_get(box, "walls");
    int found = -1;
    *count = 0;
    for (int side = 0; side < 6; side++) {
        size_t k;
        json_t *of;
        json_array_foreach(walls, k,
                           of) if (!strcmp(json_string_value(of), sides[side]))
        {
            if (!strcmp(name, sides[side])) found = *count;
            ++*count;
        }
    }
    return found;
}

// The place of NAME among the sorted keys of OBJECT, or -1. `simulate` numbers walls
// and groups in the order of their names, by strcmp. Here too, because JSON objects
// have no order to go by.
static int place_of_name(const json_t *object, const char *name)
{
    const size_t n = json_object_size(object);
    const char **names = allocate(n, sizeof *names);
    size_t k = 0;
    for (void *at = json_object_iter((json_t *)(uintptr_t)object); at;
         at = json_object_iter_next((json_t *)(uintptr_t)object, at))
        names[k++] = json_object_iter_key(at);
    qsort(names, n, sizeof *names, rising_texts);
    int found = -1;
    for (k = 0; k < n; k++)
        if (!strcmp(names[k], name)) found = (int)k;
    free(names);
    return found;
}

static int find_wall(const struct motion *motion, const char *name)
{
    int of_box;
    const int side = box_walls(motion, name, &of_box);
    if (side >= 0) return side;
    const int place = place_of_name(json_object_get(motion->scene, "walls"), name);
    return place < 0 ? -1 : of_box + place;
}

// A whole, non-negative number below N and nothing behind it, else -1.
static int find_number(const char *name, int n)
{
    char *end;
    const long number = strtol(name, &end, 10);
    return *name && !*end && number >= 0 && number < n ? (int)number : -1;
}

// Moments of a group are about the `point` of its parameters, 0 unless given.
static struct vector point_of_group(const struct motion *motion, const char *name)
{
    const json_t *group =
        json_object_get(json_object_get(motion->scene, "groups"), name);
    const json_t *point = json_object_get(group, "point");
    double x[3] = {0};
    for (size_t k = 0; k < 3; k++)
        x[k] = json_number_value(json_array_get(point, k));
    return as_vector(x);
}

// The next name of LIST, without blanks around it; false at its end.
static bool next_name(const char **list, char *name, size_t size)
{
    if (!*list || !**list) return false;
    *list += strspn(*list, " ,");
    size_t length = strcspn(*list, ",");
    const char *start = *list;
    *list += length;
    while (length > 0 && start[length - 1] == ' ')
        length--;
    snprintf(name, size, "%.*s", (int)length, start);
    return length > 0;
}

static enum status unknown(struct reason *reason, const char *kind, const char *name)
{
    return refuse(reason, STATUS_BAD_DATA,
                  "shearstats.cell.%s: '%s' is not there, or there are too many: names "
                  "are those of the motion's scene, or numbers from 0",
                  kind, name);
}

enum status find_part(const struct motion *motion, const char *walls,
                      const char *groups, struct part *part, struct reason *reason)
{
    char name[256];
    part->n_wall = part->n_group = 0;
    while (next_name(&walls, name, sizeof name)) {
        int w = find_wall(motion, name);
        if (w < 0) w = find_number(name, motion->n_wall);
        if (w < 0 || w >= motion->n_wall || part->n_wall == MOST_IN_PART)
            return unknown(reason, "walls", name);
        part->wall[part->n_wall++] = w;
    }
    while (next_name(&groups, name, sizeof name)) {
        int g = place_of_name(json_object_get(motion->scene, "groups"), name);
        if (g < 0) g = find_number(name, motion->n_group);
        if (g < 0 || g >= motion->n_group || part->n_group == MOST_IN_PART)
            return unknown(reason, "groups", name);
        part->group_point[part->n_group] = point_of_group(motion, name);
        part->group[part->n_group++] = g;
    }
    return STATUS_OK;
}

// ---- torque -------------------------------------------------------------------------

// Minus: the sums are the loads of the grains on the part, and the drive is what
// balances them.
static double torque_at(const struct motion *motion, int t, const struct part *part,
                        struct vector point, struct vector axis)
{
    double torque = 0;
    for (int k = 0; k < part->n_wall; k++)
        torque -= wall_torque(motion, t, part->wall[k], point, axis);
    for (int k = 0; k < part->n_group; k++)
        torque -=
            group_torque(motion, t, part->group[k], part->group_point[k], point, axis);
    return torque;
}

// NAN bounds leave all rows in; fewer rows than blocks make as many blocks as rows.
struct torque mean_torque(const struct motion *motion, const struct part *part,
                          struct vector point, struct vector axis, double rate,
                          double from, double to, int blocks)
{
    double *value = NEW_ARRAY(double, motion->n_time);
    int n = 0;
    for (int t = 0; t < motion->n_time; t++)
        if (!(motion->time[t] < from) && !(motion->time[t] > to))
            value[n++] = copysign(1, rate) * torque_at(motion, t, part, point, axis);
    struct torque torque = {n, NAN, NAN};
    if (n > 0) torque.mean = sample_mean((struct sample){value, n});
    if (blocks > n) blocks = n;
    double *mean = NEW_ARRAY(double, blocks);
    for (int b = 0; b < blocks; b++) {
        const int from_row = (int)((long)n * b / blocks);
        const int to_row = (int)((long)n * (b + 1) / blocks);
        mean[b] = sample_mean((struct sample){value + from_row, to_row - from_row});
    }
    if (blocks > 1)
        torque.block_error =
            sample_deviation((struct sample){mean, blocks}) / sqrt(blocks);
    free(mean);
    free(value);
    return torque;
}
