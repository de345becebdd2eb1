// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts and bridges by the separation of their grains [G 15]. The range of a run is
// not divided into a given number of classes, as in [G 15]: classes of one width let
// runs be added, and compared.
#pragma once

#include "band.h"
#include "frame.h"
#include "motion.h"

enum zone { ZONE_OUTSIDE = 0, ZONE_INSIDE = 1, ZONES };

// Pairs in all snapshots, and the sum of their normal forces, N; below 0: they pull.
// Counts are doubles: they are means later.
struct separation_class {
    double count[ZONES], force[ZONES];
};

// Classes of equal width, class k from k WIDTH on; the first kept is LOWEST. It owns
// its array; free with separations_free. Empty is all zero but WIDTH, which must be set
// before the first call.
struct separations {
    double width; // m
    int64_t lowest;
    int n;
    struct separation_class *class; // (n)
};

// Adds the pairs of grains of snapshot S, one of which at least moves freely; INSIDE
// where the contact is within a width of the band's centre. Without a band (FIT is
// NULL) all are outside. The separation is that of the motion (surfaces, m, below 0 in
// overlap). A pair counts whole in the zone of its contact point.
void add_separations(struct separations *separations, const struct motion *motion,
                     int s, const struct frame *frame, const struct split_cell *cell,
                     const struct band_fit *fit);
void separations_free(struct separations *separations);

// Whether a place is inside the band. R and Z in m, as coordinates of the frame; false
// without a band at that height.
bool inside_band(const struct split_cell *cell, const struct band_fit *fit, double r,
                 double z);
