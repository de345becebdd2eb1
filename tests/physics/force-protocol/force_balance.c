// SPDX-License-Identifier: GPL-3.0-or-later
// Balanced pulls in diagrams of scattered grains: each throat in balance, grains at
// rest while all is wet, and nothing nearer to the form.
#include "force-protocol/balance.h"
#include "wedge_scene.h"

static struct sectors wedges_of(const struct network *network)
{
    struct sectors sectors;
    struct reason reason;
    if (sectors_find(network, &sectors, &reason)) fail_msg("%s", reason.text);
    return sectors;
}

static double product(const struct patches *a, const struct patches *b)
{
    double sum = 0;
    assert_int_equal(a->n, b->n);
    for (int k = 0; k < a->n; k++) {
        assert_int_equal(a->patch[k].throat, b->patch[k].throat);
        assert_int_equal(a->patch[k].particle, b->patch[k].particle);
        sum += dot(a->patch[k].pull, b->patch[k].pull);
    }
    return sum;
}

static struct patches balanced(struct sectors *sectors, enum form form, double *change)
{
    struct patches patches;
    struct reason reason;
    if (find_balanced_patches(sectors, form, false, &patches, change, &reason))
        fail_msg("%s", reason.text);
    return patches;
}

static struct vector pull_on(const struct patches *patches, int throat, int grain)
{
    struct vector pull = {0};
    for (int k = patches->begin[grain]; k < patches->begin[grain + 1]; k++)
        if (patches->patch[k].throat == throat)
            pull = add(pull, patches->patch[k].pull);
    return pull;
}

// Forces, and moments about the throat, of all throats that neither walls nor auxiliary
// grains are beside. Returns how many.
static int check_throats(struct sectors *sectors, const struct patches *patches)
{
    int count = 0;
    for (int t = 0; t < sectors->network->n_throat; t++) {
        struct vector force = {0}, moment = {0};
        bool alone = true;
        const int n = sectors_at(sectors, t);
        for (int k = 0; k < n; k++) {
            const struct sector *sector = &sectors->sector[k];
            bool known = false;
            for (int other = 0; other < k; other++)
                known |= sectors->sector[other].grain == sector->grain;
            alone &= sector->beyond >= 0 &&
                     !is_auxiliary(&sectors->network->packing, sector->grain);
            if (known || !alone) continue;
            const struct vector middle = scale(0.5, add(sector->from, sector->to));
            const struct vector pull = pull_on(patches, t, sector->grain);
            force = add(force, pull);
            moment = add(moment, cross(subtract(sector->centre, middle), pull));
        }
        if (!alone) continue;
        assert_within(norm(force), 0, 1e-12);
        assert_within(norm(moment), 0, 1e-12);
        count++;
    }
    return count;
}

static double rest_of(const struct patches *patches, int grain)
{
    struct vector sum = {0};
    for (int k = patches->begin[grain]; k < patches->begin[grain + 1]; k++)
        sum = add(sum, patches->patch[k].pull);
    return norm(sum);
}

// FORM_FACES is in balance as it is. What is changed of the solid angles is orthogonal
// to it and to what becomes of them, so that nothing in balance is nearer.
static void check_balance(struct sectors *sectors)
{
    double change, none;
    struct patches form = find_patches(sectors, FORM_SOLID_ANGLE);
    struct patches faces = find_patches(sectors, FORM_FACES);
    struct patches near = balanced(sectors, FORM_SOLID_ANGLE, &change);
    struct patches same = balanced(sectors, FORM_FACES, &none);
    assert_within(none, 0, 1e-12);
    assert_within(product(&same, &same), product(&same, &faces), 0);
    const double all = product(&form, &form);
    assert_close(product(&faces, &near), product(&faces, &form), 1e-12);
    assert_close(product(&near, &near), product(&near, &form), 1e-12);
    assert_close(change, sqrt(1 - product(&near, &near) / all), 1e-9);
    assert_true(change > 0.01);
    assert_true(check_throats(sectors, &near) > 40);
    int closed = 0;
    for (int i = 0; i < sectors->network->packing.n_particle; i++) {
        if (rest_of(&form, i) > 1e-12) continue;
        assert_within(rest_of(&near, i), 0, 1e-12);
        closed += near.begin[i] < near.begin[i + 1];
    }
    assert_true(closed > 4);
    patches_free(&form);
    patches_free(&faces);
    patches_free(&near);
    patches_free(&same);
}

TEST(balance_is_the_nearest_there_is)
{
    for (int s = 0; s < N_SCENE; s++) {
        struct network network = diagram_of(&scenes[s], 1);
        struct sectors sectors = wedges_of(&network);
        check_balance(&sectors);
        sectors_free(&sectors);
        network_free(&network);
    }
}

// Where a grain is around a throat in two repetitions of the box, each has its place:
// else FORM_FACES would not be in balance.
TEST(repetitions_are_grains_of_their_own)
{
    const struct scene narrow = {false, {1, 1, 0}, BOUNDARY_TRUNCATE, IN_A_NARROW_BOX};
    struct network network = diagram_of(&narrow, 1);
    struct sectors sectors = wedges_of(&network);
    int twice = 0;
    for (int t = 0; t < network.n_throat; t++) {
        int same = 0;
        const int n = sectors_at(&sectors, t);
        for (int k = 0; k < n; k++)
            same += sectors.sector[k].grain == sectors.sector[0].grain;
        twice += same > 2;
    }
    assert_true(twice > 5);
    for (int scaled = 0; scaled < 2; scaled++) {
        double change;
        struct patches patches = balanced(&sectors, FORM_FACES, &change);
        assert_within(change, 0, 1e-12);
        patches_free(&patches);
        resize(&network, 0x1p-30);
    }
    sectors_free(&sectors);
    network_free(&network);
}

static void check_scale(const struct scene *scene, int power)
{
    struct network network = diagram_of(scene, 2);
    struct sectors sectors = wedges_of(&network);
    double change, scaled_change;
    struct patches patches = balanced(&sectors, FORM_SOLID_ANGLE, &change);
    resize(&network, ldexp(1, power));
    struct patches scaled = balanced(&sectors, FORM_SOLID_ANGLE, &scaled_change);
    assert_true(change == scaled_change);
    assert_int_equal(patches.n, scaled.n);
    for (int k = 0; k < scaled.n; k++) {
        const struct vector wanted = scale(ldexp(1, 2 * power), patches.patch[k].pull);
        assert_true(distance(scaled.patch[k].pull, wanted) == 0);
    }
    patches_free(&patches);
    patches_free(&scaled);
    sectors_free(&sectors);
    network_free(&network);
}

// In nanometres and in gigametres the same bits.
TEST(balance_does_not_depend_on_scale)
{
    for (int s = 0; s < N_SCENE; s++) {
        check_scale(&scenes[s], -30);
        check_scale(&scenes[s], 30);
    }
}
