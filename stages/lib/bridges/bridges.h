// SPDX-License-Identifier: GPL-3.0-or-later
// Capillary bridges between two spheres, or a sphere and a plane: the force by the
// exact solution of Young and Laplace's equation and by the models of [G 2]. Forces are
// positive when they pull the bodies together. Lengths in m, angles in rad, forces in
// N; everything is scale-free.
//
//     struct bridge bridge = {.radius = {1e-4, INFINITY}, // sphere, plane
//                             .contact_angle = {0.3, 0.3},
//                             .surface_tension = 0.0728,
//                             .volume = 1e-14};
//     struct bridge_state state;
//     enum status status = bridge_solve(&bridge, 1e-6, &state, &reason);
// A force has the scale surface tension gamma times effective radius r = 2 R1 R2 / (R1
// + R2): at contact, with little liquid, it is 2 pi gamma r cos(theta).
//
// Which one to take: BRIDGE_EXACT for single bridges, and for their suction and shape;
// a table (bridges/table.h, ratios.h) for many of one angle, as good once it is made; a
// fit where a paper is to be repeated. Functions here are pure: any number of threads,
// the same digits.
#pragma once

#include "basics/status.h"
#include "bridges/meridian.h"

// A value; bridge_check says whether it is one.
struct bridge {
    double radius[2];        // m; INFINITY for a plane, at most one of them
    double contact_angle[2]; // rad, from 0 to less than pi
    double surface_tension;  // N/m
    double volume;           // m3, of the liquid
};

// The exact solution is the slowest by far; a table of it is as good once it is made.
// [G 2.1-2.4] has the fits.
enum bridge_model {
    BRIDGE_EXACT,
    BRIDGE_TABLE,              // bridges/table.h
    BRIDGE_WEIGERT,            // [G A1-A7]
    BRIDGE_WILLETT_FULL,       // [G B1-B4]
    BRIDGE_WILLETT_REDUCED,    // [G 8]
    BRIDGE_RABINOVICH,         // [G 11]
    BRIDGE_RABINOVICH_LAMBERT, // [G 12]
    BRIDGE_SOULIE,             // Soulie et al. (2006), as Yade has it
    BRIDGE_MODELS
};
// "exact", "table", ...: in the order above, as choices are spelled for parameters.
#define BRIDGE_MODEL_CHOICES                                                           \
    "exact|table|weigert|willett-full|willett-reduced|rabinovich|rabinovich-lambert|"  \
    "soulie"

// What a force is not good for. It is finite all the same, and continuous but for
// rupture.
enum bridge_flag {
    BRIDGE_RUPTURED = 1, // beyond bridge_rupture_distance
    BRIDGE_OVERLAPS = 2, // bodies overlap
    BRIDGE_ANGLE = 4,    // contact angle beyond what models were made for: 50 degrees
    // Volume, over the cube of the effective radius, beyond what models were made for:
    // above 0.1; BRIDGE_WILLETT_FULL also below 3e-5
    BRIDGE_VOLUME = 8,
    BRIDGE_UNEQUAL_ANGLES = 16 // the model has one contact angle: their mean cosine
};

// 2 R1 R2/(R1 + R2) [G 1]. m; of a plane twice the radius of the sphere.
double bridge_effective_radius(const struct bridge *bridge);

// STATUS_BAD_DATA: a size or an angle is none, or the volume is too small or large for
// the bodies to compute with.
enum status bridge_check(const struct bridge *bridge, struct reason *reason);

// Volume over the cube of the effective radius.
double bridge_dimensionless_volume(const struct bridge *bridge);

// [G 2]; with the mean cosine of two contact angles. m, between the surfaces. (1 +
// theta / 2) (v^(1/3) + 0.1 v^(2/3)) r, v the volume over r^3.
double bridge_rupture_distance(const struct bridge *bridge);

// The force of a model other than BRIDGE_EXACT and BRIDGE_TABLE at SEPARATION (m;
// negative: overlap, where the models keep their value at contact). Beyond rupture it
// goes on with the model's formula. FLAGS may be NULL. N, positive when it pulls. FLAGS
// gets a sum of bridge_flag.
double bridge_model_force(const struct bridge *bridge, enum bridge_model model,
                          double separation, unsigned *flags);

// Many forces of such a model in effective radii and surface tensions, for one contact
// angle: COUNT volumes, gaps (negative ones count as 0) and forces.
void bridge_model_forces(enum bridge_model model, double contact_angle, int count,
                         const double *volume, const double *gap, double *force);

// ---- the exact solution ------------------------------------------------------------

struct bridge_state {
    double separation;            // m
    double force;                 // N
    double suction;               // Pa: of the gas over the liquid
    double neck_radius;           // m, the least
    double half_filling_angle[2]; // rad; 0 on a plane
    double contact_radius[2];     // m
    double wetted_area[2];        // m2
    double free_area;             // m2, of the meniscus
    double energy;  // J: surface tension times (free area - cos theta wetted area)
    struct arc arc; // in effective radii
    int steps;      // of Newton's method
};

// The stable axisymmetric bridge without gravity at SEPARATION, to about 1e-12.
// Returns STATUS_OK, STATUS_NO beyond rupture, STATUS_NOT_CONVERGED, or STATUS_BAD_DATA
// when the bridge is none.
//
// Overlapping bodies are taken as their union: the liquid lies around it and does not
// press where they share their space, so that the force stays -dE/da there.
enum status bridge_solve(const struct bridge *bridge, double separation,
                         struct bridge_state *state, struct reason *reason);

// The widest stable bridge.
enum status bridge_solve_rupture(const struct bridge *bridge,
                                 struct bridge_state *state, struct reason *reason);

// The bridge at SEPARATION whose liquid is joined to other liquid of SUCTION (above 0,
// Pa): VOLUME of BRIDGE is not looked at, but returned in *VOLUME (m3). STATUS_NO: none
// holds out against that suction there. Its bodies must be those of a bridge; that is
// not checked.
enum status bridge_at_suction(const struct bridge *bridge, double separation,
                              double suction, struct bridge_state *state,
                              double *volume, struct reason *reason);

// Its meridian: height above the pole of the first body and radius (m) at COUNT places,
// at least 2, evenly along it. Both (COUNT), in m.
void bridge_profile(const struct bridge *bridge, const struct bridge_state *state,
                    int count, double *height, double *radius);
