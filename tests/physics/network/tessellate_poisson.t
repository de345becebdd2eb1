#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# The cells of Poisson points, in a box that repeats so that none is cut, beside their exact
# means: Meijering's faces, vertices and edges.
import sys

import numpy as np

sys.path.insert(0, "tests")
from diagram import tessellate
from tap import done, ok, scratch

N = 100000
random = np.random.default_rng(7)

with scratch() as folder:
    cells = tessellate(random.uniform(0, 1, (N, 3)), 1, folder, periodic=(True,) * 3)

faces = np.bincount(cells.sides.ravel(), minlength=N)
sides = np.bincount(cells.sides.ravel(), weights=np.repeat(cells.size, 2), minlength=N)
edges = sides / 2  # each edge of a cell lies in two of its faces
name = [np.concatenate([(cells.sides[cells.face, s].astype(np.int64) << 32)
                        | (cells.corner.astype(np.int64) << 9)
                        | ((cells.corner_image - s * cells.face_image[cells.face] + 4)
                           @ [64, 8, 1]) for s in (0, 1)])]
vertices = np.bincount(np.unique(name) >> 32, minlength=N)

exact = 48 * np.pi**2 / 35
for what, values, mean in (("faces", faces, 2 + exact), ("vertices", vertices, 2 * exact),
                           ("edges", edges, 3 * exact)):
    error = values.std() / np.sqrt(N)
    off = values.mean() - mean
    ok(abs(off) < 3 * error, f"{values.mean():.4f} {what} a cell: {mean:.4f} within three "
       f"standard errors of {error:.4f}", off)
ratio = sides.sum() / faces.sum()
error = (sides - ratio * faces).std() / faces.mean() / np.sqrt(N)  # of a ratio of means
ok(abs(ratio - 6 * exact / (2 + exact)) < 3 * error,
   f"{ratio:.4f} edges a face: {6 * exact / (2 + exact):.4f} within three standard errors of "
   f"{error:.4f}", ratio)
ok((vertices - edges + faces == 2).all(), "Euler's formula holds for every cell")
ok((2 * edges == 3 * vertices).all(), "three edges meet in every vertex of a cell")
degree = np.bincount(cells.ends.ravel(), minlength=len(cells.node))
ok((degree == 4).all(), "four throats meet in every node")
ok(len(cells.node) * 4 == vertices.sum(), "every node is a vertex of four cells")
ok(len(cells.node) - len(cells.ends) + len(cells.sides) - N == 0, "Euler's formula of the torus")
ok(cells.box_error() < 1e-12, "the cells fill the box to 1e-12", cells.box_error())
ok(cells.equidistance(False) < 1e-12, "nodes as far from all their grains to 1e-12 of the spacing",
   cells.equidistance(False))
done()
