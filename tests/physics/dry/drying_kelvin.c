// SPDX-License-Identifier: GPL-3.0-or-later
// Menisci with vapour pressures of their own: tubes in closed form, condensation by
// hand and in balance, the limit of no surface tension, and the unit of length.
#include "../../test.h"
#include "../support_lattice.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const double spacing = 1e-7;

static const enum liquid_limit limits[] = {LIQUID_INVISCID, LIQUID_IMMOBILE,
                                           LIQUID_VISCOUS};

// kg/s through a unit of area over length, from a meniscus of that radius into the air.
static double drive(const struct drying_conditions *conditions, double radius)
{
    const double tension =
        2 * conditions->surface_tension * cos(conditions->contact_angle * (M_PI / 180));
    const double gas = conditions->gas_pressure, heat = GAS_CONSTANT * 293.15;
    const double vapour = conditions->saturation_pressure *
                          exp(-tension / radius * conditions->molar_mass /
                              (conditions->liquid_density * heat));
    return conditions->diffusivity * gas * conditions->molar_mass / heat *
           log((gas - conditions->air_vapour_pressure) / (gas - vapour));
}

// Leaves only the columns along z at those nodes of the bottom that are in COLUMNS.
static void leave_columns(struct network *network, unsigned columns)
{
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *node = network->throat_nodes[t];
        if (node[1] - node[0] != 4 || !(columns >> node[0] % 4 & 1))
            network->throat_kind[t] = THROAT_IMPOSED_EMPTY;
    }
}

// Two tubes in series: each has its own vapour while it empties.
TEST(tubes_in_series)
{
    for (int k = 0; k < 12; k++) {
        struct network network = lattice_network(2, 2, 3, spacing);
        leave_columns(&network, 1);
        const int lower = lattice_throat(&network, 0, 2);
        const int upper = lattice_throat(&network, 4, 2);
        network.throat_radius[lower] = 3e-9;
        network.throat_radius[upper] = k / 2 % 2 ? 2e-8 : 2e-9;
        struct drying_conditions conditions = kelvin_conditions(limits[k / 4]);
        conditions.contact_angle = k % 2 ? 60 : 0;
        conditions.air_vapour_pressure = 300;
        struct drying_history history = dry_and_check(&network, &conditions);
        const double layer =
            conditions.diffusivity / conditions.mass_transfer / (spacing * spacing);
        const double r = network.throat_radius[upper];
        const double first = drive(&conditions, r) / layer;
        const double second =
            drive(&conditions, 3e-9) / (layer + spacing / (M_PI * r * r));
        assert_true(fabs(history.rate[0] / first - 1) < 1e-12);
        assert_true(fabs(history.rate[1] / second - 1) < 1e-12);
        const double time = spacing * M_PI * conditions.liquid_density *
                            (r * r / first + 9e-18 / second);
        assert_true(fabs(history.time[2] / time - 1) < 1e-12);
        drying_history_free(&history);
        network_free(&network);
    }
}

// Resistance of the layer over PART of the open surface, and of a throat.
static double layer_resistance(const struct drying_conditions *conditions, double part)
{
    return conditions->diffusivity / conditions->mass_transfer /
           (part * spacing * spacing);
}

static double throat_resistance(double radius)
{
    return spacing / (M_PI * radius * radius);
}

static double throat_mass(double radius)
{
    return 998.2 * spacing * M_PI * radius * radius;
}

// Side by side, each through a layer of its own.
TEST(tubes_in_parallel)
{
    for (int l = 0; l < 3; l++) {
        struct network network = lattice_network(2, 2, 2, spacing);
        leave_columns(&network, 15);
        struct drying_conditions conditions = kelvin_conditions(limits[l]);
        conditions.lumped = true;
        double rate = 0;
        for (int t = 0, k = 0; t < network.n_throat; t++) {
            if (network.throat_kind[t] != THROAT_NETWORK) continue;
            network.throat_radius[t] = 2e-9 * (1 << k++);
            rate += drive(&conditions, network.throat_radius[t]) /
                    layer_resistance(&conditions, 0.25);
        }
        struct drying_history history = dry_and_check(&network, &conditions);
        assert_true(fabs(history.rate[0] / rate - 1) < 1e-12);
        drying_history_free(&history);
        network_free(&network);
    }
}

// Two tubes side by side, joined at the bottom by a narrow throat: as long as the
// liquid is in one piece, all of it has the vapour of the widest meniscus.
TEST(joined_tubes)
{
    const double radius[] = {2e-8, 5e-9, 2e-9};
    struct network network = lattice_network(2, 2, 2, spacing);
    const int throat[] = {lattice_throat(&network, 0, 2),
                          lattice_throat(&network, 1, 2),
                          lattice_throat(&network, 0, 0)};
    for (int t = 0; t < network.n_throat; t++)
        network.throat_kind[t] = THROAT_IMPOSED_EMPTY;
    for (int k = 0; k < 3; k++) {
        network.throat_kind[throat[k]] = THROAT_NETWORK;
        network.throat_radius[throat[k]] = radius[k];
    }
    struct drying_conditions conditions = kelvin_conditions(LIQUID_INVISCID);
    conditions.lumped = true;
    struct drying_history history = dry_and_check(&network, &conditions);
    const double layer = layer_resistance(&conditions, 0.5);
    const double first = layer + throat_resistance(radius[0]);
    const double second = layer + throat_resistance(radius[1]);
    const double conductance[] = {2 / layer, 1 / layer + 1 / first,
                                  1 / first + 1 / second};
    double time = 0;
    for (int k = 0; k < 3; k++) {
        const double rate = drive(&conditions, radius[k]) * conductance[k];
        time += throat_mass(radius[k]) / rate;
        assert_int_equal(history.event_throat[k], throat[k]);
        assert_true(fabs(history.rate[k] / rate - 1) < 1e-12);
        assert_true(fabs(history.time[k + 1] / time - 1) < 1e-12);
    }
    drying_history_free(&history);
    network_free(&network);
}

// A junction under the surface from which gas leads to two throats of liquid, each for
// itself. What they evaporate, by hand, of potentials DRIVE over resistances.
struct pair {
    struct network network;
    int wide, narrow;
    double *start;
    double out, in; // resistances from the junction into the air, and to either throat
};

static struct pair make_pair(double wide, double narrow, double filled)
{
    struct pair pair = {.network = lattice_network(2, 2, 4, spacing)};
    struct network *network = &pair.network;
    pair.wide = lattice_throat(network, 5, 2);
    pair.narrow = lattice_throat(network, 6, 2);
    pair.start = NEW_ARRAY(double, network->n_throat);
    for (int t = 0; t < network->n_throat; t++)
        network->throat_kind[t] = THROAT_IMPOSED_EMPTY;
    const int gas[] = {lattice_throat(network, 8, 0), lattice_throat(network, 8, 1),
                       lattice_throat(network, 8, 2)};
    for (int k = 0; k < 3; k++)
        network->throat_kind[gas[k]] = THROAT_NETWORK;
    network->throat_kind[pair.wide] = network->throat_kind[pair.narrow] =
        THROAT_NETWORK;
    network->throat_radius[pair.wide] = wide;
    network->throat_radius[pair.narrow] = narrow;
    pair.start[pair.wide] = 1;
    pair.start[pair.narrow] = filled;
    const struct drying_conditions conditions = kelvin_conditions(LIQUID_INVISCID);
    pair.in = throat_resistance(network->throat_radius[gas[0]]);
    pair.out = layer_resistance(&conditions, 1) + pair.in;
    return pair;
}

static struct drying_history dry_pair(const struct pair *pair, enum liquid_limit liquid)
{
    struct drying_conditions conditions = kelvin_conditions(liquid);
    conditions.start = pair->start;
    return dry_or_fail(&pair->network, &conditions);
}

static void free_pair(struct pair *pair)
{
    free(pair->start);
    network_free(&pair->network);
}

// Radii so near each other that both dry, the narrow throat first: it has less liquid.
TEST(two_pieces_that_both_dry)
{
    struct pair pair = make_pair(2e-8, 1.98e-8, 1);
    const struct drying_conditions conditions = kelvin_conditions(LIQUID_INVISCID);
    const double wide = drive(&conditions, 2e-8), narrow = drive(&conditions, 1.98e-8);
    const double junction =
        (wide / pair.in + narrow / pair.in) / (1 / pair.out + 2 / pair.in);
    const double time = throat_mass(1.98e-8) / ((narrow - junction) / pair.in);
    const double left = throat_mass(2e-8) - time * (wide - junction) / pair.in;
    const double alone = wide / (pair.out + pair.in);
    for (int l = 0; l < 3; l++) {
        struct drying_history history = dry_pair(&pair, limits[l]);
        assert_int_equal(history.event_throat[0], pair.narrow);
        assert_true(fabs(history.rate[0] / (junction / pair.out) - 1) < 1e-12);
        assert_true(fabs(history.time[1] / time - 1) < 1e-11);
        assert_true(fabs(history.rate[1] / alone - 1) < 1e-12);
        assert_true(fabs(history.time[2] / (time + left / alone) - 1) < 1e-11);
        drying_history_free(&history);
    }
    free_pair(&pair);
}

// The narrow throat waits, full, until the wide one is empty. Half full it fills first.
TEST(two_pieces_of_which_one_waits)
{
    const struct drying_conditions conditions = kelvin_conditions(LIQUID_INVISCID);
    const double wide = drive(&conditions, 2e-8), narrow = drive(&conditions, 2e-9);
    for (int k = 0; k < 6; k++) {
        const bool fills = k % 2;
        struct pair pair = make_pair(2e-8, 2e-9, fills ? 0.5 : 1);
        const double junction =
            (wide / pair.in + narrow / pair.in) / (1 / pair.out + 2 / pair.in);
        const double gain = (junction - narrow) / pair.in;
        const double filling = fills ? throat_mass(2e-9) / 2 / gain : 0;
        const double lost = fills ? filling * (wide - junction) / pair.in : 0;
        const double alone = wide / (pair.out + pair.in);
        const double emptied = filling + (throat_mass(2e-8) - lost) / alone;
        const double end = emptied + throat_mass(2e-9) * (pair.out + pair.in) / narrow;
        assert_true(gain > 0);
        struct drying_history history = dry_pair(&pair, limits[k / 2]);
        assert_int_equal(history.n_event, fills ? 3 : 2);
        const int last = history.n_event - 1;
        if (fills) {
            assert_int_equal(history.event_kind[0], EVENT_REFILLED);
            assert_int_equal(history.event_throat[0], pair.narrow);
            assert_true(fabs(history.event_time[0] / filling - 1) < 1e-11);
        }
        assert_true(fabs(history.rate[last - 1] / alone - 1) < 1e-12);
        assert_int_equal(history.event_throat[last - 1], pair.wide);
        assert_true(fabs(history.event_time[last - 1] / emptied - 1) < 1e-11);
        assert_true(fabs(history.event_time[last] / end - 1) < 1e-11);
        drying_history_free(&history);
        free_pair(&pair);
    }
}

// One throat open above and below: its upper meniscus has less vapour than its lower,
// by the barometric formula.
TEST(gravity)
{
    struct network network = lattice_column(1, spacing);
    struct drying_conditions conditions = kelvin_conditions(LIQUID_INVISCID);
    conditions.gravity = 1e12;
    conditions.open_walls = WALL_Z_LOWER | WALL_Z_UPPER;
    struct drying_history history = dry_and_check(&network, &conditions);
    const double tension = 2 * conditions.surface_tension;
    const double radius = network.throat_radius[lattice_throat(&network, 0, 2)];
    double rate = 0;
    for (int side = -1; side <= 1; side += 2) {
        const double suction = tension / radius + side * 998.2 * 1e12 * spacing / 2;
        rate +=
            drive(&conditions, tension / suction) / layer_resistance(&conditions, 1);
    }
    assert_true(fabs(history.rate[0] / rate - 1) < 1e-12);
    assert_true(fabs(history.rate[0] / drive(&conditions, radius) *
                         layer_resistance(&conditions, 2) -
                     1) > 1e-6);
    drying_history_free(&history);
    network_free(&network);
}

// How far each throat that has filled again had emptied: not by rounding.
static void check_refills(const struct drying_history *history, int n_throat)
{
    double *lowest = NEW_ARRAY(double, n_throat);
    for (int t = 0; t < n_throat; t++)
        lowest[t] = 1;
    for (int k = 0, event = 0; k < history->n_step; k++) {
        for (int64_t c = history->change_offset[k]; c < history->change_offset[k + 1];
             c++)
            lowest[history->change_throat[c]] =
                fmin(lowest[history->change_throat[c]], history->change_saturation[c]);
        for (;
             event < history->n_event && history->event_time[event] <= history->time[k];
             event++) {
            const int throat = history->event_throat[event];
            if (history->event_kind[event] != EVENT_REFILLED) continue;
            assert_true(lowest[throat] < 1 - 1e-12);
            lowest[throat] = 1;
        }
    }
    free(lowest);
}

// Radii from 2 to 38 nm in a random order: vapour condenses. Nothing is lost, above 1
// or below 0, and what has filled again empties again.
static void check_condensation(enum liquid_limit liquid)
{
    struct network network = lattice_network(5, 5, 6, spacing);
    randomise_radii(&network, spacing, 0.9, 12);
    const struct drying_conditions conditions = kelvin_conditions(liquid);
    struct drying_history history = dry_or_fail(&network, &conditions);
    assert_true(fabs(history.evaporated / history.initial_liquid - 1) < 1e-12);
    assert_true(history.vapour_residual < 1e-11);
    assert_true(history.saturation[history.n_step - 1] == 0);
    int refilled = 0;
    for (int k = 0; k < history.n_event; k++)
        refilled += history.event_kind[k] == EVENT_REFILLED;
    assert_true(refilled > 0);
    assert_int_equal(history.n_event, network.n_throat + refilled);
    check_refills(&history, network.n_throat);
    for (int64_t c = 0; c < history.change_offset[history.n_step]; c++)
        assert_true(history.change_saturation[c] >= 0 &&
                    history.change_saturation[c] <= 1);
    for (int k = 0; k + 1 < history.n_step; k++)
        assert_true(history.time[k + 1] >= history.time[k]);
    drying_history_free(&history);
    network_free(&network);
}

TEST(condensation_balances)
{
    check_condensation(LIQUID_INVISCID);
    check_condensation(LIQUID_IMMOBILE);
}

// The vapour is lowered by 1e-9 at most.
static void check_same_order(const struct drying_history *with,
                             const struct drying_history *without)
{
    const double end = without->time[without->n_step - 1];
    int n = 0;
    for (int k = 0; k < with->n_event; k++) {
        if (with->event_kind[k] == EVENT_REFILLED) continue; // what hardly lost
        assert_int_equal(with->event_throat[k], without->event_throat[n]);
        assert_true(fabs(with->event_time[k] - without->event_time[n]) < 1e-8 * end);
        n++;
    }
    assert_int_equal(n, without->n_event);
}

// As the surface tension goes to 0, all is as without, and in proportion to it.
TEST(no_tension_is_no_effect)
{
    struct network network = lattice_network(5, 5, 6, spacing);
    randomise_radii(&network, spacing, 0.5, 13);
    for (int l = 0; l < 2; l++) {
        struct drying_conditions conditions = kelvin_conditions(limits[l]);
        conditions.kelvin = false;
        struct drying_history without = dry_and_check(&network, &conditions);
        conditions.kelvin = true;
        double late[2];
        for (int k = 0; k < 2; k++) {
            conditions.surface_tension = k == 0 ? 1e-9 : 1e-6;
            struct drying_history with = dry_or_fail(&network, &conditions);
            if (k == 0) check_same_order(&with, &without);
            late[k] = with.time[with.n_step - 1] / without.time[without.n_step - 1] - 1;
            drying_history_free(&with);
        }
        assert_true(late[1] > 1e-8 && late[1] < 1e-5);
        assert_true(fabs(late[0] / late[1] * 1e3 - 1) < 1e-3);
        drying_history_free(&without);
    }
    network_free(&network);
}

TEST(unit_of_length_does_not_matter)
{
    for (int l = 0; l < 2; l++) {
        struct network network = lattice_network(4, 4, 5, spacing);
        randomise_radii(&network, spacing, 0.9, 17);
        check_dries_alike_enlarged(&network, kelvin_conditions(limits[l]));
        network_free(&network);
    }
}

TEST(refusals)
{
    struct network network = lattice_network(3, 3, 3, spacing);
    struct drying_conditions conditions = kelvin_conditions(LIQUID_IMMOBILE);
    const struct {
        double air;
        enum liquid_limit liquid;
        const char *says;
    } wrong[] = {{0.99 * 2339, LIQUID_IMMOBILE, "never dries"}, // 0.95 in the throats
                 {0.99 * 2339, LIQUID_INVISCID, "never dries"},
                 {0.99 * 2339, LIQUID_VISCOUS, "never dries"}};
    for (int k = 0; k < 3; k++) {
        conditions.air_vapour_pressure = wrong[k].air;
        conditions.liquid = wrong[k].liquid;
        struct drying_history history;
        struct reason reason = {""};
        assert_int_equal(dry_network(&network, &conditions, NULL, &history, &reason),
                         STATUS_BAD_DATA);
        assert_non_null(strstr(reason.text, wrong[k].says));
        drying_history_free(&history);
    }
    network_free(&network);
}
