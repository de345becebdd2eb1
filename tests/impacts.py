# SPDX-License-Identifier: GPL-3.0-or-later
"""The eight impacts of Chung & Ooi (2011, Granular Matter 13, 643) as scenes of simulate.

A grain comes from above onto a plane, rigid or of a material, or onto a second grain, and
touches it at the start. The closed forms are those of docs/contacts.md: Hertz' force, overlap
and time, and rigid bodies that slide throughout.
"""
import json
import math

import h5py
import numpy as np

from tap import run, scratch_paths


def material(young_modulus, poisson_ratio, density, restitution=1, friction=0):
    return {"young_modulus": young_modulus, "poisson_ratio": poisson_ratio, "density": density,
            "restitution": restitution, "friction": friction}


GLASS = material(48e9, 0.2, 2800)
LIMESTONE = material(20e9, 0.25, 2500)
ALUMINIUM = material(70e9, 0.3, 2699)
MAGNESIUM = material(40e9, 0.35, 1800)
OXIDE = material(380e9, 0.23, 4000, 0.98, 0.092)
IRON = material(100e9, 0.25, 7000)
STEEL = material(208e9, 0.3, 7850, 1, 0.3)
ALLOY = material(70e9, 0.33, 2700, 0.5, 0.4)


class Impact:
    """A grain of MATERIAL onto a plane (OTHER None: rigid), or onto a grain of radius BELOW."""

    def __init__(self, stuff, radius, velocity, spin=0, below=None, other=None, velocity_below=(0, 0),
                 spin_below=0):
        self.stuff, self.radius, self.velocity, self.spin = stuff, radius, velocity, spin
        self.below, self.other, self.velocity_below, self.spin_below = below, other, velocity_below, spin_below
        mass = lambda what, r: what["density"] * 4 / 3 * math.pi * r**3
        self.mass = mass(stuff, radius)
        compliance = lambda what: (1 - what["poisson_ratio"]**2) / what["young_modulus"]
        self.closing = velocity_below[1] - velocity[1]
        m, r, c = self.mass, radius, compliance(stuff) + (compliance(other) if other else 0)
        if below:
            m2 = mass(other, below)
            m, r = m * m2 / (m + m2), r * below / (r + below)
        self.stiffness = 4 / 3 / c * math.sqrt(r)
        # Hertz: m v^2 / 2 = 2/5 k U^(5/2); F = k U^1.5; t = 2 U / v times a beta function
        self.overlap = (1.25 * m * self.closing**2 / self.stiffness)**0.4
        self.force = self.stiffness * self.overlap**1.5
        self.time = 0.8 * self.overlap / self.closing * math.exp(
            math.lgamma(0.4) + math.lgamma(0.5) - math.lgamma(0.9))

    def scene(self, steps):
        """STEPS time steps an elastic contact; every one is recorded."""
        step = self.time / steps
        materials = {"a": self.stuff} | ({"b": self.other} if self.other else {})
        start = lambda v, w: {"initial": {"velocity": [v[0], 0, v[1]], "spin": [0, w, 0]}}
        scene = {"duration": 1.5 * self.time, "time_step": step, "allow_unstable": True, "gravity": [0, 0, 0],
                 "materials": materials, "material": "a",
                 "groups": {"upper": {"grains": [0], **start(self.velocity, self.spin)}},
                 "record": {"every": self.time, "snapshots_every": step, "energy": False}}
        if self.below:
            scene["groups"]["lower"] = {"grains": [1], "material": "b",
                                        **start(self.velocity_below, self.spin_below)}
        else:
            scene["walls"] = {"plane": {"point": [0, 0, 0]} | ({"material": "b"} if self.other else {})}
        return scene


class Outcome:
    """Of IMPACT in STEPS time steps a contact: force, overlap, time; velocities and spins after."""

    def __init__(self, impact, steps):
        with scratch_paths() as at:
            far = 8 * (impact.radius + (impact.below or 0))
            grains = [[0, 0, impact.radius, impact.radius]]
            if impact.below:
                grains.append([0, 0, -impact.below, impact.below])
            np.savetxt(at("grains"), grains, fmt="%.17g")
            pack = {"method": "import", "check": "none", "lower": [-far] * 3, "upper": [far] * 3, "bonds": "none"}
            for name, scene in ("pack.json", pack), ("scene.json", impact.scene(steps)):
                with open(at(name), "w") as file:
                    json.dump(scene, file)
            run("pack", "-q", "-p", at("pack.json"), at("grains"), "-o", at("packing"))
            run("simulate", "-q", "-p", at("scene.json"), at("packing"), "-o", at("motion"))
            with h5py.File(at("motion")) as motion:
                self.read(impact, motion)

    def read(self, impact, motion):
        time, place = motion["snapshots/time"][()], motion["snapshots/position"][()]
        gap = np.linalg.norm(place[:, 0] - place[:, 1], axis=1) - impact.below if impact.below else place[:, 0, 2]
        overlap = impact.radius - gap
        self.overlap = overlap.max()
        self.force = np.abs(motion["contacts/force"][:, 2]).max()
        last = np.nonzero(overlap > 0)[0][-1]  # and it parts before the next one
        self.time = time[last] + (time[last + 1] - time[last]) * overlap[last] / (overlap[last] - overlap[last + 1])
        self.velocity = motion["snapshots/velocity"][-1]
        self.spin = motion["snapshots/spin"][-1][:, 1]
        self.surface = self.velocity[0, 0] - impact.radius * self.spin[0]


def two_spheres(stuff):
    return Impact(stuff, 0.01, (0, -10), below=0.01, other=stuff, velocity_below=(0, 10))


def onto_plane(stuff, elastic):
    return Impact(stuff, 0.1, (0, -0.2), other=stuff if elastic else None)


def rebound(stuff, restitution):
    return Impact(dict(stuff, restitution=restitution), 2.5e-3, (0, -3.9))


def oblique(angle):
    return Impact(OXIDE, 2.5e-3, (3.9 * math.sin(angle), -3.9 * math.cos(angle)))


def at_one_normal_velocity(psi):
    return Impact(STEEL, 1e-5, (0.3 * 5 * psi, -5))


def spinning(tangent):
    return Impact(ALLOY, 0.1, (0, -0.2), spin=-2 * tangent)


def opposite_spins(angle):
    w = 2 * math.tan(angle)
    return Impact(ALLOY, 0.1, (0, -0.2), spin=w, below=0.1, other=ALLOY, velocity_below=(0, 0.2), spin_below=-w)


def onto_large(tangent, heavy):
    other = dict(ALLOY)
    if heavy:
        other |= {"density": 2.7e6, "young_modulus": 70e12}
    return Impact(ALLOY, 0.1, (0, -0.2), spin=-2 * tangent, below=0.5, other=other)


def beta_of(impact, outcome):
    """Minus the velocity of the surfaces after, over that before."""
    after = outcome.surface
    if impact.below:
        after -= outcome.velocity[1, 0] + impact.below * outcome.spin[1]
    return after / (impact.radius * impact.spin)
