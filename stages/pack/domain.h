// SPDX-License-Identifier: GPL-3.0-or-later
// Where grains may lie: a box, cylinder, ring or sphere, perhaps with something cut
// out.
#pragma once

#include "basics/status.h"
#include "geometry/packing.h"

#include <gsl/gsl_rng.h>
#include <stdbool.h>

// What the walls enclose, and what is cut out of it. In the order of the choices of
// domain.shape and domain.cut.shape in the table.
enum domain_shape { DOMAIN_BOX, DOMAIN_CYLINDER, DOMAIN_RING, DOMAIN_SPHERE };
enum domain_cut { CUT_NONE, CUT_BOX, CUT_CYLINDER, CUT_SPHERE };

// The user's parameters; lengths in m, NAN where not given. make_domain.c says which of
// them a shape needs.
struct domain_parameters {
    int shape;                 // enum domain_shape
    double lower[3], upper[3]; // of a box
    bool periodic[3];          // whether it repeats
    double centre[3];          // of a cylinder, ring or sphere
    double radius;             // outer
    double inner_radius;       // of a ring
    double height;             // of a cylinder or ring
    int cut;                   // enum domain_cut
    double cut_centre[3];      // of a cylinder or sphere cut out
    double cut_radius;         // of it
    double cut_lower[3];       // of a box; of a cylinder only z: NAN: right through
    double cut_upper[3];
};

// Cylinders and rings stand along z, from lower.z to upper.z. In two dimensions centres
// lie in the plane y = middle, the domain is one largest diameter thick, and a sphere
// is a disc of that thickness. What the methods work with, complete: made by
// domain_init or domain_around, for an import by make_import, and changed by methods
// whose box moves. A value: nothing to free. Members that a shape does not need are
// not looked at.
struct domain {
    int dimensions;              // 2 or 3
    enum domain_shape shape;     // of its outer walls
    struct vector lower, upper;  // the box around it, m
    bool periodic[3];            // of that box
    struct vector centre;        // of its box, so of the axis or the sphere too, m
    double radius, inner_radius; // of cylinder, ring (outer and inner), sphere, m
    enum domain_cut cut;
    struct vector cut_centre;           // m
    double cut_radius;                  // of cylinder or sphere, m
    struct vector cut_lower, cut_upper; // the box around what is cut out, m
};

// LARGEST is the largest grain radius, m. STATUS_BAD_DATA, naming the key, when the
// parameters make no domain, when such a grain fits nowhere in the shape, or when what
// is cut out does not lie wholly inside it. Sides and centres that are not given begin
// at the origin.
enum status domain_init(const struct domain_parameters *parameters, int dimensions,
                        double largest, struct domain *domain, struct reason *reason);

// The same for the box of a lattice, LOWER to UPPER; of PARAMETERS only periodic sides
// and the cut-out count. STATUS_BAD_DATA when that does not lie wholly inside.
enum status domain_around(const struct domain_parameters *parameters, int dimensions,
                          struct vector lower, struct vector upper,
                          struct domain *domain, struct reason *reason);

// How far rounding may put a grain beyond a wall that it touches, m. Eight roundings of
// the largest coordinate.
double domain_rounding(const struct domain *domain);

// The root of the sum of squares of two legs: the distance of (X, Y) from the z axis.
static inline double across(double x, double y)
{
    return sqrt(x * x + y * y);
}

// Volume, m^3, exact. In two dimensions over the thickness upper.y - lower.y it is the
// area, m^2.
double domain_volume(const struct domain *domain);

// A box without a cut, FACTOR times as large along all its dimensions, from its lower
// corner. In two dimensions y stays.
void domain_stretch(struct domain *box, double factor);

// Whether a grain lies wholly inside; touching the wall is inside, to rounding. Where
// the box repeats there is no wall.
bool domain_holds(const struct domain *domain, struct vector centre, double radius);

// Writes the bodies whose surfaces are its walls to BODY, the outer one first, and
// returns how many; a box without a cut has none. A ring is one cylinder around the
// grains and one that they lie around. For the artifact and the stages behind.
int domain_bodies(const struct domain *domain, struct body body[MOST_BODIES]);

// The inverse: the domain that the box and the bodies of PACKING bound. False when no
// domain is bounded so (two bodies cut out, a box within the box).
bool domain_of(const struct packing *packing, int dimensions, struct domain *domain);

// A point evenly distributed where a grain of this radius fits wholly. False when the
// cut leaves none that could be found. Draws from RANDOM only; where the box repeats,
// over its whole edge.
bool domain_random_point(const struct domain *domain, double radius, gsl_rng *random,
                         struct vector *point);

// Puts POINT back into the box along the axes that repeat.
struct vector domain_wrap(const struct domain *domain, struct vector point);

// From FROM to the nearest image of TO where the box repeats, m.
struct vector nearest_apart(const struct domain *domain, struct vector from,
                            struct vector to);

// STATUS_BAD_DATA when N grains of these radii have more volume than the
// domain (in two dimensions: area).
enum status domain_check_filling(const struct domain *domain, const double *radius,
                                 int n, struct reason *reason);
