// SPDX-License-Identifier: GPL-3.0-or-later
// The grain sweep: sums of forces and moments [K 4.18, 4.21], then leapfrog [K
// 4.1-4.6].
//
// With F and M the sums over pairs, then walls, then the external force:
//     v = v + dt F / m,   omega = omega + dt M / I,   u = u + dt v.
// Fixed grains have mobilities (1/m, 1/I) of 0. Local damping first makes each
// component of F smaller by its share where it has the sign of v and larger where it
// opposes v. A grain that would move further than MAX_STEP stays where it is and
// reports divergence.
//
// What a scene does not have is not read: memory traffic decides the speed of large
// scenes. tests/bench/bench_dem.c counts operations and bytes. Vectors hold x, y, z and
// 0; in `place` the fourth is the radius, which dt v leaves alone.
#include "dem/engine.h"

#include "basics/simd.h"

struct load {
    double4 force, moment;
};

SIMD_INLINE double4 as_quad(struct vector a)
{
    return (double4){a.x, a.y, a.z, 0};
}

// Adds walls, then the external force, to SUM.
SIMD_INLINE struct load with_walls(const struct dem *dem, int particle, struct load sum,
                                   bool turns)
{
    const int *walls = dem->wall_offset + particle;
    const int n_wall_pair = dem->n_wall_pair > 0 ? walls[1] - walls[0] : 0;
    for (int k = 0; k < n_wall_pair; k++) {
        const struct wall_pair *pair = &dem->wall_pair[walls[0] + k];
        sum.force += as_quad(pair->load);
        if (turns) sum.moment += as_quad(pair->moment);
    }
    if (dem->has_external) sum.force += *(const double4 *)dem->external[particle];
    return sum;
}

// Sum over the pairs of a grain from the loads kept in the last cycle.
static struct load add_up(const struct dem *dem, int particle, bool turns)
{
    struct load sum = {{0}, {0}};
    for (int s = dem->pair_offset[particle]; s < dem->pair_offset[particle + 1]; s++) {
        const int p = dem->pair_of[s], group = p / PAIRS_IN_GROUP;
        const int lane = p % PAIRS_IN_GROUP;
        const bool is_first = dem->pairs.particle[p][0] == particle;
        const double4 force = as_quad(lane_vector(dem->pairs.load[group].force, lane));
        sum.force += is_first ? -force : force;
        if (!turns) continue;
        const struct moment_group *moment = &dem->pairs.moment[group];
        sum.moment += is_first ? -as_quad(lane_vector(moment->first, lane))
                               : as_quad(lane_vector(moment->second, lane));
    }
    return with_walls(dem, particle, sum, turns);
}

// Takes what the pair sweep added up, and clears it for the next cycle.
SIMD_INLINE struct load take_sum(struct dem *dem, int particle, bool turns)
{
    const double4 zero = {0};
    double4 *row = (double4 *)(dem->sum + (turns ? 8 : 4) * (size_t)particle);
    const struct load sum = {row[0], turns ? row[1] : zero};
    row[0] = zero;
    if (turns) row[1] = zero;
    return with_walls(dem, particle, sum, turns);
}

// The same for a shared grain, from the rows of its pairs in their order.
SIMD_INLINE struct load take_shared_sum(struct dem *dem, int shared, bool turns)
{
    const double4 zero = {0};
    struct load sum = {zero, zero};
    for (int k = dem->first_row[shared]; k < dem->first_row[shared + 1]; k++) {
        double4 *row = (double4 *)(dem->sum + (turns ? 8 : 4) * (size_t)k);
        sum.force += row[0];
        row[0] = zero;
        if (!turns) continue;
        sum.moment += row[1];
        row[1] = zero;
    }
    return with_walls(dem, dem->shared_grain[shared], sum, turns);
}

struct motion load_on_grain(const struct dem *dem, int particle)
{
    const struct load sum = add_up(dem, particle, dem->features & FEATURE_ROTATION);
    struct motion load;
    *(double4 *)load.linear = sum.force;
    *(double4 *)load.angular = sum.moment;
    return load;
}

// Local damping: each component of LOAD less by SHARE of itself where MOTION has its
// sign, more where it has the opposite sign, unchanged at rest.
SIMD_INLINE double4 damped(double4 load, double4 motion, double share)
{
    const double4 power = load * motion;
    const double4 zero = {0}, one = zero + 1;
    const double4 sign =
        (double4)((mask4)one & (power > zero)) - (double4)((mask4)one & (power < zero));
    return load - share * (sign * load);
}

SIMD_INLINE double sum_of(double4 a)
{
    return a[0] + a[1] + a[2];
}

// Upper bound of the squared speed of the surface RADIUS from the centre.
SIMD_INLINE double surface_square(double4 velocity, double4 spin, double radius,
                                  bool turns)
{
    const double4 shift = velocity * velocity;
    return sum_of(turns ? shift + radius * radius * (spin * spin) : shift);
}

// Books the work of external forces in this step, and what local damping took.
static void update_grain_ledger(const struct dem *dem, int i, const struct load *sum,
                                struct load damped_sum, double4 velocity, double4 spin)
{
    const double4 external = *(const double4 *)dem->external[i];
    const double4 taken = (sum->force - damped_sum.force) * velocity +
                          (sum->moment - damped_sum.moment) * spin;
    dem->grain_ledger[i][0] += dem->time_step * sum_of(external * velocity);
    dem->grain_ledger[i][1] += dem->time_step * sum_of(taken);
}

static struct max_speed drive(struct dem *dem, int i, const struct load *sum)
{
    struct motion load;
    *(double4 *)load.linear = sum->force;
    *(double4 *)load.angular = sum->moment;
    return move_driven_grain(dem, i, &load);
}

// Values that all grains need are held in locals: the compiler cannot know that stores
// to grains leave them alone.
SIMD_INLINE struct max_speed move(struct dem *dem, int begin, int end, bool shared,
                                  bool turns)
{
    const double dt = dem->time_step, share = dem->local_damping;
    const double largest_distance = MAX_STEP / dt,
                 limit = largest_distance * largest_distance;
    const double largest_radius = dem->largest_radius;
    const uint8_t *const is_shared = dem->is_shared;
    const double(*const mobility)[2] = dem->mobility;
    const size_t next_mobility = dem->equal_mobility ? 0 : 1;
    double *const velocities = dem->velocity, *const spins = dem->spin;
    const size_t stride = turns ? 8 : 4;
    struct place *const place = dem->place;
    const bool balance = dem->balance_energy, any_driven = dem->group_of;
    const double4 zero = {0};
    const double *const half_skin = dem->half_skin;
    double largest = 0, shares = 0;
    bool valid = true;
    for (int k = begin; k < end; k++) {
        const int i = shared ? dem->shared_grain[k] : k;
        if (!shared && is_shared[i]) continue;
        const struct load sum =
            shared ? take_shared_sum(dem, k, turns) : take_sum(dem, i, turns);
        if (any_driven && dem->group_of[i]) {
            const struct max_speed speed = drive(dem, i, &sum);
            largest = speed.square > largest ? speed.square : largest;
            shares = speed.shares > shares ? speed.shares : shares;
            valid = valid && speed.valid;
            continue;
        }
        const double *mobile = mobility[next_mobility * (size_t)i];
        double4 *velocity = (double4 *)(velocities + stride * (size_t)i),
                *spin = (double4 *)(spins + stride * (size_t)i);
        struct load net = {sum.force + zero, sum.moment + zero}; // +0, as damped has it
        if (share > 0) {
            net.force = damped(sum.force, *velocity, share);
            if (turns) net.moment = damped(sum.moment, *spin, share);
        }
        const double4 v = *velocity + dt * mobile[0] * net.force;
        const double4 w = turns ? *spin + dt * mobile[1] * net.moment : zero;
        const double square = surface_square(v, w, largest_radius, turns);
        // The bound with the largest radius fails: look at the grain's own. Also
        // catches NaN.
        if (!(square <= limit) &&
            !(surface_square(v, w, place[i].radius, turns) <= limit)) {
            valid = false;
            continue;
        }
        largest = square > largest ? square : largest;
        const double share_square = sum_of(v * v) / (half_skin[i] * half_skin[i]);
        shares = share_square > shares ? share_square : shares;
        *velocity = v;
        if (turns) *spin = w;
        *(double4 *)&place[i] += dt * v; // the radius by 0
        if (balance && mobile[0] > 0) update_grain_ledger(dem, i, &sum, net, v, w);
    }
    return (struct max_speed){.square = largest, .shares = shares, .valid = valid};
}

struct max_speed move_grains(struct dem *dem, int begin, int end)
{
    return dem->features & FEATURE_ROTATION ? move(dem, begin, end, false, true)
                                            : move(dem, begin, end, false, false);
}

struct max_speed move_shared_grains(struct dem *dem, int begin, int end)
{
    return dem->features & FEATURE_ROTATION ? move(dem, begin, end, true, true)
                                            : move(dem, begin, end, true, false);
}
