// SPDX-License-Identifier: GPL-3.0-or-later
// Opening an artifact: its bytes are taken as an image of an HDF5 file; links, kind,
// schema and every value are checked before anything is used. A child process does all
// of that first, since a damaged file may crash the HDF5 library; what it survived the
// program repeats. The getters come after; what they read has been checked.
//
// Opening in order: all bytes, mapped or from a pipe; the signature of HDF5; in the
// child the links (check_links.c), the attribute `schema` of the root, every dataset
// and attribute that the schema lists (check.c) and the provenance; then once more here
// without the checks; last the SHA-256 of the bytes, by which other artifacts name this
// one as their input.
//
// A file that is empty, no HDF5, cut short, without a schema, of an unknown schema, or
// of another kind than wanted gets a line of its own; all exit 65. Rules that no schema
// can say are checked by the getters that know them: bodies, walls, ends of throats.
#include "artifacts/artifact.h"
#include "artifacts/check.h"
#include "basics/memory.h"
#include "basics/status.h"

#include <ctype.h>
#include <errno.h>
#include <hdf5_hl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

const char *const provenance_names[] = {"program", "parameters", "inputs", "model",
                                        NULL};

// Parameters given without -p are what JSON here mostly is, and grains what other text
// is (it may begin with the mark of UTF-8), so the message says how they go.
static const char *hint_for(char first)
{
    if (first == '{') return "; parameters, in JSON, go by -p";
    return isprint((unsigned char)first) || first == '\xef'
               ? "; grains as text go to pack first"
               : "";
}

// HDF5 reads from IMAGE itself, not from a copy: it must outlive the file.
static hid_t open_image(const char *path, const struct bytes *image)
{
    if (image->size == 0) die(STATUS_BAD_DATA, "%s: is empty", input_name(path));
    if (!is_hdf5(image))
        die(STATUS_BAD_DATA, "%s: is not an HDF5 file%s", input_name(path),
            hint_for((char)image->data[0]));
    hdf5_begin();
    const hid_t file =
        H5LTopen_file_image(image->data, image->size,
                            H5LT_FILE_IMAGE_DONT_COPY | H5LT_FILE_IMAGE_DONT_RELEASE);
    if (file < 0)
        die(STATUS_BAD_DATA, "%s: is a truncated or damaged HDF5 file",
            input_name(path));
    return file;
}

// Strings of variable length are those of h5py, of fixed length those of
// put_text_attribute. One that claims more than the file holds is damage: NULL.
char *artifact_get_text(const struct artifact *artifact, const char *name)
{
    const hid_t attribute = H5Aopen(artifact->file, name, H5P_DEFAULT);
    if (attribute < 0) return NULL;
    const hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
    const bool one =
        H5Tget_class(type) == H5T_STRING && H5Sget_simple_extent_npoints(space) == 1;
    char *text = NULL;
    if (one && H5Tis_variable_str(type) > 0) { // as h5py writes
        char *variable = NULL;
        if (H5Aread(attribute, type, &variable) >= 0 && variable)
            text = duplicate(variable, strlen(variable) + 1, 1);
        H5free_memory(variable);
    } else if (one && H5Tget_size(type) <= artifact->image.size) {
        text = allocate(H5Tget_size(type) + 1, 1);
        if (H5Aread(attribute, type, text) < 0) text[0] = 0;
    }
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(attribute);
    return text;
}

// What is made of what, and by which stage.
static const struct {
    const char *kind, *next_stage;
} chain[] = {{"packing", "tessellate"},
             {"network", "dry"},
             {"drying", "force-protocol"},
             {"forces", "dem-replay"},
             {"response", "crackstats"}};
enum { KINDS = sizeof chain / sizeof *chain };

// KINDS for what is not in it.
static int place_in_chain(const char *kind)
{
    int place = 0;
    while (place < KINDS && strcmp(chain[place].kind, kind))
        place++;
    return place;
}

// From the place of GOT up to that of WANTED; nothing is advised where WANTED comes
// before GOT or one of them is not in the chain.
void refuse_kind(const char *path, const char *wanted, const char *got)
{
    char stages[100] = "";
    const int end = place_in_chain(wanted);
    for (int k = place_in_chain(got); k < end && end < KINDS; k++)
        snprintf(stages + strlen(stages), sizeof stages - strlen(stages), "%s%s",
                 *stages ? ", then " : ": first run ", chain[k].next_stage);
    die(STATUS_BAD_DATA, "%s: must be a %s, is a %s%s", input_name(path), wanted, got,
        stages);
}

// schema_find goes by the name alone and would take any version: so the ids are
// compared, and the message says which version is known. NAME NULL: any kind will do.
static struct schema *schema_of(const struct artifact *artifact, const char *name)
{
    const char *path = input_name(artifact->path);
    char *id = artifact_get_text(artifact, "schema");
    if (!id)
        die(STATUS_BAD_DATA, "%s: is not an artifact: it has no schema attribute",
            path);
    struct schema *schema = schema_find(id);
    if (!schema || strcmp(schema->id, id))
        die(STATUS_BAD_DATA, "%s: schema %s is unknown%s%s", path, id,
            schema ? "; this program knows " : "", schema ? schema->id : "");
    if (name && strcmp(schema->name, name)) refuse_kind(path, name, schema->name);
    free(id);
    return schema;
}

static void open_unchecked(struct artifact *artifact, const char *name)
{
    artifact->file = open_image(artifact->path, &artifact->image);
    artifact->schema = schema_of(artifact, name);
}

// In an opening of its own: what this look leaves in the library's caches may hide
// damage from the next.
static void check_nothing_leads_out(const struct artifact *artifact)
{
    struct reason reason;
    const hid_t file = open_image(artifact->path, &artifact->image);
    if (check_links(file, &reason))
        die(STATUS_BAD_DATA, "%s: %s", input_name(artifact->path), reason.text);
    H5Fclose(file);
}

// Reads all that anyone may read later.
static void check(const struct artifact *artifact)
{
    struct reason reason;
    const enum status status =
        check_file(artifact->file, artifact->schema, artifact->image.size, &reason);
    if (status) die(STATUS_BAD_DATA, "%s: %s", input_name(artifact->path), reason.text);
    for (int k = 0; provenance_names[k]; k++)
        free(artifact_get_text(artifact, provenance_names[k]));
}

// The HDF5 library may crash on a damaged file, so a child looks at it first and dies
// in our place. What it could read we can: the bytes are the same.
static void check_apart(struct artifact *artifact, const char *name)
{
    const pid_t child = fork();
    if (child <= 0) {
        check_nothing_leads_out(artifact);
        open_unchecked(artifact, name);
        check(artifact);
        if (child == 0) _exit(STATUS_OK);
        H5Fclose(artifact->file); // no child could be had: we looked ourselves
        schema_free(artifact->schema);
        return;
    }
    int end;
    while (waitpid(child, &end, 0) < 0 && errno == EINTR)
        continue;
    if (WIFEXITED(end) && WEXITSTATUS(end)) exit(WEXITSTATUS(end)); // it said why
    if (!WIFSIGNALED(end)) return;
    const int signal = WTERMSIG(end);
    if (signal != SIGSEGV && signal != SIGBUS && signal != SIGFPE && signal != SIGABRT)
        raise(signal); // not its fault: interrupted
    die(STATUS_BAD_DATA, "%s: is a damaged HDF5 file: the HDF5 library fails on it: %s",
        input_name(artifact->path), strsignal(signal));
}

struct artifact *artifact_open(const char *path, const char *name)
{
    return artifact_open_bytes(path, read_whole_of(path, is_hdf5), name);
}

struct artifact *artifact_open_bytes(const char *path, struct bytes bytes,
                                     const char *name)
{
    struct artifact *artifact = NEW_ARRAY(struct artifact, 1);
    artifact->path = path;
    artifact->image = bytes;
    check_apart(artifact, name);
    open_unchecked(artifact, name);
    sha256(artifact->image.data, artifact->image.size, artifact->sha256);
    release_pages(&artifact->image);
    return artifact;
}

// The file before the image that it reads from.
void artifact_close(struct artifact *artifact)
{
    if (!artifact) return;
    H5Fclose(artifact->file);
    schema_free(artifact->schema);
    bytes_free(&artifact->image);
    free(artifact);
}

static const json_t *entry_of(const struct artifact *artifact, const char *name)
{
    const json_t *entry = schema_dataset(artifact->schema, name);
    if (!entry)
        die(STATUS_INTERNAL, "%s: not in schema %s", name, artifact->schema->name);
    return entry;
}

// Class, rank and size were checked; width and byte order are converted by HDF5. Rows
// fit into an int: check_size refuses more.
void *artifact_get(const struct artifact *artifact, const char *name, int *rows)
{
    const json_t *entry = entry_of(artifact, name);
    const hid_t dataset = H5Dopen2(artifact->file, name, H5P_DEFAULT);
    const hid_t space = H5Dget_space(dataset);
    hsize_t extent[8] = {0};
    H5Sget_simple_extent_dims(space, extent, NULL);
    const size_t count = (size_t)H5Sget_simple_extent_npoints(space);
    H5Sclose(space);

    void *data = allocate(count, H5Tget_size(entry_memory_type(entry)));
    if (H5Dread(dataset, entry_memory_type(entry), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                data) < 0)
        die(STATUS_BAD_DATA, "%s: %s: cannot be read", input_name(artifact->path),
            name);
    H5Dclose(dataset);
    release_pages(&artifact->image);
    if (rows) *rows = (int)extent[0];
    return data;
}

// ---- row by row ---------------------------------------------------------------------

// Rows of a million grains have 24 MB: then a band is a part of a chunk, which is
// unpacked for each of its parts.
static const size_t MOST_BAND_BYTES = 256 << 20;

// As many as a chunk has; what lies in one piece can be read anywhere.
static hsize_t rows_of_band(const struct row_reader *reader)
{
    enum { ROWS = 32 };
    hsize_t chunk[8] = {ROWS};
    const hid_t creation = H5Dget_create_plist(reader->dataset);
    if (H5Pget_layout(creation) == H5D_CHUNKED)
        H5Pget_chunk(creation, reader->rank, chunk);
    H5Pclose(creation);
    hsize_t rows = chunk[0];
    while (rows > 1 && rows * reader->row_bytes > MOST_BAND_BYTES)
        rows = (rows + 1) / 2;
    return rows;
}

struct row_reader artifact_read_rows(const struct artifact *artifact, const char *name)
{
    struct row_reader reader = {.artifact = artifact, .name = name};
    reader.type = entry_memory_type(entry_of(artifact, name));
    reader.dataset = H5Dopen2(artifact->file, name, H5P_DEFAULT);
    const hid_t space = H5Dget_space(reader.dataset);
    reader.rank = H5Sget_simple_extent_dims(space, reader.extent, NULL);
    H5Sclose(space);
    reader.row_bytes = H5Tget_size(reader.type);
    for (int axis = 1; axis < reader.rank; axis++)
        reader.row_bytes *= reader.extent[axis];
    reader.most = rows_of_band(&reader);
    reader.band = allocate_uncleared(reader.most, reader.row_bytes);
    return reader;
}

static void read_band(struct row_reader *reader, hsize_t first)
{
    const hsize_t left = reader->extent[0] - first;
    hsize_t start[8] = {first}, count[8] = {left < reader->most ? left : reader->most};
    for (int axis = 1; axis < reader->rank; axis++)
        count[axis] = reader->extent[axis];
    const hid_t space = H5Dget_space(reader->dataset);
    const hid_t memory = H5Screate_simple(reader->rank, count, NULL);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL);
    if (H5Dread(reader->dataset, reader->type, memory, space, H5P_DEFAULT,
                reader->band) < 0)
        die(STATUS_BAD_DATA, "%s: %s: cannot be read",
            input_name(reader->artifact->path), reader->name);
    H5Sclose(memory);
    H5Sclose(space);
    release_pages(&reader->artifact->image);
    reader->first = first;
    reader->held = count[0];
}

const void *artifact_row(struct row_reader *reader, int row)
{
    const hsize_t k = (hsize_t)row;
    if (k < reader->first || k >= reader->first + reader->held)
        read_band(reader, k - k % reader->most);
    return (const char *)reader->band + (k - reader->first) * reader->row_bytes;
}

void row_reader_free(struct row_reader *reader)
{
    if (reader->band) H5Dclose(reader->dataset);
    free(reader->band);
    *reader = (struct row_reader){0};
}

static bool artifact_has(const struct artifact *artifact, const json_t *entry)
{
    return entry && has_entry(artifact->file, entry);
}

// For those who look at any dataset alike (inspect, artdiff): NAME must be there.
struct dataset_values artifact_get_values(const struct artifact *artifact,
                                          const char *name)
{
    struct dataset_values values = {0};
    const hid_t dataset = H5Dopen2(artifact->file, name, H5P_DEFAULT);
    const hid_t space = H5Dget_space(dataset);
    values.rank = H5Sget_simple_extent_dims(space, values.extent, NULL);
    values.count = (size_t)H5Sget_simple_extent_npoints(space);
    values.value = NEW_ARRAY(double, values.count);
    if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                values.value) < 0)
        die(STATUS_BAD_DATA, "%s: %s: cannot be read", input_name(artifact->path),
            name);
    H5Sclose(space);
    H5Dclose(dataset);
    return values;
}

bool artifact_has_dataset(const struct artifact *artifact, const char *name)
{
    return artifact_has(artifact, schema_dataset(artifact->schema, name));
}

bool artifact_has_number(const struct artifact *artifact, const char *name)
{
    return artifact_has(artifact, schema_attribute(artifact->schema, name));
}

// What is behind the last slash of NAME is the attribute, what is before it the group.
double artifact_get_number(const struct artifact *artifact, const char *name)
{
    char group[128];
    snprintf(group, sizeof group, "%.*s", (int)(strrchr(name, '/') - name), name);
    const hid_t attribute = H5Aopen_by_name(
        artifact->file, group, strrchr(name, '/') + 1, H5P_DEFAULT, H5P_DEFAULT);
    double value;
    if (attribute < 0 || H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) < 0)
        die(STATUS_BAD_DATA, "%s: %s: cannot be read", input_name(artifact->path),
            name);
    H5Aclose(attribute);
    return value;
}

// Those of /domain/bodies, which no one else checks: all four datasets or none.
static void get_bodies(const struct artifact *artifact, struct packing *packing)
{
    static const char *const names[] = {"/domain/bodies/shape", "/domain/bodies/within",
                                        "/domain/bodies/lower", "/domain/bodies/upper"};
    int n = 0, given = 0;
    for (int k = 0; k < 4; k++)
        given += artifact_has_dataset(artifact, names[k]);
    if (!given) return;
    for (int k = 0; k < 4; k++)
        if (!artifact_has_dataset(artifact, names[k]))
            die(STATUS_BAD_DATA, "%s: %s: is missing", input_name(artifact->path),
                names[k]);
    uint8_t *shape = artifact_get(artifact, names[0], &n);
    uint8_t *within = artifact_get(artifact, names[1], NULL);
    struct vector *lower = artifact_get(artifact, names[2], NULL);
    struct vector *upper = artifact_get(artifact, names[3], NULL);
    if (n > MOST_BODIES)
        die(STATUS_BAD_DATA, "%s: %s: must have at most %d rows, got %d",
            input_name(artifact->path), names[0], MOST_BODIES, n);
    for (int k = 0; k < n; k++) {
        packing->body[k] = (struct body){shape[k], within[k], lower[k], upper[k]};
        if (!body_is_one(&packing->body[k]))
            die(STATUS_BAD_DATA, "%s: %s: row %d: must be < %s",
                input_name(artifact->path), names[2], k, names[3]);
    }
    packing->n_body = n;
    free(shape);
    free(within);
    free(lower);
    free(upper);
}

// /domain has three datasets of 3 values: lower, upper, periodic. Without
// /particles/kind all are solid.
struct packing artifact_get_packing(const struct artifact *artifact)
{
    struct packing packing = {0};
    packing.position =
        artifact_get(artifact, "/particles/position", &packing.n_particle);
    packing.radius = artifact_get(artifact, "/particles/radius", NULL);
    if (artifact_has_dataset(artifact, "/particles/kind"))
        packing.kind = artifact_get(artifact, "/particles/kind", NULL);
    packing.bond = artifact_get(artifact, "/bonds/particles", &packing.n_bond);
    if (artifact_has_dataset(artifact, "/bonds/relative_strength"))
        packing.bond_strength =
            artifact_get(artifact, "/bonds/relative_strength", NULL);

    struct vector *lower = artifact_get(artifact, "/domain/lower", NULL);
    struct vector *upper = artifact_get(artifact, "/domain/upper", NULL);
    uint8_t *periodic = artifact_get(artifact, "/domain/periodic", NULL);
    packing.lower = *lower;
    packing.upper = *upper;
    memcpy(packing.periodic, periodic, sizeof packing.periodic);
    free(lower);
    free(upper);
    free(periodic);
    get_bodies(artifact, &packing);
    return packing;
}

struct packing artifact_get_solid_packing(const struct artifact *artifact,
                                          const char *stage)
{
    struct packing packing = artifact_get_packing(artifact);
    for (int i = 0; i < packing.n_particle; i++)
        if (is_auxiliary(&packing, i))
            die(STATUS_BAD_DATA,
                "%s: /particles/kind: grain %d is auxiliary: %s takes packings without "
                "an extra layer (pack.extra_layer)",
                input_name(artifact->path), i, stage);
    return packing;
}

// Each by itself: what is left out stays NULL, and the throat conducts as a cylinder.
static void get_throat_shapes(const struct artifact *artifact, struct network *network)
{
    if (artifact_has_dataset(artifact, "/throats/diffusive_conductance"))
        network->throat_diffusion =
            artifact_get(artifact, "/throats/diffusive_conductance", NULL);
    if (artifact_has_dataset(artifact, "/throats/hydraulic_conductance"))
        network->throat_flow =
            artifact_get(artifact, "/throats/hydraulic_conductance", NULL);
    if (artifact_has_dataset(artifact, "/throats/hydraulic_radius"))
        network->throat_hydraulic_radius =
            artifact_get(artifact, "/throats/hydraulic_radius", NULL);
}

struct network artifact_get_network(const struct artifact *artifact)
{
    if (artifact_has_dataset(artifact, "/throats/image"))
        die(STATUS_BAD_DATA,
            "%s: /domain/periodic: this stage knows no networks in boxes that repeat "
            "yet; pack with periodic=[false,false,false]",
            input_name(artifact->path));
    return artifact_get_periodic_network(artifact);
}

// A throat may join a node to its own image.
static void check_throats_lead_away(const struct artifact *artifact,
                                    const struct network *network)
{
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *ends = network->throat_nodes[t];
        const struct image *image = network->throat_image;
        if (ends[0] != ends[1] || (image && !same_image(image[t], (struct image){0})))
            continue;
        die(STATUS_BAD_DATA,
            "%s: /throats/nodes: row %d: the lower index must come first, got %d, %d",
            input_name(artifact->path), t, ends[0], ends[1]);
    }
}

// The schema lets walls of bodies through, also where there are none. Bits 64 and 128
// of /nodes/kind, and -7 and -8 of /faces/particles, need a body around the grains or
// among them.
static void check_walls(const struct artifact *artifact, const struct network *network)
{
    unsigned walls = (1u << WALL_COUNT) - 1;
    for (int k = 0; k < network->packing.n_body; k++)
        walls |= 1u << body_wall(&network->packing.body[k]);
    for (int i = 0; i < network->n_node; i++)
        if (network->node_walls[i] & ~walls)
            die(STATUS_BAD_DATA,
                "%s: /nodes/kind: row %d: is on the wall of no body of /domain/bodies, "
                "got %d",
                input_name(artifact->path), i, network->node_walls[i]);
    for (int f = 0; f < network->n_face; f++) {
        const int32_t side = network->face_particles[f][1];
        if (side < 0 && !(walls >> (-1 - side) & 1))
            die(STATUS_BAD_DATA,
                "%s: /faces/particles: row %d: is on the wall of no body of "
                "/domain/bodies, got %d",
                input_name(artifact->path), f, side);
    }
}

// The arrays are those of struct network, member by member; images come as a set of
// three. The ends of throats are checked last, as that needs the images.
struct network artifact_get_periodic_network(const struct artifact *artifact)
{
    const struct schema *schema = artifact->schema;
    struct network network = {.packing = artifact_get_packing(artifact)};
    network.node_position = artifact_get(artifact, "/nodes/position", &network.n_node);
    network.node_walls = artifact_get(artifact, "/nodes/kind", NULL);
    network.throat_nodes = artifact_get(artifact, "/throats/nodes", &network.n_throat);
    network.throat_radius = artifact_get(artifact, "/throats/radius", NULL);
    network.throat_length = artifact_get(artifact, "/throats/length", NULL);
    network.throat_kind = artifact_get(artifact, "/throats/kind", NULL);
    network.face_offset = artifact_get(artifact, "/faces/offset", NULL);
    network.face_nodes = artifact_get(artifact, "/faces/nodes", NULL);
    network.face_particles =
        artifact_get(artifact, "/faces/particles", &network.n_face);
    check_walls(artifact, &network);
    if (artifact_has_dataset(artifact, "/throats/volume"))
        network.throat_volume = artifact_get(artifact, "/throats/volume", NULL);
    get_throat_shapes(artifact, &network);
    if (artifact_has(artifact, schema_attribute(schema, "/summary/unmerged_throats"))) {
        network.unmerged_throats =
            (int)artifact_get_number(artifact, "/summary/unmerged_throats");
        network.unmerged_length =
            artifact_get_number(artifact, "/summary/unmerged_length");
    }
    if (artifact_has_dataset(artifact, "/throats/image")) {
        if (!artifact_has_dataset(artifact, "/faces/image") ||
            !artifact_has_dataset(artifact, "/faces/node_image"))
            die(STATUS_BAD_DATA,
                "%s: /throats/image needs /faces/image and /faces/node_image beside it",
                artifact->path);
        network.throat_image = artifact_get(artifact, "/throats/image", NULL);
        network.face_image = artifact_get(artifact, "/faces/image", NULL);
        network.face_node_image = artifact_get(artifact, "/faces/node_image", NULL);
    }
    check_throats_lead_away(artifact, &network);
    return network;
}

// The others of a list would be taken alone.
void refuse_repeated(const struct artifact *artifact, const struct network *network,
                     unsigned walls, const char *key)
{
    for (int wall = 0; wall < 6; wall++)
        if (walls & 1u << wall && network->packing.periodic[wall / 2])
            die(STATUS_BAD_DATA,
                "%s: must not name %c%c, as the box of %s repeats along %c", key,
                wall % 2 ? '+' : '-', "xyz"[wall / 2], input_name(artifact->path),
                "xyz"[wall / 2]);
}

void report_repeated(const struct artifact *artifact, const struct network *network,
                     unsigned walls, const char *key)
{
    char sides[6 * 3 + 1] = "";
    for (int wall = 0; wall < 6; wall++)
        if (walls & 1u << wall && network->packing.periodic[wall / 2])
            sprintf(sides + strlen(sides), " %c%c", wall % 2 ? '+' : '-',
                    "xyz"[wall / 2]);
    if (*sides)
        report("%s: leaves out%s, where the box of %s repeats", key, sides,
               input_name(artifact->path));
}

// /history has a row a step, /changes the throats that change in it: rows offset[k] to
// offset[k+1] - 1 belong to step k.
struct drying_record artifact_get_drying(const struct artifact *artifact)
{
    struct drying_record record;
    record.time = artifact_get(artifact, "/history/time", &record.n_step);
    record.saturation = artifact_get(artifact, "/history/saturation", NULL);
    record.offset = artifact_get(artifact, "/changes/offset", NULL);
    record.throat = artifact_get(artifact, "/changes/throat", NULL);
    record.throat_saturation = artifact_get(artifact, "/changes/saturation", NULL);
    return record;
}

bool artifact_has_rings(const struct artifact *artifact)
{
    return artifact_has_dataset(artifact, "/rings/throat") &&
           artifact_has_dataset(artifact, "/ring_changes/offset");
}

struct ring_record artifact_get_rings(const struct artifact *artifact)
{
    struct ring_record rings = {0};
    rings.face = artifact_get(artifact, "/rings/face", &rings.n);
    rings.separation = artifact_get(artifact, "/rings/separation", NULL);
    rings.offset = artifact_get(artifact, "/rings/offset", NULL);
    rings.throat = artifact_get(artifact, "/rings/throat", NULL);
    rings.volume = artifact_get(artifact, "/rings/volume", NULL);
    rings.changes.offset = artifact_get(artifact, "/ring_changes/offset", NULL);
    rings.changes.throat = artifact_get(artifact, "/ring_changes/node", NULL);
    rings.changes.throat_saturation =
        artifact_get(artifact, "/ring_changes/saturation", NULL);
    return rings;
}
