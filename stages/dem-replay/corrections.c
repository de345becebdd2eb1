// SPDX-License-Identifier: GPL-3.0-or-later
#include "corrections.h"

#include "basics/memory.h"
#include "settle_joint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 240 }; // triples: beyond, the dense system costs more than a factor

// Three strains of a joint, from the first or the fourth on.
struct triple {
    int32_t joint;
    int first;
    double load[3];     // that they begin with
    double slope[3][3]; // of q with the strains, now
};

struct corrections {
    struct stiffness *stiffness;
    int n, n_joint;
    const struct joint *joint;
    const double (*tangent)[STRAINS];
    double share; // of the compliance that counts
    int count;
    struct triple triple[MOST];
    int (*of)[2];                   // (n_joint) the triples of each, or -1
    double (*compliance)[MOST * 3]; // W
    double (*matrix)[MOST * 3];     // 1 + W dq/de of those that act, factored
    int row[MOST * 3];              // of the matrix, as pivots chose
    int n_acting, acting[MOST * 3];
    double strain[MOST * 3], linear[MOST * 3], more[MOST * 3]; // e, B K^-1 r, q
    double left[MOST * 3], step[MOST * 3];
    struct displacement *answer; // (3 n)
};

struct corrections *corrections_new(struct stiffness *stiffness, int n, int n_joint,
                                    const struct joint *joint,
                                    const double (*tangent)[STRAINS])
{
    struct corrections *c = NEW_ARRAY(struct corrections, 1);
    c->stiffness = stiffness;
    c->n = n;
    c->n_joint = n_joint;
    c->joint = joint;
    c->tangent = tangent;
    c->of = allocate((size_t)n_joint, sizeof *c->of);
    c->compliance = allocate(MOST * 3, sizeof *c->compliance);
    c->matrix = allocate(MOST * 3, sizeof *c->matrix);
    c->answer = NEW_ARRAY(struct displacement, 3 * (size_t)n);
    corrections_clear(c);
    return c;
}

void corrections_free(struct corrections *c)
{
    if (!c) return;
    free(c->of);
    free(c->compliance);
    free(c->matrix);
    free(c->answer);
    free(c);
}

void corrections_clear(struct corrections *c)
{
    c->count = 0;
    for (int j = 0; j < c->n_joint; j++)
        c->of[j][0] = c->of[j][1] = -1;
}

int corrections_count(const struct corrections *c)
{
    return 3 * c->count;
}

static const struct displacement *answer_of(const struct corrections *c, int k,
                                            int32_t grain)
{
    return grain < 0 ? NULL : &c->answer[(size_t)k * (size_t)c->n + (size_t)grain];
}

bool corrections_add(struct corrections *c, int joint, int first)
{
    if (c->of[joint][first / 3] >= 0) return true;
    if (c->count == MOST) return false;
    if (!stiffness_solve_joint(c->stiffness, joint, first, c->answer)) return false;
    const int new = c->count++;
    c->of[joint][first / 3] = new;
    c->triple[new] = (struct triple){.joint = joint, .first = first};
    for (int t = 0; t <= new; t++) {
        const struct triple *triple = &c->triple[t];
        const struct joint *other = &c->joint[triple->joint];
        for (int k = 0; k < 3; k++) {
            double strain[STRAINS];
            joint_strains(other, answer_of(c, k, other->grain[0]),
                          answer_of(c, k, other->grain[1]), strain);
            for (int l = 0; l < 3; l++) {
                const double compliance = strain[triple->first + l];
                c->compliance[3 * t + l][3 * new + k] = compliance;
                c->compliance[3 * new + k][3 * t + l] = compliance;
            }
        }
    }
    return true;
}

// ---- what is left of e - B K^-1 r + W q(e) ------------------------------------------

static void resist(struct corrections *c, int t, const double (*from)[STRAINS])
{
    struct triple *triple = &c->triple[t];
    const int j = triple->joint, first = triple->first;
    const double *tangent = c->tangent[j] + first, *more = c->strain + 3 * t;
    double strain[STRAINS];
    memcpy(strain, from[j], sizeof strain);
    for (int k = 0; k < 3; k++)
        strain[first + k] += more[k];
    const struct resistance resistance = joint_resistance(&c->joint[j], strain);
    for (int k = 0; k < 3; k++) {
        for (int l = 0; l < 3; l++) {
            const double slope = first == 0 ? resistance.slope[k][l]
                                 : k == l   ? resistance.stiffness[k]
                                            : 0;
            triple->slope[k][l] = slope - (k == l ? tangent[k] : 0);
        }
        c->more[3 * t + k] =
            first == 0 ? resistance.load[k] - triple->load[k] - tangent[k] * more[k]
                       : triple->slope[k][k] * more[k];
    }
}

// Adds W MORE in ROW to SUM; by columns, which are rows too: no sum waits for itself.
static void add_answer(const struct corrections *c, int row, double more, double *sum)
{
    const double *compliance = c->compliance[row];
    if (more == 0) return;
    for (int k = 0; k < 3 * c->count; k++)
        sum[k] += c->share * more * compliance[k];
}

static double find_left(struct corrections *c)
{
    double most = 0;
    for (int k = 0; k < 3 * c->count; k++)
        c->left[k] = c->strain[k] - c->linear[k];
    for (int k = 0; k < 3 * c->count; k++)
        add_answer(c, k, c->more[k], c->left);
    for (int k = 0; k < 3 * c->count; k++)
        most = fmax(most, fabs(c->left[k]));
    return most;
}

static double resist_all(struct corrections *c, const double (*from)[STRAINS])
{
    for (int t = 0; t < c->count; t++)
        resist(c, t, from);
    return find_left(c);
}

// ---- Newton's method ----------------------------------------------------------------

// Columns FIRST to END-1 by Gauss, with the largest pivot of each.
static bool factor_panel(struct corrections *c, int n, int first, int end)
{
    for (int k = first; k < end; k++) {
        int best = k;
        for (int r = k + 1; r < n; r++)
            if (fabs(c->matrix[c->row[r]][k]) > fabs(c->matrix[c->row[best]][k]))
                best = r;
        const int pivot = c->row[best];
        c->row[best] = c->row[k];
        c->row[k] = pivot;
        const double *above = c->matrix[pivot];
        if (!(fabs(above[k]) > 0)) return false;
        for (int r = k + 1; r < n; r++) {
            double *row = c->matrix[c->row[r]];
            row[k] /= above[k];
            for (int l = k + 1; l < end; l++)
                row[l] -= row[k] * above[l];
        }
    }
    return true;
}

// Four columns at a time, so that the rest is read and written a quarter as often.
static bool factor(struct corrections *c, int n)
{
    for (int k = 0; k < n; k++)
        c->row[k] = k;
    for (int first = 0; first < n; first += 4) {
        const int end = first + 4 < n ? first + 4 : n;
        if (!factor_panel(c, n, first, end)) return false;
        if (end == n) break;
        const double *above[4];
        for (int k = 0; k < 4; k++) {
            double *row = c->matrix[c->row[first + k]];
            for (int i = 0; i < k; i++)
                for (int l = end; l < n; l++)
                    row[l] -= row[first + i] * above[i][l];
            above[k] = row;
        }
        for (int r = end; r < n; r++) {
            double *row = c->matrix[c->row[r]];
            const double s[4] = {row[first], row[first + 1], row[first + 2],
                                 row[first + 3]};
            for (int l = end; l < n; l++)
                row[l] -= s[0] * above[0][l] + s[1] * above[1][l] + s[2] * above[2][l] +
                          s[3] * above[3][l];
        }
    }
    return true;
}

static void substitute(const struct corrections *c, int n, const double *right,
                       double *answer)
{
    for (int k = 0; k < n; k++) {
        const double *row = c->matrix[c->row[k]];
        answer[k] = right[c->row[k]];
        for (int l = 0; l < k; l++)
            answer[k] -= row[l] * answer[l];
    }
    for (int k = n - 1; k >= 0; k--) {
        const double *row = c->matrix[c->row[k]];
        for (int l = k + 1; l < n; l++)
            answer[k] -= row[l] * answer[l];
        answer[k] /= row[k];
    }
}

// Loads that change with the strains: rows of dq/de that are not 0.
static void list_acting(struct corrections *c)
{
    c->n_acting = 0;
    for (int t = 0; t < c->count; t++)
        for (int k = 0; k < 3; k++) {
            const double *slope = c->triple[t].slope[k];
            if (slope[0] != 0 || slope[1] != 0 || slope[2] != 0)
                c->acting[c->n_acting++] = 3 * t + k;
        }
}

// 1 + dq/de W
static void fill_matrix(struct corrections *c)
{
    for (int a = 0; a < c->n_acting; a++) {
        const int t = c->acting[a] / 3;
        const double *slope = c->triple[t].slope[c->acting[a] % 3];
        const double(*compliance)[MOST * 3] = c->compliance + 3 * t;
        for (int b = 0; b < c->n_acting; b++) {
            const int column = c->acting[b];
            c->matrix[a][b] = c->share * (slope[0] * compliance[0][column] +
                                          slope[1] * compliance[1][column] +
                                          slope[2] * compliance[2][column]);
        }
        c->matrix[a][a] += 1;
    }
}

// How q would change; the strains follow from it.
static bool find_step(struct corrections *c)
{
    double right[MOST * 3], answer[MOST * 3];
    list_acting(c);
    fill_matrix(c);
    if (!factor(c, c->n_acting)) return false;
    for (int a = 0; a < c->n_acting; a++) {
        const int t = c->acting[a] / 3;
        const double *slope = c->triple[t].slope[c->acting[a] % 3];
        const double *left = c->left + 3 * t;
        right[a] = -slope[0] * left[0] - slope[1] * left[1] - slope[2] * left[2];
    }
    substitute(c, c->n_acting, right, answer);
    for (int row = 0; row < 3 * c->count; row++)
        c->step[row] = -c->left[row];
    for (int a = 0; a < c->n_acting; a++)
        add_answer(c, c->acting[a], -answer[a], c->step);
    return true;
}

// Whether it is found; given up where nothing gets better.
static bool newton(struct corrections *c, const double (*from)[STRAINS], double enough)
{
    enum { PATIENCE = 4 };
    double best = INFINITY;
    for (int waited = 0; waited < PATIENCE; waited++) {
        if (!find_step(c)) return false;
        for (int row = 0; row < 3 * c->count; row++)
            c->strain[row] += c->step[row];
        const double left = resist_all(c, from);
        if (left <= enough) return true;
        if (left < 0.5 * best) {
            best = left;
            waited = 0;
        }
    }
    return false;
}

// ---- joint by joint -----------------------------------------------------------------

// Twist and bending are linear.
static void settle_moments(const struct triple *triple, const struct surroundings *s,
                           double x[3])
{
    double m[3][3], right[3];
    for (int k = 0; k < 3; k++) {
        right[k] = s->given[k];
        for (int l = 0; l < 3; l++)
            m[k][l] = (k == l) + s->compliance[k][l] * triple->slope[l][l];
    }
    if (solve_three(m, right)) memcpy(x, right, sizeof right);
}

static struct surroundings around(const struct corrections *c, int t,
                                  const double from[STRAINS])
{
    const struct triple *triple = &c->triple[t];
    struct surroundings s;
    memcpy(s.from, from + triple->first, sizeof s.from);
    memcpy(s.load, triple->load, sizeof s.load);
    memcpy(s.tangent, c->tangent[triple->joint] + triple->first, sizeof s.tangent);
    for (int k = 0; k < 3; k++) {
        const double *compliance = c->compliance[3 * t + k] + 3 * t;
        s.given[k] = c->strain[3 * t + k] - c->left[3 * t + k];
        for (int l = 0; l < 3; l++) {
            s.compliance[k][l] = c->share * compliance[l];
            s.given[k] += s.compliance[k][l] * c->more[3 * t + l];
        }
    }
    return s;
}

// The strains of one while the others push as they do.
static void settle(struct corrections *c, int t, const double (*from)[STRAINS],
                   double enough)
{
    const struct triple *triple = &c->triple[t];
    double *strain = c->strain + 3 * t, *more = c->more + 3 * t,
           *left = c->left + 3 * t;
    if (fmax(fabs(left[0]), fmax(fabs(left[1]), fabs(left[2]))) <= enough) return;
    const struct surroundings s = around(c, t, from[triple->joint]);
    const double before[6] = {strain[0], strain[1], strain[2],
                              more[0],   more[1],   more[2]};
    if (triple->first == 0)
        settle_joint(&c->joint[triple->joint], &s, strain);
    else
        settle_moments(triple, &s, strain);
    resist(c, t, from);
    for (int k = 0; k < 3; k++) {
        left[k] += strain[k] - before[k];
        add_answer(c, 3 * t + k, more[k] - before[3 + k], c->left);
    }
}

// How much is left after some rounds.
static double settle_in_turn(struct corrections *c, const double (*from)[STRAINS],
                             double enough)
{
    enum { SWEEPS = 10 };
    double left = INFINITY;
    for (int sweep = 0; sweep < SWEEPS && left > enough; sweep++) {
        for (int t = 0; t < c->count; t++)
            settle(c, t, from, 0.5 * enough);
        left = find_left(c);
    }
    return left;
}

static void begin(struct corrections *c, const double (*from)[STRAINS],
                  const double (*linear)[STRAINS])
{
    for (int t = 0; t < c->count; t++) {
        struct triple *triple = &c->triple[t];
        const struct resistance resistance =
            joint_resistance(&c->joint[triple->joint], from[triple->joint]);
        for (int k = 0; k < 3; k++) {
            triple->load[k] = resistance.load[triple->first + k];
            c->linear[3 * t + k] = linear[triple->joint][triple->first + k];
        }
    }
}

bool corrections_find(struct corrections *c, const double (*strain)[STRAINS],
                      const double (*linear)[STRAINS], double share, double enough)
{
    enum { PATIENCE = 2 };
    c->share = share;
    begin(c, strain, linear);
    memset(c->strain, 0, sizeof c->strain);
    if (resist_all(c, strain) <= enough) return true;
    if (newton(c, strain, enough)) return true;
    memset(c->strain, 0, sizeof c->strain);
    double best = resist_all(c, strain);
    for (int waited = 0; waited < PATIENCE; waited++) {
        const double left = settle_in_turn(c, strain, enough);
        if (left <= enough || newton(c, strain, enough)) return true;
        if (left < 0.5 * best) {
            best = left;
            waited = 0;
        }
    }
    return false;
}

void corrections_take_off(const struct corrections *c, double share,
                          struct displacement *left)
{
    for (int t = 0; t < c->count; t++) {
        const struct joint *joint = &c->joint[c->triple[t].joint];
        double load[STRAINS] = {0};
        memcpy(load + c->triple[t].first, c->more + 3 * t, 3 * sizeof *load);
        for (int end = 0; end < 2; end++) {
            if (joint->grain[end] < 0) continue;
            const struct displacement part = joint_loads(joint, end, load);
            struct displacement *of = &left[joint->grain[end]];
            of->shift = subtract(of->shift, scale(share, part.shift));
            of->turn = subtract(of->turn, scale(share, part.turn));
        }
    }
}
