// SPDX-License-Identifier: GPL-3.0-or-later
// Auxiliary grains only give the boundary layer its nodes: they are left out of what is
// written, and measured.
#pragma once

#include "geometry/porosity.h"

#include <stddef.h>

// PACKING without auxiliary grains and their bonds; the others keep their order. The
// caller frees it with packing_free. Bonds get the new numbers; the box stays.
struct packing without_auxiliary(const struct packing *packing);

// Copies to TO the values, of SIZE bytes each, of the grains of PACKING that are not
// auxiliary: FROM (n_particle).
void copy_without_auxiliary(const struct packing *packing, const void *from,
                            size_t size, void *to);

// The box of PACKING without the layers of auxiliary grains along its sides: these
// sides are where the other grains end, m. O(n_particle).
struct window box_without_auxiliary(const struct packing *packing);
