// SPDX-License-Identifier: GPL-3.0-or-later
// Grains from files of other programs.
#pragma once

#include "domain.h"
#include "parameters.h"
#include "parameters/stage.h"

// Reads the grains of INPUT (standard input where none is named), scaled to m by
// import_scale, and what bounds them as *DOMAIN and in the packing; appends their
// provenance to INPUTS. UNIT: m that INPUT says its lengths are in, where they were
// taken for metres; else 0. Grains keep their bonds if INPUT is a packing. Ends the
// program: 65 for a domain that cannot be, for sides that cross and for grains that
// cannot be read, 66 for no input. The caller frees the packing.
struct packing make_import(const struct invocation *invocation,
                           const struct pack_parameters *parameters, json_t *inputs,
                           struct domain *domain, double *unit);
