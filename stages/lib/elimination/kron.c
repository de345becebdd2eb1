// SPDX-License-Identifier: GPL-3.0-or-later
// Kron reduction in sparse rows. Eliminating node i with conductances c_ij:
//     share_j = c_ij / sum_l c_il,
//     c_jk += share_j c_ik           (join_mesh, both c_jk and c_kj),
//     extracted_j += share_j extracted_i.
// All numbers are positive, so nothing cancels. Rows of eliminated nodes stay as they
// were at their elimination; kron_potentials uses them backwards,
//     potential_i = (sum_l c_il potential_l - extracted_i) / sum_l c_il.
// The node with the fewest neighbours goes first: a search over all, for small
// networks.
#include "kron.h"

#include "basics/memory.h"

#include <stdlib.h>

struct kron_link {
    int site;
    double conductance;
};

// Links of a site; those of an eliminated node stay as they were then.
struct kron_row {
    int n, capacity;
    struct kron_link *link;
};

void kron_begin(struct kron *kron, int n_node, int n_end)
{
    const int n = n_node + n_end, before = kron->capacity;
    kron->n_node = n_node;
    kron->n_end = n_end;
    if (n > before) {
        kron->capacity = n + n / 2;
        const size_t size = (size_t)kron->capacity;
        kron->row = reallocate(kron->row, size, sizeof *kron->row);
        kron->extracted = reallocate(kron->extracted, size, sizeof *kron->extracted);
        kron->place = reallocate(kron->place, size, sizeof *kron->place);
        kron->order = reallocate(kron->order, size, sizeof *kron->order);
        for (int i = before; i < kron->capacity; i++) {
            kron->row[i] = (struct kron_row){0};
            kron->place[i] = -1;
        }
    }
    for (int i = 0; i < n; i++) {
        kron->row[i].n = 0;
        kron->extracted[i] = 0;
    }
}

void kron_free(struct kron *kron)
{
    for (int i = 0; i < kron->capacity; i++)
        free(kron->row[i].link);
    free(kron->row);
    free(kron->extracted);
    free(kron->place);
    free(kron->order);
    *kron = (struct kron){0};
}

static void append(struct kron_row *row, int site, double conductance)
{
    if (row->n == row->capacity) {
        row->capacity = row->capacity ? 2 * row->capacity : 8;
        row->link = reallocate(row->link, (size_t)row->capacity, sizeof *row->link);
    }
    row->link[row->n++] = (struct kron_link){site, conductance};
}

static void add(struct kron_row *row, int site, double conductance)
{
    for (int k = 0; k < row->n; k++)
        if (row->link[k].site == site) {
            row->link[k].conductance += conductance;
            return;
        }
    append(row, site, conductance);
}

void kron_link(struct kron *kron, int a, int b, double conductance)
{
    if (a == b) return;
    add(&kron->row[a], b, conductance);
    add(&kron->row[b], a, conductance);
}

void kron_extract(struct kron *kron, int site, double rate)
{
    kron->extracted[site] += rate;
}

// --- elimination ---------------------------------------------------------------------

static void forget(struct kron_row *row, int site)
{
    int k = 0;
    while (row->link[k].site != site)
        k++;
    row->link[k] = row->link[--row->n];
}

// Adds to neighbour J of the star its part of the mesh.
static void join_mesh(struct kron *kron, const struct kron_row *star, int j,
                      double share)
{
    struct kron_row *row = &kron->row[star->link[j].site];
    for (int k = 0; k < row->n; k++)
        kron->place[row->link[k].site] = k;
    for (int k = 0; k < star->n; k++) {
        const int site = star->link[k].site;
        const double conductance = share * star->link[k].conductance;
        if (k == j) continue;
        if (kron->place[site] >= 0)
            row->link[kron->place[site]].conductance += conductance;
        else
            append(row, site, conductance);
    }
    for (int k = 0; k < row->n; k++)
        kron->place[row->link[k].site] = -1;
}

static double all_conductances(const struct kron_row *row)
{
    double sum = 0;
    for (int k = 0; k < row->n; k++)
        sum += row->link[k].conductance;
    return sum;
}

static void eliminate(struct kron *kron, int node)
{
    const struct kron_row *star = &kron->row[node];
    const double sum = all_conductances(star);
    for (int j = 0; j < star->n; j++) {
        const double share = star->link[j].conductance / sum;
        forget(&kron->row[star->link[j].site], node);
        kron->extracted[star->link[j].site] += share * kron->extracted[node];
        join_mesh(kron, star, j, share);
    }
}

void kron_eliminate(struct kron *kron)
{
    const int n = kron->n_node;
    int *left = kron->order;
    for (int i = 0; i < n; i++)
        left[i] = i;
    for (int k = 0; k < n; k++) {
        int least = k;
        for (int l = k + 1; l < n; l++)
            if (kron->row[left[l]].n < kron->row[left[least]].n) least = l;
        const int node = left[least];
        left[least] = left[k];
        left[k] = node;
        eliminate(kron, node);
    }
}

// --- what comes of it ----------------------------------------------------------------

double kron_flow(const struct kron *kron, int a,
                 double (*drop)(const void *context, int b, int a), const void *context)
{
    const struct kron_row *row = &kron->row[kron->n_node + a];
    double flow = -kron->extracted[kron->n_node + a];
    for (int k = 0; k < row->n; k++)
        flow += row->link[k].conductance *
                drop(context, row->link[k].site - kron->n_node, a);
    return flow;
}

void kron_potentials(const struct kron *kron, double *potential)
{
    for (int k = kron->n_node - 1; k >= 0; k--) {
        const int node = kron->order[k];
        const struct kron_row *row = &kron->row[node];
        double sum = -kron->extracted[node];
        for (int l = 0; l < row->n; l++)
            sum += row->link[l].conductance * potential[row->link[l].site];
        potential[node] = sum / all_conductances(row);
    }
}
