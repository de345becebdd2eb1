// SPDX-License-Identifier: GPL-3.0-or-later
// The pore network between the grains of a packing: what network.h5 holds, in memory.
//
// Nodes are Voronoi vertices, throats are Voronoi edges seen as cylinders [K 3.3.4],
// and faces separate two grains, or a grain from a wall (K's fv and fc, K 3.7). The
// faces of one grain close around it: its Voronoi cell cut by the box.
//
// Loops that come up again and again, in a network n with its incidence in:
//     nodes of face f    face_nodes[k],  face_offset[f] <= k < face_offset[f + 1]
//     throats of face f  face_throat(&n, &in, f, k),  k from 0 to its corners less 1
//     throats of node i  in.throat[k],   in.offset[i] <= k < in.offset[i + 1]
//     faces of grain g   those with g in face_particles
// throat_sides.h has the faces of each throat. Rows are those of the artifact: whoever
// removes nodes or throats must renumber all that refers to them (compact_nodes of
// tessellate, merging_finish of merge-nodes).
//
// Functions that only read are safe for several threads. A network from another program
// may lack faces (n_face = 0): what needs them says so.
#pragma once

#include "geometry/image.h"
#include "geometry/packing.h"

enum throat_kind {
    THROAT_NETWORK = 0,
    THROAT_BOUNDARY_LAYER = 1, // gas above the surface [K 3.3.5]
    THROAT_IMPOSED_EMPTY = 2   // holds no liquid and lets nothing through [K 5.4], or
                               // is closed by grains
};

// The images are NULL unless the box repeats; then what is in another repetition of it
// than the nodes and grains listed lies that many boxes away.
struct network {
    struct packing packing; // the grains travel along

    int n_node;
    struct vector *node_position; // (n_node) m
    uint8_t *node_walls; // (n_node) /nodes/kind: walls it lies on, bits of enum wall

    int n_throat;
    // (n_throat) Lower node first; one node twice only around a box that repeats.
    int32_t (*throat_nodes)[2];
    double *throat_radius; // (n_throat) m
    double *throat_length; // (n_throat) m
    uint8_t *throat_kind;  // (n_throat) enum throat_kind
    double *throat_volume; // (n_throat) m3; NULL: the throats are cylinders
    // What throats conduct [network/open_section.h]; each NULL: as cylinders do.
    double *throat_diffusion;        // (n_throat) m
    double *throat_flow;             // (n_throat) m3
    double *throat_hydraulic_radius; // (n_throat) m
    struct image *throat_image; // (n_throat) of the second node, seen from the first

    int n_face;
    int64_t *face_offset;          // (n_face+1) into face_nodes
    int32_t *face_nodes;           // each face a closed loop of nodes
    int32_t (*face_particles)[2];  // (n_face) two grains; -1-w for wall w = 0..5
    struct image *face_image;      // (n_face) of the second grain, seen from the first
    struct image *face_node_image; // of each of face_nodes, seen from the first grain

    // Throats, and their mean length in m, before any were merged away: what thresholds
    // of merging are relative to. 0: not merged yet.
    int unmerged_throats;
    double unmerged_length;
};

// Whether it is the network of one layer of grains, in a plane (tessellate's
// dimensions=2): then faces are the cells of the grains, each with the lower wall y as
// its second side.
bool is_layer(const struct network *network);

// Where the second node of a throat is, seen from the first: in another repetition of
// the box, if the throat leads there.
struct vector along_throat(const struct network *network, int throat);
// Half of the way from its first node.
struct vector throat_middle(const struct network *network, int throat);

// (n_throat,2) Ends of the throats as lines to draw: one that leads into another
// repetition of the box is a point, not a line across the box. The caller frees it.
int32_t (*drawn_throats(const struct network *network))[2];

// Where the node face_nodes[CORNER] is, and the second grain of FACE (not a wall), both
// in the repetition of the box in which the first grain of the face is.
struct vector face_corner(const struct network *network, int64_t corner);
struct vector second_grain(const struct network *network, int face);

// Frees what the network owns, packing included, and empties it; safe on an empty one.
void network_free(struct network *network);

// The throats at each node, as compressed rows: throats of node i are
// throat[offset[i]] .. throat[offset[i+1]-1], in ascending order.
struct incidence {
    int *offset; // (n_node+1)
    int *throat; // (2 n_throat)
};

// O(n_node + n_throat). The caller frees it with incidence_free.
struct incidence network_incidence(const struct network *network);
void incidence_free(struct incidence *incidence);

// The throat from corner K (0 and up) of FACE to the next one in its loop, or -1.
// O(throats at a node). -1: faces that do not close, as of networks from elsewhere.
int face_throat(const struct network *network, const struct incidence *incidence,
                int face, int k);

// Marks as THROAT_IMPOSED_EMPTY the throats that lie in one of WALLS (bits of enum
// wall), that is whose two nodes are both on that wall: they hold no liquid, and
// neither vapour nor gas passes through them [K 5.4]. Returns how many are so marked in
// all.
int impose_empty_throats(struct network *network, unsigned walls);

// The same for throats without a radius or an open section, which grains close: no
// liquid, no vapour and no gas. Returns how many of kind THROAT_NETWORK there were.
int shut_closed_throats(struct network *network);

// Liquid a full throat holds, m3: what the network says, else the cylinder pi r^2 L [K
// 3.3.4]. Of any kind of throat; whether it may hold liquid says throat_kind.
double throat_volume(const struct network *network, int throat);

// Conductance of a throat to diffusion, in units of LENGTH, and to flow, in units of
// LENGTH^3: flux over (diffusivity x difference of concentration), and over
// (difference of pressure / dynamic viscosity). What the network says, else those of
// the cylinder, pi r^2 / L and pi r^4 / (8 L).
double diffusive_conductance(const struct network *network, int throat, double length);
double hydraulic_conductance(const struct network *network, int throat, double length);
// What collisions with walls see, m: what the network says, else the throat's radius.
double hydraulic_radius(const struct network *network, int throat);

// Gives throat TO what throat FROM conducts, where the network says it.
void copy_throat_shape(struct network *network, int from, int to);
// Forgets what the throats conduct: they are cylinders.
void forget_throat_shapes(struct network *network);
