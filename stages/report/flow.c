// SPDX-License-Identifier: GPL-3.0-or-later
// The pores are nodes, their throats tubes as wide as the facet between them; the arrow
// of a grain is its drag: the force of the viscous stress and of the piezometric
// pressure. Radius of a tube for a facet of area A: sqrt(A / pi). Its colour is the
// mean of the pressures of its two pores, or the mean speed |q| / A through it. Closed
// throats (conductance 0) are empty tubes, which are not drawn.
//
// The profile is the plain mean of the pressures of the pores in each of SLICES slices
// of the box along an axis: where it is straight, the packing resists evenly.
#include "flow.h"

#include "basics/memory.h"
#include "facts.h"
#include "html.h"

#include <math.h>
#include <stdlib.h>

enum { SLICES = 20 };

// One load, at time 0: a flow is steady.
static void read_drag(struct run *run)
{
    int n;
    struct vector *viscous = artifact_get(run->flow, "/particles/viscous_force", &n);
    run->load = artifact_get(run->flow, "/particles/pressure_force", NULL);
    for (int i = 0; i < n; i++)
        run->load[i] = add(run->load[i], viscous[i]);
    free(viscous);
    run->load_time = NEW_ARRAY(double, 1);
    run->n_load = 1;
}

// The network of a drying serves for the drawing: nodes, throats, radii, images.
void read_flow(struct run *run)
{
    struct network *network = &run->network;
    const struct artifact *flow = run->flow;
    network->node_position = artifact_get(flow, "/pores/position", &network->n_node);
    network->throat_nodes = artifact_get(flow, "/throats/pores", &network->n_throat);
    network->throat_radius = artifact_get(flow, "/throats/area", NULL);
    if (artifact_has_dataset(flow, "/throats/image"))
        network->throat_image = artifact_get(flow, "/throats/image", NULL);
    double *conductance = artifact_get(flow, "/throats/conductance", NULL);
    network->throat_kind = NEW_ARRAY(uint8_t, network->n_throat);
    for (int t = 0; t < network->n_throat; t++) {
        network->throat_radius[t] = sqrt(network->throat_radius[t] / M_PI);
        if (conductance[t] <= 0) network->throat_kind[t] = THROAT_IMPOSED_EMPTY;
    }
    free(conductance);
    read_drag(run);
}

// ---- for the script -----------------------------------------------------------------

static double *throat_means(const struct run *run, const double *pressure)
{
    const struct network *network = &run->network;
    double *mean = NEW_ARRAY(double, network->n_throat);
    for (int t = 0; t < network->n_throat; t++)
        mean[t] = (pressure[network->throat_nodes[t][0]] +
                   pressure[network->throat_nodes[t][1]]) /
                  2;
    return mean;
}

static double *throat_speeds(const struct run *run)
{
    double *speed = artifact_get(run->flow, "/throats/flux", NULL);
    double *area = artifact_get(run->flow, "/throats/area", NULL);
    for (int t = 0; t < run->network.n_throat; t++)
        speed[t] = area[t] > 0 ? fabs(speed[t]) / area[t] : 0;
    free(area);
    return speed;
}

// {"name", "y"}: the mean pressure of pores in slices along AXIS. Pores outside of the
// box (beside walls) count in the outermost slices. An empty slice is a gap in the
// line.
static json_t *profile_along(const struct run *run, const double *pressure, int axis)
{
    double sum[SLICES] = {0};
    int count[SLICES] = {0};
    const double low = component(run->packing.lower, axis),
                 high = component(run->packing.upper, axis);
    for (int k = 0; k < run->network.n_node; k++) {
        const double at = component(run->network.node_position[k], axis);
        const double share = fmin(1, fmax(0, (at - low) / (high - low)));
        const int slice = share < 1 ? (int)(share * SLICES) : SLICES - 1;
        sum[slice] += pressure[k];
        count[slice]++;
    }
    json_t *mean = json_array();
    for (int s = 0; s < SLICES; s++)
        json_array_append_new(mean,
                              count[s] ? json_real(sum[s] / count[s]) : json_null());
    const char name[] = {'a', 'l', 'o', 'n', 'g', ' ', "xyz"[axis], 0};
    return json_pack("{s:s,s:o}", "name", name, "y", mean);
}

static json_t *profiles(const struct run *run, const double *pressure)
{
    json_t *lines = json_array(), *x = json_array();
    for (int s = 0; s < SLICES; s++)
        json_array_append_new(x, json_real((s + 0.5) / SLICES));
    for (int axis = 0; axis < 3; axis++)
        json_array_append_new(lines, profile_along(run, pressure, axis));
    return json_pack("{s:s,s:s,s:s,s:s,s:o,s:o}", "title",
                     "Pressure in slices of the box", "label", "mean pressure", "unit",
                     "Pa", "xLabel", "place in the box", "x", x, "lines", lines);
}

json_t *put_flow(struct arrays *arrays, const struct run *run)
{
    const size_t n = (size_t)run->network.n_throat;
    double *pressure = artifact_get(run->flow, "/pores/pressure", NULL);
    double *mean = throat_means(run, pressure), *speed = throat_speeds(run);
    arrays_put_doubles(arrays, "pore.pressure", mean, n);
    arrays_put_doubles(arrays, "pore.speed", speed, n);
    json_t *charts = json_pack("[o]", profiles(run, pressure));
    free(pressure);
    free(mean);
    free(speed);
    return json_pack("{s:[{s:s,s:s,s:s,s:s},{s:s,s:s,s:s,s:s}],s:o}", "fields", "array",
                     "pore.pressure", "label", "pores by pressure", "of", "throat",
                     "unit", "Pa", "array", "pore.speed", "label", "pores by speed",
                     "of", "throat", "unit", "m/s", "charts", charts);
}

// ---- in words -----------------------------------------------------------------------

static double number(const struct run *run, const char *name)
{
    return artifact_has_number(run->flow, name) ? artifact_get_number(run->flow, name)
                                                : NAN;
}

// "1.2e-15 m2", of the whole box or of the tensor's diagonal. A box that repeats has a
// tensor of 9 numbers, a flow between two sides one number.
static void say_permeability(const struct run *run, char text[100])
{
    const double one = number(run, "/summary/permeability");
    if (!isnan(one)) {
        snprintf(text, 100, "%.4g m²", one);
        return;
    }
    *text = 0;
    if (!artifact_has_dataset(run->flow, "/permeability")) return;
    double *all = artifact_get(run->flow, "/permeability", NULL);
    snprintf(text, 100, "%.4g, %.4g and %.4g m² along x, y and z", all[0], all[4],
             all[8]);
    free(all);
}

void put_flow_headline(FILE *page, const struct run *run)
{
    char text[100];
    say_permeability(run, text);
    if (*text)
        put_line(page, "The permeability is %s.", text);
    else
        put_line(page, "Fluid flows between %d grains.", run->packing.n_particle);
}

void put_flow_facts(FILE *page, const struct run *run, const struct shown_body *body)
{
    char text[100], low[40], high[40];
    int n;
    double *pressure = artifact_get(run->flow, "/pores/pressure", &n);
    double least = INFINITY, most = -INFINITY;
    for (int k = 0; k < n; k++) {
        least = fmin(least, pressure[k]);
        most = fmax(most, pressure[k]);
    }
    free(pressure);
    say_permeability(run, text);
    fputs("<dl class=\"facts\">\n", page);
    if (*text) put_fact(page, nowhere, "Permeability", "%s", text);
    const double bed = number(run, "/summary/bed_permeability");
    if (!isnan(bed))
        put_fact(page, nowhere, "Permeability of the bed alone", "%.4g m²", bed);
    put_fact(page, nowhere, "Flux through the walls", "%.4g m³/s",
             number(run, "/summary/flux"));
    if (n)
        put_fact(page, nowhere, "Pressure in the pores", "%s to %s",
                 with_unit(least, "Pa", low), with_unit(most, "Pa", high));
    if (body->largest_load > 0)
        put_fact(page, (struct where){0, body->heaviest}, "Largest drag",
                 "%s on grain %d", with_unit(body->largest_load, "N", low),
                 body->heaviest);
    put_makeup(page, run);
    fputs("</dl>\n", page);
}
