// SPDX-License-Identifier: GPL-3.0-or-later
#include "loose.h"

#include "basics/memory.h"

#include <stdlib.h>

struct loose_grains loose_new(int n)
{
    return (struct loose_grains){.fragments = fragments_new(n),
                                 .is_loose = NEW_ARRAY(bool, n)};
}

void loose_free(struct loose_grains *loose)
{
    fragments_free(&loose->fragments);
    free(loose->is_loose);
}

static void find_fragments_of(struct fragments *fragments,
                              const struct packing *packing, const uint8_t *held,
                              const struct dem *dem)
{
    uint8_t *intact = NEW_ARRAY(uint8_t, packing->n_bond);
    dem_bonds_intact(dem, intact);
    fragments_begin(fragments);
    for (int b = 0; b < packing->n_bond; b++)
        if (intact[b])
            fragments_join(fragments, packing->bond[b][0], packing->bond[b][1]);
    fragments_end(fragments, held, NULL);
    free(intact);
}

void find_loose(struct loose_grains *loose, const struct packing *packing,
                const uint8_t *held, const struct dem *dem)
{
    const struct fragments *fragments = &loose->fragments;
    find_fragments_of(&loose->fragments, packing, held, dem);
    loose->n_loose = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        loose->is_loose[i] = !fragments->is_held[fragments->of[i]];
        if (loose->is_loose[i] && loose->n_loose++ == 0) loose->first_one = i;
    }
}
