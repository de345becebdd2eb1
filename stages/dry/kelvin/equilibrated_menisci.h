// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of liquid whose menisci are flatter than their throats make them: at which
// potentials they evaporate nothing.
//
// Their system has a sparse Cholesky factor that follows them. Bodies that begin or
// cease to float are rows that come and go, as are those whose nodes change; a node
// that dries is eliminated from all others by one downdate.
#ifndef CRAQUELURE_FLOATING_H
#define CRAQUELURE_FLOATING_H

#include "kelvin_menisci.h"

struct floating;

// For a network of N_THROAT throats and vapour of N_SITE sites. The caller frees it
// with floating_free.
struct floating *floating_make(int n_throat, int n_site, bool by_throat);

// Empties THROAT, as phases_empty_throat, and keeps what it changes.
void floating_empty_throat(struct floating *floating, struct phases *phases,
                           int throat);

// Bodies have been listed, after N throats have emptied. Goes on from what was, if all
// of them have by floating_empty_throat.
void floating_follow(struct floating *floating, const struct curved *curved,
                     const struct phases *phases, int n);

// Nothing is gone on from.
void floating_forget(struct floating *floating);

// Those that float come to where they evaporate nothing; the gains follow. False if
// memory ran out.
bool float_freely(struct curved *curved, const struct phases *phases);

void floating_free(struct floating *floating);

#endif
