// SPDX-License-Identifier: GPL-3.0-or-later
// Stokes flow past eight spheres in the corners of a cube and one in the middle [C Fig.
// 12], with lateral symmetry: docs/flow.md's column, of a lattice Boltzmann method (19
// velocities, two relaxation times whose product puts walls half way between nodes;
// Ginzburg, Verhaeghe and d'Humieres 2008). A quarter of the cube, mirrored; a body
// force along y.
//
//     build/tests/bench/stokes_nine NODES_ALONG_THE_EDGE D_OVER_D
#include "basics/memory.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

enum { Q = 19, MOST_STEPS = 6000, EVERY = 250 };
enum node { FLUID, BIG, SMALL };

static const double drive = 1e-6, even_time = 1, odd_time = 0.5 + 3.0 / 16 / (1 - 0.5);

static int velocity[Q][3], opposite[Q], mirrored[2][2][Q]; // along x, along z
static double weight[Q];

struct lattice {
    int edge, half;
    unsigned char *node; // (half, edge, half) of enum node, from the middle of x and z
    float *now, *next;   // (same, Q) less what is at rest
};

static int find(int x, int y, int z)
{
    for (int q = 0; q < Q; q++)
        if (velocity[q][0] == x && velocity[q][1] == y && velocity[q][2] == z) return q;
    return 0;
}

static void make_velocities(void)
{
    for (int code = 0, q = 0; code < 27; code++) {
        const int v[3] = {code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1};
        const int square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        if (square == 3) continue;
        for (int axis = 0; axis < 3; axis++)
            velocity[q][axis] = v[axis];
        weight[q++] = square == 0 ? 1.0 / 3 : square == 1 ? 1.0 / 18 : 1.0 / 36;
    }
    for (int q = 0; q < Q; q++)
        opposite[q] = find(-velocity[q][0], -velocity[q][1], -velocity[q][2]);
    for (int code = 0; code < 4 * Q; code++) {
        const int x = code / Q % 2, z = code / Q / 2, *v = velocity[code % Q];
        mirrored[x][z][code % Q] = find(x ? -v[0] : v[0], v[1], z ? -v[2] : v[2]);
    }
}

static int at(const struct lattice *l, int x, int y, int z)
{
    return (x * l->edge + y) * l->half + z;
}

static enum node node_at(double x, double y, double z, double ratio)
{
    const double off = (x - 0.25) * (x - 0.25) + (z - 0.25) * (z - 0.25),
                 r = 0.25 * 0.25;
    if (off + (y - 0.25) * (y - 0.25) < r || off + (y - 0.75) * (y - 0.75) < r)
        return BIG;
    return x * x + (y - 0.5) * (y - 0.5) + z * z < r * ratio * ratio ? SMALL : FLUID;
}

static void collide(const float *f, double *out)
{
    double density = 0, momentum[3] = {0, 0.5 * drive, 0};
    for (int q = 0; q < Q; q++) {
        density += (double)f[q];
        for (int axis = 0; axis < 3; axis++)
            momentum[axis] += velocity[q][axis] * (double)f[q];
    }
    for (int q = 0; q < Q; q++) {
        const int o = opposite[q];
        double along = 0;
        for (int axis = 0; axis < 3; axis++)
            along += velocity[q][axis] * momentum[axis];
        const double even = 0.5 * (double)(f[q] + f[o]),
                     odd = 0.5 * (double)(f[q] - f[o]);
        out[q] = even - (even - weight[q] * density) / even_time + odd -
                 (odd - 3 * weight[q] * along) / odd_time +
                 (1 - 0.5 / odd_time) * 3 * weight[q] * velocity[q][1] * drive;
    }
}

// Adds to FORCE what the nodes of each kind take of the momentum along y.
static void step(struct lattice *l, double force[3])
{
    double out[Q];
    for (int x = 0; x < l->half; x++)
        for (int y = 0; y < l->edge; y++)
            for (int z = 0; z < l->half; z++) {
                const int here = at(l, x, y, z);
                if (l->node[here]) continue;
                collide(&l->now[Q * here], out);
                for (int q = 0; q < Q; q++) {
                    const int *v = velocity[q];
                    const bool x_turns = x + v[0] < 0 || x + v[0] >= l->half;
                    const bool z_turns = z + v[2] < 0 || z + v[2] >= l->half;
                    const int there =
                        at(l, x_turns ? x : x + v[0], (y + v[1] + l->edge) % l->edge,
                           z_turns ? z : z + v[2]);
                    const int as = mirrored[x_turns][z_turns][q];
                    const enum node met = l->node[there];
                    l->next[met ? Q * here + opposite[q] : Q * there + as] =
                        (float)out[q];
                    if (met) force[met] += 2 * v[1] * out[q];
                }
            }
    float *other = l->now;
    l->now = l->next;
    l->next = other;
}

int main(int argc, char **argv)
{
    if (argc != 3) return 64;
    const double ratio = atof(argv[2]);
    struct lattice l = {.edge = atoi(argv[1])};
    l.half = l.edge / 2;
    const int n = l.half * l.edge * l.half;
    l.node = NEW_ARRAY(unsigned char, n);
    l.now = NEW_ARRAY(float, (size_t)n *Q);
    l.next = NEW_ARRAY(float, (size_t)n *Q);
    make_velocities();
    double solid[3] = {0};
    for (int x = 0; x < l.half; x++)
        for (int y = 0; y < l.edge; y++)
            for (int z = 0; z < l.half; z++)
                solid[l.node[at(&l, x, y, z)] =
                          node_at((x + 0.5) / l.edge, (y + 0.5) / l.edge,
                                  (z + 0.5) / l.edge, ratio)]++;
    // All forces are to sum to the drop times the section. The body force stands for a
    // mean gradient of the pressure, which pushes on the spheres as well.
    double sum = 0, small = 0;
    for (int steps = 1; steps <= MOST_STEPS && fabs(sum - 1) > 1e-4; steps++) {
        double force[3] = {0};
        step(&l, force);
        if (steps % EVERY) continue;
        small = (force[SMALL] + drive * solid[SMALL]) / (drive * n);
        sum = small + (force[BIG] + drive * solid[BIG]) / (drive * n);
    }
    printf(
        "d/D %g: force on the centre %.4g, on each other %.4g, of drop times section\n",
        ratio, small, (sum - small) / 8);
    free(l.node);
    free(l.now);
    free(l.next);
    return 0;
}
