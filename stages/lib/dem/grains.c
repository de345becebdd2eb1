// SPDX-License-Identifier: GPL-3.0-or-later
// The grain sweep: forces and moments added up [K 4.18, 4.21], velocities, then places
// [K 4.1, 4.5, 4.6]. What a scene does not have is not read: far from caches bytes are
// time. tests/bench/bench_dem.c counts operations and bytes.
#include "dem/engine.h"

#define INLINE static inline __attribute__((always_inline))

typedef double quad __attribute__((vector_size(32)));

struct load {
    quad force, moment;
};

INLINE quad as_quad(struct vector a)
{
    return (quad){a.x, a.y, a.z, 0};
}

// Walls come after pairs, what acts from outside last.
INLINE struct load with_walls(const struct dem *dem, int particle, struct load sum,
                              bool turns)
{
    const int *walls = dem->wall_offset + particle;
    const int n_wall_pair = dem->n_wall_pair > 0 ? walls[1] - walls[0] : 0;
    for (int k = 0; k < n_wall_pair; k++) {
        const struct wall_pair *pair = &dem->wall_pair[walls[0] + k];
        sum.force += as_quad(pair->load);
        if (turns) sum.moment += as_quad(pair->moment);
    }
    if (dem->is_pulled) sum.force += *(const quad *)dem->external[particle];
    return sum;
}

// From the loads that were kept.
static struct load add_up(const struct dem *dem, int particle, bool turns)
{
    struct load sum = {{0}, {0}};
    for (int s = dem->pair_offset[particle]; s < dem->pair_offset[particle + 1]; s++) {
        const int p = dem->pair_of[s], group = p / PAIRS_IN_GROUP;
        const int lane = p % PAIRS_IN_GROUP;
        const bool is_first = dem->pairs.particle[p][0] == particle;
        const quad force = as_quad(lane_vector(dem->pairs.load[group].force, lane));
        sum.force += is_first ? -force : force;
        if (!turns) continue;
        const struct moment_group *moment = &dem->pairs.moment[group];
        sum.moment += is_first ? -as_quad(lane_vector(moment->first, lane))
                               : as_quad(lane_vector(moment->second, lane));
    }
    return with_walls(dem, particle, sum, turns);
}

// What the pair sweep added up, which is cleared for the next.
INLINE struct load take_sum(struct dem *dem, int particle, bool turns)
{
    const quad zero = {0};
    quad *row = (quad *)(dem->sum + (turns ? 8 : 4) * (size_t)particle);
    const struct load sum = {row[0], turns ? row[1] : zero};
    row[0] = zero;
    if (turns) row[1] = zero;
    return with_walls(dem, particle, sum, turns);
}

// From the rows of its pairs, in their order.
INLINE struct load take_late_sum(struct dem *dem, int late, bool turns)
{
    const quad zero = {0};
    struct load sum = {zero, zero};
    for (int k = dem->late_row[late]; k < dem->late_row[late + 1]; k++) {
        quad *row = (quad *)(dem->sum + (turns ? 8 : 4) * (size_t)k);
        sum.force += row[0];
        row[0] = zero;
        if (!turns) continue;
        sum.moment += row[1];
        row[1] = zero;
    }
    return with_walls(dem, dem->late[late], sum, turns);
}

struct motion load_on_grain(const struct dem *dem, int particle)
{
    const struct load sum = add_up(dem, particle, dem->features & FEATURE_TURN);
    struct motion load;
    *(quad *)load.linear = sum.force;
    *(quad *)load.angular = sum.moment;
    return load;
}

// LOAD, each component less by SHARE of itself where MOTION has its sign, more where it
// has the opposite, unchanged at rest.
INLINE quad damped(quad load, quad motion, double share)
{
    const quad power = load * motion;
    const quad zero = {0}, one = zero + 1;
    typedef int64_t mask __attribute__((vector_size(32)));
    const quad sign =
        (quad)((mask)one & (power > zero)) - (quad)((mask)one & (power < zero));
    return load - share * (sign * load);
}

INLINE double sum_of(quad a)
{
    return a[0] + a[1] + a[2];
}

// Of the speed of a surface RADIUS from the centre, at most.
INLINE double surface_square(quad velocity, quad spin, double radius, bool turns)
{
    const quad shift = velocity * velocity;
    return sum_of(turns ? shift + radius * radius * (spin * spin) : shift);
}

// What pulled from outside did in this step, and what local damping took.
static void keep_books(const struct dem *dem, int i, const struct load *sum,
                       struct load damped_sum, quad velocity, quad spin)
{
    const quad external = *(const quad *)dem->external[i];
    const quad taken = (sum->force - damped_sum.force) * velocity +
                       (sum->moment - damped_sum.moment) * spin;
    dem->grain_books[i][0] += dem->time_step * sum_of(external * velocity);
    dem->grain_books[i][1] += dem->time_step * sum_of(taken);
}

// What is read again for each grain is held in registers: the compiler cannot know that
// grains are not written over it.
INLINE struct pace move(struct dem *dem, int begin, int end, bool late, bool turns)
{
    const double dt = dem->time_step, share = dem->local_damping;
    const double furthest = FURTHEST_STEP / dt, limit = furthest * furthest;
    const double largest_radius = dem->largest_radius;
    const uint8_t *const is_late = dem->is_late;
    const double(*const mobility)[2] = dem->mobility;
    const size_t next_mobility = dem->moves_alike ? 0 : 1;
    struct motion *const motion = dem->motion;
    struct place *const place = dem->place;
    const bool balance = dem->balance_energy;
    const quad zero = {0};
    double largest = 0;
    bool sound = true;
    for (int k = begin; k < end; k++) {
        const int i = late ? dem->late[k] : k;
        if (!late && is_late[i]) continue;
        const struct load sum =
            late ? take_late_sum(dem, k, turns) : take_sum(dem, i, turns);
        const double *mobile = mobility[next_mobility * (size_t)i];
        quad *velocity = (quad *)motion[i].linear, *spin = (quad *)motion[i].angular;
        struct load net = {sum.force + zero, sum.moment + zero}; // +0, as damped has it
        if (share > 0) {
            net.force = damped(sum.force, *velocity, share);
            if (turns) net.moment = damped(sum.moment, *spin, share);
        }
        const quad v = *velocity + dt * mobile[0] * net.force;
        const quad w = turns ? *spin + dt * mobile[1] * net.moment : zero;
        const double square = surface_square(v, w, largest_radius, turns);
        // The grain's own surface is no faster: rarely asked. Also when not a number.
        if (!(square <= limit) &&
            !(surface_square(v, w, place[i].radius, turns) <= limit)) {
            sound = false;
            continue;
        }
        largest = square > largest ? square : largest;
        *velocity = v;
        if (turns) *spin = w;
        *(quad *)&place[i] += dt * v; // the radius by 0
        if (balance && mobile[0] > 0) keep_books(dem, i, &sum, net, v, w);
    }
    return (struct pace){.largest = largest, .sound = sound};
}

struct pace move_grains(struct dem *dem, int begin, int end)
{
    return dem->features & FEATURE_TURN ? move(dem, begin, end, false, true)
                                        : move(dem, begin, end, false, false);
}

struct pace move_late_grains(struct dem *dem, int begin, int end)
{
    return dem->features & FEATURE_TURN ? move(dem, begin, end, true, true)
                                        : move(dem, begin, end, true, false);
}
