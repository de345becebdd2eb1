// SPDX-License-Identifier: GPL-3.0-or-later
// What every program's command line has alike: --help, --version, an error in one line.
// Errors of the command line are exits with 64 and one line, here and nowhere else; GNU
// argp prints help and reads options.
#pragma once

#include <argp.h>

// A row of each program's table of options, before the row of zeros that ends it.
#define VERSION_OPTION                                                                 \
    {                                                                                  \
        "version", 'V', NULL, 0, "Print program version", -1                           \
    }

// What a program's parser returns for a KEY it does not know: ARGP_ERR_UNKNOWN unless
// it is one that all share. Exits on --version, which prints PROGRAM and VERSION. For
// programs that are no stage (artdiff, inspect); stages have stage_begin.
error_t parse_common_option(int key, struct argp_state *state, const char *program,
                            int version);

// Parses into INPUT, which the program's own parser knows. Exits on --help and on
// errors (64, one line). To be called once, and first: from here on a standard output
// that cannot be written at the end exits 74.
void parse_command_line(const struct argp *argp, int argc, char **argv, void *input);

// The number that TEXT is, all of it. Exits (64) unless it is from LEAST to MOST;
// OPTION names it in the message. OPTION as the user writes it, "--threads".
long whole_of_option(const char *option, const char *text, long least, long most);
double number_of_option(const char *option, const char *text, double least,
                        double most);
