// SPDX-License-Identifier: GPL-3.0-or-later
// Frames over time, one function for each kind of artifact: throats and their
// saturation (drying), forces on the grains (forces), moved grains and their contacts
// (response, motion).
//
// A drying is replayed from step to step; a frame is written at the first step at or
// below each of n evenly spaced saturations, so fast changes take fewer frames than n.
// Of forces, rows frame (n_time - 1) / (n_frame - 1) are taken. In a response positions
// are those before drying plus displacements, radii those of grains that have shrunk so
// far, and a contact is whole until the time of its crack has come. A contact across a
// side that repeats is a line from a grain to itself, as a throat there is.
//
//     kind      points              lines              arrays
//     drying    nodes               throats            saturation, radius, kind
//               grains              rings              volume; in files of their own
//     forces    grains              none               force, radius
//     response  grains, moved       contacts           displacement, force, radius;
//                                                      contact_force, crack, and of
//                                                      bridges volume, force, gap
//     motion    grains, in the box  contacts of each   velocity, spin, radius, group;
//                                   snapshot           force
#include "series.h"

#include "artifacts/cracks.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "frames.h"
#include "geometry/neighbours.h"
#include "ring_frames.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// VTK arrays here are of doubles. The caller frees them.
static double *as_doubles(const uint8_t *values, int count)
{
    double *doubles = NEW_ARRAY(double, count);
    for (int k = 0; k < count; k++)
        doubles[k] = values[k];
    return doubles;
}

// Frames are evenly spaced from full to dry.
static double frame_saturation(int frame, int n_frame)
{
    return 1 - (double)frame / (n_frame > 1 ? n_frame - 1 : 1);
}

// A drying at the step that it has come to: SATURATION (n_throat) of the throats, to
// which GRID points, and their rings, if it has any.
struct drying_view {
    const struct drying_record *record;
    double *saturation;
    struct vtu_grid grid;
    struct frames *frames;
    struct ring_frames *rings; // NULL: none
};

static void take_step(struct drying_view *view, int step)
{
    apply_changes(view->record, step, view->saturation);
    if (view->rings) ring_frames_step(view->rings, step);
}

static void add_frames(struct drying_view *view, int step)
{
    const double time = view->record->time[step];
    add_frame(view->frames, time, &view->grid);
    if (view->rings) ring_frames_add(view->rings, time, view->saturation);
}

// A step may pass several levels at once: then one frame stands for all of them.
static void follow_drying(struct drying_view *view, int n_frame)
{
    for (int step = 0, frame = 0; step < view->record->n_step; step++) {
        const double saturation = view->record->saturation[step];
        take_step(view, step);
        if (saturation > frame_saturation(frame, n_frame)) continue;
        add_frames(view, step);
        while (frame < n_frame && saturation <= frame_saturation(frame, n_frame))
            frame++;
        if (frame == n_frame) break;
    }
}

static void drying_series(const struct artifact *artifact, struct frames *frames,
                          int n_frame)
{
    struct network network = artifact_get_periodic_network(artifact);
    int32_t(*drawn)[2] = drawn_throats(&network);
    struct drying_record record = artifact_get_drying(artifact);
    double *saturation = full_saturations(&network);
    double *kind = as_doubles(network.throat_kind, network.n_throat);
    const struct vtu_array cells[] = {{"saturation", saturation, 1, NULL},
                                      {"radius", network.throat_radius, 1, NULL},
                                      {"kind", kind, 1, NULL},
                                      {0}};
    struct drying_view view = {.record = &record,
                               .saturation = saturation,
                               .grid = {.n_point = network.n_node,
                                        .point = network.node_position,
                                        .n_line = network.n_throat,
                                        .line = (const int32_t(*)[2])drawn,
                                        .cells = cells,
                                        .shown = "saturation"},
                               .frames = frames};
    char prefix[4096];
    snprintf(prefix, sizeof prefix, "%s-rings", frames->prefix);
    struct ring_frames rings;
    if (artifact_has_rings(artifact)) {
        rings = ring_frames_begin(artifact, &network, prefix);
        view.rings = &rings;
    }
    follow_drying(&view, n_frame);
    if (view.rings) ring_frames_end(view.rings);
    drying_record_free(&record);
    free(saturation);
    free(kind);
    free(drawn);
    network_free(&network);
}

// Force on the grains. The first and the last row are always taken.
static void forces_series(const struct artifact *artifact, struct frames *frames,
                          int n_frame)
{
    struct packing packing = artifact_get_packing(artifact);
    int n_time;
    double *time = artifact_get(artifact, "/time", &n_time);
    struct vector *force = artifact_get(artifact, "/force", NULL);
    for (int frame = 0; frame < n_frame && n_time > 0; frame++) {
        const int m =
            n_frame > 1 ? (int)((int64_t)frame * (n_time - 1) / (n_frame - 1)) : 0;
        const struct vtu_array points[] = {
            {"force", &force[(size_t)m * (size_t)packing.n_particle].x, 3, NULL},
            {"radius", packing.radius, 1, NULL},
            {0}};
        add_frame(frames, time[m],
                  &(struct vtu_grid){.n_point = packing.n_particle,
                                     .point = packing.position,
                                     .points = points,
                                     .shown = "force"});
    }
    free(time);
    free(force);
    packing_free(&packing);
}

// Cracks so far: per contact -1 no bond, 0 whole, 1 normal crack, 2 shear crack.
struct crack_view {
    int n_contact;
    int32_t (*contact)[2];
    struct cracks cracks;
    double *state; // (n_contact)
};

// Reads what the view needs; the caller frees it with crack_view_free.
static struct crack_view crack_view_of(const struct artifact *artifact)
{
    struct crack_view view = {.cracks = artifact_get_cracks(artifact)};
    view.contact = artifact_get(artifact, "/contacts/particles", &view.n_contact);
    view.state = NEW_ARRAY(double, view.n_contact);
    return view;
}

static void crack_view_free(struct crack_view *view)
{
    cracks_free(&view->cracks);
    free(view->contact);
    free(view->state);
}

// Contacts are sorted by their grains; a bond of grains that never touched has none.
static int contact_of_bond(const struct crack_view *view, const int32_t bond[2])
{
    if (!view->n_contact) return -1;
    const int32_t(*found)[2] = bsearch(bond, view->contact, (size_t)view->n_contact,
                                       sizeof *view->contact, compare_pairs);
    return found ? (int)(found - (const int32_t(*)[2])view->contact) : -1;
}

static void mark_broken(struct crack_view *view, const int32_t bond[2], int mode)
{
    const int c = contact_of_bond(view, bond);
    if (c >= 0) view->state[c] = 1 + mode;
}

// From the start each time: frames are few.
static void update_cracks(struct crack_view *view, const struct packing *packing,
                          double time)
{
    for (int c = 0; c < view->n_contact; c++)
        view->state[c] = -1;
    for (int b = 0; b < packing->n_bond; b++) {
        const int c = contact_of_bond(view, packing->bond[b]);
        if (c >= 0) view->state[c] = 0;
    }
    const struct cracks *cracks = &view->cracks;
    for (int k = 0; k < cracks->n; k++)
        if (cracks->time[k] <= time)
            mark_broken(view, packing->bond[cracks->bond[k]], cracks->mode[k]);
    for (int k = 0; k < cracks->n_before; k++) // by earlier replays, or the weight
        mark_broken(view, packing->bond[cracks->bond_before[k]],
                    cracks->mode_before[k]);
}

// Whether the way APART between grains that touch leads across a side that repeats.
static bool is_across(const struct packing *packing, struct vector apart)
{
    return norm(subtract(shortest_image(packing, apart), apart)) > 0;
}

// The contacts as lines between grains that lie at MOVED: across a side that repeats
// both ends are the first grain.
static void draw_contacts(const struct packing *packing, const struct vector *moved,
                          const struct crack_view *view, int32_t (*line)[2])
{
    for (int c = 0; c < view->n_contact; c++) {
        const int32_t *pair = view->contact[c];
        const struct vector apart = subtract(moved[pair[1]], moved[pair[0]]);
        line[c][0] = pair[0];
        line[c][1] = pair[is_across(packing, apart) ? 0 : 1];
    }
}

// Radii of grains that have shrunk by STRAIN; NULL: not at all.
static void shrink(const struct packing *packing, const double *strain, double *radius)
{
    for (int i = 0; i < packing->n_particle; i++)
        radius[i] = packing->radius[i] * (strain ? 1 - strain[i] : 1);
}

// Displacements of the grains; forces, cracks and liquid bridges at the contacts.
// Contacts are those of all snapshots, with forces of 0 where one is open.
static void response_series(const struct artifact *artifact, struct frames *frames)
{
    static const char *const bridge_name[] = {
        "/snapshots/bridge_volume", "/snapshots/bridge_force", "/snapshots/bridge_gap"};
    struct packing packing = artifact_get_packing(artifact);
    const size_t n = (size_t)packing.n_particle;
    int n_snapshot;
    double *time = artifact_get(artifact, "/snapshots/time", &n_snapshot);
    struct vector *displacement =
        artifact_get(artifact, "/snapshots/displacement", NULL);
    struct vector *force = artifact_get(artifact, "/snapshots/force", NULL);
    struct vector *contact_force =
        artifact_get(artifact, "/snapshots/contact_force", NULL);
    double *bridge[3] = {NULL, NULL, NULL};
    const bool wet = artifact_has_dataset(artifact, bridge_name[0]);
    for (int k = 0; wet && k < 3; k++)
        bridge[k] = artifact_get(artifact, bridge_name[k], NULL);
    double *strain = NULL;
    if (artifact_has_dataset(artifact, "/snapshots/shrinkage"))
        strain = artifact_get(artifact, "/snapshots/shrinkage", NULL);
    struct crack_view view = crack_view_of(artifact);
    struct vector *moved = NEW_ARRAY(struct vector, n);
    double *radius = NEW_ARRAY(double, n);
    int32_t(*line)[2] = allocate((size_t)view.n_contact, sizeof *line);
    for (int s = 0; s < n_snapshot; s++) {
        const size_t at = (size_t)s * n;
        for (size_t i = 0; i < n; i++)
            moved[i] = add(packing.position[i], displacement[at + i]);
        update_cracks(&view, &packing, time[s]);
        draw_contacts(&packing, moved, &view, line);
        shrink(&packing, strain ? strain + at : NULL, radius);
        const struct vtu_array points[] = {
            {"displacement", &displacement[at].x, 3, NULL},
            {"force", &force[at].x, 3, NULL},
            {"radius", radius, 1, NULL},
            {0}};
        const size_t row = (size_t)s * (size_t)view.n_contact;
        const struct vtu_array cells[] = {
            {"contact_force", &contact_force[row].x, 3, NULL},
            {"crack", view.state, 1,
             "0 holds, 1 broken in tension, 2 in shear, -1 no bond"},
            {wet ? "bridge_volume" : NULL, wet ? bridge[0] + row : NULL, 1, NULL},
            {"bridge_force", wet ? bridge[1] + row : NULL, 1, NULL},
            {"bridge_gap", wet ? bridge[2] + row : NULL, 1, NULL},
            {0}};
        add_frame(frames, time[s],
                  &(struct vtu_grid){.n_point = packing.n_particle,
                                     .point = moved,
                                     .n_line = view.n_contact,
                                     .line = (const int32_t(*)[2])line,
                                     .points = points,
                                     .cells = cells,
                                     .shown = "crack"});
    }
    free(time);
    free(displacement);
    free(force);
    free(contact_force);
    for (int k = 0; k < 3; k++)
        free(bridge[k]);
    free(strain);
    free(moved);
    free(radius);
    free(line);
    crack_view_free(&view);
    packing_free(&packing);
}

// The image of X in the box, where that repeats.
static struct vector in_box(const struct packing *packing, struct vector x)
{
    for (int axis = 0; axis < 3; axis++) {
        if (!packing->periodic[axis]) continue;
        const double from = component(packing->lower, axis), at = component(x, axis);
        const double edge = component(packing->upper, axis) - from;
        set_component(&x, axis, at - edge * floor((at - from) / edge));
    }
    return x;
}

// The contacts between grains of a snapshot, without those with walls and around the
// box, which would be drawn across it; FORCE is moved along. Returns how many are left.
static int drawn_contacts(const struct packing *packing, const struct vector *at,
                          int64_t count, int32_t (*pair)[2], struct vector *force)
{
    int kept = 0;
    for (int64_t c = 0; c < count; c++) {
        const int32_t i = pair[c][0], j = pair[c][1];
        if (i < 0 || j < 0 || is_across(packing, subtract(at[j], at[i]))) continue;
        memmove(pair[kept], pair[c], sizeof *pair);
        force[kept++] = force[c];
    }
    return kept;
}

// Another program may have written the counts of contacts.
static void check_counts(const struct artifact *artifact, const int64_t *contacts,
                         int n_snapshot, int n_contact)
{
    int64_t left = n_contact;
    for (int s = 0; s < n_snapshot && left >= 0; s++)
        left -= contacts[s];
    if (left != 0)
        die(STATUS_BAD_DATA,
            "%s: /snapshots/contacts: must add up to the %d rows of /contacts",
            input_name(artifact->path), n_contact);
}

// Grains as they move, and the forces at their contacts. Positions are brought back
// into the box for the picture only.
static void motion_series(const struct artifact *artifact, struct frames *frames)
{
    struct packing packing = artifact_get_packing(artifact);
    const int n = packing.n_particle;
    int n_snapshot;
    double *time = artifact_get(artifact, "/snapshots/time", &n_snapshot);
    struct vector *lower = artifact_get(artifact, "/snapshots/box_lower", NULL);
    struct vector *upper = artifact_get(artifact, "/snapshots/box_upper", NULL);
    struct vector *position = artifact_get(artifact, "/snapshots/position", NULL);
    struct vector *velocity = artifact_get(artifact, "/snapshots/velocity", NULL);
    struct vector *spin = artifact_get(artifact, "/snapshots/spin", NULL);
    int64_t *contacts = artifact_get(artifact, "/snapshots/contacts", NULL);
    int n_contact;
    uint8_t *group_number = artifact_get(artifact, "/particles/group", NULL);
    double *group = as_doubles(group_number, n);
    int32_t(*pair)[2] = artifact_get(artifact, "/contacts/particles", &n_contact);
    check_counts(artifact, contacts, n_snapshot, n_contact);
    struct vector *force = artifact_get(artifact, "/contacts/force", NULL);
    int64_t first = 0;
    for (int64_t s = 0; s < n_snapshot; first += contacts[s], s++) {
        struct vector *at = position + s * n;
        packing.lower = lower[s];
        packing.upper = upper[s];
        for (int i = 0; i < n; i++)
            at[i] = in_box(&packing, at[i]);
        const int drawn =
            drawn_contacts(&packing, at, contacts[s], pair + first, force + first);
        const struct vtu_array points[] = {{"velocity", &velocity[s * n].x, 3, NULL},
                                           {"spin", &spin[s * n].x, 3, NULL},
                                           {"radius", packing.radius, 1, NULL},
                                           {"group", group, 1, "0: of none"},
                                           {0}};
        const struct vtu_array cells[] = {{"force", &force[first].x, 3, NULL}, {0}};
        add_frame(frames, time[s],
                  &(struct vtu_grid){.n_point = n,
                                     .point = at,
                                     .n_line = drawn,
                                     .line = (const int32_t(*)[2])(pair + first),
                                     .points = points,
                                     .cells = cells,
                                     .shown = "velocity"});
    }
    void *const owned[] = {time,     lower,        upper, position, velocity, spin,
                           contacts, group_number, group, pair,     force};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    packing_free(&packing);
}

// The .pvd comes last: whoever finds it finds all its frames.
void write_series(const struct artifact *artifact, const char *prefix, int n_frame)
{
    struct frames frames = {.prefix = prefix};
    const char *schema = artifact->schema->name;
    if (!strcmp(schema, "drying"))
        drying_series(artifact, &frames, n_frame);
    else if (!strcmp(schema, "forces"))
        forces_series(artifact, &frames, n_frame);
    else if (!strcmp(schema, "response"))
        response_series(artifact, &frames);
    else if (!strcmp(schema, "motion"))
        motion_series(artifact, &frames);
    else if (!strcmp(schema, "shearstats") || !strcmp(schema, "restart"))
        die(STATUS_BAD_DATA,
            "%s: has nothing for ParaView (%s): --data prints its datasets, h5py "
            "reads them",
            input_name(artifact->path), schema);
    else
        die(STATUS_BAD_DATA,
            "%s: nothing changes over time in a%s %s; ParaView opens it as it is, "
            "under a "
            "name that ends in .hdf",
            input_name(artifact->path), strcmp(schema, "invasion") ? "" : "n", schema);
    end_frames(&frames);
}
