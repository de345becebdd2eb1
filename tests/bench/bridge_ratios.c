// SPDX-License-Identifier: GPL-3.0-or-later
// How good the tables of bridges between unequal grains are, beside the exact solution
// at random radii from 1 to 20, volumes and gaps; and beside them one table of equal
// grains read by the effective radius alone (Derjaguin). Prints one line an angle and
// range of volumes: angle, volumes, then the largest error of the force up to 0.9 of
// rupture, to 0.96 and to 0.999, and that of the gap of rupture; then the same four of
// Derjaguin's for radii from 1 to 2, 1 to 5 and 1 to 20.
#include "bridges/equilibrium.h"
#include "bridges/ratios.h"
#include "bridges/table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { CASES = 1200, REACHES = 3, KINDS = 4 };

// How far from the exact one: forces up to each share of rupture, and rupture.
struct error {
    double of[REACHES + 1];
};

static const double reach[REACHES] = {0.9, 0.96, 0.999};

static double place(int k, double step)
{
    return fmod(0.5 + k * step, 1);
}

struct sample {
    double ratio, volume, share; // of radii, over the effective one's cube, of rupture
};

// Every other one of nearly equal grains, whose radii differ from each other by a share
// of their sum of 1e-5 on.
static struct sample sample_of(int k, double least, double most)
{
    const double difference = 1e-5 * pow(19e5 / 21, place(k, 0.754877666));
    const double ratio =
        k % 2 ? pow(20, place(k, 0.754877666)) : (1 + difference) / (1 - difference);
    return (struct sample){ratio, least * pow(most / least, place(k, 0.569840290)),
                           fmin(place(k, 0.819172513), 0.999)};
}

static void note(struct error *error, double share, double force, double rupture)
{
    for (int r = 0; r < REACHES; r++)
        if (share <= reach[r] && !(force <= error->of[r])) error->of[r] = force;
    error->of[REACHES] = fmax(error->of[REACHES], rupture);
}

struct tables {
    struct bridge_ratios *ratios;
    struct bridge_table *equal;
    double contact_angle;
};

// Into ERROR of the tables, then of Derjaguin's for the three ranges of radii.
static void compare(const struct tables *tables, const struct sample *s,
                    struct error error[KINDS])
{
    static const double widest[KINDS] = {20, 2, 5, 20};
    const double e = (s->ratio - 1) / (s->ratio + 1), angle = tables->contact_angle;
    const struct bodies bodies = {{1 - e, 1 + e}, {angle, angle}};
    struct equilibrium last, found;
    if (find_rupture(&bodies, s->volume, &last)) exit(1);
    const double gap = s->share * last.gap, asymmetry = bridge_asymmetry(1, s->ratio);
    if (find_equilibrium(&bodies, s->volume, gap, &found)) exit(1);
    const double exact = 2 * M_PI * arc_force(&bodies, &found.arc);
    const double steep = 1 + gap / (1.2 * sqrt(s->volume));
    const double size = fmax(fabs(exact), BRIDGE_TABLE_FLOOR / steep / steep);
    double ours;
    bridge_ratios_forces(tables->ratios, 1, &asymmetry, &s->volume, &gap, &ours);
    const double plain = bridge_table_force(tables->equal, s->volume, gap);
    const double rupture[2] = {
        bridge_ratios_rupture(tables->ratios, asymmetry, s->volume),
        bridge_table_rupture(tables->equal, s->volume)};
    for (int k = 0; k < KINDS; k++)
        if (s->ratio <= widest[k])
            note(&error[k], s->share, fabs((k ? plain : ours) - exact) / size,
                 fabs(rupture[k > 0] / last.gap - 1));
}

static void measure(const struct tables *tables, double degrees, double least,
                    double most)
{
    struct error error[KINDS] = {0}, each[CASES][KINDS] = {0};
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < CASES; k++) {
        const struct sample sample = sample_of(k, least, most);
        compare(tables, &sample, each[k]);
    }
    for (int k = 0; k < CASES; k++)
        for (int kind = 0; kind < KINDS; kind++)
            for (int r = 0; r <= REACHES; r++)
                error[kind].of[r] = fmax(error[kind].of[r], each[k][kind].of[r]);
    printf("%g %g %g", degrees, least, most);
    for (int kind = 0; kind < KINDS; kind++)
        for (int r = 0; r <= REACHES; r++)
            printf(" %.1e", error[kind].of[r]);
    printf("\n");
    fflush(stdout);
}

int main(void)
{
    static const double degrees[] = {0, 10, 20, 28, 32, 40, 50, 60, 90, 110};
    static const double volume[] = {1e-8, 1e-5, 1e-3, 1e-2, 0.1, 1};
    // So that all of these volumes are tabulated at every ratio.
    const struct bridge_sizes sizes = {{1, 20}, {6e-8, 7}, {0, 0}};
    for (size_t a = 0; a < sizeof degrees / sizeof *degrees; a++) {
        const double angle = degrees[a] * M_PI / 180;
        struct tables tables = {.contact_angle = angle};
        struct reason reason;
        if (bridge_ratios_create(&sizes, angle, &tables.ratios, &reason) ||
            bridge_table_create((double[2]){1, 1}, (double[2]){angle, angle},
                                &tables.equal, &reason))
            return 1;
        for (int v = 0; v + 1 < (int)(sizeof volume / sizeof *volume); v++)
            measure(&tables, degrees[a], volume[v], volume[v + 1]);
        bridge_ratios_free(tables.ratios);
        bridge_table_free(tables.equal);
    }
    return 0;
}
