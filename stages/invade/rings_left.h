// SPDX-License-Identifier: GPL-3.0-or-later
// The liquid that stays as rings around contacts where gas has come.
#pragma once

#include "network/contact_rings.h"
#include "outcome.h"

// It owns its arrays.
struct rings_left {
    double *volume; // (outcome->n) m3 in all rings after each event
    double *part;   // (rings.n_part) m3 in the end
    struct contact_rings rings;
    int limited; // throats that hold less in rings than these ask for
};

// Joined rings have the highest pressure so far, and drain as it rises. Where gas was
// from the start rings are joined ones only. WEIGHT: of the liquid, N/m3, by which
// suction grows with height; 0 with RINGS_JOINED. The caller frees LEFT with
// rings_left_free, also after a failure. Statuses as contact_rings_init and
// ring_volumes. Joined rings are found at some suctions and interpolated between them;
// isolated ones each by itself.
enum status rings_left_init(const struct network *network,
                            const struct outcome *outcome, enum ring_supply supply,
                            const struct ring_liquid *liquid, double weight,
                            struct rings_left *left, struct reason *reason);
void rings_left_free(struct rings_left *left);
