// SPDX-License-Identifier: GPL-3.0-or-later
// Grains of another maker.
#ifndef CRAQUELURE_PACK_IMPORT_H
#define CRAQUELURE_PACK_IMPORT_H

#include "domain.h"
#include "parameters.h"
#include "parameters/stage.h"

// Those of INPUT, in the units of the parameters, and the box they lie in as DOMAIN;
// INPUTS gets what the provenance says of it. Exits 65 and 66. The caller frees it.
struct packing make_import(const struct invocation *invocation,
                           const struct pack_parameters *parameters, json_t *inputs,
                           struct domain *domain);

#endif
