// SPDX-License-Identifier: GPL-3.0-or-later
// All joints go on from the last equilibrium as they resist in the factor; those that
// in some lane do not are rows of the corrections, which settle_lane.h finds.
#include "foresee_state.h"

#include "basics/memory.h"
#include "basics/ranks.h"

#include <stdlib.h>
#include <string.h>

// Rows go through the factor side by side, a factor is made of smaller products: that
// many multiplications of the ones take the time of one of the other.
static const double row_speed = 2;

// ---- what is expected ---------------------------------------------------------------

// So that rows that go through the factor side by side have most of the way in common.
static int *order_joints(const struct equilibrium *e)
{
    double *before = NEW_ARRAY(double, e->n_joint);
    int *in_order = NEW_ARRAY(int, e->n_joint);
    for (int j = 0; j < e->n_joint; j++)
        before[j] = -(double)stiffness_place(e->matrix, j);
    rank_descending(before, e->n_joint, in_order, NULL);
    free(before);
    return in_order;
}

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
    f->strain = allocate((size_t)e->n_joint, sizeof *f->strain);
    f->touches_now = NEW_ARRAY(uint8_t, e->n_joint);
    f->in_order = order_joints(e);
    f->settler = settler_new();
    return f;
}

void foresight_free(struct foresight *f)
{
    if (!f) return;
    settler_free(f->settler);
    void *const owned[] = {f->load,        f->applied, f->left,    f->moved, f->step,
                           f->row,         f->touches, f->given,   f->more,  f->from,
                           f->touches_now, f->strain,  f->in_order};
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
    f->n_lane = f->found = f->used = 0;
    f->path.count = f->passed = 0;
    f->sight = LANES;
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
    f->passed++;
    f->force += f->of->n;
    if (f->used < f->n_lane) f->used++;
}

// ---- the last equilibrium, as factored ----------------------------------------------

static bool holds(const struct joint *joint)
{
    return joint->is_bonded && !joint->is_gone;
}

// The load FORCE (n), into a lane TO of so many numbers.
static struct net_load apply_load(struct equilibrium *e, const struct vector *force,
                                  double *to)
{
    const struct vector *load = e->foresight->load;
    const struct net_load taken_off = loads_of(e, force, e->foresight->load);
    for (long i = 0; i < e->n; i++) {
        to[i * GRAIN] = load[i].x;
        to[i * GRAIN + LANES] = load[i].y;
        to[i * GRAIN + 2 * LANES] = load[i].z;
    }
    return taken_off;
}

// Of the path, its load K.
static const struct vector *force_of(const struct foresight *f, int k)
{
    return f->force + (k - f->passed) * (long)f->of->n;
}

static void apply_loads(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    double largest = e->largest_load;
    memset(f->applied, 0, (size_t)e->n * GRAIN * sizeof *f->applied);
    for (int l = 0; l < f->n_lane; l++) {
        f->taken_off[l] = apply_load(e, force_of(f, f->first + l), f->applied + l);
        for (int i = 0; i < e->n; i++)
            if (dot(f->load[i], f->load[i]) > largest * largest)
                largest = norm(f->load[i]);
        f->largest_load[l] = largest;
    }
}

// What joints resisted with when all began if they were as in the factor.
static void resist_as_factored(const struct equilibrium *e, struct displacement *sum)
{
    memset(sum, 0, (size_t)e->n * sizeof *sum);
    for (int j = 0; j < e->n_joint; j++) {
        const struct joint *joint = &e->joint[j];
        const double *strain = e->foresight->strain[j];
        double load[STRAINS] = {0};
        for (int k = 0; k < STRAINS && e->factored[j].is_bonded; k++)
            load[k] = joint->bond_stiffness[k] * strain[k];
        if (e->factored[j].touch)
            load[STRAIN_ALONG] -=
                joint->contact_along * (joint->overlap - strain[STRAIN_ALONG]);
        for (int end = 0; end < 2; end++) {
            if (joint->grain[end] < 0) continue;
            const struct displacement part = joint_loads(joint, end, load);
            struct displacement *of = &sum[joint->grain[end]];
            of->shift = add(of->shift, part.shift);
            of->turn = add(of->turn, part.turn);
        }
    }
}

// OFF from each lane of a grain.
static void take_off_lanes(const struct displacement *off, double *grain)
{
    double number[DEGREES];
    memcpy(number, off, sizeof number);
    for (int k = 0; k < DEGREES; k++)
        for (int l = 0; l < LANES; l++)
            grain[k * LANES + l] -= number[k];
}

static void begin_corners(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    memset(f->left, 0, (size_t)e->n * GRAIN * sizeof *f->left);
    for (int k = 0; k < f->path.corners; k++)
        apply_load(e, force_of(f, f->path.corner[k]), f->left + k);
    resist_as_factored(e, e->step);
    for (int i = 0; i < e->n; i++) {
        double *left = f->left + (long)i * GRAIN;
        if (e->is_gone[i])
            memset(left, 0, GRAIN * sizeof *left);
        else
            take_off_lanes(&e->step[i], left);
    }
    stiffness_begin_lanes(e->matrix, f->left);
    stiffness_keep_lanes(e->matrix);
    f->has_begun = true;
}

static void begin_lanes(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    double share[LANES][LANES];
    path_shares(&f->path, f->first, share);
    stiffness_combine_lanes(e->matrix, share);
    f->n_given = 0;
    f->has_begun_lanes = true;
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
    const double *strain = e->foresight->strain[which.joint];
    const double bond = joint->bond_stiffness[which.strain];
    const bool is_along = which.strain == STRAIN_ALONG;
    return (struct lane_row){
        .strain = strain[which.strain],
        .bond = (holds(joint) - factored->is_bonded) * bond,
        .contact = is_along ? joint->contact_along : 0,
        .closed_to = joint->is_gone ? -INFINITY : joint->overlap - strain[STRAIN_ALONG],
        .touched = is_along && factored->touch};
}

// Of all rows of the corrections; new ones begin where the grains have MOVED.
static void describe_rows(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    const int before = f->n_row;
    f->n_row = corrections_count(e->corrections);
    make_room(f, f->n_row);
    for (int k = 0; k < f->n_row; k++) {
        const struct unit_load which = corrections_row(e->corrections, k);
        f->row[k] = row_of(e, which);
        for (int l = 0; l < LANES && k >= before; l++)
            f->touches[(long)k * LANES + l] =
                f->row[k].contact > 0 && (f->touches_now[which.joint] >> l & 1);
    }
}

// The first lane, from FIRST to END - 1, that was not settled, or END; whether contacts
// MAY CHANGE, or go on as they are; of those lanes that UNLIKE joints are in, of which
// the others need no more; NULL: all, and where contacts may change each begins as the
// one before ended.
static int settle_lanes(struct equilibrium *e, int first, int end, bool may_change,
                        const int unlike[LANES])
{
    struct foresight *f = e->foresight;
    const long begin = unlike ? (long)f->n_given * LANES : 0, all = f->n_row * LANES;
    corrections_strain_lanes(e->corrections, f->n_given, f->given);
    memset(f->more + begin, 0, (size_t)(all - begin) * sizeof *f->more);
    f->n_given = f->n_row;
    for (int l = first; l < end; l++) {
        if (unlike && unlike[l] == 0) continue;
        if (!settle_lane(f->settler, e->corrections, f->row, may_change, f->given + l,
                         f->touches + l, f->more + l))
            end = l;
        for (long k = l; k < all && may_change && !unlike && l + 1 < end; k += LANES)
            f->touches[k + 1] = f->touches[k];
    }
    return end;
}

// What then MOVES (n * GRAIN) in those lanes.
static void finish_lanes(struct equilibrium *e, int first, int end, double *moves)
{
    const struct foresight *f = e->foresight;
    if (end - first > 1) {
        stiffness_take_lanes(e->matrix);
        corrections_take_off_lanes(e->corrections, f->more);
        stiffness_finish_lanes(e->matrix, moves);
    } else {
        stiffness_take_lane(e->matrix, first);
        corrections_take_off_lane(e->corrections, first, f->more);
        stiffness_finish_lane(e->matrix, first, moves);
    }
}

// ---- rounds -------------------------------------------------------------------------

static void find_touching(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    lane_kernels()->touch(e->n_joint, e->joint, f->strain, f->moved, f->touches_now);
}

// Joints without a row that are not as factored in a lane from FIRST to END - 1. COUNT
// of them in each.
static int list_unlike(struct equilibrium *e, int first, int end, int in_lane[LANES])
{
    const struct foresight *f = e->foresight;
    const int all = (1 << end) - (1 << first);
    int count = 0;
    memset(in_lane, 0, LANES * sizeof *in_lane);
    for (int k = 0; k < e->n_joint; k++) {
        const int j = f->in_order[k];
        const int unlike = (f->touches_now[j] ^ (e->factored[j].touch ? all : 0)) & all;
        if (!unlike || !(e->joint[j].contact_along > 0) || e->joint[j].is_gone ||
            corrections_of(e->corrections, j) > 0)
            continue;
        for (int l = first; l < end; l++)
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

// As the joints are in LANE where the grains have MOVED.
static bool factor_lane(struct equilibrium *e, int lane)
{
    const struct foresight *f = e->foresight;
    find_touching(e);
    for (int j = 0; j < e->n_joint; j++) {
        const bool touches = e->joint[j].contact_along > 0 && !e->joint[j].is_gone &&
                             (f->touches_now[j] >> lane & 1);
        e->resistance[j].contact.touch = touches ? TOUCH_STICKS : TOUCH_NONE;
    }
    if (factor(e)) return true;
    corrections_count_work(e->corrections, INFINITY); // another is due
    return false;
}

void polish(struct equilibrium *e, int first, int end)
{
    struct foresight *f = e->foresight;
    stiffness_begin_lanes(e->matrix, f->left);
    f->n_given = 0;
    f->has_begun_lanes = false;
    if (settle_lanes(e, first, end, false, NULL) < end) return;
    memset(f->step, 0, (size_t)e->n * GRAIN * sizeof *f->step);
    finish_lanes(e, first, end, f->step);
    for (long k = 0; k < (long)e->n * GRAIN; k++)
        f->moved[k] += f->step[k];
    find_left_lanes(e);
}

// The first lane from FIRST to END - 1 in which so many are unlike that a factor costs
// less than a row of corrections for each.
static int first_with_many(const struct equilibrium *e, int first, int end,
                           const int in_lane[LANES])
{
    const double most =
        row_speed * stiffness_work(e->matrix) / stiffness_numbers(e->matrix);
    for (int l = first; l < end; l++)
        if (in_lane[l] > most) return l;
    return end;
}

// Corrects what is not as factored in lanes from FIRST to END - 1 until nothing else
// is, or for so many rounds. Where those end that are found; none if they begin with so
// much that a new factor is better.
static int correct_lanes(struct equilibrium *e, int first, int end)
{
    enum { ROUNDS = 10 };
    struct foresight *f = e->foresight;
    if (!corrections_add(e->corrections, list_broken(e), e->unlike)) return first;
    int in_lane[LANES];
    for (int round = 0; round < ROUNDS; round++) {
        describe_rows(e);
        end = settle_lanes(e, first, end, true, round > 0 ? in_lane : NULL);
        if (end == first) return first;
        finish_lanes(e, first, end, f->moved);
        find_touching(e);
        int unlike = list_unlike(e, first, end, in_lane);
        if (unlike == 0) return end;
        const int few = first_with_many(e, first, end, in_lane);
        if (few == first) return first;
        if (few < end) unlike = list_unlike(e, first, end = few, in_lane);
        if (!corrections_add(e->corrections, unlike, e->unlike)) return first;
    }
    while (first < end && in_lane[first] == 0)
        first++;
    return first;
}

static bool is_factor_due(const struct equilibrium *e)
{
    return e->factors == 0 ||
           corrections_work(e->corrections) > row_speed * stiffness_work(e->matrix);
}

// What belongs to the factor, if that has been made anew, and to the loads.
static void begin_as_factored(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    if (f->factors != e->factors) {
        settler_forget(f->settler);
        f->n_row = 0;
        f->has_begun = f->has_begun_lanes = false;
        find_touching(e);
    }
    if (!f->has_begun) begin_corners(e);
    if (!f->has_begun_lanes) begin_lanes(e);
    f->factors = e->factors;
}

int look(struct equilibrium *e, int first, int end)
{
    enum { FACTORS = 30 };
    int found = first;
    for (int factors = 0; found == first && factors < FACTORS; factors++) {
        const bool is_due = factors > 0 || is_factor_due(e);
        if (is_due && !factor_lane(e, first)) return first;
        begin_as_factored(e);
        found = correct_lanes(e, first, end);
    }
    find_left_lanes(e);
    return found;
}

// All begins anew, from the last equilibrium: as many loads as lie on a few lines, but
// where bonds broke and grains may lie loose no more than are looked at together.
static void begin_path(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    const int most = e->n_crack > 0 ? LANES : f->n_expected;
    find_load_path(&f->path, e->n, most < f->n_expected ? most : f->n_expected,
                   f->force);
    f->passed = 0;
    f->n_gone = e->n_gone;
    f->has_begun = false;
    memcpy(f->from, e->before, (size_t)e->n * sizeof *f->from);
    for (int j = 0; j < e->n_joint; j++)
        memcpy(f->strain[j], e->joint[j].strain, sizeof f->strain[j]);
}

// Lanes and rows as at the last equilibrium.
static void go_to_last(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    memset(f->moved, 0, (size_t)e->n * GRAIN * sizeof *f->moved);
    for (int i = 0; i < e->n; i++) {
        struct displacement back = f->from[i];
        pull(&back, e->before[i]);
        take_off_lanes(&back, f->moved + (long)i * GRAIN);
    }
    find_touching(e);
    f->n_row = 0;
}

void begin_lanes_anew(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    const int most = f->n_expected < LANES ? f->n_expected : LANES;
    if (f->path.count - f->passed < most || f->n_crack != e->n_crack ||
        f->n_gone != e->n_gone)
        begin_path(e);
    f->first = f->passed;
    f->n_lane = most;
    f->used = f->found = 0;
    f->n_crack = e->n_crack;
    f->has_begun_lanes = false;
    go_to_last(e);
    apply_loads(e);
}
