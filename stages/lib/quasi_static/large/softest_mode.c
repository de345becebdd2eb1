// SPDX-License-Identifier: GPL-3.0-or-later
// Inverse iteration with the tangent at the last equilibrium, K x' = x: x tends to the
// mode of the lowest stiffness by its size. Where the tangent has no factor, with that
// of the pairs alone, without geometric stiffness.
//
// The grain that moves most in the mode tells which fragment is let go
// (load_stepping.c), or is named where there is none. The first x differs from grain to
// grain, so that it has a part in modes of either symmetry. A body that nothing holds
// has rigid motions without stiffness: davidson.c leaves these out.
#include "softest_mode.h"

int find_softest_mode(struct quasi_static *qs)
{
    enum { ROUNDS = 8 };
    int softest = 0;
    const double(*tangent)[COMPONENTS] = (const double(*)[COMPONENTS])qs->tangent;
    if (!factor_tangent(qs)) {
        const double hold = qs->large->stabilisation;
        const double soft[2] = {qs->regularisation[0] + hold,
                                qs->regularisation[1] + hold};
        stiffness_factor(
            qs->matrix,
            &(struct stiffness_terms){.tangent = tangent, .soft = {soft[0], soft[1]}});
    }
    if (qs->setup.is_free) return davidson_softest_mode(qs, NULL);
    for (int i = 0; i < qs->n; i++)
        qs->step[i] = qs->is_detached[i]
                          ? no_displacement
                          : (struct displacement){{1, 0.7, 0.4 + i % 3}, {0.3, 0.6, 1}};
    for (int round = 0; round < ROUNDS; round++) {
        stiffness_begin(qs->matrix, qs->step);
        stiffness_finish(qs->matrix, qs->step);
        softest = normalise_mode(qs);
    }
    return softest;
}
