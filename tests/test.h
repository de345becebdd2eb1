// SPDX-License-Identifier: GPL-3.0-or-later
// cmocka, with what it wants included before it.
#ifndef CRAQUELURE_TEST_H
#define CRAQUELURE_TEST_H

// clang-format off
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
// clang-format on

#endif
