#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# What every tessellation must keep, also where geometry is at its worst: the cells fill the
# box, are closed, keep Euler's formula, and nodes have the same power to their grains; at any
# scale. Also elimination, and what must be refused.
import itertools
import os
import subprocess
import sys

import numpy as np

sys.path.insert(0, "tests")
from diagram import tessellate
from tap import BIN, done, ok, scratch

random = np.random.default_rng(5)
ALL, NONE = (True,) * 3, (False,) * 3


def sound(title, cells, power=True, euler=True):
    volume, leak = cells.volumes()
    facts = {"box": cells.box_error(), "leak": leak.max(), "euler": cells.euler(),
             "power": cells.equidistance(power), "finite": np.isfinite(cells.node).all(),
             "least volume": volume.min(), "nan": np.isnan(cells.clearance).any()}
    ok(facts["box"] < 1e-12 and facts["leak"] < 1e-11 and facts["power"] < 1e-12
       and (not euler or facts["euler"] == {2}) and facts["finite"] and not facts["nan"], title,
       facts)
    return cells


def lattice(kind, n):
    basis = {"sc": [[0, 0, 0]], "bcc": [[0, 0, 0], [.5, .5, .5]],
             "fcc": [[0, 0, 0], [.5, .5, 0], [.5, 0, .5], [0, .5, .5]],
             "hcp": [[0, 0, 0], [.5, .5, 0], [0, 1 / 3, .5], [.5, 5 / 6, .5]]}[kind]
    cell = np.array([1, 3**.5, (8 / 3)**.5] if kind == "hcp" else [1, 1, 1])
    at = np.array(list(itertools.product(range(n), repeat=3)))[:, None] + np.array(basis) + 0.1
    return at.reshape(-1, 3) * cell, n * cell


# Faces that have an area, their number for each cell, and the volume of a cell.
KNOWN = {"sc": (6, 1), "bcc": (14, 1 / 2), "fcc": (12, 1 / 4), "hcp": (12, 2**-.5)}


def check_lattice(kind, folder, noise, periodic):
    grains, edge = lattice(kind, 3)
    grains = grains * (1 + noise * random.uniform(-1, 1, grains.shape))
    cells = tessellate(grains, edge, folder, periodic=periodic, radius=0.3)
    sound(f"{kind}, noise {noise:g}, {'repeats' if periodic[0] else 'walls'}", cells)
    area = np.linalg.norm(cells.areas(), axis=1)
    real = cells.sides[area > 1e-6]
    count = np.bincount(real[real >= 0], minlength=len(grains))
    if periodic[0]:
        ok((count == KNOWN[kind][0]).all()
           and np.abs(cells.volumes()[0] - KNOWN[kind][1]).max() < 1e-12,
           f"  {KNOWN[kind][0]} faces, each cell {KNOWN[kind][1]:.4g}", np.unique(count))


def check_scales(folder):
    grains, radius = random.uniform(0, 1, (500, 3)), random.uniform(0.01, 0.06, 500)
    for periodic in (NONE, ALL):
        seen = []
        for scale in (1, 2.0**-30, 1e-9, 1e3):
            cells = tessellate(grains * scale, scale, folder, periodic=periodic,
                               radius=radius * scale)
            sound(f"grains in a box of {scale:g} m", cells)
            seen.append(cells)
        one = seen[0]
        ok(all(np.array_equal(one.ends, c.ends) and np.array_equal(one.corner, c.corner)
               for c in seen), "  the same network")
        ok(np.array_equal(seen[1].node, one.node * 2.0**-30), "  to the last digit for 2^-30")


def check_hard(folder):
    at = random.normal(0, 1, (10000, 3))
    sphere = 0.5 + 0.4 * at / np.linalg.norm(at, axis=1)[:, None]
    sound("10,000 grains on a sphere", tessellate(sphere, 1, folder, radius=1e-3))
    line = np.stack([np.linspace(0.1, 0.9, 9), np.full(9, 0.5), np.full(9, 0.5)], 1)
    sound("grains on a line", tessellate(line, 1, folder, radius=0.05))
    sound("grains on a line that repeats",
          tessellate(line, 1, folder, radius=0.05, periodic=ALL))
    layer = random.uniform(0, 1, (300, 3)) * [1, 0, 1] + [0, 0.05, 0]
    sound("a layer", tessellate(layer, [1, 0.1, 1], folder, radius=0.02))
    sound("a layer that repeats",
          tessellate(layer, [1, 0.1, 1], folder, radius=0.02, periodic=ALL))
    grid = np.stack(np.meshgrid(*[np.arange(5) + 0.5] * 2), -1).reshape(-1, 2)
    flat = np.stack([grid[:, 0], np.full(25, 0.5), grid[:, 1]], 1)
    sound("a square layer", tessellate(flat, [5, 1, 5], folder, radius=0.5))
    inside = np.array([[0.5, 0.5, 0.5], [0.52, 0.5, 0.5], [0.1, 0.1, 0.1]])
    cells = tessellate(inside, 1, folder, radius=np.array([0.3, 0.01, 0.05]))
    ok(1 not in cells.sides and b"1 grains without a cell" in np.bytes_(cells.model),
       "a grain inside a larger one has no cell, and is counted")
    one = sound("one grain that repeats", tessellate(np.full((1, 3), 0.3), 1, folder, periodic=ALL,
                                                     radius=0.5))
    ok(abs(one.clearance.min() - (2**.5 - 1) / 2) < 1e-12 and len(one.sides) == 7,
       "  a simple cubic lattice", one.clearance)


def check_elimination(folder):
    grains = random.uniform(0, 1, (1000, 3))
    for periodic in (NONE, (True, True, False)):
        whole = tessellate(grains, 1, folder, periodic=periodic)
        some = tessellate(grains, 1, folder, "--set", "boundary=eliminate", periodic=periodic)
        cut = np.unique(whole.sides[whole.sides[:, 1] < 0, 0])
        stays = np.setdiff1d(np.arange(1000), cut)
        wanted = np.isin(whole.sides, stays).any(1)
        ok(np.array_equal(some.sides, whole.sides[wanted])
           and np.array_equal(some.place, whole.place[wanted[whole.face]]),
           f"{len(stays)} of 1000 cells stay, as they are, after elimination")
        a, b = whole.volumes()[0][stays], some.volumes()[0][stays]
        ok(np.array_equal(a, b) and some.volumes()[1][stays].max() < 1e-12, "  whole")
        after = some.next_corner()
        step = some.corner_image[after] - some.corner_image
        swap = some.corner > some.corner[after]
        ends = np.where(swap[:, None], np.stack([some.corner[after], some.corner], 1),
                        np.stack([some.corner, some.corner[after]], 1))
        edges = np.unique(np.hstack([ends, np.where(swap[:, None], -step, step)]), axis=0)
        throats = np.hstack([some.ends, some.throat_image])
        ok(np.array_equal(edges, np.unique(throats, axis=0)),
           f"  its {len(throats)} throats are the edges of their faces")
        ok(set(np.unique(some.ends)) == set(range(len(some.node))), "  and no node is left alone")


def check_layer(title, grains, edge, radius, folder, around, nodes, throats, inner,
                clearance):
    """The network in the plane of a layer: K 3.3.6."""
    flat = np.stack([grains[:, 0], np.full(len(grains), radius), grains[:, 1]], 1)
    box = [edge[0], 2 * radius, edge[1]]
    net = tessellate(flat, box, folder, "--set", "dimensions=2", radius=radius)
    ok((net.node[:, 1] == 0).all() and np.array_equal(net.sides, [[i, -3] for i in range(
        len(grains))]), f"{title}: a polygon for each grain, in one plane")
    ok(len(net.node) - len(net.ends) + len(net.sides) == 1, "  Euler's formula of the plane")
    area = np.abs(net.areas()[:, 1]).sum()
    ok(abs(area / np.prod(edge) - 1) < 1e-12, "  which the polygons fill", area)
    degree = np.bincount(net.ends.ravel(), minlength=len(net.node))
    ok((degree[net.walls == 0] == around).all(), f"  {around} throats at every inner node")
    if clearance is None:
        return
    shape = len(net.node), len(net.ends)
    ok(shape == (nodes, throats), f"  {nodes} nodes and {throats} throats", shape)
    within = (net.walls[net.ends] == 0).all(1)
    ok(np.abs(net.clearance[within] - clearance).max() < 1e-12 and within.sum() == inner,
       "  clearance as in closed form", net.clearance[within])


def check_layers(folder):
    # 5 x 5 touching grains: from the middle of a square to its side half a diameter, to the
    # plane of the throats as much.
    grid = np.stack(np.meshgrid(*[np.arange(5) + 0.5] * 2), -1).reshape(-1, 2)
    check_layer("square layer", grid, [5, 5], 0.5, folder, 4, 36, 60, 24, 0.5**0.5 - 0.5)
    check_layer("random layer", random.uniform(0, 1, (200, 2)), [1, 1], 0.02, folder, 3, None,
                None, None, None)


def refused(title, grains, folder, *options, pattern, edge=1, periodic=NONE, radius=0.01):
    try:
        tessellate(grains, edge, folder, *options, periodic=periodic, radius=radius)
    except subprocess.CalledProcessError as error:
        again = subprocess.run(error.cmd, capture_output=True, text=True)
        ok(again.returncode == 65 and pattern in again.stderr and again.stderr.count("\n") == 1,
           title, again.stderr)
    else:
        ok(False, title, "was not refused")


with scratch() as folder:
    for kind, noise, periodic in itertools.product(KNOWN, (0, 1e-15), (ALL, NONE)):
        check_lattice(kind, folder, noise, periodic)
    check_scales(folder)
    check_hard(folder)
    check_elimination(folder)
    check_layers(folder)
    refused("grains not in one plane as a layer", random.uniform(0, 1, (5, 3)), folder, "--set",
            "dimensions=2", pattern="half way between the walls y")
    refused("two grains in one place", np.array([[.5, .5, .5], [.2, .2, .2], [.5, .5, .5]]), folder,
            pattern="row 2: has the same centre as row 0")
    refused("two grains in one place by repetition", np.array([[.25, .5, .5], [1.25, .5, .5]]),
            folder, periodic=ALL, pattern="has the same centre as row 0")
    refused("elimination that leaves nothing", random.uniform(0, 1, (5, 3)), folder, "--set",
            "boundary=eliminate", pattern="leaves no cell")
    cells = tessellate(random.uniform(0, 1, (50, 3)), 1, folder, periodic=ALL, radius=0.01)
    ended = subprocess.run([f"{BIN}/dry", "-q", os.path.join(folder, "cells.h5"), "-o",
                            os.path.join(folder, "dry.h5")], capture_output=True, text=True)
    ok(ended.returncode == 65 and "/domain/periodic" in ended.stderr,
       "dry refuses a network that repeats", ended.stderr)
done()
