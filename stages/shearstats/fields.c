// SPDX-License-Identifier: GPL-3.0-or-later
// In a cell of volume V, sums over N snapshots (sums.h) divided by N V give
//     density, fraction, number, momentum, contacts, traction,
//     velocity = momentum / density,
//     contact and bridge stress = sum f l / (N V),
//     kinetic stress = (sum m v v - momentum velocity) / (N V),
//     fabric = sum n n / contacts, coordination = touching / number.
// In a cylinder
//     angular velocity = sum m r v_angle / sum m r^2,   velocity_angle = that times r
// and the kinetic stress is that of v - angular velocity r: both are exact in a rigid
// rotation, however wide the kernel.
// The strain rate is the symmetric gradient (strain_rate.h). Invariants:
//     pressure = trace / 3 of the whole stress s,
//     in a cylinder shear stress = sqrt(s_r,angle^2 + s_angle,z^2),
//                   shear rate = sqrt(d_r,angle^2 + d_angle,z^2),    [G 17, 24]
//     else          sqrt(dev : dev / 2) of the one and the other,
// s and d symmetric; for plane shear the two agree, and the rate is half the slope of
// the velocity.
#include "fields.h"

#include "basics/memory.h"
#include "strain_rate.h"

#include <math.h>
#include <stdlib.h>

// Row-major place of component K of a symmetric tensor, and its mirror.
static const int PLACE_IN_TENSOR[6][2] = {{0, 0}, {4, 4}, {8, 8},
                                          {1, 3}, {2, 6}, {5, 7}};
static const int INDICES[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

static void set_symmetric(double *tensor, int k, double value)
{
    tensor[PLACE_IN_TENSOR[k][0]] = tensor[PLACE_IN_TENSOR[k][1]] = value;
}

// The mass in the denominator is spread by the same kernel as the momentum: a velocity
// needs no volume, and is right at the edge of the bed.
static void set_velocity(const double *sum, bool cylindrical, double r, double *value)
{
    double *velocity = value + field_column(FIELD_VELOCITY);
    for (int a = 0; a < 3; a++)
        velocity[a] = sum[SUM_MOMENTUM + a] / sum[SUM_MASS];
    if (!cylindrical || !(sum[SUM_INERTIA] > 0)) return;
    const double omega = sum[SUM_TURNING + 1] / sum[SUM_INERTIA];
    value[field_column(FIELD_ANGULAR_VELOCITY)] = omega;
    velocity[1] = omega * r;
}

// Fluctuations are small beside the mean where the flow is slow: the difference then
// has errors of 1e-16 of the flux of the mean, which does not matter beside other
// stresses. Beside the angle the mean that is taken off is omega r of each grain, whose
// sums are SUM_TURNING: r varies over a cell, and with the mean velocity a rigid
// rotation would show a stress.
static void set_kinetic(const double *sum, bool cylindrical, double per_volume,
                        const double *value, double *kinetic)
{
    const double *velocity = value + field_column(FIELD_VELOCITY);
    const double omega = value[field_column(FIELD_ANGULAR_VELOCITY)];
    for (int k = 0; k < 6; k++) {
        const int a = INDICES[k][0], b = INDICES[k][1];
        double mean = sum[SUM_MOMENTUM + a] * velocity[b];
        if (cylindrical && a == 1 && b == 1) mean = omega * sum[SUM_TURNING + 1];
        if (cylindrical && (a == 1) != (b == 1))
            mean = omega * sum[SUM_TURNING + (a == 1 ? b : a)];
        set_symmetric(kinetic, k, (sum[SUM_FLUX + k] - mean) * per_volume);
    }
}

// Contact stress is symmetrised: its antisymmetric part belongs to couples, which are
// left out.
static void set_invariants(bool cylindrical, double *value)
{
    const double *part[3] = {value + field_column(FIELD_CONTACT_STRESS),
                             value + field_column(FIELD_BRIDGE_STRESS),
                             value + field_column(FIELD_KINETIC_STRESS)};
    const double *rate = value + field_column(FIELD_STRAIN_RATE);
    double s[6], d[6];
    for (int k = 0; k < 6; k++) {
        const int here = PLACE_IN_TENSOR[k][0], mirror = PLACE_IN_TENSOR[k][1];
        s[k] = 0;
        for (int p = 0; p < 3; p++)
            s[k] += 0.5 * (part[p][here] + part[p][mirror]);
        d[k] = rate[here];
    }
    const double p = (s[0] + s[1] + s[2]) / 3, expansion = (d[0] + d[1] + d[2]) / 3;
    double stress = s[3] * s[3] + s[5] * s[5], strain = d[3] * d[3] + d[5] * d[5];
    if (!cylindrical) {
        stress += s[4] * s[4];
        strain += d[4] * d[4];
        for (int k = 0; k < 3; k++) {
            stress += 0.5 * (s[k] - p) * (s[k] - p);
            strain += 0.5 * (d[k] - expansion) * (d[k] - expansion);
        }
    }
    value[field_column(FIELD_PRESSURE)] = p;
    value[field_column(FIELD_SHEAR_STRESS)] = sqrt(stress);
    value[field_column(FIELD_SHEAR_RATE)] = sqrt(strain);
}

// Volumes first, then what is per mass or per grain, which an empty cell has not.
static void set_cell(const struct grid *grid, int cell, const double *sum,
                     int snapshots, double *value)
{
    const double per_volume = 1 / (cell_volume(grid, cell) * snapshots);
    const double r = grid->cylindrical ? cell_centre(grid, cell, 0) : 0;
    value[field_column(FIELD_DENSITY)] = sum[SUM_MASS] * per_volume;
    value[field_column(FIELD_FRACTION)] = sum[SUM_VOLUME] * per_volume;
    value[field_column(FIELD_NUMBER)] = sum[SUM_COUNT] * per_volume;
    value[field_column(FIELD_CONTACTS)] = sum[SUM_CONTACTS] * per_volume;
    for (int a = 0; a < 3; a++) {
        value[field_column(FIELD_MOMENTUM) + a] = sum[SUM_MOMENTUM + a] * per_volume;
        value[field_column(FIELD_TRACTION) + a] = sum[SUM_TRACTION + a] * per_volume;
    }
    for (int k = 0; k < 9; k++) {
        value[field_column(FIELD_CONTACT_STRESS) + k] =
            sum[SUM_CONTACT + k] * per_volume;
        value[field_column(FIELD_BRIDGE_STRESS) + k] = sum[SUM_BRIDGE + k] * per_volume;
    }
    for (int k = 0; k < 6 && sum[SUM_CONTACTS] > 0; k++)
        set_symmetric(value + field_column(FIELD_FABRIC), k,
                      sum[SUM_FABRIC + k] / sum[SUM_CONTACTS]);
    if (!(sum[SUM_MASS] > 0)) return;
    set_velocity(sum, grid->cylindrical, r, value);
    set_kinetic(sum, grid->cylindrical, per_volume, value,
                value + field_column(FIELD_KINETIC_STRESS));
    value[field_column(FIELD_COORDINATION)] = sum[SUM_TOUCHING] / sum[SUM_COUNT];
    value[field_column(FIELD_BRIDGES)] = sum[SUM_JOINED] / sum[SUM_COUNT];
}

// Two passes: the strain rate of a cell needs the velocities of the cells beside it.
struct fields make_fields(const struct grid *grid, const double *sum, int snapshots)
{
    const int n = grid_cells(grid);
    const size_t width = (size_t)fields_width();
    struct fields fields = {NEW_ARRAY(double, (size_t)n *width), NEW_ARRAY(uint8_t, n)};
    for (int cell = 0; cell < n; cell++) {
        const double *of = sum + (size_t)cell * SUM_ALL;
        fields.filled[cell] = of[SUM_MASS] > 0;
        set_cell(grid, cell, of, snapshots, fields.value + (size_t)cell * width);
    }
    for (int cell = 0; cell < n; cell++) {
        double *value = fields.value + (size_t)cell * width;
        if (fields.filled[cell])
            strain_rate(grid, &fields, cell, value + field_column(FIELD_STRAIN_RATE));
        set_invariants(grid->cylindrical, value);
    }
    return fields;
}

void fields_free(struct fields *fields)
{
    free(fields->value);
    free(fields->filled);
    *fields = (struct fields){0};
}
