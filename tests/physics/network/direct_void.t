#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# The direct solvers of tests/bench/void, which networks are judged by, against published series of
# lattices, on coarse grids: diffusivity within twice the error that they state, drag within 1 %.
import json
import os
import subprocess
import sys

import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, run, scratch, sets

BENCH = os.path.join(os.path.dirname(BIN), "tests/bench/void")
ENVIRONMENT = {**os.environ, "OMP_NUM_THREADS": "1"}


# Grains in a cell of edge 1, their radius at contact, and the coefficient of the first term of
# higher order in Rayleigh's series for diffusion [Sangani & Acrivos 1983].
LATTICES = {
    "sc": ([(.5, .5, .5)], .5, 1.3047),
    "bcc": ([(.25, .25, .25), (.75, .75, .75)], 3 ** .5 / 4, .129),
    "fcc": ([(.25, .25, .25), (.75, .75, .25), (.75, .25, .75), (.25, .75, .75)], 2 ** .5 / 4,
            .0753)}
# Drag over 6 pi mu a U in the simple cubic lattice, by the share of solid [Zick & Homsy 1982].
DRAG = {.125: 4.292, np.pi / 6: 42.14}


def packing(at, places, radius):
    """PLACES, shifted so that nothing lies on a plane of the grid."""
    grains = "".join(f"{x + .013:.17g} {y + .007:.17g} {z - .011:.17g} {radius:.17g}\n"
                     for x, y, z in places)
    run("pack", "-q", *sets("method=import", "check=none", "bonds=none", "lower=[0,0,0]",
                            "upper=[1,1,1]", "periodic=[true,true,true]"),
        "-o", at, input=grains.encode())
    return at


def solved(program, *arguments):
    return json.loads(subprocess.run([f"{BENCH}/{program}", *map(str, arguments)], check=True,
                                     stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                     env=ENVIRONMENT).stdout)


def series(solid, c1):
    """Relative diffusivity around grains that let nothing through."""
    return 1 - 3 * solid / (2 + solid - .75 * c1 * solid ** (10 / 3))


with scratch() as folder:
    at = os.path.join(folder, "packing.h5")
    for name, (places, contact, c1) in LATTICES.items():
        for share in .6, .8:
            radius = contact * share
            solid = len(places) * 4 / 3 * np.pi * radius ** 3
            found = solved("laplace", packing(at, places, radius), 16, 24, 32)
            wanted = series(solid, c1)
            # What the series leaves out is of the order of solid^(14/3).
            within = 2 * max(found["error"]) + .1 * solid ** (14 / 3)
            off = np.array(found["extrapolated"]) / wanted - 1
            ok(abs(off).max() < within < 3e-3, f"{name}, {share} contact radii: diffusivity of the series",
               (found, wanted))
            print(f"# off by {off}, {within:.1e} allowed")
    for solid, drag in DRAG.items():
        radius = (solid / (4 / 3 * np.pi)) ** (1 / 3)
        found = solved("stokes", packing(at, LATTICES["sc"][0], radius), 20, 28, 40)
        off = found["extrapolated"][0] * 9 * solid * drag / 2 - 1
        ok(abs(off) < .01, f"sc, {solid:.3f} solid: published drag", (found, off))
        print(f"# off by {off:+.1e}")
    done()
