// SPDX-License-Identifier: GPL-3.0-or-later
// Artifacts out, straight to the disk where they go to one. Same input, same bytes: no
// time stamps, and the oldest file layout, set explicitly.
//
// An artifact is whole or not there. artifact_create makes a file without a name in the
// folder of the output (in memory for standard output and devices: basics/file.h), the
// put functions fill it, and artifact_finish adds the provenance, has it checked
// against its own schema and only then gives it its name. However a program ends before
// that, nothing is left, and what stood at the path still stands there.
//
//     /                   attributes, text: schema, program, parameters, inputs, model
//     /GROUP/NAME         dataset; type and shape by the schema; deflated in chunks if
//                         it is large and "packed" in the schema; attributes, text:
//                         units, long_name
//     /summary, /liquid   groups with one attribute a number
//     /VTKHDF             attributes Type, Version; datasets NumberOfPoints (1),
//                         NumberOfCells (1), NumberOfConnectivityIds (1), Points
//                         (n_point, 3), Connectivity (size n_cell), Offsets
//                         (n_cell + 1), Types (n_cell); groups PointData and
//                         CellData; Points and all in these are hard links
#include "artifacts/artifact.h"
#include "artifacts/check.h"
#include "artifacts/document.h"
#include "basics/memory.h"
#include "basics/status.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

// A list of properties for making one of CLASS, for the caller to close. By default
// each object would carry the time at which it was made.
static hid_t untimed(hid_t class)
{
    const hid_t list = H5Pcreate(class);
    H5Pset_obj_track_times(list, 0);
    return list;
}

// Ends the program when an HDF5 call fails that writes nothing yet: nothing the user
// did.
static hid_t done(hid_t result, const char *what)
{
    if (result < 0) die(STATUS_INTERNAL, "HDF5 failed on %s", what);
    return result;
}

// Ends the program when bytes cannot be written, on a full disk.
static void wrote(const struct artifact *artifact, herr_t result)
{
    if (result >= 0) return;
    const bool to_file = strcmp(artifact->path, "-");
    die(STATUS_IO, "%s: %s", to_file ? artifact->path : "standard output",
        strerror(errno));
}

// HDF5 opens the file by its descriptor (/proc/self/fd), as it has no name yet.
struct artifact *artifact_create(const char *name, const char *path)
{
    struct artifact *artifact = NEW_ARRAY(struct artifact, 1);
    artifact->schema = schema_find(name);
    if (!artifact->schema) die(STATUS_INTERNAL, "%s: no such schema", name);
    artifact->path = path;
    artifact->descriptor = open_unnamed(path);
    hdf5_begin();

    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V18);
    // The usual driver wants to know the real name, and there is none.
    H5Pset_fapl_stdio(access);
    const hid_t creation = untimed(H5P_FILE_CREATE);
    char file[DESCRIPTOR_NAME];
    name_of_descriptor(artifact->descriptor, file);
    artifact->file = H5Fcreate(file, H5F_ACC_TRUNC, creation, access);
    wrote(artifact, artifact->file < 0 ? -1 : 0);
    H5Pclose(creation);
    H5Pclose(access);
    return artifact;
}

// Of fixed length, padded with nulls; an empty text gets the one null that HDF5 asks
// for.
static void put_text_attribute(hid_t object, const char *name, const char *text)
{
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, strlen(text) ? strlen(text) : 1);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute =
        done(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), name);
    done(H5Awrite(attribute, type, text), name);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
}

// Groups made on the way by HDF5 itself would carry a time stamp: make them beforehand.
static void make_groups(hid_t file, const char *name)
{
    char path[256];
    for (const char *slash = strchr(name + 1, '/'); slash;
         slash = strchr(slash + 1, '/')) {
        snprintf(path, sizeof path, "%.*s", (int)(slash - name), name);
        if (H5Lexists(file, path, H5P_DEFAULT) > 0) continue;
        const hid_t creation = untimed(H5P_GROUP_CREATE);
        H5Gclose(
            done(H5Gcreate2(file, path, H5P_DEFAULT, creation, H5P_DEFAULT), path));
        H5Pclose(creation);
    }
}

// Tables over time of which most values stay from row to row are written in chunks of
// PACKED_ROWS rows and PACKED_COLUMNS columns, each deflated by itself: a row of a
// chunk is near enough to the next for deflate, which looks back 32 kB, to find it
// again.
enum { PACKED_ROWS = 32, PACKED_COLUMNS = 512, LEAST_PACKED = 1 << 20 };

static void pack_rows(hid_t creation, hid_t memory_type, int rank,
                      const hsize_t *extent)
{
    static const unsigned fastest = 1;
    hsize_t chunk[8], bytes = H5Tget_size(memory_type);
    for (int axis = 0; axis < rank; axis++) {
        const hsize_t most = axis == 0 ? PACKED_ROWS : PACKED_COLUMNS;
        bytes *= extent[axis];
        chunk[axis] = extent[axis] < most ? extent[axis] : most;
    }
    if (bytes < LEAST_PACKED) return;
    H5Pset_chunk(creation, rank, chunk);
    H5Pset_deflate(creation, fastest);
}

// An open dataset without values, for the caller to close once it has its attributes.
static hid_t make_dataset(const struct artifact *artifact, const char *name,
                          hid_t file_type, hid_t memory_type, int rank,
                          const hsize_t *extent, bool packed)
{
    const hid_t file = artifact->file;
    make_groups(file, name);
    const hid_t space = H5Screate_simple(rank, extent, NULL);
    const hid_t creation = untimed(H5P_DATASET_CREATE);
    if (packed) pack_rows(creation, memory_type, rank, extent);
    const hid_t dataset = done(
        H5Dcreate2(file, name, file_type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
        name);
    H5Pclose(creation);
    H5Sclose(space);
    return dataset;
}

// One without attributes. A full disk may show here, hence `wrote`.
static void put_list(const struct artifact *artifact, const char *name, hid_t file_type,
                     hid_t memory_type, int count, const void *data)
{
    const hid_t dataset = make_dataset(artifact, name, file_type, memory_type, 1,
                                       &(hsize_t){(hsize_t)count}, false);
    wrote(artifact,
          H5Dwrite(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data));
    H5Dclose(dataset);
}

// Numbers in the schema's shape are extents; its symbols, but the first, take COLUMNS.
static int extents_of(const json_t *entry, int rows, int columns, hsize_t *extent)
{
    const json_t *shape = json_object_get(entry, "shape");
    extent[0] = (hsize_t)rows;
    for (size_t axis = 1; axis < json_array_size(shape); axis++) {
        const json_t *wanted = json_array_get(shape, axis);
        extent[axis] = json_is_integer(wanted) ? (hsize_t)json_integer_value(wanted)
                                               : (hsize_t)columns;
    }
    return (int)json_array_size(shape);
}

// A band of rows is as high as the chunks, so that each of these is deflated once.
struct row_writer artifact_begin_rows(struct artifact *artifact, const char *name,
                                      int rows, int columns)
{
    struct row_writer writer = {.artifact = artifact,
                                .entry = schema_dataset(artifact->schema, name)};
    if (!writer.entry)
        die(STATUS_INTERNAL, "%s: not in schema %s", name, artifact->schema->name);
    const hid_t type = entry_memory_type(writer.entry);
    writer.rank = extents_of(writer.entry, rows, columns, writer.extent);
    writer.dataset = make_dataset(
        artifact, name, entry_file_type(writer.entry), type, writer.rank, writer.extent,
        json_is_true(json_object_get(writer.entry, "packed")));
    writer.row_bytes = H5Tget_size(type);
    for (int axis = 1; axis < writer.rank; axis++)
        writer.row_bytes *= writer.extent[axis];
    return writer;
}

// Values are those in memory from row FIRST on.
static void write_rows(struct row_writer *writer, hsize_t first, hsize_t rows,
                       const void *data)
{
    hsize_t start[8] = {first}, count[8] = {rows};
    for (int axis = 1; axis < writer->rank; axis++)
        count[axis] = writer->extent[axis];
    const hid_t space = H5Dget_space(writer->dataset);
    const hid_t memory = H5Screate_simple(writer->rank, count, NULL);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL);
    wrote(writer->artifact, H5Dwrite(writer->dataset, entry_memory_type(writer->entry),
                                     memory, space, H5P_DEFAULT, data));
    H5Sclose(memory);
    H5Sclose(space);
}

static void write_band(struct row_writer *writer)
{
    write_rows(writer, writer->written, writer->held, writer->band);
    writer->written += writer->held;
    writer->held = 0;
}

void *artifact_next_row(struct row_writer *writer)
{
    if (!writer->band) writer->band = allocate(PACKED_ROWS, writer->row_bytes);
    if (writer->held == PACKED_ROWS) write_band(writer);
    return (char *)writer->band + writer->held++ * writer->row_bytes;
}

// What is written is checked by artifact_finish, not here.
void artifact_end_rows(struct row_writer *writer)
{
    if (writer->held > 0) write_band(writer);
    put_text_attribute(writer->dataset, "units",
                       json_string_value(json_object_get(writer->entry, "units")));
    put_text_attribute(writer->dataset, "long_name",
                       json_string_value(json_object_get(writer->entry, "text")));
    H5Dclose(writer->dataset);
    free(writer->band);
}

void artifact_put_table(struct artifact *artifact, const char *name, const void *data,
                        int rows, int columns)
{
    struct row_writer writer = artifact_begin_rows(artifact, name, rows, columns);
    write_rows(&writer, 0, (hsize_t)rows, data);
    artifact_end_rows(&writer);
}

void artifact_put(struct artifact *artifact, const char *name, const void *data,
                  int rows)
{
    artifact_put_table(artifact, name, data, rows, 0);
}

// HDF5 converts to the type of the schema: whole numbers come as doubles, too.
void artifact_put_number(struct artifact *artifact, const char *name, double value)
{
    const json_t *entry = schema_attribute(artifact->schema, name);
    if (!entry)
        die(STATUS_INTERNAL, "%s: not in schema %s", name, artifact->schema->name);
    make_groups(artifact->file, name);
    char group[128];
    snprintf(group, sizeof group, "%.*s", (int)(strrchr(name, '/') - name), name);
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute =
        done(H5Acreate_by_name(artifact->file, group, strrchr(name, '/') + 1,
                               entry_file_type(entry), space, H5P_DEFAULT, H5P_DEFAULT,
                               H5P_DEFAULT),
             name);
    done(H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value), name);
    H5Aclose(attribute);
    H5Sclose(space);
}

// A dataset a member; none at all where there are no bodies.
static void put_bodies(struct artifact *artifact, const struct packing *packing)
{
    const int n = packing->n_body;
    uint8_t shape[MOST_BODIES], within[MOST_BODIES];
    struct vector lower[MOST_BODIES], upper[MOST_BODIES];
    if (!n) return;
    for (int k = 0; k < n; k++) {
        shape[k] = packing->body[k].shape;
        within[k] = packing->body[k].within;
        lower[k] = packing->body[k].lower;
        upper[k] = packing->body[k].upper;
    }
    artifact_put(artifact, "/domain/bodies/shape", shape, n);
    artifact_put(artifact, "/domain/bodies/within", within, n);
    artifact_put(artifact, "/domain/bodies/lower", lower, n);
    artifact_put(artifact, "/domain/bodies/upper", upper, n);
}

void artifact_put_packing(struct artifact *artifact, const struct packing *packing)
{
    artifact_put(artifact, "/particles/position", packing->position,
                 packing->n_particle);
    artifact_put(artifact, "/particles/radius", packing->radius, packing->n_particle);
    if (packing->kind)
        artifact_put(artifact, "/particles/kind", packing->kind, packing->n_particle);
    artifact_put(artifact, "/domain/lower", &packing->lower, 3);
    artifact_put(artifact, "/domain/upper", &packing->upper, 3);
    artifact_put(artifact, "/domain/periodic", packing->periodic, 3);
    put_bodies(artifact, packing);
    artifact_put(artifact, "/bonds/particles", packing->bond, packing->n_bond);
    if (packing->bond_strength)
        artifact_put(artifact, "/bonds/relative_strength", packing->bond_strength,
                     packing->n_bond);
}

// Each is left out where its array is NULL: such throats conduct as cylinders.
static void put_throat_shapes(struct artifact *artifact, const struct network *network)
{
    const int n = network->n_throat;
    if (network->throat_diffusion)
        artifact_put(artifact, "/throats/diffusive_conductance",
                     network->throat_diffusion, n);
    if (network->throat_flow)
        artifact_put(artifact, "/throats/hydraulic_conductance", network->throat_flow,
                     n);
    if (network->throat_hydraulic_radius)
        artifact_put(artifact, "/throats/hydraulic_radius",
                     network->throat_hydraulic_radius, n);
}

// The packing goes along. Arrays that are NULL are left out: then throats are
// cylinders, or the box does not repeat.
void artifact_put_network(struct artifact *artifact, const struct network *network)
{
    const int n_face_node = (int)network->face_offset[network->n_face];
    artifact_put_packing(artifact, &network->packing);
    artifact_put(artifact, "/nodes/position", network->node_position, network->n_node);
    artifact_put(artifact, "/nodes/kind", network->node_walls, network->n_node);
    artifact_put(artifact, "/throats/nodes", network->throat_nodes, network->n_throat);
    artifact_put(artifact, "/throats/radius", network->throat_radius,
                 network->n_throat);
    artifact_put(artifact, "/throats/length", network->throat_length,
                 network->n_throat);
    artifact_put(artifact, "/throats/kind", network->throat_kind, network->n_throat);
    if (network->throat_volume)
        artifact_put(artifact, "/throats/volume", network->throat_volume,
                     network->n_throat);
    put_throat_shapes(artifact, network);
    artifact_put(artifact, "/faces/offset", network->face_offset, network->n_face + 1);
    artifact_put(artifact, "/faces/nodes", network->face_nodes, n_face_node);
    artifact_put(artifact, "/faces/particles", network->face_particles,
                 network->n_face);
    if (!network->throat_image) return;
    artifact_put(artifact, "/throats/image", network->throat_image, network->n_throat);
    artifact_put(artifact, "/faces/image", network->face_image, network->n_face);
    artifact_put(artifact, "/faces/node_image", network->face_node_image, n_face_node);
}

// ---- ParaView -----------------------------------------------------------------------

// ParaView wants a row for each part of a grid; here there is one part.
static void put_count(const struct artifact *artifact, const char *name, int64_t count)
{
    put_list(artifact, name, H5T_STD_I64LE, H5T_NATIVE_INT64, 1, &count);
}

static void put_indices(const struct artifact *artifact, const char *name,
                        const int32_t *index, int count)
{
    put_list(artifact, name, H5T_STD_I32LE, H5T_NATIVE_INT32, count, index);
}

// A byte that all have in common, and which takes no room.
static void put_types(hid_t file, int count, uint8_t type)
{
    const hid_t space = H5Screate_simple(1, &(hsize_t){(hsize_t)count}, NULL);
    const hid_t creation = untimed(H5P_DATASET_CREATE);
    H5Pset_fill_value(creation, H5T_NATIVE_UINT8, &type);
    H5Dclose(done(H5Dcreate2(file, "/VTKHDF/Types", H5T_STD_U8LE, space, H5P_DEFAULT,
                             creation, H5P_DEFAULT),
                  "/VTKHDF/Types"));
    H5Pclose(creation);
    H5Sclose(space);
}

// Type must be ASCII, of exactly its length, padded with nulls: the readers of ParaView
// 5.11 take the size of the string type for its length.
static void put_vtk_header(hid_t file)
{
    make_groups(file, "/VTKHDF/");
    const hid_t group = H5Gopen2(file, "/VTKHDF", H5P_DEFAULT);
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, strlen("UnstructuredGrid"));
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    const hid_t scalar = H5Screate(H5S_SCALAR);
    const hid_t kind =
        H5Acreate2(group, "Type", type, scalar, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(kind, type, "UnstructuredGrid");
    const hid_t pair = H5Screate_simple(1, &(hsize_t){2}, NULL);
    const hid_t version =
        H5Acreate2(group, "Version", H5T_STD_I64LE, pair, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(version, H5T_NATIVE_INT64, (int64_t[]){1, 0});
    H5Aclose(version);
    H5Aclose(kind);
    H5Sclose(pair);
    H5Sclose(scalar);
    H5Tclose(type);
    H5Gclose(group);
}

// Cells of SIZE points each: vertices (1) or lines (2). Cell c has the entries
// OFFSETS[c] to OFFSETS[c + 1] - 1 of the connectivity. Of vertices that is 0, 1, 2,
// ..., the same as their offsets.
static void put_vtk_cells(const struct artifact *artifact, const int32_t *connectivity,
                          int n_cell, int size)
{
    enum { VTK_VERTEX = 1, VTK_LINE = 3 };
    int32_t *offsets = NEW_ARRAY(int32_t, n_cell + 1);
    for (int c = 0; c < n_cell; c++)
        offsets[c + 1] = size * (c + 1);
    put_count(artifact, "/VTKHDF/NumberOfCells", n_cell);
    put_count(artifact, "/VTKHDF/NumberOfConnectivityIds", (int64_t)size * n_cell);
    put_indices(artifact, "/VTKHDF/Connectivity", size == 1 ? offsets : connectivity,
                size * n_cell);
    put_indices(artifact, "/VTKHDF/Offsets", offsets, n_cell + 1);
    put_types(artifact->file, n_cell, size == 1 ? VTK_VERTEX : VTK_LINE);
    free(offsets);
}

// Hard links: one dataset under two names, which takes no room. The last part of its
// name is the array's in ParaView.
static void link_data(hid_t file, const char *group, const char *const *names)
{
    for (int k = 0; names && names[k]; k++) {
        char path[128];
        snprintf(path, sizeof path, "/VTKHDF/%s/%s", group, strrchr(names[k], '/') + 1);
        make_groups(file, path);
        done(H5Lcreate_hard(file, names[k], file, path, H5P_DEFAULT, H5P_DEFAULT),
             path);
    }
}

void artifact_put_vtk(struct artifact *artifact, const char *points, int n_point,
                      const char *const *point_data, const int32_t (*lines)[2],
                      int n_line, const char *const *cell_data)
{
    const hid_t file = artifact->file;
    put_vtk_header(file);
    put_count(artifact, "/VTKHDF/NumberOfPoints", n_point);
    put_vtk_cells(artifact, lines ? lines[0] : NULL, lines ? n_line : n_point,
                  lines ? 2 : 1);
    done(H5Lcreate_hard(file, points, file, "/VTKHDF/Points", H5P_DEFAULT, H5P_DEFAULT),
         points);
    link_data(file, "PointData", point_data);
    link_data(file, "CellData", cell_data);
}

// ---- provenance and the end ---------------------------------------------------------

json_t *input_digest(const struct artifact *input)
{
    return json_pack("{s:s,s:s}", "schema", input->schema->id, "sha256", input->sha256);
}

json_t *one_input(const struct artifact *input)
{
    return json_pack("[o]", input_digest(input));
}

// Members every artifact carries. Takes INPUTS over.
static json_t *provenance(const struct invocation *invocation, json_t *inputs,
                          const char *model)
{
    char program[64];
    return json_pack("{s:s,s:O,s:o,s:s}", "program",
                     stage_program(invocation->stage, program), "parameters",
                     invocation->parameters, "inputs", inputs, "model", model);
}

// Texts as they are, JSON with sorted keys and without blanks: equal runs give equal
// bytes. Takes MEMBERS over.
static void put_provenance(struct artifact *artifact, json_t *members)
{
    const hid_t root = H5Gopen2(artifact->file, "/", H5P_DEFAULT);
    const char *key;
    json_t *value;
    put_text_attribute(root, "schema", artifact->schema->id);
    json_object_foreach(members, key, value)
    {
        char *text = json_is_string(value) ? strdup(json_string_value(value))
                                           : json_canonical(value);
        put_text_attribute(root, key, text);
        free(text);
    }
    H5Gclose(root);
    json_decref(members);
}

// Flushed first, so that the check reads what was written and knows the size. A breach
// is blamed on the input where a stage only transcribes, on the checkpoint where the
// run went on from one, on the sizes given where a number is merely too large, else on
// us.
void artifact_finish(struct artifact *artifact, const struct invocation *invocation,
                     json_t *inputs, const char *model)
{
    put_provenance(artifact, provenance(invocation, inputs, model));

    wrote(artifact, H5Fflush(artifact->file, H5F_SCOPE_GLOBAL));
    hsize_t size;
    done(H5Fget_filesize(artifact->file, &size), "size");
    struct reason reason;
    const enum status status =
        check_file(artifact->file, artifact->schema, size, &reason);
    if (status && invocation->stage->transcribes)
        die(STATUS_BAD_DATA, "%s: gives no %s: %s",
            input_name(invocation->n_input ? invocation->inputs[0] : "-"),
            artifact->schema->name, reason.text);
    if (status && invocation->resumed)
        die(STATUS_BAD_DATA, "%s: is no state of this run: it comes to %s",
            invocation->checkpoint, reason.text);
    if (status == STATUS_NO) // of sizes given, none by itself too large or small
        die(STATUS_BAD_DATA, "the results are out of range: %s", reason.text);
    if (status)
        die(STATUS_INTERNAL, "would write a %s that breaks its own schema: %s",
            artifact->schema->name, reason.text);
    wrote(artifact, H5Fclose(artifact->file));
    publish(artifact->descriptor, artifact->path);
    schema_free(artifact->schema);
    free(artifact);
}

// DOCUMENT must name its schema. Provenance is members of its first level.
void finish_json(json_t *document, const struct invocation *invocation, json_t *inputs,
                 const char *model)
{
    json_t *members = provenance(invocation, inputs, model);
    json_object_update(document, members);
    json_decref(members);
    struct schema *schema =
        schema_find(json_string_value(json_object_get(document, "schema")));
    struct reason reason;
    if (check_document(document, schema, &reason))
        die(STATUS_INTERNAL, "would write a %s that breaks its own schema: %s",
            schema->name, reason.text);
    schema_free(schema);
    write_json(invocation->output, document);
}
