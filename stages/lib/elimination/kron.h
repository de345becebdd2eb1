// SPDX-License-Identifier: GPL-3.0-or-later
// The flow through a network of conductances between places of given potential, found
// by eliminating its nodes one by one.
//
// An eliminated node leaves links between all its neighbours, c_jk += c_ij c_ik / sum_l
// c_il (star-mesh transformation, Kron reduction), and hands them what is taken from it
// in proportion to c_ij. Sums, products and quotients of positive numbers only, so
// every conductance, potential and flow keeps its digits whatever the range of
// conductances (Grassmann, Taksar and Heyman 1985): digits are lost only where the
// given potentials, or opposite flows to one place, cancel in their own differences.
#pragma once

struct kron_row;

// Room that is kept from network to network, beginning as {0}. It grows as networks do
// and is freed once, with kron_free.
struct kron {
    int n_node,
        n_end; // sites 0..n_node-1 are nodes, the next n_end are of given potential
    int capacity;
    struct kron_row *row; // (capacity)
    double *extracted;    // (capacity) from each site, what it inherits included
    int *place;           // (capacity) workspace
    int *order;           // (n_node) as eliminated
};

// Begins a network without links, nothing taken from it.
void kron_begin(struct kron *kron, int n_node, int n_end);

// Adds to the conductance between two sites, above 0; to what is taken from one, 0 or
// more. Sites count from 0, nodes first.
void kron_link(struct kron *kron, int a, int b, double conductance);
void kron_extract(struct kron *kron, int site, double rate);

// Eliminates all nodes, those of few neighbours first. Each must have a way to an end.
// O(n d^2) for n nodes of d neighbours at their elimination.
void kron_eliminate(struct kron *kron);

// What flows out of the network at end A (counted from 0), where DROP(CONTEXT, B, A) is
// the potential of end B less that of A. Once eliminated.
double kron_flow(const struct kron *kron, int a,
                 double (*drop)(const void *context, int b, int a),
                 const void *context);

// POTENTIAL (n_node + n_end): given at the ends, of one sign, negative or 0; found at
// the nodes.
void kron_potentials(const struct kron *kron, double *potential);

// What it owns; it is {0} then.
void kron_free(struct kron *kron);
