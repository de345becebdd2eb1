// SPDX-License-Identifier: GPL-3.0-or-later
// Balances of the pores [C 6, 20]: in each pore i of unknown pressure
//     sum_j conductance_ij (p_i - p_j) = injected_i + what the mean gradient drives,
//     p = value + gradient . x,
// where pores at a wall of imposed pressure are known and all pores behind a wall of
// imposed flux are one node. The values are corrected until the residual, summed in two
// parts, is small relative to the throughput; the first correction is nearly the
// solution. A set of pores without a path to an imposed pressure (a pocket) is
// singular: one of its pores is pinned, and afterwards the pocket is shifted to the
// mean pressure around it. A box without any imposed pressure is one pocket; there the
// mean pressure of the fluid is 0 (mean_pressure).
//
// A fall of pressure over a throat of pores that are nearly equal would cancel:
// pressures are sums of two doubles (compensated.h), and pressure_drop subtracts these.
// The imbalance is the largest residual of a pore, or the size of their sum, over
//     throughput = sum over throats of |flux| length / largest edge of the box.
#include "pressures.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"
#include "sparse/linear_solver.h"

#include <stdlib.h>

// Each correction reduces the residual by at most this factor; rounding ends it.
enum { CORRECTIONS = 12 };
static const double FIRST_REDUCTION = 1e-8;

// Below this imbalance corrections do not change the throughput any more.
static const double THROUGHPUT_SETTLED = 1e-5;

// The system of balances: in the matrix the unknown nodes come first.
struct balance {
    const struct grains *grains;
    const struct cells *cells;
    const struct throats *throats;
    uint8_t *walls;   // (n_pore)
    uint8_t *known;   // (n_node)
    double *injected; // (n_node) sources and fluxes through walls
    double *given;    // (n_node) these, and what the mean gradient drives
    int32_t *unknown; // (n_node) place in the matrix
    struct conductance_matrix matrix;
};

static unsigned walls_of_corners(const int32_t *corner, int n)
{
    unsigned walls = 0;
    for (int k = 0; k < n; k++)
        if (corner[k] < 0) walls |= 1u << (-1 - corner[k]);
    return walls;
}

uint8_t *walls_of_pores(const struct cells *cells)
{
    uint8_t *walls = NEW_ARRAY(uint8_t, cells->n_pore);
    for (int c = 0; c < cells->n; c++)
        walls[cells->cell[c].pore] |=
            (uint8_t)walls_of_corners(cells->cell[c].corner, 4);
    return walls;
}

// The wall that imposes the pressure on a pore; -1: none. Of several the lower one in
// the order of walls, so that a pore in an edge has one pressure.
static int pressure_wall(const struct conditions *conditions, unsigned walls)
{
    for (int wall = 0; wall < WALL_COUNT; wall++)
        if (walls >> wall & 1 && !isnan(conditions->pressure[wall])) return wall;
    return -1;
}

// The wall through which a flux enters a pore; -1: none. An imposed pressure goes
// first: where the pressure is known no balance is solved, and a flux would be lost.
static int flux_wall(const struct conditions *conditions, unsigned walls)
{
    if (pressure_wall(conditions, walls) >= 0) return -1;
    for (int wall = 0; wall < WALL_COUNT; wall++)
        if (walls >> wall & 1 && !isnan(conditions->flux[wall])) return wall;
    return -1;
}

int feeding_wall(const struct conditions *conditions, unsigned walls)
{
    const int wall = pressure_wall(conditions, walls);
    return wall >= 0 ? wall : flux_wall(conditions, walls);
}

// Numbers the nodes: each pore is one, and all pores behind a wall of imposed flux are
// one (its plate).
static void number_nodes(struct balance *balance, const struct conditions *conditions,
                         struct pressures *pressures, int32_t plate[WALL_COUNT])
{
    const int n = balance->cells->n_pore;
    int32_t *parent = NEW_ARRAY(int32_t, n);
    for (int wall = 0; wall < WALL_COUNT; wall++)
        plate[wall] = -1;
    for (int i = 0; i < n; i++) {
        parent[i] = i;
        const int wall = flux_wall(conditions, balance->walls[i]);
        if (wall < 0) continue;
        if (plate[wall] < 0) plate[wall] = i;
        parent[i] = plate[wall];
    }
    pressures->node = NEW_ARRAY(int32_t, n);
    for (int i = 0; i < n; i++)
        pressures->node[i] =
            parent[i] == i ? pressures->n_node++ : pressures->node[parent[i]];
    for (int wall = 0; wall < WALL_COUNT; wall++)
        if (plate[wall] >= 0) plate[wall] = pressures->node[plate[wall]];
    pressures->node_of_cell = NEW_ARRAY(int32_t, balance->cells->n);
    for (int c = 0; c < balance->cells->n; c++)
        pressures->node_of_cell[c] = pressures->node[balance->cells->cell[c].pore];
    free(parent);
}

// Both nodes of a throat that conducts; false: it does not.
static bool nodes_of(const struct pressures *pressures, const struct throat *throat,
                     int32_t node[2])
{
    if (!(throat->conductance > 0)) return false;
    node[0] = pressures->node_of_cell[throat->cell[0]];
    node[1] = pressures->node_of_cell[throat->cell[1]];
    return node[0] != node[1];
}

// Starts from a uniform pressure, of those imposed the one nearest to 0. If it is the
// only one, that is the solution, and flows are exactly 0 instead of rounding.
static void start_from_uniform(const struct conditions *conditions,
                               struct pressures *pressures)
{
    double least = INFINITY;
    for (int wall = 0; wall < WALL_COUNT; wall++)
        if (fabs(conditions->pressure[wall]) < fabs(least))
            least = conditions->pressure[wall];
    for (int i = 0; i < pressures->n_node && isfinite(least); i++)
        pressures->value[i].value = least;
}

static void impose(struct balance *balance, const struct conditions *conditions,
                   const double *source, const int32_t plate[WALL_COUNT],
                   struct pressures *pressures)
{
    pressures->value = NEW_ARRAY(struct compensated, pressures->n_node);
    start_from_uniform(conditions, pressures);
    balance->known = NEW_ARRAY(uint8_t, pressures->n_node);
    balance->injected = NEW_ARRAY(double, pressures->n_node);
    for (int i = 0; i < balance->cells->n_pore; i++) {
        const int32_t node = pressures->node[i];
        const int wall = pressure_wall(conditions, balance->walls[i]);
        if (source) balance->injected[node] += source[i];
        if (wall < 0) continue;
        balance->known[node] = 1;
        pressures->value[node].value = conditions->pressure[wall];
    }
    for (int wall = 0; wall < WALL_COUNT; wall++)
        if (plate[wall] >= 0) balance->injected[plate[wall]] += conditions->flux[wall];
    balance->given =
        duplicate(balance->injected, (size_t)pressures->n_node, sizeof *balance->given);
    if (!(norm(conditions->gradient) > 0)) return;
    for (int t = 0; t < balance->throats->n; t++) {
        const struct throat *throat = &balance->throats->throat[t];
        int32_t node[2];
        if (!nodes_of(pressures, throat, node)) continue;
        const double driven = throat->conductance *
                              dot(conditions->gradient,
                                  throat_step(balance->grains, balance->cells, throat));
        balance->given[node[0]] += driven;
        balance->given[node[1]] -= driven;
    }
}

// Pins one pore of every pocket. POCKET (n_node) becomes the root of each node's
// pocket, -1 for nodes with a path to an imposed pressure. Flows into a pocket must sum
// to 0, to rounding: else its balances contradict each other, and the pinned pore would
// silently take up the rest.
static enum status find_pockets(struct balance *balance, struct pressures *pressures,
                                int32_t *pocket, struct reason *reason)
{
    const int n = pressures->n_node;
    double *sum = NEW_ARRAY(double, n), *size = NEW_ARRAY(double, n);
    uint8_t *way_out = NEW_ARRAY(uint8_t, n);
    for (int i = 0; i < n; i++)
        pocket[i] = i;
    for (int t = 0; t < balance->throats->n; t++) {
        int32_t node[2];
        if (nodes_of(pressures, &balance->throats->throat[t], node))
            unite_sets(pocket, node[0], node[1]);
    }
    for (int i = 0; i < n; i++) {
        pocket[i] = set_root(pocket, i);
        way_out[pocket[i]] |= balance->known[i];
        sum[pocket[i]] += balance->injected[i];
        size[pocket[i]] += fabs(balance->injected[i]);
    }
    enum status status = STATUS_OK;
    for (int i = 0; i < n && !status; i++) {
        if (pocket[i] != i || way_out[i]) continue;
        pressures->n_pocket++;
        balance->known[i] = 1;
        if (fabs(sum[i]) > 1e-10 * size[i])
            status = refuse(reason, STATUS_BAD_DATA,
                            "the flow into a closed pocket of pores does not balance: "
                            "%.3g of %.3g remains",
                            sum[i], size[i]);
    }
    for (int i = 0; i < n; i++)
        pocket[i] = way_out[pocket[i]] ? -1 : pocket[i];
    free(sum);
    free(size);
    free(way_out);
    return status;
}

// The matrix has unknown nodes first, known ones behind them as its boundary; throats
// that are closed, or inside one node, have no entry.
static void arrange(struct balance *balance, const struct pressures *pressures)
{
    const int n_node = pressures->n_node;
    int n = 0, n_link = 0;
    for (int i = 0; i < n_node; i++)
        n += !balance->known[i];
    balance->unknown = NEW_ARRAY(int32_t, n_node);
    for (int i = 0, next = 0, given = n; i < n_node; i++)
        balance->unknown[i] = balance->known[i] ? given++ : next++;
    struct link *link = NEW_ARRAY(struct link, balance->throats->n);
    for (int t = 0; t < balance->throats->n; t++) {
        const struct throat *throat = &balance->throats->throat[t];
        int32_t node[2];
        if (nodes_of(pressures, throat, node))
            link[n_link++] =
                (struct link){{balance->unknown[node[0]], balance->unknown[node[1]]},
                              throat->conductance};
    }
    balance->matrix = conductance_matrix_of_links(n, n_node, n_link, link);
    free(link);
}

// ---- solution -----------------------------------------------------------------------

double pressure_drop(const struct pressures *pressures, const struct grains *grains,
                     const struct cells *cells, const struct throat *throat)
{
    const struct compensated *value = pressures->value;
    const struct compensated a = value[pressures->node_of_cell[throat->cell[0]]];
    const struct compensated b = value[pressures->node_of_cell[throat->cell[1]]];
    const double drop = compensated_difference(a, b);
    if (!grains_repeat(grains)) return drop;
    return drop - dot(pressures->gradient, throat_step(grains, cells, throat));
}

double pore_pressure(const struct pressures *pressures, const struct cells *cells,
                     int cell)
{
    const struct pore_cell *at = &cells->cell[cell];
    return compensated_value(pressures->value[pressures->node_of_cell[cell]]) +
           dot(pressures->gradient, at->centre);
}

static double find_throughput(const struct balance *balance,
                              const struct pressures *pressures)
{
    const struct vector box = balance->grains->box;
    const double edge = fmax(box.x, fmax(box.y, box.z));
    double sum = 0;
    for (int t = 0; t < balance->throats->n; t++) {
        const struct throat *throat = &balance->throats->throat[t];
        sum += throat->conductance * throat->length / edge *
               fabs(pressure_drop(pressures, balance->grains, balance->cells, throat));
    }
    return sum;
}

static double imbalance(const double *residual, int n)
{
    double largest = 0, sum = 0;
    for (int i = 0; i < n; i++) {
        largest = fmax(largest, fabs(residual[i]));
        sum += residual[i];
    }
    return fmax(largest, fabs(sum));
}

// Puts the pressures into the order of the matrix, or back.
static void reorder(const struct balance *balance, struct pressures *pressures,
                    struct compensated *x, bool back)
{
    for (int i = 0; i < pressures->n_node; i++)
        if (back)
            pressures->value[i] = x[balance->unknown[i]];
        else
            x[balance->unknown[i]] = pressures->value[i];
}

// Corrects X until the balances close, or rounding ends it. X, GIVEN and RESIDUAL are
// in the order of the matrix. It aims at a tenth of the tolerance; once below the
// tolerance, a round that does not halve the imbalance is the last. The throughput, to
// which the imbalance is relative, is found again until it has settled.
static enum status correct(const struct balance *balance, const struct solving *solving,
                           struct linear_solver *solver, const double *given,
                           struct compensated *x, double *residual,
                           struct pressures *pressures, struct reason *reason)
{
    const double tolerance = solving->tolerance;
    double best = INFINITY, reduction = FIRST_REDUCTION;
    for (int round = 0; round < CORRECTIONS; round++) {
        const enum status status = linear_correct(solver, given, x, residual, reduction,
                                                  &pressures->iterations, reason);
        if (status) return status;
        if (!(pressures->imbalance < THROUGHPUT_SETTLED)) {
            reorder(balance, pressures, x, true);
            pressures->throughput = find_throughput(balance, pressures);
        }
        const double absolute = imbalance(residual, balance->matrix.n);
        const double left = absolute > 0 ? absolute / pressures->throughput : 0;
        pressures->imbalance = left;
        if (left < 0.1 * tolerance || (left < tolerance && left > 0.5 * best)) break;
        best = fmin(best, left);
        reduction = fmax(FIRST_REDUCTION, 0.02 * tolerance / left);
    }
    return STATUS_OK;
}

static enum status close_balances(const struct balance *balance,
                                  const struct solving *solving,
                                  struct pressures *pressures, struct reason *reason)
{
    const struct conductance_matrix *matrix = &balance->matrix;
    struct compensated *x = NEW_ARRAY(struct compensated, matrix->n_all);
    double *residual = NEW_ARRAY(double, matrix->n);
    double *given = NEW_ARRAY(double, matrix->n_all);
    for (int i = 0; i < matrix->n_all; i++)
        given[balance->unknown[i]] = balance->given[i];
    reorder(balance, pressures, x, false);
    conductance_matrix_residual(matrix, given, x, residual);
    pressures->imbalance = INFINITY;
    struct linear_solver solver;
    enum status status = linear_solver_init(matrix, solving->solver, &solver, reason);
    pressures->direct = solver.cholesky;
    if (!status)
        status =
            correct(balance, solving, &solver, given, x, residual, pressures, reason);
    reorder(balance, pressures, x, true);
    linear_solver_free(&solver);
    free(x);
    free(residual);
    free(given);
    if (status || pressures->imbalance <= solving->tolerance) return status;
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "the balances of %d pores close to %.3g of the flux only, needed is "
                  "%g after %d iterations; try solver=cholesky, or a larger tolerance",
                  matrix->n, pressures->imbalance, solving->tolerance,
                  pressures->iterations);
}

// ---- what follows -------------------------------------------------------------------

double mean_pressure(const struct pressures *pressures, const struct grains *grains,
                     const struct throats *throats)
{
    double volume = 0, sum = 0;
    for (int t = 0; t < throats->n; t++) {
        const struct throat *throat = &throats->throat[t];
        volume += throat->volume;
        for (int end = 0; end < 2; end++) {
            const int32_t node = pressures->node_of_cell[throat->cell[end]];
            sum += 0.5 * throat->volume * compensated_value(pressures->value[node]);
        }
    }
    const double middle = 0.5 * dot(pressures->gradient, grains->box);
    return volume > 0 ? sum / volume + middle : 0;
}

// The mean_pressure of each pocket, at its root; pores without volume do not count.
// POCKET, MEAN (n_node).
static void find_means(const struct balance *balance, const int32_t *pocket,
                       const struct pressures *pressures, double *mean)
{
    const double middle = 0.5 * dot(pressures->gradient, balance->grains->box);
    double *volume = NEW_ARRAY(double, pressures->n_node);
    for (int t = 0; t < balance->throats->n; t++) {
        const struct throat *throat = &balance->throats->throat[t];
        for (int end = 0; end < 2; end++) {
            const int32_t node = pressures->node_of_cell[throat->cell[end]];
            if (pocket[node] < 0) continue;
            volume[pocket[node]] += throat->volume;
            mean[pocket[node]] +=
                throat->volume * compensated_value(pressures->value[node]);
        }
    }
    for (int i = 0; i < pressures->n_node; i++)
        mean[i] = volume[i] > 0 ? mean[i] / volume[i] + middle : 0;
    free(volume);
}

// Shifts each pocket to the mean pressure of the pores around it, weighted by facet
// area; one without any pores around it, as the whole fluid, to a mean of 0.
static void level_pockets(const struct balance *balance, const int32_t *pocket,
                          struct pressures *pressures)
{
    const int n = pressures->n_node;
    double *area = NEW_ARRAY(double, n), *sum = NEW_ARRAY(double, n);
    for (int t = 0; t < balance->throats->n; t++) {
        const struct throat *throat = &balance->throats->throat[t];
        int32_t node[2];
        for (int end = 0; end < 2; end++)
            node[end] = pressures->node_of_cell[throat->cell[end]];
        if (pocket[node[0]] == pocket[node[1]]) continue;
        const double drop =
            pressure_drop(pressures, balance->grains, balance->cells, throat);
        for (int end = 0; end < 2; end++) {
            const int32_t here = pocket[node[end]];
            if (here < 0 || pocket[node[1 - end]] >= 0) continue;
            area[here] += norm(throat->area);
            sum[here] += norm(throat->area) * (end == 0 ? drop : -drop);
        }
    }
    double *mean = NEW_ARRAY(double, n);
    find_means(balance, pocket, pressures, mean);
    for (int i = 0; i < n; i++) {
        const int32_t here = pocket[i];
        if (here < 0) continue;
        const double above = area[here] > 0 ? sum[here] / area[here] : mean[here];
        compensated_add(&pressures->value[i], -above);
    }
    free(area);
    free(sum);
    free(mean);
}

// The inflow through each wall: the flow from its pores to others, less their sources.
static void find_inflow(const struct balance *balance,
                        const struct conditions *conditions, const double *source,
                        struct pressures *pressures)
{
    for (int wall = 0; wall < WALL_COUNT; wall++)
        pressures->inflow[wall] =
            isnan(conditions->flux[wall]) ? 0 : conditions->flux[wall];
    struct compensated sum[WALL_COUNT] = {{0, 0}};
    for (int i = 0; source && i < balance->cells->n_pore; i++) {
        const int wall = pressure_wall(conditions, balance->walls[i]);
        if (wall >= 0) compensated_add(&sum[wall], -source[i]);
    }
    for (int t = 0; t < balance->throats->n; t++) {
        const struct throat *throat = &balance->throats->throat[t];
        int32_t node[2];
        if (!nodes_of(pressures, throat, node)) continue;
        const double flux =
            throat->conductance *
            pressure_drop(pressures, balance->grains, balance->cells, throat);
        for (int end = 0; end < 2; end++) {
            const int wall = pressure_wall(
                conditions,
                balance->walls[balance->cells->cell[throat->cell[end]].pore]);
            if (wall >= 0) compensated_add(&sum[wall], end == 0 ? flux : -flux);
        }
    }
    for (int wall = 0; wall < WALL_COUNT; wall++)
        if (!isnan(conditions->pressure[wall]))
            pressures->inflow[wall] = compensated_value(sum[wall]);
}

enum status solve_pressures(const struct grains *grains, const struct cells *cells,
                            const struct throats *throats,
                            const struct conditions *conditions, const double *source,
                            const struct solving *solving, struct pressures *pressures,
                            struct reason *reason)
{
    *pressures = (struct pressures){.gradient = conditions->gradient};
    struct balance balance = {.grains = grains, .cells = cells, .throats = throats};
    int32_t plate[WALL_COUNT];
    balance.walls = walls_of_pores(cells);
    number_nodes(&balance, conditions, pressures, plate);
    impose(&balance, conditions, source, plate, pressures);
    int32_t *pocket = NEW_ARRAY(int32_t, pressures->n_node);
    enum status status = find_pockets(&balance, pressures, pocket, reason);
    if (!status) {
        arrange(&balance, pressures);
        pressures->n_unknown = balance.matrix.n;
        if (balance.matrix.n > 0)
            status = close_balances(&balance, solving, pressures, reason);
    }
    if (!status) {
        level_pockets(&balance, pocket, pressures);
        find_inflow(&balance, conditions, source, pressures);
    }
    free(pocket);
    free(balance.walls);
    free(balance.known);
    free(balance.injected);
    free(balance.given);
    free(balance.unknown);
    conductance_matrix_free(&balance.matrix);
    return status;
}

void pressures_free(struct pressures *pressures)
{
    free(pressures->node);
    free(pressures->node_of_cell);
    free(pressures->value);
    *pressures = (struct pressures){0};
}
