// SPDX-License-Identifier: GPL-3.0-or-later
// Rings in the drying artifact (run/ring_history.h):
//     /rings        (n_ring) face, separation; (n_ring + 1) offset of
//                   (n_part) throat, volume: what each throat leaves
//     /ring_changes (n_step + 1) offset of (n_ring_change) node, saturation
//     /history/ring_saturation (n_step); with films film_evaporation, film_depth and
//                   film_deepest (run/film_history.h)
//     /summary      ring_saturation: what all throats leave; residual_saturation: what
//                   is there when the last throat has emptied; limited_throats
#include "write_rings.h"

#include "dry/run/film_history.h"
#include "dry/run/ring_history.h"

#include <limits.h>
#include <math.h>

// The step from which on all liquid is in rings; -1: never.
static int first_of_rings_alone(const struct drying_history *history)
{
    int step = history->n_step;
    while (step > 0 && history->clusters[step - 1] == 0)
        step--;
    return step < history->n_step ? step : -1;
}

static double left_by_all(const struct ring_history *rings)
{
    double sum = 0;
    for (int64_t k = 0; k < rings->offset[rings->n]; k++)
        sum += rings->volume[k];
    return sum;
}

static void put_films(struct artifact *artifact, const struct film_history *films,
                      int n_step)
{
    double deepest = 0;
    for (int k = 0; k < n_step; k++)
        deepest = fmax(deepest, films->deepest[k]);
    artifact_put(artifact, "/history/film_evaporation", films->evaporation, n_step);
    artifact_put(artifact, "/history/film_depth", films->depth, n_step);
    artifact_put(artifact, "/history/film_deepest", films->deepest, n_step);
    artifact_put_number(artifact, "/summary/film_evaporated", films->evaporated);
    artifact_put_number(artifact, "/summary/film_deepest", deepest);
    artifact_put_number(artifact, "/summary/film_solutions", (double)films->solutions);
}

void put_rings(struct artifact *artifact, const struct drying_history *history)
{
    const struct ring_history *rings = history->rings;
    const int n_step = history->n_step, n = rings->n;
    const int n_part = (int)rings->offset[n];
    const int n_change = (int)rings->change_offset[n_step];
    artifact_put(artifact, "/rings/face", rings->face, n);
    artifact_put(artifact, "/rings/separation", rings->separation, n);
    artifact_put(artifact, "/rings/offset", rings->offset, n + 1);
    artifact_put(artifact, "/rings/throat", rings->throat, n_part);
    artifact_put(artifact, "/rings/volume", rings->volume, n_part);
    artifact_put(artifact, "/ring_changes/offset", rings->change_offset, n_step + 1);
    artifact_put(artifact, "/ring_changes/node", rings->change_node, n_change);
    artifact_put(artifact, "/ring_changes/saturation", rings->change_saturation,
                 n_change);
    artifact_put(artifact, "/history/ring_saturation", rings->saturation, n_step);
    if (history->films) put_films(artifact, history->films, n_step);
    const int step = first_of_rings_alone(history);
    artifact_put_number(artifact, "/summary/ring_volume", left_by_all(rings));
    artifact_put_number(artifact, "/summary/limited_throats", rings->limited);
    if (step >= 0)
        artifact_put_number(artifact, "/summary/residual_saturation",
                            history->saturation[step]);
}
