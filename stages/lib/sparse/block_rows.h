// SPDX-License-Identifier: GPL-3.0-or-later
// A sparse symmetric matrix of 3x3 blocks, filled row by row: products, and the
// inverses of its diagonal blocks as a preconditioner. Blocks below the diagonal are
// not kept: they are those above, transposed. Rows are filled and kept in any order:
// best in one in which neighbours follow each other.
//
// How it is filled, in the order given:
//     for (int k = 0; k < n; k++) {
//         for each column j that row order[k] has, itself included:
//             double *block = block_rows_at(&rows, j);
//             if (block) add to block[0..8], row by row
//         block_rows_end_row(&rows);
//     }
// A block of two rows is filled with the one that comes first, and asked for again with
// the other, so that each row knows its columns.
#pragma once

#include <stdint.h>

struct block_rows {
    int n;                // rows of blocks
    int32_t *order;       // (n) rows, as they are filled and kept
    int32_t *rank;        // (n) of each row in that order
    int *start;           // (n+1) of the rows in that order, into COLUMN and AT
    int *column;          // (start[n])
    int *at;              // (start[n]) into BLOCK; ~at: transposed
    double (*block)[9];   // (n_block) by rows
    double (*inverse)[9]; // (n) of the diagonal blocks, 0 for empty rows
    int n_block, filled;
    int room, block_room; // for columns, and for blocks
    int *place; // (n) of a column in the row that is being filled, or before it
};

// N rows, none filled, to be filled in ORDER (n), which is freed with the rest; NULL:
// from the first to the last. Free with block_rows_free.
struct block_rows block_rows_init(int n, int32_t *order);
void block_rows_free(struct block_rows *rows);

// The block at COLUMN of the row being filled, which is 0 when first asked for. Valid
// until the next call. Where row COLUMN has been filled NULL: nothing is to be added.
// These must be asked for all the same, and no others than those that were there.
double *block_rows_at(struct block_rows *rows, int column);
// Ends the row being filled, order[filled]; after the last one the matrix can be used.
void block_rows_end_row(struct block_rows *rows);

// IMAGE = matrix X, both (3 n). The same digits for any number of threads.
void block_rows_multiply(const struct block_rows *rows, const double *x, double *image);
// Z = inverses of the diagonal blocks times RESIDUAL, both (3 n).
void block_rows_precondition(const struct block_rows *rows, const double *residual,
                             double *z);
