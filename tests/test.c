// SPDX-License-Identifier: GPL-3.0-or-later
// The main program of the tests in C: it runs what TEST has added before it starts.
#include "test.h"

#include <stdlib.h>

enum { LINES = 1000 }; // that a file has at most

// By the line at which each stands: cmocka passes over places without a name.
static struct CMUnitTest tests[LINES];

void add_test(int line, const char *name, CMUnitTestFunction test)
{
    if (line >= LINES) abort();
    tests[line] = (struct CMUnitTest){.name = name, .test_func = test};
}

void skip_test(void **state)
{
    (void)state;
}

int main(void)
{
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
