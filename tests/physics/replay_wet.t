#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Liquid bridges at the contacts of a bonded lattice that nothing else loads: each contact and its
# bond are pressed by what the bridge pulls with, and so the lattice shrinks evenly.
import json
import os
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, SCENE, done, ok, run, scratch

STIFFNESS, BOND, SHARE, TENSION, VOLUME = 100.0, 8e13, 0.5858, 0.07, 1e-24
wet = [f"normal_stiffness={STIFFNESS}", f"shear_stiffness={STIFFNESS}",
       f"bond.normal_stiffness={BOND}", f"bond.shear_stiffness={BOND}",
       f"bond.radius_fraction={SHARE}", "bond.normal_strength=1e12", "bond.shear_strength=1e12",
       f"bridges.volume={VOLUME}", f"bridges.surface_tension={TENSION}",
       "bridges.contact_angle=30", "support=free", "time_step_safety=0.02", "cycles=4000"]

with scratch() as folder:
    at = lambda name: os.path.join(folder, name)
    settings = lambda words: [word for s in words for word in ("--set", s)]
    run("pack", "-p", SCENE, *settings(["counts=[3,3,3]"]), "-o", at("p"))
    run("tessellate", "-p", SCENE, at("p"), "-o", at("t"))
    run("merge-nodes", "-p", SCENE, at("t"), "-o", at("n"))
    run("dry", "-p", SCENE, at("n"), "-o", at("d"))
    run("force-protocol", "-p", SCENE, *settings(["steps=5"]), at("d"), "-o", at("forces"))
    with h5py.File(at("forces"), "r+") as file:
        file["force"][...] = 0
        place, radius = file["particles/position"][:], file["particles/radius"][0]
    run("dem-replay", "-p", SCENE, *settings(wet + ["snapshots=[0]"]), at("forces"), "-o", at("r"))
    curve = json.loads(subprocess.run(
        [f"{BIN}/bridge", "-q", *settings([f"radius={radius}", f"volume={VOLUME}", "points=2",
                                           f"surface_tension={TENSION}", "contact_angle=30",
                                           "model=willett-full"])],
        check=True, capture_output=True).stdout)
    pull = curve["force"][0]
    with h5py.File(at("r")) as file:
        moved = file["snapshots/displacement"][-1]
        ok(len(file["cracks/bond"]) == 0, "no bond breaks")
    overlap = pull / (STIFFNESS / 2 + BOND * np.pi * (SHARE * radius) ** 2)
    wanted = -(place - place.mean(axis=0)) / (2 * radius) * overlap
    moved = moved - moved.mean(axis=0)
    error = abs(moved - wanted).max() / overlap
    ok(error < 1e-4 and overlap > 1e-4 * radius, "shrinks by what bridges pull with", (error, overlap / radius))
    refused = subprocess.run([f"{BIN}/dem-replay", "-p", SCENE, at("forces"), "-o", at("none"),
                              *settings(wet + ["engine=quasi-static"])],
                             capture_output=True, text=True)
    ok(refused.returncode == 65 and "bridges" in refused.stderr, "equilibria refuse them",
       refused.stderr)
done()
