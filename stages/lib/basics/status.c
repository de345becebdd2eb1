// SPDX-License-Identifier: GPL-3.0-or-later
// A message is one line of 2047 bytes at most.
#include "basics/status.h"

#include <errno.h> // program_invocation_short_name: set by the C library, read-only here
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

enum status refuse(struct reason *reason, enum status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reason->text, sizeof reason->text, format, arguments);
    va_end(arguments);
    return status;
}

static void print_line(const char *format, va_list arguments)
{
    char line[2048];
    vsnprintf(line, sizeof line, format, arguments);
    for (char *c = line; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 127)
            *c = '?'; // names may hold newlines; a message is one line
    fprintf(stderr, "%s: %s\n", program_invocation_short_name, line);
}

void die(enum status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line(format, arguments);
    va_end(arguments);
    exit(status);
}

void report(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line(format, arguments);
    va_end(arguments);
}
