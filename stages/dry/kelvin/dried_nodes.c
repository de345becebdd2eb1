// SPDX-License-Identifier: GPL-3.0-or-later
// What the vapour's system had at nodes that dry, recorded before they are eliminated.
// The elimination of node i changes the matrix of the wet nodes by
//     S_jk -= c_ij c_ik / total_i,   total_i = sum of all its links and to the air,
// a downdate of rank one whose column is c_i / sqrt(total_i). If both ends of a throat
// dry, the second is seen after the first is gone (see_through): its links grow by
// c_12 c_1j / total_1. Bodies at the ends of the throat, and throats that change
// cluster, are other bodies afterwards: their rows go.
#include "dried_nodes.h"

#include "basics/memory.h"

#include <stdlib.h>

struct dried_nodes dried_nodes_init(int n_throat, int n_site, bool by_throat)
{
    return (struct dried_nodes){.body = NEW_ARRAY(int, n_throat),
                                .seen = NEW_ARRAY(bool, n_throat),
                                .other = NEW_ARRAY(int, n_site),
                                .conductance = NEW_ARRAY(double, n_site),
                                .by_throat = by_throat};
}

void dried_nodes_free(struct dried_nodes *dried)
{
    free(dried->body);
    free(dried->seen);
    free(dried->node);
    free(dried->link);
    free(dried->other);
    free(dried->conductance);
    *dried = (struct dried_nodes){0};
}

void dried_nodes_clear(struct dried_nodes *dried)
{
    for (int i = 0; i < dried->n_body; i++)
        dried->seen[dried->body[i]] = false;
    dried->n_throat = dried->n_body = dried->n_node = dried->n_link = 0;
}

static void note_body_of(struct dried_nodes *dried, const struct occupancy *occupancy,
                         int throat)
{
    const int cluster = occupancy->clusters.of_throat[throat];
    const int body = dried->by_throat ? throat : cluster;
    if (cluster < 0 || dried->seen[body]) return;
    dried->seen[body] = true;
    dried->body[dried->n_body++] = body;
}

static void add_link(struct dried_nodes *dried, int site, double conductance)
{
    GROW_ARRAY(dried->link, dried->n_link, dried->link_capacity);
    dried->link[dried->n_link++] = (struct dried_link){site, conductance};
}

// Records SITE with all its links except that to BUT, which is returned.
static double note_node(struct dried_nodes *dried, const struct kron_fronts *mesh,
                        int site, int but)
{
    GROW_ARRAY(dried->node, dried->n_node, dried->node_capacity);
    struct dried_node *node = &dried->node[dried->n_node++];
    *node = (struct dried_node){.begin = dried->n_link,
                                .total = kron_fronts_air(mesh, site)};
    const int n = kron_fronts_list_links(mesh, site, dried->other, dried->conductance);
    double to_but = 0;
    for (int i = 0; i < n; i++) {
        const int other = dried->other[i];
        const double conductance = dried->conductance[other];
        dried->conductance[other] = 0;
        if (other == but) {
            to_but = conductance;
            continue;
        }
        add_link(dried, other, conductance);
        node->total += conductance;
    }
    node->end = dried->n_link;
    return to_but;
}

// Two nodes dry, linked by BETWEEN. The first is eliminated first, which gives the
// second part of its links and of its total.
static void see_through(struct dried_nodes *dried, double between)
{
    struct dried_node *second = &dried->node[dried->n_node - 1];
    const struct dried_node *first = second - 1;
    const double part = between / (first->total + between);
    for (int i = first->begin; i < first->end; i++)
        add_link(dried, dried->link[i].site, dried->link[i].conductance * part);
    second->end = dried->n_link;
    second->total += first->total * part;
}

// Liquid at the ends of the throat is another body from now on, so links to an end that
// does not dry count only in the total.
static void note_dried(struct dried_nodes *dried, struct occupancy *occupancy,
                       int throat)
{
    const int32_t *end = occupancy->network->throat_nodes[throat];
    const bool dries[2] = {occupancy->liquid_beside[end[0]] == 1,
                           occupancy->liquid_beside[end[1]] == 1};
    if (!dries[0] && !dries[1]) return;
    struct kron_fronts *mesh = &occupancy->vapour.mesh;
    kron_fronts_flush(mesh, end[0]);
    kron_fronts_flush(mesh, end[1]);
    const int one = dries[0] ? end[0] : end[1], other = dries[0] ? end[1] : end[0];
    const double between =
        note_node(dried, mesh, one, other) + occupancy->vapour.conductance[throat];
    if (dries[0] && dries[1]) {
        note_node(dried, mesh, other, one);
        see_through(dried, between);
    }
    dried->node[dried->n_node - 1 - (dries[0] && dries[1])].total += between;
}

void dried_nodes_note_before(struct dried_nodes *dried, struct occupancy *occupancy,
                             int throat)
{
    dried->n_throat++;
    for (int end = 0; end < 2; end++) {
        const int node = occupancy->network->throat_nodes[throat][end];
        for (int k = occupancy->incidence.offset[node];
             k < occupancy->incidence.offset[node + 1]; k++)
            note_body_of(dried, occupancy, occupancy->incidence.throat[k]);
    }
    note_dried(dried, occupancy, throat);
}

void dried_nodes_note_after(struct dried_nodes *dried,
                            const struct occupancy *occupancy)
{
    for (int k = 0; k < occupancy->clusters.n_moved; k++)
        note_body_of(dried, occupancy, occupancy->clusters.moved[k]);
}
