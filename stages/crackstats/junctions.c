// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons filled to their borders (polygons.nearest) meet at corners of four columns
// with three or more polygons around them. Two corners at most h / 2 apart belong to
// one junction, and so do corners that a chain of such pairs joins; it lies at their
// mean. A circle of radius h / 2 about it, followed by angle, crosses the borders;
// angles between crossings are those between cracks:
//     T: largest above 155 degrees, Y: largest below 135 degrees.
// Where the circle crosses fewer than three borders, or more than five (another
// junction is near), nothing is measured.
#include "junctions.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

struct point {
    double x, y; // m
};

// Different polygons around the upper right corner of column C.
static int meeting_at(const struct columns *columns, const int *nearest, int c)
{
    int seen[4], count = 0;
    for (int k = 0; k < 4; k++) {
        const int other = column_beside(columns, c, k % 2, k / 2);
        if (other < 0) return 0;
        bool new = true;
        for (int j = 0; j < count; j++)
            new = new &&seen[j] != nearest[other];
        if (new) seen[count++] = nearest[other];
    }
    return count;
}

static struct point corner_of(const struct columns *columns, int c)
{
    const int x = c % columns->count[0], y = c / columns->count[0];
    return (struct point){columns->lower[0] + (x + 1) * columns->edge[0],
                          columns->lower[1] + (y + 1) * columns->edge[1]};
}

// From A to the nearest image of B.
static struct point apart(const struct columns *columns, struct point a, struct point b)
{
    double by[2] = {b.x - a.x, b.y - a.y};
    for (int axis = 0; axis < 2; axis++) {
        const double box = columns->count[axis] * columns->edge[axis];
        if (columns->periodic[axis]) by[axis] -= box * nearbyint(by[axis] / box);
    }
    return (struct point){by[0], by[1]};
}

// The junction of each of the N corners: its lowest corner. Sets of near pairs do not
// depend on where the map begins or how it lies.
static int *join_corners(const struct columns *columns, const struct point *corner,
                         int n)
{
    static const double most = 1 + 1e-9;
    int *root = NEW_ARRAY(int, n);
    for (int k = 0; k < n; k++)
        root[k] = k;
    for (int k = 0; k < n; k++)
        for (int j = 0; j < k; j++) {
            const struct point by = apart(columns, corner[j], corner[k]);
            if (hypot(by.x, by.y) <= most * 0.5 * columns->height)
                unite_sets(root, j, k);
        }
    for (int k = 0; k < n; k++)
        root[k] = set_root(root, k);
    return root;
}

// The mean of the corners of the junction FIRST.
static struct point junction_at(const struct columns *columns,
                                const struct point *corner, const int *junction, int n,
                                int first)
{
    struct point sum = {0, 0};
    int count = 0;
    for (int k = first; k < n; k++) {
        if (junction[k] != first) continue;
        const struct point by = apart(columns, corner[first], corner[k]);
        sum = (struct point){sum.x + by.x, sum.y + by.y};
        count++;
    }
    return (struct point){corner[first].x + sum.x / count,
                          corner[first].y + sum.y / count};
}

// Largest angle between borders that a circle about AT crosses, degrees; 0 if they are
// not 3 to 5.
static double largest_angle(const struct columns *columns, const int *nearest,
                            struct point at)
{
    enum { STEPS = 1440, MOST = 5 };
    const double radius = 0.5 * columns->height;
    double crossing[MOST], largest = 0;
    int count = 0, before = -1;
    for (int k = 0; k <= STEPS; k++) {
        const double angle = 2 * M_PI * k / STEPS;
        const int now = nearest[column_at(columns, at.x + radius * cos(angle),
                                          at.y + radius * sin(angle))];
        if (k > 0 && now != before) {
            if (count == MOST) return 0;
            crossing[count++] = 360.0 * k / STEPS;
        }
        before = now;
    }
    if (count < 3) return 0;
    for (int k = 0; k < count; k++) {
        const double next = k + 1 < count ? crossing[k + 1] : crossing[0] + 360;
        largest = fmax(largest, next - crossing[k]);
    }
    return largest;
}

static void measure(struct junctions *found, double angle)
{
    if (!(angle > 0)) return;
    found->measured++;
    found->mean_largest += angle;
    found->t_share += angle > 155;
    found->y_share += angle < 135;
}

struct junctions find_junctions(const struct columns *columns,
                                const struct polygons *polygons)
{
    struct junctions found = {0};
    if (polygons->none) return found;
    struct point *corner = NEW_ARRAY(struct point, columns->n);
    int n = 0;
    for (int c = 0; c < columns->n; c++)
        if (meeting_at(columns, polygons->nearest, c) >= 3)
            corner[n++] = corner_of(columns, c);
    int *junction = join_corners(columns, corner, n);
    for (int k = 0; k < n; k++) {
        if (junction[k] != k) continue;
        const struct point at = junction_at(columns, corner, junction, n, k);
        found.count++;
        measure(&found, largest_angle(columns, polygons->nearest, at));
    }
    if (found.measured) {
        found.mean_largest /= found.measured;
        found.t_share /= found.measured;
        found.y_share /= found.measured;
    }
    free(corner);
    free(junction);
    return found;
}
