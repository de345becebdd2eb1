// SPDX-License-Identifier: GPL-3.0-or-later
// From artifacts to struct run and struct liquid. A schema checks types, shapes, ranges
// and order of rows; here is checked what relates datasets to each other (65, with the
// dataset and row):
//     /cracks/bond    no bond breaks twice, nor after the weight or an earlier replay
//                     broke it;
//     /cracks/time    none after the end, the last row of /history/time;
//     /history/settled   is there if loads did not come to rest;
//     /history/time      of a drying: has a row.
// A crack belongs to the load whose time is the first that is not before its own. Both
// rise, so one walk along them counts the cracks under loads that did not come to rest;
// it needs check_cracks to have passed, or it would walk beyond the last load.
//
// Optional: /particles/held, /snapshots/dryness (NULL: not known).
#include "read.h"

#include "artifacts/cracks.h"
#include "basics/memory.h"
#include "basics/status.h"

#include <stdlib.h>

// Responses of dem-replay before version 45 say how many loads did not come to rest,
// not which.
static void read_unsettled(struct run *run, const struct artifact *response,
                           const double *time, int n_time)
{
    if (!artifact_has_dataset(response, "/history/settled")) {
        if (artifact_get_number(response, "/summary/steps_unsettled") > 0)
            die(STATUS_BAD_DATA,
                "%s: /history/settled: is not there, and some loads did not come to "
                "rest: replay it with this dem-replay",
                input_name(response->path));
        return;
    }
    if (n_time == 0 && run->n_crack > 0)
        die(STATUS_BAD_DATA, "%s: /history/time: has no row, and there are cracks",
            input_name(response->path));
    uint8_t *settled = artifact_get(response, "/history/settled", NULL);
    for (int k = 0; k < n_time; k++)
        run->n_unsettled += !settled[k];
    for (int k = 0, step = 0; k < run->n_crack; k++) {
        while (time[step] < run->time[k])
            step++; // never past the last: no crack is later
        run->n_unsettled_crack += !settled[step];
    }
    free(settled);
}

// Bonds never heal, and nothing breaks after the end.
static void check_cracks(const struct run *run, const char *path)
{
    uint8_t *holds = bonds_before(run);
    int k = 0;
    while (k < run->n_crack && run->time[k] <= run->end && holds[run->bond[k]]--)
        k++;
    free(holds);
    if (k == run->n_crack) return;
    if (run->time[k] > run->end)
        die(STATUS_BAD_DATA,
            "%s: /cracks/time: row %d: must not be after the end of /history/time, %g "
            "s, got %g",
            input_name(path), k, run->end, run->time[k]);
    die(STATUS_BAD_DATA, "%s: /cracks/bond: row %d: bond %d has broken before",
        input_name(path), k, run->bond[k]);
}

struct run read_run(const struct artifact *response)
{
    struct cracks cracks = artifact_get_cracks(response);
    struct run run = {.packing = artifact_get_packing(response),
                      .n_crack = cracks.n,
                      .bond = cracks.bond,
                      .time = cracks.time,
                      .saturation = cracks.saturation,
                      .mode = cracks.mode,
                      .n_before = cracks.n_before,
                      .before = cracks.bond_before};
    free(cracks.mode_before);
    if (artifact_has_dataset(response, "/particles/held"))
        run.held = artifact_get(response, "/particles/held", NULL);
    run.first_period_end =
        artifact_get_number(response, "/summary/first_period_end_time");
    int n_time;
    double *time = artifact_get(response, "/history/time", &n_time);
    run.end = n_time ? time[n_time - 1] : 0;
    check_cracks(&run, response->path);
    run.snapshot_saturation =
        artifact_get(response, "/snapshots/saturation", &run.n_snapshot);
    run.displacement = artifact_get(response, "/snapshots/displacement", NULL);
    run.intact = artifact_get(response, "/snapshots/bond_intact", NULL);
    if (artifact_has_dataset(response, "/snapshots/dryness"))
        run.dryness = artifact_get(response, "/snapshots/dryness", NULL);
    read_unsettled(&run, response, time, n_time);
    free(time);
    return run;
}

struct liquid read_liquid(const struct artifact *drying)
{
    struct liquid liquid = {.network = artifact_get_periodic_network(drying),
                            .record = artifact_get_drying(drying),
                            .first_period_end = artifact_get_number(
                                drying, "/summary/first_period_end_time")};
    if (liquid.record.n_step < 1)
        die(STATUS_BAD_DATA, "%s: /history/time: must have at least one row",
            input_name(drying->path));
    return liquid;
}
