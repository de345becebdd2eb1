// SPDX-License-Identifier: GPL-3.0-or-later
// Grains from files of other programs.
#ifndef CRAQUELURE_PACK_IMPORT_H
#define CRAQUELURE_PACK_IMPORT_H

#include "domain.h"
#include "parameters.h"
#include "parameters/stage.h"

// Reads the grains of the input, scaled to m, and the box they lie in as DOMAIN; adds
// its provenance to INPUTS. Exits 65 and 66. The caller frees the packing.
struct packing make_import(const struct invocation *invocation,
                           const struct pack_parameters *parameters, json_t *inputs,
                           struct domain *domain);

#endif
