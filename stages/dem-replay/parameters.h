// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of dem-replay.
#ifndef CRAQUELURE_REPLAY_PARAMETERS_H
#define CRAQUELURE_REPLAY_PARAMETERS_H

#include "bonds.h"
#include "held.h"
#include "parameters/parameters.h"
#include "replay.h"

struct replay_parameters {
    struct replay_settings settings;
    struct held held;
    struct strength_scatter scatter;
    int support, engine, bond, bonds_by, strength_law, bridge_model;
    bool prestress;
    double bond_gap, contact_strength, gravity;
    struct number_list snapshots;
};

extern const struct parameter replay_table[];

// Completes the settings from the rest of PARAMETERS, which must outlive them. Exits
// where they are not of use.
void complete_settings(struct replay_parameters *parameters, int threads);

#endif
