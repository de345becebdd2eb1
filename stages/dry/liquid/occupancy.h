// SPDX-License-Identifier: GPL-3.0-or-later
// Where the liquid is: in the throats, in parts; in the nodes, all or nothing
// [K 3.4.1].
#ifndef CRAQUELURE_PHASES_H
#define CRAQUELURE_PHASES_H

#include "basics/compensated.h"
#include "clusters.h"
#include "dry/gas/boundary_layer.h"
#include "dry/gas/vapour.h"

struct phases {
    const struct network *network;
    struct incidence incidence;
    unsigned far_walls; // opposite an open one, and closed: bits of enum wall
    struct boundary_layer layer;
    struct vapour vapour;
    struct clusters clusters;

    double *volume;             // (n_throat) scaled; 0 where no throat takes part
    struct compensated *liquid; // (n_throat) of the volume
    double capacity;            // volume of all
    double initial_liquid;
    struct compensated total_liquid;
    int n_full; // throats not yet empty

    bool *gas;          // (n_node)
    int *liquid_beside; // (n_node) throats with liquid at the node
    int n_wet;
    int *wet;          // (n_wet) nodes with liquid on one side and gas on the other
    int *wet_place;    // (n_node) in wet, -1 where not wet
    bool breakthrough; // gas has reached one of the far walls
};

struct phases_form {
    double length;           // m, the unit
    bool gas_parts;          // as in struct clusters
    const double *ease;      // (n_throat) as clusters_make takes it
    double knudsen_radius;   // m, as vapour_make takes it
    double vapour_tolerance; // likewise
};

// A network full of liquid under its boundary layer: the exposed nodes are liquid and
// wet. Takes over LAYER. The caller frees PHASES with
// phases_free, also after a failure.
//
// STATUS_BAD_DATA if a piece of the network has no way to an open wall.
enum status phases_make(const struct network *network, unsigned open_walls,
                        const struct phases_form *form, struct boundary_layer layer,
                        struct phases *phases, struct reason *reason);

// THROAT has lost its last liquid: gas fills it and both its nodes.
void phases_empty_throat(struct phases *phases, int throat);

// Of THROAT, where the phases know it: at the start, and in viscous liquid.
double phases_saturation(const struct phases *phases, int throat);

void phases_state(struct phases *phases, struct checkpoint_stream *stream);

void phases_free(struct phases *phases);

#endif
