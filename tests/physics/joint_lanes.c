// SPDX-License-Identifier: GPL-3.0-or-later
// Joints under eight loads side by side (joint_lanes.h): each lane is what the joints
// are one by one, and its bytes are the same whatever vectors it is found by.
#include "../random.h"
#include "../test.h"

#include <string.h>

// Vectors of two numbers, which every machine has, by plain C.
#define BYTES 16
#define NAMED(name) name##_of_two
#include "dem-replay/joint_lanes_of.h"

enum { N = 40, JOINTS = 300 };

// Either leads in some lanes.
static const struct bond_strength strength = {.normal = 0.35, .shear = 0.2};

struct scene {
    struct joint joint[JOINTS];
    double from[JOINTS][STRAINS], moved[N * GRAIN], load[N * GRAIN];
    struct displacement began[N];
};

struct answer {
    uint8_t touches[JOINTS];
    double left[N * GRAIN];
    struct lane_sums sums;
};

static double chance(uint64_t *state)
{
    return 2 * next_random(state) - 1;
}

static struct vector any_vector(uint64_t *state)
{
    return (struct vector){chance(state), chance(state), chance(state)};
}

// Bonded, or not, or gone, of two grains or at the wall; without friction.
static struct joint any_joint(uint64_t *state)
{
    struct joint joint = {
        .grain = {(int32_t)(N * next_random(state)), (int32_t)(N * next_random(state))},
        .is_bonded = next_random(state) < 0.6,
        .is_gone = next_random(state) < 0.1,
        .arm = {next_random(state), next_random(state)},
        .overlap = chance(state),
        .bond_radius = 0.5 + next_random(state),
        .contact_along = next_random(state)};
    if (next_random(state) < 0.1) joint.grain[1] = -1;
    for (int k = 0; k < STRAINS; k++)
        joint.bond_stiffness[k] = next_random(state);
    joint.bond_stiffness[STRAIN_ACROSS + 1] = joint.bond_stiffness[STRAIN_ACROSS];
    joint.bond_stiffness[STRAIN_BEND + 1] = joint.bond_stiffness[STRAIN_BEND];
    const struct vector n = any_vector(state), s = cross(n, any_vector(state));
    joint.axis[0] = scale(1 / norm(n), n);
    joint.axis[1] = scale(1 / norm(s), s);
    joint.axis[2] = cross(joint.axis[0], joint.axis[1]);
    return joint;
}

static struct scene *any_scene(uint64_t state)
{
    struct scene *scene = NEW_ARRAY(struct scene, 1);
    for (int j = 0; j < JOINTS; j++) {
        scene->joint[j] = any_joint(&state);
        for (int k = 0; k < STRAINS; k++)
            scene->from[j][k] = chance(&state);
    }
    for (int k = 0; k < N * GRAIN; k++) {
        scene->moved[k] = chance(&state);
        scene->load[k] = chance(&state);
    }
    for (int i = 0; i < N; i++)
        scene->began[i] = (struct displacement){any_vector(&state), any_vector(&state)};
    return scene;
}

static struct answer *answer_by(const struct lane_kernels *kernels,
                                const struct scene *scene)
{
    struct answer *a = NEW_ARRAY(struct answer, 1);
    kernels->touch(JOINTS, scene->joint, scene->from, scene->moved, a->touches);
    memcpy(a->left, scene->load, sizeof a->left);
    kernels->resist(JOINTS, scene->joint, scene->from, &strength, scene->moved, a->left,
                    &a->sums);
    for (int i = 0; i < N; i++)
        kernels->measure(i, &scene->began[i], scene->moved, a->left, &a->sums);
    return a;
}

static struct displacement of_lane(const double *grain, int lane)
{
    struct displacement of;
    double *number = &of.shift.x;
    for (int k = 0; k < DEGREES; k++)
        number[k] = grain[k * LANES + lane];
    return of;
}

static struct displacement sum_of(struct displacement a, struct displacement b)
{
    return (struct displacement){add(a.shift, b.shift), add(a.turn, b.turn)};
}

static double size_of(struct displacement a)
{
    return fmax(norm(a.shift), norm(a.turn));
}

// What joint J does in LANE, and adds to the sums of that lane.
static void resist_alone(const struct scene *scene, int j, int lane,
                         struct displacement *left, const struct answer *a,
                         struct lane_sums *sums)
{
    const struct joint *joint = &scene->joint[j];
    struct displacement end[2];
    for (int k = 0; k < 2; k++)
        if (joint->grain[k] >= 0)
            end[k] = of_lane(scene->moved + joint->grain[k] * GRAIN, lane);
    double strain[STRAINS];
    joint_strains(joint, &end[0], joint->grain[1] < 0 ? NULL : &end[1], strain);
    for (int k = 0; k < STRAINS; k++)
        strain[k] += scene->from[j][k];
    assert_int_equal(a->touches[j] >> lane & 1, strain[STRAIN_ALONG] <= joint->overlap);
    if (joint->is_gone) return;
    const struct resistance resistance = joint_resistance(joint, strain);
    const double *load = resistance.load;
    joint_take_off(joint, load, left);
    const double force = norm((struct vector){load[0], load[1], load[2]});
    sums->carried[lane] += force;
    sums->carrying[lane] += force > 0 || joint->is_bonded;
    if (!joint->is_bonded) return;
    const struct overload overload =
        joint_overload(joint, strain, strength.normal, strength.shear);
    sums->overload[lane] =
        fmax(sums->overload[lane], fmax(overload.normal, overload.shear));
}

static void check_lane(const struct scene *scene, const struct answer *a, int lane)
{
    const double near = 1e-13; // of sums of a hundred numbers of order 1
    struct displacement left[N];
    struct lane_sums sums = {.carried = {0}};
    for (int i = 0; i < N; i++)
        left[i] = of_lane(scene->load + i * GRAIN, lane);
    for (int j = 0; j < JOINTS; j++)
        resist_alone(scene, j, lane, left, a, &sums);
    for (int i = 0; i < N; i++) {
        const struct displacement got = of_lane(a->left + i * GRAIN, lane);
        assert_within(norm(subtract(got.shift, left[i].shift)), 0, 100 * near);
        assert_within(norm(subtract(got.turn, left[i].turn)), 0, 100 * near);
        sums.unbalanced[lane] += norm(left[i].shift);
        sums.left[lane] = fmax(sums.left[lane], size_of(left[i]));
        const struct displacement moved = of_lane(scene->moved + i * GRAIN, lane);
        sums.furthest[lane] =
            fmax(sums.furthest[lane], size_of(sum_of(scene->began[i], moved)));
    }
    assert_close(a->sums.carried[lane], sums.carried[lane], near);
    assert_close(a->sums.carrying[lane], sums.carrying[lane], 0);
    assert_close(a->sums.overload[lane], sums.overload[lane], near);
    assert_close(a->sums.unbalanced[lane], sums.unbalanced[lane], near);
    assert_close(a->sums.left[lane], sums.left[lane], near);
    assert_close(a->sums.furthest[lane], sums.furthest[lane], near);
}

static void each_lane_is_the_joints_one_by_one(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed < 6; seed++) {
        struct scene *scene = any_scene(seed);
        struct answer *answer = answer_by(&lane_kernels_narrow, scene);
        for (int lane = 0; lane < LANES; lane++)
            check_lane(scene, answer, lane);
        free(answer);
        free(scene);
    }
}

static void check_width(const struct lane_kernels *kernels)
{
    for (uint64_t seed = 1; seed < 6; seed++) {
        struct scene *scene = any_scene(seed);
        struct answer *by_two = answer_by(&lane_kernels_of_two, scene);
        struct answer *by_other = answer_by(kernels, scene);
        assert_memory_equal(by_two, by_other, sizeof *by_two);
        free(by_two);
        free(by_other);
        free(scene);
    }
}

static void vectors_of_four(void **state)
{
    (void)state;
    check_width(&lane_kernels_narrow);
}

static void vectors_of_eight(void **state)
{
    (void)state;
    check_width(&lane_kernels_wide);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_lane_is_the_joints_one_by_one),
        cmocka_unit_test(vectors_of_four),
        UNIT_TEST_WHERE(has_wide_vectors(), "no wide vectors here", vectors_of_eight)};
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
