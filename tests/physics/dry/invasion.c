// SPDX-License-Identifier: GPL-3.0-or-later
// Invasion percolation against the rule itself, step by step: on small lattices and on
// random networks with parallel throats, loose pieces and throats imposed empty; with
// ties; however it is numbered. And ranks against sorting.
#include "network/invasion.h"
#include "../../test.h"
#include "../support_lattice.h"

#include "basics/memory.h"
#include "basics/ranks.h"

#include <stdbool.h>
#include <stdlib.h>

// --- the rule itself ---------------------------------------------------------------

struct state {
    const struct network *network;
    const struct invasion_conditions *conditions;
    bool *gas_throat, *gas_node;
};

static bool takes_part(const struct network *network, int throat)
{
    return network->throat_kind[throat] == THROAT_NETWORK;
}

// Whether liquid leads from NODE to a node on the outlet: labels spread until nothing
// changes.
static bool leads_out(const struct state *state, int node)
{
    const struct network *network = state->network;
    if (state->gas_node[node]) return false;
    bool *wet = NEW_ARRAY(bool, network->n_node);
    wet[node] = true;
    for (bool changed = true; changed;) {
        changed = false;
        for (int t = 0; t < network->n_throat; t++) {
            const int a = network->throat_nodes[t][0], b = network->throat_nodes[t][1];
            if (!takes_part(network, t) || state->gas_throat[t] || state->gas_node[a] ||
                state->gas_node[b] || wet[a] == wet[b])
                continue;
            wet[a] = wet[b] = changed = true;
        }
    }
    bool out = false;
    for (int i = 0; i < network->n_node; i++)
        out |= wet[i] && (network->node_walls[i] & state->conditions->outlet);
    free(wet);
    return out;
}

// Whether gas may enter throat or node E.
static bool may_enter(const struct state *state, int e)
{
    const struct network *network = state->network;
    const bool trapping = state->conditions->trapping;
    if (state->conditions->rule == INVADE_THROATS) {
        const int a = network->throat_nodes[e][0], b = network->throat_nodes[e][1];
        return takes_part(network, e) && !state->gas_throat[e] &&
               (state->gas_node[a] || state->gas_node[b]) &&
               (!trapping || leads_out(state, a) || leads_out(state, b));
    }
    if (state->gas_node[e]) return false;
    bool joined = false, touched = false;
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2 && takes_part(network, t); end++)
            if (network->throat_nodes[t][end] == e) {
                joined = true;
                touched |= state->gas_node[network->throat_nodes[t][1 - end]];
            }
    touched |= joined && (network->node_walls[e] & state->conditions->inlet);
    return touched && (!trapping || leads_out(state, e));
}

static double middle(const struct network *network, int throat, int axis)
{
    const int32_t *ends = network->throat_nodes[throat];
    return (component(network->node_position[ends[0]], axis) +
            component(network->node_position[ends[1]], axis)) /
           2;
}

// Whether E is entered before F, of two that are as easy: what is shorter, holds less,
// is higher, lower along x, along y; then by number.
static bool is_before(const struct state *state, int e, int f)
{
    const struct network *network = state->network;
    const bool throats = state->conditions->rule == INVADE_THROATS;
    double difference = 0;
    if (throats) {
        difference = network->throat_length[e] - network->throat_length[f];
        if (difference == 0)
            difference = throat_volume(network, e) - throat_volume(network, f);
    }
    static const int axes[3] = {2, 0, 1};
    for (int k = 0; k < 3 && difference == 0; k++) {
        difference = throats ? middle(network, e, axes[k]) - middle(network, f, axes[k])
                             : component(network->node_position[e], axes[k]) -
                                   component(network->node_position[f], axes[k]);
        if (axes[k] == 2) difference = -difference;
    }
    return difference != 0 ? difference < 0 : e < f;
}

// What gas enters first of all it may enter; -1 if there is none left.
static int easiest(const struct state *state)
{
    const bool throats = state->conditions->rule == INVADE_THROATS;
    const int n = throats ? state->network->n_throat : state->network->n_node;
    const double *entry_priority = state->conditions->entry_priority
                                       ? state->conditions->entry_priority
                                       : state->network->throat_radius;
    int best = -1;
    for (int e = 0; e < n; e++)
        if ((best < 0 || entry_priority[e] > entry_priority[best] ||
             (entry_priority[e] == entry_priority[best] &&
              is_before(state, e, best))) &&
            may_enter(state, e))
            best = e;
    return best;
}

static void check_against_rule(const struct network *network,
                               const struct invasion_conditions *conditions)
{
    struct invasion invasion;
    struct reason reason;
    assert_int_equal(invade(network, conditions, &invasion, &reason), 0);
    const bool throats = conditions->rule == INVADE_THROATS;
    struct state state = {network, conditions, NEW_ARRAY(bool, network->n_throat),
                          NEW_ARRAY(bool, network->n_node)};
    int n = 0, breakthrough = -1;
    for (int i = 0; throats && i < network->n_node; i++) {
        state.gas_node[i] = network->node_walls[i] & conditions->inlet;
        if (state.gas_node[i] && (network->node_walls[i] & conditions->outlet))
            breakthrough = 0;
    }
    for (int e; !(conditions->until_breakthrough && breakthrough >= 0) &&
                (e = easiest(&state)) >= 0;
         n++) {
        assert_true(n < invasion.n);
        int reached = throats ? -1 : e;
        for (int end = 0; throats && end < 2; end++)
            if (!state.gas_node[network->throat_nodes[e][end]])
                reached = network->throat_nodes[e][end];
        if (throats) assert_int_equal(invasion.throat[n], e);
        assert_int_equal(invasion.node[n], reached);
        if (throats) state.gas_throat[e] = true;
        if (reached >= 0) state.gas_node[reached] = true;
        if (breakthrough < 0 && reached >= 0 &&
            (network->node_walls[reached] & conditions->outlet))
            breakthrough = n + 1;
    }
    assert_int_equal(invasion.n, n);
    assert_int_equal(invasion.breakthrough, breakthrough);
    free(state.gas_throat);
    free(state.gas_node);
    invasion_free(&invasion);
}

// Both rules, with and without trapping, to the end and until breakthrough. If few
// values are DIFFERENT, many tie.
static void check_all(const struct network *network, int different, uint64_t *seed)
{
    const int n = network->n_throat + network->n_node;
    double *entry_priority = NEW_ARRAY(double, n);
    for (int i = 0; i < n; i++)
        entry_priority[i] = (int)(next_random(seed) * different);
    for (int way = 0; way < 8; way++)
        check_against_rule(network, &(struct invasion_conditions){
                                        .rule = way & 1 ? INVADE_NODES : INVADE_THROATS,
                                        .entry_priority = entry_priority,
                                        .inlet = WALL_Z_UPPER,
                                        .outlet = WALL_Z_LOWER,
                                        .trapping = way & 2,
                                        .until_breakthrough = way & 4});
    free(entry_priority);
}

TEST(lattices)
{
    struct network network = lattice_network(4, 4, 5, 1);
    for (uint64_t seed = 1; seed <= 4; seed++) {
        check_all(&network, 1000000, &seed);
        check_all(&network, 5, &seed);
    }
    uint64_t seed = 1;
    check_all(&network, 1, &seed); // nothing but ties
    network_free(&network);
}

// Parallel throats, loose pieces, throats imposed empty, nodes on both walls.
static struct network random_network(int n_node, int n_throat, uint64_t *seed)
{
    struct network network = {.n_node = n_node, .n_throat = n_throat};
    network.node_walls = NEW_ARRAY(uint8_t, n_node);
    network.throat_nodes = allocate((size_t)n_throat, sizeof *network.throat_nodes);
    network.node_position = NEW_ARRAY(struct vector, n_node);
    network.throat_radius = NEW_ARRAY(double, n_throat);
    network.throat_length = NEW_ARRAY(double, n_throat);
    network.throat_kind = NEW_ARRAY(uint8_t, n_throat);
    for (int i = 0; i < n_node; i++) {
        if (next_random(seed) < 0.2) network.node_walls[i] |= WALL_Z_UPPER;
        if (next_random(seed) < 0.1) network.node_walls[i] |= WALL_Z_LOWER;
        for (int axis = 0; axis < 3; axis++) // many tie
            set_component(&network.node_position[i], axis,
                          floor(3 * next_random(seed)));
    }
    for (int t = 0; t < n_throat; t++) {
        const int a = (int)(next_random(seed) * n_node);
        const int b = (a + 1 + (int)(next_random(seed) * (n_node - 1))) % n_node;
        network.throat_nodes[t][0] = a < b ? a : b;
        network.throat_nodes[t][1] = a < b ? b : a;
        network.throat_length[t] = 1 + floor(2 * next_random(seed));
        network.throat_radius[t] = 1 + floor(2 * next_random(seed));
        if (t > 0 && next_random(seed) < 0.1)
            network.throat_kind[t] = THROAT_IMPOSED_EMPTY;
    }
    network.node_walls[network.throat_nodes[0][0]] = WALL_Z_UPPER;
    network.node_walls[network.throat_nodes[0][1]] = WALL_Z_LOWER;
    return network;
}

TEST(random_networks)
{
    uint64_t seed = 7;
    for (int run = 0; run < 300; run++) {
        const int n_node = 2 + (int)(next_random(&seed) * 30);
        const int n_throat = 1 + (int)(next_random(&seed) * 2 * n_node);
        struct network network = random_network(n_node, n_throat, &seed);
        check_all(&network, run % 3 ? 4 : 1000000, &seed);
        network_free(&network);
    }
}

// --- closed forms ------------------------------------------------------------------

// A chain: whatever its radii, from one end to the other.
TEST(chain)
{
    enum { N = 10 };
    struct network network = lattice_network(1, 1, N, 1);
    randomise_radii(&network, 1, 0.5, 3);
    for (int trapping = 0; trapping < 2; trapping++) {
        struct invasion invasion;
        struct reason reason;
        const struct invasion_conditions conditions = {
            .inlet = WALL_Z_LOWER, .outlet = WALL_Z_UPPER, .trapping = trapping};
        assert_int_equal(invade(&network, &conditions, &invasion, &reason), 0);
        assert_int_equal(invasion.n, N - 1);
        assert_int_equal(invasion.breakthrough, N - 1);
        for (int k = 0; k < N - 1; k++) {
            assert_int_equal(invasion.throat[k], k);
            assert_int_equal(invasion.node[k], k + 1);
        }
        invasion_free(&invasion);
    }
    network_free(&network);
}

// Liquid in a dead end leaves only if nothing is trapped.
TEST(dead_end)
{
    int32_t nodes[][2] = {{0, 1}, {1, 2}, {1, 3}}; // 3 is the end
    double radius[] = {1, 2, 3};
    uint8_t walls[4] = {WALL_X_LOWER, 0, WALL_X_UPPER, 0}, kind[3] = {0};
    const struct network network = {.n_node = 4,
                                    .n_throat = 3,
                                    .node_walls = walls,
                                    .throat_nodes = nodes,
                                    .throat_radius = radius,
                                    .throat_kind = kind};
    const int expected[2][3] = {{0, 2, 1}, {0, 1}};
    for (int trapping = 0; trapping < 2; trapping++) {
        struct invasion invasion;
        struct reason reason;
        const struct invasion_conditions conditions = {
            .inlet = WALL_X_LOWER, .outlet = WALL_X_UPPER, .trapping = trapping};
        assert_int_equal(invade(&network, &conditions, &invasion, &reason), 0);
        assert_int_equal(invasion.n, 3 - trapping);
        assert_int_equal(invasion.breakthrough, 3 - trapping);
        for (int k = 0; k < invasion.n; k++)
            assert_int_equal(invasion.throat[k], expected[trapping][k]);
        invasion_free(&invasion);
    }
}

// The share of throats at least as wide as the narrowest that gas had to enter.
static double threshold(struct network *network, uint64_t *seed)
{
    for (int t = 0; t < network->n_throat; t++)
        network->throat_radius[t] = 1 - next_random(seed);
    struct invasion invasion;
    struct reason reason;
    const struct invasion_conditions conditions = {
        .inlet = WALL_Z_LOWER, .outlet = WALL_Z_UPPER, .until_breakthrough = true};
    assert_int_equal(invade(network, &conditions, &invasion, &reason), 0);
    assert_int_equal(invasion.breakthrough, invasion.n);
    double narrowest = 1;
    for (int k = 0; k < invasion.n; k++)
        narrowest = fmin(narrowest, network->throat_radius[invasion.throat[k]]);
    invasion_free(&invasion);
    return 1 - narrowest;
}

// The square lattice of L by L+1 nodes is its own dual: half of all are crossed at a
// share of exactly 1/2, however small.
TEST(square_lattice_is_crossed_at_half)
{
    enum { RUNS = 4000 };
    uint64_t seed = 21;
    for (int size = 2; size <= 16; size *= 2) {
        struct network network = lattice_network(size, 1, size + 1, 1);
        int crossed = 0;
        for (int run = 0; run < RUNS; run++)
            crossed += threshold(&network, &seed) < 0.5;
        assert_true(fabs(crossed - RUNS / 2.0) < 3.5 * sqrt(RUNS / 4.0));
        network_free(&network);
    }
}

// Threshold of the cubic lattice: the mean over finite ones, extrapolated in their
// standard deviation to infinite size.
TEST(cubic_threshold)
{
    enum { RUNS = 400 };
    double mean[2], deviation[2];
    uint64_t seed = 22;
    for (int k = 0; k < 2; k++) {
        const int size = k ? 32 : 16;
        struct network network = lattice_network(size, size, size + 1, 1);
        double sum = 0, squares = 0;
        for (int run = 0; run < RUNS; run++) {
            const double p = threshold(&network, &seed);
            sum += p;
            squares += p * p;
        }
        mean[k] = sum / RUNS;
        deviation[k] = sqrt(squares / RUNS - mean[k] * mean[k]);
        network_free(&network);
    }
    const double slope = (mean[0] - mean[1]) / (deviation[0] - deviation[1]);
    const double limit = mean[1] - slope * deviation[1];
    const double weight = deviation[1] / (deviation[0] - deviation[1]);
    const double error =
        hypot((1 + weight) * deviation[1], weight * deviation[0]) / sqrt(RUNS);
    print_message("# cubic bond threshold %.4f +- %.4f\n", limit, error);
    assert_true(fabs(limit - 0.24881182) < 3 * error);
    assert_true(error < 0.002);
}

// --- whatever the numbers ----------------------------------------------------------

// Of all values ENTRY_PRIORITY (of throats, or nodes) only so many are DIFFERENT.
static void check_renumbered(enum invasion_rule rule, int different)
{
    uint64_t seed = 31;
    struct network one = lattice_network(6, 6, 6, 1), two = lattice_network(6, 6, 6, 1);
    int *node = shuffled(one.n_node, &seed), *throat = shuffled(one.n_throat, &seed);
    const bool throats = rule == INVADE_THROATS;
    const int n = throats ? one.n_throat : one.n_node;
    double *entry_priority[2] = {NEW_ARRAY(double, n), NEW_ARRAY(double, n)};
    for (int i = 0; i < n; i++)
        entry_priority[1][throats ? throat[i] : node[i]] = entry_priority[0][i] =
            floor(different * next_random(&seed));
    for (int i = 0; i < one.n_node; i++) {
        two.node_walls[node[i]] = one.node_walls[i];
        two.node_position[node[i]] = one.node_position[i];
    }
    for (int t = 0; t < one.n_throat; t++) {
        for (int end = 0; end < 2; end++)
            two.throat_nodes[throat[t]][1 - end] = node[one.throat_nodes[t][end]];
    }
    for (int trapping = 0; trapping < 2; trapping++) {
        struct invasion_conditions conditions = {.rule = rule,
                                                 .entry_priority = entry_priority[0],
                                                 .inlet = WALL_X_LOWER,
                                                 .outlet = WALL_X_UPPER,
                                                 .trapping = trapping};
        struct invasion first, second;
        struct reason reason;
        assert_int_equal(invade(&one, &conditions, &first, &reason), 0);
        conditions.entry_priority = entry_priority[1];
        assert_int_equal(invade(&two, &conditions, &second, &reason), 0);
        assert_int_equal(first.n, second.n);
        assert_int_equal(first.breakthrough, second.breakthrough);
        for (int k = 0; k < first.n; k++) {
            if (throats) assert_int_equal(throat[first.throat[k]], second.throat[k]);
            assert_int_equal(first.node[k] < 0 ? -1 : node[first.node[k]],
                             second.node[k]);
        }
        invasion_free(&first);
        invasion_free(&second);
    }
    free(entry_priority[0]);
    free(entry_priority[1]);
    free(node);
    free(throat);
    network_free(&one);
    network_free(&two);
}

TEST(renumbered)
{
    static const int different[3] = {1000000, 4, 1};
    for (int k = 0; k < 3; k++) {
        check_renumbered(INVADE_THROATS, different[k]);
        check_renumbered(INVADE_NODES, different[k]);
    }
}

TEST(ranks_of_any_radii)
{
    enum { N = 5000 };
    static double radius[N];
    static int order[N];
    static bool same[N];
    uint64_t seed = 3;
    for (int kind = 0; kind < 5; kind++) {
        for (int i = 0; i < N; i++) {
            const double u = next_random(&seed);
            radius[i] = kind == 0   ? 1e-7 * (1 + u)
                        : kind == 1 ? pow(10, 12 * u - 9)
                        : kind == 2 ? 1 + 1e-13 * floor(100 * u) // next to each other
                        : kind == 3 ? 1 + floor(4 * u)
                                    : 2 - floor(5 * u); // below 0 too
        }
        if (kind == 2) radius[N / 2] = 1e-6; // leaves their keys no digits
        rank_descending(radius, N, order, same);
        for (int k = 1; k < N; k++) {
            const double before = radius[order[k - 1]], here = radius[order[k]];
            assert_true(before > here || (before == here && order[k - 1] < order[k]));
            assert_int_equal(same[k], before - here <= 0x1p-40 * fabs(before));
        }
    }
}
