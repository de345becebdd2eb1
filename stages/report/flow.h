// SPDX-License-Identifier: GPL-3.0-or-later
// A flow through the pores between grains: pressures, velocities, drag.
#ifndef CRAQUELURE_REPORT_FLOW_H
#define CRAQUELURE_REPORT_FLOW_H

#include "body.h"

#include <stdio.h>

// Takes pores and throats of RUN's flow for its network, and drag for its arrows.
void read_flow(struct run *run);

// What colours throats; returns {"fields": [...], "charts": [...]} for the script.
json_t *put_flow(struct arrays *arrays, const struct run *run);

void put_flow_headline(FILE *page, const struct run *run);
void put_flow_facts(FILE *page, const struct run *run, const struct shown_body *body);

#endif
