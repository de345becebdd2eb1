// SPDX-License-Identifier: GPL-3.0-or-later
// Places become whole numbers of steps from the lowest corner, for each axis
//
//     value = round((x - origin) / step)
//     step  = min(R_min / 500, largest edge / 65535),
//
// forces become 128 + 127 f / f_max for each component, and moments become keys of the
// course (course.h). No picture shows the difference.
//
// What a throat does over time is two keys: when it begins to empty and when it is
// empty. That is enough for a drawing that shrinks its liquid between the two; what
// refills is shown from when it last emptied.
#include "body.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double smallest_radius(const struct packing *packing)
{
    double least = packing->n_particle ? packing->radius[0] : 1;
    for (int i = 1; i < packing->n_particle; i++)
        least = fmin(least, packing->radius[i]);
    return least;
}

// LOW and HIGH grow to hold the N points.
static void reach(struct vector *low, struct vector *high, const struct vector *point,
                  int n)
{
    for (int i = 0; i < n; i++)
        for (int axis = 0; axis < 3; axis++) {
            const double x = component(point[i], axis);
            set_component(low, axis, fmin(component(*low, axis), x));
            set_component(high, axis, fmax(component(*high, axis), x));
        }
}

// Wherever grains go, and where they touch walls.
static void reach_motion(const struct run *run, struct vector *low, struct vector *high)
{
    struct vector *place = artifact_get(run->motion, "/snapshots/position", NULL);
    for (int s = 0; s < run->n_load; s++)
        reach(low, high, place + (size_t)s * (size_t)run->packing.n_particle,
              run->packing.n_particle);
    free(place);
    int n_contact;
    struct vector *touch = artifact_get(run->motion, "/contacts/position", &n_contact);
    reach(low, high, touch, n_contact);
    free(touch);
}

// All that is drawn must lie on the grid, also nodes outside of the box and grains that
// leave it. The second bound uses all of two planes of bytes where the body is less
// than some 130 smallest radii wide; in wider ones coordinates need a third.
static struct grid grid_of(const struct run *run, const struct vector *node, int n_node)
{
    const struct packing *packing = &run->packing;
    struct vector low = packing->lower, high = packing->upper;
    reach(&low, &high, packing->position, packing->n_particle);
    reach(&low, &high, node, n_node);
    if (run->motion) reach_motion(run, &low, &high);
    const double fine = smallest_radius(packing) / 500;
    return (struct grid){low,
                         fmin(fine, largest_component(subtract(high, low)) / 65535)};
}

uint32_t on_grid(const struct grid *grid, struct vector point, int axis)
{
    return (uint32_t)lround((component(point, axis) - component(grid->origin, axis)) /
                            grid->step);
}

// POINT (N) as PREFIX.x, .y, .z. POINT in m must lie on GRID.
static void put_points(struct arrays *arrays, const char *prefix,
                       const struct grid *grid, const struct vector *point, int n)
{
    uint32_t *value = NEW_ARRAY(uint32_t, n);
    for (int axis = 0; axis < 3; axis++) {
        char name[40];
        snprintf(name, sizeof name, "%s.%c", prefix, "xyz"[axis]);
        for (int i = 0; i < n; i++)
            value[i] = on_grid(grid, point[i], axis);
        arrays_put(arrays, name, value, (size_t)n, false);
    }
    free(value);
}

static void put_lengths(struct arrays *arrays, const char *name, const double *length,
                        int n, double step)
{
    uint32_t *value = NEW_ARRAY(uint32_t, n);
    for (int i = 0; i < n; i++)
        value[i] = (uint32_t)lround(length[i] / step);
    arrays_put(arrays, name, value, (size_t)n, false);
    free(value);
}

// ---- liquid -------------------------------------------------------------------------

struct emptying {            // of each throat
    uint32_t *leaves, *ends; // (n_throat) keys: no longer full, empty
    int refilled;
};

// Replays the drying. Liquid falls linearly between steps, so that a throat begins to
// empty at the end of the step before. `liquid` is the saturation of each throat so
// far; the record lists only those that change in a step. Throats that never hold
// liquid have both keys at 0.
static struct emptying replay(const struct run *run, const struct course *course)
{
    const struct drying_record *record = &run->record;
    const int n = run->network.n_throat;
    struct emptying emptying = {NEW_ARRAY(uint32_t, n), NEW_ARRAY(uint32_t, n), 0};
    double *liquid = full_saturations(&run->network);
    for (int t = 0; t < n; t++)
        emptying.leaves[t] = emptying.ends[t] = liquid[t] > 0 ? NEVER : 0;
    for (int step = 0; step < record->n_step; step++) {
        const double before = record->time[step > 0 ? step - 1 : 0];
        for (int64_t k = record->offset[step]; k < record->offset[step + 1]; k++) {
            const int t = record->throat[k];
            const double now = record->throat_saturation[k];
            if (emptying.leaves[t] == NEVER && now < 1)
                emptying.leaves[t] = key_of(course, before);
            if (now > 0 && liquid[t] <= 0 && step > 0) {
                emptying.refilled++;
                emptying.ends[t] = NEVER;
            }
            if (now >= 1) emptying.leaves[t] = NEVER;
            if (now <= 0) emptying.ends[t] = key_of(course, record->time[step]);
            liquid[t] = now;
        }
    }
    free(liquid);
    return emptying;
}

// Nodes, and behind them where throats that lead across a side of a box that repeats
// would end. Without that a tube would be drawn across the whole box.
static struct vector *points_of(const struct network *network, uint32_t *second,
                                int *count)
{
    const int n = network->n_node;
    int crossing = 0;
    for (int t = 0; network->throat_image && t < network->n_throat; t++)
        crossing += !same_image(network->throat_image[t], (struct image){0});
    struct vector *point = NEW_ARRAY(struct vector, n + crossing);
    if (n) memcpy(point, network->node_position, (size_t)n * sizeof *point);
    *count = n;
    for (int t = 0; t < network->n_throat; t++) {
        second[t] = (uint32_t)network->throat_nodes[t][1];
        if (!network->throat_image ||
            same_image(network->throat_image[t], (struct image){0}))
            continue;
        second[t] = (uint32_t)*count;
        point[(*count)++] = add(network->node_position[network->throat_nodes[t][0]],
                                along_throat(network, t));
    }
    return point;
}

// Throats without liquid at any time are not drawn, and so not written. Indices of
// second nodes go as differences from the first, modulo 2^32; the page adds them back.
static void put_throats(struct arrays *arrays, const struct run *run,
                        const struct course *course, const struct grid *grid,
                        const uint32_t *second, struct shown_body *body)
{
    const struct network *network = &run->network;
    const int n = network->n_throat;
    struct emptying emptying = replay(run, course);
    uint32_t *column[5];
    for (int c = 0; c < 5; c++)
        column[c] = NEW_ARRAY(uint32_t, n);
    double *radius = NEW_ARRAY(double, n);
    int kept = 0;
    for (int t = 0; t < n; t++) {
        if (emptying.ends[t] == 0) continue;
        const uint32_t row[] = {(uint32_t)t, (uint32_t)network->throat_nodes[t][0],
                                second[t], emptying.leaves[t], emptying.ends[t]};
        for (int c = 0; c < 5; c++)
            column[c][kept] = row[c];
        radius[kept++] = network->throat_radius[t];
    }
    static const char *const name[] = {"throat.id", "throat.first", "throat.second",
                                       "throat.leaves", "throat.ends"};
    for (int c = 0; c < 5; c++) {
        for (int t = 0; c == 2 && t < kept; t++) // from the first: near, so small
            column[c][t] = (column[2][t] - column[1][t]);
        arrays_put(arrays, name[c], column[c], (size_t)kept, c < 2);
    }
    put_lengths(arrays, "throat.radius", radius, kept, grid->step);
    body->dry_throats = n - kept;
    body->refilled = emptying.refilled;
    free(radius);
    for (int c = 0; c < 5; c++)
        free(column[c]);
    free(emptying.leaves);
    free(emptying.ends);
}

// ---- bonds --------------------------------------------------------------------------

// Where bonds were broken when the replay began, "bond.earlier" says which: their key
// is 0, but they are no cracks of this replay.
static void put_bonds_before(struct arrays *arrays, const struct run *run,
                             uint32_t *key, uint32_t *mode)
{
    if (!run->n_before) return;
    const int n = run->packing.n_bond;
    uint32_t *earlier = NEW_ARRAY(uint32_t, n);
    for (int k = 0; k < run->n_before; k++) {
        const int bond = run->bond_before[k];
        key[bond] = 0;
        mode[bond] = run->mode_before[k];
        earlier[bond] = 1;
    }
    arrays_put(arrays, "bond.earlier", earlier, (size_t)n, false);
    free(earlier);
}

// The page draws a bond until its key, and its crack from then on.
static void put_bonds(struct arrays *arrays, const struct run *run,
                      const struct course *course)
{
    const int n = run->packing.n_bond;
    uint32_t *first = NEW_ARRAY(uint32_t, n), *second = NEW_ARRAY(uint32_t, n);
    uint32_t *key = NEW_ARRAY(uint32_t, n), *mode = NEW_ARRAY(uint32_t, n);
    for (int b = 0; b < n; b++) {
        first[b] = (uint32_t)run->packing.bond[b][0];
        second[b] = (uint32_t)(run->packing.bond[b][1] - run->packing.bond[b][0]);
        key[b] = NEVER;
    }
    for (int k = 0; k < run->n_crack; k++) {
        key[run->crack_bond[k]] = key_of(course, run->crack_time[k]);
        mode[run->crack_bond[k]] = run->crack_mode[k];
    }
    put_bonds_before(arrays, run, key, mode);
    arrays_put(arrays, "bond.first", first, (size_t)n, true);
    arrays_put(arrays, "bond.second", second, (size_t)n, false);
    arrays_put(arrays, "bond.breaks", key, (size_t)n, false);
    arrays_put(arrays, "bond.mode", mode, (size_t)n, false);
    free(first);
    free(second);
    free(key);
    free(mode);
}

// ---- forces -------------------------------------------------------------------------

// The largest force on each grain, and when. `heaviest` is the grain with the largest
// of all, the first of equals.
static void put_largest(struct arrays *arrays, const struct run *run,
                        const struct course *course, struct shown_body *body)
{
    const int n = run->packing.n_particle;
    double *largest = NEW_ARRAY(double, n);
    int *when = NEW_ARRAY(int, n);
    for (int m = 0; m < run->n_load; m++)
        for (int i = 0; i < n; i++) {
            const double force = norm(run->load[(size_t)m * (size_t)n + (size_t)i]);
            if (force <= largest[i]) continue;
            largest[i] = force;
            when[i] = m;
        }
    uint32_t *key = NEW_ARRAY(uint32_t, n);
    for (int i = 0; i < n; i++) {
        key[i] = key_of(course, run->load_time[when[i]]);
        if (largest[i] <= body->largest_load) continue;
        body->largest_load = largest[i];
        body->heaviest = i;
        body->heaviest_time = run->load_time[when[i]];
    }
    arrays_put_doubles(arrays, "grain.largest", largest, (size_t)n);
    arrays_put(arrays, "grain.largest_key", key, (size_t)n, false);
    free(largest);
    free(when);
    free(key);
}

// Mean and largest force over the loads. The mean is over grains, of the size of the
// force.
static void put_load_course(struct arrays *arrays, const struct run *run,
                            const struct course *course)
{
    const int n = run->packing.n_particle, n_load = run->n_load;
    double *mean = NEW_ARRAY(double, n_load), *largest = NEW_ARRAY(double, n_load);
    uint32_t *key = NEW_ARRAY(uint32_t, n_load);
    for (int m = 0; m < n_load; m++) {
        for (int i = 0; i < n; i++) {
            const double force = norm(run->load[(size_t)m * (size_t)n + (size_t)i]);
            mean[m] += force / n;
            largest[m] = fmax(largest[m], force);
        }
        key[m] = key_of(course, run->load_time[m]);
    }
    arrays_put(arrays, "load.key", key, (size_t)n_load, true);
    arrays_put_doubles(arrays, "load.mean", mean, (size_t)n_load);
    arrays_put_doubles(arrays, "load.largest", largest, (size_t)n_load);
    free(mean);
    free(largest);
    free(key);
}

// 128 is no force, so that both signs fit into a byte.
static uint32_t share_of(double force, double largest)
{
    return (uint32_t)lround(128 + (largest > 0 ? 127 * force / largest : 0));
}

// Some of the loads, evenly spaced along the course. In keys, not in loads: loads may
// crowd where the drying is fast.
static void put_moments(struct arrays *arrays, const struct run *run,
                        const struct course *course, int most, struct shown_body *body)
{
    const size_t n = (size_t)run->packing.n_particle;
    body->moment = NEW_ARRAY(int, most);
    uint32_t *key = NEW_ARRAY(uint32_t, most);
    uint32_t *value = NEW_ARRAY(uint32_t, 3 * n * (size_t)most);
    const double last = key_of(course, run->load_time[run->n_load - 1]);
    int shown = 0;
    for (int m = 0; m < run->n_load && shown < most; m++) {
        const uint32_t now = key_of(course, run->load_time[m]);
        if (now < shown * last / (most - 1 > 1 ? most - 1 : 1)) continue;
        key[shown] = now;
        body->moment[shown] = m;
        for (size_t i = 0; i < n; i++)
            for (int axis = 0; axis < 3; axis++)
                value[3 * ((size_t)shown * n + i) + (size_t)axis] = share_of(
                    component(run->load[(size_t)m * n + i], axis), body->largest_load);
        shown++;
    }
    arrays_put(arrays, "moment.key", key, (size_t)shown, true);
    arrays_put(arrays, "moment.force", value, 3 * n * (size_t)shown, false);
    body->n_moment = shown;
    free(key);
    free(value);
}

// ---- all ----------------------------------------------------------------------------

// A motion has moments even if nothing moves: its places are shown at them.
struct shown_body put_body(struct arrays *arrays, const struct run *run,
                           const struct course *course, int most_moments)
{
    struct shown_body body = {0};
    uint32_t *second = NEW_ARRAY(uint32_t, run->network.n_throat);
    int n_point = 0;
    struct vector *point = points_of(&run->network, second, &n_point);
    const struct grid grid = body.grid = grid_of(run, point, n_point);
    put_points(arrays, "grain", &grid, run->packing.position, run->packing.n_particle);
    put_lengths(arrays, "grain.radius", run->packing.radius, run->packing.n_particle,
                grid.step);
    put_bonds(arrays, run, course);
    if (run->network.n_throat) {
        put_points(arrays, "node", &grid, point, n_point);
        put_throats(arrays, run, course, &grid, second, &body);
    }
    if (run->n_load && run->packing.n_particle) {
        put_largest(arrays, run, course, &body);
        put_load_course(arrays, run, course);
        if (body.largest_load > 0 || run->motion)
            put_moments(arrays, run, course, most_moments, &body);
    }
    body.scales =
        json_pack("{s:[fff],s:f,s:f}", "origin", grid.origin.x, grid.origin.y,
                  grid.origin.z, "step", grid.step, "force", body.largest_load / 127);
    free(point);
    free(second);
    return body;
}

void shown_body_free(struct shown_body *body)
{
    json_decref(body->scales);
    free(body->moment);
    *body = (struct shown_body){0};
}
