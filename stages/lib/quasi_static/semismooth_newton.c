// SPDX-License-Identifier: GPL-3.0-or-later
// Solves residual = e - free_deformation + f W q(e) = 0 for e = `deformation`. With S =
// dq/de (`slope`), which is one of its limits where a contact opens, sticks or slips,
//     (1 + S f W) dq = -S residual      [matrix, rhs, solution: acting rows, S not 0]
//     de = -residual - f W dq           [step]
// Slip is judged by the augmented Lagrangian of Alart and Curnier (1991), whose
// multiplier, the augmented state, follows the linearised loads [advance].
#include "contact_solver_internal.h"

#include "sparse/dense_lu.h"

#include <math.h>
#include <string.h>

// ---- residual -----------------------------------------------------------------------

static double bond_shear_stiffness(const struct contact_pair *pair)
{
    return pair->is_bonded && !pair->is_detached ? pair->bond_stiffness[SHEAR] : 0;
}

// Half of the shear stiffness with which the body holds the pair without its contact,
// 1 / (f W) less the contact in K, over that of the contact, which can be larger by
// orders of magnitude. Half, as other contacts give way too.
static double stiffness_ratio_of(const struct contact_solver *c,
                                 const struct active_pair *active)
{
    const struct contact_pair *pair = &c->pair[active->pair];
    double compliance = 0;
    for (int k = SHEAR; k < COMPONENTS / 2; k++)
        compliance += 0.5 * c->compliance_factor *
                      compliance_of(c, active->row[k])[active->row[k]];
    const double held = c->tangent[active->pair][SHEAR] - bond_shear_stiffness(pair);
    return fmin(1, fmax(1e-4, 0.5 * (1 / compliance - held) / pair->shear_stiffness));
}

void update_augmentation(const struct contact_solver *c, struct active_pair *active)
{
    const int j = active->pair;
    const double bond = bond_shear_stiffness(&c->pair[j]);
    const double along = c->from[j][NORMAL] + c->deformation[active->row[0]];
    active->overlap = fmax(0, c->pair[j].overlap - along);
    for (int k = SHEAR; k < COMPONENTS / 2 && active->count > k; k++) {
        const double more = c->deformation[active->row[k]];
        active->shear_force[k - SHEAR] = c->excess[active->row[k]] + active->load[k] +
                                         c->tangent[j][k] * more -
                                         bond * (c->from[j][k] + more);
    }
}

void update_pair_excess(struct contact_solver *c, struct active_pair *active,
                        bool is_augmented)
{
    const int j = active->pair;
    const double *tangent = c->tangent[j];
    struct augmented_state augmented = {.stiffness_ratio = 1};
    if (is_augmented && active->count >= 3)
        augmented = (struct augmented_state){
            .stiffness_ratio = stiffness_ratio_of(c, active),
            .shear_force = {active->shear_force[0], active->shear_force[1]},
            .overlap = active->overlap};
    double deformation[COMPONENTS];
    memcpy(deformation, c->from[j], sizeof deformation);
    for (int k = 0; k < active->count; k++)
        deformation[k] += c->deformation[active->row[k]];
    const struct pair_response response =
        pair_respond_augmented(&c->pair[j], deformation, &augmented);
    active->state = response.contact.state;
    for (int k = 0; k < active->count; k++) {
        const double more = c->deformation[active->row[k]];
        double *q = &c->excess[active->row[k]];
        if (k >= 3) {
            active->slope[k][0] = response.stiffness[k - 3] - tangent[k];
            *q = active->slope[k][0] * more;
            continue;
        }
        for (int l = 0; l < 3; l++)
            active->slope[k][l] = response.slope[k][l] - (k == l ? tangent[k] : 0);
        *q = response.load[k] - active->load[k] - tangent[k] * more;
    }
    if (is_augmented) update_augmentation(c, active);
}

// By columns, which are rows too: no sum waits for the one before.
void add_compliance(const struct contact_solver *c, int row, double more,
                    double *restrict sum)
{
    const double *restrict compliance = compliance_of(c, row);
    if (more == 0) return;
    for (int k = 0; k < c->count; k++)
        sum[k] += c->compliance_factor * more * compliance[k];
}

// The same of COUNT rows (all: NULL) at once.
static void add_compliances(const struct contact_solver *c, int count, const int *row,
                            const double *more, double sign, double *restrict sum)
{
    enum { TOGETHER = 4 };
    for (int first = 0; first < count;) {
        const double *w[TOGETHER];
        double weight[TOGETHER] = {0};
        int n = 0;
        for (; n < TOGETHER && first < count; first++) {
            if (more[first] == 0) continue;
            w[n] = compliance_of(c, row ? row[first] : first);
            weight[n++] = sign * c->compliance_factor * more[first];
        }
        if (n == 0) break;
        while (n < TOGETHER)
            w[n++] = w[0];
        const double *const restrict a = w[0], *const restrict b = w[1],
                                     *const restrict d = w[2], *const restrict e = w[3];
        for (int k = 0; k < c->count; k++)
            sum[k] = fma(weight[3], e[k],
                         fma(weight[2], d[k],
                             fma(weight[1], b[k], fma(weight[0], a[k], sum[k]))));
    }
}

double find_contact_residual(struct contact_solver *c)
{
    double most = 0;
    for (int k = 0; k < c->count; k++)
        c->residual[k] = c->deformation[k] - c->free_deformation[k];
    c->work += (double)c->count * c->n_acting;
    add_compliances(c, c->count, NULL, c->excess, 1, c->residual);
    for (int k = 0; k < c->count; k++)
        most = fmax(most, fabs(c->residual[k]));
    return most;
}

double update_contacts(struct contact_solver *c, bool is_augmented)
{
    for (int k = 0; k < c->n_active; k++)
        update_pair_excess(c, &c->active[k], is_augmented);
    return find_contact_residual(c);
}

// ---- Newton's method ----------------------------------------------------------------

static const double *slope_of(const struct contact_solver *c, int row)
{
    return c->active[c->active_of_row[row]].slope[c->component_of_row[row]];
}

static void list_acting(struct contact_solver *c)
{
    c->n_acting = 0;
    for (int row = 0; row < c->count; row++) {
        const double *slope = slope_of(c, row);
        const bool is_moment = c->component_of_row[row] >= 3;
        if (slope[0] != 0 || (!is_moment && (slope[1] != 0 || slope[2] != 0)))
            c->acting[c->n_acting++] = row;
    }
}

// Whether the matrix of an earlier step does: the same rows act, with about the same
// slopes.
static bool is_factored(const struct contact_solver *c)
{
    const double near = 1e-3;
    if (c->n_acting != c->n_factored) return false;
    for (int a = 0; a < c->n_acting; a++) {
        if (c->acting[a] != c->factored[a]) return false;
        const double *slope = slope_of(c, c->acting[a]), *old = c->factored_slope[a];
        const int terms = c->component_of_row[c->acting[a]] >= 3 ? 1 : 3;
        double size = 0, apart = 0;
        for (int k = 0; k < terms; k++) {
            size = fmax(size, fabs(old[k]));
            apart = fmax(apart, fabs(slope[k] - old[k]));
        }
        if (apart > near * size) return false;
    }
    return true;
}

// An odd number of cache lines: columns do not fall on the same few.
static int stride_of(const struct contact_solver *c)
{
    return ((c->n_acting + 7) / 8 | 1) * 8;
}

// 1 + S f W
static void fill_matrix(struct contact_solver *c)
{
    for (int a = 0; a < c->n_acting; a++) {
        const int row = c->acting[a];
        const struct active_pair *active = &c->active[c->active_of_row[row]];
        const bool is_moment = c->component_of_row[row] >= 3;
        const int terms = is_moment ? 1 : active->count < 3 ? active->count : 3;
        double slope[3] = {0};
        const double *of[3];
        for (int k = 0; k < 3; k++) {
            of[k] = compliance_of(c, is_moment || k >= terms ? row : active->row[k]);
            if (k < terms) slope[k] = c->compliance_factor * slope_of(c, row)[k];
        }
        double *to = c->matrix + (size_t)a * (size_t)stride_of(c);
        for (int b = 0; b < c->n_acting; b++) {
            const int column = c->acting[b];
            to[b] = slope[0] * of[0][column] + slope[1] * of[1][column] +
                    slope[2] * of[2][column];
        }
        to[a] += 1;
    }
}

static bool factor(struct contact_solver *c)
{
    const double n = c->n_acting;
    if (is_factored(c)) return true;
    c->work += n * n * n / 3;
    fill_matrix(c);
    c->n_factored = 0;
    if (!dense_factor(c->n_acting, c->matrix, stride_of(c), c->order, c->work_space))
        return false;
    c->n_factored = c->n_acting;
    memcpy(c->factored, c->acting, (size_t)c->n_acting * sizeof *c->acting);
    for (int a = 0; a < c->n_acting; a++)
        memcpy(c->factored_slope[a], slope_of(c, c->acting[a]),
               sizeof *c->factored_slope);
    return true;
}

static bool find_step(struct contact_solver *c)
{
    list_acting(c);
    if (!factor(c)) return false;
    for (int a = 0; a < c->n_acting; a++) {
        const int row = c->acting[a];
        const struct active_pair *active = &c->active[c->active_of_row[row]];
        const bool is_moment = c->component_of_row[row] >= 3;
        const int terms = is_moment ? 1 : active->count < 3 ? active->count : 3;
        const int *of = is_moment ? &row : active->row;
        c->rhs[a] = 0;
        for (int k = 0; k < terms; k++)
            c->rhs[a] -= slope_of(c, row)[k] * c->residual[of[k]];
    }
    dense_substitute(c->n_acting, c->matrix, stride_of(c), c->order, c->rhs,
                     c->solution);
    for (int row = 0; row < c->count; row++)
        c->step[row] = -c->residual[row];
    add_compliances(c, c->n_acting, c->acting, c->solution, -1, c->step);
    return true;
}

// The shear force of a spring: load + excess + tangent e, less the bond.
static void advance(struct contact_solver *c)
{
    for (int e = 0; e < c->n_active; e++) {
        struct active_pair *active = &c->active[e];
        const double *tangent = c->tangent[active->pair];
        const double bond = bond_shear_stiffness(&c->pair[active->pair]);
        for (int k = 1; k < 3 && active->count >= 3; k++) {
            active->shear_force[k - 1] += tangent[k] * c->step[active->row[k]];
            for (int l = 0; l < 3; l++)
                active->shear_force[k - 1] +=
                    active->slope[k][l] * c->step[active->row[l]];
            active->shear_force[k - 1] -= bond * c->step[active->row[k]];
        }
        if (active->overlap > 0) active->overlap -= c->step[active->row[0]];
    }
    for (int row = 0; row < c->count; row++)
        c->deformation[row] += c->step[row];
}

// Gives up when the residual has not halved in PATIENCE steps. Where pairs hold hardly
// anything, so that rounding ends it earlier, 1e-6 of the free deformation will do.
bool semismooth_newton(struct contact_solver *c, bool is_augmented, double enough)
{
    enum { PATIENCE = 4, AT_THE_END = 3 };
    double best = INFINITY, nearly = enough;
    for (int row = 0; row < c->count; row++)
        nearly = fmax(nearly, 1e-6 * fabs(c->free_deformation[row]));
    update_contacts(c, is_augmented);
    for (int waited = 0; waited < (best > nearly ? PATIENCE : AT_THE_END); waited++) {
        if (!find_step(c)) return false;
        advance(c);
        const double left = update_contacts(c, is_augmented);
        if (left <= enough && update_contacts(c, false) <= enough) return true;
        if (left < 0.5 * best) {
            best = left;
            waited = 0;
        }
    }
    return update_contacts(c, false) <= nearly;
}
