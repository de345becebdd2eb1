// SPDX-License-Identifier: GPL-3.0-or-later
#include "warnings.h"

#include "basics/status.h"
#include "dem/stiff_contacts.h"
#include "geometry/porosity.h"

#include <math.h>

// Half of the loads, because a few that are slow to settle change little. Equilibria
// are advised only to a replay that they can make.
static void warn_if_restless(const struct load *load,
                             const struct replay_settings *settings,
                             const struct response *response)
{
    if (response->n_unconverged > 0)
        report(
            "under %d of the loads not all grains came to rest within "
            "quasi_static.tolerance; under the last of these loads grain %d did not: "
            "from there on rounding may decide what breaks (renumber the grains and "
            "compare, or use engine=explicit)",
            response->n_unconverged, response->unconverged_grain);
    else if (response->n_unsettled > load->n_time / 2)
        report("%d of %d steps of the load did not come to rest, to an unbalanced "
               "ratio of %g: let steps last longer by cycles, tolerance and "
               "most_cycles%s",
               response->n_unsettled, load->n_time, ratio_at_rest(settings),
               load->shrinks || load->drains || settings->liquid.volume > 0
                   ? ""
                   : ", or use engine=quasi-static, which finds equilibria");
}

// Where contacts are so much stiffer than bonds that they keep the body from rest.
static void warn_if_stiff(const struct packing *packing, const struct load *load,
                          const struct replay_settings *settings,
                          const struct response *response)
{
    const double bond =
        stiffness_of_bond(settings->bond.normal_stiffness,
                          settings->bond.radius_fraction, mean_radius(packing));
    const double ratio = settings->material.normal_stiffness / bond;
    if (packing->n_bond > 0 && settings->bond.kind == DEM_PARALLEL_BOND &&
        settings->engine == ENGINE_EXPLICIT &&
        response->n_unsettled > load->n_time / 2 && ratio > STIFF_GRAIN_OVER_BOND &&
        isfinite(ratio))
        report("grains are %.0f times as stiff as bonds: with normal_stiffness and "
               "shear_stiffness of %.2g N/m they come to rest in far fewer time steps "
               "(docs/your-grains.md)",
               ratio, GRAIN_OVER_BOND * bond);
}

// Grains that have moved by more than the largest radius, at any snapshot, and the one
// that moved most, by so many of these.
struct far_grains {
    int count, furthest;
    double moved;
};

// Over all snapshots, since a grain may come back.
static struct far_grains find_far_grains(const struct packing *packing,
                                         const struct response *response)
{
    double largest_radius = 0;
    for (int i = 0; i < packing->n_particle; i++)
        largest_radius = fmax(largest_radius, packing->radius[i]);
    struct far_grains far = {0};
    for (int i = 0; i < packing->n_particle; i++) {
        double moved = 0;
        for (int s = 0; s < response->n_snapshot; s++)
            moved = fmax(moved, norm(response->snapshot[s].displacement[i]));
        moved /= largest_radius;
        far.count += moved > 1;
        if (moved > far.moved) far = (struct far_grains){far.count, i, moved};
    }
    return far;
}

// A body with cracks may still be in one piece; grains that have moved by their own
// size are not part of it. Forces that balance but keep their directions can turn a
// body over.
static void warn_if_loose(const struct packing *packing,
                          const struct replay_settings *settings,
                          const struct response *response)
{
    const struct far_grains far = find_far_grains(packing, response);
    const int n = packing->n_particle;
    const bool most_are_far = 2 * far.count >= n && far.count > 0;
    if (response->n_detached > 0)
        report("%d of %d grains detached from the aggregate, grain %d first: nothing "
               "held %s under %s load",
               response->n_detached, n, response->first_detached,
               response->n_detached > 1 ? "them" : "it",
               response->n_detached > 1 ? "their" : "its");
    if (response->n_unbonded > 0)
        report("%d of %d grains have no bond, and nothing held them under their load",
               response->n_unbonded, n);
    if (response->n_instability > 0)
        report("the aggregate snapped through or buckled %d time%s, and dashpots "
               "brought it to rest; grain %d moved most the last time",
               response->n_instability, response->n_instability > 1 ? "s" : "",
               response->instability_grain);
    if (far.count > 0)
        report("%s%d of %d grains moved by more than the largest radius, grain %d "
               "most, by %.3g of it; %d of %d bonds broke",
               !most_are_far       ? ""
               : response->n_crack ? "the aggregate has come apart: "
                                   : "the aggregate has given way: ",
               far.count, n, far.furthest, far.moved, response->n_crack,
               packing->n_bond);
    const bool is_loose =
        most_are_far || response->n_detached + response->n_unbonded == n;
    if (settings->support == SUPPORT_WALL && n > 0 && is_loose)
        report("support=wall holds only a body that the forces press against the wall; "
               "one that they only press together turns over (support=free removes net "
               "force and moment)");
}

// Bonds feel shrinkage before grains have followed it.
static void warn_if_sudden(const struct packing *packing,
                           const struct replay_settings *settings,
                           const struct response *response)
{
    static const double much = 0.25; // of what breaks a bond
    const struct dem_bond_material *bond = &settings->bond;
    const double stiffness = bond->kind == DEM_PARALLEL_BOND
                                 ? bond->normal_stiffness
                                 : settings->material.normal_stiffness;
    const double length = 2 * mean_radius(packing);
    const double breaks = bond->normal_strength / (stiffness * length);
    if (packing->n_bond > 0 && response->most_at_once > much * breaks)
        report("grains shrank by up to %.2g at once, and a stretch of %.2g breaks a "
               "bond: such loads break bonds by themselves; let steps last longer "
               "(cycles), or take more of them (shrinkage.steps)",
               response->most_at_once, breaks);
}

// Where the largest suction was too small for gas to enter anything, or for the share
// that is to evaporate. A round takes its portion to half of it. Pores that narrow
// press liquid out, which nothing needs to take.
static void warn_if_wet(const struct load *load, const struct replay_settings *settings,
                        const struct response *response)
{
    const struct capillarity *how = &settings->capillarity;
    if (!load->drains || load->n_time == 0) return;
    const struct drainage_history *drainage = &response->drainage;
    const int last = load->n_time - 1;
    const double gone = drainage->drained[last] / drainage->first_liquid;
    const double left = drainage->liquid[last] / drainage->first_liquid;
    const bool dries = how->control == CONTROL_EVAPORATION;
    const double wanted =
        dries ? how->last_drained * (1 - 1.0 / (double)(how->steps * how->rounds)) : 0;
    if (gone > wanted || (dries && fmin(left, 1 - gone) <= 1 - wanted)) return;
    report(
        "gas has taken %.3g of the liquid%s: capillary.suction=%g Pa is too small for "
        "the throats, which need 2 gamma cos(theta)/r",
        gone, dries ? ", less than capillary.evaporated" : "", how->suction);
}

void warn_of_replay(const struct packing *packing, const struct load *load,
                    const struct replay_settings *settings,
                    const struct response *response)
{
    warn_if_restless(load, settings, response);
    warn_if_stiff(packing, load, settings, response);
    warn_if_sudden(packing, settings, response);
    warn_if_loose(packing, settings, response);
    warn_if_wet(load, settings, response);
}
