// SPDX-License-Identifier: GPL-3.0-or-later
// The table, and what no row of it can say by itself. What needs a motion (whether the
// bed is high enough, how many cells there are) is checked by begin_study.
#include "parameters.h"

#include "basics/status.h"

#include <math.h>

#define AT(member) offsetof(struct shearstats_parameters, member)

const struct parameter shearstats_table[] = {
    {"coordinates", PARAMETER_CHOICE, "1", "\"cylindrical\"", AT(coordinates),
     .choices = "cartesian|cylindrical",
     .text = "of the cells: x, y, z; or r and z about an axis, means over the angle"},
    {"axis.point", PARAMETER_POINT, "m", "[0,0,0]", AT(axis_point),
     .text = "cylindrical: on the axis; z is 0 there"},
    {"axis.direction", PARAMETER_POINT, "1", "[0,0,1]", AT(axis_direction),
     .text = "cylindrical: along the axis, of any length; z rises along it"},
    {"smoothing_length", PARAMETER_NUMBER, "m", "null", AT(smoothing_length),
     AT_LEAST(0),
     .text =
         "standard deviation of the coarse-graining function along each axis, which "
         "reaches three times as far; null: half a mean diameter; 0: plain cells"},
    {"grid.spacing", PARAMETER_NUMBER, "m", "null", AT(spacing), ABOVE(0),
     .text = "size of the cells; null: the smoothing length, or half a mean diameter"},
    {"grid.along", PARAMETER_CHOICES, "1", "[\"x\",\"y\",\"z\"]", AT(along),
     .choices = "x|y|z",
     .text = "cartesian: axes divided into cells; fields are means along the others"},
    {"grid.lower", PARAMETER_POINT, "m", "null", AT(lower),
     .text =
         "lower end of the cells: x, y, z, or r, 0, z; null: where no grain reaches "
         "further, or that of a box that repeats"},
    {"grid.upper", PARAMETER_POINT, "m", "null", AT(upper), .text = "upper end"},
    {"time.from", PARAMETER_NUMBER, "s", "null", AT(from),
     .text = "snapshots and sums from this time on; null: from the start"},
    {"time.to", PARAMETER_NUMBER, "s", "null", AT(to),
     .text = "up to this time; null: to the end"},
    {"blocks", PARAMETER_INTEGER, "1", "5", AT(blocks), BETWEEN(1, 1000),
     .text = "parts of each run, from whose scatter the block errors are; as many as "
             "there are snapshots at most"},
    {"confidence", PARAMETER_NUMBER, "1", "0.95", AT(confidence),
     BETWEEN(0.5, 0.999999), .text = "of the intervals around means over runs"},
    {"cell.rate", PARAMETER_NUMBER, "rad s-1", "null", AT(rate),
     .text = "angular velocity of the turning part of a split-bottom cell; null: it is "
             "none, and only fields are made"},
    {"cell.turning", PARAMETER_CHOICE, "1", "\"outer\"", AT(turning),
     .choices = "outer|inner", .text = "which part turns"},
    {"cell.levels", PARAMETER_INTEGER, "1", "13", AT(levels), BETWEEN(1, 1000),
     .text = "heights at which the error function is fitted to the angular velocity "
             "[G 13], evenly from cell.lower to cell.upper"},
    {"cell.lower", PARAMETER_NUMBER, "m", "null", AT(level_lower),
     .text = "the lowest; null: one mean diameter above the lowest centre of a grain"},
    {"cell.upper", PARAMETER_NUMBER, "m", "null", AT(level_upper),
     .text =
         "the highest; null: one mean diameter below the highest centre, leaving out "
         "the highest hundredth of the grains"},
    {"cell.inner_radius", PARAMETER_NUMBER, "m", "null", AT(inner_radius), AT_LEAST(0),
     .text = "profiles are fitted from here; null: from the innermost grain"},
    {"cell.outer_radius", PARAMETER_NUMBER, "m", "null", AT(outer_radius), ABOVE(0),
     .text = "to here; null: to the outermost grain"},
    {"cell.walls", PARAMETER_TEXT, "1", "\"\"", AT(walls),
     .text = "walls of the turning part, for its torque: names or numbers between "
             "commas"},
    {"cell.groups", PARAMETER_TEXT, "1", "\"\"", AT(groups),
     .text = "driven groups of the turning part"},
    {"rheology.least_rate", PARAMETER_NUMBER, "s-1", "0.12", AT(least_rate),
     AT_LEAST(0),
     .text = "shear stress is compared with pressure [G 14] where the shear rate is "
             "above this"},
    {"rheology.least_fraction", PARAMETER_NUMBER, "1", "0.4", AT(least_fraction),
     BETWEEN(0, 1),
     .text =
         "and the volume fraction of the grains at least this, which leaves out the "
         "surface; also for profiles"},
    {"rheology.margin", PARAMETER_NUMBER, "m", "null", AT(margin), AT_LEAST(0),
     .text = "and no nearer than this to the outermost centres of grains; null: as far "
             "as the coarse-graining function reaches"},
    {"separation.class", PARAMETER_NUMBER, "m", "null", AT(class_width), ABOVE(0),
     .text =
         "width of the classes of separations [G 15]; null: a thousandth of the mean "
         "diameter"},
    {0}};

void check_shearstats_parameters(const struct shearstats_parameters *parameters)
{
    double length = 0;
    for (int k = 0; k < 3; k++) {
        length += fabs(parameters->axis_direction[k]);
        if (parameters->lower[k] >= parameters->upper[k] &&
            !(k == 1 && parameters->coordinates == COORDINATES_CYLINDRICAL))
            die(STATUS_BAD_DATA,
                "shearstats.grid.upper: must be above grid.lower, got %g not above %g",
                parameters->upper[k], parameters->lower[k]);
    }
    if (parameters->coordinates == COORDINATES_CYLINDRICAL && !(length > 0))
        die(STATUS_BAD_DATA, "shearstats.axis.direction: must not be [0,0,0]");
    if (parameters->from > parameters->to)
        die(STATUS_BAD_DATA,
            "shearstats.time.to: must not be before time.from, %g s, "
            "got %g",
            parameters->from, parameters->to);
    if (isnan(parameters->rate)) return;
    if (!(fabs(parameters->rate) > 0))
        die(STATUS_BAD_DATA, "shearstats.cell.rate: must not be 0: nothing turns");
    if (parameters->coordinates != COORDINATES_CYLINDRICAL)
        die(STATUS_BAD_DATA, "shearstats.cell.rate: a cell has an axis: coordinates "
                             "must be cylindrical");
    if (parameters->level_lower >= parameters->level_upper)
        die(STATUS_BAD_DATA,
            "shearstats.cell.upper: must be above cell.lower, %g m, got %g",
            parameters->level_lower, parameters->level_upper);
}
