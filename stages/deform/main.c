// SPDX-License-Identifier: GPL-3.0-or-later
// deform: the network of grains that have moved.
//
// Inputs, in this order: a drying or a network; the response of the same grains, whose
// last snapshot says where they are; and perhaps a third, a network of these places.
// The first is read twice: `before` stays as it was, `after` gets the places of the
// response (take_places) and a box moved with them (move_box). Then one of three:
//     write_packing   write=packing: the moved grains alone, for tessellate;
//     replace         a third input: that network, with the liquid of the first (and
//                     with radii=carried its radii) carried over to it;
//     move            else: nodes, lengths, radii, volumes and conductances of `before`
//                     follow the grains; connections stay. If the moved grains have
//                     another diagram, nothing is written (status 1), but for
//                     on_change=keep.
//
// move needs this order: nodes first, as lengths and clearances are measured between
// them; then count_changed_nodes, as volumes and conductances are found anew from the
// faces only if these are still those of the diagram; liquid last, as it needs the new
// volumes. Only a drying has liquid; of a network none is known and none is written, so
// one with liquid is refused, as first input and as third.
//
// Written: a network with /throats/saturation and /summary/liquid_volume and
// expelled_volume (where liquid is known), changed_nodes and closed_throats; or a
// packing. Numbers that overflow are blamed on the response (check_moved).
#include "artifacts/artifact.h"
#include "artifacts/liquid.h"
#include "artifacts/write_network.h"
#include "basics/compensated.h"
#include "basics/memory.h"
#include "basics/sorted.h"
#include "basics/status.h"
#include "geometry/neighbours.h"
#include "liquid.h"
#include "map_radii.h"
#include "move.h"
#include "throats.h"

#include <gsl/gsl_errno.h>
#include <stdlib.h>
#include <string.h>

enum on_change { CHANGE_REFUSED, CHANGE_KEPT };

enum radii { RADII_ANEW, RADII_CARRIED };

enum what_to_write { WRITE_NETWORK, WRITE_PACKING };

struct deform_parameters {
    int clearance, on_change, write, radii;
};

static const struct parameter table[] = {
    {"throat_radius", PARAMETER_CHOICE, "1", "\"segment\"",
     offsetof(struct deform_parameters, clearance), .choices = "segment|line|beside",
     .text = "clearance that radii scale with, as in tessellate"},
    {"on_change", PARAMETER_CHOICE, "1", "\"refuse\"",
     offsetof(struct deform_parameters, on_change), .choices = "refuse|keep",
     .text = "if moved grains have another diagram: refuse writes nothing (exit status "
             "1), keep does not change the connections of the network"},
    {"radii", PARAMETER_CHOICE, "1", "\"anew\"",
     offsetof(struct deform_parameters, radii), .choices = "anew|carried",
     .text = "throat radii of a third input; anew: as it has them; carried, for drawn "
             "radii: each that of the nearest old throat, changed like its clearance"},
    {"write", PARAMETER_CHOICE, "1", "\"network\"",
     offsetof(struct deform_parameters, write), .choices = "network|packing",
     .text = "packing: the moved grains in their box, for tessellate"},
    {0}};

static const struct stage stage = {
    .name = "deform",
    .version = STAGE_VERSION,
    .summary = "deform -- the pore network of grains that have moved",
    .reads = "drying",
    .writes = "network",
    .most_inputs = 3,
    .parameters = table,
    .notes = "Inputs: a drying, whose final liquid is kept, or a network; the response "
             "of the same grains, whose last snapshot has their new positions; and, if "
             "these have another diagram, the network of these positions, to which the "
             "liquid is transferred."};

// ---- what is asked for --------------------------------------------------------------

// The inputs, and the network whose grains have their new places.
struct scene {
    const struct deform_parameters *parameters;
    const struct invocation *invocation;
    struct artifact *input, *response;
    struct network before, after;
};

// ---- input --------------------------------------------------------------------------

// The caller closes it. Exits 65: neither a drying nor a network.
static struct artifact *open_network(const char *path)
{
    struct artifact *input = artifact_open(path, NULL);
    const char *schema = input->schema->name;
    if (strcmp(schema, "network") && strcmp(schema, "drying"))
        die(STATUS_BAD_DATA, "%s: must be a drying or a network, is a %s",
            input_name(path), schema);
    return input;
}

// A response follows grains across the sides of a box that repeats, and tessellate puts
// them back. Shifts each grain by whole boxes along AXIS, so that it has moved from WAS
// like most others.
static void move_together(const struct vector *was, int axis, struct packing *packing)
{
    const int n = packing->n_particle;
    const double edge =
        component(packing->upper, axis) - component(packing->lower, axis);
    double *moved = NEW_ARRAY(double, n);
    for (int i = 0; i < n; i++)
        moved[i] = component(packing->position[i], axis) - component(was[i], axis);
    double *sorted = duplicate(moved, (size_t)n, sizeof *moved);
    qsort(sorted, (size_t)n, sizeof *sorted, rising_doubles);
    for (int i = 0; i < n; i++) {
        const double boxes = round((moved[i] - sorted[n / 2]) / edge);
        set_component(&packing->position[i], axis,
                      component(packing->position[i], axis) - boxes * edge);
    }
    free(sorted);
    free(moved);
}

// Where the grains were at the last snapshot of RESPONSE, in place of their places:
// displacements are from where the response itself began. If they have shrunk, also
// their radii then. Exits 65: other grains, by their number, or no snapshot.
static void take_places(const struct artifact *response, struct packing *packing)
{
    struct packing began = artifact_get_packing(response);
    const int n = packing->n_particle;
    if (began.n_particle != n)
        die(STATUS_BAD_DATA, "%s: /particles: has %d grains, but the network %d",
            input_name(response->path), began.n_particle, n);
    int n_snapshot;
    struct vector *displacement =
        artifact_get(response, "/snapshots/displacement", &n_snapshot);
    if (!n_snapshot)
        die(STATUS_BAD_DATA, "%s: /snapshots/displacement: must have at least one row",
            input_name(response->path));
    const struct vector *last = displacement + (size_t)(n_snapshot - 1) * (size_t)n;
    struct vector *was =
        duplicate(packing->position, (size_t)n, sizeof *packing->position);
    for (int i = 0; i < n; i++)
        packing->position[i] = add(began.position[i], last[i]);
    for (int axis = 0; axis < 3 && n > 0; axis++)
        if (packing->periodic[axis]) move_together(was, axis, packing);
    free(was);
    free(displacement);
    if (artifact_has_dataset(response, "/snapshots/shrinkage")) {
        double *shrinkage = artifact_get(response, "/snapshots/shrinkage", NULL);
        const double *strain = shrinkage + (size_t)(n_snapshot - 1) * (size_t)n;
        for (int i = 0; i < n; i++)
            packing->radius[i] = began.radius[i] * (1 - strain[i]);
        free(shrinkage);
    }
    packing_free(&began);
}

// Grains that flew apart may have taken the walls past each other.
static void check_box(const struct packing *after, const char *path)
{
    for (int axis = 0; axis < 3; axis++)
        if (!(component(after->lower, axis) < component(after->upper, axis)))
            die(STATUS_BAD_DATA,
                "%s: /snapshots/displacement: grains have moved so far that the walls "
                "%c beside them have changed sides",
                input_name(path), "xyz"[axis]);
    for (int k = 0; k < after->n_body; k++)
        if (!body_is_one(&after->body[k]))
            die(STATUS_BAD_DATA,
                "%s: /snapshots/displacement: grains have moved so far that nothing is "
                "left of /domain/bodies: row %d",
                input_name(path), k);
}

// ---- liquid -------------------------------------------------------------------------

// (n_throat) Of each throat at the end of a drying.
static double *last_saturations(const struct artifact *drying,
                                const struct network *network)
{
    struct drying_record record = artifact_get_drying(drying);
    double *saturation = full_saturations(network);
    for (int step = 0; step < record.n_step; step++)
        apply_changes(&record, step, saturation);
    for (int t = 0; t < network->n_throat; t++) // whatever a foreign one says
        if (network->throat_kind[t] != THROAT_NETWORK) saturation[t] = 0;
    drying_record_free(&record);
    return saturation;
}

struct liquid {
    double *saturation;      // (n_throat); NULL: none is known
    double volume, expelled; // m3
};

// What map_liquid gives where throats stay as they are.
static struct mapped_liquid keep_liquid(const struct network *before,
                                        const double *saturation)
{
    const int n = before->n_throat;
    struct mapped_liquid kept = {NEW_ARRAY(double, n),
                                 duplicate(saturation, (size_t)n, sizeof *saturation)};
    for (int t = 0; t < n; t++)
        kept.liquid[t] = saturation[t] * throat_volume(before, t);
    return kept;
}

// The walls through which DRYING let gas in, as bits of enum wall.
static unsigned open_walls(const struct artifact *drying)
{
    return (unsigned)artifact_get_number(drying, "/summary/open_walls");
}

// Puts CARRIED into throats of other volumes (redistribute_liquid), frees its arrays,
// and sums what has found room. The caller frees the saturations.
static struct liquid settle(const struct artifact *drying,
                            const struct network *network,
                            struct mapped_liquid *carried)
{
    struct liquid liquid = {.saturation = NEW_ARRAY(double, network->n_throat)};
    const struct held_liquid held = {carried->liquid, carried->saturation,
                                     open_walls(drying)};
    liquid.expelled = redistribute_liquid(network, &held, liquid.saturation);
    struct compensated sum = {0};
    for (int t = 0; t < network->n_throat; t++)
        compensated_add(&sum, liquid.saturation[t] * throat_volume(network, t));
    liquid.volume = compensated_value(sum);
    free(carried->liquid);
    free(carried->saturation);
    return liquid;
}

// -------------------------------------------------------------------------------------

// Schemas allow no larger numbers. That grains flew apart is the response's fault, so
// the message names that file.
static void check_moved(const struct network *network, const char *path)
{
    static const double largest = 1e150; // as the schemas have it
    bool fits = true;
    for (int i = 0; i < network->n_node; i++)
        fits &= norm(network->node_position[i]) <= largest;
    for (int t = 0; t < network->n_throat; t++)
        fits &= network->throat_radius[t] <= largest &&
                network->throat_length[t] <= largest &&
                throat_volume(network, t) <= largest;
    if (!fits)
        die(STATUS_BAD_DATA,
            "%s: /snapshots/displacement: the network of these grains overflows",
            input_name(path));
}

static void refuse_change(int changed, int n_node, const char *path)
{
    die(STATUS_NO,
        "%s: the grains have another diagram now, at %d of %d nodes: tessellate them "
        "again (write=packing), or on_change=keep",
        input_name(path), changed, n_node);
}

static void write_moved(const struct network *network, const struct liquid *liquid,
                        int changed, int closed, const struct scene *scene,
                        json_t *inputs)
{
    const struct invocation *invocation = scene->invocation;
    const struct liquid_properties told = artifact_get_liquid(scene->input);
    char model[700];
    snprintf(model, sizeof model,
             "%s\n"
             "%s\n"
             "%d nodes at which the grains would have another diagram by now\n",
             invocation->n_input > 2
                 ? "the network of the moved grains, as it was tessellated anew"
                 : "nodes where the grains around them are now, walls with the grains "
                   "beside them; radii as the clearance of the throats",
             liquid->saturation
                 ? "liquid kept: what volumes leave over fills the narrowest menisci, "
                   "what they are short of leaves the widest"
                 : "liquid: none known",
             changed);
    struct artifact *artifact = artifact_create("network", invocation->output);
    put_network_with_summary(artifact, network);
    artifact_put_liquid(artifact, &told);
    artifact_put_number(artifact, "/summary/changed_nodes", changed);
    artifact_put_number(artifact, "/summary/closed_throats", closed);
    if (liquid->saturation) {
        artifact_put(artifact, "/throats/saturation", liquid->saturation,
                     network->n_throat);
        artifact_put_number(artifact, "/summary/liquid_volume", liquid->volume);
        artifact_put_number(artifact, "/summary/expelled_volume", liquid->expelled);
    }
    artifact_finish(artifact, invocation, inputs, model);
}

static json_t *digests(const struct scene *scene)
{
    json_t *inputs = one_input(scene->input);
    json_array_append_new(inputs, input_digest(scene->response));
    return inputs;
}

static double *find_saturations(const struct scene *scene)
{
    if (strcmp(scene->input->schema->name, "drying")) return NULL;
    return last_saturations(scene->input, &scene->before);
}

// The network as it is connected. Nodes without a place on their round surface count as
// changed.
static void move(struct scene *scene)
{
    const struct deform_parameters *parameters = scene->parameters;
    const struct network *before = &scene->before;
    struct network *after = &scene->after;
    const char *path = scene->input->path;
    struct neighbour_grains around = find_neighbour_grains(before);
    struct reason reason;
    const int lost = move_nodes(before, &around, after);
    const int changed = lost + count_changed_nodes(before, &around, after);
    if (changed && parameters->on_change == CHANGE_REFUSED)
        refuse_change(changed, before->n_node, path);
    enum status status = move_throats(
        before, &around, (enum clearance)parameters->clearance, after, &reason);
    neighbour_grains_free(&around);
    if (!status) status = move_volumes(before, changed > 0, after, &reason);
    if (!status) status = move_shapes(before, changed > 0, after, &reason);
    if (status) die(status, "%s: %s", input_name(path), reason.text);
    check_moved(after, scene->response->path);

    struct liquid liquid = {0};
    double *saturation = find_saturations(scene);
    if (saturation) {
        struct mapped_liquid kept = keep_liquid(before, saturation);
        liquid = settle(scene->input, after, &kept);
    }
    write_moved(after, &liquid, changed, count_closed_throats(before, after), scene,
                digests(scene));
    free(saturation);
    free(liquid.saturation);
}

// The third input must be a network of the moved grains, in the same order.
static void check_same_grains(const struct scene *scene, const struct network *renewed,
                              const char *path)
{
    static const double same = 1e-9; // of a radius: tessellate rounds no more
    const struct packing *packing = &scene->after.packing;
    bool fits = renewed->packing.n_particle == packing->n_particle;
    for (int i = 0; i < packing->n_particle && fits; i++) {
        const struct vector off =
            subtract(renewed->packing.position[i], packing->position[i]);
        fits = norm(shortest_image(packing, off)) <= same * packing->radius[i];
    }
    if (!fits)
        die(STATUS_BAD_DATA,
            "%s: /particles/position: is not where the response has the grains now",
            input_name(path));
}

// Another network of the moved grains takes its place.
static void replace(struct scene *scene)
{
    struct artifact *third = artifact_open(scene->invocation->inputs[2], "network");
    refuse_saturation(third, "it gets the liquid of the first input: give the network "
                             "that tessellate or merge-nodes made of these grains");
    struct network renewed = artifact_get_periodic_network(third);
    check_same_grains(scene, &renewed, third->path);
    struct neighbour_grains around = find_neighbour_grains(&scene->before);
    struct liquid liquid = {0};
    double *saturation = find_saturations(scene);
    struct reason reason;
    if (scene->parameters->radii == RADII_CARRIED &&
        map_radii(&scene->before, &around, &scene->after.packing,
                  (enum clearance)scene->parameters->clearance, &renewed, &reason))
        die(STATUS_BAD_DATA, "%s: %s", input_name(third->path), reason.text);
    if (saturation) {
        struct mapped_liquid carried =
            map_liquid(&scene->before, &around, &scene->after.packing, saturation,
                       open_walls(scene->input), &renewed);
        liquid = settle(scene->input, &renewed, &carried);
    }
    neighbour_grains_free(&around);
    json_t *inputs = digests(scene);
    json_array_append_new(inputs, input_digest(third));
    write_moved(&renewed, &liquid, 0, 0, scene, inputs);
    free(saturation);
    free(liquid.saturation);
    network_free(&renewed);
    artifact_close(third);
}

// The moved grains alone. Porosity counts overlaps twice as solid; max_overlap is over
// the smaller radius; no force is known, so unbalanced_ratio is 0.
static void write_packing(const struct scene *scene)
{
    const struct packing *packing = &scene->after.packing;
    double solid = 0, overlap = 0;
    for (int i = 0; i < packing->n_particle; i++)
        solid += 4 * M_PI / 3 * pow(packing->radius[i], 3);
    int n;
    int32_t(*pair)[2] = neighbour_pairs(packing, 0, &n);
    for (int k = 0; k < n; k++) {
        const double a = packing->radius[pair[k][0]], b = packing->radius[pair[k][1]];
        const double apart = norm(nearest_image(packing, pair[k][0], pair[k][1]));
        overlap = fmax(overlap, (a + b - apart) / fmin(a, b));
    }
    free(pair);
    struct artifact *artifact = artifact_create("packing", scene->invocation->output);
    artifact_put_packing(artifact, packing);
    artifact_put_number(artifact, "/summary/porosity",
                        1 - solid / packing_domain_volume(packing));
    artifact_put_number(artifact, "/summary/max_overlap", overlap);
    artifact_put_number(artifact, "/summary/coordination",
                        packing->n_particle ? 2.0 * n / packing->n_particle : 0);
    artifact_put_number(artifact, "/summary/unbalanced_ratio", 0);
    artifact_put_vtk(artifact, "/particles/position", packing->n_particle,
                     (const char *const[]){"/particles/radius", NULL}, NULL, 0, NULL);
    artifact_finish(artifact, scene->invocation, digests(scene),
                    "grains where a replay has moved them, walls with those beside "
                    "them\n");
}

// The rings of moved grains are others, and a network has no place for what they hold.
static void refuse_rings(const struct artifact *input)
{
    static const char name[] = "/summary/ring_volume";
    if (artifact_has_number(input, name) && artifact_get_number(input, name) > 0)
        die(STATUS_BAD_DATA,
            "%s: /rings: the liquid in rings cannot go along with moved grains: dry "
            "with rings=none",
            input_name(input->path));
}

int main(int argc, char **argv)
{
    struct deform_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    gsl_set_error_handler_off(); // what fails is said by status
    if (invocation.n_input < 2)
        die(STATUS_USAGE, "two inputs: a drying or network, and a response");
    struct scene scene = {.parameters = &parameters,
                          .invocation = &invocation,
                          .input = open_network(invocation.inputs[0]),
                          .response = artifact_open(invocation.inputs[1], "response")};
    if (parameters.write != WRITE_PACKING) {
        refuse_rings(scene.input);
        refuse_saturation(scene.input, "the liquid of a network cannot go along with "
                                       "moved grains, that of a drying can: give the "
                                       "drying that dry makes of it");
    }
    scene.before = artifact_get_periodic_network(scene.input);
    scene.after = artifact_get_periodic_network(scene.input);
    take_places(scene.response, &scene.after.packing);
    move_box(&scene.before.packing, &scene.after.packing);
    check_box(&scene.after.packing, scene.response->path);

    if (parameters.write == WRITE_PACKING)
        write_packing(&scene);
    else if (invocation.n_input > 2)
        replace(&scene);
    else
        move(&scene);

    network_free(&scene.before);
    network_free(&scene.after);
    artifact_close(scene.response);
    artifact_close(scene.input);
    invocation_free(&invocation);
    return STATUS_OK;
}
