// SPDX-License-Identifier: GPL-3.0-or-later
// What a network must be for gas to come in. On STATUS_BAD_DATA the reason names the
// dataset and row, or the parameter. Checked by those who are about to divide by a
// radius, not when a network is read: a network with a shut throat is fine for looking
// at.
#pragma once

#include "basics/status.h"
#include "network/network.h"

// STATUS_BAD_DATA: the radius of THROAT is not a number above 0.
enum status check_throat_radius(const struct network *network, int throat,
                                struct reason *reason);

// STATUS_BAD_DATA: GRAVITY (m/s2) pulls along z, but the box repeats there. GRAVITY of
// 0 is always fine.
enum status check_gravity(const struct network *network, double gravity,
                          struct reason *reason);
