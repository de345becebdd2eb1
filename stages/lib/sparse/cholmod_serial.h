// SPDX-License-Identifier: GPL-3.0-or-later
// CHOLMOD as every stage uses it. Three steps make a matrix: new_entries, add_entry for
// each, take_matrix. CHOLMOD would choose among orderings and between simplicial and
// supernodal factors by the size of the matrix, and threaded BLAS would add in another
// order each time. So all is fixed here. What CHOLMOD returns is NULL when out of
// memory: callers must look.
#pragma once

#include <cholmod.h>

// Begins COMMON, which the caller ends with cholmod_finish: silent, simplicial and
// always in the same ordering. No BLAS, so the same bytes everywhere and for any number
// of threads. AMD is the only ordering tried; `print = 0` keeps messages off the user's
// screen.
static inline void cholmod_serial_start(cholmod_common *common)
{
    cholmod_start(common);
    common->print = 0;
    common->supernodal = CHOLMOD_SIMPLICIAL;
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_AMD;
}

// The lower triangle of a symmetric matrix of N rows, entry by entry, at most MOST of
// them. NULL: out of memory, for take_matrix too, which frees the entries. -1 stands
// for a matrix of which the lower triangle is given.
static inline cholmod_triplet *new_entries(cholmod_common *common, int n, size_t most)
{
    return cholmod_allocate_triplet((size_t)n, (size_t)n, most, -1, CHOLMOD_REAL,
                                    common);
}

// Adds VALUE at (ROW, COLUMN), or at its mirror below the diagonal; entries at one
// place are summed by take_matrix. No more than MOST. ENTRIES must not be NULL.
static inline void add_entry(cholmod_triplet *entries, int row, int column,
                             double value)
{
    ((int *)entries->i)[entries->nnz] = row > column ? row : column;
    ((int *)entries->j)[entries->nnz] = row > column ? column : row;
    ((double *)entries->x)[entries->nnz] = value;
    entries->nnz++;
}

// The sparse matrix of ENTRIES, which it frees. The caller frees it with
// cholmod_free_sparse. O(entries). NULL: out of memory.
static inline cholmod_sparse *take_matrix(cholmod_common *common,
                                          cholmod_triplet *entries)
{
    cholmod_sparse *matrix = cholmod_triplet_to_sparse(entries, entries->nnz, common);
    cholmod_free_triplet(&entries, common);
    return matrix;
}
