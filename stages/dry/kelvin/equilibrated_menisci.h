// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of liquid whose menisci are flatter than their throats make them: at which
// potentials they evaporate nothing.
//
// Their system has a sparse Cholesky factor that follows them. Bodies that begin or
// cease to be are rows that come and go, as are those whose nodes change; a node
// that dries is eliminated from all others by one downdate.
#ifndef CRAQUELURE_EQUILIBRATED_MENISCI_H
#define CRAQUELURE_EQUILIBRATED_MENISCI_H

#include "kelvin_menisci.h"

struct equilibrated_menisci;

// For a network of N_THROAT throats and vapour of N_SITE sites. The caller frees it
// with equilibrated_free.
struct equilibrated_menisci *equilibrated_make(int n_throat, int n_site,
                                               bool by_throat);

// Empties THROAT, as occupancy_empty_throat, and keeps what it changes.
void equilibrated_empty_throat(struct equilibrated_menisci *equilibrated,
                               struct occupancy *occupancy, int throat);

// Bodies have been listed, after N throats have emptied. Goes on from what was, if all
// of them have by equilibrated_empty_throat.
void equilibrated_follow(struct equilibrated_menisci *equilibrated,
                         const struct kelvin_menisci *kelvin,
                         const struct occupancy *occupancy, int n);

// Nothing is gone on from.
void equilibrated_forget(struct equilibrated_menisci *equilibrated);

// The equilibrated come to where they evaporate nothing; the gains follow. False if
// memory ran out.
bool solve_zero_flux(struct kelvin_menisci *kelvin, const struct occupancy *occupancy);

void equilibrated_free(struct equilibrated_menisci *equilibrated);

#endif
