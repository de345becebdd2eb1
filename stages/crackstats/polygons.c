// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons of a cracked layer. A column is a crack where its damage is at least
//     threshold = max(0.1, p98 / 2),   p98 the 98th percentile of the damage.
// There is no pattern where p98 < 0.2 (nothing or little broke), where fewer than half
// of the broken lateral bonds lie in crack columns, or where these are more than half
// of the area: damage spread evenly would pass the threshold otherwise. A polygon is a
// component, by sides of columns, of the others, of at least h^2 / 8; its area is that
// of all columns which it is the nearest polygon to. A set of crack columns goes
// through where in each slice of height d above the held grains at least a tenth of its
// lateral bonds are broken.
#include "polygons.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"
#include "basics/sorted.h"
#include "fragment_counts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The value that a share of 0.98 is at or below, between two linearly.
static double percentile_98(const double *value, int n)
{
    double *sorted = duplicate(value, (size_t)n, sizeof *value);
    qsort(sorted, (size_t)n, sizeof *sorted, rising_doubles);
    const double at = 0.98 * (n - 1);
    const int k = (int)at;
    const double next = sorted[k + 1 < n ? k + 1 : k];
    const double found = sorted[k] + (at - k) * (next - sorted[k]);
    free(sorted);
    return found;
}

// The damage above which a column is a crack, from the 98th PERCENTILE.
static double crack_threshold(double percentile)
{
    return fmax(0.1, 0.5 * percentile);
}

// Components of the columns where IS_CRACK is IS: their roots, the lowest column; -1
// elsewhere.
static int *components(const struct columns *columns, const bool *is_crack, bool is)
{
    int *root = NEW_ARRAY(int, columns->n);
    for (int c = 0; c < columns->n; c++)
        root[c] = c;
    for (int c = 0; c < columns->n; c++)
        for (int side = 0; side < 2 && is_crack[c] == is; side++) {
            const int next = column_beside(columns, c, side == 0, side == 1);
            if (next >= 0 && is_crack[next] == is) unite_sets(root, c, next);
        }
    int *of = NEW_ARRAY(int, columns->n);
    for (int c = 0; c < columns->n; c++)
        of[c] = is_crack[c] == is ? set_root(root, c) : -1;
    free(root);
    return of;
}

static void label_polygons(const struct columns *columns, const bool *is_crack,
                           struct polygons *p)
{
    int *of = components(columns, is_crack, false);
    int *size = NEW_ARRAY(int, columns->n), *number = NEW_ARRAY(int, columns->n);
    const double column = columns->edge[0] * columns->edge[1];
    const double least = columns->height * columns->height / 8;
    for (int c = 0; c < columns->n; c++)
        if (of[c] >= 0) size[of[c]]++;
    for (int c = 0; c < columns->n; c++)
        number[c] = size[c] * column >= least ? p->count++ : -1;
    p->label = NEW_ARRAY(int, columns->n);
    for (int c = 0; c < columns->n; c++)
        p->label[c] = of[c] >= 0 ? number[of[c]] : -1;
    free(of);
    free(size);
    free(number);
}

// ---- the nearest polygon ------------------------------------------------------------

// The polygon of the columns R away, along x or y at most, that is nearest to COLUMN,
// if nearer than *SQUARE; of equally near ones, to rounding, the first. BEST otherwise.
static int nearest_in_ring(const struct columns *columns, const int *label, int column,
                           int r, int best, double *square)
{
    static const double nearer = 1 - 1e-9;
    for (int dy = -r; dy <= r; dy++)
        for (int dx = -r; dx <= r; dx += abs(dy) == r ? 1 : 2 * r) {
            const int other = column_beside(columns, column, dx, dy);
            if (other < 0 || label[other] < 0) continue;
            const double x = dx * columns->edge[0], y = dy * columns->edge[1];
            if (x * x + y * y >= nearer * *square) continue;
            *square = x * x + y * y;
            best = label[other];
        }
    return best;
}

static int nearest_polygon(const struct columns *columns, const int *label, int column)
{
    if (label[column] >= 0) return label[column];
    const int most = columns->count[0] + columns->count[1];
    const double edge = fmin(columns->edge[0], columns->edge[1]);
    double square = INFINITY;
    int best = -1;
    for (int r = 1; r <= most && r * edge * (r * edge) < square; r++)
        best = nearest_in_ring(columns, label, column, r, best, &square);
    return best;
}

// Sides between columns of different polygons; a line across them at random is longer
// along sides by 4 / pi.
static void measure_borders(const struct columns *columns, struct polygons *p)
{
    double sides = 0;
    for (int c = 0; c < columns->n; c++)
        for (int side = 0; side < 2; side++) {
            const int next = column_beside(columns, c, side == 0, side == 1);
            if (next >= 0 && p->nearest[next] != p->nearest[c])
                sides += columns->edge[1 - side];
        }
    p->border = M_PI / 4 * sides;
}

static void share_out(const struct columns *columns, struct polygons *p)
{
    p->nearest = NEW_ARRAY(int, columns->n);
    p->area = NEW_ARRAY(double, p->count);
    for (int c = 0; c < columns->n; c++) {
        p->nearest[c] = nearest_polygon(columns, p->label, c);
        p->area[p->nearest[c]] += columns->edge[0] * columns->edge[1];
    }
    measure_borders(columns, p);
}

// ---- cracks that go through ---------------------------------------------------------

static void find_through(const struct columns *columns, const struct run *run,
                         const uint8_t *intact, const bool *is_crack,
                         struct polygons *p)
{
    static const double least = 0.1, border = 1e-6; // of the bonds in a slice; of it
    const double above = columns->top - columns->floor;
    if (above < columns->height / 2) { // held at its sides or from above: no floor
        p->through = NAN;
        return;
    }
    const int slices = (int)fmax(1, floor(above / columns->diameter - 0.5 + border));
    int *of = components(columns, is_crack, true);
    const size_t size = (size_t)columns->n * (size_t)slices;
    int *all = NEW_ARRAY(int, size), *broken = NEW_ARRAY(int, size);
    for (int b = 0; b < run->packing.n_bond; b++) {
        double length;
        const int c = column_of_bond(columns, run, b, &length);
        if (of[c] < 0 || !is_lateral(run, b)) continue;
        const struct vector along = bond_vector(&run->packing, b);
        const double z = run->packing.position[run->packing.bond[b][0]].z +
                         0.5 * along.z - columns->floor;
        // On a border the lower one: layers of a lattice lie on it, the first too.
        const int slice = (int)ceil(z / columns->diameter - border) - 1;
        if (slice < 0 || slice >= slices) continue;
        all[of[c] * slices + slice]++;
        broken[of[c] * slices + slice] += !intact[b];
    }
    int cracks = 0, through = 0;
    for (int c = 0; c < columns->n; c++) {
        if (of[c] < 0) continue;
        bool cut = true;
        for (int k = of[c] * slices; k < (of[c] + 1) * slices; k++)
            cut = cut && broken[k] > 0 && broken[k] >= least * all[k];
        cracks++;
        through += cut;
    }
    p->through = cracks ? (double)through / cracks : 0;
    free(of);
    free(all);
    free(broken);
}

// ---- all of it ----------------------------------------------------------------------

static double share_in_cracks(const struct columns *columns, const struct run *run,
                              const uint8_t *intact, const bool *is_crack)
{
    int broken = 0, inside = 0;
    for (int b = 0; b < run->packing.n_bond; b++) {
        double length;
        if (intact[b] || !is_lateral(run, b)) continue;
        broken++;
        inside += is_crack[column_of_bond(columns, run, b, &length)];
    }
    return broken ? (double)inside / broken : 0;
}

static const char *why_none(const struct polygons *p)
{
    if (p->percentile < 0.2) return "too little damage";
    if (p->in_cracks < 0.5) return "most broken bonds lie outside of the cracks";
    if (p->crack_area > 0.5) return "damage everywhere";
    return NULL;
}

struct polygons find_polygons(const struct columns *columns, const struct run *run,
                              const uint8_t *intact, const double *damage)
{
    struct polygons p = {.percentile = percentile_98(damage, columns->n)};
    p.threshold = crack_threshold(p.percentile);
    bool *is_crack = NEW_ARRAY(bool, columns->n);
    int cracks = 0;
    for (int c = 0; c < columns->n; c++)
        cracks += is_crack[c] = damage[c] >= p.threshold;
    p.crack_area = (double)cracks / columns->n;
    p.in_cracks = share_in_cracks(columns, run, intact, is_crack);
    p.none = why_none(&p);
    if (!p.none) {
        label_polygons(columns, is_crack, &p);
        if (!p.count) p.none = "no piece is large enough";
    }
    if (!p.none) {
        share_out(columns, &p);
        find_through(columns, run, intact, is_crack, &p);
    }
    free(is_crack);
    return p;
}

void polygons_free(struct polygons *polygons)
{
    free(polygons->label);
    free(polygons->nearest);
    free(polygons->area);
    *polygons = (struct polygons){0};
}

// ---- islands ------------------------------------------------------------------------

static bool *find_core(const struct run *run, const uint8_t *intact)
{
    static const double least = 0.6; // of the lateral bonds
    const int n = run->packing.n_particle;
    int *all = NEW_ARRAY(int, n), *kept = NEW_ARRAY(int, n);
    bool *core = NEW_ARRAY(bool, n);
    for (int b = 0; b < run->packing.n_bond; b++)
        for (int end = 0; end < 2 && is_lateral(run, b); end++) {
            all[run->packing.bond[b][end]]++;
            kept[run->packing.bond[b][end]] += intact[b];
        }
    for (int i = 0; i < n; i++)
        core[i] = all[i] > 0 && kept[i] >= least * all[i];
    free(all);
    free(kept);
    return core;
}

// Only grains of cores are joined. Any other grain is a set by itself, and no island.
int count_islands(const struct columns *columns, const struct run *run,
                  const uint8_t *intact)
{
    const struct packing *packing = &run->packing;
    bool *core = find_core(run, intact);
    int *root = NEW_ARRAY(int, packing->n_particle), count = 0;
    uint8_t *joins = NEW_ARRAY(uint8_t, packing->n_bond);
    for (int b = 0; b < packing->n_bond; b++)
        joins[b] = intact[b] && is_lateral(run, b) && core[packing->bond[b][0]] &&
                   core[packing->bond[b][1]];
    int *size = fragment_sizes(packing, joins, root);
    const double least = pow(columns->height / columns->diameter, 3) / 2;
    for (int i = 0; i < packing->n_particle; i++)
        count += core[i] && size[i] >= least;
    free(core);
    free(joins);
    free(root);
    free(size);
    return count;
}
