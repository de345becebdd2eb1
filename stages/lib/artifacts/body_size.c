// SPDX-License-Identifier: GPL-3.0-or-later
#include "artifacts/body_size.h"

#include "artifacts/artifact.h"
#include "basics/status.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

// 0: it has no such dataset.
static double rows_of(const struct artifact *artifact, const char *name)
{
    if (!artifact_has_dataset(artifact, name)) return 0;
    int rows;
    free(artifact_get(artifact, name, &rows));
    return rows;
}

static double nodes_on(const struct artifact *artifact, unsigned walls)
{
    int nodes, count = 0;
    uint8_t *kind = artifact_get(artifact, "/nodes/kind", &nodes);
    for (int i = 0; i < nodes; i++)
        count += (kind[i] & walls) != 0;
    free(kind);
    return count;
}

// Throats that merging leaves by default: in lattices nodes coincide.
static double throats_with_length(const struct artifact *artifact)
{
    int n;
    double *length = artifact_get(artifact, "/throats/length", &n);
    double all = 0, count = 0;
    for (int t = 0; t < n; t++)
        all += length[t];
    for (int t = 0; t < n; t++)
        count += length[t] > 1e-6 * all / n;
    free(length);
    return count;
}

static struct body_size size_of(const struct artifact *artifact, unsigned open_walls)
{
    struct body_size body = body_of_grains(rows_of(artifact, "/particles/radius"));
    if (artifact_has_dataset(artifact, "/throats/radius")) {
        body.unmerged = rows_of(artifact, "/throats/radius");
        body.throats = throats_with_length(artifact);
        if (open_walls) body.face = nodes_on(artifact, open_walls);
    }
    body.changes = rows_of(artifact, "/changes/throat");
    body.loads = rows_of(artifact, "/time");
    return body;
}

struct body_size input_size(const struct invocation *invocation, unsigned open_walls)
{
    if (invocation->n_input) {
        struct artifact *artifact = artifact_open(invocation->inputs[0], NULL);
        const struct body_size body = size_of(artifact, open_walls);
        artifact_close(artifact);
        return body;
    }
    if (!(invocation->grains > 0))
        die(STATUS_USAGE,
            "--estimate: name an input, or a number of grains, as --estimate=1000");
    struct body_size body = body_of_grains(invocation->grains);
    if (invocation->throats > 0) body = body_with_throats(body, invocation->throats);
    if (open_walls) body.face *= __builtin_popcount(open_walls);
    body.loads = invocation->loads;
    return body;
}
