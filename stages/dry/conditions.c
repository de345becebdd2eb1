// SPDX-License-Identifier: GPL-3.0-or-later
// What can be dried, and the units it is computed in. With L the mean throat length,
// the scaled unit of the rate is one throat's worth of K 3.9,
//     rate = diffusivity (p_g M / (R T)) ln((p_g - p_inf) / (p_g - p_sat)) L,
// of mass rho L^3, and of time mass / rate. In these units vapour conductances are
// area over length, the driving potential is 1, and a throat loses scaled volume. The
// trap is the logarithm: where p_sat is close to p_inf, or to p_g, only log1p of the
// difference keeps its digits.
#include "conditions.h"

#include "basics/compensated.h"
#include "network/checks.h"

#include <stddef.h>

// The comparison is written so that NAN is refused, too.
static enum status check_positive(const struct drying_conditions *conditions,
                                  struct reason *reason)
{
    const struct {
        const char *name;
        double value;
    } positive[] = {{"temperature", conditions->temperature},
                    {"gas_pressure", conditions->gas_pressure},
                    {"saturation_pressure", conditions->saturation_pressure},
                    {"diffusivity", conditions->diffusivity},
                    {"molar_mass", conditions->molar_mass},
                    {"liquid_density", conditions->liquid_density},
                    {"mass_transfer", conditions->mass_transfer}};
    for (size_t i = 0; i < sizeof positive / sizeof *positive; i++)
        if (!(positive[i].value > 0) || !isfinite(positive[i].value))
            return refuse(reason, STATUS_BAD_DATA, "%s: must be above 0, is %g",
                          positive[i].name, positive[i].value);
    return STATUS_OK;
}

// At 90 degrees the suction 2 gamma cos(theta) / r is 0, and the order of invasion
// would be none.
static enum status check_menisci(const struct drying_conditions *conditions,
                                 struct reason *reason)
{
    if (!(conditions->surface_tension > 0) || !isfinite(conditions->surface_tension))
        return refuse(reason, STATUS_BAD_DATA,
                      "surface_tension: must be above 0, is %g",
                      conditions->surface_tension);
    if (!(conditions->contact_angle >= 0 && conditions->contact_angle < 90))
        return refuse(reason, STATUS_BAD_DATA,
                      "contact_angle: must be from 0 to below 90 degrees, is %g: gas "
                      "would enter without suction",
                      conditions->contact_angle);
    if (!(conditions->gravity >= 0) || !isfinite(conditions->gravity))
        return refuse(reason, STATUS_BAD_DATA, "gravity: must not be below 0, is %g",
                      conditions->gravity);
    return STATUS_OK;
}

// Films have the viscosity of the liquid.
static enum status check_films(const struct drying_conditions *conditions,
                               struct reason *reason)
{
    const struct film_conditions *films = &conditions->films;
    if (conditions->liquid == LIQUID_IMMOBILE)
        return refuse(reason, STATUS_BAD_DATA,
                      "rings: must not be films where liquid is immobile: nothing "
                      "flows through films either");
    if (!(conditions->viscosity > 0) || !isfinite(conditions->viscosity))
        return refuse(reason, STATUS_BAD_DATA,
                      "viscosity: must be above 0 with rings=films, is %g",
                      conditions->viscosity);
    const struct {
        const char *name;
        double value, least, most;
    } range[] = {{"corners", films->corners, 1, 12},
                 {"half_angle", films->half_angle, 1, 89},
                 {"conductance", films->conductance, 0, 1e12},
                 {"step", films->step, 0, 1}};
    for (size_t i = 0; i < sizeof range / sizeof *range; i++)
        if (!(range[i].value >= range[i].least && range[i].value <= range[i].most))
            return refuse(reason, STATUS_BAD_DATA,
                          "films.%s: must be from %g to %g, is %g", range[i].name,
                          range[i].least, range[i].most, range[i].value);
    return STATUS_OK;
}

// Surface tension and angle count only where suctions are computed: in viscous liquid,
// under gravity, with the Kelvin effect, or with rings. In the two limits only the
// order of the radii counts, which has no tension in it.
static enum status check_liquid(const struct drying_conditions *conditions,
                                struct reason *reason)
{
    if ((unsigned)conditions->liquid > LIQUID_VISCOUS)
        return refuse(reason, STATUS_BAD_DATA, "liquid: no such limit, %d",
                      (int)conditions->liquid);
    if (conditions->rings &&
        (conditions->liquid == LIQUID_VISCOUS || conditions->kelvin))
        return refuse(reason, STATUS_BAD_DATA,
                      "rings: must be none where liquid is viscous or menisci are "
                      "curved (kelvin)");
    if (conditions->rings == RINGS_JOINED && conditions->liquid == LIQUID_IMMOBILE)
        return refuse(reason, STATUS_BAD_DATA,
                      "rings: must not be joined where liquid is immobile: nothing "
                      "flows through films either");
    if (conditions->liquid != LIQUID_VISCOUS && conditions->gravity == 0 &&
        !conditions->kelvin && !conditions->rings)
        return STATUS_OK;
    enum status status = check_menisci(conditions, reason);
    if (!status && conditions->rings == RINGS_FILMS)
        status = check_films(conditions, reason);
    if (status || conditions->liquid != LIQUID_VISCOUS) return status;
    if (!(conditions->viscosity > 0) || !isfinite(conditions->viscosity))
        return refuse(reason, STATUS_BAD_DATA,
                      "viscosity: must be above 0 in viscous liquid, is %g",
                      conditions->viscosity);
    if (!(conditions->saturation_step > 0 && conditions->saturation_step <= 1))
        return refuse(reason, STATUS_BAD_DATA,
                      "saturation_step: must be above 0 and at most 1, is %g",
                      conditions->saturation_step);
    if (conditions->flow_step > 0 &&
        (conditions->kelvin || conditions->saturation_step < 1))
        return refuse(reason, STATUS_BAD_DATA,
                      "flow_step: must be 0 with kelvin, or with a saturation_step "
                      "below 1, which asks for more flows, not fewer; is %g",
                      conditions->flow_step);
    return STATUS_OK;
}

// p_inf < p_sat < p_g: otherwise the logarithm of [K 3.9] has no sign that dries, or no
// value.
static enum status check_air(const struct drying_conditions *conditions,
                             struct reason *reason)
{
    if (conditions->saturation_pressure >= conditions->gas_pressure)
        return refuse(
            reason, STATUS_BAD_DATA,
            "saturation_pressure: must be below gas_pressure (%g Pa), is %g Pa: "
            "the liquid would boil",
            conditions->gas_pressure, conditions->saturation_pressure);
    if (!(conditions->air_vapour_pressure >= 0))
        return refuse(reason, STATUS_BAD_DATA,
                      "air_vapour_pressure: must not be below 0, is %g",
                      conditions->air_vapour_pressure);
    if (conditions->air_vapour_pressure >= conditions->saturation_pressure)
        return refuse(
            reason, STATUS_BAD_DATA,
            "air_vapour_pressure: must be below saturation_pressure (%g Pa), is "
            "%g Pa: nothing would dry",
            conditions->saturation_pressure, conditions->air_vapour_pressure);
    if (conditions->layers < 0)
        return refuse(reason, STATUS_BAD_DATA, "layers: must not be below 0, is %d",
                      conditions->layers);
    if (conditions->feet != FEET_SURFACE && conditions->feet != FEET_AUXILIARY)
        return refuse(reason, STATUS_BAD_DATA, "feet: no such choice, %d",
                      (int)conditions->feet);
    if (conditions->open_walls == 0 || conditions->open_walls >= 1u << WALL_COUNT)
        return refuse(reason, STATUS_BAD_DATA,
                      "open walls: must be one at least, or nothing would dry");
    return STATUS_OK;
}

// Where the run starts and ends, and what is recorded of it. A tolerance is for rates
// that come straight from the elimination of the vapour's network: liquid without
// viscosity or immobile, menisci that are not curved.
static enum status check_course(const struct drying_conditions *conditions,
                                struct reason *reason)
{
    if (!(conditions->start_saturation > 0 && conditions->start_saturation <= 1))
        return refuse(reason, STATUS_BAD_DATA,
                      "start_saturation: must be above 0 and at most 1, is %g",
                      conditions->start_saturation);
    if (!(conditions->stop_saturation >= 0 && conditions->stop_saturation < 1))
        return refuse(reason, STATUS_BAD_DATA,
                      "stop_saturation: must be at least 0 and below 1, is %g",
                      conditions->stop_saturation);
    if (!(conditions->vapour_tolerance == 0 || (conditions->vapour_tolerance >= 1e-6 &&
                                                conditions->vapour_tolerance <= 0.5)))
        return refuse(reason, STATUS_BAD_DATA,
                      "vapour_tolerance: must be 0 or from 1e-6 to 0.5, is %g",
                      conditions->vapour_tolerance);
    if (conditions->vapour_tolerance > 0 &&
        (conditions->kelvin || conditions->liquid == LIQUID_VISCOUS))
        return refuse(reason, STATUS_BAD_DATA,
                      "vapour_tolerance: must be 0 where liquid is viscous or menisci "
                      "are curved (kelvin), is %g: with 0 the vapour is exact; a "
                      "tolerance goes with inviscid or immobile liquid, kelvin=false",
                      conditions->vapour_tolerance);
    if (!(conditions->vapour_step >= 0 && conditions->vapour_step <= 0.5))
        return refuse(reason, STATUS_BAD_DATA,
                      "vapour_step: must be from 0 to 0.5, is %g",
                      conditions->vapour_step);
    if (conditions->vapour_step > 0 && conditions->kelvin)
        return refuse(reason, STATUS_BAD_DATA,
                      "vapour_step: must be 0 where menisci are curved (kelvin), is %g",
                      conditions->vapour_step);
    if (conditions->vapour_step > 0 && conditions->liquid == LIQUID_VISCOUS &&
        !(conditions->flow_step > 0))
        return refuse(reason, STATUS_BAD_DATA,
                      "vapour_step: must be 0 where the flow of viscous liquid is "
                      "found at each event (flow_step = 0), is %g",
                      conditions->vapour_step);
    if (!(conditions->step_interval >= 0 && conditions->step_interval <= 1))
        return refuse(reason, STATUS_BAD_DATA,
                      "step_interval: must be from 0 to 1, is %g",
                      conditions->step_interval);
    if (!(conditions->first_period_rate_fraction > 0 &&
          conditions->first_period_rate_fraction < 1))
        return refuse(reason, STATUS_BAD_DATA,
                      "first_period_rate_fraction: must be between 0 and 1, is %g",
                      conditions->first_period_rate_fraction);
    return STATUS_OK;
}

// Air before liquid, because the more usual mistakes are there.
enum status check_conditions(const struct drying_conditions *conditions,
                             struct reason *reason)
{
    enum status status = check_positive(conditions, reason);
    if (!status) status = check_air(conditions, reason);
    if (!status) status = check_course(conditions, reason);
    if (!status) status = check_liquid(conditions, reason);
    return status;
}

// Only throats that may hold liquid; those closed by grains or imposed empty need no
// size.
enum status check_throats(const struct network *network, struct reason *reason)
{
    int n = 0;
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        const double length = network->throat_length[t];
        const double volume = throat_volume(network, t);
        n++;
        if (!(length > 0) || !isfinite(length))
            return refuse(
                reason, STATUS_BAD_DATA,
                "/throats/length: row %d: must be above 0, is %g (merge-nodes "
                "removes short throats)",
                t, length);
        const enum status status = check_throat_radius(network, t, reason);
        if (status) return status;
        if (!(volume > 0) || !isfinite(volume))
            return refuse(reason, STATUS_BAD_DATA,
                          "/throats/volume: row %d: must be above 0, is %g", t, volume);
        if (network->throat_nodes[t][0] == network->throat_nodes[t][1])
            return refuse(reason, STATUS_BAD_DATA,
                          "/throats/nodes: row %d: both ends are node %d", t,
                          network->throat_nodes[t][0]);
    }
    if (n == 0)
        return refuse(
            reason, STATUS_BAD_DATA,
            "/throats/kind: no throat holds liquid, there is nothing to dry: all "
            "are imposed empty, or closed by grains");
    return STATUS_OK;
}

int count_throats(const struct network *network)
{
    int n = 0;
    for (int t = 0; t < network->n_throat; t++)
        n += network->throat_kind[t] == THROAT_NETWORK;
    return n;
}

// 12 bytes a change: a throat of 4, a saturation of 8.
enum status check_steps(const struct drying_conditions *conditions,
                        const struct network *network, struct reason *reason)
{
    const int n = count_throats(network);
    if (conditions->step_interval > 0 || n <= MAX_RECORDED_THROATS) return STATUS_OK;
    const double bytes = 12 * pow(n, 1.7) / 2; // rows as measured on cubic lattices
    return refuse(reason, STATUS_BAD_DATA,
                  "step_interval: must be above 0 in networks of more than %d throats, "
                  "is 0 with %d: the changes at all events would take about %.2g GB",
                  MAX_RECORDED_THROATS, n, bytes / 1e9);
}

// Compensated, because the unit of length enters every number.
static double mean_throat_length(const struct network *network)
{
    struct compensated sum = {0};
    int n = 0;
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        compensated_add(&sum, network->throat_length[t]);
        n++;
    }
    return compensated_value(sum) / n;
}

// ln((p_g - p_inf) / (p_g - p_sat)): the rise of -ln(1 - p_v/p_g) from the drying air
// to the wet nodes. log1p(x) with x = (p_sat - p_inf) / (p_g - p_sat), since 1 + x =
// (p_g - p_inf) / (p_g - p_sat).
static double potential_drop(const struct drying_conditions *conditions)
{
    return log1p((conditions->saturation_pressure - conditions->air_vapour_pressure) /
                 (conditions->gas_pressure - conditions->saturation_pressure));
}

// beta enters as the thickness delta / beta of the boundary layer [K 3.3.5], in throat
// lengths.
struct drying_scale drying_scale(const struct network *network,
                                 const struct drying_conditions *conditions)
{
    const double length = mean_throat_length(network);
    const double vapour_density = conditions->gas_pressure * conditions->molar_mass /
                                  (GAS_CONSTANT * conditions->temperature);
    struct drying_scale scale = {
        .length = length,
        .mass = conditions->liquid_density * (length * length * length),
        .rate = conditions->diffusivity * vapour_density * potential_drop(conditions) *
                length, // [K 3.9]
        .boundary_layer = conditions->diffusivity / conditions->mass_transfer / length};
    scale.time = scale.mass / scale.rate;
    return scale;
}

// Within these bounds the square of a time is still a normal number.
enum status check_scale(const struct drying_conditions *conditions,
                        const struct network *network, struct reason *reason)
{
    const double time = drying_scale(network, conditions).time, most = 1e150;
    if (time >= 1 / most && time <= most) return STATUS_OK;
    return refuse(
        reason, STATUS_BAD_DATA,
        "saturation_pressure = %g Pa, diffusivity = %g m2/s: the time in which "
        "a throat dries must be from 1e-150 to 1e150 s, is %g s",
        conditions->saturation_pressure, conditions->diffusivity, time);
}

// From D_K(r) = delta: r = 3/2 delta / speed, with the mean speed of the molecules.
double knudsen_radius(const struct drying_conditions *conditions)
{
    if (!conditions->knudsen) return 0;
    const double speed = sqrt(8 * GAS_CONSTANT * conditions->temperature /
                              (M_PI * conditions->molar_mass));
    return 1.5 * conditions->diffusivity / speed;
}
