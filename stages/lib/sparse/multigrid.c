// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PAIRINGS = 2, FEWEST = 120, MOST_LEVELS = 30, MOST_ROUNDS = 2000 };

static const double STRONG = 0.1;

// --- groups ------------------------------------------------------------------------

struct graph {
    int n;
    int *begin, *neighbour; // (n+1), (begin[n])
    double *weight;         // (begin[n])
};

static void graph_free(struct graph *graph)
{
    free(graph->begin);
    free(graph->neighbour);
    free(graph->weight);
    *graph = (struct graph){0};
}

static struct graph graph_of_links(int n, int n_link, const struct link *link,
                                   const int *place)
{
    struct graph graph = {n, NEW_ARRAY(int, n + 1), NEW_ARRAY(int, 2 * (size_t)n_link),
                          NEW_ARRAY(double, 2 * (size_t)n_link)};
    for (int k = 0; k < n_link; k++)
        for (int end = 0; end < 2; end++)
            graph.begin[place[link[k].site[end]] + 1]++;
    for (int i = 0; i < n; i++)
        graph.begin[i + 1] += graph.begin[i];
    int *next = duplicate(graph.begin, (size_t)n + 1, sizeof *next);
    for (int k = 0; k < n_link; k++)
        for (int end = 0; end < 2; end++) {
            const int at = next[place[link[k].site[end]]]++;
            graph.neighbour[at] = place[link[k].site[1 - end]];
            graph.weight[at] = link[k].conductance;
        }
    free(next);
    return graph;
}

// Each site with the one it is most strongly linked to, of those that are still alone;
// not if the link is weak beside others it has: they would not move as one.
static int pair(const struct graph *graph, int *group)
{
    int n = 0;
    for (int i = 0; i < graph->n; i++)
        group[i] = -1;
    for (int i = 0; i < graph->n; i++) {
        if (group[i] >= 0) continue;
        int best = -1;
        double strongest = 0;
        for (int k = graph->begin[i]; k < graph->begin[i + 1]; k++)
            strongest = fmax(strongest, graph->weight[k]);
        for (int k = graph->begin[i]; k < graph->begin[i + 1]; k++)
            if (graph->weight[k] >= STRONG * strongest &&
                group[graph->neighbour[k]] < 0 && graph->neighbour[k] != i &&
                (best < 0 || graph->weight[k] > graph->weight[best]))
                best = k;
        group[i] = n;
        if (best >= 0) group[graph->neighbour[best]] = n;
        n++;
    }
    return n;
}

// The sites of each group, one group after the other.
static int *members_by_group(int n, const int *group, int n_group, int *begin)
{
    int *member = NEW_ARRAY(int, n);
    memset(begin, 0, ((size_t)n_group + 1) * sizeof *begin);
    for (int i = 0; i < n; i++)
        begin[group[i] + 1]++;
    for (int g = 0; g < n_group; g++)
        begin[g + 1] += begin[g];
    int *next = duplicate(begin, (size_t)n_group + 1, sizeof *next);
    for (int i = 0; i < n; i++)
        member[next[group[i]]++] = i;
    free(next);
    return member;
}

// Links between groups; COARSE_LINK, if not NULL, where each link of GRAPH goes.
static struct graph contract(const struct graph *graph, const int *group, int n_group,
                             int *coarse_link)
{
    struct graph coarse = {n_group, NEW_ARRAY(int, n_group + 1),
                           NEW_ARRAY(int, graph->begin[graph->n]),
                           NEW_ARRAY(double, graph->begin[graph->n])};
    int *begin = NEW_ARRAY(int, n_group + 1), *seen = NEW_ARRAY(int, n_group), n = 0;
    int *member = members_by_group(graph->n, group, n_group, begin);
    for (int g = 0; g < n_group; g++)
        seen[g] = -1;
    for (int g = 0; g < n_group; g++) {
        const int first = n;
        for (int m = begin[g]; m < begin[g + 1]; m++)
            for (int k = graph->begin[member[m]]; k < graph->begin[member[m] + 1];
                 k++) {
                const int other = group[graph->neighbour[k]];
                if (other == g) {
                    if (coarse_link) coarse_link[k] = -1;
                    continue;
                }
                if (seen[other] < first) {
                    seen[other] = n;
                    coarse.neighbour[n++] = other;
                }
                coarse.weight[seen[other]] += graph->weight[k];
                if (coarse_link) coarse_link[k] = seen[other];
            }
        coarse.begin[g + 1] = n;
    }
    free(begin);
    free(seen);
    free(member);
    return coarse;
}

// --- levels ------------------------------------------------------------------------

// GROUP of each site: of PAIRINGS pairings on top of each other. Returns how many.
static int find_groups(const struct graph *graph, int *group)
{
    int n_group = pair(graph, group);
    for (int k = 1; k < PAIRINGS; k++) {
        struct graph coarse = contract(graph, group, n_group, NULL);
        int *again = NEW_ARRAY(int, n_group);
        n_group = pair(&coarse, again);
        for (int i = 0; i < graph->n; i++)
            group[i] = again[group[i]];
        free(again);
        graph_free(&coarse);
    }
    return n_group;
}

struct grouping {
    int n_level, n[MOST_LEVELS];
    int *group[MOST_LEVELS]; // of the sites of each level but the last
};

static struct grouping group_all(int n, int n_link, const struct link *link)
{
    struct grouping all = {.n_level = 1, .n = {n}};
    int *same = NEW_ARRAY(int, n);
    for (int i = 0; i < n; i++)
        same[i] = i;
    struct graph graph = graph_of_links(n, n_link, link, same);
    free(same);
    while (graph.n > FEWEST && all.n_level < MOST_LEVELS) {
        int *group = NEW_ARRAY(int, graph.n);
        const int n_group = find_groups(&graph, group);
        if (n_group > 0.8 * graph.n) { // hardly any links
            free(group);
            break;
        }
        all.group[all.n_level - 1] = group;
        all.n[all.n_level++] = n_group;
        struct graph coarse = contract(&graph, group, n_group, NULL);
        graph_free(&graph);
        graph = coarse;
    }
    graph_free(&graph);
    return all;
}

// Numbers all sites such that those of a group follow each other, and makes the groups
// ascend with them. Returns the place of each site of the first level.
static int *order_levels(struct grouping *all)
{
    const int last = all->n_level - 1;
    int *place = NEW_ARRAY(int, all->n[last]);
    for (int i = 0; i < all->n[last]; i++)
        place[i] = i;
    for (int l = last - 1; l >= 0; l--) {
        const int n = all->n[l], n_group = all->n[l + 1];
        int *begin = NEW_ARRAY(int, n_group + 1);
        for (int i = 0; i < n; i++)
            all->group[l][i] = place[all->group[l][i]];
        int *member = members_by_group(n, all->group[l], n_group, begin);
        free(place);
        place = NEW_ARRAY(int, n);
        for (int i = 0; i < n; i++)
            place[member[i]] = i;
        for (int g = 0; g < n_group; g++)
            for (int i = begin[g]; i < begin[g + 1]; i++)
                all->group[l][i] = g;
        free(begin);
        free(member);
    }
    return place;
}

static void make_level(struct multigrid_level *level, struct graph *graph)
{
    const int n = graph->n;
    *level = (struct multigrid_level){.n = n,
                                      .begin = graph->begin,
                                      .neighbour = graph->neighbour,
                                      .conductance = graph->weight,
                                      .ground = NEW_ARRAY(double, n),
                                      .diagonal = NEW_ARRAY(double, n),
                                      .given = NEW_ARRAY(double, n),
                                      .solution = NEW_ARRAY(double, n),
                                      .residual = NEW_ARRAY(double, n)};
    for (int k = 0; k < 2; k++) {
        level->direction[k] = NEW_ARRAY(double, n);
        level->image[k] = NEW_ARRAY(double, n);
    }
}

struct multigrid multigrid_make(int n, int n_link, const struct link *link,
                                const double *shunt)
{
    struct grouping all = group_all(n, n_link, link);
    struct multigrid multigrid = {.n_level = all.n_level,
                                  .level =
                                      NEW_ARRAY(struct multigrid_level, all.n_level),
                                  .place = order_levels(&all)};
    struct graph graph = graph_of_links(n, n_link, link, multigrid.place);
    for (int l = 0; l < all.n_level; l++) {
        struct multigrid_level *level = &multigrid.level[l];
        make_level(level, &graph);
        if (l + 1 == all.n_level) break;
        level->group = all.group[l];
        level->coarse_link = NEW_ARRAY(int, graph.begin[graph.n]);
        graph = contract(&graph, level->group, all.n[l + 1], level->coarse_link);
    }
    for (int i = 0; i < n; i++)
        multigrid.level[0].ground[multigrid.place[i]] = shunt[i];
    const size_t last = (size_t)all.n[all.n_level - 1];
    multigrid.factor = NEW_ARRAY(double, last *last);
    return multigrid;
}

void multigrid_free(struct multigrid *multigrid)
{
    for (int l = 0; l < multigrid->n_level; l++) {
        struct multigrid_level *level = &multigrid->level[l];
        free(level->begin);
        free(level->neighbour);
        free(level->conductance);
        free(level->ground);
        free(level->diagonal);
        free(level->group);
        free(level->coarse_link);
        free(level->given);
        free(level->solution);
        free(level->residual);
        for (int k = 0; k < 2; k++) {
            free(level->direction[k]);
            free(level->image[k]);
        }
    }
    free(multigrid->level);
    free(multigrid->place);
    free(multigrid->factor);
    *multigrid = (struct multigrid){0};
}

// --- what is free ------------------------------------------------------------------

static void coarsen(const struct multigrid_level *fine, struct multigrid_level *coarse)
{
    memset(coarse->ground, 0, (size_t)coarse->n * sizeof *coarse->ground);
    memset(coarse->conductance, 0,
           (size_t)coarse->begin[coarse->n] * sizeof *coarse->conductance);
    for (int i = 0; i < fine->n; i++) {
        if (!(fine->diagonal[i] > 0)) continue;
        double ground = fine->ground[i];
        for (int k = fine->begin[i]; k < fine->begin[i + 1]; k++)
            if (!(fine->diagonal[fine->neighbour[k]] > 0))
                ground += fine->conductance[k];
            else if (fine->coarse_link[k] >= 0)
                coarse->conductance[fine->coarse_link[k]] += fine->conductance[k];
        coarse->ground[fine->group[i]] += ground;
    }
    for (int g = 0; g < coarse->n; g++) {
        coarse->diagonal[g] = coarse->ground[g];
        for (int k = coarse->begin[g]; k < coarse->begin[g + 1]; k++)
            coarse->diagonal[g] += coarse->conductance[k];
    }
}

// Cholesky's of the last level; sites that are not free stand by themselves.
static void factorise(struct multigrid *multigrid)
{
    const struct multigrid_level *level = &multigrid->level[multigrid->n_level - 1];
    const int n = level->n;
    double *l = multigrid->factor;
    memset(l, 0, (size_t)n * (size_t)n * sizeof *l);
    for (int i = 0; i < n; i++) {
        const bool is_free = level->diagonal[i] > 0;
        l[i * n + i] = is_free ? level->diagonal[i] : 1;
        for (int k = level->begin[i]; k < level->begin[i + 1]; k++)
            if (is_free && level->diagonal[level->neighbour[k]] > 0)
                l[i * n + level->neighbour[k]] -= level->conductance[k];
    }
    for (int j = 0; j < n; j++) {
        const double scale = l[j * n + j];
        for (int k = 0; k < j; k++)
            l[j * n + j] -= l[j * n + k] * l[j * n + k];
        // Only rounding can make it so small: a group that hardly leaks.
        l[j * n + j] = sqrt(fmax(l[j * n + j], 1e-14 * scale));
        for (int i = j + 1; i < n; i++) {
            for (int k = 0; k < j; k++)
                l[i * n + j] -= l[i * n + k] * l[j * n + k];
            l[i * n + j] /= l[j * n + j];
        }
    }
}

void multigrid_renew(struct multigrid *multigrid)
{
    for (int l = 0; l + 1 < multigrid->n_level; l++)
        coarsen(&multigrid->level[l], &multigrid->level[l + 1]);
    factorise(multigrid);
}

// --- the cycle ---------------------------------------------------------------------

static double inflow(const struct multigrid_level *level, const double *x, int i)
{
    double sum = 0;
    for (int k = level->begin[i]; k < level->begin[i + 1]; k++)
        sum += level->conductance[k] * x[level->neighbour[k]];
    return sum;
}

static void multiply(const struct multigrid_level *level, const double *x,
                     double *image)
{
    for (int i = 0; i < level->n; i++)
        image[i] = level->diagonal[i] > 0
                       ? level->diagonal[i] * x[i] - inflow(level, x, i)
                       : 0;
}

static double product(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

static void solve_last(const struct multigrid *multigrid, const double *given,
                       double *x)
{
    const struct multigrid_level *level = &multigrid->level[multigrid->n_level - 1];
    const int n = level->n;
    const double *l = multigrid->factor;
    for (int i = 0; i < n; i++) {
        x[i] = level->diagonal[i] > 0 ? given[i] : 0;
        for (int k = 0; k < i; k++)
            x[i] -= l[i * n + k] * x[k];
        x[i] /= l[i * n + i];
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++)
            x[i] -= l[k * n + i] * x[k];
        x[i] /= l[i * n + i];
    }
}

static void solve_coarse(struct multigrid *multigrid, int l);

// X becomes about A^-1 GIVEN: Gauss and Seidel forwards, the groups, and backwards.
static void cycle(struct multigrid *multigrid, int l, const double *given, double *x)
{
    struct multigrid_level *level = &multigrid->level[l];
    if (!level->group) {
        solve_last(multigrid, given, x);
        return;
    }
    struct multigrid_level *coarse = &multigrid->level[l + 1];
    memset(x, 0, (size_t)level->n * sizeof *x);
    for (int i = 0; i < level->n; i++)
        if (level->diagonal[i] > 0)
            x[i] = (given[i] + inflow(level, x, i)) / level->diagonal[i];
    memset(coarse->given, 0, (size_t)coarse->n * sizeof *coarse->given);
    for (int i = 0; i < level->n; i++)
        if (level->diagonal[i] > 0)
            coarse->given[level->group[i]] +=
                given[i] - (level->diagonal[i] * x[i] - inflow(level, x, i));
    solve_coarse(multigrid, l + 1);
    for (int i = 0; i < level->n; i++)
        if (level->diagonal[i] > 0) x[i] += coarse->solution[level->group[i]];
    for (int i = level->n - 1; i >= 0; i--)
        if (level->diagonal[i] > 0)
            x[i] = (given[i] + inflow(level, x, i)) / level->diagonal[i];
}

// At most two steps of conjugate gradients.
static void solve_coarse(struct multigrid *multigrid, int l)
{
    struct multigrid_level *level = &multigrid->level[l];
    const int n = level->n;
    if (!level->group) {
        solve_last(multigrid, level->given, level->solution);
        return;
    }
    double *given = level->given, *c = level->direction[0], *d = level->direction[1];
    double *v = level->image[0], *w = level->image[1], *x = level->solution;
    memset(x, 0, (size_t)n * sizeof *x);
    const double before = product(n, given, given);
    if (!(before > 0)) return;
    cycle(multigrid, l, given, c);
    multiply(level, c, v);
    const double first = product(n, c, v), a = product(n, c, given) / first;
    if (!(first > 0)) return;
    for (int i = 0; i < n; i++)
        given[i] -= a * v[i];
    if (product(n, given, given) <= 0.0625 * before) {
        for (int i = 0; i < n; i++)
            x[i] = a * c[i];
        return;
    }
    cycle(multigrid, l, given, d);
    multiply(level, d, w);
    const double across = product(n, d, v);
    const double second = product(n, d, w) - across * across / first;
    const double b = second > 0 ? product(n, d, given) / second : 0;
    for (int i = 0; i < n; i++)
        x[i] = (a - across * b / first) * c[i] + b * d[i];
}

static double sum_of_sizes(const struct multigrid_level *level, const double *x)
{
    double sum = 0;
    for (int i = 0; i < level->n; i++)
        if (level->diagonal[i] > 0) sum += fabs(x[i]);
    return sum;
}

bool multigrid_solve(struct multigrid *multigrid, double least, double *residual,
                     double *x)
{
    struct multigrid_level *level = &multigrid->level[0];
    const int n = level->n;
    double *z = level->solution, *direction = level->direction[0];
    double *image = level->image[0], last = 0;
    memset(x, 0, (size_t)n * sizeof *x);
    for (int i = 0; i < n; i++)
        if (!(level->diagonal[i] > 0)) residual[i] = 0;
    for (int round = 0; sum_of_sizes(level, residual) > least; round++) {
        if (round == MOST_ROUNDS) return false;
        cycle(multigrid, 0, residual, z);
        // Flexible: the cycle is not the same matrix each time.
        const double along = round > 0 ? product(n, z, image) / last : 0;
        for (int i = 0; i < n; i++)
            direction[i] = z[i] - along * direction[i];
        multiply(level, direction, image);
        last = product(n, direction, image);
        if (!(last > 0)) return false;
        const double step = product(n, direction, residual) / last;
        for (int i = 0; i < n; i++) {
            x[i] += step * direction[i];
            residual[i] -= step * image[i];
        }
    }
    return true;
}
