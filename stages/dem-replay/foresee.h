// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibria that lie ahead, LANES loads at a time. Without friction contacts have no
// history, and until a bond breaks each load has its equilibrium whatever comes
// between: one way through the factor serves them all. What is foreseen is where
// balance.c begins; whether it is an equilibrium is seen there.
#ifndef CRAQUELURE_FORESEE_H
#define CRAQUELURE_FORESEE_H

#include "joint.h"

struct equilibrium;
struct foresight;

// NULL, which the others take: there is friction, or glue at points, or displacements
// may be large. The caller frees it.
struct foresight *foresight_new(struct equilibrium *equilibrium);
void foresight_free(struct foresight *foresight);

// FORCE (count * n) of the next COUNT loads, kept, not copied. Nothing is expected any
// longer where the next one has other forces than FORCE. On to the next.
void foresight_expect(struct foresight *foresight, int count,
                      const struct vector *force);
void foresight_check(struct foresight *foresight, const struct vector *force);
void foresight_go_on(struct foresight *foresight);

// The trial goes to where equilibrium under the load is, if that can be foreseen.
void foresee(struct equilibrium *equilibrium);

// Whether the next equilibrium was foreseen and no bond breaks under it: it then is the
// present one, but the trial and the joints come to it only when they are made to.
bool foreseen(struct equilibrium *equilibrium);
void realise(struct foresight *foresight);

// Of the present one, if it IS FORESEEN and not real yet: as equilibrium.h says, and
// what joints do to a held grain, negative.
bool is_foreseen(const struct equilibrium *equilibrium);
double foreseen_unbalanced_ratio(const struct equilibrium *equilibrium);
struct displacement foreseen_pull(const struct equilibrium *equilibrium, int grain);

#endif
