# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard cases of networks: lattices, exact and nearly so, radii of 1:100, random points."""
import os

import numpy as np

from cases import case, must
from scene import CHAIN, HERE


class Network:
    def __init__(self, scene, stage):
        get = lambda name: scene.get(stage, name)
        self.centre, self.radius = get("particles/position"), get("particles/radius")
        self.lower, self.upper = get("domain/lower"), get("domain/upper")
        self.node, self.walls = get("nodes/position"), get("nodes/kind")
        self.ends = get("throats/nodes")
        offset, nodes = get("faces/offset"), get("faces/nodes")
        self.loops = [nodes[a:b] for a, b in zip(offset, offset[1:])]
        self.sides = get("faces/particles")
        self.throats_at = np.bincount(self.ends.ravel(), minlength=len(self.node))
        self.inner = self.walls == 0

    def cells(self):
        """Volume of each cell, as the sum of pyramids over its faces, and the sum of its
        face normals times areas, which is zero when it is closed."""
        n = len(self.radius)
        volume, leak = np.zeros(n), np.zeros((n, 3))
        for (i, j), loop in zip(self.sides, self.loops):
            corner = self.node[loop] - self.centre[i]
            area = 0.5 * np.cross(corner[1:-1] - corner[0], corner[2:] - corner[0]).sum(0)
            if j < 0:
                outward = np.zeros(3)
                outward[(-1 - j) // 2] = 1 if (-1 - j) % 2 else -1
            else:
                outward = self.centre[j] - self.centre[i]
            if area @ outward < 0:
                area = -area
            volume[i] += area @ corner[0] / 3
            leak[i] += area
            if j >= 0:
                volume[j] -= area @ (self.node[loop[0]] - self.centre[j]) / 3
                leak[j] -= area
        return volume, np.linalg.norm(leak, axis=1)

    def fills_the_box(self):
        """The error of the sum of cells, of the box."""
        box = np.prod(self.upper - self.lower)
        return abs(self.cells()[0].sum() - box) / box

    def euler(self):
        """Corners - edges + faces of each cell that has faces."""
        n = len(self.radius)
        corners, edges, faces = ([set() for _ in range(n)] for _ in range(3))
        for f, (pair, loop) in enumerate(zip(self.sides, self.loops)):
            around = {tuple(sorted(e)) for e in zip(loop, np.roll(loop, -1))}
            for grain in pair[pair >= 0]:
                corners[grain].update(loop)
                edges[grain] |= around
                faces[grain].add(f)
        return {len(c) - len(e) + len(f) for c, e, f in zip(corners, edges, faces) if f}

    def grains_at_nodes(self):
        grains = [set() for _ in self.node]
        for pair, loop in zip(self.sides, self.loops):
            for node in loop:
                grains[node].update(pair[pair >= 0])
        return grains


def check_lattice(scene, counts, diameter, tolerance):
    """The cubic network of a cubic lattice, out of merge-nodes."""
    raw, net = Network(scene, "tessellate"), Network(scene, "merge-nodes")
    must((raw.throats_at[raw.inner] == 4).all(), "unmerged inner nodes without 4 throats")
    must(raw.fills_the_box() < 1e-12, f"unmerged cells miss the box by {raw.fills_the_box():.1e}")
    nodes, inner = np.prod(np.add(counts, 1)), np.prod(np.subtract(counts, 1))
    across = sum(np.prod([c + (k != axis) for k, c in enumerate(counts)]) for axis in range(3))
    lattice = np.stack(np.meshgrid(*[np.arange(c + 1) for c in counts], indexing="ij"), -1)
    place = (net.node - net.lower) / diameter
    must(len(place) == nodes, f"{len(place)} nodes, not {nodes}")
    place = place[np.lexsort(np.rint(place).T[::-1])]
    off = np.abs(place - lattice.reshape(-1, 3)).max()
    must(off < tolerance, f"nodes {off:.1e} diameters from the lattice")
    must(len(net.ends) == across, f"{len(net.ends)} throats, not {across}")
    must(net.inner.sum() == inner and (net.throats_at[net.inner] == 6).all(),
         "inner nodes without 6 throats")
    must(net.euler() == {2}, f"Euler's formula gives {net.euler()}")
    edges = [set() for _ in net.radius]
    for pair, loop in zip(net.sides, net.loops):
        for grain in pair[pair >= 0]:
            edges[grain].update(tuple(sorted(e)) for e in zip(loop, np.roll(loop, -1)))
    must({len(e) for e in edges} == {12}, "a grain does not face 12 throats")
    must(net.fills_the_box() < 1e-12, f"merged cells miss the box by {net.fills_the_box():.1e}")
    return f"{nodes} nodes, {across} throats, off by {off:.1e}"


def check_rough_lattice(scene, counts, noise):
    """The lattice out of places that are off by NOISE: its nodes, and nodes of two throats on
    its throats, whose number is returned."""
    net = Network(scene, "merge-nodes")
    error = Network(scene, "tessellate").fills_the_box()
    must(error < 1e-12, f"cells miss the box by {error:.1e}")
    off = np.linalg.norm(net.node - np.rint(net.node), axis=1)
    nearest = {}
    for k in np.argsort(off):
        nearest.setdefault(tuple(np.rint(net.node[k])), k)
    corner = np.isin(np.arange(len(off)), list(nearest.values()))
    must(corner.sum() == np.prod(np.add(counts, 1)) and off[corner].max() < 1e-6 + 1e3 * noise,
         f"noise {noise}: {corner.sum()} corners, off by {off[corner].max():.1e}")
    must((net.throats_at[~corner] == 2).all(), f"noise {noise}: another node without 2 throats")
    parent = np.arange(len(net.node))  # a chain of such nodes and the throats beyond it

    def root(k):
        while parent[k] != k:
            k = parent[k]
        return k

    chains = {}
    for a, b in net.ends:
        if not corner[a] and not corner[b]:
            parent[root(b)] = root(a)
    direct = {(a, b) for a, b in net.ends if corner[a] and corner[b]}
    for a, b in net.ends:
        if corner[a] != corner[b]:
            end, middle = (a, b) if corner[a] else (b, a)
            chains.setdefault(root(middle), []).append(end)
    joined = direct | {tuple(sorted(ends)) for ends in chains.values()}
    across = sum(np.prod([c + (k != axis) for k, c in enumerate(counts)]) for axis in range(3))
    apart = np.array([net.node[b] - net.node[a] for a, b in joined])
    must(len(joined) == len(direct) + len(chains) == across,
         f"noise {noise}: {len(joined)} throats between corners, not {across}")
    must(np.abs(np.abs(apart).sum(1) - 1).max() < 1e-5 + 1e4 * noise,
         f"noise {noise}: a throat not along the lattice")
    return int((~corner).sum())


def lattice(scene):
    scene.stages("pack", "tessellate", "merge-nodes")
    return check_lattice(scene, scene.json["pack"]["counts"], 2 * scene.json["pack"]["radius"],
                         1e-12)


case("lattice-3x3x3")(lattice)
case("lattice-5x5x10")(lattice)


@case("lattice-noise")
def lattice_noise(scene):
    random = np.random.default_rng(1)
    extra = 0
    for counts in ((3, 3, 3), (5, 5, 10)):
        grid = np.stack(np.meshgrid(*[np.arange(c) + 0.5 for c in counts], indexing="ij"), -1)
        for k, noise in enumerate((1e-15, 1e-12, 1e-12, 1e-12, 1e-11, 1e-10, 1e-8)):
            part = scene.copy(f"{counts[2]}-{k}")
            place = grid.reshape(-1, 3)
            place = place * (1 + noise * random.uniform(-1, 1, place.shape))
            part.grains = os.path.join(part.folder, "grains.txt")
            with open(part.grains, "w") as file:
                file.writelines(f"{x!r} {y!r} {z!r} 0.5\n" for x, y, z in place.tolist())
            part.stages("pack", "tessellate", "merge-nodes")
            if noise == 1e-15:
                check_lattice(part, counts, 1, 1e-12)
            else:
                extra += check_rough_lattice(part, counts, noise)
    return f"the same at 1e-15; {extra} nodes of two throats in the 12 others"


@case("ratio-100")
def ratio(scene):
    scene.stages(*CHAIN[:5])
    raw, net = Network(scene, "tessellate"), Network(scene, "merge-nodes")
    error = raw.fills_the_box()
    must(error < 1e-12, f"cells miss the box by {error:.1e}")
    must(set(raw.sides[raw.sides >= 0]) == set(range(len(raw.radius))), "a grain has no cell")
    must(raw.euler() == {2}, f"Euler's formula gives {raw.euler()}")
    must(scene.get("dry", "history/saturation")[-1] == 0, "does not end dry")
    force = scene.get("force-protocol", "force")
    must(np.isfinite(force).all() and np.abs(force).max() > 0, "forces are not finite")
    inner = np.ones(len(net.radius), bool)
    inner[net.sides[net.sides[:, 1] < 0, 0]] = False
    most = np.abs(force[0, inner]).max() / (
        scene.summary("force-protocol", "capillary_pressure") * raw.radius.max()**2)
    must(most < 1e-12, f"a full network pulls an inner grain by {most:.1e} p_c R^2")
    return f"box missed by {error:.1e}; dry in the end; inner grains pulled by {most:.1e}"


# ---- random points -----------------------------------------------------------------------

def check_random(scene):
    scene.grains = os.path.join(HERE, "random.txt")
    scene.stages("pack", "tessellate")
    net = Network(scene, "tessellate")
    power = scene.json["tessellate"]["diagram"] == "power"
    spacing = (np.prod(net.upper - net.lower) / len(net.radius)) ** (1 / 3)
    volume, leak = net.cells()
    error = net.fills_the_box()
    must(error < 1e-12, f"cells miss the box by {error:.1e}")
    must((volume > -1e-12 * spacing**3).all(), "a cell of negative volume")
    must((leak < 1e-12 * spacing**2).all(), f"a cell is open by {leak.max():.1e}")
    must(net.euler() == {2}, f"Euler's formula gives {net.euler()}")
    must((net.throats_at[net.inner] == 4).all(), "an inner node without 4 throats")
    apart = net.node[:, None] - net.centre[None]
    away = (apart**2).sum(-1) - (net.radius**2 if power else 0)
    own = np.array([[away[k, list(g)].min(), away[k, list(g)].max()]
                    for k, g in enumerate(net.grains_at_nodes())]) / (2 * spacing**2)
    nearer = (own[:, 0] - away.min(1) / (2 * spacing**2)).max()
    spread = (own[:, 1] - own[:, 0]).max()
    must(spread < 1e-12, f"nodes differ by {spread:.1e} spacings from their grains")
    must(nearer < 1e-12, f"a grain is nearer to a node by {nearer:.1e} spacings")
    return f"box missed by {error:.1e}, nodes apart by {spread:.1e}"


case("random-power")(check_random)
case("random-voronoi")(check_random)
