// SPDX-License-Identifier: GPL-3.0-or-later
#include "dried_nodes.h"

#include "basics/memory.h"

#include <stdlib.h>

struct drained drained_make(int n_throat, int n_site, bool by_throat)
{
    return (struct drained){.body = NEW_ARRAY(int, n_throat),
                            .seen = NEW_ARRAY(bool, n_throat),
                            .other = NEW_ARRAY(int, n_site),
                            .conductance = NEW_ARRAY(double, n_site),
                            .by_throat = by_throat};
}

void drained_free(struct drained *drained)
{
    free(drained->body);
    free(drained->seen);
    free(drained->node);
    free(drained->link);
    free(drained->other);
    free(drained->conductance);
    *drained = (struct drained){0};
}

void drained_clear(struct drained *drained)
{
    for (int i = 0; i < drained->n_body; i++)
        drained->seen[drained->body[i]] = false;
    drained->n_throat = drained->n_body = drained->n_node = drained->n_link = 0;
}

static void note_body_of(struct drained *drained, const struct phases *phases,
                         int throat)
{
    const int cluster = phases->clusters.of_throat[throat];
    const int body = drained->by_throat ? throat : cluster;
    if (cluster < 0 || drained->seen[body]) return;
    drained->seen[body] = true;
    drained->body[drained->n_body++] = body;
}

static void add_link(struct drained *drained, int site, double conductance)
{
    GROW_ARRAY(drained->link, drained->n_link, drained->link_capacity);
    drained->link[drained->n_link++] = (struct dried_link){site, conductance};
}

// With all its links but that to SITE's neighbour BUT, which is returned.
static double note_node(struct drained *drained, const struct star_mesh *mesh, int site,
                        int but)
{
    GROW_ARRAY(drained->node, drained->n_node, drained->node_capacity);
    struct dried_node *node = &drained->node[drained->n_node++];
    *node = (struct dried_node){.begin = drained->n_link, .total = mesh->air[site]};
    const int n =
        star_mesh_list_links(mesh, site, drained->other, drained->conductance);
    double to_but = 0;
    for (int i = 0; i < n; i++) {
        const int other = drained->other[i];
        const double conductance = drained->conductance[other];
        drained->conductance[other] = 0;
        if (other == but) {
            to_but = conductance;
            continue;
        }
        add_link(drained, other, conductance);
        node->total += conductance;
    }
    node->end = drained->n_link;
    return to_but;
}

// The second of two that dry, linked by BETWEEN, sees through the first what that sees.
static void see_through(struct drained *drained, double between)
{
    struct dried_node *second = &drained->node[drained->n_node - 1];
    const struct dried_node *first = second - 1;
    const double part = between / (first->total + between);
    for (int i = first->begin; i < first->end; i++)
        add_link(drained, drained->link[i].site, drained->link[i].conductance * part);
    second->end = drained->n_link;
    second->total += first->total * part;
}

// What is at the ends of the throat is another body from now on, so links to an end
// that does not dry count only in the total.
static void note_dried(struct drained *drained, struct phases *phases, int throat)
{
    const int32_t *end = phases->network->throat_nodes[throat];
    const bool dries[2] = {phases->liquid_beside[end[0]] == 1,
                           phases->liquid_beside[end[1]] == 1};
    if (!dries[0] && !dries[1]) return;
    struct star_mesh *mesh = &phases->vapour.mesh;
    star_mesh_bring_up_to_date(mesh, end[0]);
    star_mesh_bring_up_to_date(mesh, end[1]);
    const int one = dries[0] ? end[0] : end[1], other = dries[0] ? end[1] : end[0];
    const double between =
        note_node(drained, mesh, one, other) + phases->vapour.conductance[throat];
    if (dries[0] && dries[1]) {
        note_node(drained, mesh, other, one);
        see_through(drained, between);
    }
    drained->node[drained->n_node - 1 - (dries[0] && dries[1])].total += between;
}

void drained_note_before(struct drained *drained, struct phases *phases, int throat)
{
    drained->n_throat++;
    for (int end = 0; end < 2; end++) {
        const int node = phases->network->throat_nodes[throat][end];
        for (int k = phases->incidence.offset[node];
             k < phases->incidence.offset[node + 1]; k++)
            note_body_of(drained, phases, phases->incidence.throat[k]);
    }
    note_dried(drained, phases, throat);
}

void drained_note_after(struct drained *drained, const struct phases *phases)
{
    for (int k = 0; k < phases->clusters.n_moved; k++)
        note_body_of(drained, phases, phases->clusters.moved[k]);
}
