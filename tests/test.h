// SPDX-License-Identifier: GPL-3.0-or-later
// cmocka, with what it wants included before it, and numbers that are to be near each
// other.
#pragma once

// clang-format off
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
// clang-format on
#include <math.h>
#include <stdbool.h>

// A test is TEST(what_it_shows) { ... }. The program (test.c) runs those of its file in
// their order there.
#define TEST(name) TEST_WHERE(true, "", name)

// One that only some machines can run: on the others a line that TAP takes for skipped
// (cmocka's own skip() says "not ok", which harnesses count as failed).
#define TEST_WHERE(can_run, why_not, name)                                             \
    static void test_##name(void **state);                                             \
    __attribute__((constructor)) static void add_test_##name(void)                     \
    {                                                                                  \
        if (can_run)                                                                   \
            add_test(__LINE__, #name, test_##name);                                    \
        else                                                                           \
            add_test(__LINE__, #name " # SKIP " why_not, skip_test);                   \
    }                                                                                  \
    static void test_##name(__attribute__((unused)) void **state)

// Test NAME, which stands at LINE of its file.
void add_test(int line, const char *name, CMUnitTestFunction test);
void skip_test(void **state);

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
