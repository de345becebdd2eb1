# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard cases of the flow: whatever the packing, what flows in flows out, and the forces on the
solid sum to the pressure drop times the section."""
import os

import h5py
import numpy as np

from cases import case, must
from tap import sets

DROP = 3.0


def packing(scene, grains, *settings, periodic="[false,false,false]"):
    scene.grains = os.path.join(scene.folder, "grains.txt")
    with open(scene.grains, "w") as file:
        file.writelines(" ".join(map(repr, row)) + "\n" for row in np.asarray(grains, float).tolist())
    words = [f"periodic={periodic}", *settings]
    scene.stage("pack", *sets(*words))


def flow(scene, title, *settings, area=1.0):
    """The flow along z under DROP, whose books must close."""
    words = ["along=z", f"pressure_drop={DROP}", *settings]
    scene.stage("flow", *sets(*words), input=scene.at("pack"))
    file = h5py.File(scene.at("flow"))
    inflow = file["walls/inflow"][:]
    force = sum(file[f"{who}/{kind}_force"][:].sum(axis=0)
                for who in ("particles", "walls") for kind in ("viscous", "pressure"))
    force -= file["walls/pressure_force"][4:].sum(axis=0)  # of the two that drive it
    finite = all(np.isfinite(file[name][:]).all() for name in
                 ("walls/inflow", "particles/viscous_force", "particles/pressure_force"))
    must(finite, f"{title}: numbers that are not finite")
    leak = abs(inflow.sum()) / max(np.abs(inflow).max(), 1e-300)
    must(leak < 1e-12, f"{title}: in and out differ by {leak:.1e}")
    off = np.abs(force - [0, 0, DROP * area]).max() / (DROP * area)
    must(off < 1e-12, f"{title}: forces miss the drop times the section by {off:.1e}")
    return file, off


def corners(radius):
    return [(x, y, z, radius) for x in (.25, .75) for y in (.25, .75) for z in (.25, .75)]


@case("flow-few")
def few(scene):
    packing(scene, [(.5, .5, .5, .5)])
    worst = max(flow(scene, f"one sphere, {sides}", f"sides={sides}")[1]
                for sides in ("no-slip", "symmetric"))
    open(scene.grains, "w").close()
    reason = scene.refused("pack", 65, "no grains")
    return f"one sphere off by {worst:.1e}; none: {reason}"


@case("flow-flat")
def flat(scene):
    worst, count = 0, 0
    for method in ("cubic", "bcc", "fcc", "hexagonal"):
        for repeats in ("[false,false,false]", "[true,true,false]"):
            scene.stage("pack", "--set", f"method={method}", "--set", "counts=[3,3,3]", "--set",
                        "radius=0.1", "--set", f"periodic={repeats}")
            with h5py.File(scene.at("pack")) as file:
                edge = file["domain/upper"][:] - file["domain/lower"][:]
            worst = max(worst, flow(scene, f"{method}, {repeats}", area=edge[0] * edge[1])[1])
            count += 1
    random = np.random.default_rng(4)
    grains = [(*place, .05) for place in random.uniform(.1, .9, (60, 3)) * [1, 1, 0] + [0, 0, .5]]
    packing(scene, grains)  # all centres in one plane
    worst = max(worst, flow(scene, "a flat layer")[1])
    return f"{count} lattices and a flat layer, off by {worst:.1e}"


@case("flow-overlap")
def overlap(scene):
    packing(scene, corners(.36))
    file, worst = flow(scene, "overlap that closes all throats between four grains")
    closed = int(file["summary"].attrs["closed_throats"])
    must(closed > 0, "no throat is closed")
    # A shell of overlapping grains about a void: a pocket that nothing flows into.
    turn = np.random.default_rng(5).normal(size=(260, 3))
    shell = .5 + .22 * turn / np.linalg.norm(turn, axis=1)[:, None]
    packing(scene, [(*place, .09) for place in shell] + [(.5, .5, .5, .05)])
    file, off = flow(scene, "a pocket")
    pockets = int(file["summary"].attrs["pockets"])
    inside = file["particles/viscous_force"][-1]
    must(pockets > 0, "no pocket is found")
    must(np.abs(inside).max() < 1e-13 * DROP, f"a grain in a pocket is dragged by {inside}")
    return f"{closed} throats closed, {pockets} pockets; off by {max(worst, off):.1e}"


@case("flow-through-the-wall")
def through_the_wall(scene):
    random = np.random.default_rng(6)
    grains = [(*place, .2) for place in random.uniform(.02, .98, (40, 3))]
    packing(scene, grains)
    worst = max(flow(scene, f"grains that stick out, {sides}", f"sides={sides}")[1]
                for sides in ("no-slip", "symmetric"))
    packing(scene, corners(.1) + [(1.2, .5, .5, .1)])
    reason = scene.refused("flow", 65, "inside the box", input=scene.at("pack"))
    return f"off by {worst:.1e}; a centre outside: {reason}"


@case("flow-ratio-100")
def ratio_100(scene):
    random = np.random.default_rng(7)
    drag = []
    for share in (1e-2, 1e-1):
        packing(scene, corners(.25) + [(.5, .5, .5, .25 * share)])
        file, _ = flow(scene, f"one grain of {share} in a void")
        force = file["particles/viscous_force"][-1, 2] + file["particles/pressure_force"][-1, 2]
        drag.append(force)
    slope = np.log10(drag[1] / drag[0])
    floating = [(*place, .0025) for place in random.uniform(.4, .6, (30, 3))]
    packing(scene, corners(.25) + floating)
    file, worst = flow(scene, "thirty grains of a hundredth in a void")
    force = file["particles/pressure_force"][8:, 2]
    must((force > 0).all(), f"a small grain is pulled against the flow: {force.min()}")
    must(1.5 < slope < 3, f"the force on a grain in a void goes with the power {slope:.2f}")
    return f"force on a grain in a void goes with its size to the {slope:.2f}; off by {worst:.1e}"
