// SPDX-License-Identifier: GPL-3.0-or-later
// The materials of Chung & Ooi (2011), where they are elastic unless a test says
// otherwise.
#pragma once

#include "dem/dem.h"

static const struct dem_material glass = {
    .density = 2800, .restitution = 1, .young_modulus = 48e9, .poisson_ratio = 0.2};
static const struct dem_material limestone = {
    .density = 2500, .restitution = 1, .young_modulus = 20e9, .poisson_ratio = 0.25};
static const struct dem_material aluminium = {
    .density = 2699, .restitution = 1, .young_modulus = 70e9, .poisson_ratio = 0.3};
static const struct dem_material magnesium = {
    .density = 1800, .restitution = 1, .young_modulus = 40e9, .poisson_ratio = 0.35};
static const struct dem_material oxide = {.density = 4000,
                                          .friction = 0.092,
                                          .restitution = 0.98,
                                          .young_modulus = 380e9,
                                          .poisson_ratio = 0.23};
static const struct dem_material cast_iron = {
    .density = 7000, .restitution = 1, .young_modulus = 100e9, .poisson_ratio = 0.25};
static const struct dem_material steel = {.density = 7850,
                                          .friction = 0.3,
                                          .restitution = 1,
                                          .young_modulus = 208e9,
                                          .poisson_ratio = 0.3};
static const struct dem_material alloy = {.density = 2700,
                                          .friction = 0.4,
                                          .restitution = 0.5,
                                          .young_modulus = 70e9,
                                          .poisson_ratio = 0.33};
