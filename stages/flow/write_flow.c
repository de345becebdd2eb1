// SPDX-License-Identifier: GPL-3.0-or-later
// The results in SI units. Lengths are times unit; forces (Pa unit^2) times unit^2;
// fluxes and conductances, computed for a viscosity of 1, times unit^3 / viscosity.
// Buoyancy [C 12] is minus the weight of the fluid that a grain displaces. Trap:
// several cells can be one pore; what belongs to the pore (source, volume) stands at
// its first cell and is 0 at the others, so that sums over rows are right.
#include "write_flow.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

// Force of the weight of the fluid on grain I [C 12]: what a sphere of fluid weighs, N.
static struct vector buoyancy(const struct flow *flow, int i)
{
    const double radius = flow->packing->radius[i];
    return scale(-4 * M_PI / 3 * radius * radius * radius, flow->weight);
}

// From Pa unit^2.
static struct vector newtons(const struct flow *flow, struct vector force)
{
    return scale(flow->grains->unit * flow->grains->unit, force);
}

// Everything on grain I, N [C 19].
static struct vector total_force(const struct flow *flow, int i)
{
    return add(newtons(flow, add(flow->forces->viscous[i], flow->forces->pressure[i])),
               buoyancy(flow, i));
}

static double cube(double x)
{
    return x * x * x;
}

// Cells of one pore share its pressure. Pores come in the order of their first cells:
// `next` is the first that was not met.
static void put_pores(struct artifact *artifact, const struct flow *flow)
{
    const struct cells *cells = flow->cells;
    const int n = cells->n;
    struct vector *position = NEW_ARRAY(struct vector, n);
    int32_t(*corner)[4] = allocate((size_t)n, sizeof *corner);
    double *value = NEW_ARRAY(double, n);
    for (int c = 0; c < n; c++) {
        position[c] =
            add(flow->packing->lower, scale(flow->grains->unit, cells->cell[c].centre));
        memcpy(corner[c], cells->cell[c].corner, sizeof *corner);
        value[c] = pore_pressure(flow->pressures, cells, c);
    }
    artifact_put(artifact, "/pores/position", position, n);
    artifact_put(artifact, "/pores/particles", corner, n);
    artifact_put(artifact, "/pores/pressure", value, n);
    // Where several cells are one pore, its outflow is stored at the first.
    for (int c = 0, next = 0; c < n && flow->opening; c++) {
        const int pore = cells->cell[c].pore;
        value[c] = pore == next ? -flow->opening[pore] * cube(flow->grains->unit) : 0;
        next += pore == next;
    }
    if (flow->opening) artifact_put(artifact, "/pores/source", value, n);
    free(position);
    free(corner);
    free(value);
}

// Less the pressure. Row and column of the six numbers of a symmetric tensor, diagonal
// first. Tension is positive here: the pressure is subtracted.
static void put_together(double stress[3][3], const double viscous[6], double pressure)
{
    static const int row[6] = {0, 1, 2, 1, 2, 0}, column[6] = {0, 1, 2, 2, 0, 1};
    for (int k = 0; k < 6; k++)
        stress[row[k]][column[k]] = stress[column[k]][row[k]] =
            viscous[k] - (k < 3 ? pressure : 0);
}

static void put_stress(struct artifact *artifact, const struct flow *flow)
{
    const struct cells *cells = flow->cells;
    double *volume = NEW_ARRAY(double, cells->n), mean[3][3];
    double(*stress)[3][3] = allocate((size_t)cells->n, sizeof *stress);
    // Where several cells are one pore, its volume is stored at the first.
    for (int c = 0, next = 0; c < cells->n; c++) {
        const int pore = cells->cell[c].pore;
        volume[c] =
            pore == next ? flow->stress->volume[pore] * cube(flow->grains->unit) : 0;
        next += pore == next;
        put_together(stress[c], flow->stress->viscous[pore],
                     pore_pressure(flow->pressures, cells, c));
    }
    put_together(mean, flow->stress->mean_viscous, flow->forces->mean_pressure);
    artifact_put(artifact, "/pores/volume", volume, cells->n);
    artifact_put(artifact, "/pores/stress", stress, cells->n);
    artifact_put(artifact, "/stress", mean, 3);
    free(volume);
    free(stress);
}

// The flux is positive from the first pore to the second. Where grains cover a facet
// its fluid area may be negative; 0 is written.
static void put_throat_numbers(struct artifact *artifact, const struct flow *flow)
{
    const struct throats *throats = flow->throats;
    const int n = throats->n;
    const double unit = flow->grains->unit, conducts = cube(unit) / flow->viscosity;
    double *conductance = NEW_ARRAY(double, n), *flux = NEW_ARRAY(double, n),
           *length = NEW_ARRAY(double, n), *area = NEW_ARRAY(double, n);
    for (int t = 0; t < n; t++) {
        const struct throat *throat = &throats->throat[t];
        conductance[t] = conducts * throat->conductance;
        flux[t] = conductance[t] *
                  pressure_drop(flow->pressures, flow->grains, flow->cells, throat);
        length[t] = unit * throat->length;
        area[t] = unit * unit * fmax(0, fluid_area(throat));
    }
    artifact_put(artifact, "/throats/conductance", conductance, n);
    artifact_put(artifact, "/throats/flux", flux, n);
    artifact_put(artifact, "/throats/length", length, n);
    artifact_put(artifact, "/throats/area", area, n);
    free(conductance);
    free(flux);
    free(length);
    free(area);
}

// Also as a view for ParaView, with pores as points and throats as lines.
static void put_throats(struct artifact *artifact, const struct flow *flow)
{
    const struct throats *throats = flow->throats;
    const int n = throats->n;
    int32_t(*pores)[2] = allocate((size_t)n, sizeof *pores);
    int32_t(*corner)[3] = allocate((size_t)n, sizeof *corner);
    struct image *image = NEW_ARRAY(struct image, n);
    for (int t = 0; t < n; t++) {
        memcpy(pores[t], throats->throat[t].cell, sizeof *pores);
        memcpy(corner[t], throats->throat[t].corner, sizeof *corner);
        image[t] = throats->throat[t].image;
    }
    artifact_put(artifact, "/throats/pores", pores, n);
    artifact_put(artifact, "/throats/particles", corner, n);
    if (grains_repeat(flow->grains)) artifact_put(artifact, "/throats/image", image, n);
    put_throat_numbers(artifact, flow);
    artifact_put_vtk(artifact, "/pores/position", flow->cells->n,
                     (const char *const[]){"/pores/pressure", NULL},
                     (const int32_t(*)[2])pores, n,
                     (const char *const[]){"/throats/conductance", "/throats/flux",
                                           "/throats/length", "/throats/area", NULL});
    free(pores);
    free(corner);
    free(image);
}

static void put_grains(struct artifact *artifact, const struct flow *flow)
{
    const int n = flow->packing->n_particle;
    struct vector *force = NEW_ARRAY(struct vector, n);
    for (int i = 0; i < n; i++)
        force[i] = newtons(flow, flow->forces->viscous[i]);
    artifact_put(artifact, "/particles/viscous_force", force, n);
    for (int i = 0; i < n; i++)
        force[i] = newtons(flow, flow->forces->pressure[i]);
    artifact_put(artifact, "/particles/pressure_force", force, n);
    for (int i = 0; i < n; i++)
        force[i] = buoyancy(flow, i);
    artifact_put(artifact, "/particles/buoyancy", force, n);
    free(force);
}

// Returns what flows in. Inflow is positive into the box; what flows in is the sum of
// the positive ones.
static double put_walls(struct artifact *artifact, const struct flow *flow)
{
    struct vector viscous[WALL_COUNT], pressure[WALL_COUNT];
    double inflow[WALL_COUNT], sum = 0;
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        viscous[wall] = newtons(flow, flow->forces->wall_viscous[wall]);
        pressure[wall] = newtons(flow, flow->forces->wall_pressure[wall]);
        inflow[wall] =
            flow->pressures->inflow[wall] * cube(flow->grains->unit) / flow->viscosity;
        sum += fmax(0, inflow[wall]);
    }
    artifact_put(artifact, "/walls/inflow", inflow, WALL_COUNT);
    artifact_put(artifact, "/walls/viscous_force", viscous, WALL_COUNT);
    artifact_put(artifact, "/walls/pressure_force", pressure, WALL_COUNT);
    return sum;
}

// Columns become the second index: tensor[i][j] is the flow along i for a drop along j.
static void put_permeability(struct artifact *artifact, const struct flow *flow)
{
    if (!isnan(flow->permeability)) {
        artifact_put_number(artifact, "/summary/permeability", flow->permeability);
        artifact_put_number(artifact, "/summary/bed_permeability",
                            flow->permeability * flow->bed_share);
    }
    if (!flow->permeability_columns) return;
    double tensor[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            tensor[i][j] = component(flow->permeability_columns[j], i);
    artifact_put(artifact, "/permeability", tensor, 3);
}

void put_flow(struct artifact *artifact, const struct flow *flow)
{
    artifact_put_packing(artifact, flow->packing);
    put_pores(artifact, flow);
    put_throats(artifact, flow);
    put_grains(artifact, flow);
    const double flux = put_walls(artifact, flow);
    put_permeability(artifact, flow);
    if (flow->stress) put_stress(artifact, flow);
    artifact_put_number(artifact, "/summary/flux", flux);
    artifact_put_number(artifact, "/summary/imbalance", flow->pressures->imbalance);
    artifact_put_number(artifact, "/summary/mean_pressure",
                        flow->forces->mean_pressure);
    artifact_put_number(artifact, "/summary/closed_throats", flow->throats->n_closed);
    artifact_put_number(artifact, "/summary/pockets", flow->pressures->n_pocket);
}

// A forces artifact without liquid: saturation 1, suction 0. The forces grow linearly
// from 0, so that a replay can follow them.
void put_forces(struct artifact *artifact, const struct flow *flow, int steps)
{
    const int n = flow->packing->n_particle;
    double *time = NEW_ARRAY(double, steps), *saturation = NEW_ARRAY(double, steps);
    struct vector *force = NEW_ARRAY(struct vector, (size_t)steps * (size_t)n);
    double largest = 0;
    for (int k = 0; k < steps; k++) {
        time[k] = k;
        saturation[k] = 1;
        for (int i = 0; i < n; i++)
            force[(size_t)k * (size_t)n + (size_t)i] =
                scale((double)k / (steps - 1), total_force(flow, i));
    }
    for (int i = 0; i < n; i++)
        largest = fmax(largest, norm(total_force(flow, i)));
    artifact_put_packing(artifact, flow->packing);
    artifact_put(artifact, "/time", time, steps);
    artifact_put(artifact, "/saturation", saturation, steps);
    artifact_put_table(artifact, "/force", force, steps, n);
    artifact_put_number(artifact, "/summary/capillary_pressure", 0);
    artifact_put_number(artifact, "/summary/force_scale", 1);
    artifact_put_number(artifact, "/summary/largest_force", largest);
    artifact_put_number(artifact, "/summary/first_period_end_time", 0);
    free(time);
    free(saturation);
    free(force);
}
