// SPDX-License-Identifier: GPL-3.0-or-later
// Elimination of the inner rows leaves links between rows of the front; with those that
// are there already they are the network of the front. Its rows are counted from the
// first on, its ground is all that is not in the gas.
#include "gas_preconditioner.h"

#include "basics/memory.h"

#include <stdlib.h>

struct gas_preconditioner {
    int n_inner, n_first; // rows, when the inner ones were eliminated
    int n;                // rows now
    struct approximate_cholesky *inner, *front; // front: NULL before _follow
    int n_link;
    struct link *link; // (n_link) left between rows, from n_first on to ground
    double *b_front;   // (n_most - n_inner)
};

struct gas_preconditioner *
gas_preconditioner_create(const struct conductance_matrix *matrix, int n_inner,
                          int n_most)
{
    struct gas_preconditioner *gas = NEW_ARRAY(struct gas_preconditioner, 1);
    *gas = (struct gas_preconditioner){.n_inner = n_inner,
                                       .n_first = matrix->n,
                                       .b_front = NEW_ARRAY(double, n_most - n_inner)};
    struct conductance_matrix rows = *matrix;
    rows.n = n_inner;
    gas->inner = approximate_cholesky_create_partly(&rows, matrix->n - n_inner,
                                                    &gas->n_link, &gas->link);
    return gas;
}

void gas_preconditioner_free(struct gas_preconditioner *gas)
{
    if (!gas) return;
    approximate_cholesky_free(gas->inner);
    approximate_cholesky_free(gas->front);
    free(gas->link);
    free(gas->b_front);
    free(gas);
}

// LINK has room for those left and all of the rows. Returns how many.
static int links_of_front(const struct gas_preconditioner *gas,
                          const struct conductance_matrix *matrix, struct link *link)
{
    const int n = matrix->n, first = gas->n_inner, ground = n - first;
    int count = 0;
    for (int l = 0; l < gas->n_link; l++) {
        const int *site = gas->link[l].site;
        link[count++] = (struct link){
            {site[0] - first, site[1] < gas->n_first ? site[1] - first : ground},
            gas->link[l].conductance};
    }
    for (int row = first; row < n; row++)
        for (int k = matrix->offset[row]; k < matrix->offset[row + 1]; k++) {
            const int other = matrix->column[k];
            if (other > row)
                link[count++] =
                    (struct link){{row - first, other < n ? other - first : ground},
                                  matrix->value[k]};
        }
    return count;
}

double gas_preconditioner_follow(struct gas_preconditioner *gas,
                                 const struct conductance_matrix *matrix)
{
    const int n_front = matrix->n - gas->n_inner;
    const int most = matrix->offset[matrix->n] - matrix->offset[gas->n_inner];
    struct link *link = NEW_ARRAY(struct link, gas->n_link + most);
    const int n_link = links_of_front(gas, matrix, link);
    struct conductance_matrix front =
        conductance_matrix_of_links(n_front, n_front + 1, n_link, link);
    gas->n = matrix->n;
    approximate_cholesky_free(gas->front);
    gas->front = approximate_cholesky_create(&front);
    conductance_matrix_free(&front);
    free(link);
    return (double)n_front / matrix->n;
}

void gas_preconditioner_apply(struct gas_preconditioner *gas, const double *b,
                              double *z)
{
    const int n_inner = gas->n_inner;
    double *z_front = z + n_inner;
    approximate_cholesky_reduce(gas->inner, b, gas->b_front);
    for (int row = gas->n_first; row < gas->n; row++)
        gas->b_front[row - n_inner] = b[row];
    approximate_cholesky_apply(gas->front, gas->b_front, z_front);
    approximate_cholesky_extend(gas->inner, z_front, z);
}
