# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard cases of the tessellation."""
import itertools
import os
import re

import numpy as np

from cases import case, must
from diagram import Diagram
from tap import sets

ALL, NONE = [True] * 3, [False] * 3


def network(scene, grains, *pack, tessellate=(), upper=None, periodic=NONE):
    """The diagram of GRAINS (n,4) with their radii."""
    scene.grains = os.path.join(scene.folder, "grains.txt")
    with open(scene.grains, "w") as file:
        file.writelines(" ".join(map(repr, row)) + "\n" for row in np.asarray(grains).tolist())
    words = [f"periodic={str(list(periodic)).lower()}", *pack]
    if upper is not None:
        words += ["lower=[0,0,0]", f"upper={list(map(float, upper))}"]
    scene.stage("pack", *sets(*words))
    scene.stage("tessellate", *sets(*tessellate))
    return Diagram(scene.at("tessellate"))


def sound(cells, title="", power=True, euler={2}):
    """The worst of what must vanish."""
    volume, leak = cells.volumes()
    must(np.isfinite(cells.node).all() and np.isfinite(cells.clearance).all(),
         f"{title}: numbers that are not finite")
    must(cells.box_error() < 1e-12, f"{title}: cells miss the box by {cells.box_error():.1e}")
    must(leak.max() < 1e-11, f"{title}: a cell is open by {leak.max():.1e}")
    must(cells.euler() == euler, f"{title}: Euler's formula gives {cells.euler()}")
    spread = cells.equidistance(power)
    must(spread < 1e-12, f"{title}: nodes differ by {spread:.1e} spacings from their grains")
    return max(cells.box_error(), spread)


def with_radius(places, radius):
    return np.column_stack([places, np.broadcast_to(radius, len(places))])


@case("cospherical")
def cospherical(scene):
    worst, count = 0, 0
    for method, periodic in itertools.product(("cubic", "bcc", "fcc", "hexagonal"), (ALL, NONE)):
        title = f"{method}, {'repeats' if periodic[0] else 'walls'}"
        scene.stage("pack", "--set", f"method={method}", "--set",
                    f"periodic={str(periodic).lower()}")
        scene.stage("tessellate")
        cells = Diagram(scene.at("tessellate"))
        worst = max(worst, sound(cells, title))
        inner = np.ones(len(cells.radius), bool)
        inner[cells.sides[cells.sides[:, 1] < 0, 0]] = False
        volume = cells.volumes()[0][inner]
        off = np.ptp(volume) / volume.mean()
        must(len(volume) > 5 and (off < 1e-12 or periodic is NONE),
             f"{title}: volumes differ by {off:.1e}")
        around = np.bincount(cells.ends.ravel(), minlength=len(cells.node))
        must((around[cells.walls == 0] == 4).all(), f"{title}: a node without 4 throats")
        count += 1
    return f"{count} lattices, off by {worst:.1e} at most"


@case("layer-in-3d")
def layer_in_3d(scene):
    random = np.random.default_rng(1)
    place = random.uniform(0, 1, (300, 3)) * [1, 0, 1] + [0, 0.05, 0]
    grains = with_radius(place, 0.02)
    solid = network(scene, grains)
    worst = sound(solid, "the layer")
    flat = network(scene, grains, tessellate=["dimensions=2"])
    area = np.zeros(300)
    np.add.at(area, flat.sides[:, 0], np.abs(flat.areas()[:, 1]))
    off = np.abs(solid.volumes()[0] / (0.1 * area) - 1).max()
    must(off < 1e-12, f"prisms differ from the polygons by {off:.1e}")
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    askew = (place - [0.5, 0.05, 0.5]) @ turn * 0.5 + 0.5
    for periodic in (NONE, ALL):
        title = "askew, repeats" if periodic[0] else "askew"
        cells = network(scene, with_radius(askew, 0.02), upper=[1, 1, 1], periodic=periodic)
        worst = max(worst, sound(cells, title))
    return f"prisms off by {off:.1e}, boxes by {worst:.1e}"


@case("on-the-wall")
def on_the_wall(scene):
    random = np.random.default_rng(2)
    place = random.uniform(0.1, 0.9, (50, 3))
    for axis, at in itertools.product(range(3), (0.0, 1.0)):
        place[7] = 0.5
        place[7, axis] = at
        network(scene, with_radius(place[:1], 0.01))  # writes the file of grains
        with open(scene.grains, "w") as file:
            file.writelines(" ".join(map(repr, row)) + " 0.01\n" for row in place.tolist())
        scene.stage("pack")
        reason = scene.refused("tessellate", 65, "row 7: the centre must be inside the box")
    worst = 0
    for hair in (1e-3, 1e-6, 1e-9):
        place[7] = hair, 0.5, 1 - hair
        worst = max(worst, sound(network(scene, with_radius(place, 0.01)), f"{hair} inside"))
    sides = []
    for at in (0.0, 1.0, -3.0, 1 - 2.0**-53):
        place[7] = at, 0.5, 0.5
        cells = network(scene, with_radius(place, 0.01), periodic=ALL)
        worst = max(worst, sound(cells, "on a side that repeats"))
        sides.append(cells)
    must(all(np.array_equal(c.node, sides[0].node) and np.array_equal(c.corner, sides[0].corner)
             for c in sides[:3]), "a side that repeats has two sides")
    return f"{reason}; inside off by {worst:.1e}"


@case("hidden")
def hidden(scene):
    random = np.random.default_rng(3)
    large = with_radius(random.uniform(0.05, 0.95, (200, 3)), random.uniform(0.08, 0.12, 200))
    small = with_radius(large[:, :3] + random.uniform(-0.01, 0.01, (200, 3)), 0.001)
    place = np.concatenate([large, small])
    order = random.permutation(400)
    worst = 0
    for periodic in (NONE, ALL):
        both = network(scene, place[order], periodic=periodic)
        count = int(re.search(rb"(\d+) grains without a cell", np.bytes_(both.model))[1])
        worst = max(worst, sound(both))
        seen = np.zeros(400, bool)
        seen[both.sides[both.sides >= 0]] = True
        must(count == (~seen).sum() and seen[order >= 200].sum() == 0,
             f"{count} hidden, {(~seen).sum()} without faces")
        alone = network(scene, place[order[seen]], periodic=periodic)
        same = np.array_equal(both.ends, alone.ends) and np.array_equal(both.corner, alone.corner)
        off = np.abs(both.node - alone.node).max() if same else 1
        must(off < 1e-12, f"the network is not that of the others: off by {off:.1e}")
    return f"{count} hidden, nodes off by {off:.1e}, cells by {worst:.1e}"


@case("on-a-sphere")
def on_a_sphere(scene):
    at = np.random.default_rng(4).normal(size=(10000, 3))
    at = 0.5 + 0.4 * at / np.linalg.norm(at, axis=1)[:, None]
    cells = network(scene, with_radius(at, 1e-4))
    return f"{len(cells.node)} nodes, off by {sound(cells):.1e}"


@case("collinear")
def collinear(scene):
    along = np.linspace(0.1, 0.9, 9)[:, None] * np.ones(3)
    axis = along * [1, 0, 0] + [0, 0.5, 0.5]
    lines = {"along x": axis, "along the diagonal": along, "askew": along * [0.9, 0.3, 0.5],
             "two lines": np.concatenate([axis, along[along[:, 0] != 0.5] * [0, 1, 0]
                                          + [0.5, 0, 0.5]])}
    worst = 0
    for (name, places), periodic in itertools.product(lines.items(), (NONE, ALL)):
        cells = network(scene, with_radius(places, 0.03), periodic=periodic)
        worst = max(worst, sound(cells, f"{name}{', repeats' if periodic[0] else ''}"))
    return f"{2 * len(lines)} of them, off by {worst:.1e}"


@case("duplicates")
def duplicates(scene):
    place = np.random.default_rng(5).integers(100, 900, (30, 3)) / 1024
    for name, twin, radius, periodic in (("one size", 0, 0.05, NONE), ("two sizes", 0, 0.02, NONE),
                                         ("by repetition", 1, 0.05, ALL),
                                         ("nearly", 1e-16, 0.05, NONE)):
        grains = with_radius(np.concatenate([place, place[3:4] + twin]), 0.05)
        grains[30, 3] = radius
        scene.grains = os.path.join(scene.folder, "grains.txt")
        np.savetxt(scene.grains, grains, fmt="%.17g")
        words = ["--set", f"periodic={str(periodic).lower()}"]
        scene.refused("pack", 65, "row 30: has the same centre as row 3", *words)
        scene.stage("pack", *words, "--set", "check=warn")
        reason = scene.refused("tessellate", 65, "row 30: has the same centre as row 3")
    near = np.concatenate([place, place[3:4] + [1e-9, 0, 0]])
    cells = network(scene, with_radius(near, 0.05))
    worst = sound(cells, "a nanometre apart")
    volume = cells.volumes()[0]
    must(volume[3] > 0 and volume[30] > 0, "one of two has no cell")
    return f"{reason}; apart, off by {worst:.1e}"


@case("one-grain-wide")
def one_grain_wide(scene):
    random = np.random.default_rng(6)
    worst = 0
    for upper in ([1, 1, 8], [8, 1, 8], [1, 8, 1]):
        for count in (8, 64):
            grains = with_radius(random.uniform(0, 1, (count, 3)) * upper, 0.2)
            cells = network(scene, grains, periodic=ALL, upper=upper)
            worst = max(worst, sound(cells, f"{count} grains in {upper}"))
    chain = with_radius(np.stack([[0.3] * 8, [0.6] * 8, np.arange(8) + 0.5], 1), 0.5)
    cells = network(scene, chain, periodic=ALL, upper=[1, 1, 8])
    worst = max(worst, sound(cells, "a chain"))
    must(np.abs(cells.volumes()[0] - 1).max() < 1e-12, "cells of the chain are not cubes")
    pillar = with_radius([[0.5, 0.5, z + 0.5] for z in range(3)], 0.5)
    cells = network(scene, pillar, periodic=[True, True, False], upper=[1, 1, 3])
    worst = max(worst, sound(cells, "a pillar of grains"))
    must((cells.ends[:, 0] == cells.ends[:, 1]).any(), "no throat around the box")
    one = network(scene, with_radius(np.full((1, 3), 0.2), 0.5), periodic=ALL)
    worst = max(worst, sound(one, "one grain"))
    off = abs(one.clearance.min() - (2**0.5 - 1) / 2)
    must(off < 1e-12, f"one grain: clearance off by {off:.1e}")
    for thin in (0.1, 0.02, 0.002):
        grains = with_radius(random.uniform(0, 1, (50, 3)) * [1, thin, 1], 0.3 * thin)
        cells = network(scene, grains, periodic=ALL, upper=[1, thin, 1])
        worst = max(worst, sound(cells, f"{thin} m thin"))
    return f"off by {worst:.1e}"


@case("scale-nodes")
def scale_nodes(scene):
    grains = np.loadtxt(os.path.join(os.path.dirname(__file__), "random.txt"))
    worst = 0
    for scale, power in itertools.product((1e-9, 1e-6, 1, 1e3), (True, False)):
        cells = network(scene, grains * scale, upper=[scale] * 3,
                        tessellate=[f"diagram={'power' if power else 'voronoi'}"])
        worst = max(worst, sound(cells, f"{scale} m", power))
    return f"off by {worst:.1e} at most"
