// SPDX-License-Identifier: GPL-3.0-or-later
#include "corrections.h"

#include "basics/memory.h"
#include "settle_joint.h"
#include "sparse/dense_system.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 4000 }; // rows: beyond, the dense system is too large

// A joint and those of its strains, from the first on, that have a row.
struct entry {
    int32_t joint;
    int count, row[STRAINS];
    double load[STRAINS];     // that it begins with
    double slope[STRAINS][3]; // of q with the first three strains; of the others, each
                              // with its own
};

struct addition {
    int first; // row
    struct halves halves;
};

// W and the matrix have rows CAPACITY apart.
struct corrections {
    struct stiffness *stiffness;
    int n_joint;
    const struct joint *joint;
    const double (*tangent)[STRAINS];
    double share; // of the compliance that counts
    double work;  // multiplications since there were none
    int n_entry, entry_capacity;
    struct entry *entry;
    int *of; // (n_joint) the entry of each, or -1
    int n_addition, addition_capacity;
    struct addition *addition;
    int count, capacity;            // rows
    int *entry_of, *strain_of;      // (count)
    double *compliance;             // W
    double *matrix;                 // 1 + dq/de W of those that act, factored
    int *order;                     // of the matrix's rows, as pivots chose
    int n_acting, *acting;          // rows
    int n_factored, *factored;      // those in the matrix
    double (*factored_slope)[3];    // (n_factored)
    double *strain, *linear, *more; // e, B K^-1 r, q
    double *left, *step, *right, *answer;
};

struct corrections *corrections_new(struct stiffness *stiffness, int n_joint,
                                    const struct joint *joint,
                                    const double (*tangent)[STRAINS])
{
    struct corrections *c = NEW_ARRAY(struct corrections, 1);
    c->stiffness = stiffness;
    c->n_joint = n_joint;
    c->joint = joint;
    c->tangent = tangent;
    c->of = NEW_ARRAY(int, n_joint);
    corrections_clear(c);
    return c;
}

void corrections_clear(struct corrections *c)
{
    for (int k = 0; k < c->n_addition; k++)
        halves_free(&c->addition[k].halves);
    c->n_addition = c->n_entry = c->count = c->n_factored = 0;
    c->work = 0;
    for (int j = 0; j < c->n_joint; j++)
        c->of[j] = -1;
}

void corrections_free(struct corrections *c)
{
    if (!c) return;
    corrections_clear(c);
    void *const owned[] = {
        c->entry,  c->of,         c->addition,      c->entry_of, c->strain_of,
        c->matrix, c->order,      c->acting,        c->factored, c->strain,
        c->linear, c->more,       c->left,          c->step,     c->right,
        c->answer, c->compliance, c->factored_slope};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free(c);
}

int corrections_count(const struct corrections *c)
{
    return c->count;
}

double corrections_work(const struct corrections *c)
{
    return c->work;
}

void corrections_count_work(struct corrections *c, double more)
{
    c->work += more;
}

// ---- rows ---------------------------------------------------------------------------

static double *compliance_of(const struct corrections *c, int row)
{
    return c->compliance + (size_t)row * (size_t)c->capacity;
}

static void make_room(struct corrections *c)
{
    const size_t before = (size_t)c->capacity, after = before ? 2 * before : 128;
    double *compliance = NEW_ARRAY(double, after *after);
    for (size_t row = 0; row < (size_t)c->count; row++)
        memcpy(compliance + row * after, c->compliance + row * before,
               (size_t)c->count * sizeof *compliance);
    free(c->compliance);
    c->compliance = compliance;
    c->matrix = reallocate(c->matrix, after * after, sizeof *c->matrix);
    c->n_factored = 0;
    int **const whole[] = {&c->entry_of, &c->strain_of, &c->order, &c->acting,
                           &c->factored};
    for (size_t k = 0; k < sizeof whole / sizeof *whole; k++)
        *whole[k] = reallocate(*whole[k], after, sizeof **whole);
    double **const real[] = {&c->strain, &c->linear, &c->more,  &c->left,
                             &c->step,   &c->right,  &c->answer};
    for (size_t k = 0; k < sizeof real / sizeof *real; k++)
        *real[k] = reallocate(*real[k], after, sizeof **real);
    c->factored_slope = reallocate(c->factored_slope, after, sizeof *c->factored_slope);
    c->capacity = (int)after;
}

static void fill_compliance(struct corrections *c, const struct addition *new)
{
    const int columns = new->halves.columns;
    c->work += new->halves.work + (double)columns *new->halves.size * c->count;
    for (int k = 0; k < c->n_addition; k++) {
        const struct addition *other = &c->addition[k];
        double product[LANES * LANES];
        stiffness_product(c->stiffness, &other->halves, &new->halves, product);
        for (int i = 0; i < other->halves.columns; i++)
            for (int j = 0; j < columns; j++) {
                const double compliance = product[i * columns + j];
                const int row = other->first + i, column = new->first + j;
                compliance_of(c, row)[column] = compliance_of(c, column)[row] =
                    compliance;
            }
    }
}

// Rows for strains of one joint; how many.
static int add_rows(struct corrections *c, const struct correction *new,
                    struct unit_load *load)
{
    struct entry *entry = &c->entry[c->of[new->joint]];
    int count = 0;
    for (; entry->count < new->strains; entry->count++, c->count++) {
        load[count++] = (struct unit_load){new->joint, entry->count};
        entry->row[entry->count] = c->count;
        c->entry_of[c->count] = c->of[new->joint];
        c->strain_of[c->count] = entry->count;
    }
    return count;
}

static int rows_of(struct corrections *c, const struct correction *new)
{
    if (c->of[new->joint] < 0) {
        GROW_ARRAY(c->entry, c->n_entry, c->entry_capacity);
        c->entry[c->n_entry] = (struct entry){.joint = new->joint};
        c->of[new->joint] = c->n_entry++;
    }
    const int more = new->strains - c->entry[c->of[new->joint]].count;
    return more > 0 ? more : 0;
}

// As many at once as there are lanes.
bool corrections_add(struct corrections *c, int count, const struct correction *new)
{
    for (int k = 0; k < count;) {
        struct unit_load load[LANES];
        const int first = c->count;
        int loads = 0;
        for (; k < count && loads + rows_of(c, &new[k]) <= LANES; k++) {
            if (c->count + LANES > MOST) return false;
            if (c->count + LANES > c->capacity) make_room(c);
            loads += add_rows(c, &new[k], load + loads);
        }
        if (loads == 0) continue;
        GROW_ARRAY(c->addition, c->n_addition, c->addition_capacity);
        c->addition[c->n_addition++] =
            (struct addition){first, stiffness_halves(c->stiffness, loads, load)};
        fill_compliance(c, &c->addition[c->n_addition - 1]);
    }
    return true;
}

struct unit_load corrections_row(const struct corrections *c, int row)
{
    return (struct unit_load){c->entry[c->entry_of[row]].joint, c->strain_of[row]};
}

int corrections_of(const struct corrections *c, int joint)
{
    return c->of[joint] < 0 ? 0 : c->entry[c->of[joint]].count;
}

const double *corrections_compliance(const struct corrections *c, int row)
{
    return compliance_of(c, row);
}

void corrections_strain_lanes(const struct corrections *c, double *strain)
{
    for (int k = 0; k < c->n_addition; k++)
        stiffness_strain_lanes(c->stiffness, &c->addition[k].halves,
                               strain + (long)c->addition[k].first * LANES);
}

void corrections_take_off_lanes(const struct corrections *c, const double *load)
{
    for (int k = 0; k < c->n_addition; k++)
        stiffness_take_off_lanes(c->stiffness, &c->addition[k].halves,
                                 load + (long)c->addition[k].first * LANES);
}

// ---- what is left of e - B K^-1 r + W q(e) ------------------------------------------

static void resist(struct corrections *c, struct entry *entry,
                   const double (*from)[STRAINS])
{
    const int j = entry->joint;
    const double *tangent = c->tangent[j];
    double strain[STRAINS];
    memcpy(strain, from[j], sizeof strain);
    for (int k = 0; k < entry->count; k++)
        strain[k] += c->strain[entry->row[k]];
    const struct resistance resistance = joint_resistance(&c->joint[j], strain);
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
}

// Adds W MORE in ROW to SUM; by columns, which are rows too: no sum waits for itself.
static void add_answer(const struct corrections *c, int row, double more,
                       double *restrict sum)
{
    const double *restrict compliance = compliance_of(c, row);
    if (more == 0) return;
    for (int k = 0; k < c->count; k++)
        sum[k] += c->share * more * compliance[k];
}

static double find_left(struct corrections *c)
{
    double most = 0;
    for (int k = 0; k < c->count; k++)
        c->left[k] = c->strain[k] - c->linear[k];
    c->work += (double)c->count * c->n_acting;
    for (int k = 0; k < c->count; k++)
        add_answer(c, k, c->more[k], c->left);
    for (int k = 0; k < c->count; k++)
        most = fmax(most, fabs(c->left[k]));
    return most;
}

static double resist_all(struct corrections *c, const double (*from)[STRAINS])
{
    for (int k = 0; k < c->n_entry; k++)
        resist(c, &c->entry[k], from);
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

// 1 + dq/de W
static void fill_matrix(struct corrections *c)
{
    for (int a = 0; a < c->n_acting; a++) {
        const int row = c->acting[a];
        const struct entry *entry = &c->entry[c->entry_of[row]];
        const bool is_moment = c->strain_of[row] >= 3;
        const int terms = is_moment ? 1 : entry->count < 3 ? entry->count : 3;
        const int *of = is_moment ? &row : entry->row;
        double *to = c->matrix + (size_t)a * (size_t)c->capacity;
        memset(to, 0, (size_t)c->n_acting * sizeof *to);
        for (int k = 0; k < terms; k++) {
            const double slope = c->share * slope_of(c, row)[k];
            const double *compliance = compliance_of(c, of[k]);
            if (slope == 0) continue;
            for (int b = 0; b < c->n_acting; b++)
                to[b] += slope * compliance[c->acting[b]];
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
    if (!dense_factor(c->n_acting, c->matrix, c->capacity, c->order)) return false;
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
    dense_substitute(c->n_acting, c->matrix, c->capacity, c->order, c->right,
                     c->answer);
    for (int row = 0; row < c->count; row++)
        c->step[row] = -c->left[row];
    for (int a = 0; a < c->n_acting; a++)
        add_answer(c, c->acting[a], -c->answer[a], c->step);
    return true;
}

// Goes the step, or the half, the quarter ... of it: the first that leaves less than
// BEFORE, else that which leaves least. How much that is.
static double go(struct corrections *c, const double (*from)[STRAINS], double before)
{
    enum { HALVES = 6 };
    double gone = 0, share = 1, best = INFINITY, best_share = 1, left = INFINITY;
    for (int k = 0; k < HALVES; k++, share /= 2) {
        for (int row = 0; row < c->count; row++)
            c->strain[row] += (share - gone) * c->step[row];
        gone = share;
        left = resist_all(c, from);
        if (left < best) {
            best = left;
            best_share = share;
        }
        if (left < 0.9 * before) return left;
    }
    if (best_share == gone) return left;
    for (int row = 0; row < c->count; row++)
        c->strain[row] += (best_share - gone) * c->step[row];
    return resist_all(c, from);
}

// Whether it is found, or nearly, as where joints hold hardly anything and numbers end;
// given up where nothing gets better.
static bool newton(struct corrections *c, const double (*from)[STRAINS], double enough)
{
    enum { PATIENCE = 4 };
    double best = INFINITY, left = INFINITY;
    for (int waited = 0; waited < PATIENCE; waited++) {
        if (!find_step(c)) return false;
        left = go(c, from, left);
        if (left <= enough) return true;
        if (left < 0.5 * best) {
            best = left;
            waited = 0;
        }
    }
    double most = 0;
    for (int row = 0; row < c->count; row++)
        most = fmax(most, fabs(c->linear[row]));
    return left <= fmax(enough, 1e-6 * most);
}

// ---- joint by joint -----------------------------------------------------------------

// Twist and bending are linear.
static void settle_moments(const struct entry *entry, const struct surroundings *s,
                           double x[3])
{
    double m[3][3], right[3];
    for (int k = 0; k < 3; k++) {
        right[k] = s->given[k];
        for (int l = 0; l < 3; l++)
            m[k][l] = (k == l) + s->compliance[k][l] * entry->slope[3 + l][0];
    }
    if (solve_three(m, right)) memcpy(x, right, sizeof right);
}

// Of strains FIRST to END - 1.
static struct surroundings around(const struct corrections *c,
                                  const struct entry *entry, int first, int end,
                                  const double from[STRAINS])
{
    struct surroundings s = {.given = {0}};
    memcpy(s.from, from + first, sizeof s.from);
    memcpy(s.load, entry->load + first, sizeof s.load);
    memcpy(s.tangent, c->tangent[entry->joint] + first, sizeof s.tangent);
    for (int k = 0; k < end - first; k++) {
        const int row = entry->row[first + k];
        s.given[k] = c->strain[row] - c->left[row];
        for (int l = 0; l < end - first; l++) {
            const int other = entry->row[first + l];
            s.compliance[k][l] = c->share * compliance_of(c, row)[other];
            s.given[k] += s.compliance[k][l] * c->more[other];
        }
    }
    return s;
}

// The strains of one from FIRST on, three at most, while the others push as they do.
static void settle(struct corrections *c, struct entry *entry, int first,
                   const double (*from)[STRAINS], double enough)
{
    const int count = entry->count - first < 3 ? entry->count - first : 3;
    const int *row = entry->row + first;
    double most = 0, before[3] = {0}, more[3], strain[3] = {0};
    for (int k = 0; k < count; k++) {
        most = fmax(most, fabs(c->left[row[k]]));
        before[k] = strain[k] = c->strain[row[k]];
        more[k] = c->more[row[k]];
    }
    if (most <= enough) return;
    const struct surroundings s =
        around(c, entry, first, first + count, from[entry->joint]);
    if (first == 0)
        settle_joint(&c->joint[entry->joint], &s, strain);
    else
        settle_moments(entry, &s, strain);
    for (int k = 0; k < count; k++)
        c->strain[row[k]] = strain[k];
    resist(c, entry, from);
    for (int k = 0; k < count; k++) {
        c->left[row[k]] += strain[k] - before[k];
        add_answer(c, row[k], c->more[row[k]] - more[k], c->left);
    }
}

// How much is left after some rounds.
static double settle_in_turn(struct corrections *c, const double (*from)[STRAINS],
                             double enough)
{
    enum { SWEEPS = 10 };
    double left = INFINITY;
    for (int sweep = 0; sweep < SWEEPS && left > enough; sweep++) {
        for (int k = 0; k < c->n_entry; k++)
            for (int first = 0; first < c->entry[k].count; first += 3)
                settle(c, &c->entry[k], first, from, 0.5 * enough);
        left = find_left(c);
    }
    return left;
}

static void begin(struct corrections *c, const double (*from)[STRAINS])
{
    for (int e = 0; e < c->n_entry; e++) {
        struct entry *entry = &c->entry[e];
        const struct resistance resistance =
            joint_resistance(&c->joint[entry->joint], from[entry->joint]);
        memcpy(entry->load, resistance.load, sizeof entry->load);
    }
    for (int k = 0; k < c->n_addition; k++)
        stiffness_strain(c->stiffness, &c->addition[k].halves,
                         c->linear + c->addition[k].first);
}

static void guess_strains(struct corrections *c, const double (*guess)[STRAINS])
{
    for (int row = 0; row < c->count; row++)
        c->strain[row] =
            guess ? guess[c->entry[c->entry_of[row]].joint][c->strain_of[row]] : 0;
}

bool corrections_find(struct corrections *c, const double (*strain)[STRAINS],
                      const double (*guess)[STRAINS], double share, double enough)
{
    enum { PATIENCE = 2 };
    if (c->share != share) c->n_factored = 0;
    c->share = share;
    begin(c, strain);
    for (int row = 0; row < c->count; row++)
        enough = fmax(enough, 1e-14 * fabs(c->linear[row]));
    guess_strains(c, guess);
    if (resist_all(c, strain) <= enough) return true;
    if (newton(c, strain, enough)) return true;
    guess_strains(c, guess);
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
    for (int k = 0; k < c->n_addition; k++) {
        const struct addition *addition = &c->addition[k];
        double load[LANES];
        for (int l = 0; l < addition->halves.columns; l++)
            load[l] = share * c->more[addition->first + l];
        stiffness_take_off(c->stiffness, &addition->halves, load);
    }
    for (int e = 0; e < c->n_entry; e++) {
        const struct entry *entry = &c->entry[e];
        const struct joint *joint = &c->joint[entry->joint];
        double load[STRAINS] = {0};
        for (int k = 0; k < entry->count; k++)
            load[k] = c->more[entry->row[k]];
        for (int end = 0; end < 2; end++) {
            if (joint->grain[end] < 0) continue;
            const struct displacement part = joint_loads(joint, end, load);
            struct displacement *of = &left[joint->grain[end]];
            of->shift = subtract(of->shift, scale(share, part.shift));
            of->turn = subtract(of->turn, scale(share, part.turn));
        }
    }
}
