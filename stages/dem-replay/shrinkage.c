// SPDX-License-Identifier: GPL-3.0-or-later
// Shrinkage e of each grain from its dryness w in [0,1], e = strain w. With the part of
// the liquid that is gone, t = 1 - saturation,
//     uniform:  w = t,
//     front:    w = ((1 + b) t - (z_top - z) / h) / b, cut off at 0 and 1,
//     liquid:   w = 1 - m / m_most,
// where h is the height of the body between its lowest and its highest centre, b the
// width of the front over h, and m the mass of the liquid around the grain: so the
// front enters at t = 0 and has passed the floor at t = 1. A grain that never had
// liquid around it dries as with uniform. Held grains stay as they are.
#include "shrinkage.h"

#include <math.h>
#include <stddef.h>

static double cut_off(double w)
{
    return fmin(fmax(w, 0), 1);
}

struct heights {
    double top, height, diameter; // m
};

static struct heights find_heights(const struct packing *packing)
{
    double low = INFINITY, high = -INFINITY, sum = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        low = fmin(low, packing->position[i].z);
        high = fmax(high, packing->position[i].z);
        sum += 2 * packing->radius[i];
    }
    return (struct heights){high, high - low, sum / packing->n_particle};
}

// A body of one layer has no height: all of it is at its top.
static double behind_front(const struct heights *of, double front_width, double z,
                           double gone)
{
    if (!(of->height > 0)) return gone;
    const double b = isnan(front_width) ? 1 : front_width * of->diameter / of->height;
    return cut_off(((1 + b) * gone - (of->top - z) / of->height) / b);
}

void liquid_to_dryness(const double *liquid, const double *most, double saturation,
                       int n, double *dryness)
{
    for (int i = 0; i < n; i++)
        dryness[i] = most[i] > 0 ? cut_off(1 - liquid[i] / most[i]) : 1 - saturation;
}

void find_shrinkage(const struct shrinkage *how, const struct packing *packing, int row,
                    double saturation, const double *dryness, double *strain)
{
    const struct heights heights = find_heights(packing);
    const size_t n = (size_t)packing->n_particle;
    const double gone = row < 0 ? 0 : 1 - saturation;
    for (size_t i = 0; i < n; i++) {
        double w = gone;
        if (row < 0 || how->held[i])
            w = 0;
        else if (how->law == SHRINKAGE_FRONT)
            w = behind_front(&heights, how->front_width, packing->position[i].z, gone);
        else if (how->law == SHRINKAGE_LIQUID)
            w = dryness[i];
        strain[i] = how->strain * w;
    }
}
