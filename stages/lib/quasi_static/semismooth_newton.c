// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact_solver_internal.h"

#include "sparse/dense_system.h"

#include <math.h>
#include <string.h>

// ---- what is left of e - B K^-1 r + W q(e) ------------------------------------------

static double bond_across(const struct joint *joint)
{
    return joint->is_bonded && !joint->is_gone ? joint->bond_stiffness[STRAIN_ACROSS]
                                               : 0;
}

// How stiff what holds the joint is against shear without its contact, of the contact,
// which can be stiffer by orders of magnitude. Half of it: others give way as well.
static double softness(const struct corrections *c, const struct entry *entry)
{
    const struct joint *joint = &c->joint[entry->joint];
    double compliance = 0;
    for (int k = STRAIN_ACROSS; k < STRAINS / 2; k++)
        compliance += 0.5 * c->share * compliance_of(c, entry->row[k])[entry->row[k]];
    const double held = c->tangent[entry->joint][STRAIN_ACROSS] - bond_across(joint);
    return fmin(1, fmax(1e-4, 0.5 * (1 / compliance - held) / joint->contact_across));
}

void note_pull(const struct corrections *c, struct entry *entry)
{
    const int j = entry->joint;
    const double bond = bond_across(&c->joint[j]);
    const double along = c->from[j][STRAIN_ALONG] + c->strain[entry->row[0]];
    entry->overlap = fmax(0, c->joint[j].overlap - along);
    for (int k = STRAIN_ACROSS; k < STRAINS / 2 && entry->count > k; k++) {
        const double more = c->strain[entry->row[k]];
        entry->pull[k - STRAIN_ACROSS] = c->more[entry->row[k]] + entry->load[k] +
                                         c->tangent[j][k] * more -
                                         bond * (c->from[j][k] + more);
    }
}

void resist_entry(struct corrections *c, struct entry *entry, bool softened)
{
    const int j = entry->joint;
    const double *tangent = c->tangent[j];
    struct judgement judgement = {.share = 1};
    if (softened && entry->count >= 3)
        judgement = (struct judgement){.share = softness(c, entry),
                                       .pull = {entry->pull[0], entry->pull[1]},
                                       .overlap = entry->overlap};
    double strain[STRAINS];
    memcpy(strain, c->from[j], sizeof strain);
    for (int k = 0; k < entry->count; k++)
        strain[k] += c->strain[entry->row[k]];
    const struct resistance resistance =
        joint_softened(&c->joint[j], strain, &judgement);
    entry->touch = resistance.contact.touch;
    for (int k = 0; k < entry->count; k++) {
        const double more = c->strain[entry->row[k]];
        double *q = &c->more[entry->row[k]];
        if (k >= 3) {
            entry->slope[k][0] = resistance.stiffness[k - 3] - tangent[k];
            *q = entry->slope[k][0] * more;
            continue;
        }
        for (int l = 0; l < 3; l++)
            entry->slope[k][l] = resistance.slope[k][l] - (k == l ? tangent[k] : 0);
        *q = resistance.load[k] - entry->load[k] - tangent[k] * more;
    }
    if (softened) note_pull(c, entry);
}

// Adds W MORE in ROW to SUM; by columns, which are rows too: no sum waits for itself.
void add_answer(const struct corrections *c, int row, double more, double *restrict sum)
{
    const double *restrict compliance = compliance_of(c, row);
    if (more == 0) return;
    for (int k = 0; k < c->count; k++)
        sum[k] += c->share * more * compliance[k];
}

// The same of COUNT rows (all: NULL) at once.
static void add_answers(const struct corrections *c, int count, const int *row,
                        const double *more, double sign, double *restrict sum)
{
    enum { TOGETHER = 4 };
    for (int first = 0; first < count;) {
        const double *w[TOGETHER];
        double share[TOGETHER] = {0};
        int n = 0;
        for (; n < TOGETHER && first < count; first++) {
            if (more[first] == 0) continue;
            w[n] = compliance_of(c, row ? row[first] : first);
            share[n++] = sign * c->share * more[first];
        }
        if (n == 0) break;
        while (n < TOGETHER)
            w[n++] = w[0];
        const double *const restrict a = w[0], *const restrict b = w[1],
                                     *const restrict d = w[2], *const restrict e = w[3];
        for (int k = 0; k < c->count; k++)
            sum[k] = fma(
                share[3], e[k],
                fma(share[2], d[k], fma(share[1], b[k], fma(share[0], a[k], sum[k]))));
    }
}

double find_left(struct corrections *c)
{
    double most = 0;
    for (int k = 0; k < c->count; k++)
        c->left[k] = c->strain[k] - c->linear[k];
    c->work += (double)c->count * c->n_acting;
    add_answers(c, c->count, NULL, c->more, 1, c->left);
    for (int k = 0; k < c->count; k++)
        most = fmax(most, fabs(c->left[k]));
    return most;
}

double resist_entries(struct corrections *c, bool softened)
{
    for (int k = 0; k < c->n_entry; k++)
        resist_entry(c, &c->entry[k], softened);
    return find_left(c);
}

// ---- Newton's method ----------------------------------------------------------------

static const double *slope_of(const struct corrections *c, int row)
{
    return c->entry[c->entry_of[row]].slope[c->strain_of[row]];
}

// Loads that change with the strains: rows of dq/de that are not 0.
static void list_acting(struct corrections *c)
{
    c->n_acting = 0;
    for (int row = 0; row < c->count; row++) {
        const double *slope = slope_of(c, row);
        const bool is_moment = c->strain_of[row] >= 3;
        if (slope[0] != 0 || (!is_moment && (slope[1] != 0 || slope[2] != 0)))
            c->acting[c->n_acting++] = row;
    }
}

// The matrix of another step does where little has changed: the same loads act, with
// about the same slopes.
static bool is_factored(const struct corrections *c)
{
    const double near = 1e-3;
    if (c->n_acting != c->n_factored) return false;
    for (int a = 0; a < c->n_acting; a++) {
        if (c->acting[a] != c->factored[a]) return false;
        const double *slope = slope_of(c, c->acting[a]), *old = c->factored_slope[a];
        const int terms = c->strain_of[c->acting[a]] >= 3 ? 1 : 3;
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
static int stride_of(const struct corrections *c)
{
    return ((c->n_acting + 7) / 8 | 1) * 8;
}

// 1 + dq/de W
static void fill_matrix(struct corrections *c)
{
    for (int a = 0; a < c->n_acting; a++) {
        const int row = c->acting[a];
        const struct entry *entry = &c->entry[c->entry_of[row]];
        const bool is_moment = c->strain_of[row] >= 3;
        const int terms = is_moment ? 1 : entry->count < 3 ? entry->count : 3;
        double slope[3] = {0};
        const double *of[3];
        for (int k = 0; k < 3; k++) {
            of[k] = compliance_of(c, is_moment || k >= terms ? row : entry->row[k]);
            if (k < terms) slope[k] = c->share * slope_of(c, row)[k];
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

static bool factor(struct corrections *c)
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

// How q would change; the strains follow from it.
static bool find_step(struct corrections *c)
{
    list_acting(c);
    if (!factor(c)) return false;
    for (int a = 0; a < c->n_acting; a++) {
        const int row = c->acting[a];
        const struct entry *entry = &c->entry[c->entry_of[row]];
        const bool is_moment = c->strain_of[row] >= 3;
        const int terms = is_moment ? 1 : entry->count < 3 ? entry->count : 3;
        const int *of = is_moment ? &row : entry->row;
        c->right[a] = 0;
        for (int k = 0; k < terms; k++)
            c->right[a] -= slope_of(c, row)[k] * c->left[of[k]];
    }
    dense_substitute(c->n_acting, c->matrix, stride_of(c), c->order, c->right,
                     c->answer);
    for (int row = 0; row < c->count; row++)
        c->step[row] = -c->left[row];
    add_answers(c, c->n_acting, c->acting, c->answer, -1, c->step);
    return true;
}

// Pulls of springs follow the loads that Newton's method says.
static void go(struct corrections *c)
{
    for (int e = 0; e < c->n_entry; e++) {
        struct entry *entry = &c->entry[e];
        const double *tangent = c->tangent[entry->joint];
        const double bond = bond_across(&c->joint[entry->joint]);
        for (int k = 1; k < 3 && entry->count >= 3; k++) {
            entry->pull[k - 1] += tangent[k] * c->step[entry->row[k]];
            for (int l = 0; l < 3; l++)
                entry->pull[k - 1] += entry->slope[k][l] * c->step[entry->row[l]];
            entry->pull[k - 1] -= bond * c->step[entry->row[k]];
        }
        if (entry->overlap > 0) entry->overlap -= c->step[entry->row[0]];
    }
    for (int row = 0; row < c->count; row++)
        c->strain[row] += c->step[row];
}

// Given up where nothing gets better; nearly found is enough where joints hold hardly
// anything and numbers end.
bool settle_together(struct corrections *c, bool softened, double enough)
{
    enum { PATIENCE = 4, AT_THE_END = 3 };
    double best = INFINITY, nearly = enough;
    for (int row = 0; row < c->count; row++)
        nearly = fmax(nearly, 1e-6 * fabs(c->linear[row]));
    double left = resist_entries(c, softened);
    for (int waited = 0; waited < (best > nearly ? PATIENCE : AT_THE_END); waited++) {
        if (!find_step(c)) return false;
        go(c);
        left = resist_entries(c, softened);
        if (left <= enough && resist_entries(c, false) <= enough) return true;
        if (left < 0.5 * best) {
            best = left;
            waited = 0;
        }
    }
    return resist_entries(c, false) <= nearly;
}
