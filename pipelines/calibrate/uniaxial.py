# SPDX-License-Identifier: GPL-3.0-or-later
"""Numerical uniaxial tests of a packing [K 4.3]: its two end layers are pulled apart, and nothing else
holds it. The layers are grips, as if glued to plates: grains of one that lie near each other are bonded, by
bonds that do not break.

    stress   = force / section of the packing's extent, round in a cylinder,
    strain   = symmetric part of the displacement gradient, by least squares over the grains of the
               middle half,
    E        = stress / strain along the force,   nu = - mean strain across / strain along,
    strength = largest stress that the body carried: forces on what was torn off a grip do not count.
"""
import json
import os
import subprocess
import sys
from math import log, pi

import h5py
import numpy as np
from scipy.spatial import cKDTree

from common import BIN, artifact, copy_groups, refuse, summary
from samples import described

LAYER = 3  # thickness of the end layers, mean radii
GLUE = 1  # widest gap that it bridges, mean radii
GLUED = 1e9  # strength of such bonds, over that of the others
UNBREAKABLE = 1e30
MORE_BONDS = "pack.touching_gap (or dem-replay.bond.by=distance, bond.gap) joins more grains"
CYLINDER = 1  # of /domain/bodies/shape: along z
# Equilibria without friction: between open contacts it hardly acts (docs/calibration.md).
FAST = ("engine=quasi-static", "friction=0")
# Among unequal grains one may keep a residual force of a few 1e-8 of the largest load: no equilibrium by the default
# tolerance, 1e-8. With 1e-6 moduli are the same to 1e-8.
ELASTIC = (*FAST, "quasi_static.tolerance=1e-6")
SLOW = ("engine=explicit", "tolerance=1e-6", "most_cycles=1000000", "ramp=20000")

KEYS = ("normal_stiffness", "shear_stiffness", "bond.normal_stiffness", "bond.shear_stiffness",
        "bond.normal_strength", "bond.shear_strength")
THICKNESS = "bond.radius_fraction"


def effective(scene):
    """The parameters of dem-replay in SCENE that the tests change, KEYS, and the THICKNESS of bonds."""
    said = subprocess.run([f"{BIN}/dem-replay", "-p", scene, "--parameters"], capture_output=True, text=True, check=False)
    if said.returncode:
        refuse(said.returncode, said.stderr.strip())
    parameters = json.loads(said.stdout)
    found = {}
    for key in (*KEYS, THICKNESS):
        value = parameters
        for name in key.split("."):
            value = value[name]
        found[key] = value
    if parameters["bond"]["kind"] != "parallel":
        refuse(65, f"{scene}: dem-replay.bond.kind: must be parallel")
    if parameters["prestress"]:
        refuse(65, f"{scene}: dem-replay.prestress: must be false: overlaps that push load the bonds before any test")
    return found


def scaled(bond, what, factor):
    return {key: value * (factor if key.endswith(what) else 1) for key, value in bond.items()}


def strengths_of(bond):
    """The weaker and the stronger."""
    return sorted(bond[f"bond.{way}_strength"] for way in ("normal", "shear"))


def stretch(bond):
    """Of bonds where they break in the way in which they are weaker, m."""
    return strengths_of(bond)[0] / min(bond["bond.normal_stiffness"], bond["bond.shear_stiffness"])


def read_bodies(packing):
    """Corners of the box, and what bounds the grains besides it: shape, whether they lie within, corners around it; those
    around the grains first."""
    group = packing["domain"]
    if "bodies" not in group:
        return None, []
    bodies = zip(*(group[f"bodies/{name}"][:] for name in ("shape", "within", "lower", "upper")))
    return (group["lower"][:], group["upper"][:]), sorted(bodies, key=lambda body: -int(body[1]))


def components(count, pairs):
    """For each grain a grain of its piece, the same for all of it."""
    of = np.arange(count)
    while True:
        lower = np.minimum(of[pairs[:, 0]], of[pairs[:, 1]])
        before = of.copy()
        np.minimum.at(of, pairs[:, 0], lower)
        np.minimum.at(of, pairs[:, 1], lower)
        of = of[of]
        if np.array_equal(of, before):
            return of


class Specimen:
    """The packing of SCENE, made in FOLDER; tests of it leave their files there. Each is told, unless QUIET."""

    def __init__(self, scene, folder, inputs=(), quiet=False):
        self.scene, self.folder, self.quiet, self.tests = scene, folder, quiet, 0
        self.packing = os.path.join(folder, "packing.h5")
        self.stage("pack", *inputs, "-o", self.packing)
        with artifact(self.packing, "packing") as file:
            self.x, self.r = file["particles/position"][:], file["particles/radius"][:]
            if file["domain/periodic"][:].any():
                refuse(65, f"{scene}: pack.periodic: the packing has no ends to pull at")
            self.domain, self.bodies = read_bodies(file)
        if len(self.r) < 8:
            refuse(65, f"{scene}: {len(self.r)} grains are too few to be pulled at")
        self.lower, self.upper = (self.x - self.r[:, None]).min(axis=0), (self.x + self.r[:, None]).max(axis=0)
        self.middle, self.edge = (self.lower + self.upper) / 2, self.upper - self.lower
        self.bonds = None
        with self.pull(2, [0], {}, FAST) as file:
            self.bonds = file["bonds/particles"][:], file["bonds/relative_strength"][:]
        glue = GLUE * self.r.mean()
        near = cKDTree(self.x).query_pairs(2 * self.r.max() + glue, output_type="ndarray")
        apart = np.linalg.norm(self.x[near[:, 1]] - self.x[near[:, 0]], axis=1) - self.r[near].sum(axis=1)
        self.near_pairs = np.unique(near[apart <= glue], axis=0).astype(np.int32)

    def stage(self, name, *words):
        ended = subprocess.run([f"{BIN}/{name}", "-q", "-p", self.scene, *words], stderr=subprocess.PIPE, text=True, check=False)
        if ended.returncode:
            refuse(ended.returncode, (ended.stderr.strip().splitlines() or [f"{name} failed"])[-1])

    def section(self, axis):
        """Of the body's extent: round in a cylinder, less the hole of a ring."""
        section = np.prod(self.edge) / self.edge[axis]
        for shape, within, lower, upper in self.bodies:
            is_through = lower[2] <= self.domain[0][2] and upper[2] >= self.domain[1][2]
            if shape != CYLINDER or axis != 2 or not is_through:
                refuse(65, f"{self.scene}: pack.domain: sections of the body along {'xyz'[axis]} differ: only boxes, and cylinders and "
                           "rings along z (AXES=z), are pulled at")
            from_axis = np.linalg.norm(self.x[:, :2] - ((lower + upper) / 2)[:2], axis=1)
            section = pi * (from_axis + self.r).max()**2 if within else section - pi * (from_axis - self.r).min()**2
        return section

    def ends(self, axis):
        layer = LAYER * self.r.mean() * (1 - 1e-9)  # centres on its border are outside, at both ends
        return self.x[:, axis] < self.lower[axis] + layer, self.x[:, axis] > self.upper[axis] - layer

    def gripped(self, axis):
        """Bonds between the grips as they were, and within them; strength of each over the mean one."""
        pairs, relative = self.bonds
        ends, near = self.ends(axis), self.near_pairs
        glued = near[np.any([end[near].all(axis=1) for end in ends], axis=0)]
        within = np.any([end[pairs].all(axis=1) for end in ends], axis=0)
        strengths = np.concatenate([np.full(len(glued), GLUED), relative[~within]])
        return np.concatenate([glued, pairs[~within]]), strengths

    def largest_piece(self, pairs):
        """Which grains are in it."""
        piece = components(len(self.r), pairs)
        return piece == np.bincount(piece).argmax()

    def shares(self, axis):
        """Of the force on each end: those of the grains in its layer, in proportion to their sections. Grains that nothing
        joins to the body bear none."""
        joined = self.largest_piece(self.gripped(axis)[0]) if self.bonds else True
        shares = [np.where(end & joined, self.r**2, 0) for end in self.ends(axis)]
        if not all(share.any() for share in shares):
            refuse(65, f"{self.scene}: bonds do not join the ends of the packing along {'xyz'[axis]}: {MORE_BONDS}")
        return [share / share.sum() for share in shares]

    def write_forces(self, path, axis, stresses):
        """Forces on each end layer, a stress a second."""
        force = np.zeros((len(stresses), len(self.r), 3))
        for share, sign in zip(self.shares(axis), (-1, 1)):
            force[:, :, axis] += sign * self.section(axis) * np.outer(stresses, share)
        with h5py.File(self.packing) as packing, h5py.File(path, "w") as file:
            copy_groups(packing, file, without=["bonds"] if self.bonds else [])
            file.attrs["schema"] = "craquelure/forces/1"
            for name in list(file["summary"].attrs):
                del file["summary"].attrs[name]
            file["summary"].attrs.update(capillary_pressure=0., force_scale=1., first_period_end_time=0.,
                                         largest_force=np.abs(force).max())
            file["time"] = np.arange(len(stresses), dtype=float)
            file["saturation"] = np.linspace(1, 0, len(stresses))
            file["force"] = force
            if self.bonds:
                file["bonds/particles"], file["bonds/relative_strength"] = self.gripped(axis)

    def pull(self, axis, stresses, bond, how):
        """The response to STRESSES, an open file."""
        if bond:
            self.tests += 1
            self.tell(axis, stresses, bond)
        forces, response = (os.path.join(self.folder, name) for name in ("forces.h5", "response.h5"))
        self.write_forces(forces, axis, stresses)
        settings = (*(f"{key}={value!r}" for key, value in bond.items()), "support=free", "gravity=0", "snapshots=[0]",
                    "shrinkage.strain=0", "bridges.volume=0", "capillary.suction=0", *how)
        if self.bonds:  # as dem-replay found them, and drew their strengths
            settings += "bond.by=packing", "bond.strength.distribution=one"
        self.stage("dem-replay", *(word for setting in settings for word in ("-s", setting)), forces, "-o", response)
        return artifact(response, "response")

    def tell(self, axis, stresses, bond):
        """What is tested next, in a line."""
        if bond["bond.normal_strength"] == UNBREAKABLE:
            what = f"modulus and Poisson ratio with {bond['bond.shear_stiffness'] / bond['bond.normal_stiffness']:.4g} as shear over normal stiffness"
        else:
            what = f"strength, under stresses up to {max(stresses):.4g} Pa"
        if not self.quiet:
            print(f"test {self.tests}, along {'xyz'[axis]}: {what}", file=sys.stderr, flush=True)

    def tell_short(self, axes):
        """Along which of AXES the grips reach into the middle half."""
        for axis in axes:
            length = self.edge[axis] / self.r.mean()
            if length < 4 * LAYER and not self.quiet:
                print(f"{self.scene}: the packing is {length:.3g} mean radii long along {'xyz'[axis]}: where it is less than {4 * LAYER}, strain is "
                      "taken in part at the ends that are pulled at, and moduli may come out a tenth too low", file=sys.stderr, flush=True)

    def moduli(self, axis, bond, how=ELASTIC):
        """E and nu of bonds that do not break."""
        whole = {**bond, "bond.normal_strength": UNBREAKABLE, "bond.shear_strength": UNBREAKABLE}
        stress = 1e-9 * min(1, 2 * bond[THICKNESS])**2 * bond["bond.normal_stiffness"] * self.r.mean()  # thin ones bend
        with self.pull(axis, [0, stress], whole, how) as file:
            moved, pairs = file["snapshots/displacement"][-1], file["bonds/particles"][:]
            if summary(file)["steps_unsettled"]:
                refuse(3, f"{self.scene}: no equilibrium found along {'xyz'[axis]} with shear over normal stiffness "
                          f"{bond['bond.shear_stiffness'] / bond['bond.normal_stiffness']:.3g}: more bonds (pack.touching_gap) would "
                          "hold the body")
        gauge = self.largest_piece(pairs) & (np.abs(self.x[:, axis] - self.middle[axis]) < self.edge[axis] / 4)
        if gauge.sum() < 8:
            refuse(65, f"{self.scene}: bonds join only {gauge.sum()} grains in the middle of the packing along {'xyz'[axis]}: {MORE_BONDS}")
        places = np.column_stack([np.ones(gauge.sum()), self.x[gauge] - self.middle])
        gradient = np.linalg.lstsq(places, moved[gauge], rcond=None)[0][1:]
        strain = np.diag(gradient)
        return stress / strain[axis], -(strain.sum() - strain[axis]) / 2 / strain[axis]

    def moduli_in_time(self, axis, bond):
        """The same by time steps, with the friction of the scene."""
        return self.moduli(axis, bond, SLOW)

    def carried_under(self, axis, stresses, bond, how):
        """What the body carries under each of rising STRESSES: the part whose forces act on both ends of one
        piece. Forces on grains that were torn off an end count no more."""
        with self.pull(axis, stresses, bond, how) as file:
            pairs, broken, time = file["bonds/particles"][:], file["cracks/bond"][:], file["cracks/time"][:]
        ends = self.shares(axis)
        carried = []
        for k, stress in enumerate(stresses):
            intact = np.ones(len(pairs), bool)
            intact[broken[time <= k]] = False
            piece = components(len(self.r), pairs[intact])
            shares = [np.bincount(piece, weights=end, minlength=len(self.r)) for end in ends]
            carried.append(stress * np.minimum(*shares).sum())
        return np.array(carried)

    def breaks(self, axis, stress, bond):
        """Whether any bond breaks: not a matter of stiffness, so that nothing need move far."""
        with self.pull(axis, [0, stress], scaled(bond, "stiffness", 1e6), FAST) as file:
            return file["cracks/bond"].size > 0

    def rising(self, axis, bond):
        """Stresses that rise by an eighth, from one under which all bonds hold: far below their strength where they
        are thin, or where they are far stronger in one way than in the other."""
        weaker, stronger = strengths_of(bond)
        if not weaker > 0:
            refuse(65, f"{self.scene}: dem-replay.bond.normal_strength and .shear_strength must be above 0")
        first = -60 - 20 * int(log(stronger / weaker) / (20 * log(1.125)))
        for begin in range(first, first - 400, -20):
            if not self.breaks(axis, stronger * 1.125**begin, bond):
                return stronger * 1.125 ** np.arange(begin, 20)
        return refuse(3, f"{self.scene}: {stronger * 1.125**begin:.3g} Pa along {'xyz'[axis]} breaks bonds of {weaker:.3g} Pa")

    def strength(self, axis, bond, steps=60):
        """The largest stress carried: first by stresses that grow by an eighth, then in STEPS around it.
        Where displacements are small, stiff bonds break under the same stresses, and keep them small."""
        stiff = scaled(bond, "stiffness", max(1, stretch(bond) / (1e-7 * self.r.mean())))
        coarse = self.rising(axis, stiff)
        most = under = 0
        for begin in range(0, len(coarse), 5):  # since a body in pieces is slow
            some = coarse[begin:begin + 5]
            carried = self.carried_under(axis, [0, *some], stiff, FAST)
            if carried.max() > most:
                most, under = carried.max(), [0, *some][carried.argmax()]
            if carried[-1] < 0.5 * some[-1]:
                break
        else:
            refuse(3, f"{self.scene}: no stress along {'xyz'[axis]} up to {coarse[-1]:.3g} Pa parts the body")
        near = under * np.concatenate([np.linspace(0, 0.8, 9), np.linspace(0.82, 1.14, steps)])
        return self.carried_under(axis, near, stiff, FAST).max()

    def strength_in_time(self, axis, bond, guess):
        """The same by time steps, in which the stress rises by 1 % of GUESS each, so that grains hardly swing."""
        for most in 105, 130, 200, 400:  # no further than needed, since pieces take long to come to rest
            stresses = guess * np.arange(most + 1) / 100
            carried = self.carried_under(axis, stresses, bond, SLOW)
            if carried[-1] < 0.5 * stresses[-1]:
                return carried.max()
        return refuse(3, f"{self.scene}: by time steps no stress along {'xyz'[axis]} up to {stresses[-1]:.3g} Pa parts the body")


# ---- tables -----------------------------------------------------------------------------

def quiet_asked():
    """Whether -q is among the words of the call, which it is taken from."""
    quiet = "-q" in sys.argv[1:]
    sys.argv[1:] = [word for word in sys.argv[1:] if word != "-q"]
    return quiet


def axes_asked():
    """Those of AXES in the environment, x, y and z unless it says."""
    letters = os.environ.get("AXES") or "xyz"
    if not set(letters) <= set("xyz") or len(set(letters)) < len(letters):
        refuse(64, f"AXES: must be of x, y and z, got {letters}")
    return ["xyz".index(letter) for letter in letters]


def row(name, unit, values, wanted):
    found = described([float(v) for v in values])
    interval = "" if found["high"] is None else f" ± {found['high'] - found['mean']:.2g}"
    each = " | ".join(f"{v:.4g}" for v in values)
    wished = "" if wanted is None else f"{wanted:.4g}"
    print(f"| {name}, {unit} | {wished} | {found['mean']:.4g}{interval} | {each} |")


def show(axes, found, wanted):
    """Modulus, Poisson ratio and strength, FOUND along each of AXES, and as they were WANTED (None: they were not)."""
    print("| | wanted | mean, 95 % | " + " | ".join("xyz"[axis] for axis in axes) + " |\n" + "|---" * (3 + len(axes)) + "|")
    for name, unit, values, wish in zip(("Young's modulus", "Poisson ratio", "tensile strength"), ("Pa", "1", "Pa"), found, wanted):
        row(name, unit, values, wish)
