// SPDX-License-Identifier: GPL-3.0-or-later
// Invasion percolation against the rule itself, step by step on small lattices, with
// ties; and ranks against sorting.
#include "dry/invasion.h"
#include "dry/ranks.h"
#include "support_lattice.h"

#include "basics/memory.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Whether liquid leads from THROAT to a node on OUTLET: labels spread until nothing
// changes.
static bool leads_out(const struct network *network, const bool *gas_throat,
                      const bool *gas_node, int throat, unsigned outlet)
{
    bool *wet = NEW_ARRAY(bool, network->n_node);
    for (int end = 0; end < 2; end++) {
        const int node = network->throat_nodes[throat][end];
        wet[node] = !gas_node[node];
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (int t = 0; t < network->n_throat; t++) {
            const int a = network->throat_nodes[t][0], b = network->throat_nodes[t][1];
            if (gas_throat[t] || gas_node[a] || gas_node[b] || wet[a] == wet[b])
                continue;
            wet[a] = wet[b] = changed = true;
        }
    }
    bool out = false;
    for (int i = 0; i < network->n_node; i++)
        out |= wet[i] && (network->node_walls[i] & outlet);
    free(wet);
    return out;
}

// The widest throat that gas touches, of equals the first; -1 if there is none left.
static int next_throat(const struct network *network, const bool *gas_throat,
                       const bool *gas_node, bool trapping)
{
    int best = -1;
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *node = network->throat_nodes[t];
        if (gas_throat[t] || !(gas_node[node[0]] || gas_node[node[1]])) continue;
        if (best >= 0 && network->throat_radius[t] <= network->throat_radius[best])
            continue;
        if (!trapping || leads_out(network, gas_throat, gas_node, t, WALL_Z_LOWER))
            best = t;
    }
    return best;
}

static void check_rule(bool trapping, int radii, uint64_t seed)
{
    struct network network = lattice_network(4, 4, 5, 1);
    for (int t = 0; t < network.n_throat; t++)
        network.throat_radius[t] = 1 + (int)(next_random(&seed) * radii);
    struct invasion invasion;
    struct reason reason;
    assert_int_equal(
        invade(&network, WALL_Z_UPPER, WALL_Z_LOWER, trapping, &invasion, &reason), 0);

    bool *gas_throat = NEW_ARRAY(bool, network.n_throat);
    bool *gas_node = NEW_ARRAY(bool, network.n_node);
    for (int i = 0; i < network.n_node; i++)
        gas_node[i] = network.node_walls[i] & WALL_Z_UPPER;
    int n = 0, breakthrough = -1;
    for (int t; (t = next_throat(&network, gas_throat, gas_node, trapping)) >= 0; n++) {
        assert_true(n < invasion.n);
        assert_int_equal(invasion.throat[n], t);
        gas_throat[t] = true;
        for (int end = 0; end < 2; end++) {
            const int node = network.throat_nodes[t][end];
            gas_node[node] = true;
            if (breakthrough < 0 && (network.node_walls[node] & WALL_Z_LOWER))
                breakthrough = n + 1;
        }
    }
    assert_int_equal(invasion.n, n);
    assert_int_equal(invasion.breakthrough, breakthrough);
    free(gas_throat);
    free(gas_node);
    invasion_free(&invasion);
    network_free(&network);
}

static void test_widest_first(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        check_rule(false, 1000000, seed);
        check_rule(false, 5, seed); // ties
    }
    check_rule(false, 1, 6); // nothing but ties
}

static void test_trapped_liquid_stays(void **state)
{
    (void)state;
    for (uint64_t seed = 11; seed <= 15; seed++) {
        check_rule(true, 1000000, seed);
        check_rule(true, 5, seed);
    }
    check_rule(true, 1, 16);
}

static void test_ranks_of_any_radii(void **state)
{
    (void)state;
    enum { N = 5000 };
    static double radius[N];
    static int order[N];
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
        rank_descending(radius, N, order);
        for (int k = 1; k < N; k++) {
            const double before = radius[order[k - 1]], here = radius[order[k]];
            assert_true(before > here || (before == here && order[k - 1] < order[k]));
        }
    }
}

int main(void)
{
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_widest_first),
                                       cmocka_unit_test(test_trapped_liquid_stays),
                                       cmocka_unit_test(test_ranks_of_any_radii)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
