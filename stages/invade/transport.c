// SPDX-License-Identifier: GPL-3.0-or-later
// Relative permeability and diffusivity of each phase, in states along the invasion.
// Each is the conductance between inlet (potential 1) and outlet (0) of the throats
// that the phase fills, as network.h gives it: node balances
//     sum_j conductance_ij (x_j - x_i) = 0
// are solved by iterative refinement, and the conductance is the dissipation
//     sum over links of conductance (x_a - x_b)^2,
// which is of second order in the error of x. A residual at a node is flow that ends,
// as a random walk would, at inlet or outlet, so the sum of residuals bounds the error.
// If that does not fall to TOLERANCE, the network is eliminated, which loses no digits.
//
// Numbers are scaled by the longest throat, so that fourth powers of radii do not
// underflow; unit_of gives the scale back. States are recorded at the first
// event at or below each tenth of saturation. For inlet and outlet on opposite sides of
// one axis, with the box's length L and section A,
//     material = conductance L / A.
#include "transport.h"

#include "basics/memory.h"
#include "elimination/kron.h"
#include "sparse/linear_solver.h"

#include <math.h>
#include <stdlib.h>

// Largest sum of residuals, relative to the flow.
static const double TOLERANCE = 1e-10;
static const double REDUCTION = 1e-8; // of the residuals, in one round

enum { MAX_ROUNDS = 6, MAX_ELIMINATED = 20000, MAX_STATES = 11 };

struct phase_network {
    const struct network *network;
    struct incidence incidence;
    unsigned inlet, outlet;
    double length;         // m, of the longest throat: the unit
    double *conductance;   // (n_throat) scaled; 0: lets nothing through
    int *site;             // (n_node) balances, the outlet, the inlet; -1: not reached
    int n_balance, *queue; // (n_node)
    bool reached;          // the outlet
};

static bool is_inlet(const struct phase_network *conductor, int node)
{
    return conductor->network->node_walls[node] & conductor->inlet;
}

static bool is_outlet(const struct phase_network *conductor, int node)
{
    return conductor->network->node_walls[node] & conductor->outlet;
}

// --- one network of conductances -----------------------------------------------------

// Reaches the neighbours of NODE, a node that is reached.
static void visit_neighbours(struct phase_network *conductor, int node, int *n_queue)
{
    const struct incidence *incidence = &conductor->incidence;
    for (int k = incidence->offset[node]; k < incidence->offset[node + 1]; k++) {
        const int32_t *ends = conductor->network->throat_nodes[incidence->throat[k]];
        const int other = ends[ends[0] == node];
        if (!(conductor->conductance[incidence->throat[k]] > 0) ||
            is_inlet(conductor, other))
            continue;
        if (is_outlet(conductor, other)) {
            conductor->reached = true;
        } else if (conductor->site[other] < 0) {
            conductor->site[other] = conductor->n_balance++;
            conductor->queue[(*n_queue)++] = other;
        }
    }
}

// Numbers the nodes that are reached from the inlet, then outlet and inlet.
static void find_sites(struct phase_network *conductor)
{
    const int n_node = conductor->network->n_node;
    int n_queue = 0;
    conductor->n_balance = 0;
    conductor->reached = false;
    for (int i = 0; i < n_node; i++) {
        conductor->site[i] = -1;
        if (is_inlet(conductor, i)) conductor->queue[n_queue++] = i;
    }
    for (int k = 0; k < n_queue; k++)
        visit_neighbours(conductor, conductor->queue[k], &n_queue);
    for (int i = 0; i < n_node; i++) {
        if (is_outlet(conductor, i)) conductor->site[i] = conductor->n_balance;
        if (is_inlet(conductor, i)) conductor->site[i] = conductor->n_balance + 1;
    }
}

// Links between sites. Returns how many.
static int link_sites(const struct phase_network *conductor, struct link *link)
{
    int n = 0;
    for (int t = 0; t < conductor->network->n_throat; t++) {
        const int32_t *ends = conductor->network->throat_nodes[t];
        const int a = conductor->site[ends[0]], b = conductor->site[ends[1]];
        if (conductor->conductance[t] > 0 && a >= 0 && b >= 0 && a != b)
            link[n++] = (struct link){{a, b}, conductor->conductance[t]};
    }
    return n;
}

// The dissipation at the potentials X, which is the conductance if they balance; its
// error is of second order, since balanced potentials minimise it.
static double flow_of(int n_link, const struct link *link, const struct compensated *x)
{
    struct compensated sum = {0};
    for (int k = 0; k < n_link; k++) {
        const double drop =
            compensated_difference(x[link[k].site[0]], x[link[k].site[1]]);
        compensated_add(&sum, link[k].conductance * drop * drop);
    }
    return compensated_value(sum);
}

static double sum_of_sizes(const double *x, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += fabs(x[i]);
    return sum;
}

// Refines the potentials until the sum of residuals is a small part of the flow.
static enum status iterate(int n, int n_link, const struct link *link,
                           double *conductance, struct reason *reason)
{
    struct compensated *x = NEW_ARRAY(struct compensated, n + 2);
    double *residual = NEW_ARRAY(double, n);
    x[n + 1].value = 1; // at the inlet
    struct conductance_matrix matrix =
        conductance_matrix_of_links(n, n + 2, n_link, link);
    struct linear_solver solver;
    enum status status = linear_solver_init(&matrix, SOLVER_AUTO, &solver, reason);
    conductance_matrix_residual(&matrix, NULL, x, residual);
    bool closed = false;
    for (int round = 0, iterations = 0; !status && !closed && round < MAX_ROUNDS;
         round++) {
        status =
            linear_correct(&solver, NULL, x, residual, REDUCTION, &iterations, reason);
        *conductance = flow_of(n_link, link, x);
        closed = sum_of_sizes(residual, n) <= TOLERANCE * *conductance;
    }
    linear_solver_free(&solver);
    conductance_matrix_free(&matrix);
    free(x);
    free(residual);
    return status || closed ? status : STATUS_NOT_CONVERGED;
}

static double unit_drop(const void *context, int b, int a)
{
    (void)context;
    return b - a; // the inlet is end 1, the outlet end 0
}

// The conductance by elimination: no digits are lost, however far apart conductances
// are.
static double eliminate(int n, int n_link, const struct link *link)
{
    struct kron kron = {0};
    kron_begin(&kron, n, 2);
    for (int k = 0; k < n_link; k++)
        kron_link(&kron, link[k].site[0], link[k].site[1], link[k].conductance);
    kron_eliminate(&kron);
    const double flow = kron_flow(&kron, 0, unit_drop, NULL);
    kron_free(&kron);
    return flow;
}

static enum status find_conductance(struct phase_network *conductor,
                                    double *conductance, struct reason *reason)
{
    *conductance = 0;
    find_sites(conductor);
    if (!conductor->reached) return STATUS_OK;
    struct link *link = NEW_ARRAY(struct link, conductor->network->n_throat);
    const int n = conductor->n_balance, n_link = link_sites(conductor, link);
    enum status status = iterate(n, n_link, link, conductance, reason);
    if (status == STATUS_NOT_CONVERGED && n < MAX_ELIMINATED) {
        *conductance = eliminate(n, n_link, link);
        status = STATUS_OK;
    }
    free(link);
    if (status != STATUS_NOT_CONVERGED) return status;
    return refuse(reason, status,
                  "transport: the balances of %d nodes cannot be closed to %g of the "
                  "flow, conductances are too far apart (throats of more even radii, "
                  "or fewer than %d nodes, would do)",
                  n, TOLERANCE, MAX_ELIMINATED);
}

// --- states ------------------------------------------------------------------------

static double property_of(const struct phase_network *conductor, int throat,
                          enum property property)
{
    return property == PERMEABILITY
               ? hydraulic_conductance(conductor->network, throat, conductor->length)
               : diffusive_conductance(conductor->network, throat, conductor->length);
}

static double unit_of(const struct phase_network *conductor, enum property property)
{
    const double length = conductor->length;
    return property == PERMEABILITY ? length * length * length : length;
}

// Whether PHASE holds a throat or node of event NUMBER after EVENT events.
static bool holds(enum phase phase, int number, int event)
{
    return (number >= 0 && number <= event) == (phase == GAS);
}

static bool leads_through(const struct phase_network *conductor,
                          const struct outcome *outcome, enum phase phase, int node,
                          int event)
{
    return is_inlet(conductor, node) || is_outlet(conductor, node) ||
           holds(phase, outcome->node_event[node], event);
}

// Conductances of the throats that PHASE fills after EVENT events; of all throats if
// OUTCOME is NULL.
static void fill_phase_network(struct phase_network *conductor,
                               const struct outcome *outcome, enum phase phase,
                               enum property property, int event)
{
    for (int t = 0; t < conductor->network->n_throat; t++) {
        const int32_t *ends = conductor->network->throat_nodes[t];
        bool open = conductor->network->throat_kind[t] == THROAT_NETWORK;
        if (outcome)
            open &= holds(phase, outcome->throat_event[t], event) &&
                    leads_through(conductor, outcome, phase, ends[0], event) &&
                    leads_through(conductor, outcome, phase, ends[1], event);
        conductor->conductance[t] = open ? property_of(conductor, t, property) : 0;
    }
}

// The events after which the states are reached: none, 0.9, 0.8, ..., the end. Returns
// their number.
static int find_states(const struct outcome *outcome, int *event)
{
    int n = 0, k = 0;
    event[n++] = 0;
    for (int tenths = 9; tenths > 0; tenths--) {
        if (outcome->at_first <= tenths / 10.0) continue;
        while (k < outcome->n && outcome->saturation[k] > tenths / 10.0)
            k++;
        if (k == outcome->n) break;
        if (event[n - 1] != k + 1) event[n++] = k + 1;
    }
    if (event[n - 1] != outcome->n) event[n++] = outcome->n;
    return n;
}

// --- the whole ---------------------------------------------------------------------

static enum status check(const struct phase_network *conductor, struct reason *reason)
{
    const struct network *network = conductor->network;
    for (int i = 0; i < network->n_node; i++)
        if (is_inlet(conductor, i) && is_outlet(conductor, i))
            return refuse(reason, STATUS_BAD_DATA,
                          "transport: node %d is at the inlet and at the outlet", i);
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        const double length = network->throat_length[t];
        if (!(length > 0) || !isfinite(length))
            return refuse(reason, STATUS_BAD_DATA,
                          "/throats/length: row %d: must be above 0 for transport, is "
                          "%g (merge-nodes removes short throats)",
                          t, length);
    }
    return STATUS_OK;
}

static struct phase_network
phase_network_init(const struct network *network,
                   const struct invasion_conditions *conditions)
{
    struct phase_network conductor = {.network = network,
                                      .incidence = network_incidence(network),
                                      .inlet = conditions->inlet,
                                      .outlet = conditions->outlet,
                                      .conductance =
                                          NEW_ARRAY(double, network->n_throat),
                                      .site = NEW_ARRAY(int, network->n_node),
                                      .queue = NEW_ARRAY(int, network->n_node)};
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        conductor.length = fmax(conductor.length, network->throat_length[t]);
    }
    return conductor;
}

static void phase_network_free(struct phase_network *conductor)
{
    incidence_free(&conductor->incidence);
    free(conductor->conductance);
    free(conductor->site);
    free(conductor->queue);
}

// Whether all nodes of inlet and outlet lie on their walls. Where cells were left out
// or an extra layer lies above they only face them, and the box is longer than the
// network.
static bool spans_box(const struct phase_network *conductor)
{
    const struct network *network = conductor->network;
    const struct packing *packing = &network->packing;
    const double near = 1e-9 * distance(packing->lower, packing->upper);
    for (int i = 0; i < network->n_node; i++)
        for (int wall = 0; wall < WALL_COUNT; wall++) {
            const double at = component(network->node_position[i], wall / 2);
            if (network->node_walls[i] & (conductor->inlet | conductor->outlet) &
                    1u << wall &&
                fabs(at - wall_position(packing, wall)) > near)
                return false;
        }
    return true;
}

// Length over section of the box along the axis whose sides are inlet and outlet.
static double box_shape_factor(const struct phase_network *conductor)
{
    const struct packing *packing = &conductor->network->packing;
    if (!spans_box(conductor)) return NAN;
    const struct vector box = subtract(packing->upper, packing->lower);
    for (int axis = 0; axis < 3; axis++) {
        const unsigned lower = 1u << 2 * axis, upper = 2u << 2 * axis;
        if (packing->n_body == 0 &&
            (conductor->inlet | conductor->outlet) == (lower | upper) &&
            conductor->inlet != (lower | upper))
            return component(box, axis) /
                   (component(box, (axis + 1) % 3) * component(box, (axis + 2) % 3));
    }
    return NAN;
}

static enum status find_one_phase(struct phase_network *conductor,
                                  struct transport *transport, struct reason *reason)
{
    for (enum property property = 0; property < PROPERTIES; property++) {
        double *conductance = &transport->conductance[property];
        fill_phase_network(conductor, NULL, GAS, property, 0);
        const enum status status = find_conductance(conductor, conductance, reason);
        if (status) return status;
        if (!(*conductance > 0))
            return refuse(reason, STATUS_BAD_DATA,
                          "transport: no throats lead from inlet to outlet");
        *conductance *= unit_of(conductor, property);
        transport->material[property] = *conductance * box_shape_factor(conductor);
    }
    return STATUS_OK;
}

static enum status find_relative(struct phase_network *conductor,
                                 const struct outcome *outcome, int state, int event,
                                 struct transport *transport, struct reason *reason)
{
    for (enum phase phase = 0; phase < PHASES; phase++)
        for (enum property property = 0; property < PROPERTIES; property++) {
            double conductance;
            fill_phase_network(conductor, outcome, phase, property, event);
            const enum status status =
                find_conductance(conductor, &conductance, reason);
            if (status) return status;
            transport->relative[phase][property][state] =
                conductance * unit_of(conductor, property) /
                transport->conductance[property];
        }
    return STATUS_OK;
}

enum status transport_find(const struct network *network,
                           const struct invasion_conditions *conditions,
                           const struct outcome *outcome, struct transport *transport,
                           struct reason *reason)
{
    int event[MAX_STATES];
    *transport = (struct transport){.n = find_states(outcome, event),
                                    .saturation = NEW_ARRAY(double, MAX_STATES)};
    for (int k = 0; k < PHASES * PROPERTIES; k++)
        transport->relative[k / PROPERTIES][k % PROPERTIES] =
            NEW_ARRAY(double, MAX_STATES);
    struct phase_network conductor = phase_network_init(network, conditions);
    enum status status = check(&conductor, reason);
    if (!status) status = find_one_phase(&conductor, transport, reason);
    for (int k = 0; !status && k < transport->n; k++) {
        transport->saturation[k] = saturation_after(outcome, event[k]);
        status = find_relative(&conductor, outcome, k, event[k], transport, reason);
    }
    phase_network_free(&conductor);
    return status;
}

void transport_free(struct transport *transport)
{
    free(transport->saturation);
    for (int k = 0; k < PHASES * PROPERTIES; k++)
        free(transport->relative[k / PROPERTIES][k % PROPERTIES]);
    *transport = (struct transport){0};
}
