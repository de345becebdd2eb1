// SPDX-License-Identifier: GPL-3.0-or-later
// Connected cracks and fragments against a search from grain to grain, cracks that span
// or lead around a box that repeats, strains put in and found again.
#include "crack_lattice.h"
#include "crackstats/clusters.h"
#include "crackstats/deformation.h"
#include "crackstats/fragment_counts.h"
#include "crackstats/orientation.h"

#include <gsl/gsl_rng.h>

// ---- brute force --------------------------------------------------------------------

static bool share_a_grain(const int32_t a[2], const int32_t b[2])
{
    return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
}

// Marks all cracks that hang together with crack K, and counts them.
static int visit_cracks(const struct run *run, int k, bool *seen)
{
    seen[k] = true;
    int count = 1;
    for (int j = 0; j < run->n_crack; j++)
        if (!seen[j] && share_a_grain(run->packing.bond[run->bond[k]],
                                      run->packing.bond[run->bond[j]]))
            count += visit_cracks(run, j, seen);
    return count;
}

static int visit_grains(const struct packing *packing, const uint8_t *intact, int i,
                        bool *seen)
{
    seen[i] = true;
    int count = 1;
    for (int b = 0; b < packing->n_bond; b++) {
        const int32_t *pair = packing->bond[b];
        if (!intact[b] || (pair[0] != i && pair[1] != i)) continue;
        const int other = pair[0] == i ? pair[1] : pair[0];
        if (!seen[other]) count += visit_grains(packing, intact, other, seen);
    }
    return count;
}

static int by_size(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

static void assert_same_sizes(struct sizes found, struct sizes wanted)
{
    assert_int_equal(found.count, wanted.count);
    if (!found.count) return;
    qsort(found.size, (size_t)found.count, sizeof(int), by_size);
    qsort(wanted.size, (size_t)wanted.count, sizeof(int), by_size);
    assert_memory_equal(found.size, wanted.size, (size_t)found.count * sizeof(int));
}

static void compare_with_brute_force(const struct run *run)
{
    struct sizes found = {0}, wanted = {0};
    bool seen[1000] = {false};
    const struct clusters clusters = find_clusters(run, &found);
    for (int k = 0; k < run->n_crack; k++)
        if (!seen[k]) add_size(&wanted, visit_cracks(run, k, seen));
    assert_same_sizes(found, wanted);
    assert_int_equal(clusters.count, found.count);
    assert_int_equal(clusters.largest, found.count ? found.size[found.count - 1] : 0);

    found.count = wanted.count = 0;
    memset(seen, 0, sizeof seen);
    uint8_t *intact = bonds_left(run);
    const struct fragment_counts pieces =
        count_fragments(&run->packing, intact, &found);
    for (int i = 0; i < run->packing.n_particle; i++)
        if (!seen[i]) add_size(&wanted, visit_grains(&run->packing, intact, i, seen));
    assert_same_sizes(found, wanted);
    assert_int_equal(pieces.count, found.count);
    assert_int_equal(pieces.largest, found.size[found.count - 1]);
    int single = 0;
    while (single < found.count && found.size[single] == 1)
        single++;
    assert_int_equal(pieces.single, single);
    free(intact);
    free(found.size);
    free(wanted.size);
}

TEST(clusters_and_fragments_by_brute_force)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int trial = 0; trial < 60; trial++) {
        struct run run = lattice(4, 3, 5, trial % 2);
        const double share = gsl_rng_uniform(rng);
        for (int b = 0; b < run.packing.n_bond; b++)
            if (gsl_rng_uniform(rng) < share) crack(&run, b);
        compare_with_brute_force(&run);
        run_free(&run);
    }
    gsl_rng_free(rng);
}

// ---- spanning -----------------------------------------------------------------------

static struct clusters clusters_of(const struct run *run)
{
    struct sizes sizes = {0};
    const struct clusters found = find_clusters(run, &sizes);
    free(sizes.size);
    return found;
}

// All bonds between the first two layers: spans both ways along them, not across.
TEST(a_layer_of_cracks_spans_along_itself)
{
    struct run run = lattice(5, 4, 6, false);
    for (int i = 0; i < 20; i++)
        crack(&run, bond_between(&run, i, i + 20));
    // Parallel bonds share no grain: one bond across holds each row together.
    struct clusters found = clusters_of(&run);
    assert_int_equal(found.count, 20);
    assert_false(found.spans[0] || found.spans[1] || found.spans[2]);
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 4; x++)
            crack(&run, bond_between(&run, 5 * y + x, 5 * y + x + 1));
    for (int y = 0; y < 3; y++)
        crack(&run, bond_between(&run, 5 * y, 5 * y + 5));
    found = clusters_of(&run);
    assert_int_equal(found.count, 1);
    assert_int_equal(found.largest, 20 + 16 + 3);
    assert_true(found.spans[0] && found.spans[1] && !found.spans[2]);
    run_free(&run);
}

// A row of broken bonds through a box that repeats spans once it comes back to itself.
TEST(cracks_that_lead_around_the_box)
{
    struct run run = lattice(5, 2, 2, true);
    for (int x = 0; x < 4; x++)
        crack(&run, bond_between(&run, x, x + 1));
    assert_false(clusters_of(&run).spans[0]);
    crack(&run, bond_between(&run, 0, 4));
    assert_true(clusters_of(&run).spans[0]);
    run_free(&run);
    // Back and forth across the side of the box, around no box.
    run = lattice(5, 2, 2, true);
    crack(&run, bond_between(&run, 0, 4));
    crack(&run, bond_between(&run, 4, 9));
    crack(&run, bond_between(&run, 5, 9));
    crack(&run, bond_between(&run, 0, 5));
    assert_int_equal(clusters_of(&run).count, 1);
    assert_false(clusters_of(&run).spans[0]);
    run_free(&run);
}

// Whether a walk over broken bonds from grain I, which is X boxes along, comes to some
// grain in two boxes.
static bool leads_around(const struct run *run, int i, int x, int *box, bool *seen)
{
    if (seen[i]) return box[i] != x;
    seen[i] = true;
    box[i] = x;
    bool around = false;
    for (int k = 0; k < run->n_crack; k++) {
        const int32_t *pair = run->packing.bond[run->bond[k]];
        if (pair[0] != i && pair[1] != i) continue;
        const int other = pair[pair[0] == i];
        const double apart =
            run->packing.position[other].x - run->packing.position[i].x;
        const int over = apart > 1.5 ? -1 : apart < -1.5 ? 1 : 0;
        around |= leads_around(run, other, x + over, box, seen);
    }
    return around;
}

TEST(leading_around_by_walking)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_around = 0;
    for (int trial = 0; trial < 200; trial++) {
        struct run run = lattice(4, 3, 4, true);
        const double share = 0.2 + 0.3 * gsl_rng_uniform(rng);
        for (int b = 0; b < run.packing.n_bond; b++)
            if (gsl_rng_uniform(rng) < share) crack(&run, b);
        int box[48];
        bool seen[48] = {false}, around = false;
        for (int i = 0; i < 48; i++)
            if (!seen[i]) around |= leads_around(&run, i, 0, box, seen);
        assert_int_equal(clusters_of(&run).spans[0], around);
        n_around += around;
        run_free(&run);
    }
    assert_in_range(n_around, 50, 150);
    gsl_rng_free(rng);
}

// ---- deformation --------------------------------------------------------------------

static const double stretch[3][3] = {
    {-0.02, 0.003, 0.001}, {-0.001, -0.05, 0.004}, {0.002, -0.006, 0.01}};

static struct vector displaced(struct vector x, double times)
{
    struct vector u = {0.3, -0.2, 0.1};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            set_component(&u, i,
                          component(u, i) + times * stretch[i][j] * component(x, j));
    return u;
}

static void displace(struct run *run, double times)
{
    const int n = run->packing.n_particle;
    run->n_snapshot = 1;
    run->displacement = NEW_ARRAY(struct vector, n);
    run->intact = bonds_left(run);
    for (int i = 0; i < n; i++)
        run->displacement[i] = displaced(run->packing.position[i], times);
}

TEST(a_homogeneous_strain_is_found_again)
{
    struct run run = lattice(4, 3, 5, false);
    displace(&run, 1);
    const struct deformation found = body_deformation(&run, 0);
    const double strain[STRAIN_COUNT] = {-0.02, -0.05, 0.01, -0.001, 0.0015, 0.001};
    for (int k = 0; k < STRAIN_COUNT; k++)
        assert_within(found.strain[k], strain[k], 1e-14);
    // 1 - det of 1 + stretch, by hand.
    const double determinant = 0.98 * (0.95 * 1.01 + 0.006 * 0.004) -
                               0.003 * (-0.001 * 1.01 - 0.004 * 0.002) +
                               0.001 * (0.001 * 0.006 - 0.95 * 0.002);
    assert_within(found.shrinkage, 1 - determinant, 1e-14);
    run_free(&run);
}

TEST(small_strains_keep_their_digits)
{
    struct run run = lattice(4, 3, 5, false);
    displace(&run, 1e-9);
    for (int i = 0; i < run.packing.n_particle; i++) // the shift alone would drown them
        run.displacement[i] =
            subtract(run.displacement[i], (struct vector){0.3, -0.2, 0.1});
    const double trace = 1e-9 * (-0.02 - 0.05 + 0.01);
    assert_within(body_deformation(&run, 0).shrinkage / -trace, 1, 2e-6);
    run_free(&run);
}

// Grains broken off do not count, however far they fly; in one layer the strain across
// it is not known and 0.
TEST(only_the_largest_fragment_counts)
{
    struct run run = lattice(4, 1, 5, false);
    crack(&run, bond_between(&run, 0, 1));
    crack(&run, bond_between(&run, 0, 4));
    displace(&run, 1);
    run.displacement[0] = (struct vector){1e6, -1e7, 1e5};
    const struct deformation found = body_deformation(&run, 0);
    assert_within(found.strain[0], -0.02, 1e-14);
    assert_within(found.strain[2], 0.01, 1e-14);
    assert_within(found.strain[1], 0, 1e-14);
    run_free(&run);
}

// As many unknowns as grains give.
TEST(four_grains_have_one)
{
    struct run run = lattice(2, 2, 2, false);
    for (int b = 0; b < run.packing.n_bond; b++) {
        const int32_t *pair = run.packing.bond[b];
        if (pair[0] != 0 || (pair[1] & (pair[1] - 1))) crack(&run, b);
    }
    displace(&run, 1);
    run.displacement[7] = (struct vector){1e6, -1e7, 1e5};
    assert_within(body_deformation(&run, 0).strain[5], 0.001, 1e-13);
    run_free(&run);
}

TEST(three_grains_have_no_strain)
{
    struct run run = lattice(3, 1, 1, false);
    displace(&run, 1);
    assert_true(isnan(body_deformation(&run, 0).shrinkage));
    run_free(&run);
}

// The planes 4, 5, 0, 1 of six, whole across the side of the box: it shrinks as it
// would within the box. A body around the box keeps its length, wherever the box
// begins.
TEST(fragments_across_a_side_are_whole)
{
    struct run run = lattice(6, 3, 5, true);
    for (int b = 0; b < run.packing.n_bond; b++) {
        const int32_t *pair = run.packing.bond[b];
        if (pair[1] != pair[0] + 1) continue; // along x, within the box
        if (pair[0] % 6 == 1 || pair[0] % 6 == 3) crack(&run, b);
    }
    displace(&run, 1);
    for (int i = 0; i < run.packing.n_particle; i++) {
        struct vector place = run.packing.position[i];
        if (i % 6 < 2) place.x += 6;
        run.displacement[i] = displaced(place, 1);
    }
    const struct deformation found = body_deformation(&run, 0);
    const double strain[STRAIN_COUNT] = {-0.02, -0.05, 0.01, -0.001, 0.0015, 0.001};
    for (int k = 0; k < STRAIN_COUNT; k++)
        assert_within(found.strain[k], strain[k], 1e-14);
    run_free(&run);

    for (int begin = 0; begin < 6; begin++) {
        run = lattice(6, 3, 5, true);
        displace(&run, 1);
        for (int i = 0; i < run.packing.n_particle; i++) {
            run.displacement[i].x = 0.01 * sin((i % 6 + begin) * M_PI / 3);
            run.displacement[i].y = -0.05 * run.packing.position[i].y;
        }
        const struct deformation around = body_deformation(&run, 0);
        assert_within(around.strain[0], 0, 1e-14);
        assert_within(around.strain[1], -0.05, 1e-14);
        run_free(&run);
    }
}

// ---- orientation --------------------------------------------------------------------

TEST(upright_and_level_cracks)
{
    struct run run = lattice(3, 3, 3, false);
    crack(&run, bond_between(&run, 0, 9));
    crack(&run, bond_between(&run, 0, 1));
    run.mode[1] = MODE_SHEAR;
    struct orientation found = {0};
    add_orientation(&found, &run);
    assert_within(found.bonds[0], 18, 0);
    assert_within(found.bonds[INCLINATION_CLASSES - 1], 36, 0);
    assert_within(found.cracks[0][MODE_NORMAL], 1, 0);
    assert_within(found.cracks[INCLINATION_CLASSES - 1][MODE_SHEAR], 1, 0);
    assert_within(found.fabric[MODE_NORMAL][8], 1, 0);
    assert_within(found.fabric[MODE_SHEAR][0], 1, 0);
    run_free(&run);
}

// The fabric of one crack is n n, however long the bond and from whichever end; a bond
// down is as steep as one up.
TEST(oblique_cracks)
{
    for (int up = -1; up <= 1; up += 2) {
        struct run run = lattice(2, 1, 1, false);
        run.packing.position[1] =
            add(run.packing.position[0], (struct vector){2 * up, 3 * up, 6 * up});
        crack(&run, 0);
        struct orientation found = {0};
        add_orientation(&found, &run);
        const double n[3] = {2. / 7, 3. / 7, 6. / 7};
        for (int i = 0; i < 9; i++)
            assert_within(found.fabric[MODE_NORMAL][i], n[i / 3] * n[i % 3], 1e-15);
        const double angle = acos(6. / 7) / M_PI_2;
        assert_within(found.cracks[(int)(angle * INCLINATION_CLASSES)][MODE_NORMAL], 1,
                      0);
        run.packing.position[1] = run.packing.position[0]; // has no direction
        add_orientation(&found, &run);
        assert_within(found.fabric[MODE_NORMAL][8], n[2] * n[2], 1e-15);
        run_free(&run);
    }
}
