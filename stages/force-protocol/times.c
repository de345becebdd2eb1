// SPDX-License-Identifier: GPL-3.0-or-later
// Adaptive times of the protocol. Forces are followed from step to step; when the
// force on some grain has changed by more than the bound since the last chosen time,
// the step before becomes a time. A single step that changes a force by more is
// divided into equal parts, since forces are linear within it; a jump cannot be
// divided and counts as one change. The count goes on beyond the limit, so that the
// message can say what is needed.
#include "times.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

static double end_of(const struct drying_record *record)
{
    return record->time[record->n_step - 1];
}

double *uniform_times(const struct drying_record *record, int count)
{
    double *times = NEW_ARRAY(double, count);
    for (int m = 0; m < count; m++)
        times[m] = end_of(record) * m / (count - 1);
    times[count - 1] = end_of(record);
    return times;
}

// Times chosen so far.
struct choice {
    struct force_steps steps;
    double bound;        // N
    struct vector *last; // (n_particle) forces at the last time
    double *time;        // (n) but no more than MOST
    int n, capacity, most;
    double wanted; // how many it takes
    double latest; // of these
};

static void choose(struct choice *choice, double time)
{
    if (choice->wanted > 0 && !(time > choice->latest)) return;
    choice->wanted++;
    choice->latest = time;
    if (choice->n == choice->most) return;
    GROW_ARRAY(choice->time, choice->n, choice->capacity);
    choice->time[choice->n++] = time;
}

static void remember(struct choice *choice)
{
    const int n = choice->steps.liquid.network->packing.n_particle;
    memcpy(choice->last, choice->steps.force, (size_t)n * sizeof *choice->last);
}

// Largest change since the last chosen time, among the forces that the step changed.
static double largest_movement(const struct choice *choice)
{
    double most = 0;
    for (int k = 0; k < choice->steps.n_changed; k++) {
        const int i = choice->steps.changed[k];
        most = fmax(most, distance(choice->steps.force[i], choice->last[i]));
    }
    return most;
}

// The forces before the last step become those of the last chosen time.
static void remember_former(struct choice *choice)
{
    remember(choice);
    for (int k = 0; k < choice->steps.n_changed; k++)
        choice->last[choice->steps.changed[k]] = choice->steps.former[k];
}

// The forces have been advanced from time FROM to TO. If they moved too far, FROM
// becomes a time; if this step alone is too much, it is divided evenly.
static void add_step(struct choice *choice, double from, double to)
{
    if (largest_movement(choice) <= choice->bound) return;
    choose(choice, from);
    remember_former(choice);
    const double moved = largest_movement(choice);
    if (moved <= choice->bound) return;
    const double parts = to > from ? ceil(moved / choice->bound) : 1;
    const double too_many = choice->wanted + parts > choice->most ? parts : 0;
    for (int p = 1; p < parts && !too_many; p++)
        choose(choice, from + (to - from) * (p / parts));
    choice->wanted += fmax(0, too_many - 1);
    choose(choice, to);
    remember(choice);
}

static double largest_at_steps(const struct process *process)
{
    struct force_steps steps = force_steps_begin(process->loads, process->network,
                                                 process->record, process->law);
    double largest = 0;
    for (int i = 0; i < process->network->packing.n_particle; i++)
        largest = fmax(largest, norm(steps.force[i]));
    while (force_steps_advance(&steps))
        for (int k = 0; k < steps.n_changed; k++)
            largest = fmax(largest, norm(steps.force[steps.changed[k]]));
    force_steps_free(&steps);
    return largest;
}

double *adaptive_times(const struct process *process, double bound, int most,
                       double *count)
{
    const struct drying_record *record = &process->record->drying;
    struct choice choice = {
        .steps = force_steps_begin(process->loads, process->network, process->record,
                                   process->law),
        .bound = bound * largest_at_steps(process),
        .last = NEW_ARRAY(struct vector, process->network->packing.n_particle),
        .most = most};
    choose(&choice, 0);
    remember(&choice);
    for (int step = 0; force_steps_advance(&choice.steps); step++)
        add_step(&choice, record->time[step], record->time[step + 1]);
    choose(&choice, end_of(record));
    force_steps_free(&choice.steps);
    free(choice.last);
    *count = choice.wanted;
    if (choice.wanted <= most) return choice.time;
    free(choice.time);
    return NULL;
}
