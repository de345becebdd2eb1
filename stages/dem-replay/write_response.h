// SPDX-License-Identifier: GPL-3.0-or-later
// A response as an artifact. The datasets and their shapes stand at the top of
// write_response.c, their rules in schemas/response.json.
#pragma once

#include "artifacts/artifact.h"
#include "replay.h"

// Puts cracks, history, contacts and snapshots into a response artifact. PACKING must
// be that of the replay, with its bonds; the caller adds the weight (put_weight), the
// engine's state and the provenance, and finishes the artifact. Ends the program on
// failure. LOAD gives cracks and snapshots their times. Memory: tables of snapshots by
// pairs, (n_snapshot, n_contact).
void put_response(struct artifact *artifact, const struct packing *packing,
                  const struct load *load, const struct replay_settings *settings,
                  const struct response *response);

// Puts the N bonds CRACK and how they broke as the datasets bond and mode of GROUP.
void put_bonds_and_modes(struct artifact *artifact, const char *group,
                         const struct dem_crack *crack, int n);
