// SPDX-License-Identifier: GPL-3.0-or-later
#include "loose_mesh.h"

#include "basics/memory.h"
#include "sheet.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// A front of more sites than this is a sheet, with its links in blocks.
enum { LARGE_FRONT = 96 };

struct membership {
    int front;
    int place; // on the front
    int next;  // of the site, or of those unused; -1: the last
};

// Small: a triangle, the link of places i > j at i(i-1)/2 + j.
struct front {
    bool is_large;
    int n; // sites
    int capacity;
    int *site; // (n) if small
    double *triangle;
    size_t triangle_capacity;
    struct sheet sheet;
    int next_unused;
};

static size_t triangle_size(int n)
{
    return n > 0 ? (size_t)n * (size_t)(n - 1) / 2 : 0;
}

struct loose_mesh loose_mesh_make(int n_site, const int *key, double threshold,
                                  double report)
{
    struct loose_mesh mesh = {.n_site = n_site,
                              .key = key,
                              .threshold = threshold,
                              .report = report,
                              .elsewhere = NEW_ARRAY(double, n_site),
                              .reported = NEW_ARRAY(double, n_site),
                              .air = NEW_ARRAY(double, n_site),
                              .first = NEW_ARRAY(int, n_site),
                              .changed = NEW_ARRAY(int, n_site),
                              .is_changed = NEW_ARRAY(bool, n_site),
                              .unused_membership = -1,
                              .unused_front = -1,
                              .scale = 1};
    for (int i = 0; i < n_site; i++)
        mesh.first[i] = -1;
    return mesh;
}

static void empty_front(struct front *front)
{
    free(front->site);
    free(front->triangle);
    sheet_free(&front->sheet);
    *front = (struct front){0};
}

void loose_mesh_free(struct loose_mesh *mesh)
{
    for (int f = 0; f < mesh->n_front; f++)
        empty_front(&mesh->front[f]);
    free(mesh->air);
    free(mesh->first);
    free(mesh->membership);
    free(mesh->front);
    free(mesh->changed);
    free(mesh->is_changed);
    free(mesh->row);
    free(mesh->elsewhere);
    free(mesh->reported);
    free(mesh->left_out);
    *mesh = (struct loose_mesh){0};
}

// --- who is on which front ---------------------------------------------------------

static int new_front(struct loose_mesh *mesh)
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

static void end_front(struct loose_mesh *mesh, int front)
{
    empty_front(&mesh->front[front]);
    mesh->front[front].next_unused = mesh->unused_front;
    mesh->unused_front = front;
}

static void join(struct loose_mesh *mesh, int site, int front, int place)
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

static void leave(struct loose_mesh *mesh, int site, int front)
{
    int *link = &mesh->first[site];
    while (mesh->membership[*link].front != front)
        link = &mesh->membership[*link].next;
    const int membership = *link;
    *link = mesh->membership[membership].next;
    mesh->membership[membership].next = mesh->unused_membership;
    mesh->unused_membership = membership;
}

// Where it is noted; NULL if the site is not on the front.
static int *place_on(const struct loose_mesh *mesh, int site, int front)
{
    for (int k = mesh->first[site]; k >= 0; k = mesh->membership[k].next)
        if (mesh->membership[k].front == front) return &mesh->membership[k].place;
    return NULL;
}

// --- a front, small or large -------------------------------------------------------

// Places go from 0 to here.
static int n_places(const struct front *front)
{
    return front->is_large ? sheet_places(&front->sheet) : front->n;
}

// At a place; -1: none.
static int site_at(const struct front *front, int place)
{
    if (!front->is_large) return front->site[place];
    return place % PATCH < front->sheet.count[place / PATCH] ? front->sheet.site[place]
                                                             : -1;
}

static int add_to_triangle(struct front *front, int site)
{
    if (front->n == front->capacity) {
        front->capacity = front->capacity ? front->capacity + front->capacity / 2 : 4;
        front->site =
            reallocate(front->site, (size_t)front->capacity, sizeof *front->site);
    }
    const size_t before = triangle_size(front->n), after = triangle_size(front->n + 1);
    if (after > front->triangle_capacity) {
        front->triangle_capacity = after + after / 2;
        front->triangle = reallocate(front->triangle, front->triangle_capacity,
                                     sizeof *front->triangle);
    }
    for (size_t k = before; k < after; k++)
        front->triangle[k] = 0;
    front->site[front->n] = site;
    return front->n;
}

// SITE comes onto the front, without links. Returns its place.
static int add_member(struct loose_mesh *mesh, int front_index, int site)
{
    struct front *front = &mesh->front[front_index];
    const int place = front->is_large ? sheet_add(&front->sheet, site, mesh->key[site])
                                      : add_to_triangle(front, site);
    front->n++;
    join(mesh, site, front_index, place);
    return place;
}

static double *triangle_link(const struct front *front, int p, int q)
{
    const int high = p > q ? p : q, low = p > q ? q : p;
    return front->triangle + triangle_size(high) + low;
}

static void add_link(struct front *front, int p, int q, double conductance)
{
    if (front->is_large)
        sheet_link(&front->sheet, p, q, conductance);
    else
        *triangle_link(front, p, q) += conductance;
}

// The links of place P, by place.
static void take_row(struct front *front, int p, double *row)
{
    if (front->is_large) {
        sheet_row(&front->sheet, p, row);
        return;
    }
    for (int i = 0; i < front->n; i++)
        row[i] = i == p ? 0 : *triangle_link(front, i, p);
}

// The site at place P leaves; another may take its place, also in the row.
static void remove_member(struct loose_mesh *mesh, int front_index, int p, double *row)
{
    struct front *front = &mesh->front[front_index];
    leave(mesh, site_at(front, p), front_index);
    front->n--;
    if (front->is_large) {
        if (sheet_remove(&front->sheet, p, row) != p)
            *place_on(mesh, front->sheet.site[p], front_index) = p;
        return;
    }
    const int last = front->n;
    if (p == last) return;
    row[p] = row[last];
    front->site[p] = front->site[last];
    *place_on(mesh, front->site[p], front_index) = p;
    for (int i = 0; i < last; i++)
        if (i != p) *triangle_link(front, i, p) = *triangle_link(front, i, last);
}

// Links all members in proportion to the products of their entries in the row.
static void add_products(struct loose_mesh *mesh, struct front *front,
                         const double *row, double factor)
{
    if (front->is_large) {
        while (mesh->left_out_capacity < front->sheet.n_patch)
            GROW_ARRAY(mesh->left_out, mesh->left_out_capacity,
                       mesh->left_out_capacity);
        sheet_add_products(&front->sheet, row, factor, mesh->left_out);
        return;
    }
    for (int i = 1; i < front->n; i++) {
        double *restrict to = front->triangle + triangle_size(i);
        const double share = factor * row[i];
        for (int j = 0; j < i; j++)
            to[j] += share * row[j];
    }
}

// --- links -------------------------------------------------------------------------

void loose_mesh_link(struct loose_mesh *mesh, int a, int b, double conductance)
{
    const int front = new_front(mesh);
    add_member(mesh, front, a);
    add_member(mesh, front, b);
    add_link(&mesh->front[front], 0, 1, conductance);
}

static void sum_air(struct loose_mesh *mesh)
{
    mesh->all_air = (struct compensated){0};
    for (int i = 0; i < mesh->n_site; i++)
        compensated_add(&mesh->all_air, mesh->air[i]);
    mesh->summed_air = compensated_value(mesh->all_air);
    mesh->all_reported = (struct compensated){0};
    for (int i = 0; i < mesh->n_site; i++)
        compensated_add(&mesh->all_reported, mesh->reported[i]);
}

// Digits are lost only when little is left of a large sum: then it is summed anew.
static void lower_air(struct loose_mesh *mesh, double fall)
{
    compensated_add(&mesh->all_air, -fall);
    if (compensated_value(mesh->all_air) < 0.5 * mesh->summed_air) sum_air(mesh);
}

// --- the air -----------------------------------------------------------------------

static void note_change(struct loose_mesh *mesh, int site)
{
    compensated_add(&mesh->all_reported, mesh->air[site] - mesh->reported[site]);
    mesh->reported[site] = mesh->air[site];
    if (!mesh->is_changed[site]) mesh->changed[mesh->n_changed++] = site;
    mesh->is_changed[site] = true;
}

void loose_mesh_link_air(struct loose_mesh *mesh, int site, double conductance)
{
    mesh->air[site] += conductance;
    compensated_add(&mesh->all_air, conductance);
    note_change(mesh, site);
    mesh->summed_air = fmax(mesh->summed_air, compensated_value(mesh->all_air));
}

void loose_mesh_begin_air(struct loose_mesh *mesh)
{
    mesh->all_air = mesh->all_reported = (struct compensated){0};
    mesh->lost = 0;
    mesh->scale = 1;
    for (int f = 0; f < mesh->n_front; f++)
        for (int a = 0; a < mesh->front[f].sheet.n_patch; a++)
            mesh->front[f].sheet.unreported[a] = 0;
}

void loose_mesh_put_air(struct loose_mesh *mesh, int site, double conductance)
{
    const bool is_shut_in = mesh->air[site] == 0 && mesh->elsewhere[site] == 0;
    conductance = is_shut_in ? 0 : fmax(0, conductance);
    if (mesh->air[site] != conductance || mesh->reported[site] != conductance) {
        mesh->air[site] = mesh->reported[site] = conductance;
        note_change(mesh, site);
    }
    compensated_add(&mesh->all_air, conductance);
    compensated_add(&mesh->all_reported, conductance);
}

void loose_mesh_end_air(struct loose_mesh *mesh, double rate)
{
    mesh->summed_air = compensated_value(mesh->all_air);
    if (mesh->summed_air > 0) mesh->scale = rate / mesh->summed_air;
}

double loose_mesh_rate(const struct loose_mesh *mesh)
{
    return compensated_value(mesh->all_air) * mesh->scale;
}

double loose_mesh_air(const struct loose_mesh *mesh, int site)
{
    return mesh->reported[site];
}

double loose_mesh_scale(const struct loose_mesh *mesh)
{
    return loose_mesh_rate(mesh) / compensated_value(mesh->all_reported);
}

// SITE with its conductance to the AIR, of all it had, TOTAL, is gone. The sum of all
// to the air falls in truth by what went back there, and what is known of it also by
// what went elsewhere.
static void lose_air(struct loose_mesh *mesh, int site, double air, double total)
{
    const double back = air * (air / total);
    const double elsewhere = air * (mesh->elsewhere[site] / total);
    const double truth = loose_mesh_rate(mesh) - mesh->scale * mesh->scale * back;
    compensated_add(&mesh->all_reported, -mesh->reported[site]);
    mesh->reported[site] = mesh->elsewhere[site] = 0;
    mesh->lost += elsewhere;
    lower_air(mesh, back + elsewhere);
    const double known = compensated_value(mesh->all_air);
    mesh->scale = known > 0 ? truth / known : 1;
}

// --- elimination -------------------------------------------------------------------

static double *room_for_row(struct loose_mesh *mesh, int n)
{
    while (mesh->row_capacity < n)
        GROW_ARRAY(mesh->row, mesh->row_capacity, mesh->row_capacity);
    return mesh->row;
}

// The members of front OTHER become members of BASE.
static void merge(struct loose_mesh *mesh, int base_index, int other_index)
{
    const struct front *other = &mesh->front[other_index];
    const int n = n_places(other);
    int *place = NEW_ARRAY(int, n);
    for (int i = 0; i < n; i++) {
        const int site = site_at(other, i);
        if (site < 0) continue;
        leave(mesh, site, other_index);
        if (other->is_large) note_change(mesh, site);
        const int *on_base = place_on(mesh, site, base_index);
        place[i] = on_base ? *on_base : add_member(mesh, base_index, site);
    }
    double *row = room_for_row(mesh, n);
    for (int i = 1; i < n; i++) {
        if (site_at(other, i) < 0) continue;
        take_row(&mesh->front[other_index], i, row);
        for (int j = 0; j < i; j++)
            if (row[j] > 0)
                add_link(&mesh->front[base_index], place[i], place[j], row[j]);
    }
    end_front(mesh, other_index);
    free(place);
}

// All fronts that SITE is on, as one: the largest with what the others add.
static int merge_fronts(struct loose_mesh *mesh, int site)
{
    int largest = -1, n = 0;
    for (int k = mesh->first[site]; k >= 0; k = mesh->membership[k].next) {
        const int front = mesh->membership[k].front;
        n += mesh->front[front].n;
        if (largest < 0 || mesh->front[front].n > mesh->front[largest].n)
            largest = front;
    }
    if (largest >= 0 && n > LARGE_FRONT && !mesh->front[largest].is_large) {
        largest = new_front(mesh);
        mesh->front[largest].is_large = true;
        mesh->front[largest].sheet = sheet_make(mesh->threshold);
    }
    for (int k = mesh->first[site]; k >= 0;) {
        const int front = mesh->membership[k].front;
        k = mesh->membership[k].next;
        if (front != largest) merge(mesh, largest, front);
    }
    return largest;
}

// What flowed to the eliminated site flows on into the air. Of a front with a
// threshold, changes are reported patch by patch.
static void raise_air(struct loose_mesh *mesh, struct front *front, const double *row,
                      double share)
{
    const bool in_patches = front->is_large;
    const double much =
        in_patches ? mesh->report * loose_mesh_rate(mesh) / front->sheet.n_patch : 0;
    for (int i = 0; i < n_places(front); i++) {
        if (!(row[i] > 0)) continue;
        const int site = site_at(front, i);
        mesh->air[site] += row[i] * share;
        if (in_patches)
            front->sheet.unreported[i / PATCH] += row[i] * share;
        else
            note_change(mesh, site);
    }
    for (int a = 0; in_patches && a < front->sheet.n_patch; a++) {
        if (!(front->sheet.unreported[a] > much)) continue;
        front->sheet.unreported[a] = 0;
        for (int i = 0; i < front->sheet.count[a]; i++)
            note_change(mesh, front->sheet.site[PATCH * a + i]);
    }
}

// What is left out of large fronts, and what the site had elsewhere.
static void raise_elsewhere(struct loose_mesh *mesh, const struct front *front,
                            const double *row, double share)
{
    for (int i = 0; i < n_places(front); i++)
        if (row[i] > 0)
            mesh->elsewhere[site_at(front, i)] +=
                row[i] * (share + (front->is_large ? mesh->left_out[i / PATCH] : 0));
}

void loose_mesh_eliminate(struct loose_mesh *mesh, int site)
{
    const double air = mesh->air[site];
    const double elsewhere = mesh->elsewhere[site];
    mesh->air[site] = 0;
    const int front_index = merge_fronts(mesh, site);
    if (front_index < 0) {
        if (air > 0) lose_air(mesh, site, air, air + elsewhere);
        return;
    }
    struct front *front = &mesh->front[front_index];
    double *row = room_for_row(mesh, n_places(front));
    const int place = *place_on(mesh, site, front_index);
    take_row(front, place, row);
    remove_member(mesh, front_index, place, row);
    double total = air + elsewhere;
    for (int i = 0; i < n_places(front); i++)
        total += row[i];
    if (total > 0) {
        add_products(mesh, front, row, 1 / total);
        if (air > 0) raise_air(mesh, front, row, air / total);
        raise_elsewhere(mesh, front, row, elsewhere / total);
    }
    if (air > 0) lose_air(mesh, site, air, total);
    if (front->n == 1) { // a dead end
        for (int i = 0; i < n_places(front); i++)
            if (site_at(front, i) >= 0) {
                note_change(mesh, site_at(front, i));
                leave(mesh, site_at(front, i), front_index);
            }
        front->n = 0;
    }
    if (front->n == 0) end_front(mesh, front_index);
}

void loose_mesh_forget_changes(struct loose_mesh *mesh)
{
    for (int k = 0; k < mesh->n_changed; k++)
        mesh->is_changed[mesh->changed[k]] = false;
    mesh->n_changed = 0;
}
