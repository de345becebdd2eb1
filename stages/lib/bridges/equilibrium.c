// SPDX-License-Identifier: GPL-3.0-or-later
// The stable bridge at a gap, by continuation along the branch of equilibria.
//
// Unknowns (newton.h): logarithms of both reaches and of the arc's length, and its
// turn. A branch begins at contact, from a torus (`torus`), if need be through growing
// volumes (`grow`). From there `advance` follows it by pseudo-arclength: predict a
// distance along `direction`, correct by Newton with the fourth equation direction.(x -
// x_from) = distance (`reach`). The branch is stable while
//     rate = d gap / d s > 0   (no turning point yet), and
//     symmetry > 0            (symmetry not broken yet),
// where symmetry is the determinant of the three other equations and `direction`, with
// the sign that makes it positive for the thinnest torus.
//
// A sign change of either is closed in on by regula falsi; that is rupture. Trap:
// Newton may land on an unstable branch or an arc with a bulge; near(), goes_on() and
// least_pull refuse those.
#include "bridges/equilibrium.h"

#include "bridges/newton.h"

#include <math.h>
#include <string.h>

// Distances along the branch, in the unknowns: some two from contact to rupture.
static const double LONGEST_STRIDE = 0.5, SHORTEST_STRIDE = 1e-10;

// A bridge found, and the direction of the branch there: that in which the gap widens
// where the branch begins. The bridge is stable while the gap does widen, at the RATE,
// and while the SYMMETRY determinant (of the three equations and that direction) has
// the sign that it has for the thinnest torus: the first ends in a turning point, the
// second where symmetry breaks.
struct state {
    struct unknowns unknowns;
    double direction[ARC_NUMBERS];
    double gap, rate, symmetry;
    int steps;
};

static double stability(const struct state *state)
{
    return fmin(state->rate, state->symmetry);
}

static double dot(const double a[ARC_NUMBERS], const double b[ARC_NUMBERS])
{
    double sum = 0;
    for (int k = 0; k < ARC_NUMBERS; k++)
        sum += a[k] * b[k];
    return sum;
}

// Fills all but the unknowns of STATE. PREVIOUS is the direction of a bridge nearby, or
// NULL: then the direction is that in which the waist gets thinner, as it does all
// along from contact to rupture and beyond.
static bool judge(const struct problem *problem, const double *previous,
                  struct state *state)
{
    struct problem at = *problem;
    at.from = NULL;
    at.gap = 0;
    struct system is = system_at(&at, &state->unknowns);
    double widening[ARC_NUMBERS], tangent[ARC_NUMBERS] = {0, 0, 0, 1};
    state->gap = is.residual[3] * exp(state->unknowns.at[ARC_LENGTH]);
    memcpy(widening, is.slope[3], sizeof widening);
    struct system turned = is;
    if (previous) memcpy(turned.slope[3], previous, sizeof widening);
    if (eliminate(turned.slope, tangent) == 0) return false;
    const bool thickens = !previous && dot(is.waist_slope, tangent) > 0;
    const double size = (thickens ? -1 : 1) * sqrt(dot(tangent, tangent));
    for (int n = 0; n < ARC_NUMBERS; n++)
        state->direction[n] = tangent[n] / size;
    state->rate = dot(widening, state->direction);

    state->symmetry = INFINITY;
    if (problem->to_turning && problem->symmetric) return isfinite(size);
    at.symmetric = false;
    if (problem->symmetric) is = system_at(&at, &state->unknowns);
    memcpy(is.slope[3], state->direction, sizeof widening);
    state->symmetry = eliminate(is.slope, is.residual);
    return isfinite(size);
}

// ---- where to begin ----------------------------------------------------------------

// The torus: an arc of a circle across the gap at the contact lines, whose volume is
// about pi r^2 (gap + r^2/2). Good when the bridge is thin and the gap short.
static struct arc torus(const struct bodies *bodies, double volume, double gap)
{
    const double apart = fmax(gap, 0); // overlapping bodies fill the rest
    const double radius2 = sqrt(apart * apart + 2 * volume / M_PI) - gap;
    struct arc arc;
    double turned[2], open = gap;
    for (int k = 0; k < 2; k++) {
        const double curvature = bodies->curvature[k];
        const double sine = fmin(curvature * sqrt(radius2), 0.9);
        arc.reach[k] = curvature > 1e-8 ? asin(sine) / curvature : sqrt(radius2);
        const struct contact_line line = contact_line(bodies, k, arc.reach[k]);
        turned[k] = line.angle + bodies->contact_angle[k];
        open += line.sagitta;
    }
    arc.turn = 0.5 * (M_PI - turned[0] - turned[1]);
    const double bend = fabs(arc.turn) < 1e-6 ? 1 : arc.turn / sin(arc.turn);
    arc.length = open * bend / fmax(cos(0.5 * (turned[0] - turned[1])), 0.1);
    return arc;
}

// The bridge to find; with to_turning also past the break of symmetry.
struct question {
    const struct bodies *bodies;
    double volume;
    bool to_turning;
};

static struct problem problem_at(const struct question *asked, double volume,
                                 double gap)
{
    const struct bodies *bodies = asked->bodies;
    return (struct problem){.bodies = bodies,
                            .to_turning = asked->to_turning,
                            .volume = volume,
                            .shared = bodies_overlap(bodies, gap).volume,
                            .gap = gap,
                            .symmetric = bodies_are_equal(bodies)};
}

static bool settle(const struct problem *problem, struct state *state)
{
    if (!converge(problem, &state->unknowns, &state->steps)) return false;
    return judge(problem, NULL, state) && stability(state) > 0;
}

// Whether both contact lines lie near where they were expected, and the arc is less
// than a period: arcs with a bulge between thin necks, or more of them, pass every
// other test.
static bool near(const struct unknowns *one, const struct unknowns *other)
{
    return fabs(one->at[ARC_TURN]) < 0.95 * M_PI &&
           fabs(one->at[ARC_FIRST] - other->at[ARC_FIRST]) < 1.2 &&
           fabs(one->at[ARC_SECOND] - other->at[ARC_SECOND]) < 1.2;
}

// The force of the stable branch is least at rupture, some 0.3 times the edge of the
// liquid's cube up to 90 degrees. Of bridges that pull less some are two instabilities
// further on, which no determinant tells; from contact on there is no mistaking.
static const double LEAST_PULL = 0.16;

// The same, but for bridges that are stable.
static struct problem stable_at(const struct question *asked, double volume, double gap)
{
    struct problem problem = problem_at(asked, volume, gap);
    problem.to_turning = false;
    return problem;
}

// At GAP straight from the torus; false when that does not lead to a stable bridge.
static bool jump(const struct question *asked, double volume, double gap,
                 struct state *state)
{
    const struct problem problem = stable_at(asked, volume, gap);
    const struct arc arc = torus(asked->bodies, volume, gap);
    const struct unknowns guess = unknowns_of(&arc);
    state->unknowns = guess;
    if (!settle(&problem, state) || !near(&state->unknowns, &guess)) return false;
    const struct arc found = arc_of(&state->unknowns);
    return gap <= 0 || arc_force(asked->bodies, &found) > LEAST_PULL * cbrt(volume);
}

// At GAP (zero or less), if need be through ever larger volumes.
static bool grow(const struct question *asked, double gap, struct state *state)
{
    const double volume = asked->volume;
    double reached = volume, factor = 2;
    while (!jump(asked, reached, gap, state)) {
        reached *= 0.1;
        if (reached < 1e-8 * volume) return false;
    }
    while (reached < volume) {
        const double next = fmin(reached * factor, volume);
        const struct problem problem = stable_at(asked, next, gap);
        struct state larger = *state;
        if (settle(&problem, &larger)) {
            *state = larger;
            reached = next;
        } else if ((factor = sqrt(factor)) < 1.001)
            return false;
    }
    return true;
}

// ---- along the branch --------------------------------------------------------------

// Whether TO lies where the branch from FROM goes on. The condition of a DISTANCE along
// its direction holds on a whole hyperplane, and far away in that other branches cross
// it.
static bool goes_on(const struct state *from, const struct state *to, double distance)
{
    const double most = 2 * distance + 1e-6; // and what is left of Newton's method
    double apart[ARC_NUMBERS];
    for (int n = 0; n < ARC_NUMBERS; n++)
        apart[n] = to->unknowns.at[n] - from->unknowns.at[n];
    return dot(apart, apart) < most * most;
}

// DISTANCE along the branch's direction at FROM. Returns whether there is a bridge.
static bool reach(const struct problem *problem, double distance,
                  const struct state *from, struct state *to)
{
    struct problem at = *problem;
    at.from = &from->unknowns;
    at.direction = from->direction;
    at.distance = distance;
    *to = *from;
    to->unknowns = moved(&from->unknowns, from->direction, distance);
    return sensible(problem->bodies, &to->unknowns) &&
           converge(&at, &to->unknowns, &to->steps) && goes_on(from, to, distance) &&
           judge(&at, from->direction, to);
}

// What is positive before the place looked for: GAP, or the end of stability
// (INFINITY).
static double ahead(const struct state *state, double gap)
{
    return isfinite(gap) ? gap - state->gap : stability(state);
}

// Between FROM and the bridge BEYOND at DISTANCE from it: the place where `ahead` falls
// to zero, by regula falsi (Illinois), from the near side, into LAST at *DISTANCE.
static bool close_in(const struct problem *problem, double gap,
                     const struct state *from, const struct state *beyond,
                     double *distance, struct state *last)
{
    double near = 0, far = *distance;
    double low = ahead(from, gap), high = ahead(beyond, gap);
    int steps = beyond->steps;
    *last = *from;
    for (int k = 0, side = 0; k < 60 && far - near > 1e-12; k++) {
        const double at = (low * far - high * near) / (low - high);
        struct state middle;
        if (!(at > near && at < far)) break;
        if (!reach(problem, at, from, &middle)) return false;
        steps += middle.steps - from->steps;
        const double value = ahead(&middle, gap), move = fmin(at - near, far - at);
        if (value > 0) {
            *last = middle;
            near = at;
            low = value;
            if (side == 1) high *= 0.5;
            side = 1;
        } else {
            far = at;
            high = value;
            if (side == -1) low *= 0.5;
            side = -1;
        }
        if (move < 1e-13) break;
    }
    *distance = near;
    last->steps = steps;
    return true;
}

// Along the branch to GAP, or to rupture where that comes first. Turns STATE into the
// bridge there; RUPTURED says which it is.
static enum status advance(const struct problem *problem, double gap,
                           struct state *state, bool *ruptured)
{
    double step = LONGEST_STRIDE;
    for (*ruptured = false; step > SHORTEST_STRIDE;) {
        struct state next, last;
        double stride = step;
        const bool reached = reach(problem, step, state, &next);
        const bool stable = reached && stability(&next) > 0;
        if (stable && next.gap < gap) {
            *state = next;
            step = fmin(1.5 * step, LONGEST_STRIDE);
            continue;
        }
        bool found = stable || (reached && step < 0.6 * LONGEST_STRIDE);
        if (found && !stable) {
            found = close_in(problem, INFINITY, state, &next, &stride, &last);
            *ruptured = last.gap < gap * (1 - 1e-8); // so well it is known
            next = last;
        }
        if (found && next.gap > gap)
            found = close_in(problem, gap, state, &next, &stride, &last);
        if (found) {
            *state = last;
            return STATUS_OK;
        }
        *ruptured = false;
        step *= 0.5;
    }
    *ruptured = stability(state) < RESIDUAL_ROUNDING;
    return *ruptured ? STATUS_OK : STATUS_NOT_CONVERGED;
}

static struct equilibrium equilibrium_of(const struct state *state)
{
    return (struct equilibrium){.arc = arc_of(&state->unknowns),
                                .gap = state->gap,
                                .stability = stability(state),
                                .steps = state->steps};
}

static enum status find_end(const struct question *asked, struct equilibrium *found)
{
    struct state state = {0};
    bool ruptured;
    const struct problem problem = problem_at(asked, asked->volume, 0);
    if (!grow(asked, 0, &state)) return STATUS_NOT_CONVERGED;
    const enum status status = advance(&problem, INFINITY, &state, &ruptured);
    *found = equilibrium_of(&state);
    return status;
}

enum status find_rupture(const struct bodies *bodies, double volume,
                         struct equilibrium *found)
{
    return find_end(&(struct question){bodies, volume, false}, found);
}

enum status find_turning(const struct bodies *bodies, double volume,
                         struct equilibrium *found)
{
    return find_end(&(struct question){bodies, volume, true}, found);
}

// Along the branch from a shorter gap, if need be from touching bodies.
static enum status approach(const struct question *asked, double gap,
                            struct state *state)
{
    bool ruptured;
    const struct problem problem = problem_at(asked, asked->volume, gap);
    if (!jump(asked, asked->volume, 0.6 * gap, state) && !grow(asked, 0, state))
        return STATUS_NOT_CONVERGED;
    const enum status status = advance(&problem, gap, state, &ruptured);
    if (status || ruptured) return status ? status : STATUS_NO;
    struct state exact = *state; // fails only next to rupture, where it adds nothing
    if (settle(&problem, &exact) && near(&exact.unknowns, &state->unknowns))
        *state = exact;
    return STATUS_OK;
}

static enum status find_at(const struct question *asked, double gap,
                           struct equilibrium *found)
{
    struct state state = {0};
    enum status status = STATUS_OK;
    if (gap <= 0)
        status = grow(asked, gap, &state) ? STATUS_OK : STATUS_NOT_CONVERGED;
    else if (!jump(asked, asked->volume, gap, &state))
        status = approach(asked, gap, &state);
    *found = equilibrium_of(&state);
    return status;
}

enum status find_equilibrium(const struct bodies *bodies, double volume, double gap,
                             struct equilibrium *found)
{
    return find_at(&(struct question){bodies, volume, false}, gap, found);
}

// Extrapolates the two bridges before to GAP.
static struct unknowns extrapolated(const struct state *before,
                                    const struct state *last, double gap)
{
    struct unknowns to;
    const double share = (gap - last->gap) / (last->gap - before->gap);
    for (int n = 0; n < ARC_NUMBERS; n++)
        to.at[n] = last->unknowns.at[n] +
                   share * (last->unknowns.at[n] - before->unknowns.at[n]);
    return to;
}

enum status follow_to_turning(const struct bodies *bodies, double volume, int count,
                              const double *gap, struct equilibrium *found)
{
    const struct question *asked = &(struct question){bodies, volume, true};
    struct state before = {0}, last = {0};
    for (int k = 0; k < count; k++) {
        struct state next = last;
        const struct problem problem = problem_at(asked, asked->volume, gap[k]);
        if (k > 1) next.unknowns = extrapolated(&before, &last, gap[k]);
        const bool settled =
            k > 0 && settle(&problem, &next) && near(&next.unknowns, &last.unknowns);
        if (settled)
            found[k] = equilibrium_of(&next);
        else {
            const enum status status = find_at(asked, gap[k], &found[k]);
            const bool just_beyond =
                status == STATUS_NO && gap[k] < (1 + 1e-4) * found[k].gap;
            if (status && !just_beyond) return status;
            next.unknowns = unknowns_of(&found[k].arc);
            next.gap = found[k].gap;
        }
        before = last;
        last = next;
    }
    return STATUS_OK;
}
