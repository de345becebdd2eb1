// SPDX-License-Identifier: GPL-3.0-or-later
// The remaining network, link by link, and the flow through it:
//     flow_j += sum over links of c_jk (level_k - level_j),  flow_k gets the opposite.
// Each link adds to both ends with one product, so the flows of all sites cancel to
// rounding. Sites may be linked on several fronts; such links are summed.
#include "kron_fronts.h"

#include "basics/memory.h"
#include "kron_fronts_internal.h"

#include <stdlib.h>

void kron_fronts_flush(struct kron_fronts *fronts, int site)
{
    for (int k = fronts->first[site]; k >= 0; k = fronts->membership[k].next) {
        struct front *front = &fronts->front[fronts->membership[k].front];
        dense_front_flush(&front->dense, front->n);
    }
}

// Fronts of two sites are listed as pairs: most are, and they lie far apart in memory.
void kron_fronts_list(struct kron_fronts *fronts)
{
    fronts->n_pair = fronts->n_wide = fronts->widest = 0;
    for (int f = 0; f < fronts->n_front; f++) {
        struct front *front = &fronts->front[f];
        if (front->n == 2) {
            GROW_ARRAY(fronts->pair, fronts->n_pair, fronts->pair_capacity);
            fronts->pair[fronts->n_pair++] = (struct pair){
                front->site[0], front->site[1], dense_front_entry(&front->dense, 1, 0)};
        } else if (front->n > 2) {
            dense_front_flush(&front->dense, front->n);
            GROW_ARRAY(fronts->wide, fronts->n_wide, fronts->wide_capacity);
            fronts->wide[fronts->n_wide++] = f;
            if (front->n > fronts->widest) fronts->widest = front->n;
        }
    }
}

// Flow over N links to one site with potential HERE; subtracted from FLOW (n) of the
// others. Partial sums, so that the compiler can use one register for them.
static double add_row_flows(const double *restrict link, int n,
                            const double *restrict level, double here,
                            double *restrict flow)
{
    enum { PARTIAL_SUMS = 4 };
    double part[PARTIAL_SUMS] = {0}, sum = 0;
    int i = 0;
    for (; i + PARTIAL_SUMS <= n; i += PARTIAL_SUMS)
        for (int l = 0; l < PARTIAL_SUMS; l++) {
            const double through = link[i + l] * (level[i + l] - here);
            part[l] += through;
            flow[i + l] -= through;
        }
    for (; i < n; i++) {
        const double through = link[i] * (level[i] - here);
        sum += through;
        flow[i] -= through;
    }
    for (int l = 0; l < PARTIAL_SUMS; l++)
        sum += part[l];
    return sum;
}

static void add_front_flows(const struct front *front, const double *level,
                            double *flow, double *n_entries)
{
    const int n = front->n;
    double *here = n_entries, *gain = n_entries + n;
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

void kron_fronts_add_flows(const struct kron_fronts *fronts, const double *level,
                           double *flow)
{
    for (int p = 0; p < fronts->n_pair; p++) {
        const struct pair *pair = &fronts->pair[p];
        const double through = pair->conductance * (level[pair->a] - level[pair->b]);
        flow[pair->a] -= through;
        flow[pair->b] += through;
    }
    double *n_entries = NEW_ARRAY(double, 2 * fronts->widest);
    for (int f = 0; f < fronts->n_wide; f++)
        add_front_flows(&fronts->front[fronts->wide[f]], level, flow, n_entries);
    free(n_entries);
}

int kron_fronts_list_links(const struct kron_fronts *fronts, int site, int *other,
                           double *link)
{
    int n = 0;
    for (int k = fronts->first[site]; k >= 0; k = fronts->membership[k].next) {
        const struct front *front = &fronts->front[fronts->membership[k].front];
        const int p = fronts->membership[k].place;
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
