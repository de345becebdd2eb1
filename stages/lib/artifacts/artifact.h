// SPDX-License-Identifier: GPL-3.0-or-later
// Artifacts: HDF5 files. Those that are read are held as images in memory, so that
// files and pipes are the same.
//
// Types, units and shapes of what is written come from the schema, and everything that
// is read has been checked against it, so that a stage can trust what it gets. All
// functions end the program with one line and the right exit status on failure.
//
// How a stage reads and writes:
//     struct artifact *input = artifact_open(invocation.inputs[0], "packing");
//     struct packing packing = artifact_get_packing(input);
//     ...
//     struct artifact *output = artifact_create("network", invocation.output);
//     artifact_put_network(output, &network);
//     artifact_finish(output, &invocation, one_input(input), model);
//     artifact_close(input);
//
// Arrays and texts that are read are the caller's and outlive the artifact; entries of
// its schema end with it. Memory: a file is mapped, so what it holds takes none until
// it is read, and artifact_get takes that of the dataset once.
//
// For one thread: HDF5 is not to be called from several. Several artifacts may be open
// at once. The same datasets, put in the same order, give the same bytes.
#pragma once

#include "artifacts/schema.h"
#include "basics/file.h"
#include "geometry/packing.h"
#include "network/network.h"
#include "network/ring_record.h"
#include "parameters/stage.h"

// One that is read lives from artifact_open to artifact_close, one that is written from
// artifact_create to artifact_finish. Names of datasets and attributes are paths,
// "/particles/position". artifact_get and all that writes end the program (70) at one
// that the schema does not have.
struct artifact {
    const char *path;      // for messages; not owned
    struct schema *schema; // what it is
    hid_t file;
    struct bytes image; // of one that was read: the whole file
    char sha256[65];    // of one that was read, hexadecimal
    int descriptor;     // of one that is being written
};

// Before any other call of HDF5: it keeps silent, and does not write on at an exit what
// could not be written. artifact_open and artifact_create call it; others that use HDF5
// by themselves must.
void hdf5_begin(void);

// ---- reading ------------------------------------------------------------------------

// Reads PATH ("-": standard input) and checks it against the schema called NAME; NULL
// takes any known one. Exits 65 when it is not an artifact, of another schema,
// truncated, or breaks a rule, naming the dataset, the row, the rule and the value.
// Cost: all datasets are read once for the check, in a child process, since a damaged
// file may crash the library, and the digest takes another pass.
struct artifact *artifact_open(const char *path, const char *name);
void artifact_close(struct artifact *artifact);

// The same for bytes already read, which it then owns; PATH is for messages.
struct artifact *artifact_open_bytes(const char *path, struct bytes bytes,
                                     const char *name);

// Exits 65: PATH must be a WANTED, is a GOT ("network", "packing"); says which stages
// lead from one to the other.
_Noreturn void refuse_kind(const char *path, const char *wanted, const char *got);

// Whether bytes begin as HDF5 files do.
bool is_hdf5(const struct bytes *bytes);

// A whole dataset in the memory type of its schema entry (float64: double, int32:
// int32_t, int64: int64_t, uint8: uint8_t, int8: int8_t). ROWS, if not NULL, gets the
// first extent. The caller frees it. The dataset must be there: ask
// artifact_has_dataset for an optional one. (rows, ...) row-major, in the shape of the
// schema; never NULL, also without rows.
void *artifact_get(const struct artifact *artifact, const char *name, int *rows);

// The rows of a dataset, one after the other: a band of them is held, as high as its
// chunks are, so that each of these is unpacked once; of very long rows fewer. Going
// back reads again.
struct row_reader {
    const struct artifact *artifact;
    const char *name;
    hid_t dataset, type; // in memory
    int rank;
    hsize_t extent[8];
    size_t row_bytes;
    hsize_t first, held, most; // rows in the band; as many fit into it
    void *band;
};

// Freed with row_reader_free; ARTIFACT must stay open as long.
struct row_reader artifact_read_rows(const struct artifact *artifact, const char *name);
const void *artifact_row(struct row_reader *reader, int row); // until the next call
void row_reader_free(struct row_reader *reader);

// A whole dataset as doubles, whatever its type: whole numbers up to 2^53 are exact.
// The caller frees VALUE.
struct dataset_values {
    int rank;
    hsize_t extent[8];
    size_t count;
    double *value;
};
struct dataset_values artifact_get_values(const struct artifact *artifact,
                                          const char *name);

// Whether an optional dataset is there. NAME must be one of the schema, else false.
bool artifact_has_dataset(const struct artifact *artifact, const char *name);

// Whether an optional attribute is there; also false where the schema has no such one.
bool artifact_has_number(const struct artifact *artifact, const char *name);

// A number from an attribute, "/summary/porosity". It must be there: exits 65
// otherwise. Whole numbers come as doubles.
double artifact_get_number(const struct artifact *artifact, const char *name);

// A text attribute of the whole artifact, or NULL when there is none: a foreign program
// need not have written the provenance. The caller frees it.
char *artifact_get_text(const struct artifact *artifact, const char *name);
extern const char *const provenance_names[]; // ends with NULL

// Everything a packing or network artifact holds (also drying, forces, response, which
// carry one along). The caller frees it with packing_free or network_free. What no
// schema can say is checked here (65): that bodies are whole, that walls exist, that no
// throat leads from a node to itself but around the box.
struct packing artifact_get_packing(const struct artifact *artifact);

// The packing, for a STAGE that takes all of its grains for solid: auxiliary ones, of
// an extra layer, are refused (65).
struct packing artifact_get_solid_packing(const struct artifact *artifact,
                                          const char *stage);
// Exits 65 on a network in a box that repeats, unless asked for such a one: a stage
// that does not know of images would take a throat across a side for one across the
// box.
struct network artifact_get_network(const struct artifact *artifact);
struct network artifact_get_periodic_network(const struct artifact *artifact);
// Exits 65 where a side of WALLS (bits of enum wall), which parameter KEY names, is on
// an axis along which the box of NETWORK, that of ARTIFACT, repeats: it has none there.
void refuse_repeated(const struct artifact *artifact, const struct network *network,
                     unsigned walls, const char *key);
// Tells them, where the others serve alone.
void report_repeated(const struct artifact *artifact, const struct network *network,
                     unsigned walls, const char *key);

// What happened in a drying. A foreign one may have no step. The caller frees it with
// drying_record_free.
struct drying_record artifact_get_drying(const struct artifact *artifact);

// Whether a drying has rings, and what happened to them. It must have some. The caller
// frees them with ring_record_free.
bool artifact_has_rings(const struct artifact *artifact);
struct ring_record artifact_get_rings(const struct artifact *artifact);

// ---- writing ------------------------------------------------------------------------

// An empty artifact of schema NAME, to be written to PATH ("-": standard output), which
// is not touched before artifact_finish. PATH must last as long. The caller ends it
// with artifact_finish, or by ending the program: then nothing is left of it. Exits 70
// for a NAME without schema, 73 where no file can be made.
struct artifact *artifact_create(const char *name, const char *path);

// Writes a whole dataset of ROWS rows; the other extents are those of the schema, where
// a symbol among them ("n_particle") takes COLUMNS. DATA in the memory type of the
// schema entry, row-major; copied. Each dataset once; what the schema does not call
// optional must be put before artifact_finish. ROWS may be 0.
void artifact_put(struct artifact *artifact, const char *name, const void *data,
                  int rows);
void artifact_put_table(struct artifact *artifact, const char *name, const void *data,
                        int rows, int columns);

// The same row by row, with the same bytes, while a band of 32 rows is held. The place
// that next_row returns is for the row to be written to. Nothing else may be put into
// the artifact from begin to end.
struct row_writer {
    struct artifact *artifact;
    const json_t *entry;
    hid_t dataset;
    int rank;
    hsize_t extent[8];
    size_t row_bytes;
    hsize_t written, held; // rows
    void *band;
};

// Exactly ROWS rows must follow.
struct row_writer artifact_begin_rows(struct artifact *artifact, const char *name,
                                      int rows, int columns);
void *artifact_next_row(struct row_writer *writer);
void artifact_end_rows(struct row_writer *writer);

// NAME as artifact_get_number takes it.
void artifact_put_number(struct artifact *artifact, const char *name, double value);

// These put /particles, /domain and /bonds; and those with /nodes, /throats and /faces.
void artifact_put_packing(struct artifact *artifact, const struct packing *packing);
void artifact_put_network(struct artifact *artifact, const struct network *network);

// Lets ParaView open it as it is: a /VTKHDF group of hard links (points from POINTS,
// point and cell data from the named datasets; lists end with NULL), vertices when
// throats are NULL, lines between throat nodes otherwise.
void artifact_put_vtk(struct artifact *artifact, const char *points, int n_point,
                      const char *const *point_data, const int32_t (*lines)[2],
                      int n_line, const char *const *cell_data);

// Provenance: from the call, the digests of its inputs (a list, taken over), and MODEL
// (one line a feature that was modelled or left out). Then checks the artifact against
// its own schema, writes it to its path, whole or not at all, and frees it. A breach
// exits 65 where input, checkpoint or mere size of numbers is to blame, else 70; 73 or
// 74 when it cannot be written.
void artifact_finish(struct artifact *artifact, const struct invocation *invocation,
                     json_t *inputs, const char *model);

// What provenance says of one input: {"schema":…, "sha256":…}. The caller owns it.
json_t *input_digest(const struct artifact *input);

// A list of just that one.
json_t *one_input(const struct artifact *input);

// The same end for a JSON artifact: adds the provenance to DOCUMENT, whose inputs'
// digests are INPUTS (taken over), writes it, and frees it.
void finish_json(json_t *document, const struct invocation *invocation, json_t *inputs,
                 const char *model);
