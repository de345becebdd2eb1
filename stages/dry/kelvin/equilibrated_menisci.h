// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of liquid whose menisci are flatter than their throats make them: the
// potentials at which they evaporate nothing.
//
// Their system has a sparse Cholesky factor that is updated. A body that joins or
// leaves adds or deletes a row, and so does one whose nodes change; a node that dries
// is eliminated by one downdate. The factor only saves time: without it the next
// solution makes it again, from the vapour as it is.
#pragma once

#include "kelvin_menisci.h"

struct equilibrated_menisci;

// For a network of N_THROAT throats and vapour of N_SITE sites. The caller frees it
// with equilibrated_free.
struct equilibrated_menisci *equilibrated_create(int n_throat, int n_site,
                                                 bool by_throat);

// Empties THROAT, as occupancy_empty_throat, and notes what that changes in the system.
void equilibrated_empty_throat(struct equilibrated_menisci *equilibrated,
                               struct occupancy *occupancy, int throat);

// Call after the bodies have been listed again, N throats having emptied. Updates the
// factor, if all N were emptied by equilibrated_empty_throat; else forgets it.
void equilibrated_follow(struct equilibrated_menisci *equilibrated,
                         const struct kelvin_menisci *kelvin,
                         const struct occupancy *occupancy, int n);

// Forgets the factor: the next solution makes it again.
void equilibrated_forget(struct equilibrated_menisci *equilibrated);

// Finds the potentials at which the bodies with kelvin->zero_flux evaporate nothing,
// and what all bodies evaporate then. False if memory ran out. Once is enough, as
// evaporation is linear in the potentials; refinement removes rounding.
bool solve_zero_flux(struct kelvin_menisci *kelvin, const struct occupancy *occupancy);

void equilibrated_free(struct equilibrated_menisci *equilibrated);
