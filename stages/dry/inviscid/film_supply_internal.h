// SPDX-License-Identifier: GPL-3.0-or-later
// What film_supply.c uses of film_supply_find.c besides film_supply.h.
#pragma once

#include "film_supply.h"

// Of the liquid at the start, not clipped.
double film_saturation(const struct occupancy *occupancy);

// The place of the throat that CLUSTER empties now or next in the
// order of invasion, and the level of films beside the cluster.
int film_turn_of(const struct emptying_times *times, int cluster);
double film_least_level(const struct emptying_times *times, int cluster);
