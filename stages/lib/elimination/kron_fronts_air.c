// SPDX-License-Identifier: GPL-3.0-or-later
// The conductance of each site to the air. Those above 0 lie side by side, few enough
// for the cache: an elimination changes all of a front. A site keeps its place until it
// is eliminated. The sum of all is a compensated one; digits are lost only when a large
// sum becomes small: then it is added up again.
#include "basics/memory.h"
#include "kron_fronts.h"
#include "kron_fronts_internal.h"

#include <math.h>
#include <stdlib.h>

void air_init(struct kron_fronts *fronts)
{
    fronts->air_place = NEW_ARRAY(int, fronts->n_site);
    fronts->reached_air = NEW_ARRAY(int, fronts->n_site);
    for (int i = 0; i < fronts->n_site; i++)
        fronts->air_place[i] = -1;
}

void air_free(struct kron_fronts *fronts)
{
    free(fronts->air_place);
    free(fronts->air);
    free(fronts->air_site);
    free(fronts->unused_air);
    free(fronts->reached_air);
}

// Of a site that has none. Every place may come to be unused.
static int new_place(struct kron_fronts *fronts, int site)
{
    if (fronts->n_unused_air == 0) {
        const int before = fronts->air_capacity;
        GROW_ARRAY(fronts->air, fronts->n_air, fronts->air_capacity);
        if (fronts->air_capacity != before) {
            const size_t n = (size_t)fronts->air_capacity;
            fronts->air_site = reallocate(fronts->air_site, n, sizeof(int));
            fronts->unused_air = reallocate(fronts->unused_air, n, sizeof(int));
        }
        fronts->unused_air[fronts->n_unused_air++] = fronts->n_air++;
    }
    const int place = fronts->unused_air[--fronts->n_unused_air];
    fronts->air[place] = 0;
    fronts->air_site[place] = site;
    return fronts->air_place[site] = place;
}

static void add_air(struct kron_fronts *fronts, int site, double conductance)
{
    if (!(conductance > 0)) return;
    if (fronts->air_place[site] < 0) {
        fronts->reached_air[fronts->n_reached_air++] = site;
        new_place(fronts, site);
    }
    fronts->air[fronts->air_place[site]] += conductance;
}

void kron_fronts_link_air(struct kron_fronts *fronts, int site, double conductance)
{
    add_air(fronts, site, conductance);
    compensated_add(&fronts->all_air, conductance);
    fronts->summed_air = fmax(fronts->summed_air, compensated_value(fronts->all_air));
}

double air_take(struct kron_fronts *fronts, int site)
{
    const int place = fronts->air_place[site];
    if (place < 0) return 0;
    const double air = fronts->air[place];
    fronts->air[place] = 0;
    fronts->air_place[site] = -1;
    fronts->unused_air[fronts->n_unused_air++] = place;
    return air;
}

void air_find_places(struct front *front)
{
    front->air_place = NEW_ARRAY(int, front->capacity);
    for (int i = 0; i < front->n; i++)
        front->air_place[i] = -1;
}

void air_raise(struct kron_fronts *fronts, struct front *front, double share)
{
    for (int i = 0; i < front->n && !front->air_place; i++)
        add_air(fronts, front->site[i], fronts->row[i] * share);
    for (int i = 0; i < front->n && front->air_place; i++) {
        const int place = front->air_place[i];
        if (place >= 0) {
            fronts->air[place] += fronts->row[i] * share;
            continue;
        }
        add_air(fronts, front->site[i], fronts->row[i] * share);
        front->air_place[i] = fronts->air_place[front->site[i]];
    }
}

static void sum_air(struct kron_fronts *fronts)
{
    fronts->all_air = (struct compensated){0};
    for (int i = 0; i < fronts->n_site; i++)
        compensated_add(&fronts->all_air, kron_fronts_air(fronts, i));
    fronts->summed_air = compensated_value(fronts->all_air);
}

void air_lower(struct kron_fronts *fronts, double drop)
{
    compensated_add(&fronts->all_air, -drop);
    if (compensated_value(fronts->all_air) < 0.5 * fronts->summed_air) sum_air(fronts);
}

// Numbers are written by site, so a checkpoint keeps no places. A negative number or
// NaN gets a place too: kron_fronts_fit then refuses it.
void air_state(struct kron_fronts *fronts, struct checkpoint_stream *stream)
{
    double *air = NEW_ARRAY(double, fronts->n_site);
    for (int i = 0; i < fronts->n_site; i++)
        air[i] = kron_fronts_air(fronts, i);
    stream_numbers(stream, air, fronts->n_site);
    for (int i = 0; stream->restoring && i < fronts->n_site; i++) {
        air_take(fronts, i);
        if (air[i] == 0) continue;
        const int place = new_place(fronts, i); // may move fronts->air
        fronts->air[place] = air[i];
    }
    free(air);
    stream_sums(stream, &fronts->all_air, 1);
    stream_numbers(stream, &fronts->summed_air, 1);
}
