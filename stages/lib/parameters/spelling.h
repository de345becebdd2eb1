// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The least number of letters to insert, delete or change to turn A into B
// (Levenshtein); only the first 127 letters of each count. Bytes are letters.
int edit_distance(const char *a, const char *b);
