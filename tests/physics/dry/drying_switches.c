// SPDX-License-Identifier: GPL-3.0-or-later
// What is off by default: gravity, contact angle, Knudsen effect. In closed form when
// on, and of no trace when off.
#include "../../test.h"
#include "../support_lattice.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const double spacing = 1e-3;

static double middle_height(const struct network *network, int throat)
{
    const int32_t *node = network->throat_nodes[throat];
    return (network->node_position[node[0]].z + network->node_position[node[1]].z) / 2;
}

// Equal tubes joined at the bottom: their levels fall together, down to the bottom.
TEST(gravity_levels_equal_tubes)
{
    const int n_column = 9;
    struct network network = lattice_network(3, 3, 7, spacing);
    for (int t = 0; t < network.n_throat; t++) {
        const int32_t *node = network.throat_nodes[t];
        const bool bottom = node[1] < n_column;
        if (node[1] - node[0] != n_column && !bottom)
            network.throat_kind[t] = THROAT_IMPOSED_EMPTY;
        if (bottom) network.throat_radius[t] *= 0.5;
    }
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    conditions.gravity = 9.81;
    struct drying_history history = dry_and_check(&network, &conditions);
    for (int k = 0; k < 5 * n_column; k++) {
        const double height = middle_height(&network, history.event_throat[k]);
        assert_true(fabs(height / spacing - (5.5 - k / n_column)) < 1e-12);
    }
    drying_history_free(&history);
    network_free(&network);
}

// A tube one spacing lower is emptied after another if it is wider by less than
// 2 sigma cos(theta) (1/r - 1/R) = rho g spacing.
static double wider_by(double factor, double angle)
{
    const double r = 0.2 * spacing, rise = 998.2 * 9.81 * spacing;
    const double tension = 2 * 0.07274 * cos(angle * M_PI / 180);
    return 1 / (1 / r - factor * rise / tension);
}

// Two wells in the surface, of one throat each, lead down to a pair of throats: 0
// deeper than 1 by a spacing. Which is emptied first?
static int first_of_wells(enum liquid_limit liquid, double factor, double angle)
{
    struct network network = lattice_network(2, 2, 4, spacing);
    for (int t = 0; t < network.n_throat; t++) {
        const int32_t *node = network.throat_nodes[t];
        const bool vertical = node[1] - node[0] == 4;
        if (vertical ? node[0] % 4 > 1 : node[0] >= 4 || node[1] != 1)
            network.throat_kind[t] = THROAT_IMPOSED_EMPTY;
        // Wide above, so that gas comes down to the two; narrow elsewhere.
        network.throat_radius[t] =
            vertical && node[0] >= 8 ? 0.4 * spacing : 0.05 * spacing;
    }
    const int upper = lattice_throat(&network, 8 + 1, 2);
    const int above_lower = lattice_throat(&network, 8, 2);
    const int lower = lattice_throat(&network, 4, 2);
    network.throat_radius[upper] = 0.2 * spacing;
    network.throat_radius[above_lower] = 0.4 * spacing;
    network.throat_radius[lower] = wider_by(factor, angle);
    struct drying_conditions conditions = kharaghani_conditions(liquid);
    conditions.gravity = 9.81;
    conditions.contact_angle = angle;
    conditions.viscosity = 1e-18;
    struct drying_history history = dry_and_check(&network, &conditions);
    assert_int_equal(history.event_throat[0], above_lower);
    const int first = history.event_throat[1];
    assert_true(first == upper || first == lower);
    drying_history_free(&history);
    network_free(&network);
    return first == lower;
}

TEST(gravity_against_capillarity)
{
    const enum liquid_limit liquids[] = {LIQUID_INVISCID, LIQUID_VISCOUS};
    for (int k = 0; k < 2; k++)
        for (double angle = 0; angle < 90; angle += 40) {
            assert_false(first_of_wells(liquids[k], 0.99, angle));
            assert_true(first_of_wells(liquids[k], 1.01, angle));
        }
}

// One column: the resistance of each empty throat is larger by 1 + D/D_K.
TEST(knudsen_resistance)
{
    const double small = 5e-7;
    const int n = 6;
    struct network network = lattice_column(n, small);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    conditions.knudsen = true;
    struct drying_history history = dry_and_check(&network, &conditions);
    const double r = 0.2 * small;
    const double knudsen =
        2.0 / 3 * r * sqrt(8 * GAS_CONSTANT * 293.15 / (M_PI * conditions.molar_mass));
    const double free_diffusion = conditions.diffusivity;
    const double layer = free_diffusion / conditions.mass_transfer / (small * small);
    for (int k = 0; k < n; k++) {
        const double throats =
            k * small / (M_PI * r * r) * (1 + free_diffusion / knudsen);
        assert_true(fabs(history.rate[k] / history.rate[0] * (layer + throats) / layer -
                         1) < 1e-12);
    }
    drying_history_free(&history);
    network_free(&network);
}

static bool same(const struct drying_history *a, const struct drying_history *b)
{
    const size_t n = (size_t)a->n_step, m = (size_t)a->n_event;
    return a->n_step == b->n_step && a->n_event == b->n_event &&
           memcmp(a->time, b->time, n * sizeof *a->time) == 0 &&
           memcmp(a->rate, b->rate, n * sizeof *a->rate) == 0 &&
           memcmp(a->saturation, b->saturation, n * sizeof *a->saturation) == 0 &&
           memcmp(a->event_throat, b->event_throat, m * sizeof *a->event_throat) == 0;
}

// Properties of the liquid that nothing asks for change no bit.
TEST(off_leaves_no_trace)
{
    struct network network = lattice_network(5, 5, 5, spacing);
    randomise_radii(&network, spacing, 0.3, 3);
    const enum liquid_limit liquids[] = {LIQUID_INVISCID, LIQUID_IMMOBILE};
    for (int k = 0; k < 2; k++) {
        struct drying_conditions conditions = kharaghani_conditions(liquids[k]);
        struct drying_history plain = dry_and_check(&network, &conditions);
        conditions.contact_angle = 45;
        conditions.surface_tension = 0.03;
        conditions.viscosity = 1e-3;
        struct drying_history other = dry_and_check(&network, &conditions);
        assert_true(same(&plain, &other));
        drying_history_free(&other);
        // Gravity does not move what is immobile; against it, order changes.
        conditions.gravity = 9.81;
        other = dry_and_check(&network, &conditions);
        assert_int_equal(same(&plain, &other), liquids[k] == LIQUID_IMMOBILE);
        drying_history_free(&other);
        drying_history_free(&plain);
    }
    network_free(&network);
}

static int most_clusters(const struct drying_history *history)
{
    int most = 0;
    for (int k = 0; k < history->n_step; k++)
        most = history->clusters[k] > most ? history->clusters[k] : most;
    return most;
}

// A tolerance knows of the order that gravity gives, among many clusters: times within
// it, and the contact angle matters as it does without.
TEST(gravity_with_a_tolerance)
{
    const double small = 5e-7;
    struct network network = lattice_network(12, 11, 8, small);
    randomise_radii(&network, small, 0.5, 4);
    for (double angle = 0; angle < 90; angle += 60) {
        struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
        conditions.gravity = 1e8;
        conditions.contact_angle = angle;
        struct drying_history exact = dry_and_check(&network, &conditions);
        conditions.vapour_tolerance = 1e-3;
        struct drying_history history = dry_and_check(&network, &conditions);
        conditions.contact_angle = 60 - angle;
        struct drying_history other = dry_and_check(&network, &conditions);
        assert_true(most_clusters(&exact) > 20);
        const double end = exact.time[exact.n_step - 1];
        assert_true(fabs(history.time[history.n_step - 1] / end - 1) < 1e-3);
        assert_true(fabs(other.time[other.n_step - 1] / end - 1) > 1e-2);
        int n_moved = 0;
        for (int k = 0; k < exact.n_event; k++)
            n_moved += history.event_throat[k] != exact.event_throat[k];
        assert_true(n_moved < exact.n_event / 10);
        drying_history_free(&exact);
        drying_history_free(&history);
        drying_history_free(&other);
    }
    network_free(&network);
}
