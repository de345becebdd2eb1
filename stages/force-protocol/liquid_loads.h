// SPDX-License-Identifier: GPL-3.0-or-later
// What is in each throat over the time of drying: how much liquid, under which suction,
// with how many menisci.
#ifndef CRAQUELURE_LIQUID_LOADS_H
#define CRAQUELURE_LIQUID_LOADS_H

#include "network/drying_record.h"

// What the drying artifact says happened.
struct liquid_record {
    struct drying_record drying; // at least one step
    bool *exposed;               // (n_node) gas is above the node from the beginning
    int n_snapshot;
    double *snapshot_time; // (n_snapshot)
    double *pressure;      // (n_snapshot * n_node) Pa, of the liquid less that of the
                           // gas; 0 in gas. NULL: not known
};

enum suction_rule {
    SUCTION_UNIFORM, // that of a throat of mean radius, everywhere [K 5.3]
    // In each connected piece of liquid that of its widest throat with a meniscus, into
    // which gas comes next: there the meniscus is as curved as it can be, and behind
    // all others of the piece is the same pressure; with weight, at the same height:
    // then gas comes next where the suction less rho g z is least.
    SUCTION_CLUSTERS,
    // By the pressures of viscous liquid at the nodes: a throat has the mean of its
    // ends that are in liquid, or without one that of its own meniscus; linear in time
    // from snapshot to snapshot.
    SUCTION_FIELD
};

struct suction_law {
    enum suction_rule rule;
    double uniform;      // Pa, of a throat of mean radius
    double meniscus;     // 2 sigma cos(theta), N/m: suction times radius
    double contact_line; // sigma sin(theta), N/m
    double weight;       // rho g, N/m3; 0: the liquid weighs nothing
};

// What pulls on the grains, for each throat.
enum load {
    LOAD_SUCTION,      // of the liquid times saturation, Pa
    LOAD_CONTACT_LINE, // radius times sigma sin(theta) for each end in gas, N
    LOAD_EMPTINESS,    // how much of the throat has emptied, 1
    LOAD_WEIGHT,       // of the liquid, N
    LOADS
};

// The liquid as it goes from step to step of the drying. Between two steps saturations
// are linear in time, and nothing else changes but the pressures of SUCTION_FIELD.
struct liquid_loads {
    const struct network *network;
    const struct liquid_record *record;
    struct suction_law law;
    int step;
    double share;           // of the way to the next step
    double *before, *after; // (n_throat) saturations at this step and the next
    bool *gas;              // (n_node) a throat there has emptied
    double *suction;        // (n_throat) Pa, now; NULL if uniform
    double *field;          // (n_snapshot * n_throat) Pa; NULL without
    bool stale;             // SUCTION is that of before a throat has emptied
};

// At the first step. Keeps NETWORK and RECORD, which must live as long. The caller
// frees with liquid_loads_free.
struct liquid_loads liquid_loads_begin(const struct network *network,
                                       const struct liquid_record *record,
                                       const struct suction_law *law);
void liquid_loads_free(struct liquid_loads *liquid);

// To the next step, which must be there, or to its end, the moment before that.
void liquid_loads_advance(struct liquid_loads *liquid);
void liquid_loads_to_end_of_step(struct liquid_loads *liquid);

// To TIME, which must not be before that of the step.
void liquid_loads_to(struct liquid_loads *liquid, double time);

// Saturation of the network, interpolated.
double liquid_loads_saturation(const struct liquid_loads *liquid);

// The loads of THROAT now.
void liquid_loads_at(const struct liquid_loads *liquid, int throat, double load[LOADS]);

// How far the suction of a throat that holds liquid is, in the mean, from the one
// interpolated between the snapshots before and after, of UNIFORM: what every second
// snapshot adds. NAN with fewer than three.
double field_error(const struct liquid_loads *liquid);

// Names the connected pieces of liquid by the lowest throat of each, -1: no liquid.
// Throats join at nodes where none has emptied. CLUSTER (n_throat); returns how many.
int liquid_loads_clusters(const struct liquid_loads *liquid, int *cluster);

#endif
