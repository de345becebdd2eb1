#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""At which strain a layer cracks, and Griffith's strain, as `make critical-thickness` reports them: against
finite elements for what a crack on a rigid floor releases, and a lattice in closed form."""
import json
import math
import os
import subprocess
import sys

import h5py
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

sys.path.insert(0, "tests")
from tap import done, ok, run, scratch_paths, sets

sys.path[:0] = ["pipelines/lib", "pipelines/studies/critical-thickness"]
import criterion

REPORT = "pipelines/studies/critical-thickness/report"


def stiffness(a, b, matrix):
    """Of a bilinear element of sides A and B, by 2 x 2 Gauss points."""
    total, at = np.zeros((8, 8)), 1 / math.sqrt(3)
    for s in -at, at:
        for t in -at, at:
            along_x = np.array([t - 1, 1 - t, 1 + t, -1 - t]) / (2 * a)
            along_y = np.array([s - 1, -1 - s, 1 + s, 1 - s]) / (2 * b)
            strain = np.zeros((3, 8))
            strain[0, 0::2] = strain[2, 1::2] = along_x
            strain[1, 1::2] = strain[2, 0::2] = along_y
            total += strain.T @ matrix @ strain * a * b / 4
    return total


def released(nu, count):
    """Z of G = Z sigma^2 h / E', E' = E/(1 - nu^2): the opening of a crack through a layer of height 1 and
    modulus 1 on a rigid floor in plane strain, under the stress 1 on its faces. COUNT elements over the
    height, finer near the floor and the crack."""
    x, y = 5 * np.linspace(0, 1, 2 * count + 1) ** 2, np.linspace(0, 1, count + 1) ** 1.5
    lame, shear = nu / ((1 + nu) * (1 - 2 * nu)), 1 / (2 * (1 + nu))
    matrix = np.array([[lame + 2 * shear, lame, 0], [lame, lame + 2 * shear, 0], [0, 0, shear]])
    node = np.arange(len(x) * len(y)).reshape(len(x), len(y))
    entries, load = [], np.zeros(2 * node.size)
    for i in range(len(x) - 1):
        for j in range(count):
            corner = np.array([node[i, j], node[i + 1, j], node[i + 1, j + 1], node[i, j + 1]])
            place = np.stack([2 * corner, 2 * corner + 1], axis=1).ravel()
            entries.append((np.repeat(place, 8), np.tile(place, 8),
                            stiffness(x[i + 1] - x[i], y[j + 1] - y[j], matrix).ravel()))
    for j in range(count):
        load[2 * node[0, j:j + 2]] -= (y[j + 1] - y[j]) / 2
    rows, columns, values = map(np.concatenate, zip(*entries))
    held = np.union1d(np.concatenate([2 * node[:, 0], 2 * node[:, 0] + 1]), 2 * node[-1])
    free = np.setdiff1d(np.arange(2 * node.size), held)
    whole = coo_matrix((values, (rows, columns))).tocsc()
    return load[free] @ spsolve(whole[free][:, free], load[free]) / (1 - nu * nu)


with open("samples/craquelure-40.json", encoding="utf-8") as file:
    bond = json.load(file)["dem-replay"]["bond"]
ratio = bond["shear_stiffness"] / bond["normal_stiffness"]
found = [released((1 - ratio) / (4 + ratio), count) for count in (8, 16)]
ok(abs(found[1] - found[0]) < 0.01 and abs(found[1] - criterion.RELEASED) < 0.01, "what a crack on a rigid floor releases", found)

# A lattice of touching grains: all bonds along it break at the strain s/(k 2R), and it carries k A 2R e
# in every one of them.
RADIUS, SIDE, STRENGTH, STIFFNESS = 0.26e-6, 6, 2e5, 5e13
AREA = math.pi * (0.5 * RADIUS) ** 2
SCENE = {"pack": {"method": "cubic", "radius": RADIUS, "counts": [SIDE, SIDE, SIDE], "periodic": [True, True, False]},
         "dem-replay": {"density": 2500, "normal_stiffness": 10, "shear_stiffness": 10,
                        "bond": {"normal_stiffness": STIFFNESS, "shear_stiffness": 2e13, "normal_strength": STRENGTH,
                                 "shear_strength": 1e12, "radius_fraction": 0.5},
                        "shrinkage": {"strain": 0.01, "steps": 40}, "cycles": 256, "ramp": 0, "tolerance": 1e-6,
                        "snapshots": [0]}}
with scratch_paths() as at:
    with open(at("layer.json"), "w", encoding="utf-8") as file:
        json.dump(SCENE, file)
    os.mkdir(at("6-1"))
    run("pack", "-q", "-p", at("layer.json"), "-o", at("layer.h5"))
    run("dem-replay", "-q", "-p", at("layer.json"), at("layer.h5"), "-o", at("6-1/response.h5"))
    subprocess.run([REPORT, "table", at("6-1/response.h5"), at("table.md")], check=True)
    with open(at("table.md"), encoding="utf-8") as file:
        cells = [float(cell) for cell in file.read().splitlines()[2].strip("|").split("|") if cell.strip()]
    breaks = STRENGTH / (STIFFNESS * 2 * RADIUS)
    ok(breaks - 0.01 / 40 < cells[1] <= breaks, "a lattice cracks at the last step below its strain at rupture", cells)
    layers, depth = SIDE - 1, 2 * RADIUS * SIDE - RADIUS
    slope = layers * STIFFNESS * AREA
    energy = STRENGTH ** 2 * AREA / (2 * STIFFNESS) * layers / (2 * RADIUS * depth)
    nu = (1 - 0.4) / (4 + 0.4)
    griffith = math.sqrt(energy / (criterion.RELEASED * (1 + nu) * slope))
    ok(abs(cells[3] - griffith) < 1e-4 and cells[2] == 0, "Griffith's strain of a lattice", f"{cells} {griffith}")

    # A small layer of unlike grains. With all stiffnesses twice as large it breaks at half the strain. Where suction
    # draws it together, Griffith's strain has the two surfaces of water that a crack makes as well.
    def replay(variant, scene, *settings):
        os.mkdir(at("3-1" + variant))
        run("dem-replay", "-q", "-p", scene, *sets("snapshots=[0.4]", *settings), at("small.h5"), "-o",
            at(f"3-1{variant}/response.h5"))
        return at(f"3-1{variant}/response.h5")

    DRY, WET = "samples/craquelure-40.json", "samples/craquelure-wet-40.json"
    run("pack", "-q", "-p", DRY, *sets("slab.upper=1.56e-6", "upper=[4.16e-6,4.16e-6,2.08e-6]"), "-o", at("small.h5"))
    slowly = "shrinkage.law=uniform", "cycles=48", "most_cycles=192"
    plain = replay("", DRY, *slowly, "shrinkage.strain=0.02")
    stiff = replay("-stiff", DRY, *slowly, "shrinkage.strain=0.01", "normal_stiffness=40", "shear_stiffness=20",
                   "bond.normal_stiffness=4.4e14", "bond.shear_stiffness=1.76e14")
    wet = replay("-suction", WET, "capillary.steps=8")
    subprocess.run([os.path.dirname(REPORT) + "/bonds", "table", plain, stiff, wet, at("bonds.md")], check=True)
    with open(at("bonds.md"), encoding="utf-8") as file:
        usual, half, drawn = ([float(cell) for cell in line.split("|")[3:-1]] for line in file.read().splitlines()
                              if line.startswith("|") and "---" not in line and "diameters" not in line)
    ok(abs(half[0] - usual[0] / 2) < 0.02 / 36 and abs(half[2] - usual[2] / 2) < 1e-4 and usual[0] > 0.01,
       "twice as stiff: half the strain", f"{usual} {half}")
    with h5py.File(plain) as dry, h5py.File(wet) as file:
        first = dry["history/lateral_tension"][1] / (0.02 * (1 - dry["history/saturation"][1]))
        step = file["history/lateral_tension"][:].argmax()
        tension, liquid = (file["history"][name][step] for name in ("lateral_tension", "liquid_volume"))
        height, radius = file["particles/position"][:, 2], file["particles/radius"][:]
        box = 4.16e-6 ** 2 * (height + radius).max() - 4.16e-6 ** 2 * (height - radius).min()
    bonds = usual[2] ** 2 * (1.8 / 2.3) ** 2  # Griffith's strains are as the square roots of energies
    both = bonds * (1 + 2 * 0.0727 * liquid / box / criterion.Layer(wet).toughness)
    ok(abs(drawn[0] - tension / 1e6) < 0.006 and abs(drawn[2] / (tension / first / math.sqrt(bonds)) - 1) < 0.03
       and abs(drawn[3] / (tension / first / math.sqrt(both)) - 1) < 0.03 and drawn[3] < drawn[2] / 1.5,
       "suction beside Griffith's criterion, with two surfaces of water", f"{drawn} {both / bonds}")

    # A slit in a wide lattice of the grains that it is made for: rows of centres at odd multiples of the radius,
    # the floor at 3.6 radii. Of the middle row of 15, 4 grains each way from the middle go, in 5 of 7 layers.
    SCENE["pack"]["counts"] = [15, 16, 7]
    with open(at("layer.json"), "w", encoding="utf-8") as file:
        json.dump(SCENE, file)
    run("pack", "-q", "-p", at("layer.json"), "-o", at("wide.h5"))
    subprocess.run([os.path.dirname(REPORT) + "/slit", at("wide.h5"), "4", at("slit.dump")], check=True)
    run("pack", "-q", "-s", "method=import", at("slit.dump"), "-o", at("slit.h5"))
    whole, cut = h5py.File(at("wide.h5")), h5py.File(at("slit.h5"))
    kept = {tuple(place) for place in cut["particles/position"][:]}
    gone = np.array([place for place in whole["particles/position"][:] if tuple(place) not in kept]) / RADIUS
    ok(len(gone) == 8 * 5 and np.ptp(gone[:, 0]) < 1 and abs(np.ptp(gone[:, 1]) - 14) < 1e-9 and gone[:, 2].min() > 4
       and all((whole[f"domain/{end}"][:] == cut[f"domain/{end}"][:]).all() for end in ("lower", "upper")),
       "a slit of one row, two thicknesses long, down to the floor", gone)
done()
