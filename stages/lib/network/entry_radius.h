// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/open_section.h"

// The radius, m, for which 2 sigma cos(theta) / radius is the capillary pressure at
// which gas enters the narrowest section of a throat between grains that liquid wets at
// CONTACT_ANGLE theta (rad, below pi/2), after Mayer & Stowe (1965) and Princen (1969):
// liquid stays in the gaps between grains. Exact for rods of the section's discs, of
// equal radii or not; walls count as mirrors. 0: the iteration found none, as where
// grains overlap all around.
double entry_radius(const struct open_section *section, double contact_angle);
