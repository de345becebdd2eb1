// SPDX-License-Identifier: GPL-3.0-or-later
// What the splitting works on: pairs that are near enough to touch. Only these are in
// the patterns of its two matrices, because pairs that stay apart would double the
// numbers in a factor. A pair is near if it has or had a bond, or if its gap is below
// NEAR_GAP,
//     d[NORMAL] - overlap < NEAR_GAP     (mean radii).
// A pair that closes all the same joins them, and both patterns are made again. The
// springs between grains and contacts are as stiff as a bond, or a contact where that
// is softer,
//     rho = mean over bonds of min(bond stiffness, contact stiffness),
// and without bonds 0.01 of the unit of stiffness (contact_splitting.c says why).
#include "splitting_internal.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// The gap below which pairs are near, in mean radii.
static const double NEAR_GAP = 0.02;

void splitting_free(struct splitting *s)
{
    if (!s) return;
    stiffness_free(s->split);
    stiffness_free(s->tangent);
    anderson_normal_free(&s->of_forces);
    anderson_normal_free(&s->of_step);
    void *const owned[] = {s->is_near, s->near,  s->force, s->change, s->place,
                           s->dashpot, s->right, s->part,  s->values, s->across};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free(s);
}

// Of a bond, but of a contact where contacts are softer: the mean over all. Without
// bonds a body is as stiff as its contacts, and rho a hundredth of that.
static double spring_stiffness(const struct quasi_static *qs)
{
    double sum = 0;
    int count = 0;
    for (int j = 0; j < qs->n_pair; j++) {
        if (qs->pair[j].bond < 0) continue;
        sum += fmin(qs->pair[j].bond_stiffness[NORMAL], qs->pair[j].normal_stiffness);
        count++;
    }
    return count > 0 && sum > 0 ? sum / count : 0.01;
}

static void make_matrices(struct quasi_static *qs, struct splitting *s)
{
    stiffness_free(s->split);
    stiffness_free(s->tangent);
    anderson_normal_free(&s->of_forces);
    s->n_near = 0;
    for (int j = 0; j < qs->n_pair; j++)
        if (s->is_near[j]) s->near[s->n_near++] = j;
    struct stiffness **const both[] = {&s->split, &s->tangent};
    for (int k = 0; k < 2; k++)
        *both[k] =
            stiffness_create(qs->n, qs->setup.fixed, qs->n_pair, qs->pair, s->is_near);
    s->of_forces = anderson_normal_init(3 * s->n_near, 10);
    s->is_split_stale = true;
}

static bool is_near(const struct contact_pair *pair, const double *deformation)
{
    return pair->bond >= 0 || deformation[NORMAL] - pair->overlap < NEAR_GAP;
}

struct splitting *splitting_create(struct quasi_static *qs)
{
    struct splitting *s = NEW_ARRAY(struct splitting, 1);
    const size_t n = (size_t)qs->n_pair;
    s->is_near = NEW_ARRAY(bool, n);
    s->near = NEW_ARRAY(int32_t, n);
    s->force = NEW_ARRAY(double, 3 * n);
    s->change = NEW_ARRAY(double, 3 * n);
    s->place = allocate(n, sizeof *s->place);
    s->values = allocate(n, sizeof *s->values);
    s->across = NEW_ARRAY(double, n);
    s->dashpot = NEW_ARRAY(double, qs->n);
    s->right = NEW_ARRAY(struct displacement, qs->n);
    s->part = NEW_ARRAY(struct displacement, qs->n);
    s->stiffness = spring_stiffness(qs);
    s->of_step = anderson_normal_init(6 * qs->n, ANDERSON_NORMAL_DEPTH);
    for (int j = 0; j < qs->n_pair; j++)
        s->is_near[j] = is_near(&qs->pair[j], qs->pair[j].deformation);
    make_matrices(qs, s);
    return s;
}

bool add_near_pairs(struct quasi_static *qs, struct splitting *s)
{
    bool any = false;
    for (int j = 0; j < qs->n_pair && !any; j++)
        any = !s->is_near[j] && qs->response[j].contact.state;
    if (!any) return false;
    for (int j = 0; j < qs->n_pair; j++)
        if (is_near(&qs->pair[j], qs->deformation[j])) s->is_near[j] = true;
    make_matrices(qs, s);
    return true;
}
