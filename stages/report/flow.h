// SPDX-License-Identifier: GPL-3.0-or-later
// A flow through the pores between grains: pressures, velocities, drag.
#pragma once

#include "body.h"

#include <stdio.h>

// Takes pores and throats of RUN's flow for its network, and drag for its arrows. RUN
// owns them and frees them as those of a drying. Areas in m2, forces in N.
void read_flow(struct run *run);

// What colours throats; returns {"fields": [...], "charts": [...]} for the script. The
// caller owns the JSON.
json_t *put_flow(struct arrays *arrays, const struct run *run);

// The permeability, in one sentence; and a list of facts: permeability, flux, range of
// pressures, largest drag.
void put_flow_headline(FILE *page, const struct run *run);
void put_flow_facts(FILE *page, const struct run *run, const struct shown_body *body);
