// SPDX-License-Identifier: GPL-3.0-or-later
// Levenshtein's distance by dynamic programming, one row of the table at a time: O(a b)
// steps, O(b) memory.
#include "parameters/spelling.h"

enum { LONGEST = 127 };

static int least_of(int a, int b, int c)
{
    const int least = a < b ? a : b;
    return least < c ? least : c;
}

int edit_distance(const char *a, const char *b)
{
    int row[LONGEST + 1]; // row[j]: distance of a's first letters to b's first j
    for (int j = 0; j <= LONGEST; j++)
        row[j] = j;
    int columns = 0;
    while (b[columns] && columns < LONGEST)
        columns++;
    for (int i = 0; a[i] && i < LONGEST; i++) {
        int diagonal = row[0];
        row[0] = i + 1;
        for (int j = 0; j < columns; j++) {
            const int changed = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = least_of(changed, row[j] + 1, row[j + 1] + 1);
        }
    }
    return row[columns];
}
