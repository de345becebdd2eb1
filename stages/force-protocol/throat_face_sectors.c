// SPDX-License-Identifier: GPL-3.0-or-later
// Sectors: a throat beside a face, seen from one grain, is the triangle from the foot
// of the face to the throat. The foot is where the line between the grains at x_i and
// x_j crosses the plane of equal power [K 3.2],
//     foot = x_i + (1/2 + (R_i^2 - R_j^2) / (2 |x_j - x_i|^2)) (x_j - x_i).
// Sectors are made when asked for, from the list of face sides of each throat. A face
// that was removed with cut cells leaves a gap around a throat: the two grains beside
// the gap have one sector each, and the missing pair is made from them. The trap is
// orientation: a large grain can engulf the centre of a small one, which then lies
// beyond its own face, so the sense of a loop is taken from the neighbour, not from
// the foot.
#include "throat_face_sectors.h"

#include "basics/memory.h"

#include <stdlib.h>

// A throat, the K-th of a face's loop, seen from the grain on one side of the face.
// There are some 66 a grain: 8 bytes each.
struct side {
    int32_t face;
    uint32_t which : 1;  // side of the face
    uint32_t turned : 1; // the loop runs clockwise seen from beyond
    uint32_t k : 30;
};

static const unsigned MOST_K = (1u << 30) - 1; // of .k

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

// The point of equal power on the line from the centre of grain I to that of J: the
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

// Twice the area vector of a face, from its corners.
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

static struct sector *append(struct sectors *sectors, int *n)
{
    GROW_ARRAY(sectors->sector, *n, sectors->capacity);
    return &sectors->sector[(*n)++];
}

static void add_side(struct sectors *sectors, int throat, const struct side *side,
                     int *n)
{
    const struct network *network = sectors->network;
    const int32_t *grains = network->face_particles[side->face];
    const int count = corners_of(network, side->face);
    const int64_t begin = network->face_offset[side->face];
    const int k = (int)side->k, next = (k + 1) % count;
    struct sector *sector = append(sectors, n);
    *sector =
        (struct sector){.throat = throat,
                        .grain = grains[side->which],
                        .beyond = grains[!side->which],
                        .face = side->face,
                        .centre = centre_of(network, side->face, side->which),
                        .from = face_corner(network, begin + (side->turned ? next : k)),
                        .to = face_corner(network, begin + (side->turned ? k : next))};
    if (sectors->layer) {
        sector->beyond = -1;
        sector->centre.y = sector->from.y; // grains and throats are staggered
        sector->foot = scale(0.5, add(sector->from, sector->to));
        sector->across = sector->foot;
    } else if (sector->beyond < 0) {
        sector->foot =
            nearest_on_wall(&network->packing, -1 - sector->beyond, sector->centre);
        sector->across = sector->foot;
    } else {
        sector->across = centre_of(network, side->face, !side->which);
        sector->foot = foot_between(&network->packing, sector->grain, sector->centre,
                                    sector->beyond, sector->across);
    }
}

// The same sector seen from the grain across, for a face that the network has not kept.
static struct sector seen_from_beyond(const struct sector *sector)
{
    return (struct sector){.throat = sector->throat,
                           .grain = sector->beyond,
                           .beyond = sector->grain,
                           .face = -1,
                           .centre = sector->across,
                           .across = sector->centre,
                           .foot = sector->foot,
                           .from = sector->to,
                           .to = sector->from};
}

// The wedges of the face between the grains of A and B, which the network has not kept:
// both have a wedge against a grain between them. Seen from the first the throat runs
// the other way in the face on its other side, and so it does in that of the second.
static void add_missing(struct sectors *sectors, int a, int b, int *n)
{
    struct sector sector = sectors->sector[a];
    const struct sector *other = &sectors->sector[b];
    sector.beyond = other->grain;
    sector.face = -1;
    sector.across = add(other->centre, subtract(sector.to, other->from));
    sector.foot = foot_between(&sectors->network->packing, sector.grain, sector.centre,
                               sector.beyond, sector.across);
    sector.from = sectors->sector[a].to;
    sector.to = sectors->sector[a].from;
    *append(sectors, n) = sector;
    *append(sectors, n) = seen_from_beyond(&sector);
}

// Finds grains that have only one of the N sectors, and so miss a face. Returns their
// number; SINGLE has the sectors of the first two.
static int find_singles(const struct sector *sector, int n, int single[2])
{
    int count = 0;
    for (int a = 0; a < n; a++) {
        int same = 0;
        for (int b = 0; b < n; b++)
            same += sector[b].grain == sector[a].grain;
        if (same > 1) continue;
        if (count < 2) single[count] = a;
        count++;
    }
    return count;
}

// --- layers ------------------------------------------------------------------------

// The periodic copy of grain J of least power at X; POWER becomes that power.
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

// The grain across the throat of SECTOR, whose cell was left out: of all others that of
// least power at its middle.
static void find_grain_across(const struct network *network, struct sector *sector)
{
    double least = INFINITY;
    for (int j = 0; j < network->packing.n_particle; j++) {
        double power;
        const struct vector copy =
            nearest_copy(&network->packing, j, sector->foot, &power);
        if (power >= least || distance(copy, sector->centre) == 0) continue;
        least = power;
        sector->beyond = j;
        sector->across = copy;
    }
}

// In a layer both sides of a throat are cells: each sector's grain across is the
// other's.
static void pair_cells(struct sectors *sectors, int throat, int *n)
{
    struct sector *sector = sectors->sector;
    if (*n == 2) {
        for (int k = 0; k < 2; k++) {
            sector[k].beyond = sector[!k].grain;
            sector[k].across =
                add(sector[!k].centre, subtract(sector[k].to, sector[!k].from));
        }
    } else if (*n == 1 && !sectors->surface[throat]) {
        find_grain_across(sectors->network, &sector[0]);
        if (sector[0].beyond < 0) return;
        const struct sector one = sector[0]; // the list may move
        *append(sectors, n) = seen_from_beyond(&one);
    }
}

int sectors_at(struct sectors *sectors, int throat)
{
    int n = 0, single[2];
    for (int64_t k = sectors->offset[throat]; k < sectors->offset[throat + 1]; k++)
        add_side(sectors, throat, &sectors->side[k], &n);
    if (sectors->layer)
        pair_cells(sectors, throat, &n);
    else if (sectors->open[throat] && find_singles(sectors->sector, n, single) == 2)
        add_missing(sectors, single[0], single[1], &n);
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
static unsigned sides_of(const struct sectors *sectors, int face)
{
    return sectors->layer || sectors->network->face_particles[face][1] < 0 ? 1 : 2;
}

static void sort_sides(struct sectors *sectors, const int *throats)
{
    const struct network *network = sectors->network;
    const int n = network->n_throat;
    for (int face = 0; face < network->n_face; face++)
        for (int64_t c = network->face_offset[face]; c < network->face_offset[face + 1];
             c++)
            sectors->offset[throats[c] + 1] += sides_of(sectors, face);
    for (int t = 0; t < n; t++)
        sectors->offset[t + 1] += sectors->offset[t];
    int64_t *next = duplicate(sectors->offset, (size_t)n + 1, sizeof *next);
    sectors->side = NEW_ARRAY(struct side, sectors->offset[n]);
    for (int face = 0; face < network->n_face; face++)
        for (unsigned which = 0; which < sides_of(sectors, face); which++) {
            const bool turned = sectors->layer ? is_cell_turned(network, face)
                                               : is_turned(network, face, (int)which);
            const int *loop = throats + network->face_offset[face];
            for (unsigned k = 0; k < (unsigned)corners_of(network, face); k++)
                sectors->side[next[loop[k]]++] =
                    (struct side){face, which & 1, turned, k & MOST_K};
        }
    free(next);
}

// The walls (bits) on which both ends of the throat lie; where cells were left out,
// nodes have the bit of a wall that they only face.
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

static bool is_beside_auxiliary(const struct sectors *sectors, int n)
{
    for (int k = 0; k < n; k++)
        if (is_auxiliary(&sectors->network->packing, sectors->sector[k].grain))
            return true;
    return false;
}

static void find_surface(struct sectors *sectors)
{
    const struct network *network = sectors->network;
    for (int t = 0; t < network->n_throat; t++)
        sectors->surface[t] = (uint8_t)walls_around(network, t);
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *ends = network->throat_nodes[t];
        if (is_beside_auxiliary(sectors, sectors_at(sectors, t)))
            sectors->surface[t] =
                network->node_walls[ends[0]] & network->node_walls[ends[1]];
    }
}

// Finds throats with a missing face. At most one face around a throat may be missing.
static enum status find_open(struct sectors *sectors, struct reason *reason)
{
    for (int t = 0; t < sectors->network->n_throat; t++) {
        int single[2];
        const int n = sectors_at(sectors, t);
        const int count = sectors->layer ? 0 : find_singles(sectors->sector, n, single);
        if (count != 0 && count != 2)
            return refuse(reason, STATUS_BAD_DATA,
                          "/faces/particles: the cell of grain %d is open at throat "
                          "%d: tessellate with boundary=truncate",
                          sectors->sector[single[0]].grain, t);
        sectors->open[t] = count == 2;
    }
    return STATUS_OK;
}

enum status sectors_find(const struct network *network, struct sectors *sectors,
                         struct reason *reason)
{
    int *throats;
    *sectors = (struct sectors){.network = network,
                                .layer = is_layer(network),
                                .offset = NEW_ARRAY(int64_t, network->n_throat + 1),
                                .open = NEW_ARRAY(bool, network->n_throat),
                                .surface = NEW_ARRAY(uint8_t, network->n_throat)};
    enum status status = find_throats(network, &throats, reason);
    if (!status) {
        sort_sides(sectors, throats);
        find_surface(sectors);
    }
    if (!status) status = find_open(sectors, reason);
    free(throats);
    return status;
}

static void free_faces(struct network *network)
{
    free(network->face_offset);
    free(network->face_nodes);
    free(network->face_particles);
    free(network->face_image);
    free(network->face_node_image);
    network->n_face = 0;
    network->face_offset = NULL;
    network->face_nodes = NULL;
    network->face_particles = NULL;
    network->face_image = network->face_node_image = NULL;
}

void sectors_free_sides(struct sectors *sectors)
{
    free(sectors->side);
    free(sectors->offset);
    sectors->side = NULL;
    sectors->offset = NULL;
    if (sectors->spare) free_faces(sectors->spare);
}

void sectors_free(struct sectors *sectors)
{
    sectors_free_sides(sectors);
    free(sectors->open);
    free(sectors->surface);
    free(sectors->sector);
    *sectors = (struct sectors){0};
}
