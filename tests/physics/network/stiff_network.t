#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# The pore network of the stiff aggregate [K 5.1], out of an exactly degenerate lattice: 8
# cospherical grains around every void.
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import SCENE, done, ok, run, scratch_paths

with scratch_paths() as at:
    run("pack", "-p", SCENE, "-o", at("packing.h5"))
    run("tessellate", "-p", SCENE, at("packing.h5"), "-o", at("tessellation.h5"))
    run("merge-nodes", "-p", SCENE, at("tessellation.h5"), "-o", at("network.h5"))
    run("merge-nodes", "-p", SCENE, at("network.h5"), "-o", at("again.h5"))

    packing = h5py.File(at("packing.h5"))
    ok(packing["particles/radius"].shape == (250,), "250 grains")
    ok(packing["bonds/particles"].shape == (625, 2), "625 bonds")
    ok(abs(packing["summary"].attrs["porosity"] - (1 - np.pi / 6)) < 1e-14,
       "porosity of a simple cubic lattice, 1 - pi/6")

    # Before merging: 5 or 6 tetrahedra share each void's centre.
    tessellation = h5py.File(at("tessellation.h5"))
    throats = np.bincount(tessellation["throats/nodes"][:].ravel())
    inner = tessellation["nodes/kind"][:] == 0
    ok((throats[inner] == 4).all(), "before merging every inner node has 4 throats")
    ok((~inner).sum() == 396 - 144, "nodes on walls are already one each")

    network = h5py.File(at("network.h5"))
    diameter = 2 * 250e-9
    nodes = network["nodes/position"][:] / diameter
    lattice = np.array([(x, y, z) for x in range(6) for y in range(6) for z in range(11)])
    order = np.lexsort(np.rint(nodes).T[::-1])
    ok(nodes.shape == (396, 3) and np.abs(nodes[order] - lattice).max() < 1e-12,
       "the nodes are the 6 x 6 x 11 lattice")
    ends = network["throats/nodes"][:]
    ok(len(ends) == 5 * 6 * 11 * 2 + 6 * 6 * 10, "1020 throats")
    ok(np.allclose(network["throats/length"][:], diameter, rtol=1e-12, atol=0),
       "each as long as a grain is wide")
    ok(np.allclose(network["throats/radius"][:], (np.sqrt(2) - 1) * 250e-9, rtol=1e-12, atol=0),
       "each with clearance (sqrt 2 - 1) R")
    inner = network["nodes/kind"][:] == 0
    ok(inner.sum() == 4 * 4 * 9 and (np.bincount(ends.ravel())[inner] == 6).all(),
       "each of the 144 inner nodes has 6 throats")

    # The cells: closed polyhedra around each grain.
    sides = network["faces/particles"][:]
    offset = network["faces/offset"][:]
    loops = [network["faces/nodes"][a:b] for a, b in zip(offset, offset[1:])]
    index = {tuple(pair): t for t, pair in enumerate(ends)}
    edges = [set() for _ in range(250)]
    corners = [set() for _ in range(250)]
    faces = np.zeros(250, int)
    for pair, loop in zip(sides, loops):
        around = {index[tuple(sorted(e))] for e in zip(loop, np.roll(loop, -1))}
        for grain in pair[pair >= 0]:
            edges[grain] |= around
            corners[grain] |= set(loop)
            faces[grain] += 1
    ok({len(e) for e in edges} == {12}, "each grain faces 12 throats")
    ok(all(len(c) - len(e) + f == 2 for c, e, f in zip(corners, edges, faces)),
       "Euler's formula holds for every cell")
    ok(len(sides) == 625 + 250 and (sides[:, 1] < 0).sum() == 250,
       "a face for each bond, and one for each of the 250 grain diameters squared of wall")

    with open(at("network.h5"), "rb") as one, open(at("again.h5"), "rb") as two:
        a, b = h5py.File(one), h5py.File(two)
        ok(all(np.array_equal(a[f"{g}/{n}"], b[f"{g}/{n}"])
               for g in ("nodes", "throats", "faces") for n in a[g]),
           "merging again changes nothing")
done()
