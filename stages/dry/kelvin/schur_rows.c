// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of the matrix S = -d evaporation / d potential of the bodies,
//     S_ab = sum over wet nodes k of part_ak air_conductance[k] part_bk
//            + sum over links (k,l) of c_kl (part_ak - part_al) (part_bk - part_bl),
// the Laplacian of the wet nodes projected on the bodies. In this order a link inside
// one body (part_ak = part_al) adds exactly 0: written as differences of sums,
// conductances a million times that to the air would leave their rounding.
#include "schur_rows.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

struct schur_rows schur_rows_init(int n_throat, int n_site)
{
    return (struct schur_rows){.offset = NEW_ARRAY(int, n_throat + 1),
                               .at = NEW_ARRAY(struct at_node, 2 * (size_t)n_throat),
                               .column = NEW_ARRAY(int, n_throat),
                               .value = NEW_ARRAY(double, n_throat),
                               .listed = NEW_ARRAY(bool, n_throat),
                               .other = NEW_ARRAY(int, n_site),
                               .link = NEW_ARRAY(double, n_site)};
}

void schur_rows_free(struct schur_rows *rows)
{
    free(rows->offset);
    free(rows->at);
    free(rows->column);
    free(rows->value);
    free(rows->listed);
    free(rows->other);
    free(rows->link);
    *rows = (struct schur_rows){0};
}

void schur_rows_list(struct schur_rows *rows, const struct kelvin_menisci *kelvin,
                     const struct occupancy *occupancy)
{
    const int n_share = kelvin->offset[occupancy->n_wet];
    int *end = rows->offset + 1; // of the body before, while it fills
    memset(rows->offset, 0, ((size_t)kelvin->n + 1) * sizeof *rows->offset);
    for (int i = 0; i < n_share; i++)
        if (kelvin->share[i].body + 1 < kelvin->n) end[kelvin->share[i].body + 1]++;
    for (int a = 0; a < kelvin->n; a++)
        rows->offset[a + 1] += rows->offset[a];
    for (int k = 0; k < occupancy->n_wet; k++)
        for (int i = kelvin->offset[k]; i < kelvin->offset[k + 1]; i++)
            rows->at[end[kelvin->share[i].body]++] =
                (struct at_node){k, kelvin->share[i].part};
}

static double part_at(const struct kelvin_menisci *kelvin, int k, int body)
{
    for (int i = kelvin->offset[k]; i < kelvin->offset[k + 1]; i++)
        if (kelvin->share[i].body == body) return kelvin->share[i].part;
    return 0;
}

static void add_shares(struct schur_rows *rows, const struct kelvin_menisci *kelvin,
                       int k, double factor)
{
    for (int i = kelvin->offset[k]; i < kelvin->offset[k + 1]; i++) {
        const int body = kelvin->share[i].body;
        if (!rows->listed[body]) rows->column[rows->n++] = body;
        rows->listed[body] = true;
        rows->value[body] += factor * kelvin->share[i].part;
    }
}

// A link of conductance c between nodes of which BODY has the parts p and q adds
// c (p - q) times the difference of all parts. Here node AT adds its own parts, and
// those of the other node unless BODY has that too: then it adds them itself.
static void add_node(struct schur_rows *rows, const struct kelvin_menisci *kelvin,
                     const struct occupancy *occupancy, int body, struct at_node at)
{
    const struct kron_fronts *mesh = &occupancy->vapour.mesh;
    const int node = occupancy->wet[at.k];
    const int n = kron_fronts_list_links(mesh, node, rows->other, rows->link);
    double sum = kron_fronts_air(mesh, node) * at.part;
    for (int i = 0; i < n; i++) {
        const int l = occupancy->wet_place[rows->other[i]];
        const double link = rows->link[rows->other[i]];
        const double part = part_at(kelvin, l, body);
        rows->link[rows->other[i]] = 0;
        sum += link * (at.part - part);
        if (part == 0) add_shares(rows, kelvin, l, -link * at.part);
    }
    add_shares(rows, kelvin, at.k, sum);
}

void schur_rows_take(struct schur_rows *rows, const struct kelvin_menisci *kelvin,
                     const struct occupancy *occupancy, int body)
{
    for (int i = rows->offset[body]; i < rows->offset[body + 1]; i++)
        add_node(rows, kelvin, occupancy, body, rows->at[i]);
}

void schur_rows_clear(struct schur_rows *rows)
{
    for (int i = 0; i < rows->n; i++) {
        rows->value[rows->column[i]] = 0;
        rows->listed[rows->column[i]] = false;
    }
    rows->n = 0;
}
