// SPDX-License-Identifier: GPL-3.0-or-later
// The response so far as named arrays, and back, with checks of everything that the run
// relies on: ranges, ascending steps, ordered pairs, counts that add up.
//
// A list with "load_force" belongs to equilibria (saved_by_equilibria). Contacts of all
// snapshots stand one after the other, with how many are of each. Bridges are left out
// where there are none, and the ratio under the weight where it is NAN: NAN would be
// out of every range. Nothing read is used before it is checked, as a file may have
// been changed.
//
// With n grains, b bonds, t rows of the load, s snapshots so far, c contacts in these:
//     step, step_began (1)               the row on the way, its first cycle
//     unbalanced_ratio, cycles, cracks,
//     settled (t), reaction (t, 6)       all rows; those to come still 0
//     lateral_tension (t)                only where grains shrink or pores drain
//     crack_step (cracks of this replay) the cracks themselves are the engine's
//     weight_cracks (1), weight_unbalanced_ratio (1, or 0: NAN)
//     snapshot_step (s), _displacement and _force (s, n, 3), _intact (s, b)
//     snapshot_contacts (s)              how many of the c each has
//     contact_particle (c, 2), _bond, _overlap (c), _force, _position (c, 3)
//     contact_bridge (c, 2)              volume and force
//     snapshot_dryness (s, n)            only where pores drain
//     snapshot_shrinkage (s, n)          only where grains shrink
// save_load adds force (n, 3) and taken_off (6); save_loads makes load_force (rows, n,
// 3). Units are SI. Arrays have no shapes in the file, only lengths, so each is read
// with the length that it must have.
#include "replay_checkpoint.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Numbers beyond LARGEST are no state of a run. MOST_CYCLES is the last whole number
// before doubles have gaps.
static const double LARGEST = 1e150, MOST_CYCLES = 0x1p53;
static const char loads_name[] = "load_force", bridges_name[] = "contact_bridge",
                  dryness_name[] = "snapshot_dryness",
                  shrinkage_name[] = "snapshot_shrinkage";

// ---- out ----------------------------------------------------------------------------

// Only what observe fills in and the step; times follow from the load.
static void save_snapshots(struct array_list *list, const struct response *response,
                           const struct packing *packing)
{
    const size_t count = (size_t)response->n_snapshot;
    const size_t n = (size_t)packing->n_particle, n_bond = (size_t)packing->n_bond;
    int32_t *step = NEW_ARRAY(int32_t, count);
    struct vector *displacement = NEW_ARRAY(struct vector, count * n);
    struct vector *force = NEW_ARRAY(struct vector, count * n);
    uint8_t *intact = NEW_ARRAY(uint8_t, count * n_bond);
    for (size_t s = 0; s < count; s++) {
        const struct snapshot *snapshot = &response->snapshot[s];
        step[s] = snapshot->step;
        memcpy(displacement + s * n, snapshot->displacement, n * sizeof *displacement);
        memcpy(force + s * n, snapshot->force, n * sizeof *force);
        memcpy(intact + s * n_bond, snapshot->intact, n_bond);
    }
    const int64_t numbers = (int64_t)(3 * count * n);
    add_array(list, "snapshot_step", ARRAY_INT32, (int64_t)count, step);
    add_array(list, "snapshot_displacement", ARRAY_FLOAT64, numbers, displacement);
    add_array(list, "snapshot_force", ARRAY_FLOAT64, numbers, force);
    add_array(list, "snapshot_intact", ARRAY_UINT8, (int64_t)(count * n_bond), intact);
    free(step);
    free(displacement);
    free(force);
    free(intact);
}

double **snapshot_dryness(struct snapshot *snapshot)
{
    return &snapshot->dryness;
}

double **snapshot_shrinkage(struct snapshot *snapshot)
{
    return &snapshot->shrinkage;
}

double *join_numbers(const struct response *response, snapshot_numbers *of, int n)
{
    double *all = NEW_ARRAY(double, (size_t)response->n_snapshot *(size_t)n);
    for (int s = 0; s < response->n_snapshot; s++)
        memcpy(all + (size_t)s * (size_t)n, *of(&response->snapshot[s]),
               (size_t)n * sizeof *all);
    return all;
}

// Of all snapshots or of none.
static void save_numbers(struct array_list *list, const char *name,
                         snapshot_numbers *of, const struct response *response,
                         const struct packing *packing)
{
    const int n = packing->n_particle;
    if (response->n_snapshot == 0 || !*of(response->snapshot)) return;
    double *all = join_numbers(response, of, n);
    add_array(list, name, ARRAY_FLOAT64, (int64_t)response->n_snapshot * n, all);
    free(all);
}

// The contacts of all snapshots, one after the other.
static struct dem_contact *join_contacts(const struct response *response,
                                         int32_t *of_each, int *count)
{
    *count = 0;
    for (int s = 0; s < response->n_snapshot; s++)
        *count += of_each[s] = response->snapshot[s].n_contact;
    struct dem_contact *all = NEW_ARRAY(struct dem_contact, *count), *end = all;
    for (int s = 0; s < response->n_snapshot; s++) {
        const struct snapshot *snapshot = &response->snapshot[s];
        memcpy(end, snapshot->contact, (size_t)snapshot->n_contact * sizeof *all);
        end += snapshot->n_contact;
    }
    return all;
}

// Volume and force of the bridge of each contact; only where there are any.
static void save_bridges(struct array_list *list, const struct dem_contact *contact,
                         int n)
{
    double(*bridge)[2] = allocate((size_t)n, sizeof *bridge);
    bool any = false;
    for (int k = 0; k < n; k++) {
        bridge[k][0] = contact[k].bridge_volume;
        bridge[k][1] = contact[k].bridge_force;
        any = any || bridge[k][0] > 0;
    }
    if (any) add_array(list, bridges_name, ARRAY_FLOAT64, 2 * (int64_t)n, bridge);
    free(bridge);
}

static void save_contacts(struct array_list *list, const struct response *response)
{
    int n;
    int32_t *of_each = NEW_ARRAY(int32_t, response->n_snapshot);
    struct dem_contact *contact = join_contacts(response, of_each, &n);
    int32_t(*particle)[2] = allocate((size_t)n, sizeof *particle);
    int32_t *bond = NEW_ARRAY(int32_t, n);
    double *overlap = NEW_ARRAY(double, n);
    struct vector *force = NEW_ARRAY(struct vector, n);
    struct vector *position = NEW_ARRAY(struct vector, n);
    for (int k = 0; k < n; k++) {
        memcpy(particle[k], contact[k].particle, sizeof *particle);
        bond[k] = contact[k].bond;
        overlap[k] = contact[k].overlap;
        force[k] = contact[k].force;
        position[k] = contact[k].position;
    }
    add_array(list, "snapshot_contacts", ARRAY_INT32, response->n_snapshot, of_each);
    add_array(list, "contact_particle", ARRAY_INT32, 2 * (int64_t)n, particle);
    add_array(list, "contact_bond", ARRAY_INT32, n, bond);
    add_array(list, "contact_overlap", ARRAY_FLOAT64, n, overlap);
    add_array(list, "contact_force", ARRAY_FLOAT64, 3 * (int64_t)n, force);
    add_array(list, "contact_position", ARRAY_FLOAT64, 3 * (int64_t)n, position);
    save_bridges(list, contact, n);
    free(of_each);
    free(contact);
    free(particle);
    free(bond);
    free(overlap);
    free(force);
    free(position);
}

struct array_list save_response(const struct response *response,
                                const struct packing *packing, int n_time,
                                struct replay_place place)
{
    struct array_list list = {NULL, 0};
    add_array(&list, "step", ARRAY_INT64, 1, &(int64_t){place.step});
    add_array(&list, "step_began", ARRAY_INT64, 1, &place.began);
    add_array(&list, "unbalanced_ratio", ARRAY_FLOAT64, n_time,
              response->unbalanced_ratio);
    add_array(&list, "cycles", ARRAY_INT64, n_time, response->cycles);
    add_array(&list, "cracks", ARRAY_INT32, n_time, response->cracks);
    add_array(&list, "settled", ARRAY_UINT8, n_time, response->settled);
    add_array(&list, "reaction", ARRAY_FLOAT64, 6 * (int64_t)n_time,
              response->reaction);
    if (response->lateral_tension)
        add_array(&list, "lateral_tension", ARRAY_FLOAT64, n_time,
                  response->lateral_tension);
    add_array(&list, "crack_step", ARRAY_INT32, response->n_crack,
              response->crack_step);
    add_array(&list, "weight_cracks", ARRAY_INT32, 1,
              &(int32_t){response->n_weight_crack});
    add_array(&list, "weight_unbalanced_ratio", ARRAY_FLOAT64,
              !isnan(response->weight_unbalanced_ratio),
              &response->weight_unbalanced_ratio);
    save_snapshots(&list, response, packing);
    save_numbers(&list, dryness_name, snapshot_dryness, response, packing);
    save_numbers(&list, shrinkage_name, snapshot_shrinkage, response, packing);
    save_contacts(&list, response);
    return list;
}

void save_load(struct array_list *list, const struct vector *force, int n_particle,
               struct net_load taken_off)
{
    add_array(list, "force", ARRAY_FLOAT64, 3 * (int64_t)n_particle, force);
    add_array(list, "taken_off", ARRAY_FLOAT64, 6, &taken_off);
}

// Equilibria are found again from all loads so far, in their order: those of earlier
// replays, or the weight alone, then these.
struct array_list save_loads(const struct array_list *earlier,
                             const struct vector *weight, const struct load *load,
                             const struct packing *packing)
{
    const int64_t before = earlier  ? array_count(earlier, loads_name)
                           : weight ? 3 * (int64_t)packing->n_particle
                                    : 0;
    const int64_t each = 3 * (int64_t)packing->n_particle, now = each * load->n_time;
    double *all = NEW_ARRAY(double, before + now);
    const void *data = weight;
    if (earlier && before)
        data = find_array(earlier->array, earlier->count, loads_name)->data;
    if (before) memcpy(all, data, (size_t)before * sizeof *all);
    for (int k = 0; k < load->n_time; k++)
        memcpy(all + before + k * each, load->force(load->source, k),
               (size_t)each * sizeof *all);
    struct array_list list = {NULL, 0};
    add_array(&list, loads_name, ARRAY_FLOAT64, before + now, all);
    free(all);
    return list;
}

// ---- in -----------------------------------------------------------------------------

// The forces of the step on the way, with what was taken off already: they cannot be
// found again from the load alone, as loose grains depend on what has broken.
enum status restore_load(const struct array_list *list, int n_particle,
                         struct vector *force, struct net_load *taken_off,
                         struct reason *reason)
{
    struct array_reader reader = {.list = list, .reason = reason};
    const struct vector *applied = read_array(
        &reader, "force", ARRAY_FLOAT64, 3 * (int64_t)n_particle, -LARGEST, LARGEST);
    const struct net_load *off =
        read_array(&reader, "taken_off", ARRAY_FLOAT64, 6, -LARGEST, LARGEST);
    if (reader.failed) return STATUS_BAD_DATA;
    memcpy(force, applied, (size_t)n_particle * sizeof *force);
    *taken_off = *off;
    return STATUS_OK;
}

// The two engines keep different things, and each knows its own by this array.
bool saved_by_equilibria(const struct array_list *list)
{
    return find_array(list->array, list->count, loads_name) != NULL;
}

enum status refuse_other_engine(struct reason *reason, const char *name)
{
    return refuse(reason, STATUS_BAD_DATA,
                  "was kept by engine=%s, and only that engine can continue from it",
                  name);
}

const struct vector *saved_loads(const struct array_list *list,
                                 const struct packing *packing, int *n_load,
                                 struct reason *reason)
{
    struct array_reader reader = {.list = list, .reason = reason};
    const int64_t each = 3 * (int64_t)packing->n_particle;
    const int64_t most = each > 0 ? array_count(list, loads_name) / each : 0;
    *n_load = (int)(most > 1 ? most : 1);
    return read_array(&reader, loads_name, ARRAY_FLOAT64, *n_load * each, -LARGEST,
                      LARGEST);
}

// STEP is the load at work when the state was kept; BEGAN the cycle at which it began.
// All arrays have a number for each load, also for those to come.
static enum status restore_history(struct response *response, int first_step,
                                   int n_time, int64_t cycle,
                                   struct array_reader *reader,
                                   struct replay_place *place)
{
    const int64_t *step =
        read_array(reader, "step", ARRAY_INT64, 1, first_step, n_time - 1);
    const int64_t *began =
        read_array(reader, "step_began", ARRAY_INT64, 1, 0, (double)cycle);
    const double *ratio =
        read_array(reader, "unbalanced_ratio", ARRAY_FLOAT64, n_time, 0, LARGEST);
    const int64_t *cycles =
        read_array(reader, "cycles", ARRAY_INT64, n_time, 0, MOST_CYCLES);
    const int32_t *cracks =
        read_array(reader, "cracks", ARRAY_INT32, n_time, 0, INT32_MAX);
    const uint8_t *settled = read_array(reader, "settled", ARRAY_UINT8, n_time, 0, 1);
    const struct net_load *reaction = read_array(
        reader, "reaction", ARRAY_FLOAT64, 6 * (int64_t)n_time, -LARGEST, LARGEST);
    const double *tension = response->lateral_tension
                                ? read_array(reader, "lateral_tension", ARRAY_FLOAT64,
                                             n_time, -LARGEST, LARGEST)
                                : NULL;
    if (reader->failed) return STATUS_BAD_DATA;
    const size_t n = (size_t)n_time;
    *place = (struct replay_place){(int)*step, *began};
    memcpy(response->unbalanced_ratio, ratio, n * sizeof *ratio);
    memcpy(response->cycles, cycles, n * sizeof *cycles);
    memcpy(response->cracks, cracks, n * sizeof *cracks);
    memcpy(response->settled, settled, n * sizeof *settled);
    memcpy(response->reaction, reaction, n * sizeof *reaction);
    if (tension) memcpy(response->lateral_tension, tension, n * sizeof *tension);
    return STATUS_OK;
}

// An array of no numbers stands for NAN, which no file holds.
enum status restore_weight(struct response *response, int n_crack,
                           const struct array_list *list, struct reason *reason)
{
    struct array_reader reader = {.list = list, .reason = reason};
    const int64_t n_ratio = array_count(list, "weight_unbalanced_ratio");
    const int32_t *n = read_array(&reader, "weight_cracks", ARRAY_INT32, 1, 0, n_crack);
    const double *ratio = read_array(&reader, "weight_unbalanced_ratio", ARRAY_FLOAT64,
                                     n_ratio > 0, 0, LARGEST);
    if (reader.failed) return STATUS_BAD_DATA;
    response->n_weight_crack = *n;
    if (n_ratio > 0) response->weight_unbalanced_ratio = *ratio;
    return STATUS_OK;
}

// Whether N steps never fall.
static bool rises(const int32_t *step, int64_t n)
{
    for (int64_t k = 1; k < n; k++)
        if (step[k] < step[k - 1]) return false;
    return true;
}

// Cracks come from the engine; the steps of those of completed steps from the list.
static enum status restore_cracks(struct response *response, int n_time,
                                  const struct engine_past *past,
                                  struct array_reader *reader)
{
    const int64_t n = array_count(reader->list, "crack_step");
    const int32_t *step =
        read_array(reader, "crack_step", ARRAY_INT32, n, 0, n_time - 1);
    if (reader->failed) return STATUS_BAD_DATA;
    if (n > past->n_crack)
        return refuse(reader->reason, STATUS_BAD_DATA,
                      "crack_step: is longer than the cracks");
    if (!rises(step, n))
        return refuse(reader->reason, STATUS_BAD_DATA, "crack_step: must not fall");
    response->n_crack = (int)n;
    response->crack = duplicate(past->crack, (size_t)n, sizeof *past->crack);
    response->crack_step = duplicate(step, (size_t)n, sizeof *step);
    return STATUS_OK;
}

// Times and saturations are not kept: they are those of the loads.
static enum status restore_snapshots(struct response *response,
                                     const struct packing *packing,
                                     const struct load *load, int most,
                                     struct array_reader *reader)
{
    const int64_t count = array_count(reader->list, "snapshot_step");
    const size_t n = (size_t)packing->n_particle, n_bond = (size_t)packing->n_bond;
    if (count > most)
        return refuse(reader->reason, STATUS_BAD_DATA,
                      "snapshot_step: is longer than the parameters say");
    const int64_t numbers = 3 * count * packing->n_particle;
    const int32_t *step =
        read_array(reader, "snapshot_step", ARRAY_INT32, count, 0, load->n_time - 1);
    const struct vector *displacement = read_array(
        reader, "snapshot_displacement", ARRAY_FLOAT64, numbers, -LARGEST, LARGEST);
    const struct vector *force =
        read_array(reader, "snapshot_force", ARRAY_FLOAT64, numbers, -LARGEST, LARGEST);
    const uint8_t *intact = read_array(reader, "snapshot_intact", ARRAY_UINT8,
                                       count * packing->n_bond, 0, 1);
    if (reader->failed) return STATUS_BAD_DATA;
    if (!rises(step, count))
        return refuse(reader->reason, STATUS_BAD_DATA, "snapshot_step: must not fall");
    for (size_t s = 0; s < (size_t)count; s++)
        response->snapshot[response->n_snapshot++] = (struct snapshot){
            .step = step[s],
            .time = load->time[step[s]],
            .saturation = load->saturation[step[s]],
            .displacement = duplicate(displacement + s * n, n, sizeof *displacement),
            .force = duplicate(force + s * n, n, sizeof *force),
            .intact = duplicate(intact + s * n_bond, n_bond, 1)};
    return STATUS_OK;
}

// From 0 to 1.
static enum status restore_numbers(struct response *response, const char *name,
                                   snapshot_numbers *of, const struct packing *packing,
                                   struct array_reader *reader)
{
    const int64_t n = packing->n_particle;
    if (response->n_snapshot == 0) return STATUS_OK;
    const double *number =
        read_array(reader, name, ARRAY_FLOAT64, response->n_snapshot * n, 0, 1);
    if (!number) return STATUS_BAD_DATA;
    for (int s = 0; s < response->n_snapshot; s++)
        *of(&response->snapshot[s]) =
            duplicate(number + s * n, (size_t)n, sizeof *number);
    return STATUS_OK;
}

// The first row that is neither two grains, the lower first, nor a grain and a wall; N
// if all are.
static int64_t first_unordered(const int32_t (*particle)[2], int64_t n)
{
    int64_t k = 0;
    while (k < n && particle[k][0] >= 0 &&
           (particle[k][1] < 0 || particle[k][0] < particle[k][1]))
        k++;
    return k;
}

// The contacts of all snapshots, N of them; NULL with the reason. Every index is
// checked before it is used: a damaged file must not lead outside of an array.
static struct dem_contact *read_contacts(const struct packing *packing, int64_t n,
                                         struct array_reader *reader)
{
    const int walls = 1; // at most
    const int32_t(*particle)[2] = read_array(reader, "contact_particle", ARRAY_INT32,
                                             2 * n, -walls, packing->n_particle - 1);
    const int32_t *bond =
        read_array(reader, "contact_bond", ARRAY_INT32, n, -1, packing->n_bond - 1);
    const double *overlap =
        read_array(reader, "contact_overlap", ARRAY_FLOAT64, n, -LARGEST, LARGEST);
    const struct vector *force =
        read_array(reader, "contact_force", ARRAY_FLOAT64, 3 * n, -LARGEST, LARGEST);
    const struct vector *position =
        read_array(reader, "contact_position", ARRAY_FLOAT64, 3 * n, -LARGEST, LARGEST);
    const bool wet = array_count(reader->list, bridges_name) > 0;
    const double(*bridge)[2] =
        wet ? read_array(reader, bridges_name, ARRAY_FLOAT64, 2 * n, -LARGEST, LARGEST)
            : NULL;
    if (reader->failed) return NULL;
    const int64_t odd = first_unordered(particle, n);
    if (odd < n) {
        refuse(
            reader->reason, STATUS_BAD_DATA,
            "contact_particle: row %lld: the lower index must come first, got %d, %d",
            (long long)odd, particle[odd][0], particle[odd][1]);
        return NULL;
    }
    struct dem_contact *contact = NEW_ARRAY(struct dem_contact, n);
    for (int64_t k = 0; k < n; k++)
        contact[k] = (struct dem_contact){.particle = {particle[k][0], particle[k][1]},
                                          .bond = bond[k],
                                          .overlap = overlap[k],
                                          .force = force[k],
                                          .position = position[k],
                                          .bridge_volume = wet ? bridge[k][0] : 0,
                                          .bridge_force = wet ? bridge[k][1] : 0};
    return contact;
}

// Contacts of all snapshots lie one behind the other; OF_EACH says how many each has.
static enum status restore_contacts(struct response *response,
                                    const struct packing *packing,
                                    struct array_reader *reader)
{
    const int64_t n = array_count(reader->list, "contact_bond");
    const int32_t *of_each = read_array(reader, "snapshot_contacts", ARRAY_INT32,
                                        response->n_snapshot, 0, (double)n);
    struct dem_contact *contact = read_contacts(packing, n, reader);
    if (!contact) return STATUS_BAD_DATA;
    int64_t sum = 0;
    for (int s = 0; s < response->n_snapshot && sum + of_each[s] <= n; s++) {
        struct snapshot *snapshot = &response->snapshot[s];
        snapshot->n_contact = of_each[s];
        snapshot->contact =
            duplicate(contact + sum, (size_t)of_each[s], sizeof *contact);
        sum += of_each[s];
    }
    free(contact);
    if (sum == n) return STATUS_OK;
    return refuse(reader->reason, STATUS_BAD_DATA,
                  "snapshot_contacts: must come to %lld, come to %lld", (long long)n,
                  (long long)sum);
}

// In this order because each needs the one before: loads for the steps of cracks,
// snapshots for their contacts.
enum status restore_response(struct response *response, const struct packing *packing,
                             const struct load *load, int most_snapshots,
                             const struct engine_past *past,
                             const struct array_list *list, struct replay_place *place,
                             struct reason *reason)
{
    struct array_reader reader = {.list = list, .reason = reason};
    enum status status = restore_history(response, past->first_step, load->n_time,
                                         past->cycle, &reader, place);
    if (status == STATUS_OK)
        status = restore_cracks(response, load->n_time, past, &reader);
    if (status == STATUS_OK)
        status = restore_snapshots(response, packing, load, most_snapshots, &reader);
    if (status == STATUS_OK && load->drains)
        status =
            restore_numbers(response, dryness_name, snapshot_dryness, packing, &reader);
    if (status == STATUS_OK && load->shrinks)
        status = restore_numbers(response, shrinkage_name, snapshot_shrinkage, packing,
                                 &reader);
    if (status == STATUS_OK) status = restore_contacts(response, packing, &reader);
    return status;
}
