// SPDX-License-Identifier: GPL-3.0-or-later
// What is left of a star mesh, link by link, and what flows through it.
#include "kron_fronts.h"

#include "basics/memory.h"
#include "kron_fronts_internal.h"

#include <stdlib.h>

void kron_fronts_bring_up_to_date(struct kron_fronts *mesh, int site)
{
    for (int k = mesh->first[site]; k >= 0; k = mesh->membership[k].next) {
        struct front *front = &mesh->front[mesh->membership[k].front];
        dense_front_bring_up_to_date(&front->dense, front->n);
    }
}

// Fronts of two sites come as pairs: most are, and far apart in memory.
void kron_fronts_list(struct kron_fronts *mesh)
{
    mesh->n_pair = mesh->n_wide = mesh->widest = 0;
    for (int f = 0; f < mesh->n_front; f++) {
        struct front *front = &mesh->front[f];
        if (front->n == 2) {
            GROW_ARRAY(mesh->pair, mesh->n_pair, mesh->pair_capacity);
            mesh->pair[mesh->n_pair++] = (struct pair){
                front->site[0], front->site[1], dense_front_entry(&front->dense, 1, 0)};
        } else if (front->n > 2) {
            dense_front_bring_up_to_date(&front->dense, front->n);
            GROW_ARRAY(mesh->wide, mesh->n_wide, mesh->wide_capacity);
            mesh->wide[mesh->n_wide++] = f;
            if (front->n > mesh->widest) mesh->widest = front->n;
        }
    }
}

// What flows over N links of one site that is at HERE; taken from FLOW (n) of the
// others. In lanes of their own, so that the compiler may keep them in one register.
static double add_row_flows(const double *restrict link, int n,
                            const double *restrict level, double here,
                            double *restrict flow)
{
    enum { LANES = 4 };
    double lane[LANES] = {0}, sum = 0;
    int i = 0;
    for (; i + LANES <= n; i += LANES)
        for (int l = 0; l < LANES; l++) {
            const double through = link[i + l] * (level[i + l] - here);
            lane[l] += through;
            flow[i + l] -= through;
        }
    for (; i < n; i++) {
        const double through = link[i] * (level[i] - here);
        sum += through;
        flow[i] -= through;
    }
    for (int l = 0; l < LANES; l++)
        sum += lane[l];
    return sum;
}

static void add_front_flows(const struct front *front, const double *level,
                            double *flow, double *room)
{
    const int n = front->n;
    double *here = room, *gain = room + n;
    for (int i = 0; i < n; i++) {
        here[i] = level[front->site[i]];
        gain[i] = 0;
    }
    for (int i = 1; i < n; i++)
        gain[i] += add_row_flows((const double *)front->dense.entry +
                                     dense_front_row(&front->dense, i),
                                 i, here, here[i], gain);
    for (int i = 0; i < n; i++)
        flow[front->site[i]] += gain[i];
}

void kron_fronts_add_flows(const struct kron_fronts *mesh, const double *level,
                           double *flow)
{
    for (int p = 0; p < mesh->n_pair; p++) {
        const struct pair *pair = &mesh->pair[p];
        const double through = pair->conductance * (level[pair->a] - level[pair->b]);
        flow[pair->a] -= through;
        flow[pair->b] += through;
    }
    double *room = NEW_ARRAY(double, 2 * mesh->widest);
    for (int f = 0; f < mesh->n_wide; f++)
        add_front_flows(&mesh->front[mesh->wide[f]], level, flow, room);
    free(room);
}

int kron_fronts_list_links(const struct kron_fronts *mesh, int site, int *other,
                           double *link)
{
    int n = 0;
    for (int k = mesh->first[site]; k >= 0; k = mesh->membership[k].next) {
        const struct front *front = &mesh->front[mesh->membership[k].front];
        const int p = mesh->membership[k].place;
        for (int i = 0; i < front->n; i++) {
            if (i == p) continue;
            const int at = front->site[i];
            const double more =
                dense_front_entry(&front->dense, i > p ? i : p, i > p ? p : i);
            if (link[at] == 0 && more > 0) other[n++] = at;
            link[at] += more;
        }
    }
    return n;
}
