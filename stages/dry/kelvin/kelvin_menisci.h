// SPDX-License-Identifier: GPL-3.0-or-later
// Menisci with vapour pressures of their own (Kelvin): p_v = p_sat exp(-p_c M/(rho R
// T)) above a meniscus of capillary pressure p_c = 2 sigma cos(theta) / r.
//
// A body of liquid has one curvature: a throat, where the liquid does not move; a
// cluster, where it has no viscosity and so one pressure, that at which gas enters its
// widest meniscus throat. Under gravity the pressure of a cluster falls with height,
// and so does the vapour pressure above it. A node between several bodies has the mean
// of their potentials, weighted by the sections of the throats, just as its evaporation
// is shared out.
//
// So vapour diffuses from wide menisci to narrow ones, and may condense there: a throat
// partly empty then fills. If the throat where gas would enter is full, the menisci of
// the body become flatter until it neither evaporates nor condenses. Its pressure is
// unknown: nothing may condense, and no meniscus may be more curved than its throat
// makes it (an obstacle problem).
#pragma once

#include "dry/conditions.h"
#include "dry/liquid/losses.h"
#include "dry/liquid/occupancy.h"
#include "kelvin_law.h"

struct equilibrated_menisci;

struct share {
    int body;    // its place
    double part; // of the sections at the node
};

struct kelvin_menisci {
    bool by_throat;          // a throat is a body of liquid; else a cluster
    double *section;         // (n_throat) proportional to its cross-section
    double *entry_potential; // (n_throat) potential above its meniscus: 0 flat, 1 as in
                             // the air
    double rate;             // into the air, scaled
    double residual;         // largest error of a balance so far, relative to the rate
    struct kelvin_law law;
    struct equilibrated_menisci *equilibrated;
    bool *had_zero_flux; // (n_throat) by throat or cluster: zero_flux when last found
    double *zero_flux_potential; // (n_throat) its potential then

    // The bodies beside gas, listed when so many throats held liquid.
    int listed_at; // -1: not yet
    int n;
    int *body;                 // (n) throat or cluster
    int *throat;               // (n) that gas enters: what the body loses or takes up
    double *potential;         // (n)
    double *evaporation;       // (n) what it evaporates; below 0: takes up
    bool *zero_flux;           // (n) flatter than its throat makes it
    bool *flows;               // (n) its exponent and potential are given, by its flow
    double *exponent;          // (n) p_c M / (rho R T) in its throat; as curved as that
                               // makes it, if equilibrated
    int *place;                // (n_throat) of a throat or cluster, -1: none
    double *conductance_bound; // (n) at most what conducts vapour from it
    double *noise, all_noise;  // (n) less gain than this is none; their sum
    int *ranked;               // (n) places by throats, ascending
    int *at_throat;            // (n_throat) room
    int *offset;               // (n_wet+1) of the shares in each wet node
    struct share *share;       // (offset[n_wet])
    double *gravity_potential; // (n_wet) potential that gravity adds there
    double *node_conductance_bound; // (n_wet) at most what conducts vapour from there
    double *initial_conductance; // (n_site) conductance of the boundary layer, at first
    double *level, *flow;        // (n_site) room
};

// For OCCUPANCY before any throat has emptied. The caller frees it with
// kelvin_menisci_free.
struct kelvin_menisci kelvin_menisci_init(struct occupancy *occupancy,
                                          const struct drying_conditions *conditions);

// Sets LOSSES to what each body loses, or takes up (negative), in ascending throats,
// for the OCCUPANCY of now; kelvin->rate is their sum.
//
// STATUS_NOT_CONVERGED if the menisci are not found.
enum status kelvin_menisci_find(struct kelvin_menisci *kelvin,
                                struct occupancy *occupancy, struct losses *losses,
                                struct reason *reason);

// Empties THROAT, as occupancy_empty_throat. That may be called instead, but then the
// factor of the equilibrated menisci is lost.
void kelvin_menisci_empty_throat(struct kelvin_menisci *kelvin,
                                 struct occupancy *occupancy, int throat);

// Forgets what is kept only for speed: the next call starts from what
// kelvin_menisci_state keeps.
void kelvin_menisci_forget(struct kelvin_menisci *kelvin);

// The same in three steps, for viscous liquid, where throats of clusters of several
// have potentials given by their flow (kelvin->flows). _begin lists the bodies.
// _find_others finds the others' potentials, and what all evaporate. _end adds what the
// others lose to LOSSES, which has those of the given, and makes the sum equal to the
// rate.
void kelvin_menisci_begin(struct kelvin_menisci *kelvin, struct occupancy *occupancy);
enum status kelvin_menisci_find_others(struct kelvin_menisci *kelvin,
                                       const struct occupancy *occupancy,
                                       struct reason *reason);
enum status kelvin_menisci_end(struct kelvin_menisci *kelvin,
                               const struct occupancy *occupancy, struct losses *losses,
                               struct reason *reason);

// The potential difference from the widest meniscus to the air, relative to that from a
// flat one.
double kelvin_drive(const struct kelvin_menisci *kelvin);

void kelvin_menisci_state(struct kelvin_menisci *kelvin, const struct network *network,
                          struct checkpoint_stream *stream);

void kelvin_menisci_free(struct kelvin_menisci *kelvin);
