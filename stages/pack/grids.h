// SPDX-License-Identifier: GPL-3.0-or-later
// Look-up of placed grains by position: one grid of cells for each halving of the
// radius, so that a query costs the same at any ratio of radii.
#pragma once

#include "domain.h"

struct grids;

// For grains with radii from SMALLEST to LARGEST, m, about EXPECTED of them, in DOMAIN,
// which must outlive it. Freed with grids_free. Memory: at most about four cells a
// grain expected, for each level that has grains.
struct grids *grids_create(const struct domain *domain, double smallest, double largest,
                           double expected);
void grids_free(struct grids *grids);

// Adds the next grain: the first is 0.
void grids_add(struct grids *grids, struct vector centre, double radius);

// The grains added so far; lengths in m.
int grids_count(const struct grids *grids);
struct vector grids_centre(const struct grids *grids, int grain);
double grids_radius(const struct grids *grids, int grain);

// The grains whose surface is less than GAP (m, may be negative) from the surface of a
// sphere at CENTRE, by the nearest image; at most MOST of them go to FOUND. Returns how
// many. In an order that depends only on what was added. The cost does not depend on
// the ratio of radii, but on how many grains are near.
int grids_near(const struct grids *grids, struct vector centre, double radius,
               double gap, int *found, int most);
