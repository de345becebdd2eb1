// SPDX-License-Identifier: GPL-3.0-or-later
// What can be dried, under which conditions, and the units it is computed in.
//
// What is 0 or NULL is off: gravity, knudsen, kelvin, rings, snapshots, start. Numbers
// that are not given do not exist here: dry/parameters.h has filled them in.
#pragma once

#include "basics/status.h"
#include "dry/gas/boundary_layer.h"
#include "network/contact_rings.h"

// How the liquid moves between the throats of a cluster.
enum liquid_limit {
    // Viscosity negligible: a cluster loses all it evaporates from its widest meniscus
    // throat, that of lowest capillary pressure [K 3.4.2, steps 1-6].
    LIQUID_INVISCID = 0,
    // Viscosity suppresses all flow: each throat loses what it evaporates itself.
    LIQUID_IMMOBILE = 1,
    // Poiseuille flow within each cluster [K 3.10]: between the two limits, which it
    // reaches as the viscosity goes to 0 and to infinity.
    LIQUID_VISCOUS = 2
};

// Molar gas constant, J/(mol K): exact in the SI; [K Table 3.1] rounds it to 8.3145.
#define GAS_CONSTANT 8.31446261815324

// Films in the corners of throats that have emptied, with rings (liquid/film_law.h).
struct film_conditions {
    double corners;     // of a throat, from 1 to 12
    double half_angle;  // of a corner, degrees, above 0 and below 90
    double conductance; // factor, 0 or more; 0: no films
    double step;        // fall of the saturation from one solution of the flow to the
                        // next, from 0 (each event) to 1
};

struct drying_conditions {
    double temperature;         // K
    double gas_pressure;        // p_g, Pa
    double saturation_pressure; // of vapour at the temperature, Pa; below p_g
    double air_vapour_pressure; // in the drying air, Pa; from 0 to below saturation
    double diffusivity;         // delta of vapour in the gas, m2/s
    double molar_mass;          // of the liquid, kg/mol
    double liquid_density;      // kg/m3
    double viscosity;       // kinematic, of the liquid, m2/s; above 0 if it is viscous
    double surface_tension; // N/m; above 0 if the liquid is viscous
    double contact_angle;   // degrees, from 0 to below 90
    double gravity;         // towards -z, m/s2; 0: none
    bool knudsen;           // molecules meet the walls of narrow throats
    bool kelvin;            // curved menisci have less vapour
    enum ring_supply rings; // throats leave liquid at contacts
    struct film_conditions films; // with RINGS_FILMS
    int n_snapshot;
    const double *snapshot; // (n_snapshot) saturations, each below the one before:
                            // where the pressures of viscous liquid are kept
    // Viscous: conductances are renewed when a throat's saturation has changed by this,
    // in (0,1]; 1: only when a throat has emptied or filled, as K does.
    double saturation_step;
    double flow_step; // viscous: share of its liquid that a cluster may lose until its
                      // flow is found again, in [0,1); 0: found at each event
    double mass_transfer;    // beta, m/s; the boundary layer is delta/beta thick
    int layers;              // of the boundary layer; 0: as thick as a throat is long
    enum boundary_feet feet; // where its columns stand
    bool lumped;             // no lattice of layers and columns, only beta
    unsigned open_walls;     // bits of enum wall; at least one
    enum liquid_limit liquid;
    // Liquid at the start, as a fraction of the throats' volume, in (0,1]: gas has come
    // in through the open walls and always entered the widest throat it touched. START,
    // if not NULL, gives the saturation throat by throat instead.
    double start_saturation;
    bool start_trapping; // liquid that gas then cuts off from the walls opposite stays
    const double *start; // (n_throat) from 0 to 1; NULL: by START_SATURATION
    const double *start_rings; // (n_node) with START and rings: of the rings there, 1
                               // beside liquid; NULL: whole
    double stop_saturation; // where it ends, from 0 (dry) to below what it begins with
    // Largest sum of the errors in what the wet nodes evaporate, relative to the rate.
    // From 1e-6 on, links on large fronts are stored as floats. 0: exact.
    double vapour_tolerance;
    // Share of the rate that may be on its way through the gas, which is also the
    // largest sum of the errors, until the vapour is found again. 0: exact.
    double vapour_step;
    // Decrease of the network's saturation from one recorded step to the next; 0: each
    // event is a step.
    double step_interval;
    double
        first_period_rate_fraction; // of the first rate, in (0,1): where period 1 ends
};

// Scaled units: the mean throat length is 1, the density of the liquid is 1, and the
// vapour's potential differs by 1 between saturation and the drying air.
struct drying_scale {
    double length;         // m
    double mass;           // kg
    double rate;           // kg/s
    double time;           // s
    double boundary_layer; // its thickness in mean throat lengths
};

// STATUS_BAD_DATA with the key, the rule and the value if the conditions are
// impossible.
enum status check_conditions(const struct drying_conditions *conditions,
                             struct reason *reason);

// STATUS_BAD_DATA with the dataset, the row, the rule and the value if a throat that
// takes part has no length, no radius, or both its ends on one node, or if none takes
// part.
enum status check_throats(const struct network *network, struct reason *reason);

// Networks of more throats than this must not record every event: the changes, about
// n^1.7 / 2 rows, would take more than 2 GB.
enum { MAX_RECORDED_THROATS = 100000 };

// How many throats hold liquid: those of kind THROAT_NETWORK.
int count_throats(const struct network *network);

// STATUS_BAD_DATA if step_interval is 0 in a network above MAX_RECORDED_THROATS.
enum status check_steps(const struct drying_conditions *conditions,
                        const struct network *network, struct reason *reason);

// STATUS_BAD_DATA if the unit of time is not between 1e-150 and 1e150 s.
enum status check_scale(const struct drying_conditions *conditions,
                        const struct network *network, struct reason *reason);

// Both arguments must have passed their checks.
struct drying_scale drying_scale(const struct network *network,
                                 const struct drying_conditions *conditions);

// Radius of a throat, in m, in which collisions with the wall slow the vapour as much
// as collisions with the gas: there the Knudsen diffusivity
// D_K = (2/3) r sqrt(8 R T / (pi M)) equals the molecular one. 0 without the Knudsen
// effect.
double knudsen_radius(const struct drying_conditions *conditions);
