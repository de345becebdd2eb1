// SPDX-License-Identifier: GPL-3.0-or-later
// inspect: any artifact as JSON, or as a series for ParaView. It reads one file, from
// standard input if none is named. A JSON document describes itself and is printed as
// it is. Of an artifact it writes the network, the series, one dataset or the
// description, by the options, in this order of precedence.
//
// Only one of these is done: a network (--openpnm and --statoil go together), --xyz,
// --vtk, --data, else the description; an option further behind is passed over.
// Files are each written whole or not at all. Whether the input is JSON or HDF5 its
// first bytes say, not its name. The artifact is checked whole before any of it is
// printed.
#include "artifacts/artifact.h"
#include "artifacts/document.h"
#include "basics/status.h"
#include "describe.h"
#include "export.h"
#include "parameters/command_line.h"
#include "series.h"
#include "xyz.h"

#include <stdlib.h>

struct options {
    const char *input, *data, *vtk, *openpnm, *statoil, *xyz;
    int frames;
};

enum { KEY_VTK = 256, KEY_FRAMES, KEY_OPENPNM, KEY_STATOIL, KEY_XYZ };

static const struct argp_option option_table[] = {
    {"data", 'd', "NAME", 0, "Print one dataset, as nested lists", 0},
    {"vtk", KEY_VTK, "PREFIX", 0,
     "Write everything that changes over time as PREFIX-0000.vtu ... and PREFIX.pvd, "
     "for ParaView: liquid in the throats (that in rings as PREFIX-rings), forces, "
     "cracks and "
     "displacements",
     0},
    {"frames", KEY_FRAMES, "N", 0, "Frames of a drying or of forces [11]", 0},
    {"openpnm", KEY_OPENPNM, "FILE", 0,
     "Write a network as JSON graph, which OpenPNM and import-network read", 0},
    {"statoil", KEY_STATOIL, "PREFIX", 0,
     "Write a network as PREFIX_node1.dat, _node2.dat, _link1.dat and _link2.dat", 0},
    {"xyz", KEY_XYZ, "FILE", 0,
     "Write the grains as extended XYZ, for OVITO: places, radii, and over time "
     "forces, "
     "displacements and broken bonds",
     0},
    VERSION_OPTION,
    {0}};

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    struct options *options = state->input;
    switch (key) {
    case 'd':
        options->data = argument;
        return 0;
    case KEY_VTK:
        options->vtk = argument;
        return 0;
    case KEY_FRAMES:
        options->frames = (int)whole_of_option("--frames", argument, 1, 10000);
        return 0;
    case KEY_OPENPNM:
        options->openpnm = argument;
        return 0;
    case KEY_STATOIL:
        options->statoil = argument;
        return 0;
    case KEY_XYZ:
        options->xyz = argument;
        return 0;
    case ARGP_KEY_ARG:
        if (state->arg_num) die(STATUS_USAGE, "%s: one input only", argument);
        options->input = argument;
        return 0;
    default:
        return parse_common_option(key, state, "inspect", STAGE_VERSION);
    }
}

int main(int argc, char **argv)
{
    struct options options = {.input = "-", .frames = 11};
    const struct argp argp = {
        .options = option_table,
        .parser = parse_option,
        .args_doc = "[ARTIFACT]",
        .doc = "inspect -- any artifact as JSON, or as a series for ParaView"};
    parse_command_line(&argp, argc, argv, &options);

    struct bytes bytes = read_whole_of(options.input, may_be_either);
    if (is_document(&bytes)) { // describes itself
        if (options.data || options.vtk || options.openpnm || options.statoil ||
            options.xyz)
            die(STATUS_USAGE, "%s: is JSON: read it with jq",
                input_name(options.input));
        write_json("-", document_of(options.input, &bytes));
        bytes_free(&bytes);
        return STATUS_OK;
    }
    struct artifact *artifact = artifact_open_bytes(options.input, bytes, NULL);
    if (options.openpnm || options.statoil)
        export_network(artifact, options.openpnm, options.statoil);
    else if (options.xyz)
        write_xyz(artifact, options.xyz, options.frames);
    else if (options.vtk)
        write_series(artifact, options.vtk, options.frames);
    else
        write_json("-", options.data ? dataset_json(artifact, options.data)
                                     : describe_artifact(artifact));
    artifact_close(artifact);
    return STATUS_OK;
}
