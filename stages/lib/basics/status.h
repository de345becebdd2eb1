// SPDX-License-Identifier: GPL-3.0-or-later
// Exit statuses, and how a computation says why it cannot go on.
//
// Physics never prints and never exits: it returns a status and leaves the reason in
// the caller's struct. Only the layers that talk to the user call die().
//
// How a status goes up, from physics to main:
//     const enum status status = find_cells(packing, &grains, &cells, reason);
//     if (status) return status;
// and there: if (status) die(status, "%s", reason.text). The reason says the dataset or
// key, the row, the rule, the value and what to do; die puts the program's name before
// it. Only 0 is success. The numbers are those of sysexits.h, but for 1 and 3.
#pragma once

enum status {
    STATUS_OK = 0,
    STATUS_NO = 1,             // ran, and the answer is no (diff, check)
    STATUS_NOT_CONVERGED = 3,  // did not converge, or would be unstable
    STATUS_USAGE = 64,         // wrong command line
    STATUS_BAD_DATA = 65,      // bad input or parameters
    STATUS_NO_INPUT = 66,      // no such input
    STATUS_INTERNAL = 70,      // internal error, out of memory
    STATUS_CANNOT_CREATE = 73, // output cannot be created
    STATUS_IO = 74             // reading or writing failed
};

// Why a computation stopped: one line, no trailing newline, no program name.
struct reason {
    char text[512];
};

// Writes the line into REASON and returns STATUS, so that errors leave early:
//     if (n < 1) return refuse(reason, STATUS_BAD_DATA, "no grains");
enum status refuse(struct reason *reason, enum status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Prints "PROGRAM: line" on stderr and exits with STATUS. Not for physics. Control
// characters in the line, as in names of files, are printed as "?".
_Noreturn void die(enum status status, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// Prints "PROGRAM: line" on stderr and goes on.
void report(const char *format, ...) __attribute__((format(printf, 1, 2)));
