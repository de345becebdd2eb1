// SPDX-License-Identifier: GPL-3.0-or-later
// Whole numbers of 32 bits as one to four planes of bytes. The high bytes of numbers of
// one size are nearly all equal, so beside each other zlib packs them to almost
// nothing.
//
//     kept_k = zigzag(value_k - value_{k-1})    where RISING, kept_0 = zigzag(value_0)
//     zigzag(d) = 2 d for d >= 0, -2 d - 1 below
//     plane p  = (kept >> 8 p) & 0xff           one behind the other, lowest first
//
// The script of the page undoes this by the fields of `list`: name, count, planes,
// delta, float. A change here needs one there (page/).
#include "arrays.h"

#include "basics/memory.h"
#include "basics/status.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

struct arrays arrays_init(void)
{
    return (struct arrays){.list = json_array()};
}

void arrays_free(struct arrays *arrays)
{
    free(arrays->data);
    json_decref(arrays->list);
    *arrays = (struct arrays){0};
}

// Capacity doubles: appending costs O(size).
static void put_planes(struct arrays *arrays, const uint32_t *value, size_t count,
                       int planes)
{
    const size_t wanted = arrays->size + count * (size_t)planes;
    if (wanted > arrays->capacity) {
        arrays->capacity = 2 * wanted;
        arrays->data = reallocate(arrays->data, arrays->capacity, 1);
    }
    for (int plane = 0; plane < planes; plane++)
        for (size_t k = 0; k < count; k++)
            arrays->data[arrays->size++] = (unsigned char)(value[k] >> (8 * plane));
}

// The bits of all numbers together have a byte where any of them has one.
static int planes_for(const uint32_t *value, size_t count)
{
    uint32_t all = 0;
    for (size_t k = 0; k < count; k++)
        all |= value[k];
    return 1 + (all > 0xff) + (all > 0xffff) + (all > 0xffffff);
}

static void note(struct arrays *arrays, const char *name, size_t count, int planes,
                 bool rising, bool is_float)
{
    json_array_append_new(arrays->list,
                          json_pack("{s:s,s:I,s:i,s:b,s:b}", "name", name, "count",
                                    (json_int_t)count, "planes", planes, "delta",
                                    rising, "float", is_float));
}

// Small differences of either sign become small numbers; as two's complement those
// below 0 would fill all four planes.
static uint32_t zigzag(int64_t difference)
{
    return (uint32_t)(difference < 0 ? -2 * difference - 1 : 2 * difference);
}

void arrays_put(struct arrays *arrays, const char *name, const uint32_t *value,
                size_t count, bool rising)
{
    uint32_t *kept = duplicate(value, count, sizeof *value);
    for (size_t k = count; rising && k-- > 1;)
        kept[k] = zigzag((int64_t)value[k] - value[k - 1]);
    if (rising && count) kept[0] = zigzag(value[0]);
    const int planes = planes_for(kept, count);
    note(arrays, name, count, planes, rising, false);
    put_planes(arrays, kept, count, planes);
    free(kept);
}

// As bits, never converted: the page reads the same float on any machine.
void arrays_put_doubles(struct arrays *arrays, const char *name, const double *value,
                        size_t count)
{
    uint32_t *bits = NEW_ARRAY(uint32_t, count);
    for (size_t k = 0; k < count; k++) {
        const float rounded = (float)value[k];
        memcpy(&bits[k], &rounded, sizeof rounded);
    }
    note(arrays, name, count, 4, false, true);
    put_planes(arrays, bits, count, 4);
    free(bits);
}

// Three bytes become four letters; the last group is filled up with "=".
char *base64(const unsigned char *data, size_t size)
{
    static const char digit[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *text = allocate(4 * ((size + 2) / 3) + 1, 1), *end = text;
    for (size_t k = 0; k < size; k += 3) {
        const unsigned bits = (unsigned)data[k] << 16 |
                              (k + 1 < size ? (unsigned)data[k + 1] << 8 : 0) |
                              (k + 2 < size ? (unsigned)data[k + 2] : 0);
        *end++ = digit[bits >> 18];
        *end++ = digit[bits >> 12 & 63];
        *end++ = k + 1 < size ? digit[bits >> 6 & 63] : '=';
        *end++ = k + 2 < size ? digit[bits & 63] : '=';
    }
    return text;
}

// zlib wants a pointer even for no bytes.
char *arrays_text(const struct arrays *arrays)
{
    uLongf size = compressBound(arrays->size);
    unsigned char *packed = allocate(size, 1);
    const unsigned char *data = arrays->data ? arrays->data : packed;
    if (compress2(packed, &size, data, arrays->size, 9) != Z_OK)
        die(STATUS_INTERNAL, "out of memory");
    char *text = base64(packed, size);
    free(packed);
    return text;
}
