// SPDX-License-Identifier: GPL-3.0-or-later
// Network artifacts as stages that make or change networks write them.
#pragma once

#include "artifacts/artifact.h"

// Writes a network artifact, made from INPUT, to the output of the call: summary
// (coordination, void volume, and the length from before merging if there is one),
// ParaView view and provenance included. Exits as artifact_finish. NETWORK is not
// changed and stays the caller's; INPUT must still be open.
void write_network(const struct network *network, const struct invocation *invocation,
                   const struct artifact *input, const char *model);

// The same for one made from anything: INPUTS are their digests, taken over. MODEL is
// what was modelled and left out, for the provenance.
void write_network_of(const struct network *network,
                      const struct invocation *invocation, json_t *inputs,
                      const char *model);

// What they put into a network artifact, for who puts in more: datasets, summary and
// ParaView view. The caller creates ARTIFACT and finishes it.
void put_network_with_summary(struct artifact *artifact, const struct network *network);
