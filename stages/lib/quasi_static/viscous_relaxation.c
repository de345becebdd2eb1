// SPDX-License-Identifier: GPL-3.0-or-later
#include "quasi_static_internal.h"

#include <math.h>
#include <string.h>

void keep_history(struct equilibrium *e)
{
    memcpy(e->before, e->trial, (size_t)e->n * sizeof *e->before);
    for (int j = 0; j < e->n_joint; j++) {
        for (int k = 0; k < STRAINS; k++)
            e->grown[j][k] = e->strain[j][k] - e->joint[j].strain[k];
        memcpy(e->joint[j].strain, e->strain[j], sizeof e->joint[j].strain);
        e->joint[j].contact = e->resistance[j].contact;
        if (e->joint[j].contact.touch == TOUCH_BEGINS)
            e->joint[j].contact.touch = TOUCH_STICKS;
    }
    if (e->kind->keep_history) e->kind->keep_history(e);
}

void go_back(struct equilibrium *e)
{
    memcpy(e->trial, e->before, (size_t)e->n * sizeof *e->trial);
    memset(e->dashpots, 0, (size_t)e->n * sizeof *e->dashpots);
}

// The way to rest with dashpots at all joints, by steps in time that grow as things
// come to rest and shrink where one cannot be found. Whether it came to rest.
static bool creep(struct equilibrium *e)
{
    const double stiffest = 1e4, softest = 1e-2;
    double growth = 16;
    e->damping = 1;
    go_back(e);
    for (int64_t k = 0; k < e->setup.most_iterations && e->damping <= stiffest; k++) {
        const bool found = e->kind->approach(e);
        if (found) {
            keep_history(e);
            if (e->damping == 0) return true;
            e->damping = e->damping > softest ? e->damping / growth : 0;
            growth = 16;
        } else {
            e->damping = fmax(8 * e->damping, softest);
            growth = 2;
        }
        go_back(e);
    }
    e->damping = 0;
    resist(e);
    return false;
}

bool come_to_rest(struct equilibrium *e)
{
    e->damping = 0;
    if (e->kind->approach(e)) {
        keep_history(e);
        return true;
    }
    if (!e->is_restless) return creep(e);
    go_back(e);
    resist(e);
    return false;
}
