// SPDX-License-Identifier: GPL-3.0-or-later
// How gravity comes in. The grains get the gravity of the parameters, or where that is
// left open the one that the forces were made with (force-protocol.gravity), and none
// where nothing supports the body. Bond numbers are computed in any case, with the
// gravity of the Earth where there is none, so that a user who leaves weight out is
// told when it matters. They need the largest force without the weight of the grains,
// which is known when the replay has read all rows.
#include "take_weight.h"

#include "basics/memory.h"
#include "basics/status.h"
#include "read_load.h"
#include "write_response.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- taken --------------------------------------------------------------------------

// The gravity in the forces; 0: none.
static double gravity_of_forces(const struct artifact *input)
{
    return input && artifact_has_number(input, "/summary/gravity")
               ? artifact_get_number(input, "/summary/gravity")
               : 0;
}

// A gravity that comes from the forces is dropped quietly where the body is free, one
// that the user gave is refused.
static double choose_gravity(const struct replay_parameters *parameters,
                             const struct packing *packing, double of_forces)
{
    const bool is_free = parameters->settings.support == SUPPORT_FREE;
    const bool is_given = !isnan(parameters->gravity);
    const double gravity = is_given ? parameters->gravity : of_forces;
    if (gravity > 0 && is_free && is_given)
        die(STATUS_BAD_DATA,
            "dem-replay.gravity: must be 0 with support=free, is %g: a body without "
            "support falls under its weight (use support=fixed or wall)",
            gravity);
    if (gravity > 0 && packing->periodic[2])
        die(STATUS_BAD_DATA,
            "dem-replay.gravity: must be 0 in a box that is periodic along z, is %g",
            gravity);
    return is_free ? 0 : gravity;
}

// The liquid around each grain (n) before drying, kg; NULL: not known.
static double *first_liquid(const struct artifact *input, int n)
{
    if (!input || !artifact_has_dataset(input, "/liquid_mass")) return NULL;
    struct row_reader rows = artifact_read_rows(input, "/liquid_mass");
    double *liquid = duplicate(artifact_row(&rows, 0), (size_t)n, sizeof *liquid);
    row_reader_free(&rows);
    return liquid;
}

// The suction that weights are compared with has the factor force_scale in it, as the
// forces have.
struct taken_weight take_weight(const struct artifact *input,
                                const struct replay_parameters *parameters,
                                const struct packing *packing, struct load *load,
                                struct replay_settings *settings)
{
    const double of_forces = gravity_of_forces(input);
    struct taken_weight taken = {.has_forces = input,
                                 .gravity_of_liquid = of_forces,
                                 .gravity =
                                     choose_gravity(parameters, packing, of_forces)};
    taken.liquid = load->n_time > 0 ? first_liquid(input, packing->n_particle) : NULL;
    taken.weighing = (struct weighing){
        .packing = packing,
        .density = settings->material.density,
        .gravity = taken.gravity > 0 ? taken.gravity : GRAVITY_OF_THE_EARTH,
        .liquid = taken.liquid};
    if (input)
        taken.suction = artifact_get_number(input, "/summary/capillary_pressure") *
                        artifact_get_number(input, "/summary/force_scale");
    if (taken.gravity > 0) {
        add_weight(load, grain_weights(&taken.weighing));
        taken.standing = standing_weight(&taken.weighing);
    }
    // What an earlier replay has left stands already.
    settings->weight = taken.standing;
    return taken;
}

void taken_weight_free(struct taken_weight *weight)
{
    free(weight->standing);
    free(weight->liquid);
}

void note_bond_numbers(struct taken_weight *weight, double largest)
{
    weight->numbers = find_bond_numbers(largest, weight->suction, &weight->weighing);
}

// ---- told ---------------------------------------------------------------------------

// Weight matters from a twentieth of the suction on. The body need not come nearer to
// rest under it than under a load.
void warn_of_weight(const struct taken_weight *weight,
                    const struct replay_settings *settings,
                    const struct response *response, const struct packing *packing)
{
    const double most = fmax(weight->numbers.grain, weight->numbers.body);
    if (weight->gravity == 0 && most >= WEIGHT_MATTERS)
        report("gravity is left out, but %s weighs %.2g of its suction: gravity=9.81 "
               "in dry, or in force-protocol and here, adds it",
               weight->numbers.grain < most ? "the body" : "a grain", most);
    const double of_liquid = weight->gravity_of_liquid;
    if (weight->gravity > 0 && of_liquid > 0 && weight->gravity != of_liquid)
        report("gravity = %g m/s2 for the grains, but %g for the liquid in the forces",
               weight->gravity, of_liquid);
    if (weight->gravity > 0 && !(of_liquid > 0) && weight->has_forces)
        report("the forces are without the weight of the liquid: "
               "force-protocol.gravity=%g adds it",
               weight->gravity);
    if (response->n_weight_crack > 0)
        report("%d of %d bonds broke under the weight alone, before drying: they are "
               "in /weight_cracks, and are no cracks of drying",
               response->n_weight_crack, packing->n_bond);
    if (response->weight_unbalanced_ratio >= ratio_at_rest(settings))
        report(
            "under its weight alone the body did not come to rest before drying: "
            "the unbalanced ratio is %.2g, not below %g (larger cycles give time steps "
            "longer)",
            response->weight_unbalanced_ratio, ratio_at_rest(settings));
}

// The value, not whether it was given: who writes the default down means it as little.
static bool is_default(const struct replay_parameters *parameters, const char *key)
{
    const struct parameter *row = replay_table;
    while (strcmp(row->key, key))
        row++;
    double value;
    memcpy(&value, (const char *)parameters + row->offset, sizeof value);
    return value == strtod(row->fallback, NULL);
}

// A tenth to ten times the radius: within that the defaults are at least of the right
// order.
void warn_of_defaults(const struct replay_parameters *parameters,
                      const struct packing *packing)
{
    static const char *const keys[] = {"normal_stiffness", "bond.normal_stiffness",
                                       "bond.normal_strength", "bond.shear_strength"};
    static const double radius_of_defaults = 250e-9; // m, [K Table 5.1]
    const int of_contacts = 1;
    const bool is_parallel = parameters->settings.bond.kind == DEM_PARALLEL_BOND;
    const int count = is_parallel && packing->n_bond ? 4 : of_contacts;
    char names[200] = "";
    size_t length = 0;
    double mean = 0;
    for (int i = 0; i < packing->n_particle; i++)
        mean += packing->radius[i] / packing->n_particle;
    if (packing->n_particle == 0) return;
    if (mean <= 10 * radius_of_defaults && mean >= 0.1 * radius_of_defaults) return;
    for (int k = 0; k < count; k++)
        if (is_default(parameters, keys[k]))
            length += (size_t)snprintf(names + length, sizeof names - length, "%s%s",
                                       length ? ", " : "", keys[k]);
    if (names[0])
        report("the defaults of %s are those of grains of 250 nm radius; these have "
               "%.3g m: docs/your-grains.md says what to take",
               names, mean);
}

const char *describe_weight(const struct taken_weight *weight, char text[200])
{
    if (weight->gravity == 0) return "";
    snprintf(text, 200,
             "weight of the grains%s: gravity %.17g m/s2, at rest before drying\n",
             weight->gravity_of_liquid > 0 ? " and the liquid" : "", weight->gravity);
    return text;
}

// A bond number that is not known is left out.
void put_weight(struct artifact *artifact, const struct taken_weight *weight,
                const struct response *response)
{
    if (!isnan(weight->numbers.grain))
        artifact_put_number(artifact, "/summary/bond_number_grain",
                            weight->numbers.grain);
    if (!isnan(weight->numbers.body))
        artifact_put_number(artifact, "/summary/bond_number_body",
                            weight->numbers.body);
    if (weight->gravity == 0) return;
    artifact_put_number(artifact, "/summary/gravity", weight->gravity);
    artifact_put_number(artifact, "/summary/weight_cracks", response->n_weight_crack);
    if (!isnan(response->weight_unbalanced_ratio))
        artifact_put_number(artifact, "/summary/weight_unbalanced_ratio",
                            response->weight_unbalanced_ratio);
    put_bonds_and_modes(artifact, "/weight_cracks", response->weight_crack,
                        response->n_weight_crack);
}
