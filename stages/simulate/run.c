// SPDX-License-Identifier: GPL-3.0-or-later
// Sums are recorded at the times 0, T, 2 T, ... and at the end, snapshots likewise with
// an interval of their own. A moment has come when the next cycle would end further
// behind it than this one. So moments are met to half a time step, and the times that
// are written are those of the cycles.
//
// In this order: control (walls, servos, strain) every CONTROL_EVERY cycles, cycles up
// to the next of these moments, then what is due there. Cycles between looks at the
// checkpoint's clock change no result.
//
// The state that is kept is the engine's and the record; everything else follows from
// both. The next moment follows from the number of rows there are, not from a clock of
// its own, so that a run that goes on cannot count differently.
#include "run.h"

#include "basics/memory.h"
#include "control.h"
#include "dem/keep.h"
#include "geometry/porosity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// Cycles between two looks at the largest overlap: so many, fewer where a wall moves
// more than the share of a mean radius in them.
enum { LOOK_MOST = 1024, LOOK_LEAST = 16 };
static const double LOOK_SHARE = 0.1;
// No wall moves more than this share of a mean radius in a cycle, as no grain does.
static const double LARGEST_MOVE = 0.1;
static const char streams[] = "motion";

// A run on its way.
struct run {
    const struct simulate_parameters *parameters;
    struct scene *scene;
    struct outcome *outcome;
    bool controlled;
    double record_every, snapshots_every; // s
    int64_t asked;                        // cycles between questions to the keeper
    int64_t look_every;                   // cycles between looks at the overlaps
};

void outcome_free(struct outcome *outcome)
{
    dem_free(outcome->dem);
    record_free(&outcome->record);
    *outcome = (struct outcome){0};
}

static struct dem *dem_of(const struct run *run)
{
    return run->outcome->dem;
}

// ---- what is due --------------------------------------------------------------------

static int64_t rows(const struct run *run, const char *dataset)
{
    return recorded(&run->outcome->record, dataset)->rows;
}

// The last moment is the end of the run, whatever the interval: rows * every may pass
// it.
static double next_sums(const struct run *run)
{
    return fmin((double)rows(run, "/history/time") * run->record_every,
                run->parameters->duration);
}

// Snapshots may begin after the end of the run: then none is due, and record_end takes
// the only one.
static double next_snapshot(const struct run *run)
{
    const double from = run->parameters->snapshots_from;
    return fmin(from + (double)rows(run, "/snapshots/time") * run->snapshots_every,
                fmax(run->parameters->duration, from));
}

// Compared with half a step, not with equality: sums of time steps do not meet round
// numbers.
static bool has_come(const struct run *run, double moment)
{
    return dem_time(dem_of(run)) >= moment - 0.5 * dem_time_step(dem_of(run));
}

// The time of the last row of DATASET, or before all.
static double last_time(const struct run *run, const char *dataset)
{
    const struct recorded_column *c = recorded(&run->outcome->record, dataset);
    return c->rows > 0 ? ((const double *)c->data)[c->rows - 1] : -INFINITY;
}

// Without this the end could be recorded twice, and so could the moment at which a run
// goes on, if the interval is shorter than a time step.
static bool is_new(const struct run *run, const char *dataset)
{
    return dem_time(dem_of(run)) > last_time(run, dataset);
}

static void take_sums(struct run *run)
{
    record_sums(&run->outcome->record, run->scene, dem_of(run), dem_time(dem_of(run)));
}

static void take_snapshot(struct run *run)
{
    record_snapshot(&run->outcome->record, run->parameters, run->scene, dem_of(run),
                    dem_time(dem_of(run)));
}

static void record_what_is_due(struct run *run)
{
    if (has_come(run, next_sums(run)) && is_new(run, "/history/time")) take_sums(run);
    if (has_come(run, next_snapshot(run)) && is_new(run, "/snapshots/time") &&
        has_come(run, run->parameters->snapshots_from))
        take_snapshot(run);
}

// Whatever the intervals, the end is recorded.
static void record_end(struct run *run)
{
    if (is_new(run, "/history/time")) take_sums(run);
    if (is_new(run, "/snapshots/time")) take_snapshot(run);
}

// Only at multiples of CONTROL_EVERY, since the ratio costs O(pairs); these cycles are
// the same after a restart. Before the first cycle no force is known, and the ratio
// would be 0. It is 0 too where no force acts on grains that fly: those are not at
// rest.
static bool is_at_rest(const struct run *run)
{
    const struct dem *dem = dem_of(run);
    const bool is_asked = !isnan(run->parameters->stop_ratio) && dem_cycle(dem) > 0 &&
                          dem_cycle(dem) % CONTROL_EVERY == 0 &&
                          has_come(run, run->parameters->stop_after);
    if (!is_asked) return false;
    const double ratio = dem_unbalanced_ratio(dem);
    if (!(ratio < run->parameters->stop_ratio)) return false;
    return ratio > 0 || !(dem_energy(dem).kinetic > 0);
}

// ---- cycles -------------------------------------------------------------------------

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

// At least 1, so that a moment already passed by rounding cannot stall the run. 2^53
// keeps the conversion from a double defined.
static int64_t cycles_to(const struct run *run, double moment)
{
    const struct dem *dem = dem_of(run);
    const double left = (moment - dem_time(dem)) / dem_time_step(dem);
    return left > 0x1p53 ? (int64_t)1 << 53 : left > 1 ? (int64_t)rint(left) : 1;
}

// From 1 to OF, never 0: at a multiple the next one counts.
static int64_t cycles_to_multiple(const struct run *run, int64_t of)
{
    return of - dem_cycle(dem_of(run)) % of;
}

static int64_t next_cycles(const struct run *run)
{
    int64_t cycles = least(run->asked, cycles_to(run, run->parameters->duration));
    cycles = least(cycles, cycles_to(run, next_sums(run)));
    cycles = least(cycles, cycles_to(run, next_snapshot(run)));
    cycles = least(cycles, cycles_to_multiple(run, run->look_every));
    const bool looks = run->controlled || !isnan(run->parameters->stop_ratio);
    return looks ? least(cycles, cycles_to_multiple(run, CONTROL_EVERY)) : cycles;
}

// Pa, over the room between planes, which follows walls as they close in.
static double mean_pressure(const struct run *run, const struct dem_census *census)
{
    struct vector lower, upper;
    dem_box(dem_of(run), &lower, &upper);
    const struct vector edge = subtract(upper, lower);
    const double between = room(run->scene, dem_of(run)), box = box_volume(edge);
    const double sum =
        census->stress[0][0] + census->stress[1][1] + census->stress[2][2];
    return sum / 3 * (between > 0 ? box / between : 1);
}

static enum status check_overlap(const struct run *run, struct reason *reason)
{
    const struct dem_census census = dem_census(dem_of(run));
    const double most = run->parameters->largest_overlap;
    const bool wall = census.wall_overlap > fmax(most, census.largest_overlap);
    if (!wall && !(census.largest_overlap > most)) return STATUS_OK;
    char what[300] = "two grains overlap";
    if (wall)
        snprintf(what, sizeof what, "wall %s, pushed with %.4g N, and a grain overlap",
                 run->scene->wall_more[census.deepest_wall].name,
                 norm(dem_wall_state(dem_of(run), census.deepest_wall).force));
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "at %.4g s %s by %.3g mean radii, above largest_overlap=%g, under a "
                  "mean pressure of %.4g Pa: stiffer grains, %s",
                  dem_time(dem_of(run)), what,
                  wall ? census.wall_overlap : census.largest_overlap, most,
                  mean_pressure(run, &census),
                  run->parameters->adhesion > 0
                      ? "less adhesion, or walls that close in less"
                      : "or walls that close in less");
}

static enum status advance(struct run *run, struct reason *reason)
{
    struct dem *dem = dem_of(run);
    struct reason cause;
    if (run->controlled && dem_cycle(dem) % CONTROL_EVERY == 0 &&
        control(run->parameters, run->scene, dem_time(dem), dem, &cause))
        return refuse(reason, STATUS_NOT_CONVERGED, "at %.4g s: %.400s", dem_time(dem),
                      cause.text);
    enum status status = dem_run(dem, next_cycles(run), &cause);
    if (status)
        return refuse(reason, status, "at %.4g s: %.400s", dem_time(dem), cause.text);
    if (dem_cycle(dem) % run->look_every == 0) status = check_overlap(run, reason);
    return status;
}

// ---- checkpoint ---------------------------------------------------------------------

static void keep(const struct run *run, const struct keeper *keeper)
{
    struct checkpoint_stream stream = stream_to_keep();
    record_state(&run->outcome->record, &stream);
    keep_state(keeper, dem_of(run), stream_list(&stream, streams));
    stream_free(&stream);
}

// The engine first: it checks that the arrays are of this scene before anything else is
// read.
static enum status go_on(struct run *run, const struct kept_state *kept,
                         struct reason *reason)
{
    const struct array_list *engine = &kept->engine;
    const enum status status =
        dem_restore(dem_of(run), engine->array, engine->count, reason);
    if (status) return status;
    struct checkpoint_stream stream = stream_to_restore(&kept->stage, streams);
    record_state(&run->outcome->record, &stream);
    if (stream_is_whole(&stream)) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA, "/stage: is not the state of this scene");
}

// ---- the whole ----------------------------------------------------------------------

static double interval(double given, double duration, double count)
{
    if (!isnan(given)) return given;
    return duration > 0 ? duration / count : 1;
}

double snapshot_interval(const struct simulate_parameters *parameters)
{
    return interval(parameters->snapshots_every, parameters->duration, 20);
}

// m/s, of wall W with the largest of its factors, servo included.
static double largest_speed(const struct scene *scene, int w)
{
    const struct dem_wall *wall = &scene->wall[w];
    const struct time_table *motion = scene->wall_more[w].motion;
    double factor = motion && motion->times.count > 0 ? 0 : 1;
    for (int k = 0; motion && k < motion->factors.count; k++)
        factor = fmax(factor, fabs(motion->factors.value[k]));
    return factor * norm(wall->velocity) + wall->servo_largest_speed;
}

// Finds how often to look at the overlaps. Fast walls pass through grains in a cycle.
static enum status check_speeds(struct run *run, struct reason *reason)
{
    const struct scene *scene = run->scene;
    const struct packing *packing = scene->setup.packing;
    const double step = dem_time_step(dem_of(run));
    const double radius = mean_radius(packing);
    run->look_every = LOOK_MOST;
    for (int w = 0; w < scene->setup.n_wall; w++) {
        const double move = largest_speed(scene, w) * step / radius;
        if (move > LARGEST_MOVE)
            return refuse(reason, STATUS_BAD_DATA,
                          "%s: moves by %.3g mean radii in a time step of "
                          "%.4g s, above %g: slower walls, or a smaller time step",
                          scene->wall_more[w].key, move, step, LARGEST_MOVE);
        while (run->look_every > LOOK_LEAST &&
               (double)run->look_every * move > LOOK_SHARE)
            run->look_every /= 2;
    }
    return STATUS_OK;
}

static enum status check_servos(const struct run *run, struct reason *reason)
{
    const struct scene *scene = run->scene;
    for (int w = 0; w < scene->setup.n_wall; w++) {
        if (isnan(scene->wall_more[w].servo_pressure)) continue;
        if (servo_area(scene, dem_of(run), w) > 0) continue;
        return refuse(reason, STATUS_BAD_DATA,
                      "%s.servo.area: must be given: no planes or sides "
                      "of the box bound a rectangle across its normal",
                      scene->wall_more[w].key);
    }
    return STATUS_OK;
}

// A grain that begins deep in a wall would be shot out of it. Only where the run
// begins: one that goes on has passed it, and grains may lie deeper under load by then.
static enum status check_walls(const struct run *run, struct reason *reason)
{
    for (int w = 0; w < run->scene->setup.n_wall; w++) {
        double overlap;
        const int grain = dem_deepest_in_wall(dem_of(run), w, &overlap);
        if (overlap > run->parameters->largest_overlap)
            return refuse(reason, STATUS_BAD_DATA,
                          "%s: grain %d begins in it, by %.3g of its "
                          "radius, at (%.4g, %.4g, %.4g) m",
                          run->scene->wall_more[w].key, grain, overlap,
                          run->scene->setup.packing->position[grain].x,
                          run->scene->setup.packing->position[grain].y,
                          run->scene->setup.packing->position[grain].z);
    }
    return STATUS_OK;
}

// Leapfrog begins with velocities of half a step before: v - g dt / 2, so that grains
// that nothing touches fall exactly.
static void set_velocities(const struct run *run)
{
    const struct scene *scene = run->scene;
    const double half = 0.5 * dem_time_step(dem_of(run));
    const int n = scene->setup.packing->n_particle;
    struct vector *velocity = NEW_ARRAY(struct vector, n);
    for (int i = 0; i < n; i++)
        velocity[i] = subtract(scene->velocity[i], scale(half, scene->setup.gravity));
    dem_set_velocity(dem_of(run), velocity, scene->spin);
    free(velocity);
}

static enum status begin(struct run *run, const struct vector *force, int threads,
                         const struct keeper *keeper, struct reason *reason)
{
    struct scene *scene = run->scene;
    scene->setup.threads = threads;
    enum status status = dem_create(&run->outcome->dem, &scene->setup, reason);
    if (status) return status;
    status = check_speeds(run, reason);
    if (!status) status = check_servos(run, reason);
    if (status) return status;
    set_velocities(run);
    if (force) dem_set_force(dem_of(run), force);
    if (keeper && keeper->begin) return go_on(run, keeper->begin, reason);
    return check_walls(run, reason);
}

// Of walls and groups that move as they will in the first cycle, as dashpots feel that.
static void find_first_forces(const struct run *run)
{
    struct dem *dem = dem_of(run);
    if (dem_cycle(dem) > 0) return;
    if (run->controlled) set_motions(run->parameters, run->scene, 0, dem);
    dem_find_forces(dem);
}

// `duration` may be 0: then the state at the start is recorded and written.
enum status run_scene(const struct simulate_parameters *parameters, struct scene *scene,
                      const struct vector *force, int threads,
                      void (*tell)(void *context, double fraction), void *context,
                      const struct keeper *keeper, struct outcome *outcome,
                      struct reason *reason)
{
    const double duration = parameters->duration;
    *outcome = (struct outcome){.record = record_init(parameters, scene)};
    struct run run = {.parameters = parameters,
                      .scene = scene,
                      .outcome = outcome,
                      .controlled = is_controlled(parameters, scene),
                      .record_every = interval(parameters->record_every, duration, 200),
                      .snapshots_every = snapshot_interval(parameters),
                      .asked =
                          cycles_between_questions(scene->setup.packing->n_particle)};
    enum status status = begin(&run, force, threads, keeper, reason);
    if (status) return status;
    find_first_forces(&run);
    record_what_is_due(&run);
    while (!has_come(&run, duration) && !is_at_rest(&run)) {
        status = advance(&run, reason);
        if (status) return status;
        record_what_is_due(&run);
        tell(context, fmin(dem_time(outcome->dem) / duration, 1));
        if (is_due(keeper)) keep(&run, keeper);
    }
    outcome->ending = has_come(&run, duration) ? ENDED_IN_TIME : ENDED_AT_REST;
    record_end(&run);
    return check_overlap(&run, reason);
}
