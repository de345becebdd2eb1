#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Lattices of grains whose networks have the coordination numbers of K Fig. 2.3: every node
# two grain radii and more from the walls; and they dry with correlated radii of two modes.
import os
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, run, scratch

with scratch() as folder:
    network, drying = os.path.join(folder, "network.h5"), os.path.join(folder, "drying.h5")
    for name in "2d-3", "2d-4", "2d-6", "3d-4", "3d-6", "3d-8":
        scene, wanted = f"samples/regular-{name}.json", int(name[-1])
        run("merge-nodes", "-p", scene, "-o", network,
            input=run("tessellate", "-p", scene, input=run("pack", "-p", scene)))
        file = h5py.File(network)
        nodes = file["nodes/position"][:]
        ends = file["throats/nodes"][:]
        depth = np.minimum(nodes - file["domain/lower"][:], file["domain/upper"][:] - nodes)
        deep = depth > 2.1 * file["particles/radius"][0]
        deep[:, 1] |= name.startswith("2d")
        count = np.bincount(ends.ravel(), minlength=len(nodes))[deep.all(axis=1)]
        ok(len(count) > 20 and (count == wanted).all(), f"{name}: {wanted} throats a node",
           np.bincount(count))
        run("dry", "--quiet", "-p", scene, "--set", "throat_radius.distribution=two_mode", "--set",
            "throat_radius.correlation_length=1e-3", network, "-o", drying)
        ok(h5py.File(drying)["history/saturation"][-1] == 0, f"{name}: dries")
done()
