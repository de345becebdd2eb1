// SPDX-License-Identifier: GPL-3.0-or-later
#include "basics/file.h"

#include "basics/memory.h"
#include "basics/status.h"

#include <errno.h>
#include <fcntl.h>
#include <openssl/evp.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

const char *input_name(const char *path)
{
    return strcmp(path, "-") ? path : "standard input";
}

static int open_input(const char *path)
{
    if (!strcmp(path, "-")) return STDIN_FILENO;
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) die(STATUS_NO_INPUT, "%s: %s", path, strerror(errno));
    return descriptor;
}

struct bytes read_whole(const char *path)
{
    const int descriptor = open_input(path);
    struct stat information;
    size_t capacity = 1 << 16;
    if (!fstat(descriptor, &information) && S_ISREG(information.st_mode))
        capacity = (size_t)information.st_size + 1; // one more, to see the end at once
    struct bytes bytes = {.data = reallocate(NULL, capacity, 1)};
    for (;;) {
        const ssize_t got =
            read(descriptor, bytes.data + bytes.size, capacity - bytes.size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) die(STATUS_IO, "%s: %s", input_name(path), strerror(errno));
        if (got == 0) break;
        bytes.size += (size_t)got;
        if (bytes.size == capacity)
            bytes.data = reallocate(bytes.data, capacity *= 2, 1);
    }
    if (descriptor != STDIN_FILENO) close(descriptor);
    return bytes;
}

static bool write_all(int descriptor, const unsigned char *data, size_t size)
{
    while (size) {
        const ssize_t put = write(descriptor, data, size);
        if (put < 0 && errno == EINTR) continue;
        if (put < 0) return false;
        data += put;
        size -= (size_t)put;
    }
    return true;
}

static void write_standard_output(const void *data, size_t size)
{
    signal(SIGPIPE, SIG_IGN); // a closed pipe is reported as any other failure
    if (!write_all(STDOUT_FILENO, data, size))
        die(STATUS_IO, "standard output: %s", strerror(errno));
}

// The rights a plain open() would have given: mkstemp gives 0600.
static void grant_usual_rights(int descriptor)
{
    const mode_t mask = umask(0);
    umask(mask);
    fchmod(descriptor, 0666 & ~mask);
}

static void write_file(const char *path, const void *data, size_t size)
{
    struct stat information;
    if (!stat(path, &information) && S_ISDIR(information.st_mode))
        die(STATUS_CANNOT_CREATE, "%s: is a directory", path);
    char *temporary = allocate(strlen(path) + 8, 1);
    sprintf(temporary, "%s.XXXXXX", path);
    const int descriptor = mkstemp(temporary);
    if (descriptor < 0) die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(errno));
    grant_usual_rights(descriptor);
    const bool written = write_all(descriptor, data, size) && !fsync(descriptor);
    const int write_error = errno;
    if (close(descriptor) || !written) {
        unlink(temporary);
        die(STATUS_IO, "%s: %s", path, strerror(written ? errno : write_error));
    }
    if (rename(temporary, path)) {
        const int rename_error = errno;
        unlink(temporary);
        die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(rename_error));
    }
    free(temporary);
}

// What a link points to is replaced, not the link: /dev/stdout must stay one.
static char *follow_link(const char *path)
{
    struct stat information;
    const bool link = !lstat(path, &information) && S_ISLNK(information.st_mode);
    char *target = link ? realpath(path, NULL) : strdup(path);
    if (!target) die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(errno));
    return target;
}

// A device or a FIFO: nothing to rename over.
static bool is_device(const char *path)
{
    struct stat information;
    return !stat(path, &information) && !S_ISREG(information.st_mode) &&
           !S_ISDIR(information.st_mode);
}

static void write_device(const char *path, const void *data, size_t size)
{
    const int descriptor = open(path, O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(errno));
    signal(SIGPIPE, SIG_IGN);
    if (!write_all(descriptor, data, size) || close(descriptor))
        die(STATUS_IO, "%s: %s", path, strerror(errno));
}

void write_whole(const char *path, const void *data, size_t size)
{
    if (!strcmp(path, "-")) {
        write_standard_output(data, size);
        return;
    }
    if (!access(path, F_OK) && access(path, W_OK))
        die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(errno));
    if (is_device(path)) {
        write_device(path, data, size);
        return;
    }
    // With the signals held back, no half file can be left behind: nothing ends the
    // program between the create and the rename.
    sigset_t interrupts, before;
    sigemptyset(&interrupts);
    sigaddset(&interrupts, SIGINT);
    sigaddset(&interrupts, SIGTERM);
    sigaddset(&interrupts, SIGHUP);
    sigprocmask(SIG_BLOCK, &interrupts, &before);
    signal(SIGXFSZ, SIG_IGN); // past the file size limit: an error, as on a full disk
    char *target = follow_link(path);
    write_file(target, data, size);
    free(target);
    sigprocmask(SIG_SETMASK, &before, NULL);
}

void check_output(const char *path)
{
    if (!strcmp(path, "-")) return;
    char *copy = strdup(path);
    char *slash = strrchr(copy, '/');
    if (slash) slash[slash == copy] = 0; // "/x" lies in "/"
    const char *folder = slash ? copy : ".";
    struct stat information;
    if (!stat(folder, &information) && !S_ISDIR(information.st_mode))
        die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(ENOTDIR));
    if (access(folder, W_OK | X_OK))
        die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(errno));
    free(copy);
}

void sha256(const void *data, size_t size, char digest[65])
{
    unsigned char raw[32];
    if (!EVP_Q_digest(NULL, "SHA256", NULL, data, size, raw, NULL))
        die(STATUS_INTERNAL, "SHA-256 is not available");
    for (int k = 0; k < 32; k++)
        sprintf(&digest[2 * k], "%02x", raw[k]);
}
