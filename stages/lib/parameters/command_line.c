// SPDX-License-Identifier: GPL-3.0-or-later
// Thin wrappers of argp and strtol/strtod. Standard output is flushed and checked at
// exit, as a full disk shows only then.
#include "parameters/command_line.h"

#include "basics/status.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// What --help and the like print is lost on a full disk; nobody else looks. _exit, as
// this runs at exit already.
static void flush_standard_output(void)
{
    if (!fflush(stdout) && !ferror(stdout)) return;
    report("standard output: %s", strerror(errno));
    _exit(STATUS_IO);
}

error_t parse_common_option(int key, struct argp_state *state, const char *program,
                            int version)
{
    if (key == ARGP_KEY_INIT) {
        state->err_stream = NULL; // one line, getopt's own
        return 0;
    }
    if (key != 'V') return ARGP_ERR_UNKNOWN;
    printf("%s (craquelure %s) stage version %d\n", program, CRAQUELURE_VERSION,
           version);
    exit(STATUS_OK);
}

void parse_command_line(const struct argp *argp, int argc, char **argv, void *input)
{
    atexit(flush_standard_output);
    if (argp_parse(argp, argc, argv, 0, NULL, input)) exit(STATUS_USAGE);
}

long whole_of_option(const char *option, const char *text, long least, long most)
{
    char *end;
    const long number = strtol(text, &end, 10);
    if (*end || end == text || number < least || number > most)
        die(STATUS_USAGE, "%s: must be from %ld to %ld, got %s", option, least, most,
            text);
    return number;
}

double number_of_option(const char *option, const char *text, double least, double most)
{
    char *end;
    const double number = strtod(text, &end);
    if (*end || end == text || !(number >= least && number <= most))
        die(STATUS_USAGE, "%s: must be from %.10g to %.10g, got %s", option, least,
            most, text);
    return number;
}
