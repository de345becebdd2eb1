// SPDX-License-Identifier: GPL-3.0-or-later
#include "joint_lanes.h"

static const double unmoved[GRAIN] = {0};

// Not a function: how those return wide vectors depends on the machine.
#define AT(grain, degree) (*(const lanes *)((grain) + (degree)*LANES))

#define ALONG(axis, a) ((axis).x * (a)[0] + (axis).y * (a)[1] + (axis).z * (a)[2])

void joint_strains_lanes(const struct joint *joint, const double *moved,
                         lanes strain[STRAINS])
{
    const int32_t *grain = joint->grain;
    const double *i = moved + (long)grain[0] * GRAIN;
    const double *j = grain[1] < 0 ? unmoved : moved + (long)grain[1] * GRAIN;
    const struct vector *axis = joint->axis;
    lanes shift[3], turn[3], rolling[3];
    for (int k = 0; k < 3; k++) {
        shift[k] = AT(j, k) - AT(i, k);
        turn[k] = AT(j, 3 + k) - AT(i, 3 + k);
        rolling[k] = joint->arm[0] * AT(i, 3 + k) + joint->arm[1] * AT(j, 3 + k);
    }
    strain[STRAIN_ALONG] = ALONG(axis[0], shift);
    strain[STRAIN_ACROSS] = ALONG(axis[1], shift) - ALONG(axis[2], rolling);
    strain[STRAIN_ACROSS + 1] = ALONG(axis[2], shift) + ALONG(axis[1], rolling);
    for (int k = 0; k < 3; k++)
        strain[STRAIN_TWIST + k] = ALONG(axis[k], turn);
}

void joint_lengthen_lanes(const struct joint *joint, const double *moved, lanes *strain)
{
    const int32_t *grain = joint->grain;
    const double *i = moved + (long)grain[0] * GRAIN;
    const double *j = grain[1] < 0 ? unmoved : moved + (long)grain[1] * GRAIN;
    lanes shift[3];
    for (int k = 0; k < 3; k++)
        shift[k] = AT(j, k) - AT(i, k);
    *strain = ALONG(joint->axis[0], shift);
}

// Takes LOADS off the grain at END.
static inline void pull(const struct joint *joint, int end, const lanes load[STRAINS],
                        double *left)
{
    if (joint->grain[end] < 0) return;
    lanes *of = (lanes *)(left + (long)joint->grain[end] * GRAIN);
    const double *n = &joint->axis[0].x, *s = &joint->axis[1].x, *t = &joint->axis[2].x;
    const double sign = end ? 1 : -1, arm = joint->arm[end];
    for (int k = 0; k < 3; k++) {
        of[k] -= sign * (n[k] * load[0] + s[k] * load[1] + t[k] * load[2]);
        of[3 + k] -= arm * (s[k] * load[2] - t[k] * load[1]) +
                     sign * (n[k] * load[3] + s[k] * load[4] + t[k] * load[5]);
    }
}

void joint_resist_lanes(const struct joint *joint, const lanes more[STRAINS],
                        double *left)
{
    if (joint->is_gone) return;
    lanes load[STRAINS];
    for (int k = 0; k < STRAINS; k++)
        load[k] = (joint->is_bonded ? joint->bond_stiffness[k] : 0) *
                  (joint->strain[k] + more[k]);
    const lanes overlap = joint->overlap - (joint->strain[STRAIN_ALONG] + more[0]);
    for (int l = 0; l < LANES; l++)
        load[STRAIN_ALONG][l] -=
            overlap[l] >= 0 ? joint->contact_along * overlap[l] : 0;
    pull(joint, 0, load, left);
    pull(joint, 1, load, left);
}
