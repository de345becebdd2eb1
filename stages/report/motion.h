// SPDX-License-Identifier: GPL-3.0-or-later
// Grains that move: places and contact forces at snapshots, curves of the history.
#pragma once

#include "body.h"

#include <stdio.h>

// Places, groups, contacts at the moments of BODY and the history at the rows of
// COURSE; returns {"fields": [...], "charts": [...]} for the script. RUN must have a
// motion, BODY and COURSE be made from it. The caller owns the JSON. Arrays are those
// that motion.c lists at its top.
json_t *put_motion(struct arrays *arrays, const struct run *run,
                   const struct course *course, const struct shown_body *body);

// How many grains moved for how long, and how many bonds broke; and a list of facts,
// with its moment where it has one: the fastest grain, the most energy, the largest
// overlap, the first crack, the balance of energy. RUN must have a motion.
void put_motion_headline(FILE *page, const struct run *run);
void put_motion_facts(FILE *page, const struct run *run, const struct course *course,
                      const struct shown_body *body);
