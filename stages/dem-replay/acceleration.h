// SPDX-License-Identifier: GPL-3.0-or-later
// Anderson's acceleration of an iteration x + step(x): of the steps so far the
// combination that would have left the least, which for a linear one is what GMRES
// finds. For the part of a stiffness that its factor does not have.
#ifndef CRAQUELURE_ACCELERATION_H
#define CRAQUELURE_ACCELERATION_H

struct acceleration;

// For vectors of N numbers. The caller frees it with acceleration_free.
struct acceleration *acceleration_new(int n);
void acceleration_free(struct acceleration *acceleration);

// Forgets the steps so far: another iteration begins, or another factor makes its
// steps.
void acceleration_clear(struct acceleration *acceleration);

// STEP (n), of where the last one led, becomes the one to take.
void accelerate(struct acceleration *acceleration, double *step);

#endif
