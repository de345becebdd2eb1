// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/drawn_radii.h"

static const struct parameter rows[] = {DRAWN_RADII_ROWS(0), {0}};

// Of radii that are not drawn nothing may be asked: all must be as by default.
static enum status refuse_unused(const json_t *parameters, struct reason *reason)
{
    struct drawn_radii unused;
    json_t *defaults = parameters_fill(rows, NULL, "", &unused);
    const json_t *given = json_object_get(parameters, "throat_radius");
    enum status status = STATUS_OK;
    const char *key;
    json_t *fallback;
    json_object_foreach(json_object_get(defaults, "throat_radius"), key, fallback)
    {
        const json_t *value = json_object_get(given, key);
        if (status || json_equal(value, fallback)) continue;
        status = refuse(reason, STATUS_BAD_DATA,
                        "throat_radius.%s: must be left out with "
                        "throat_radius.distribution=network, got %g",
                        key, json_number_value(value));
    }
    json_decref(defaults);
    return status;
}

enum status give_radii(struct network *network, const struct drawn_radii *radii,
                       const json_t *parameters, struct reason *reason)
{
    if (radii->law == 0) return refuse_unused(parameters, reason);
    struct radius_distribution how = radii->how;
    how.law = (enum radius_law)(radii->law - 1);
    how.seed = (unsigned long)radii->seed;
    return draw_radii(network, &how, reason);
}
