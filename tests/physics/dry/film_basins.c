// SPDX-License-Identifier: GPL-3.0-or-later
// Two sources of levels 1 and 4 at the ends of a row of nodes,
//     source A - node - node - node - source B,
// each link conducts 1, the nodes evaporate 1/4, 15/8 and 1/2. By hand their levels are
// 1/2, 1/4, 15/8: A brings 1/2, B 17/8, and the middle node gets 1/4 from one side and
// 13/8 from the other. Each outer node has a floating cluster beside it, with the level
// of the node.
#include "../../test.h"

#include "dry/inviscid/film_basins.h"

#include <stdlib.h>

// Clusters 0 to 3, with the numbers of their sites, and nodes 10 to 12.
enum { A, B, AT_A, AT_B, LEFT, MIDDLE, RIGHT, N };

static const int place[N] = {A, B, AT_A, AT_B, 10, 11, 12};

static const struct link links[] = {{{A, LEFT}, 1},       {{LEFT, MIDDLE}, 1},
                                    {{MIDDLE, RIGHT}, 1}, {{RIGHT, B}, 1},
                                    {{LEFT, AT_A}, 1},    {{RIGHT, AT_B}, 1}};

static const double taken[N] = {[LEFT] = 0.25, [MIDDLE] = 1.875, [RIGHT] = 0.5};
static double surplus[N] = {0.5, 2.125};
static const double least[N] = {1, 4, 0.4, 1.5};
static const int turn[N] = {1, 0, 3, 2};

static struct film_basins *basins_of_row(void)
{
    static bool held[N] = {[A] = true, [B] = true};
    static struct compensated level[N] = {{1, 0},   {4, 0},    {0.5, 0},  {1.875, 0},
                                          {0.5, 0}, {0.25, 0}, {1.875, 0}};
    static const int source[2] = {A, B};
    struct conductance_matrix matrix =
        conductance_matrix_of_links(N, N, (int)(sizeof links / sizeof *links), links);
    const struct film_flow flow = {.matrix = &matrix,
                                   .place = place,
                                   .taken = taken,
                                   .least = least,
                                   .held = held,
                                   .level = level,
                                   .surplus = surplus};
    struct film_basins *basins = film_basins_create(13, 4);
    film_basins_find(basins, &flow, 1e-6, turn, 2, source);
    conductance_matrix_free(&matrix);
    return basins;
}

// Floating clusters have no inflow at all, and belong to the node beside them.
TEST(each_site_belongs_to_what_brings_most)
{
    struct film_basins *basins = basins_of_row();
    static const int basin[N] = {[B] = 1, [AT_B] = 1, [MIDDLE] = 1, [RIGHT] = 1};
    for (int i = 0; i < N; i++)
        assert_int_equal(film_basins_of(basins, place[i]), basin[i]);
    assert_int_equal(film_basins_of(basins, 5), -1);
    assert_int_equal(film_basins_supplier(basins, 0), A);
    assert_int_equal(film_basins_supplier(basins, 1), B);
    film_basins_free(basins);
}

// B's next throat is narrower: its gap is 3. The floating cluster, whose gap is 0.375,
// supplies, and levels in B's basin fall by that, so that films no longer reach the
// middle. When B comes to a wide throat again, levels rise.
TEST(nearest_to_its_least_supplies)
{
    struct film_basins *basins = basins_of_row();
    film_basins_set(basins, B, 1, 3, 0);
    assert_int_equal(film_basins_supplier(basins, 1), AT_B);
    assert_within(film_basins_fall(basins, 12), 0.375, 0);
    assert_within(film_basins_fall(basins, 10), 0, 0);
    assert_within(film_basins_failing(basins), 1.875, 0);
    film_basins_set(basins, B, 1, -1, 0);
    assert_int_equal(film_basins_supplier(basins, 1), B);
    assert_within(film_basins_fall(basins, 12), -1, 0);
    film_basins_free(basins);
}

// From A the left node gets 1/4 half a level down. From B the middle one gets 15/8 and
// the right one 1/2, 15/4 and 17/8 down. With levels of 0 they would get as much more
// as the levels from the sources to 0 are higher, and less as those fall.
TEST(capacity_goes_with_the_level_of_the_source)
{
    struct film_basins *basins = basins_of_row();
    const double of_b = 1.875 / 3.75 + 0.5 / 2.125;
    assert_within(film_basins_capacity(basins, 0), 0.5, 1e-15);
    assert_within(film_basins_capacity(basins, 1), 4 * of_b, 1e-15);
    film_basins_set(basins, B, 1, 3, 0);
    film_basins_supplier(basins, 1);
    assert_within(film_basins_capacity(basins, 1), 3.625 * of_b, 1e-15);
    film_basins_free(basins);
}

// What has been set twice, or taken out, does not supply by what it was before.
TEST(basin_without_clusters)
{
    struct film_basins *basins = basins_of_row();
    film_basins_set(basins, A, 0, 2, 0);
    film_basins_set(basins, A, 0, 0.5, 0);
    film_basins_set(basins, AT_A, -1, 0, 0);
    assert_int_equal(film_basins_supplier(basins, 0), A);
    assert_within(film_basins_failing(basins), 0, 0); // 0.5 is not below 0.5
    film_basins_set(basins, A, -1, 0, 0);
    assert_int_equal(film_basins_supplier(basins, 0), -1);
    assert_int_equal(film_basins_supplier(basins, 1), B);
    film_basins_free(basins);
}

// Three clusters are at their least: the numbers of clusters do not say which supplies.
TEST(turn_decides_between_equal_gaps)
{
    struct film_basins *basins = basins_of_row();
    film_basins_set(basins, B, 1, 0, 3);
    film_basins_set(basins, AT_A, 1, 0, 1);
    film_basins_set(basins, AT_B, 1, 0, 2);
    assert_int_equal(film_basins_supplier(basins, 1), AT_A);
    film_basins_set(basins, AT_A, -1, 0, 0);
    assert_int_equal(film_basins_supplier(basins, 1), AT_B);
    film_basins_set(basins, AT_B, -1, 0, 0);
    assert_int_equal(film_basins_supplier(basins, 1), B);
    film_basins_free(basins);
}
