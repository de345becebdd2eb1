// SPDX-License-Identifier: GPL-3.0-or-later
#include "throat_loads.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

void action_free(struct action *action)
{
    for (int l = 0; l < LOADS; l++)
        patches_free(&action->patches[l]);
}

// Added to FORCE.
static struct vector pulled(const struct action *action, enum load l,
                            double (*load)[LOADS], int grain, struct vector force)
{
    const struct patches *patches = &action->patches[l];
    if (patches->n == 0) return force;
    for (int k = patches->begin[grain]; k < patches->begin[grain + 1]; k++)
        force = add(force,
                    scale(load[patches->patch[k].throat][l], patches->patch[k].pull));
    return force;
}

static struct vector force_on(const struct action *action, double (*load)[LOADS],
                              int grain)
{
    struct vector force = {0};
    for (int l = 0; l < LOAD_WEIGHT; l++)
        force = pulled(action, (enum load)l, load, grain, force);
    return pulled(action, LOAD_WEIGHT, load, grain, scale(action->scale, force));
}

void forces_now(const struct action *action, const struct filling *filling,
                struct vector *force)
{
    const struct network *network = filling->network;
    double(*load)[LOADS] = allocate((size_t)network->n_throat, sizeof *load);
#pragma omp parallel
    {
#pragma omp for
        for (int t = 0; t < network->n_throat; t++)
            filling_loads(filling, t, load[t]);
#pragma omp for
        for (int i = 0; i < network->packing.n_particle; i++)
            force[i] = force_on(action, load, i);
    }
    free(load);
}

// --- step by step ------------------------------------------------------------------

// Grains of each throat; those that it acts on in several ways several times.
static void list_grains(struct walk *walk, int n_throat)
{
    const struct patches *patches = walk->action->patches;
    walk->offset = NEW_ARRAY(int, n_throat + 1);
    for (int l = 0; l < LOADS; l++)
        for (int k = 0; k < patches[l].n; k++)
            walk->offset[patches[l].patch[k].throat + 1]++;
    for (int t = 0; t < n_throat; t++)
        walk->offset[t + 1] += walk->offset[t];
    walk->grain = NEW_ARRAY(int, walk->offset[n_throat]);
    int *next = duplicate(walk->offset, (size_t)n_throat + 1, sizeof *next);
    for (int l = 0; l < LOADS; l++)
        for (int k = 0; k < patches[l].n; k++) {
            const struct patch *patch = &patches[l].patch[k];
            walk->grain[next[patch->throat]++] = patch->particle;
        }
    free(next);
}

static void look_at(struct walk *walk, int throat)
{
    double load[LOADS];
    filling_loads(&walk->filling, throat, load);
    bool same = true;
    for (int l = 0; l < LOADS; l++)
        same &= load[l] == walk->load[throat][l];
    if (same) return;
    memcpy(walk->load[throat], load, sizeof load);
    for (int k = walk->offset[throat]; k < walk->offset[throat + 1]; k++) {
        const int grain = walk->grain[k];
        if (walk->listed[grain]) continue;
        walk->listed[grain] = true;
        walk->changed[walk->n_changed++] = grain;
    }
}

static void update(struct walk *walk)
{
    const struct drying_record *record = &walk->filling.record->drying;
    const int step = walk->filling.step;
    walk->n_changed = 0;
    if (walk->far_reaching)
        for (int t = 0; t < walk->filling.network->n_throat; t++)
            look_at(walk, t);
    else
        for (int64_t k = record->offset[step]; k < record->offset[step + 1]; k++)
            look_at(walk, record->throat[k]);
    for (int k = 0; k < walk->n_changed; k++) {
        const int grain = walk->changed[k];
        walk->former[k] = walk->force[grain];
        walk->force[grain] = force_on(walk->action, walk->load, grain);
        walk->listed[grain] = false;
    }
}

struct walk walk_begin(const struct action *action, const struct network *network,
                       const struct filling_record *record,
                       const struct suction_law *law)
{
    const int n = network->packing.n_particle;
    struct walk walk = {.action = action,
                        .filling = filling_begin(network, record, law),
                        .far_reaching = law->rule != SUCTION_UNIFORM ||
                                        action->patches[LOAD_CONTACT_LINE].n > 0,
                        .load = allocate((size_t)network->n_throat, sizeof *walk.load),
                        .force = NEW_ARRAY(struct vector, n),
                        .changed = NEW_ARRAY(int, n),
                        .former = NEW_ARRAY(struct vector, n),
                        .listed = NEW_ARRAY(bool, n)};
    list_grains(&walk, network->n_throat);
    for (int t = 0; t < network->n_throat; t++)
        filling_loads(&walk.filling, t, walk.load[t]);
    for (int i = 0; i < n; i++)
        walk.force[i] = force_on(action, walk.load, i);
    return walk;
}

void walk_to_end_of_step(struct walk *walk)
{
    filling_to_end_of_step(&walk->filling);
    update(walk);
}

bool walk_advance(struct walk *walk)
{
    if (walk->filling.step + 1 >= walk->filling.record->drying.n_step) return false;
    filling_advance(&walk->filling);
    update(walk);
    return true;
}

void walk_free(struct walk *walk)
{
    filling_free(&walk->filling);
    free(walk->load);
    free(walk->force);
    free(walk->offset);
    free(walk->grain);
    free(walk->changed);
    free(walk->former);
    free(walk->listed);
    *walk = (struct walk){0};
}
