// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of dem-replay.
#ifndef CRAQUELURE_REPLAY_PARAMETERS_H
#define CRAQUELURE_REPLAY_PARAMETERS_H

#include "artifacts/liquid.h"
#include "bonds.h"
#include "fixed_grains.h"
#include "parameters/parameters.h"
#include "replay.h"

struct replay_parameters {
    struct replay_settings settings;
    struct liquid_properties bridge_liquid; // tension and angle
    struct fixed_grains held;
    struct strength_scatter scatter;
    int support, engine, loose, unsettled, bond, bonds_by, strength_law, bridge_model;
    bool prestress;
    double bond_gap, contact_strength, moment_contribution, gravity;
    struct number_list snapshots;
};

extern const struct parameter replay_table[];

// Completes the settings from the rest of PARAMETERS, which must outlive them. Ends the
// program if they contradict each other.
void complete_settings(struct replay_parameters *parameters, int threads);

// Gives bridges the liquid of FORCES unless the user gave one. Returns DIFFERENCE (SIZE
// bytes): one line if the user's liquid differs, else empty.
const char *complete_bridges(struct replay_parameters *parameters,
                             const struct artifact *forces, char *difference,
                             size_t size);

// Sets the engine that PARAMETERS name, or the one that suits the grains, with its
// reason. Ends the program if it cannot do what is asked of it.
void choose_engine(const struct replay_parameters *parameters,
                   const struct packing *packing, struct replay_settings *settings);

#endif
