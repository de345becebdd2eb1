// SPDX-License-Identifier: GPL-3.0-or-later
// Names are those of the datasets below /fields.
#include "field_kinds.h"

const struct field_kind field_kinds[FIELD_KINDS] = {
    {"density", 1},        {"volume_fraction", 1}, {"number_density", 1},
    {"momentum", 3},       {"velocity", 3},        {"angular_velocity", 1},
    {"contact_stress", 9}, {"bridge_stress", 9},   {"kinetic_stress", 9},
    {"strain_rate", 9},    {"fabric", 9},          {"coordination", 1},
    {"bridges", 1},        {"contact_density", 1}, {"traction", 3},
    {"pressure", 1},       {"shear_stress", 1},    {"shear_rate", 1}};

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
