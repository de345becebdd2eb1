// SPDX-License-Identifier: GPL-3.0-or-later
// The load of a step on the grains where they are now: forces of the liquid, shrinkage,
// suction of the menisci. What nothing balances is taken off: the net load of a free
// body, and those of fragments that came loose. At the first step the load grows
// linearly; for a body with weight, with share from 0 to 1,
//     force = weight + share (load - weight).
#include "replay_by_cycles.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Forces keep their directions when a free body rotates, and would rotate it further:
// the load removed is adapted to the grains often enough to bring such motion to rest.
// Loose grains are stopped less often: the speed they gain meanwhile breaks nothing
// (their kinetic energy grows with the square of this number).
enum { TAKE_OFF_EVERY = 16, STOP_EVERY = 64 }; // cycles

// Menisci follow the grains as often: these move by a small part of a throat meanwhile.
enum { FOLLOW_EVERY = 16 };

bool unloads(const struct run *run)
{
    return run->settings->loose == LOOSE_UNLOADED && run->packing->n_bond > 0 &&
           !(run->settings->liquid.volume > 0);
}

int64_t load_holds(const struct run *run)
{
    if (run->load->drains) return FOLLOW_EVERY;
    if (run->load->shrinks && run->settings->support != SUPPORT_FREE) return STOP_EVERY;
    if (run->settings->support == SUPPORT_FREE) return TAKE_OFF_EVERY;
    return unloads(run) ? STOP_EVERY : INT64_MAX;
}

// Finds the loose grains again if bonds have broken, and stops them when it is time.
static void follow_loose(struct run *run)
{
    struct by_cycles *state = run->state;
    if (!unloads(run)) return;
    int n_crack;
    dem_cracks(state->dem, &n_crack);
    if (!state->has_looked || n_crack != state->n_crack)
        find_loose(&state->loose, run->packing, run->settings->held, state->dem);
    state->has_looked = true;
    state->n_crack = n_crack;
    const int64_t now = dem_cycle(state->dem) - run->place.began;
    if (state->loose.n_loose > 0 && now % STOP_EVERY == 0)
        dem_stop(state->dem, state->loose.is_loose);
}

// Removes the net loads of loose fragments. On a wall, the grains that are not loose
// take these over, so that the wall still carries the net load of all.
static void take_off_loose(struct run *run)
{
    const struct loose_grains *loose = &state_of(run)->loose;
    struct vector *displacement = NEW_ARRAY(struct vector, run->packing->n_particle);
    dem_displacements(dem_of(run), displacement);
    const struct net_load off =
        relieve_loose(loose, run->packing, displacement, run->force);
    if (run->settings->support == SUPPORT_WALL)
        put_on_net_load(run->packing, loose->is_loose, displacement, off, run->force);
    free(displacement);
}

// Removes the net load of a free body.
static void take_off(struct run *run)
{
    struct vector *state[3];
    for (int k = 0; k < 3; k++)
        state[k] = NEW_ARRAY(struct vector, run->packing->n_particle);
    dem_displacements(dem_of(run), state[0]);
    dem_velocities(dem_of(run), state[1]);
    dem_spins(dem_of(run), state[2]);
    const struct moving_grains now = {state[0], state[1], state[2],
                                      run->settings->material.density,
                                      TAKE_OFF_EVERY * dem_time_step(dem_of(run))};
    run->taken_off = take_off_net_load(run->packing, state_of(run)->loose.is_loose,
                                       &now, run->force);
    for (int k = 0; k < 3; k++)
        free(state[k]);
}

int64_t ramp(const struct run *run)
{
    const bool is_first = run->place.step == 0 && !run->settings->begin;
    return is_first ? run->settings->ramp : 0;
}

// Below the end of the ramp the load is a part of its row; without weight it grows from
// 0.
static void grow(struct run *run)
{
    const struct vector *weight = run->settings->weight; // is on already
    const int64_t next = dem_cycle(dem_of(run)) - run->place.began + 1;
    const double share = (double)next / (double)ramp(run);
    for (int i = 0; next < ramp(run) && i < run->packing->n_particle; i++)
        run->force[i] =
            weight ? add(weight[i], scale(share, subtract(run->force[i], weight[i])))
                   : scale(share, run->force[i]);
}

void find_due(const struct run *run, int row, double *strain)
{
    const struct by_cycles *state = run->state;
    const int n = run->packing->n_particle;
    if (row < 0 && state->due)
        memcpy(strain, state->due, (size_t)n * sizeof *strain);
    else
        shrinkage_by_law(run, row, strain);
}

// Shrinks grains to SHARE of the way from the shrinkage of the row before to that of
// this one, but none swells: not where liquid comes back, nor after an earlier replay.
static void shrink_to(struct run *run, double share)
{
    const int n = run->packing->n_particle, row = run->place.step;
    if (!run->load->shrinks || row < 0) return;
    double *from = NEW_ARRAY(double, n), *to = NEW_ARRAY(double, n),
           *strain = NEW_ARRAY(double, n);
    find_due(run, row - 1, from);
    find_due(run, row, to);
    dem_shrinkage(dem_of(run), strain);
    for (int i = 0; i < n; i++) {
        const double before = strain[i];
        strain[i] = fmax(before, from[i] + share * (to[i] - from[i]));
        run->response->most_at_once =
            fmax(run->response->most_at_once, strain[i] - before);
    }
    dem_set_shrinkage(dem_of(run), strain);
    free(from);
    free(to);
    free(strain);
}

void shrink(struct run *run)
{
    const int64_t since = dem_cycle(dem_of(run)) - run->place.began;
    const int64_t done = since - ramp(run), holds = load_holds(run);
    if (done < 0 || done >= run->settings->cycles) return;
    const int64_t next = done + holds - since % holds;
    shrink_to(run, fmin(1, (double)next / (double)run->settings->cycles));
}

void apply_forces(struct run *run)
{
    shrink(run);
    take_forces(run);
    grow(run);
    if (run->load->drains && run->place.step >= 0)
        add_capillary_forces(&state_of(run)->drainage, dem_of(run), run->force);
    follow_loose(run);
    if (state_of(run)->loose.n_loose > 0) take_off_loose(run);
    if (run->settings->support == SUPPORT_FREE) take_off(run);
    dem_set_force(dem_of(run), run->force);
}
