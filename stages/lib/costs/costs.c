// SPDX-License-Identifier: GPL-3.0-or-later
// For n grains, N throats, m nodes of the open side, c rows of recorded changes, L
// loads, S snapshots, seconds and MiB beyond what starting a program takes:
//
//     placing          a n
//     moving           a n^(4/3)      cycles grow with the height, n^(1/3)
//     relaxation       a n            of soft spheres
//     tessellation     a n
//     merging          a N
//     drying           N (a + b m + d m^2) + e c       d m^2: products of links, of
//                      floats with a tolerance
//     viscous flow     a N^2.4; kept for a while: b N^2
//     rings            a N; films: b N^1.45 / step^0.45, at each event c N^2
//     forces           a N + e c + f n L
//     cycles           g n (ramp + L cycles)
//     equilibria       a n^2 L
//     flow             a n, and as much for each system but the first
//     motion           g n steps, where g grows as grains leave the caches
//
// and on disk, beside some 22 kB of attributes and small datasets (network: with the
// open sections of throats; forces are packed, the more the more times there are):
//
//     packing a n,   network a N,   drying a N + 12 c,   forces a n + b n L,
//     response and motion a n + b n S + c L
//
// with the constants below: `make bench-estimates` measures what they foresee. They are
// of an AMD EPYC with AVX2, one core, with other programs beside; the growth of the
// drying is explained in docs/speed.md. Of moving, cycles until rest and equilibria
// only the order is known before: LEAST and MOST enclose what was measured.
#include "costs.h"

#include <math.h>

static const double START_SECONDS = 0.03, START_MEBIBYTES = 10.5;
static const double MEBIBYTE = 1048576;

// Bytes of an artifact.
static const double SMALL_BYTES = 22000, GRAIN_BYTES = 54, THROAT_BYTES = 107;

// Events are recorded one by one up to so many throats, above in a thousand steps.
static const double MOST_BY_EVENTS = 30000, COARSE_STEPS = 1e-3;

// The vapour is kept for a while where this takes less than such a part of the time,
// from so many nodes on the open walls on.
static const double LEAST_OPEN_NODES_TO_KEEP = 1000, KEPT_STEP = 0.3, LESS = 0.8;

static struct cost cost_of(double seconds, double mebibytes)
{
    const double all = START_SECONDS + seconds;
    return (struct cost){.seconds = all,
                         .least = all,
                         .most = all,
                         .mebibytes = START_MEBIBYTES + mebibytes};
}

// The cost of an artifact of so many BYTES.
static struct cost writes(struct cost cost, double bytes)
{
    cost.disk = (SMALL_BYTES + bytes) / MEBIBYTE;
    return cost;
}

// Known to a factor of LESS below and MORE above.
static struct cost within(double seconds, double less, double more, double mebibytes)
{
    struct cost cost = cost_of(seconds, mebibytes);
    cost.least = START_SECONDS + seconds / less;
    cost.most = START_SECONDS + seconds * more;
    return cost;
}

struct body_size body_of_grains(double grains)
{
    return (struct body_size){.grains = grains,
                              .unmerged = 12 * grains,
                              .throats = 11 * grains,
                              .face = 1.8 * pow(grains, 2.0 / 3)};
}

struct body_size body_with_throats(struct body_size body, double throats)
{
    body.face *= pow(throats / body.throats, 2.0 / 3);
    body.throats = throats;
    return body;
}

double recorded_changes(const struct body_size *body, double interval)
{
    if (isnan(interval)) interval = body->throats > MOST_BY_EVENTS ? COARSE_STEPS : 0;
    const double steps =
        interval > 0 ? fmin(1 / interval, body->throats) : body->throats;
    return 1.2 * body->face * steps;
}

struct cost cost_of_packing(double grains, enum moving moving)
{
    static const double constant[] = {[MOVING_BY_GRAVITY] = 1.5e-4,
                                      [MOVING_BY_COMPRESSION] = 5.5e-5,
                                      [MOVING_BY_OVERLAPS] = 1.2e-4,
                                      [MOVING_BY_RELAXATION] = 2.2e-4};
    const double power = moving == MOVING_BY_RELAXATION ? 1 : 4.0 / 3;
    const struct cost cost =
        moving == MOVING_NOT
            ? cost_of(1e-5 * grains, 5e-5 * grains)
            : within(constant[moving] * pow(grains, power), 3, 3,
                     (moving == MOVING_BY_RELAXATION ? 1e-4 : 0.0025) * grains);
    return writes(cost, GRAIN_BYTES * grains);
}

struct cost cost_of_tessellation(double grains)
{
    return writes(cost_of(7e-5 * grains, 0.0025 * grains),
                  THROAT_BYTES * body_of_grains(grains).unmerged);
}

struct cost cost_of_merging(const struct body_size *body)
{
    return writes(cost_of(3e-6 * body->unmerged, 4e-4 * body->unmerged),
                  THROAT_BYTES * body->throats);
}

// Of a throat. Links of a front grow with its square.
static double seconds_by_events(double face, bool exact)
{
    const double front = 2 * face;
    return 2e-6 + 9e-9 * front + front * front * (exact ? 5e-12 : 2.5e-12);
}

// Kept vapour is found again, in all of the gas, as often as nodes dry over those that
// dry in between, STEP of the open face.
static double seconds_by_steps(double face, double throats, double step)
{
    return 2e-6 + 2.5e-9 * face + 3.5e-8 * throats / (face * step);
}

double default_vapour_step(double open_nodes, double throats)
{
    const bool pays = seconds_by_steps(open_nodes, throats, KEPT_STEP) <
                      LESS * seconds_by_events(open_nodes, true);
    return pays && open_nodes > LEAST_OPEN_NODES_TO_KEEP ? KEPT_STEP : 0;
}

struct cost cost_of_drying(const struct body_size *body, bool kelvin, bool exact,
                           double step)
{
    const double throats = body->throats, face = body->face;
    const double links = step > 0 ? 0 : 4 * face * face;
    const double each = step > 0 ? seconds_by_steps(face, throats, step)
                                 : seconds_by_events(face, exact);
    double seconds = throats * each + 1.2e-7 * body->changes;
    if (kelvin) seconds += 2.4e-10 * pow(throats, 2.65);
    const double mebibytes =
        5.5e-4 * throats + (14 * body->changes + links * (exact ? 4 : 2)) / MEBIBYTE;
    return writes(kelvin ? within(seconds, 5, 100, mebibytes)
                         : cost_of(seconds, mebibytes),
                  THROAT_BYTES * throats + 12 * body->changes);
}

struct cost with_viscous_flow(struct cost drying, const struct body_size *body,
                              bool kept)
{
    const double flow = kept ? 2.5e-8 * body->throats * body->throats
                             : 1.4e-9 * pow(body->throats, 2.4);
    drying.seconds += flow;
    drying.least += flow / 3;
    drying.most += 3 * flow;
    return drying;
}

struct cost with_rings(struct cost drying, const struct body_size *body, bool films,
                       double step)
{
    const double throats = body->throats, rings = 4e-5 * throats;
    const double by_events = 2.8e-7 * throats * throats;
    const double by_steps = 2.4e-6 * pow(throats, 1.45) * pow(0.01 / step, 0.45);
    const double flow = !films ? 0 : step > 0 ? fmin(by_steps, by_events) : by_events;
    drying.seconds += rings + flow;
    drying.least += rings + flow / 3;
    drying.most += rings + 3 * flow;
    drying.mebibytes += (films ? 4.5e-4 : 1.5e-4) * throats;
    return drying;
}

// By levels, or by the columns of separators where their front is smaller.
struct cost with_boundary_layer(struct cost drying, double columns, double layers)
{
    const double separator = 2 * sqrt(columns), front = separator * layers;
    const bool by_levels = front >= columns;
    const double eliminated = layers * (by_levels ? columns : separator);
    const double seconds =
        1e-6 * layers * columns + 2.7e-11 * eliminated * pow(fmin(front, columns), 2);
    drying.seconds += seconds;
    drying.least += seconds;
    drying.most += seconds;
    return drying;
}

// What the stages hold of forces over time: a band of rows.
static double band_bytes(const struct body_size *body)
{
    static const double rows = 32;
    return 24 * body->grains * fmin(body->loads, rows);
}

// Packed from a MiB on (artifacts/write.c).
static double force_bytes(const struct body_size *body)
{
    const double forces = body->grains * body->loads;
    return 24 * forces < MEBIBYTE ? 24 * forces
                                  : fmin(24, 3 + 60 / body->loads) * forces;
}

// Most memory is taken where the pulls are balanced, where the drying is read, each
// value twice, or where the forces are summed.
struct cost cost_of_forces(const struct body_size *body)
{
    static const double packing = 3; // MiB: chunks, and what deflate needs
    const double forces = body->grains * body->loads;
    const double balance = 3e-4 * body->throats;
    const double reading = 1.4e-4 * body->throats + 20 * body->changes / MEBIBYTE;
    const double sum =
        2.2e-4 * body->throats + (12 * body->changes + band_bytes(body)) / MEBIBYTE;
    return writes(cost_of(1.4e-5 * body->throats + 1e-7 * body->changes + 6e-7 * forces,
                          packing + fmax(balance, fmax(reading, sum))),
                  GRAIN_BYTES * body->grains + force_bytes(body));
}

// A snapshot has displacements, forces and, of 1.6 contacts a grain, the forces there.
static double response_bytes(const struct body_size *body)
{
    return (80 + 90 * body->snapshots) * body->grains + 80 * body->loads;
}

// A band of long rows is made lower.
static double replay_mebibytes(const struct body_size *body)
{
    static const double packing = 4, most = 256;
    return packing + 0.0035 * body->grains + fmin(band_bytes(body) / MEBIBYTE, most);
}

struct cost cost_of_cycles(const struct body_size *body, double ramp, double cycles,
                           double most)
{
    const double step = 5e-8 * body->grains, mebibytes = replay_mebibytes(body);
    const double least = step * (ramp + body->loads * cycles);
    const double bytes = response_bytes(body);
    if (!(most > cycles)) return writes(cost_of(least, mebibytes), bytes);
    const double middle = step * (ramp + body->loads * sqrt(cycles * most));
    return writes(within(middle, middle / least,
                         step * (ramp + body->loads * most) / middle, mebibytes),
                  bytes);
}

// Menisci and pores take as long as contacts, or three times where these are few.
struct cost cost_of_drainage(const struct body_size *body, double ramp, double least,
                             double rest)
{
    struct cost cost = cost_of_cycles(body, ramp, least, least + rest);
    const double steps = 2 * (cost.seconds - START_SECONDS);
    return writes(within(steps, steps / (cost.least - START_SECONDS),
                         2 * 2 * (cost.most - START_SECONDS) / steps,
                         cost.mebibytes - START_MEBIBYTES),
                  response_bytes(body));
}

struct cost cost_of_equilibria(const struct body_size *body, bool friction)
{
    const double work = body->grains * body->grains * body->loads;
    return writes(within((friction ? 3e-6 : 1e-7) * work, 30, 10,
                         replay_mebibytes(body) + 0.1 * body->grains),
                  response_bytes(body));
}

struct cost cost_of_flow(double grains, int systems)
{
    return writes(cost_of(5e-5 * grains * (0.7 + 0.3 * systems), 0.0045 * grains),
                  THROAT_BYTES * body_of_grains(grains).unmerged);
}

// From some 10^5 grains on the second grain of a pair is seldom in the caches. Bytes of
// a snapshot are those of simulate's record; 200 rows of sums have some 300 each.
struct cost cost_of_motion(const struct motion_size *motion)
{
    static const double cached = 2e5, sum_bytes = 200 * 300, engine = 3; // MiB
    const double n = motion->grains;
    const double far = 1 + 2 * n / (n + cached);
    const double grain_step =
        far * ((motion->turns ? 7e-8 : 4.2e-8) + (motion->wet ? 4.2e-8 : 0));
    const double snapshots =
        motion->snapshots * (72 * n + (motion->wet ? 84 : 68) * motion->contacts);
    return writes(
        cost_of(grain_step * n * motion->steps,
                engine + (motion->wet ? 0.002 : 0.0015) * n + snapshots / MEBIBYTE),
        (GRAIN_BYTES + 20) * n + snapshots + sum_bytes);
}
