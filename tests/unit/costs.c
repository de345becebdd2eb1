// SPDX-License-Identifier: GPL-3.0-or-later
// Defaults that depend on what runs are estimated to cost.
#include "../test.h"

#include "costs/costs.h"

// Wide bodies dry faster with vapour that is kept. Deep ones do not, since all of their
// gas is found again.
TEST(vapour_is_kept_where_the_open_face_is_wide)
{
    assert_true(default_vapour_step(841, 113e3) <= 0);   // 10,000 grains
    assert_true(default_vapour_step(1453, 575e3) > 0);   // 50,000 that settled
    assert_true(default_vapour_step(3605, 1.14e6) > 0);  // 100,000
    assert_true(default_vapour_step(3800, 11.5e6) <= 0); // a column of a million
    assert_true(default_vapour_step(18e3, 11.5e6) > 0);  // a cube of a million
}
