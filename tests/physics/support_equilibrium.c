// SPDX-License-Identifier: GPL-3.0-or-later
#include "support_equilibrium.h"

#include "../test.h"

struct quasi_static *make_equilibrium(const struct quasi_static_setup *setup)
{
    struct quasi_static *equilibrium;
    struct reason reason = {""};
    if (quasi_static_create(&equilibrium, setup, &reason)) fail_msg("%s", reason.text);
    return equilibrium;
}

void next_equilibrium(struct quasi_static *equilibrium, const struct vector *force)
{
    struct reason reason = {""};
    if (quasi_static_solve(equilibrium, force, &reason)) fail_msg("%s", reason.text);
}

struct response replay_or_fail(const struct packing *packing, const struct load *load,
                               const struct replay_settings *settings)
{
    struct response response;
    struct reason reason = {""};
    if (replay(packing, load, settings, NULL, NULL, &response, &reason))
        fail_msg("%s", reason.text);
    return response;
}

struct dem_setup cycles_of(const struct quasi_static_setup *setup, double safety)
{
    struct dem_setup cycles = {.packing = setup->packing,
                               .material = setup->material,
                               .bond = setup->bond,
                               .fixed = setup->fixed,
                               .time_step_safety = safety,
                               .threads = 1};
    cycles.material.density = 3230;
    cycles.material.damping_ratio = 0.7;
    return cycles;
}
