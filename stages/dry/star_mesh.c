// SPDX-License-Identifier: GPL-3.0-or-later
#include "star_mesh.h"

#include "basics/memory.h"
#include "triangle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// On a front that has been larger than this, what eliminations add waits until there
// are many, and then passes over the triangle once for all.
enum { LARGE_FRONT = 96 };

struct membership {
    int front;
    int next; // of the site, or of those unused; -1: the last
};

struct front {
    int n, capacity;
    int *site;                // (n)
    struct triangle triangle; // of their links
    int n_waiting;
    double *waiting; // (n_waiting) rows of CAPACITY: what eliminated sites had
    double factor[MOST_SOURCES]; // of the product of two entries of a row
    int next_unused;
};

// The more wait, the fewer passes over the triangle, and the more to add to each row
// that is taken.
static int most_sources(int n)
{
    const int most = n / 16;
    return most < 8 ? 8 : most < MOST_SOURCES ? most : MOST_SOURCES;
}

static double *waiting_row(const struct front *front, int k)
{
    return front->waiting + (size_t)k * (size_t)front->capacity;
}

struct star_mesh star_mesh_make(int n_site, bool is_rounded)
{
    struct star_mesh mesh = {.n_site = n_site,
                             .is_rounded = is_rounded,
                             .air = NEW_ARRAY(double, n_site),
                             .first = NEW_ARRAY(int, n_site),
                             .place = NEW_ARRAY(int, n_site),
                             .linked = NEW_ARRAY(int, n_site),
                             .unused_membership = -1,
                             .unused_front = -1};
    for (int i = 0; i < n_site; i++)
        mesh.first[i] = mesh.place[i] = -1;
    return mesh;
}

static void empty_front(struct front *front)
{
    free(front->site);
    triangle_free(&front->triangle);
    free(front->waiting);
    *front = (struct front){0};
}

void star_mesh_free(struct star_mesh *mesh)
{
    for (int f = 0; f < mesh->n_front; f++)
        empty_front(&mesh->front[f]);
    free(mesh->air);
    free(mesh->first);
    free(mesh->membership);
    free(mesh->front);
    free(mesh->linked);
    free(mesh->place);
    free(mesh->row);
    *mesh = (struct star_mesh){0};
}

// --- who is on which front ---------------------------------------------------------

static int new_front(struct star_mesh *mesh)
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

static void end_front(struct star_mesh *mesh, int front)
{
    empty_front(&mesh->front[front]);
    mesh->front[front].next_unused = mesh->unused_front;
    mesh->unused_front = front;
}

static void join(struct star_mesh *mesh, int site, int front)
{
    int membership = mesh->unused_membership;
    if (membership >= 0) {
        mesh->unused_membership = mesh->membership[membership].next;
    } else {
        GROW_ARRAY(mesh->membership, mesh->n_membership, mesh->membership_capacity);
        membership = mesh->n_membership++;
    }
    mesh->membership[membership] = (struct membership){front, mesh->first[site]};
    mesh->first[site] = membership;
}

static void leave(struct star_mesh *mesh, int site, int front)
{
    int *link = &mesh->first[site];
    while (mesh->membership[*link].front != front)
        link = &mesh->membership[*link].next;
    const int membership = *link;
    *link = mesh->membership[membership].next;
    mesh->membership[membership].next = mesh->unused_membership;
    mesh->unused_membership = membership;
}

static void widen(struct front *front)
{
    const int capacity = front->capacity ? front->capacity + front->capacity / 2 : 4;
    front->site = reallocate(front->site, (size_t)capacity, sizeof *front->site);
    if (front->waiting) {
        double *waiting = NEW_ARRAY(double, (size_t)MOST_SOURCES *(size_t)capacity);
        for (int k = 0; k < front->n_waiting; k++)
            memcpy(waiting + (size_t)k * (size_t)capacity, waiting_row(front, k),
                   (size_t)front->n * sizeof *waiting);
        free(front->waiting);
        front->waiting = waiting;
    }
    front->capacity = capacity;
}

// SITE comes last on the front, without links.
static void add_member(struct star_mesh *mesh, int front_index, int site)
{
    struct front *front = &mesh->front[front_index];
    join(mesh, site, front_index);
    if (front->n == front->capacity) widen(front);
    triangle_add_row(&front->triangle, front->n);
    for (int k = 0; k < front->n_waiting; k++)
        waiting_row(front, k)[front->n] = 0;
    front->site[front->n++] = site;
}

void star_mesh_link(struct star_mesh *mesh, int a, int b, double conductance)
{
    const int front = new_front(mesh);
    add_member(mesh, front, a);
    add_member(mesh, front, b);
    triangle_set(&mesh->front[front].triangle, 1, 0, conductance);
}

static void add_air(struct star_mesh *mesh, int site, double conductance)
{
    if (!(conductance > 0)) return;
    if (mesh->air[site] == 0) mesh->linked[mesh->n_linked++] = site;
    mesh->air[site] += conductance;
}

static void sum_air(struct star_mesh *mesh)
{
    mesh->all_air = (struct compensated){0};
    for (int i = 0; i < mesh->n_site; i++)
        compensated_add(&mesh->all_air, mesh->air[i]);
    mesh->summed_air = compensated_value(mesh->all_air);
}

// Digits are lost only when little is left of a large sum: then it is summed anew.
static void lower_air(struct star_mesh *mesh, double fall)
{
    compensated_add(&mesh->all_air, -fall);
    if (compensated_value(mesh->all_air) < 0.5 * mesh->summed_air) sum_air(mesh);
}

void star_mesh_link_air(struct star_mesh *mesh, int site, double conductance)
{
    add_air(mesh, site, conductance);
    compensated_add(&mesh->all_air, conductance);
    mesh->summed_air = fmax(mesh->summed_air, compensated_value(mesh->all_air));
}

// --- the triangle ------------------------------------------------------------------

// What has waited is added to the triangle.
static void bring_up_to_date(struct front *front)
{
    if (front->n_waiting == 0) return;
    const double *source[MOST_SOURCES];
    for (int k = 0; k < front->n_waiting; k++)
        source[k] = waiting_row(front, k);
    triangle_update(&front->triangle, front->n, front->n_waiting, front->factor,
                    source);
    front->n_waiting = 0;
}

// Adds WEIGHT times rows that wait, from row K on, to ROW: in fours, which read and
// write it once.
static void add_rows(double *restrict row, const struct front *front, int k,
                     const double *weight)
{
    const double *a = waiting_row(front, k), *b = waiting_row(front, k + 1);
    const double *c = waiting_row(front, k + 2), *d = waiting_row(front, k + 3);
    for (int i = 0; i < front->n; i++)
        row[i] += (weight[k] * a[i] + weight[k + 1] * b[i]) +
                  (weight[k + 2] * c[i] + weight[k + 3] * d[i]);
}

// The links of member P, what waits included.
static void take_row(const struct front *front, int p, double *row)
{
    double weight[MOST_SOURCES];
    triangle_take(&front->triangle, front->n, p, row);
    for (int k = 0; k < front->n_waiting; k++)
        weight[k] = front->factor[k] * waiting_row(front, k)[p];
    int k = 0;
    for (; k + 4 <= front->n_waiting; k += 4)
        add_rows(row, front, k, weight);
    for (; k < front->n_waiting; k++)
        for (int i = 0; i < front->n; i++)
            row[i] += weight[k] * waiting_row(front, k)[i];
    row[p] = 0;
}

// The last member takes the place of member P.
static void remove_member(struct star_mesh *mesh, struct front *front, int p)
{
    triangle_remove(&front->triangle, front->n, p);
    const int last = --front->n;
    mesh->row[p] = mesh->row[last];
    for (int k = 0; k < front->n_waiting; k++)
        waiting_row(front, k)[p] = waiting_row(front, k)[last];
    front->site[p] = front->site[last];
}

// Links all members in proportion to the products of their entries in the row.
static void add_mesh(struct front *front, const double *row, double factor,
                     bool is_rounded)
{
    const int n = front->n;
    if (!front->triangle.is_large) {
        triangle_update(&front->triangle, n, 1, &factor, &row);
        if (n > LARGE_FRONT) triangle_enlarge(&front->triangle, n, is_rounded);
        return;
    }
    if (!front->waiting)
        front->waiting =
            NEW_ARRAY(double, (size_t)MOST_SOURCES *(size_t)front->capacity);
    front->factor[front->n_waiting] = factor;
    memcpy(waiting_row(front, front->n_waiting++), row, (size_t)n * sizeof *row);
    if (front->n_waiting >= most_sources(n)) bring_up_to_date(front);
}

// --- elimination -------------------------------------------------------------------

// The members of front OTHER become members of BASE, whose places are known.
static void merge(struct star_mesh *mesh, int base_index, int other_index)
{
    bring_up_to_date(&mesh->front[other_index]);
    for (int i = 0; i < mesh->front[other_index].n; i++) {
        const int site = mesh->front[other_index].site[i];
        leave(mesh, site, other_index);
        if (mesh->place[site] >= 0) continue;
        mesh->place[site] = mesh->front[base_index].n;
        add_member(mesh, base_index, site);
    }
    const struct front *other = &mesh->front[other_index];
    struct front *base = &mesh->front[base_index];
    for (int i = 1; i < other->n; i++) {
        const int p = mesh->place[other->site[i]];
        for (int j = 0; j < i; j++) {
            const int q = mesh->place[other->site[j]];
            const int high = p > q ? p : q, low = p > q ? q : p;
            triangle_set(&base->triangle, high, low,
                         triangle_entry(&base->triangle, high, low) +
                             triangle_entry(&other->triangle, i, j));
        }
    }
    end_front(mesh, other_index);
}

// All fronts that SITE is on, as one: the largest with what the others add.
static int merge_fronts(struct star_mesh *mesh, int site)
{
    int largest = -1;
    for (int k = mesh->first[site]; k >= 0; k = mesh->membership[k].next) {
        const int front = mesh->membership[k].front;
        if (largest < 0 || mesh->front[front].n > mesh->front[largest].n)
            largest = front;
    }
    if (largest < 0) return -1;
    for (int i = 0; i < mesh->front[largest].n; i++)
        mesh->place[mesh->front[largest].site[i]] = i;
    for (int k = mesh->first[site]; k >= 0;) {
        const int front = mesh->membership[k].front;
        k = mesh->membership[k].next;
        if (front != largest) merge(mesh, largest, front);
    }
    return largest;
}

// What flowed to the eliminated site flows on into the air.
static void raise_air(struct star_mesh *mesh, const struct front *front, double share)
{
    for (int i = 0; i < front->n; i++)
        add_air(mesh, front->site[i], mesh->row[i] * share);
}

void star_mesh_eliminate(struct star_mesh *mesh, int site)
{
    const double air = mesh->air[site];
    mesh->air[site] = 0;
    const int front_index = merge_fronts(mesh, site);
    if (front_index < 0) {
        lower_air(mesh, air);
        return;
    }
    struct front *front = &mesh->front[front_index];
    while (mesh->row_capacity < front->n)
        GROW_ARRAY(mesh->row, mesh->row_capacity, mesh->row_capacity);

    const int place = mesh->place[site];
    take_row(front, place, mesh->row);
    for (int i = 0; i < front->n; i++)
        mesh->place[front->site[i]] = -1;
    leave(mesh, site, front_index);
    remove_member(mesh, front, place);
    double total = air;
    for (int i = 0; i < front->n; i++)
        total += mesh->row[i];
    if (total > 0) {
        add_mesh(front, mesh->row, 1 / total, mesh->is_rounded);
        if (air > 0) raise_air(mesh, front, air / total);
    }
    if (air > 0) lower_air(mesh, air * (air / total));
    if (front->n == 1) { // a dead end
        leave(mesh, front->site[0], front_index);
        front->n = 0;
    }
    if (front->n == 0) end_front(mesh, front_index);
}

// --- all links ---------------------------------------------------------------------

void star_mesh_bring_up_to_date(struct star_mesh *mesh)
{
    for (int f = 0; f < mesh->n_front; f++)
        bring_up_to_date(&mesh->front[f]);
}

void star_mesh_add_flows(const struct star_mesh *mesh, const double *level,
                         double *flow)
{
    for (int f = 0; f < mesh->n_front; f++) {
        const struct front *front = &mesh->front[f];
        for (int i = 1; i < front->n; i++) {
            const int site = front->site[i];
            double sum = 0;
            for (int j = 0; j < i; j++) {
                const double through = triangle_entry(&front->triangle, i, j) *
                                       (level[front->site[j]] - level[site]);
                sum += through;
                flow[front->site[j]] -= through;
            }
            flow[site] += sum;
        }
    }
}

int star_mesh_list_links(const struct star_mesh *mesh, int site, int *other,
                         double *link)
{
    int n = 0;
    for (int k = mesh->first[site]; k >= 0; k = mesh->membership[k].next) {
        const struct front *front = &mesh->front[mesh->membership[k].front];
        int p = 0;
        while (front->site[p] != site)
            p++;
        for (int i = 0; i < front->n; i++) {
            if (i == p) continue;
            const int at = front->site[i];
            const double more =
                triangle_entry(&front->triangle, i > p ? i : p, i > p ? p : i);
            if (link[at] == 0 && more > 0) other[n++] = at;
            link[at] += more;
        }
    }
    return n;
}

// --- state -------------------------------------------------------------------------

static void front_state(struct front *front, int n_site, int n_front,
                        struct state *state)
{
    state_integer(state, &front->n, 0, n_site);
    state_integer(state, &front->next_unused, -1, n_front - 1);
    state_integer(state, &front->n_waiting, 0, MOST_SOURCES);
    const size_t n = (size_t)front->n;
    state_flags(state, &front->triangle.is_large, 1);
    if (state->restoring) {
        front->capacity = front->n;
        front->site = NEW_ARRAY(int, n);
        if (front->n_waiting > 0)
            front->waiting = NEW_ARRAY(double, (size_t)MOST_SOURCES *n);
    }
    state_integers(state, front->site, front->n, 0, n_site - 1);
    for (int i = 0; i < front->n; i++) {
        if (state->restoring) triangle_add_row(&front->triangle, i);
        state_numbers(
            state, (double *)front->triangle.entry + triangle_row(&front->triangle, i),
            i);
    }
    state_numbers(state, front->factor, front->n_waiting);
    for (int k = 0; k < front->n_waiting; k++)
        state_numbers(state, waiting_row(front, k), front->n);
}

static void fronts_state(struct star_mesh *mesh, struct state *state)
{
    int64_t n = mesh->n_front;
    if (state->restoring)
        for (int f = 0; f < mesh->n_front; f++)
            empty_front(&mesh->front[f]);
    mesh->front = state_room(state, mesh->front, &n, sizeof *mesh->front);
    if (state->restoring) {
        memset(mesh->front, 0, (size_t)n * sizeof *mesh->front);
        mesh->n_front = mesh->front_capacity = (int)n;
    }
    state_integer(state, &mesh->unused_front, -1, (int)n - 1);
    for (int f = 0; f < mesh->n_front; f++)
        front_state(&mesh->front[f], mesh->n_site, mesh->n_front, state);
}

static void memberships_state(struct star_mesh *mesh, struct state *state)
{
    int64_t n = mesh->n_membership;
    mesh->membership =
        state_room(state, mesh->membership, &n, sizeof *mesh->membership);
    if (state->restoring) mesh->n_membership = mesh->membership_capacity = (int)n;
    state_integer(state, &mesh->unused_membership, -1, (int)n - 1);
    state_integers(state, mesh->first, mesh->n_site, -1, (int)n - 1);
    for (int k = 0; k < mesh->n_membership; k++) {
        state_integer(state, &mesh->membership[k].front, 0, mesh->n_front - 1);
        state_integer(state, &mesh->membership[k].next, -1, (int)n - 1);
    }
}

void star_mesh_state(struct star_mesh *mesh, struct state *state)
{
    state_numbers(state, mesh->air, mesh->n_site);
    state_sums(state, &mesh->all_air, 1);
    state_numbers(state, &mesh->summed_air, 1);
    fronts_state(mesh, state);
    memberships_state(mesh, state);
}
