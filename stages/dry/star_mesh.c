// SPDX-License-Identifier: GPL-3.0-or-later
#include "star_mesh.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct tile_link {
    int tile, block;
};

struct tile {
    int next_in_region; // -1: the last
    int n_used;
    int n_link, capacity;
    struct tile_link *link; // to itself too
};

// The site that is eliminated: its conductances to the lanes of each tile beside it.
struct star {
    int n, capacity;
    struct arm {
        int tile;
        double sum;
        double conductance[TILE_LANES];
    } * arm;
};

struct star_mesh star_mesh_make(int n_site, int n_region, const int *region)
{
    struct star_mesh mesh = {.n_site = n_site,
                             .region = region,
                             .slot = NEW_ARRAY(int, n_site),
                             .first_tile = NEW_ARRAY(int, n_region),
                             .star = NEW_ARRAY(struct star, 1)};
    for (int i = 0; i < n_site; i++)
        mesh.slot[i] = -1;
    for (int r = 0; r < n_region; r++)
        mesh.first_tile[r] = -1;
    return mesh;
}

void star_mesh_free(struct star_mesh *mesh)
{
    for (int t = 0; t < mesh->n_tile; t++)
        free(mesh->tile[t].link);
    if (mesh->star) free(mesh->star->arm);
    free(mesh->star);
    free(mesh->slot);
    free(mesh->tile);
    free(mesh->air);
    free(mesh->site);
    free(mesh->first_tile);
    free(mesh->place);
    free(mesh->met);
    free(mesh->block);
    free(mesh->unused_block);
    free(mesh->changed);
    *mesh = (struct star_mesh){0};
}

// --- tiles and blocks --------------------------------------------------------------

static int add_tile(struct star_mesh *mesh, int region)
{
    if (mesh->n_tile == mesh->tile_capacity) {
        const int capacity = mesh->tile_capacity ? 2 * mesh->tile_capacity : 64;
        const size_t n = (size_t)capacity;
        mesh->tile = reallocate(mesh->tile, n, sizeof *mesh->tile);
        mesh->air = reallocate(mesh->air, n, TILE_LANES * sizeof *mesh->air);
        mesh->site = reallocate(mesh->site, n, TILE_LANES * sizeof *mesh->site);
        mesh->place = reallocate(mesh->place, n, sizeof *mesh->place);
        mesh->met = reallocate(mesh->met, n, sizeof *mesh->met);
        mesh->tile_capacity = capacity;
    }
    const int tile = mesh->n_tile++;
    mesh->tile[tile] = (struct tile){.next_in_region = mesh->first_tile[region]};
    mesh->first_tile[region] = tile;
    mesh->place[tile] = mesh->met[tile] = -1;
    for (int lane = 0; lane < TILE_LANES; lane++) {
        mesh->air[tile * TILE_LANES + lane] = 0;
        mesh->site[tile * TILE_LANES + lane] = -1;
    }
    return tile;
}

// The slot of SITE, a new one if it has none.
static int enter(struct star_mesh *mesh, int site)
{
    if (mesh->slot[site] >= 0) return mesh->slot[site];
    int tile = mesh->first_tile[mesh->region[site]];
    while (tile >= 0 && mesh->tile[tile].n_used == TILE_LANES)
        tile = mesh->tile[tile].next_in_region;
    if (tile < 0) tile = add_tile(mesh, mesh->region[site]);
    int slot = tile * TILE_LANES;
    while (mesh->site[slot] >= 0)
        slot++;
    mesh->site[slot] = site;
    mesh->air[slot] = 0;
    mesh->tile[tile].n_used++;
    return mesh->slot[site] = slot;
}

static void add_tile_link(struct tile *tile, int other, int block)
{
    GROW_ARRAY(tile->link, tile->n_link, tile->capacity);
    tile->link[tile->n_link++] = (struct tile_link){other, block};
}

static int add_block(struct star_mesh *mesh, int a, int b)
{
    int block;
    if (mesh->n_unused > 0) {
        block = mesh->unused_block[--mesh->n_unused];
    } else {
        GROW_ARRAY(mesh->block, mesh->n_block, mesh->block_capacity);
        block = mesh->n_block++;
    }
    memset(mesh->block[block], 0, sizeof mesh->block[block]);
    add_tile_link(&mesh->tile[a], b, block);
    if (a != b) add_tile_link(&mesh->tile[b], a, block);
    return block;
}

static int find_block(const struct star_mesh *mesh, int a, int b)
{
    if (mesh->tile[a].n_link > mesh->tile[b].n_link) {
        const int swap = a;
        a = b;
        b = swap;
    }
    for (int k = 0; k < mesh->tile[a].n_link; k++)
        if (mesh->tile[a].link[k].tile == b) return mesh->tile[a].link[k].block;
    return -1;
}

static void remove_tile_link(struct tile *tile, int other)
{
    int k = 0;
    while (tile->link[k].tile != other)
        k++;
    tile->link[k] = tile->link[--tile->n_link];
}

static bool is_zero(const double *block)
{
    double sum = 0;
    for (int k = 0; k < TILE_LANES * TILE_LANES; k++)
        sum += block[k];
    return sum == 0;
}

void star_mesh_link(struct star_mesh *mesh, int a, int b, double conductance)
{
    int i = enter(mesh, a), j = enter(mesh, b);
    if (i < j) {
        const int swap = i;
        i = j;
        j = swap;
    }
    const int high = i / TILE_LANES, low = j / TILE_LANES;
    int block = find_block(mesh, high, low);
    if (block < 0) block = add_block(mesh, high, low);
    double *entry = mesh->block[block];
    entry[i % TILE_LANES * TILE_LANES + j % TILE_LANES] += conductance;
    if (high == low) entry[j % TILE_LANES * TILE_LANES + i % TILE_LANES] += conductance;
}

static void change_air(struct star_mesh *mesh, int slot, double air)
{
    compensated_add(&mesh->all_air, air);
    compensated_add(&mesh->all_air, -mesh->air[slot]);
    mesh->air[slot] = air;
}

void star_mesh_link_air(struct star_mesh *mesh, int site, double conductance)
{
    const int slot = enter(mesh, site); // may move the array
    change_air(mesh, slot, mesh->air[slot] + conductance);
}

double star_mesh_air(const struct star_mesh *mesh, int site)
{
    return mesh->slot[site] < 0 ? 0 : mesh->air[mesh->slot[site]];
}

// --- elimination -------------------------------------------------------------------

// Takes the conductances of SLOT out of the mesh into the star. Returns their sum.
static double take_out(struct star_mesh *mesh, int slot)
{
    const int tile = slot / TILE_LANES, lane = slot % TILE_LANES;
    struct tile *here = &mesh->tile[tile];
    struct star *star = mesh->star;
    double total = 0;
    star->n = 0;
    for (int k = 0; k < here->n_link;) {
        const int other = here->link[k].tile, block = here->link[k].block;
        double *entry = mesh->block[block];
        GROW_ARRAY(star->arm, star->n, star->capacity);
        struct arm *arm = &star->arm[star->n];
        const bool by_row = tile >= other;
        double *first = by_row ? entry + TILE_LANES * lane : entry + lane;
        const int stride = by_row ? 1 : TILE_LANES;
        arm->sum = 0;
        for (int l = 0; l < TILE_LANES; l++) {
            arm->conductance[l] = first[l * stride];
            arm->sum += arm->conductance[l];
            first[l * stride] = 0;
            if (other == tile) entry[TILE_LANES * l + lane] = 0;
        }
        if (arm->sum > 0) {
            arm->tile = other;
            total += arm->sum;
            mesh->place[other] = star->n++;
        }
        if (!is_zero(entry)) {
            k++;
            continue;
        }
        GROW_ARRAY(mesh->unused_block, mesh->n_unused, mesh->unused_capacity);
        mesh->unused_block[mesh->n_unused++] = block;
        if (other != tile) remove_tile_link(&mesh->tile[other], tile);
        here->link[k] = here->link[--here->n_link];
    }
    return total;
}

// Adds the mesh between two arms to a block.
static void add_mesh(double *restrict block, const double *restrict high,
                     const double *restrict low, double factor)
{
    for (int r = 0; r < TILE_LANES; r++) {
        const double share = high[r] * factor;
        for (int c = 0; c < TILE_LANES; c++)
            block[TILE_LANES * r + c] += share * low[c];
    }
}

static void add_mesh_within(double *block, const double *arm, double factor)
{
    add_mesh(block, arm, arm, factor);
    for (int l = 0; l < TILE_LANES; l++)
        block[(TILE_LANES + 1) * l] = 0;
}

static void add_mesh_between(struct star_mesh *mesh, int block, const struct arm *high,
                             const struct arm *low, double factor)
{
    if (high == low)
        add_mesh_within(mesh->block[block], high->conductance, factor);
    else
        add_mesh(mesh->block[block], high->conductance, low->conductance, factor);
}

// Links the lanes of arm A with those of all arms whose tiles are not numbered higher.
static void spread_arm(struct star_mesh *mesh, int a, double factor)
{
    const struct star *star = mesh->star;
    const struct arm *high = &star->arm[a];
    const double enough = mesh->drop / (high->sum * factor);
    const struct tile *tile = &mesh->tile[high->tile];
    const int n_link = tile->n_link;
    for (int k = 0; k < n_link; k++) {
        const int other = tile->link[k].tile;
        if (other > high->tile || mesh->place[other] < 0) continue;
        mesh->met[other] = a;
        const struct arm *low = &star->arm[mesh->place[other]];
        if (low->sum >= enough)
            add_mesh_between(mesh, tile->link[k].block, high, low, factor);
        else
            mesh->dropped += high->sum * factor * low->sum;
    }
    for (int k = 0; k < star->n; k++) {
        const struct arm *low = &star->arm[k];
        if (low->tile > high->tile || mesh->met[low->tile] == a) continue;
        if (low->sum >= enough)
            add_mesh_between(mesh, add_block(mesh, high->tile, low->tile), high, low,
                             factor);
        else
            mesh->dropped += high->sum * factor * low->sum;
    }
}

// What flowed from the eliminated site flows on to its neighbours.
static void raise_air(struct star_mesh *mesh, double air)
{
    const struct star *star = mesh->star;
    for (int a = 0; a < star->n; a++)
        for (int l = 0; l < TILE_LANES; l++) {
            const int slot = star->arm[a].tile * TILE_LANES + l;
            if (!(star->arm[a].conductance[l] > 0)) continue;
            change_air(mesh, slot, mesh->air[slot] + star->arm[a].conductance[l] * air);
            GROW_ARRAY(mesh->changed, mesh->n_changed, mesh->changed_capacity);
            mesh->changed[mesh->n_changed++] = mesh->site[slot];
        }
}

void star_mesh_eliminate(struct star_mesh *mesh, int site)
{
    mesh->n_changed = 0;
    const int slot = mesh->slot[site];
    if (slot < 0) return;
    const double air = mesh->air[slot];
    const double total = take_out(mesh, slot) + air;
    mesh->tile[slot / TILE_LANES].n_used--;
    mesh->site[slot] = mesh->slot[site] = -1;
    change_air(mesh, slot, 0);
    const struct star *star = mesh->star;
    if (total > 0) {
        for (int a = 0; a < star->n; a++)
            spread_arm(mesh, a, 1 / total);
        if (air > 0) raise_air(mesh, air / total);
    }
    for (int a = 0; a < star->n; a++)
        mesh->place[star->arm[a].tile] = mesh->met[star->arm[a].tile] = -1;
}
