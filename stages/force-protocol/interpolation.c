// SPDX-License-Identifier: GPL-3.0-or-later
// Between steps of the drying loads are linear in time, so the largest error of
// interpolating between the protocol's times is found at steps:
//     deviation = |force - (from + share (to - from))|
// of the grains whose force a step changes, at both ends of it, with FROM and TO the
// forces at the times around. A force is linear in time except where a step in which it
// changes begins or ends. Where forces jump, the end of a step and the beginning of the
// next are told apart.
//
// Each move of the forces is looked at twice: where it begins, as soon as it is made,
// with the forces before it; where it ends, when the rows around that have come. So no
// more than two rows are needed at once, however long a step is.
#include "interpolation.h"

// Goes on to the moment TIME, which is not before the present one.
static void set_now(struct interpolation *of, double time)
{
    of->now = time;
    while (of->after + 1 < of->n_time && of->time[of->after] <= time)
        of->after++;
}

struct interpolation interpolation_begin(const struct process *process,
                                         const double *time, int n_time)
{
    struct interpolation interpolation = {
        .time = time,
        .n_time = n_time,
        .steps = force_steps_begin(process->loads, process->network, process->record,
                                   process->law),
        .after = 1};
    set_now(&interpolation, process->record->drying.time[0]);
    return interpolation;
}

void interpolation_free(struct interpolation *interpolation)
{
    force_steps_free(&interpolation->steps);
}

// The largest deviation now, of the forces that the last move changed: as they are, or
// as they were BEFORE it.
static void measure(struct interpolation *of, const struct vector *former,
                    const struct vector *force, bool before)
{
    const double begin = of->time[of->after - 1];
    const double share = (of->now - begin) / (of->time[of->after] - begin);
    for (int k = 0; k < of->steps.n_changed; k++) {
        const int i = of->steps.changed[k];
        const struct vector between =
            add(former[i], scale(share, subtract(force[i], former[i])));
        const double deviation =
            distance(before ? of->steps.former[k] : of->steps.force[i], between);
        if (deviation > of->worst) of->worst = deviation;
    }
}

// To the end of the step where forces jump, and from there, or at once where they do
// not, to the next step. False: there is none.
static bool move(struct interpolation *of)
{
    const int left = of->steps.liquid.record->drying.n_step - 1 - of->steps.liquid.step;
    if (left < 1) return false;
    of->is_at_end = of->steps.checks_all && !of->is_at_end;
    if (of->is_at_end)
        force_steps_to_end_of_step(&of->steps);
    else
        force_steps_advance(&of->steps);
    return true;
}

void interpolation_follow(struct interpolation *of, const struct vector *former,
                          const struct vector *force, int row)
{
    const double *step_time = of->steps.liquid.record->drying.time;
    while (of->after == row && !of->is_over) {
        measure(of, former, force, false);
        of->is_over = !move(of);
        if (of->is_over) return;
        measure(of, former, force, true);
        set_now(of, step_time[of->steps.liquid.step + of->is_at_end]);
    }
}
