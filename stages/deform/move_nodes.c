// SPDX-License-Identifier: GPL-3.0-or-later
#include "basics/memory.h"
#include "move.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <stdlib.h>

// ---- the box ------------------------------------------------------------------------

// Of the grains beside a wall, along its axis, m.
struct layer_of_grains {
    int count;
    double place, moved; // means
};

static struct layer_of_grains beside_wall(const struct packing *before,
                                          const struct packing *after, int wall,
                                          double reach)
{
    struct layer_of_grains layer = {0};
    const int axis = wall / 2;
    for (int i = 0; i < before->n_particle; i++) {
        const double place = component(before->position[i], axis);
        if (fabs(place - wall_position(before, wall)) > reach) continue;
        layer.place += place;
        layer.moved += component(after->position[i], axis) - place;
        layer.count++;
    }
    if (!layer.count) return layer;
    layer.place /= layer.count;
    layer.moved /= layer.count;
    return layer;
}

void move_box(const struct packing *before, struct packing *after)
{
    double diameter = 0;
    for (int i = 0; i < before->n_particle; i++)
        diameter += 2 * before->radius[i] / before->n_particle;
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        const int axis = wall / 2;
        if (before->periodic[axis]) continue;
        const struct layer_of_grains here = beside_wall(before, after, wall, diameter),
                                     there =
                                         beside_wall(before, after, wall ^ 1, diameter);
        const double at = wall_position(before, wall);
        const double apart = there.place - here.place;
        // A single layer, or none, tells nothing of how the body stretches.
        const bool stretches = here.count && there.count && fabs(apart) > diameter / 2;
        const double stretch = stretches ? (there.moved - here.moved) / apart : 0;
        set_component(wall % 2 ? &after->upper : &after->lower, axis,
                      at + (here.moved + stretch * (at - here.place)));
    }
}

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

// The shortest step along the AXES (n_axis) for which every
//     -2 (to - mean) . step = wanted
// holds, or nearly so; not a number where there is none.
static struct vector solve(const struct view *view, const double *wanted,
                           const int *axes, int n_axis)
{
    static const double negligible = 1e-10; // of the largest singular value
    const size_t rows = (size_t)(view->n > n_axis ? view->n : n_axis);
    const size_t columns = (size_t)n_axis;
    gsl_matrix *a = gsl_matrix_calloc(rows, columns);
    gsl_matrix *v = gsl_matrix_alloc(columns, columns);
    gsl_vector *s = gsl_vector_alloc(columns), *b = gsl_vector_calloc(rows);
    gsl_vector *x = gsl_vector_alloc(columns);
    for (int k = 0; k < view->n; k++) {
        const struct vector off = subtract(view->to[k], view->mean);
        for (int c = 0; c < n_axis; c++)
            gsl_matrix_set(a, (size_t)k, (size_t)c, -2 * component(off, axes[c]));
        gsl_vector_set(b, (size_t)k, wanted[k]);
    }
    const bool fails = gsl_linalg_SV_decomp_jacobi(a, v, s) != GSL_SUCCESS;
    for (size_t c = 0; c < columns; c++) // gsl_linalg_SV_solve leaves those of 0 out
        if (gsl_vector_get(s, c) <= negligible * gsl_vector_get(s, 0))
            gsl_vector_set(s, c, 0);
    gsl_linalg_SV_solve(a, v, s, b, x);
    struct vector step = {fails ? NAN : 0, 0, 0};
    for (int c = 0; c < n_axis && !fails; c++)
        set_component(&step, axes[c], gsl_vector_get(x, (size_t)c));
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

// The grains' mean, or that of the wall along the axes of WALLS; lists the others.
static struct vector first_guess(const struct packing *before,
                                 const struct packing *after,
                                 const struct grain_beside *beside, int n,
                                 unsigned walls, int axes[3], int *n_axis)
{
    struct vector step = {0};
    for (int k = 0; k < n; k++)
        step = add(step, scale(1.0 / n, subtract(after->position[beside[k].grain],
                                                 before->position[beside[k].grain])));
    *n_axis = 0;
    for (int axis = 0; axis < 3; axis++) {
        const unsigned here = walls >> (2 * axis) & 3;
        if (here)
            set_component(&step, axis,
                          wall_step(before, after, 2 * axis + !(here & 1)));
        else
            axes[(*n_axis)++] = axis;
    }
    return step;
}

static void move_node(const struct network *before, const struct surroundings *around,
                      int node, struct view view[2], struct network *after)
{
    const struct grain_beside *beside = around->at + around->offset[node];
    const int n = (int)(around->offset[node + 1] - around->offset[node]);
    const struct vector at = before->node_position[node];
    int axes[3], n_axis;
    const struct vector guess =
        add(at, first_guess(&before->packing, &after->packing, beside, n,
                            around->walls[node], axes, &n_axis));
    after->node_position[node] = guess;
    if (n < 2 || n_axis == 0) return;
    view[0].n = view[1].n = n;
    look(&before->packing, beside, at, &view[0]);
    look(&after->packing, beside, guess, &view[1]);
    const double scaling = view[1].spread / view[0].spread;
    double *wanted = view[0].power; // no longer needed
    bool moves = false;
    for (int k = 0; k < n; k++) {
        wanted[k] = scaling * (view[0].power[k] - view[0].mean_power) -
                    (view[1].power[k] - view[1].mean_power);
        moves |= wanted[k] != 0;
    }
    if (!isfinite(scaling))
        after->node_position[node].x = NAN; // no numbers hold it
    else if (moves)
        after->node_position[node] = add(guess, solve(&view[1], wanted, axes, n_axis));
}

void move_nodes(const struct network *before, const struct surroundings *around,
                struct network *after)
{
    int most = 0;
    for (int i = 0; i < before->n_node; i++) {
        const int n = (int)(around->offset[i + 1] - around->offset[i]);
        most = n > most ? n : most;
    }
    struct view view[2];
    for (int k = 0; k < 2; k++)
        view[k] = (struct view){.to = NEW_ARRAY(struct vector, most),
                                .power = NEW_ARRAY(double, most)};
    for (int i = 0; i < before->n_node; i++)
        move_node(before, around, i, view, after);
    for (int k = 0; k < 2; k++) {
        free(view[k].to);
        free(view[k].power);
    }
}
