// SPDX-License-Identifier: GPL-3.0-or-later
// Boundary conditions in the units of the computation: a flux Q becomes Q mu / unit^3.
//     axis that repeats:  gradient = -drop / edge;   between walls:  p = drop, then 0.
// Pressures stay in Pa: the flow is linear, so a viscosity of 1 in the solution and mu
// in the fluxes give the same pressures. NAN means that a wall has no such condition: a
// wall with neither lets nothing through. A wall takes one condition, and an axis along
// which the box repeats none, as it has no walls. Where the pressure falls along a
// wall, from box to box, the wall is open to fluid whose pressure falls alike, and a
// pressure imposed is that in the middle of the box; pressures of the computation count
// the gradient from its lower corner (p = value + gradient . x).
#include "conditions.h"

static const char *const wall_names[WALL_COUNT] = {"x_lower", "x_upper", "y_lower",
                                                   "y_upper", "z_lower", "z_upper"};

static struct conditions nothing(void)
{
    struct conditions conditions = {.gradient = {0, 0, 0}};
    for (int wall = 0; wall < WALL_COUNT; wall++)
        conditions.pressure[wall] = conditions.flux[wall] = NAN;
    return conditions;
}

struct conditions fall_along(const struct grains *grains, int axis, double drop)
{
    struct conditions conditions = nothing();
    if (grains->repeats[axis]) {
        set_component(&conditions.gradient, axis, -drop / component(grains->box, axis));
    } else {
        double *of_walls = conditions.pressure + (size_t)axis * 2;
        of_walls[0] = drop;
        of_walls[1] = 0;
    }
    return conditions;
}

enum status find_conditions(const struct grains *grains, const struct imposed *imposed,
                            double viscosity, struct conditions *conditions,
                            struct reason *reason)
{
    *conditions = imposed->along == ALONG_NONE
                      ? nothing()
                      : fall_along(grains, imposed->along, imposed->drop);
    const double middle = 0.5 * dot(conditions->gradient, grains->box);
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        const bool pressure = !isnan(imposed->pressure[wall]);
        const bool flux = !isnan(imposed->flux[wall]);
        if (!pressure && !flux) continue;
        const char *key = pressure ? "pressure" : "flux";
        if (grains->repeats[wall / 2])
            return refuse(reason, STATUS_BAD_DATA,
                          "flow.%s.%s: must be null where the box repeats", key,
                          wall_names[wall]);
        if (wall / 2 == imposed->along || (pressure && flux))
            return refuse(reason, STATUS_BAD_DATA,
                          "flow.%s.%s: must be null, for %s imposes something there",
                          key, wall_names[wall],
                          wall / 2 == imposed->along ? "flow.along" : "flow.flux");
        if (pressure) conditions->pressure[wall] = imposed->pressure[wall] - middle;
        if (flux)
            conditions->flux[wall] = imposed->flux[wall] * viscosity /
                                     (grains->unit * grains->unit * grains->unit);
    }
    return STATUS_OK;
}
