// SPDX-License-Identifier: GPL-3.0-or-later
// All joints go on from the last equilibrium as they resist in the factor; those that
// in some lane do not are rows of the corrections, which settle_lane.h finds.
#include "equilibrium_state.h"

#include "basics/memory.h"
#include "joint_lanes.h"
#include "settle_lane.h"

#include <stdlib.h>
#include <string.h>

// Rows go through the factor side by side, a factor is made of smaller products: that
// many multiplications of the ones take the time of one of the other.
static const double row_speed = 2;

struct foresight {
    int n_grain;
    int n_expected; // loads
    const struct vector *force;
    int found, used; // lanes that are known, and of them those that were asked for
    int sight; // lanes to look at: one after a crack, then twice as many each time
    bool has_looked; // since the load, cracks or grains that left changed
    int n_crack, n_gone;
    int factors;               // that there were then
    struct vector *load;       // (n)
    double *applied;           // (n * GRAIN) loads
    double *left;              // (n * GRAIN) to begin with, by the law of the factor
    double *moved, *step;      // (n * GRAIN)
    struct displacement *from; // (n) the last equilibrium when these began
    int n_row, row_capacity;
    struct lane_row *row;
    bool *touches;        // (row_capacity * LANES)
    double *given, *more; // (row_capacity * LANES)
    struct settler *settler;
};

// ---- what is expected ---------------------------------------------------------------

struct foresight *foresight_new(const struct equilibrium *e)
{
    for (int j = 0; j < e->n_joint; j++)
        if (e->joint[j].contact_across > 0 || e->joint[j].is_point) return NULL;
    if (e->setup.large_displacements) return NULL;
    struct foresight *f = NEW_ARRAY(struct foresight, 1);
    f->load = NEW_ARRAY(struct vector, e->n);
    double **const of_grains[] = {&f->applied, &f->left, &f->moved, &f->step};
    for (size_t k = 0; k < sizeof of_grains / sizeof *of_grains; k++)
        *of_grains[k] = allocate_aligned((size_t)e->n, GRAIN * sizeof **of_grains[k]);
    f->from = NEW_ARRAY(struct displacement, e->n);
    f->settler = settler_new();
    return f;
}

void foresight_free(struct foresight *f)
{
    if (!f) return;
    settler_free(f->settler);
    void *const owned[] = {f->load, f->applied, f->left,  f->moved, f->step,
                           f->row,  f->touches, f->given, f->more,  f->from};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free(f);
}

void foresight_expect(struct foresight *f, int count, const struct vector *force)
{
    if (!f) return;
    f->n_expected = count;
    f->force = force;
    f->found = f->used = 0;
    f->sight = LANES;
    f->has_looked = false;
}

void foresight_check(struct foresight *f, int n, const struct vector *force)
{
    if (!f || f->n_expected == 0) return;
    f->n_grain = n;
    if (memcmp(f->force, force, (size_t)n * sizeof *force) != 0)
        foresight_expect(f, 0, NULL);
}

void foresight_go_on(struct foresight *f)
{
    if (!f || f->n_expected == 0) return;
    f->n_expected--;
    f->force += f->n_grain;
    f->used++;
    if (f->used < f->found) return;
    f->has_looked = false;
    f->sight = 2 * f->sight < LANES ? 2 * f->sight : LANES;
}

// ---- the last equilibrium, as factored ----------------------------------------------

static bool holds(const struct joint *joint)
{
    return joint->is_bonded && !joint->is_gone;
}

static void apply_loads(struct equilibrium *e, int count)
{
    struct foresight *f = e->foresight;
    memset(f->applied, 0, (size_t)e->n * GRAIN * sizeof *f->applied);
    for (int l = 0; l < count; l++) {
        loads_of(e, f->force + (long)l * e->n, f->load);
        for (int i = 0; i < e->n; i++) {
            double *to = f->applied + (long)i * GRAIN + l;
            to[0] = f->load[i].x;
            to[LANES] = f->load[i].y;
            to[2 * LANES] = f->load[i].z;
        }
    }
}

// What joints resisted with at the last equilibrium if all were as in the factor.
static void resist_as_factored(const struct equilibrium *e, struct displacement *sum)
{
    memset(sum, 0, (size_t)e->n * sizeof *sum);
    for (int j = 0; j < e->n_joint; j++) {
        const struct joint *joint = &e->joint[j];
        double load[STRAINS] = {0};
        for (int k = 0; k < STRAINS && e->factored[j].is_bonded; k++)
            load[k] = joint->bond_stiffness[k] * joint->strain[k];
        if (e->factored[j].touch)
            load[STRAIN_ALONG] -=
                joint->contact_along * (joint->overlap - joint->strain[STRAIN_ALONG]);
        for (int end = 0; end < 2; end++) {
            if (joint->grain[end] < 0) continue;
            const struct displacement part = joint_loads(joint, end, load);
            struct displacement *of = &sum[joint->grain[end]];
            of->shift = add(of->shift, part.shift);
            of->turn = add(of->turn, part.turn);
        }
    }
}

static bool is_free(const struct equilibrium *e, int grain)
{
    return !e->setup.fixed[grain] && !e->is_gone[grain];
}

static void begin_lanes(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    resist_as_factored(e, e->step);
    for (int i = 0; i < e->n; i++) {
        double number[DEGREES];
        memcpy(number, &e->step[i], sizeof number);
        for (int k = 0; k < GRAIN; k++)
            f->left[(long)i * GRAIN + k] =
                is_free(e, i) ? f->applied[(long)i * GRAIN + k] - number[k / LANES] : 0;
    }
    stiffness_begin_lanes(e->matrix, f->left);
    memset(f->moved, 0, (size_t)e->n * GRAIN * sizeof *f->moved);
}

// ---- rows ---------------------------------------------------------------------------

static void make_room(struct foresight *f, int count)
{
    if (f->row && count <= f->row_capacity) return;
    const size_t n = (size_t)(f->row_capacity = 2 * count + 64);
    f->row = reallocate(f->row, n, sizeof *f->row);
    f->touches = reallocate(f->touches, n * LANES, sizeof *f->touches);
    f->given = reallocate(f->given, n * LANES, sizeof *f->given);
    f->more = reallocate(f->more, n * LANES, sizeof *f->more);
}

static struct lane_row row_of(const struct equilibrium *e, struct unit_load which)
{
    const struct joint *joint = &e->joint[which.joint];
    const struct factored *factored = &e->factored[which.joint];
    const double bond = joint->bond_stiffness[which.strain];
    const bool is_along = which.strain == STRAIN_ALONG;
    return (struct lane_row){
        .strain = joint->strain[which.strain],
        .bond = (holds(joint) - factored->is_bonded) * bond,
        .contact = is_along ? joint->contact_along : 0,
        .closed_to =
            joint->is_gone ? -INFINITY : joint->overlap - joint->strain[STRAIN_ALONG],
        .touched = is_along && factored->touch};
}

// Of all rows of the corrections; those from FIRST on begin as they were.
static void describe_rows(struct equilibrium *e, int first)
{
    struct foresight *f = e->foresight;
    f->n_row = corrections_count(e->corrections);
    make_room(f, f->n_row);
    for (int k = first; k < f->n_row; k++) {
        const struct unit_load which = corrections_row(e->corrections, k);
        f->row[k] = row_of(e, which);
        for (int l = 0; l < LANES; l++)
            f->touches[(long)k * LANES + l] =
                f->row[k].contact > 0 && e->joint[which.joint].contact.touch;
    }
}

// How many of COUNT lanes were settled, from the first on; whether contacts MAY CHANGE,
// or go on as they are; where it IS FIRST each begins as the one before ended.
static int settle_lanes(struct equilibrium *e, int count, bool may_change,
                        bool is_first)
{
    struct foresight *f = e->foresight;
    corrections_strain_lanes(e->corrections, f->given);
    memset(f->more, 0, (size_t)f->n_row * LANES * sizeof *f->more);
    for (int l = 0; l < count; l++) {
        if (!settle_lane(f->settler, e->corrections, f->row, may_change, f->given + l,
                         f->touches + l, f->more + l))
            count = l;
        for (int k = 0; k < f->n_row && is_first && l + 1 < count; k++)
            f->touches[(long)k * LANES + l + 1] = f->touches[(long)k * LANES + l];
    }
    corrections_take_off_lanes(e->corrections, f->more);
    return count;
}

// ---- rounds -------------------------------------------------------------------------

// Joints without a row that are not as factored in one of LANES. COUNT of them in each.
static int list_unlike(struct equilibrium *e, int n_lane, int in_lane[LANES])
{
    int count = 0;
    memset(in_lane, 0, LANES * sizeof *in_lane);
    for (int j = 0; j < e->n_joint; j++) {
        const struct joint *joint = &e->joint[j];
        if (!(joint->contact_along > 0) || joint->is_gone ||
            corrections_of(e->corrections, j) > 0)
            continue;
        lanes more;
        joint_lengthen_lanes(joint, e->foresight->moved, &more);
        const double closed_to = joint->overlap - joint->strain[STRAIN_ALONG];
        const bool touched = e->factored[j].touch;
        int unlike = 0;
        for (int l = 0; l < LANES; l++) {
            const bool is_unlike = l < n_lane && (more[l] <= closed_to) != touched;
            in_lane[l] += is_unlike;
            unlike += is_unlike;
        }
        if (unlike) e->unlike[count++] = (struct correction){j, 1};
    }
    return count;
}

// Bonds that broke and grains that left since the factor was made.
static int list_broken(struct equilibrium *e)
{
    int count = 0;
    for (int j = 0; j < e->n_joint; j++)
        if (e->factored[j].is_bonded && !holds(&e->joint[j]))
            e->unlike[count++] = (struct correction){j, STRAINS};
        else if (e->joint[j].is_gone && e->factored[j].touch)
            e->unlike[count++] = (struct correction){j, 1};
    return count;
}

static bool is_small(const struct equilibrium *e, int lane)
{
    for (int i = 0; i < e->n; i++)
        for (int k = 0; k < DEGREES; k++) {
            const double to = e->foresight->moved[(long)i * GRAIN + k * LANES + lane];
            if (!(fabs(to) < furthest)) return false;
        }
    return true;
}

static bool factor_anew(struct equilibrium *e)
{
    settler_forget(e->foresight->settler);
    if (factor(e)) return true;
    corrections_count_work(e->corrections, INFINITY); // another is due
    return false;
}

// What is left where the grains have MOVED, in LEFT; the most in any of COUNT lanes.
static double find_left(struct equilibrium *e, int count)
{
    struct foresight *f = e->foresight;
    memcpy(f->left, f->applied, (size_t)e->n * GRAIN * sizeof *f->left);
    for (int j = 0; j < e->n_joint; j++) {
        lanes more[STRAINS];
        joint_strains_lanes(&e->joint[j], f->moved, more);
        joint_resist_lanes(&e->joint[j], more, f->left);
    }
    double most = 0;
    for (int i = 0; i < e->n; i++) {
        double *left = f->left + (long)i * GRAIN;
        if (!is_free(e, i)) memset(left, 0, GRAIN * sizeof *left);
        for (int k = 0; k < DEGREES; k++)
            for (int l = 0; l < count; l++)
                most = fmax(most, fabs(left[k * LANES + l]));
    }
    return most;
}

// One round more for what rounding left.
static void polish(struct equilibrium *e, int count)
{
    struct foresight *f = e->foresight;
    stiffness_begin_lanes(e->matrix, f->left);
    if (settle_lanes(e, count, false, false) < count) return;
    stiffness_finish_lanes(e->matrix, f->step);
    for (long k = 0; k < (long)e->n * GRAIN; k++)
        f->moved[k] += f->step[k];
}

// As the joints are in the first lane.
static bool factor_first_lane(struct equilibrium *e)
{
    const struct foresight *f = e->foresight;
    for (int j = 0; j < e->n_joint; j++) {
        const struct joint *joint = &e->joint[j];
        lanes more;
        joint_lengthen_lanes(joint, f->moved, &more);
        const bool touches = joint->contact_along > 0 && !joint->is_gone &&
                             joint->strain[STRAIN_ALONG] + more[0] <= joint->overlap;
        e->resistance[j].contact.touch = touches ? TOUCH_STICKS : TOUCH_NONE;
    }
    return factor_anew(e);
}

// Of COUNT lanes those, from the first on, in which few are unlike, so that a row of
// corrections for each costs less than a factor.
static int lanes_with_few(const struct equilibrium *e, int count,
                          const int in_lane[LANES])
{
    const double most =
        row_speed * stiffness_work(e->matrix) / stiffness_numbers(e->matrix);
    for (int l = 0; l < count; l++)
        if (in_lane[l] > most) return l;
    return count;
}

// Corrects what is not as factored in some of COUNT lanes until nothing else is. How
// many are left, none if they begin with so much that a new factor is better.
static int correct_lanes(struct equilibrium *e, int count)
{
    enum { ROUNDS = 10 };
    struct foresight *f = e->foresight;
    if (!corrections_add(e->corrections, list_broken(e), e->unlike)) return 0;
    describe_rows(e, 0);
    for (int round = 0; round < ROUNDS; round++) {
        count = settle_lanes(e, count, true, round == 0);
        if (count == 0) return 0;
        stiffness_finish_lanes(e->matrix, f->moved);
        int in_lane[LANES], unlike = list_unlike(e, count, in_lane);
        if (unlike == 0) return count;
        const int few = lanes_with_few(e, count, in_lane);
        if (few == 0) return 0;
        if (few < count) unlike = list_unlike(e, count = few, in_lane);
        if (!corrections_add(e->corrections, unlike, e->unlike)) return 0;
        describe_rows(e, f->n_row);
    }
    return 0;
}

// Lanes that were found of those begun with.
static int look(struct equilibrium *e, int count)
{
    enum { FACTORS = 8 };
    apply_loads(e, count);
    int found = 0;
    for (int factors = 0; found == 0 && factors < FACTORS; factors++) {
        if (factors > 0 && !factor_first_lane(e)) return 0;
        begin_lanes(e);
        found = correct_lanes(e, count);
    }
    if (find_left(e, found) > 1e-3 * e->setup.tolerance * e->largest_load)
        polish(e, found);
    for (int l = 0; l < found; l++)
        if (!is_small(e, l)) return l;
    return found;
}

static int look_ahead(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    const int count = f->n_expected < f->sight ? f->n_expected : f->sight;
    if (f->factors != e->factors) settler_forget(f->settler);
    if (e->factors == 0 ||
        corrections_work(e->corrections) > row_speed * stiffness_work(e->matrix)) {
        resist(e);
        if (!factor_anew(e)) return 0;
    }
    memcpy(f->from, e->before, (size_t)e->n * sizeof *f->from);
    return look(e, count);
}

void foresee(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    if (!f || f->n_expected == 0) return;
    const bool is_other = f->n_crack != e->n_crack || f->n_gone != e->n_gone;
    if (!f->has_looked || is_other) {
        if (is_other) f->sight = 1;
        f->found = look_ahead(e);
        f->used = 0;
        f->has_looked = true;
        f->n_crack = e->n_crack;
        f->n_gone = e->n_gone;
        f->factors = e->factors;
    }
    if (f->used >= f->found) return;
    for (int i = 0; i < e->n; i++) {
        double number[DEGREES];
        for (int k = 0; k < DEGREES; k++)
            number[k] = f->moved[(long)i * GRAIN + k * LANES + f->used];
        struct displacement more;
        memcpy(&more, number, sizeof more);
        e->trial[i].shift = add(f->from[i].shift, more.shift);
        e->trial[i].turn = add(f->from[i].turn, more.turn);
    }
}
