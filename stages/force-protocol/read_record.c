// SPDX-License-Identifier: GPL-3.0-or-later
// Reads from a drying what forces need: steps and changes of saturation, which nodes
// gas touches from the beginning, and, for a field of suction, the pressures of the
// snapshots. Exits 65 where the drying lacks them, with the parameter of `dry` that
// records them.
//
//     steps and changes    artifact_get_drying
//     exposed (n_node)     /boundary_layer/node, else nodes on /summary/open_walls
//     snapshot_time (s)    /snapshots/time
//     rings                /rings and /ring_changes
//     pressure (s, n_node) /snapshots/liquid_pressure, Pa less that of the gas
// That rows are as many as they must be, and indices in range, the schema has checked
// when the artifact was opened. Optional datasets are asked for here.
#include "read_record.h"

#include "basics/memory.h"
#include "basics/status.h"

#include <stdlib.h>

// The nodes under the boundary layer. Artifacts of other programs need not have them:
// then those on the open walls.
static bool *find_exposed(const struct artifact *input, const struct network *network)
{
    bool *exposed = NEW_ARRAY(bool, network->n_node);
    if (artifact_has_dataset(input, "/boundary_layer/node")) {
        int n;
        int32_t *node = artifact_get(input, "/boundary_layer/node", &n);
        for (int k = 0; k < n; k++)
            exposed[node[k]] = true;
        free(node);
        return exposed;
    }
    const unsigned walls = (unsigned)artifact_get_number(input, "/summary/open_walls");
    for (int i = 0; i < network->n_node; i++)
        exposed[i] = network->node_walls[i] & walls;
    return exposed;
}

static void read_pressures(const struct artifact *input, struct liquid_record *record)
{
    static const char *const needed[] = {"/snapshots/liquid_pressure",
                                         "/snapshots/time"};
    for (int k = 0; k < 2; k++)
        if (!artifact_has_dataset(input, needed[k]))
            die(STATUS_BAD_DATA,
                "%s: %s: pressure=field needs it: dry with liquid=viscous and "
                "snapshots",
                input_name(input->path), needed[k]);
    record->pressure = artifact_get(input, needed[0], &record->n_snapshot);
    record->snapshot_time = artifact_get(input, needed[1], NULL);
    if (record->n_snapshot == 0)
        die(STATUS_BAD_DATA,
            "%s: %s: pressure=field needs at least one row: dry with snapshots",
            input_name(input->path), needed[0]);
}

static struct ring_record read_rings(const struct artifact *input)
{
    if (!artifact_has_rings(input))
        die(STATUS_BAD_DATA,
            "%s: /rings/throat: rings.left=drying needs it: dry with rings=isolated, "
            "joined or films",
            input_name(input->path));
    return artifact_get_rings(input);
}

struct liquid_record read_record(const struct artifact *input,
                                 const struct network *network, bool field, bool rings)
{
    struct liquid_record record = {.drying = artifact_get_drying(input),
                                   .exposed = find_exposed(input, network)};
    if (record.drying.n_step < 1)
        die(STATUS_BAD_DATA, "%s: /history/time: must have at least one row",
            input_name(input->path));
    if (field) read_pressures(input, &record);
    if (rings) record.rings = read_rings(input);
    return record;
}

void free_record(struct liquid_record *record)
{
    drying_record_free(&record->drying);
    ring_record_free(&record->rings);
    free(record->exposed);
    free(record->snapshot_time);
    free(record->pressure);
    *record = (struct liquid_record){0};
}
