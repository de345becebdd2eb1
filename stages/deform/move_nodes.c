// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes follow their grains. A node at c keeps the differences of its powers to the
// grains around it, P_k = |x_k - c|^2 - R_k^2, scaled with the squared spread of the
// grains:
//     P_k(c + step) - mean = scaling (P_k before - mean before),
// which is linear in the step, since |step|^2 cancels:
//     -2 (to_k - mean of to) . step = wanted_k.
// Solved by singular values (shortest step, least squares), within the directions that
// the node's flat surfaces leave free. On a round surface: tangential steps, each
// followed by a projection to the surface, from a guess that includes the rotation of
// the grains. For a vertex of the diagram all differences are 0 and stay 0, so it
// stays a vertex.
#include "basics/memory.h"
#include "domain_sides.h"
#include "move.h"
#include "rotation.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <stdlib.h>
#include <string.h>

// ---- one node -----------------------------------------------------------------------

// The grains around a node, seen from it.
struct view {
    int n;
    struct vector *to; // (n)
    double *power;     // (n) distance squared less radius squared
    struct vector mean;
    double mean_power, spread; // of TO around its mean, squared
};

static void view_grains(const struct packing *packing,
                        const struct grain_beside *beside, struct vector from,
                        struct view *view)
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

// Orthonormal directions in which a node may move.
struct directions {
    int n;
    struct vector direction[3];
};

// The shortest step along these directions that solves
//     -2 (to - mean) . step = wanted
// by least squares; NAN if the decomposition fails.
static struct vector solve(const struct view *view, const double *wanted,
                           const struct directions *along)
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
            gsl_matrix_set(a, (size_t)k, (size_t)c, -2 * dot(off, along->direction[c]));
        gsl_vector_set(b, (size_t)k, wanted[k]);
    }
    const bool fails = gsl_linalg_SV_decomp_jacobi(a, v, s) != GSL_SUCCESS;
    for (size_t c = 0; c < columns; c++) // gsl_linalg_SV_solve leaves those of 0 out
        if (gsl_vector_get(s, c) <= negligible * gsl_vector_get(s, 0))
            gsl_vector_set(s, c, 0);
    gsl_linalg_SV_solve(a, v, s, b, x);
    struct vector step = {fails ? NAN : 0, 0, 0};
    for (int c = 0; c < along->n && !fails; c++)
        step = add(step, scale(gsl_vector_get(x, (size_t)c), along->direction[c]));
    gsl_matrix_free(a);
    gsl_matrix_free(v);
    gsl_vector_free(s);
    gsl_vector_free(b);
    gsl_vector_free(x);
    return step;
}

// The mean displacement of the grains; along a held axis that of the flat surface.
static struct vector first_guess(const struct packing *before,
                                 const struct packing *after,
                                 const struct grain_beside *beside, int n,
                                 const struct domain_sides *sides)
{
    struct vector step = {0};
    for (int k = 0; k < n; k++)
        step = add(step, scale(1.0 / n, subtract(after->position[beside[k].grain],
                                                 before->position[beside[k].grain])));
    for (int axis = 0; axis < 3; axis++)
        if (sides->held[axis]) set_component(&step, axis, sides->step[axis]);
    return step;
}

// What the rotation of the grains about their mean adds to the guess.
static struct vector rotation_of_guess(const struct view view[2])
{
    struct products products = {0};
    for (int k = 0; k < view[0].n; k++)
        add_products(&products, subtract(view[0].to[k], view[0].mean),
                     subtract(view[1].to[k], view[1].mean));
    const struct rotation rotation = find_rotation(&products);
    return subtract(view[0].mean, rotated(&rotation, view[0].mean));
}

static bool same_bodies(const struct packing *a, const struct packing *b)
{
    return !memcmp(a->body, b->body, (size_t)a->n_body * sizeof *a->body);
}

static struct vector onto_round(const struct packing *packing, int k, struct vector at)
{
    const struct body body = body_near(packing, k, at);
    return body_nearest_round(&body, at);
}

// The directions along the surfaces that a node AT is on.
static struct directions find_directions(const struct packing *packing,
                                         const struct domain_sides *sides,
                                         struct vector at)
{
    struct directions directions = {0};
    for (int axis = 0; axis < 3; axis++) {
        if (sides->held[axis]) continue;
        struct vector direction = {0};
        set_component(&direction, axis, 1);
        directions.direction[directions.n++] = direction;
    }
    if (sides->round < 0 || !directions.n) return directions;
    const struct body body = body_near(packing, sides->round, at);
    const struct vector outward = body_outward(&body, at);
    struct vector out = {0}; // within the flat surfaces
    for (int c = 0; c < directions.n; c++)
        out = add(
            out, scale(dot(outward, directions.direction[c]), directions.direction[c]));
    if (!(norm(out) > 0)) return directions;
    out = scale(1 / norm(out), out);
    int steepest = 0;
    for (int c = 1; c < directions.n; c++)
        if (fabs(dot(out, directions.direction[c])) >
            fabs(dot(out, directions.direction[steepest])))
            steepest = c;
    directions.direction[steepest] = directions.direction[--directions.n];
    for (int c = 0; c < directions.n; c++) { // Gram and Schmidt
        struct vector *direction = &directions.direction[c];
        *direction = subtract(*direction, scale(dot(*direction, out), out));
        for (int b = 0; b < c; b++)
            *direction =
                subtract(*direction, scale(dot(*direction, directions.direction[b]),
                                           directions.direction[b]));
        *direction = scale(1 / norm(*direction), *direction);
    }
    return directions;
}

// The step from the present place, with the view NOW, to where the differences of
// powers are those BEFORE, scaled; 0 if they are so already.
static struct vector step_to(const struct view *before, struct view *now,
                             const struct directions *along)
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

// Moves one node. False if no place on its round surface is found.
static bool move_node(const struct network *before,
                      const struct neighbour_grains *around, int node,
                      struct view view[2], struct network *after)
{
    enum { MAX_STEPS = 30 };
    static const double rest = 1e-13; // of how far the grains spread
    const struct grain_beside *beside = around->at + around->offset[node];
    const int n = (int)(around->offset[node + 1] - around->offset[node]);
    const struct packing *packing = &after->packing;
    const struct vector from = before->node_position[node];
    const struct domain_sides sides =
        find_domain_sides(&before->packing, packing, around->walls[node], from);
    const struct vector guess =
        first_guess(&before->packing, packing, beside, n, &sides);
    struct vector at = add(from, guess);
    const bool is_round = sides.round >= 0;
    view[0].n = view[1].n = n;
    view_grains(&before->packing, beside, from, &view[0]);
    if (is_round && (norm(guess) > 0 || !same_bodies(&before->packing, packing))) {
        view_grains(packing, beside, from, &view[1]);
        at = add(at, rotation_of_guess(view));
        at = onto_round(packing, sides.round, at);
    }
    after->node_position[node] = at;
    struct directions directions = find_directions(packing, &sides, at);
    if (n < 2 || directions.n == 0) return true;
    for (int k = 0; k < MAX_STEPS; k++) {
        view_grains(packing, beside, at, &view[1]);
        const struct vector step = step_to(&view[0], &view[1], &directions);
        at = after->node_position[node] = add(at, step);
        if (!is_round || norm(step) == 0) return true;
        at = after->node_position[node] = onto_round(packing, sides.round, at);
        if (norm(step) <= rest * sqrt(view[1].spread)) return true;
        directions = find_directions(packing, &sides, at);
    }
    return false;
}

int move_nodes(const struct network *before, const struct neighbour_grains *around,
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
