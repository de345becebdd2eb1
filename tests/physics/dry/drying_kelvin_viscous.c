// SPDX-License-Identifier: GPL-3.0-or-later
// Viscous liquid whose menisci have vapour pressures of their own: tubes in closed form
// and by quadrature, both limits of the viscosity, no Kelvin effect, balances,
// equilibrium with the air, and the unit of length.
#include "../../test.h"
#include "../support_lattice.h"

#include "basics/memory.h"

#include <gsl/gsl_integration.h>
#include <gsl/gsl_roots.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const double spacing = 1e-7;

// p_c M / (rho R T) of a capillary pressure.
static double exponent(const struct drying_conditions *conditions, double pressure)
{
    return pressure * conditions->molar_mass /
           (conditions->liquid_density * GAS_CONSTANT * conditions->temperature);
}

// kg/s through a unit of area over length, from a meniscus of that capillary pressure.
static double drive(const struct drying_conditions *conditions, double pressure)
{
    const double gas = conditions->gas_pressure;
    const double heat = GAS_CONSTANT * conditions->temperature;
    const double vapour =
        conditions->saturation_pressure * exp(-exponent(conditions, pressure));
    return conditions->diffusivity * gas * conditions->molar_mass / heat *
           log((gas - conditions->air_vapour_pressure) / (gas - vapour));
}

static double suction(const struct drying_conditions *conditions, double radius)
{
    return 2 * conditions->surface_tension / radius;
}

static double resistance(const struct drying_conditions *conditions, double radius)
{
    return 8 * conditions->viscosity * spacing / (M_PI * pow(radius, 4));
}

// --- a pair of tubes -----------------------------------------------------------------

// From the surface, joined at the bottom. The wide one's meniscus moves. The other's
// stays: it is as curved as the pressure that is left when what evaporates from it has
// flowed through all throats, of RESISTANCE in all.
struct pair {
    struct network network;
    struct drying_conditions conditions;
    int wide;
    double radius[3]; // wide, narrow, between
    double area;      // of the layer over each, over its thickness
    double resistance;
};

static struct pair make_pair(double viscosity)
{
    struct pair pair = {.network = lattice_network(2, 2, 2, spacing),
                        .conditions = kelvin_conditions(LIQUID_VISCOUS),
                        .radius = {1e-8, 6e-9, 4e-9}};
    struct network *network = &pair.network;
    const int throat[] = {lattice_throat(network, 0, 2), lattice_throat(network, 1, 2),
                          lattice_throat(network, 0, 0)};
    for (int t = 0; t < network->n_throat; t++)
        network->throat_kind[t] = THROAT_IMPOSED_EMPTY;
    for (int k = 0; k < 3; k++) {
        network->throat_kind[throat[k]] = THROAT_NETWORK;
        network->throat_radius[throat[k]] = pair.radius[k];
    }
    pair.wide = throat[0];
    pair.conditions.lumped = true;
    pair.conditions.viscosity = viscosity;
    pair.area = spacing * spacing / 2 /
                (pair.conditions.diffusivity / pair.conditions.mass_transfer);
    return pair;
}

// What the narrow one evaporates beyond what flows to it at a capillary pressure.
static double excess(double pressure, void *context)
{
    const struct pair *pair = context;
    const double wide = suction(&pair->conditions, pair->radius[0]);
    return pair->area * drive(&pair->conditions, pressure) -
           (pressure - wide) / pair->resistance;
}

static double narrow_pressure(struct pair *pair)
{
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    gsl_function function = {excess, pair};
    const double wide = suction(&pair->conditions, pair->radius[0]);
    gsl_root_fsolver_set(solver, &function, wide,
                         suction(&pair->conditions, pair->radius[1]));
    for (int k = 0; k < 200; k++)
        gsl_root_fsolver_iterate(solver);
    const double root = gsl_root_fsolver_root(solver);
    gsl_root_fsolver_free(solver);
    return root;
}

// What both evaporate when the wide one is full to SATURATION.
static double rate_of_pair(struct pair *pair, double saturation)
{
    const struct drying_conditions *conditions = &pair->conditions;
    pair->resistance = saturation * resistance(conditions, pair->radius[0]) +
                       resistance(conditions, pair->radius[1]) +
                       resistance(conditions, pair->radius[2]);
    return pair->area * (drive(conditions, suction(conditions, pair->radius[0])) +
                         drive(conditions, narrow_pressure(pair)));
}

static double time_over_liquid(double saturation, void *context)
{
    return 1 / rate_of_pair(context, saturation);
}

// At which the narrow meniscus is about half-way between both tubes' curvatures.
static const double middle_viscosity = 1e-5;

TEST(pair_at_first)
{
    for (int k = -4; k <= 0; k++) {
        struct pair pair = make_pair(middle_viscosity * pow(10, k));
        struct drying_history history = dry_or_fail(&pair.network, &pair.conditions);
        const double flat =
            pair.area * 2 *
            drive(&pair.conditions, suction(&pair.conditions, pair.radius[0]));
        const double rate = rate_of_pair(&pair, 1);
        assert_true(fabs(history.rate[0] / rate - 1) < 1e-12);
        assert_true(k < 0 || rate < 0.99 * flat); // the effect is there
        assert_int_equal(history.event_throat[0], pair.wide);
        drying_history_free(&history);
        network_free(&pair.network);
    }
}

// A throat in the surface joins the tops of both tubes. Its meniscus and that of the
// narrow tube stay. Each takes half of what it evaporates from either end, and is as
// curved as the pressure at its middle is low; this gives all flows.
static void check_ring(double viscosity)
{
    struct pair pair = make_pair(viscosity);
    const struct drying_conditions *conditions = &pair.conditions;
    const int top = lattice_throat(&pair.network, 4, 0);
    const double full = 1, radius[] = {pair.radius[0], pair.radius[1], 3e-9};
    enum { WIDE, NARROW, TOP };
    pair.network.throat_kind[top] = THROAT_NETWORK;
    pair.network.throat_radius[top] = radius[TOP];
    pair.conditions.snapshot = &full;
    pair.conditions.n_snapshot = 1;
    struct drying_history history = dry_or_fail(&pair.network, conditions);
    assert_int_equal(history.event_throat[0], pair.wide);

    const double *p = history.pressure, entry = -suction(conditions, radius[WIDE]);
    double conductance[3], section[3], drives[3];
    for (int k = 0; k < 3; k++) {
        conductance[k] = 1 / resistance(conditions, radius[k]);
        section[k] = radius[k] * radius[k];
    }
    const double below = (p[0] - p[1]) / resistance(conditions, pair.radius[2]);
    const double up = conductance[NARROW] * (p[1] - p[5]);
    const double across = conductance[TOP] * (p[4] - p[5]);
    const double from_wide = 2 * conductance[WIDE] * (entry - p[4]);
    const double narrow = 2 * (below - up), between = 2 * (from_wide - across);
    const double rate = history.rate[0];
    assert_true(fabs(2 * conductance[WIDE] * (entry - p[0]) - below) < 1e-10 * rate);
    assert_true(fabs(up - narrow / 2 + across - between / 2) < 1e-10 * rate);

    drives[WIDE] = drive(conditions, -entry);
    drives[NARROW] =
        drive(conditions, narrow / 4 / conductance[NARROW] - (p[1] + p[5]) / 2);
    drives[TOP] = drive(conditions, between / 4 / conductance[TOP] - (p[4] + p[5]) / 2);
    double parts[2]; // of the throat between, by the tube at the other side of the node
    for (int k = WIDE; k <= NARROW; k++) {
        const double all = section[k] + section[TOP];
        const double mean = (section[k] * drives[k] + section[TOP] * drives[TOP]) / all;
        parts[k] = pair.area * mean * section[TOP] / all;
    }
    assert_true(fabs(parts[WIDE] + parts[NARROW] - between) < 1e-10 * rate);
    assert_true(fabs(parts[NARROW] * section[NARROW] / section[TOP] - narrow) <
                1e-10 * rate);
    drying_history_free(&history);
    network_free(&pair.network);
}

TEST(ring_of_three_menisci)
{
    for (int k = -2; k <= 0; k++)
        check_ring(middle_viscosity * pow(10, k));
}

// With the first power of the step at which conductances are renewed.
TEST(pair_in_time)
{
    struct pair pair = make_pair(middle_viscosity);
    gsl_integration_workspace *room = gsl_integration_workspace_alloc(100);
    gsl_function function = {time_over_liquid, &pair};
    double exact, error, before = 0;
    gsl_integration_qag(&function, 0, 1, 0, 1e-11, 100, GSL_INTEG_GAUSS15, room, &exact,
                        &error);
    gsl_integration_workspace_free(room);
    exact *= pair.conditions.liquid_density * throat_volume(&pair.network, pair.wide);
    for (int k = 3; k < 9; k++) {
        pair.conditions.saturation_step = pow(2, -k);
        struct drying_history history = dry_or_fail(&pair.network, &pair.conditions);
        assert_int_equal(history.event_throat[0], pair.wide);
        const double off = history.event_time[0] / exact - 1;
        assert_true(fabs(off) > 1e-7);
        assert_true(k == 3 || fabs(before / off - 2) < 0.01);
        before = off;
        drying_history_free(&history);
    }
    assert_true(fabs(before) < 1e-4);
    network_free(&pair.network);
}

// --- networks ------------------------------------------------------------------------

// Of throats no two of which are alike in length: those at one node would empty at
// once.
static struct network make_network(const int n[3], double spread)
{
    struct network network = lattice_network(n[0], n[1], n[2], spacing);
    randomise_radii(&network, spacing, spread, 12);
    uint64_t seed = 22;
    for (int t = 0; t < network.n_throat; t++)
        network.throat_length[t] *= 0.7 + 0.6 * next_random(&seed);
    return network;
}

// When each throat has emptied for the last time, of the end. The caller frees it.
static double *times_of(const struct network *network,
                        const struct drying_conditions *conditions)
{
    struct drying_history history = dry_or_fail(network, conditions);
    double *time = NEW_ARRAY(double, network->n_throat);
    for (int k = 0; k < history.n_event; k++)
        time[history.event_throat[k]] =
            history.event_time[k] / history.time[history.n_step - 1];
    drying_history_free(&history);
    return time;
}

static double largest_distance(const struct network *network, const double *a,
                               const double *b)
{
    double most = 0;
    for (int t = 0; t < network->n_throat; t++)
        most = fmax(most, fabs(a[t] - b[t]));
    return most;
}

// As FACTOR takes the viscosity to a limit, each throat's time goes there with the
// first power of it.
static void check_limit(enum liquid_limit limit, double viscosity, double factor,
                        double gravity)
{
    struct network network = make_network((int[]){4, 4, 4}, 0.6);
    struct drying_conditions conditions = kelvin_conditions(limit);
    conditions.gravity = gravity;
    double *there = times_of(&network, &conditions), before = 0;
    conditions.liquid = LIQUID_VISCOUS;
    for (int k = 0; k < 4; k++) {
        conditions.viscosity = viscosity * pow(factor, k);
        double *times = times_of(&network, &conditions);
        const double now = largest_distance(&network, times, there);
        const double order = log(now / before) / -fabs(log(factor));
        assert_true(k == 0 || fabs(order - 1) < 0.05);
        assert_true(k < 3 || now < 1e-7);
        before = now;
        free(times);
    }
    free(there);
    network_free(&network);
}

TEST(no_viscosity)
{
    check_limit(LIQUID_INVISCID, 1e-11, 0.1, 0);
    check_limit(LIQUID_INVISCID, 1e-11, 0.1, 1e11); // four times capillarity
}

TEST(all_viscosity)
{
    check_limit(LIQUID_IMMOBILE, 1e4, 10, 0);
}

// The exponent goes with the molar mass; so does the rate, and the pressures of the
// flow stay if the viscosity is larger by as much.
TEST(no_effect)
{
    struct network network = make_network((int[]){4, 4, 4}, 0.6);
    double before = 0;
    for (int k = 0; k < 3; k++) {
        struct drying_conditions conditions = kelvin_conditions(LIQUID_VISCOUS);
        const double less = 1e-5 * pow(10, -k);
        conditions.molar_mass *= less;
        conditions.viscosity = 1e-6 / less;
        double *with = times_of(&network, &conditions);
        conditions.kelvin = false;
        double *without = times_of(&network, &conditions);
        const double now = largest_distance(&network, with, without);
        assert_true(now > 0 && now < 10 * less);
        assert_true(k == 0 || fabs(before / now - 10) < 0.1);
        before = now;
        free(with);
        free(without);
    }
    network_free(&network);
}

// From nearly no viscosity to nearly no flow: nothing is lost, above 1 or below 0.
TEST(balances)
{
    struct network network = make_network((int[]){4, 4, 5}, 0.9);
    int refilled = 0;
    for (int decade = -12; decade <= 6; decade += 3) {
        struct drying_conditions conditions = kelvin_conditions(LIQUID_VISCOUS);
        conditions.viscosity = pow(10, decade);
        struct drying_history history = dry_or_fail(&network, &conditions);
        assert_true(fabs(history.evaporated / history.initial_liquid - 1) < 1e-12);
        assert_true(history.vapour_residual < 1e-11 && history.liquid_residual < 1e-11);
        assert_true(history.saturation[history.n_step - 1] == 0);
        for (int64_t c = 0; c < history.change_offset[history.n_step]; c++)
            assert_true(history.change_saturation[c] >= 0 &&
                        history.change_saturation[c] <= 1);
        for (int k = 0; k + 1 < history.n_step; k++)
            assert_true(history.time[k + 1] >= history.time[k]);
        for (int k = 0; k < history.n_event; k++)
            refilled += history.event_kind[k] == EVENT_REFILLED;
        drying_history_free(&history);
    }
    assert_true(refilled > 0);
    network_free(&network);
}

// In air as humid as above the menisci of the pores, all alike, nothing moves: as the
// air comes near it all rates go to 0 in proportion. Above it, it is refused.
TEST(equilibrium)
{
    struct network network = lattice_network(3, 3, 4, spacing);
    for (int t = 0; t < network.n_throat; t++)
        network.throat_radius[t] = 5e-9;
    struct drying_conditions conditions = kelvin_conditions(LIQUID_VISCOUS);
    const double humid = conditions.saturation_pressure *
                         exp(-exponent(&conditions, suction(&conditions, 5e-9)));
    double before = 0;
    for (int k = 0; k < 4; k++) {
        const double less = pow(10, -2 - 2 * k);
        conditions.air_vapour_pressure = humid * (1 - less);
        struct drying_history history = dry_or_fail(&network, &conditions);
        assert_true(k == 0 || fabs(before / history.rate[0] / 100 - 1) < 1e-2);
        assert_true(fabs(history.evaporated / history.initial_liquid - 1) < 1e-12);
        before = history.rate[0];
        drying_history_free(&history);
    }
    conditions.air_vapour_pressure = humid * (1 + 1e-12);
    struct drying_history history;
    struct reason reason = {""};
    assert_int_equal(dry_network(&network, &conditions, NULL, &history, &reason),
                     STATUS_BAD_DATA);
    drying_history_free(&history);
    network_free(&network);
}

// So cold that menisci have 1e-8 of the vapour of flat ones and less, twice as curved
// none to rounding: either each rate is a number, or it is said by how little they are
// driven.
TEST(hardly_any_vapour)
{
    struct network network = lattice_network(3, 3, 4, spacing);
    randomise_radii(&network, 1.8e-8, 0.1, 4);
    struct drying_conditions conditions = kelvin_conditions(LIQUID_VISCOUS);
    conditions.knudsen = true;
    for (int k = 0; k < 9; k++) {
        conditions.temperature = 4 + k % 3;
        conditions.viscosity = pow(10, -6 + k / 3);
        struct drying_history history;
        struct reason reason = {""};
        const enum status status =
            dry_network(&network, &conditions, NULL, &history, &reason);
        if (status) {
            assert_int_equal(status, STATUS_NOT_CONVERGED);
            assert_non_null(strstr(reason.text, "the widest are driven by"));
            assert_null(strstr(reason.text, "nan"));
        }
        for (int i = 0; !status && i < history.n_step; i++)
            assert_true(history.rate[i] >= 0);
        drying_history_free(&history);
    }
    network_free(&network);
}

TEST(unit_of_length_does_not_matter)
{
    struct network network = make_network((int[]){4, 4, 4}, 0.9);
    check_dries_alike_enlarged(&network, kelvin_conditions(LIQUID_VISCOUS));
    network_free(&network);
}
