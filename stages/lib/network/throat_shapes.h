// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "basics/status.h"
#include "network/network.h"

// Gives every throat what it conducts to diffusion and to flow, and its hydraulic
// radius, from the grains around it (network/open_section.h): fills throat_diffusion,
// throat_flow and throat_hydraulic_radius; what was there goes. Faces must be those of
// the diagram: no nodes merged, no cells left out.
//
// Grains may touch and overlap; walls count as mirrors, round ones as the planes that
// touch them beside each grain. O(throats), shared among threads. STATUS_BAD_DATA when
// two neighbours in a face's loop are not joined by a throat.
enum status find_throat_shapes(struct network *network, struct reason *reason);

// Gives every open throat, in place of its radius, that for which 2 sigma cos(theta) /
// radius is the pressure at which gas enters it (network/entry_radius.h), with
// CONTACT_ANGLE theta in rad; no less than cos(theta) times the radius it has. Faces as
// above.
enum status find_entry_radii(struct network *network, double contact_angle,
                             struct reason *reason);
