// SPDX-License-Identifier: GPL-3.0-or-later
// The films between wet nodes, at a moment:
//     conductance of a throat = film_law.conductance / length,
//     of its part between clusters c and d at its ends = that times w_c w_d,
// w the share of a cluster in the liquid's cross-section at the node, and 1 of a node
// that is a site itself. Parts that no cluster feeds are left out: they are found by
// uniting what films join.
#include "film_network.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"
#include "dry/liquid/losses.h"

#include <math.h>
#include <stdlib.h>

// While the network is made, a site is its place: a cluster, or n_throat + node.
struct film_end {
    int place;
    double weight;
};

struct film_links {
    const struct occupancy *occupancy;
    int n_place;
    int n, capacity;
    struct film_link *link;
    int *parent;  // (n_place) what films join
    int *n_films; // (n_place)
};

static bool is_film_node(const struct occupancy *occupancy, int node)
{
    return occupancy->wet_place[node] >= 0 && occupancy->liquid_beside[node] == 0;
}

// END has room for all throats at NODE. Returns how many places there are.
static int ends_at(const struct occupancy *occupancy, int node, struct film_end *end)
{
    if (is_film_node(occupancy, node)) {
        end[0] = (struct film_end){occupancy->network->n_throat + node, 1};
        return 1;
    }
    int n = 0;
    double all = 0;
    for (int k = occupancy->incidence.offset[node];
         k < occupancy->incidence.offset[node + 1]; k++) {
        const int throat = occupancy->incidence.throat[k];
        const double section = liquid_section(occupancy, throat);
        if (!(section > 0)) continue;
        const int cluster = occupancy->clusters.of_throat[throat];
        int l = 0;
        while (l < n && end[l].place != cluster)
            l++;
        if (l == n) end[n++] = (struct film_end){cluster, 0};
        end[l].weight += section;
        all += section;
    }
    for (int l = 0; l < n; l++)
        end[l].weight /= all;
    return n;
}

double film_depth(const struct occupancy *occupancy, int throat)
{
    const struct network *network = occupancy->network;
    if (!(occupancy->film_law->weight > 0)) return 0;
    return (network->packing.upper.z - throat_middle(network, throat).z) /
           occupancy->length;
}

static void add_link(struct film_links *links, int a, int b, double conductance,
                     double depth)
{
    if (a == b) return;
    GROW_ARRAY(links->link, links->n, links->capacity);
    links->link[links->n++] = (struct film_link){{{a, b}, conductance}, depth, 1};
    links->n_films[a]++;
    links->n_films[b]++;
    unite_sets(links->parent, a, b);
}

static bool holds_film(const struct occupancy *occupancy, int throat)
{
    const struct network *network = occupancy->network;
    const int32_t *node = network->throat_nodes[throat];
    return network->throat_kind[throat] == THROAT_NETWORK &&
           occupancy->clusters.of_throat[throat] < 0 &&
           occupancy->wet_place[node[0]] >= 0 && occupancy->wet_place[node[1]] >= 0;
}

static void link_films(struct film_links *links)
{
    const struct occupancy *occupancy = links->occupancy;
    const struct network *network = occupancy->network;
    int most = 0;
    for (int i = 0; i < network->n_node; i++) {
        const int degree =
            occupancy->incidence.offset[i + 1] - occupancy->incidence.offset[i];
        most = degree > most ? degree : most;
    }
    struct film_end *a = NEW_ARRAY(struct film_end, most + 1);
    struct film_end *b = NEW_ARRAY(struct film_end, most + 1);
    for (int t = 0; t < network->n_throat; t++) {
        if (!holds_film(occupancy, t)) continue;
        const int n = ends_at(occupancy, network->throat_nodes[t][0], a);
        const int m = ends_at(occupancy, network->throat_nodes[t][1], b);
        const double length = network->throat_length[t] / occupancy->length;
        const double conductance = occupancy->film_law->conductance / length;
        const double depth = film_depth(occupancy, t);
        for (int k = 0; k < n; k++)
            for (int l = 0; l < m; l++)
                add_link(links, a[k].place, b[l].place,
                         conductance * a[k].weight * b[l].weight, depth);
    }
    free(a);
    free(b);
}

// NODE becomes all nodes, those of few films first, else in the order of CURVE.
static void order_nodes(const struct film_links *links, const int32_t *curve, int *node)
{
    const struct network *network = links->occupancy->network;
    const int *n_films = links->n_films + network->n_throat;
    int most = 0;
    for (int i = 0; i < network->n_node; i++)
        most = n_films[i] > most ? n_films[i] : most;
    int *begin = NEW_ARRAY(int, most + 2);
    for (int i = 0; i < network->n_node; i++)
        begin[n_films[i] + 1]++;
    for (int k = 0; k < most; k++)
        begin[k + 1] += begin[k];
    for (int k = 0; k < network->n_node; k++)
        node[begin[n_films[curve[k]]]++] = curve[k];
    free(begin);
}

// Adds PLACE, if it is a site. The lowest place of a set is its root, and clusters come
// before nodes: so a part of the network has a cluster if its root is one.
static void add_site(struct film_links *links, int place, int *site,
                     struct film_network *films)
{
    const int root = set_root(links->parent, place);
    if (links->n_films[place] == 0 || root >= links->occupancy->network->n_throat)
        return;
    site[place] = films->n_site;
    films->root[films->n_site] = site[root];
    films->place[films->n_site++] = place;
}

static void number_sites(struct film_links *links, const int32_t *curve,
                         struct film_network *films)
{
    const int n_throat = links->occupancy->network->n_throat;
    const int n_node = links->occupancy->network->n_node;
    int *site = NEW_ARRAY(int, links->n_place), *node = NEW_ARRAY(int, n_node);
    films->place = NEW_ARRAY(int, links->n_place);
    films->root = NEW_ARRAY(int, links->n_place);
    order_nodes(links, curve, node);
    for (int c = 0; c < n_throat; c++)
        add_site(links, c, site, films);
    for (int k = 0; k < n_node; k++)
        add_site(links, n_throat + node[k], site, films);
    for (int l = 0; l < links->n; l++) {
        struct film_link link = links->link[l];
        if (set_root(links->parent, link.link.site[0]) >= n_throat) continue;
        for (int end = 0; end < 2; end++)
            link.link.site[end] = site[link.link.site[end]];
        links->link[films->n_link++] = link;
    }
    free(site);
    free(node);
}

// The matrix of the links, each with its ratio.
static void fill_matrix(struct film_network *films)
{
    struct link *link = NEW_ARRAY(struct link, films->n_link);
    for (int l = 0; l < films->n_link; l++) {
        link[l] = films->link[l].link;
        link[l].conductance *= films->link[l].ratio;
    }
    conductance_matrix_free(&films->matrix);
    films->matrix =
        conductance_matrix_of_links(films->n_site, films->n_site, films->n_link, link);
    free(link);
}

double film_network_weigh(struct film_network *films, const struct film_law *law,
                          const struct compensated *level)
{
    double changed = 0;
    for (int l = 0; l < films->n_link; l++) {
        struct film_link *film = &films->link[l];
        const struct compensated a = level[film->link.site[0]],
                                 b = level[film->link.site[1]];
        const double mean = (compensated_value(a) + compensated_value(b)) / 2;
        const double change = film_flow_ratio(law, mean, film->depth) - film->ratio;
        film->ratio += change;
        changed += film->link.conductance * fabs(change * compensated_difference(a, b));
    }
    fill_matrix(films);
    return changed;
}

struct film_network film_network_init(const struct occupancy *occupancy,
                                      const int32_t *curve)
{
    const struct network *network = occupancy->network;
    struct film_links links = {.occupancy = occupancy,
                               .n_place = network->n_throat + network->n_node};
    struct film_network films = {0};
    links.parent = NEW_ARRAY(int, links.n_place);
    links.n_films = NEW_ARRAY(int, links.n_place);
    for (int p = 0; p < links.n_place; p++)
        links.parent[p] = p;
    link_films(&links);
    number_sites(&links, curve, &films);
    films.link = links.link;
    fill_matrix(&films);
    free(links.parent);
    free(links.n_films);
    return films;
}

void film_network_free(struct film_network *films)
{
    free(films->place);
    free(films->root);
    free(films->link);
    conductance_matrix_free(&films->matrix);
    *films = (struct film_network){0};
}
