// SPDX-License-Identifier: GPL-3.0-or-later
// The pull of a unit of suction on each grain at each throat, R^2 times the integral
// of the unit normal n over the patch of the sphere that faces the throat [K 3.13,
// 3.20, 3.21]. The patch is a spherical triangle (foot of the face, both ends of the
// throat). Its cone is closed, so the integral of n over it is minus that over its
// flat sides:
//     integral of n = 1/2 sum over the three arcs of theta (a x b) / |a x b|,
// exact for any triangle, and the sum over all patches of a grain vanishes to
// rounding, because each arc belongs to two of them [K 3.22]. Small angles: theta =
// atan2(|a x b|, a . b), which keeps its digits where acos would not. In a layer the
// patch is the lune between the two ends: the arc in the plane times pi / 2.
#include "solid_angle_patches.h"

#include "basics/memory.h"

#include <stdlib.h>

// theta (A x B) / |A x B| for unit vectors A and B with the angle theta between them.
static struct vector arc(struct vector a, struct vector b)
{
    const struct vector normal = cross(a, b);
    const double sine = norm(normal);
    if (sine == 0) return (struct vector){0};
    return scale(atan2(sine, dot(a, b)) / sine, normal);
}

// The integral of the unit normal over the spherical triangle A B C, counter-clockwise
// from outside. The flat sides of its cone are circular sectors of area theta / 2.
static struct vector triangle_normal(struct vector a, struct vector b, struct vector c)
{
    return scale(0.5, add(arc(a, b), add(arc(b, c), arc(c, a))));
}

static struct vector direction(struct vector from, struct vector to)
{
    const struct vector apart = subtract(to, from);
    return scale(1 / norm(apart), apart);
}

// If the face's foot is the centre of the grain itself, any direction would do.
static struct vector towards_foot(const struct sector *sector)
{
    return direction(sector->centre, distance(sector->foot, sector->centre) > 0
                                         ? sector->foot
                                         : sector->across);
}

// In the plane of a layer, to the right of A: outwards where A runs from one end of a
// throat to the other.
static struct vector turned(struct vector a)
{
    return cross(a, (struct vector){.y = 1});
}

static struct vector arc_in_plane(const struct sector *sector)
{
    return turned(subtract(direction(sector->centre, sector->to),
                           direction(sector->centre, sector->from)));
}

static double thickness(const struct sectors *sectors)
{
    const struct packing *packing = &sectors->network->packing;
    return packing->upper.y - packing->lower.y;
}

// --- forms -------------------------------------------------------------------------

static double radius_squared(const struct sectors *sectors, const struct sector *sector)
{
    const double radius = sectors->network->packing.radius[sector->grain];
    return radius * radius;
}

// Across the plane of a layer a sphere adds pi/2 to the arc.
static struct vector solid_angle(const struct sectors *sectors,
                                 const struct sector *sector, const void *unused)
{
    (void)unused;
    const struct vector unit =
        sectors->layer ? scale(M_PI / 2, arc_in_plane(sector))
                       : triangle_normal(towards_foot(sector),
                                         direction(sector->centre, sector->from),
                                         direction(sector->centre, sector->to));
    return scale(radius_squared(sectors, sector), unit);
}

static struct vector face_area(const struct sectors *sectors,
                               const struct sector *sector, const void *unused)
{
    (void)unused;
    const struct vector from = subtract(sector->from, sector->foot);
    const struct vector to = subtract(sector->to, sector->foot);
    return sectors->layer ? scale(thickness(sectors), turned(subtract(to, from)))
                          : scale(0.5, cross(from, to));
}

// Half of it from each of the two faces beside the throat; in a layer there is one.
static struct vector to_centre(const struct sectors *sectors,
                               const struct sector *sector, const void *unused)
{
    (void)unused;
    const struct vector middle = scale(0.5, add(sector->from, sector->to));
    return scale((sectors->layer ? 1 : 0.5) * radius_squared(sectors, sector),
                 direction(sector->centre, middle));
}

static struct vector in_plane(const struct sectors *sectors,
                              const struct sector *sector, const void *unused)
{
    (void)unused;
    return scale(radius_squared(sectors, sector), arc_in_plane(sector));
}

// A layer has the throat above it and below it; half of each circle faces the grain.
static struct vector contact_line(const struct sectors *sectors,
                                  const struct sector *sector, const void *unused)
{
    (void)unused;
    if (!sectors->layer) return direction(sector->centre, sector->across);
    const struct vector outwards = turned(subtract(sector->to, sector->from));
    return scale(2 / norm(outwards), outwards);
}

// --- lists -------------------------------------------------------------------------

void patches_add(struct patches *patches, int throat, int grain, struct vector pull)
{
    int p = patches->n;
    while (--p >= 0 && patches->patch[p].throat == throat)
        if (patches->patch[p].particle == grain) {
            patches->patch[p].pull = add(patches->patch[p].pull, pull);
            return;
        }
    GROW_ARRAY(patches->patch, patches->n, patches->capacity);
    patches->patch[patches->n++] = (struct patch){throat, grain, pull};
}

static void find_begins(struct patches *patches, int n_particle)
{
    free(patches->begin);
    patches->begin = NEW_ARRAY(int, n_particle + 1);
    for (int k = 0; k < patches->n; k++)
        patches->begin[patches->patch[k].particle + 1]++;
    for (int i = 0; i < n_particle; i++)
        patches->begin[i + 1] += patches->begin[i];
}

void patches_sort(struct patches *patches, int n_particle)
{
    find_begins(patches, n_particle);
    struct patch *sorted = NEW_ARRAY(struct patch, patches->n);
    int *next = duplicate(patches->begin, (size_t)n_particle + 1, sizeof *next);
    for (int k = 0; k < patches->n; k++)
        sorted[next[patches->patch[k].particle]++] = patches->patch[k];
    free(next);
    free(patches->patch);
    patches->patch = sorted;
}

struct patches collect_patches(struct sectors *sectors, pull_of_sector *make,
                               const void *context)
{
    struct patches patches = {0};
    for (int t = 0; t < sectors->network->n_throat; t++) {
        const int n = sectors_at(sectors, t);
        for (int k = 0; k < n; k++) {
            const struct sector *sector = &sectors->sector[k];
            if (is_auxiliary(&sectors->network->packing, sector->grain)) continue;
            patches_add(&patches, t, sector->grain, make(sectors, sector, context));
        }
    }
    patches_sort(&patches, sectors->network->packing.n_particle);
    return patches;
}

pull_of_sector *pull_of(enum form form)
{
    return form == FORM_SOLID_ANGLE ? solid_angle
           : form == FORM_FACES     ? face_area
           : form == FORM_CENTRES   ? to_centre
                                    : in_plane;
}

struct patches find_patches(struct sectors *sectors, enum form form)
{
    return collect_patches(sectors, pull_of(form), NULL);
}

struct patches find_contact_lines(struct sectors *sectors)
{
    return collect_patches(sectors, contact_line, NULL);
}

void patches_free(struct patches *patches)
{
    free(patches->patch);
    free(patches->begin);
    *patches = (struct patches){0};
}

enum status check_patches(const struct patches *patches, struct reason *reason)
{
    for (int k = 0; k < patches->n; k++)
        if (!isfinite(norm(patches->patch[k].pull)))
            return refuse(reason, STATUS_BAD_DATA,
                          "/throats/nodes: throat %d meets the centre of grain %d",
                          patches->patch[k].throat, patches->patch[k].particle);
    return STATUS_OK;
}

void drop_patches_in_walls(const struct sectors *sectors, unsigned walls,
                           struct patches *patches)
{
    int kept = 0;
    for (int k = 0; k < patches->n; k++)
        if (!(sectors->surface[patches->patch[k].throat] & walls))
            patches->patch[kept++] = patches->patch[k];
    patches->n = kept;
    find_begins(patches, sectors->network->packing.n_particle);
}
