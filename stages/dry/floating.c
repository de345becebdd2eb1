// SPDX-License-Identifier: GPL-3.0-or-later
#include "floating.h"

#include "basics/memory.h"
#include "sparse/plain_cholmod.h"
#include "sparse/plain_solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { REFINEMENTS = 4 };

// What is added to the diagonal of one of the menisci that float, of it: where vapour
// cannot leave, all could float at any one potential.
static const double STAY = 1e-12;

// Part of the rate that floating bodies may evaporate.
static const double CLOSED = 1e-13;

// How the gains of the bodies that float fall with their potentials, over the roots of
// its diagonal: symmetric, positive definite, and sparse, for most links are throats.
// Where no throat has emptied, bodies that begin or cease to float are rows that come
// and go.
struct floating {
    cholmod_common common;
    cholmod_factor *factor; // L D L' of all bodies, the rows of others being those of
                            // the identity; NULL: to be made
    int n;                  // bodies
    int *row;               // (n) of each in the factor
    bool *has;              // (n) the factor has the body's row
    double *root;           // (n) of the diagonal
    int *offset;            // (n+1) of each body's wet nodes
    struct at_node *at;     // (offset[n])
    double *x, *work;       // (n) room, in the factor's order

    // Of one row.
    int n_column;
    int *column;   // (n_column) bodies
    double *value; // (n) 0 between calls
    bool *listed;  // (n) false between calls
    int *other;    // (n_site) of a node's links
    double *link;  // (n_site) 0 between calls
};

struct at_node {
    int k; // of the wet nodes
    double part;
};

// --- making ------------------------------------------------------------------------

struct floating *floating_make(int n_throat, int n_site)
{
    const size_t most = 2 * (size_t)n_throat;
    struct floating *floating = NEW_ARRAY(struct floating, 1);
    *floating = (struct floating){.row = NEW_ARRAY(int, n_throat),
                                  .has = NEW_ARRAY(bool, n_throat),
                                  .root = NEW_ARRAY(double, n_throat),
                                  .offset = NEW_ARRAY(int, n_throat + 1),
                                  .at = NEW_ARRAY(struct at_node, most),
                                  .x = NEW_ARRAY(double, n_throat),
                                  .work = NEW_ARRAY(double, n_throat),
                                  .column = NEW_ARRAY(int, n_throat),
                                  .value = NEW_ARRAY(double, n_throat),
                                  .listed = NEW_ARRAY(bool, n_throat),
                                  .other = NEW_ARRAY(int, n_site),
                                  .link = NEW_ARRAY(double, n_site)};
    plain_cholmod_start(&floating->common);
    floating->common.dbound = STAY;
    return floating;
}

void floating_free(struct floating *floating)
{
    if (!floating) return;
    floating_forget(floating);
    cholmod_finish(&floating->common);
    free(floating->row);
    free(floating->has);
    free(floating->root);
    free(floating->offset);
    free(floating->at);
    free(floating->x);
    free(floating->work);
    free(floating->column);
    free(floating->value);
    free(floating->listed);
    free(floating->other);
    free(floating->link);
    free(floating);
}

void floating_forget(struct floating *floating)
{
    cholmod_free_factor(&floating->factor, &floating->common);
}

// The wet nodes of each body, from the bodies of each.
static void list_nodes(struct floating *floating, const struct curved *curved,
                       const struct phases *phases)
{
    const int n_share = curved->offset[phases->n_wet];
    int *end = floating->offset + 1;
    floating->n = curved->n;
    memset(floating->offset, 0, ((size_t)curved->n + 1) * sizeof *floating->offset);
    for (int i = 0; i < n_share; i++)
        if (curved->share[i].body + 1 < curved->n) end[curved->share[i].body + 1]++;
    for (int a = 0; a < curved->n; a++)
        floating->offset[a + 1] += floating->offset[a];
    for (int k = 0; k < phases->n_wet; k++)
        for (int i = curved->offset[k]; i < curved->offset[k + 1]; i++)
            floating->at[end[curved->share[i].body]++] =
                (struct at_node){k, curved->share[i].part};
}

// --- one row -----------------------------------------------------------------------

static double part_at(const struct curved *curved, int k, int body)
{
    for (int i = curved->offset[k]; i < curved->offset[k + 1]; i++)
        if (curved->share[i].body == body) return curved->share[i].part;
    return 0;
}

static void add_shares(struct floating *floating, const struct curved *curved, int k,
                       double factor)
{
    for (int i = curved->offset[k]; i < curved->offset[k + 1]; i++) {
        const int body = curved->share[i].body;
        if (!floating->listed[body]) floating->column[floating->n_column++] = body;
        floating->listed[body] = true;
        floating->value[body] += factor * curved->share[i].part;
    }
}

// A link of conductance c between nodes of which BODY has the parts p and q adds
// c (p - q) times the difference of all parts: here those of the K-th wet node, with
// those of the other if it is not one of BODY's, which would add them itself. So links
// inside a body leave nothing to go off.
static void add_node(struct floating *floating, const struct curved *curved,
                     const struct phases *phases, int body, struct at_node at)
{
    const struct star_mesh *mesh = &phases->vapour.mesh;
    const int node = phases->wet[at.k];
    const int n = star_mesh_list_links(mesh, node, floating->other, floating->link);
    double sum = mesh->air[node] * at.part;
    for (int i = 0; i < n; i++) {
        const int l = phases->wet_place[floating->other[i]];
        const double link = floating->link[floating->other[i]];
        const double part = part_at(curved, l, body);
        floating->link[floating->other[i]] = 0;
        sum += link * (at.part - part);
        if (part == 0) add_shares(floating, curved, l, -link * at.part);
    }
    add_shares(floating, curved, at.k, sum);
}

// The whole row of BODY in floating->value, at floating->column.
static void make_row(struct floating *floating, const struct curved *curved,
                     const struct phases *phases, int body)
{
    floating->n_column = 0;
    for (int i = floating->offset[body]; i < floating->offset[body + 1]; i++)
        add_node(floating, curved, phases, body, floating->at[i]);
    const double diagonal = floating->value[body];
    floating->root[body] = diagonal > 0 ? sqrt(diagonal) : 1;
}

static void clear_row(struct floating *floating)
{
    for (int i = 0; i < floating->n_column; i++) {
        floating->value[floating->column[i]] = 0;
        floating->listed[floating->column[i]] = false;
    }
}

// Between BODY, of the row, and the other.
static double entry(const struct floating *floating, int body, int other)
{
    return other == body ? 1 + STAY
                         : floating->value[other] /
                               (floating->root[body] * floating->root[other]);
}

// --- all rows ----------------------------------------------------------------------

static void add_entry(cholmod_triplet *entries, int row, int column, double value)
{
    ((int *)entries->i)[entries->nnz] = row;
    ((int *)entries->j)[entries->nnz] = column;
    ((double *)entries->x)[entries->nnz] = value;
    entries->nnz++;
}

static bool more_entries(struct floating *floating, cholmod_triplet *entries)
{
    const size_t needed = entries->nnz + (size_t)floating->n_column + 1;
    return needed <= entries->nzmax ||
           cholmod_reallocate_triplet(2 * needed, entries, &floating->common);
}

// Of those who come later the roots are not known yet: they add the entry.
static bool list_entries(struct floating *floating, const struct curved *curved,
                         const struct phases *phases, cholmod_triplet *entries)
{
    for (int a = 0; a < floating->n; a++) {
        floating->has[a] = curved->floats[a];
        if (!curved->floats[a]) {
            add_entry(entries, a, a, 1);
            continue;
        }
        make_row(floating, curved, phases, a);
        const bool has_room = more_entries(floating, entries);
        for (int i = 0; has_room && i < floating->n_column; i++) {
            const int b = floating->column[i];
            if (b <= a && curved->floats[b])
                add_entry(entries, a, b, entry(floating, a, b));
        }
        clear_row(floating);
        if (!has_room) return false;
    }
    return true;
}

static cholmod_sparse *make_matrix(struct floating *floating,
                                   const struct curved *curved,
                                   const struct phases *phases)
{
    const size_t n = (size_t)floating->n;
    cholmod_triplet *entries =
        cholmod_allocate_triplet(n, n, 8 * n, -1, CHOLMOD_REAL, &floating->common);
    if (!entries) return NULL;
    cholmod_sparse *matrix = NULL;
    if (list_entries(floating, curved, phases, entries))
        matrix = cholmod_triplet_to_sparse(entries, entries->nnz, &floating->common);
    cholmod_free_triplet(&entries, &floating->common);
    return matrix;
}

static bool factorise(struct floating *floating, const struct curved *curved,
                      const struct phases *phases)
{
    floating_forget(floating);
    list_nodes(floating, curved, phases);
    cholmod_sparse *matrix = make_matrix(floating, curved, phases);
    if (matrix) floating->factor = cholmod_analyze(matrix, &floating->common);
    const bool good = floating->factor &&
                      cholmod_factorize(matrix, floating->factor, &floating->common);
    cholmod_free_sparse(&matrix, &floating->common);
    if (!good) {
        floating_forget(floating);
        return false;
    }
    for (int i = 0; i < floating->n; i++)
        floating->row[((const int *)floating->factor->Perm)[i]] = i;
    return true;
}

// --- rows that come and go ---------------------------------------------------------

static bool add_row(struct floating *floating, const struct curved *curved,
                    const struct phases *phases, int body)
{
    make_row(floating, curved, phases, body);
    floating->has[body] = true;
    cholmod_sparse *column =
        cholmod_allocate_sparse((size_t)floating->n, 1, (size_t)floating->n_column,
                                false, true, 0, CHOLMOD_REAL, &floating->common);
    int n = 0;
    for (int i = 0; column && i < floating->n_column; i++) {
        const int b = floating->column[i];
        if (!floating->has[b]) continue;
        ((int *)column->i)[n] = floating->row[b];
        ((double *)column->x)[n++] = entry(floating, body, b);
    }
    clear_row(floating);
    if (!column) return false;
    ((int *)column->p)[1] = n;
    const bool good = cholmod_rowadd((size_t)floating->row[body], column,
                                     floating->factor, &floating->common);
    cholmod_free_sparse(&column, &floating->common);
    return good;
}

static bool take_row(struct floating *floating, int body)
{
    floating->has[body] = false;
    return cholmod_rowdel((size_t)floating->row[body], NULL, floating->factor,
                          &floating->common);
}

// The factor has those that float.
static bool follow(struct floating *floating, const struct curved *curved,
                   const struct phases *phases)
{
    if (!floating->factor) return factorise(floating, curved, phases);
    bool good = true;
    for (int a = 0; good && a < floating->n; a++)
        if (floating->has[a] && !curved->floats[a]) good = take_row(floating, a);
    for (int a = 0; good && a < floating->n; a++)
        if (!floating->has[a] && curved->floats[a])
            good = add_row(floating, curved, phases, a);
    return good || factorise(floating, curved, phases);
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
    memset(floating->x, 0, (size_t)floating->n * sizeof *floating->x);
    for (int a = 0; a < floating->n; a++)
        if (curved->floats[a])
            floating->x[floating->row[a]] = curved->gain[a] / floating->root[a];
    plain_solve(floating->factor, floating->x, floating->work);
    for (int a = 0; a < floating->n; a++)
        if (curved->floats[a])
            curved->potential[a] += floating->x[floating->row[a]] / floating->root[a];
}

bool float_freely(struct curved *curved, const struct phases *phases)
{
    struct floating *floating = curved->floating;
    for (int k = 0; k < REFINEMENTS && !is_closed(curved); k++) {
        if (k == 0 && !follow(floating, curved, phases)) return false;
        correct(floating, curved);
        curved_find_gains(curved, phases);
    }
    return true;
}
