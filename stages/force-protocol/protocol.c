// SPDX-License-Identifier: GPL-3.0-or-later
// Forces on all grains at given times, and how well they represent the drying. The
// force on a grain is the sum over its patches of load times pull (throat_loads.h).
// Between steps of the drying loads are linear in time, so the largest error of
// interpolating between the protocol's times is found at steps: deviation = |force -
// interpolated force| there, on both sides of a step where forces jump.
#include "protocol.h"

#include "basics/memory.h"

#include <stdlib.h>

// Inlined; fmax with its rules for NaN is not, and took a third of the stage's time.
static inline double larger(double a, double b)
{
    return a > b ? a : b;
}

struct protocol protocol_init(const struct process *process, double *times, int n_time)
{
    const size_t n_particle = (size_t)process->network->packing.n_particle;
    struct protocol protocol = {
        .n_time = n_time,
        .time = times,
        .saturation = NEW_ARRAY(double, n_time),
        .force = NEW_ARRAY(struct vector, (size_t)n_time * n_particle)};
    struct liquid_loads liquid =
        liquid_loads_begin(process->network, process->record, process->law);
    for (int m = 0; m < n_time; m++) {
        liquid_loads_to(&liquid, times[m]);
        protocol.saturation[m] = liquid_loads_saturation(&liquid);
        forces_now(process->loads, &liquid, protocol.force + (size_t)m * n_particle);
    }
    liquid_loads_free(&liquid);
    return protocol;
}

void protocol_free(struct protocol *protocol)
{
    free(protocol->time);
    free(protocol->saturation);
    free(protocol->force);
    free(protocol->liquid);
    *protocol = (struct protocol){0};
}

// --- measures of a protocol --------------------------------------------------------

double largest_force(const struct protocol *protocol, int n_particle)
{
    double largest = 0;
    for (size_t k = 0; k < (size_t)protocol->n_time * (size_t)n_particle; k++)
        largest = larger(largest, norm(protocol->force[k]));
    return largest;
}

double largest_change(const struct protocol *protocol, int n_particle)
{
    const size_t n = (size_t)n_particle;
    double largest = 0;
    for (size_t k = n; k < (size_t)protocol->n_time * n; k++)
        largest = larger(largest, distance(protocol->force[k], protocol->force[k - n]));
    return largest;
}

// A moment, and where it lies in the protocol.
struct moment {
    double time;
    int after; // the first time of the protocol later than that, or the last
};

static struct moment moment_at(const struct protocol *protocol, struct moment earlier,
                               double time)
{
    struct moment moment = {time, earlier.after};
    while (moment.after + 1 < protocol->n_time && protocol->time[moment.after] <= time)
        moment.after++;
    return moment;
}

// Distance between FORCE on GRAIN and the force interpolated at that moment.
static double deviation(const struct protocol *protocol, int n_particle,
                        struct moment moment, int grain, struct vector force)
{
    const struct vector *to =
        protocol->force + (size_t)moment.after * (size_t)n_particle + grain;
    const struct vector *from = to - n_particle;
    const double begin = protocol->time[moment.after - 1];
    const double share = (moment.time - begin) / (protocol->time[moment.after] - begin);
    return distance(force, add(*from, scale(share, subtract(*to, *from))));
}

// Largest deviation among the grains that the last step changed: of their forces BEFORE
// it and NOW.
static double worst_deviation(const struct force_steps *steps,
                              const struct protocol *protocol, struct moment before,
                              struct moment now)
{
    const int n = steps->liquid.network->packing.n_particle;
    double worst = 0;
    for (int k = 0; k < steps->n_changed; k++) {
        const int i = steps->changed[k];
        const double then = deviation(protocol, n, before, i, steps->former[k]);
        worst = larger(worst,
                       larger(then, deviation(protocol, n, now, i, steps->force[i])));
    }
    return worst;
}

// A force is linear in time except where a step in which it changes begins or ends.
double interpolation_error(const struct process *process,
                           const struct protocol *protocol)
{
    const struct drying_record *record = &process->record->drying;
    struct force_steps steps = force_steps_begin(process->loads, process->network,
                                                 process->record, process->law);
    double worst = 0;
    struct moment now = moment_at(protocol, (struct moment){0, 1}, record->time[0]);
    for (int step = 0; step + 1 < record->n_step; step++) {
        const struct moment next = moment_at(protocol, now, record->time[step + 1]);
        if (steps.checks_all) {
            force_steps_to_end_of_step(&steps);
            worst = fmax(worst, worst_deviation(&steps, protocol, now, next));
            now = next; // the rest of the change is a jump at this moment
        }
        force_steps_advance(&steps);
        worst = fmax(worst, worst_deviation(&steps, protocol, now, next));
        now = next;
    }
    force_steps_free(&steps);
    return worst;
}

double process_field_error(const struct process *process)
{
    struct liquid_loads liquid =
        liquid_loads_begin(process->network, process->record, process->law);
    const double error = field_error(&liquid);
    liquid_loads_free(&liquid);
    return error;
}

// Sums of forces and moments at one time, and of their magnitudes.
struct sums {
    struct vector force, moment;
    double forces, moments;
};

static struct sums sum_up(const struct packing *packing, struct vector middle,
                          const struct vector *force)
{
    struct sums sums = {0};
    for (int i = 0; i < packing->n_particle; i++) {
        const struct vector arm = subtract(packing->position[i], middle);
        sums.force = add(sums.force, force[i]);
        sums.moment = add(sums.moment, cross(arm, force[i]));
        sums.forces += norm(force[i]);
        sums.moments += norm(arm) * norm(force[i]);
    }
    return sums;
}

void net_load(const struct protocol *protocol, const struct packing *packing,
              double *force, double *moment)
{
    const struct vector middle = scale(0.5, add(packing->lower, packing->upper));
    const size_t n = (size_t)packing->n_particle;
    double most_force = 0, most_moment = 0, forces = 0, moments = 0;
    for (size_t m = 0; m < (size_t)protocol->n_time; m++) {
        const struct sums sums = sum_up(packing, middle, protocol->force + m * n);
        most_force = fmax(most_force, norm(sums.force));
        most_moment = fmax(most_moment, norm(sums.moment));
        forces = fmax(forces, sums.forces);
        moments = fmax(moments, sums.moments);
    }
    *force = forces > 0 ? most_force / forces : 0;
    *moment = moments > 0 && !is_periodic(packing) ? most_moment / moments : 0;
}
