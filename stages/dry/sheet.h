// SPDX-License-Identifier: GPL-3.0-or-later
// Links between all pairs of many sites, each at a place of its own: a symmetric matrix
// without a diagonal, in blocks of PATCH by PATCH. Products of rows are added to a
// block only when it is looked at, many at once, which keeps it in cache.
#ifndef CRAQUELURE_SHEET_H
#define CRAQUELURE_SHEET_H

#include <stddef.h>

enum { PATCH = 64, MOST_SOURCES = 64 };

//
// With a threshold, products are left out between patches that a source has hardly
// anything to do with, as is most often so between patches far from it.
struct sheet {
    double threshold; // of the parts of a row in two patches, multiplied; 0: none
    int n_patch, patch_capacity;
    int *key;           // (n_patch) its sites have in common
    int *count;         // (n_patch) sites in a patch: its first places
    double *unreported; // (n_patch) for the owner of the sheet; 0 at first
    int *site;          // (PATCH n_patch) at each place
    double **block;     // of patches a >= b at a (a+1) / 2 + b, PATCH rows of a
    int *n_done;        // beside it: sources it has
    int n_source;
    double *source[MOST_SOURCES]; // (PATCH n_patch) a row, 0 where no site is
    double *scaled[MOST_SOURCES]; // the same times its factor
    double *sum[MOST_SOURCES];    // (n_patch) of the row in each patch
    double least[MOST_SOURCES];   // products of sums that count are larger
};

struct sheet sheet_make(double threshold);
void sheet_free(struct sheet *sheet);

static inline int sheet_places(const struct sheet *sheet)
{
    return PATCH * sheet->n_patch;
}

// SITE gets a place in a patch of KEY, without links. Returns the place.
int sheet_add(struct sheet *sheet, int site, int key);

// Adds to the link between two places.
void sheet_link(struct sheet *sheet, int p, int q, double conductance);

// The links of PLACE, by place; 0 where no site is.
void sheet_row(struct sheet *sheet, int place, double *row);

// The site at PLACE has left. Another of its patch may take its place, to which ROW
// follows: returns where it was.
int sheet_remove(struct sheet *sheet, int place, double *row);

// Adds FACTOR ROW[p] ROW[q] to the link between any two places. LEFT_OUT (n_patch): of
// what is left out, the sum over q for a place p of the patch, over ROW[p].
void sheet_add_products(struct sheet *sheet, const double *row, double factor,
                        double *left_out);

// Adds sum_k LEFT[k][i] RIGHT[k][j] to BLOCK[i][j] for at least N_ROW rows and N_COLUMN
// columns of a block; by the width of the processor's vectors: the same digits.
void block_update_narrow(double *block, int n_row, int n_column, int n_source,
                         const double *const *left, const double *const *right);
void block_update_wide(double *block, int n_row, int n_column, int n_source,
                       const double *const *left, const double *const *right);

#endif
