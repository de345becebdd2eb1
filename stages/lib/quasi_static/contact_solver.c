// SPDX-License-Identifier: GPL-3.0-or-later
// Unknowns, one number a row, a row for each component of an active pair:
//     deformation e, since `from`; excess load q(e), by which the pair resists more
//     than its tangent in K says.
// Grains move by u = K^-1 (r - B^T q), so with f the compliance factor
//     e = free_deformation - f W q(e),  free_deformation = B K^-1 r,  W = B K^-1 B^T,
// W being `compliance` (Woodbury's identity; Delassus' operator of contact mechanics).
// With K = L L^T a group of rows keeps L^-1 B^T; W is products of these, and
// free_deformation their products with L^-1 r, so no row costs a whole solve.
//
// Newton's method with augmented springs (semismooth_newton.c) and block Gauss-Seidel
// (gauss_seidel.c) both work on these small dense equations; K is factored elsewhere
// and used for many of them.
#include "contact_solver_internal.h"

#include "basics/memory.h"
#include "sparse/dense_lu.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct contact_solver *contact_solver_create(struct stiffness *stiffness, int n_pair,
                                             const struct contact_pair *pair,
                                             const double (*tangent)[COMPONENTS],
                                             int most_rows)
{
    struct contact_solver *c = NEW_ARRAY(struct contact_solver, 1);
    c->stiffness = stiffness;
    c->n_pair = n_pair;
    c->pair = pair;
    c->tangent = tangent;
    c->most_rows = most_rows;
    c->active_of = NEW_ARRAY(int, n_pair);
    contact_solver_clear(c);
    return c;
}

// Capacities stay: the next rows use the same memory.
void contact_solver_clear(struct contact_solver *solver)
{
    for (int k = 0; k < solver->n_group; k++)
        forward_solves_free(&solver->group[k].solves);
    solver->n_group = solver->n_active = solver->count = solver->n_acting =
        solver->n_factored = 0;
    solver->work = 0;
    for (int j = 0; j < solver->n_pair; j++)
        solver->active_of[j] = -1;
}

void contact_solver_free(struct contact_solver *solver)
{
    if (!solver) return;
    contact_solver_clear(solver);
    void *const owned[] = {solver->active,
                           solver->active_of,
                           solver->group,
                           solver->active_of_row,
                           solver->component_of_row,
                           solver->matrix,
                           solver->order,
                           solver->acting,
                           solver->factored,
                           solver->deformation,
                           solver->free_deformation,
                           solver->excess,
                           solver->residual,
                           solver->step,
                           solver->rhs,
                           solver->solution,
                           solver->work_space,
                           solver->compliance,
                           solver->factored_slope};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free(solver);
}

bool contact_solver_is_full(const struct contact_solver *solver)
{
    return solver->count >= solver->most_rows;
}

void contact_solver_set_most_rows(struct contact_solver *solver, int most_rows)
{
    solver->most_rows = most_rows;
}

int contact_solver_count(const struct contact_solver *solver)
{
    return solver->count;
}

double contact_solver_work(const struct contact_solver *solver)
{
    return solver->work;
}

// Work that a new factor of K, with the pairs' present tangents, would make
// unnecessary.
bool contact_solver_is_costly(const struct contact_solver *c)
{
    const double most = 1e10, most_factors = 100;
    return c->work > fmax(most, most_factors * stiffness_work(c->stiffness));
}

// ---- rows ---------------------------------------------------------------------------

static void grow(struct contact_solver *c)
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
    int **const whole[] = {&c->active_of_row, &c->component_of_row, &c->order,
                           &c->acting, &c->factored};
    for (size_t k = 0; k < sizeof whole / sizeof *whole; k++)
        *whole[k] = reallocate(*whole[k], after, sizeof **whole);
    double **const real[] = {
        &c->deformation, &c->free_deformation, &c->excess, &c->residual, &c->step,
        &c->rhs,         &c->solution};
    for (size_t k = 0; k < sizeof real / sizeof *real; k++)
        *real[k] = reallocate(*real[k], after, sizeof **real);
    c->factored_slope = reallocate(c->factored_slope, after, sizeof *c->factored_slope);
    c->capacity = (int)after;
}

static void fill_between(struct contact_solver *c, const struct row_group *a,
                         const struct row_group *b)
{
    double product[BATCH * BATCH];
    stiffness_product(c->stiffness, &a->solves, &b->solves, product);
    for (int i = 0; i < a->solves.columns; i++)
        for (int j = 0; j < b->solves.columns; j++) {
            const double compliance = product[i * b->solves.columns + j];
            const int row = a->first + i, column = b->first + j;
            compliance_of(c, row)[column] = compliance_of(c, column)[row] = compliance;
        }
}

// For the groups from FIRST on.
static void fill_compliance(struct contact_solver *c, int first)
{
    for (int k = first; k < c->n_group; k++) {
        const struct row_group *new = &c->group[k];
        const double columns = new->solves.columns;
        c->work += new->solves.work +
                   columns *new->solves.size *(new->first + new->solves.columns);
    }
    for (int k = 0; k < c->n_group; k++)
        for (int l = k > first ? k : first; l < c->n_group; l++)
            fill_between(c, &c->group[k], &c->group[l]);
}

// Once a pair is active it stays so until the rows are cleared.
static struct active_pair *activate(struct contact_solver *c, int pair)
{
    if (c->active_of[pair] < 0) {
        GROW_ARRAY(c->active, c->n_active, c->active_capacity);
        c->active[c->n_active] = (struct active_pair){.pair = pair, .is_new = true};
        c->active_of[pair] = c->n_active++;
    }
    return &c->active[c->active_of[pair]];
}

// Groups of rows that go through the factor together, the first GROUPS of them full.
struct batch {
    int groups, first[MOST_SOLVES], count[MOST_SOLVES];
    struct unit_load load[MOST_SOLVES][BATCH];
};

// Several groups at once: each row of the factor is then read once for all of them.
static void add_batch(struct contact_solver *c, struct batch *batch)
{
    const int before = c->n_group;
    struct forward_solves solves[MOST_SOLVES];
    stiffness_forward_solves(c->stiffness, batch->groups, batch->count, batch->load,
                             solves);
    for (int g = 0; g < batch->groups; g++) {
        GROW_ARRAY(c->group, c->n_group, c->group_capacity);
        c->group[c->n_group++] = (struct row_group){batch->first[g], solves[g]};
    }
    fill_compliance(c, before);
    *batch = (struct batch){0};
}

// For the next component of a pair. Components in their order, NORMAL first: a pair
// with few rows has the first ones.
static void add_row(struct contact_solver *c, struct batch *batch,
                    struct active_pair *active)
{
    const int group = batch->groups;
    if (c->count == c->capacity) grow(c);
    if (batch->count[group] == 0) batch->first[group] = c->count;
    batch->load[group][batch->count[group]++] =
        (struct unit_load){active->pair, active->count};
    c->active_of_row[c->count] = c->active_of[active->pair];
    c->component_of_row[c->count] = active->count;
    active->row[active->count++] = c->count++;
    if (batch->count[group] == BATCH) batch->groups++;
}

// False when there would be more than `most_rows`; those that fit are there.
bool contact_solver_add(struct contact_solver *c, int count,
                        const struct pair_rows *new)
{
    struct batch batch = {0};
    bool fits = true;
    for (int k = 0; k < count && fits; k++) {
        struct active_pair *active = activate(c, new[k].pair);
        while (active->count < new[k].count && (fits = c->count < c->most_rows)) {
            add_row(c, &batch, active);
            if (batch.groups == MOST_SOLVES) add_batch(c, &batch);
        }
    }
    if (batch.count[batch.groups] > 0) batch.groups++;
    if (batch.groups > 0) add_batch(c, &batch);
    return fits;
}

// ---- solve --------------------------------------------------------------------------

// The augmented states of an earlier solution go on where there is a GUESS from it.
static void begin(struct contact_solver *c, bool is_guessed)
{
    memset(c->deformation, 0, (size_t)c->count * sizeof *c->deformation);
    memset(c->excess, 0, (size_t)c->count * sizeof *c->excess);
    for (int e = 0; e < c->n_active; e++) {
        struct active_pair *active = &c->active[e];
        const struct pair_response response =
            pair_respond(&c->pair[active->pair], c->from[active->pair]);
        memcpy(active->load, response.load, sizeof active->load);
        if (active->is_new || !is_guessed) update_augmentation(c, active);
        active->is_new = false;
    }
    for (int k = 0; k < c->n_group; k++)
        stiffness_deformation(c->stiffness, &c->group[k].solves,
                              c->free_deformation + c->group[k].first);
}

static void guess_deformation(struct contact_solver *c,
                              const double (*guess)[COMPONENTS])
{
    for (int row = 0; row < c->count; row++)
        c->deformation[row] =
            guess
                ? guess[c->active[c->active_of_row[row]].pair][c->component_of_row[row]]
                : 0;
}

// Newton's method with augmented and with the contacts' own springs, by turns; from the
// third round on after some sweeps of Gauss-Seidel. The factored rows of the last
// solution serve again while f is the same. ENOUGH is not below what rounding of the
// free deformation leaves.
bool contact_solver_solve(struct contact_solver *c,
                          const double (*deformation)[COMPONENTS],
                          const double (*guess)[COMPONENTS], double compliance_factor,
                          double enough)
{
    enum { ROUNDS = 5 };
    if (c->compliance_factor != compliance_factor) c->n_factored = 0;
    c->compliance_factor = compliance_factor;
    c->from = deformation;
    begin(c, guess);
    for (int row = 0; row < c->count; row++)
        enough = fmax(enough, 1e-14 * fabs(c->free_deformation[row]));
    guess_deformation(c, guess);
    if (update_contacts(c, false) <= enough) return true;
    for (int round = 0; round < ROUNDS; round++) {
        if (round > 0 && contact_solver_is_costly(c)) return false;
        if (round > 1) gauss_seidel(c, enough);
        if (semismooth_newton(c, round % 2 == 0, enough)) return true;
    }
    return false;
}

// Off both: the right side in the factor's order, and the residual grain by grain.
void contact_solver_subtract(const struct contact_solver *solver,
                             double compliance_factor, struct displacement *residual)
{
    for (int k = 0; k < solver->n_group; k++) {
        const struct row_group *group = &solver->group[k];
        double load[BATCH];
        for (int l = 0; l < group->solves.columns; l++)
            load[l] = compliance_factor * solver->excess[group->first + l];
        stiffness_subtract(solver->stiffness, &group->solves, load);
    }
    for (int e = 0; e < solver->n_active; e++) {
        const struct active_pair *active = &solver->active[e];
        const struct contact_pair *pair = &solver->pair[active->pair];
        double load[COMPONENTS] = {0};
        for (int k = 0; k < active->count; k++)
            load[k] = solver->excess[active->row[k]];
        for (int end = 0; end < 2; end++) {
            if (pair->grain[end] < 0) continue;
            const struct displacement part = pair_load_on_grain(pair, end, load);
            struct displacement *of = &residual[pair->grain[end]];
            of->translation =
                subtract(of->translation, scale(compliance_factor, part.translation));
            of->rotation =
                subtract(of->rotation, scale(compliance_factor, part.rotation));
        }
    }
}
