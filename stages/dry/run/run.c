// SPDX-License-Identifier: GPL-3.0-or-later
// What all drying steps ask of a run and record of it. Between two recorded steps the
// rate is their mean, so that the recorded rates integrate to what has evaporated.
//
//     saturation = total_liquid / capacity, clipped to [0, 1],
//     rate_now   = into the drying air at this moment (0 when all is dry),
//     mean rate  = (evaporated - step_evaporated) / (time - step_time).
// A step is recorded with rate_now, which holds from it on. If events are then skipped,
// that number is overwritten by the mean when the next step is recorded. All is scaled
// (struct drying_scale) and becomes SI only where it goes into the history. `time` and
// `evaporated` are compensated sums, as a run adds very many short intervals.
#include "run.h"

#include "film_history.h"
#include "profiles.h"

#include "basics/sorted.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

// A run that comes so near to stop_saturation may end there.
static const double ROUNDING = 1e-12;

// total_liquid is a sum of many differences, so its rounding is kept out of [0,1].
double network_saturation(const struct run *run)
{
    if (run->occupancy.n_liquid == 0) return 0;
    const double liquid = compensated_value(run->occupancy.total_liquid);
    return fmin(1, fmax(0, liquid / run->occupancy.capacity));
}

double rate_now(const struct run *run)
{
    if (run->occupancy.n_liquid == 0) return 0;
    return run->conditions->kelvin ? run->kelvin.rate
                                   : vapour_rate(&run->occupancy.vapour) *
                                         vapour_pace(&run->occupancy.vapour);
}

// Both, because rounding may leave a saturation above 0 with no throat left.
bool goes_on(const struct run *run)
{
    return run->occupancy.n_liquid > 0 &&
           network_saturation(run) > run->conditions->stop_saturation;
}

bool snapshot_is_due(const struct run *run)
{
    const struct drying_conditions *conditions = run->conditions;
    const int next = run->recorder.history->n_pressure;
    return conditions->liquid == LIQUID_VISCOUS && next < conditions->n_snapshot &&
           is_down_to(network_saturation(run),
                      fmax(conditions->snapshot[next], conditions->stop_saturation));
}

// Where steps were skipped, the rate recorded before them is replaced by the mean over
// the interval.
static void end_interval(struct run *run)
{
    if (run->n_skipped == 0) return;
    const double evaporated =
        compensated_difference(run->evaporated, run->step_evaporated);
    const double time = compensated_difference(run->time, run->step_time);
    recorder_set_last_rate(&run->recorder, evaporated / time * run->scale.rate);
}

// The last step always is.
bool step_is_due(struct run *run)
{
    const double fallen = run->step_saturation - network_saturation(run);
    if (fallen < run->conditions->step_interval && goes_on(run) &&
        !snapshot_is_due(run)) {
        run->n_skipped++;
        return false;
    }
    end_interval(run);
    return true;
}

bool last_step_but_one_is_due(struct run *run, double loss)
{
    const double stop = run->conditions->stop_saturation;
    const double rest = compensated_value(run->occupancy.total_liquid) - loss;
    if (stop == 0 || run->n_skipped == 0 ||
        rest > (stop + ROUNDING) * run->occupancy.capacity)
        return false;
    end_interval(run);
    return true;
}

// So that truncate_history has next to nothing to cut, and what is found there is of
// the end.
double left_to_stop(const struct run *run)
{
    const double stop = run->conditions->stop_saturation;
    if (stop == 0) return INFINITY;
    return (network_saturation(run) - stop + 4 * DBL_EPSILON) * run->occupancy.capacity;
}

void sort_ended(struct run *run)
{
    qsort(run->ended, (size_t)run->n_ended, sizeof *run->ended, rising_ints);
}

// SI from here on: scaled time and rate times their units.
void record_state(struct run *run)
{
    recorder_add_step(&run->recorder, compensated_value(run->time) * run->scale.time,
                      network_saturation(run), rate_now(run) * run->scale.rate,
                      run->occupancy.clusters.count);
    if (run->recorder.history->films)
        film_history_add(run->recorder.history->films, &run->times,
                         run->conditions->open_walls, run->scale.rate);
    run->n_skipped = 0;
    run->step_saturation = network_saturation(run);
    run->step_time = run->time;
    run->step_evaporated = run->evaporated;
}

void note_breakthrough(struct run *run)
{
    struct drying_history *history = run->recorder.history;
    if (run->occupancy.breakthrough && history->breakthrough_saturation == 0)
        history->breakthrough_saturation = network_saturation(run);
}

// A rate of 0 with liquid left would give an infinite time to the next event.
enum status refuse_standstill(const struct run *run, struct reason *reason)
{
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "nothing evaporates any more with %d throats still wet (rates too "
                  "small for the arithmetic)",
                  run->occupancy.n_liquid);
}

enum status check_vapour(const struct run *run, struct reason *reason)
{
    const struct kept_vapour *kept = run->occupancy.vapour.kept;
    if (!kept || !kept->failed) return STATUS_OK;
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "the vapour was not found to vapour_step = %g of the drying rate at "
                  "saturation %g; vapour_step=0 finds it without iterations",
                  run->conditions->vapour_step, network_saturation(run));
}
