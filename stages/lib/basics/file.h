// SPDX-License-Identifier: GPL-3.0-or-later
// Whole files, in and out.
//
// Reading is for regular files, pipes and devices alike; writing leaves the old file or
// the new one, whatever ends the program. All functions end the program with one line
// and the status named, so that no caller needs a branch for a full disk. Paths are
// used as given: "-" is a stream only where it says so.
#pragma once

#include <stdbool.h>
#include <stddef.h>

struct bytes {
    unsigned char *data; // read only where mapped
    size_t size;
    bool mapped; // the pages of a file, which take no memory of ours
};

// All of PATH, or of standard input for "-"; of a pipe or device the beginning where
// the first byte is 0, as of nothing that we read. Exits 66 when there is no such file,
// 74 when reading fails. The caller frees it by bytes_free. A file that is cut short by
// another program while it is mapped ends this one (74). Exits 64 where standard input
// is a terminal.
struct bytes read_whole(const char *path);
void bytes_free(struct bytes *bytes);

// Gives pages back until they are read again; nothing where the bytes are not mapped.
void release_pages(const struct bytes *bytes);

// The same, but only the beginning of what GOES_ON says no to, which is asked once
// there are 8 bytes: what follows may have no end.
struct bytes read_whole_of(const char *path,
                           bool (*goes_on)(const struct bytes *beginning));

// Writes all of it or nothing: beside PATH under another name, synced, then renamed.
// "-" is standard output. Exits 73 when PATH cannot be created, 74 when writing fails;
// what stood at PATH before is then untouched. What is replaced keeps its rights.
// Interrupts wait until it is done.
void write_whole(const char *path, const void *data, size_t size);

// A new file that is no one's to see yet, for reading and writing, on the file system
// of PATH; in memory where PATH is standard output or a device. However the program
// ends, nothing is left of it, unless it is published: then it is PATH, synced, whole
// or not at all, as if by write_whole. Publishing closes it.
int open_unnamed(const char *path);
void publish(int descriptor, const char *path);

// A path by which libraries can open it.
enum { DESCRIPTOR_NAME = 32 };
void name_of_descriptor(int descriptor, char name[DESCRIPTOR_NAME]);

// Exits 73 at once, before any work, when the folder of PATH is not there or closed to
// us, or what is at PATH cannot be replaced: a folder, a link that leads nowhere.
// Whether the disk has room is not known then.
void check_output(const char *path);

// A device or a FIFO: nothing to rename over, nor to come back to. Also false where
// nothing is there.
bool is_device(const char *path);

// Whether what is written to one would replace the other, however they are spelt.
bool is_same_place(const char *a, const char *b);

// SHA-256 as 64 hexadecimal digits, as sha256sum prints it. DIGEST ends with a null.
void sha256(const void *data, size_t size, char digest[65]);

// The name to use in messages. PATH itself or a static text.
const char *input_name(const char *path);
