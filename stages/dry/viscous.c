// SPDX-License-Identifier: GPL-3.0-or-later
#include "viscous.h"

#include "basics/memory.h"
#include "graph_factor.h"
#include "losses.h"
#include "sparse/plain_cholmod.h"

#include <stdlib.h>
#include <string.h>

// Rounds in which menisci are found; from the second on none can come back, so this is
// far more than any network needs.
enum { MOST_ROUNDS = 200, REFINEMENTS = 10 };

// Largest error of a node's balance, relative to the largest flow in its cluster.
#define FLOW_TOLERANCE 1e-11
static const double AIM = 5e-13;

// A cluster of at least this many nodes keeps its factor; the conjugate gradients with
// it stop at this part of the square of the error, or after so many steps.
enum { FOLLOWED_NODES = 150, MOST_STEPS = 24, FEW_MOVING = 32 };
static const double REDUCTION = 1e-18;

// One cluster of liquid. Its unknowns are the potentials at nodes that liquid fills.
struct piece {
    const int *throat; // (n_throat)
    int n_throat;
    int n_unknown;
    int reference;      // throat that gas enters most easily: potentials are above its
    double evaporation; // of all its throats
    int n_meniscus, n_partial; // of them, in throats partly empty
    double margin;             // of the reference over the next throat that gas enters
    double resistance;         // of all its throats one after the other
    int n_moving;
    double flow;   // scale of the flows in it
    bool followed; // its factor is kept
    int n_link;
};

// Of the matrix: between unknowns, or to a meniscus at potential LEVEL where B is -1.
struct flow_link {
    int a, b;
    double conductance, level;
};

struct flow_solver {
    cholmod_common common;
    int *throat, *offset; // throats by clusters: those of c from offset[c] on
    int offset_capacity;
    int *unknown; // (n_node) -1: gas, or in no cluster now
    int *node;    // (n_unknown)
    // In two parts: across a wide throat potentials differ by less than the last digit.
    struct compensated *potential;
    double *lack;
    struct graph_factor *factor; // of the largest cluster
    struct flow_link *link;
    double *source;    // (n_unknown) what stationary menisci take, negative
    double *vector[3]; // (n_node) each
    int64_t steps;     // of conjugate gradients
    const struct phases *phases;
    const double *charge;
};

struct liquid_flow liquid_flow_make(const struct network *network, double length,
                                    struct menisci menisci)
{
    struct flow_solver *solver = NEW_ARRAY(struct flow_solver, 1);
    struct liquid_flow flow = {.network = network,
                               .menisci = menisci,
                               .conductance = NEW_ARRAY(double, network->n_throat),
                               .resistance = NEW_ARRAY(double, network->n_throat),
                               .moving = NEW_ARRAY(bool, network->n_throat),
                               .pressure = NEW_ARRAY(double, network->n_node),
                               .solver = solver};
    for (int t = 0; t < network->n_throat; t++) {
        const double r = network->throat_radius[t] / length;
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        flow.conductance[t] =
            M_PI * (r * r) * (r * r) / (8 * (network->throat_length[t] / length));
        flow.resistance[t] = 1 / flow.conductance[t];
    }
    solver->throat = NEW_ARRAY(int, network->n_throat);
    solver->unknown = NEW_ARRAY(int, network->n_node);
    solver->node = NEW_ARRAY(int, network->n_node);
    solver->potential = NEW_ARRAY(struct compensated, network->n_node);
    solver->lack = NEW_ARRAY(double, network->n_node);
    solver->source = NEW_ARRAY(double, network->n_node);
    solver->link = NEW_ARRAY(struct flow_link, 2 * (size_t)network->n_throat);
    for (int k = 0; k < 3; k++)
        solver->vector[k] = NEW_ARRAY(double, network->n_node);
    solver->factor = graph_factor_make(network->n_node, 3 * network->n_throat);
    for (int i = 0; i < network->n_node; i++)
        solver->unknown[i] = -1;
    plain_cholmod_start(&solver->common);
    return flow;
}

void liquid_flow_free(struct liquid_flow *flow)
{
    struct flow_solver *solver = flow->solver;
    if (solver) {
        cholmod_finish(&solver->common);
        free(solver->throat);
        free(solver->offset);
        free(solver->unknown);
        free(solver->node);
        free(solver->potential);
        free(solver->lack);
        free(solver->link);
        free(solver->source);
        for (int k = 0; k < 3; k++)
            free(solver->vector[k]);
        graph_factor_free(solver->factor);
        free(solver);
    }
    menisci_free(&flow->menisci);
    free(flow->conductance);
    free(flow->resistance);
    free(flow->moving);
    free(flow->pressure);
    *flow = (struct liquid_flow){0};
}

// --- one throat ----------------------------------------------------------------------

static double saturation_of(const struct flow_solver *solver, int throat)
{
    return compensated_value(solver->phases->liquid[throat]) /
           solver->phases->volume[throat];
}

static bool is_full(const struct flow_solver *solver, int throat)
{
    return !(saturation_of(solver, throat) < 1);
}

static bool has_meniscus(const struct flow_solver *solver, int throat)
{
    return solver->phases->clusters.meniscus[throat];
}

// The unknowns at a throat's liquid ends; returns how many there are.
static int liquid_ends(const struct liquid_flow *flow, int throat, int end[2])
{
    int n = 0;
    for (int k = 0; k < 2; k++) {
        const int unknown =
            flow->solver->unknown[flow->network->throat_nodes[throat][k]];
        if (unknown >= 0) end[n++] = unknown;
    }
    return n;
}

// From the meniscus of THROAT to each of its N liquid ends.
static double arm(const struct liquid_flow *flow, int throat, int n)
{
    return n * flow->conductance[throat] / saturation_of(flow->solver, throat);
}

// Potential at which the meniscus of THROAT moves.
static double entry(const struct liquid_flow *flow, const struct piece *piece,
                    int throat)
{
    return menisci_potential(&flow->menisci, throat, piece->reference);
}

static double above(struct compensated potential, double level)
{
    return (potential.value - level) + potential.lost;
}

static double fall(struct compensated from, struct compensated to)
{
    return (from.value - to.value) + (from.lost - to.lost);
}

// What flows from the liquid ends to a moving meniscus.
static double flow_to_meniscus(const struct liquid_flow *flow,
                               const struct piece *piece, int throat)
{
    int end[2];
    const int n = liquid_ends(flow, throat, end);
    double sum = 0;
    for (int k = 0; k < n; k++)
        sum += above(flow->solver->potential[end[k]], entry(flow, piece, throat));
    return n > 0 ? arm(flow, throat, n) * sum : 0;
}

// Potential behind a meniscus to which as much flows as evaporates.
static double potential_at_mouth(const struct liquid_flow *flow, int throat)
{
    int end[2];
    const int n = liquid_ends(flow, throat, end);
    double mean = 0;
    for (int k = 0; k < n; k++)
        mean += compensated_value(flow->solver->potential[end[k]]) / n;
    return mean - flow->solver->charge[throat] / (n * arm(flow, throat, n));
}

// --- the balances --------------------------------------------------------------------

// What the balances of all nodes lack.
static void find_lack(const struct liquid_flow *flow, const struct piece *piece)
{
    struct flow_solver *solver = flow->solver;
    double *lack = solver->lack;
    memcpy(lack, solver->source, (size_t)piece->n_unknown * sizeof *lack);
    for (int k = 0; k < piece->n_link; k++) {
        const struct flow_link *link = &solver->link[k];
        const struct compensated here = solver->potential[link->a];
        const double through =
            link->conductance * (link->b < 0 ? above(here, link->level)
                                             : fall(here, solver->potential[link->b]));
        lack[link->a] -= through;
        if (link->b >= 0) lack[link->b] += through;
    }
}

// The matrix, link by link, and what stationary menisci take.
static void find_links(const struct liquid_flow *flow, struct piece *piece)
{
    struct flow_solver *solver = flow->solver;
    struct flow_link *link = solver->link;
    piece->n_link = piece->n_moving = 0;
    memset(solver->source, 0, (size_t)piece->n_unknown * sizeof(double));
    for (int k = 0; k < piece->n_throat; k++) {
        const int throat = piece->throat[k];
        int end[2];
        const int n = liquid_ends(flow, throat, end);
        if (flow->moving[throat]) {
            piece->n_moving++;
            for (int e = 0; e < n; e++)
                link[piece->n_link++] = (struct flow_link){
                    end[e], -1, arm(flow, throat, n), entry(flow, piece, throat)};
            continue;
        }
        for (int e = 0; e < n; e++)
            solver->source[end[e]] -= solver->charge[throat] / n;
        if (n == 2)
            link[piece->n_link++] =
                (struct flow_link){end[0], end[1], flow->conductance[throat], 0};
    }
}

static void add_entry(cholmod_triplet *entries, int row, int column, double value)
{
    ((int *)entries->i)[entries->nnz] = row > column ? row : column;
    ((int *)entries->j)[entries->nnz] = row > column ? column : row;
    ((double *)entries->x)[entries->nnz] = value;
    entries->nnz++;
}

// Lower triangle.
static cholmod_sparse *assemble(const struct liquid_flow *flow,
                                const struct piece *piece)
{
    cholmod_common *common = &flow->solver->common;
    const size_t n = (size_t)piece->n_unknown;
    cholmod_triplet *entries = cholmod_allocate_triplet(n, n, 3 * (size_t)piece->n_link,
                                                        -1, CHOLMOD_REAL, common);
    if (!entries) return NULL;
    for (int k = 0; k < piece->n_link; k++) {
        const struct flow_link *link = &flow->solver->link[k];
        add_entry(entries, link->a, link->a, link->conductance);
        if (link->b < 0) continue;
        add_entry(entries, link->b, link->b, link->conductance);
        add_entry(entries, link->a, link->b, -link->conductance);
    }
    cholmod_sparse *matrix = cholmod_triplet_to_sparse(entries, entries->nnz, common);
    cholmod_free_triplet(&entries, common);
    return matrix;
}

static double largest_lack(const struct flow_solver *solver, const struct piece *piece)
{
    double largest = 0;
    for (int k = 0; k < piece->n_unknown; k++)
        largest = fmax(largest, fabs(solver->lack[k]));
    return largest;
}

// The largest flow to or from a moving meniscus, or what evaporates.
static double flow_scale(const struct liquid_flow *flow, const struct piece *piece)
{
    double scale = piece->evaporation;
    for (int k = 0; k < piece->n_throat; k++)
        if (flow->moving[piece->throat[k]])
            scale = fmax(scale, fabs(flow_to_meniscus(flow, piece, piece->throat[k])));
    return scale;
}

// What the worst balance lacks, of the largest flow; 0 where nothing flows, as between
// menisci that are all alike.
static double balance_error(const struct liquid_flow *flow, const struct piece *piece)
{
    const double lack = largest_lack(flow->solver, piece);
    return lack == 0 ? 0 : lack / flow_scale(flow, piece);
}

// --- with a factor that follows ----------------------------------------------------

// The arm of a moving meniscus to the next power of two, and no more than a million
// times that of a full throat: near enough, and seldom another.
static double rough_arm(const struct liquid_flow *flow, int throat, int n)
{
    int exponent;
    frexp(fmax(1e-6, saturation_of(flow->solver, throat)), &exponent);
    return ldexp(n * flow->conductance[throat], -exponent);
}

// Numbers of a throat's links: between its nodes, and from either to its meniscus.
enum { LINK_THROUGH, LINK_ARM, LINKS = 3 };

static void name_throat(const struct liquid_flow *flow, const struct piece *piece,
                        int throat)
{
    struct flow_solver *solver = flow->solver;
    const int32_t *node = flow->network->throat_nodes[throat];
    int end[2];
    const int n = liquid_ends(flow, throat, end);
    const bool moving = flow->moving[throat];
    graph_factor_link(solver->factor, LINKS * throat + LINK_THROUGH, node[0], node[1],
                      n == 2 && !moving ? flow->conductance[throat] : 0);
    if (!has_meniscus(solver, throat)) return;
    for (int e = 0; e < 2; e++)
        if (solver->unknown[node[e]] >= 0)
            graph_factor_link(
                solver->factor, LINKS * throat + LINK_ARM + e, node[e], -1,
                !moving                         ? 0
                : piece->n_moving <= FEW_MOVING ? arm(flow, throat, n)
                                                : rough_arm(flow, throat, n));
}

static bool name_links(const struct liquid_flow *flow, const struct piece *piece)
{
    struct graph_factor *factor = flow->solver->factor;
    bool good = false;
    for (int attempt = 0; attempt < 2 && !good; attempt++) {
        graph_factor_begin(factor, piece->n_unknown, flow->solver->node);
        for (int k = 0; k < piece->n_throat; k++)
            name_throat(flow, piece, piece->throat[k]);
        good = graph_factor_finish(factor);
    }
    return good;
}

// RESULT = matrix times POTENTIAL.
static void multiply(const struct liquid_flow *flow, const struct piece *piece,
                     const double *potential, double *result)
{
    for (int k = 0; k < piece->n_unknown; k++)
        result[k] = 0;
    for (int k = 0; k < piece->n_link; k++) {
        const struct flow_link *link = &flow->solver->link[k];
        const double through =
            link->conductance *
            (potential[link->a] - (link->b < 0 ? 0 : potential[link->b]));
        result[link->a] += through;
        if (link->b >= 0) result[link->b] -= through;
    }
}

static double product(const double *a, const double *b, int n)
{
    double sum = 0;
    for (int k = 0; k < n; k++)
        sum += a[k] * b[k];
    return sum;
}

// The same by conjugate gradients, preconditioned with the factor that follows. Few
// steps are enough, for it differs in few links.
static bool correct_followed(const struct liquid_flow *flow, const struct piece *piece)
{
    struct flow_solver *solver = flow->solver;
    const int n = piece->n_unknown;
    double *rest = solver->lack, *z = solver->vector[0], *p = solver->vector[1],
           *q = solver->vector[2];
    const double enough = REDUCTION * product(rest, rest, n);
    double rho = 0;
    for (int k = 0; k < MOST_STEPS; k++) {
        if (k > 0 && product(rest, rest, n) <= enough) return true;
        if (!graph_factor_solve(solver->factor, rest, z)) return false;
        const double before = rho;
        rho = product(rest, z, n);
        if (!(rho > 0)) return rho == 0;
        for (int i = 0; i < n; i++)
            p[i] = z[i] + (k > 0 ? rho / before * p[i] : 0);
        multiply(flow, piece, p, q);
        const double step = rho / product(p, q, n);
        for (int i = 0; i < n; i++) {
            compensated_add(&solver->potential[i], step * p[i]);
            rest[i] -= step * q[i];
        }
        solver->steps++;
    }
    graph_factor_forget(solver->factor);
    return true;
}

// Adds to the potentials what the balances lack, by a factor of this matrix.
static bool correct(const struct liquid_flow *flow, const struct piece *piece,
                    cholmod_factor *factor)
{
    struct flow_solver *solver = flow->solver;
    cholmod_dense lack = {.nrow = (size_t)piece->n_unknown,
                          .ncol = 1,
                          .nzmax = (size_t)piece->n_unknown,
                          .d = (size_t)piece->n_unknown,
                          .x = solver->lack,
                          .xtype = CHOLMOD_REAL,
                          .dtype = CHOLMOD_DOUBLE};
    cholmod_dense *correction =
        cholmod_solve(CHOLMOD_A, factor, &lack, &solver->common);
    if (!correction) return false;
    for (int k = 0; k < piece->n_unknown; k++)
        compensated_add(&solver->potential[k], ((const double *)correction->x)[k]);
    cholmod_free_dense(&correction, &solver->common);
    return true;
}

// Corrects until the balances close; the last error comes back in RESIDUAL.
static bool refine(const struct liquid_flow *flow, const struct piece *piece,
                   cholmod_factor *factor, double *residual)
{
    for (int k = 0; k < REFINEMENTS; k++) {
        if (*residual <= AIM) break;
        const bool corrected =
            factor ? correct(flow, piece, factor) : correct_followed(flow, piece);
        if (!corrected) return false;
        find_lack(flow, piece);
        *residual = balance_error(flow, piece);
    }
    return true;
}

// By a factor that is made for this and thrown away.
static bool solve_directly(const struct liquid_flow *flow, const struct piece *piece,
                           double *residual)
{
    cholmod_common *common = &flow->solver->common;
    cholmod_sparse *matrix = assemble(flow, piece);
    cholmod_factor *factor = matrix ? cholmod_analyze(matrix, common) : NULL;
    const bool solved = factor && cholmod_factorize(matrix, factor, common) &&
                        common->status == CHOLMOD_OK &&
                        refine(flow, piece, factor, residual);
    cholmod_free_factor(&factor, common);
    cholmod_free_sparse(&matrix, common);
    return solved;
}

static void start_from_rest(const struct liquid_flow *flow, const struct piece *piece)
{
    for (int k = 0; k < piece->n_unknown; k++)
        flow->solver->potential[k] = (struct compensated){0};
    find_lack(flow, piece);
}

// Potentials for the menisci as they are.
static enum status solve_potentials(struct liquid_flow *flow, struct piece *piece,
                                    struct reason *reason)
{
    struct flow_solver *solver = flow->solver;
    double residual = INFINITY;
    find_links(flow, piece);
    start_from_rest(flow, piece);
    bool solved = piece->followed && name_links(flow, piece) &&
                  refine(flow, piece, NULL, &residual) && residual < FLOW_TOLERANCE;
    if (!solved) {
        if (piece->followed) graph_factor_forget(solver->factor);
        residual = INFINITY;
        start_from_rest(flow, piece);
        solved = solve_directly(flow, piece, &residual);
    }
    if (!solved || !(residual < FLOW_TOLERANCE))
        return refuse(reason, STATUS_NOT_CONVERGED,
                      "the liquid's balance closes to %.3g of its largest flow only, "
                      "needed is %g (%d unknowns, CHOLMOD status %d)",
                      residual, FLOW_TOLERANCE, piece->n_unknown,
                      solver->common.status);
    flow->residual = fmax(flow->residual, residual);
    return STATUS_OK;
}

// --- the menisci ---------------------------------------------------------------------

// Whether the meniscus of THROAT must move by the potentials as they are.
static bool must_move(const struct liquid_flow *flow, const struct piece *piece,
                      int throat)
{
    const struct flow_solver *solver = flow->solver;
    if (!has_meniscus(solver, throat)) return false;
    if (!is_full(solver, throat)) return true;
    // What would flow back to a full throat for rounding alone does not stop it.
    const double charge = solver->charge[throat];
    if (flow->moving[throat])
        return charge - flow_to_meniscus(flow, piece, throat) >= -AIM * piece->flow;
    return potential_at_mouth(flow, throat) < entry(flow, piece, throat);
}

// Menisci as they were, those in throats partly empty, and if that is none, that which
// gas enters most easily.
static void start_menisci(struct liquid_flow *flow, const struct piece *piece)
{
    bool any = false;
    for (int k = 0; k < piece->n_throat; k++) {
        const int throat = piece->throat[k];
        flow->moving[throat] = has_meniscus(flow->solver, throat) &&
                               (flow->moving[throat] || !is_full(flow->solver, throat));
        any |= flow->moving[throat];
    }
    if (!any) flow->moving[piece->reference] = true;
}

static int revise_menisci(struct liquid_flow *flow, const struct piece *piece)
{
    int n = 0;
    for (int k = 0; k < piece->n_throat; k++) {
        const int throat = piece->throat[k];
        const bool moves = must_move(flow, piece, throat);
        n += moves != flow->moving[throat];
        flow->moving[throat] = moves;
    }
    return n;
}

static enum status find_menisci(struct liquid_flow *flow, struct piece *piece,
                                struct reason *reason)
{
    start_menisci(flow, piece);
    for (int round = 0; round < MOST_ROUNDS; round++) {
        const enum status status = solve_potentials(flow, piece, reason);
        if (status) return status;
        flow->rounds++;
        piece->flow = flow_scale(flow, piece);
        if (revise_menisci(flow, piece) == 0) return STATUS_OK;
    }
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "no consistent menisci after %d rounds in a cluster of %d throats",
                  MOST_ROUNDS, piece->n_throat);
}

// --- one cluster ---------------------------------------------------------------------

static void add_loss(struct loss *loss, int *n_loss, int throat, double rate)
{
    if (rate != 0) loss[(*n_loss)++] = (struct loss){throat, rate};
}

// What each moving meniscus loses. The error of the balances is left to the largest.
static void collect_losses(const struct liquid_flow *flow, const struct piece *piece,
                           struct loss *loss, int *n_loss)
{
    const int first = *n_loss;
    int largest = first;
    double sum = 0;
    for (int k = 0; k < piece->n_throat; k++) {
        const int throat = piece->throat[k];
        if (!flow->moving[throat]) continue;
        double rate =
            flow->solver->charge[throat] - flow_to_meniscus(flow, piece, throat);
        if (is_full(flow->solver, throat)) rate = fmax(rate, 0);
        add_loss(loss, n_loss, throat, rate);
        sum += rate;
    }
    for (int k = first; k < *n_loss; k++)
        if (fabs(loss[k].rate) > fabs(loss[largest].rate)) largest = k;
    if (*n_loss == first + 1)
        loss[first].rate = piece->evaporation;
    else if (*n_loss > first)
        loss[largest].rate += piece->evaporation - sum;
}

static void write_pressures(struct liquid_flow *flow, const struct piece *piece)
{
    const struct menisci *menisci = &flow->menisci;
    const double reference = -menisci->tension / menisci->radius[piece->reference];
    for (int k = 0; k < piece->n_unknown; k++) {
        const int node = flow->solver->node[k];
        flow->pressure[node] = reference +
                               compensated_value(flow->solver->potential[k]) +
                               menisci_weight(menisci, piece->reference, node);
    }
}

// Whether liquid goes from throat to throat at NODE.
static bool passes_on(const struct phases *phases, int node)
{
    return phases->clusters.joins[node] && phases->liquid_beside[node] > 1;
}

static void number_unknowns(struct liquid_flow *flow, struct piece *piece)
{
    struct flow_solver *solver = flow->solver;
    for (int k = 0; k < piece->n_throat; k++)
        for (int end = 0; end < 2; end++) {
            const int node = flow->network->throat_nodes[piece->throat[k]][end];
            if (!passes_on(solver->phases, node) || solver->unknown[node] >= 0)
                continue;
            solver->unknown[node] = piece->n_unknown;
            solver->node[piece->n_unknown++] = node;
        }
}

static void forget_unknowns(struct flow_solver *solver, const struct piece *piece)
{
    for (int k = 0; k < piece->n_unknown; k++)
        solver->unknown[solver->node[k]] = -1;
}

// The pressures of a cluster that does not flow: at the verge of its widest meniscus.
static void write_rest(struct liquid_flow *flow, struct piece *piece)
{
    number_unknowns(flow, piece);
    for (int k = 0; k < piece->n_unknown; k++)
        flow->solver->potential[k] = (struct compensated){0};
    write_pressures(flow, piece);
    forget_unknowns(flow->solver, piece);
}

// Counts the menisci, and those in throats partly empty; finds where gas enters first
// and second.
static void survey(const struct liquid_flow *flow, struct piece *piece)
{
    const struct flow_solver *solver = flow->solver;
    int second = -1;
    for (int k = 0; k < piece->n_throat; k++) {
        const int throat = piece->throat[k];
        piece->resistance += flow->resistance[throat];
        if (!has_meniscus(solver, throat)) continue;
        if (piece->n_meniscus++ == 0) {
            piece->reference = throat;
        } else if (entry(flow, piece, throat) > 0) {
            second = piece->reference;
            piece->reference = throat;
        } else if (second < 0 ||
                   entry(flow, piece, throat) > entry(flow, piece, second)) {
            second = throat;
        }
        piece->n_partial += !is_full(solver, throat);
        piece->evaporation += solver->charge[throat];
    }
    if (second >= 0) piece->margin = -entry(flow, piece, second);
}

// Whether only the meniscus that gas enters most easily can move: all that evaporates
// falls by less than the margin to the next on any way through the cluster.
static bool only_one_moves(const struct liquid_flow *flow, const struct piece *piece)
{
    if (piece->n_meniscus == 1) return true;
    if (piece->n_partial > !is_full(flow->solver, piece->reference)) return false;
    return piece->evaporation * piece->resistance < piece->margin;
}

static void move_reference(struct liquid_flow *flow, const struct piece *piece)
{
    for (int k = 0; k < piece->n_throat; k++)
        flow->moving[piece->throat[k]] = false;
    flow->moving[piece->reference] = true;
}

static enum status find_losses(struct liquid_flow *flow, struct piece *piece,
                               struct loss *loss, int *n_loss, struct reason *reason)
{
    survey(flow, piece);
    if (!(piece->evaporation > 0) && piece->n_partial < 2) {
        if (flow->wants_pressures) write_rest(flow, piece);
        return STATUS_OK;
    }
    const bool decided = only_one_moves(flow, piece);
    if (decided && (piece->n_throat == 1 || !flow->wants_pressures)) {
        move_reference(flow, piece);
        add_loss(loss, n_loss, piece->reference, piece->evaporation);
        return STATUS_OK;
    }
    number_unknowns(flow, piece);
    piece->followed &= piece->n_unknown >= FOLLOWED_NODES;
    const enum status status = find_menisci(flow, piece, reason);
    if (!status) {
        collect_losses(flow, piece, loss, n_loss);
        if (flow->wants_pressures) write_pressures(flow, piece);
        flow->solutions++;
    }
    forget_unknowns(flow->solver, piece);
    return status;
}

// Throats in the order of their clusters.
static void sort_throats(struct flow_solver *solver, int n_throat)
{
    const struct clusters *clusters = &solver->phases->clusters;
    while (solver->offset_capacity < clusters->n_id + 2)
        GROW_ARRAY(solver->offset, solver->offset_capacity, solver->offset_capacity);
    int *offset = solver->offset;
    for (int c = 0; c < clusters->n_id + 2; c++)
        offset[c] = 0;
    for (int t = 0; t < n_throat; t++)
        if (clusters->of_throat[t] >= 0) offset[clusters->of_throat[t] + 2]++;
    for (int c = 0; c < clusters->n_id; c++)
        offset[c + 2] += offset[c + 1];
    for (int t = 0; t < n_throat; t++)
        if (clusters->of_throat[t] >= 0)
            solver->throat[offset[clusters->of_throat[t] + 1]++] = t;
}

static int largest_cluster(const struct clusters *clusters)
{
    int largest = 0;
    for (int c = 1; c < clusters->n_id; c++)
        if (clusters->size[c] > clusters->size[largest]) largest = c;
    return largest;
}

enum status liquid_flow_find(struct liquid_flow *flow, const struct phases *phases,
                             const double *charge, struct loss *loss, int *n_loss,
                             struct reason *reason)
{
    struct flow_solver *solver = flow->solver;
    solver->phases = phases;
    solver->charge = charge;
    sort_throats(solver, flow->network->n_throat);
    for (int i = 0; flow->wants_pressures && i < flow->network->n_node; i++)
        flow->pressure[i] = 0;
    const int largest = largest_cluster(&phases->clusters);
    enum status status = STATUS_OK;
    for (int c = 0; !status && c < phases->clusters.n_id; c++) {
        struct piece piece = {.throat = solver->throat + solver->offset[c],
                              .n_throat = solver->offset[c + 1] - solver->offset[c],
                              .followed = c == largest};
        if (piece.n_throat > 0)
            status = find_losses(flow, &piece, loss, n_loss, reason);
    }
    return status;
}

void liquid_flow_forget(struct liquid_flow *flow)
{
    graph_factor_forget(flow->solver->factor);
}
