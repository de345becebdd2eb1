// SPDX-License-Identifier: GPL-3.0-or-later
// CHOLMOD as every stage uses it.
#ifndef CRAQUELURE_PLAIN_CHOLMOD_H
#define CRAQUELURE_PLAIN_CHOLMOD_H

#include <cholmod.h>

// Begins COMMON, which the caller ends with cholmod_finish: silent, simplicial and
// always in the same ordering. No BLAS, so the same bytes everywhere and for any number
// of threads.
static inline void plain_cholmod_start(cholmod_common *common)
{
    cholmod_start(common);
    common->print = 0;
    common->supernodal = CHOLMOD_SIMPLICIAL;
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_AMD;
}

#endif
