// SPDX-License-Identifier: GPL-3.0-or-later
// Reading maps a file, so that its bytes take no memory, and takes what comes until the
// end from pipes, which have no size. Writing: what is new has no name (O_TMPFILE) or
// is in memory, is synced, and then takes the place of the old by link or rename, which
// are atomic. Where the file system knows no nameless files it gets another name in the
// same folder instead. Standard output and devices have nothing to rename over and are
// written straight.
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

// A file that is made shorter in place while it is mapped. Nothing else raises SIGBUS.
static void say_cut_short(int signal)
{
    static const char line[] = "an input was cut short while it was read\n";
    (void)signal;
    const ssize_t written = write(STDERR_FILENO, line, sizeof line - 1);
    (void)written; // errno is not for handlers
    _exit(STATUS_IO);
}

// False for what cannot be mapped: pipes, devices, standard input that was read in
// part, and files without a byte.
static bool map_file(int descriptor, struct bytes *bytes)
{
    struct stat information;
    if (fstat(descriptor, &information) || !S_ISREG(information.st_mode)) return false;
    if (information.st_size == 0 || lseek(descriptor, 0, SEEK_CUR) != 0) return false;
    const size_t size = (size_t)information.st_size;
    void *data = mmap(NULL, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (data == MAP_FAILED) return false;
    signal(SIGBUS, say_cut_short);
    *bytes = (struct bytes){.data = data, .size = size, .mapped = true};
    return true;
}

void bytes_free(struct bytes *bytes)
{
    if (bytes->mapped)
        munmap(bytes->data, bytes->size);
    else
        free(bytes->data);
    *bytes = (struct bytes){0};
}

void release_pages(const struct bytes *bytes)
{
    if (bytes->mapped) madvise(bytes->data, bytes->size, MADV_DONTNEED);
}

static struct bytes read_stream(int descriptor, const char *path,
                                bool (*goes_on)(const struct bytes *beginning))
{
    enum { SIGNATURE = 8 };
    bool asked = !goes_on;
    size_t capacity = 1 << 16;
    struct bytes bytes = {.data = reallocate(NULL, capacity, 1)};
    for (;;) {
        const ssize_t got =
            read(descriptor, bytes.data + bytes.size, capacity - bytes.size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) die(STATUS_IO, "%s: %s", input_name(path), strerror(errno));
        if (got == 0) break;
        bytes.size += (size_t)got;
        if (bytes.data[0] == 0) break; // /dev/zero has no end
        if (!asked && bytes.size >= SIGNATURE && !goes_on(&bytes)) break;
        asked = asked || bytes.size >= SIGNATURE;
        if (bytes.size == capacity)
            bytes.data = reallocate(bytes.data, capacity *= 2, 1);
    }
    return bytes;
}

struct bytes read_whole_of(const char *path,
                           bool (*goes_on)(const struct bytes *beginning))
{
    const int descriptor = open_input(path);
    struct bytes bytes;
    if (!map_file(descriptor, &bytes)) bytes = read_stream(descriptor, path, goes_on);
    if (descriptor != STDIN_FILENO) close(descriptor);
    return bytes;
}

struct bytes read_whole(const char *path)
{
    return read_whole_of(path, NULL);
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
    if (lstat(path, &information) && errno == ENAMETOOLONG)
        die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(errno));
    if (!access(path, F_OK) && access(path, W_OK))
        die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(errno));
    if (!stat(path, &information) && S_ISDIR(information.st_mode))
        die(STATUS_CANNOT_CREATE, "%s: is a directory", path);
}

// The folder that PATH is in. The caller frees it.
static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (!slash) return strdup(".");
    return strndup(path, slash == path ? 1 : (size_t)(slash - path)); // "/x": in "/"
}

// Another name in the folder of PATH, short, as PATH's own may be as long as names can
// be. The caller frees it.
static char *name_beside(const char *path, const char *name)
{
    char *folder = folder_of(path), *beside = NULL;
    if (asprintf(&beside, "%s/%s", folder, name) < 0)
        die(STATUS_INTERNAL, "out of memory: a file name");
    free(folder);
    return beside;
}

// Those of the file that is replaced, or what a plain open() would have given.
static void grant_rights(int descriptor, const char *path)
{
    struct stat replaced;
    const mode_t mask = umask(0);
    umask(mask);
    fchmod(descriptor, stat(path, &replaced) ? 0666 & ~mask : replaced.st_mode & 0777);
}

// ---- files without a name -----------------------------------------------------------

void name_of_descriptor(int descriptor, char name[DESCRIPTOR_NAME])
{
    snprintf(name, DESCRIPTOR_NAME, "/proc/self/fd/%d", descriptor);
}

// A file in the folder of PATH; -1 where the file system cannot have one.
static int open_in_folder(const char *path)
{
    char *folder = folder_of(path);
    const int descriptor = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    free(folder);
    return descriptor;
}

int open_unnamed(const char *path)
{
    int descriptor = -1;
    if (!strcmp(path, "-") && fcntl(STDOUT_FILENO, F_GETFD) < 0) // would become ours
        die(STATUS_IO, "standard output: %s", strerror(errno));
    signal(SIGXFSZ, SIG_IGN); // past the file size limit: an error, as on a full disk
    if (strcmp(path, "-") && !is_device(path)) {
        char *target = follow_link(path);
        descriptor = open_in_folder(target);
        free(target);
    }
    if (descriptor < 0) descriptor = memfd_create("output", MFD_CLOEXEC);
    if (descriptor < 0) die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(errno));
    return descriptor;
}

// The link's name, which the caller frees; NULL where DESCRIPTOR cannot be linked. A
// process of the same number on another machine may be at work in the folder.
static char *link_beside(const char *from, const char *path)
{
    for (int n = 0;; n++) {
        char name[32];
        snprintf(name, sizeof name, ".new-%d-%d", (int)getpid(), n);
        char *beside = name_beside(path, name);
        if (!linkat(AT_FDCWD, from, AT_FDCWD, beside, AT_SYMLINK_FOLLOW)) return beside;
        free(beside);
        if (errno != EEXIST) return NULL;
    }
}

// Synced while it has no name, so that whatever ends the program meanwhile leaves
// nothing. A link replaces nothing: where there is a file, it goes by a name beside it.
// False when it cannot be linked, being in memory.
static bool give_name(int descriptor, const char *path)
{
    char from[DESCRIPTOR_NAME];
    name_of_descriptor(descriptor, from);
    grant_rights(descriptor, path);
    if (fsync(descriptor)) die(STATUS_IO, "%s: %s", path, strerror(errno));
    if (!linkat(AT_FDCWD, from, AT_FDCWD, path, AT_SYMLINK_FOLLOW)) return true;
    char *beside = errno == EEXIST ? link_beside(from, path) : NULL;
    if (!beside) return false;
    if (rename(beside, path)) {
        const int error = errno;
        unlink(beside);
        die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(error));
    }
    free(beside);
    return true;
}

// ---- whole files --------------------------------------------------------------------

// Where no file can be without a name.
static void write_by_name(const char *path, const void *data, size_t size)
{
    char *temporary = name_beside(path, ".new-XXXXXX");
    const int descriptor = mkstemp(temporary);
    if (descriptor < 0) die(STATUS_CANNOT_CREATE, "%s: %s", path, strerror(errno));
    grant_rights(descriptor, path);
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

static void write_file(const char *path, const void *data, size_t size)
{
    const int descriptor = open_in_folder(path);
    if (descriptor >= 0 && !write_all(descriptor, data, size))
        die(STATUS_IO, "%s: %s", path, strerror(errno));
    const bool named = descriptor >= 0 && give_name(descriptor, path);
    if (descriptor >= 0) close(descriptor);
    if (!named) write_by_name(path, data, size);
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
    signal(SIGXFSZ, SIG_IGN);
    char *target = follow_link(path);
    write_file(target, data, size);
    free(target);
    sigprocmask(SIG_SETMASK, &before, NULL);
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
    for (size_t k = 0; k < sizeof raw; k++)
        sprintf(&digest[2 * k], "%02x", raw[k]);
}
