// SPDX-License-Identifier: GPL-3.0-or-later
// The weight as the user asks for it, and warnings about it and about other scales. The
// sum itself is in weight.h; here is what belongs to the stage: parameters, messages,
// the artifact.
#pragma once

#include "artifacts/artifact.h"
#include "parameters.h"
#include "weight.h"

// The weight that a replay is done with.
struct taken_weight {
    bool has_forces;             // or the load is a packing's own
    double gravity;              // m/s2; 0: left out
    double gravity_of_liquid;    // in the forces; 0: they have no weight of it
    struct vector *standing;     // (n_particle) N, before drying; NULL: none
    struct weighing weighing;    // with the gravity of the Earth where there is none
    double *liquid;              // of it
    double suction;              // that the forces come from, Pa; 0: from none
    struct bond_numbers numbers; // of note_bond_numbers
};

// Takes the weight of the grains into account: has LOAD, which comes from INPUT (NULL:
// from no forces), take it up in every row, and gives SETTINGS the load before drying.
// That of the liquid is in the forces already, if they were made with gravity. Ends the
// program with status 65 for a gravity with support=free, or in a box that repeats
// along z. SETTINGS then point to .standing. The caller frees it with
// taken_weight_free; PACKING must live as long.
struct taken_weight take_weight(const struct artifact *input,
                                const struct replay_parameters *parameters,
                                const struct packing *packing, struct load *load,
                                struct replay_settings *settings);
void taken_weight_free(struct taken_weight *weight);

// Finds the Bond numbers. LARGEST: the force on a grain at any time, N, known once all
// rows of the load have been read.
void note_bond_numbers(struct taken_weight *weight, double largest);

// Warns on standard error if a weight that matters is left out, and of what the weight
// did alone.
void warn_of_weight(const struct taken_weight *weight,
                    const struct replay_settings *settings,
                    const struct response *response, const struct packing *packing);

// Warns if stiffnesses or strengths are the defaults, those of K's grains [K Table
// 5.1], and the mean radius is more than ten times larger or smaller.
void warn_of_defaults(const struct replay_parameters *parameters,
                      const struct packing *packing);

// The line of the model of the response, written to TEXT, which it returns; "" without
// weight.
const char *describe_weight(const struct taken_weight *weight, char text[200]);

// Writes the Bond numbers and, with weight, gravity and the bonds that it broke before
// drying, to a response artifact.
void put_weight(struct artifact *artifact, const struct taken_weight *weight,
                const struct response *response);
