// SPDX-License-Identifier: GPL-3.0-or-later
// Clusters kept online against clusters found anew after every event, on small random
// networks with parallel throats and loose pieces.
#include "../../test.h"
#include "../support_lattice.h"
#include "dry/liquid/clusters.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>

enum { NODES = 40, THROATS = 70 };

struct reference {
    bool gas[NODES];
    bool full[THROATS];
    int cluster[THROATS]; // -1 where empty
    int count;
};

static struct network random_network(uint64_t *seed)
{
    struct network network = {.n_node = NODES, .n_throat = THROATS};
    network.node_position = NEW_ARRAY(struct vector, NODES); // all in one place
    network.throat_nodes = allocate(THROATS, sizeof *network.throat_nodes);
    network.throat_radius = NEW_ARRAY(double, THROATS);
    network.throat_length = NEW_ARRAY(double, THROATS);
    network.throat_kind = NEW_ARRAY(uint8_t, THROATS);
    for (int t = 0; t < THROATS; t++) {
        const int a = (int)(next_random(seed) * NODES);
        const int b = (a + 1 + (int)(next_random(seed) * (NODES - 1))) % NODES;
        network.throat_nodes[t][0] = a < b ? a : b;
        network.throat_nodes[t][1] = a < b ? b : a;
        // Few different radii, so that many tie.
        network.throat_radius[t] = 1 + (int)(next_random(seed) * 10);
        network.throat_length[t] = 1;
        network.throat_kind[t] =
            next_random(seed) < 0.1 ? THROAT_IMPOSED_EMPTY : THROAT_NETWORK;
    }
    return network;
}

static bool connected(const struct network *network, const struct reference *reference,
                      bool gas_parts, int t, int s)
{
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            const int node = network->throat_nodes[t][i];
            if (node == network->throat_nodes[s][j] &&
                !(gas_parts && reference->gas[node]))
                return true;
        }
    return false;
}

// Labels spread from neighbour to neighbour until nothing changes.
static void label_anew(const struct network *network, struct reference *reference,
                       bool gas_parts)
{
    for (int t = 0; t < THROATS; t++)
        reference->cluster[t] = reference->full[t] ? t : -1;
    for (bool changed = true; changed;) {
        changed = false;
        for (int t = 0; t < THROATS; t++)
            for (int s = 0; s < THROATS; s++)
                if (reference->full[t] && reference->full[s] &&
                    reference->cluster[s] < reference->cluster[t] &&
                    connected(network, reference, gas_parts, t, s)) {
                    reference->cluster[t] = reference->cluster[s];
                    changed = true;
                }
    }
    reference->count = 0;
    for (int t = 0; t < THROATS; t++)
        reference->count += reference->cluster[t] == t;
}

static int widest_meniscus(const struct network *network,
                           const struct reference *reference, int cluster)
{
    int widest = -1;
    for (int t = 0; t < THROATS; t++) {
        const int32_t *node = network->throat_nodes[t];
        if (reference->cluster[t] == cluster &&
            (reference->gas[node[0]] || reference->gas[node[1]]) &&
            (widest < 0 || network->throat_radius[t] > network->throat_radius[widest]))
            widest = t;
    }
    return widest;
}

static void compare(const struct network *network, struct clusters *clusters,
                    const struct reference *reference)
{
    assert_int_equal(clusters->count, reference->count);
    for (int t = 0; t < THROATS; t++) {
        const int cluster = clusters->of_throat[t];
        assert_int_equal(cluster < 0, reference->cluster[t] < 0);
        if (cluster < 0) continue;
        int size = 0;
        for (int s = 0; s < THROATS; s++) {
            assert_int_equal(clusters->of_throat[s] == cluster,
                             reference->cluster[s] == reference->cluster[t]);
            size += clusters->of_throat[s] == cluster;
        }
        assert_int_equal(clusters->size[cluster], size);
        assert_int_equal(clusters_invasion_throat(clusters, cluster),
                         widest_meniscus(network, reference, reference->cluster[t]));
    }
}

static void empty_in_random_order(bool gas_parts, uint64_t *seed)
{
    struct network network = random_network(seed);
    struct incidence incidence = network_incidence(&network);
    struct clusters clusters = clusters_init(&network, &incidence, NULL, gas_parts);
    struct reference reference = {0};
    int left = 0;
    for (int t = 0; t < THROATS; t++) {
        reference.full[t] = network.throat_kind[t] == THROAT_NETWORK;
        left += reference.full[t];
    }
    label_anew(&network, &reference, gas_parts);
    compare(&network, &clusters, &reference);
    while (left > 0) {
        const int throat = (int)(next_random(seed) * THROATS);
        if (!reference.full[throat]) continue;
        clusters_empty_throat(&clusters, throat);
        reference.full[throat] = false;
        for (int end = 0; end < 2; end++)
            reference.gas[network.throat_nodes[throat][end]] = true;
        label_anew(&network, &reference, gas_parts);
        compare(&network, &clusters, &reference);
        left--;
    }
    clusters_free(&clusters);
    incidence_free(&incidence);
    network_free(&network);
}

TEST(clusters_where_gas_parts_liquid)
{
    uint64_t seed = 1;
    for (int run = 0; run < 20; run++)
        empty_in_random_order(true, &seed);
}

TEST(clusters_where_liquid_stays_in_touch)
{
    uint64_t seed = 2;
    for (int run = 0; run < 20; run++)
        empty_in_random_order(false, &seed);
}
