// SPDX-License-Identifier: GPL-3.0-or-later
// Patterns as JSON: what pictures are drawn from, one object for each run, in the order
// of the runs. Lengths in m, areas in m2. `damage`, `polygon` and `opened` have one
// number for each column, along x, then y (columns.h); `polygon` is -1 in cracks and
// crumbs, `opened` null where the damage never passed the threshold of the end. Where
// there is no pattern, `none` says why, `areas` is empty, and `polygon` is empty or has
// no number but -1; damage, threshold and stages are there all the same.
#include "report.h"

#include <math.h>

static json_t *numbers(const double *value, int n)
{
    json_t *list = json_array();
    for (int k = 0; k < n; k++)
        json_array_append_new(list, json_value(value[k]));
    return list;
}

static json_t *labels(const int *value, int n)
{
    json_t *list = json_array();
    for (int k = 0; value && k < n; k++)
        json_array_append_new(list, json_integer(value[k]));
    return list;
}

static json_t *stages(const struct pattern *pattern)
{
    json_t *list = json_array();
    for (int k = 0; k < pattern->n_stage; k++) {
        const struct pattern_stage *stage = &pattern->stage[k];
        json_array_append_new(list, json_pack("{s:o,s:i,s:o,s:o}", "saturation",
                                              json_value(stage->saturation), "polygons",
                                              stage->count, "crack_area",
                                              json_value(stage->crack_area), "largest",
                                              json_value(stage->largest)));
    }
    return list;
}

static json_t *pattern_json(const struct pattern *pattern)
{
    const struct columns *columns = &pattern->columns;
    const struct polygons *p = &pattern->polygons;
    return json_pack(
        "{s:o,s:o,s:o,s:[i,i],s:[o,o],s:o,s:o,s:o,s:o,s:o,s:o}", "none",
        p->none ? json_string(p->none) : json_null(), "height",
        json_value(columns->height), "diameter", json_value(columns->diameter),
        "columns", columns->count[0], columns->count[1], "edge",
        json_value(columns->edge[0]), json_value(columns->edge[1]), "threshold",
        json_value(p->threshold), "areas", numbers(p->area, p->count), "stages",
        stages(pattern), "damage", numbers(pattern->damage, columns->n), "polygon",
        labels(p->label, columns->n), "opened", numbers(pattern->opened, columns->n));
}

void report_patterns(json_t *report, const struct ensemble *ensemble)
{
    if (!ensemble->pattern) return;
    json_t *list = json_array();
    for (int r = 0; r < ensemble->n_run; r++)
        json_array_append_new(list, pattern_json(&ensemble->pattern[r]));
    json_object_set_new(report, "patterns", list);
}
