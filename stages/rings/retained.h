// SPDX-License-Identifier: GPL-3.0-or-later
// The liquid that stays in a packing as rings, at a suction: one ring at each contact,
// and in each gap that a bridge can stand in, all joined to liquid of that suction.
//
//     struct ring_sites sites = sites_of(&packing, suction[0], tension);
//     for (int k = 0; k < n; k++)
//         status = retain(&packing, &sites, &liquid, suction[k], &retained, &reason);
//     sites_free(&sites);
// trace(pull) / 3 over the volume of the box is the stress by which rings press the
// grains together. MEETING above 0 tells where the picture of single rings ends.
#pragma once

#include "basics/status.h"
#include "geometry/packing.h"

#include <stdbool.h>

// Pairs of solid grains close enough for a ring. It owns its arrays.
struct ring_sites {
    int count;
    int contacts; // of these: pairs that touch
    int32_t (*grain)[2];
    double *separation;    // (count) m between the surfaces; negative: overlap
    struct vector *normal; // (count) of length 1, from the first grain to the second
    bool *dry;             // (count) too wide for a ring at the suctions up to now
};

// All pairs in whose gaps rings may stand at SUCTION (Pa) or more, of a liquid of
// surface TENSION (N/m). sites_free frees them.
struct ring_sites sites_of(const struct packing *packing, double suction,
                           double tension);
void sites_free(struct ring_sites *sites);

struct liquid {
    double tension; // N/m
    double angle;   // of contact, rad
};

// What rings hold at a suction.
struct retained {
    int rings;
    int meeting;       // pairs of rings whose contact lines meet on a grain
    double volume;     // m3
    double pull[3][3]; // sum over rings of force times branch vector, N m
};

// The same for any number of threads. Suctions must rise from call to call: a site
// whose ring broke stays dry. STATUS_NOT_CONVERGED: a ring was not found that should be
// there.
enum status retain(const struct packing *packing, struct ring_sites *sites,
                   const struct liquid *liquid, double suction,
                   struct retained *retained, struct reason *reason);
