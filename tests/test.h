// SPDX-License-Identifier: GPL-3.0-or-later
// cmocka, with what it wants included before it, and numbers that are to be near each
// other.
#ifndef CRAQUELURE_TEST_H
#define CRAQUELURE_TEST_H

// clang-format off
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
// clang-format on
#include <math.h>

// A test that only some machines can run: on the others a line that TAP takes for
// skipped (cmocka's own skip() says "not ok", which harnesses count as failed).
#define UNIT_TEST_WHERE(can_run, why_not, test)                                        \
    {                                                                                  \
        (can_run) ? #test : #test " # SKIP " why_not, (can_run) ? (test) : skip_test,  \
            NULL, NULL, NULL                                                           \
    }

static inline void skip_test(void **state)
{
    (void)state;
}

static inline void assert_within(double got, double wanted, double tolerance)
{
    if (!(fabs(got - wanted) <= tolerance))
        fail_msg("got %.17g, wanted %.17g within %g", got, wanted, tolerance);
}

// Within a fraction of |WANTED|.
static inline void assert_close(double got, double wanted, double fraction)
{
    assert_within(got, wanted, fraction * fabs(wanted));
}

#endif
