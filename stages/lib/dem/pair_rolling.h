// SPDX-License-Identifier: GPL-3.0-or-later
// Rolling resistance; for pair_kernel.h. An elastic-plastic spring and a dashpot, type
// C of Ai, Chen, Rotter & Ooi (2011). One pair a lane, as in pair_contact.h. With n
// from the first grain to the second, F^n what counts as the normal force, k the secant
// normal stiffness, arm = mu_r R* and the relative angular velocity omega = omega_j -
// omega_i,
//     omega^r = omega - (omega.n) n,   k_r = 9/4 k arm^2,
//     M^r = rotated M^r - k_r dt omega^r,  |M^r| <= arm F^n,
//     moment on the second grain = M^r - c_r omega^r where it does not roll on.
// Twisting about n is free. M^r is kept for the next step, turned and forgotten as the
// shear force is. 9/4 is theirs, after Jiang, Yu and Harris (2005). All is in scaled
// units.
//
// Without friction in rolling (arm = 0) all of it is 0. The moment on the first grain
// is the opposite; both come to the moments of shear in scatter_loads. The largest
// rolling moment, arm F^n, is reached after rolling by 4/9 F^n / (k arm), and spring
// and dashpot count in the limit of the time step (stability.c).
#include "dem/pair_contact.h"

// The moment on the second grain; PUSH is the force of spring and dashpot along n. No
// bond ever holds a rolling spring (FEATURE_ROLLING excludes bonds), hence the empty
// mask. Sliding and rolling limits use one normal force.
SIMD_INLINE struct vectorw rolling_moment(const struct dem *dem, int k, int at,
                                          const struct pair_motion *m, maskw touch,
                                          const struct lane_law *law, doublew push,
                                          doublew time_step, unsigned features)
{
    struct rolling_group *group = dem->pairs.rolling + k;
    const struct vectorw n = m->rotation.normal;
    const struct vectorw rolling =
        subtract_scaled3(m->relative_spin, dot3(m->relative_spin, n), n);
    const doublew arm = load(group->arm + at), factor = 2.25 * arm * arm;
    const struct slipping_spring spring = {
        factor * law->normal_stiffness, factor * law->normal_stiffness_before,
        law->shear_retained, rolling, arm * friction_normal_force(dem, law, push)};
    const maskw none = above(splat(0), splat(0));
    maskw rolls_on;
    const struct vectorw moment =
        advance_spring(dem, k, at, group->moment, m, &spring, touch, none, time_step,
                       features, &rolls_on);
    const maskw damped = without(touch, rolls_on);
    doublew damping = only_where(damped, load(group->damping + at));
    if (features & FEATURE_HERTZ)
        damping = damping * square_root(square_root(only_where(touch, m->overlap)));
    if (dem->pairs.loss)
        add_to_ledger(dem->pairs.loss[k].dashpots + at, damped,
                      damping * dot3(rolling, rolling) * time_step);
    return subtract_scaled3(moment, damping, rolling);
}
