#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Equilibria of 1000 settled grains with friction, some hundred of whose contacts slip under each
# load: every load comes to rest, to the tolerance without dashpots.
import os
import sys

import h5py

sys.path.insert(0, "tests")
from tap import done, ok, run, scratch, sets

folder = scratch()
SCENE = ("-p", "samples/irregular-1000.json")
response = os.path.join(folder.name, "response")

network = run("merge-nodes", "-q", *SCENE, input=run(
    "tessellate", "-q", *SCENE, input=run("pack", "-q", *SCENE)))
forces = run("force-protocol", "-q", *SCENE, *sets("steps=6"), input=run("dry", "-q", *SCENE, input=network))
run("dem-replay", "-q", *SCENE, *sets(
    "engine=quasi-static", "bond.normal_stiffness=4e15", "bond.shear_stiffness=4e15", "bond.normal_strength=1e30",
    "bond.shear_strength=1e30"), "-o", response, input=forces)
with h5py.File(response) as file:
    settled, unbalanced = file["history/settled"][()], file["history/unbalanced_ratio"][()]
    moved, radius = file["summary"].attrs["largest_displacement"], file["particles/radius"][()].mean()
ok(settled.all(), "all loads come to rest", settled)
ok(unbalanced.max() < 1e-9, "and are balanced", unbalanced.max())
ok(0 < moved < 0.1 * radius, "displacements are small", moved / radius)
done()
