// SPDX-License-Identifier: GPL-3.0-or-later
// The findings, for people and for programs.
#pragma once

#include "bonds.h"
#include "suggest.h"

// All that was found out; it owns nothing. Both outputs are made from it and from
// nothing else, so that they say the same. PACKING has no auxiliary grains; FACTS,
// BONDS and CONTACTS are of it, with rows and numbers of the input. MATERIAL is only
// for what is suggested. FINDINGS come sorted, the worst first.
struct checked {
    const struct packing *packing;
    const struct contacts *contacts;
    const struct packing_facts *facts;
    const struct bond_facts *bonds;
    const struct findings *findings;
    const struct bond_numbers *weight;
    const struct material *material;
};

// Number of findings worse than a note. The exit status of check depends on it.
int count_wrong(const struct findings *findings);

// Prints a line for each finding to standard output, then the measurements, and if no
// finding is WRONG the suggestions. WRONG: from count_wrong.
void tell(const struct checked *checked, int wrong);

// The same as a document of schemas/check.json; the caller owns it. Suggestions and
// cost are null if WRONG is not 0.
json_t *checked_json(const struct checked *checked, int wrong);
