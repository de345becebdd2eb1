// SPDX-License-Identifier: GPL-3.0-or-later
// Where the liquid is: in the throats, in parts; in the nodes, all or nothing
// [K 3.4.1]. It owns the vapour and the clusters, because both change with every throat
// that empties, and only here: so the three cannot come to disagree.
#pragma once

#include "basics/compensated.h"
#include "clusters.h"
#include "dry/gas/boundary_layer.h"
#include "dry/gas/vapour.h"
#include "film_law.h"
#include "ring_stores.h"

// It owns its arrays and parts, not NETWORK. Volumes are scaled by the cube of the unit
// of length. Throats of other kinds than THROAT_NETWORK have volume 0 and never liquid.
struct occupancy {
    const struct network *network;
    double length; // m, the unit
    struct incidence incidence;
    unsigned far_walls; // opposite an open one, and closed: bits of enum wall
    struct boundary_layer layer;
    struct vapour vapour;
    struct clusters clusters;

    const struct film_law *film_law; // films of finite resistance; NULL: none
    const struct ring_stores *rings; // NULL: throats leave nothing
    double *volume;                  // (n_throat) scaled; 0 where no throat takes part;
                                     // without what stays in rings
    struct compensated *liquid;      // (n_throat) of the volume
    double capacity;                 // volume of all, rings included
    double initial_liquid;
    struct compensated total_liquid;
    int n_liquid; // throats not yet empty, and nodes whose rings are not yet dry

    bool *gas;          // (n_node)
    int *liquid_beside; // (n_node) throats with liquid at the node
    bool *has_rings;    // (n_node) rings there hold liquid; NULL without rings
    const double *rings_at_start; // (n_node) their saturations; kept; NULL: 1
    int *feeder; // (n_node) with films: cluster that feeds rings there, -1: none
    int n_wet;
    int *wet;          // (n_wet) nodes with liquid on one side and gas on the other
    int *wet_place;    // (n_node) in wet, -1 where not wet
    bool breakthrough; // gas has reached one of the far walls
};

// Places where liquid may be: throats and, with rings, nodes; the rings at node i are
// place n_throat + i.
static inline int n_place_of(const struct occupancy *occupancy)
{
    const struct network *network = occupancy->network;
    return network->n_throat + (occupancy->rings ? network->n_node : 0);
}

// Whether the rings at NODE hold liquid.
static inline bool node_has_rings(const struct occupancy *occupancy, int node)
{
    return occupancy->has_rings && occupancy->has_rings[node];
}

// How to make one. It owns nothing.
struct occupancy_form {
    double length;                   // m, the unit
    bool gas_parts;                  // as in struct clusters
    const double *entry_priority;    // (n_throat) as clusters_init takes it
    double knudsen_radius;           // m, as vapour_init takes it
    double vapour_tolerance;         // likewise
    double vapour_step;              // likewise
    const struct ring_stores *rings; // kept; NULL: none
    bool films;                      // join what was a cluster at the start
    const struct film_law *film_law; // kept; NULL: none
};

// A network full of liquid under its boundary layer: the exposed nodes are liquid and
// wet. Takes over LAYER, keeps NETWORK. The caller frees OCCUPANCY with occupancy_free,
// also after a failure.
//
// STATUS_BAD_DATA with a throat if no path leads from it to an open wall.
enum status occupancy_init(const struct network *network, unsigned open_walls,
                           const struct occupancy_form *form,
                           struct boundary_layer layer, struct occupancy *occupancy,
                           struct reason *reason);

// THROAT has lost its last liquid: gas fills it and both its nodes. The vapour gains a
// link, its cluster may split, and each of its nodes becomes wet, or dry if no liquid
// is left there, in throats or rings. Once for each throat. `total_liquid` is the
// caller's to change.
void occupancy_empty_throat(struct occupancy *occupancy, int throat);

// The rings at NODE, where all throats are empty, have dried.
void occupancy_dry_rings(struct occupancy *occupancy, int node);

// Saturation of THROAT, from 0 to 1. Only at the start and in viscous or Kelvin runs:
// else emptying_times_saturation knows it.
double occupancy_saturation(const struct occupancy *occupancy, int throat);

// Keeps all that changes, or restores it into an occupancy just made, of the same
// network and form. Whether the parts then agree is for run_fits to say.
void occupancy_state(struct occupancy *occupancy, struct checkpoint_stream *stream);

void occupancy_free(struct occupancy *occupancy);
