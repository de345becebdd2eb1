// SPDX-License-Identifier: GPL-3.0-or-later
// The first item of a heap beside a search of all, while keys change, items come and
// go, and keys tie.
#include "dry/liquid/indexed_heap.h"
#include "../../random.h"
#include "../../test.h"

#include <math.h>

enum { N = 60, CHANGES = 20000 };

static int first_of(const double *key, const int *place)
{
    int first = -1;
    for (int i = 0; i < N; i++)
        if (place[i] >= 0 && (first < 0 || key[i] < key[first])) first = i;
    return first;
}

TEST(the_least_key_comes_first)
{
    struct indexed_heap heap = {0};
    double key[N];
    int place[N];
    uint64_t seed = 7;
    for (int i = 0; i < N; i++)
        place[i] = -1;
    for (int k = 0; k < CHANGES; k++) {
        const int item = (int)(N * next_random(&seed));
        if (next_random(&seed) < 0.4) {
            indexed_heap_take(&heap, key, place, item);
        } else {
            key[item] = floor(30 * next_random(&seed)); // ties: the lowest item
            indexed_heap_put(&heap, key, place, item);
        }
        const int first = first_of(key, place);
        assert_int_equal(heap.n > 0 ? heap.item[0] : -1, first);
    }
    int n = 0;
    for (int i = 0; i < N; i++)
        n += place[i] >= 0;
    assert_int_equal(heap.n, n);
    indexed_heap_clear(&heap, place);
    assert_int_equal(first_of(key, place), -1);
    indexed_heap_free(&heap);
}
