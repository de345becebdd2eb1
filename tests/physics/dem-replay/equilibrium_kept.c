// SPDX-License-Identifier: GPL-3.0-or-later
// An equilibrium that is given up after any of its loads, and gone on with from what
// was kept then, ends in the same bytes (dem-replay, --checkpoint).
#include "equilibrium_scene.h"

#include "basics/memory.h"

#include <string.h>

enum { LOADS = 12 };

struct scene {
    const char *name;
    bool is_large, is_free;
    enum dem_bond_kind bond;
    double friction, strength; // N/m2, or N of contact bonds
    double size;               // N
};

// Pulled about, more and more, so that contacts slip, open and close.
static void load_scene(const struct scene *scene, int load, struct vector force[BLOCK])
{
    for (int i = 0; i < BLOCK; i++) {
        const double x = i % SIDE - 1, y = i / SIDE % SIDE - 1;
        const double more = sin(0.9 * load + i), size = scene->size * (1 + 0.5 * load);
        force[i] = (struct vector){size * (more - x), size * (0.5 - more * y),
                                   size * (0.6 * more - 0.8)};
    }
}

static struct quasi_static *begin(const struct scene *scene, const struct block *block)
{
    static double strength[3 * BLOCK]; // of bonds, relative
    for (int b = 0; b < block->packing.n_bond; b++)
        strength[b] = 1 + 0.9 * sin(b * b);
    struct quasi_static_setup setup = block->setup;
    setup.relative_strength = strength;
    setup.material.friction = scene->friction;
    setup.is_free = scene->is_free;
    setup.bond.kind = scene->bond;
    setup.bond.normal_strength = setup.bond.shear_strength = scene->strength;
    setup.tolerance = 1e-8;
    setup.rolling = 1e-3;
    setup.large_displacements = scene->is_large;
    setup.increment = 0.02;
    return make_equilibrium(&setup);
}

// A file holds no others.
static void assert_finite(const struct scene *scene, const struct array_list *list)
{
    for (int k = 0; k < list->count; k++) {
        const double *number = list->array[k].data;
        if (list->array[k].type != ARRAY_FLOAT64) continue;
        for (int64_t l = 0; l < list->array[k].count; l++)
            if (!isfinite(number[l]))
                fail_msg("%s: %s holds %g", scene->name, list->array[k].name,
                         number[l]);
    }
}

static void go_on(const struct scene *scene, const struct block *block,
                  struct quasi_static **equilibrium)
{
    struct reason reason = {""};
    struct array_list list = quasi_static_save(*equilibrium);
    assert_finite(scene, &list);
    quasi_static_free(*equilibrium);
    *equilibrium = begin(scene, block);
    if (quasi_static_restore(*equilibrium, &list, &reason)) fail_msg("%s", reason.text);
    free_arrays(list.array, list.count);
}

static void assert_same(const struct scene *scene, int load, struct quasi_static *one,
                        struct quasi_static *other)
{
    struct array_list a = quasi_static_save(one), b = quasi_static_save(other);
    assert_int_equal(a.count, b.count);
    for (int k = 0; k < a.count; k++) {
        const size_t bytes = (size_t)a.array[k].count * number_size(a.array[k].type);
        if (a.array[k].count != b.array[k].count ||
            memcmp(a.array[k].data, b.array[k].data, bytes))
            fail_msg("%s: other %s after load %d", scene->name, a.array[k].name, load);
    }
    free_arrays(a.array, a.count);
    free_arrays(b.array, b.count);
}

// Beside one in one piece, which forgets after as many loads.
static void in_pieces(const struct scene *scene, int between)
{
    struct block *block = new_block();
    if (scene->is_free) memset(block->fixed, 0, sizeof block->fixed);
    struct quasi_static *whole = begin(scene, block), *cut = begin(scene, block);
    for (int load = 0; load < LOADS; load++) {
        struct vector force[BLOCK];
        load_scene(scene, load, force);
        next_equilibrium(whole, force);
        next_equilibrium(cut, force);
        assert_same(scene, load, whole, cut);
        if (load % between) continue;
        quasi_static_drop_cache(whole);
        quasi_static_drop_cache(cut);
        go_on(scene, block, &cut);
    }
    int cracks, last;
    quasi_static_cracks(whole, &cracks);
    print_message(
        "# %s: %d iterations, %d cracks, %d left, %d snaps, %d without rest\n",
        scene->name, quasi_static_iterations(whole), cracks,
        quasi_static_detached(whole, &last), quasi_static_instabilities(whole, &last),
        quasi_static_unconverged(whole, &last));
    quasi_static_free(whole);
    quasi_static_free(cut);
    free_block(block);
}

TEST(the_same_bytes)
{
    const struct scene scene[] = {
        {"small, nothing breaks", false, false, DEM_PARALLEL_BOND, 0.5, INFINITY, 2e-9},
        {"large, nothing breaks", true, false, DEM_PARALLEL_BOND, 0.5, INFINITY, 1e-7},
        {"small, friction", false, false, DEM_PARALLEL_BOND, 0.5, 2e5, 2e-9},
        {"large", true, false, DEM_PARALLEL_BOND, 0, 1e5, 2e-9},
        {"large, friction", true, false, DEM_PARALLEL_BOND, 0.5, 2e5, 2e-9},
        {"large, friction, far", true, false, DEM_PARALLEL_BOND, 0.5, 4e7, 1e-6},
        {"large, nothing held", true, true, DEM_PARALLEL_BOND, 0.5, 6e5, 5e-8},
        {"small, contact bonds", false, false, DEM_CONTACT_BOND, 0.5, 2e-8, 2e-9},
        {"large, contact bonds", true, false, DEM_CONTACT_BOND, 0.5, 2e-8, 2e-9}};
    for (size_t k = 0; k < sizeof scene / sizeof *scene; k++)
        for (int between = 1; between <= 3; between += 2)
            in_pieces(&scene[k], between);
}
