// SPDX-License-Identifier: GPL-3.0-or-later
// What a page is made from: the artifacts of one run, each of which may be missing; or
// one flow, or one motion.
#pragma once

#include "artifacts/artifact.h"

#include <jansson.h>

// The chain of a drying in its order: each is made from the one before.
enum kind { PACKING, NETWORK, DRYING, FORCES, RESPONSE, KINDS };

// It owns all of it; close_run frees it. Times in s, forces in N. Rows are those of the
// artifacts; cracks are in the order of time.
struct run {
    struct artifact *of[KINDS];    // NULL: not there
    struct artifact *tessellation; // a network that no throats were merged in
    struct artifact *flow, *motion;
    json_t *counted;  // crackstats of this run; NULL likewise
    json_t *repeated; // crackstats of several runs
    json_t *checked;  // findings of check
    json_t *sources;  // [{"name", "schema", "sha256"}, ...] all of them

    struct packing packing;      // the grains
    struct network network;      // n_throat 0: not known
    struct drying_record record; // n_step 0: not known

    int n_crack;
    int32_t *crack_bond; // (n_crack)
    double *crack_time, *crack_saturation;
    uint8_t *crack_mode;
    int n_before;         // bonds broken when the replay began
    int32_t *bond_before; // (n_before)
    uint8_t *mode_before;

    // Arrows: forces of the liquid or, of a flow, of the fluid (N); velocities (m/s).
    int n_load;
    double *load_time, *load_saturation; // (n_load) NULL where nothing dries
    struct vector *load;                 // (n_load, n_particle)
};

// Reads PATHS (N): artifacts, or folders of them. Exits 65 where two say different
// things of one run, or one is not known here, and 66 where a folder has none. Exits 64
// where two are of one kind, or a flow or motion is not alone.
struct run run_of_paths(const char *const *paths, int n);
void close_run(struct run *run);

// Whether times are numbers of steps, not seconds: a packing that shrinks or drains by
// itself has no times, and dem-replay counts its steps.
bool counts_steps(const struct run *run);
