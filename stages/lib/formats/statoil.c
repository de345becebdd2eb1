// SPDX-License-Identifier: GPL-3.0-or-later
// Networks as the four text files of Statoil, written and read. Nodes and throats count
// from 1; reservoirs are the nodes -1 (inlet) and 0 (outlet), and throats to them come
// after all others.
//
// A line is a row; numbers are separated by blanks. What is written, a line each row,
// with a first line of _node1 and _link1 only:
//
//     _node1  n Lx Ly Lz    i x y z, number of throats m, m nodes, at inlet, at outlet,
//                           m throats
//     _node2                i 0 radius G 0             volume 0: nodes have none
//     _link1  n             t a b radius G length
//     _link2                t a b 0 0 length volume 0  lengths of both nodes are 0
//
// Traps: reading takes the first columns of a line and passes over the rest; _node2 is
// not read; a row must have the number of its place. G is the shape factor, area over
// perimeter squared.
#include "formats/statoil.h"

#include "basics/memory.h"
#include "formats/foreign.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const statoil_endings[STATOIL_FILES] = {"_node1.dat", "_node2.dat",
                                                    "_link1.dat", "_link2.dat"};

// ---- out ----------------------------------------------------------------------------

#define CIRCLE_SHAPE (1 / (4 * M_PI)) // shape factor, area over perimeter^2

// Reservoir 0 at the inlet, 1 at the outlet: as a node, -1 and 0.
static bool at_reservoir(const struct network *network, int node, int reservoir)
{
    return network->node_walls[node] >> reservoir & 1;
}

// Radius (m) of the widest throat at NODE, which stands for its own; 0 without throats.
static double widest(const struct network *network, const struct incidence *incidence,
                     int node)
{
    double radius = 0;
    for (int k = incidence->offset[node]; k < incidence->offset[node + 1]; k++)
        radius = fmax(radius, network->throat_radius[incidence->throat[k]]);
    return radius;
}

// The shape factor G of the duct of the throat's radius that conducts as the throat
// does, flow = k A^2 G / length with A = radius^2 / (4 G): a triangle, k = 3/5, up to
// G = sqrt(3) / 36; a square, k = 0.5623, up to 0.07; else a circle, k = 1/2 [Patzek &
// Silin 2001]. The circle's own where the throat is a cylinder, or conducts less.
static double shape_factor(const struct network *network, int t)
{
    static const struct {
        double k, largest;
    } duct[] = {{0.6, 0.04811252243246881}, {0.5623, 0.07}, {0.5, CIRCLE_SHAPE}};
    if (!network->throat_flow || !(network->throat_flow[t] > 0)) return CIRCLE_SHAPE;
    const double square = network->throat_radius[t] * network->throat_radius[t];
    const double shape =
        square * square / (16 * network->throat_flow[t] * network->throat_length[t]);
    for (int k = 0; k < 3; k++)
        if (duct[k].k * shape <= duct[k].largest)
            return fmax(duct[k].k * shape, k ? duct[k - 1].largest * (1 + 1e-9) : 0);
    return CIRCLE_SHAPE;
}

// COLUMN: radius, shape factor, length, volume, in m and m3. The same row in both
// files, as both begin with its number and ends. 17 digits give each double back.
static void put_link(FILE *link[2], int number, int a, int b, const double column[4])
{
    const double radius = column[0], shape = column[1], length = column[2];
    fprintf(link[0], "%d %d %d %.17g %.17g %.17g\n", number, a, b, radius, shape,
            length);
    fprintf(link[1], "%d %d %d 0 0 %.17g %.17g 0\n", number, a, b, length, column[3]);
}

// Throats to reservoirs are numbered after the others, by reservoir and node.
static void put_links(const struct network *network, const struct incidence *incidence,
                      int *to_reservoir[2], FILE *link[2])
{
    int number = network->n_throat;
    for (int reservoir = 0; reservoir < 2; reservoir++)
        for (int i = 0; i < network->n_node; i++)
            if (at_reservoir(network, i, reservoir))
                to_reservoir[reservoir][i] = ++number;
    fprintf(link[0], "%d\n", number);
    for (int t = 0; t < network->n_throat; t++)
        put_link(link, t + 1, network->throat_nodes[t][0] + 1,
                 network->throat_nodes[t][1] + 1,
                 (double[4]){network->throat_radius[t], shape_factor(network, t),
                             network->throat_length[t], throat_volume(network, t)});
    for (int reservoir = 0; reservoir < 2; reservoir++)
        for (int i = 0; i < network->n_node; i++)
            if (to_reservoir[reservoir][i])
                put_link(
                    link, to_reservoir[reservoir][i], reservoir - 1, i + 1,
                    (double[4]){widest(network, incidence, i), CIRCLE_SHAPE, 0, 0});
}

// Neighbours first, then their throats, in the same order; of both, those to reservoirs
// come last, inlet before outlet. The box begins at the origin, so its lower corner is
// taken off.
static void put_node(const struct network *network, const struct incidence *incidence,
                     int *const to_reservoir[2], int i, FILE *node)
{
    const int begin = incidence->offset[i], end = incidence->offset[i + 1];
    const struct vector at =
        subtract(network->node_position[i], network->packing.lower);
    const int *in = &to_reservoir[0][i], *out = &to_reservoir[1][i];
    fprintf(node, "%d %.17g %.17g %.17g %d", i + 1, at.x, at.y, at.z,
            end - begin + !!*in + !!*out);
    for (int k = begin; k < end; k++) {
        const int32_t *ends = network->throat_nodes[incidence->throat[k]];
        fprintf(node, " %d", (ends[0] == i ? ends[1] : ends[0]) + 1);
    }
    fprintf(node, "%s%s %d %d", *in ? " -1" : "", *out ? " 0" : "", !!*in, !!*out);
    for (int k = begin; k < end; k++)
        fprintf(node, " %d", incidence->throat[k] + 1);
    if (*in) fprintf(node, " %d", *in);
    if (*out) fprintf(node, " %d", *out);
    fputc('\n', node);
}

// Shape factors of nodes are those of circles: a node has no section.
static void put_nodes(const struct network *network, const struct incidence *incidence,
                      int *const to_reservoir[2], FILE *node[2])
{
    const struct vector edge = subtract(network->packing.upper, network->packing.lower);
    fprintf(node[0], "%d %.17g %.17g %.17g\n", network->n_node, edge.x, edge.y, edge.z);
    for (int i = 0; i < network->n_node; i++) {
        put_node(network, incidence, to_reservoir, i, node[0]);
        fprintf(node[1], "%d 0 %.17g %.17g 0\n", i + 1, widest(network, incidence, i),
                CIRCLE_SHAPE);
    }
}

// Links before nodes: put_links numbers the throats to reservoirs, put_nodes names
// them.
void statoil_from_network(const struct network *network, char *text[STATOIL_FILES])
{
    FILE *stream[STATOIL_FILES];
    size_t size[STATOIL_FILES];
    for (int k = 0; k < STATOIL_FILES; k++)
        stream[k] = open_memstream(&text[k], &size[k]);
    struct incidence incidence = network_incidence(network);
    int *to_reservoir[2] = {NEW_ARRAY(int, network->n_node),
                            NEW_ARRAY(int, network->n_node)};
    put_links(network, &incidence, to_reservoir, &stream[STATOIL_LINK1]);
    put_nodes(network, &incidence, to_reservoir, &stream[STATOIL_NODE1]);
    for (int k = 0; k < STATOIL_FILES; k++)
        fclose(stream[k]);
    free(to_reservoir[0]);
    free(to_reservoir[1]);
    incidence_free(&incidence);
}

// ---- in -----------------------------------------------------------------------------

// Where reading is: file, line, and what is left of the text.
struct reading {
    int file, line;
    const char *rest;
};

// The first WANTED numbers of the next line that is not empty.
static enum status read_line(struct reading *reading, int wanted, double *number,
                             struct reason *reason)
{
    const char *blanks = " \t\r";
    do {
        reading->line++;
        reading->rest += strspn(reading->rest, blanks);
    } while (*reading->rest == '\n' && reading->rest++);
    for (int k = 0; k < wanted; k++) {
        reading->rest += strspn(reading->rest, blanks);
        const bool is_over = *reading->rest == '\n';
        char *end = NULL;
        number[k] = is_over ? 0 : strtod(reading->rest, &end);
        if (is_over || end == reading->rest || !isfinite(number[k]))
            return refuse(reason, STATUS_BAD_DATA,
                          "%s: line %d: must begin with %d "
                          "numbers",
                          statoil_endings[reading->file], reading->line, wanted);
        reading->rest = end;
    }
    const char *next = strchr(reading->rest, '\n');
    reading->rest = next ? next + 1 : "";
    return STATUS_OK;
}

// The same for a row that must be numbered NUMBER. Rows in another order would be
// joined wrongly, as _link1 and _link2 are read side by side.
static enum status read_row(struct reading *reading, int number, int wanted,
                            double *column, struct reason *reason)
{
    const enum status status = read_line(reading, wanted, column, reason);
    if (status || column[0] == number) return status;
    return refuse(reason, STATUS_BAD_DATA, "%s: line %d: must be number %d, is %g",
                  statoil_endings[reading->file], reading->line, number, column[0]);
}

// Before room is made for them: a damaged count must not ask for more memory than the
// file could fill.
static enum status read_count(struct reading *reading, double count, int *n,
                              struct reason *reason)
{
    // no line is shorter than its number and what must follow
    const double most = (double)strlen(reading->rest) / 4;
    if (!(count >= 0 && count <= most) || count != floor(count))
        return refuse(reason, STATUS_BAD_DATA,
                      "%s: line %d: %g rows are not what the file holds",
                      statoil_endings[reading->file], reading->line, count);
    *n = (int)count;
    return STATUS_OK;
}

// Only number and place; throats come from the links.
static enum status read_nodes(struct reading *node1, struct network *network,
                              struct reason *reason)
{
    double column[4];
    for (int i = 0; i < network->n_node; i++) {
        const enum status status = read_row(node1, i + 1, 4, column, reason);
        if (status) return status;
        network->node_position[i] = (struct vector){column[1], column[2], column[3]};
    }
    return STATUS_OK;
}

// Throats to reservoirs are left out. Ends, radius and the length in all are those of
// _link1, the volume that of _link2. Throats that are kept move up, so numbers of
// throats change where there were reservoirs.
static enum status read_throats(struct reading *link1, struct reading *link2,
                                struct network *network, struct reason *reason)
{
    const int n_link = network->n_throat;
    double first[6] = {0}, second[7] = {0};
    int t = 0;
    for (int number = 1; number <= n_link; number++) {
        enum status status = read_row(link1, number, 6, first, reason);
        if (!status) status = read_row(link2, number, 7, second, reason);
        if (status) return status;
        if (first[1] < 1 || first[2] < 1) continue;
        for (int end = 0; end < 2; end++) // a node too high is refused later
            network->throat_nodes[t][end] =
                (int32_t)fmin(first[1 + end] - 1, network->n_node);
        network->throat_radius[t] = first[3];
        network->throat_length[t] = first[5];
        network->throat_volume[t++] = second[6];
    }
    network->n_throat = t;
    return STATUS_OK;
}

// Edges; the lower corner is the origin, as network_init leaves it.
static enum status read_box(const double header[4], struct packing *packing,
                            struct reason *reason)
{
    for (int axis = 0; axis < 3; axis++) {
        if (!(header[1 + axis] > 0))
            return refuse(reason, STATUS_BAD_DATA,
                          "_node1.dat: line 1: edges of the box must be > 0, got %g",
                          header[1 + axis]);
        set_component(&packing->upper, axis, header[1 + axis]);
    }
    return STATUS_OK;
}

// Counts come first, from both headers, so that all room is made at once.
enum status network_from_statoil(const char *const text[STATOIL_FILES],
                                 struct network *network, struct reason *reason)
{
    struct reading node1 = {STATOIL_NODE1, 0, text[STATOIL_NODE1]};
    struct reading link1 = {STATOIL_LINK1, 0, text[STATOIL_LINK1]};
    struct reading link2 = {STATOIL_LINK2, 0, text[STATOIL_LINK2]};
    double header[4] = {0}, links = 0;
    int n_node = 0, n_link = 0;
    *network = (struct network){0};
    enum status status = read_line(&node1, 4, header, reason);
    if (!status) status = read_count(&node1, header[0], &n_node, reason);
    if (!status) status = read_line(&link1, 1, &links, reason);
    if (!status) status = read_count(&link1, links, &n_link, reason);
    if (status) return status;
    *network = network_init(n_node, n_link);
    status = read_box(header, &network->packing, reason);
    if (!status) status = read_nodes(&node1, network, reason);
    if (!status) status = read_throats(&link1, &link2, network, reason);
    if (!status) status = check_network(network, reason);
    if (status) {
        network_free(network);
        return status;
    }
    find_walls(network);
    drop_cylinder_volumes(network);
    return STATUS_OK;
}
