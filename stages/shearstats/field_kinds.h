// SPDX-License-Identifier: GPL-3.0-or-later
// Which fields there are, and where each stands in the row of a cell. Units, in this
// order of `enum field`: kg/m3, 1, 1/m3, kg/(m2 s), m/s, 1/s, Pa three times, 1/s, 1
// (fabric, coordination, bridges a grain), 1/m3, N/m3, Pa, Pa, 1/s. Compression is
// positive. What each is, in terms of the sums, stands in fields.c.
//
// A new field is a line in the enum, one in field_kinds.c, one in fields.c and a
// dataset in schemas/shearstats.json.
#pragma once

#include <stddef.h>
#include <stdint.h>

enum field {
    FIELD_DENSITY,
    FIELD_FRACTION,
    FIELD_NUMBER,
    FIELD_MOMENTUM,
    FIELD_VELOCITY,
    FIELD_ANGULAR_VELOCITY,
    FIELD_CONTACT_STRESS,
    FIELD_BRIDGE_STRESS,
    FIELD_KINETIC_STRESS,
    FIELD_STRAIN_RATE,
    FIELD_FABRIC,
    FIELD_COORDINATION,
    FIELD_BRIDGES,
    FIELD_CONTACTS,
    FIELD_TRACTION,
    FIELD_PRESSURE,
    FIELD_SHEAR_STRESS,
    FIELD_SHEAR_RATE,
    FIELD_KINDS
};

// What a field is a mean over: it is 0 in a cell that has none. A mean over runs leaves
// those runs out that have none.
enum field_basis { OF_VOLUME, OF_GRAINS, OF_CONTACTS };

// One dataset each: its name, and its numbers in a cell (1, 3 or 9).
struct field_kind {
    const char *name; // "density"
    int width;
    enum field_basis basis;
};
extern const struct field_kind field_kinds[FIELD_KINDS];

// All fields of a cell stand in a row of fields_width numbers, a field from
// field_column on. Both add up the widths of the table: O(FIELD_KINDS), small beside
// what a cell costs.
int field_column(enum field field);
int fields_width(void);

// VALUE (n_cell, fields_width); FILLED (n_cell) is 1 where there is mass; elsewhere
// what is per mass or per grain is 0, but not stresses, because contacts reach into
// such cells. Cells are numbered as in grid.h. Free with fields_free.
struct fields {
    double *value;
    uint8_t *filled;
};

// The first of the field's numbers; tensors are row-major, (3, 3) in the components of
// the frame.
static inline const double *field_at(const struct fields *fields, int cell,
                                     enum field field)
{
    return fields->value + (size_t)cell * (size_t)fields_width() + field_column(field);
}
