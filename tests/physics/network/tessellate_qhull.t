#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Networks of a layer beside qhull: a plane's power diagram is the lower side of the convex hull
# of its points lifted to z = x^2 + y^2 - r^2. Walls are made there by mirror images of all points.
import os
import shutil
import subprocess
import sys

import numpy as np

sys.path.insert(0, "tests")
from diagram import Diagram
from tap import done, ok, run, scratch, sets

if not shutil.which("qconvex"):
    print("1..0 # SKIP qhull is not installed")
    raise SystemExit


def lower_hull(points, weight):
    """Triangles of the lower hull, and the point of equal power to the corners of each: the plane
    through them is z = 2 centre . x + constant."""
    lifted = np.column_stack([points, (points**2).sum(1) - weight])
    text = f"3\n{len(lifted)}\n" + "\n".join("%.17g %.17g %.17g" % tuple(p) for p in lifted)
    said = subprocess.run(["qconvex", "Qt", "i", "n"], input=text, text=True, check=True,
                          stdout=subprocess.PIPE).stdout.split("\n")
    count = int(said[0])
    corners = np.array([line.split() for line in said[1:1 + count]], int)
    normal = np.array([line.split() for line in said[3 + count:3 + 2 * count]], float)[:, :3]
    below = normal[:, 2] < -1e-9
    return corners[below], -normal[below, :2] / (2 * normal[below, 2:])


def by_qhull(grains, weight, edge):
    """Length of the edge between every two grains, and between a grain and a wall, -1 to -4."""
    images = [grains, *(np.where(np.arange(2) == axis, 2 * at - grains, grains)
                        for axis in (0, 1) for at in (0, edge[axis]))]
    corners, centre = lower_hull(np.vstack(images), np.tile(weight, 5))
    n, beside = len(grains), {}
    for k, corner in enumerate(corners):
        for pair in ((0, 1), (1, 2), (0, 2)):
            beside.setdefault(tuple(sorted(corner[list(pair)])), []).append(k)
    found = {}
    for (i, j), triangles in beside.items():
        if i >= n or (j >= n and j % n != i) or len(triangles) < 2:
            continue
        side = j if j < n else -(j // n)
        found[i, side] = np.linalg.norm(centre[triangles[0]] - centre[triangles[1]])
    return found


def by_network(net):
    """The same from the polygons of a layer's network, whose walls are 1, 2, 16 and 32."""
    after, beside, found = net.next_corner(), {}, {}
    grain = net.sides[net.face, 0]
    for k, (a, b) in enumerate(zip(net.corner, net.corner[after])):
        beside.setdefault((min(a, b), max(a, b)), []).append(grain[k])
    for (a, b), grains in beside.items():
        walls = net.walls[a] & net.walls[b]
        side = max(grains) if len(grains) == 2 else -1 - [1, 2, 16, 32].index(walls)
        found[min(grains), side] = np.linalg.norm(net.node[a] - net.node[b])
    return found


def compare(title, folder, *settings):
    path = os.path.join(folder, "layer")
    run("pack", "-q", "--set", "dimensions=2", *sets(*settings), "-o", path + "-packing.h5")
    run("tessellate", "-q", "--set", "dimensions=2", path + "-packing.h5", "-o", path + ".h5")
    net = Diagram(path + ".h5")
    spacing = np.sqrt(net.edge[0] * net.edge[2] / len(net.radius))
    at = (net.centre - net.lower)[:, [0, 2]]
    ours = by_network(net)
    theirs = by_qhull(at / spacing, (net.radius / spacing)**2, net.edge[[0, 2]] / spacing)
    lasting = lambda found, unit: {k: v / unit for k, v in found.items() if v > 1e-8 * unit}
    ours, theirs = lasting(ours, spacing), lasting(theirs, 1)
    off = max((abs(ours[k] - theirs[k]) for k in ours.keys() & theirs.keys()), default=1)
    differ = ours.keys() ^ theirs.keys()
    ok(not differ and off < 1e-10 and len(ours) > 2 * len(at),
       f"{title}: {len(at)} polygons, {len(ours)} edges", (off, sorted(differ)[:10]))


SIZES = ["sizes.distribution=lognormal", "sizes.spread=0.4"]
with scratch() as folder:
    loose = ["method=random_sequential", "radius=0.01", "upper=[1,1,1]", "count=800"]
    compare("loose grains", folder, *loose)
    compare("loose grains of many sizes", folder, *loose, *SIZES)
    compare("grains from the walls inwards", folder, "method=inward_spiral", "radius=0.02",
            "upper=[1,1,1]", *SIZES)
    compare("grains of a few nanometres", folder, "method=inward_spiral", "radius=2e-9",
            "upper=[1e-7,1e-7,1e-7]", *SIZES)
    compare("overlapping grains", folder, "method=poisson", "radius=0.01", "upper=[1,1,1]",
            "count=1000", *SIZES)
done()
