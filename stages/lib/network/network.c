// SPDX-License-Identifier: GPL-3.0-or-later
// Look-ups in the arrays of struct network. Nothing is kept beside them, so who changes
// an array need tell nobody. With X the edges of the box and `image` the boxes that lie
// between,
//     along_throat = (position[second] - position[first]) + image * X,
// which is exactly opposite when seen from the other end. Corners and the second grain
// of a face are given in the repetition of the box that its first grain is in.
//
// What a throat holds and conducts is what the arrays say, else that of the cylinder
// with its radius r and length L (m3, m, m3):
//     volume = pi r^2 L,  diffusive = pi r^2 / L,  hydraulic = pi r^4 / (8 L).
// Conductances come in units of a LENGTH that suits the network: r and L are divided by
// it before the fourth power is taken.
//
// Incidence is built by counting throats per node, summing the counts to offsets, and
// filling in the order of the throats, which makes each row ascending. A throat from a
// node to its own image is in the row of that node twice.
#include "network/network.h"

#include "basics/memory.h"

#include <stdlib.h>

void network_free(struct network *network)
{
    packing_free(&network->packing);
    free(network->node_position);
    free(network->node_walls);
    free(network->throat_nodes);
    free(network->throat_radius);
    free(network->throat_length);
    free(network->throat_kind);
    free(network->throat_volume);
    forget_throat_shapes(network);
    free(network->face_offset);
    free(network->face_nodes);
    free(network->face_particles);
    free(network->throat_image);
    free(network->face_image);
    free(network->face_node_image);
    *network = (struct network){0};
}

bool is_layer(const struct network *network)
{
    for (int f = 0; f < network->n_face; f++)
        if (network->face_particles[f][1] != -3) return false;
    return network->n_face > 0;
}

// What arrays of images hold at K; 0 where the box does not repeat and there are none.
static struct image image_at(const struct image *image, int64_t k)
{
    return image ? image[k] : (struct image){0};
}

struct vector along_throat(const struct network *network, int throat)
{
    const int32_t *ends = network->throat_nodes[throat];
    return image_apart(&network->packing, network->node_position[ends[0]],
                       network->node_position[ends[1]],
                       image_at(network->throat_image, throat));
}

struct vector throat_middle(const struct network *network, int throat)
{
    return add(network->node_position[network->throat_nodes[throat][0]],
               scale(0.5, along_throat(network, throat)));
}

int32_t (*drawn_throats(const struct network *network))[2]
{
    int32_t(*ends)[2] =
        duplicate(network->throat_nodes, (size_t)network->n_throat, sizeof *ends);
    for (int t = 0; t < network->n_throat; t++)
        if (!same_image(image_at(network->throat_image, t), (struct image){0}))
            ends[t][1] = ends[t][0];
    return ends;
}

struct vector face_corner(const struct network *network, int64_t corner)
{
    return add(
        network->node_position[network->face_nodes[corner]],
        image_offset(&network->packing, image_at(network->face_node_image, corner)));
}

struct vector second_grain(const struct network *network, int face)
{
    return add(network->packing.position[network->face_particles[face][1]],
               image_offset(&network->packing, image_at(network->face_image, face)));
}

struct incidence network_incidence(const struct network *network)
{
    struct incidence incidence = {.offset = NEW_ARRAY(int, network->n_node + 1),
                                  .throat =
                                      NEW_ARRAY(int, 2 * (size_t)network->n_throat)};
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2; end++)
            incidence.offset[network->throat_nodes[t][end] + 1]++;
    for (int i = 0; i < network->n_node; i++)
        incidence.offset[i + 1] += incidence.offset[i];

    int *next = duplicate(incidence.offset, (size_t)network->n_node + 1, sizeof *next);
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2; end++)
            incidence.throat[next[network->throat_nodes[t][end]]++] = t;
    free(next);
    return incidence;
}

void incidence_free(struct incidence *incidence)
{
    free(incidence->offset);
    free(incidence->throat);
    *incidence = (struct incidence){0};
}

// Looks through the throats of one node, a handful. Both nodes do not suffice: in a
// narrow box that repeats, several throats join the same two nodes, each through
// another image.
int face_throat(const struct network *network, const struct incidence *incidence,
                int face, int k)
{
    const int64_t from = network->face_offset[face] + k;
    const int64_t to = from + 1 < network->face_offset[face + 1]
                           ? from + 1
                           : network->face_offset[face];
    const int a = network->face_nodes[from], b = network->face_nodes[to];
    const struct image apart =
        image_difference(image_at(network->face_node_image, to),
                         image_at(network->face_node_image, from));
    for (int i = incidence->offset[a]; i < incidence->offset[a + 1]; i++) {
        const int t = incidence->throat[i];
        const int32_t *ends = network->throat_nodes[t];
        const struct image image = image_at(network->throat_image, t);
        if ((ends[0] == a && ends[1] == b && same_image(image, apart)) ||
            (ends[0] == b && ends[1] == a && same_image(image, image_opposite(apart))))
            return t;
    }
    return -1;
}

// A throat lies in a wall if both its nodes are on that same one: hence what all three
// sets of bits have in common. Throats of the boundary layer keep their kind.
int impose_empty_throats(struct network *network, unsigned walls)
{
    int n = 0;
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *node = network->throat_nodes[t];
        if (network->throat_kind[t] == THROAT_NETWORK &&
            network->node_walls[node[0]] & network->node_walls[node[1]] & walls)
            network->throat_kind[t] = THROAT_IMPOSED_EMPTY;
        n += network->throat_kind[t] == THROAT_IMPOSED_EMPTY;
    }
    return n;
}

// A radius that is not a number counts as closed: the test is for open ones.
int shut_closed_throats(struct network *network)
{
    int n = 0;
    for (int t = 0; t < network->n_throat; t++) {
        const bool open =
            network->throat_radius[t] > 0 &&
            !(network->throat_diffusion && network->throat_diffusion[t] == 0);
        if (network->throat_kind[t] != THROAT_NETWORK || open) continue;
        network->throat_kind[t] = THROAT_IMPOSED_EMPTY;
        n++;
    }
    return n;
}

double throat_volume(const struct network *network, int throat)
{
    if (network->throat_volume) return network->throat_volume[throat];
    const double radius = network->throat_radius[throat];
    return M_PI * radius * radius * network->throat_length[throat];
}

double diffusive_conductance(const struct network *network, int throat, double length)
{
    if (network->throat_diffusion) return network->throat_diffusion[throat] / length;
    const double radius = network->throat_radius[throat] / length;
    return M_PI * radius * radius / (network->throat_length[throat] / length);
}

// Poiseuille's law for a cylinder.
double hydraulic_conductance(const struct network *network, int throat, double length)
{
    if (network->throat_flow)
        return network->throat_flow[throat] / (length * length * length);
    const double r = network->throat_radius[throat] / length;
    return M_PI * (r * r) * (r * r) / (8 * (network->throat_length[throat] / length));
}

double hydraulic_radius(const struct network *network, int throat)
{
    return network->throat_hydraulic_radius ? network->throat_hydraulic_radius[throat]
                                            : network->throat_radius[throat];
}

void copy_throat_shape(struct network *network, int from, int to)
{
    if (network->throat_diffusion)
        network->throat_diffusion[to] = network->throat_diffusion[from];
    if (network->throat_flow) network->throat_flow[to] = network->throat_flow[from];
    if (network->throat_hydraulic_radius)
        network->throat_hydraulic_radius[to] = network->throat_hydraulic_radius[from];
}

void forget_throat_shapes(struct network *network)
{
    free(network->throat_diffusion);
    free(network->throat_flow);
    free(network->throat_hydraulic_radius);
    network->throat_diffusion = network->throat_flow = NULL;
    network->throat_hydraulic_radius = NULL;
}
