// SPDX-License-Identifier: GPL-3.0-or-later
#include "kron_fronts.h"

#include "basics/memory.h"
#include "kron_fronts_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The triangle of a front that has been larger than this is a large one.
enum { LARGE_FRONT = 96 };

struct kron_fronts kron_fronts_make(int n_site, bool is_rounded)
{
    struct kron_fronts mesh = {.n_site = n_site,
                               .is_rounded = is_rounded,
                               .air_conductance = NEW_ARRAY(double, n_site),
                               .first = NEW_ARRAY(int, n_site),
                               .reached_air = NEW_ARRAY(int, n_site),
                               .unused_membership = -1,
                               .unused_front = -1};
    for (int i = 0; i < n_site; i++)
        mesh.first[i] = -1;
    return mesh;
}

static void empty_front(struct front *front)
{
    free(front->site);
    dense_front_free(&front->dense);
    *front = (struct front){0};
}

void kron_fronts_free(struct kron_fronts *mesh)
{
    for (int f = 0; f < mesh->n_front; f++)
        empty_front(&mesh->front[f]);
    free(mesh->air_conductance);
    free(mesh->first);
    free(mesh->membership);
    free(mesh->front);
    free(mesh->reached_air);
    free(mesh->place);
    free(mesh->row);
    free(mesh->pair);
    free(mesh->wide);
    *mesh = (struct kron_fronts){0};
}

// --- who is on which front ---------------------------------------------------------

static int new_front(struct kron_fronts *mesh)
{
    const int front = mesh->unused_front;
    if (front >= 0) {
        mesh->unused_front = mesh->front[front].next_unused;
        mesh->front[front].next_unused = -1;
        return front;
    }
    GROW_ARRAY(mesh->front, mesh->n_front, mesh->front_capacity);
    mesh->front[mesh->n_front] = (struct front){0};
    return mesh->n_front++;
}

static void end_front(struct kron_fronts *mesh, int front)
{
    empty_front(&mesh->front[front]);
    mesh->front[front].next_unused = mesh->unused_front;
    mesh->unused_front = front;
}

// Of SITE on FRONT, -1 if it is not on it.
static int membership_of(const struct kron_fronts *mesh, int site, int front)
{
    int membership = mesh->first[site];
    while (membership >= 0 && mesh->membership[membership].front != front)
        membership = mesh->membership[membership].next;
    return membership;
}

static void join(struct kron_fronts *mesh, int site, int front, int place)
{
    int membership = mesh->unused_membership;
    if (membership >= 0) {
        mesh->unused_membership = mesh->membership[membership].next;
    } else {
        GROW_ARRAY(mesh->membership, mesh->n_membership, mesh->membership_capacity);
        membership = mesh->n_membership++;
    }
    mesh->membership[membership] = (struct membership){front, place, mesh->first[site]};
    mesh->first[site] = membership;
}

static void leave(struct kron_fronts *mesh, int site, int front)
{
    int *link = &mesh->first[site];
    while (mesh->membership[*link].front != front)
        link = &mesh->membership[*link].next;
    const int membership = *link;
    *link = mesh->membership[membership].next;
    mesh->membership[membership].next = mesh->unused_membership;
    mesh->unused_membership = membership;
}

// SITE comes last on the front, without links.
static void add_member(struct kron_fronts *mesh, int front_index, int site)
{
    struct front *front = &mesh->front[front_index];
    join(mesh, site, front_index, front->n);
    if (front->n == front->capacity) {
        front->capacity = front->capacity ? 2 * front->capacity : 4;
        front->site =
            reallocate(front->site, (size_t)front->capacity, sizeof *front->site);
    }
    dense_front_add_row(&front->dense, front->n);
    front->site[front->n++] = site;
}

// The last member takes the place of member P.
static void remove_member(struct kron_fronts *mesh, int front_index, int p)
{
    struct front *front = &mesh->front[front_index];
    leave(mesh, front->site[p], front_index);
    dense_front_remove(&front->dense, front->n, p);
    const int last = --front->n;
    if (p == last) return;
    front->site[p] = front->site[last];
    mesh->membership[membership_of(mesh, front->site[p], front_index)].place = p;
}

void kron_fronts_link(struct kron_fronts *mesh, int a, int b, double conductance)
{
    const int front = new_front(mesh);
    add_member(mesh, front, a);
    add_member(mesh, front, b);
    dense_front_set(&mesh->front[front].dense, 1, 0, conductance);
}

static void add_air(struct kron_fronts *mesh, int site, double conductance)
{
    if (!(conductance > 0)) return;
    if (mesh->air_conductance[site] == 0)
        mesh->reached_air[mesh->n_reached_air++] = site;
    mesh->air_conductance[site] += conductance;
}

static void sum_air(struct kron_fronts *mesh)
{
    mesh->all_air = (struct compensated){0};
    for (int i = 0; i < mesh->n_site; i++)
        compensated_add(&mesh->all_air, mesh->air_conductance[i]);
    mesh->summed_air = compensated_value(mesh->all_air);
}

// Digits are lost only when little is left of a large sum: then it is summed anew.
static void lower_air(struct kron_fronts *mesh, double drop)
{
    compensated_add(&mesh->all_air, -drop);
    if (compensated_value(mesh->all_air) < 0.5 * mesh->summed_air) sum_air(mesh);
}

void kron_fronts_link_air(struct kron_fronts *mesh, int site, double conductance)
{
    add_air(mesh, site, conductance);
    compensated_add(&mesh->all_air, conductance);
    mesh->summed_air = fmax(mesh->summed_air, compensated_value(mesh->all_air));
}

// --- elimination -------------------------------------------------------------------

// The members of front OTHER become members of BASE.
static void find_places(struct kron_fronts *mesh, int base_index, int other_index)
{
    while (mesh->place_capacity < mesh->front[other_index].n)
        GROW_ARRAY(mesh->place, mesh->place_capacity, mesh->place_capacity);
    for (int i = 0; i < mesh->front[other_index].n; i++) {
        const int site = mesh->front[other_index].site[i];
        leave(mesh, site, other_index);
        const int membership = membership_of(mesh, site, base_index);
        mesh->place[i] = membership < 0 ? mesh->front[base_index].n
                                        : mesh->membership[membership].place;
        if (membership < 0) add_member(mesh, base_index, site);
    }
}

static void merge(struct kron_fronts *mesh, int base_index, int other_index)
{
    find_places(mesh, base_index, other_index);
    struct front *base = &mesh->front[base_index], *other = &mesh->front[other_index];
    dense_front_bring_up_to_date(&other->dense, other->n);
    for (int i = 1; i < other->n; i++) {
        const int p = mesh->place[i];
        for (int j = 0; j < i; j++) {
            const int q = mesh->place[j];
            const int high = p > q ? p : q, low = p > q ? q : p;
            dense_front_set(&base->dense, high, low,
                            dense_front_entry(&base->dense, high, low) +
                                dense_front_entry(&other->dense, i, j));
        }
    }
    end_front(mesh, other_index);
}

// All fronts that SITE is on, as one: the largest with what the others add.
static int merge_fronts(struct kron_fronts *mesh, int site)
{
    int largest = -1;
    for (int k = mesh->first[site]; k >= 0; k = mesh->membership[k].next) {
        const int front = mesh->membership[k].front;
        if (largest < 0 || mesh->front[front].n > mesh->front[largest].n)
            largest = front;
    }
    for (int k = mesh->first[site]; k >= 0;) {
        const int front = mesh->membership[k].front;
        k = mesh->membership[k].next;
        if (front != largest) merge(mesh, largest, front);
    }
    return largest;
}

// Out of the front, into mesh->row: the links of SITE with those that stay.
static void take_out(struct kron_fronts *mesh, int front_index, int site)
{
    struct front *front = &mesh->front[front_index];
    while (mesh->row_capacity < front->n)
        GROW_ARRAY(mesh->row, mesh->row_capacity, mesh->row_capacity);
    const int place = mesh->membership[membership_of(mesh, site, front_index)].place;
    dense_front_take(&front->dense, front->n, place, mesh->row);
    remove_member(mesh, front_index, place);
    mesh->row[place] = mesh->row[front->n];
}

// In eight parts, which wide vectors add at once.
static double sum_of(const double *row, int n)
{
    enum { PARTS = 8 };
    double part[PARTS] = {0};
    int i = 0;
    for (; i + PARTS <= n; i += PARTS)
        for (int l = 0; l < PARTS; l++)
            part[l] += row[i + l];
    for (; i < n; i++)
        part[0] += row[i];
    return ((part[0] + part[1]) + (part[2] + part[3])) +
           ((part[4] + part[5]) + (part[6] + part[7]));
}

// What flowed to the eliminated site flows on into the air.
static void raise_air(struct kron_fronts *mesh, const struct front *front, double share)
{
    for (int i = 0; i < front->n; i++)
        add_air(mesh, front->site[i], mesh->row[i] * share);
}

void kron_fronts_eliminate(struct kron_fronts *mesh, int site)
{
    const double air = mesh->air_conductance[site];
    mesh->air_conductance[site] = 0;
    const int front_index = merge_fronts(mesh, site);
    if (front_index < 0) {
        lower_air(mesh, air);
        return;
    }
    take_out(mesh, front_index, site);
    struct front *front = &mesh->front[front_index];
    const double total = air + sum_of(mesh->row, front->n);
    if (total > 0) {
        dense_front_add_products(&front->dense, front->n, 1 / total, mesh->row);
        if (!front->dense.is_large && front->n > LARGE_FRONT)
            dense_front_enlarge(&front->dense, front->n, mesh->is_rounded);
        if (air > 0) raise_air(mesh, front, air / total);
    }
    if (air > 0) lower_air(mesh, air * (air / total));
    if (front->n == 1) { // a dead end
        leave(mesh, front->site[0], front_index);
        front->n = 0;
    }
    if (front->n == 0) end_front(mesh, front_index);
}

// --- state -------------------------------------------------------------------------

static void front_state(struct front *front, int n_site, int n_front,
                        struct checkpoint_stream *stream)
{
    stream_integer(stream, &front->n, 0, n_site);
    stream_integer(stream, &front->next_unused, -1, n_front - 1);
    if (stream->restoring) {
        front->capacity = front->n;
        front->site = NEW_ARRAY(int, front->n);
    }
    stream_integers(stream, front->site, front->n, 0, n_site - 1);
    dense_front_state(&front->dense, front->n, stream);
}

static void fronts_state(struct kron_fronts *mesh, struct checkpoint_stream *stream)
{
    int64_t n = mesh->n_front;
    if (stream->restoring)
        for (int f = 0; f < mesh->n_front; f++)
            empty_front(&mesh->front[f]);
    mesh->front = stream_room(stream, mesh->front, &n, sizeof *mesh->front);
    if (stream->restoring) {
        memset(mesh->front, 0, (size_t)n * sizeof *mesh->front);
        mesh->n_front = mesh->front_capacity = (int)n;
    }
    stream_integer(stream, &mesh->unused_front, -1, (int)n - 1);
    for (int f = 0; f < mesh->n_front; f++)
        front_state(&mesh->front[f], mesh->n_site, mesh->n_front, stream);
}

static void memberships_state(struct kron_fronts *mesh,
                              struct checkpoint_stream *stream)
{
    int64_t n = mesh->n_membership;
    mesh->membership =
        stream_room(stream, mesh->membership, &n, sizeof *mesh->membership);
    if (stream->restoring) mesh->n_membership = mesh->membership_capacity = (int)n;
    stream_integer(stream, &mesh->unused_membership, -1, (int)n - 1);
    stream_integers(stream, mesh->first, mesh->n_site, -1, (int)n - 1);
    for (int k = 0; k < mesh->n_membership; k++) {
        stream_integer(stream, &mesh->membership[k].front, 0, mesh->n_front - 1);
        stream_integer(stream, &mesh->membership[k].place, 0, mesh->n_site - 1);
        stream_integer(stream, &mesh->membership[k].next, -1, (int)n - 1);
    }
}

void kron_fronts_state(struct kron_fronts *mesh, struct checkpoint_stream *stream)
{
    stream_numbers(stream, mesh->air_conductance, mesh->n_site);
    stream_sums(stream, &mesh->all_air, 1);
    stream_numbers(stream, &mesh->summed_air, 1);
    fronts_state(mesh, stream);
    memberships_state(mesh, stream);
}
