// SPDX-License-Identifier: GPL-3.0-or-later
// The force on grain i is the sum over loads l and its patches k,
//     force_i = scale * (sum_(l, k) load_l(throat_k) pull_lk + sum of rings),
// the weight without scale, rings as the drying left them (drying_rings.h),
// always added in the same order, so that stepping gives the same bits as a sum from
// scratch: a grain whose throats change is summed again as a whole, never corrected.
//
// A step of the drying changes few throats, so forces are followed from step to step:
// throats with another load, then the grains that these act on, each once. Where loads
// change of throats that the drying does not list (checks_all) all are looked at.
#include "throat_loads.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

void throat_loads_free(struct throat_loads *loads)
{
    for (int l = 0; l < LOADS; l++)
        patches_free(&loads->patches[l]);
    drying_rings_free(&loads->rings);
}

// Room for the loads that act on grains.
static struct load_values load_values_init(const struct throat_loads *loads,
                                           int n_throat)
{
    struct load_values load = {0};
    for (int l = 0; l < LOADS; l++)
        if (loads->patches[l].n > 0) load.of[l] = NEW_ARRAY(double, n_throat);
    return load;
}

static void load_values_free(struct load_values *load)
{
    for (int l = 0; l < LOADS; l++)
        free(load->of[l]);
}

// Sets the loads of THROAT to those of the liquid. Returns whether one is another than
// before. Exact comparison: equal loads give equal sums.
static bool set_loads(const struct liquid_loads *liquid, int throat,
                      struct load_values *load)
{
    double now[LOADS];
    liquid_loads_at(liquid, throat, now);
    bool differs = false;
    for (int l = 0; l < LOADS; l++) {
        if (!load->of[l]) continue;
        differs |= load->of[l][throat] != now[l];
        load->of[l][throat] = now[l];
    }
    return differs;
}

// FORCE plus the pulls of load L.
static struct vector pulled(const struct throat_loads *loads, enum load l,
                            const struct load_values *load, int grain,
                            struct vector force)
{
    const struct patches *patches = &loads->patches[l];
    if (patches->n == 0) return force;
    for (int k = patches->begin[grain]; k < patches->begin[grain + 1]; k++)
        force = add(force, scale(load->of[l][patches->patch[k].throat],
                                 patches->patch[k].pull));
    return force;
}

static struct vector force_on(const struct throat_loads *loads,
                              const struct load_values *load, const double *pull,
                              int grain)
{
    struct vector force = {0};
    for (int l = 0; l < LOAD_WEIGHT; l++)
        force = pulled(loads, (enum load)l, load, grain, force);
    if (loads->rings.n > 0)
        force = add(force, drying_rings_force(&loads->rings, pull, grain));
    return pulled(loads, LOAD_WEIGHT, load, grain, scale(loads->scale, force));
}

void forces_now(const struct throat_loads *loads, const struct liquid_loads *liquid,
                struct vector *force)
{
    const struct network *network = liquid->network;
    struct load_values load = load_values_init(loads, network->n_throat);
    double *pull = NEW_ARRAY(double, loads->rings.n);
    drying_rings_pull(&loads->rings, liquid, pull);
#pragma omp parallel
    {
#pragma omp for
        for (int t = 0; t < network->n_throat; t++)
            set_loads(liquid, t, &load);
#pragma omp for
        for (int i = 0; i < network->packing.n_particle; i++)
            force[i] = force_on(loads, &load, pull, i);
    }
    load_values_free(&load);
    free(pull);
}

// --- step by step ------------------------------------------------------------------

// Lists the grains of each throat, once for each load that acts on them.
static void list_grains(struct force_steps *steps, int n_throat)
{
    const struct patches *patches = steps->loads->patches;
    steps->offset = NEW_ARRAY(int, n_throat + 1);
    for (int l = 0; l < LOADS; l++)
        for (int k = 0; k < patches[l].n; k++)
            steps->offset[patches[l].patch[k].throat + 1]++;
    for (int t = 0; t < n_throat; t++)
        steps->offset[t + 1] += steps->offset[t];
    steps->grain = NEW_ARRAY(int, steps->offset[n_throat]);
    int *next = duplicate(steps->offset, (size_t)n_throat + 1, sizeof *next);
    for (int l = 0; l < LOADS; l++)
        for (int k = 0; k < patches[l].n; k++) {
            const struct patch *patch = &patches[l].patch[k];
            steps->grain[next[patch->throat]++] = patch->particle;
        }
    free(next);
}

static void list_grain(struct force_steps *steps, int grain)
{
    if (steps->listed[grain]) return;
    steps->listed[grain] = true;
    steps->changed[steps->n_changed++] = grain;
}

// Lists the grains of THROAT if any of its loads is another.
static void update_throat(struct force_steps *steps, int throat)
{
    if (!set_loads(&steps->liquid, throat, &steps->load)) return;
    for (int k = steps->offset[throat]; k < steps->offset[throat + 1]; k++)
        list_grain(steps, steps->grain[k]);
}

// All rings: each that pulls differently lists its two grains.
static void update_rings(struct force_steps *steps)
{
    const struct drying_rings *rings = &steps->loads->rings;
    double *former = steps->pull;
    steps->pull = steps->former_pull;
    steps->former_pull = former;
    drying_rings_pull(rings, &steps->liquid, steps->pull);
    for (int r = 0; r < rings->n; r++)
        for (int end = 0; end < 2 && steps->pull[r] != former[r]; end++)
            list_grain(steps, rings->grain[r][end]);
}

static void update(struct force_steps *steps)
{
    const struct drying_record *record = &steps->liquid.record->drying;
    const int step = steps->liquid.step;
    steps->n_changed = 0;
    if (steps->checks_all)
        for (int t = 0; t < steps->liquid.network->n_throat; t++)
            update_throat(steps, t);
    else
        for (int64_t k = record->offset[step]; k < record->offset[step + 1]; k++)
            update_throat(steps, record->throat[k]);
    if (steps->loads->rings.n > 0) update_rings(steps);
    for (int k = 0; k < steps->n_changed; k++) {
        const int grain = steps->changed[k];
        steps->former[k] = steps->force[grain];
        steps->force[grain] = force_on(steps->loads, &steps->load, steps->pull, grain);
        steps->listed[grain] = false;
    }
}

struct force_steps force_steps_begin(const struct throat_loads *loads,
                                     const struct network *network,
                                     const struct liquid_record *record,
                                     const struct suction_law *law)
{
    const int n = network->packing.n_particle;
    struct force_steps steps = {.loads = loads,
                                .liquid = liquid_loads_begin(network, record, law),
                                .load = load_values_init(loads, network->n_throat),
                                .pull = NEW_ARRAY(double, loads->rings.n),
                                .former_pull = NEW_ARRAY(double, loads->rings.n),
                                .force = NEW_ARRAY(struct vector, n),
                                .changed = NEW_ARRAY(int, n),
                                .former = NEW_ARRAY(struct vector, n),
                                .listed = NEW_ARRAY(bool, n)};
    const bool rings_weigh = steps.liquid.ring_part && law->weight > 0;
    steps.checks_all = law->rule != SUCTION_UNIFORM || rings_weigh ||
                       loads->patches[LOAD_CONTACT_LINE].n > 0;
    list_grains(&steps, network->n_throat);
    for (int t = 0; t < network->n_throat; t++)
        set_loads(&steps.liquid, t, &steps.load);
    drying_rings_pull(&loads->rings, &steps.liquid, steps.pull);
    for (int i = 0; i < n; i++)
        steps.force[i] = force_on(loads, &steps.load, steps.pull, i);
    return steps;
}

void force_steps_to_end_of_step(struct force_steps *steps)
{
    liquid_loads_to_end_of_step(&steps->liquid);
    update(steps);
}

bool force_steps_advance(struct force_steps *steps)
{
    if (steps->liquid.step + 1 >= steps->liquid.record->drying.n_step) return false;
    liquid_loads_advance(&steps->liquid);
    update(steps);
    return true;
}

void force_steps_free(struct force_steps *steps)
{
    liquid_loads_free(&steps->liquid);
    load_values_free(&steps->load);
    free(steps->pull);
    free(steps->former_pull);
    free(steps->force);
    free(steps->offset);
    free(steps->grain);
    free(steps->changed);
    free(steps->former);
    free(steps->listed);
    *steps = (struct force_steps){0};
}
