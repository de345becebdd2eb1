// SPDX-License-Identifier: GPL-3.0-or-later
// What gas leaves behind in rings (network/contact_rings.h), after each event. Liquid
// is cut off in pieces, whole throats or their halves (outcome.h). A piece cut off by
// event e keeps its part of the rings around the throat,
//     isolated:  at the suction of that event,  p = pressure[e] + weight z;
//     joined:    at P, the highest pressure so far; in all pieces the same.
// Joined rings are found exactly at suctions P_j in equal ratios. In between all of
// them together have the volume
//     volume(P) = sum of w_j(P) (P_j / P)^2 volume(P_j),
// w_j Lagrange's polynomials in ln P through four P_j: rings at contact hold nearly
// P^-2. Those across gaps end one by one, at suctions of their own, so that the sum
// over a packing stays smooth, but at suctions below which they do not grow any more
// (contact_rings.h). Between events the rings drain; where the polynomials say that
// they fill by a thousandth, they hold before what they hold after. The error is
// measured by tests/physics/dry/rings_left.t.
#include "rings_left.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// ---- isolated -----------------------------------------------------------------------

static double height_of(const struct network *network, int throat)
{
    return throat_middle(network, throat).z - network->packing.lower.z;
}

// Suctions (n_throat) at which gas cut off piece PIECE of each throat; 0: it did not.
static void find_suctions(const struct network *network, const struct outcome *outcome,
                          int piece, double weight, double *suction)
{
    for (int t = 0; t < network->n_throat; t++) {
        int32_t event[2];
        const int pieces = events_of_pieces(network, outcome, t, event);
        const bool is_cut = piece < pieces && event[piece] > 0;
        suction[t] = is_cut ? outcome->pressure[event[piece] - 1] +
                                  (weight > 0 ? weight * height_of(network, t) : 0)
                            : 0;
    }
}

static enum status isolate(const struct network *network, const struct outcome *outcome,
                           const struct ring_liquid *liquid, double weight,
                           struct rings_left *left, struct reason *reason)
{
    const struct throat_sides *parts = &left->rings.parts;
    double *suction = NEW_ARRAY(double, network->n_throat);
    double *part = NEW_ARRAY(double, left->rings.n_part);
    enum status status = STATUS_OK;
    for (int piece = 0; piece < 2 && !status; piece++) {
        int limited;
        find_suctions(network, outcome, piece, weight, suction);
        status = ring_volumes(network, &left->rings, liquid, suction, part, &limited,
                              reason);
        left->limited = limited > left->limited ? limited : left->limited;
        for (int t = 0; t < network->n_throat && !status; t++) {
            int32_t event[2];
            const int pieces = events_of_pieces(network, outcome, t, event);
            for (int64_t k = parts->offset[t];
                 suction[t] > 0 && k < parts->offset[t + 1]; k++) {
                left->volume[event[piece] - 1] += part[k] / pieces;
                left->part[k] += part[k] / pieces;
            }
        }
    }
    for (int k = 1; k < outcome->n; k++)
        left->volume[k] += left->volume[k - 1];
    free(suction);
    free(part);
    return status;
}

// ---- joined -------------------------------------------------------------------------

enum { STENCIL = 4 };

// Suctions at which rings are found, from the first to the last; at least STENCIL of
// them, or one.
struct ladder {
    int n;
    double first, last;
};

static struct ladder ladder_over(double first, double last)
{
    const double step = 0.1, span = log(last / first);
    const int n = 1 + (int)ceil(span / step);
    return (struct ladder){span > 0 ? (n < STENCIL ? STENCIL : n) : 1, first, last};
}

static double rung(const struct ladder *ladder, int j)
{
    if (j == ladder->n - 1) return ladder->last;
    return ladder->first *
           pow(ladder->last / ladder->first, (double)j / (ladder->n - 1));
}

// What the rings found at rung J count for at SUCTION: 0 where others are nearer.
static double weight_of(const struct ladder *ladder, int j, double suction)
{
    if (ladder->n == 1) return 1;
    const double at = log(suction / ladder->first) / log(ladder->last / ladder->first) *
                      (ladder->n - 1);
    int first = (int)at - 1;
    if (first > ladder->n - STENCIL) first = ladder->n - STENCIL;
    if (first < 0) first = 0;
    if (j < first || j >= first + STENCIL) return 0;
    double product = 1;
    for (int i = first; i < first + STENCIL; i++)
        if (i != j) product *= (at - i) / (j - i);
    const double ratio = rung(ladder, j) / suction;
    return product * ratio * ratio;
}

// (n) The highest pressure up to each event. The caller frees it.
static double *highest_so_far(const struct outcome *outcome)
{
    double *highest = NEW_ARRAY(double, outcome->n);
    for (int k = 0; k < outcome->n; k++)
        highest[k] =
            fmax(outcome->pressure[k], k ? highest[k - 1] : outcome->pressure[0]);
    return highest;
}

// At event AT or from the start: whether among the first EVENT events. Below 0: never.
static bool is_cut_by(int32_t at, int event)
{
    return at >= 0 && at <= event;
}

// Which rings are asked for when EVENT events have happened: those with a part cut off
// that have not broken.
static void find_wanted(const struct network *network, const struct outcome *outcome,
                        const struct contact_rings *rings, int event,
                        const bool *broken, bool *wanted)
{
    for (int f = 0; f < network->n_face; f++)
        wanted[f] = false;
    for (int t = 0; t < network->n_throat; t++) {
        int32_t at[2];
        const int pieces = events_of_pieces(network, outcome, t, at);
        if (!is_cut_by(at[0], event) && !is_cut_by(at[pieces - 1], event)) continue;
        for (int64_t k = rings->parts.offset[t]; k < rings->parts.offset[t + 1]; k++)
            wanted[rings->parts.face[k]] = !broken[rings->parts.face[k]];
    }
}

// Parts (n_part) of whole throats for rings of the volumes WHOLE (n_face), limited.
// Returns how many throats were.
static int divide(const struct network *network, const struct contact_rings *rings,
                  const double *whole, double *part)
{
    int limited = 0;
    for (int k = 0; k < rings->n_part; k++)
        part[k] = rings->share[k] * whole[rings->parts.face[k]];
    for (int t = 0; t < network->n_throat; t++)
        limited += limit_parts(network, rings, t, part);
    return limited;
}

// Adds to GAINED (n) what each of the first EVENT events leaves of these parts; CUT, if
// not NULL, gets the parts of all they leave.
static void find_gains(const struct network *network, const struct outcome *outcome,
                       const struct rings_left *left, int event, const double *part,
                       double *gained, double *cut)
{
    const struct throat_sides *parts = &left->rings.parts;
    for (int t = 0; t < network->n_throat; t++) {
        int32_t at[2];
        const int pieces = events_of_pieces(network, outcome, t, at);
        for (int piece = 0; piece < pieces; piece++)
            for (int64_t k = parts->offset[t];
                 is_cut_by(at[piece], event) && k < parts->offset[t + 1]; k++) {
                gained[at[piece] > 0 ? at[piece] - 1 : 0] += part[k] / pieces;
                if (cut) cut[k] += part[k] / pieces;
            }
    }
}

// Room for one rung of the ladder, and what each event leaves by all rungs so far.
struct workspace {
    double *whole, *part, *gained; // (n_face), (n_part), (n)
    bool *wanted, *broken;         // (n_face)
    double *gain;                  // (n)
};

// Adds what the rings found at rung J count for, after each event.
static enum status add_rung(const struct network *network,
                            const struct outcome *outcome,
                            const struct ring_liquid *liquid,
                            const struct ladder *ladder, int j, const double *highest,
                            struct workspace *room, struct rings_left *left,
                            struct reason *reason)
{
    const double suction = rung(ladder, j);
    int event = outcome->n; // the last for which this rung counts
    while (event > 0 && weight_of(ladder, j, highest[event - 1]) == 0 &&
           highest[event - 1] > suction)
        event--;
    find_wanted(network, outcome, &left->rings, event, room->broken, room->wanted);
    const enum status status = whole_rings(network, &left->rings, liquid, suction,
                                           room->wanted, room->whole, reason);
    if (status) return status;
    for (int f = 0; f < network->n_face; f++)
        room->broken[f] |= room->wanted[f] && !(room->whole[f] > 0);
    const int limited = divide(network, &left->rings, room->whole, room->part);
    left->limited = limited > left->limited ? limited : left->limited;
    for (int k = 0; k < outcome->n; k++)
        room->gained[k] = 0;
    find_gains(network, outcome, left, event, room->part, room->gained,
               j == ladder->n - 1 ? left->part : NULL);
    double sum = 0;
    for (int k = 0; k < event; k++) {
        const double weight = weight_of(ladder, j, highest[k]);
        sum += room->gained[k];
        left->volume[k] += weight * sum;
        room->gain[k] += weight * room->gained[k];
    }
    return STATUS_OK;
}

static enum status join(const struct network *network, const struct outcome *outcome,
                        const struct ring_liquid *liquid, struct rings_left *left,
                        struct reason *reason)
{
    double *highest = highest_so_far(outcome);
    struct workspace room = {
        NEW_ARRAY(double, network->n_face), NEW_ARRAY(double, left->rings.n_part),
        NEW_ARRAY(double, outcome->n),      NEW_ARRAY(bool, network->n_face),
        NEW_ARRAY(bool, network->n_face),   NEW_ARRAY(double, outcome->n)};
    const struct ladder ladder = ladder_over(highest[0], highest[outcome->n - 1]);
    enum status status = STATUS_OK;
    for (int j = 0; j < ladder.n && !status; j++)
        status = add_rung(network, outcome, liquid, &ladder, j, highest, &room, left,
                          reason);
    for (int k = outcome->n - 1; k > 0; k--)
        left->volume[k - 1] = fmax(left->volume[k - 1], left->volume[k] - room.gain[k]);
    free(highest);
    free(room.gain);
    free(room.whole);
    free(room.part);
    free(room.gained);
    free(room.wanted);
    free(room.broken);
    return status;
}

// ---- the whole ----------------------------------------------------------------------

enum status rings_left_init(const struct network *network,
                            const struct outcome *outcome, enum ring_supply supply,
                            const struct ring_liquid *liquid, double weight,
                            struct rings_left *left, struct reason *reason)
{
    *left = (struct rings_left){0};
    const enum status status = contact_rings_init(network, &left->rings, reason);
    if (status) return status;
    left->volume = NEW_ARRAY(double, outcome->n);
    left->part = NEW_ARRAY(double, left->rings.n_part);
    if (outcome->n == 0) return STATUS_OK;
    return supply == RINGS_ISOLATED
               ? isolate(network, outcome, liquid, weight, left, reason)
               : join(network, outcome, liquid, left, reason);
}

void rings_left_free(struct rings_left *left)
{
    free(left->volume);
    free(left->part);
    contact_rings_free(&left->rings);
    *left = (struct rings_left){0};
}
