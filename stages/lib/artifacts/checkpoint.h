// SPDX-License-Identifier: GPL-3.0-or-later
// Long runs that may be stopped: the restart artifact (schemas/restart.json), and when
// it is written. The clock decides on that alone, never on a result.
//
// Life of one in a stage:
//     struct checkpoint checkpoint;
//     checkpoint_begin(&checkpoint, &invocation, inputs);
//     status = run(..., &checkpoint.keeper, ...);    asks it now and then
//     artifact_finish(output, &invocation, inputs, model);
//     checkpoint_end(&checkpoint);
// A run begins from keeper.begin where that is not NULL. The file is of one run:
// SHA-256 over all its arrays tells damage, and program, parameters and inputs must be
// those of this call, as canonical JSON.
#pragma once

#include "artifacts/artifact.h"
#include "checkpoint/keeper.h"

// The arrays of an engine or stage as the datasets of GROUP, "engine". The caller frees
// those it gets with free_arrays; there are none where the artifact has no such group.
// Each array must be in the schema with its type, and have whole rows of its second
// extent: else the program ends (70).
void artifact_put_arrays(struct artifact *artifact, const char *group,
                         const struct array_list *list);
struct array_list artifact_get_arrays(const struct artifact *artifact,
                                      const char *group);

// One for the whole run: begin reads or sets it up, its keeper goes to the engine, end
// tidies up. States are written by a child process; a failure is reported once and the
// run goes on without.
struct checkpoint {
    const struct invocation *invocation;
    json_t *inputs;          // digests, as in the provenance of the output
    double written;          // s, when the last one was, or the run began
    bool has_failed;         // it could not be written, which was said
    struct kept_state begin; // what FILE held
    struct keeper keeper;    // for the run
};

// Reads the file of --checkpoint if there is one. From here on SIGTERM, SIGINT and
// SIGHUP wait until the run asks; a second one of a kind ends the program at once.
// Without --checkpoint does nothing. INPUTS must last as long. Exits 65 when the file
// is not a whole restart artifact, or of another program, parameters or inputs; it then
// leaves the file where it is.
void checkpoint_begin(struct checkpoint *checkpoint, struct invocation *invocation,
                      json_t *inputs);

// After the output is written: removes the file. Frees what begin read; without
// --checkpoint does nothing. What cannot be removed is reported, no more.
void checkpoint_end(struct checkpoint *checkpoint);
