// SPDX-License-Identifier: GPL-3.0-or-later
#include "vapour.h"

#include "basics/memory.h"

#include <cholmod.h>
#include <stdlib.h>

// One refinement nearly always comes below AIM, well below what is promised. Where the
// conductances at one site differ so much that its diagonal loses digits of the
// smallest, each still gains what digits are left.
enum { REFINEMENTS = 20 };
static const double AIM = VAPOUR_TOLERANCE / 100;

struct vapour_solver {
    cholmod_common common;
    cholmod_factor *factor;
    int n_unknown;
    int *site;    // (n_unknown) ascending
    int *unknown; // (n_site+1) its number, -1 where the deficit is known
};

// --- the links ---------------------------------------------------------------------

struct link_list {
    struct {
        int site[2];
        int throat;
        double conductance;
    } * item;
    int n, capacity;
};

static void add_link(struct link_list *list, int a, int b, int throat,
                     double conductance)
{
    GROW_ARRAY(list->item, list->n, list->capacity);
    list->item[list->n].site[0] = a;
    list->item[list->n].site[1] = b;
    list->item[list->n].throat = throat;
    list->item[list->n].conductance = conductance;
    list->n++;
}

static void add_throats(struct link_list *list, const struct network *network,
                        double length)
{
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        const double radius = network->throat_radius[t] / length;
        add_link(list, network->throat_nodes[t][0], network->throat_nodes[t][1], t,
                 M_PI * radius * radius / (network->throat_length[t] / length));
    }
}

static int level_site(const struct boundary_layer *layer, int n_node, int level, int i)
{
    if (level == 0) return layer->exposed[i];
    const int site = n_node + (level - 1) * layer->n_exposed;
    return level == layer->layers ? site : site + i;
}

static void add_boundary_layer(struct link_list *list,
                               const struct boundary_layer *layer, int n_node)
{
    for (int level = 0; level < layer->layers; level++) {
        for (int i = 0; i < layer->n_exposed; i++)
            add_link(list, level_site(layer, n_node, level, i),
                     level_site(layer, n_node, level + 1, i), -1,
                     layer->area[i] / layer->spacing);
        // Half a cell stands on the surface [K 3.3.5].
        const double height = level == 0 ? 0.5 : 1;
        for (int k = 0; k < layer->n_lateral; k++)
            add_link(list, level_site(layer, n_node, level, layer->lateral[k][0]),
                     level_site(layer, n_node, level, layer->lateral[k][1]), -1,
                     height * layer->lateral_conductance[k]);
    }
}

// The list as compressed rows, one for each site and the air.
static void arrange_links(struct vapour *vapour, const struct link_list *list)
{
    vapour->offset = NEW_ARRAY(int, vapour->n_site + 2);
    vapour->link = NEW_ARRAY(struct vapour_link, 2 * (size_t)list->n);
    for (int k = 0; k < list->n; k++)
        for (int end = 0; end < 2; end++)
            vapour->offset[list->item[k].site[end] + 1]++;
    for (int i = 0; i <= vapour->n_site; i++)
        vapour->offset[i + 1] += vapour->offset[i];

    int *next = duplicate(vapour->offset, (size_t)vapour->n_site + 2, sizeof *next);
    for (int k = 0; k < list->n; k++)
        for (int end = 0; end < 2; end++)
            vapour->link[next[list->item[k].site[end]]++] =
                (struct vapour_link){.site = list->item[k].site[1 - end],
                                     .throat = list->item[k].throat,
                                     .conductance = list->item[k].conductance};
    free(next);
}

struct vapour vapour_make(const struct network *network, double length,
                          const struct boundary_layer *layer)
{
    const int n_gas = (layer->layers - 1) * layer->n_exposed;
    struct vapour vapour = {.n_site = network->n_node + n_gas, .changed = true};
    struct link_list list = {0};
    add_throats(&list, network, length);
    add_boundary_layer(&list, layer, network->n_node);
    arrange_links(&vapour, &list);
    free(list.item);

    vapour.open = NEW_ARRAY(bool, network->n_throat);
    vapour.dry = NEW_ARRAY(bool, vapour.n_site);
    for (int i = network->n_node; i < vapour.n_site; i++)
        vapour.dry[i] = true;
    vapour.deficit = NEW_ARRAY(struct compensated, vapour.n_site + 1);
    vapour.deficit[vapour.n_site].value = 1;

    struct vapour_solver *solver = NEW_ARRAY(struct vapour_solver, 1);
    solver->site = NEW_ARRAY(int, vapour.n_site);
    solver->unknown = NEW_ARRAY(int, vapour.n_site + 1);
    cholmod_start(&solver->common);
    solver->common.print = 0;
    // Simplicial, and always the same ordering: no BLAS, so the same bytes everywhere.
    solver->common.supernodal = CHOLMOD_SIMPLICIAL;
    solver->common.nmethods = 1;
    solver->common.method[0].ordering = CHOLMOD_AMD;
    vapour.solver = solver;
    return vapour;
}

void vapour_free(struct vapour *vapour)
{
    struct vapour_solver *solver = vapour->solver;
    if (solver) {
        cholmod_free_factor(&solver->factor, &solver->common);
        cholmod_finish(&solver->common);
        free(solver->site);
        free(solver->unknown);
        free(solver);
    }
    free(vapour->offset);
    free(vapour->link);
    free(vapour->open);
    free(vapour->dry);
    free(vapour->deficit);
    *vapour = (struct vapour){0};
}

// --- the gas changes ---------------------------------------------------------------

// The throat's ends were wet until now, so this alone changes no unknown's balance.
void vapour_open_throat(struct vapour *vapour, int throat)
{
    vapour->open[throat] = true;
}

void vapour_dry_node(struct vapour *vapour, int node)
{
    vapour->dry[node] = true;
    vapour->changed = true;
}

static bool passes(const struct vapour *vapour, const struct vapour_link *link)
{
    return link->throat < 0 || vapour->open[link->throat];
}

// Net vapour flow into SITE.
static double inflow(const struct vapour *vapour, int site)
{
    const struct compensated here = vapour->deficit[site];
    double sum = 0;
    for (int k = vapour->offset[site]; k < vapour->offset[site + 1]; k++) {
        const struct vapour_link *link = &vapour->link[k];
        const struct compensated there = vapour->deficit[link->site];
        if (passes(vapour, link))
            sum += link->conductance *
                   ((here.value - there.value) + (here.lost - there.lost));
    }
    return sum;
}

double vapour_evaporation(const struct vapour *vapour, int node)
{
    return -inflow(vapour, node);
}

// --- the solution ------------------------------------------------------------------

static void number_unknowns(struct vapour *vapour)
{
    struct vapour_solver *solver = vapour->solver;
    solver->n_unknown = 0;
    for (int i = 0; i < vapour->n_site; i++) {
        solver->unknown[i] = vapour->dry[i] ? solver->n_unknown : -1;
        if (vapour->dry[i]) solver->site[solver->n_unknown++] = i;
    }
    solver->unknown[vapour->n_site] = -1;
}

static void add_entry(cholmod_triplet *entries, int row, int column, double value)
{
    ((int *)entries->i)[entries->nnz] = row;
    ((int *)entries->j)[entries->nnz] = column;
    ((double *)entries->x)[entries->nnz] = value;
    entries->nnz++;
}

// Lower triangle of the balances of all unknown deficits.
static cholmod_sparse *assemble(struct vapour *vapour)
{
    struct vapour_solver *solver = vapour->solver;
    const size_t n = (size_t)solver->n_unknown;
    size_t n_entry = n;
    for (size_t k = 0; k < n; k++)
        n_entry += (size_t)(vapour->offset[solver->site[k] + 1] -
                            vapour->offset[solver->site[k]]);
    cholmod_triplet *entries =
        cholmod_allocate_triplet(n, n, n_entry, -1, CHOLMOD_REAL, &solver->common);
    if (!entries) return NULL;
    for (int column = 0; column < solver->n_unknown; column++) {
        const int site = solver->site[column];
        double diagonal = 0;
        for (int k = vapour->offset[site]; k < vapour->offset[site + 1]; k++) {
            const struct vapour_link *link = &vapour->link[k];
            if (!passes(vapour, link)) continue;
            diagonal += link->conductance;
            if (solver->unknown[link->site] > column)
                add_entry(entries, solver->unknown[link->site], column,
                          -link->conductance);
        }
        add_entry(entries, column, column, diagonal);
    }
    cholmod_sparse *matrix =
        cholmod_triplet_to_sparse(entries, entries->nnz, &solver->common);
    cholmod_free_triplet(&entries, &solver->common);
    return matrix;
}

static enum status factorise(struct vapour *vapour, struct reason *reason)
{
    struct vapour_solver *solver = vapour->solver;
    cholmod_common *common = &solver->common;
    cholmod_sparse *matrix = assemble(vapour);
    cholmod_free_factor(&solver->factor, common);
    if (matrix) solver->factor = cholmod_analyze(matrix, common);
    if (solver->factor) cholmod_factorize(matrix, solver->factor, common);
    cholmod_free_sparse(&matrix, common);
    if (common->status == CHOLMOD_OUT_OF_MEMORY)
        return refuse(reason, STATUS_INTERNAL,
                      "out of memory in the vapour matrix of %d unknowns",
                      solver->n_unknown);
    if (common->status != CHOLMOD_OK)
        return refuse(
            reason, STATUS_NOT_CONVERGED,
            "the vapour matrix of %d unknowns has no Cholesky factor (CHOLMOD "
            "status %d)",
            solver->n_unknown, common->status);
    return STATUS_OK;
}

// Adds to all unknown deficits what their balances still lack. From nothing, that is
// the whole solution.
static enum status correct(struct vapour *vapour, struct reason *reason)
{
    struct vapour_solver *solver = vapour->solver;
    if (solver->n_unknown == 0) return STATUS_OK;
    cholmod_common *common = &solver->common;
    cholmod_dense *lack =
        cholmod_zeros((size_t)solver->n_unknown, 1, CHOLMOD_REAL, common);
    cholmod_dense *correction = NULL;
    if (lack) {
        for (int k = 0; k < solver->n_unknown; k++)
            ((double *)lack->x)[k] = -inflow(vapour, solver->site[k]);
        correction = cholmod_solve(CHOLMOD_A, solver->factor, lack, common);
    }
    cholmod_free_dense(&lack, common);
    if (!correction)
        return refuse(reason, STATUS_INTERNAL,
                      "out of memory in the vapour balances of %d unknowns",
                      solver->n_unknown);
    for (int k = 0; k < solver->n_unknown; k++)
        compensated_add(&vapour->deficit[solver->site[k]],
                        ((const double *)correction->x)[k]);
    cholmod_free_dense(&correction, common);
    return STATUS_OK;
}

// The largest error of a balance: of one site, or of all together.
static double imbalance(const struct vapour *vapour)
{
    double largest = 0, sum = 0;
    for (int k = 0; k < vapour->solver->n_unknown; k++) {
        const double error = inflow(vapour, vapour->solver->site[k]);
        largest = fmax(largest, fabs(error));
        sum += error;
    }
    return fmax(largest, fabs(sum));
}

enum status vapour_solve(struct vapour *vapour, struct reason *reason)
{
    if (!vapour->changed) return STATUS_OK;
    number_unknowns(vapour);
    const int n = vapour->solver->n_unknown;
    for (int k = 0; k < n; k++)
        vapour->deficit[vapour->solver->site[k]] = (struct compensated){0};
    enum status status = n > 0 ? factorise(vapour, reason) : STATUS_OK;

    double residual = INFINITY;
    for (int k = 0; !status && residual > AIM && k <= REFINEMENTS; k++) {
        status = correct(vapour, reason);
        vapour->rate = inflow(vapour, vapour->n_site);
        residual = imbalance(vapour) / vapour->rate;
    }
    if (status) return status;
    if (!(residual < VAPOUR_TOLERANCE))
        return refuse(
            reason, STATUS_NOT_CONVERGED,
            "the vapour balance closes to %.3g of the drying rate only, needed "
            "is %g (%d unknowns; conductances that differ by many orders of "
            "magnitude do this)",
            residual, VAPOUR_TOLERANCE, n);
    vapour->residual = fmax(vapour->residual, residual);
    vapour->changed = false;
    return STATUS_OK;
}
