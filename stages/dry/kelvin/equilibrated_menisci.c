// SPDX-License-Identifier: GPL-3.0-or-later
// The equilibrated bodies evaporate nothing: with S of schur_rows.c, restricted to
// them,
//     S step = evaporation,   potential += step,
// once, as evaporation is linear in the potentials; refinement removes rounding. The
// factor is of the matrix scaled to a unit diagonal, D^-1/2 S D^-1/2 with root =
// sqrt(D), in which a body that is not equilibrated has a row of the identity. It
// follows
//     bodies that join or leave    by cholmod_rowadd and cholmod_rowdel,
//     nodes that dry               by one downdate each (dried_nodes.c),
// and is made again after MAX_UPDATES emptied throats or when refinement stalls.
// Without DIAGONAL_SHIFT it would be singular for a group without a path to the air.
#include "equilibrated_menisci.h"

#include "basics/memory.h"
#include "dried_nodes.h"
#include "kelvin_evaporation.h"
#include "schur_rows.h"
#include "sparse/cholmod_serial.h"
#include "sparse/cholmod_solve_serial.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// At most so many corrections; after STALE_AFTER of them an updated factor is made
// again.
enum { REFINEMENTS = 4, STALE_AFTER = 2 };

// A new ordering costs as much as updates for some ten throats; by then fill-in has
// made the factor dense.
enum { MAX_UPDATES = 16 };

// Added to the unit diagonal: where vapour cannot leave, any common potential would be
// an equilibrium.
static const double DIAGONAL_SHIFT = 1e-12;

// Equilibrated bodies may evaporate this part of the rate, in all.
static const double FLUX_TOLERANCE = 1e-13;

struct equilibrated_menisci {
    cholmod_common common;
    cholmod_factor *factor; // L D L' of all rows, those of bodies that are not
                            // equilibrated being of the identity; NULL: to be made
    int n_updates;          // throats that have emptied since it was made
    bool was_updated;       // rows have come or gone
    int n_slot, capacity;   // rows in use, of how many
    int *owner;             // (n_slot) throat or cluster
    int *slot;              // (n_throat) by throat or cluster, -1: none
    bool *has;              // (n_throat) likewise: its row is in the factor
    int *row;               // (room) in the factor, by slot
    double *root;           // (room) over which entries are taken, by slot
    double *x, *work;       // (room)
    struct schur_rows rows;
    struct dried_nodes dried;
};

// --- making ------------------------------------------------------------------------

static int capacity_for(int n)
{
    return n + n / 4 + 64;
}

struct equilibrated_menisci *equilibrated_create(int n_throat, int n_site,
                                                 bool by_throat)
{
    const int capacity = capacity_for(n_throat);
    struct equilibrated_menisci *equilibrated =
        NEW_ARRAY(struct equilibrated_menisci, 1);
    *equilibrated = (struct equilibrated_menisci){
        .owner = NEW_ARRAY(int, capacity),
        .slot = NEW_ARRAY(int, n_throat),
        .has = NEW_ARRAY(bool, n_throat),
        .row = NEW_ARRAY(int, capacity),
        .root = NEW_ARRAY(double, capacity),
        .x = NEW_ARRAY(double, capacity),
        .work = NEW_ARRAY(double, capacity),
        .rows = schur_rows_init(n_throat, n_site),
        .dried = dried_nodes_init(n_throat, n_site, by_throat)};
    for (int t = 0; t < n_throat; t++)
        equilibrated->slot[t] = -1;
    cholmod_serial_start(&equilibrated->common);
    equilibrated->common.dbound = DIAGONAL_SHIFT;
    return equilibrated;
}

void equilibrated_free(struct equilibrated_menisci *equilibrated)
{
    if (!equilibrated) return;
    equilibrated_forget(equilibrated);
    cholmod_finish(&equilibrated->common);
    free(equilibrated->owner);
    free(equilibrated->slot);
    free(equilibrated->has);
    free(equilibrated->row);
    free(equilibrated->root);
    free(equilibrated->x);
    free(equilibrated->work);
    schur_rows_free(&equilibrated->rows);
    dried_nodes_free(&equilibrated->dried);
    free(equilibrated);
}

void equilibrated_forget(struct equilibrated_menisci *equilibrated)
{
    cholmod_free_factor(&equilibrated->factor, &equilibrated->common);
    for (int s = 0; s < equilibrated->n_slot; s++) {
        equilibrated->slot[equilibrated->owner[s]] = -1;
        equilibrated->has[equilibrated->owner[s]] = false;
    }
    equilibrated->n_slot = 0;
    dried_nodes_clear(&equilibrated->dried);
}

static int add_slot(struct equilibrated_menisci *equilibrated, int owner)
{
    const int slot = equilibrated->n_slot++;
    equilibrated->owner[slot] = owner;
    equilibrated->slot[owner] = slot;
    return slot;
}

static int slot_of(const struct equilibrated_menisci *equilibrated,
                   const struct kelvin_menisci *kelvin, int body)
{
    return equilibrated->slot[kelvin->body[body]];
}

// --- one row -----------------------------------------------------------------------

static void make_row(struct equilibrated_menisci *equilibrated,
                     const struct kelvin_menisci *kelvin,
                     const struct occupancy *occupancy, int body)
{
    schur_rows_take(&equilibrated->rows, kelvin, occupancy, body);
    const double diagonal = equilibrated->rows.value[body];
    equilibrated->root[slot_of(equilibrated, kelvin, body)] =
        diagonal > 0 ? sqrt(diagonal) : 1;
}

// Entry of the current row, that of BODY, in the column of OTHER; scaled.
static double entry(const struct equilibrated_menisci *equilibrated,
                    const struct kelvin_menisci *kelvin, int body, int other)
{
    if (other == body) return 1 + DIAGONAL_SHIFT;
    return equilibrated->rows.value[other] /
           (equilibrated->root[slot_of(equilibrated, kelvin, body)] *
            equilibrated->root[slot_of(equilibrated, kelvin, other)]);
}

// --- all rows ----------------------------------------------------------------------

static bool more_entries(struct equilibrated_menisci *equilibrated,
                         cholmod_triplet *entries, int n)
{
    const size_t needed = entries->nnz + (size_t)n;
    return needed <= entries->nzmax ||
           cholmod_reallocate_triplet(2 * needed, entries, &equilibrated->common);
}

// Each row adds its entries with the rows before it, whose roots are known.
static bool list_row(struct equilibrated_menisci *equilibrated,
                     const struct kelvin_menisci *kelvin,
                     const struct occupancy *occupancy, int body,
                     cholmod_triplet *entries)
{
    const struct schur_rows *rows = &equilibrated->rows;
    make_row(equilibrated, kelvin, occupancy, body);
    equilibrated->has[kelvin->body[body]] = true;
    const bool has_room =
        more_entries(equilibrated, entries, rows->n + equilibrated->capacity);
    for (int i = 0; has_room && i < rows->n; i++) {
        const int other = rows->column[i];
        if (equilibrated->has[kelvin->body[other]])
            add_entry(entries, slot_of(equilibrated, kelvin, body),
                      slot_of(equilibrated, kelvin, other),
                      entry(equilibrated, kelvin, body, other));
    }
    schur_rows_clear(&equilibrated->rows);
    return has_room;
}

static cholmod_sparse *make_matrix(struct equilibrated_menisci *equilibrated,
                                   const struct kelvin_menisci *kelvin,
                                   const struct occupancy *occupancy)
{
    cholmod_triplet *entries =
        new_entries(&equilibrated->common, equilibrated->capacity,
                    8 * (size_t)equilibrated->capacity);
    if (!entries) return NULL;
    bool good = true;
    for (int a = 0; good && a < kelvin->n; a++)
        if (kelvin->zero_flux[a])
            good = list_row(equilibrated, kelvin, occupancy, a, entries);
    for (int s = 0; good && s < equilibrated->capacity; s++)
        if (s >= equilibrated->n_slot || !equilibrated->has[equilibrated->owner[s]])
            add_entry(entries, s, s, 1);
    if (good) return take_matrix(&equilibrated->common, entries);
    cholmod_free_triplet(&entries, &equilibrated->common);
    return NULL;
}

static bool factorise(struct equilibrated_menisci *equilibrated,
                      const struct kelvin_menisci *kelvin,
                      const struct occupancy *occupancy)
{
    equilibrated_forget(equilibrated);
    equilibrated->n_updates = 0;
    equilibrated->was_updated = false;
    equilibrated->capacity = capacity_for(kelvin->n);
    for (int a = 0; a < kelvin->n; a++)
        add_slot(equilibrated, kelvin->body[a]);
    cholmod_sparse *matrix = make_matrix(equilibrated, kelvin, occupancy);
    if (matrix) equilibrated->factor = cholmod_analyze(matrix, &equilibrated->common);
    const bool good =
        equilibrated->factor &&
        cholmod_factorize(matrix, equilibrated->factor, &equilibrated->common);
    cholmod_free_sparse(&matrix, &equilibrated->common);
    for (int i = 0; good && i < equilibrated->capacity; i++)
        equilibrated->row[((const int *)equilibrated->factor->Perm)[i]] = i;
    if (!good) equilibrated_forget(equilibrated);
    return good;
}

// --- rows that come and go ---------------------------------------------------------

static cholmod_sparse *new_column(struct equilibrated_menisci *equilibrated, int most)
{
    return cholmod_allocate_sparse((size_t)equilibrated->capacity, 1, (size_t)most,
                                   false, true, 0, CHOLMOD_REAL, &equilibrated->common);
}

static void add_to_column(cholmod_sparse *column, int row, double value)
{
    int *n = (int *)column->p + 1;
    ((int *)column->i)[*n] = row;
    ((double *)column->x)[*n] = value;
    ++*n;
}

static bool add_row(struct equilibrated_menisci *equilibrated,
                    const struct kelvin_menisci *kelvin,
                    const struct occupancy *occupancy, int body)
{
    if (slot_of(equilibrated, kelvin, body) < 0)
        add_slot(equilibrated, kelvin->body[body]);
    const int slot = slot_of(equilibrated, kelvin, body);
    make_row(equilibrated, kelvin, occupancy, body);
    equilibrated->has[kelvin->body[body]] = true;
    cholmod_sparse *column = new_column(equilibrated, equilibrated->rows.n);
    for (int i = 0; column && i < equilibrated->rows.n; i++) {
        const int other = equilibrated->rows.column[i];
        if (equilibrated->has[kelvin->body[other]])
            add_to_column(column,
                          equilibrated->row[slot_of(equilibrated, kelvin, other)],
                          entry(equilibrated, kelvin, body, other));
    }
    schur_rows_clear(&equilibrated->rows);
    const bool good =
        column && cholmod_rowadd((size_t)equilibrated->row[slot], column,
                                 equilibrated->factor, &equilibrated->common);
    cholmod_free_sparse(&column, &equilibrated->common);
    return good;
}

static bool take_row(struct equilibrated_menisci *equilibrated, int owner)
{
    if (!equilibrated->has[owner]) return true;
    equilibrated->has[owner] = false;
    return cholmod_rowdel((size_t)equilibrated->row[equilibrated->slot[owner]], NULL,
                          equilibrated->factor, &equilibrated->common);
}

// Updates the factor until it has exactly the rows of the equilibrated bodies.
static bool update(struct equilibrated_menisci *equilibrated,
                   const struct kelvin_menisci *kelvin,
                   const struct occupancy *occupancy)
{
    if (!equilibrated->factor) return factorise(equilibrated, kelvin, occupancy);
    bool good = true;
    for (int a = 0; good && a < kelvin->n; a++) {
        if (equilibrated->has[kelvin->body[a]] == kelvin->zero_flux[a]) continue;
        equilibrated->was_updated = true;
        if (!kelvin->zero_flux[a]) good = take_row(equilibrated, kelvin->body[a]);
    }
    for (int a = 0; good && a < kelvin->n; a++) {
        if (equilibrated->has[kelvin->body[a]] == kelvin->zero_flux[a]) continue;
        good = equilibrated->n_slot < equilibrated->capacity &&
               add_row(equilibrated, kelvin, occupancy, a);
    }
    return good || factorise(equilibrated, kelvin, occupancy);
}

// --- throats that empty ------------------------------------------------------------

void equilibrated_empty_throat(struct equilibrated_menisci *equilibrated,
                               struct occupancy *occupancy, int throat)
{
    if (equilibrated->factor)
        dried_nodes_note_before(&equilibrated->dried, occupancy, throat);
    occupancy_empty_throat(occupancy, throat);
    if (equilibrated->factor) dried_nodes_note_after(&equilibrated->dried, occupancy);
}

// Adds the parts of the K-th wet node, times CONDUCTANCE, to equilibrated->x by slots,
// and lists new slots in COLUMN.
static void add_parts(struct equilibrated_menisci *equilibrated,
                      const struct kelvin_menisci *kelvin, int k, double conductance,
                      cholmod_sparse *column)
{
    for (int j = kelvin->offset[k]; j < kelvin->offset[k + 1]; j++) {
        const int owner = kelvin->body[kelvin->share[j].body];
        const double part = kelvin->share[j].part * conductance;
        if (!equilibrated->has[owner] || !(part > 0)) continue;
        const int slot = equilibrated->slot[owner];
        if (equilibrated->x[slot] == 0) add_to_column(column, slot, 0);
        equilibrated->x[slot] += part;
    }
}

// Eliminates a node that has dried: a downdate with the column of its links to bodies.
static bool eliminate(struct equilibrated_menisci *equilibrated,
                      const struct kelvin_menisci *kelvin,
                      const struct occupancy *occupancy, const struct dried_node *node)
{
    cholmod_sparse *column = new_column(equilibrated, equilibrated->n_slot);
    if (!column) return false;
    for (int i = node->begin; i < node->end; i++) {
        const struct dried_link *link = &equilibrated->dried.link[i];
        const int k = occupancy->wet_place[link->site];
        if (k >= 0) add_parts(equilibrated, kelvin, k, link->conductance, column);
    }
    int *at = column->i;
    for (int i = 0; i < ((const int *)column->p)[1]; i++) {
        const int slot = at[i];
        at[i] = equilibrated->row[slot];
        ((double *)column->x)[i] =
            equilibrated->x[slot] / (equilibrated->root[slot] * sqrt(node->total));
        equilibrated->x[slot] = 0;
    }
    const bool good =
        cholmod_sort(column, &equilibrated->common) &&
        cholmod_updown(false, column, equilibrated->factor, &equilibrated->common);
    cholmod_free_sparse(&column, &equilibrated->common);
    return good;
}

void equilibrated_follow(struct equilibrated_menisci *equilibrated,
                         const struct kelvin_menisci *kelvin,
                         const struct occupancy *occupancy, int n)
{
    struct dried_nodes *dried = &equilibrated->dried;
    schur_rows_list(&equilibrated->rows, kelvin, occupancy);
    equilibrated->n_updates += n;
    bool good = equilibrated->factor && dried->n_throat == n &&
                equilibrated->n_updates <= MAX_UPDATES;
    equilibrated->was_updated = true;
    memset(equilibrated->x, 0,
           (size_t)equilibrated->capacity * sizeof *equilibrated->x);
    for (int i = 0; good && i < dried->n_body; i++)
        good = take_row(equilibrated, dried->body[i]);
    for (int i = 0; good && i < dried->n_node; i++)
        good = eliminate(equilibrated, kelvin, occupancy, &dried->node[i]);
    dried_nodes_clear(dried);
    if (!good) equilibrated_forget(equilibrated);
}

// --- all ---------------------------------------------------------------------------

// Whether the equilibrated bodies evaporate no more than rounding.
static bool has_zero_flux(const struct kelvin_menisci *kelvin)
{
    double evaporation = 0, noise = 0;
    for (int a = 0; a < kelvin->n; a++) {
        if (!kelvin->zero_flux[a]) continue;
        evaporation += fabs(kelvin->evaporation[a]);
        noise += kelvin->noise[a];
    }
    return evaporation <= fmax(FLUX_TOLERANCE * kelvin->rate, noise);
}

static void correct(struct equilibrated_menisci *equilibrated,
                    struct kelvin_menisci *kelvin)
{
    memset(equilibrated->x, 0,
           (size_t)equilibrated->capacity * sizeof *equilibrated->x);
    for (int a = 0; a < kelvin->n; a++) {
        const int slot = slot_of(equilibrated, kelvin, a);
        if (kelvin->zero_flux[a])
            equilibrated->x[equilibrated->row[slot]] =
                kelvin->evaporation[a] / equilibrated->root[slot];
    }
    cholmod_solve_serial(equilibrated->factor, equilibrated->x, equilibrated->work);
    for (int a = 0; a < kelvin->n; a++) {
        const int slot = slot_of(equilibrated, kelvin, a);
        if (kelvin->zero_flux[a])
            kelvin->potential[a] +=
                equilibrated->x[equilibrated->row[slot]] / equilibrated->root[slot];
    }
}

bool solve_zero_flux(struct kelvin_menisci *kelvin, const struct occupancy *occupancy)
{
    struct equilibrated_menisci *equilibrated = kelvin->equilibrated;
    for (int k = 0; k < REFINEMENTS && !has_zero_flux(kelvin); k++) {
        const bool anew = k == STALE_AFTER && equilibrated->was_updated;
        if (k == 0 && !update(equilibrated, kelvin, occupancy)) return false;
        if (anew && !factorise(equilibrated, kelvin, occupancy)) return false;
        correct(equilibrated, kelvin);
        kelvin_find_evaporation(kelvin, occupancy);
    }
    return true;
}
