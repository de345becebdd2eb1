// SPDX-License-Identifier: GPL-3.0-or-later
// Profiles and snapshots hold the liquid that the history says is there.
#include "../../test.h"
#include "../support_lattice.h"

#include "dry/run/profiles.h"

#include <stdbool.h>

static void check_level(const struct network *network,
                        const struct drying_history *history,
                        const struct profiles *profiles, int level)
{
    const int step = profiles->step[level];
    double liquid = 0, full = 0, surface = 0, surface_full = 0;
    for (int t = 0; t < network->n_throat; t++) {
        const double volume = throat_volume(network, t);
        const double saturation =
            profiles->throat_saturation[level * network->n_throat + t];
        const int32_t *node = network->throat_nodes[t];
        liquid += saturation * volume;
        full += volume;
        if ((network->node_walls[node[0]] | network->node_walls[node[1]]) &
            WALL_Z_UPPER) {
            surface += saturation * volume;
            surface_full += volume;
        }
    }
    assert_true(fabs(liquid / full - history->saturation[step]) < 1e-13);
    assert_true(fabs(surface / surface_full - profiles->surface[level]) < 1e-13);
    int n = 0;
    for (int k = 0; k < PROFILE_CLASSES; k++)
        n += profiles->clusters[level * PROFILE_CLASSES + k];
    assert_int_equal(n, history->clusters[step]);
}

static void check_profiles(enum liquid_limit liquid)
{
    struct network network = lattice_network(5, 5, 6, 5e-7);
    randomise_radii(&network, 5e-7, 0.3, 2);
    const struct drying_conditions conditions = kharaghani_conditions(liquid);
    struct drying_history history = dry_and_check(&network, &conditions);
    const double level[] = {1, 0.8, 0.5, 0.2, 0};
    struct profiles profiles =
        profiles_init(&network, &history, WALL_Z_UPPER,
                      liquid == LIQUID_IMMOBILE ? PATHS_THROATS : PATHS_PARTED_BY_GAS,
                      5, level, true);
    assert_int_equal(profiles.step[0], 0);
    assert_int_equal(profiles.step[4], history.n_step - 1);
    for (int k = 0; k < 5; k++) {
        assert_true(history.saturation[profiles.step[k]] <= level[k]);
        if (k > 0) assert_true(history.saturation[profiles.step[k] - 1] > level[k]);
        check_level(&network, &history, &profiles, k);
    }
    // Full, and dry, everywhere: the lattice has throats at eleven depths.
    int n_slice = 0;
    for (int s = 0; s < PROFILE_SLICES; s++) {
        n_slice += profiles.slice[s] == 1;
        assert_true(profiles.slice[s] == 0 || profiles.slice[s] == 1);
        assert_true(profiles.slice[4 * PROFILE_SLICES + s] == 0);
    }
    assert_int_equal(n_slice, 11);
    profiles_free(&profiles);
    drying_history_free(&history);
    network_free(&network);
}

TEST(profiles_hold_the_liquid)
{
    check_profiles(LIQUID_INVISCID);
    check_profiles(LIQUID_IMMOBILE);
    check_profiles(LIQUID_VISCOUS);
}
