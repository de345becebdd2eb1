// SPDX-License-Identifier: GPL-3.0-or-later
// Which fields there are, and where each stands in the row of a cell.
#ifndef CRAQUELURE_SHEARSTATS_FIELD_KINDS_H
#define CRAQUELURE_SHEARSTATS_FIELD_KINDS_H

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

// What a field is a mean over: it is 0 in a cell that has none.
enum field_basis { OF_VOLUME, OF_GRAINS, OF_CONTACTS };

// One dataset each: its name, and its numbers in a cell (1, 3 or 9).
struct field_kind {
    const char *name; // "density"
    int width;
    enum field_basis basis;
};
extern const struct field_kind field_kinds[FIELD_KINDS];

// All fields of a cell stand in a row of fields_width numbers, a field from
// field_column on.
int field_column(enum field field);
int fields_width(void);

// VALUE (n_cell, fields_width); FILLED (n_cell) is 1 where there is mass, else all is
// 0.
struct fields {
    double *value;
    uint8_t *filled;
};

static inline const double *field_at(const struct fields *fields, int cell,
                                     enum field field)
{
    return fields->value + (size_t)cell * (size_t)fields_width() + field_column(field);
}

#endif
