// SPDX-License-Identifier: GPL-3.0-or-later
// What becomes history: the iterate u as `previous`, deformations, and the contacts as
// they respond, whose anchors have followed slip. Whatever is not committed is rolled
// back to u = previous.
#include "quasi_static_internal.h"

#include <string.h>

void commit_state(struct quasi_static *qs)
{
    memcpy(qs->previous, qs->displacement, (size_t)qs->n * sizeof *qs->previous);
    for (int j = 0; j < qs->n_pair; j++) {
        for (int k = 0; k < COMPONENTS; k++)
            qs->last_increment[j][k] =
                qs->deformation[j][k] - qs->pair[j].deformation[k];
        memcpy(qs->pair[j].deformation, qs->deformation[j],
               sizeof qs->pair[j].deformation);
        qs->pair[j].contact = qs->response[j].contact;
        if (qs->pair[j].contact.state == CONTACT_NEW)
            qs->pair[j].contact.state = CONTACT_STICKING;
    }
    if (qs->kinematics->commit) qs->kinematics->commit(qs);
}

void roll_back_state(struct quasi_static *qs)
{
    memcpy(qs->displacement, qs->previous, (size_t)qs->n * sizeof *qs->displacement);
    memset(qs->dashpot_force, 0, (size_t)qs->n * sizeof *qs->dashpot_force);
}
