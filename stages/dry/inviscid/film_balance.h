// SPDX-License-Identifier: GPL-3.0-or-later
// The levels of the sites of a film_flow that are not held, by their balances: one
// linear system, for one set of held sites.
#pragma once

#include "film_flow.h"

struct film_factor;

// Nothing is known yet. It may serve one film_flow after another. The caller frees it
// with film_factor_free; NULL is allowed.
struct film_factor *film_factor_create(void);
void film_factor_free(struct film_factor *factor);

// As if just created: what is found next does not depend on what was found before.
void film_factor_forget(struct film_factor *factor);

// Corrects FLOW->level where no site is held. RESIDUAL (n) becomes the balances of all
// sites, less what is TAKEN: the surplus with its sign turned where a site is held. The
// others add up to TOLERANCE at most, or to what rounding of levels makes; false if
// that is not reached.
bool film_balance(struct film_flow *flow, double tolerance, double *residual);
