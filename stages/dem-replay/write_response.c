// SPDX-License-Identifier: GPL-3.0-or-later
// The response artifact. Contacts of all snapshots share one list of pairs, sorted and
// unique; a snapshot has 0 where it does not have a contact. A crack has time and
// saturation of the load it opened under, not of the cycle. Contacts with a wall are
// left out. The tables of snapshots are (n_snapshot, n_contact), so their size grows
// with all contacts that there ever were.
//
// With n grains, b bonds, k rows of the load, s snapshots, c pairs:
//     packing, /bonds/relative_strength (b), /particles/held (n)
//     /cracks     bond, time, saturation, mode, position (n_crack)
//     /earlier_cracks   bond, mode, of the replays that this one goes on from
//     /history    time, saturation, unbalanced_ratio, cycles, cracks, settled,
//                 reaction_force, reaction_moment (k); lateral_tension (k)
//                 where grains shrink or pores drain
//     /contacts   particles (c, 2): bonded at the start, or in contact at a snapshot
//     /snapshots  time, saturation (s); displacement, force (s, n); bond_intact (s, b);
//                 contact_force (s, c); with bridges bridge_volume, _force, _gap (s,
//                 c); where pores drain dryness, where grains shrink shrinkage (s, n)
//     /summary    cracks, time step, and how far from rest and from the start
// SI units; forces on the grains, displacements from where the packing has them.
#include "write_response.h"

#include "basics/memory.h"
#include "bonds.h"
#include "geometry/fragments.h"
#include "geometry/neighbours.h"
#include "replay_checkpoint.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void put_bonds_and_modes(struct artifact *artifact, const char *group,
                         const struct dem_crack *crack, int n)
{
    int32_t *bond = NEW_ARRAY(int32_t, n);
    uint8_t *mode = NEW_ARRAY(uint8_t, n);
    char name[60];
    for (int k = 0; k < n; k++) {
        bond[k] = crack[k].bond;
        mode[k] = crack[k].mode;
    }
    snprintf(name, sizeof name, "%s/bond", group);
    artifact_put(artifact, name, bond, n);
    snprintf(name, sizeof name, "%s/mode", group);
    artifact_put(artifact, name, mode, n);
    free(bond);
    free(mode);
}

static void put_cracks(struct artifact *artifact, const struct load *load,
                       const struct response *response)
{
    const int n = response->n_crack;
    int32_t *bond = NEW_ARRAY(int32_t, n);
    double *time = NEW_ARRAY(double, n), *saturation = NEW_ARRAY(double, n);
    uint8_t *mode = NEW_ARRAY(uint8_t, n);
    struct vector *position = NEW_ARRAY(struct vector, n);
    for (int k = 0; k < n; k++) {
        bond[k] = response->crack[k].bond;
        time[k] = load->time[response->crack_step[k]];
        saturation[k] = load->saturation[response->crack_step[k]];
        mode[k] = response->crack[k].mode;
        position[k] = response->crack[k].position;
    }
    artifact_put(artifact, "/cracks/bond", bond, n);
    artifact_put(artifact, "/cracks/time", time, n);
    artifact_put(artifact, "/cracks/saturation", saturation, n);
    artifact_put(artifact, "/cracks/mode", mode, n);
    artifact_put(artifact, "/cracks/position", position, n);
    free(bond);
    free(time);
    free(saturation);
    free(mode);
    free(position);
}

static void put_history(struct artifact *artifact, const struct load *load,
                        const struct response *response)
{
    artifact_put(artifact, "/history/time", load->time, load->n_time);
    artifact_put(artifact, "/history/saturation", load->saturation, load->n_time);
    artifact_put(artifact, "/history/unbalanced_ratio", response->unbalanced_ratio,
                 load->n_time);
    artifact_put(artifact, "/history/cycles", response->cycles, load->n_time);
    artifact_put(artifact, "/history/cracks", response->cracks, load->n_time);
    artifact_put(artifact, "/history/settled", response->settled, load->n_time);
    if (response->lateral_tension)
        artifact_put(artifact, "/history/lateral_tension", response->lateral_tension,
                     load->n_time);
    struct vector *force = NEW_ARRAY(struct vector, load->n_time);
    struct vector *moment = NEW_ARRAY(struct vector, load->n_time);
    for (int k = 0; k < load->n_time; k++) {
        force[k] = response->reaction[k].force;
        moment[k] = response->reaction[k].moment;
    }
    artifact_put(artifact, "/history/reaction_force", force, load->n_time);
    artifact_put(artifact, "/history/reaction_moment", moment, load->n_time);
    free(force);
    free(moment);
}

static void put_drainage(struct artifact *artifact, const struct load *load,
                         const struct drainage_history *drainage)
{
    if (!load->drains) return;
    const int n = load->n_time;
    artifact_put(artifact, "/history/suction", drainage->suction, n);
    artifact_put(artifact, "/history/liquid_volume", drainage->liquid, n);
    artifact_put(artifact, "/history/drained_volume", drainage->drained, n);
    artifact_put(artifact, "/history/gas_pores", drainage->gas_pores, n);
    artifact_put(artifact, "/history/distorted_pores", drainage->distorted, n);
}

// With the strengths of its bonds in this replay.
static void put_replayed_packing(struct artifact *artifact,
                                 const struct packing *packing,
                                 const struct replay_settings *settings)
{
    double *relative = settings->relative_strength;
    struct packing replayed = *packing;
    replayed.bond_strength = relative ? relative : equal_strengths(packing->n_bond);
    artifact_put_packing(artifact, &replayed);
    artifact_put(artifact, "/particles/held", settings->held, packing->n_particle);
    if (!relative) free(replayed.bond_strength);
}

// ---- contacts of all snapshots ------------------------------------------------------

struct contact_list {
    int32_t (*pair)[2];
    int count, capacity;
};

static void append(struct contact_list *list, const int32_t pair[2])
{
    GROW_ARRAY(list->pair, list->count, list->capacity);
    memcpy(list->pair[list->count++], pair, sizeof *list->pair);
}

// Pairs bonded at the start, or touching or joined by a liquid bridge at a snapshot,
// each once; walls left out. Bonded ones are there even when no snapshot has them, so
// that a broken bond keeps its column. O(c log c).
static struct contact_list all_contacts(const struct packing *packing,
                                        const struct response *response)
{
    struct contact_list list = {0};
    for (int b = 0; b < packing->n_bond; b++)
        append(&list, packing->bond[b]);
    for (int s = 0; s < response->n_snapshot; s++)
        for (int c = 0; c < response->snapshot[s].n_contact; c++)
            if (response->snapshot[s].contact[c].particle[1] >= 0)
                append(&list, response->snapshot[s].contact[c].particle);
    if (list.count)
        qsort(list.pair, (size_t)list.count, sizeof *list.pair, compare_pairs);
    int kept = 0;
    for (int k = 0; k < list.count; k++)
        if (!kept || compare_pairs(list.pair[kept - 1], list.pair[k]))
            memmove(list.pair[kept++], list.pair[k], sizeof *list.pair);
    list.count = kept;
    return list;
}

// The row of LIST that a contact has, or -1: with a wall. By bisection: the list is
// sorted.
static int row_of(const struct contact_list *list, const struct dem_contact *contact)
{
    if (!list->count) return -1;
    const int32_t(*found)[2] =
        bsearch(contact->particle, list->pair, (size_t)list->count, sizeof *list->pair,
                compare_pairs);
    return found ? (int)(found - (const int32_t(*)[2])list->pair) : -1;
}

// 0 where a snapshot does not have the contact.
struct contact_tables {
    struct vector *force;
    double *bridge_volume, *bridge_force, *bridge_gap;
};

// A table of all contacts of any snapshot, so that a contact has one column in all of
// them.
static struct contact_tables tables_of(const struct response *response,
                                       const struct contact_list *list)
{
    const size_t width = (size_t)list->count;
    const size_t size = (size_t)response->n_snapshot * width;
    const struct contact_tables tables = {
        NEW_ARRAY(struct vector, size), NEW_ARRAY(double, size),
        NEW_ARRAY(double, size), NEW_ARRAY(double, size)};
    for (int s = 0; s < response->n_snapshot; s++)
        for (int c = 0; c < response->snapshot[s].n_contact; c++) {
            const struct dem_contact *contact = &response->snapshot[s].contact[c];
            const int row = row_of(list, contact);
            if (row < 0) continue;
            const size_t at = (size_t)s * width + (size_t)row;
            tables.force[at] = contact->force;
            if (!(contact->bridge_volume > 0)) continue;
            tables.bridge_volume[at] = contact->bridge_volume;
            tables.bridge_force[at] = contact->bridge_force;
            tables.bridge_gap[at] = -contact->overlap;
        }
    return tables;
}

// Bridges only where there may be any.
static void put_contacts(struct artifact *artifact, const struct response *response,
                         const struct contact_list *list, bool wet)
{
    const int rows = response->n_snapshot, width = list->count;
    const struct contact_tables tables = tables_of(response, list);
    artifact_put(artifact, "/contacts/particles", list->pair, width);
    artifact_put_table(artifact, "/snapshots/contact_force", tables.force, rows, width);
    if (wet) {
        artifact_put_table(artifact, "/snapshots/bridge_volume", tables.bridge_volume,
                           rows, width);
        artifact_put_table(artifact, "/snapshots/bridge_force", tables.bridge_force,
                           rows, width);
        artifact_put_table(artifact, "/snapshots/bridge_gap", tables.bridge_gap, rows,
                           width);
    }
    free(tables.force);
    free(tables.bridge_volume);
    free(tables.bridge_force);
    free(tables.bridge_gap);
}

// ---- snapshots ----------------------------------------------------------------------

// One array for all snapshots, (n_snapshot, n), as datasets are.
static void put_snapshots(struct artifact *artifact, const struct packing *packing,
                          const struct response *response)
{
    const size_t n = (size_t)packing->n_particle, n_bond = (size_t)packing->n_bond;
    const size_t count = (size_t)response->n_snapshot;
    double *time = NEW_ARRAY(double, count), *saturation = NEW_ARRAY(double, count);
    struct vector *displacement = NEW_ARRAY(struct vector, count * n);
    struct vector *force = NEW_ARRAY(struct vector, count * n);
    uint8_t *intact = NEW_ARRAY(uint8_t, count * n_bond);
    for (size_t s = 0; s < count; s++) {
        const struct snapshot *snapshot = &response->snapshot[s];
        time[s] = snapshot->time;
        saturation[s] = snapshot->saturation;
        memcpy(displacement + s * n, snapshot->displacement, n * sizeof *displacement);
        memcpy(force + s * n, snapshot->force, n * sizeof *force);
        memcpy(intact + s * n_bond, snapshot->intact, n_bond);
    }
    artifact_put(artifact, "/snapshots/time", time, (int)count);
    artifact_put(artifact, "/snapshots/saturation", saturation, (int)count);
    artifact_put_table(artifact, "/snapshots/displacement", displacement, (int)count,
                       (int)n);
    artifact_put_table(artifact, "/snapshots/force", force, (int)count, (int)n);
    artifact_put_table(artifact, "/snapshots/bond_intact", intact, (int)count,
                       (int)n_bond);
    free(time);
    free(saturation);
    free(displacement);
    free(force);
    free(intact);
}

// A number of each of N grains, at each snapshot.
static void put_numbers(struct artifact *artifact, const char *name,
                        snapshot_numbers *of, int n, const struct response *response)
{
    double *all = join_numbers(response, of, n);
    artifact_put_table(artifact, name, all, response->n_snapshot, n);
    free(all);
}

// Pieces of SNAPSHOT: grains that intact bonds join.
static void find_fragments(struct fragments *fragments, const struct packing *packing,
                           const uint8_t *held, const struct snapshot *snapshot)
{
    fragments_begin(fragments);
    for (int b = 0; b < packing->n_bond; b++)
        if (snapshot->intact[b])
            fragments_join(fragments, packing->bond[b][0], packing->bond[b][1]);
    fragments_end(fragments, held, NULL);
}

// Of snapshots only; from the places where grains began. What has come loose of a
// bonded body does not count.
static double largest_displacement(const struct packing *packing, const uint8_t *held,
                                   const struct response *response)
{
    struct fragments fragments = fragments_init(packing->n_particle);
    double most = 0;
    for (int s = 0; s < response->n_snapshot; s++) {
        const struct snapshot *snapshot = &response->snapshot[s];
        find_fragments(&fragments, packing, held, snapshot);
        for (int i = 0; i < packing->n_particle; i++)
            if (packing->n_bond == 0 || fragments.is_held[fragments.of[i]])
                most = fmax(most, norm(snapshot->displacement[i]));
    }
    fragments_free(&fragments);
    return most;
}

// Over loads that have a force only: without any, the ratio says nothing (is_loaded).
static double largest_unbalanced_ratio(const struct response *response, int n_time)
{
    double most = 0;
    for (int k = 0; k < n_time; k++)
        if (response->loaded[k]) most = fmax(most, response->unbalanced_ratio[k]);
    return most;
}

void put_response(struct artifact *artifact, const struct packing *packing,
                  const struct load *load, const struct replay_settings *settings,
                  const struct response *response)
{
    put_replayed_packing(artifact, packing, settings);
    put_cracks(artifact, load, response);
    if (settings->begin)
        put_bonds_and_modes(artifact, "/earlier_cracks", response->earlier_crack,
                            response->n_earlier_crack);
    put_history(artifact, load, response);
    put_drainage(artifact, load, &response->drainage);
    struct contact_list contacts = all_contacts(packing, response);
    put_contacts(artifact, response, &contacts, settings->liquid.volume > 0);
    free(contacts.pair);
    put_snapshots(artifact, packing, response);
    if (load->drains)
        put_numbers(artifact, "/snapshots/dryness", snapshot_dryness,
                    packing->n_particle, response);
    if (load->shrinks)
        put_numbers(artifact, "/snapshots/shrinkage", snapshot_shrinkage,
                    packing->n_particle, response);
    artifact_put_number(artifact, "/summary/cracks", response->n_crack);
    artifact_put_number(artifact, "/summary/steps_unsettled", response->n_unsettled);
    artifact_put_number(artifact, "/summary/largest_displacement",
                        largest_displacement(packing, settings->held, response));
    artifact_put_number(artifact, "/summary/time_step", response->time_step);
    artifact_put_number(artifact, "/summary/time_step_limit",
                        response->time_step_limit);
    artifact_put_number(artifact, "/summary/gone", response->n_detached);
    artifact_put_number(artifact, "/summary/gone_unbonded", response->n_unbonded);
    artifact_put_number(artifact, "/summary/snaps", response->n_instability);
    artifact_put_number(artifact, "/summary/largest_unbalanced_ratio",
                        largest_unbalanced_ratio(response, load->n_time));
}
