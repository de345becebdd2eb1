// SPDX-License-Identifier: GPL-3.0-or-later
// Policy iteration (Howard 1960; for M-matrices Bokanowski, Maroso and Zidani 2009):
//     levels of the sites that are not held, by their balances;
//     hold those that fell below the least, free those held whose surplus is below 0;
//     until none changes.
// Where a source falls short, all levels fall far below, and to hold all of them would
// hold far too many, which are freed in round after round. So ends of films are held
// first, and then, of the clusters below their least, those that lack most among those
// near them: they hold the others up. Rounds begin with some sweeps of Gauss-Seidel,
// which hold and free sites as they go: they find what changes near a site. A part of
// the network never loses its last held site: what they supply is what is taken there,
// 0 or more, so not all surpluses are below 0.
//
// If all that are below their least are held at once, no level falls from the second
// round on, because the matrix is an M-matrix: no set of held sites comes back, and the
// rounds are finitely many. So that is what is done after CAUTIOUS_ROUNDS.
//
// The balances of the sites that are not held are one linear system a round, which
// film_balance.h solves from the levels of before, until the true residual, from
// differences of compensated levels, is small enough.
#include "film_flow.h"

#include "basics/memory.h"
#include "film_balance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Which sites are held is found to so many tolerances first, then to ever fewer.
static const double COARSE = 1e4, FINER = 1e-2;

// Sweeps of Gauss-Seidel before each of these rounds.
enum { SWEEPS = 3 };
// They round levels. No level above its least by less than this part frees a site: it
// may be the last one held in its part of the network, which rounding must not free.
static const double ROUNDING = 1e-12;

enum { CAUTIOUS_ROUNDS = 100, MOST_ROUNDS = 1000 };

// A site from which nothing is taken gets to a least of 0 only if all around it do: no
// balance needs it held.
static bool may_be_held(const struct film_flow *flow, int i)
{
    return flow->taken[i] > 0 || flow->least[i] > 0;
}

// How far site I is below its least; 0 if it is not, or held.
static double lack(const struct film_flow *flow, int i)
{
    if (flow->held[i] || !may_be_held(flow, i)) return 0;
    const struct compensated least = {.value = flow->least[i]};
    return fmax(0, -compensated_difference(flow->level[i], least));
}

// Where films should bring liquid and have fallen below none.
static bool is_end_below(const struct film_flow *flow, int i)
{
    return !(flow->least[i] > 0) && lack(flow, i) > 0;
}

// How far a cluster that is held up holds up others: it is chosen among them.
enum { NEAR = 2 };

// MOST (n): the largest lack of a cluster near each site.
static void find_most(const struct film_flow *flow, double *most)
{
    const struct conductance_matrix *matrix = flow->matrix;
    double *before = NEW_ARRAY(double, matrix->n);
    for (int i = 0; i < matrix->n; i++)
        most[i] = flow->least[i] > 0 ? lack(flow, i) : 0;
    for (int link = 0; link < NEAR; link++) {
        memcpy(before, most, (size_t)matrix->n * sizeof *most);
        for (int i = 0; i < matrix->n; i++) {
            if (!(before[i] > 0)) continue;
            for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
                most[matrix->column[k]] = fmax(most[matrix->column[k]], before[i]);
        }
    }
    free(before);
}

// Films that have ended are held first: without them all levels may be far too low.
// Then, of the clusters below their least, those that lack most among those near them;
// all of them unless CAUTIOUS. Returns how many.
static int hold(struct film_flow *flow, bool cautious)
{
    const int n = flow->matrix->n;
    int ends = 0, low = 0, held = 0;
    for (int i = 0; i < n; i++) {
        if (!(lack(flow, i) > 0)) continue;
        low++;
        ends += is_end_below(flow, i);
    }
    if (low == 0) return 0;
    double *most = NEW_ARRAY(double, n);
    if (cautious && ends == 0) find_most(flow, most);
    for (int i = 0; i < n; i++) {
        const double here = lack(flow, i);
        const bool waits = cautious && (ends > 0 ? flow->least[i] > 0 : here < most[i]);
        if (!(here > 0) || waits) continue;
        flow->held[i] = true;
        flow->level[i] = (struct compensated){.value = flow->least[i]};
        held++;
    }
    free(most);
    return held;
}

// Holds and frees sites; returns how many.
static int change_held(struct film_flow *flow, double tolerance, bool cautious,
                       const double *residual)
{
    int changed = 0;
    for (int i = 0; i < flow->matrix->n; i++) {
        if (!flow->held[i] || !(residual[i] > tolerance)) continue;
        flow->held[i] = false;
        changed++;
    }
    return changed + hold(flow, cautious);
}

// The level of site I that balances it with those around it, or its least if it may be
// held there.
static double balanced_level(const struct film_flow *flow, const double *level, int i)
{
    const struct conductance_matrix *matrix = flow->matrix;
    double sum = -flow->taken[i];
    for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
        sum += matrix->value[k] * level[matrix->column[k]];
    const double balanced = sum / matrix->diagonal[i];
    return may_be_held(flow, i) ? fmax(flow->least[i], balanced) : balanced;
}

// Gauss-Seidel, forwards and back.
static void relax(struct film_flow *flow)
{
    const int n = flow->matrix->n;
    double *level = NEW_ARRAY(double, n);
    double most = 0; // no level is above it
    for (int i = 0; i < n; i++)
        most = fmax(most, flow->least[i]);
    for (int i = 0; i < n; i++)
        level[i] = fmin(most, compensated_value(flow->level[i]));
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (int i = 0; i < n; i++)
            level[i] = balanced_level(flow, level, i);
        for (int i = n - 1; i >= 0; i--)
            level[i] = balanced_level(flow, level, i);
    }
    for (int i = 0; i < n; i++) {
        const bool low = !(level[i] > (1 + ROUNDING) * flow->least[i]);
        flow->held[i] = low && may_be_held(flow, i);
        flow->level[i].value = flow->held[i] ? flow->least[i] : level[i];
        flow->level[i].lost = 0;
    }
    free(level);
}

// Holds the sites that only held ones of level 0 are around, with others like them: no
// liquid comes there.
static void hold_unreached(struct film_flow *flow)
{
    const struct conductance_matrix *matrix = flow->matrix;
    int *queue = NEW_ARRAY(int, matrix->n), n = 0;
    bool *reached = NEW_ARRAY(bool, matrix->n);
    for (int i = 0; i < matrix->n; i++) {
        reached[i] = flow->held[i] ? flow->least[i] > 0 : may_be_held(flow, i);
        if (reached[i]) queue[n++] = i;
    }
    for (int next = 0; next < n; next++)
        for (int k = matrix->offset[queue[next]]; k < matrix->offset[queue[next] + 1];
             k++) {
            const int j = matrix->column[k];
            if (reached[j] || flow->held[j]) continue;
            reached[j] = true;
            queue[n++] = j;
        }
    for (int i = 0; i < matrix->n; i++) {
        if (reached[i] || flow->held[i]) continue;
        flow->held[i] = true;
        flow->level[i] = (struct compensated){0};
    }
    free(queue);
    free(reached);
}

bool film_flow_solve(struct film_flow *flow, double tolerance)
{
    const int n = flow->matrix->n;
    double *residual = NEW_ARRAY(double, n);
    for (int i = 0; i < n; i++) {
        flow->held[i] =
            may_be_held(flow, i) && (flow->held[i] || is_end_below(flow, i));
        if (flow->held[i])
            flow->level[i] = (struct compensated){.value = flow->least[i]};
    }
    bool found = false;
    double coarse = COARSE * tolerance;
    for (int round = 0; round < MOST_ROUNDS; round++) {
        flow->rounds++;
        const bool cautious = round < CAUTIOUS_ROUNDS;
        if (cautious && coarse > tolerance) relax(flow);
        if (!film_balance(flow, coarse, residual)) break;
        if (change_held(flow, coarse, cautious, residual) > 0) continue;
        found = !(coarse > tolerance);
        if (found) break;
        coarse = fmax(tolerance, FINER * coarse);
    }
    for (int i = 0; i < n; i++)
        flow->surplus[i] = flow->held[i] ? fmax(0, -residual[i]) : 0;
    hold_unreached(flow);
    free(residual);
    return found;
}
