// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of liquid whose menisci are flatter than their throats make them: at which
// potentials they evaporate nothing.
#ifndef CRAQUELURE_FLOATING_H
#define CRAQUELURE_FLOATING_H

#include "curved.h"

struct floating;

struct floating *floating_make(int n_throat, int n_site);

// Gas or liquid has moved, or bodies are listed anew.
void floating_forget(struct floating *floating);

// Those that float come to where they evaporate nothing; the gains follow. False if
// memory ran out.
bool float_freely(struct curved *curved, const struct phases *phases);

void floating_free(struct floating *floating);

#endif
