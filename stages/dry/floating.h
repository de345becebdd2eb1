// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of liquid whose menisci are flatter than their throats make them: at which
// potentials they evaporate nothing.
#ifndef CRAQUELURE_FLOATING_H
#define CRAQUELURE_FLOATING_H

#include "curved.h"

// Those that float come to where they evaporate nothing; the gains follow.
void float_freely(struct curved *curved, const struct phases *phases);

#endif
