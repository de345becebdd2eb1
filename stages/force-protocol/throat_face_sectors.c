// SPDX-License-Identifier: GPL-3.0-or-later
#include "throat_face_sectors.h"

#include "basics/memory.h"

#include <stdlib.h>

// A throat, the Kth of a face's loop, seen from the grain on one SIDE of the face.
struct side {
    int32_t face, k;
    uint8_t which; // side of the face
    bool turned;   // the loop runs clockwise seen from beyond
};

// --- faces -------------------------------------------------------------------------

static int corners_of(const struct network *network, int face)
{
    return (int)(network->face_offset[face + 1] - network->face_offset[face]);
}

// The grain on side WHICH of the face, in the repetition of the box where the first is.
static struct vector centre_of(const struct network *network, int face, int which)
{
    return which ? second_grain(network, face)
                 : network->packing.position[network->face_particles[face][0]];
}

// On the line from the centre of grain I to that of J: the point of equal power, the
// middle for equal radii.
static struct vector foot_between(const struct packing *packing, int i,
                                  struct vector centre, int j, struct vector across)
{
    const struct vector apart = subtract(across, centre);
    const double ri = packing->radius[i], rj = packing->radius[j];
    const double share =
        0.5 + 0.5 * (ri - rj) * (ri + rj) / dot(apart, apart); // [K 3.2]
    return add(centre, scale(share, apart));
}

// By its corners; twice the area, normal to the loop.
static struct vector loop_area(const struct network *network, int face)
{
    const int64_t begin = network->face_offset[face];
    const struct vector origin = face_corner(network, begin);
    struct vector area = {0};
    for (int k = 1; k + 1 < corners_of(network, face); k++)
        area = add(area, cross(subtract(face_corner(network, begin + k), origin),
                               subtract(face_corner(network, begin + k + 1), origin)));
    return area;
}

// Whether the loop runs clockwise seen from beyond. Not from the foot: a grain whose
// centre another one has engulfed lies beyond its own face.
static bool is_turned(const struct network *network, int face, int which)
{
    const int32_t *side = network->face_particles[face];
    const struct vector centre = centre_of(network, face, which);
    const struct vector beyond =
        side[1] < 0 ? nearest_on_wall(&network->packing, -1 - side[1], centre)
                    : centre_of(network, face, !which);
    return dot(loop_area(network, face), subtract(beyond, centre)) < 0;
}

// A cell of a layer, whose loop should run so that its area points along y.
static bool is_cell_turned(const struct network *network, int face)
{
    return loop_area(network, face).y < 0;
}

// --- the wedges of one throat ------------------------------------------------------

static struct wedge *append(struct wedges *wedges, int *n)
{
    GROW_ARRAY(wedges->wedge, *n, wedges->capacity);
    return &wedges->wedge[(*n)++];
}

static void add_side(struct wedges *wedges, int throat, const struct side *side, int *n)
{
    const struct network *network = wedges->network;
    const int32_t *grains = network->face_particles[side->face];
    const int count = corners_of(network, side->face);
    const int64_t begin = network->face_offset[side->face];
    const int next = (side->k + 1) % count;
    struct wedge *wedge = append(wedges, n);
    *wedge = (struct wedge){
        .throat = throat,
        .grain = grains[side->which],
        .beyond = grains[!side->which],
        .face = side->face,
        .centre = centre_of(network, side->face, side->which),
        .from = face_corner(network, begin + (side->turned ? next : side->k)),
        .to = face_corner(network, begin + (side->turned ? side->k : next))};
    if (wedges->layer) {
        wedge->beyond = -1;
        wedge->centre.y = wedge->from.y; // grains and throats are staggered
        wedge->foot = scale(0.5, add(wedge->from, wedge->to));
        wedge->across = wedge->foot;
    } else if (wedge->beyond < 0) {
        wedge->foot =
            nearest_on_wall(&network->packing, -1 - wedge->beyond, wedge->centre);
        wedge->across = wedge->foot;
    } else {
        wedge->across = centre_of(network, side->face, !side->which);
        wedge->foot = foot_between(&network->packing, wedge->grain, wedge->centre,
                                   wedge->beyond, wedge->across);
    }
}

// What the grain across a face that the network has not kept sees of it.
static struct wedge seen_from_beyond(const struct wedge *wedge)
{
    return (struct wedge){.throat = wedge->throat,
                          .grain = wedge->beyond,
                          .beyond = wedge->grain,
                          .face = -1,
                          .centre = wedge->across,
                          .across = wedge->centre,
                          .foot = wedge->foot,
                          .from = wedge->to,
                          .to = wedge->from};
}

// The wedges of the face between the grains of A and B, which the network has not kept:
// both have a wedge against a grain between them. Seen from the first the throat runs
// the other way in the face on its other side, and so it does in that of the second.
static void add_missing(struct wedges *wedges, int a, int b, int *n)
{
    struct wedge wedge = wedges->wedge[a];
    const struct wedge *other = &wedges->wedge[b];
    wedge.beyond = other->grain;
    wedge.face = -1;
    wedge.across = add(other->centre, subtract(wedge.to, other->from));
    wedge.foot = foot_between(&wedges->network->packing, wedge.grain, wedge.centre,
                              wedge.beyond, wedge.across);
    wedge.from = wedges->wedge[a].to;
    wedge.to = wedges->wedge[a].from;
    *append(wedges, n) = wedge;
    *append(wedges, n) = seen_from_beyond(&wedge);
}

// Of the N wedges those of grains that have only this one, and so miss a face; returns
// how many, of which the first two are in SINGLE.
static int find_singles(const struct wedge *wedge, int n, int single[2])
{
    int count = 0;
    for (int a = 0; a < n; a++) {
        int same = 0;
        for (int b = 0; b < n; b++)
            same += wedge[b].grain == wedge[a].grain;
        if (same > 1) continue;
        if (count < 2) single[count] = a;
        count++;
    }
    return count;
}

// --- layers ------------------------------------------------------------------------

// The copy of grain J, along sides that repeat, of least power at X, which is lowered
// to it.
static struct vector nearest_copy(const struct packing *packing, int j, struct vector x,
                                  double *power)
{
    struct vector best = {0};
    *power = INFINITY;
    for (int8_t i = packing->periodic[0] ? -1 : 0; i <= packing->periodic[0]; i++)
        for (int8_t k = packing->periodic[2] ? -1 : 0; k <= packing->periodic[2]; k++) {
            struct vector there = add(packing->position[j],
                                      image_offset(packing, (struct image){{i, 0, k}}));
            there.y = x.y;
            const struct vector apart = subtract(there, x);
            const double here =
                dot(apart, apart) - packing->radius[j] * packing->radius[j];
            if (here >= *power) continue;
            *power = here;
            best = there;
        }
    return best;
}

// The grain across the throat of WEDGE, whose cell was left out: of all others that of
// least power at its middle.
static void find_grain_across(const struct network *network, struct wedge *wedge)
{
    double least = INFINITY;
    for (int j = 0; j < network->packing.n_particle; j++) {
        double power;
        const struct vector copy =
            nearest_copy(&network->packing, j, wedge->foot, &power);
        if (power >= least || distance(copy, wedge->centre) == 0) continue;
        least = power;
        wedge->beyond = j;
        wedge->across = copy;
    }
}

// In a layer both sides of a throat are cells.
static void pair_cells(struct wedges *wedges, int throat, int *n)
{
    struct wedge *wedge = wedges->wedge;
    if (*n == 2) {
        for (int k = 0; k < 2; k++) {
            wedge[k].beyond = wedge[!k].grain;
            wedge[k].across =
                add(wedge[!k].centre, subtract(wedge[k].to, wedge[!k].from));
        }
    } else if (*n == 1 && !wedges->surface[throat]) {
        find_grain_across(wedges->network, &wedge[0]);
        if (wedge[0].beyond < 0) return;
        const struct wedge one = wedge[0]; // the list may move
        *append(wedges, n) = seen_from_beyond(&one);
    }
}

int wedges_at(struct wedges *wedges, int throat)
{
    int n = 0, single[2];
    for (int64_t k = wedges->offset[throat]; k < wedges->offset[throat + 1]; k++)
        add_side(wedges, throat, &wedges->side[k], &n);
    if (wedges->layer)
        pair_cells(wedges, throat, &n);
    else if (wedges->open[throat] && find_singles(wedges->wedge, n, single) == 2)
        add_missing(wedges, single[0], single[1], &n);
    return n;
}

// --- all of them -------------------------------------------------------------------

// The throats of all corners. The caller frees them.
static enum status find_throats(const struct network *network, int **throats,
                                struct reason *reason)
{
    struct incidence incidence = network_incidence(network);
    int *found = NEW_ARRAY(int, network->face_offset[network->n_face]);
    *throats = found;
    enum status status = STATUS_OK;
    for (int face = 0; face < network->n_face && !status; face++) {
        const int64_t begin = network->face_offset[face];
        const int count = corners_of(network, face);
        if (network->face_particles[face][0] < 0)
            status = refuse(
                reason, STATUS_BAD_DATA,
                "/faces/particles: row %d: the first side must be a grain, got %d",
                face, network->face_particles[face][0]);
        for (int k = 0; k < count && !status; k++) {
            found[begin + k] = face_throat(network, &incidence, face, k);
            if (found[begin + k] < 0)
                status =
                    refuse(reason, STATUS_BAD_DATA,
                           "/faces/nodes: face %d: no throat between nodes %d and %d",
                           face, network->face_nodes[begin + k],
                           network->face_nodes[begin + (k + 1) % count]);
        }
    }
    incidence_free(&incidence);
    return status;
}

// Counts the grains on the sides of FACE.
static int sides_of(const struct wedges *wedges, int face)
{
    return wedges->layer || wedges->network->face_particles[face][1] < 0 ? 1 : 2;
}

static void sort_sides(struct wedges *wedges, const int *throats)
{
    const struct network *network = wedges->network;
    const int n = network->n_throat;
    for (int face = 0; face < network->n_face; face++)
        for (int64_t c = network->face_offset[face]; c < network->face_offset[face + 1];
             c++)
            wedges->offset[throats[c] + 1] += sides_of(wedges, face);
    for (int t = 0; t < n; t++)
        wedges->offset[t + 1] += wedges->offset[t];
    int64_t *next = duplicate(wedges->offset, (size_t)n + 1, sizeof *next);
    wedges->side = NEW_ARRAY(struct side, wedges->offset[n]);
    for (int face = 0; face < network->n_face; face++)
        for (int which = 0; which < sides_of(wedges, face); which++) {
            const bool turned = wedges->layer ? is_cell_turned(network, face)
                                              : is_turned(network, face, which);
            const int *loop = throats + network->face_offset[face];
            for (int k = 0; k < corners_of(network, face); k++)
                wedges->side[next[loop[k]]++] =
                    (struct side){face, k, (uint8_t)which, turned};
        }
    free(next);
}

// Of the walls that both ends of the throat belong to those on which they lie. Where
// cells were left out ends only face a wall.
static unsigned walls_around(const struct network *network, int throat)
{
    static const double rounding = 1e-6; // of the throat
    const int32_t *ends = network->throat_nodes[throat];
    unsigned walls = network->node_walls[ends[0]] & network->node_walls[ends[1]];
    for (int wall = 0; wall <= WALL_INNER; wall++)
        for (int end = 0; end < 2 && walls >> wall & 1; end++) {
            const struct vector x = network->node_position[ends[end]];
            if (!(distance(x, nearest_on_wall(&network->packing, wall, x)) <=
                  rounding * network->throat_length[throat]))
                walls &= ~(1u << wall);
        }
    return walls;
}

static bool is_beside_auxiliary(const struct wedges *wedges, int n)
{
    for (int k = 0; k < n; k++)
        if (is_auxiliary(&wedges->network->packing, wedges->wedge[k].grain))
            return true;
    return false;
}

static void find_surface(struct wedges *wedges)
{
    const struct network *network = wedges->network;
    for (int t = 0; t < network->n_throat; t++)
        wedges->surface[t] = (uint8_t)walls_around(network, t);
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *ends = network->throat_nodes[t];
        if (is_beside_auxiliary(wedges, wedges_at(wedges, t)))
            wedges->surface[t] =
                network->node_walls[ends[0]] & network->node_walls[ends[1]];
    }
}

// Around a throat grains follow one another; at most one face between two is missing.
static enum status find_open(struct wedges *wedges, struct reason *reason)
{
    for (int t = 0; t < wedges->network->n_throat; t++) {
        int single[2];
        const int n = wedges_at(wedges, t);
        const int count = wedges->layer ? 0 : find_singles(wedges->wedge, n, single);
        if (count != 0 && count != 2)
            return refuse(reason, STATUS_BAD_DATA,
                          "/faces/particles: the cell of grain %d is open at throat "
                          "%d: tessellate with boundary=truncate",
                          wedges->wedge[single[0]].grain, t);
        wedges->open[t] = count == 2;
    }
    return STATUS_OK;
}

enum status wedges_find(const struct network *network, struct wedges *wedges,
                        struct reason *reason)
{
    int *throats;
    *wedges = (struct wedges){.network = network,
                              .layer = is_layer(network),
                              .offset = NEW_ARRAY(int64_t, network->n_throat + 1),
                              .open = NEW_ARRAY(bool, network->n_throat),
                              .surface = NEW_ARRAY(uint8_t, network->n_throat)};
    enum status status = find_throats(network, &throats, reason);
    if (!status) {
        sort_sides(wedges, throats);
        find_surface(wedges);
    }
    if (!status) status = find_open(wedges, reason);
    free(throats);
    return status;
}

void wedges_free(struct wedges *wedges)
{
    free(wedges->side);
    free(wedges->offset);
    free(wedges->open);
    free(wedges->surface);
    free(wedges->wedge);
    *wedges = (struct wedges){0};
}
