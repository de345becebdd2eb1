// SPDX-License-Identifier: GPL-3.0-or-later
// Lists of the report are appended point by point; a model that has no suction or shape
// gives null for them, so that every report has the same keys. A table is made once for
// the bridge's radii and angles and evaluated in units of the effective radius [G 1].
//
//     gap = separation / scale,  force = surface tension scale table(volume, gap),
// with scale the effective radius and volume over its cube. `flags` says where a model
// is used outside its validity; the force is given nevertheless. Beyond rupture the
// exact model and the table give 0; the approximations go on with their formula.
// Negative separations are overlaps.
#include "curve.h"

#include "basics/memory.h"
#include "bridges/table.h"

#include <stdlib.h>

static const struct {
    unsigned flag;
    const char *word;
} words[] = {{BRIDGE_RUPTURED, "ruptured"},
             {BRIDGE_OVERLAPS, "overlaps"},
             {BRIDGE_ANGLE, "contact angle outside validity"},
             {BRIDGE_VOLUME, "volume outside validity"},
             {BRIDGE_UNEQUAL_ANGLES, "unequal contact angles averaged"}};

static json_t *flag_words(unsigned flags)
{
    json_t *list = json_array();
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (flags & words[k].flag)
            json_array_append_new(list, json_string(words[k].word));
    return list;
}

static void append(json_t *report, const char *name, json_t *value)
{
    json_t *list = json_object_get(report, name);
    if (!list) json_object_set_new(report, name, list = json_array());
    json_array_append_new(list, value);
}

static json_t *pair(const double of[2])
{
    return json_pack("[f,f]", of[0], of[1]);
}

static json_t *numbers(const double *values, int count)
{
    json_t *list = json_array();
    for (int k = 0; k < count; k++)
        json_array_append_new(list, json_real(values[k]));
    return list;
}

// {"height": [...], "radius": [...]}
static json_t *profile(const struct bridge *bridge, const struct bridge_state *state,
                       int count)
{
    double *height = NEW_ARRAY(double, count), *radius = NEW_ARRAY(double, count);
    bridge_profile(bridge, state, count, height, radius);
    json_t *object = json_pack("{s:o,s:o}", "height", numbers(height, count), "radius",
                               numbers(radius, count));
    free(height);
    free(radius);
    return object;
}

// STATE is NULL where there is no bridge.
static void append_state(json_t *report, const struct bridge *bridge,
                         const struct bridge_state *state, int places)
{
    append(report, "suction", state ? json_real(state->suction) : json_null());
    append(report, "neck_radius", state ? json_real(state->neck_radius) : json_null());
    append(report, "half_filling_angle",
           state ? pair(state->half_filling_angle) : json_null());
    append(report, "contact_radius", state ? pair(state->contact_radius) : json_null());
    append(report, "wetted_area", state ? pair(state->wetted_area) : json_null());
    append(report, "free_area", state ? json_real(state->free_area) : json_null());
    append(report, "energy", state ? json_real(state->energy) : json_null());
    if (places)
        append(report, "profile", state ? profile(bridge, state, places) : json_null());
}

static enum status append_exact(json_t *report, const struct bridge *bridge,
                                double separation, int places, struct reason *reason)
{
    struct bridge_state state;
    const enum status status = bridge_solve(bridge, separation, &state, reason);
    if (status && status != STATUS_NO) return status;
    unsigned flags = separation < 0 ? BRIDGE_OVERLAPS : 0;
    if (status == STATUS_NO) flags |= BRIDGE_RUPTURED;
    append(report, "force", json_real(status ? 0 : state.force));
    append(report, "flags", flag_words(flags));
    append_state(report, bridge, status ? NULL : &state, places);
    return STATUS_OK;
}

// Sets the keys that only the exact solution has to null where they are missing.
static void fill_in(json_t *report)
{
    static const char *const names[] = {
        "suction",        "neck_radius", "half_filling_angle",
        "contact_radius", "wetted_area", "free_area",
        "energy",         "profile"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (!json_object_get(report, names[k]))
            json_object_set_new(report, names[k], json_null());
}

static enum status append_table(json_t *report, const struct bridge *bridge,
                                const struct curve_request *request,
                                struct reason *reason)
{
    struct bridge_table *table;
    const enum status status =
        bridge_table_create(bridge->radius, bridge->contact_angle, &table, reason);
    if (status) return status;
    const double scale = bridge_effective_radius(bridge);
    const double volume = bridge_dimensionless_volume(bridge);
    const double rupture = bridge_table_rupture(table, volume);
    const bool inside = volume >= BRIDGE_TABLE_LEAST && volume <= BRIDGE_TABLE_MOST;
    for (int k = 0; k < request->count; k++) {
        const double gap = request->separation[k] / scale;
        const double force = bridge_table_force(table, volume, gap);
        append(report, "separation", json_real(request->separation[k]));
        append(report, "force", json_real(bridge->surface_tension * scale * force));
        append(report, "flags",
               flag_words((gap > rupture ? BRIDGE_RUPTURED : 0) |
                          (gap < 0 ? BRIDGE_OVERLAPS : 0) |
                          (inside ? 0 : BRIDGE_VOLUME)));
    }
    bridge_table_free(table);
    return STATUS_OK;
}

enum status put_curve(json_t *report, const struct bridge *bridge,
                      enum bridge_model model, const struct curve_request *request,
                      struct reason *reason)
{
    if (model == BRIDGE_TABLE) {
        const enum status status = append_table(report, bridge, request, reason);
        fill_in(report);
        return status;
    }
    for (int k = 0; k < request->count; k++) {
        const double separation = request->separation[k];
        append(report, "separation", json_real(separation));
        if (model == BRIDGE_EXACT) {
            const enum status status =
                append_exact(report, bridge, separation, request->profile, reason);
            if (status) return status;
            continue;
        }
        unsigned flags;
        const double force = bridge_model_force(bridge, model, separation, &flags);
        append(report, "force", json_real(force));
        append(report, "flags", flag_words(flags));
    }
    fill_in(report);
    return STATUS_OK;
}
