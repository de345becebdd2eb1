// SPDX-License-Identifier: GPL-3.0-or-later
#include "equilibrated_menisci.h"

#include "basics/memory.h"
#include "dried_nodes.h"
#include "kelvin_evaporation.h"
#include "schur_rows.h"
#include "sparse/plain_cholmod.h"
#include "sparse/plain_solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Corrections at most; after some with a factor that has followed changes, it is made
// anew.
enum { REFINEMENTS = 4, STALE = 2 };

// A new order costs as much as the changes of some ten throats; by then they have
// filled the factor.
enum { MOST_FOLLOWED = 16 };

// What is added to the diagonal of one of the menisci that float, of it: where vapour
// cannot leave, all could float at any one potential.
static const double STAY = 1e-12;

// Part of the rate that floating bodies may evaporate.
static const double CLOSED = 1e-13;

struct floating {
    cholmod_common common;
    cholmod_factor *factor; // L D L' of all rows, those of bodies that do not float
                            // being of the identity; NULL: to be made
    int n_followed;         // throats that have emptied since it was made
    bool has_followed;      // rows have come or gone
    int n_slot, room;       // rows in use, of how many
    int *owner;             // (n_slot) throat or cluster
    int *slot;              // (n_throat) by throat or cluster, -1: none
    bool *has;              // (n_throat) likewise: its row is in the factor
    int *row;               // (room) in the factor, by slot
    double *root;           // (room) over which entries are taken, by slot
    double *x, *work;       // (room)
    struct body_rows rows;
    struct drained drained;
};

// --- making ------------------------------------------------------------------------

static int room_for(int n)
{
    return n + n / 4 + 64;
}

struct floating *floating_make(int n_throat, int n_site, bool by_throat)
{
    const int room = room_for(n_throat);
    struct floating *floating = NEW_ARRAY(struct floating, 1);
    *floating = (struct floating){.owner = NEW_ARRAY(int, room),
                                  .slot = NEW_ARRAY(int, n_throat),
                                  .has = NEW_ARRAY(bool, n_throat),
                                  .row = NEW_ARRAY(int, room),
                                  .root = NEW_ARRAY(double, room),
                                  .x = NEW_ARRAY(double, room),
                                  .work = NEW_ARRAY(double, room),
                                  .rows = body_rows_make(n_throat, n_site),
                                  .drained = drained_make(n_throat, n_site, by_throat)};
    for (int t = 0; t < n_throat; t++)
        floating->slot[t] = -1;
    plain_cholmod_start(&floating->common);
    floating->common.dbound = STAY;
    return floating;
}

void floating_free(struct floating *floating)
{
    if (!floating) return;
    floating_forget(floating);
    cholmod_finish(&floating->common);
    free(floating->owner);
    free(floating->slot);
    free(floating->has);
    free(floating->row);
    free(floating->root);
    free(floating->x);
    free(floating->work);
    body_rows_free(&floating->rows);
    drained_free(&floating->drained);
    free(floating);
}

void floating_forget(struct floating *floating)
{
    cholmod_free_factor(&floating->factor, &floating->common);
    for (int s = 0; s < floating->n_slot; s++) {
        floating->slot[floating->owner[s]] = -1;
        floating->has[floating->owner[s]] = false;
    }
    floating->n_slot = 0;
    drained_clear(&floating->drained);
}

static int add_slot(struct floating *floating, int owner)
{
    const int slot = floating->n_slot++;
    floating->owner[slot] = owner;
    floating->slot[owner] = slot;
    return slot;
}

static int slot_of(const struct floating *floating, const struct curved *curved,
                   int body)
{
    return floating->slot[curved->body[body]];
}

// --- one row -----------------------------------------------------------------------

static void make_row(struct floating *floating, const struct curved *curved,
                     const struct phases *phases, int body)
{
    body_rows_take(&floating->rows, curved, phases, body);
    const double diagonal = floating->rows.value[body];
    floating->root[slot_of(floating, curved, body)] = diagonal > 0 ? sqrt(diagonal) : 1;
}

// Of the row at hand, that of BODY.
static double entry(const struct floating *floating, const struct curved *curved,
                    int body, int other)
{
    if (other == body) return 1 + STAY;
    return floating->rows.value[other] /
           (floating->root[slot_of(floating, curved, body)] *
            floating->root[slot_of(floating, curved, other)]);
}

// --- all rows ----------------------------------------------------------------------

static bool more_entries(struct floating *floating, cholmod_triplet *entries, int n)
{
    const size_t needed = entries->nnz + (size_t)n;
    return needed <= entries->nzmax ||
           cholmod_reallocate_triplet(2 * needed, entries, &floating->common);
}

// Rows that come later add the entries with those before, whose roots they know.
static bool list_row(struct floating *floating, const struct curved *curved,
                     const struct phases *phases, int body, cholmod_triplet *entries)
{
    const struct body_rows *rows = &floating->rows;
    make_row(floating, curved, phases, body);
    floating->has[curved->body[body]] = true;
    const bool has_room = more_entries(floating, entries, rows->n + floating->room);
    for (int i = 0; has_room && i < rows->n; i++) {
        const int other = rows->column[i];
        if (floating->has[curved->body[other]])
            add_entry(entries, slot_of(floating, curved, body),
                      slot_of(floating, curved, other),
                      entry(floating, curved, body, other));
    }
    body_rows_clear(&floating->rows);
    return has_room;
}

static cholmod_sparse *make_matrix(struct floating *floating,
                                   const struct curved *curved,
                                   const struct phases *phases)
{
    cholmod_triplet *entries =
        new_entries(&floating->common, floating->room, 8 * (size_t)floating->room);
    if (!entries) return NULL;
    bool good = true;
    for (int a = 0; good && a < curved->n; a++)
        if (curved->floats[a]) good = list_row(floating, curved, phases, a, entries);
    for (int s = 0; good && s < floating->room; s++)
        if (s >= floating->n_slot || !floating->has[floating->owner[s]])
            add_entry(entries, s, s, 1);
    if (good) return take_matrix(&floating->common, entries);
    cholmod_free_triplet(&entries, &floating->common);
    return NULL;
}

static bool factorise(struct floating *floating, const struct curved *curved,
                      const struct phases *phases)
{
    floating_forget(floating);
    floating->n_followed = 0;
    floating->has_followed = false;
    floating->room = room_for(curved->n);
    for (int a = 0; a < curved->n; a++)
        add_slot(floating, curved->body[a]);
    cholmod_sparse *matrix = make_matrix(floating, curved, phases);
    if (matrix) floating->factor = cholmod_analyze(matrix, &floating->common);
    const bool good = floating->factor &&
                      cholmod_factorize(matrix, floating->factor, &floating->common);
    cholmod_free_sparse(&matrix, &floating->common);
    for (int i = 0; good && i < floating->room; i++)
        floating->row[((const int *)floating->factor->Perm)[i]] = i;
    if (!good) floating_forget(floating);
    return good;
}

// --- rows that come and go ---------------------------------------------------------

static cholmod_sparse *new_column(struct floating *floating, int most)
{
    return cholmod_allocate_sparse((size_t)floating->room, 1, (size_t)most, false, true,
                                   0, CHOLMOD_REAL, &floating->common);
}

static void add_to_column(cholmod_sparse *column, int row, double value)
{
    int *n = (int *)column->p + 1;
    ((int *)column->i)[*n] = row;
    ((double *)column->x)[*n] = value;
    ++*n;
}

static bool add_row(struct floating *floating, const struct curved *curved,
                    const struct phases *phases, int body)
{
    if (slot_of(floating, curved, body) < 0) add_slot(floating, curved->body[body]);
    const int slot = slot_of(floating, curved, body);
    make_row(floating, curved, phases, body);
    floating->has[curved->body[body]] = true;
    cholmod_sparse *column = new_column(floating, floating->rows.n);
    for (int i = 0; column && i < floating->rows.n; i++) {
        const int other = floating->rows.column[i];
        if (floating->has[curved->body[other]])
            add_to_column(column, floating->row[slot_of(floating, curved, other)],
                          entry(floating, curved, body, other));
    }
    body_rows_clear(&floating->rows);
    const bool good = column && cholmod_rowadd((size_t)floating->row[slot], column,
                                               floating->factor, &floating->common);
    cholmod_free_sparse(&column, &floating->common);
    return good;
}

static bool take_row(struct floating *floating, int owner)
{
    if (!floating->has[owner]) return true;
    floating->has[owner] = false;
    return cholmod_rowdel((size_t)floating->row[floating->slot[owner]], NULL,
                          floating->factor, &floating->common);
}

// The factor has those that float.
static bool update(struct floating *floating, const struct curved *curved,
                   const struct phases *phases)
{
    if (!floating->factor) return factorise(floating, curved, phases);
    bool good = true;
    for (int a = 0; good && a < curved->n; a++) {
        if (floating->has[curved->body[a]] == curved->floats[a]) continue;
        floating->has_followed = true;
        if (!curved->floats[a]) good = take_row(floating, curved->body[a]);
    }
    for (int a = 0; good && a < curved->n; a++) {
        if (floating->has[curved->body[a]] == curved->floats[a]) continue;
        good =
            floating->n_slot < floating->room && add_row(floating, curved, phases, a);
    }
    return good || factorise(floating, curved, phases);
}

// --- throats that empty ------------------------------------------------------------

void floating_empty_throat(struct floating *floating, struct phases *phases, int throat)
{
    if (floating->factor) drained_note_before(&floating->drained, phases, throat);
    phases_empty_throat(phases, throat);
    if (floating->factor) drained_note_after(&floating->drained, phases);
}

// To COLUMN, by slots whose numbers in floating->x it lists.
static void add_parts(struct floating *floating, const struct curved *curved, int k,
                      double conductance, cholmod_sparse *column)
{
    for (int j = curved->offset[k]; j < curved->offset[k + 1]; j++) {
        const int owner = curved->body[curved->share[j].body];
        const double part = curved->share[j].part * conductance;
        if (!floating->has[owner] || !(part > 0)) continue;
        const int slot = floating->slot[owner];
        if (floating->x[slot] == 0) add_to_column(column, slot, 0);
        floating->x[slot] += part;
    }
}

// What bodies see of each other through a node that has dried comes from the product of
// their links with it.
static bool eliminate(struct floating *floating, const struct curved *curved,
                      const struct phases *phases, const struct dried_node *node)
{
    cholmod_sparse *column = new_column(floating, floating->n_slot);
    if (!column) return false;
    for (int i = node->begin; i < node->end; i++) {
        const struct dried_link *link = &floating->drained.link[i];
        const int k = phases->wet_place[link->site];
        if (k >= 0) add_parts(floating, curved, k, link->conductance, column);
    }
    int *at = column->i;
    for (int i = 0; i < ((const int *)column->p)[1]; i++) {
        const int slot = at[i];
        at[i] = floating->row[slot];
        ((double *)column->x)[i] =
            floating->x[slot] / (floating->root[slot] * sqrt(node->total));
        floating->x[slot] = 0;
    }
    const bool good =
        cholmod_sort(column, &floating->common) &&
        cholmod_updown(false, column, floating->factor, &floating->common);
    cholmod_free_sparse(&column, &floating->common);
    return good;
}

void floating_follow(struct floating *floating, const struct curved *curved,
                     const struct phases *phases, int n)
{
    struct drained *drained = &floating->drained;
    body_rows_list(&floating->rows, curved, phases);
    floating->n_followed += n;
    bool good = floating->factor && drained->n_throat == n &&
                floating->n_followed <= MOST_FOLLOWED;
    floating->has_followed = true;
    memset(floating->x, 0, (size_t)floating->room * sizeof *floating->x);
    for (int i = 0; good && i < drained->n_body; i++)
        good = take_row(floating, drained->body[i]);
    for (int i = 0; good && i < drained->n_node; i++)
        good = eliminate(floating, curved, phases, &drained->node[i]);
    drained_clear(drained);
    if (!good) floating_forget(floating);
}

// --- all ---------------------------------------------------------------------------

// Whether they evaporate nothing but rounding.
static bool is_closed(const struct curved *curved)
{
    double gain = 0, noise = 0;
    for (int a = 0; a < curved->n; a++) {
        if (!curved->floats[a]) continue;
        gain += fabs(curved->gain[a]);
        noise += curved->noise[a];
    }
    return gain <= fmax(CLOSED * curved->rate, noise);
}

static void correct(struct floating *floating, struct curved *curved)
{
    memset(floating->x, 0, (size_t)floating->room * sizeof *floating->x);
    for (int a = 0; a < curved->n; a++) {
        const int slot = slot_of(floating, curved, a);
        if (curved->floats[a])
            floating->x[floating->row[slot]] = curved->gain[a] / floating->root[slot];
    }
    plain_solve(floating->factor, floating->x, floating->work);
    for (int a = 0; a < curved->n; a++) {
        const int slot = slot_of(floating, curved, a);
        if (curved->floats[a])
            curved->potential[a] +=
                floating->x[floating->row[slot]] / floating->root[slot];
    }
}

bool float_freely(struct curved *curved, const struct phases *phases)
{
    struct floating *floating = curved->floating;
    for (int k = 0; k < REFINEMENTS && !is_closed(curved); k++) {
        const bool anew = k == STALE && floating->has_followed;
        if (k == 0 && !update(floating, curved, phases)) return false;
        if (anew && !factorise(floating, curved, phases)) return false;
        correct(floating, curved);
        curved_find_gains(curved, phases);
    }
    return true;
}
