// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays for a page: whole numbers as planes of bytes (all lowest bytes first), so that
// they compress well and browsers of any byte order read them alike.
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct arrays {
    unsigned char *data; // the planes, one array behind the other
    size_t size, capacity;
    json_t *list; // [{"name", "count", "planes", "delta", "float"}, ...] in that order
};

// An empty one, for the caller to free with arrays_free.
struct arrays arrays_init(void);
void arrays_free(struct arrays *arrays);

// VALUE (COUNT) in as few planes as the largest needs. RISING: differences of
// neighbours are kept instead, zigzag (0, -1, 1, -2, ... become 0, 1, 2, 3, ...). VALUE
// is copied, and the name too. RISING need not be strict: any sequence whose neighbours
// are near packs well that way; differences must fit into 31 bits.
void arrays_put(struct arrays *arrays, const char *name, const uint32_t *value,
                size_t count, bool rising);

// VALUE (COUNT) to seven digits, as the bits of floats. Numbers beyond a float's range
// become infinite.
void arrays_put_doubles(struct arrays *arrays, const char *name, const double *value,
                        size_t count);

// All of them, compressed (zlib) and in base64. The caller frees it.
char *arrays_text(const struct arrays *arrays);

// The caller frees it. SIZE bytes of DATA as text with a terminating 0.
char *base64(const unsigned char *data, size_t size);
