// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a packing: the numbers and curves of /summary and /structure, in the
// artifact and as JSON.
#pragma once

#include "artifacts/artifact.h"
#include "domain.h"
#include "geometry/porosity.h"

enum { MAX_ENTRIES = 32 };

// A number, or a curve, under its name in the schema of packings. Names are paths of
// datasets and attributes, as "/summary/porosity".
struct report_entry {
    const char *name;
    int count; // values; 0: a number
    double number;
    double *value; // (count), owned
};

// All entries, in the order in which they were added.
struct packing_report {
    int count;
    struct report_entry entry[MAX_ENTRIES];
};

// Measures PACKING in DOMAIN: everything but porosity and unbalanced ratio. CONTACTS
// are surfaces at most GAP radius sums apart. Two contacts hold a grain if it
// HAS_FRICTION; it needs more without. Measures without meaning for this packing are
// left out, such as the bulk porosity if walls are near everywhere. Bulk, slices and
// g(r) are taken in a box: for a cylinder or sphere the largest that lies within, for a
// ring, or where something is cut out, not at all. Freed with report_free. g(r) looks
// around 20,000 centres at most.
struct packing_report report_packing(const struct packing *packing,
                                     const struct domain *domain,
                                     const struct contacts *contacts, double gap,
                                     bool has_friction);

// Adds a number; NAME must last. One that is not finite is left out.
void report_number(struct packing_report *report, const char *name, double number);

// Writes all of it into the artifact. What the schema says are whole numbers becomes
// int64.
void report_put(const struct packing_report *report, struct artifact *artifact);

// Writes it as JSON to PATH ("-": standard output): {"summary": {...}, "structure":
// {...}, "reached": REACHED}; REACHED (taken over) is what the method says of its own
// end, or NULL.
void report_write(const struct packing_report *report, const char *path,
                  json_t *reached);

void report_free(struct packing_report *report);
