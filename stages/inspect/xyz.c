// SPDX-License-Identifier: GPL-3.0-or-later
// Extended XYZ, as OVITO and ASE read it: for each frame the number of grains, a line
// of keys (Lattice, Origin, pbc, Time, Properties), then a row a grain. Nine digits:
// coordinates to 1e-9 of the box, without making files twice as large.
//
//     n
//     Lattice="a 0 0 0 b 0 0 0 c" Origin="x y z" pbc="T F F" Time=t Properties=...
//     id x y z radius [displacement 3] [force 3] [broken_bonds]      n rows
//
// Which columns there are, Properties says: all frames of one file have the same.
// Places are those before drying plus displacement, where that is known, and radii
// those of grains that have shrunk so far. Time is left out where there is none. All
// frames are made in memory, so the file is whole or not there.
#include "xyz.h"

#include "basics/file.h"
#include "basics/memory.h"
#include "basics/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// One moment of the grains; NULL: not known.
struct xyz_frame {
    double time; // s; NAN where there is none
    const struct vector *displacement, *force;
    const int *broken;
    const double *shrinkage;
};

// Lattice is the box, row by row; pbc says where it repeats.
static void put_header(FILE *stream, const struct packing *packing,
                       const struct xyz_frame *frame)
{
    const struct vector low = packing->lower, size = subtract(packing->upper, low);
    fprintf(stream,
            "%d\nLattice=\"%.9g 0 0 0 %.9g 0 0 0 %.9g\" Origin=\"%.9g %.9g %.9g\"",
            packing->n_particle, size.x, size.y, size.z, low.x, low.y, low.z);
    fprintf(stream, " pbc=\"%c %c %c\"", packing->periodic[0] ? 'T' : 'F',
            packing->periodic[1] ? 'T' : 'F', packing->periodic[2] ? 'T' : 'F');
    if (!isnan(frame->time)) fprintf(stream, " Time=%.9g", frame->time);
    fprintf(stream, " Properties=id:I:1:pos:R:3:radius:R:1%s%s%s\n",
            frame->displacement ? ":displacement:R:3" : "",
            frame->force ? ":force:R:3" : "", frame->broken ? ":broken_bonds:I:1" : "");
}

static void put_frame(FILE *stream, const struct packing *packing,
                      const struct xyz_frame *frame)
{
    put_header(stream, packing, frame);
    for (int i = 0; i < packing->n_particle; i++) {
        const struct vector moved =
            frame->displacement ? frame->displacement[i] : (struct vector){0};
        const struct vector x = add(packing->position[i], moved);
        const double radius =
            packing->radius[i] * (frame->shrinkage ? 1 - frame->shrinkage[i] : 1);
        fprintf(stream, "%d %.9g %.9g %.9g %.9g", i, x.x, x.y, x.z, radius);
        if (frame->displacement)
            fprintf(stream, " %.9g %.9g %.9g", moved.x, moved.y, moved.z);
        if (frame->force)
            fprintf(stream, " %.9g %.9g %.9g", frame->force[i].x, frame->force[i].y,
                    frame->force[i].z);
        if (frame->broken) fprintf(stream, " %d", frame->broken[i]);
        fputc('\n', stream);
    }
}

// Rows m = k (n_time - 1)/(n_frame - 1): the first and the last are always there. Of 64
// bits, as the product may be large.
static void put_forces(FILE *stream, const struct artifact *artifact,
                       const struct packing *packing, int n_frame)
{
    int n_time;
    double *time = artifact_get(artifact, "/time", &n_time);
    struct vector *force = artifact_get(artifact, "/force", NULL);
    for (int k = 0; k < n_frame && n_time > 0; k++) {
        const int64_t m = n_frame > 1 ? (int64_t)k * (n_time - 1) / (n_frame - 1) : 0;
        const struct xyz_frame frame = {.time = time[m],
                                        .force = force + m * packing->n_particle};
        put_frame(stream, packing, &frame);
    }
    free(time);
    free(force);
}

// Broken bonds (n_particle) of each grain, by INTACT (n_bond).
static void count_broken(const struct packing *packing, const uint8_t *intact,
                         int *broken)
{
    memset(broken, 0, (size_t)packing->n_particle * sizeof *broken);
    for (int b = 0; b < packing->n_bond; b++)
        for (int side = 0; side < 2; side++)
            broken[packing->bond[b][side]] += !intact[b];
}

// /snapshots/... have a block of n_particle (n_bond) rows a snapshot.
static void put_snapshots(FILE *stream, const struct artifact *artifact,
                          const struct packing *packing)
{
    const int n = packing->n_particle;
    int n_snapshot, *broken = NEW_ARRAY(int, n);
    double *time = artifact_get(artifact, "/snapshots/time", &n_snapshot);
    struct vector *displacement =
        artifact_get(artifact, "/snapshots/displacement", NULL);
    struct vector *force = artifact_get(artifact, "/snapshots/force", NULL);
    uint8_t *intact = artifact_get(artifact, "/snapshots/bond_intact", NULL);
    double *shrinkage = NULL;
    if (artifact_has_dataset(artifact, "/snapshots/shrinkage"))
        shrinkage = artifact_get(artifact, "/snapshots/shrinkage", NULL);
    for (int64_t s = 0; s < n_snapshot; s++) {
        count_broken(packing, intact + s * packing->n_bond, broken);
        put_frame(stream, packing,
                  &(struct xyz_frame){time[s], displacement + s * n, force + s * n,
                                      broken, shrinkage ? shrinkage + s * n : NULL});
    }
    free(shrinkage);
    free(time);
    free(displacement);
    free(force);
    free(intact);
    free(broken);
}

// What is neither a response nor forces has one frame, of its grains as they lie; also
// a motion, whose snapshots are not taken.
void write_xyz(const struct artifact *artifact, const char *path, int n_frame)
{
    if (!schema_dataset(artifact->schema, "/particles/position"))
        die(STATUS_BAD_DATA, "%s: a %s has no grains", input_name(artifact->path),
            artifact->schema->name);
    struct packing packing = artifact_get_packing(artifact);
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!strcmp(artifact->schema->name, "response"))
        put_snapshots(stream, artifact, &packing);
    else if (!strcmp(artifact->schema->name, "forces"))
        put_forces(stream, artifact, &packing, n_frame);
    else
        put_frame(stream, &packing, &(struct xyz_frame){.time = NAN});
    fclose(stream);
    write_whole(path, text, size);
    free(text);
    packing_free(&packing);
}
