// SPDX-License-Identifier: GPL-3.0-or-later
// Once for vectors of four numbers, once of eight (BYTES), which are all lanes: each
// number has the same digits in both. NAMED(x) is the name of x.
#include "joint_lanes.h"

#include <math.h>
#include <string.h>
#if defined __AVX__
#include <immintrin.h>
#endif

#define INLINE static inline __attribute__((always_inline))

// Not returned by functions: how that is done depends on the machine.
typedef double lanes __attribute__((vector_size(BYTES), aligned(8)));
typedef int64_t whole __attribute__((vector_size(BYTES), aligned(8)));

// Vectors that the lanes take; longer ones than registers are taken apart by compilers,
// number by number.
enum { NUMBERS = BYTES / sizeof(double), PARTS = LANES / NUMBERS };

static const double unmoved[GRAIN] = {0};

#define AT(grain, degree) (*(const lanes *)((grain) + (degree)*LANES))
#define ALONG(axis, a) ((axis).x * (a)[0] + (axis).y * (a)[1] + (axis).z * (a)[2])

// ---- numbers ------------------------------------------------------------------------

INLINE void take_root(lanes *a)
{
#if defined __AVX512F__ && BYTES == 64
    *a = (lanes)_mm512_sqrt_pd((__m512d)*a);
#elif defined __AVX__ && BYTES == 32
    *a = (lanes)_mm256_sqrt_pd((__m256d)*a);
#else
    for (int l = 0; l < NUMBERS; l++)
        (*a)[l] = sqrt((*a)[l]);
#endif
}

// What is no number is larger than all, and stays: a singular factor must be seen.
INLINE void take_larger(const lanes *a, lanes *most)
{
    const whole is_larger = ~(*a <= *most) & (*most == *most);
    *most = (lanes)((is_larger & (whole)*a) | (~is_larger & (whole)*most));
}

INLINE uint8_t at_most(const lanes *a, double limit)
{
#if defined __AVX512F__ && BYTES == 64
    return (uint8_t)_mm512_cmp_pd_mask((__m512d)*a, _mm512_set1_pd(limit), _CMP_LE_OQ);
#elif defined __AVX__ && BYTES == 32
    return (uint8_t)_mm256_movemask_pd(
        _mm256_cmp_pd((__m256d)*a, _mm256_set1_pd(limit), _CMP_LE_OQ));
#else
    int bits = 0;
    for (int l = 0; l < NUMBERS; l++)
        bits |= ((*a)[l] <= limit) << l;
    return (uint8_t)bits;
#endif
}

// ---- strains ------------------------------------------------------------------------

INLINE const double *end_of(const struct joint *joint, int end, const double *moved)
{
    return joint->grain[end] < 0 ? unmoved : moved + (long)joint->grain[end] * GRAIN;
}

static void touch(int n_joint, const struct joint *joint, const double (*from)[STRAINS],
                  const double *moved, uint8_t *touches)
{
    for (; n_joint-- > 0; joint++, from++, touches++) {
        int bits = 0;
        for (int first = 0; first < LANES; first += NUMBERS) {
            const double *i = end_of(joint, 0, moved + first);
            const double *j = end_of(joint, 1, moved + first);
            const lanes shift[3] = {AT(j, 0) - AT(i, 0), AT(j, 1) - AT(i, 1),
                                    AT(j, 2) - AT(i, 2)};
            const lanes longer = ALONG(joint->axis[0], shift);
            bits |= at_most(&longer, joint->overlap - (*from)[STRAIN_ALONG]) << first;
        }
        *touches = (uint8_t)bits;
    }
}

INLINE void find_strains(const struct joint *joint, const double from[STRAINS],
                         const double *moved, lanes strain[STRAINS])
{
    const double *i = end_of(joint, 0, moved), *j = end_of(joint, 1, moved);
    const struct vector *axis = joint->axis;
    lanes shift[3], turn[3], rolling[3];
    for (int k = 0; k < 3; k++) {
        shift[k] = AT(j, k) - AT(i, k);
        turn[k] = AT(j, 3 + k) - AT(i, 3 + k);
        rolling[k] = joint->arm[0] * AT(i, 3 + k) + joint->arm[1] * AT(j, 3 + k);
    }
    strain[STRAIN_ALONG] = ALONG(axis[0], shift);
    strain[STRAIN_ACROSS] = ALONG(axis[1], shift) - ALONG(axis[2], rolling);
    strain[STRAIN_ACROSS + 1] = ALONG(axis[2], shift) + ALONG(axis[1], rolling);
    for (int k = 0; k < 3; k++)
        strain[STRAIN_TWIST + k] = ALONG(axis[k], turn);
    for (int k = 0; k < STRAINS; k++)
        strain[k] += from[k];
}

// ---- loads --------------------------------------------------------------------------

INLINE void pull(const struct joint *joint, int end, const lanes load[STRAINS],
                 double *left)
{
    if (joint->grain[end] < 0) return;
    double *of = left + (long)joint->grain[end] * GRAIN;
    const double *n = &joint->axis[0].x, *s = &joint->axis[1].x, *t = &joint->axis[2].x;
    const double sign = end ? 1 : -1, arm = joint->arm[end];
    for (int k = 0; k < 3; k++) {
        lanes *force = (lanes *)(of + k * LANES);
        lanes *moment = (lanes *)(of + (3 + k) * LANES);
        *force -= sign * (n[k] * load[0] + s[k] * load[1] + t[k] * load[2]);
        *moment -= arm * (s[k] * load[2] - t[k] * load[1]) +
                   sign * (n[k] * load[3] + s[k] * load[4] + t[k] * load[5]);
    }
}

INLINE void size_of_two(const lanes a[2], lanes *size)
{
    *size = a[0] * a[0] + a[1] * a[1];
    take_root(size);
}

// [K 4.41, 4.42], of the LOAD of a parallel bond, as joint_overload.
INLINE void find_overload(const struct joint *joint,
                          const struct bond_strength *strength,
                          const lanes load[STRAINS], lanes *most)
{
    const double beta = 1 - joint->moments_left_out;
    const double radius = joint->bond_radius, area = M_PI * radius * radius;
    const double share = strength->relative ? strength->relative[joint->bond] : 1;
    const double normal = 1 / (area * strength->normal * share);
    const double tangential = 1 / (area * strength->shear * share);
    lanes bending, shear;
    size_of_two(load + STRAIN_BEND, &bending);
    size_of_two(load + STRAIN_ACROSS, &shear);
    const lanes minus = -load[STRAIN_TWIST];
    lanes twisting = load[STRAIN_TWIST];
    take_larger(&minus, &twisting);
    const lanes tension = normal * (load[STRAIN_ALONG] + beta * 4 / radius * bending);
    const lanes sliding = tangential * (shear + beta * 2 / radius * twisting);
    take_larger(&tension, most);
    take_larger(&sliding, most);
}

// Of a joint, or of all so far.
struct part {
    lanes carried, carrying, overload;
};

INLINE void resist_part(const struct joint *joint, const double from[STRAINS],
                        const struct bond_strength *strength, const double *moved,
                        double *left, struct part *sum)
{
    lanes load[STRAINS];
    find_strains(joint, from, moved, load);
    const lanes overlap = joint->overlap - load[STRAIN_ALONG];
    for (int k = 0; k < STRAINS; k++)
        load[k] *= joint->is_bonded ? joint->bond_stiffness[k] : 0;
    if (joint->is_bonded) find_overload(joint, strength, load, &sum->overload);
    const lanes push = joint->contact_along * overlap;
    load[STRAIN_ALONG] -= (lanes)((whole)push & (overlap >= 0));
    pull(joint, 0, load, left);
    pull(joint, 1, load, left);
    lanes force = load[0] * load[0] + load[1] * load[1] + load[2] * load[2];
    take_root(&force);
    sum->carried += force;
    const whole carries = (force > 0) | -(int64_t)joint->is_bonded;
    sum->carrying -= __builtin_convertvector(carries, lanes);
}

static void resist(int n_joint, const struct joint *joint,
                   const double (*from)[STRAINS], const struct bond_strength *strength,
                   const double *moved, double *left, struct lane_sums *sums)
{
    struct part sum[PARTS] = {0};
    for (; n_joint-- > 0; joint++, from++) {
        if (joint->is_gone) continue;
        for (int p = 0; p < PARTS; p++)
            resist_part(joint, *from, strength, moved + p * NUMBERS, left + p * NUMBERS,
                        &sum[p]);
    }
    for (int p = 0; p < PARTS; p++) {
        memcpy(sums->carried + p * NUMBERS, &sum[p].carried, BYTES);
        memcpy(sums->carrying + p * NUMBERS, &sum[p].carrying, BYTES);
        memcpy(sums->overload + p * NUMBERS, &sum[p].overload, BYTES);
    }
}

// ---- grains -------------------------------------------------------------------------

INLINE void find_size(const lanes a[3], lanes *size)
{
    *size = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
    take_root(size);
}

// Of the lanes from FIRST on.
INLINE void measure_part(const double *began, const double *moved, const double *left,
                         int first, struct lane_sums *sums)
{
    lanes to[DEGREES], of[DEGREES], size, most, furthest;
    for (int k = 0; k < DEGREES; k++) {
        to[k] = began[k] + AT(moved + first, k);
        of[k] = AT(left + first, k);
    }
    memcpy(&furthest, sums->furthest + first, sizeof furthest);
    memcpy(&most, sums->left + first, sizeof most);
    for (int k = 0; k < DEGREES; k += 3) {
        find_size(to + k, &size);
        take_larger(&size, &furthest);
        find_size(of + k, &size);
        take_larger(&size, &most);
        if (k > 0) continue;
        for (int l = 0; l < NUMBERS; l++)
            sums->unbalanced[first + l] += size[l];
    }
    memcpy(sums->furthest + first, &furthest, sizeof furthest);
    memcpy(sums->left + first, &most, sizeof most);
}

static void measure(int grain, const struct displacement *from, const double *moved,
                    const double *left, struct lane_sums *sums)
{
    for (int first = 0; first < LANES; first += NUMBERS)
        measure_part(&from->shift.x, moved + (long)grain * GRAIN,
                     left + (long)grain * GRAIN, first, sums);
}

const struct lane_kernels NAMED(lane_kernels) = {
    .touch = touch, .resist = resist, .measure = measure};
