// SPDX-License-Identifier: GPL-3.0-or-later
// A network of throats whose pores are taken out one after the other. Each pore holds
// its throats in a row, and what is left is moved together now and then: close in
// space, close in memory.
#ifndef CRAQUELURE_ELIMINATION_GRAPH_H
#define CRAQUELURE_ELIMINATION_GRAPH_H

#include "conductance_matrix.h"

#include <stdbool.h>
#include <stddef.h>

// A throat, as one of its pores sees it. Widths are of the widest there was.
struct half_throat {
    float width;
    int to; // n of the graph: a place where the pressure is given
};

struct pore_throats {
    int first, count, room;
    bool gone, beside; // beside: a neighbour went since the graph was last packed
};

struct shrinking_graph {
    int n;
    struct pore_throats *pore; // (n)
    int *name;                 // (n+1) of each in the matrix; the last: given places
    struct half_throat *half;
    size_t n_half, capacity;
};

// The network of MATRIX, whose widest throat is WIDEST. The caller frees with
// graph_free.
struct shrinking_graph graph_of(const struct matrix *matrix, double widest);
void graph_free(struct shrinking_graph *graph);

// In place of the throat from AT to GONE, one of WIDTH between AT and OTHER, or a wider
// one where they have one already. Given places keep no throats.
void graph_replace(struct shrinking_graph *graph, int at, int gone, int other,
                   float width);

// AT loses its throat to GONE.
void graph_cut(struct shrinking_graph *graph, int at, int gone);

// Leaves out the pores that are gone; those left are numbered anew, in the same order.
void graph_pack(struct shrinking_graph *graph);

#endif
