// SPDX-License-Identifier: GPL-3.0-or-later
// The load of the liquid in each throat during the drying: how much liquid there is,
// under which suction, with how many menisci.
#pragma once

#include "network/ring_record.h"

// The drying, as read from its artifact.
struct liquid_record {
    struct drying_record drying; // at least one step
    struct ring_record rings;
    bool *exposed; // (n_node) gas touches the node from the beginning
    int n_snapshot;
    double *snapshot_time; // (n_snapshot)
    double *pressure;      // (n_snapshot * n_node) Pa, of the liquid less that of the
                           // gas; 0 in gas. NULL: not known
};

enum suction_rule {
    SUCTION_UNIFORM, // that of a throat of mean radius, everywhere [K 5.3]
    // In each cluster of liquid that of its widest throat with a meniscus, which gas
    // enters next: its meniscus is as curved as it can be, and the whole cluster has
    // the same pressure. With weight, the same potential: then gas enters next where
    // the suction less rho g z is least. Where films join all liquid (dry.rings=joined)
    // clusters stay as they were when all throats were full.
    SUCTION_CLUSTERS,
    // By the pressures of viscous liquid at the nodes: a throat has the mean of its
    // ends that are in liquid, or without one that of its own meniscus; linear in time
    // from snapshot to snapshot.
    SUCTION_FIELD
};

struct suction_law {
    enum suction_rule rule;
    bool joined;         // films join all liquid
    double uniform;      // Pa, of a throat of mean radius
    double meniscus;     // 2 sigma cos(theta), N/m: suction times radius
    double contact_line; // sigma sin(theta), N/m
    double weight;       // rho g, N/m3; 0: the liquid weighs nothing
};

// What a throat's liquid does to the grains around it.
enum load {
    LOAD_SUCTION,      // of the liquid times saturation, Pa
    LOAD_CONTACT_LINE, // radius times sigma sin(theta) for each end in gas, N
    LOAD_EMPTINESS,    // 1 - saturation: rings grow with it
    LOAD_WEIGHT,       // of the liquid and what it has left in rings, N
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
    double *rings_before, *rings_after; // (n_node) of the rings there; NULL: none
    double *ring_part; // (n_throat) m3, what it leaves in rings; NULL: none
    bool *gas;         // (n_node) a throat there has emptied
    double *suction;   // (n_throat) Pa, now; NULL if uniform
    double *field;     // (n_snapshot * n_throat) Pa; NULL without
    bool stale;        // SUCTION is that of before a throat has emptied
};

// At the first step. Keeps NETWORK and RECORD, which must live as long. The caller
// frees with liquid_loads_free.
struct liquid_loads liquid_loads_begin(const struct network *network,
                                       const struct liquid_record *record,
                                       const struct suction_law *law);
void liquid_loads_free(struct liquid_loads *liquid);

// _advance goes to the next step, which must exist; _to_end_of_step to the moment just
// before it.
void liquid_loads_advance(struct liquid_loads *liquid);
void liquid_loads_to_end_of_step(struct liquid_loads *liquid);

// Goes to TIME (s), which must not be before the present step.
void liquid_loads_to(struct liquid_loads *liquid, double time);

// Saturation of the network at N increasing TIMES (s). The caller frees it.
double *saturations_at(const struct drying_record *record, const double *times, int n);

// The loads of THROAT now, in the units of enum load.
void liquid_loads_at(const struct liquid_loads *liquid, int throat, double load[LOADS]);

// Saturation of THROAT now, and of the rings that it leaves: the mean of those at its
// nodes, which must be known.
double liquid_loads_filling(const struct liquid_loads *liquid, int throat);
double liquid_loads_rings(const struct liquid_loads *liquid, int throat);

// What THROAT has left in rings and is there now, m3; 0 where rings are not known.
double liquid_loads_left(const struct liquid_loads *liquid, int throat);

// Interpolation error of SUCTION_FIELD: the mean difference between the suction of a
// wet throat in a snapshot and that interpolated between the snapshots before and
// after, relative to law.uniform. NAN with fewer than three snapshots.
double field_error(const struct liquid_loads *liquid);

// Sets CLUSTER (n_throat) to the lowest throat of each throat's cluster, -1: no liquid.
// Throats join at nodes where none has emptied, or at all if films join them. Returns
// the number of clusters.
int liquid_loads_clusters(const struct liquid_loads *liquid, int *cluster);
