// SPDX-License-Identifier: GPL-3.0-or-later
// Small systems have a Cholesky factor (sparse/cholesky.h) of the sites that are
// not held, and are solved to rounding. Larger ones are solved by conjugate gradients
// on all sites, in which those that are held stay 0. In both the true residual, from
// differences of compensated levels, decides when it is enough.
//
// The preconditioner is an approximate factor in two parts. Sites that may be held or
// freed, and those with many links, come last. Elimination of the others leaves a small
// network between these. When a site is held or freed, only the small network is
// eliminated again. The first part costs as much as some 30 iterations: it is kept from
// one moment of drying to the next while few sites come or go. With M both parts,
//     z = M^-1 r                at sites that are there and not held now,
//         r / diagonal          at the others that are not held.
// Both are symmetric and positive definite.
#include "film_balance.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"
#include "elimination/approximate_cholesky.h"
#include "sparse/cholesky.h"
#include "sparse/conjugate_gradients.h"

#include <math.h>
#include <stdlib.h>

// Each correction reduces the residual so far at most.
static const double REDUCTION = 1e-4;
// Of the tolerance, what a correction aims at.
static const double MARGIN = 0.3;
// So many sites, or one of so many, may have come or gone, or be held though they are
// not among the last, before the first part is made again.
enum { MOST_CHANGED = 20, CHANGED_OF = 2000 };
// Sites with more links (clusters around which films are everywhere) are among the
// last.
enum { MOST_LINKS = 100 };
// Clusters of a level below so many times the least may be held before long.
static const double NEAR = 1.05;

// Of one number.
static const double ROUNDING = 1e-15;

enum { DIRECT_MOST = 1500, MOST_CORRECTIONS = 30, MOST_ITERATIONS = 500 };

// Rows are those sites that come first, then the last ones.
struct film_factor {
    struct approximate_cholesky *first, *last; // NULL: to be made
    int n, n_first;
    int *place; // (n)
    int *row;   // (n) of each place
    int *site;  // (n) by row, the site there now; -1: none
    int n_new, new_capacity;
    int *new_site;                   // (n_new) sites now that have no row
    int n_link;                      // between rows from n_first on
    struct link *link;               // (n_link)
    int *order;                      // (n - n_first) of each row in LAST
    bool *is_held;                   // (n - n_first) when LAST was made, or gone
    double *b, *x, *b_last, *x_last; // (n) and (n - n_first)
};

struct film_factor *film_factor_create(void)
{
    return NEW_ARRAY(struct film_factor, 1);
}

void film_factor_forget(struct film_factor *factor)
{
    approximate_cholesky_free(factor->first);
    approximate_cholesky_free(factor->last);
    free(factor->place);
    free(factor->row);
    free(factor->site);
    free(factor->new_site);
    free(factor->link);
    free(factor->order);
    free(factor->is_held);
    free(factor->b);
    free(factor->x);
    free(factor->b_last);
    free(factor->x_last);
    *factor = (struct film_factor){0};
}

void film_factor_free(struct film_factor *factor)
{
    if (!factor) return;
    film_factor_forget(factor);
    free(factor);
}

// --- sites in another order --------------------------------------------------------

// Those that are not LAST come first, N of them; MATRIX has their rows.
struct ordered_sites {
    int n;
    int *site, *order; // (all) the site at each place, and the place of each site
    struct conductance_matrix matrix; // (n)
};

// ORDER (n): the place of each; those that are not LAST come first. Returns how many.
static int order_last(int n, const bool *last, int *order)
{
    int first = 0, at = 0;
    for (int i = 0; i < n; i++)
        if (!last[i]) order[i] = first++;
    for (int i = 0; i < n; i++)
        if (last[i]) order[i] = first + at++;
    return first;
}

static struct ordered_sites ordered_sites_init(const struct conductance_matrix *all,
                                               const bool *last)
{
    const size_t n_all = (size_t)all->n;
    struct ordered_sites sites = {.site = NEW_ARRAY(int, n_all),
                                  .order = NEW_ARRAY(int, n_all)};
    sites.n = order_last(all->n, last, sites.order);
    for (int i = 0; i < all->n; i++)
        sites.site[sites.order[i]] = i;
    struct conductance_matrix *matrix = &sites.matrix;
    *matrix =
        (struct conductance_matrix){.n = sites.n,
                                    .n_all = all->n,
                                    .offset = NEW_ARRAY(int, n_all + 2),
                                    .column = NEW_ARRAY(int, all->offset[all->n]),
                                    .value = NEW_ARRAY(double, all->offset[all->n]),
                                    .diagonal = NEW_ARRAY(double, n_all)};
    for (int row = 0; row < sites.n; row++) {
        const int i = sites.site[row];
        int to = matrix->offset[row];
        for (int k = all->offset[i]; k < all->offset[i + 1]; k++, to++) {
            matrix->column[to] = sites.order[all->column[k]];
            matrix->value[to] = all->value[k];
        }
        matrix->offset[row + 1] = to;
        matrix->diagonal[row] = all->diagonal[i];
    }
    return sites;
}

static void ordered_sites_free(struct ordered_sites *sites)
{
    free(sites->site);
    free(sites->order);
    conductance_matrix_free(&sites->matrix);
}

// --- the residual ------------------------------------------------------------------

// The sum of the flows to and from site I, by size.
static double flows_at(const struct film_flow *flow, int i)
{
    const struct conductance_matrix *matrix = flow->matrix;
    double sum = 0;
    for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
        sum += matrix->value[k] * fabs(compensated_difference(
                                      flow->level[matrix->column[k]], flow->level[i]));
    return sum;
}

// The sum of what does not balance, less what rounding makes: of flows, which are large
// until all sites are held that must be, and of levels, which have the digits of two
// numbers. With those of one all levels would be equal where films conduct 1e9 times
// what evaporates. Flows are summed only where rounding may decide whether the sum is
// above TOLERANCE: none is larger than if it came from the highest level to 0.
static double imbalance(const struct film_flow *flow, double tolerance,
                        const double *residual)
{
    double sum = 0, levels = 0, flows = 0, diagonal = 0, most = 0;
    for (int i = 0; i < flow->matrix->n; i++) {
        const double level = fabs(compensated_value(flow->level[i]));
        most = fmax(most, level);
        if (flow->held[i]) continue;
        sum += fabs(residual[i]);
        levels += flow->matrix->diagonal[i] * level;
        diagonal += flow->matrix->diagonal[i];
    }
    if (!(sum > tolerance) || sum - ROUNDING * (3 * diagonal * most) > tolerance)
        return sum;
    for (int i = 0; i < flow->matrix->n; i++)
        if (!flow->held[i]) flows += flows_at(flow, i);
    return sum - ROUNDING * (flows + ROUNDING * levels);
}

static void find_residual(const struct film_flow *flow, double *residual)
{
    conductance_matrix_residual(flow->matrix, NULL, flow->level, residual);
    for (int i = 0; i < flow->matrix->n; i++)
        residual[i] -= flow->taken[i];
}

// --- small systems -----------------------------------------------------------------

static bool solve_directly(struct film_flow *flow, double tolerance, double *residual)
{
    struct ordered_sites sites = ordered_sites_init(flow->matrix, flow->held);
    struct cholesky *cholesky = NULL;
    struct reason reason;
    double *b = NEW_ARRAY(double, sites.n), *x = NEW_ARRAY(double, sites.n);
    bool found = false,
         able = cholesky_create(&sites.matrix, &cholesky, &reason) == STATUS_OK;
    for (int most = MOST_CORRECTIONS; able && !found && most > 0; most--) {
        for (int k = 0; k < sites.n; k++)
            b[k] = residual[sites.site[k]];
        able = cholesky_solve(cholesky, b, x);
        for (int k = 0; able && k < sites.n; k++)
            compensated_add(&flow->level[sites.site[k]], x[k]);
        find_residual(flow, residual);
        found = !(imbalance(flow, tolerance, residual) > tolerance);
    }
    cholesky_free(cholesky);
    ordered_sites_free(&sites);
    free(b);
    free(x);
    return found;
}

// --- large systems -----------------------------------------------------------------

// Sites that may be held or freed before long, or have many links.
static bool *find_last(const struct film_flow *flow)
{
    const struct conductance_matrix *matrix = flow->matrix;
    bool *last = NEW_ARRAY(bool, matrix->n);
    for (int i = 0; i < matrix->n; i++)
        last[i] = flow->held[i] || flow->taken[i] > 0 ||
                  (flow->least[i] > 0 &&
                   compensated_value(flow->level[i]) < NEAR * flow->least[i]) ||
                  matrix->offset[i + 1] - matrix->offset[i] > MOST_LINKS;
    return last;
}

// Links that are there already between the sites that come last.
static void add_links(const struct film_flow *flow, const struct ordered_sites *sites,
                      struct film_factor *factor)
{
    const struct conductance_matrix *matrix = flow->matrix;
    int capacity = factor->n_link;
    for (int row = sites->n; row < matrix->n; row++) {
        const int i = sites->site[row];
        for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++) {
            const int other = sites->order[matrix->column[k]];
            if (other <= row) continue;
            GROW_ARRAY(factor->link, factor->n_link, capacity);
            factor->link[factor->n_link++] =
                (struct link){{row, other}, matrix->value[k]};
        }
    }
}

static void make_first(const struct film_flow *flow)
{
    struct film_factor *factor = flow->factor;
    const int n = flow->matrix->n;
    bool *last = find_last(flow);
    struct ordered_sites sites = ordered_sites_init(flow->matrix, last);
    const int n_last = n - sites.n;
    film_factor_forget(factor);
    factor->n = n;
    factor->n_first = sites.n;
    factor->first = approximate_cholesky_create_partly(&sites.matrix, n_last,
                                                       &factor->n_link, &factor->link);
    add_links(flow, &sites, factor);
    factor->place = NEW_ARRAY(int, n);
    factor->row = sites.order;
    factor->site = NEW_ARRAY(int, n);
    factor->order = NEW_ARRAY(int, n_last);
    factor->is_held = NEW_ARRAY(bool, n_last);
    factor->b = NEW_ARRAY(double, n);
    factor->x = NEW_ARRAY(double, n);
    factor->b_last = NEW_ARRAY(double, n_last);
    factor->x_last = NEW_ARRAY(double, n_last);
    for (int i = 0; i < n; i++)
        factor->place[i] = flow->place[i];
    sites.order = NULL;
    ordered_sites_free(&sites);
    free(last);
}

static bool is_free(const struct film_flow *flow, int row)
{
    const int site = flow->factor->site[row];
    return site >= 0 && !flow->held[site];
}

// Adds to the N_LINK LINKs between N_FREE rows, and from these to GROUND and above, one
// to GROUND from each part that has none. Where the held sites of a part have come
// since the first part was made, nothing there would be fixed, and the factor would be
// singular. Returns the number of links.
static int ground_parts(const struct film_flow *flow, int n_free, int n_link,
                        struct link *link)
{
    const struct film_factor *factor = flow->factor;
    int *part = NEW_ARRAY(int, n_free + 1);
    for (int k = 0; k <= n_free; k++)
        part[k] = k;
    for (int l = 0; l < n_link; l++) {
        const int *end = link[l].site;
        unite_sets(part, end[0] < n_free ? end[0] : n_free,
                   end[1] < n_free ? end[1] : n_free);
    }
    for (int k = 0; k < factor->n - factor->n_first; k++) {
        const int row = factor->order[k], ground = set_root(part, n_free);
        if (row >= n_free || set_root(part, row) == ground) continue;
        const int site = factor->site[factor->n_first + k];
        link[n_link++] = (struct link){{row, n_free}, flow->matrix->diagonal[site]};
        unite_sets(part, row, n_free);
    }
    free(part);
    return n_link;
}

// Eliminates what is free among the last rows; the others are held.
static void make_last(const struct film_flow *flow)
{
    struct film_factor *factor = flow->factor;
    const int n_last = factor->n - factor->n_first;
    for (int k = 0; k < n_last; k++)
        factor->is_held[k] = !is_free(flow, factor->n_first + k);
    const int n_free = order_last(n_last, factor->is_held, factor->order);
    struct link *link = NEW_ARRAY(struct link, factor->n_link + n_free);
    for (int l = 0; l < factor->n_link; l++) {
        link[l] = factor->link[l];
        for (int end = 0; end < 2; end++)
            link[l].site[end] = factor->order[link[l].site[end] - factor->n_first];
    }
    const int n_link = ground_parts(flow, n_free, factor->n_link, link);
    struct conductance_matrix matrix =
        conductance_matrix_of_links(n_free, n_last + 1, n_link, link);
    approximate_cholesky_free(factor->last);
    factor->last = approximate_cholesky_create(&matrix);
    conductance_matrix_free(&matrix);
    free(link);
}

// Names are below this.
static int end_of_places(const struct film_flow *flow)
{
    const struct film_factor *factor = flow->factor;
    int most = -1;
    for (int i = 0; i < flow->matrix->n; i++)
        most = flow->place[i] > most ? flow->place[i] : most;
    for (int k = 0; k < factor->n; k++)
        most = factor->place[k] > most ? factor->place[k] : most;
    return most + 1;
}

// Returns how many sites have come or gone, or are held that are not among the last.
static int find_sites(const struct film_flow *flow)
{
    struct film_factor *factor = flow->factor;
    const int n = flow->matrix->n;
    int *site = NEW_ARRAY(int, end_of_places(flow)), gone = 0, held = 0; // 1 + index
    for (int i = 0; i < n; i++)
        site[flow->place[i]] = i + 1;
    for (int k = 0; k < factor->n; k++) {
        const int row = factor->row[k], i = site[factor->place[k]] - 1;
        factor->site[row] = i;
        gone += i < 0;
        held += i >= 0 && row < factor->n_first && flow->held[i];
        site[factor->place[k]] = 0;
    }
    factor->n_new = 0;
    for (int i = 0; i < n; i++) {
        if (site[flow->place[i]] == 0) continue;
        GROW_ARRAY(factor->new_site, factor->n_new, factor->new_capacity);
        factor->new_site[factor->n_new++] = i;
    }
    free(site);
    return gone + factor->n_new + held;
}

static bool last_has_changed(const struct film_flow *flow)
{
    const struct film_factor *factor = flow->factor;
    for (int row = factor->n_first; row < factor->n; row++)
        if (is_free(flow, row) == factor->is_held[row - factor->n_first]) return true;
    return false;
}

static void prepare_factor(const struct film_flow *flow)
{
    struct film_factor *factor = flow->factor;
    const int most = flow->matrix->n / CHANGED_OF;
    if (!factor->first ||
        find_sites(flow) > (most > MOST_CHANGED ? most : MOST_CHANGED)) {
        make_first(flow);
        find_sites(flow);
    }
    if (!factor->last || last_has_changed(flow)) make_last(flow);
}

static void multiply(void *context, const double *x, double *image)
{
    const struct film_flow *flow = context;
    conductance_matrix_multiply(flow->matrix, x, image);
    for (int i = 0; i < flow->matrix->n; i++)
        if (flow->held[i]) image[i] = 0;
}

static void precondition(void *context, const double *residual, double *z)
{
    const struct film_flow *flow = context;
    const struct film_factor *factor = flow->factor;
    const int n = factor->n, n_first = factor->n_first;
    for (int k = 0; k < factor->n_new; k++) {
        const int i = factor->new_site[k];
        z[i] = flow->held[i] ? 0 : residual[i] / flow->matrix->diagonal[i];
    }
    for (int row = 0; row < n; row++)
        factor->b[row] = factor->site[row] >= 0 ? residual[factor->site[row]] : 0;
    double *kept = factor->x + n_first;
    approximate_cholesky_reduce(factor->first, factor->b, kept);
    for (int k = 0; k < n - n_first; k++)
        factor->b_last[factor->order[k]] = kept[k];
    approximate_cholesky_apply(factor->last, factor->b_last, factor->x_last);
    for (int k = 0; k < n - n_first; k++)
        kept[k] = factor->is_held[k] ? 0 : factor->x_last[factor->order[k]];
    approximate_cholesky_extend(factor->first, kept, factor->x);
    for (int row = 0; row < n; row++) {
        const int i = factor->site[row];
        if (i >= 0) z[i] = flow->held[i] ? 0 : factor->x[row];
    }
}

static void correct(struct film_flow *flow, double reduction, const double *residual,
                    double *work)
{
    const size_t n = (size_t)flow->matrix->n;
    prepare_factor(flow);
    double *r = work, *x = work + n;
    for (size_t i = 0; i < n; i++)
        r[i] = flow->held[i] ? 0 : residual[i];
    const double size = sqrt(sum_of_products(r, r, (int)n));
    for (size_t i = 0; i < n; i++)
        r[i] /= size;
    const struct linear_problem problem = {(int)n,
                                           flow,
                                           multiply,
                                           precondition,
                                           {work + 2 * n, work + 3 * n, work + 4 * n}};
    const int iterations =
        conjugate_gradients(&problem, r, x, reduction, MOST_ITERATIONS);
    flow->iterations += iterations;
    for (size_t i = 0; i < n; i++)
        compensated_add(&flow->level[i], size * x[i]);
}

static bool solve_iteratively(struct film_flow *flow, double tolerance,
                              double *residual)
{
    double *work = NEW_ARRAY(double, 5 * (size_t)flow->matrix->n);
    double left = imbalance(flow, tolerance, residual);
    for (int most = MOST_CORRECTIONS; left > tolerance && most > 0; most--) {
        correct(flow, fmax(REDUCTION, MARGIN * tolerance / left), residual, work);
        find_residual(flow, residual);
        left = imbalance(flow, tolerance, residual);
    }
    free(work);
    return left <= tolerance;
}

bool film_balance(struct film_flow *flow, double tolerance, double *residual)
{
    const bool directly = flow->matrix->n <= DIRECT_MOST;
    find_residual(flow, residual);
    if (!(imbalance(flow, tolerance, residual) > (directly ? 0 : tolerance)))
        return true;
    return directly ? solve_directly(flow, tolerance, residual)
                    : solve_iteratively(flow, tolerance, residual);
}
