// SPDX-License-Identifier: GPL-3.0-or-later
// Porosity of a window and of its slices along z: solid = spheres - lenses of touching
// pairs, each cut by the slice (sphere_box_volume.h); porosity = 1 - solid / volume.
// The height of a centre over the lower end of the window is `height`; slice k lies
// from k w - height to (k + 1) w - height as seen from it. Where the box repeats along
// z slices are counted on beyond its ends and wrapped; where it repeats along x or y
// nothing is cut there, as an image fills in what sticks out.
#include "geometry/porosity.h"

#include "geometry/neighbours.h"
#include "geometry/sphere_box_volume.h"

// What is cut into slices: a sphere, or the lens of a pair of them.
struct piece {
    struct vector centre; // of the sphere, or the first of the pair
    double radius;
    struct lens lens; // when radius is 0
    double low, high; // its ends along z, from the centre
};

struct slices {
    const struct packing *packing;
    const struct window *window;
    int count;
    double thickness;
    double *solid; // (count), m^3
};

bool packing_is_flat(const struct packing *packing)
{
    double largest = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        if (packing->position[i].y != packing->position[0].y) return false;
        largest = fmax(largest, packing->radius[i]);
    }
    return !packing->periodic[1] && packing->upper.y - packing->lower.y < 4 * largest;
}

// Summed as differences: equal radii have just that mean.
double mean_radius(const struct packing *packing)
{
    double sum = 0;
    for (int i = 0; i < packing->n_particle; i++)
        sum += packing->radius[i] - packing->radius[0];
    return packing->n_particle ? packing->radius[0] + sum / packing->n_particle : 0;
}

bool inner_window(const struct packing *packing, struct window *window)
{
    const bool flat = packing_is_flat(packing);
    const double margin = 2 * mean_radius(packing);
    *window = (struct window){packing->lower, packing->upper};
    for (int axis = 0; axis < 3; axis++) {
        if (packing->periodic[axis] || (axis == 1 && flat)) continue;
        const double low = component(packing->lower, axis) + margin;
        const double high = component(packing->upper, axis) - margin;
        if (!(high - low > 1e-9 * margin)) return false; // not what rounding leaves
        set_component(&window->lower, axis, low);
        set_component(&window->upper, axis, high);
    }
    return true;
}

double solid_volume(const struct packing *packing, const struct contacts *contacts)
{
    double volume = 0;
    for (int i = 0; i < packing->n_particle; i++)
        volume +=
            4 * M_PI / 3 * packing->radius[i] * packing->radius[i] * packing->radius[i];
    for (int k = 0; k < contacts->count; k++) {
        const int i = contacts->pair[k][0], j = contacts->pair[k][1];
        volume -= lens_volume(packing->radius[i], packing->radius[j],
                              norm(nearest_image(packing, i, j)));
    }
    return volume;
}

// The part of BODY from LOW to HIGH, seen from its centre; a lens is to be taken off.
static double part(const struct piece *body, struct vector low, struct vector high)
{
    return body->radius > 0 ? sphere_in_box(body->radius, low, high)
                            : -lens_in_box(&body->lens, low, high);
}

// Adds what BODY has in each slice it may reach. Slices beyond a side that repeats are
// those of the other side.
static void add_body(struct slices *slices, const struct piece *body)
{
    const uint8_t *periodic = slices->packing->periodic;
    struct vector low = subtract(slices->window->lower, body->centre);
    struct vector high = subtract(slices->window->upper, body->centre);
    const double edge = high.z - low.z, w = slices->thickness;
    double height = -low.z;
    if (periodic[0]) low.x = -HUGE_VAL, high.x = HUGE_VAL;
    if (periodic[1]) low.y = -HUGE_VAL, high.y = HUGE_VAL;
    if (periodic[2]) height = fmax(0, fmin(height - edge * floor(height / edge), edge));
    double first = floor((height + body->low) / w);
    double last = floor((height + body->high) / w);
    if (!periodic[2]) {
        first = fmax(first, 0);
        last = fmin(last, slices->count - 1);
    }
    const int reached = (int)fmax(0, last - first + 1);
    for (int place = 0; place < reached; place++) {
        const double k = first + place;
        low.z = k * w - height;
        high.z = (k + 1) * w - height;
        const double wrapped = k - slices->count * floor(k / slices->count);
        slices->solid[(int)wrapped] += part(body, low, high);
    }
}

void slice_porosity(const struct packing *packing, const struct contacts *contacts,
                    const struct window *window, int count, double *porosity)
{
    const struct vector edge = subtract(window->upper, window->lower);
    struct slices slices = {packing, window, count, edge.z / count, porosity};
    for (int k = 0; k < count; k++)
        porosity[k] = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        const double r = packing->radius[i];
        add_body(&slices, &(struct piece){.centre = packing->position[i],
                                          .radius = r,
                                          .low = -r,
                                          .high = r});
    }
    for (int k = 0; k < contacts->count; k++) {
        const int i = contacts->pair[k][0], j = contacts->pair[k][1];
        struct piece body = {.centre = packing->position[i]};
        body.lens = lens_between(packing->radius[i], packing->radius[j],
                                 nearest_image(packing, i, j));
        body.low = body.lens.lower.z;
        body.high = body.lens.upper.z;
        if (body.lens.volume > 0) add_body(&slices, &body);
    }
    for (int k = 0; k < count; k++)
        porosity[k] = 1 - porosity[k] / edge.x / edge.y / slices.thickness;
}
