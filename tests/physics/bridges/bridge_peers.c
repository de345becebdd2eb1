// SPDX-License-Identifier: GPL-3.0-or-later
// Bridges beside numbers that others computed: exact values by arc-length shooting, and
// the forces that Yade 2023.02a gives (tests/physics/bridges/*.csv).
#include "../../test.h"
#include "bridges/bridges.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// [G Table 1]
static const struct {
    const char *name;
    double first, second, tension, degrees, volume;
} cases[] = {{"W11", 2.381e-3, 2.381e-3, 0.0206, 0, 13.6e-12},
             {"W12", 2.381e-3, 2.381e-3, 0.0206, 0, 31.3e-12},
             {"W13", 2.381e-3, 2.381e-3, 0.0206, 0, 74.2e-12},
             {"W21", 2.381e-3, 1.588e-3, 0.0206, 0, 9.6e-12},
             {"W22", 2.381e-3, 1.588e-3, 0.0206, 0, 13.2e-12},
             {"W23", 2.381e-3, 1.588e-3, 0.0206, 0, 24.7e-12},
             {"W24", 2.381e-3, 1.588e-3, 0.0206, 0, 59.3e-12},
             {"W31", 2.381e-3, 1.191e-3, 0.0206, 0, 25.3e-12},
             {"W32", 2.381e-3, 1.191e-3, 0.0206, 0, 61.8e-12},
             {"W33", 2.381e-3, 1.191e-3, 0.0206, 0, 127.8e-12},
             {"R1", 19e-6, 35e-6, 0.027, 10, 2e-19},
             {"R2", 19e-6, 32.5e-6, 0.024, 10, 12e-19},
             {"R3", 19e-6, 27.5e-6, 0.028, 10, 36e-19}};

static struct bridge bridge_of(const char *name)
{
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        if (!strcmp(cases[k].name, name)) {
            const double angle = cases[k].degrees * M_PI / 180;
            return (struct bridge){{cases[k].first, cases[k].second},
                                   {angle, angle},
                                   cases[k].tension,
                                   cases[k].volume};
        }
    fail_msg("no case %s", name);
    return (struct bridge){0};
}

static FILE *open_table(const char *name)
{
    char path[256];
    snprintf(path, sizeof path, "tests/physics/bridges/%s", name);
    FILE *file = fopen(path, "r");
    if (!file) fail_msg("no %s: run from the root of the source", path);
    char head[1024];
    assert_non_null(fgets(head, sizeof head, file));
    return file;
}

static void close_to(double value, double reference, double tolerance, const char *what)
{
    if (!(fabs(value / reference - 1) <= tolerance))
        fail_msg("%s: %.15g, not %.15g", what, value, reference);
}

TEST(exact_forces)
{
    FILE *file = open_table("exact_selected.csv");
    char line[1024], name[8];
    int count = 0;
    while (fgets(line, sizeof line, file)) {
        double gap, force, neck, curvature, angle[2];
        assert_int_equal(sscanf(line, "%7[^,],%*[^,],%*g,%lg,%lg,%*g,%lg,%lg,%lg,%lg",
                                name, &gap, &force, &neck, &curvature, &angle[0],
                                &angle[1]),
                         7);
        const struct bridge bridge = bridge_of(name);
        struct bridge_state is;
        struct reason reason;
        assert_int_equal(bridge_solve(&bridge, gap, &is, &reason), STATUS_OK);
        // Near rupture the reference holds its gap to 4e-10 and the force answers with
        // ten times that.
        close_to(is.force, force, 1e-8, line);
        close_to(is.neck_radius, neck, 1e-8, line);
        close_to(is.suction, 2 * bridge.surface_tension * curvature, 1e-8, line);
        for (int k = 0; k < 2; k++)
            close_to(is.half_filling_angle[k], angle[k], 1e-8, line);
        count++;
    }
    fclose(file);
    assert_true(count >= 70);
}

TEST(exact_ruptures)
{
    FILE *file = open_table("exact_rupture.csv");
    char line[1024], name[8];
    int count = 0;
    while (fgets(line, sizeof line, file)) {
        double gap;
        assert_int_equal(sscanf(line, "%7[^,],%*g,%*g,%*g,%lg", name, &gap), 2);
        const struct bridge bridge = bridge_of(name);
        struct bridge_state is;
        struct reason reason;
        assert_int_equal(bridge_solve_rupture(&bridge, &is, &reason), STATUS_OK);
        close_to(is.separation, gap, 1e-8, line);
        count++;
    }
    fclose(file);
    assert_int_equal(count, 6);
}

static int model_of(const char *name)
{
    static const char *const yade[BRIDGE_MODELS] = {[BRIDGE_WEIGERT] = "Weig",
                                                    [BRIDGE_WILLETT_FULL] = "WilF",
                                                    [BRIDGE_WILLETT_REDUCED] = "WilR",
                                                    [BRIDGE_RABINOVICH] = "Rab",
                                                    [BRIDGE_RABINOVICH_LAMBERT] =
                                                        "RabL",
                                                    [BRIDGE_SOULIE] = "Soulie"};
    for (int k = 0; k < BRIDGE_MODELS; k++)
        if (yade[k] && !strcmp(yade[k], name)) return k;
    fail_msg("no model %s", name);
    return -1;
}

// All of Yade's forces where it still has a bridge.
TEST(models_as_in_yade)
{
    FILE *file = open_table("yade_curves.csv");
    char line[256], name[8], model[8];
    int count[BRIDGE_MODELS] = {0};
    double worst = 0;
    while (fgets(line, sizeof line, file)) {
        double gap, force;
        int bridged;
        assert_int_equal(sscanf(line, "%7[^,],%7[^,],%*[^,],%*g,%lg,%lg,%d", name,
                                model, &gap, &force, &bridged),
                         5);
        if (!bridged || !(force > 0)) continue;
        const struct bridge bridge = bridge_of(name);
        const int which = model_of(model);
        unsigned flags;
        const double ours = bridge_model_force(&bridge, which, gap, &flags);
        // Below 3e-5 effective radii cubed we hold Willett's coefficients; Yade does
        // not.
        if (which == BRIDGE_WILLETT_FULL && flags & BRIDGE_VOLUME) continue;
        worst = fmax(worst, fabs(ours / force - 1));
        // Yade takes the difference of near-equal numbers in [G 10].
        close_to(ours, force, 5e-12, line);
        count[which]++;
    }
    fclose(file);
    print_message("# furthest from Yade: %.1e\n", worst);
    for (int k = BRIDGE_WEIGERT; k < BRIDGE_MODELS; k++)
        assert_true(count[k] > 300);
}
