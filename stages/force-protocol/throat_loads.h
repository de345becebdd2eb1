// SPDX-License-Identifier: GPL-3.0-or-later
// Forces on the grains from the loads of the throats: at one time, or followed from
// step to step of the drying. A patch says how a throat pulls a grain for a load of 1,
// by geometry alone; liquid_loads.h says how large the load is. Both ways add in the
// same order, so they give the same bits, for any number of threads.
#pragma once

#include "drying_rings.h"
#include "liquid_loads.h"
#include "solid_angle_patches.h"

// Which throats act on which grains, by each load; a load that is not modelled has no
// patches. Forces are multiplied by SCALE, except the weight.
struct throat_loads {
    struct patches patches[LOADS];
    struct drying_rings rings; // that the drying left; n = 0: none
    double scale;
    double balance_change; // of the suction's pulls (balance.h); 0: none
};
void throat_loads_free(struct throat_loads *loads);

// The loads of all throats now; of those that act on no grain NULL.
struct load_values {
    double *of[LOADS]; // (n_throat)
};

// Forces on all grains (n_particle), for the filling as it is now. OpenMP over the
// grains, each summed in the order of throats.
void forces_now(const struct throat_loads *loads, const struct liquid_loads *liquid,
                struct vector *force);

// The forces step by step; only of grains beside throats that change. It owns its
// arrays and its liquid, not the loads. `changed` and `former` tell what the last move
// did, so that whoever follows need not compare all grains.
struct force_steps {
    const struct throat_loads *loads;
    struct liquid_loads liquid;
    bool checks_all; // throats change that the drying does not list
    struct load_values load;
    double *pull, *former_pull; // (loads->rings.n) N, now and before
    struct vector *force;       // (n_particle) N
    int *offset, *grain;        // (n_throat+1): grains that each throat acts on
    int n_changed;
    int *changed;          // (n_changed) grains whose force the last move changed
    struct vector *former; // (n_changed) what it was before
    bool *listed;          // (n_particle)
};

// At the first step. The caller frees with force_steps_free.
struct force_steps force_steps_begin(const struct throat_loads *loads,
                                     const struct network *network,
                                     const struct liquid_record *record,
                                     const struct suction_law *law);
void force_steps_free(struct force_steps *steps);

// _to_end_of_step goes to the moment just before the next step, _advance to that step
// itself; false: there is none. Only where forces jump, STEPS.CHECKS_ALL, do the two
// differ; elsewhere _to_end_of_step must not be called: it would look at the throats
// that changed when the step began, not at those that change until the next.
void force_steps_to_end_of_step(struct force_steps *steps);
bool force_steps_advance(struct force_steps *steps);
