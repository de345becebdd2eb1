// SPDX-License-Identifier: GPL-3.0-or-later
// Rows are read when a replay asks for them. What needs all of them is found on the
// way: the largest force when each comes first. Only the most liquid that each grain
// ever has must be known before, by reading /liquid_mass once more.
#include "read_load.h"

#include "basics/memory.h"
#include "basics/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Where rows come from, and what is held of them.
struct source {
    int n;                     // grains
    struct row_reader *forces; // NULL: there are none
    struct vector *row;        // (n) N: of no forces, or with the weight; else NULL
    double *weight;            // (n) N; NULL: none
    int n_seen;                // rows that have come
    double largest;            // N, of these
    struct row_reader *liquid; // NULL: it is not looked at
    const double *saturation;  // (n_time)
    double *most;              // (n) kg, .most_liquid of the load
    double *dryness[2];        // (n) of the rows
    int dry[2];                // below; -1: none
};

bool is_packing(const struct artifact *input)
{
    return !strcmp(input->schema->name, "packing");
}

// ---- rows ---------------------------------------------------------------------------

static const struct vector *force_row(void *context, int row)
{
    struct source *source = context;
    if (!source->forces && !source->weight) return source->row;
    const struct vector *force =
        source->forces ? artifact_row(source->forces, row) : NULL;
    for (int i = 0; force && row == source->n_seen && i < source->n; i++)
        source->largest = fmax(source->largest, norm(force[i]));
    source->n_seen += row == source->n_seen;
    if (!source->weight) return force;
    for (int i = 0; i < source->n; i++) {
        source->row[i] = force ? force[i] : (struct vector){0};
        source->row[i].z -= source->weight[i];
    }
    return source->row;
}

// Even rows in one place, odd ones in the other: so that of the row before stays.
static const double *dryness_row(void *context, int row)
{
    struct source *source = context;
    double *dryness = source->dryness[row % 2];
    if (source->dry[row % 2] != row)
        liquid_to_dryness(artifact_row(source->liquid, row), source->most,
                          source->saturation[row], source->n, dryness);
    source->dry[row % 2] = row;
    return dryness;
}

static struct row_reader *open_rows(const struct artifact *input, const char *name)
{
    const struct row_reader reader = artifact_read_rows(input, name);
    return duplicate(&reader, 1, sizeof reader);
}

static void close_rows(struct row_reader *rows)
{
    if (rows) row_reader_free(rows);
    free(rows);
}

// ---- loads --------------------------------------------------------------------------

// A load without forces, under which a packing only shrinks or drains: n rows a second
// apart, of saturations from (n-1)/n to 0, so that the first row has shrunk already.
// The saturations of one that drains are found on the way.
static struct load load_without_forces(const struct artifact *input,
                                       const struct replay_parameters *parameters)
{
    const struct capillarity *drains = &parameters->settings.capillarity;
    const int n =
        (int)(drains->suction > 0 ? drains->steps : parameters->shrinkage_steps);
    if (!(parameters->settings.shrinkage.strain > 0) && !(drains->suction > 0))
        die(STATUS_BAD_DATA,
            "%s: is a packing, without forces: first run tessellate, merge-nodes, dry "
            "and force-protocol, or let it shrink (dem-replay.shrinkage.strain) or "
            "drain (dem-replay.capillary.suction)",
            input_name(input->path));
    struct load load = {.n_time = n,
                        .drains = drains->suction > 0,
                        .time = NEW_ARRAY(double, n),
                        .saturation = NEW_ARRAY(double, n)};
    for (int k = 0; k < n; k++) {
        load.time[k] = k + 1;
        load.saturation[k] = (double)(n - 1 - k) / n;
    }
    return load;
}

// The most liquid of each grain, and room for the dryness of two rows.
static void begin_dryness(const struct artifact *input, struct load *load)
{
    struct source *source = load->source;
    const int n = source->n;
    source->liquid = open_rows(input, "/liquid_mass");
    source->saturation = load->saturation;
    source->most = NEW_ARRAY(double, n);
    for (int k = 0; k < load->n_time; k++) {
        const double *liquid = artifact_row(source->liquid, k);
        for (int i = 0; i < n; i++)
            source->most[i] = fmax(source->most[i], liquid[i]);
    }
    for (int k = 0; k < 2; k++) {
        source->dryness[k] = NEW_ARRAY(double, n);
        source->dry[k] = -1;
    }
    load->most_liquid = source->most;
    load->dryness = dryness_row;
}

struct load read_load(const struct artifact *input,
                      const struct replay_parameters *parameters, int n_particle)
{
    const struct shrinkage *how = &parameters->settings.shrinkage;
    struct source *source = NEW_ARRAY(struct source, 1);
    struct load load = {0};
    source->n = n_particle;
    if (is_packing(input)) {
        load = load_without_forces(input, parameters);
        source->row = NEW_ARRAY(struct vector, n_particle);
    } else {
        load.time = artifact_get(input, "/time", &load.n_time);
        load.saturation = artifact_get(input, "/saturation", NULL);
        source->forces = open_rows(input, "/force");
    }
    load.source = source;
    load.force = force_row;
    load.shrinks = how->strain > 0;
    if (!load.shrinks || how->law != SHRINKAGE_LIQUID) return load;
    if (load.drains) {
        load.drained = NEW_ARRAY(double, (size_t)load.n_time *(size_t)n_particle);
        return load;
    }
    if (is_packing(input) || !artifact_has_dataset(input, "/liquid_mass"))
        die(STATUS_BAD_DATA,
            "%s: /liquid_mass: is not there, which shrinkage.law=liquid needs: run "
            "force-protocol with a gravity above 0, however small",
            input_name(input->path));
    begin_dryness(input, &load);
    return load;
}

void free_load(struct load *load)
{
    struct source *source = load->source;
    close_rows(source->forces);
    close_rows(source->liquid);
    free(source->row);
    free(source->weight);
    free(source->most);
    free(source->dryness[0]);
    free(source->dryness[1]);
    free(source);
    free(load->time);
    free(load->saturation);
    free(load->drained);
}

void add_weight(struct load *load, double *weight)
{
    struct source *source = load->source;
    source->weight = weight;
    if (!source->row) source->row = NEW_ARRAY(struct vector, source->n);
}

double largest_force(const struct load *load)
{
    return ((const struct source *)load->source)->largest;
}
