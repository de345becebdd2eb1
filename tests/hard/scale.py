# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard cases of scale: nanometres and kilometres, from the packing to the cracks."""
import json
import os

import numpy as np

from cases import case, must
from scene import CHAIN, HERE, LIMITS

FACTORS = [(2.0**-8, 0), (2.0**32, 0), (1 / 250, 1e-9), (4e9, 1e-9)]


def rescaled(scene, factor):
    """The scene with every length times FACTOR, the rest so that it is alike."""
    new = json.loads(json.dumps(scene.json))
    powers = {("pack", "radius"): 1, ("dry", "throat_radius", "mean"): 1,
              ("dry", "throat_radius", "standard_deviation"): 1,
              ("dry", "boundary_layer", "mass_transfer"): -1,
              ("dem-replay", "bond", "normal_stiffness"): -2,
              ("dem-replay", "bond", "shear_stiffness"): -2,
              ("dem-replay", "bond", "normal_strength"): -1,
              ("dem-replay", "bond", "shear_strength"): -1}
    for path, power in powers.items():
        section = new
        for key in path[:-1]:
            section = section[key]
        section[path[-1]] *= factor**power
    return new


# Dataset, the power of the length it goes with.
ALIKE = {
    "merge-nodes": {"nodes/position": 1, "nodes/kind": 0, "throats/nodes": 0,
                    "throats/radius": 1, "throats/length": 1, "faces/nodes": 0,
                    "faces/offset": 0, "faces/particles": 0},
    "dry": {"history/time": 2, "history/saturation": 0, "history/rate": 1,
            "history/clusters": 0, "events/time": 2, "events/throat": 0,
            "changes/offset": 0, "changes/throat": 0, "changes/saturation": 0},
    "force-protocol": {"time": 2, "saturation": 0, "force": 1},
    "dem-replay": {"cracks/bond": 0, "cracks/mode": 0, "cracks/time": 2,
                   "cracks/position": 1, "history/cycles": 0, "history/cracks": 0,
                   "snapshots/displacement": 1, "snapshots/contact_force": 1,
                   "snapshots/bond_intact": 0}}
ALIKE["small"] = ALIKE["large"] = ALIKE["dem-replay"]  # equilibria, by displacements


def unlike(one, other, stage, factor):
    """The largest difference between two runs, of the largest value; inf where whole
    numbers differ."""
    worst = 0, ""
    for name, power in ALIKE[stage].items():
        a, b = one.get(stage, name), other.get(stage, name)
        if a.shape != b.shape or a.dtype.kind != "f" and not np.array_equal(a, b):
            return np.inf, f"{stage} {name} {a.shape} {b.shape}"
        if a.dtype.kind != "f" or a.size == 0:
            continue
        scaled = b / factor**power
        largest = np.abs(a).max()
        difference = np.abs(a - scaled).max() / (largest or 1)
        worst = max(worst, (difference, f"{stage} {name}"))
    return worst


def check_alike(base, parts, stages):
    worst = 0
    for factor, tolerance, part in parts:
        for stage in stages:
            difference, where = unlike(base, part, stage, factor)
            must(difference <= tolerance, f"times {factor:g}: {where} differs by {difference:.1e}")
            worst = max(worst, difference)
    return worst


@case("scale")
def scale(scene):
    cracks = []
    worst = 0
    for liquid in LIMITS:
        def run(name, factor):
            part = scene.copy(f"{liquid}-{name}", os.path.join(scene.folder, name + liquid))
            new = rescaled(scene, factor)
            new["dry"]["liquid"] = liquid
            with open(part.path, "w") as file:
                json.dump(new, file)
            part.stages(*CHAIN[:6])
            for how, word in (("small", "false"), ("large", "true")):
                part.stage("dem-replay", "-q", "--set", "engine=quasi-static", "--set",
                           f"quasi_static.large_displacements={word}", output=part.at(how))
            return part
        base = run("base", 1)
        parts = [(f, tolerance, run(str(k), f)) for k, (f, tolerance) in enumerate(FACTORS)]
        cracks += [len(base.get(how, "cracks/bond")) for how in ("dem-replay", "small", "large")]
        must(min(cracks) > 0, "no cracks to compare with")
        worst = max(worst, check_alike(base, parts, CHAIN[2:6]))
        # Where equilibria end, rounding decides what slips and breaks next.
        check_alike(base, [part for part in parts if part[1] == 0], ["small", "large"])
    return (f"{', '.join(map(str, cracks))} cracks, the same; off by {worst:.1e} at most, "
            "equilibria by nothing")


@case("scale-random")
def scale_random(scene):
    grains = np.loadtxt(os.path.join(HERE, "random.txt"))

    def run(name, factor):
        part = scene.copy(name)
        part.grains = os.path.join(part.folder, "grains.txt")
        with open(part.grains, "w") as file:
            file.writelines(" ".join(map(repr, row)) + "\n" for row in (grains * factor).tolist())
        part.stages(*CHAIN[:3])
        return part

    base = run("base", 1)
    parts = [(f, tolerance, run(str(f), f))
             for f, tolerance in ((2.0**-30, 0), (2.0**10, 0), (1e-9, 1e-9), (1e3, 1e-9))]
    worst = check_alike(base, parts, ["merge-nodes"])
    return f"{len(base.get('merge-nodes', 'throats/radius'))} throats, off by {worst:.1e} at most"
