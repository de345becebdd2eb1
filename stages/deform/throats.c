// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths change with the distance of the nodes, l' = l |d'| / |d|; radii with the
// clearance and the radii of the grains, r' = s r + (c' - s c) min(1, r / c)
// (throats.h). So a length that was not the distance of its nodes keeps its ratio to
// that, and a drawn radius its share of the clearance.
//
// Volumes that were shares of the void are computed again; others change as the
// cylinders of their throats, r'^2 l' / (r^2 l), and are then scaled by one factor, so
// that their sum changes by exactly as much as the void of the box does. Conductances
// that were those of the open section are found again; others follow the cylinders,
//     diffusion ~ r^2 / l,  flow ~ r^4 / l,  hydraulic radius ~ r.
// Which of the two they were is found by computing them for `before` and comparing
// (1e-9 of the largest): the network does not say where they come from. Trap: the flow
// conductances and hydraulic radii are not compared, only those of diffusion.
//
// If no grain has moved or shrunk, volumes and conductances stay, digit by digit.
#include "throats.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"
#include "geometry/porosity.h"
#include "network/throat_shapes.h"
#include "network/void_volume.h"

#include <stdlib.h>
#include <string.h>

// ---- lengths and radii --------------------------------------------------------------

// Adds the grains of FACE to WAY, the clearance of the throat from its corner FROM to
// TO.
static struct clear_way clear_of_face(struct clear_way way,
                                      const struct network *network, int face,
                                      int64_t from, int64_t to, enum clearance how)
{
    const struct packing *packing = &network->packing;
    const int32_t *side = network->face_particles[face];
    const struct vector end[2] = {face_corner(network, from), face_corner(network, to)};
    way = clear_of(way, packing->position[side[0]], packing->radius[side[0]], end, how);
    if (side[1] < 0) return way;
    return clear_of(way, second_grain(network, face), packing->radius[side[1]], end,
                    how);
}

// The clearance of each throat (n_throat) to the grains beside it; NULL with the
// reason.
static struct clear_way *find_clear_ways(const struct network *network,
                                         enum clearance how, struct reason *reason)
{
    struct incidence incidence = network_incidence(network);
    struct clear_way *way = NEW_ARRAY(struct clear_way, network->n_throat);
    for (int t = 0; t < network->n_throat; t++)
        way[t] = nothing_beside;
    bool fits = true;
    for (int f = 0; f < network->n_face && fits; f++) {
        const int64_t begin = network->face_offset[f];
        const int count = (int)(network->face_offset[f + 1] - begin);
        for (int k = 0; k < count && fits; k++) {
            const int t = face_throat(network, &incidence, f, k);
            fits = t >= 0;
            if (!fits)
                refuse(reason, STATUS_BAD_DATA,
                       "/faces/nodes: face %d: no throat from its corner %d", f, k);
            else
                way[t] = clear_of_face(way[t], network, f, begin + k,
                                       begin + (k + 1) % count, how);
        }
    }
    incidence_free(&incidence);
    if (fits) return way;
    free(way);
    return NULL;
}

double *find_clearances(const struct network *network, enum clearance how,
                        struct reason *reason)
{
    struct clear_way *way = find_clear_ways(network, how, reason);
    if (!way) return NULL;
    struct sphere_cells grains = sphere_cells_init(&network->packing);
    double *least = NEW_ARRAY(double, network->n_throat);
    for (int t = 0; t < network->n_throat; t++) {
        const struct vector from = network->node_position[network->throat_nodes[t][0]];
        const struct vector end[2] = {from, add(from, along_throat(network, t))};
        const bool any = how == CLEARANCE_SEGMENT && isfinite(way[t].least);
        least[t] = fmax(0, any ? least_clearance(&grains, end, way[t]) : way[t].least);
    }
    sphere_cells_free(&grains);
    free(way);
    return least;
}

double *find_growth(const struct network *before, const struct neighbour_grains *around,
                    const struct packing *moved)
{
    double *growth = NEW_ARRAY(double, before->n_throat);
    for (int t = 0; t < before->n_throat; t++) {
        double old = 0, now = 0;
        for (int end = 0; end < 2; end++) {
            const int node = before->throat_nodes[t][end];
            for (int64_t g = around->offset[node]; g < around->offset[node + 1]; g++) {
                old += before->packing.radius[around->at[g].grain];
                now += moved->radius[around->at[g].grain];
            }
        }
        growth[t] = old > 0 ? now / old : 1;
    }
    return growth;
}

double moved_radius(double radius, double growth, double before, double after)
{
    if (isinf(before) || isinf(after)) return growth * radius;
    const double share = radius < before ? radius / before : 1;
    return fmax(0, growth * radius + share * (after - growth * before));
}

// AFTER has the faces of BEFORE, so its clearances cannot fail where those did not.
enum status move_throats(const struct network *before,
                         const struct neighbour_grains *around, enum clearance how,
                         struct network *after, struct reason *reason)
{
    double *old = find_clearances(before, how, reason);
    if (!old) return STATUS_BAD_DATA;
    double *now = find_clearances(after, how, reason);
    double *growth = find_growth(before, around, &after->packing);
    for (int t = 0; t < before->n_throat; t++) {
        const double length = norm(along_throat(before, t));
        const double moved = norm(along_throat(after, t));
        after->throat_length[t] =
            length > 0 ? before->throat_length[t] * (moved / length) : moved;
        after->throat_radius[t] =
            moved_radius(before->throat_radius[t], growth[t], old[t], now[t]);
    }
    free(growth);
    free(old);
    free(now);
    return STATUS_OK;
}

// ---- volumes ------------------------------------------------------------------------

// The void of the domain, m3: its volume without all solid in the box, where what two
// grains share counts once (geometry/porosity.h).
static double void_of(const struct packing *packing)
{
    struct contacts contacts;
    contacts.pair = (const int32_t(*)[2])neighbour_pairs(packing, 0, &contacts.count);
    const struct window box = {packing->lower, packing->upper};
    const struct vector edge = subtract(box.upper, box.lower);
    double porosity;
    slice_porosity(packing, &contacts, &box, 1, &porosity);
    free((void *)(uintptr_t)contacts.pair);
    return packing_domain_volume(packing) - (1 - porosity) * box_volume(edge);
}

static bool nothing_moved(const struct network *before, const struct network *after)
{
    const size_t n = (size_t)before->packing.n_particle;
    return !memcmp(before->packing.position, after->packing.position,
                   n * sizeof *before->packing.position) &&
           !memcmp(before->packing.radius, after->packing.radius,
                   n * sizeof *before->packing.radius);
}

// Whether the volumes of NETWORK are what find_void_volumes gives.
static bool has_shares_of_void(struct network network)
{
    static const double same = 1e-9; // of the largest
    const double *volume = network.throat_volume;
    network.throat_volume = NULL;
    struct reason reason;
    if (find_void_volumes(&network, &reason)) return false;
    double largest = 0, apart = 0;
    for (int t = 0; t < network.n_throat; t++) {
        largest = fmax(largest, volume[t]);
        apart = fmax(apart, fabs(volume[t] - network.throat_volume[t]));
    }
    free(network.throat_volume);
    return apart <= same * largest;
}

static double cylinder(const struct network *network, int t)
{
    return network->throat_radius[t] * network->throat_radius[t] *
           network->throat_length[t];
}

// A throat without a cylinder keeps its volume but for the common factor.
static void scale_volumes(const struct network *before, struct network *after)
{
    double old = 0, now = 0;
    for (int t = 0; t < before->n_throat; t++) {
        const double from = cylinder(before, t), to = cylinder(after, t);
        after->throat_volume[t] = before->throat_volume[t] * (from > 0 ? to / from : 1);
        old += before->throat_volume[t];
        now += after->throat_volume[t];
    }
    const double wanted = old + (void_of(&after->packing) - void_of(&before->packing));
    for (int t = 0; t < before->n_throat && now > 0; t++)
        after->throat_volume[t] *= fmax(0, wanted) / now;
}

enum status move_volumes(const struct network *before, bool changed,
                         struct network *after, struct reason *reason)
{
    if (!before->throat_volume) return STATUS_OK;
    if (nothing_moved(before, after)) return STATUS_OK;
    if (!changed && has_shares_of_void(*before))
        return find_void_volumes(after, reason);
    scale_volumes(before, after);
    return STATUS_OK;
}

// ---- conductances -------------------------------------------------------------------

// Whether the conductances of NETWORK are what find_throat_shapes gives.
static bool has_shapes_of_void(struct network network)
{
    static const double same = 1e-9; // of the largest
    const double *said = network.throat_diffusion;
    network.throat_diffusion = network.throat_flow = NULL;
    network.throat_hydraulic_radius = NULL;
    struct reason reason;
    if (!said || find_throat_shapes(&network, &reason)) return false;
    double largest = 0, apart = 0;
    for (int t = 0; t < network.n_throat; t++) {
        largest = fmax(largest, said[t]);
        apart = fmax(apart, fabs(said[t] - network.throat_diffusion[t]));
    }
    forget_throat_shapes(&network);
    return apart <= same * largest;
}

enum status move_shapes(const struct network *before, bool changed,
                        struct network *after, struct reason *reason)
{
    if (nothing_moved(before, after)) return STATUS_OK; // not even digits change
    if (!changed && has_shapes_of_void(*before))
        return find_throat_shapes(after, reason);
    for (int t = 0; t < before->n_throat; t++) {
        const double wider = before->throat_radius[t] > 0
                                 ? after->throat_radius[t] / before->throat_radius[t]
                                 : 1;
        const double longer = before->throat_length[t] > 0
                                  ? after->throat_length[t] / before->throat_length[t]
                                  : 1;
        const double section = wider * wider;
        if (after->throat_diffusion) after->throat_diffusion[t] *= section / longer;
        if (after->throat_flow) after->throat_flow[t] *= section * section / longer;
        if (after->throat_hydraulic_radius) after->throat_hydraulic_radius[t] *= wider;
    }
    return STATUS_OK;
}

static bool is_closed(const struct network *network, int t)
{
    return network->throat_kind[t] == THROAT_NETWORK &&
           !(throat_volume(network, t) > 0 && network->throat_radius[t] > 0);
}

int count_closed_throats(const struct network *before, const struct network *after)
{
    int count = 0;
    for (int t = 0; t < before->n_throat; t++)
        count += is_closed(after, t) && !is_closed(before, t);
    return count;
}
