// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts the last step at the share of it at which the saturation was reached: time,
// changes and what has evaporated are linear within a step.
//     share = (S_before - S) / (S_before - S_last),   time = t_before + share dt,
//     evaporated -= rate (t_last - time),             s = s_before + share ds per
//     throat.
// `now` replays the changes of all steps before, as the history holds only what
// differs. Events after the new end go, and so do the breakthrough and the end of the
// first period if they came later: 0, as for those that never came.
#include "truncate_history.h"

#include "basics/memory.h"

#include <stdlib.h>

// Scales the changes of the last step by SHARE.
static void cut_changes(struct drying_history *history, const struct network *network,
                        double share)
{
    const int last = history->n_step - 1;
    const int n = network->n_throat + network->n_node; // rings, behind the throats
    double *now = NEW_ARRAY(double, n);
    for (int t = 0; t < n; t++)
        now[t] = t >= network->n_throat || network->throat_kind[t] == THROAT_NETWORK;
    for (int64_t k = 0; k < history->change_offset[last]; k++)
        now[history->change_throat[k]] = history->change_saturation[k];
    for (int64_t k = history->change_offset[last]; k < history->change_offset[last + 1];
         k++) {
        const double before = now[history->change_throat[k]];
        history->change_saturation[k] =
            before + share * (history->change_saturation[k] - before);
    }
    free(now);
}

void truncate_history(struct drying_history *history, const struct network *network,
                      double saturation)
{
    const int last = history->n_step - 1;
    const double before = history->saturation[last - 1];
    const double share = (before - saturation) / (before - history->saturation[last]);
    const double began = history->time[last - 1];
    const double time = began + share * (history->time[last] - began);
    const double rate = history->rate[last - 1];
    history->evaporated -= rate * (history->time[last] - time);
    cut_changes(history, network, share);
    while (share < 1 && history->n_event > 0 &&
           history->event_time[history->n_event - 1] > time)
        history->n_event--;
    history->time[last] = time;
    history->saturation[last] = saturation;
    history->rate[last] = rate;
    if (share < 1) history->clusters[last] = history->clusters[last - 1];
    if (history->breakthrough_saturation < saturation)
        history->breakthrough_saturation = 0;
    if (history->first_period_end_saturation < saturation)
        history->first_period_end_saturation = history->first_period_end_time = 0;
}
