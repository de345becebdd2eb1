// SPDX-License-Identifier: GPL-3.0-or-later
// Viscous liquid over 26 decades of viscosity, between liquid without and liquid
// that does not move: when each throat empties, in which order, and where liquid is
// half-way. In regular and irregular networks, flat and in space.
#include "../../test.h"
#include "../support_lattice.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>

static const double spacing = 5e-7;
enum { SLABS = 8 };

// N(y) of 2: flat, its throats in the plane y = 0.
static struct network make_network(const int n[3], bool irregular)
{
    struct network network = lattice_network(n[0], n[1], n[2], spacing);
    randomise_radii(&network, spacing, 0.3, 21);
    const bool flat = n[1] == 2;
    uint64_t seed = 22;
    for (int i = 0; irregular && i < network.n_node; i++)
        for (int axis = 0; axis < 3; axis++) {
            struct vector *place = &network.node_position[i];
            if (network.node_walls[i] & 3 << 2 * axis) continue;
            set_component(place, axis,
                          component(*place, axis) +
                              0.6 * spacing * (next_random(&seed) - 0.5));
        }
    for (int t = 0; t < network.n_throat; t++) {
        for (int end = 0; flat && end < 2; end++)
            if (network.throat_nodes[t][end] / n[0] % 2 == 1)
                network.throat_kind[t] = THROAT_IMPOSED_EMPTY;
        network.throat_length[t] = norm(along_throat(&network, t));
    }
    return network;
}

// What is compared of a run.
struct course {
    double *emptied; // (n_throat) when, for the last time
    int *order;      // (n_event) throats as they empty
    int n_event;
    double end;            // time
    double profile[SLABS]; // liquid by height at half of all, of all
};

static void add_to_profile(const struct network *network, int throat, double liquid,
                           double *profile)
{
    const int32_t *node = network->throat_nodes[throat];
    const double height =
        (network->node_position[node[0]].z + network->node_position[node[1]].z) / 2;
    const int slab = (int)(SLABS * height / network->packing.upper.z);
    profile[slab < SLABS ? slab : SLABS - 1] += liquid;
}

// At a saturation of one half, between two steps.
static void find_profile(const struct network *network,
                         const struct drying_history *history, double *profile)
{
    double *before = NEW_ARRAY(double, network->n_throat), total = 0;
    double *now = NEW_ARRAY(double, network->n_throat);
    int step = 0;
    for (int t = 0; t < network->n_throat; t++) {
        now[t] = network->throat_kind[t] == THROAT_NETWORK;
        total += now[t] * throat_volume(network, t);
    }
    while (history->saturation[step] > 0.5) {
        step++;
        for (int t = 0; t < network->n_throat; t++)
            before[t] = now[t];
        for (int64_t c = history->change_offset[step];
             c < history->change_offset[step + 1]; c++)
            now[history->change_throat[c]] = history->change_saturation[c];
    }
    const double part = (history->saturation[step - 1] - 0.5) /
                        (history->saturation[step - 1] - history->saturation[step]);
    for (int t = 0; t < network->n_throat; t++)
        add_to_profile(network, t,
                       (before[t] + part * (now[t] - before[t])) *
                           throat_volume(network, t) / total,
                       profile);
    free(before);
    free(now);
}

static struct course dry(const struct network *network, enum liquid_limit liquid,
                         double viscosity)
{
    struct drying_conditions conditions = kharaghani_conditions(liquid);
    conditions.viscosity = viscosity;
    struct drying_history history = dry_and_check(network, &conditions);
    struct course course = {.emptied = NEW_ARRAY(double, network->n_throat),
                            .order = NEW_ARRAY(int, history.n_event),
                            .end = history.time[history.n_step - 1]};
    for (int k = 0; k < history.n_event; k++) {
        if (history.event_kind[k] == EVENT_REFILLED) continue;
        course.emptied[history.event_throat[k]] = history.event_time[k];
        course.order[course.n_event++] = history.event_throat[k];
    }
    find_profile(network, &history, course.profile);
    drying_history_free(&history);
    return course;
}

static void free_course(struct course *course)
{
    free(course->emptied);
    free(course->order);
}

struct distance {
    double times;   // largest, of the end
    double profile; // sum over the height
    int moved;      // throats that have another place in the order
};

static struct distance distance_of(const struct network *network,
                                   const struct course *a, const struct course *b)
{
    struct distance distance = {0};
    assert_int_equal(a->n_event, b->n_event);
    for (int t = 0; t < network->n_throat; t++)
        distance.times =
            fmax(distance.times, fabs(a->emptied[t] - b->emptied[t]) / b->end);
    for (int s = 0; s < SLABS; s++)
        distance.profile += fabs(a->profile[s] - b->profile[s]);
    for (int k = 0; k < a->n_event; k++)
        distance.moved += a->order[k] != b->order[k];
    return distance;
}

// Without viscosity: exactly so as soon as it cannot make a second meniscus move.
static void check_inviscid(const struct network *network, double viscosity)
{
    struct course limit = dry(network, LIQUID_INVISCID, 1);
    struct course course = dry(network, LIQUID_VISCOUS, viscosity);
    const struct distance distance = distance_of(network, &course, &limit);
    assert_true(distance.times < 1e-14 && distance.profile < 1e-14);
    assert_int_equal(distance.moved, 0);
    free_course(&limit);
    free_course(&course);
}

// Immobile: nearer with each decade, and in the end with the first power of the
// viscosity.
static void check_immobile(const struct network *network)
{
    struct course limit = dry(network, LIQUID_IMMOBILE, 1);
    struct distance before = {INFINITY, INFINITY, 0};
    for (int decade = -4; decade <= 8; decade++) {
        struct course course = dry(network, LIQUID_VISCOUS, pow(10, decade));
        const struct distance now = distance_of(network, &course, &limit);
        assert_true(now.times < before.times && now.profile < before.profile);
        if (decade > 2) {
            assert_true(fabs(now.times / before.times - 0.1) < 1e-3);
            assert_true(fabs(now.profile / before.profile - 0.1) < 1e-3);
        }
        assert_true(decade < 2 || now.moved == 0);
        before = now;
        free_course(&course);
    }
    assert_true(before.times < 1e-10 && before.profile < 1e-12);
    free_course(&limit);
}

// Away from the limit without viscosity with each decade.
static void check_departure(const struct network *network)
{
    struct course limit = dry(network, LIQUID_INVISCID, 1);
    struct distance before = {0};
    for (int decade = -7; decade <= -3; decade++) {
        struct course course = dry(network, LIQUID_VISCOUS, pow(10, decade));
        const struct distance now = distance_of(network, &course, &limit);
        assert_true(now.times > before.times && now.profile >= before.profile);
        before = now;
        free_course(&course);
    }
    assert_true(before.times > 0.5 && before.profile > 0.1);
    free_course(&limit);
}

static void check_limits(const int n[3], bool irregular)
{
    struct network network = make_network(n, irregular);
    for (int decade = -18; decade <= -8; decade += 2)
        check_inviscid(&network, pow(10, decade));
    check_departure(&network);
    check_immobile(&network);
    network_free(&network);
}

TEST(flat_and_regular)
{
    check_limits((int[]){14, 2, 14}, false);
}

TEST(flat_and_irregular)
{
    check_limits((int[]){14, 2, 14}, true);
}

TEST(regular_in_space)
{
    check_limits((int[]){6, 5, 6}, false);
}

TEST(irregular_in_space)
{
    check_limits((int[]){6, 5, 6}, true);
}
