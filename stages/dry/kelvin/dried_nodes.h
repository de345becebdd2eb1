// SPDX-License-Identifier: GPL-3.0-or-later
// What a throat that empties changes in the matrix of the bodies of liquid: bodies at
// its ends, or that split, are replaced by others; nodes that dry are eliminated. So
// the matrix need not be made anew at each event: the caller replaces the rows listed
// here and keeps the rest.
#pragma once

#include "dry/liquid/occupancy.h"

struct dried_link {
    int site;
    double conductance;
};

struct dried_node {
    int begin, end; // of its links, as they were when it dried
    double total;   // conductance of all its links, to the air and, through the throat
                    // that empties, to the other node as well
};

// It owns its arrays.
struct dried_nodes {
    bool by_throat; // a throat is a body of liquid; else a cluster
    int n_throat;   // that have emptied
    int n_body;
    int *body;  // (n_body) throats or clusters whose rows are no longer valid
    bool *seen; // (n_throat of the network) whether in BODY
    int n_node, node_capacity;
    struct dried_node *node; // (n_node)
    int n_link, link_capacity;
    struct dried_link *link; // (n_link)
    int *other;              // (n_site) room
    double *conductance;     // (n_site) 0 between calls
};

// For a network of N_THROAT throats and vapour of N_SITE sites. The caller frees it
// with dried_nodes_free.
struct dried_nodes dried_nodes_init(int n_throat, int n_site, bool by_throat);

// Call _note_before when THROAT is about to be emptied, _note_after when it has been.
// Both must be called for each throat, in the order in which throats empty.
void dried_nodes_note_before(struct dried_nodes *dried, struct occupancy *occupancy,
                             int throat);
void dried_nodes_note_after(struct dried_nodes *dried,
                            const struct occupancy *occupancy);

// Forgets all that has been noted.
void dried_nodes_clear(struct dried_nodes *dried);

void dried_nodes_free(struct dried_nodes *dried);
