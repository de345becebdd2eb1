// SPDX-License-Identifier: GPL-3.0-or-later
// The unknown x is what three components (normal, two shears) add to `from`:
//     x = given - compliance q,  q = load(from + x) - load - tangent x.
// In each state of the contact the load is linear, slope (from + x) + constant, so open
// and sticking are three linear equations each. Slipping with a force of size F = limit
// overlap(x) along the unit vector `direction`,
//     x = smooth - F (direction[0] give[0] + direction[1] give[1]),
// where `direction` must be the direction of the spring, x - anchor: a fixed point, and
// where that does not converge a root in the angle, by bisection.
#include "return_mapping.h"

#include <math.h>
#include <string.h>

static void swap(double *a, double *b)
{
    const double other = *a;
    *a = *b;
    *b = other;
}

bool solve_three(double m[3][3], double right[3])
{
    for (int k = 0; k < 3; k++) {
        int best = k;
        for (int r = k + 1; r < 3; r++)
            if (fabs(m[r][k]) > fabs(m[best][k])) best = r;
        for (int l = 0; l < 3; l++)
            swap(&m[k][l], &m[best][l]);
        swap(&right[k], &right[best]);
        if (!(fabs(m[k][k]) > 0)) return false;
        for (int r = k + 1; r < 3; r++) {
            const double multiplier = m[r][k] / m[k][k];
            for (int l = k; l < 3; l++)
                m[r][l] -= multiplier * m[k][l];
            right[r] -= multiplier * right[k];
        }
    }
    for (int k = 2; k >= 0; k--) {
        for (int l = k + 1; l < 3; l++)
            right[k] -= m[k][l] * right[l];
        right[k] /= m[k][k];
    }
    return true;
}

// Load: slope (from + x) + constant.
struct linear_law {
    double slope[3][3], constant[3];
};

static struct linear_law open_law(const struct contact_pair *pair)
{
    struct linear_law law = {.constant = {0}};
    if (!pair->is_bonded) return law;
    for (int k = 0; k < 3; k++)
        law.slope[k][k] = pair->bond_stiffness[k];
    law.constant[0] = -pair->bond_stiffness[NORMAL] * pair->free_stretch;
    return law;
}

static struct linear_law closed_law(const struct contact_pair *pair)
{
    struct linear_law law = open_law(pair);
    law.slope[0][0] += pair->normal_stiffness;
    law.constant[0] -= pair->normal_stiffness * pair->overlap;
    return law;
}

static struct linear_law stuck_law(const struct contact_pair *pair)
{
    struct linear_law law = closed_law(pair);
    for (int k = 0; k < 2 && pair->contact.state != CONTACT_OPEN; k++) {
        law.slope[1 + k][1 + k] += pair->shear_stiffness;
        law.constant[1 + k] = -pair->shear_stiffness * pair->contact.anchor[k];
    }
    return law;
}

static bool solve_law(const struct local_problem *s, const struct linear_law *law,
                      double x[3])
{
    double m[3][3], more[3];
    for (int k = 0; k < 3; k++) {
        more[k] = law->constant[k] - s->load[k];
        for (int l = 0; l < 3; l++)
            more[k] += law->slope[k][l] * s->from[l];
    }
    for (int k = 0; k < 3; k++) {
        x[k] = s->given[k];
        for (int l = 0; l < 3; l++) {
            x[k] -= s->compliance[k][l] * more[l];
            m[k][l] = (k == l) - s->compliance[k][l] * s->tangent[l];
            for (int i = 0; i < 3; i++)
                m[k][l] += s->compliance[k][i] * law->slope[i][l];
        }
    }
    return solve_three(m, x);
}

static double overlap_of(const struct contact_pair *pair, const struct local_problem *s,
                         const double x[3])
{
    return pair->overlap - s->from[0] - x[0];
}

static double stretch_of(const struct contact_pair *pair, const struct local_problem *s,
                         const double x[3], int k)
{
    return s->from[1 + k] + x[1 + k] - pair->contact.anchor[k];
}

// A closed contact: x without friction, and what a unit shear force takes off it.
struct sliding {
    double smooth[3], give[2][3];
    double overlap, limit; // without friction; force over overlap
    double anchor[2];      // x at which the spring is free
    double stiffness;
};

static bool begin_sliding(const struct contact_pair *pair,
                          const struct local_problem *s, struct sliding *sliding)
{
    const struct linear_law closed = closed_law(pair);
    if (!solve_law(s, &closed, sliding->smooth)) return false;
    for (int k = 0; k < 2; k++) {
        struct local_problem pushed = *s;
        for (int l = 0; l < 3; l++)
            pushed.given[l] += s->compliance[l][1 + k];
        if (!solve_law(&pushed, &closed, sliding->give[k])) return false;
        for (int l = 0; l < 3; l++)
            sliding->give[k][l] -= sliding->smooth[l];
        sliding->anchor[k] = pair->contact.anchor[k] - s->from[1 + k];
    }
    sliding->overlap = pair->overlap - s->from[0] - sliding->smooth[0];
    sliding->limit = pair->friction * pair->normal_stiffness;
    sliding->stiffness = pair->shear_stiffness;
    return true;
}

// A trial slip along DIRECTION, a unit vector: the stretch of the spring, its component
// across DIRECTION, which must be 0, and the force of the spring along DIRECTION beyond
// the limit, which must not be negative.
struct slip {
    double x[3], stretch[2], turned, along, beyond;
};

static struct slip slip_along(const struct sliding *sliding, const double direction[2])
{
    const double give =
        direction[0] * sliding->give[0][0] + direction[1] * sliding->give[1][0];
    const double force =
        sliding->limit * sliding->overlap / (1 - sliding->limit * give);
    struct slip slip;
    for (int k = 0; k < 3; k++)
        slip.x[k] = sliding->smooth[k] - force * (direction[0] * sliding->give[0][k] +
                                                  direction[1] * sliding->give[1][k]);
    for (int k = 0; k < 2; k++)
        slip.stretch[k] = slip.x[1 + k] - sliding->anchor[k];
    slip.turned = direction[0] * slip.stretch[1] - direction[1] * slip.stretch[0];
    slip.along = direction[0] * slip.stretch[0] + direction[1] * slip.stretch[1];
    slip.beyond = force >= 0 ? sliding->stiffness * slip.along - force : -1;
    return slip;
}

static struct slip slip_at(const struct sliding *sliding, double angle)
{
    return slip_along(sliding, (double[]){cos(angle), sin(angle)});
}

static bool is_along(const struct slip *slip)
{
    return fabs(slip->turned) <= 1e-6 * slip->along;
}

// Fixed point: DIRECTION becomes the direction into which the slip turns the spring.
static bool follow_slip(const struct sliding *sliding, double x[3])
{
    enum { TURNS = 8 };
    double direction[2] = {x[1] - sliding->anchor[0], x[2] - sliding->anchor[1]};
    for (int k = 0; k < TURNS; k++) {
        const double size =
            sqrt(direction[0] * direction[0] + direction[1] * direction[1]);
        if (!(size > 0)) return false;
        const double unit[2] = {direction[0] / size, direction[1] / size};
        const struct slip slip = slip_along(sliding, unit);
        if (!(slip.along > 0)) return false;
        memcpy(direction, slip.stretch, sizeof direction);
        if (!is_along(&slip)) continue;
        if (!(slip.beyond >= 0)) return false;
        memcpy(x, slip.x, sizeof slip.x);
        return true;
    }
    return false;
}

static struct slip halve(const struct sliding *sliding, double low, double at_low,
                         double high)
{
    for (int k = 0; k < 30; k++) {
        const double middle = 0.5 * (low + high);
        if ((slip_at(sliding, middle).turned > 0) == (at_low > 0))
            low = middle;
        else
            high = middle;
    }
    return slip_at(sliding, low);
}

// All angles, those near FIRST first.
static bool seek_slip(const struct sliding *sliding, double first, double x[3])
{
    enum { PARTS = 32 };
    const double part = 2 * M_PI / PARTS;
    for (int k = 0; k < PARTS; k++) { // to both sides in turn
        const double low = first + part * ((k % 2 ? -(k + 1) / 2 : k / 2) - 0.5);
        const double at_low = slip_at(sliding, low).turned;
        const double at_high = slip_at(sliding, low + part).turned;
        if ((at_low > 0) == (at_high > 0)) continue;
        const struct slip slip = halve(sliding, low, at_low, low + part);
        if (!is_along(&slip) || !(slip.beyond >= 0)) continue; // no root, but a pole
        memcpy(x, slip.x, sizeof slip.x);
        return true;
    }
    return false;
}

static bool slip(const struct contact_pair *pair, const struct local_problem *s,
                 double x[3])
{
    struct sliding sliding;
    if (pair->contact.state == CONTACT_OPEN || !begin_sliding(pair, s, &sliding))
        return false;
    const double angle = atan2(x[2] - sliding.anchor[1], x[1] - sliding.anchor[0]);
    return follow_slip(&sliding, x) || seek_slip(&sliding, angle, x);
}

bool return_map(const struct contact_pair *pair, const struct local_problem *s,
                double x[3])
{
    const struct linear_law stuck = stuck_law(pair), open = open_law(pair);
    double found[3];
    bool is_found = false;
    if (solve_law(s, &stuck, found)) {
        const double overlap = overlap_of(pair, s, found);
        const double size =
            pair->shear_stiffness *
            hypot(stretch_of(pair, s, found, 0), stretch_of(pair, s, found, 1));
        is_found =
            overlap >= 0 && (pair->contact.state == CONTACT_OPEN ||
                             size <= pair->friction * pair->normal_stiffness * overlap);
    }
    if (!is_found && solve_law(s, &open, found))
        is_found = overlap_of(pair, s, found) < 0;
    if (!is_found) return slip(pair, s, x);
    memcpy(x, found, sizeof found);
    return true;
}
