// SPDX-License-Identifier: GPL-3.0-or-later
// What a node that dries changes near it. Its evaporation becomes its residual, and
// goes on (relaxation, Gauss-Southwell) as long as much is on its way at one site:
//     up = residual_i / diagonal_i,  phi_i += up,  residual_i = 0,
//     conductance_ij up  is added to the residual of a neighbour j in the gas, or to
//                        what a wet neighbour evaporates.
// Only positive numbers are added.
#include "kept_vapour.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// Of what a wet site evaporates on average, so much may stay on its way at one site.
static const double MUCH = 0.1;

// What a node that dries lets pass on, at most. Where conductances differ by many
// orders of magnitude it would go to and fro between two sites for ever.
enum { MOST_PASSED_ON = 20000 };

static void all_out_of_gas(struct kept_vapour *kept)
{
    for (int i = 0; i < kept->links.n; i++)
        kept->row[i] = -1;
    kept->n_row = 0;
}

static void enter_gas(struct kept_vapour *kept, int site)
{
    const struct conductance_matrix *links = &kept->links;
    kept->row[site] = kept->n_row;
    kept->row_site[kept->n_row++] = site;
    links->diagonal[site] = 0;
    for (int k = links->offset[site]; k < links->offset[site + 1]; k++)
        if (links->value[k] > 0) links->diagonal[site] += links->value[k];
}

// As large as all sites in the gas need.
static struct conductance_matrix
room_for_balances(const struct conductance_matrix *links)
{
    const int n = links->n, room = links->offset[n];
    return (struct conductance_matrix){.n_all = 2 * n + 1,
                                       .offset = NEW_ARRAY(int, n + 1),
                                       .column = NEW_ARRAY(int, room),
                                       .value = NEW_ARRAY(double, room),
                                       .diagonal = NEW_ARRAY(double, n)};
}

static void list_beside_air(struct kept_vapour *kept)
{
    const struct conductance_matrix *links = &kept->links;
    kept->beside_air = NEW_ARRAY(int, links->n);
    for (int i = 0; i < links->n; i++) {
        bool is_beside = false;
        for (int k = links->offset[i]; k < links->offset[i + 1]; k++)
            is_beside |= links->column[k] == links->n;
        if (is_beside) kept->beside_air[kept->n_beside_air++] = i;
    }
}

struct kept_vapour *kept_vapour_create(int n_wet, int n_site, int n_link, int n_open,
                                       const struct link *link, int *order, double step)
{
    struct kept_vapour *kept = NEW_ARRAY(struct kept_vapour, 1);
    *kept = (struct kept_vapour){
        .step = step,
        .air = air_links_init(n_site),
        .links = conductance_matrix_of_links(n_site, n_site + 1, n_link, link),
        .level = NEW_ARRAY(struct compensated, n_site),
        .residual = NEW_ARRAY(double, n_site),
        .reaches_wet = 1,
        .row_site = NEW_ARRAY(int, n_site),
        .row = NEW_ARRAY(int, n_site),
        .order = order,
        .dried = NEW_ARRAY(int, n_site),
        .gain_site = NEW_ARRAY(int, n_site),
        .gain = NEW_ARRAY(double, n_site),
        .queue = NEW_ARRAY(int, n_site),
        .is_queued = NEW_ARRAY(bool, n_site)};
    struct conductance_matrix *links = &kept->links;
    kept->balances = room_for_balances(links);
    list_beside_air(kept);
    for (int k = 0; k < links->offset[n_site]; k++)
        links->value[k] *= -1;
    for (int l = 0; l < n_open; l++)
        kept_vapour_open(kept, link[l].site[0], link[l].site[1], link[l].conductance);
    all_out_of_gas(kept);
    for (int i = n_wet; i < n_site; i++)
        enter_gas(kept, i);
    kept_vapour_solve(kept);
    return kept;
}

void kept_vapour_free(struct kept_vapour *kept)
{
    if (!kept) return;
    air_links_free(&kept->air);
    conductance_matrix_free(&kept->links);
    conductance_matrix_free(&kept->balances);
    gas_preconditioner_free(kept->preconditioner);
    free(kept->beside_air);
    free(kept->level);
    free(kept->residual);
    free(kept->row_site);
    free(kept->row);
    free(kept->order);
    free(kept->dried);
    free(kept->gain_site);
    free(kept->gain);
    free(kept->queue);
    free(kept->is_queued);
    free(kept);
}

// Parallel throats of one conductance are opened one after the other.
static void open_from(struct kept_vapour *kept, int from, int to, double conductance)
{
    const struct conductance_matrix *links = &kept->links;
    if (from >= links->n) return;
    int k = links->offset[from];
    while (links->column[k] != to || links->value[k] != -conductance)
        k++;
    links->value[k] = conductance;
}

void kept_vapour_open(struct kept_vapour *kept, int a, int b, double conductance)
{
    open_from(kept, a, b, conductance);
    open_from(kept, b, a, conductance);
}

void kept_vapour_dry(struct kept_vapour *kept, int site)
{
    kept->dried[kept->n_dried++] = site;
}

// --- relaxation --------------------------------------------------------------------

static void enqueue(struct kept_vapour *kept, int site)
{
    if (kept->is_queued[site]) return;
    kept->is_queued[site] = true;
    const int place = kept->queue_head + kept->n_queue++;
    kept->queue[place < kept->links.n ? place : place - kept->links.n] = site;
}

static int dequeue(struct kept_vapour *kept)
{
    const int site = kept->queue[kept->queue_head++];
    if (kept->queue_head == kept->links.n) kept->queue_head = 0;
    kept->n_queue--;
    kept->is_queued[site] = false;
    return site;
}

static void evaporate_more(struct kept_vapour *kept, int site, double flow)
{
    if (kept->gain[site] == 0) kept->gain_site[kept->n_gain++] = site;
    kept->gain[site] += flow;
    air_links_link(&kept->air, site, flow);
}

static void pass_on(struct kept_vapour *kept, int site, double much)
{
    const struct conductance_matrix *links = &kept->links;
    const double up = kept->residual[site] / links->diagonal[site];
    compensated_add(&kept->level[site], up);
    kept->residual[site] = 0;
    for (int k = links->offset[site]; k < links->offset[site + 1]; k++) {
        const double flow = links->value[k] * up;
        const int other = links->column[k];
        if (!(flow > 0)) continue;
        if (is_in_gas(kept, other)) {
            kept->residual[other] += flow;
            if (kept->residual[other] > much) enqueue(kept, other);
            continue;
        }
        kept->on_its_way -= flow;
        if (other < links->n) evaporate_more(kept, other, flow);
    }
}

static void let_dry(struct kept_vapour *kept, int site)
{
    const double evaporation = air_links_take(&kept->air, site);
    air_links_lower(&kept->air, evaporation);
    enter_gas(kept, site);
    kept->residual[site] = evaporation;
    kept->on_its_way += evaporation;
    if (!(evaporation > 0)) return;
    const struct air_links *air = &kept->air;
    const double much = MUCH * compensated_value(air->all) / (air->n - air->n_unused);
    enqueue(kept, site);
    for (int passed_on = 0; kept->n_queue > 0; passed_on++) {
        const int next = dequeue(kept);
        if (passed_on < MOST_PASSED_ON) pass_on(kept, next, much);
    }
}

bool kept_vapour_follow(struct kept_vapour *kept)
{
    for (int k = 0; k < kept->n_gain; k++)
        kept->gain[kept->gain_site[k]] = 0;
    kept->n_gain = 0;
    for (int k = 0; k < kept->n_dried; k++)
        let_dry(kept, kept->dried[k]);
    kept->n_dried = 0;
    const double evaporation = compensated_value(kept->air.all);
    if (!(kept_vapour_error(kept) > kept->step * evaporation)) return false;
    kept_vapour_solve(kept);
    return true;
}

double kept_vapour_pace(const struct kept_vapour *kept)
{
    const double evaporation = compensated_value(kept->air.all);
    if (!(evaporation > 0 && kept->on_its_way > 0)) return 1;
    return 1 + kept->reaches_wet * kept->on_its_way / evaporation;
}

// --- state -------------------------------------------------------------------------

bool kept_vapour_may_be_kept(const struct kept_vapour *kept)
{
    return !kept->preconditioner;
}

// Sites enter the gas again in their order, once the links between them are open.
void kept_vapour_state(struct kept_vapour *kept, struct checkpoint_stream *stream)
{
    struct conductance_matrix *links = &kept->links;
    const int n = links->n, n_value = links->offset[n];
    bool *is_open = NEW_ARRAY(bool, n_value);
    for (int k = 0; k < n_value; k++)
        is_open[k] = links->value[k] > 0;
    stream_flags(stream, is_open, n_value);
    for (int k = 0; k < n_value; k++)
        links->value[k] = is_open[k] ? fabs(links->value[k]) : -fabs(links->value[k]);
    free(is_open);
    stream_integer(stream, &kept->n_row, 0, n);
    stream_integers(stream, kept->row_site, kept->n_row, 0, n - 1);
    if (stream->restoring) {
        const int n_row = kept->n_row;
        all_out_of_gas(kept);
        kept->n_dried = 0;
        for (int r = 0; r < n_row; r++)
            enter_gas(kept, kept->row_site[r]);
        gas_preconditioner_free(kept->preconditioner);
        kept->preconditioner = NULL;
    }
    stream_sums(stream, kept->level, n);
    stream_numbers(stream, kept->residual, n);
    stream_numbers(stream, &kept->on_its_way, 1);
    stream_numbers(stream, &kept->below_zero, 1);
    stream_numbers(stream, &kept->reaches_wet, 1);
    air_links_state(&kept->air, stream);
}

bool kept_vapour_fits(const struct kept_vapour *kept)
{
    int n_gas = 0;
    for (int i = 0; i < kept->links.n; i++) {
        n_gas += is_in_gas(kept, i);
        if (!(air_links_of(&kept->air, i) >= 0) ||
            !(compensated_value(kept->level[i]) >= 0) || !isfinite(kept->residual[i]))
            return false;
    }
    return n_gas == kept->n_row && kept->on_its_way >= -kept->below_zero &&
           kept->below_zero >= 0 && kept->reaches_wet >= 0 && kept->reaches_wet <= 1;
}
