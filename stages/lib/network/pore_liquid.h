// SPDX-License-Identifier: GPL-3.0-or-later
// Liquid in the pores between grains that move. Pores are the tetrahedra of the grains
// where they began (pore_cells.h), and keep their corners; how large they are, how wide
// their throats are and how menisci pull follows from the places AT of the grains,
// which the caller passes each time: (n_particle) m, not brought back into a box that
// repeats, with the numbers and the images of the packing. SI throughout.
//
// In the order of a run, with AT and RADIUS of now at each call:
//     pore_liquid_init        full of liquid
//     mark_entered            which pores gas can enter under this suction
//     let_gas_in              it does; menisci are found again
//     add_meniscus_forces     in each time step
//     mark_distorted          pores of which the triangulation says nothing any more
// The connections never change: a body that flows needs another model.
#pragma once

#include "basics/status.h"
#include "geometry/image.h"
#include "geometry/packing.h"

// What lies beyond a facet where there is no pore.
enum { BEYOND_OPEN = -1, BEYOND_CLOSED = -2 };

// Facet k is opposite corner k.
struct liquid_pore {
    int32_t corner[4], beyond[4]; // grains; pores, or as above
    struct image image[4];        // of the corners
    double volume;                // m3 of the tetrahedron when it was made, > 0
    uint8_t has_gas;
};

// A facet with liquid in PORE and gas beyond.
struct meniscus {
    int32_t pore, facet;
};

// It owns its arrays. Menisci are in the order of their pores.
struct pore_liquid {
    int n_particle, n, n_meniscus;
    struct liquid_pore *pore;  // (n)
    struct meniscus *meniscus; // (n_meniscus)
    struct vector edge;        // of the box
    double mean_volume;        // of a tetrahedron
};

// Fills all pores between the grains of PACKING with liquid. Gas is above the upper z
// side; floor and sides that do not repeat are closed, and so are the spaces between
// them and the grains. STATUS_BAD_DATA as find_cells, or where no four grains enclose a
// pore. The caller frees it with pore_liquid_free.
enum status pore_liquid_init(struct pore_liquid *liquid, const struct packing *packing,
                             struct reason *reason);
void pore_liquid_free(struct pore_liquid *liquid);

// Lets gas into the pores that WHICH (n) marks, and finds the menisci again. O(n).
// Nothing is remembered of what the pores held: ask pore_room before.
void let_gas_in(struct pore_liquid *liquid, const uint8_t *which);

// Finds the menisci again after .has_gas has been changed by hand.
void find_menisci(struct pore_liquid *liquid);

// Adds to FORCE (n_particle) N what the menisci under SUCTION (Pa) do: each pulls with
// SUCTION times the area of its facet towards the liquid, a third at each corner. They
// sum to 0 over a closed surface. O(menisci), always in the same order.
void add_meniscus_forces(const struct pore_liquid *liquid, const struct vector *at,
                         double suction, struct vector *force);

// Radius of the circle in a facet that touches its three grains, m; 0: they cover it.
double throat_radius_at(const struct pore_liquid *liquid, int pore, int facet,
                        const struct vector *at, const double *radius);

// Marks in WHICH (n) the pores that gas can enter from where it is, through a throat of
// at least LEAST m: not those behind them. Returns how many more are marked. WHICH is
// added to, not cleared. To follow an invasion: mark, let gas in, mark again, until it
// returns 0.
int mark_entered(const struct pore_liquid *liquid, const struct vector *at,
                 const double *radius, double least, uint8_t *which);

// Marks in WHICH (n) pores with liquid whose tetrahedra have turned inside out, or
// grown to more than eight times what they were: the triangulation says nothing of
// them. Returns how many more are marked.
int mark_distorted(const struct pore_liquid *liquid, const struct vector *at,
                   uint8_t *which);

// Marks in WHICH (n) the pores with liquid that gas can enter most easily, the widest
// throats first, until they hold VOLUME (m3) or none is left. Returns the radius of the
// narrowest of these throats, m; 0: none was marked.
double mark_widest(const struct pore_liquid *liquid, const struct vector *at,
                   const double *radius, double volume, uint8_t *which);

// Room for liquid in PORE between the grains, m3; below 0 where they overlap much.
double pore_room(const struct pore_liquid *liquid, int pore, const struct vector *at,
                 const double *radius);

// The liquid, m3: the room in the pores that hold it; and in *TETRAHEDRA (may be NULL)
// those pores with the grains in them.
double liquid_volume(const struct pore_liquid *liquid, const struct vector *at,
                     const double *radius, double *tetrahedra);

// Writes to DRYNESS (n_particle) which share of the pores around each grain, by their
// volumes at the start, gas has entered; 0 where there are none.
void find_dryness(const struct pore_liquid *liquid, double *dryness);
