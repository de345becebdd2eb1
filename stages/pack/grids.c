// SPDX-License-Identifier: GPL-3.0-or-later
// A hierarchy of uniform grids: level k has the grains with radii in (largest/2,
// largest], in cells at least one diameter wide, as linked lists. A query visits, on
// each level, the cells within reach of that level's largest radius: so its cost does
// not depend on the ratio of radii. A grain of radius r is near a place if |centre -
// place| < to_surface + r, so the cells to look in reach to_surface + largest of the
// level. Across periodic sides cells are counted modulo their number, each at most
// once. Cells are at most about four for each grain expected.
#include "grids.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_LEVELS = 24, MAX_CELLS = 1 << 24 };

// One grid: grains with radii above half of LARGEST.
struct level {
    double largest; // m
    int count[3];   // cells
    double width[3];
    int *first; // (cells) first grain, or -1; NULL until there is a grain
};

struct grids {
    const struct domain *domain;
    double expected;
    int n_level;
    struct level level[MAX_LEVELS];
    int n, capacity_centre, capacity_radius, capacity_next;
    struct vector *centre;
    double *radius;
    int *next; // next grain of the same cell, or -1
};

struct grids *grids_create(const struct domain *domain, double smallest, double largest,
                           double expected)
{
    struct grids *grids = NEW_ARRAY(struct grids, 1);
    grids->domain = domain;
    grids->expected = fmax(expected, 1);
    for (double radius = largest; grids->n_level < MAX_LEVELS; radius /= 2) {
        grids->level[grids->n_level++].largest = radius;
        if (radius / 2 < smallest) break;
    }
    return grids;
}

void grids_free(struct grids *grids)
{
    for (int k = 0; k < grids->n_level; k++)
        free(grids->level[k].first);
    free(grids->centre);
    free(grids->radius);
    free(grids->next);
    free(grids);
}

int grids_count(const struct grids *grids)
{
    return grids->n;
}

struct vector grids_centre(const struct grids *grids, int grain)
{
    return grids->centre[grain];
}

double grids_radius(const struct grids *grids, int grain)
{
    return grids->radius[grain];
}

// Cells at least one largest diameter wide, and at most about four a grain.
static void make_cells(struct level *level, const struct domain *domain,
                       double expected)
{
    const struct vector edge = subtract(domain->upper, domain->lower);
    const double most = fmin(4 * expected + 64, MAX_CELLS);
    const bool flat = domain->dimensions == 2;
    const double share =
        flat ? sqrt(edge.x / most * edge.z) : cbrt(edge.x / most * edge.y * edge.z);
    const double width = fmax(2 * level->largest, share);
    size_t total = 1;
    for (int axis = 0; axis < 3; axis++) {
        const double along = component(edge, axis);
        const double wanted = flat && axis == 1 ? 1 : floor(along / width);
        level->count[axis] = (int)fmin(fmax(wanted, 1), MAX_CELLS);
        level->width[axis] = along / level->count[axis];
        total *= (size_t)level->count[axis];
    }
    level->first = NEW_ARRAY(int, total);
    memset(level->first, -1, total * sizeof *level->first);
}

static int cell_of(const struct level *level, const int at[3])
{
    return at[0] + level->count[0] * (at[1] + level->count[1] * at[2]);
}

static struct level *level_of(struct grids *grids, double radius)
{
    int k = 0;
    while (k < grids->n_level - 1 && radius <= grids->level[k + 1].largest)
        k++;
    return &grids->level[k];
}

// The cells along AXIS within REACH of PLACE: the first, FROM, which may be negative
// along a periodic axis, and how many.
static int reached(const struct grids *grids, const struct level *level, double place,
                   double reach, int axis, int *from)
{
    const int count = level->count[axis];
    const double low = component(grids->domain->lower, axis);
    const double first = floor((place - reach - low) / level->width[axis]);
    const double last = floor((place + reach - low) / level->width[axis]);
    if (grids->domain->periodic[axis]) {
        const bool all = last - first + 1 >= count;
        *from = all ? 0 : (int)first;
        return all ? count : (int)(last - first) + 1;
    }
    *from = (int)fmin(fmax(first, 0), count - 1);
    return (int)fmin(fmax(last, 0), count - 1) - *from + 1;
}

void grids_add(struct grids *grids, struct vector centre, double radius)
{
    struct level *level = level_of(grids, radius);
    if (!level->first) make_cells(level, grids->domain, grids->expected);
    GROW_ARRAY(grids->centre, grids->n, grids->capacity_centre);
    GROW_ARRAY(grids->radius, grids->n, grids->capacity_radius);
    GROW_ARRAY(grids->next, grids->n, grids->capacity_next);
    int at[3];
    for (int axis = 0; axis < 3; axis++) {
        const int count = level->count[axis];
        reached(grids, level, component(centre, axis), 0, axis, &at[axis]);
        at[axis] = (at[axis] % count + count) % count;
    }
    int *head = &level->first[cell_of(level, at)];
    grids->centre[grids->n] = centre;
    grids->radius[grids->n] = radius;
    grids->next[grids->n] = *head;
    *head = grids->n++;
}

static int near_in_level(const struct grids *grids, const struct level *level,
                         struct vector centre, double to_surface, int *found, int most)
{
    int from[3], span[3], count = 0;
    for (int axis = 0; axis < 3; axis++)
        span[axis] = reached(grids, level, component(centre, axis),
                             to_surface + level->largest, axis, &from[axis]);
    for (int k = 0; k < span[0] * span[1] * span[2]; k++) {
        const int step[3] = {k % span[0], k / span[0] % span[1], k / span[0] / span[1]};
        int at[3];
        for (int axis = 0; axis < 3; axis++) {
            const int cells = level->count[axis];
            const int cell = from[axis] + step[axis];
            at[axis] =
                cell < 0 || cell >= cells ? (cell % cells + cells) % cells : cell;
        }
        for (int i = level->first[cell_of(level, at)]; i >= 0; i = grids->next[i]) {
            if (norm(nearest_apart(grids->domain, centre, grids->centre[i])) >=
                to_surface + grids->radius[i])
                continue;
            if (count == most) return count;
            found[count++] = i;
        }
        if (count && count == most) return count;
    }
    return count;
}

int grids_near(const struct grids *grids, struct vector centre, double radius,
               double gap, int *found, int most)
{
    int count = 0;
    for (int k = 0; k < grids->n_level && count < most; k++)
        if (grids->level[k].first)
            count += near_in_level(grids, &grids->level[k], centre, radius + gap,
                                   found + count, most - count);
    return count;
}
