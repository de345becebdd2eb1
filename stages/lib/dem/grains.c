// SPDX-License-Identifier: GPL-3.0-or-later
// The grain sweep: forces and moments added up [K 4.18, 4.21], velocities, then places
// [K 4.1, 4.5, 4.6]. A grain costs 35 operations and 6 a slot, and moves 244 bytes (48
// constant, 96 read and written, 4 of index) and 64 a slot.
#include "dem/engine.h"

typedef double quad __attribute__((vector_size(32)));

struct load {
    quad force, moment;
};

static inline struct load add_slots(const struct dem *dem, int particle)
{
    struct load sum = {{0}, {0}};
    for (int s = dem->slot_offset[particle]; s < dem->slot_offset[particle + 1]; s++) {
        sum.force += *(const quad *)dem->slot[s].linear;
        sum.moment += *(const quad *)dem->slot[s].angular;
    }
    sum.force += *(const quad *)dem->external[particle];
    return sum;
}

struct motion load_on_grain(const struct dem *dem, int particle)
{
    const struct load sum = add_slots(dem, particle);
    struct motion load;
    *(quad *)load.linear = sum.force;
    *(quad *)load.angular = sum.moment;
    return load;
}

// LOAD, each component less by SHARE of itself where MOTION has its sign, more where it
// has the opposite, unchanged at rest.
static inline quad damped(quad load, quad motion, double share)
{
    const quad power = load * motion;
    const quad zero = {0};
    // Comparisons give -1 where they hold.
    const quad sign = __builtin_convertvector((power < zero) - (power > zero), quad);
    return load - share * (sign * load);
}

struct pace move_grains(struct dem *dem, int begin, int end, int from_group, bool late)
{
    const double dt = dem->time_step;
    const double furthest = 0.5 * SEARCH_SKIN / dt, limit = furthest * furthest;
    const double turning = dem->largest_radius * dem->largest_radius;
    struct pace pace = {.largest = 0, .sound = true};
    for (int i = begin; i < end; i++) {
        if ((dem->first_group[i] < from_group) != late) continue;
        const struct load sum = add_slots(dem, i);
        quad *velocity = (quad *)dem->motion[i].linear;
        quad *spin = (quad *)dem->motion[i].angular;
        const quad force = damped(sum.force, *velocity, dem->local_damping);
        const quad moment = damped(sum.moment, *spin, dem->local_damping);
        const quad v = *velocity + dt * dem->mobility[i][0] * force;
        const quad w = *spin + dt * dem->mobility[i][1] * moment;
        const quad squares = v * v + turning * (w * w);
        const double square = squares[0] + squares[1] + squares[2];
        if (!(square <= limit)) { // also when it is not a number
            pace.sound = false;
            continue;
        }
        if (square > pace.largest) pace.largest = square;
        *velocity = v;
        *spin = w;
        *(quad *)&dem->place[i] += dt * v; // the radius by 0
    }
    return pace;
}
