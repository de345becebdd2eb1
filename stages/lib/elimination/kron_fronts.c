// SPDX-License-Identifier: GPL-3.0-or-later
// Kron reduction on dense fronts, in an order that is given as it goes (the
// multifrontal method). A front is the set of sites around one connected piece of
// eliminated sites, all linked with each other. Eliminating site i:
//     merge all fronts of i into the largest (their links add up),
//     take the row c_ij of i out, total = air_i + sum_j c_ij,
//     c_jk += c_ij c_ik / total,   air_j += c_ij air_i / total.
// The sum of all air conductances falls by air_i^2 / total, as air_i goes and the rest
// is shared.
#include "kron_fronts.h"

#include "basics/memory.h"
#include "kron_fronts_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A front that has been larger than this is stored as a large one.
enum { LARGE_FRONT = 96 };

struct kron_fronts kron_fronts_init(int n_site, bool is_rounded)
{
    struct kron_fronts fronts = {.n_site = n_site,
                                 .is_rounded = is_rounded,
                                 .first = NEW_ARRAY(int, n_site),
                                 .air = air_links_init(n_site),
                                 .unused_membership = -1,
                                 .unused_front = -1};
    for (int i = 0; i < n_site; i++)
        fronts.first[i] = -1;
    return fronts;
}

static void empty_front(struct front *front)
{
    free(front->site);
    free(front->air_place);
    dense_front_free(&front->dense);
    *front = (struct front){0};
}

void kron_fronts_free(struct kron_fronts *fronts)
{
    for (int f = 0; f < fronts->n_front; f++)
        empty_front(&fronts->front[f]);
    air_links_free(&fronts->air);
    free(fronts->first);
    free(fronts->membership);
    free(fronts->front);
    free(fronts->place);
    free(fronts->row);
    free(fronts->pair);
    free(fronts->wide);
    *fronts = (struct kron_fronts){0};
}

// --- who is on which front ---------------------------------------------------------

static int new_front(struct kron_fronts *fronts)
{
    const int front = fronts->unused_front;
    if (front >= 0) {
        fronts->unused_front = fronts->front[front].next_unused;
        fronts->front[front].next_unused = -1;
        return front;
    }
    GROW_ARRAY(fronts->front, fronts->n_front, fronts->front_capacity);
    fronts->front[fronts->n_front] = (struct front){0};
    return fronts->n_front++;
}

static void release_front(struct kron_fronts *fronts, int front)
{
    empty_front(&fronts->front[front]);
    fronts->front[front].next_unused = fronts->unused_front;
    fronts->unused_front = front;
}

// The membership of SITE on FRONT, or -1.
static int membership_of(const struct kron_fronts *fronts, int site, int front)
{
    int membership = fronts->first[site];
    while (membership >= 0 && fronts->membership[membership].front != front)
        membership = fronts->membership[membership].next;
    return membership;
}

static void add_membership(struct kron_fronts *fronts, int site, int front, int place)
{
    int membership = fronts->unused_membership;
    if (membership >= 0) {
        fronts->unused_membership = fronts->membership[membership].next;
    } else {
        GROW_ARRAY(fronts->membership, fronts->n_membership,
                   fronts->membership_capacity);
        membership = fronts->n_membership++;
    }
    fronts->membership[membership] =
        (struct membership){front, place, fronts->first[site]};
    fronts->first[site] = membership;
}

static void remove_membership(struct kron_fronts *fronts, int site, int front)
{
    int *link = &fronts->first[site];
    while (fronts->membership[*link].front != front)
        link = &fronts->membership[*link].next;
    const int membership = *link;
    *link = fronts->membership[membership].next;
    fronts->membership[membership].next = fronts->unused_membership;
    fronts->unused_membership = membership;
}

static void grow_front(struct front *front)
{
    front->capacity = front->capacity ? 2 * front->capacity : 4;
    const size_t n = (size_t)front->capacity;
    front->site = reallocate(front->site, n, sizeof *front->site);
    if (front->air_place)
        front->air_place = reallocate(front->air_place, n, sizeof *front->air_place);
}

// SITE comes last on the front, without links.
static void add_member(struct kron_fronts *fronts, int front_index, int site)
{
    struct front *front = &fronts->front[front_index];
    add_membership(fronts, site, front_index, front->n);
    if (front->n == front->capacity) grow_front(front);
    dense_front_add_row(&front->dense, front->n);
    if (front->air_place) front->air_place[front->n] = fronts->air.place[site];
    front->site[front->n++] = site;
}

// The last member takes the place of member P, as its links have done.
static void remove_member(struct kron_fronts *fronts, int front_index, int p)
{
    struct front *front = &fronts->front[front_index];
    remove_membership(fronts, front->site[p], front_index);
    const int last = --front->n;
    if (p == last) return;
    front->site[p] = front->site[last];
    if (front->air_place) front->air_place[p] = front->air_place[last];
    fronts->membership[membership_of(fronts, front->site[p], front_index)].place = p;
}

void kron_fronts_link_air(struct kron_fronts *fronts, int site, double conductance)
{
    air_links_link(&fronts->air, site, conductance);
}

void kron_fronts_link(struct kron_fronts *fronts, int a, int b, double conductance)
{
    const int front = new_front(fronts);
    add_member(fronts, front, a);
    add_member(fronts, front, b);
    dense_front_set(&fronts->front[front].dense, 1, 0, conductance);
}

// --- elimination -------------------------------------------------------------------

// The members of front OTHER become members of BASE.
static void find_places(struct kron_fronts *fronts, int base_index, int other_index)
{
    while (fronts->place_capacity < fronts->front[other_index].n)
        GROW_ARRAY(fronts->place, fronts->place_capacity, fronts->place_capacity);
    for (int i = 0; i < fronts->front[other_index].n; i++) {
        const int site = fronts->front[other_index].site[i];
        remove_membership(fronts, site, other_index);
        const int membership = membership_of(fronts, site, base_index);
        fronts->place[i] = membership < 0 ? fronts->front[base_index].n
                                          : fronts->membership[membership].place;
        if (membership < 0) add_member(fronts, base_index, site);
    }
}

static void merge(struct kron_fronts *fronts, int base_index, int other_index)
{
    find_places(fronts, base_index, other_index);
    struct front *base = &fronts->front[base_index],
                 *other = &fronts->front[other_index];
    dense_front_flush(&other->dense, other->n);
    for (int i = 1; i < other->n; i++) {
        const int p = fronts->place[i];
        for (int j = 0; j < i; j++) {
            const int q = fronts->place[j];
            const int high = p > q ? p : q, low = p > q ? q : p;
            dense_front_set(&base->dense, high, low,
                            dense_front_entry(&base->dense, high, low) +
                                dense_front_entry(&other->dense, i, j));
        }
    }
    release_front(fronts, other_index);
}

// Merges all fronts of SITE into the largest; returns its index, or -1 if there is
// none.
static int merge_fronts(struct kron_fronts *fronts, int site)
{
    int largest = -1;
    for (int k = fronts->first[site]; k >= 0; k = fronts->membership[k].next) {
        const int front = fronts->membership[k].front;
        if (largest < 0 || fronts->front[front].n > fronts->front[largest].n)
            largest = front;
    }
    for (int k = fronts->first[site]; k >= 0;) {
        const int front = fronts->membership[k].front;
        k = fronts->membership[k].next;
        if (front != largest) merge(fronts, largest, front);
    }
    return largest;
}

// Takes SITE out of the front, and its links into fronts->row.
static void extract_row(struct kron_fronts *fronts, int front_index, int site)
{
    struct front *front = &fronts->front[front_index];
    while (fronts->row_capacity < front->n)
        GROW_ARRAY(fronts->row, fronts->row_capacity, fronts->row_capacity);
    const int place =
        fronts->membership[membership_of(fronts, site, front_index)].place;
    dense_front_take_row(&front->dense, front->n, place, fronts->row);
    remove_member(fronts, front_index, place);
    fronts->row[place] = fronts->row[front->n];
}

// Eight partial sums, which vectors add at once.
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

static void enlarge(const struct kron_fronts *fronts, struct front *front)
{
    dense_front_enlarge(&front->dense, front->n, fronts->is_rounded);
    air_find_places(front);
}

void kron_fronts_eliminate(struct kron_fronts *fronts, int site)
{
    const double air = air_links_take(&fronts->air, site);
    const int front_index = merge_fronts(fronts, site);
    if (front_index < 0) {
        air_links_lower(&fronts->air, air);
        return;
    }
    extract_row(fronts, front_index, site);
    struct front *front = &fronts->front[front_index];
    const double total = air + sum_of(fronts->row, front->n);
    if (total > 0) {
        dense_front_add_products(&front->dense, front->n, 1 / total, fronts->row);
        if (!front->dense.is_large && front->n > LARGE_FRONT) enlarge(fronts, front);
        if (air > 0) air_raise(fronts, front, air / total);
    }
    if (air > 0) air_links_lower(&fronts->air, air * (air / total));
    if (front->n == 1) { // a dead end
        remove_membership(fronts, front->site[0], front_index);
        front->n = 0;
    }
    if (front->n == 0) release_front(fronts, front_index);
}

// --- state -------------------------------------------------------------------------

static void front_state(const struct kron_fronts *fronts, struct front *front,
                        struct checkpoint_stream *stream)
{
    stream_integer(stream, &front->n, 0, fronts->n_site);
    stream_integer(stream, &front->next_unused, -1, fronts->n_front - 1);
    if (stream->restoring) {
        front->capacity = front->n;
        front->site = NEW_ARRAY(int, front->n);
    }
    stream_integers(stream, front->site, front->n, 0, fronts->n_site - 1);
    dense_front_state(&front->dense, front->n, fronts->is_rounded, stream);
    if (stream->restoring && front->dense.is_large) air_find_places(front);
}

static void fronts_state(struct kron_fronts *fronts, struct checkpoint_stream *stream)
{
    int64_t n = fronts->n_front;
    if (stream->restoring)
        for (int f = 0; f < fronts->n_front; f++)
            empty_front(&fronts->front[f]);
    stream_count(stream, &n);
    fronts->front = stream_room(stream, fronts->front, n, sizeof *fronts->front);
    if (stream->restoring) {
        memset(fronts->front, 0, (size_t)n * sizeof *fronts->front);
        fronts->n_front = fronts->front_capacity = (int)n;
    }
    stream_integer(stream, &fronts->unused_front, -1, (int)n - 1);
    for (int f = 0; f < fronts->n_front; f++)
        front_state(fronts, &fronts->front[f], stream);
}

static void memberships_state(struct kron_fronts *fronts,
                              struct checkpoint_stream *stream)
{
    int64_t n = fronts->n_membership;
    stream_count(stream, &n);
    fronts->membership =
        stream_room(stream, fronts->membership, n, sizeof *fronts->membership);
    if (stream->restoring) fronts->n_membership = fronts->membership_capacity = (int)n;
    stream_integer(stream, &fronts->unused_membership, -1, (int)n - 1);
    stream_integers(stream, fronts->first, fronts->n_site, -1, (int)n - 1);
    for (int k = 0; k < fronts->n_membership; k++) {
        stream_integer(stream, &fronts->membership[k].front, 0, fronts->n_front - 1);
        stream_integer(stream, &fronts->membership[k].place, 0, fronts->n_site - 1);
        stream_integer(stream, &fronts->membership[k].next, -1, (int)n - 1);
    }
}

void kron_fronts_state(struct kron_fronts *fronts, struct checkpoint_stream *stream)
{
    air_links_state(&fronts->air, stream);
    fronts_state(fronts, stream);
    memberships_state(fronts, stream);
}
