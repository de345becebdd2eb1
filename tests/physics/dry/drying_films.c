// SPDX-License-Identifier: GPL-3.0-or-later
// Films of finite resistance: corners against published values and a series solution,
// and a chain of throats, open above and with its liquid below, against its closed
// form. Gas has emptied n throats, the uppermost m nodes are dry:
//     E = 1 / (1 / G + sum of 1 / g)   evaporates at node m (G boundary layer, g the m
//                                      throats above),
//     Q = conductance r^3 / (n - m)    is the most that films can bring there, r of
//                                      the throat that gas enters next.
// While Q > E the liquid below loses E; then it loses Q, and the rings at node m the
// rest, until they are dry. Under gravity
//     E = -conductance (d(r^3)/dz + 3 weight r^4),
// so films rise from radius r to s by the integral of t^2 / (a^4 + t^4) from s to r
// over weight, a^4 = E / (3 weight conductance).
#include "../../test.h"
#include "../support_lattice.h"

#include "basics/memory.h"
#include "dry/inviscid/emptying_times.h"
#include "dry/inviscid/film_supply.h"
#include "dry/liquid/corner_film.h"
#include "dry/liquid/film_law.h"

#include <stdlib.h>

static const double degree = M_PI / 180;

// ---- corners ----------------------------------------------------------------------

// Three corners of a triangle, or four of a square, around its inscribed circle.
TEST(area_is_that_beside_a_circle)
{
    assert_close(4 * corner_area(45 * degree, 0), 4 - M_PI, 1e-14);
    assert_close(3 * corner_area(30 * degree, 0), 3 * sqrt(3) - M_PI, 1e-14);
}

// Ransohoff and Radke (1988), without shear at the meniscus and at a contact angle of
// 0: 93.93 at a half angle of 45 degrees, 31.07 at 30. A series of harmonic functions
// that vanish at the walls, 60 terms fitted on the meniscus to 1e-8 (at 50 degrees to
// 4e-6), gives 3 % less, as the elements here do.
TEST(resistance)
{
    static const struct {
        double half_angle, contact_angle, resistance;
    } by_series[] = {{20, 0, 16.411962}, {30, 0, 30.088334},  {44.999, 0, 91.361279},
                     {60, 0, 432.06151}, {30, 30, 54.028214}, {30, 50, 344.48796}};
    for (size_t k = 0; k < sizeof by_series / sizeof *by_series; k++)
        assert_close(corner_resistance(by_series[k].half_angle * degree,
                                       by_series[k].contact_angle * degree),
                     by_series[k].resistance, 1e-5);
    assert_close(corner_resistance(45 * degree, 0), 93.93, 0.03);
    assert_close(corner_resistance(30 * degree, 0), 31.07, 0.035);
}

// Liquid in a narrow wedge flows as between parallel plates: the mean of half gap^2 / 3
// over its area, a^2 x_c^2 / 6 with x_c = cos t / a, is 1/6.
TEST(narrow_corner_is_a_gap)
{
    for (double half_angle = 0.02; half_angle > 0.0005; half_angle /= 2)
        assert_within(corner_resistance(half_angle, 0), 6, 20 * half_angle);
    assert_within(corner_resistance(0.001, 60 * degree) * 0.25, 6, 0.1);
}

TEST(no_film_where_angles_make_90_degrees)
{
    assert_true(corner_conductance(30 * degree, 59.9 * degree) > 0);
    assert_true(corner_conductance(30 * degree, 59.9 * degree) < 1e-9);
    assert_true(corner_conductance(30 * degree, 60.1 * degree) == 0);
    assert_false(corner_holds_film(45 * degree, 45.1 * degree));
}

// ---- drying with films ------------------------------------------------------------

static const double spacing = 5e-7;

// With liquid whose films bring `conductance` r^3 / length.
struct drying {
    struct network network;
    struct ring_stores rings;
    struct film_law law;
    struct occupancy occupancy;
    struct emptying_times times;
    double layer; // conductance of the boundary layer over a whole square, scaled
    double ring;  // the part of each throat that stays in rings
};

static void begin_drying(struct drying *drying, struct network network,
                         double conductance, double ring, double weight)
{
    const struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    struct boundary_layer layer;
    struct reason reason;
    *drying = (struct drying){.network = network, .ring = ring};
    const struct drying_scale scale = drying_scale(&drying->network, &conditions);
    assert_int_equal(boundary_layers_init(
                         &drying->network, conditions.open_walls, scale.length,
                         scale.boundary_layer,
                         &(struct boundary_form){.feet = FEET_SURFACE, .lumped = true},
                         &layer, &reason),
                     STATUS_OK);
    drying->layer = 1 / scale.boundary_layer;
    drying->law = (struct film_law){.conductance = conductance,
                                    .curvature = 0.5,
                                    .weight = weight,
                                    .thickest = 0.1};
    drying->rings.of_throat = NEW_ARRAY(double, network.n_throat);
    drying->rings.at_node = NEW_ARRAY(double, network.n_node);
    for (int t = 0; t < network.n_throat; t++) {
        if (network.throat_kind[t] != THROAT_NETWORK) continue;
        const double volume = throat_volume(&network, t) / pow(scale.length, 3);
        drying->rings.of_throat[t] = ring * volume;
        for (int end = 0; end < 2; end++)
            drying->rings.at_node[network.throat_nodes[t][end]] += ring * volume / 2;
    }
    const struct occupancy_form form = {.length = scale.length,
                                        .gas_parts = true,
                                        .rings = &drying->rings,
                                        .film_law = &drying->law};
    assert_int_equal(occupancy_init(&drying->network, conditions.open_walls, &form,
                                    layer, &drying->occupancy, &reason),
                     STATUS_OK);
    drying->times = emptying_times_init(&drying->occupancy, false);
}

static void end_drying(struct drying *drying)
{
    emptying_times_free(&drying->times);
    occupancy_free(&drying->occupancy);
    free(drying->rings.of_throat);
    free(drying->rings.at_node);
    network_free(&drying->network);
}

static int reached(const struct drying *drying)
{
    int n = 0;
    for (int i = 0; i < drying->network.n_node; i++)
        n += drying->times.films->reached[i];
    return n;
}

// All that throats and rings have lost has evaporated, EVAPORATED of it.
static void check_books(const struct drying *drying, double evaporated)
{
    const struct occupancy *occupancy = &drying->occupancy;
    const double held = compensated_value(occupancy->total_liquid);
    double sum = 0;
    for (int t = 0; t < drying->network.n_throat; t++)
        sum += emptying_times_saturation(&drying->times, t) * occupancy->volume[t];
    for (int i = 0; i < drying->network.n_node; i++)
        if (drying->rings.at_node[i] > 0)
            sum += emptying_times_saturation(&drying->times,
                                             drying->network.n_throat + i) *
                   drying->rings.at_node[i];
    assert_within(held, sum, 1e-12 * occupancy->initial_liquid);
    assert_within(held + evaporated, occupancy->initial_liquid,
                  1e-12 * occupancy->initial_liquid);
    assert_true(fabs(emptying_times_imbalance(&drying->times)) < 1e-12);
}

// The column's throats from the mouth down: of radius 0.2 spacing, and NARROW times
// that in the lower half.
struct chain {
    struct drying drying;
    int n;
    double reach; // through so many throats films bring what evaporates at the mouth
    double narrow;
};

static double radius_of(const struct chain *chain, int k)
{
    return 0.2 * (k < chain->n / 2 ? 1 : chain->narrow);
}

static double volume_of(const struct chain *chain, int k)
{
    return M_PI * radius_of(chain, k) * radius_of(chain, k);
}

static void make_heavy_chain(struct chain *chain, int n, double reach, double ring,
                             double narrow, double weight)
{
    *chain = (struct chain){.n = n, .reach = reach, .narrow = narrow};
    struct network network = lattice_column(n, spacing);
    for (int t = 0; t < network.n_throat; t++)
        network.throat_radius[t] =
            spacing * radius_of(chain, n - 1 - network.throat_nodes[t][0] / 4);
    const struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    const double layer = 1 / drying_scale(&network, &conditions).boundary_layer;
    begin_drying(&chain->drying, network, reach * layer / 0.001, ring, weight);
}

static void make_chain(struct chain *chain, int n, double reach, double ring,
                       double narrow)
{
    make_heavy_chain(chain, n, reach, ring, narrow, 0);
}

// Node 0 is the mouth: n throats are empty, m nodes dry. What the next throat and the
// rings at node m still hold.
struct closed_form {
    int n, m;
    double throat, ring;
    double evaporates, most;
};

static double throat_holds(const struct chain *chain, int k)
{
    return (1 - chain->drying.ring) * volume_of(chain, k);
}

static double rings_hold(const struct chain *chain, int k)
{
    const double above = k > 0 ? volume_of(chain, k - 1) : 0;
    return chain->drying.ring * (above + volume_of(chain, k)) / 2;
}

static void set_rates(const struct chain *chain, struct closed_form *form)
{
    double resistance = 1 / chain->drying.layer;
    for (int k = 0; k < form->m; k++)
        resistance += 1 / volume_of(chain, k); // of length 1
    form->evaporates = 1 / resistance;
    const double r = radius_of(chain, form->n) / 2;
    form->most = form->n > form->m
                     ? chain->drying.law.conductance * (r * r * r) / (form->n - form->m)
                     : INFINITY;
}

// The next event: its time from the last.
static double next_event(const struct chain *chain, struct closed_form *form)
{
    const double flow = fmin(form->most, form->evaporates);
    const double of_throat = form->throat / flow;
    const double of_ring = form->most < form->evaporates
                               ? form->ring / (form->evaporates - flow)
                               : INFINITY;
    const double time = fmin(of_throat, of_ring);
    form->throat -= flow * time;
    form->ring -= (form->evaporates - flow) * time;
    if (of_throat < of_ring)
        form->throat = throat_holds(chain, ++form->n);
    else
        form->ring = rings_hold(chain, ++form->m);
    set_rates(chain, form);
    return time;
}

static int ended_throat(const struct drying *drying)
{
    assert_int_equal(drying->times.n_ended, 1);
    return drying->times.ended[0] < drying->network.n_throat;
}

// Returns how many nodes have dried when gas is at the bottom.
static int check_chain(double reach, double ring, double narrow)
{
    struct chain chain;
    make_chain(&chain, 200, reach, ring, narrow);
    struct drying *drying = &chain.drying;
    struct closed_form form = {.throat = throat_holds(&chain, 0),
                               .ring = rings_hold(&chain, 0)};
    set_rates(&chain, &form);
    struct compensated evaporated = {0};
    while (form.n < chain.n - 1) {
        const struct closed_form before = form;
        assert_close(vapour_rate(&drying->occupancy.vapour), form.evaporates, 1e-12);
        if (form.n <= reach && form.n < chain.n / 2)
            assert_true(form.m == 0 && form.evaporates == drying->layer);
        const double time = next_event(&chain, &form);
        const double passed = emptying_times_advance(&drying->times);
        assert_close(passed, time, 1e-8);
        compensated_add(&evaporated, vapour_rate(&drying->occupancy.vapour) * passed);
        assert_int_equal(ended_throat(drying), form.n > before.n);
        emptying_times_empty_ended(&drying->times);
        check_books(drying, compensated_value(evaporated));
        assert_int_equal(reached(drying),
                         form.n - form.m - (form.most < form.evaporates));
    }
    end_drying(drying);
    return form.m;
}

TEST(chain)
{
    assert_true(check_chain(7.5, 0.1, 1) > 5);
    assert_true(check_chain(0.5, 0.1, 1) > 5);
    assert_true(check_chain(20.2, 0.01, 1) > 5);
    assert_int_equal(check_chain(199.5, 0.01, 1), 0);
}

// Gas comes to narrow throats: the liquid's suction doubles, films are thinner, and
// bring an eighth. At once they no longer reach the mouth.
TEST(films_that_break)
{
    assert_true(check_chain(150.5, 0.01, 0.5) > 5);
}

// Where films have left the mouth they are as long as brings what evaporates at their
// end, conductance r^3 / E: they grow with the depth m as the resistance of the gas
// does, but for what they lose when a node dries.
TEST(length_of_films)
{
    struct chain chain;
    make_chain(&chain, 200, 7.5, 1e-4, 1);
    struct drying *drying = &chain.drying;
    const double films = chain.reach * drying->layer;
    int n = 0, m = 0;
    while (n < chain.n - 1) {
        emptying_times_advance(&drying->times);
        const int throat = ended_throat(drying);
        n += throat;
        m += !throat;
        emptying_times_empty_ended(&drying->times);
        const double length = films * (1 / drying->layer + m / volume_of(&chain, 0));
        if (m > 0) assert_within(n - m, length, 1 + films / volume_of(&chain, 0));
    }
    assert_true(m > 20);
    end_drying(drying);
}

// The cube of the menisci's radius falls evenly from the liquid to the mouth.
TEST(radius_cubed_is_linear)
{
    struct chain chain;
    make_chain(&chain, 40, 30.5, 0.01, 1);
    struct drying *drying = &chain.drying;
    const int mouth = drying->network.n_throat + 4 * chain.n;
    for (int n = 1; n <= 30; n++) {
        emptying_times_advance(&drying->times);
        emptying_times_empty_ended(&drying->times);
        for (int k = 0; k < n; k++)
            assert_close(compensated_value(drying->times.films->level[mouth - 4 * k]),
                         0.001 * (1 - (n - k) / chain.reach), 1e-9);
    }
    end_drying(drying);
}

// ---- under gravity ----------------------------------------------------------------

static double rise(double a, double r)
{
    const double x = r / a, root = sqrt(2);
    const double part = log((x * x - root * x + 1) / (x * x + root * x + 1)) / 2;
    return (part + atan(root * x + 1) + atan(root * x - 1)) / (2 * root * a);
}

// The radius at a node, from its level.
static double radius_at(const struct drying *drying, int node)
{
    const double depth =
        (drying->network.packing.upper.z - drying->network.node_position[node].z) /
        spacing;
    const double level =
        compensated_value(drying->times.films->level[drying->network.n_throat + node]);
    return 1 / (1 / cbrt(level) - drying->law.weight * depth);
}

// A film of 16 FINENESS throats, and how high it is when it no longer reaches the
// mouth. Returns the largest error of heights along the film, over its length.
static double check_heavy_chain(int fineness)
{
    const double weight = 0.5 / fineness, reach = 60 * fineness;
    struct chain chain;
    make_heavy_chain(&chain, 30 * fineness, reach, 0.01, 1, weight);
    struct drying *drying = &chain.drying;
    const double a = pow(0.001 / reach / (3 * weight), 0.25);
    const double below = 1 / (10 + weight / 2); // half a throat above the menisci
    double worst = 0;
    int n = 0;
    struct compensated evaporated = {0};
    while (reached(drying) == n && n < chain.n - 1) {
        compensated_add(&evaporated, vapour_rate(&drying->occupancy.vapour) *
                                         emptying_times_advance(&drying->times));
        emptying_times_empty_ended(&drying->times);
        check_books(drying, compensated_value(evaporated));
        n++;
        for (int k = 1; n == 16 * fineness && k < n; k++) {
            const double r = radius_at(drying, 4 * (chain.n - n + k));
            const double height = (rise(a, below) - rise(a, r)) / weight;
            worst = fmax(worst, fabs(height - k) / n);
        }
    }
    const double most = (rise(a, below) - rise(a, 0)) / weight;
    assert_within(n, most, 1.5);
    assert_true(most < 0.35 * reach); // without gravity films reach that far
    end_drying(drying);
    return worst;
}

// Heights converge to the closed form as the square of the throats' length.
TEST(films_under_gravity)
{
    const double coarse = check_heavy_chain(1), fine = check_heavy_chain(2),
                 finest = check_heavy_chain(4);
    assert_true(coarse < 2e-3);
    assert_true(coarse > 3 * fine && fine > 3 * finest && finest > 0);
}

// No level is lost along a film that conducts 1e6 times what evaporates.
TEST(films_at_rest_have_the_weight_of_the_liquid)
{
    struct chain chain;
    make_heavy_chain(&chain, 40, 4e7, 0.01, 1, 0.5);
    struct drying *drying = &chain.drying;
    for (int n = 1; n <= 30; n++) {
        emptying_times_advance(&drying->times);
        emptying_times_empty_ended(&drying->times);
        for (int k = 0; k < n; k++)
            assert_close(1 / radius_at(drying, 4 * (chain.n - k)),
                         10 + 0.5 * (n - k + 0.5), 1e-5);
    }
    end_drying(drying);
}

// ---- a lattice --------------------------------------------------------------------

// Layers that empty from the top down, as the radii fall a little with depth. Returns
// how many layers are empty when a film first does not reach a node.
static int depth_of_films(double conductance, double *rate_per_column)
{
    const int side = 4, deep = 70;
    struct network network = lattice_network(side, side, deep, spacing);
    for (int t = 0; t < network.n_throat; t++) {
        const int layer = network.throat_nodes[t][0] / (side * side);
        network.throat_radius[t] = 0.2 * spacing * (1 - 1e-5 * (deep - layer));
    }
    struct drying drying;
    begin_drying(&drying, network, conductance, 0.01, 0);
    *rate_per_column = vapour_rate(&drying.occupancy.vapour) / (side * side);
    int n_film = 0;
    struct compensated evaporated = {0};
    do {
        const double rate = vapour_rate(&drying.occupancy.vapour);
        compensated_add(&evaporated, rate * emptying_times_advance(&drying.times));
        emptying_times_empty_ended(&drying.times);
        check_books(&drying, compensated_value(evaporated));
        n_film = 0;
        for (int k = 0; k < drying.occupancy.n_wet; k++)
            n_film += drying.occupancy.liquid_beside[drying.occupancy.wet[k]] == 0;
    } while (reached(&drying) == n_film);
    end_drying(&drying);
    return n_film / (side * side);
}

// L = conductance r^3 / (rate of a column), with r half a throat's radius: twice the
// conductance, twice the depth. The surface takes more in its middle than at its edges,
// so the first node falls dry some layers before; how many does not depend on the
// depth.
TEST(depth_in_a_lattice)
{
    double rate;
    int depth[3];
    const double conductance = 800;
    for (int k = 0; k < 3; k++)
        depth[k] = depth_of_films(conductance * (1 << k), &rate);
    const double unit = conductance * 0.001 / rate;
    assert_true(unit > 10);
    assert_within(depth[1] - depth[0], unit, 1.5);
    assert_within(depth[2] - depth[1], 2 * unit, 1.5);
}
