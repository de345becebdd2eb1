// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of dem-replay: the table, and what of them must be known together. The
// functions below are called in their order: the first needs no file, the second the
// forces, the third the bonds.
#pragma once

#include "artifacts/liquid.h"
#include "bonds.h"
#include "fixed_grains.h"
#include "parameters/parameters.h"
#include "replay.h"

// What the table reads into. Choices are the numbers of their enumerators in replay.h,
// bonds.h and dem/; NAN: not given.
struct replay_parameters {
    struct replay_settings settings;        // completed by the functions below
    struct liquid_properties bridge_liquid; // tension and angle
    struct liquid_properties pore_liquid;   // the same, with capillary.suction
    struct fixed_grains held;               // with support=fixed
    struct strength_scatter scatter;        // its law is strength_law
    int support, engine, loose, unsettled, bond, bonds_by, strength_law, bridge_model,
        shrinkage_law, capillary_control, capillary_forces, capillary_throats;
    bool prestress; // overlaps of the packing push from the start
    double bond_gap, contact_strength, moment_contribution, gravity;
    double substrate_strength;    // factor on bonds of a held grain to one that is not
    int64_t shrinkage_steps;      // of an input without forces
    struct number_list snapshots; // saturations, falling
};

extern const struct parameter replay_table[];

// Completes the settings from the rest of PARAMETERS, which must outlive them: the list
// of snapshots is not copied. What depends on the input (bonds, engine, weight, held
// grains) is left to the functions that know it. Ends the program with status 65 if
// snapshots do not fall.
void complete_settings(struct replay_parameters *parameters, int threads);

// Gives bridges the liquid of FORCES (NULL: there are none) unless the user gave one.
// Returns DIFFERENCE (SIZE bytes): one line if the user's liquid differs, else empty. A
// user's value comes first, then that of the forces, then water at 20 degrees Celsius.
const char *complete_bridges(struct replay_parameters *parameters,
                             const struct artifact *forces, char *difference,
                             size_t size);

// Sets .engine and .engine_reason of SETTINGS. With engine=auto that is the
// quasi-static one if friction is 0, support is fixed, bonds are parallel, overlaps at
// rest, nothing shrinks, there are bonds but no bridges, and at most 1500 grains
// (docs/equilibrium.md).
// Bonds must be known. Ends the program with status 65 if the engine cannot do what is
// asked of it.
void choose_engine(const struct replay_parameters *parameters,
                   const struct packing *packing, struct replay_settings *settings);
