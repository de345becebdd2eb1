// SPDX-License-Identifier: GPL-3.0-or-later
#include "basics/memory.h"
#include "move.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <stdlib.h>
#include <string.h>

enum { ROUND = 1u << WALL_OUTER };

// ---- one node -----------------------------------------------------------------------

// The grains around a node, seen from it.
struct view {
    int n;
    struct vector *to; // (n)
    double *power;     // (n) distance squared less radius squared
    struct vector mean;
    double mean_power, spread; // of TO around its mean, squared
};

static void look(const struct packing *packing, const struct grain_beside *beside,
                 struct vector from, struct view *view)
{
    view->mean = (struct vector){0};
    view->mean_power = view->spread = 0;
    for (int k = 0; k < view->n; k++) {
        const double radius = packing->radius[beside[k].grain];
        view->to[k] = to_grain(packing, beside[k], from);
        view->power[k] = dot(view->to[k], view->to[k]) - radius * radius;
        view->mean = add(view->mean, scale(1.0 / view->n, view->to[k]));
        view->mean_power += view->power[k] / view->n;
    }
    for (int k = 0; k < view->n; k++) {
        const struct vector off = subtract(view->to[k], view->mean);
        view->spread += dot(off, off);
    }
}

// Directions, at right angles, that a node may move in.
struct ways {
    int n;
    struct vector way[3];
};

// The shortest step along these for which every
//     -2 (to - mean) . step = wanted
// holds, or nearly so; not a number where there is none.
static struct vector solve(const struct view *view, const double *wanted,
                           const struct ways *along)
{
    static const double negligible = 1e-10; // of the largest singular value
    const size_t rows = (size_t)(view->n > along->n ? view->n : along->n);
    const size_t columns = (size_t)along->n;
    gsl_matrix *a = gsl_matrix_calloc(rows, columns);
    gsl_matrix *v = gsl_matrix_alloc(columns, columns);
    gsl_vector *s = gsl_vector_alloc(columns), *b = gsl_vector_calloc(rows);
    gsl_vector *x = gsl_vector_alloc(columns);
    for (int k = 0; k < view->n; k++) {
        const struct vector off = subtract(view->to[k], view->mean);
        for (int c = 0; c < along->n; c++)
            gsl_matrix_set(a, (size_t)k, (size_t)c, -2 * dot(off, along->way[c]));
        gsl_vector_set(b, (size_t)k, wanted[k]);
    }
    const bool fails = gsl_linalg_SV_decomp_jacobi(a, v, s) != GSL_SUCCESS;
    for (size_t c = 0; c < columns; c++) // gsl_linalg_SV_solve leaves those of 0 out
        if (gsl_vector_get(s, c) <= negligible * gsl_vector_get(s, 0))
            gsl_vector_set(s, c, 0);
    gsl_linalg_SV_solve(a, v, s, b, x);
    struct vector step = {fails ? NAN : 0, 0, 0};
    for (int c = 0; c < along->n && !fails; c++)
        step = add(step, scale(gsl_vector_get(x, (size_t)c), along->way[c]));
    gsl_matrix_free(a);
    gsl_matrix_free(v);
    gsl_vector_free(s);
    gsl_vector_free(b);
    gsl_vector_free(x);
    return step;
}

// How far a wall has moved.
static double wall_step(const struct packing *before, const struct packing *after,
                        int wall)
{
    return wall_position(after, wall) - wall_position(before, wall);
}

// The grains' mean, or that of the wall along the axes of flat WALLS.
static struct vector first_guess(const struct packing *before,
                                 const struct packing *after,
                                 const struct grain_beside *beside, int n,
                                 unsigned walls)
{
    struct vector step = {0};
    for (int k = 0; k < n; k++)
        step = add(step, scale(1.0 / n, subtract(after->position[beside[k].grain],
                                                 before->position[beside[k].grain])));
    for (int axis = 0; axis < 3; axis++) {
        const unsigned here = walls >> (2 * axis) & 3;
        if (here)
            set_component(&step, axis,
                          wall_step(before, after, 2 * axis + !(here & 1)));
    }
    return step;
}

static bool same_bodies(const struct packing *a, const struct packing *b)
{
    return !memcmp(a->body, b->body, (size_t)a->n_body * sizeof *a->body);
}

// Which way out of the round wall it is at AT.
static struct vector outward(const struct packing *packing, struct vector at)
{
    for (int k = 0; k < packing->n_body; k++) {
        const struct body body = body_near(packing, k, at);
        if (body_wall(&body) == WALL_OUTER) return body_outward(&body, at);
    }
    return (struct vector){0};
}

// Of a node AT in WALLS: along them.
static struct ways find_ways(const struct packing *packing, unsigned walls,
                             struct vector at)
{
    struct ways ways = {0};
    for (int axis = 0; axis < 3; axis++) {
        if (walls >> (2 * axis) & 3) continue;
        struct vector way = {0};
        set_component(&way, axis, 1);
        ways.way[ways.n++] = way;
    }
    if (!(walls & ROUND) || !ways.n) return ways;
    struct vector out = {0}; // within the flat walls
    for (int c = 0; c < ways.n; c++)
        out = add(out, scale(dot(outward(packing, at), ways.way[c]), ways.way[c]));
    if (!(norm(out) > 0)) return ways;
    out = scale(1 / norm(out), out);
    int steepest = 0;
    for (int c = 1; c < ways.n; c++)
        if (fabs(dot(out, ways.way[c])) > fabs(dot(out, ways.way[steepest])))
            steepest = c;
    ways.way[steepest] = ways.way[--ways.n];
    for (int c = 0; c < ways.n; c++) { // Gram and Schmidt
        struct vector *way = &ways.way[c];
        *way = subtract(*way, scale(dot(*way, out), out));
        for (int b = 0; b < c; b++)
            *way = subtract(*way, scale(dot(*way, ways.way[b]), ways.way[b]));
        *way = scale(1 / norm(*way), *way);
    }
    return ways;
}

// From AT, where the grains are VIEWed from now, to where the differences of powers are
// those BEFORE, scaled; AT itself where they are so.
static struct vector step_to(const struct view *before, struct view *now,
                             const struct ways *along)
{
    const double scaling = now->spread / before->spread;
    if (!isfinite(scaling)) return (struct vector){NAN, 0, 0}; // no numbers hold it
    double *wanted = now->power;                               // no longer needed
    bool moves = false;
    for (int k = 0; k < now->n; k++) {
        wanted[k] = scaling * (before->power[k] - before->mean_power) -
                    (now->power[k] - now->mean_power);
        moves |= wanted[k] != 0;
    }
    return moves ? solve(now, wanted, along) : (struct vector){0};
}

// False where no place in its round wall is found.
static bool move_node(const struct network *before, const struct surroundings *around,
                      int node, struct view view[2], struct network *after)
{
    enum { MOST_STEPS = 30 };
    static const double rest = 1e-13; // of how far the grains spread
    const struct grain_beside *beside = around->at + around->offset[node];
    const int n = (int)(around->offset[node + 1] - around->offset[node]);
    const unsigned walls = around->walls[node];
    const struct packing *packing = &after->packing;
    const struct vector from = before->node_position[node];
    const struct vector guess =
        first_guess(&before->packing, packing, beside, n, walls);
    struct vector at = add(from, guess);
    const bool is_round = walls & ROUND;
    if (is_round && (norm(guess) > 0 || !same_bodies(&before->packing, packing)))
        at = nearest_on_wall(packing, WALL_OUTER, at);
    after->node_position[node] = at;
    struct ways ways = find_ways(packing, walls, at);
    if (n < 2 || ways.n == 0) return true;
    view[0].n = view[1].n = n;
    look(&before->packing, beside, from, &view[0]);
    for (int k = 0; k < MOST_STEPS; k++) {
        look(packing, beside, at, &view[1]);
        const struct vector step = step_to(&view[0], &view[1], &ways);
        at = after->node_position[node] = add(at, step);
        if (!is_round || norm(step) == 0) return true;
        at = after->node_position[node] = nearest_on_wall(packing, WALL_OUTER, at);
        if (norm(step) <= rest * sqrt(view[1].spread)) return true;
        ways = find_ways(packing, walls, at);
    }
    return false;
}

int move_nodes(const struct network *before, const struct surroundings *around,
               struct network *after)
{
    int most = 0, lost = 0;
    for (int i = 0; i < before->n_node; i++) {
        const int n = (int)(around->offset[i + 1] - around->offset[i]);
        most = n > most ? n : most;
    }
    struct view view[2];
    for (int k = 0; k < 2; k++)
        view[k] = (struct view){.to = NEW_ARRAY(struct vector, most),
                                .power = NEW_ARRAY(double, most)};
    for (int i = 0; i < before->n_node; i++)
        lost += !move_node(before, around, i, view, after);
    for (int k = 0; k < 2; k++) {
        free(view[k].to);
        free(view[k].power);
    }
    return lost;
}
