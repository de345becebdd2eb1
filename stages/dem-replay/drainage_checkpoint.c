// SPDX-License-Identifier: GPL-3.0-or-later
// With p pores, n grains, t rows of the load:
//     pore_gas (p)             which hold gas; menisci follow from them
//     drainage_volume (4)      drained and target, m3; suctions it changes between, Pa
//     drainage_cycle (4)       since, until, round_began, entered
//     drainage_count (2)       pores with gas, and distorted ones
//     drainage_history (3, t)  suction, liquid, drained
//     drainage_pores (2, t)    gas_pores, distorted
//     load_saturation (t), load_dryness (t, n; empty where nothing shrinks)
// What a pore held at first is found again from the packing.
#include "drainage_checkpoint.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

static const double LARGEST = 1e150, MOST_CYCLES = 0x1p53;

enum { N_NUMBER = 3, N_COUNT = 2 };

static void columns_of(struct drainage_history *history, double *number[N_NUMBER],
                       int32_t *count[N_COUNT])
{
    number[0] = history->suction;
    number[1] = history->liquid;
    number[2] = history->drained;
    count[0] = history->gas_pores;
    count[1] = history->distorted;
}

static void save_history(struct array_list *list, struct drainage_history history,
                         size_t n)
{
    double *number[N_NUMBER], *numbers = NEW_ARRAY(double, N_NUMBER *n);
    int32_t *count[N_COUNT], *counts = NEW_ARRAY(int32_t, N_COUNT * n);
    columns_of(&history, number, count);
    for (size_t k = 0; k < N_NUMBER; k++)
        memcpy(numbers + k * n, number[k], n * sizeof *numbers);
    for (size_t k = 0; k < N_COUNT; k++)
        memcpy(counts + k * n, count[k], n * sizeof *counts);
    add_array(list, "drainage_history", ARRAY_FLOAT64, (int64_t)(N_NUMBER * n),
              numbers);
    add_array(list, "drainage_pores", ARRAY_INT32, (int64_t)(N_COUNT * n), counts);
    free(numbers);
    free(counts);
}

void save_drainage(struct array_list *list, const struct drainage *drainage,
                   const struct drainage_history *history, const struct load *load,
                   int n_particle)
{
    const int n = drainage->liquid.n;
    uint8_t *gas = NEW_ARRAY(uint8_t, n);
    for (int p = 0; p < n; p++)
        gas[p] = drainage->liquid.pore[p].has_gas;
    add_array(list, "pore_gas", ARRAY_UINT8, n, gas);
    free(gas);
    add_array(list, "drainage_volume", ARRAY_FLOAT64, 4,
              (const double[]){drainage->drained, drainage->target, drainage->from,
                               drainage->to});
    add_array(list, "drainage_cycle", ARRAY_INT64, 4,
              (const int64_t[]){drainage->since, drainage->until, drainage->round_began,
                                drainage->entered});
    add_array(list, "drainage_count", ARRAY_INT32, 2,
              (const int32_t[]){drainage->n_gas, drainage->n_distorted});
    save_history(list, *history, (size_t)load->n_time);
    add_array(list, "load_saturation", ARRAY_FLOAT64, load->n_time, load->saturation);
    add_array(list, "load_dryness", ARRAY_FLOAT64,
              load->drained ? (int64_t)load->n_time * n_particle : 0, load->drained);
}

static void take_history(struct drainage_history *history, const double *numbers,
                         const int32_t *counts, size_t n)
{
    double *number[N_NUMBER];
    int32_t *count[N_COUNT];
    columns_of(history, number, count);
    for (size_t k = 0; k < N_NUMBER; k++)
        memcpy(number[k], numbers + k * n, n * sizeof *numbers);
    for (size_t k = 0; k < N_COUNT; k++)
        memcpy(count[k], counts + k * n, n * sizeof *counts);
}

static void take_state(struct drainage *drainage, const uint8_t *gas,
                       const double *volume, const int64_t *cycle, const int32_t *count)
{
    for (int p = 0; p < drainage->liquid.n; p++)
        drainage->liquid.pore[p].has_gas = gas[p];
    find_menisci(&drainage->liquid);
    drainage->drained = volume[0];
    drainage->target = volume[1];
    drainage->from = volume[2];
    drainage->to = volume[3];
    drainage->since = cycle[0];
    drainage->until = cycle[1];
    drainage->round_began = cycle[2];
    drainage->entered = cycle[3];
    drainage->n_gas = count[0];
    drainage->n_distorted = count[1];
}

enum status restore_drainage(const struct array_list *list, struct drainage *drainage,
                             struct drainage_history *history, const struct load *load,
                             int n_particle, struct reason *reason)
{
    const int n = drainage->liquid.n;
    const int64_t rows = load->n_time, n_dry = load->drained ? rows * n_particle : 0;
    struct array_reader from = {.list = list, .reason = reason};
    const uint8_t *gas = read_array(&from, "pore_gas", ARRAY_UINT8, n, 0, 1);
    const double *volume =
        read_array(&from, "drainage_volume", ARRAY_FLOAT64, 4, -LARGEST, LARGEST);
    const int64_t *cycle =
        read_array(&from, "drainage_cycle", ARRAY_INT64, 4, 0, MOST_CYCLES);
    const int32_t *count = read_array(&from, "drainage_count", ARRAY_INT32, 2, 0, n);
    const double *numbers = read_array(&from, "drainage_history", ARRAY_FLOAT64,
                                       N_NUMBER * rows, -LARGEST, LARGEST);
    const int32_t *counts =
        read_array(&from, "drainage_pores", ARRAY_INT32, N_COUNT * rows, 0, n);
    const double *saturation =
        read_array(&from, "load_saturation", ARRAY_FLOAT64, rows, 0, 1);
    const double *dryness =
        read_array(&from, "load_dryness", ARRAY_FLOAT64, n_dry, 0, 1);
    if (from.failed) return STATUS_BAD_DATA;
    take_state(drainage, gas, volume, cycle, count);
    take_history(history, numbers, counts, (size_t)rows);
    memcpy(load->saturation, saturation, (size_t)rows * sizeof *saturation);
    if (n_dry) memcpy(load->drained, dryness, (size_t)n_dry * sizeof *dryness);
    return STATUS_OK;
}
