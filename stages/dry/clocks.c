// SPDX-License-Identifier: GPL-3.0-or-later
#include "clocks.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

// Throats that have this part of their volume left, or less, when another empties would
// have emptied with it but for rounding.
static const double TIE = 1e-12;

struct clock {
    int throat;              // -1: none
    int n_charge;            // that are above 0
    struct compensated rate; // their sum: cancels exactly, or nearly, when they go
    struct compensated since, end;
    int place; // in the heap, -1: it does not run
    bool touched;
};

// --- the heap ----------------------------------------------------------------------

static bool earlier(const struct clocks *clocks, int a, int b)
{
    const struct clock *c = &clocks->clock[a], *d = &clocks->clock[b];
    const double later = compensated_difference(d->end, c->end);
    return later > 0 || (later == 0 && c->throat < d->throat);
}

static void put(struct clocks *clocks, int place, int owner)
{
    clocks->heap[place] = owner;
    clocks->clock[owner].place = place;
}

static void rise(struct clocks *clocks, int place, int owner)
{
    while (place > 0 && earlier(clocks, owner, clocks->heap[(place - 1) / 2])) {
        put(clocks, place, clocks->heap[(place - 1) / 2]);
        place = (place - 1) / 2;
    }
    put(clocks, place, owner);
}

static void sink(struct clocks *clocks, int place, int owner)
{
    for (int child = 2 * place + 1; child < clocks->n_heap; child = 2 * place + 1) {
        if (child + 1 < clocks->n_heap &&
            earlier(clocks, clocks->heap[child + 1], clocks->heap[child]))
            child++;
        if (!earlier(clocks, clocks->heap[child], owner)) break;
        put(clocks, place, clocks->heap[child]);
        place = child;
    }
    rise(clocks, place, owner);
}

static void stop(struct clocks *clocks, int owner)
{
    const int place = clocks->clock[owner].place;
    if (place < 0) return;
    clocks->clock[owner].place = -1;
    const int last = clocks->heap[--clocks->n_heap];
    if (last != owner) sink(clocks, place, last);
}

// --- who loses ---------------------------------------------------------------------

// Where THROAT is or belongs among those that lose.
static int losing_place(const struct clocks *clocks, int throat)
{
    int low = 0, high = clocks->n_losing;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (clocks->losing[middle] < throat)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static void add_losing(struct clocks *clocks, int throat)
{
    const int place = losing_place(clocks, throat);
    if (place < clocks->n_losing && clocks->losing[place] == throat) return;
    GROW_ARRAY(clocks->losing, clocks->n_losing, clocks->losing_capacity);
    memmove(clocks->losing + place + 1, clocks->losing + place,
            (size_t)(clocks->n_losing++ - place) * sizeof *clocks->losing);
    clocks->losing[place] = throat;
}

static void remove_losing(struct clocks *clocks, int throat)
{
    const int place = losing_place(clocks, throat);
    if (place == clocks->n_losing || clocks->losing[place] != throat) return;
    memmove(clocks->losing + place, clocks->losing + place + 1,
            (size_t)(--clocks->n_losing - place) * sizeof *clocks->losing);
}

// --- the clocks --------------------------------------------------------------------

static int owner_of(const struct clocks *clocks, int throat)
{
    return clocks->by_throat ? throat : clocks->phases->clusters.of_throat[throat];
}

static double liquid_now(const struct clocks *clocks, const struct clock *clock)
{
    const double left = compensated_value(clocks->phases->liquid[clock->throat]);
    if (clock->place < 0) return left;
    const double lost = compensated_value(clock->rate) *
                        compensated_difference(clocks->now, clock->since);
    return left > lost ? left - lost : 0;
}

// Before anything of it changes: its throat has lost at the old rate until now.
static struct clock *touch(struct clocks *clocks, int owner)
{
    while (owner >= clocks->n_clock) {
        GROW_ARRAY(clocks->clock, clocks->n_clock, clocks->clock_capacity);
        clocks->clock[clocks->n_clock++] = (struct clock){.throat = -1, .place = -1};
    }
    struct clock *clock = &clocks->clock[owner];
    if (clock->touched) return clock;
    clock->touched = true;
    clocks->touched[clocks->n_touched++] = owner;
    if (clock->place >= 0)
        clocks->phases->liquid[clock->throat] =
            (struct compensated){.value = liquid_now(clocks, clock)};
    clock->since = clocks->now;
    return clock;
}

static void add_charge(struct clock *clock, double charge, int sign)
{
    if (!(charge > 0)) return;
    compensated_add(&clock->rate, sign * charge);
    clock->n_charge += sign;
    if (clock->n_charge == 0) clock->rate = (struct compensated){0};
}

static void set_charge(struct clocks *clocks, int throat, int end, double charge)
{
    double *old = &clocks->charge[throat][end];
    if (charge == *old) return;
    struct clock *clock = touch(clocks, owner_of(clocks, throat));
    add_charge(clock, charge, 1);
    add_charge(clock, *old, -1);
    *old = charge;
}

static void charge_throats(struct clocks *clocks, int node)
{
    const struct phases *phases = clocks->phases;
    const double evaporation = vapour_evaporation(&phases->vapour, node);
    const int begin = phases->incidence.offset[node];
    const int end = phases->incidence.offset[node + 1];
    double section = 0;
    for (int k = begin; k < end; k++)
        section += clocks->section[phases->incidence.throat[k]];
    for (int k = begin; k < end; k++) {
        const int throat = phases->incidence.throat[k];
        const double share = clocks->section[throat];
        if (share == 0) continue;
        const int side = phases->network->throat_nodes[throat][1] == node;
        set_charge(clocks, throat, side, evaporation * (share / section));
    }
}

static int throat_of(const struct clocks *clocks, int owner)
{
    struct clusters *clusters = &clocks->phases->clusters;
    if (clocks->by_throat) return clusters->of_throat[owner] < 0 ? -1 : owner;
    return clusters->size[owner] > 0 ? clusters_invasion_throat(clusters, owner) : -1;
}

// Sets the clock of OWNER for the throat it empties now and the rate it has now.
static void set_clock(struct clocks *clocks, int owner)
{
    struct clock *clock = &clocks->clock[owner];
    const int old = clock->throat;
    clock->touched = false;
    if (old < 0 || owner_of(clocks, old) != owner)
        clock->throat = throat_of(clocks, owner);
    const double rate = compensated_value(clock->rate);
    if (clock->place >= 0 && (clock->throat != old || !(rate > 0)))
        remove_losing(clocks, old);
    if (clock->throat < 0 || !(rate > 0)) {
        stop(clocks, owner);
        return;
    }
    if (clock->place < 0 || clock->throat != old) add_losing(clocks, clock->throat);
    clock->end = clocks->now;
    compensated_add(&clock->end,
                    compensated_value(clocks->phases->liquid[clock->throat]) / rate);
    if (clock->place < 0) clock->place = clocks->n_heap++;
    sink(clocks, clock->place, owner);
}

static void set_touched(struct clocks *clocks)
{
    for (int k = 0; k < clocks->n_touched; k++)
        set_clock(clocks, clocks->touched[k]);
    clocks->n_touched = 0;
}

struct clocks clocks_make(struct phases *phases, bool by_throat)
{
    const int n = phases->network->n_throat;
    struct clocks clocks = {.phases = phases,
                            .by_throat = by_throat,
                            .charge = allocate((size_t)n, sizeof *clocks.charge),
                            .section = NEW_ARRAY(double, n),
                            .heap = NEW_ARRAY(int, n),
                            .touched = NEW_ARRAY(int, n)};
    for (int t = 0; t < n; t++)
        if (phases->clusters.of_throat[t] >= 0)
            clocks.section[t] = phases->volume[t] / phases->network->throat_length[t];
    for (int k = 0; k < phases->n_wet; k++)
        charge_throats(&clocks, phases->wet[k]);
    set_touched(&clocks);
    return clocks;
}

void clocks_free(struct clocks *clocks)
{
    free(clocks->charge);
    free(clocks->section);
    free(clocks->clock);
    free(clocks->heap);
    free(clocks->touched);
    free(clocks->losing);
    free(clocks->ended);
    *clocks = (struct clocks){0};
}

double clocks_saturation(const struct clocks *clocks, int throat)
{
    const struct phases *phases = clocks->phases;
    if (phases->clusters.of_throat[throat] < 0) return 0;
    const int owner = owner_of(clocks, throat);
    const bool runs = owner < clocks->n_clock && clocks->clock[owner].throat == throat;
    const double liquid = runs ? liquid_now(clocks, &clocks->clock[owner])
                               : compensated_value(phases->liquid[throat]);
    return liquid / phases->volume[throat];
}

double clocks_imbalance(const struct clocks *clocks)
{
    const double rate = vapour_rate(&clocks->phases->vapour);
    struct compensated sum = {.value = -rate};
    for (int k = 0; k < clocks->n_heap; k++)
        compensated_add(&sum, compensated_value(clocks->clock[clocks->heap[k]].rate));
    return clocks->n_heap > 0 ? compensated_value(sum) / rate : 0;
}

// --- events ------------------------------------------------------------------------

static int compare_numbers(const void *a, const void *b)
{
    const int *m = a, *n = b;
    return (*m > *n) - (*m < *n);
}

static void end_first(struct clocks *clocks)
{
    const int owner = clocks->heap[0], throat = clocks->clock[owner].throat;
    struct phases *phases = clocks->phases;
    GROW_ARRAY(clocks->ended, clocks->n_ended, clocks->ended_capacity);
    clocks->ended[clocks->n_ended++] = throat;
    touch(clocks, owner);
    compensated_add(&phases->total_liquid, -compensated_value(phases->liquid[throat]));
    phases->liquid[throat] = (struct compensated){0};
    remove_losing(clocks, throat);
    stop(clocks, owner);
}

static bool first_ties(const struct clocks *clocks)
{
    if (clocks->n_heap == 0) return false;
    const struct clock *first = &clocks->clock[clocks->heap[0]];
    const double left = compensated_difference(first->end, clocks->now) *
                        compensated_value(first->rate);
    return left <= TIE * clocks->phases->volume[first->throat];
}

double clocks_advance(struct clocks *clocks)
{
    clocks->n_ended = 0;
    if (clocks->n_heap == 0) return -1;
    const struct compensated before = clocks->now;
    clocks->now = clocks->clock[clocks->heap[0]].end;
    const double duration = compensated_difference(clocks->now, before);
    struct phases *phases = clocks->phases;
    compensated_add(&phases->total_liquid, -vapour_rate(&phases->vapour) * duration);
    do
        end_first(clocks);
    while (first_ties(clocks));
    qsort(clocks->ended, (size_t)clocks->n_ended, sizeof *clocks->ended,
          compare_numbers);
    return duration;
}

// The charges of throats that have left their cluster go with them.
static void move_charges(struct clocks *clocks, int from)
{
    const struct clusters *clusters = &clocks->phases->clusters;
    for (int k = 0; k < clusters->n_moved; k++) {
        const int throat = clusters->moved[k];
        const double *charge = clocks->charge[throat];
        if (!(charge[0] > 0 || charge[1] > 0)) continue;
        touch(clocks, clusters->of_throat[throat]);
        for (int end = 0; end < 2; end++) {
            add_charge(&clocks->clock[clusters->of_throat[throat]], charge[end], 1);
            add_charge(&clocks->clock[from], charge[end], -1);
        }
    }
}

void clocks_empty_ended(struct clocks *clocks)
{
    struct phases *phases = clocks->phases;
    struct star_mesh *mesh = &phases->vapour.mesh;
    for (int k = 0; k < clocks->n_ended; k++) {
        const int throat = clocks->ended[k], owner = owner_of(clocks, throat);
        for (int end = 0; end < 2; end++)
            set_charge(clocks, throat, end, 0);
        clocks->section[throat] = 0;
        phases_empty_throat(phases, throat);
        if (!clocks->by_throat) move_charges(clocks, owner);
        for (int end = 0; end < 2; end++)
            charge_throats(clocks, phases->network->throat_nodes[throat][end]);
    }
    for (int k = 0; k < mesh->n_changed; k++)
        charge_throats(clocks, mesh->changed[k]);
    star_mesh_forget_changes(mesh);
    set_touched(clocks);
}
