// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibria and replays that have to succeed, or the test fails.
#pragma once

#include "dem-replay/replay.h"
#include "quasi_static/quasi_static.h"

struct quasi_static *make_equilibrium(const struct quasi_static_setup *setup);
void next_equilibrium(struct quasi_static *equilibrium, const struct vector *force);
struct response replay_or_fail(const struct packing *packing, const struct load *load,
                               const struct replay_settings *settings);

// Cycles of the same grains and joints, with dashpots, whose steps are SAFETY of
// [K 4.47].
struct dem_setup cycles_of(const struct quasi_static_setup *setup, double safety);
