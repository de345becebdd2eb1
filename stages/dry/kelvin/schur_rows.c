// SPDX-License-Identifier: GPL-3.0-or-later
#include "schur_rows.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

struct body_rows body_rows_make(int n_throat, int n_site)
{
    return (struct body_rows){.offset = NEW_ARRAY(int, n_throat + 1),
                              .at = NEW_ARRAY(struct at_node, 2 * (size_t)n_throat),
                              .column = NEW_ARRAY(int, n_throat),
                              .value = NEW_ARRAY(double, n_throat),
                              .listed = NEW_ARRAY(bool, n_throat),
                              .other = NEW_ARRAY(int, n_site),
                              .link = NEW_ARRAY(double, n_site)};
}

void body_rows_free(struct body_rows *rows)
{
    free(rows->offset);
    free(rows->at);
    free(rows->column);
    free(rows->value);
    free(rows->listed);
    free(rows->other);
    free(rows->link);
    *rows = (struct body_rows){0};
}

void body_rows_list(struct body_rows *rows, const struct curved *curved,
                    const struct phases *phases)
{
    const int n_share = curved->offset[phases->n_wet];
    int *end = rows->offset + 1; // of the body before, while it fills
    memset(rows->offset, 0, ((size_t)curved->n + 1) * sizeof *rows->offset);
    for (int i = 0; i < n_share; i++)
        if (curved->share[i].body + 1 < curved->n) end[curved->share[i].body + 1]++;
    for (int a = 0; a < curved->n; a++)
        rows->offset[a + 1] += rows->offset[a];
    for (int k = 0; k < phases->n_wet; k++)
        for (int i = curved->offset[k]; i < curved->offset[k + 1]; i++)
            rows->at[end[curved->share[i].body]++] =
                (struct at_node){k, curved->share[i].part};
}

static double part_at(const struct curved *curved, int k, int body)
{
    for (int i = curved->offset[k]; i < curved->offset[k + 1]; i++)
        if (curved->share[i].body == body) return curved->share[i].part;
    return 0;
}

static void add_shares(struct body_rows *rows, const struct curved *curved, int k,
                       double factor)
{
    for (int i = curved->offset[k]; i < curved->offset[k + 1]; i++) {
        const int body = curved->share[i].body;
        if (!rows->listed[body]) rows->column[rows->n++] = body;
        rows->listed[body] = true;
        rows->value[body] += factor * curved->share[i].part;
    }
}

// A link of conductance c between nodes of which BODY has the parts p and q adds
// c (p - q) times the difference of all parts: here those of the K-th wet node, with
// those of the other if it is not one of BODY's, which would add them itself. So links
// inside a body leave nothing to go off.
static void add_node(struct body_rows *rows, const struct curved *curved,
                     const struct phases *phases, int body, struct at_node at)
{
    const struct star_mesh *mesh = &phases->vapour.mesh;
    const int node = phases->wet[at.k];
    const int n = star_mesh_list_links(mesh, node, rows->other, rows->link);
    double sum = mesh->air[node] * at.part;
    for (int i = 0; i < n; i++) {
        const int l = phases->wet_place[rows->other[i]];
        const double link = rows->link[rows->other[i]];
        const double part = part_at(curved, l, body);
        rows->link[rows->other[i]] = 0;
        sum += link * (at.part - part);
        if (part == 0) add_shares(rows, curved, l, -link * at.part);
    }
    add_shares(rows, curved, at.k, sum);
}

void body_rows_take(struct body_rows *rows, const struct curved *curved,
                    const struct phases *phases, int body)
{
    for (int i = rows->offset[body]; i < rows->offset[body + 1]; i++)
        add_node(rows, curved, phases, body, rows->at[i]);
}

void body_rows_clear(struct body_rows *rows)
{
    for (int i = 0; i < rows->n; i++) {
        rows->value[rows->column[i]] = 0;
        rows->listed[rows->column[i]] = false;
    }
    rows->n = 0;
}
