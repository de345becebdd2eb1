// SPDX-License-Identifier: GPL-3.0-or-later
// What each throat of a layer does to its grain, in closed form: one grain, anywhere in
// a box of its own.
#include "../../test.h"
#include "force-protocol/solid_angle_patches.h"
#include "tessellate/diagram.h"

#include <math.h>

static const struct vector lower = {-1, 2, 5}, upper = {2, 3.5, 9},
                           grain = {0.2, 2.75, 7.3};
static const double radius = 0.7;

static struct network layer(void)
{
    struct vector position = grain;
    double size = radius;
    const struct packing packing = {.n_particle = 1,
                                    .position = &position,
                                    .radius = &size,
                                    .lower = lower,
                                    .upper = upper};
    const struct tessellation how = {.power = true, .layer = true};
    struct network network;
    struct tessellation_report report;
    struct reason reason;
    if (tessellate(&packing, &how, &network, &report, &reason))
        fail_msg("%s", reason.text);
    assert_int_equal(network.n_throat, 4);
    return network;
}

// A throat as the grain sees it: its middle, the way out, and the directions between
// which it lies, with the angle growing from x to z.
struct view {
    struct vector middle, out;
    double length, from, to;
};

static struct view view_of(const struct network *network, int throat)
{
    const int32_t *ends = network->throat_nodes[throat];
    const struct vector a = subtract(network->node_position[ends[0]], grain);
    const struct vector b = subtract(network->node_position[ends[1]], grain);
    struct view view = {.middle = scale(0.5, add(a, b)),
                        .length = distance(a, b),
                        .from = atan2(a.z, a.x),
                        .to = atan2(b.z, b.x)};
    const bool upright = fabs(a.x - b.x) < 1e-12;
    view.middle.y = 0;
    view.out = upright ? (struct vector){a.x < 0 ? -1 : 1, 0, 0}
                       : (struct vector){0, 0, a.z < 0 ? -1 : 1};
    const double turn = remainder(view.to - view.from, 2 * M_PI);
    if (turn < 0) view.from = view.to;
    view.to = view.from + fabs(turn);
    return view;
}

// The integral of (cos, 0, sin) over the arc.
static struct vector arc(const struct view *view)
{
    return (struct vector){sin(view->to) - sin(view->from), 0,
                           cos(view->from) - cos(view->to)};
}

static void check(const struct patches *patches, int throat, struct vector wanted)
{
    for (int k = 0; k < patches->n; k++)
        if (patches->patch[k].throat == throat) {
            assert_true(distance(patches->patch[k].pull, wanted) < 1e-14);
            return;
        }
    fail_msg("throat %d does nothing", throat);
}

TEST(throats_of_one_grain)
{
    struct network network = layer();
    struct sectors sectors;
    struct reason reason;
    if (sectors_find(&network, &sectors, &reason)) fail_msg("%s", reason.text);
    struct patches form[FORM_ARCS + 1], lines = find_contact_lines(&sectors);
    for (enum form f = FORM_SOLID_ANGLE; f <= FORM_ARCS; f++)
        form[f] = find_patches(&sectors, f);
    for (int t = 0; t < network.n_throat; t++) {
        const struct view view = view_of(&network, t);
        const double square = radius * radius;
        check(&form[FORM_SOLID_ANGLE], t, scale(M_PI / 2 * square, arc(&view)));
        check(&form[FORM_ARCS], t, scale(square, arc(&view)));
        check(&form[FORM_FACES], t, scale((upper.y - lower.y) * view.length, view.out));
        check(&form[FORM_CENTRES], t, scale(square / norm(view.middle), view.middle));
        check(&lines, t, scale(2, view.out));
    }
    for (enum form f = FORM_SOLID_ANGLE; f <= FORM_ARCS; f++)
        patches_free(&form[f]);
    patches_free(&lines);
    sectors_free(&sectors);
    network_free(&network);
}
