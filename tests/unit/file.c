// SPDX-License-Identifier: GPL-3.0-or-later
// Whole files: mapped from the disk or read from a pipe, the same bytes; a file that is
// cut short while it is mapped ends the program with one line and status 74.
#include "basics/file.h"
#include "../test.h"

#include "basics/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SIZE = 300000 };

// A file of SIZE bytes, none of them 0, in NAME. Returns its descriptor.
static int make_file(char name[32])
{
    strcpy(name, "/tmp/file-XXXXXX");
    const int descriptor = mkstemp(name);
    assert_true(descriptor >= 0);
    for (int k = 0; k < SIZE; k++) {
        const unsigned char byte = (unsigned char)(1 + k % 251);
        assert_int_equal(write(descriptor, &byte, 1), 1);
    }
    return descriptor;
}

TEST(same_bytes_through_a_pipe)
{
    char name[32], command[64];
    close(make_file(name));
    struct bytes mapped = read_whole(name);
    snprintf(command, sizeof command, "cat %s", name);
    FILE *pipe = popen(command, "r");
    char of_pipe[64];
    snprintf(of_pipe, sizeof of_pipe, "/proc/self/fd/%d", fileno(pipe));
    struct bytes piped = read_whole(of_pipe);
    assert_true(mapped.mapped);
    assert_false(piped.mapped);
    assert_int_equal(mapped.size, SIZE);
    assert_int_equal(piped.size, SIZE);
    assert_memory_equal(mapped.data, piped.data, SIZE);
    release_pages(&mapped);
    assert_memory_equal(mapped.data, piped.data, SIZE);
    bytes_free(&mapped);
    bytes_free(&piped);
    pclose(pipe);
    unlink(name);
}

TEST(cut_short)
{
    char name[32];
    const int descriptor = make_file(name);
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        const struct bytes bytes = read_whole(name);
        const bool cut = !ftruncate(descriptor, 10);
        volatile unsigned char last = bytes.data[SIZE - 1];
        _exit(cut && last ? 0 : 1);
    }
    int end;
    assert_int_equal(waitpid(child, &end, 0), child);
    assert_true(WIFEXITED(end));
    assert_int_equal(WEXITSTATUS(end), STATUS_IO);
    close(descriptor);
    unlink(name);
}
