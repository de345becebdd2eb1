// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays with an element for each contact pair, made anew, and empty, when pairs are
// added; with them the pattern of the stiffness and the contact solver, which know the
// pairs by number.
#include "quasi_static_internal.h"

#include "basics/memory.h"

#include <stdlib.h>

struct contact_pair_setup pair_setup_of(const struct quasi_static *qs)
{
    return (struct contact_pair_setup){.packing = qs->packing,
                                       .material = &qs->setup.material,
                                       .bond = &qs->setup.bond,
                                       .has_wall = qs->setup.has_wall,
                                       .unstressed = qs->setup.unstressed,
                                       .rolling = qs->setup.rolling,
                                       .length = qs->length,
                                       .stiffness = qs->stiffness};
}

void free_pair_arrays(struct quasi_static *qs)
{
    void *const of_pairs[] = {qs->deformation, qs->increment, qs->last_increment,
                              qs->tangent,     qs->factored,  qs->response,
                              qs->changed};
    for (size_t k = 0; k < sizeof of_pairs / sizeof *of_pairs; k++)
        free(of_pairs[k]);
    contact_solver_free(qs->contacts);
    stiffness_free(qs->matrix);
}

void allocate_pair_arrays(struct quasi_static *qs)
{
    free_pair_arrays(qs);
    qs->deformation = allocate((size_t)qs->n_pair, sizeof *qs->deformation);
    qs->increment = allocate((size_t)qs->n_pair, sizeof *qs->increment);
    qs->last_increment = allocate((size_t)qs->n_pair, sizeof *qs->last_increment);
    qs->tangent = allocate((size_t)qs->n_pair, sizeof *qs->tangent);
    qs->factored = NEW_ARRAY(struct factored, qs->n_pair);
    qs->response = NEW_ARRAY(struct pair_response, qs->n_pair);
    qs->changed = NEW_ARRAY(struct pair_rows, qs->n_pair);
    qs->matrix = stiffness_create(qs->n, qs->setup.fixed, qs->n_pair, qs->pair, NULL);
    qs->contacts =
        contact_solver_create(qs->matrix, qs->n_pair, qs->pair, qs->tangent,
                              has_splitting(qs) ? MOST_ROWS_WITH_FRICTION : MOST_ROWS);
}
