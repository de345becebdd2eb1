// SPDX-License-Identifier: GPL-3.0-or-later
// A sparse symmetric matrix of 3x3 blocks, filled row by row: products, and the
// inverses of its diagonal blocks as a preconditioner.
#ifndef CRAQUELURE_BLOCK_ROWS_H
#define CRAQUELURE_BLOCK_ROWS_H

struct block_rows {
    int n;                // rows of blocks
    int *start;           // (n+1) into COLUMN and BLOCK
    int *column;          // (start[n])
    double (*block)[9];   // (start[n]) by rows
    double (*inverse)[9]; // (n) of the diagonal blocks, 0 for empty rows
    int filled, capacity;
    int *place; // (n) of a column in the row that is being filled, or before it
};

// N rows, none filled. Free with block_rows_free.
struct block_rows block_rows_init(int n);
void block_rows_free(struct block_rows *rows);

// The block at COLUMN of the row being filled, which is 0 when first asked for. Valid
// until the next call.
double *block_rows_at(struct block_rows *rows, int column);
// Ends the row being filled; after the last one the matrix can be used.
void block_rows_end_row(struct block_rows *rows);

// IMAGE = matrix X, both (3 n). The same digits for any number of threads.
void block_rows_multiply(const struct block_rows *rows, const double *x, double *image);
// Z = inverses of the diagonal blocks times RESIDUAL, both (3 n).
void block_rows_precondition(const struct block_rows *rows, const double *residual,
                             double *z);

#endif
