// SPDX-License-Identifier: GPL-3.0-or-later
// Nanoseconds a force against error, of every bridge model, one by one and in arrays:
//     bench_bridge
// prints a table, one line a model: name, ns one by one, ns in arrays (- where there is
// none), median and largest error over wetting bridges of equal spheres from contact to
// 0.99 of rupture (volumes 1e-6 to 0.1, contact angle 20 degrees), of the exact force.
// Times are the least of many short runs.
#include "basics/memory.h"
#include "basics/progress.h"
#include "basics/sorted.h"
#include "bridges/bridges.h"
#include "bridges/equilibrium.h"
#include "bridges/table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { COUNT = 4096, RUNS = 300 };
static const double contact_angle = 20 * M_PI / 180;

struct sample {
    double volume[COUNT], gap[COUNT], exact[COUNT], force[COUNT];
};

static struct bodies equal_spheres(void)
{
    return (struct bodies){{1, 1}, {contact_angle, contact_angle}};
}

static void draw(struct sample *sample, const struct bridge_table *table)
{
    const struct bodies bodies = equal_spheres();
    for (int k = 0; k < COUNT; k++) {
        const double volume = pow(10, -6 + 5 * fmod(0.5 + k * 0.754877666, 1));
        sample->volume[k] = volume;
        sample->gap[k] =
            bridge_table_rupture(table, volume) * 0.99 * fmod(0.5 + k * 0.569840290, 1);
        // By another way than it is solved below, which tells how well it is solved.
        const double way[2] = {0.9 * sample->gap[k], sample->gap[k]};
        struct equilibrium exact[2];
        if (follow_to_turning(&bodies, volume, 2, way, exact)) exit(1);
        sample->exact[k] = 2 * M_PI * arc_force(&bodies, &exact[1].arc);
    }
}

static void print_line(const char *name, double one, double many,
                       const struct sample *sample)
{
    static double error[COUNT];
    for (int k = 0; k < COUNT; k++)
        error[k] = fabs(sample->force[k] / sample->exact[k] - 1);
    qsort(error, COUNT, sizeof *error, rising_doubles);
    char text[32] = "-";
    if (many > 0) snprintf(text, sizeof text, "%.2f", many);
    printf("%-20s %9.2f %9s %9.1e %9.1e\n", name, one, text,
           fmax(error[COUNT / 2], 1e-15), fmax(error[COUNT - 1], 1e-15));
}

// The least time of a call of DO, in ns for each of COUNT forces.
#define LEAST(runs, DO)                                                                \
    __extension__({                                                                    \
        double least = INFINITY;                                                       \
        for (int run = 0; run < (runs); run++) {                                       \
            const double start = seconds_now();                                        \
            DO;                                                                        \
            least = fmin(least, seconds_now() - start);                                \
        }                                                                              \
        1e9 / COUNT *least;                                                            \
    })

static void solve_all(struct sample *sample)
{
    const struct bodies bodies = equal_spheres();
    for (int k = 0; k < COUNT; k++) {
        struct equilibrium found;
        if (find_equilibrium(&bodies, sample->volume[k], sample->gap[k], &found))
            exit(1);
        sample->force[k] = 2 * M_PI * arc_force(&bodies, &found.arc);
    }
}

static void read_table(const struct bridge_table *table, struct sample *sample)
{
    for (int k = 0; k < COUNT; k++)
        sample->force[k] = bridge_table_force(table, sample->volume[k], sample->gap[k]);
}

static void one_by_one(enum bridge_model model, struct sample *sample)
{
    for (int k = 0; k < COUNT; k++)
        bridge_model_forces(model, contact_angle, 1, &sample->volume[k],
                            &sample->gap[k], &sample->force[k]);
}

int main(void)
{
    static const char *const names[BRIDGE_MODELS] = {"exact",
                                                     "table",
                                                     "weigert",
                                                     "willett-full",
                                                     "willett-reduced",
                                                     "rabinovich",
                                                     "rabinovich-lambert",
                                                     "soulie"};
    const double radius[2] = {1, 1}, angles[2] = {contact_angle, contact_angle};
    struct bridge_table *table;
    struct reason reason;
    if (bridge_table_create(radius, angles, &table, &reason)) return 1;
    struct sample *sample = NEW_ARRAY(struct sample, 1);
    draw(sample, table);
    printf("# %-18s %9s %9s %9s %9s\n", "model", "ns/force", "in array", "median",
           "largest");
    double one = LEAST(20, solve_all(sample)), many;
    print_line("exact", one, 0, sample);
    one = LEAST(RUNS, read_table(table, sample));
    many = LEAST(RUNS, bridge_table_forces(table, COUNT, sample->volume, sample->gap,
                                           sample->force));
    print_line("table", one, many, sample);
    for (enum bridge_model model = BRIDGE_WEIGERT; model < BRIDGE_MODELS; model++) {
        one = LEAST(RUNS, one_by_one(model, sample));
        many =
            LEAST(RUNS, bridge_model_forces(model, contact_angle, COUNT, sample->volume,
                                            sample->gap, sample->force));
        print_line(names[model], one, many, sample);
    }
    free(sample);
    bridge_table_free(table);
    return 0;
}
