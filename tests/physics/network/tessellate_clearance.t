#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Throat radii beside every grain of the packing, one after the other: the least distance from
# the throat to a centre, less the radius, 0 where that is below 0.
import os
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from diagram import of_packing, tessellate
from tap import done, ok, run, scratch, sets

random = np.random.default_rng(20)
SMALL = 200


def brute(d):
    """Of each throat of D, over all grains and, where the box repeats, their copies."""
    with h5py.File(d.path) as file:
        repeats = file["domain/periodic"][()].astype(bool)
        kind = file["particles/kind"][()] if "kind" in file["particles"] else 0 * d.radius
    solid = kind == 0
    first = d.node[d.ends[:, 0]]
    along = d.node[d.ends[:, 1]] + d.throat_image * d.edge - first
    square = (along**2).sum(1)
    square[square == 0] = 1
    boxes = (-2, -1, 0, 1, 2) if len(d.radius) < 50 else (-1, 0, 1)
    shifts = np.array(np.meshgrid(*[boxes if r else (0,) for r in repeats]))
    least = np.full(len(first), np.inf)
    for centre, radius in zip(d.centre[solid], d.radius[solid]):
        for shift in shifts.reshape(3, -1).T * d.edge:
            to = centre + shift - first
            t = np.clip((to * along).sum(1) / square, 0, 1)
            apart = np.linalg.norm(to - t[:, None] * along, axis=1) - radius
            np.minimum(least, apart, out=least)
    return np.maximum(least, 0)


def compare(title, d, narrowed=True):
    """To rounding; the grains beside the throat alone give another radius somewhere."""
    true = brute(d)
    spacing = (np.prod(d.edge) / len(d.radius)) ** (1 / 3)
    off = np.abs(d.clearance - true).max() / spacing
    with h5py.File(d.beside) as file:
        beside = file["throats/radius"][()]
    more = (beside > 1.1 * true).mean()
    ok(off < 1e-12, f"{title}: {len(true)} throats, {100 * (true == 0).mean():.1f} % closed, "
       f"{100 * more:.1f} % more than a tenth too wide by the grains beside them", off)
    ok((beside > d.clearance).any() == narrowed and (beside >= d.clearance).all(),
       "  by any grain never wider" + ("" if narrowed else ", nor narrower"))


def both(path, options, make):
    """The network by MAKE, and beside it that of the grains beside each throat."""
    d = make()
    d.path, d.beside = path + ".h5", path + "-beside.h5"
    run("tessellate", "-q", *options, "--set", "throat_radius=beside", path + "-packing.h5",
        "-o", d.beside)
    return d


def given(title, folder, grains, edge, radius, *options, periodic=(False,) * 3, narrowed=True):
    make = lambda: tessellate(grains, edge, folder, *options, periodic=periodic, radius=radius)
    compare(title, both(os.path.join(folder, "cells"), options, make), narrowed)


def packed(title, folder, *settings, options=(), narrowed=True):
    make = lambda: of_packing(folder, *settings, options=options)
    compare(title, both(os.path.join(folder, "own"), options, make), narrowed)


def sizes(n, spread):
    return np.exp(random.normal(-3.4, spread, n))


VORONOI = ("--set", "diagram=voronoi")
MANY = ["sizes.distribution=uniform", "sizes.smallest=0.02", "sizes.largest=0.06", "radius=0.04"]
with scratch() as folder:
    points = lambda n: random.uniform(0, 1, (n, 3))
    for spread in (0.1, 0.6, 1.2):
        for options in ((), VORONOI):
            given(f"overlapping, ln r +- {spread}{', Voronoi' * bool(options)}", folder,
                  points(SMALL), 1, 0.7 * sizes(SMALL, spread), *options)
    hundred = np.where(np.arange(SMALL) < 6, 0.15, 0.0015)
    given("1:100", folder, points(SMALL), 1, hundred)
    given("1:100, Voronoi", folder, points(SMALL), 1, hundred, *VORONOI)
    for periodic in ((True, False, False), (True, True, False), (True, True, True)):
        given(f"repeating {sum(periodic)} ways", folder, points(SMALL), 1, sizes(SMALL, 0.5),
              periodic=periodic)
    for n in (2, 6, 20):
        given(f"{n} grains in a box that repeats", folder, points(n), 1,
              np.linspace(0.02, 0.3, n), periodic=(True,) * 3, narrowed=n > 2)
    flat = points(SMALL) * [1, 0.7, 0.12]
    given("a flat box that repeats", folder, flat, [1, 0.7, 0.12], 0.5 * sizes(SMALL, 0.4),
          periodic=(True, False, True))
    given("far apart", folder, points(SMALL) * 1e3, 1e3, sizes(SMALL, 1))
    low = points(SMALL) * [1, 1, 0.2]
    given("under an empty space", folder, low, 1, 0.5 * sizes(SMALL, 0.5))

    box = ["upper=[0.5,0.5,0.5]", "method=random_sequential", *MANY]
    packed("apart", folder, *box)
    packed("cells left out", folder, *box, options=("--set", "boundary=eliminate"))
    packed("close", folder, "method=radius_expansion", "count=150", "periodic=[true,true,true]",
           *MANY)
    for shape, at in (("cylinder", ["domain.radius=0.3", "domain.height=0.5"]),
                      ("sphere", ["domain.radius=0.35"]),
                      ("ring", ["domain.radius=0.4", "domain.inner_radius=0.12",
                                "domain.height=0.4"])):
        packed(f"in a {shape}", folder, "method=random_sequential", f"domain.shape={shape}", *at,
               *MANY)
    layer = ("--set", "dimensions=2")
    packed("a layer", folder, "method=random_sequential", "dimensions=2",
           "upper=[1,0.12,1]", *MANY, options=layer)
    packed("grains of one size", folder, "method=random_sequential", "upper=[0.5,0.5,0.5]",
           "radius=0.04", narrowed=False)

    one, two = os.path.join(folder, "one.h5"), os.path.join(folder, "two.h5")
    own = os.path.join(folder, "own-packing.h5")
    run("pack", "-q", *sets(*box), "-o", own)
    for threads, path in (("1", one), ("2", two)):
        run("tessellate", "-q", "--threads", threads, own, "-o", path)
    with open(one, "rb") as a, open(two, "rb") as b:
        ok(a.read() == b.read(), "the same bytes with two threads")
done()
