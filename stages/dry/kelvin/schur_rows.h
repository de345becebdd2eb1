// SPDX-License-Identifier: GPL-3.0-or-later
// How what a body of liquid evaporates decreases with the potentials of all bodies: the
// rows of a symmetric, positive semidefinite matrix. It is sparse, for most links are
// throats. It is the Schur complement of the dry nodes in the vapour's balances, summed
// over the wet nodes of each body.
//
// In code order, S_ab = sum over wet nodes k of part_ak air_conductance_k part_bk
//     + sum over links (k, l) of c_kl (part_ak - part_al) (part_bk - part_bl):
// as differences of parts, so that a link inside one body adds exactly 0.
#pragma once

#include "kelvin_menisci.h"

struct at_node {
    int k; // of the wet nodes
    double part;
};

// It owns its arrays. Bodies are numbered as kelvin_list_bodies lists them.
struct schur_rows {
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
// with schur_rows_free.
struct schur_rows schur_rows_init(int n_throat, int n_site);

// Call after the bodies have been listed: lists the wet nodes of each.
void schur_rows_list(struct schur_rows *rows, const struct kelvin_menisci *kelvin,
                     const struct occupancy *occupancy);

// Makes the row of BODY in N, COLUMN and VALUE; _clear must follow before the next.
// O(links of the wet nodes of BODY).
void schur_rows_take(struct schur_rows *rows, const struct kelvin_menisci *kelvin,
                     const struct occupancy *occupancy, int body);
void schur_rows_clear(struct schur_rows *rows);

void schur_rows_free(struct schur_rows *rows);
