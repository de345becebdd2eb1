// SPDX-License-Identifier: GPL-3.0-or-later
// The cycle, and what acts on it from outside.
//
// One cycle is one step of leapfrog [K 4.1-4.6]. Forces F belong to time t, velocities
// v to t - dt/2, displacements u to t:
//     F = F(u, v) from pairs, walls and outside,
//     v += dt F / m,   omega += dt M / I,   u += dt v.
// So forces are known at the places before the last displacement, and velocities are
// half a step behind the displacements. energy.c and observe.c account for that.
//
// A team of threads runs cycles together until pairs must be sought again. Each thread
// finds the forces of its share of walls, and when all threads have, sweeps its chunks
// of pair groups and, close behind, moves the grains that are finished. After a barrier
// the threads move the shared grains (engine.h). After a second barrier the first
// thread ends the cycle and begins the next.
#include "dem/engine.h"

#include "basics/barrier.h"
#include "basics/memory.h"
#include "basics/sorted.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void dem_free(struct dem *dem)
{
    if (!dem) return;
    void *const owned[] = {dem->material,
                           dem->pair_friction,
                           dem->pair_restitution,
                           dem->pair_rolling_friction,
                           dem->id,
                           dem->index,
                           dem->start,
                           dem->place,
                           dem->velocity, // and spins
                           dem->external,
                           dem->applied,
                           dem->mobility,
                           dem->mass,
                           dem->weight,
                           dem->inertia_factor,
                           dem->material_of,
                           dem->group,
                           dem->group_of,
                           dem->lever,
                           dem->bond_particle,
                           dem->shrinkage,
                           dem->first_radius,
                           dem->bond_radius,
                           dem->bond_strength[0],
                           dem->bond_strength[1],
                           dem->wall,
                           dem->wall_pair,
                           dem->wall_offset,
                           dem->pair_offset,
                           dem->pair_of,
                           dem->spare_block,
                           dem->is_shared,
                           dem->shared_grain,
                           dem->first_group,
                           dem->last_group,
                           dem->first_row,
                           dem->sum,
                           dem->place_at_search,
                           dem->half_skin,
                           dem->grain_ledger,
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
        const struct vector f = force[dem->id[i]];
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
        const int32_t who = dem->id[i];
        for (int axis = 0; axis < 3 && dem->mobility[i][0] > 0; axis++) {
            if (velocity)
                velocity_of(dem, i)[axis] = component(velocity[who], axis) / unit;
            if (spin)
                spin_of(dem, i)[axis] = component(spin[who], axis) * dem->unit.time;
        }
    }
}

void dem_stop(struct dem *dem, const bool *which)
{
    for (int i = 0; i < dem->n_particle; i++)
        for (int axis = 0; axis < 3 && which[dem->id[i]] && !is_driven(dem, i); axis++)
            velocity_of(dem, i)[axis] = spin_of(dem, i)[axis] = 0;
}

void dem_set_friction(struct dem *dem, double friction)
{
    dem->pair_friction[0] = dem->law.friction = friction;
    for (int p = 0; dem->pairs.laws && p < dem->pairs.n_pair; p++)
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
    struct max_speed max_speed;
};

static void merge_max_speed(struct outcome *outcome, struct max_speed speed)
{
    if (speed.square > outcome->max_speed.square)
        outcome->max_speed.square = speed.square;
    if (speed.shares > outcome->max_speed.shares)
        outcome->max_speed.shares = speed.shares;
    outcome->max_speed.valid = outcome->max_speed.valid && speed.valid;
}

// Sweeps groups BEGIN..END-1 and moves the grains that these finish.
static struct outcome sweep_chunk(struct dem *dem, int begin, int end)
{
    enum { BLOCK = 32 }; // groups, few enough for what they touch to stay cached
    struct outcome outcome = {.max_speed.valid = true};
    int grain = // the first that groups before do not finish
        begin > 0 ? first_not_below(dem->last_group, dem->n_particle, begin) : 0;
    for (int block = begin; block < end; block += BLOCK) {
        const int next = block + BLOCK < end ? block + BLOCK : end;
        if (dem->liquid) update_bridges(dem, block, next);
        outcome.n_broken += dem->sweep(dem, block, next);
        const int finished = first_not_below(dem->last_group, dem->n_particle, next);
        merge_max_speed(&outcome, move_grains(dem, grain, finished));
        grain = finished;
    }
    return outcome;
}

// The threads that run cycles together, and what each did in the last cycle.
struct team {
    struct barrier barrier;
    struct outcome *part; // (barrier.size)
};

// Part of thread ME in the forces of walls, which grains need before they move.
static void touch_walls_together(struct dem *dem, struct team *team, int me)
{
    const int n = dem->n_wall_pair, share = (n + dem->n_chunk - 1) / dem->n_chunk;
    for (int t = me; t < dem->n_chunk; t += team->barrier.size)
        touch_walls(dem, smaller(t * share, n), smaller((t + 1) * share, n));
    barrier_wait(&team->barrier);
}

// Work of thread ME in one cycle: its chunks of groups, and then, when all threads are
// there, its part of the shared grains.
static struct outcome sweep_chunks(struct dem *dem, struct team *team, int me)
{
    const int n = dem->pairs.n_group, share = groups_in_chunk(dem);
    const int n_chunk = dem->n_chunk,
              shared_in_chunk = (dem->n_shared + n_chunk - 1) / n_chunk;
    struct outcome mine = {.max_speed.valid = true};
    if (walls_are_shared(dem)) touch_walls_together(dem, team, me);
    if (n == 0 && me == 0) mine.max_speed = move_grains(dem, 0, dem->n_particle);
    for (int t = me; t < n_chunk; t += team->barrier.size) {
        const int begin = smaller(t * share, n);
        const struct outcome part = sweep_chunk(dem, begin, smaller(begin + share, n));
        mine.n_broken += part.n_broken;
        merge_max_speed(&mine, part.max_speed);
    }
    barrier_wait(&team->barrier);
    for (int t = me; t < n_chunk && n_chunk > 1; t += team->barrier.size) {
        const int begin = smaller(t * shared_in_chunk, dem->n_shared);
        const int end = smaller(begin + shared_in_chunk, dem->n_shared);
        merge_max_speed(&mine, move_shared_grains(dem, begin, end));
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
        .time = dem_time(dem),
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

static enum status report_divergence(const struct dem *dem, struct reason *reason)
{
    const double step = dem_time_step(dem), limit = dem_time_step_limit(dem);
    const bool is_stable = step <= limit;
    char half[100] = ""; // a step of at most half
    if (is_stable)
        snprintf(half, sizeof half, ": too long for such a speed: try %s=%.2g",
                 dem->safety_key ? dem->safety_key : "time_step",
                 dem->safety_key ? dem->time_step / dem->critical_step / 2 : step / 2);
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "diverged in cycle %lld: a grain or its surface would move more than "
                  "%g mean radii in one time step of %g s, %s the stability limit of "
                  "%g s%s",
                  (long long)dem->cycle, MAX_STEP, step, is_stable ? "within" : "past",
                  limit, half);
}

// A run: cycles wanted and done, and how it stands.
struct run_control {
    int64_t cycles, done;
    enum status status;
    struct reason *reason;
    bool pairs_are_due; // to be sought before the next
};

// Before the pairs of a cycle are swept: which pairs can be left out, and whether pairs
// must be sought.
static void prepare_cycle(struct dem *dem, struct run_control *control)
{
    update_inactive_pairs(dem, control->cycles - control->done, control->done == 0);
    control->pairs_are_due = pairs_are_due(dem);
}

static void begin_cycle(struct dem *dem, const struct run_control *control)
{
    dem->keeps_loads = control->done == control->cycles - 1; // for who looks after it
    begin_walls(dem);
    if (!walls_are_shared(dem)) touch_walls(dem, 0, dem->n_wall_pair);
    advance_groups(dem);
}

static void end_cycle(struct dem *dem, struct outcome outcome,
                      struct run_control *control)
{
    const bool begins = dem->cycle == 0 && dem->n_bond > 0; // see dem_find_forces
    if (outcome.n_broken > 0 || begins) record_cracks(dem);
    if (dem->liquid) publish_bridge_counts(dem);
    add_up_walls(dem);
    move_walls(dem);
    const double dt = dem->time_step, wall = fastest_wall(dem);
    dem->last_travel = dt * fmax(sqrt(outcome.max_speed.square), wall);
    dem->used += dt * fmax(sqrt(outcome.max_speed.shares), wall / (0.5 * dem->skin));
    if (!outcome.max_speed.valid) {
        reactivate_pairs(dem);
        control->status = report_divergence(dem, control->reason);
        return;
    }
    dem->cycle++;
    control->done++;
}

static bool is_running(const struct run_control *control)
{
    return control->done < control->cycles && control->status == STATUS_OK;
}

// Runs cycles as thread ME until the run ends or pairs must be sought. What is not
// shared among threads, the first thread does while the others wait.
static void run_cycles(struct dem *dem, struct team *team, int me,
                       struct run_control *control)
{
    do {
        team->part[me] = sweep_chunks(dem, team, me);
        barrier_wait(&team->barrier);
        if (me == 0) {
            struct outcome total = team->part[0];
            for (int t = 1; t < team->barrier.size; t++) { // in any order the same
                total.n_broken += team->part[t].n_broken;
                merge_max_speed(&total, team->part[t].max_speed);
            }
            end_cycle(dem, total, control);
            if (is_running(control)) prepare_cycle(dem, control);
            if (is_running(control) && !control->pairs_are_due)
                begin_cycle(dem, control);
        }
        barrier_wait(&team->barrier);
    } while (is_running(control) && !control->pairs_are_due);
}

enum status dem_run(struct dem *dem, int64_t cycles, struct reason *reason)
{
    struct run_control control = {.cycles = cycles, .reason = reason};
    if (is_running(&control)) prepare_cycle(dem, &control);
    while (is_running(&control)) {
        if (control.pairs_are_due) renew_pairs(dem); // by threads of its own
        begin_cycle(dem, &control);
        struct team team = {.barrier = {.size = dem->n_chunk},
                            .part = NEW_ARRAY(struct outcome, dem->n_chunk)};
#pragma omp parallel num_threads(dem->n_chunk)
        {
#pragma omp single
            team.barrier.size = omp_get_num_threads(); // may be fewer than asked for
            run_cycles(dem, &team, omp_get_thread_num(), &control);
        }
        free(team.part);
    }
    return control.status;
}

// The forces of the first cycle, which will find the same ones: without a step done no
// history grows and nothing is booked. Bonds that break are recorded by that cycle.
void dem_find_forces(struct dem *dem)
{
    if (dem->cycle > 0) return;
    dem->keeps_loads = true;
    begin_walls(dem);
    touch_walls(dem, 0, dem->n_wall_pair);
    if (dem->liquid) update_bridges(dem, 0, dem->pairs.n_group);
    dem->sweep(dem, 0, dem->pairs.n_group);
    if (dem->liquid) publish_bridge_counts(dem);
    add_up_walls(dem);
    memset(dem->sum, 0, dem->sum_room * sizeof *dem->sum);
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
