// SPDX-License-Identifier: GPL-3.0-or-later
// How what a body of liquid evaporates falls with the potentials of all: the rows of a
// symmetric matrix, positive semidefinite and sparse, for most links are throats.
#ifndef CRAQUELURE_BODY_ROWS_H
#define CRAQUELURE_BODY_ROWS_H

#include "kelvin_menisci.h"

struct at_node {
    int k; // of the wet nodes
    double part;
};

struct body_rows {
    int *offset;        // (bodies+1) of each body's wet nodes
    struct at_node *at; // (offset[bodies])

    // The row at hand.
    int n;         // entries
    int *column;   // (n) bodies
    double *value; // (bodies) 0 elsewhere
    bool *listed;  // (bodies) whether in COLUMN

    int *other;   // (n_site) of a node's links
    double *link; // (n_site) 0 between calls
};

// For a network of N_THROAT throats and vapour of N_SITE sites. The caller frees it
// with body_rows_free.
struct body_rows body_rows_make(int n_throat, int n_site);

// Bodies have been listed.
void body_rows_list(struct body_rows *rows, const struct curved *curved,
                    const struct phases *phases);

// Makes the row of BODY; clears it.
void body_rows_take(struct body_rows *rows, const struct curved *curved,
                    const struct phases *phases, int body);
void body_rows_clear(struct body_rows *rows);

void body_rows_free(struct body_rows *rows);

#endif
