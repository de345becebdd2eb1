// SPDX-License-Identifier: GPL-3.0-or-later
// Pulls of throats on grains, for the tests of them.
#pragma once

#include "../../test.h"
#include "../support_lattice.h"
#include "force-protocol/solid_angle_patches.h"

// Sums of the absolute errors of what should vanish.
static inline double size(struct vector a)
{
    return fabs(a.x) + fabs(a.y) + fabs(a.z);
}

static inline struct vector sum_of(const struct patches *patches, int grain)
{
    struct vector sum = {0};
    for (int k = patches->begin[grain]; k < patches->begin[grain + 1]; k++)
        sum = add(sum, patches->patch[k].pull);
    return sum;
}

static inline struct patches patches_of(const struct network *network, enum form form)
{
    struct sectors sectors;
    struct reason reason;
    assert_int_equal(sectors_find(network, &sectors, &reason), STATUS_OK);
    struct patches patches = find_patches(&sectors, form);
    assert_int_equal(check_patches(&patches, &reason), STATUS_OK);
    sectors_free(&sectors);
    return patches;
}
