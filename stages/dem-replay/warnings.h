// SPDX-License-Identifier: GPL-3.0-or-later
// What the user should know of a replay that has ended, a line each on standard error:
// loads that did not come to rest or were sudden, grains that came loose or moved far,
// pores that gas did not enter.
#pragma once

#include "replay.h"

void warn_of_replay(const struct packing *packing, const struct load *load,
                    const struct replay_settings *settings,
                    const struct response *response);
