// SPDX-License-Identifier: GPL-3.0-or-later
// The liquid that throats leave as rings around contacts, and in narrow gaps, when gas
// enters them: one ring for two grains that share a face, the exact bridge between them
// (bridges/bridges.h), divided among the throats around the face.
#pragma once

#include "network/throat_sides.h"

#include <stdbool.h>

// Where rings have their liquid from, once gas surrounds them.
enum ring_supply {
    RINGS_NONE,
    RINGS_ISOLATED, // each part keeps what it held when gas cut it off
    RINGS_JOINED,   // films without resistance join all to the rest of the liquid
    RINGS_FILMS     // films join them as far as their resistance lets them
};

struct ring_liquid {
    double surface_tension; // N/m, above 0
    double contact_angle;   // rad, from 0 to below pi/2
};

// A part of a ring is a side of a throat: part k of throat t, offset[t] <= k <
// offset[t+1], belongs to the ring at face[k]. Grains that are auxiliary, and walls,
// hold no ring.
struct contact_rings {
    struct throat_sides parts;
    int n_part;
    double *share;      // (n_part) of its ring: those of a ring sum to 1, by the angles
                        // under which its throats are seen from it; 0 of a throat that
                        // holds no liquid
    double *separation; // (n_face) m between the surfaces, below 0 where they overlap;
                        // INFINITY: no ring
};

// The caller frees RINGS with contact_rings_free, also after a failure.
// STATUS_BAD_DATA: no two grains share a face (imported networks, layers), or two
// neighbours in a face's loop are not joined by a throat. O(n_face + n_part). NETWORK
// is needed again by the functions below.
enum status contact_rings_init(const struct network *network,
                               struct contact_rings *rings, struct reason *reason);
void contact_rings_free(struct contact_rings *rings);

// A throat leaves at most this part of what it holds: gas must find its way.
#define MOST_IN_RINGS 0.9

// VOLUME (n_part), m3: what each throat leaves in each of its rings if gas enters it
// while the suction of the liquid is SUCTION (n_throat) Pa; without a positive suction
// nothing. *LIMITED counts the throats whose parts limit_parts reduced. OpenMP, the
// same for any number of threads. STATUS_NOT_CONVERGED: a ring was not found that
// should be there. O(n_part), an exact bridge each (bridges/bridges.h).
enum status ring_volumes(const struct network *network,
                         const struct contact_rings *rings,
                         const struct ring_liquid *liquid, const double *suction,
                         double *volume, int *limited, struct reason *reason);

// WHOLE (n_face), m3: the rings at the faces that are WANTED (n_face), all at SUCTION
// (Pa, above 0); others 0. Otherwise as above.
enum status whole_rings(const struct network *network,
                        const struct contact_rings *rings,
                        const struct ring_liquid *liquid, double suction,
                        const bool *wanted, double *whole, struct reason *reason);

// Reduces VOLUME (n_part) of the parts of THROAT, all by one factor, if they hold more
// than MOST_IN_RINGS of what it does. Returns whether they did.
bool limit_parts(const struct network *network, const struct contact_rings *rings,
                 int throat, double *volume);
