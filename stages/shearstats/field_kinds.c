// SPDX-License-Identifier: GPL-3.0-or-later
// Names are those of the datasets below /fields. The order is that of `enum field`.
// Tensors have nine numbers also where they are symmetric, so that readers need no
// table of places.
#include "field_kinds.h"

const struct field_kind field_kinds[FIELD_KINDS] = {
    {"density", 1, OF_VOLUME},        {"volume_fraction", 1, OF_VOLUME},
    {"number_density", 1, OF_VOLUME}, {"momentum", 3, OF_VOLUME},
    {"velocity", 3, OF_GRAINS},       {"angular_velocity", 1, OF_GRAINS},
    {"contact_stress", 9, OF_VOLUME}, {"bridge_stress", 9, OF_VOLUME},
    {"kinetic_stress", 9, OF_VOLUME}, {"strain_rate", 9, OF_GRAINS},
    {"fabric", 9, OF_CONTACTS},       {"coordination", 1, OF_GRAINS},
    {"bridges", 1, OF_GRAINS},        {"contact_density", 1, OF_VOLUME},
    {"traction", 3, OF_VOLUME},       {"pressure", 1, OF_VOLUME},
    {"shear_stress", 1, OF_VOLUME},   {"shear_rate", 1, OF_GRAINS},
};

int field_column(enum field field)
{
    int column = 0;
    for (int k = 0; k < (int)field; k++)
        column += field_kinds[k].width;
    return column;
}

int fields_width(void)
{
    return field_column(FIELD_KINDS);
}
