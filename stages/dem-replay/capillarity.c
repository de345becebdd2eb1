// SPDX-License-Identifier: GPL-3.0-or-later
// One suction P everywhere in the liquid. Gas enters a pore through a throat of radius
// rho, beside a pore that it is in, where
//     P >= 2 gamma cos(theta) / rho.
// By suction, P is given. By evaporation the pores with the widest throats empty until
// they have held the liquid of a round, and P is the largest of theirs: so it falls
// where cracks open. The mean lateral tension of grains and liquid together, over the
// volume V of the box, is
//     P (tetrahedra with liquid) / V - (compression of the grains),
// as a liquid under -P in a region of volume W has the virial -P W, whatever its shape.
#include "capillarity.h"

#include "basics/memory.h"
#include "geometry/porosity.h"

#include <math.h>
#include <stdlib.h>

// Of the mean diameter: so wide is the open air, not a pore.
static const double OPEN_AIR = 0.5;

// ---- begin --------------------------------------------------------------------------

static void open_to_the_air(struct drainage *drainage, double least)
{
    uint8_t *which = NEW_ARRAY(uint8_t, drainage->liquid.n);
    while (mark_entered(&drainage->liquid, drainage->first, drainage->first_radius,
                        least, which))
        let_gas_in(&drainage->liquid, which);
    for (int p = 0; p < drainage->liquid.n; p++)
        drainage->n_gas += drainage->liquid.pore[p].has_gas;
    free(which);
}

enum status drainage_begin(struct drainage *drainage, const struct capillarity *how,
                           const struct packing *packing, struct reason *reason)
{
    const size_t n = (size_t)packing->n_particle;
    *drainage = (struct drainage){.how = how, .n_particle = packing->n_particle};
    const enum status status = pore_liquid_init(&drainage->liquid, packing, reason);
    if (status) return status;
    drainage->first = duplicate(packing->position, n, sizeof *drainage->first);
    drainage->at = duplicate(packing->position, n, sizeof *drainage->at);
    drainage->first_radius = duplicate(packing->radius, n, sizeof *packing->radius);
    drainage->radius = duplicate(packing->radius, n, sizeof *packing->radius);
    open_to_the_air(drainage, 2 * OPEN_AIR * mean_radius(packing));
    drainage->begin =
        liquid_volume(&drainage->liquid, drainage->first, drainage->first_radius, NULL);
    if (drainage->begin > 0) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "no pore holds liquid: from above gas reaches %d of its %d pores "
                  "through throats of half a mean diameter: pack the grains closer",
                  drainage->n_gas, drainage->liquid.n);
}

void drainage_free(struct drainage *drainage)
{
    pore_liquid_free(&drainage->liquid);
    free(drainage->first);
    free(drainage->at);
    free(drainage->first_radius);
    free(drainage->radius);
    *drainage = (struct drainage){0};
}

// ---- suction ------------------------------------------------------------------------

// At time step NOW, Pa.
static double suction_at(const struct drainage *drainage, int64_t now)
{
    if (now >= drainage->until) return drainage->to;
    const double share =
        (double)(now - drainage->since) / (double)(drainage->until - drainage->since);
    return drainage->from + share * (drainage->to - drainage->from);
}

void aim_at_suction(struct drainage *drainage, double suction, int64_t now,
                    int64_t cycles)
{
    drainage->from = suction_at(drainage, now);
    drainage->to = suction;
    drainage->since = now;
    drainage->until = now + cycles;
}

void add_capillary_forces(const struct drainage *drainage, const struct dem *dem,
                          struct vector *force)
{
    const double suction = suction_at(drainage, dem_cycle(dem));
    if (drainage->how->forces == GEOMETRY_FIRST) {
        add_meniscus_forces(&drainage->liquid, drainage->first, suction, force);
        return;
    }
    struct vector *at = NEW_ARRAY(struct vector, drainage->n_particle);
    dem_positions(dem, at);
    add_meniscus_forces(&drainage->liquid, at, suction, force);
    free(at);
}

// ---- gas ----------------------------------------------------------------------------

// The liquid of a round, m3.
static double portion(const struct drainage *drainage)
{
    const struct capillarity *how = drainage->how;
    return drainage->begin * how->last_drained / (double)(how->steps * how->rounds);
}

// Marks what evaporates in this round: where the largest suction is too small for it,
// what that suction drains.
static void evaporate(struct drainage *drainage, const struct vector *at,
                      const double *radius, int64_t now, uint8_t *which)
{
    const struct capillarity *how = drainage->how;
    const double narrowest =
        mark_widest(&drainage->liquid, at, radius, portion(drainage), which);
    if (!(narrowest > 0)) return;
    const double needed = 2 * how->tension / narrowest;
    aim_at_suction(drainage, fmin(needed, how->suction), now, how->round);
    if (needed <= how->suction) return;
    for (int p = 0; p < drainage->liquid.n; p++)
        which[p] = 0;
    mark_entered(&drainage->liquid, at, radius, 2 * how->tension / how->suction, which);
}

// Counts what the marked pores hold.
static int drain(struct drainage *drainage, const uint8_t *which)
{
    int n = 0;
    for (int p = 0; p < drainage->liquid.n; p++) {
        if (!which[p]) continue;
        drainage->drained +=
            pore_room(&drainage->liquid, p, drainage->at, drainage->radius);
        n++;
    }
    drainage->n_gas += n;
    if (n > 0) let_gas_in(&drainage->liquid, which);
    return n;
}

// Where gas goes by, and what pores hold when it comes.
static void look_at(struct drainage *drainage, const struct dem *dem)
{
    dem_positions(dem, drainage->at);
    dem_radii(dem, drainage->radius);
}

int enter_gas(struct drainage *drainage, const struct dem *dem)
{
    const struct capillarity *how = drainage->how;
    const int64_t now = dem_cycle(dem);
    const bool present = how->throats == GEOMETRY_PRESENT;
    look_at(drainage, dem);
    const struct vector *at = present ? drainage->at : drainage->first;
    const double *radius = present ? drainage->radius : drainage->first_radius;
    uint8_t *which = NEW_ARRAY(uint8_t, drainage->liquid.n);
    if (how->control == CONTROL_EVAPORATION)
        evaporate(drainage, at, radius, now, which);
    else if (suction_at(drainage, now) > 0)
        mark_entered(&drainage->liquid, at, radius,
                     2 * how->tension / suction_at(drainage, now), which);
    const int n = drain(drainage, which);
    free(which);
    drainage->round_began = now;
    if (n > 0) drainage->entered = now;
    return n;
}

void empty_distorted(struct drainage *drainage, const struct dem *dem)
{
    uint8_t *which = NEW_ARRAY(uint8_t, drainage->liquid.n);
    look_at(drainage, dem);
    drainage->n_distorted += mark_distorted(&drainage->liquid, drainage->at, which);
    drain(drainage, which);
    free(which);
}

void aim_at_volume(struct drainage *drainage, int row)
{
    const struct capillarity *how = drainage->how;
    drainage->target =
        drainage->begin * how->last_drained * (row + 1) / (double)how->steps;
}

// To the nearest portion: all are of one size, for the suction depends on it.
bool has_evaporated(const struct drainage *drainage)
{
    return drainage->drained >= drainage->target - portion(drainage) / 2;
}

// ---- history ------------------------------------------------------------------------

double least_cycles(const struct capillarity *how)
{
    const double round = (double)how->round;
    return how->control == CONTROL_EVAPORATION ? round * (double)how->rounds : round;
}

struct drainage_history drainage_history_init(int n_time)
{
    return (struct drainage_history){.suction = NEW_ARRAY(double, n_time),
                                     .liquid = NEW_ARRAY(double, n_time),
                                     .drained = NEW_ARRAY(double, n_time),
                                     .gas_pores = NEW_ARRAY(int32_t, n_time),
                                     .distorted = NEW_ARRAY(int32_t, n_time)};
}

void drainage_history_free(struct drainage_history *history)
{
    free(history->suction);
    free(history->liquid);
    free(history->drained);
    free(history->gas_pores);
    free(history->distorted);
    *history = (struct drainage_history){0};
}

// The volume of liquid now; that of the pores that hold it, grains and all, goes to
// WET.
static double liquid_now(const struct drainage *drainage, const struct dem *dem,
                         double *wet)
{
    struct vector *at = NEW_ARRAY(struct vector, drainage->n_particle);
    double *radius = NEW_ARRAY(double, drainage->n_particle);
    dem_positions(dem, at);
    dem_radii(dem, radius);
    const double liquid = liquid_volume(&drainage->liquid, at, radius, wet);
    free(at);
    free(radius);
    return liquid;
}

double liquid_tension(const struct drainage *drainage, const struct dem *dem)
{
    const struct vector edge = drainage->liquid.edge;
    double wet;
    liquid_now(drainage, dem, &wet);
    return suction_at(drainage, dem_cycle(dem)) * wet / box_volume(edge);
}

double note_drainage(const struct drainage *drainage, const struct dem *dem, int row,
                     struct drainage_history *history)
{
    double wet;
    const double liquid = liquid_now(drainage, dem, &wet);
    history->first_liquid = drainage->begin;
    history->suction[row] = suction_at(drainage, dem_cycle(dem));
    history->liquid[row] = liquid;
    history->drained[row] = drainage->drained;
    history->gas_pores[row] = drainage->n_gas;
    history->distorted[row] = drainage->n_distorted;
    return fmin(fmax(liquid / drainage->begin, 0), 1);
}
