// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact_solver_internal.h"

#include "return_mapping.h"

#include <math.h>
#include <string.h>

// Twist and bending are linear.
static void settle_moments(const struct entry *entry, const struct surroundings *s,
                           double x[3])
{
    double m[3][3], right[3];
    for (int k = 0; k < 3; k++) {
        right[k] = s->given[k];
        for (int l = 0; l < 3; l++)
            m[k][l] = (k == l) + s->compliance[k][l] * entry->slope[3 + l][0];
    }
    if (solve_three(m, right)) memcpy(x, right, sizeof right);
}

// Of strains FIRST to END - 1.
static struct surroundings around(const struct corrections *c,
                                  const struct entry *entry, int first, int end,
                                  const double from[STRAINS])
{
    struct surroundings s = {.given = {0}};
    memcpy(s.from, from + first, sizeof s.from);
    memcpy(s.load, entry->load + first, sizeof s.load);
    memcpy(s.tangent, c->tangent[entry->joint] + first, sizeof s.tangent);
    for (int k = 0; k < end - first; k++) {
        const int row = entry->row[first + k];
        s.given[k] = c->strain[row] - c->left[row];
        for (int l = 0; l < end - first; l++) {
            const int other = entry->row[first + l];
            s.compliance[k][l] = c->share * compliance_of(c, row)[other];
            s.given[k] += s.compliance[k][l] * c->more[other];
        }
    }
    return s;
}

// The strains of one from FIRST on, three at most, while the others push as they do.
static void settle(struct corrections *c, struct entry *entry, int first, double enough)
{
    const int count = entry->count - first < 3 ? entry->count - first : 3;
    const int *row = entry->row + first;
    double most = 0, before[3] = {0}, more[3], strain[3] = {0};
    for (int k = 0; k < count; k++) {
        most = fmax(most, fabs(c->left[row[k]]));
        before[k] = strain[k] = c->strain[row[k]];
        more[k] = c->more[row[k]];
    }
    if (most <= enough) return;
    const struct surroundings s =
        around(c, entry, first, first + count, c->from[entry->joint]);
    if (first == 0)
        settle_joint(&c->joint[entry->joint], &s, strain);
    else
        settle_moments(entry, &s, strain);
    for (int k = 0; k < count; k++)
        c->strain[row[k]] = strain[k];
    resist_entry(c, entry, false);
    for (int k = 0; k < count; k++) {
        c->left[row[k]] += strain[k] - before[k];
        add_answer(c, row[k], c->more[row[k]] - more[k], c->left);
    }
}

// Until no joint changes its touch any more.
void settle_in_turn(struct corrections *c, double enough)
{
    enum { SWEEPS = 10 };
    bool changed = true;
    resist_entries(c, false);
    for (int sweep = 0; sweep < SWEEPS && changed; sweep++) {
        changed = sweep == 0;
        for (int e = 0; e < c->n_entry; e++) {
            struct entry *entry = &c->entry[e];
            const enum touch before = entry->touch;
            for (int first = 0; first < entry->count; first += 3)
                settle(c, entry, first, 0.5 * enough);
            changed |= entry->touch != before;
        }
        find_left(c); // without the rounding of sums
    }
    for (int e = 0; e < c->n_entry; e++)
        note_pull(c, &c->entry[e]);
}
