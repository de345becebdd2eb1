// SPDX-License-Identifier: GPL-3.0-or-later
// The command line every stage shares:
//     STAGE [options] [-p PARAMS.json] [INPUT...] [-o OUTPUT]
// A stage is a main of this form: stage_begin, open inputs, compute, write the
// artifact, invocation_free. All that a user can say is in struct invocation and in the
// stage's own struct.
//
// In full, without what is particular:
//     int main(int argc, char **argv)
//     {
//         struct example_parameters parameters;
//         struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
//         omp_set_num_threads(invocation.threads);
//         struct artifact *input = artifact_open(invocation.inputs[0], "packing");
//         ...
//         artifact_finish(output, &invocation, one_input(input), model);
//         artifact_close(input);
//         invocation_free(&invocation);
//         return STATUS_OK;
//     }
// Who says a parameter, the strongest first: --set, the stage's section in the file of
// -p, "conditions" of that scene for shared keys, the section of another stage for keys
// whose row names one, the default. A stage reports
// all mistakes of the user before it computes anything, and tries its outputs before it
// works for hours.
#pragma once

#include "basics/progress.h"
#include "parameters/parameters.h"

#include <stdbool.h>

// Whether a stage says what a run will take, of its input alone or also of sizes.
enum estimates { ESTIMATES_NOTHING, ESTIMATES_INPUT, ESTIMATES_SIZES };

// What a stage says of itself. A static constant of the program.
struct stage {
    const char *name;
    int version;         // raised when results may change
    const char *summary; // one line
    const char *reads;   // schema name of its inputs, "packing"; NULL: takes none
    const char *writes;  // schema name of its output
    int most_inputs;     // on one call; 0: it takes none
    const struct parameter *parameters; // ends with a row without a key
    const char *notes;                  // more for --help; may be NULL
    const char *reports; // what --report FILE writes; NULL: there is no such option
    bool checkpoints;    // whether it can be stopped and gone on with: --checkpoint
    enum estimates estimates; // whether it says what a run will take: --estimate
    bool tells;               // without -o it tells people, in text, what it found
    bool writes_page;         // for people, which has no schema
    bool transcribes; // it writes what it read: what is wrong is wrong in the input
};

// What the user asked for on this call.
struct invocation {
    const struct stage *stage;
    const char **inputs; // "-" is standard input; one "-" when none was named
    int n_input;
    const char *output;      // "-" is standard output
    const char *report;      // of --report; NULL: not asked for; not "-" when OUTPUT is
    const char *checkpoint;  // of --checkpoint; NULL: not asked for
    double checkpoint_every; // s
    bool resumed;            // the run goes on from that checkpoint
    bool estimates;          // only the cost is asked for
    double grains, loads, throats; // of --estimate=GRAINS,LOADS,THROATS; 0: not given
    int threads;
    bool tells; // in text, on standard output, for there is no -o
    bool quiet;
    enum progress_mode progress;
    json_t *parameters; // effective, defaults filled in
    json_t *borrowed;   // keys of those that the section of another stage said
    json_t *scene;      // the file of -p; NULL: there is none, or it is no scene
};

// Parses the command line, reads the parameters, fills the stage's struct PARAMETERS.
// Exits on --help, --version, --schema, --parameters, and on errors (64, 65, 66). The
// invocation lasts until invocation_free. PARAMETERS is filled as the table of STAGE
// says; texts and names in it belong to the invocation.
struct invocation stage_begin(const struct stage *stage, int argc, char **argv,
                              void *parameters);
void invocation_free(struct invocation *invocation);

// "dry 1" into TEXT, which is returned: what an artifact's `program` attribute says.
const char *stage_program(const struct stage *stage, char text[64]);
