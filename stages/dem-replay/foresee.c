// SPDX-License-Identifier: GPL-3.0-or-later
// All joints go on from the last equilibrium as they resist in the factor; those that
// in some lane do not are rows of the corrections, which settle_lane.h finds.
#include "foresee_state.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

// Rows go through the factor side by side, a factor is made of smaller products: that
// many multiplications of the ones take the time of one of the other.
static const double row_speed = 2;

// ---- what is expected ---------------------------------------------------------------

struct foresight *foresight_new(struct equilibrium *e)
{
    for (int j = 0; j < e->n_joint; j++)
        if (e->joint[j].contact_across > 0 || e->joint[j].is_point) return NULL;
    if (e->setup.large_displacements) return NULL;
    struct foresight *f = NEW_ARRAY(struct foresight, 1);
    f->of = e;
    f->present = -1;
    f->load = NEW_ARRAY(struct vector, e->n);
    double **const of_grains[] = {&f->applied, &f->left, &f->moved, &f->step};
    for (size_t k = 0; k < sizeof of_grains / sizeof *of_grains; k++)
        *of_grains[k] = allocate_aligned((size_t)e->n, GRAIN * sizeof **of_grains[k]);
    f->from = NEW_ARRAY(struct displacement, e->n);
    f->touches_now = NEW_ARRAY(uint8_t, e->n_joint);
    f->settler = settler_new();
    return f;
}

void foresight_free(struct foresight *f)
{
    if (!f) return;
    settler_free(f->settler);
    void *const owned[] = {f->load, f->applied, f->left,       f->moved,
                           f->step, f->row,     f->touches,    f->given,
                           f->more, f->from,    f->touches_now};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free(f);
}

void foresight_expect(struct foresight *f, int count, const struct vector *force)
{
    if (!f) return;
    realise(f);
    f->n_expected = count;
    f->force = force;
    f->found = f->used = 0;
    f->sight = LANES;
    f->has_looked = false;
}

void foresight_check(struct foresight *f, const struct vector *force)
{
    if (!f || f->n_expected == 0) return;
    if (memcmp(f->force, force, (size_t)f->of->n * sizeof *force) != 0)
        foresight_expect(f, 0, NULL);
}

void foresight_go_on(struct foresight *f)
{
    if (!f || f->n_expected == 0) return;
    f->n_expected--;
    f->force += f->of->n;
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
    double largest = e->largest_load;
    memset(f->applied, 0, (size_t)e->n * GRAIN * sizeof *f->applied);
    for (int l = 0; l < count; l++) {
        f->taken_off[l] = loads_of(e, f->force + (long)l * e->n, f->load);
        for (int i = 0; i < e->n; i++) {
            double *to = f->applied + (long)i * GRAIN + l;
            to[0] = f->load[i].x;
            to[LANES] = f->load[i].y;
            to[2 * LANES] = f->load[i].z;
            largest = fmax(largest, norm(f->load[i]));
        }
        f->largest_load[l] = largest;
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
    const struct foresight *f = e->foresight;
    const int all = (1 << n_lane) - 1;
    int count = 0;
    memset(in_lane, 0, LANES * sizeof *in_lane);
    lane_kernels()->touch(e->n_joint, e->joint, f->moved, f->touches_now);
    for (int j = 0; j < e->n_joint; j++) {
        const int unlike = (f->touches_now[j] ^ (e->factored[j].touch ? all : 0)) & all;
        if (!unlike || !(e->joint[j].contact_along > 0) || e->joint[j].is_gone ||
            corrections_of(e->corrections, j) > 0)
            continue;
        for (int l = 0; l < n_lane; l++)
            in_lane[l] += unlike >> l & 1;
        e->unlike[count++] = (struct correction){j, 1};
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

static bool factor_anew(struct equilibrium *e)
{
    settler_forget(e->foresight->settler);
    if (factor(e)) return true;
    corrections_count_work(e->corrections, INFINITY); // another is due
    return false;
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
    lane_kernels()->touch(e->n_joint, e->joint, f->moved, f->touches_now);
    for (int j = 0; j < e->n_joint; j++) {
        const bool touches = e->joint[j].contact_along > 0 && !e->joint[j].is_gone &&
                             (f->touches_now[j] & 1);
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
    const struct foresight *f = e->foresight;
    apply_loads(e, count);
    int found = 0;
    for (int factors = 0; found == 0 && factors < FACTORS; factors++) {
        if (factors > 0 && !factor_first_lane(e)) return 0;
        begin_lanes(e);
        found = correct_lanes(e, count);
    }
    if (found > 0 &&
        find_left_lanes(e, found) > well_below * e->setup.tolerance * e->largest_load) {
        polish(e, found);
        find_left_lanes(e, found);
    }
    for (int l = 0; l < found; l++)
        if (!(f->sums.furthest[l] <= furthest)) return l;
    return found;
}

void look_ahead(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    const int count = f->n_expected < f->sight ? f->n_expected : f->sight;
    f->used = f->found = 0;
    f->has_looked = true;
    f->n_crack = e->n_crack;
    f->n_gone = e->n_gone;
    if (f->factors != e->factors) settler_forget(f->settler);
    bool has_factor = true;
    if (e->factors == 0 ||
        corrections_work(e->corrections) > row_speed * stiffness_work(e->matrix)) {
        resist(e);
        has_factor = factor_anew(e);
    }
    memcpy(f->from, e->before, (size_t)e->n * sizeof *f->from);
    if (has_factor) f->found = look(e, count);
    f->factors = e->factors;
}

bool has_looked(const struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    if (f->n_crack == e->n_crack && f->n_gone == e->n_gone) return f->has_looked;
    f->sight = 1;
    return false;
}

void foresee(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    if (!f || f->n_expected == 0) return;
    if (!has_looked(e)) look_ahead(e);
    if (f->used < f->found) go_to_lane(e, f->used);
}
