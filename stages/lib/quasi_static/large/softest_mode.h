// SPDX-License-Identifier: GPL-3.0-or-later
// The mode of the lowest stiffness, into `step`; the grain that moves or turns most in
// it, by 1, is returned.
#pragma once

#include "large_state.h"

// The mode at the last equilibrium; for a body that nothing holds, without rigid
// motion.
int find_softest_mode(struct quasi_static *qs);

// The same for a body that nothing holds, by Davidson's method [davidson.c] with the
// factor there is; its STIFFNESS, which may be NULL, does not count the stabilisation.
int davidson_softest_mode(struct quasi_static *qs, double *stiffness);
// Whether that stiffness is positive.
bool davidson_is_stable(struct quasi_static *qs);

// Scales the mode in `step`, if it moves at all, so that the grain returned moves by 1.
static inline int normalise_mode(struct quasi_static *qs)
{
    int softest = 0;
    for (int i = 0; i < qs->n; i++)
        if (displacement_size(qs->step[i]) > displacement_size(qs->step[softest]))
            softest = i;
    const double size = displacement_size(qs->step[softest]);
    for (int i = 0; i < qs->n && size > 0; i++)
        qs->step[i] = displacement_scaled(1 / size, qs->step[i]);
    return softest;
}
