// SPDX-License-Identifier: GPL-3.0-or-later
// Where a run comes from: what was modelled and what was not, the scene, the commands,
// versions and digests.
#pragma once

#include "run.h"

#include <stdio.h>

// What each stage left out, and what it modelled, as lists. RUN's artifacts stay open.
// All text is escaped.
void put_left_out(FILE *page, const struct run *run);
void put_modelled(FILE *page, const struct run *run);

// The effective parameters of all stages, as one scene. The caller owns it.
json_t *scene_of(const struct run *run);
void put_scene(FILE *page, const struct run *run);

// Command lines that make the run again from that scene, one a line, with the names of
// files that `make run` gives.
void put_commands(FILE *page, const struct run *run);

// Rows of a table: artifact, program, digest; in the order in which artifacts were
// read.
void put_sources(FILE *page, const struct run *run);
