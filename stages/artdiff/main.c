// SPDX-License-Identifier: GPL-3.0-or-later
// artdiff: in what two artifacts differ, with a tolerance.
//
// It reads both files whole, decides by their first bytes whether they are JSON or HDF5
// (they must be the same), and collects a line for each difference before anything is
// printed. The exit status is 1 if there are any.
//
// A difference in the provenance is none. With the tolerance 0, the default, doubles
// must be equal to the last bit, but 0 and -0 are; two files that pass need not be
// equal byte for byte. Order: what both hold is read and checked as any stage would, so
// a damaged file exits 65 and is never merely different.
#include "artifacts/document.h"
#include "basics/status.h"
#include "compare.h"
#include "parameters/command_line.h"

#include <stdlib.h>

struct options {
    const char *input[2];
    double tolerance;
    bool quiet;
};

static const struct argp_option option_table[] = {
    {"tolerance", 't', "T", 0,
     "Largest difference, relative to the largest value of a dataset, or to a single "
     "number (to 1 if that has no unit and is smaller) [0]; whole numbers must be "
     "equal",
     0},
    {"quiet", 'q', NULL, 0, "Only the exit status", 0},
    VERSION_OPTION,
    {0}};

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    struct options *options = state->input;
    switch (key) {
    case 't':
        options->tolerance = number_of_option("--tolerance", argument, 0, 1);
        return 0;
    case 'q':
        options->quiet = true;
        return 0;
    case ARGP_KEY_ARG:
        if (state->arg_num > 1) die(STATUS_USAGE, "%s: two artifacts only", argument);
        options->input[state->arg_num] = argument;
        return 0;
    case ARGP_KEY_END:
        if (state->arg_num < 2) die(STATUS_USAGE, "two artifacts are needed");
        return 0;
    default:
        return parse_common_option(key, state, "artdiff", STAGE_VERSION);
    }
}

// Takes the bytes over: they are the images of the artifacts.
static void compare_hdf5(struct comparison *comparison, struct bytes bytes[2])
{
    struct artifact *artifact[2];
    for (int k = 0; k < 2; k++)
        artifact[k] = artifact_open_bytes(comparison->names[k], bytes[k], NULL);
    compare_artifacts(comparison, artifact[0], artifact[1]);
    for (int k = 0; k < 2; k++)
        artifact_close(artifact[k]);
}

// Frees the bytes once they are parsed.
static void compare_json(struct comparison *comparison, struct bytes bytes[2])
{
    json_t *document[2];
    for (int k = 0; k < 2; k++) {
        document[k] = document_of(comparison->names[k], &bytes[k]);
        bytes_free(&bytes[k]);
    }
    compare_documents(comparison, document[0], document[1]);
    for (int k = 0; k < 2; k++)
        json_decref(document[k]);
}

// A pipe may be one of the two; both "-" would leave nothing for the second.
static void compare_files(struct comparison *comparison)
{
    struct bytes bytes[2];
    for (int k = 0; k < 2; k++)
        bytes[k] = read_whole_of(comparison->names[k], may_be_either);
    const bool json = is_document(&bytes[0]);
    if (json != is_document(&bytes[1]))
        die(STATUS_BAD_DATA, "%s is %s, %s is %s", input_name(comparison->names[0]),
            json ? "JSON" : "not JSON", input_name(comparison->names[1]),
            json ? "not" : "JSON");
    if (json)
        compare_json(comparison, bytes);
    else
        compare_hdf5(comparison, bytes);
}

int main(int argc, char **argv)
{
    struct options options = {0};
    const struct argp argp = {
        .options = option_table,
        .parser = parse_option,
        .args_doc = "ARTIFACT ARTIFACT",
        .doc = "artdiff -- how two artifacts differ, with a tolerance\vA line for each "
               "dataset or number that differs. Programs and parameters that made them "
               "are not compared: for every byte use cmp.\n\nExit status:\n  0 none "
               "does; 1 some do; 64 command line; 65 bad input;\n  66 no such input; "
               "70 internal error; 74 failed I/O"};
    parse_command_line(&argp, argc, argv, &options);

    char *lines = NULL;
    size_t size = 0;
    struct comparison comparison = {.tolerance = options.tolerance,
                                    .names = {options.input[0], options.input[1]},
                                    .lines = open_memstream(&lines, &size)};
    compare_files(&comparison);
    fclose(comparison.lines);
    if (!options.quiet && size) write_whole("-", lines, size);
    free(lines);
    return comparison.n_different ? STATUS_NO : STATUS_OK;
}
