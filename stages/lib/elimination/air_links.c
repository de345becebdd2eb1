// SPDX-License-Identifier: GPL-3.0-or-later
// A site keeps its place until it leaves. The sum of all is a compensated one; digits
// are lost only when a large sum becomes small: then it is added up again.
#include "air_links.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

struct air_links air_links_init(int n_site)
{
    struct air_links air = {.n_site = n_site,
                            .place = NEW_ARRAY(int, n_site),
                            .reached = NEW_ARRAY(int, n_site)};
    for (int i = 0; i < n_site; i++)
        air.place[i] = -1;
    return air;
}

void air_links_free(struct air_links *air)
{
    free(air->place);
    free(air->conductance);
    free(air->site);
    free(air->unused);
    free(air->reached);
    *air = (struct air_links){0};
}

// Of a site that has none. Every place may come to be unused.
static int new_place(struct air_links *air, int site)
{
    if (air->n_unused == 0) {
        const int before = air->capacity;
        GROW_ARRAY(air->conductance, air->n, air->capacity);
        if (air->capacity != before) {
            const size_t n = (size_t)air->capacity;
            air->site = reallocate(air->site, n, sizeof(int));
            air->unused = reallocate(air->unused, n, sizeof(int));
        }
        air->unused[air->n_unused++] = air->n++;
    }
    const int place = air->unused[--air->n_unused];
    air->conductance[place] = 0;
    air->site[place] = site;
    return air->place[site] = place;
}

void air_links_add(struct air_links *air, int site, double conductance)
{
    if (!(conductance > 0)) return;
    if (air->place[site] < 0) {
        air->reached[air->n_reached++] = site;
        new_place(air, site);
    }
    air->conductance[air->place[site]] += conductance;
}

void air_links_link(struct air_links *air, int site, double conductance)
{
    air_links_add(air, site, conductance);
    compensated_add(&air->all, conductance);
    air->summed = fmax(air->summed, compensated_value(air->all));
}

double air_links_take(struct air_links *air, int site)
{
    const int place = air->place[site];
    if (place < 0) return 0;
    const double conductance = air->conductance[place];
    air->conductance[place] = 0;
    air->place[site] = -1;
    air->unused[air->n_unused++] = place;
    return conductance;
}

static void add_up(struct air_links *air)
{
    air->all = (struct compensated){0};
    for (int i = 0; i < air->n_site; i++)
        compensated_add(&air->all, air_links_of(air, i));
    air->summed = compensated_value(air->all);
}

void air_links_lower(struct air_links *air, double drop)
{
    compensated_add(&air->all, -drop);
    if (compensated_value(air->all) < 0.5 * air->summed) add_up(air);
}

void air_links_clear(struct air_links *air)
{
    for (int place = 0; place < air->n; place++)
        air->conductance[place] = 0;
    air->all = (struct compensated){0};
    air->summed = 0;
}

// Numbers are written by site, so a checkpoint keeps no places. A site may have a place
// and evaporate nothing.
void air_links_state(struct air_links *air, struct checkpoint_stream *stream)
{
    const int n = air->n_site;
    double *conductance = NEW_ARRAY(double, n);
    bool *has_place = NEW_ARRAY(bool, n);
    for (int i = 0; i < n; i++) {
        conductance[i] = air_links_of(air, i);
        has_place[i] = air->place[i] >= 0;
    }
    stream_numbers(stream, conductance, n);
    stream_flags(stream, has_place, n);
    for (int i = 0; stream->restoring && i < n; i++) {
        air_links_take(air, i);
        if (!has_place[i]) continue;
        const int place = new_place(air, i); // may move air->conductance
        air->conductance[place] = conductance[i];
    }
    free(conductance);
    free(has_place);
    stream_sums(stream, &air->all, 1);
    stream_numbers(stream, &air->summed, 1);
}
