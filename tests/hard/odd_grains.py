# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard cases of few grains, and of grains in odd places."""
import json
import re

import numpy as np

from cases import case, must
from networks import Network
from scene import CHAIN, QUASI_STATIC, write_forces
from tap import read


@case("overlap")
def overlap(scene):
    scene.stages("pack", "tessellate", "merge-nodes")
    most = scene.summary("pack", "max_overlap")
    must(abs(most - 0.5) < 1e-14, f"max_overlap {most}")
    closed = int(re.search(r"(\d+) throats without clearance", scene.model("tessellate"))[1])
    error = Network(scene, "tessellate").fills_the_box()
    must(closed > 0 and error < 1e-12, f"{closed} closed throats, cells off by {error:.1e}")
    scene.stage("dry")
    shut = scene.summary("dry", "shut_throats")
    must(0 < shut <= closed, f"{shut} throats shut")
    must(scene.get("dry", "history/saturation")[-1] == 0, "it does not end dry")
    return f"{closed} closed throats; dry: {shut:.0f} of those that merging leaves shut"


@case("coincident")
def coincident(scene):
    scene.stage("pack", "--set", "check=warn")
    scene.refused("tessellate", 65, "row 2: has the same centre as row 0")
    return scene.refused("pack", 65, "row 2: has the same centre as row 0")


@case("outside")
def outside(scene):
    scene.stage("pack", "--set", "check=warn")
    scene.refused("tessellate", 65, "row 1: the centre must be inside the box")
    return scene.refused("pack", 65, "row 1: the grain is wholly outside the box")


@case("floating")
def floating(scene):
    scene.stages("pack", "tessellate", "merge-nodes")
    net = Network(scene, "merge-nodes")
    must(2 in net.sides and net.fills_the_box() < 1e-12, "the floating grain has no cell")
    must(scene.get("pack", "bonds/particles").tolist() == [[0, 1]], "bonds are not just 0-1")
    force = np.zeros((2, 3, 3))
    force[:, 2] = 1e-3, -2e-3, 5e-4
    write_forces(scene, [0, 1], force)
    scene.stage("dem-replay")
    moved = scene.get("dem-replay", "snapshots/displacement")[-1]
    step = scene.summary("dem-replay", "time_step")
    cycles = scene.get("dem-replay", "history/cycles").sum()
    mass = 3230 * 4 / 3 * np.pi * 0.5**3
    flight = force[0, 2] / mass * step**2 * cycles * (cycles + 1) / 2  # leapfrog from rest
    error = np.abs(moved[2] - flight).max() / np.abs(flight).max()
    must(error < 1e-12, f"flight off by {error:.1e}")
    must((moved[:2] == 0).all(), "the pair moved")
    scene.stage("dem-replay", "-q", *QUASI_STATIC)
    moved = scene.get("dem-replay", "snapshots/displacement")[-1]
    gone = scene.summary("dem-replay", "gone_unbonded")
    must(gone == 1 and (moved[:2] == 0).all(), f"equilibria: {gone:g} left, or the pair moved")
    return f"flight as the closed form to {error:.1e}, the pair at rest; it leaves equilibria"


def few_grains(scene, nodes, throats, bonds):
    scene.stages(*CHAIN)
    net = Network(scene, "merge-nodes")
    must((len(net.node), len(net.ends)) == (nodes, throats),
         f"{len(net.node)} nodes, {len(net.ends)} throats")
    must(net.fills_the_box() < 1e-12 and net.euler() == {2}, "the cells are not right")
    must(len(scene.get("dem-replay", "bonds/particles")) == bonds, f"not {bonds} bonds")
    must(scene.get("dry", "history/saturation")[-1] == 0, "does not end dry")
    moved = scene.get("dem-replay", "snapshots/displacement")
    must(np.isfinite(moved).all(), "displacements are not finite")
    stats = json.loads(read(scene.at("crackstats")))
    must(stats["bonds"] == bonds, "crackstats counts other bonds")
    return f"{nodes} nodes, {throats} throats, {bonds} bonds, {stats['cracks']['total']:g} cracks"


case("one-grain")(lambda scene: few_grains(scene, 8, 12, 0))
case("two-grains")(lambda scene: few_grains(scene, 12, 20, 1))
case("no-grains")(lambda scene: scene.refused("pack", 65, "no grains"))
