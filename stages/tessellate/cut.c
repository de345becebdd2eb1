// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts the network by the surface of a convex body [K 3.3.1, step 3]. A throat from
// end[0] to end[1] meets the surface at the times span[0] and span[1] of body_span; a
// node is added there. Each face is then walked corner by corner, and the part on the
// side that stays becomes the new face, closed by the chord between where it leaves
// and comes back. The chords of one grain, joined end to end, are its face on the
// wall. So cells stay closed, and their surface on the wall is a polygon: the volume
// between chords and wall is missing, of order (grain radius / wall radius)^2. Around
// a body that is cut out, what stays of a face need not be one piece, so each part is
// closed by itself.
#include "cut.h"

#include "basics/memory.h"
#include "loops.h"
#include "remove_cells.h"
#include "throats_beside.h"

#include <stdlib.h>

// How a loop crosses the wall at a corner: not, into the part that stays, or out of it.
enum crosses { CROSSES_NOT, CROSSES_IN, CROSSES_OUT };

struct step {
    struct corner corner;
    enum crosses crosses;
};

// One edge of a grain's face on the wall, counter-clockwise as seen from outside.
struct chord {
    struct corner from, to;
};

struct cut {
    struct network *network;
    int k; // which body
    bool within;
    int wall;
    enum clearance clearance;
    struct sphere_cells grains;
    bool *near;             // (n_node) whether a throat of it meets the surface
    bool *holds;            // (n_node) whether the body does
    int32_t (*crossing)[2]; // (n_throat) node where it enters and leaves the body; -1
    struct image *image;    // (n_crossing) of such a node, seen from the first end
    int n_whole;            // nodes before any such
    int node_capacity, image_capacity;
    struct step *step; // of one loop
    int n_step, step_capacity;
    struct corner *path; // what stays of it
    int n_path, path_capacity;
    struct row *chord_row; // keys: the grain, the first end, its image; which chord
    struct chord *chord;
    int n_chord, chord_row_capacity, chord_capacity;
    struct loops loops;
};

static bool stays(const struct cut *cut, int32_t node)
{
    return cut->holds[node] == cut->within;
}

// ---- throats ------------------------------------------------------------------------

static struct image throat_image(const struct cut *cut, int t)
{
    return cut->network->throat_image ? cut->network->throat_image[t]
                                      : (struct image){0};
}

static void find_ends(const struct cut *cut, int t, struct vector end[2])
{
    const struct network *network = cut->network;
    const int32_t *node = network->throat_nodes[t];
    end[0] = network->node_position[node[0]];
    end[1] = add(network->node_position[node[1]],
                 image_offset(&network->packing, throat_image(cut, t)));
}

// Adds a node at TIME (0 to 1) along throat T, moved into a periodic box.
static int32_t add_node(struct cut *cut, int t, const struct vector end[2], double time)
{
    struct network *network = cut->network;
    const int32_t *node = network->throat_nodes[t];
    const int added = network->n_node - cut->n_whole;
    const double part = fmin(fmax(time, 0), 1);
    struct vector at = add(end[0], scale(part, subtract(end[1], end[0])));
    struct image image = {0};
    for (int axis = 0; axis < 3; axis++) {
        if (!network->packing.periodic[axis]) continue;
        const double lower = component(network->packing.lower, axis);
        const double edge = component(network->packing.upper, axis) - lower;
        const double x = component(at, axis), boxes = floor((x - lower) / edge);
        image.along[axis] = (int8_t)boxes;
        set_component(&at, axis, x - boxes * edge);
    }
    if (network->n_node == cut->node_capacity) {
        cut->node_capacity += cut->node_capacity / 2 + 64;
        const size_t room = (size_t)cut->node_capacity;
        network->node_position = reallocate(network->node_position, room, sizeof at);
        network->node_walls = reallocate(network->node_walls, room, 1);
    }
    GROW_ARRAY(cut->image, added, cut->image_capacity);
    cut->image[added] = image;
    network->node_position[network->n_node] = at;
    network->node_walls[network->n_node] =
        (uint8_t)((network->node_walls[node[0]] & network->node_walls[node[1]]) |
                  1 << cut->wall);
    return network->n_node++;
}

// The body is convex: a throat enters it at most once, and leaves it after that.
static void cross_throat(struct cut *cut, int t)
{
    const int32_t *node = cut->network->throat_nodes[t];
    const bool first = cut->holds[node[0]], second = cut->holds[node[1]];
    struct vector end[2];
    double span[2];
    cut->crossing[t][0] = cut->crossing[t][1] = -1;
    if (first && second) return;
    find_ends(cut, t, end);
    const struct body body = body_near(&cut->network->packing, cut->k,
                                       first    ? end[0]
                                       : second ? end[1]
                                                : midpoint(end[0], end[1]));
    bool meets = body_span(&body, end[0], end[1], span);
    if (!meets) span[0] = span[1] = first ? 0 : 1; // grazed, if one end is within
    meets = first || second || (meets && span[0] > 0 && span[1] < 1);
    if (meets && !first) cut->crossing[t][0] = add_node(cut, t, end, span[0]);
    if (meets && !second) cut->crossing[t][1] = add_node(cut, t, end, span[1]);
    if (meets) cut->near[node[0]] = cut->near[node[1]] = true;
}

// The throat between two corners of a face. FORWARD: A is its first node (or its first
// end, if it joins a node to its own image).
static int throat_of(const struct cut *cut, struct corner a, struct corner b,
                     bool *forward)
{
    const struct image apart = image_difference(b.image, a.image);
    const bool same = a.node == b.node;
    *forward = a.node < b.node || (same && image_number(apart) > 0);
    const int32_t ends[2] = {*forward ? a.node : b.node, *forward ? b.node : a.node};
    const struct image image = *forward ? apart : image_opposite(apart);
    for (int t = first_throat_between(cut->network, ends); t < cut->network->n_throat;
         t++) {
        const int32_t *node = cut->network->throat_nodes[t];
        if (node[0] != ends[0] || node[1] != ends[1]) break;
        if (same_image(throat_image(cut, t), image)) return t;
    }
    return -1; // each edge of a face is a throat
}

// ---- faces --------------------------------------------------------------------------

static void add_step(struct cut *cut, struct corner corner, enum crosses crosses)
{
    GROW_ARRAY(cut->step, cut->n_step, cut->step_capacity);
    cut->step[cut->n_step++] = (struct step){corner, crosses};
}

static struct corner corner_of(const struct network *network, int64_t k)
{
    struct corner corner = {.node = network->face_nodes[k]};
    if (network->face_node_image) corner.image = network->face_node_image[k];
    return corner;
}

// Adds the steps from corner A to B: corners that stay, and crossings of the wall.
static void walk_edge(struct cut *cut, struct corner a, struct corner b)
{
    bool forward = true, staying = stays(cut, a.node);
    const bool near = cut->near[a.node] && cut->near[b.node];
    const int t = near ? throat_of(cut, a, b, &forward) : -1;
    if (staying) add_step(cut, a, CROSSES_NOT);
    for (int k = 0; k < 2 && t >= 0; k++) {
        const int32_t node = cut->crossing[t][forward ? k : 1 - k];
        if (node < 0) continue;
        const struct image image =
            image_sum(forward ? a.image : b.image, cut->image[node - cut->n_whole]);
        add_step(cut, (struct corner){node, image}, staying ? CROSSES_OUT : CROSSES_IN);
        staying = !staying;
    }
}

static bool is_near(const struct cut *cut, int f)
{
    const struct network *network = cut->network;
    for (int64_t k = network->face_offset[f]; k < network->face_offset[f + 1]; k++)
        if (cut->near[network->face_nodes[k]]) return true;
    return false;
}

static void walk_face(struct cut *cut, int f)
{
    const struct network *network = cut->network;
    const int64_t begin = network->face_offset[f], end = network->face_offset[f + 1];
    cut->n_step = 0;
    if (!is_near(cut, f) && !stays(cut, network->face_nodes[begin])) return;
    for (int64_t k = begin; k < end; k++)
        walk_edge(cut, corner_of(network, k),
                  corner_of(network, k + 1 < end ? k + 1 : begin));
}

static void add_chord(struct cut *cut, int32_t grain, struct corner from,
                      struct corner to)
{
    GROW_ARRAY(cut->chord_row, cut->n_chord, cut->chord_row_capacity);
    GROW_ARRAY(cut->chord, cut->n_chord, cut->chord_capacity);
    cut->chord_row[cut->n_chord] = (struct row){
        .key = {grain, from.node, image_number(from.image)}, .item = cut->n_chord};
    cut->chord[cut->n_chord++] = (struct chord){from, to};
}

// A face is closed by the chord from where it leaves to where it comes back; the faces
// on the wall of both its grains get the chord in the opposite sense.
static void add_chords(struct cut *cut, int f, struct corner from, struct corner to)
{
    const int32_t *side = cut->network->face_particles[f];
    add_chord(cut, side[0], to, from);
    if (side[1] < 0) return;
    if (cut->network->face_image) {
        const struct image image = cut->network->face_image[f];
        from.image = image_difference(from.image, image);
        to.image = image_difference(to.image, image);
    }
    add_chord(cut, side[1], from, to);
}

static struct image face_image(const struct cut *cut, int f)
{
    return cut->network->face_image ? cut->network->face_image[f] : (struct image){0};
}

// A throat of face F with an end on the wall.
static void add_throat(struct cut *cut, int f, struct corner a, struct corner b)
{
    const struct network *network = cut->network;
    const struct packing *packing = &network->packing;
    const struct vector end[2] = {
        add(network->node_position[a.node], image_offset(packing, a.image)),
        add(network->node_position[b.node], image_offset(packing, b.image))};
    struct clear_way way = nothing_beside;
    for (int side = 0; side < 2; side++) {
        const int32_t grain = network->face_particles[f][side];
        if (grain < 0) continue;
        const struct vector image =
            side ? image_offset(packing, face_image(cut, f)) : (struct vector){0};
        way = clear_of(way, add(packing->position[grain], image),
                       packing->radius[grain], end, cut->clearance);
    }
    const double radius = cut->clearance == CLEARANCE_SEGMENT
                              ? least_clearance(&cut->grains, end, way)
                              : way.least;
    loops_add_throat(&cut->loops, a, b, fmax(0, radius), distance(end[0], end[1]));
}

static void end_path(struct cut *cut, int f)
{
    loops_append(&cut->loops, cut->network->face_particles[f], face_image(cut, f),
                 cut->path, cut->n_path);
    for (int k = 0; k < cut->n_path && cut->n_path > 1; k++) {
        const struct corner a = cut->path[k];
        const struct corner b = cut->path[k + 1 < cut->n_path ? k + 1 : 0];
        if (a.node >= cut->n_whole || b.node >= cut->n_whole) add_throat(cut, f, a, b);
    }
    cut->n_path = 0;
}

static void add_to_path(struct cut *cut, struct corner corner)
{
    GROW_ARRAY(cut->path, cut->n_path, cut->path_capacity);
    cut->path[cut->n_path++] = corner;
}

// Within a convex body what stays of a convex face is one part, and chords join where
// it leaves to where it enters next. Around the body there may be several parts, each
// with a chord from where it leaves to where it entered.
static void cut_face(struct cut *cut, int f)
{
    walk_face(cut, f);
    const int n = cut->n_step;
    int first = 0; // come in there
    while (first < n && cut->step[first].crosses != CROSSES_IN)
        first++;
    if (first == n) first = 0;
    struct corner in = {0};
    for (int k = 0; k < n; k++) {
        const struct step *step = &cut->step[(first + k) % n];
        add_to_path(cut, step->corner);
        if (step->crosses == CROSSES_IN) in = step->corner;
        if (step->crosses != CROSSES_OUT) continue;
        const struct step *next = &cut->step[(first + k + 1) % n];
        add_chords(cut, f, step->corner, cut->within ? next->corner : in);
        if (!cut->within) end_path(cut, f);
    }
    end_path(cut, f);
}

// ---- the wall -----------------------------------------------------------------------

// The chord of GRAIN, not yet used, that begins at CORNER; -1 if there is none. Chords
// are sorted by both.
static int next_chord(const struct cut *cut, int32_t grain, struct corner corner,
                      const bool *used)
{
    const int32_t key[3] = {grain, corner.node, image_number(corner.image)};
    int low = 0, high = cut->n_chord;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        const int32_t *there = cut->chord_row[middle].key;
        int order = 0;
        for (int k = 0; k < 3 && !order; k++)
            order = (there[k] > key[k]) - (there[k] < key[k]);
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < cut->n_chord; low++) {
        const int32_t *there = cut->chord_row[low].key;
        if (there[0] != key[0] || there[1] != key[1] || there[2] != key[2]) return -1;
        if (!used[low]) return low;
    }
    return -1;
}

// Makes the faces on the wall, joining the chords of each grain end to end.
static void close_cells(struct cut *cut)
{
    cut->chord_row = sort_rows(cut->chord_row, cut->n_chord);
    bool *used = NEW_ARRAY(bool, cut->n_chord);
    for (int k = 0; k < cut->n_chord; k++) {
        const int32_t grain = cut->chord_row[k].key[0];
        const int32_t side[2] = {grain, -1 - cut->wall};
        cut->n_path = 0;
        for (int at = used[k] ? -1 : k; at >= 0;) {
            const struct chord *chord = &cut->chord[cut->chord_row[at].item];
            used[at] = true;
            add_to_path(cut, chord->from);
            at = next_chord(cut, grain, chord->to, used);
        }
        loops_append(&cut->loops, side, (struct image){0}, cut->path, cut->n_path);
    }
    free(used);
}

static enum status check_sides(const struct cut *cut, struct reason *reason)
{
    const struct packing *packing = &cut->network->packing;
    for (int axis = 0; axis < 3; axis++)
        if (cut->within && packing->periodic[axis] &&
            body_is_round(&packing->body[cut->k], axis))
            return refuse(reason, STATUS_BAD_DATA,
                          "/domain/periodic: row %d: must be 0 where the wall around "
                          "the grains is round",
                          axis);
    return STATUS_OK;
}

// Throats that do not meet the wall stay as they are.
static void keep_throats(struct cut *cut)
{
    const struct network *network = cut->network;
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *node = network->throat_nodes[t];
        if (!stays(cut, node[0]) || !stays(cut, node[1])) continue;
        if (cut->crossing[t][0] >= 0) continue;
        const struct corner a = {.node = node[0]};
        const struct corner b = {.node = node[1], .image = throat_image(cut, t)};
        loops_add_throat(&cut->loops, a, b, network->throat_radius[t],
                         network->throat_length[t]);
    }
}

static void find_crossings(struct cut *cut)
{
    const struct network *network = cut->network;
    for (int i = 0; i < network->n_node; i++) {
        const struct vector at = network->node_position[i];
        const struct body body = body_near(&network->packing, cut->k, at);
        cut->holds[i] = body_holds(&body, at);
    }
    for (int t = 0; t < network->n_throat; t++)
        cross_throat(cut, t);
}

static void cut_free(struct cut *cut)
{
    sphere_cells_free(&cut->grains);
    free(cut->near);
    free(cut->holds);
    free(cut->crossing);
    free(cut->image);
    free(cut->step);
    free(cut->path);
    free(cut->chord_row);
    free(cut->chord);
}

enum status cut_network(struct network *network, int k, enum clearance clearance,
                        struct reason *reason)
{
    const struct body *body = &network->packing.body[k];
    struct cut cut = {.network = network,
                      .k = k,
                      .within = body->within,
                      .clearance = clearance,
                      .wall = body_wall(body),
                      .n_whole = network->n_node,
                      .node_capacity = network->n_node};
    enum status status = check_sides(&cut, reason);
    if (status) return status;
    cut.grains = sphere_cells_init(&network->packing);
    cut.near = NEW_ARRAY(bool, network->n_node);
    cut.holds = NEW_ARRAY(bool, network->n_node);
    cut.crossing = allocate((size_t)network->n_throat, sizeof *cut.crossing);
    find_crossings(&cut);
    keep_throats(&cut);
    // Beyond a wall around the grains lies what belongs to images of theirs.
    for (int f = 0; f < network->n_face; f++)
        if (network->face_particles[f][1] != -1 - WALL_OUTER || !cut.within)
            cut_face(&cut, f);
    close_cells(&cut);
    loops_to_network(&cut.loops, network);
    if (!cut.n_chord)
        status = refuse(reason, STATUS_BAD_DATA,
                        "/domain/bodies: row %d: no throat meets its surface: it is "
                        "too small for the grains around it, or they are too few",
                        k);
    cut_free(&cut);
    return status;
}
