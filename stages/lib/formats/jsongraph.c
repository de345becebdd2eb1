// SPDX-License-Identifier: GPL-3.0-or-later
// Networks as JSON Graph Format, written and read: nodes, edges, and in the metadata
// what the format has no place for (grains, faces, bodies, box). Reading checks every
// entry and names the row that is wrong.
//
// The tree, in metres; * marks members that may be missing when it is read:
//
//     graph.directed                     false
//          .metadata.number_of_nodes     length of nodes
//                   .number_of_links     length of edges
//                   .units               "m", not read
//                   .craquelure*         box, grains, bonds, faces (rest_json)
//          .nodes[].id                   its row, "0", "1", ...
//                  .metadata.node_coordinates.x, .y, .z
//                           .node_squared_radius          not read
//                           .node_walls*                  /nodes/kind
//          .edges[].id, .source, .target                  rows
//                  .metadata.link_length, .link_squared_radius
//                           .link_radius*, .link_volume*, .link_kind*
//                           .link_diffusive_size_factor*  m
//                           .link_hydraulic_size_factor*  m3
//                           .link_hydraulic_radius*       m
//
// Other programs read the squared radius; ours stands beside it, as the root of a
// square need not be the same to the last digit. Rows go by their ids, so lists may
// come in any order.
#include "formats/jsongraph.h"

#include "basics/memory.h"
#include "formats/foreign.h"

#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>

// ---- out ----------------------------------------------------------------------------

// Ids go out as text; number_of also takes numbers.
static json_t *id_of(int number)
{
    return json_sprintf("%d", number);
}

static json_t *vector_json(struct vector x)
{
    return json_pack("[f,f,f]", x.x, x.y, x.z);
}

// [[a, b], ...]: bonds, or the two sides of faces.
static json_t *pairs_json(const int32_t (*pair)[2], int count)
{
    json_t *list = json_array();
    for (int k = 0; k < count; k++)
        json_array_append_new(list, json_pack("[i,i]", pair[k][0], pair[k][1]));
    return list;
}

// A node has the radius of its widest throat, 0 without any. O(n_node + n_throat).
static json_t *nodes_json(const struct network *network)
{
    double *radius = NEW_ARRAY(double, network->n_node);
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2; end++) {
            double *of = &radius[network->throat_nodes[t][end]];
            *of = fmax(*of, network->throat_radius[t]);
        }
    json_t *nodes = json_array();
    for (int i = 0; i < network->n_node; i++) {
        const struct vector at = network->node_position[i];
        json_array_append_new(
            nodes, json_pack("{s:o,s:{s:{s:f,s:f,s:f},s:f,s:i}}", "id", id_of(i),
                             "metadata", "node_coordinates", "x", at.x, "y", at.y, "z",
                             at.z, "node_squared_radius", radius[i] * radius[i],
                             "node_walls", (int)network->node_walls[i]));
    }
    free(radius);
    return nodes;
}

// What throats conduct, under OpenPNM's names (throat.diffusive_size_factors ...).
enum { SHAPES = 3 };
static const char *const shape_name[SHAPES] = {"link_diffusive_size_factor",
                                               "link_hydraulic_size_factor",
                                               "link_hydraulic_radius"};

// The place of array K in NETWORK: readers put a new array there, writers look whether
// one is there (NULL: throats conduct as cylinders do).
static double **shape_array(struct network *network, int k)
{
    return (double **[SHAPES]){&network->throat_diffusion, &network->throat_flow,
                               &network->throat_hydraulic_radius}[k];
}

// Volume and kind always, what throats conduct only where the network says it. SHAPES
// is a copy of the struct, not of its arrays, as shape_array wants one that could be
// changed.
static json_t *edge_json(const struct network *network, int t)
{
    struct network shapes = *network;
    const double radius = network->throat_radius[t];
    json_t *metadata = json_pack(
        "{s:f,s:f,s:f,s:f,s:i}", "link_length", network->throat_length[t],
        "link_squared_radius", radius * radius, "link_radius", radius, "link_volume",
        throat_volume(network, t), "link_kind", (int)network->throat_kind[t]);
    for (int k = 0; k < SHAPES; k++) {
        const double *shape = *shape_array(&shapes, k);
        if (shape) json_object_set_new(metadata, shape_name[k], json_real(shape[t]));
    }
    return json_pack("{s:o,s:o,s:o,s:o}", "id", id_of(t), "source",
                     id_of(network->throat_nodes[t][0]), "target",
                     id_of(network->throat_nodes[t][1]), "metadata", metadata);
}

static json_t *edges_json(const struct network *network)
{
    json_t *edges = json_array();
    for (int t = 0; t < network->n_throat; t++)
        json_array_append_new(edges, edge_json(network, t));
    return edges;
}

// Each loop is a list of its own, so that no offsets are needed: {"nodes": [[...],
// ...], "particles": [[a, b], ...]}, a wall w as -1-w.
static json_t *faces_json(const struct network *network)
{
    json_t *loops = json_array();
    for (int f = 0; f < network->n_face; f++) {
        json_t *loop = json_array();
        for (int64_t k = network->face_offset[f]; k < network->face_offset[f + 1]; k++)
            json_array_append_new(loop, json_integer(network->face_nodes[k]));
        json_array_append_new(loops, loop);
    }
    return json_pack(
        "{s:o,s:o}", "nodes", loops, "particles",
        pairs_json((const int32_t(*)[2])network->face_particles, network->n_face));
}

// The rows of /domain/bodies.
static json_t *bodies_json(const struct packing *packing)
{
    json_t *bodies = json_array();
    for (int k = 0; k < packing->n_body; k++) {
        const struct body *body = &packing->body[k];
        json_array_append_new(bodies, json_pack("{s:i,s:b,s:o,s:o}", "shape",
                                                body->shape, "within", body->within,
                                                "lower", vector_json(body->lower),
                                                "upper", vector_json(body->upper)));
    }
    return bodies;
}

// {position, radius, kind}: enum grain_kind, where not all are solid.
static json_t *particles_json(const struct packing *packing)
{
    json_t *position = json_array(), *radius = json_array(), *kind = json_array();
    for (int i = 0; i < packing->n_particle; i++) {
        json_array_append_new(position, vector_json(packing->position[i]));
        json_array_append_new(radius, json_real(packing->radius[i]));
        json_array_append_new(kind, json_integer(is_auxiliary(packing, i)));
    }
    json_t *particles = json_pack("{s:o,s:o}", "position", position, "radius", radius);
    if (packing->kind) json_object_set(particles, "kind", kind);
    json_decref(kind);
    return particles;
}

// The rows of /bonds/relative_strength.
static json_t *strengths_json(const struct packing *packing)
{
    json_t *strengths = json_array();
    for (int b = 0; b < packing->n_bond; b++)
        json_array_append_new(strengths, json_real(packing->bond_strength[b]));
    return strengths;
}

// What is under "craquelure": lower, upper, periodic (three 0 or 1), particles, bonds,
// faces, unmerged_throats and unmerged_length (0: not merged); relative_strength of the
// bonds and bodies where there are some. All in one member, which other programs pass
// over. Images of a box that repeats have none: such networks are refused before.
static json_t *rest_json(const struct network *network)
{
    const struct packing *packing = &network->packing;
    json_t *rest = json_pack(
        "{s:o,s:o,s:[i,i,i],s:o,s:o,s:o,s:i,s:f}", "lower", vector_json(packing->lower),
        "upper", vector_json(packing->upper), "periodic", packing->periodic[0],
        packing->periodic[1], packing->periodic[2], "particles",
        particles_json(packing), "bonds",
        pairs_json((const int32_t(*)[2])packing->bond, packing->n_bond), "faces",
        faces_json(network), "unmerged_throats", network->unmerged_throats,
        "unmerged_length", network->unmerged_length);
    if (packing->bond_strength)
        json_object_set_new(rest, "relative_strength", strengths_json(packing));
    if (packing->n_body) json_object_set_new(rest, "bodies", bodies_json(packing));
    return rest;
}

json_t *jsongraph_from_network(const struct network *network)
{
    return json_pack("{s:{s:b,s:{s:i,s:i,s:s,s:o},s:o,s:o}}", "graph", "directed", 0,
                     "metadata", "number_of_nodes", network->n_node, "number_of_links",
                     network->n_throat, "units", "m", "craquelure", rest_json(network),
                     "nodes", nodes_json(network), "edges", edges_json(network));
}

// ---- in -----------------------------------------------------------------------------

// The number an id stands for, "12" or 12, or -1.
static int number_of(const json_t *id)
{
    const char *text = json_string_value(id);
    char *end = NULL;
    const long long number = text ? strtoll(text, &end, 10) : json_integer_value(id);
    const bool whole = text ? end != text && !*end : json_is_integer(id);
    return whole && number >= 0 && number <= INT_MAX ? (int)number : -1;
}

// False unless LIST is three numbers; whole ones are taken, too.
static bool get_vector(json_t *list, struct vector *x)
{
    return !json_unpack(list, "[F,F,F]", &x->x, &x->y, &x->z);
}

// Row K of the list, which is node `id`. Without node_walls it is on no wall yet. x is
// NAN beforehand: a node that no row is about is found by check_network.
static enum status read_node(json_t *node, int k, struct network *network,
                             struct reason *reason)
{
    const int i = number_of(json_object_get(node, "id"));
    if (i < 0 || i >= network->n_node)
        return refuse(reason, STATUS_BAD_DATA,
                      "graph.nodes[%d].id: must be a number below number_of_nodes = %d",
                      k, network->n_node);
    struct vector *at = &network->node_position[i];
    int walls = 0;
    if (json_unpack(node, "{s:{s:{s:F,s:F,s:F},s?i}}", "metadata", "node_coordinates",
                    "x", &at->x, "y", &at->y, "z", &at->z, "node_walls", &walls))
        return refuse(reason, STATUS_BAD_DATA,
                      "graph.nodes[%d].metadata.node_coordinates: must be numbers x, "
                      "y, z",
                      k);
    network->node_walls[i] = (uint8_t)(walls & 255);
    return STATUS_OK;
}

// Edges conduct as the file says, all of them or none.
static enum status read_shapes(const json_t *metadata, int k, int t,
                               struct network *network, struct reason *reason)
{
    for (int shape = 0; shape < SHAPES; shape++) {
        double **array = shape_array(network, shape);
        const json_t *number = json_object_get(metadata, shape_name[shape]);
        if (!number && !*array) continue;
        if (!*array && k == 0) *array = NEW_ARRAY(double, network->n_throat);
        const double value = json_number_value(number);
        if (!*array || !json_is_number(number) || !(value >= 0 && value <= 1e150))
            return refuse(reason, STATUS_BAD_DATA,
                          "graph.edges[%d].metadata.%s: must be a number from 0 to "
                          "1e150 in all edges, or in none",
                          k, shape_name[shape]);
        (*array)[t] = value;
    }
    return STATUS_OK;
}

// A file of another program has length and squared radius only: then the throat is a
// cylinder of volume pi r^2 L. Ends that are no numbers become -1, and the root of a
// square below 0 is NAN: both are left to check_network, which names the throat. A kind
// that is not known counts as an open throat.
static enum status read_edge(json_t *edge, int k, struct network *network,
                             struct reason *reason)
{
    const int t = number_of(json_object_get(edge, "id"));
    if (t < 0 || t >= network->n_throat)
        return refuse(reason, STATUS_BAD_DATA,
                      "graph.edges[%d].id: must be a number below number_of_links = %d",
                      k, network->n_throat);
    network->throat_nodes[t][0] = number_of(json_object_get(edge, "source"));
    network->throat_nodes[t][1] = number_of(json_object_get(edge, "target"));
    double radius = -1, section, volume = -1;
    int kind = 0;
    if (json_unpack(edge, "{s:{s:F,s:F,s?F,s?F,s?i}}", "metadata", "link_length",
                    &network->throat_length[t], "link_squared_radius", &section,
                    "link_radius", &radius, "link_volume", &volume, "link_kind", &kind))
        return refuse(reason, STATUS_BAD_DATA,
                      "graph.edges[%d].metadata: must have the numbers link_length and "
                      "link_squared_radius",
                      k);
    network->throat_radius[t] = radius >= 0 ? radius : sqrt(section);
    network->throat_volume[t] =
        volume >= 0 ? volume : M_PI * section * network->throat_length[t];
    network->throat_kind[t] =
        (uint8_t)(kind >= 0 && kind <= THROAT_IMPOSED_EMPTY ? kind : THROAT_NETWORK);
    return read_shapes(json_object_get(edge, "metadata"), k, t, network, reason);
}

// (count,2), for the caller to free; NULL where an entry is not two whole numbers. A
// list that is missing has no entry. Range is for the caller to check.
static int32_t (*read_pairs(json_t *list, int *count))[2]
{
    *count = (int)json_array_size(list);
    int32_t(*pair)[2] = allocate((size_t)*count, sizeof *pair);
    for (int k = 0; k < *count; k++)
        if (json_unpack(json_array_get(list, (size_t)k), "[i,i]", &pair[k][0],
                        &pair[k][1])) {
            free(pair);
            return NULL;
        }
    return pair;
}

// The arrays take the place of the empty ones of network_init. Without the member there
// are no grains.
static enum status read_particles(json_t *rest, struct packing *packing,
                                  struct reason *reason)
{
    json_t *position = NULL, *radius = NULL;
    json_unpack(rest, "{s:{s:o,s:o}}", "particles", "position", &position, "radius",
                &radius);
    const size_t n = json_array_size(position);
    free(packing->position);
    free(packing->radius);
    packing->position = NEW_ARRAY(struct vector, n);
    packing->radius = NEW_ARRAY(double, n);
    packing->n_particle = (int)n;
    bool good = json_array_size(radius) == n;
    for (size_t i = 0; i < n && good; i++) {
        packing->radius[i] = json_number_value(json_array_get(radius, i));
        good = get_vector(json_array_get(position, i), &packing->position[i]) &&
               packing->radius[i] > 0;
    }
    return good
               ? STATUS_OK
               : refuse(reason, STATUS_BAD_DATA,
                        "graph.metadata.craquelure.particles: must have a position and "
                        "a radius above 0 each");
}

// Without the member all are solid. Needs the number of grains.
static enum status read_kinds(json_t *rest, struct packing *packing,
                              struct reason *reason)
{
    const size_t n = (size_t)packing->n_particle;
    json_t *kinds = json_object_get(json_object_get(rest, "particles"), "kind");
    if (!kinds) return STATUS_OK;
    packing->kind = NEW_ARRAY(uint8_t, n);
    bool good = json_array_size(kinds) == n;
    for (size_t i = 0; i < n && good; i++) {
        const json_t *kind = json_array_get(kinds, i);
        const json_int_t value = json_integer_value(kind);
        good =
            json_is_integer(kind) && value >= GRAIN_SOLID && value <= GRAIN_AUXILIARY;
        packing->kind[i] = (uint8_t)value;
    }
    return good ? STATUS_OK
                : refuse(reason, STATUS_BAD_DATA,
                         "graph.metadata.craquelure.particles.kind: must be 0 or 1 "
                         "(auxiliary) for each grain");
}

// Without the member all bonds have the mean strength. Needs the number of bonds.
static enum status read_strengths(json_t *rest, struct packing *packing,
                                  struct reason *reason)
{
    const size_t n = (size_t)packing->n_bond;
    json_t *strengths = json_object_get(rest, "relative_strength");
    if (!strengths) return STATUS_OK;
    packing->bond_strength = NEW_ARRAY(double, n);
    bool good = json_array_size(strengths) == n;
    for (size_t b = 0; b < n && good; b++) {
        const json_t *strength = json_array_get(strengths, b);
        packing->bond_strength[b] = json_number_value(strength);
        good = json_is_number(strength) && packing->bond_strength[b] >= 0;
    }
    return good ? STATUS_OK
                : refuse(reason, STATUS_BAD_DATA,
                         "graph.metadata.craquelure.relative_strength: must be a "
                         "number of 0 or more for each bond");
}

// Bonds are pairs of grains, of which there must be enough.
static enum status read_bonds(json_t *rest, struct packing *packing,
                              struct reason *reason)
{
    free(packing->bond);
    packing->bond = read_pairs(json_object_get(rest, "bonds"), &packing->n_bond);
    bool good = packing->bond != NULL;
    for (int b = 0; b < packing->n_bond && good; b++)
        good = packing->bond[b][0] >= 0 && packing->bond[b][0] < packing->bond[b][1] &&
               packing->bond[b][1] < packing->n_particle;
    if (!good)
        return refuse(reason, STATUS_BAD_DATA,
                      "graph.metadata.craquelure.bonds: must be pairs of grains, the "
                      "lower first");
    return read_strengths(rest, packing, reason);
}

// Lengths first, which give the offsets and so the room; then the nodes.
static enum status read_loops(json_t *loops, struct network *network,
                              struct reason *reason)
{
    const size_t n_face = json_array_size(loops);
    free(network->face_offset);
    network->face_offset = NEW_ARRAY(int64_t, n_face + 1);
    for (size_t f = 0; f < n_face; f++)
        network->face_offset[f + 1] =
            network->face_offset[f] +
            (int64_t)json_array_size(json_array_get(loops, f));
    free(network->face_nodes);
    network->face_nodes = NEW_ARRAY(int32_t, network->face_offset[n_face]);
    for (size_t f = 0; f < n_face; f++)
        for (int64_t k = network->face_offset[f]; k < network->face_offset[f + 1];
             k++) {
            const json_t *node = json_array_get(json_array_get(loops, f),
                                                (size_t)(k - network->face_offset[f]));
            network->face_nodes[k] = number_of(node);
            if (network->face_nodes[k] < 0 || network->face_nodes[k] >= network->n_node)
                return refuse(reason, STATUS_BAD_DATA,
                              "graph.metadata.craquelure.faces.nodes[%zu]: must be a "
                              "loop of nodes",
                              f);
        }
    return STATUS_OK;
}

// The first side is a grain, the second a grain or a wall, -1 to -8 as in
// /faces/particles. Needs the number of grains. Whether a body has wall -7 or -8 is
// checked by those who read the artifact.
static enum status read_faces(json_t *rest, struct network *network,
                              struct reason *reason)
{
    json_t *faces = json_object_get(rest, "faces");
    json_t *loops = json_object_get(faces, "nodes");
    free(network->face_particles);
    network->face_particles =
        read_pairs(json_object_get(faces, "particles"), &network->n_face);
    bool good =
        network->face_particles && json_array_size(loops) == (size_t)network->n_face;
    for (int f = 0; f < network->n_face && good; f++)
        for (int side = 0; side < 2; side++)
            good = good &&
                   network->face_particles[f][side] >= -(1 + WALL_INNER) * side &&
                   network->face_particles[f][side] < network->packing.n_particle;
    if (!good)
        return refuse(reason, STATUS_BAD_DATA,
                      "graph.metadata.craquelure.faces.particles: must be a grain, and "
                      "a grain or wall, for each face");
    return read_loops(loops, network, reason);
}

// A body counts before it is judged: the caller frees the network whole on a refusal,
// and n_body stays within MOST_BODIES as longer lists are not begun.
static enum status read_bodies(const json_t *bodies, struct packing *packing,
                               struct reason *reason)
{
    const size_t count = json_array_size(bodies); // 0 when there are none
    bool good = count <= MOST_BODIES;
    for (size_t k = 0; k < count && good; k++) {
        json_t *item = json_array_get(bodies, k);
        struct body body = {0};
        int shape = -1, within = 0;
        good = !json_unpack(item, "{s:i,s:b}", "shape", &shape, "within", &within) &&
               shape >= 0 && shape < BODY_SHAPES &&
               get_vector(json_object_get(item, "lower"), &body.lower) &&
               get_vector(json_object_get(item, "upper"), &body.upper);
        body.shape = (uint8_t)shape;
        body.within = (uint8_t)within;
        good = good && body_is_one(&body);
        packing->body[packing->n_body++] = body;
    }
    if (good) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "graph.metadata.craquelure.bodies: must be at most %d, each with "
                  "shape, within, and lower below upper",
                  MOST_BODIES);
}

// Grains before bonds and faces, which refer to them. Each part is refused by its own
// name. "periodic" must be there for the two numbers behind it to be read.
static enum status read_rest(json_t *rest, struct network *network,
                             struct reason *reason)
{
    struct packing *packing = &network->packing;
    int periodic[3] = {0};
    json_unpack(rest, "{s:[i,i,i],s?i,s?F}", "periodic", &periodic[0], &periodic[1],
                &periodic[2], "unmerged_throats", &network->unmerged_throats,
                "unmerged_length", &network->unmerged_length);
    bool good = get_vector(json_object_get(rest, "lower"), &packing->lower) &&
                get_vector(json_object_get(rest, "upper"), &packing->upper);
    for (int axis = 0; axis < 3; axis++) {
        packing->periodic[axis] = periodic[axis] != 0;
        good =
            good && component(packing->lower, axis) < component(packing->upper, axis);
    }
    if (!good)
        return refuse(reason, STATUS_BAD_DATA,
                      "graph.metadata.craquelure: must have a box, lower below upper");
    enum status status = read_bodies(json_object_get(rest, "bodies"), packing, reason);
    if (!status) status = read_particles(rest, packing, reason);
    if (!status) status = read_kinds(rest, packing, reason);
    if (!status) status = read_bonds(rest, packing, reason);
    if (status) return status;
    return read_faces(rest, network, reason);
}

// What OpenPNM's own writer makes of a network in metres: it keeps whole numbers.
static bool all_in_one_place(const struct network *network)
{
    for (int i = 1; i < network->n_node; i++)
        if (distance(network->node_position[i], network->node_position[0]) > 0)
            return false;
    return network->n_throat > 0;
}

// The check comes when all nodes and edges are there, and before anything is derived
// from them. Where our part is there it says what the box is, and node_walls what lies
// on it; else the box is drawn around the nodes.
static enum status read_graph(json_t *graph, struct network *network,
                              struct reason *reason)
{
    size_t k;
    json_t *item;
    enum status status = STATUS_OK;
    for (int i = 0; i < network->n_node; i++)
        network->node_position[i].x = NAN; // where an id is there twice, one stays so
    json_array_foreach(json_object_get(graph, "nodes"), k, item)
    {
        if (!status) status = read_node(item, (int)k, network, reason);
    }
    json_array_foreach(json_object_get(graph, "edges"), k, item)
    {
        if (!status) status = read_edge(item, (int)k, network, reason);
    }
    if (!status) status = check_network(network, reason);
    if (status) return status;
    drop_cylinder_volumes(network);
    json_t *rest = json_object_get(json_object_get(graph, "metadata"), "craquelure");
    if (rest) return read_rest(rest, network, reason);
    if (all_in_one_place(network))
        return refuse(reason, STATUS_BAD_DATA,
                      "graph.nodes: all lie in one place (OpenPNM's writer cuts "
                      "coordinates to whole numbers: docs/reference.md has another)");
    box_around_nodes(network);
    find_walls(network);
    return STATUS_OK;
}

// Lists are counted before room is made for them: a wrong number of nodes cannot ask
// for more memory than the document has.
enum status network_from_jsongraph(const json_t *document, struct network *network,
                                   struct reason *reason)
{
    json_t *graph = json_object_get(document, "graph");
    const json_t *metadata = json_object_get(graph, "metadata");
    const int n_node = number_of(json_object_get(metadata, "number_of_nodes"));
    const int n_throat = number_of(json_object_get(metadata, "number_of_links"));
    *network = (struct network){0};
    if (n_node < 0 || n_throat < 0 ||
        json_array_size(json_object_get(graph, "nodes")) != (size_t)n_node ||
        json_array_size(json_object_get(graph, "edges")) != (size_t)n_throat)
        return refuse(reason, STATUS_BAD_DATA,
                      "graph: must have as many nodes and edges as number_of_nodes and "
                      "number_of_links say");
    *network = network_init(n_node, n_throat);
    const enum status status = read_graph(graph, network, reason);
    if (status) network_free(network);
    return status;
}
