#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Face by face beside voro++: random, packed, of many sizes, and in boxes that repeat.
import os
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from diagram import faces_differ, has_voro, tessellate, voro
from tap import done, ok, run, scratch, sets

if not has_voro():
    print("1..0 # SKIP voro++ is not installed")
    raise SystemExit

random = np.random.default_rng(4)
PERIODIC = [tuple(bool(k >> axis & 1) for axis in range(3)) for k in range(8)]


def compare(title, folder, grains, edge, periodic, radius=None):
    """voro++ writes six digits, and puts corners closer than about 1e-11 together."""
    power = "power" if radius is not None else "voronoi"
    mine = tessellate(grains, edge, folder, "--set", f"diagram={power}", periodic=periodic,
                      radius=radius)
    volume, faces = voro(grains, edge, folder, periodic, radius)
    spacing = (np.prod(np.broadcast_to(edge, 3)) / len(grains)) ** (1 / 3)
    wrong = faces_differ(mine.neighbours(), faces, 1e-5 * spacing**2)
    off = np.abs(mine.volumes()[0] - volume) / np.where(volume > 0, volume, 1)
    off = off.max()  # a hidden grain has no volume
    along = "".join(axis for axis, on in zip("xyz", periodic) if on) or "nothing"
    ok(wrong == 0 and off < 1e-4, f"{title}, {along} repeats: {len(grains)} cells, "
       f"{len(mine.sides)} faces", f"{wrong} cells differ, volumes by {off}")
    ok(mine.box_error() < 1e-12 and mine.volumes()[1].max() < 1e-12 and mine.euler() == {2},
       "  cells closed, filling the box", (mine.box_error(), mine.volumes()[1].max(), mine.euler()))


def packed(title, folder, *settings, power=False):
    """A packing of pack's own, grains in contact."""
    path = os.path.join(folder, "packed.h5")
    run("pack", "-q", "--set", "radius=0.05", *sets(*settings), "-o", path)
    with h5py.File(path) as file:
        grains, radius = file["particles/position"][()], file["particles/radius"][()]
        lower, upper = file["domain/lower"][()], file["domain/upper"][()]
        periodic = tuple(map(bool, file["domain/periodic"][()]))
    compare(title, folder, grains - lower, upper - lower, periodic, radius if power else None)


MANY = ["sizes.distribution=uniform", "sizes.smallest=0.02", "sizes.largest=0.06"]
CLOSE = ["method=radius_expansion", "count=200", "periodic=[true,true,true]"]
with scratch() as folder:
    box = "upper=[0.5,0.5,0.8]"
    packed("settled", folder, "method=deposition", box)
    packed("settled, many sizes", folder, "method=deposition", box, *MANY, power=True)
    packed("settled between sides that repeat", folder, "method=deposition", box, *MANY,
           "periodic=[true,true,false]", power=True)
    packed("close", folder, *CLOSE)
    packed("close, many sizes", folder, *CLOSE, *MANY, power=True)
    for periodic in PERIODIC:
        compare("random", folder, random.uniform(0, 1, (1000, 3)), 1, periodic)
    for periodic in (PERIODIC[0], PERIODIC[3], PERIODIC[7]):
        n = 1500
        radius = np.exp(random.normal(-3.2, 0.6, n))
        compare("many sizes", folder, random.uniform(0, 1, (n, 3)), 1, periodic, radius)
    for periodic in (PERIODIC[1], PERIODIC[7]):
        compare("flat box", folder, random.uniform(0, 1, (300, 3)) * [1, 0.7, 0.15],
                [1, 0.7, 0.15], periodic)
    for n in (1, 2, 5, 20):
        compare("few", folder, random.uniform(0, 1, (n, 3)), 1, PERIODIC[7])
done()
