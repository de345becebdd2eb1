// SPDX-License-Identifier: GPL-3.0-or-later
// Throat radii that a stage may draw instead of taking those of the network: its rows
// of the parameter table, and what they fill. DRAWN_RADII_ROWS are rows for such a
// table: `invade` and `dry` take them, so that a draw is called the same in both. The
// keys are throat_radius.distribution, .mean, .standard_deviation, .second_mean,
// .second_standard_deviation, .second_share, .correlation_length and .seed, lengths in
// m. The same seed and keys give the same radii in both stages.
//
// A stage puts a struct drawn_radii into its struct of parameters and calls give_radii
// before anything is made from radii or volumes (closed throats shut, an order of entry
// found); then report_cut_radii, or describe_cut_radii for a text of its own.
#pragma once

#include "network/throat_radius.h"
#include "parameters/parameters.h"

// What the rows below fill. In `how`, law and seed are not used: the two here are. m;
// correlation_length as well.
struct drawn_radii {
    int law; // 0: as in the network; the others are those of enum radius_law, from 1
    int64_t seed;
    struct radius_distribution how;
};

// Gives NETWORK the radii that were asked for, if any were: every throat gets one, in
// the order of the network, and becomes a cylinder of it, without the volume and the
// conductances that it had. With law 0 nothing changes. STATUS_BAD_DATA as draw_radii
// (the network stays as it was), and where none are drawn but PARAMETERS, the stage's
// effective ones with defaults filled in, say how: the reason names the key.
enum status give_radii(struct network *network, const struct drawn_radii *radii,
                       const json_t *parameters, struct reason *reason);

// What cutting normal radii at 0 makes of their mean and standard deviation: a line for
// each mode of which at least a thousandth is cut, into TEXT, which is returned; empty
// for other laws.
enum { RADII_TEXT = 400 };
const char *describe_cut_radii(const struct drawn_radii *radii, char text[RADII_TEXT]);

// The same on standard error, with the advice to take a lognormal law; nothing where
// little is cut.
void report_cut_radii(const struct drawn_radii *radii);

// AT: where struct drawn_radii lies in the stage's parameter struct.
#define DRAWN_RADII_AT(at, member) (at) + offsetof(struct drawn_radii, member)
// clang-format off
#define DRAWN_RADII_ROWS(at) \
    {"throat_radius.distribution", PARAMETER_CHOICE, "1", "\"network\"", \
     DRAWN_RADII_AT(at, law), \
     .choices = "network|normal|lognormal|uniform|two_mode", \
     .text = "throat radii: as in the network, or drawn [K 2.2, 3.11]; drawn ones make " \
             "the throats cylinders"}, \
    {"throat_radius.mean", PARAMETER_NUMBER, "m", "103e-9", \
     DRAWN_RADII_AT(at, how.mean), ABOVE(0), \
     .text = "mean of drawn radii; two_mode: of the first mode"}, \
    {"throat_radius.standard_deviation", PARAMETER_NUMBER, "m", "1e-9", \
     DRAWN_RADII_AT(at, how.deviation), AT_LEAST(0), \
     .text = "their standard deviation; of normal ones before those that are not above 0 " \
             "are drawn again"}, \
    {"throat_radius.second_mean", PARAMETER_NUMBER, "m", "40e-9", \
     DRAWN_RADII_AT(at, how.second_mean), ABOVE(0), \
     .text = "two_mode: mean of the second mode"}, \
    {"throat_radius.second_standard_deviation", PARAMETER_NUMBER, "m", "2e-9", \
     DRAWN_RADII_AT(at, how.second_deviation), AT_LEAST(0), \
     .text = "its standard deviation"}, \
    {"throat_radius.second_share", PARAMETER_NUMBER, "1", "0.5", \
     DRAWN_RADII_AT(at, how.second_share), BETWEEN(0, 1), \
     .text = "share of the throats in it"}, \
    {"throat_radius.correlation_length", PARAMETER_NUMBER, "m", "0", \
     DRAWN_RADII_AT(at, how.correlation_length), AT_LEAST(0), \
     .text = "drawn radii are alike within this distance, their distribution the same; " \
             "0: independent"}, \
    {"throat_radius.seed", PARAMETER_INTEGER, "1", "1", \
     DRAWN_RADII_AT(at, seed), BETWEEN(0, 4294967295.0), \
     .text = "seed of drawn radii"}
// clang-format on
