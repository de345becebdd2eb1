// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact_solver_internal.h"

#include "basics/memory.h"
#include "sparse/dense_system.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 4000 }; // rows: beyond, the dense system is too large

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
    c->n_addition = c->n_entry = c->count = c->n_acting = c->n_factored = 0;
    c->work = 0;
    for (int j = 0; j < c->n_joint; j++)
        c->of[j] = -1;
}

void corrections_free(struct corrections *c)
{
    if (!c) return;
    corrections_clear(c);
    void *const owned[] = {c->entry,      c->of,         c->addition,      c->entry_of,
                           c->strain_of,  c->matrix,     c->order,         c->acting,
                           c->factored,   c->strain,     c->linear,        c->more,
                           c->left,       c->step,       c->right,         c->answer,
                           c->work_space, c->compliance, c->factored_slope};
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

bool corrections_are_costly(const struct corrections *c)
{
    const double most = 1e10, most_factors = 100;
    return c->work > fmax(most, most_factors * stiffness_work(c->stiffness));
}

// ---- rows ---------------------------------------------------------------------------

static void make_room(struct corrections *c)
{
    const size_t before = (size_t)c->capacity, after = before ? 2 * before : 128;
    double *compliance = NEW_ARRAY(double, after *after);
    for (size_t row = 0; row < (size_t)c->count; row++)
        memcpy(compliance + row * after, c->compliance + row * before,
               (size_t)c->count * sizeof *compliance);
    free(c->compliance);
    c->compliance = compliance;
    c->matrix = reallocate(c->matrix, after * (after + 16), sizeof *c->matrix);
    c->work_space = reallocate(c->work_space, after * DENSE_PANEL, sizeof(double));
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

static void fill_between(struct corrections *c, const struct addition *a,
                         const struct addition *b)
{
    double product[LANES * LANES];
    stiffness_product(c->stiffness, &a->halves, &b->halves, product);
    for (int i = 0; i < a->halves.columns; i++)
        for (int j = 0; j < b->halves.columns; j++) {
            const double compliance = product[i * b->halves.columns + j];
            const int row = a->first + i, column = b->first + j;
            compliance_of(c, row)[column] = compliance_of(c, column)[row] = compliance;
        }
}

// Of the additions from FIRST on: each of all is read once for these.
static void fill_compliance(struct corrections *c, int first)
{
    for (int k = first; k < c->n_addition; k++) {
        const struct addition *new = &c->addition[k];
        const double columns = new->halves.columns;
        c->work += new->halves.work +
                   columns *new->halves.size *(new->first + new->halves.columns);
    }
    for (int k = 0; k < c->n_addition; k++)
        for (int l = k > first ? k : first; l < c->n_addition; l++)
            fill_between(c, &c->addition[k], &c->addition[l]);
}

static struct entry *entry_for(struct corrections *c, int joint)
{
    if (c->of[joint] < 0) {
        GROW_ARRAY(c->entry, c->n_entry, c->entry_capacity);
        c->entry[c->n_entry] = (struct entry){.joint = joint, .is_new = true};
        c->of[joint] = c->n_entry++;
    }
    return &c->entry[c->of[joint]];
}

// Groups of rows that go through the factor together, the first GROUPS of them full.
struct batch {
    int groups, first[HALVES], count[HALVES];
    struct unit_load load[HALVES][LANES];
};

static void add_batch(struct corrections *c, struct batch *batch)
{
    const int before = c->n_addition;
    struct halves halves[HALVES];
    stiffness_halves(c->stiffness, batch->groups, batch->count, batch->load, halves);
    for (int g = 0; g < batch->groups; g++) {
        GROW_ARRAY(c->addition, c->n_addition, c->addition_capacity);
        c->addition[c->n_addition++] = (struct addition){batch->first[g], halves[g]};
    }
    fill_compliance(c, before);
    *batch = (struct batch){0};
}

// For the next strain of a joint.
static void add_row(struct corrections *c, struct batch *batch, struct entry *entry)
{
    const int group = batch->groups;
    if (c->count == c->capacity) make_room(c);
    if (batch->count[group] == 0) batch->first[group] = c->count;
    batch->load[group][batch->count[group]++] =
        (struct unit_load){entry->joint, entry->count};
    c->entry_of[c->count] = c->of[entry->joint];
    c->strain_of[c->count] = entry->count;
    entry->row[entry->count++] = c->count++;
    if (batch->count[group] == LANES) batch->groups++;
}

// As many in a group as there are lanes.
bool corrections_add(struct corrections *c, int count, const struct correction *new)
{
    struct batch batch = {0};
    bool fits = true;
    for (int k = 0; k < count && fits; k++) {
        struct entry *entry = entry_for(c, new[k].joint);
        while (entry->count < new[k].strains && (fits = c->count < MOST)) {
            add_row(c, &batch, entry);
            if (batch.groups == HALVES) add_batch(c, &batch);
        }
    }
    if (batch.count[batch.groups] > 0) batch.groups++;
    if (batch.groups > 0) add_batch(c, &batch);
    return fits;
}

// ---- the way ------------------------------------------------------------------------

// Springs pull as they did where an earlier GUESS has led, else as they do.
static void begin(struct corrections *c, bool is_guessed)
{
    memset(c->strain, 0, (size_t)c->count * sizeof *c->strain);
    memset(c->more, 0, (size_t)c->count * sizeof *c->more);
    for (int e = 0; e < c->n_entry; e++) {
        struct entry *entry = &c->entry[e];
        const struct resistance resistance =
            joint_resistance(&c->joint[entry->joint], c->from[entry->joint]);
        memcpy(entry->load, resistance.load, sizeof entry->load);
        if (entry->is_new || !is_guessed) note_pull(c, entry);
        entry->is_new = false;
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

// Softened, else as it is; where that fails too joints in turn come before each.
bool corrections_find(struct corrections *c, const double (*strain)[STRAINS],
                      const double (*guess)[STRAINS], double share, double enough)
{
    enum { ROUNDS = 5 };
    if (c->share != share) c->n_factored = 0;
    c->share = share;
    c->from = strain;
    begin(c, guess);
    for (int row = 0; row < c->count; row++)
        enough = fmax(enough, 1e-14 * fabs(c->linear[row]));
    guess_strains(c, guess);
    if (resist_entries(c, false) <= enough) return true;
    for (int round = 0; round < ROUNDS; round++) {
        if (round > 0 && corrections_are_costly(c)) return false;
        if (round > 1) settle_in_turn(c, enough);
        if (settle_together(c, round % 2 == 0, enough)) return true;
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
