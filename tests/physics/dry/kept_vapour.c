// SPDX-License-Identifier: GPL-3.0-or-later
// Vapour that is kept while a body dries node by node, next to what its wet nodes
// evaporate by elimination of the gas (star-mesh, positive numbers only). Conductances
// over many decades.
#include "dry/gas/kept_vapour.h"
#include "../../test.h"

#include "basics/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

enum {
    WIDTH = 12,
    DEPTH = 15,
    NODES = WIDTH * DEPTH,
    SITES = NODES + WIDTH,
    AIR = SITES
};
enum { MAX_LINKS = 2 * SITES + WIDTH };

static int *sites_in_order(void)
{
    int *order = NEW_ARRAY(int, SITES);
    for (int i = 0; i < SITES; i++)
        order[i] = i;
    return order;
}

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

// A square lattice, of which links are missing, under a row of gas. Links are sorted by
// depth, those of the row and the air first.
struct body {
    int n_open, n_link;
    struct link link[MAX_LINKS];
    bool open[MAX_LINKS], in_gas[SITES + 1];
};

static void link_sites(struct body *body, int a, int b, double conductance)
{
    body->link[body->n_link++] = (struct link){{a, b}, conductance};
}

static struct body make_body(double decades, uint64_t seed)
{
    struct body body = {0};
    uint64_t state = seed;
    for (int x = 0; x < WIDTH; x++) {
        link_sites(&body, NODES + x, AIR, 1);
        link_sites(&body, x, NODES + x, 1);
        body.in_gas[NODES + x] = true;
    }
    body.n_open = body.n_link;
    for (int i = 0; i < NODES; i++) {
        const double along = pow(10, -decades * uniform(&state)),
                     down = pow(10, -decades * uniform(&state));
        if (i + WIDTH < NODES) link_sites(&body, i, i + WIDTH, down);
        if ((i + 1) % WIDTH && uniform(&state) < 0.8)
            link_sites(&body, i, i + 1, along);
    }
    for (int l = 0; l < body.n_open; l++)
        body.open[l] = true;
    return body;
}

static long double mesh[SITES + 1][SITES + 1];

static void eliminate(int site)
{
    int n = 0, near[SITES + 1];
    long double sum = 0, to[SITES + 1];
    for (int a = 0; a <= SITES; a++) {
        if (!(mesh[site][a] > 0)) continue;
        near[n] = a;
        sum += to[n++] = mesh[site][a];
        mesh[site][a] = mesh[a][site] = 0;
    }
    for (int j = 0; j < n; j++)
        for (int k = 0; k < n; k++)
            if (j != k) mesh[near[j]][near[k]] += to[j] * to[k] / sum;
}

// MESH becomes what wet nodes and the air see of each other.
static void find_mesh(const struct body *body)
{
    for (int a = 0; a <= SITES; a++)
        for (int b = 0; b <= SITES; b++)
            mesh[a][b] = 0;
    for (int l = 0; l < body->n_link; l++) {
        const int *site = body->link[l].site;
        if (!body->open[l]) continue;
        mesh[site[0]][site[1]] += body->link[l].conductance;
        mesh[site[1]][site[0]] += body->link[l].conductance;
    }
    for (int site = SITES - 1; site >= 0; site--)
        if (body->in_gas[site]) eliminate(site);
}

static bool has_closed_link(const struct body *body, int site)
{
    for (int l = 0; l < body->n_link; l++)
        if (!body->open[l] &&
            (body->link[l].site[0] == site || body->link[l].site[1] == site))
            return true;
    return false;
}

static void open_link(struct body *body, struct kept_vapour *kept, int l)
{
    const struct link *link = &body->link[l];
    body->open[l] = true;
    kept_vapour_open(kept, link->site[0], link->site[1], link->conductance);
    for (int end = 0; end < 2; end++) {
        if (has_closed_link(body, link->site[end])) continue;
        body->in_gas[link->site[end]] = true;
        kept_vapour_dry(kept, link->site[end]);
    }
}

static void compare(const struct body *body, const struct kept_vapour *kept)
{
    find_mesh(body);
    long double rate = 0, errors = 0;
    for (int i = 0; i < NODES; i++) {
        if (body->in_gas[i]) continue;
        rate += mesh[i][AIR];
        errors += fabsl(mesh[i][AIR] - (long double)air_links_of(&kept->air, i));
    }
    const double found = compensated_value(kept->air.all) * kept_vapour_pace(kept);
    assert_false(kept->failed);
    assert_within((double)(errors / rate), 0, kept->step);
    assert_close(found, (double)rate, kept->step);
}

static void dry_body(struct body body, double step)
{
    struct kept_vapour *kept = kept_vapour_create(
        NODES, SITES, body.n_link, body.n_open, body.link, sites_in_order(), step);
    for (int l = body.n_open; l + 1 < body.n_link; l++) {
        open_link(&body, kept, l);
        kept_vapour_follow(kept);
        compare(&body, kept);
    }
    kept_vapour_free(kept);
}

TEST(errors_of_evaporation_added_up_stay_within_the_step)
{
    alarm(120); // without an end it would run for ever
    for (int decades = 0; decades <= 12; decades += 4)
        for (uint64_t seed = 1; seed <= 3; seed++) {
            dry_body(make_body(decades, seed), 0.05);
            dry_body(make_body(decades, seed), 0.5);
        }
    alarm(0);
}

// One node wide: the whole rate comes from one node. In some places there are two links
// side by side, of which one opens late: gas lies behind a wet node for a while.
static struct body make_column(double decades, double layer, uint64_t seed)
{
    struct body body = {0};
    uint64_t state = seed;
    for (int x = 0; x < WIDTH; x++) {
        link_sites(&body, NODES + x, AIR, layer);
        body.in_gas[NODES + x] = true;
    }
    link_sites(&body, 0, NODES, layer);
    body.n_open = body.n_link;
    for (int i = 0, late = -1; i + 1 < NODES; i++) {
        link_sites(&body, i, i + 1, pow(10, -decades * uniform(&state)));
        if (late < 0 && uniform(&state) < 0.3) late = i;
        if (late < 0 || i < late + 3) continue;
        link_sites(&body, late, late + 1, pow(10, -decades * uniform(&state)));
        late = -1;
    }
    for (int l = 0; l < body.n_open; l++)
        body.open[l] = true;
    return body;
}

TEST(columns_dry_and_gas_behind_wet_nodes_too)
{
    for (uint64_t seed = 1; seed <= 60; seed++) {
        dry_body(make_column(10, 1, seed), 0.2);
        dry_body(make_column(12, 1e6, seed), 0.2);
    }
}

TEST(a_column_dries_under_a_layer_that_conducts_far_better)
{
    for (uint64_t seed = 1; seed <= 20; seed++) {
        dry_body(make_column(8, 1e6, seed), 0.2);
        dry_body(make_column(8, 1e9, seed), 0.2);
    }
}
