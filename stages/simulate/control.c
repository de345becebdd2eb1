// SPDX-License-Identifier: GPL-3.0-or-later
// Unknowns: the factor f(t) on velocity, spin and servo of a wall or driven group, the
// area A of a servo, the stretch of the box.
//
// A table of time gives f, linear between its rows and constant outside. The engine
// takes constants, so `control` sets them anew every CONTROL_EVERY = n cycles of dt, to
// the mean of f over them,
//
//     factor = (F(t + n dt) - F(t)) / (n dt),    F = integral_to.
//
// The integral telescopes: a wall goes exactly as far as the table says, with f at t it
// would be off by half a span times the change of f. Only where the engine shortens dt
// within a span is the mean of that span a little off.
//
// A servo with a pressure p gets the force p A, with A the rectangle between the planes
// across the two other axes (the box where there is none), as these planes lie now.
//
// A box strained at the rate e grows by exp(e n dt) in n cycles. Growth by 1 + e n dt
// would depend on n. With the exponential, ln(edge / first edge) = e t: e is a rate of
// true (logarithmic) strain.
#include "control.h"

#include <math.h>

// Integral of the factor from the first time of the table to TIME. Before the first
// time f is constant too, so the integral is negative there. `share` is the part of the
// segment that lies before TIME; the mean of f over it is f at its middle.
static double integral_to(const struct time_table *table, double time)
{
    const int n = table->times.count;
    const double *t = table->times.value, *f = table->factors.value;
    if (time <= t[0]) return f[0] * (time - t[0]);
    double sum = 0;
    for (int k = 1; k < n; k++) {
        const double end = fmin(time, t[k]),
                     share = (end - t[k - 1]) / (t[k] - t[k - 1]);
        sum += (end - t[k - 1]) * (f[k - 1] + 0.5 * share * (f[k] - f[k - 1]));
        if (time <= t[k]) return sum;
    }
    return sum + f[n - 1] * (time - t[n - 1]);
}

double mean_factor(const struct time_table *table, double time, double span)
{
    if (!table || table->times.count == 0) return 1;
    return (integral_to(table, time + span) - integral_to(table, time)) / span;
}

static bool strains(const struct simulate_parameters *parameters)
{
    return norm(as_vector(parameters->strain_rate)) > 0;
}

static bool has_table(const struct time_table *table)
{
    return table && table->times.count > 0;
}

// A servo with a pressure counts even without a table: its area changes as other walls
// move. A servo with a force does not, because the engine keeps it.
bool is_controlled(const struct simulate_parameters *parameters,
                   const struct scene *scene)
{
    bool any = strains(parameters);
    for (int w = 0; w < scene->setup.n_wall; w++)
        any = any || has_table(scene->wall_more[w].motion) ||
              !isnan(scene->wall_more[w].servo_pressure);
    for (int k = 0; k < scene->n_group; k++)
        any = any || (scene->driven_group[k] >= 0 &&
                      has_table(&group_row(parameters, k)->motion));
    return any;
}

// ---- servos -------------------------------------------------------------------------

// The axis that N points along, 0 to 2, or -1. Within 1e-9 only, some digits above
// rounding: a rectangle between planes has an area by axes only if the planes are
// square to each other.
static int axis_of(struct vector n)
{
    const double length = norm(n);
    for (int axis = 0; axis < 3; axis++)
        if (fabs(component(n, axis)) > (1 - 1e-9) * length) return axis;
    return -1;
}

// The room along AXIS between the planes that face each other across it. Of several
// planes on one side the innermost bounds it. A plane that looks up along the axis is a
// lower bound, whatever its position: grains stay on the side of its normal.
static double room_along(const struct scene *scene, const struct dem *dem, int axis)
{
    struct vector lower, upper;
    dem_box(dem, &lower, &upper);
    double from = component(lower, axis), to = component(upper, axis);
    double highest = -INFINITY, lowest = INFINITY;
    for (int w = 0; w < scene->setup.n_wall; w++) {
        const struct dem_wall *wall = &scene->wall[w];
        if (wall->shape != DEM_PLANE || axis_of(wall->normal) != axis) continue;
        const double at = component(wall->point, axis) +
                          component(dem_wall_state(dem, w).displacement, axis);
        if (component(wall->normal, axis) > 0)
            highest = fmax(highest, at);
        else
            lowest = fmin(lowest, at);
    }
    if (isfinite(highest)) from = highest;
    if (isfinite(lowest)) to = lowest;
    return fmax(to - from, 0);
}

// The two axes across the normal span the rectangle. An area that the user gave wins,
// also for planes that are not along two axes.
double servo_area(const struct scene *scene, const struct dem *dem, int w)
{
    if (!isnan(scene->wall_more[w].servo_area)) return scene->wall_more[w].servo_area;
    const int axis = axis_of(scene->wall[w].normal);
    if (axis < 0) return NAN;
    return room_along(scene, dem, (axis + 1) % 3) *
           room_along(scene, dem, (axis + 2) % 3);
}

double room(const struct scene *scene, const struct dem *dem)
{
    return room_along(scene, dem, 0) * room_along(scene, dem, 1) *
           room_along(scene, dem, 2);
}

// ---- all of it ----------------------------------------------------------------------

// The scene keeps the velocity, spin and force at the factor 1, so that factors do not
// multiply up over the calls.
static void move_wall(const struct scene *scene, double time, struct dem *dem, int w)
{
    const struct dem_wall *wall = &scene->wall[w];
    const struct scene_wall *more = &scene->wall_more[w];
    const double span = CONTROL_EVERY * dem_time_step(dem);
    const double factor = mean_factor(more->motion, time, span);
    if (has_table(more->motion))
        dem_set_wall_motion(dem, w, scale(factor, wall->velocity),
                            scale(factor, wall->spin));
    if (!isnan(more->servo_pressure))
        dem_set_servo(dem, w,
                      factor * more->servo_pressure * servo_area(scene, dem, w));
    else if (wall->servo_force > 0 && has_table(more->motion))
        dem_set_servo(dem, w, factor * wall->servo_force);
}

static enum status strain_box(const struct simulate_parameters *parameters,
                              struct dem *dem, struct reason *reason)
{
    const double span = CONTROL_EVERY * dem_time_step(dem);
    double stretch[3];
    for (int axis = 0; axis < 3; axis++)
        stretch[axis] = exp(parameters->strain_rate[axis] * span);
    return dem_strain(dem, stretch, reason);
}

struct vector strain_velocity(const struct simulate_parameters *parameters,
                              struct vector lower, struct vector place)
{
    const double *rate = parameters->strain_rate;
    const struct vector from = subtract(place, lower);
    return (struct vector){rate[0] * from.x, rate[1] * from.y, rate[2] * from.z};
}

// A driven group turns about its axis at a signed rate. So a factor below 0 turns it
// back without a new axis.
void set_motions(const struct simulate_parameters *parameters,
                 const struct scene *scene, double time, struct dem *dem)
{
    for (int w = 0; w < scene->setup.n_wall; w++)
        move_wall(scene, time, dem, w);
    for (int k = 0; k < scene->n_group; k++) {
        const struct group_parameters *row = group_row(parameters, k);
        const int driven = scene->driven_group[k];
        if (driven < 0 || !has_table(&row->motion)) continue;
        const double factor =
            mean_factor(&row->motion, time, CONTROL_EVERY * dem_time_step(dem));
        dem_set_group_motion(dem, driven, scale(factor, as_vector(row->velocity)),
                             factor * norm(as_vector(row->spin)));
    }
}

enum status control(const struct simulate_parameters *parameters,
                    const struct scene *scene, double time, struct dem *dem,
                    struct reason *reason)
{
    set_motions(parameters, scene, time, dem);
    return strains(parameters) ? strain_box(parameters, dem, reason) : STATUS_OK;
}
