# SPDX-License-Identifier: GPL-3.0-or-later
"""The strain at which a layer cracks, beside Griffith's criterion for a constrained film.

A layer cracks where its lateral tension is largest. With N the tension times the height of the box, a
force per width, e the strain, and N' = N/e before anything breaks, a long crack through the layer
releases per area [Tirumkudulu and Russel 2005]
    G = Z (1 + nu) e N
with Z = 0.98 on a rigid floor at the nu of craquelure-40.json (plane strain, by finite elements:
tests/physics/crackstats/critical_thickness.t). It needs at least the energy of the bonds that cross its plane when
they break, each s^2 A/2k with the strength s, the cross-section A and the stiffness per area k. So no
crack can run below
    e_G = sqrt(Gamma / (Z (1 + nu) N')).
nu is that of grains joined evenly in all directions, (k_n - k_s)/(4 k_n + k_s).

Suction pulls a layer together without a strain of its own. So its tension counts, as the strain N/N' with
the N' of the same layer as it shrinks. A crack through wet pores also makes two surfaces of liquid. A plane
cuts liquid in a share of its area that is the share of its volume, so they take per area
    2 gamma cos(theta) (volume of liquid then)/(volume of the layer).

A slit (see the program `slit`) grows when, up to half a thickness beyond its ends and within 1.5 diameters
of its plane, half as many bonds have broken as crossed the plane there.
"""
import re

import numpy as np
from common import artifact, parameters, refuse

RELEASED = 0.98
ELASTIC = 0.25  # of the strain at the largest tension: nothing has broken
DIAMETER = 0.52e-6  # mean, of craquelure-40.json


def toughness(response, bond):
    """J/m2: the energy of the bonds that cross a plane, per area of the part that shrinks."""
    pairs, place = response["bonds/particles"][:], response["particles/position"][:]
    radius, held = response["particles/radius"][:], response["particles/held"][:]
    edge = response["domain/upper"][:] - response["domain/lower"][:]
    pairs = pairs[~held[pairs].astype(bool).all(axis=1)]
    along = place[pairs[:, 1], 0] - place[pairs[:, 0], 0]
    along = np.abs(along - edge[0] * np.rint(along / edge[0]))
    area = np.pi * (bond["radius_fraction"] * radius[pairs].min(axis=1)) ** 2
    energy = bond["normal_strength"] ** 2 * area / (2 * bond["normal_stiffness"])
    depth = (place[:, 2] + radius).max() - place[held == 1, 2].max()
    return np.sum(along * energy) / (edge[0] * edge[1] * depth)


def surfaces(response, liquid, step):
    """J/m2: the energy of the two surfaces of liquid that a crack makes at a STEP."""
    height, radius = response["particles/position"][:, 2], response["particles/radius"][:]
    edge = response["domain/upper"][:] - response["domain/lower"][:]
    volume = edge[0] * edge[1] * ((height + radius).max() - (height - radius).min())
    tension = liquid["surface_tension"] * np.cos(np.radians(liquid["contact_angle"]))
    return 2 * tension * response["history/liquid_volume"][step] / volume


def growth(response, thickness, strain):
    """The strain at which the slit grows; infinite if it does not."""
    lower, upper = response["domain/lower"][:], response["domain/upper"][:]
    pairs, held = response["bonds/particles"][:], response["particles/held"][:].astype(bool)
    ends = response["particles/position"][:][pairs] - (lower + upper) / 2
    across, middle = ends[:, :, 0], ends.mean(axis=1)
    beyond = np.abs(middle[:, 1]) / DIAMETER - thickness  # the slit's half length
    zone = ~held[pairs].any(axis=1) & (beyond > 0) & (beyond < thickness / 2) & (np.ptp(across, axis=1) < 3 * DIAMETER)
    needed = np.count_nonzero(zone & (across[:, 0] * across[:, 1] < 0)) // 2
    crack = response["cracks"]
    near = (zone & (np.abs(middle[:, 0]) < 1.5 * DIAMETER))[crack["bond"][:]]
    at = np.interp(-crack["saturation"][:][near], -response["history/saturation"][:], strain)
    return np.sort(at)[needed] if len(at) > needed else np.inf


def poisson_ratio(bond):
    ratio = bond["shear_stiffness"] / bond["normal_stiffness"]
    return (1 - ratio) / (4 + ratio)


class Layer:
    """One response. VARIANT is "slit", the name of other bonds, "suction", "suction-weak", or nothing."""

    def __init__(self, path):
        found = re.search(r"([0-9]+)-([0-9]+)(?:-([a-z0-9.-]+))?/response\.h5$", path)
        if not found:
            refuse(64, f"{path}: must be THICKNESS-SEED[-VARIANT]/response.h5")
        self.thickness, self.seed, self.variant = int(found[1]), int(found[2]), found[3] or ""
        response = artifact(path, "response")
        how, history = parameters(response), response["history"]
        self.bond, self.height = how["bond"], response["domain/upper"][2] - response["domain/lower"][2]
        self.toughness = toughness(response, self.bond)
        tension, cracks = history["lateral_tension"][:], history["cracks"][:]
        most = tension.argmax()
        self.tension = tension[most]
        self.broken, self.broken_last = cracks[[most, -1]] / len(response["bonds/particles"])
        self.is_wet = "suction" in history
        if self.is_wet:
            self.suction = history["suction"][most]
            self.surfaces = surfaces(response, how["capillary"], most)
            return
        strain = how["shrinkage"]["strain"] * (1 - history["saturation"][:])
        self.crack = strain[most]
        early = strain <= ELASTIC * self.crack
        self.slope = self.height * (tension[early] @ strain[early]) / (strain[early] @ strain[early])  # N'
        self.griffith = self.griffith_strain(self.toughness)
        self.grown = growth(response, self.thickness, strain) if self.variant == "slit" else None
        self.settled = history["settled"][:][strain < (self.grown or self.crack)].all()

    def griffith_strain(self, energy):
        """At an ENERGY (J/m2) that a crack takes."""
        return np.sqrt(energy / (RELEASED * (1 + poisson_ratio(self.bond)) * self.slope))

    def shrink_like(self, other):
        """A wet layer: takes the stiffness of the OTHER, which is the same but shrinks."""
        self.slope = other.slope
        self.crack = self.tension * self.height / self.slope
        self.griffith = self.griffith_strain(self.toughness)
        self.wet_griffith = self.griffith_strain(self.toughness + self.surfaces)
