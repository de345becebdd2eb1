// SPDX-License-Identifier: GPL-3.0-or-later
// The flux of a throat, from a grid.
//
// The grains that meet at a node, four, are a tetrahedron of the triangulation; these
// fill the box. A cell of the grid belongs to the one in which its middle lies. What
// flows between the cells of two nodes is the flux of the throat between these. So the
// fluxes of a node balance as those of the grid do, however coarse it is.
#include "support_regions.h"

#include "basics/memory.h"
#include "basics/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CORNERS = 4 };

struct tetrahedron {
    int n;
    int32_t grain[CORNERS];
    struct image image[CORNERS]; // seen from the node
};

static void add_corner(struct tetrahedron *node, int32_t grain, struct image image)
{
    for (int c = 0; c < node->n; c++)
        if (node->grain[c] == grain && same_image(node->image[c], image)) return;
    if (node->n == CORNERS)
        die(STATUS_BAD_DATA, "laplace: fluxes are for networks that were not merged");
    node->grain[node->n] = grain;
    node->image[node->n++] = image;
}

static struct tetrahedron *tetrahedra(const struct network *network)
{
    struct tetrahedron *node = NEW_ARRAY(struct tetrahedron, network->n_node);
    for (int f = 0; f < network->n_face; f++)
        for (int64_t k = network->face_offset[f]; k < network->face_offset[f + 1];
             k++) {
            struct tetrahedron *at = &node[network->face_nodes[k]];
            const struct image seen = network->face_node_image[k];
            add_corner(at, network->face_particles[f][0], image_opposite(seen));
            add_corner(at, network->face_particles[f][1],
                       image_difference(network->face_image[f], seen));
        }
    return node;
}

// ---- cells --------------------------------------------------------------------------

struct inside {
    double lower[3], upper[3];                // of the tetrahedron
    double normal[CORNERS][3], size[CORNERS]; // inward; normal.x - size is the distance
};

// Whether it has a volume; corners in the grid's unit from the lower corner of the box.
static bool find_sides(struct inside *inside, struct vector corner[CORNERS])
{
    for (int a = 0; a < 3; a++) {
        inside->lower[a] = inside->upper[a] = component(corner[0], a);
        for (int c = 1; c < CORNERS; c++) {
            inside->lower[a] = fmin(inside->lower[a], component(corner[c], a));
            inside->upper[a] = fmax(inside->upper[a], component(corner[c], a));
        }
    }
    for (int c = 0; c < CORNERS; c++) {
        const struct vector p = corner[(c + 1) % CORNERS];
        struct vector normal = cross(subtract(corner[(c + 2) % CORNERS], p),
                                     subtract(corner[(c + 3) % CORNERS], p));
        normal = scale(1 / norm(normal), normal);
        double height = dot(normal, subtract(corner[c], p));
        if (!(fabs(height) > 1e-9)) return false;
        if (height < 0) normal = scale(-1, normal);
        for (int a = 0; a < 3; a++)
            inside->normal[c][a] = component(normal, a);
        inside->size[c] = dot(normal, p);
    }
    return true;
}

static double depth(const struct inside *inside, const double x[3])
{
    double least = INFINITY;
    for (int c = 0; c < CORNERS; c++) {
        const double *normal = inside->normal[c];
        least = fmin(least, normal[0] * x[0] + normal[1] * x[1] + normal[2] * x[2] -
                                inside->size[c]);
    }
    return least;
}

// Gives cells to NODE where they lie deeper in it than in another.
static void claim(const struct grid *grid, const struct inside *inside, int node,
                  struct regions *regions, float *deepest)
{
    int from[3], to[3], at[3];
    for (int a = 0; a < 3; a++) {
        from[a] = (int)floor(inside->lower[a] / grid->spacing[a] + 0.5);
        to[a] = (int)ceil(inside->upper[a] / grid->spacing[a] + 0.5);
    }
    for (at[2] = from[2]; at[2] <= to[2]; at[2]++)
        for (at[1] = from[1]; at[1] <= to[1]; at[1]++)
            for (at[0] = from[0]; at[0] <= to[0]; at[0]++) {
                double x[3];
                struct image image;
                size_t cell = 0;
                for (int a = 0; a < 3; a++) {
                    x[a] = (at[a] - 0.5) * grid->spacing[a];
                    const int box = (int)floor((at[a] - 0.5) / grid->n[a]);
                    image.along[a] = (int8_t)box;
                    cell += (size_t)(at[a] - box * grid->n[a]) * grid->stride[a];
                }
                const float deep = (float)depth(inside, x);
                if (deep <= deepest[cell]) continue;
                deepest[cell] = deep;
                regions->node[cell] = node;
                regions->image[cell] = image;
            }
}

struct regions regions_of(const struct grid *grid, const struct network *network)
{
    const struct packing *packing = &network->packing;
    for (int a = 0; a < 3; a++)
        if (!grid->periodic[a])
            die(STATUS_BAD_DATA,
                "laplace: fluxes are for boxes that repeat all around");
    struct regions regions = {NEW_ARRAY(int32_t, grid->size),
                              NEW_ARRAY(struct image, grid->size)};
    float *deepest = NEW_ARRAY(float, grid->size);
    for (size_t c = 0; c < grid->size; c++) {
        deepest[c] = -1e-7F;
        regions.node[c] = -1;
    }
    struct tetrahedron *node = tetrahedra(network);
    for (int v = 0; v < network->n_node; v++) {
        struct vector corner[CORNERS];
        for (int c = 0; c < CORNERS; c++)
            corner[c] = scale(1 / grid->unit,
                              subtract(add(packing->position[node[v].grain[c]],
                                           image_offset(packing, node[v].image[c])),
                                       packing->lower));
        struct inside inside;
        if (node[v].n == CORNERS && find_sides(&inside, corner))
            claim(grid, &inside, v, &regions, deepest);
    }
    free(node);
    free(deepest);
    return regions;
}

void regions_free(struct regions *regions)
{
    free(regions->node);
    free(regions->image);
}

// ---- fluxes -------------------------------------------------------------------------

void add_flux(struct throat_fluxes *fluxes, const struct grid *grid,
              const struct regions *regions, const struct network *network,
              const struct incidence *incidence, const int cell[3], int axis, int along,
              double flux)
{
    int below[3] = {cell[0], cell[1], cell[2]};
    struct image step = {{0}};
    if (--below[axis] == 0) {
        below[axis] = grid->n[axis];
        step.along[axis] = 1;
    }
    const size_t u = cell_at(grid, below[0], below[1], below[2]);
    const size_t v = cell_at(grid, cell[0], cell[1], cell[2]);
    const int32_t a = regions->node[u], b = regions->node[v];
    const struct image from_a =
        image_sum(image_difference(regions->image[u], regions->image[v]), step);
    fluxes->all += fabs(flux);
    if (a < 0 || b < 0) {
        fluxes->stray += fabs(flux);
        return;
    }
    if (a == b && same_image(from_a, (struct image){{0}})) return;
    for (int k = incidence->offset[a]; k < incidence->offset[a + 1]; k++) {
        const int t = incidence->throat[k];
        const int32_t *ends = network->throat_nodes[t];
        if (ends[0] == a && ends[1] == b &&
            same_image(network->throat_image[t], from_a)) {
            fluxes->along[t][along] += flux;
            return;
        }
        if (ends[0] == b && ends[1] == a &&
            same_image(network->throat_image[t], image_opposite(from_a))) {
            fluxes->along[t][along] -= flux;
            return;
        }
    }
    fluxes->stray += fabs(flux);
}

void write_fluxes(const char *path, const struct throat_fluxes *fluxes, int n_throat)
{
    FILE *file = fopen(path, "w");
    if (!file) die(STATUS_CANNOT_CREATE, "laplace: cannot write %s", path);
    fprintf(file, "throat\tx\ty\tz\n");
    for (int t = 0; t < n_throat; t++)
        fprintf(file, "%d\t%.9g\t%.9g\t%.9g\n", t, fluxes->along[t][0],
                fluxes->along[t][1], fluxes->along[t][2]);
    if (fclose(file)) die(STATUS_IO, "laplace: cannot write %s", path);
}
