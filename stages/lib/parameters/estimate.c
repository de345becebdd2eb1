// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameters/estimate.h"

#include "basics/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

json_t *rough(double value)
{
    char text[24];
    snprintf(text, sizeof text, "%.1e", value);
    return json_real(strtod(text, NULL));
}

void print_estimate(const struct cost *cost, const struct body_size *body)
{
    json_t *line =
        json_pack("{s:o,s:o,s:o,s:i,s:o}", "seconds", rough(cost->seconds), "mebibytes",
                  rough(cost->mebibytes), "disk_mebibytes", rough(cost->disk),
                  "threads", 1, "grains", json_integer(llround(body->grains)));
    if (body->throats > 0)
        json_object_set_new(line, "throats", json_integer(llround(body->throats)));
    if (body->loads > 0)
        json_object_set_new(line, "loads", json_integer(llround(body->loads)));
    if (cost->most > cost->least)
        json_object_update_new(
            line,
            json_pack("{s:[oo],s:s}", "range", rough(cost->least), rough(cost->most),
                      "note", "rough: steps or iterations are found only by running"));
    json_dumpf(line, stdout, JSON_COMPACT | JSON_REAL_PRECISION(6));
    putchar('\n');
    json_decref(line);
}

int end_with_estimate(struct invocation *invocation, const struct cost *cost,
                      const struct body_size *body)
{
    print_estimate(cost, body);
    invocation_free(invocation);
    return STATUS_OK;
}
