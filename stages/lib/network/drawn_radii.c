// SPDX-License-Identifier: GPL-3.0-or-later
// From the user's keys to throat_radius.c. `law` counts from 1, for 0 keeps the
// network's radii: enum radius_law is law - 1. `how.law` and `how.seed` are set here:
// keys fill an int and an int64_t.
//
// With law 0 a key that describes a draw would have no effect and is refused by its
// name: all must have their defaults, which the table gives when it is filled from
// nothing. So a key that says its default is let through.
//
// A normal law is cut at 0, as radii are positive, which shifts its mean and deviation
// (cut_normal in throat_radius.c). Who asked for 40 +- 30 nm gets another mean; from a
// thousandth on we say so, for each of two modes by itself.
#include "network/drawn_radii.h"

#include <stdio.h>
#include <string.h>

static const struct parameter rows[] = {DRAWN_RADII_ROWS(0), {0}};

// Adds one line to TEXT, or nothing where less than a thousandth is cut.
static void describe_cut(double mean, double deviation, char text[RADII_TEXT])
{
    static const double noticeable = 1e-3;
    double left = mean, spread = deviation;
    const double share = cut_normal(&left, &spread);
    const size_t used = strlen(text);
    if (share < noticeable) return;
    snprintf(text + used, RADII_TEXT - used,
             "throat radii: %.3g %% of the normal ones of %.4g +- %.4g m would not be "
             "above 0 and are drawn again, which leaves %.4g +- %.4g m\n",
             100 * share, mean, deviation, left, spread);
}

const char *describe_cut_radii(const struct drawn_radii *radii, char text[RADII_TEXT])
{
    const struct radius_distribution *how = &radii->how;
    const bool two_modes = radii->law == RADIUS_TWO_MODE + 1;
    text[0] = '\0';
    if (two_modes || radii->law == RADIUS_NORMAL + 1)
        describe_cut(how->mean, how->deviation, text);
    if (two_modes) describe_cut(how->second_mean, how->second_deviation, text);
    return text;
}

void report_cut_radii(const struct drawn_radii *radii)
{
    char text[RADII_TEXT], *rest = text;
    describe_cut_radii(radii, text);
    for (char *line; (line = strtok_r(rest, "\n", &rest));)
        report("%s; lognormal ones keep their mean and deviation", line);
}

enum status give_radii(struct network *network, const struct drawn_radii *radii,
                       const json_t *parameters, struct reason *reason)
{
    const struct unused_keys undrawn = {radii->law == 0, "throat_radius",
                                        "with throat_radius.distribution=network"};
    const enum status status = refuse_unused(rows, parameters, &undrawn, 1, reason);
    if (status || undrawn.unused) return status;
    struct radius_distribution how = radii->how;
    how.law = (enum radius_law)(radii->law - 1);
    how.seed = (unsigned long)radii->seed;
    return draw_radii(network, &how, reason);
}
