// SPDX-License-Identifier: GPL-3.0-or-later
// The cycle, and what acts on it from outside.
#include "dem/engine.h"

#include "basics/barrier.h"
#include "basics/memory.h"
#include "basics/sorted.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

void dem_free(struct dem *dem)
{
    if (!dem) return;
    void *const owned[] = {dem->material,
                           dem->pair_friction,
                           dem->pair_restitution,
                           dem->identity,
                           dem->number,
                           dem->start,
                           dem->place,
                           dem->motion,
                           dem->external,
                           dem->applied,
                           dem->mobility,
                           dem->mass,
                           dem->weight,
                           dem->material_of,
                           dem->bond_particle,
                           dem->bond_radius,
                           dem->bond_strength[0],
                           dem->bond_strength[1],
                           dem->wall,
                           dem->wall_pair,
                           dem->wall_offset,
                           dem->pair_offset,
                           dem->pair_of,
                           dem->is_late,
                           dem->late,
                           dem->first_group,
                           dem->last_group,
                           dem->late_row,
                           dem->sum,
                           dem->place_at_search,
                           dem->grain_books,
                           dem->crack};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free_pairs(&dem->pairs);
    free_liquid(dem->liquid);
    free(dem);
}

void dem_set_force(struct dem *dem, const struct vector *force)
{
    const double unit = dem->unit.stiffness * dem->unit.length;
    if (!dem->applied) dem->applied = NEW_ARRAY(struct vector, dem->n_particle);
    for (int i = 0; i < dem->n_particle; i++) {
        const struct vector f = force[dem->identity[i]];
        dem->applied[i] = (struct vector){f.x / unit, f.y / unit, f.z / unit};
    }
    set_external(dem);
}

void dem_set_gravity(struct dem *dem, struct vector gravity)
{
    const double unit = dem->unit.length / (dem->unit.time * dem->unit.time);
    dem->gravity =
        (struct vector){gravity.x / unit, gravity.y / unit, gravity.z / unit};
    set_external(dem);
}

void dem_set_velocity(struct dem *dem, const struct vector *velocity,
                      const struct vector *spin)
{
    const double unit = dem->unit.length / dem->unit.time;
    for (int i = 0; i < dem->n_particle; i++) {
        const int32_t who = dem->identity[i];
        for (int axis = 0; axis < 3 && dem->mobility[i][0] > 0; axis++) {
            if (velocity)
                dem->motion[i].linear[axis] = component(velocity[who], axis) / unit;
            if (spin)
                dem->motion[i].angular[axis] =
                    component(spin[who], axis) * dem->unit.time;
        }
    }
}

void dem_stop(struct dem *dem, const bool *which)
{
    for (int i = 0; i < dem->n_particle; i++)
        for (int axis = 0; axis < 3 && which[dem->identity[i]]; axis++)
            dem->motion[i].linear[axis] = dem->motion[i].angular[axis] = 0;
}

void dem_set_friction(struct dem *dem, double friction)
{
    dem->pair_friction[0] = dem->law.friction = friction;
    for (int p = 0; dem->pairs.own && p < dem->pairs.n_pair; p++)
        set_pair_law(dem, p);
    set_wall_laws(dem);
}

void dem_set_local_damping(struct dem *dem, double share)
{
    dem->local_damping = share;
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

struct outcome {
    int n_broken;
    struct pace pace;
};

static void add_pace(struct outcome *outcome, struct pace pace)
{
    if (pace.largest > outcome->pace.largest) outcome->pace.largest = pace.largest;
    outcome->pace.sound = outcome->pace.sound && pace.sound;
}

// Groups BEGIN..END-1, and behind them the grains they finish.
static struct outcome sweep_share(struct dem *dem, int begin, int end)
{
    enum { BLOCK = 32 }; // groups, few enough for what they touch to stay cached
    struct outcome outcome = {0, {0, true}};
    int grain = // the first that groups before do not finish
        begin > 0 ? first_not_below(dem->last_group, dem->n_particle, begin) : 0;
    for (int block = begin; block < end; block += BLOCK) {
        const int next = block + BLOCK < end ? block + BLOCK : end;
        if (dem->liquid) wet_groups(dem, block, next);
        outcome.n_broken += dem->sweep(dem, block, next);
        const int finished = first_not_below(dem->last_group, dem->n_particle, next);
        add_pace(&outcome, move_grains(dem, grain, finished));
        grain = finished;
    }
    return outcome;
}

// Threads that go through cycles together, and what each did in the last.
struct crew {
    struct barrier barrier;
    struct outcome *part; // (barrier.size)
};

// Shares of equal size; then, when all are done, as much of the late grains each. Of
// each the parts of thread ME.
static struct outcome sweep_part(struct dem *dem, struct crew *crew, int me)
{
    const int n = dem->pairs.n_group, share = groups_in_share(dem);
    const int n_share = dem->n_share,
              late_share = (dem->n_late + n_share - 1) / n_share;
    struct outcome mine = {0, {0, true}};
    if (n == 0 && me == 0) mine.pace = move_grains(dem, 0, dem->n_particle);
    for (int t = me; t < n_share; t += crew->barrier.size) {
        const int begin = smaller(t * share, n);
        const struct outcome part = sweep_share(dem, begin, smaller(begin + share, n));
        mine.n_broken += part.n_broken;
        add_pace(&mine, part.pace);
    }
    barrier_wait(&crew->barrier);
    for (int t = me; t < n_share && n_share > 1; t += crew->barrier.size) {
        const int begin = smaller(t * late_share, dem->n_late);
        const int end = smaller(begin + late_share, dem->n_late);
        add_pace(&mine, move_late_grains(dem, begin, end));
    }
    return mine;
}

static void record_crack(struct dem *dem, int pair, int mode)
{
    const int bond = dem->pairs.bond[pair];
    dem->bond_strength[DEM_CRACK_NORMAL][bond] = -1;
    dem->bond_strength[DEM_CRACK_SHEAR][bond] = -1;
    GROW_ARRAY(dem->crack, dem->n_crack, dem->crack_capacity);
    dem->crack[dem->n_crack++] = (struct dem_crack){
        .bond = bond,
        .mode = (uint8_t)mode,
        .cycle = dem->cycle,
        .position = scale(dem->unit.length, pair_geometry(dem, pair, 1).position)};
}

static int by_bond(const void *a, const void *b)
{
    const struct dem_crack *p = a, *q = b;
    return (p->bond > q->bond) - (p->bond < q->bond);
}

static void record_cracks(struct dem *dem)
{
    const int before = dem->n_crack;
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        int8_t *crack = &dem->pairs.bonds[p / PAIRS_IN_GROUP].crack[p % PAIRS_IN_GROUP];
        if (*crack < 0) continue;
        record_crack(dem, p, *crack);
        *crack = -1;
    }
    qsort(dem->crack + before, (size_t)(dem->n_crack - before), sizeof *dem->crack,
          by_bond);
}

static double fastest_wall(const struct dem *dem)
{
    double fastest = 0;
    for (int w = 0; w < dem->n_wall; w++)
        fastest = fmax(fastest, norm(dem->wall[w].velocity));
    return fastest;
}

static enum status refuse_pace(const struct dem *dem, struct reason *reason)
{
    const double step = dem_time_step(dem), limit = dem_time_step_limit(dem);
    const bool is_stable = step <= limit;
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "diverged in cycle %lld: a grain or its surface would move more than "
                  "%g mean radii in one time step of %g s, %s the stability limit of "
                  "%g s%s",
                  (long long)dem->cycle, FURTHEST_STEP, step,
                  is_stable ? "within" : "past", limit,
                  is_stable ? ": too long for such a speed, try a smaller "
                              "time_step_safety"
                            : "");
}

// Cycles asked for, and how they go.
struct course {
    int64_t cycles, done;
    enum status status;
    struct reason *reason;
    bool pairs_are_due; // to be sought before the next
};

// What comes before the pairs are looked at.
static void approach_cycle(struct dem *dem, struct course *course)
{
    rest_or_wake(dem, course->cycles - course->done, course->done == 0);
    course->pairs_are_due = pairs_are_due(dem);
}

static void begin_cycle(struct dem *dem, const struct course *course)
{
    dem->keeps_loads = course->done == course->cycles - 1; // for who looks after it
    sweep_walls(dem);
}

static void end_cycle(struct dem *dem, struct outcome outcome, struct course *course)
{
    if (outcome.n_broken > 0) record_cracks(dem);
    if (dem->liquid) settle_bridges(dem);
    move_walls(dem);
    const double fastest = fmax(sqrt(outcome.pace.largest), fastest_wall(dem));
    dem->last_travel = dem->time_step * fastest;
    dem->travelled += dem->last_travel;
    if (!outcome.pace.sound) {
        wake_pairs(dem);
        course->status = refuse_pace(dem, course->reason);
        return;
    }
    dem->cycle++;
    course->done++;
}

static bool goes_on(const struct course *course)
{
    return course->done < course->cycles && course->status == STATUS_OK;
}

// The first thread does what all wait for.
static void follow(struct dem *dem, struct crew *crew, int me, struct course *course)
{
    do {
        crew->part[me] = sweep_part(dem, crew, me);
        barrier_wait(&crew->barrier);
        if (me == 0) {
            struct outcome total = crew->part[0];
            for (int t = 1; t < crew->barrier.size; t++) { // in any order the same
                total.n_broken += crew->part[t].n_broken;
                add_pace(&total, crew->part[t].pace);
            }
            end_cycle(dem, total, course);
            if (goes_on(course)) approach_cycle(dem, course);
            if (goes_on(course) && !course->pairs_are_due) begin_cycle(dem, course);
        }
        barrier_wait(&crew->barrier);
    } while (goes_on(course) && !course->pairs_are_due);
}

enum status dem_run(struct dem *dem, int64_t cycles, struct reason *reason)
{
    struct course course = {.cycles = cycles, .reason = reason};
    if (goes_on(&course)) approach_cycle(dem, &course);
    while (goes_on(&course)) {
        if (course.pairs_are_due) renew_pairs(dem); // by threads of its own
        begin_cycle(dem, &course);
        struct crew crew = {.barrier = {.size = dem->n_share},
                            .part = NEW_ARRAY(struct outcome, dem->n_share)};
#pragma omp parallel num_threads(dem->n_share)
        {
#pragma omp single
            crew.barrier.size = omp_get_num_threads(); // may be fewer than asked for
            follow(dem, &crew, omp_get_thread_num(), &course);
        }
        free(crew.part);
    }
    return course.status;
}

enum status dem_run_until(struct dem *dem, double tolerance, int64_t max_cycles,
                          struct reason *reason)
{
    enum { LOOK_EVERY = 16 };
    for (int64_t done = 0; done < max_cycles;) {
        const int64_t left = max_cycles - done;
        const int64_t cycles = left < LOOK_EVERY ? left : LOOK_EVERY;
        const enum status status = dem_run(dem, cycles, reason);
        if (status != STATUS_OK) return status;
        done += cycles;
        if (dem_unbalanced_ratio(dem) < tolerance) return STATUS_OK;
    }
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "unbalanced ratio %g is not below %g after %lld cycles",
                  dem_unbalanced_ratio(dem), tolerance, (long long)max_cycles);
}
