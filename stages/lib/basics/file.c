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
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

const char *input_name(const char *path)
{
    return strcmp(path, "-") ? path : "standard input";
}

static int open_input(const char *path)
{
    if (!strcmp(path, "-") && isatty(STDIN_FILENO))
        die(STATUS_USAGE, "standard input is a terminal: name a file, or pipe it");
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
        if (bytes.data[0] == 0) break; // /dev/zero has no end
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

bool is_device(const char *path)
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

// The signals that were let through before: until they are again, nothing ends the
// program between the create and the rename.
static sigset_t hold_interrupts(void)
{
    sigset_t interrupts, before;
    sigemptyset(&interrupts);
    sigaddset(&interrupts, SIGINT);
    sigaddset(&interrupts, SIGTERM);
    sigaddset(&interrupts, SIGHUP);
    sigprocmask(SIG_BLOCK, &interrupts, &before);
    return before;
}

static void check_replaceable(const char *path)
{
    struct stat information;
    if (!access(path, F_OK) && access(path, W_OK))
        die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(errno));
    if (!stat(path, &information) && S_ISDIR(information.st_mode))
        die(STATUS_CANNOT_CREATE, "%s: is a directory", path);
}

void write_whole(const char *path, const void *data, size_t size)
{
    if (!strcmp(path, "-")) {
        write_standard_output(data, size);
        return;
    }
    check_replaceable(path);
    if (is_device(path)) {
        write_device(path, data, size);
        return;
    }
    const sigset_t before = hold_interrupts();
    signal(SIGXFSZ, SIG_IGN); // past the file size limit: an error, as on a full disk
    char *target = follow_link(path);
    write_file(target, data, size);
    free(target);
    sigprocmask(SIG_SETMASK, &before, NULL);
}

// ---- files without a name -----------------------------------------------------------

// The folder that PATH is in. The caller frees it.
static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (!slash) return strdup(".");
    return strndup(path, slash == path ? 1 : (size_t)(slash - path)); // "/x": in "/"
}

int open_unnamed(const char *path)
{
    int descriptor = -1;
    if (!strcmp(path, "-") && fcntl(STDOUT_FILENO, F_GETFD) < 0) // would become ours
        die(STATUS_IO, "standard output: %s", strerror(errno));
    signal(SIGXFSZ, SIG_IGN);
    if (strcmp(path, "-") && !is_device(path)) {
        char *target = follow_link(path), *folder = folder_of(target);
        descriptor = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
        free(folder);
        free(target);
    }
    if (descriptor < 0) descriptor = memfd_create("output", MFD_CLOEXEC);
    if (descriptor < 0) die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(errno));
    return descriptor;
}

void name_of_descriptor(int descriptor, char name[DESCRIPTOR_NAME])
{
    snprintf(name, DESCRIPTOR_NAME, "/proc/self/fd/%d", descriptor);
}

// Under another name first: a link replaces nothing. False when it cannot be linked,
// being in memory.
static bool give_name(int descriptor, const char *path)
{
    char *temporary = allocate(strlen(path) + 16, 1), from[DESCRIPTOR_NAME];
    sprintf(temporary, "%s.%d", path, (int)getpid());
    name_of_descriptor(descriptor, from);
    const bool linked = !linkat(AT_FDCWD, from, AT_FDCWD, temporary, AT_SYMLINK_FOLLOW);
    const bool synced = !linked || !fsync(descriptor);
    if (linked && (!synced || rename(temporary, path))) {
        const int error = errno;
        unlink(temporary);
        die(synced ? STATUS_CANNOT_CREATE : STATUS_IO, "%s: %s", path, strerror(error));
    }
    free(temporary);
    return linked;
}

static void copy_whole(int descriptor, const char *path)
{
    const off_t size = lseek(descriptor, 0, SEEK_END);
    void *data = mmap(NULL, (size_t)size, PROT_READ, MAP_SHARED, descriptor, 0);
    if (data == MAP_FAILED) die(STATUS_IO, "%s: %s", path, strerror(errno));
    write_whole(path, data, (size_t)size);
    munmap(data, (size_t)size);
}

void publish(int descriptor, const char *path)
{
    bool named = false;
    if (strcmp(path, "-") && !is_device(path)) {
        check_replaceable(path);
        const sigset_t before = hold_interrupts();
        char *target = follow_link(path);
        named = give_name(descriptor, target);
        free(target);
        sigprocmask(SIG_SETMASK, &before, NULL);
    }
    if (!named) copy_whole(descriptor, path);
    close(descriptor);
}

// Where PATH leads, whether or not something is there yet. The caller frees it.
static char *absolute(const char *path)
{
    char *whole = realpath(path, NULL);
    if (whole) return whole;
    char *folder = folder_of(path), *in = realpath(folder, NULL);
    free(folder);
    if (!in) return strdup(path);
    const char *slash = strrchr(path, '/');
    char *joined = allocate(strlen(in) + strlen(path) + 2, 1);
    sprintf(joined, "%s/%s", in, slash ? slash + 1 : path);
    free(in);
    return joined;
}

bool is_same_place(const char *a, const char *b)
{
    if (!strcmp(a, "-") || !strcmp(b, "-")) return !strcmp(a, b);
    char *first = absolute(a), *second = absolute(b);
    const bool same = !strcmp(first, second);
    free(first);
    free(second);
    return same;
}

void check_output(const char *path)
{
    if (!strcmp(path, "-")) return;
    if (!*path) die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(ENOENT));
    char *folder = folder_of(path);
    struct stat information;
    if (!stat(folder, &information) && !S_ISDIR(information.st_mode))
        die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(ENOTDIR));
    if (access(folder, W_OK | X_OK))
        die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(errno));
    free(folder);
    check_replaceable(path);
    if (!is_device(path)) free(follow_link(path));
}

void sha256(const void *data, size_t size, char digest[65])
{
    unsigned char raw[32];
    if (!EVP_Q_digest(NULL, "SHA256", NULL, data, size, raw, NULL))
        die(STATUS_INTERNAL, "SHA-256 is not available");
    for (int k = 0; k < 32; k++)
        sprintf(&digest[2 * k], "%02x", raw[k]);
}
