#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Merging where the box repeats, and in layers: lattices come out as the networks of their
# holes, node for node and throat for throat; random networks stay closed.
import sys
from collections import Counter
from itertools import product

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, run, scratch_paths, sets

root = np.sqrt
hcp_atoms = [(0, 0, 0), (1/2, 1/2, 0), (1/2, 1/6, 1/2), (0, 2/3, 1/2)]
octahedral, tetrahedral = 0, 1
# tessellate rounds places to 2^-40 of a grain, 2e-12 of these.
# Grains of radius 1: edges of the cubic (orthorhombic) cell, grains in it, holes in it by kind,
# and which kinds of holes are joined over which distance, through a throat how wide.
narrow = 2 / root(3) - 1  # between three grains that touch
lattices = {
    "cubic": ((2, 2, 2), [(0, 0, 0)], [[(1/2, 1/2, 1/2)]], [(0, 0, 2, root(2) - 1)]),
    "bcc": ((4 / root(3),) * 3, [(0, 0, 0), (1/2, 1/2, 1/2)],
            [[np.roll((0, 1/2, q), turn) for q in (1/4, 3/4) for turn in range(3)]
             + [np.roll((1/2, 0, q), turn) for q in (1/4, 3/4) for turn in range(3)]],
            [(0, 0, root(2/3), root(3/2) - 1)]),
    "fcc": ((2 * root(2),) * 3, [(0, 0, 0), (1/2, 1/2, 0), (1/2, 0, 1/2), (0, 1/2, 1/2)],
            [[(1/2, 1/2, 1/2), (1/2, 0, 0), (0, 1/2, 0), (0, 0, 1/2)],
             list(product((1/4, 3/4), repeat=3))],
            [(octahedral, tetrahedral, root(3/2), narrow)]),
    "hexagonal": ((2, 2 * root(3), 4 * root(2/3)), hcp_atoms,
                  [[(x, y, z) for x, y in ((1/2, 5/6), (0, 1/3)) for z in (1/4, 3/4)],
                   [np.add(atom, (0, 0, up)) for atom in hcp_atoms for up in (3/8, -3/8)]],
                  [(octahedral, tetrahedral, root(3/2), narrow),
                   (octahedral, octahedral, 2 * root(2/3), narrow),
                   (tetrahedral, tetrahedral, root(2/3), narrow)])}


def one_way(i, j, image):
    """The same name from both ends of a throat."""
    return min((i, j, tuple(image)), (j, i, tuple(-k for k in image)))


def expected(holes, kind, joins, box):
    """Throats between holes, with their images."""
    throats = {}
    for image in product((-1, 0, 1), repeat=3):
        apart = holes[None, :] + np.multiply(image, box) - holes[:, None]
        length = np.linalg.norm(apart, axis=2)
        for a, b, reach, radius in joins:
            wanted = ((kind[:, None] == a) & (kind[None, :] == b) & (abs(length - reach) < 1e-6))
            for i, j in zip(*np.nonzero(wanted)):
                throats[one_way(int(i), int(j), image)] = reach, radius
    return throats


def closed(file):
    """Whether the faces of every grain pass each edge once each way, along throats."""
    ends, sides = file["throats/nodes"][:], file["faces/particles"][:]
    images = lambda name, n: (file[name][:].astype(int) if name in file
                              else np.zeros((n, 3), int))
    along = images("throats/image", len(ends))
    throats = {one_way(int(i), int(j), k.tolist()) for (i, j), k in zip(ends, along)}
    offset, corner = file["faces/offset"][:], file["faces/nodes"][:]
    far, second = images("faces/node_image", len(corner)), images("faces/image", len(sides))
    edges, joined = Counter(), True
    for (p, q), begin, end, of_second in zip(sides, offset, offset[1:], second):
        loop = [(int(n), tuple(map(int, k))) for n, k in zip(corner[begin:end], far[begin:end])]
        for (a, at_a), (b, at_b) in zip(loop, loop[1:] + loop[:1]):
            joined &= one_way(a, b, np.subtract(at_b, at_a).tolist()) in throats
            edges[p, a, at_a, b, at_b] += 1
            if q >= 0:
                seen = lambda k: tuple(np.subtract(k, of_second).tolist())
                edges[q, b, seen(at_b), a, seen(at_a)] += 1
    return joined and all(n == edges[p, b, at_b, a, at_a]
                          for (p, a, at_a, b, at_b), n in edges.items()), len(throats) == len(ends)


with scratch_paths() as at:
    def network(centres, radii, box, periodic, tessellate=(), merge=()):
        np.savetxt(at("grains"), np.column_stack([centres, radii]), fmt="%.17g")
        sides = "[" + ",".join(["false", "true"][int(p)] for p in periodic) + "]"
        run("pack", *sets("method=import", "lower=[0,0,0]", f"upper={list(map(float, box))}",
                          f"periodic={sides}"), "--quiet", at("grains"), "-o", at("packing"))
        run("tessellate", *sets(*tessellate), at("packing"), "-o", at("before"))
        run("merge-nodes", *sets(*merge), at("before"), "-o", at("after"))
        return h5py.File(at("before")), h5py.File(at("after"))

    def again(*merge):
        """Whether merging once more changes nothing."""
        run("merge-nodes", *sets(*merge), at("after"), "-o", at("twice"))
        with h5py.File(at("after")) as one, h5py.File(at("twice")) as other:
            return all(one[f"{g}/{n}"][()].tobytes() == other[f"{g}/{n}"][()].tobytes()
                       for g in ("nodes", "throats", "faces") for n in one[g])

    random = np.random.default_rng(5)
    for name, (edges, atoms, holes, joins) in lattices.items():
        for count, noise, size in (1, 0, 1), (2, 0, 1), (2, 1e-15, 1), (3, 1e-15, 2.5e-7):
            box = count * np.array(edges)
            cells = np.array(list(product(range(count), repeat=3)))
            # A quarter of a grain off the corner, so that some holes lie in the sides.
            place = lambda some: np.concatenate([(cells + s) * edges for s in some])
            centres = place(atoms) * (1 + noise * random.standard_normal((1, 3)))
            centres = (centres + noise * random.standard_normal(centres.shape)) % box
            hole = np.concatenate([place(some) for some in holes])
            kind = np.repeat(range(len(holes)), [len(some) * len(cells) for some in holes])
            title = f"{name}, {count} cells a side, noise {noise}, radius {size} m"
            before, after = network(centres * size, [size] * len(centres), box * size,
                                    (True,) * 3, merge=["volumes=conserved"])
            node = after["nodes/position"][:] / size
            apart = (node[:, None] - hole) / box
            shift = np.round(apart)
            far = np.linalg.norm((apart - shift) * box, axis=2)
            which = far.argmin(1)
            ok(len(node) == len(hole) and len(set(which)) == len(hole)
               and far.min(1).max() < 5e-12, title, (len(node), len(hole), far.min(1).max()))
            shift = shift[range(len(node)), which].astype(int)
            wanted = expected(hole, kind, joins, box)
            ends = after["throats/nodes"][:]
            found = {one_way(int(which[i]), int(which[j]),
                             (k + shift[j] - shift[i]).tolist()): (length / size, radius / size)
                     for (i, j), k, length, radius in
                     zip(ends, after["throats/image"][:].astype(int), after["throats/length"],
                         after["throats/radius"])}
            ok(found.keys() == wanted.keys() and len(found) == len(ends)
               and np.allclose([found[k] for k in found], [wanted[k] for k in found], rtol=5e-12),
               "with its throats", (len(found), len(wanted), len(ends)))
            volume = np.pi * (before["throats/radius"][:]**2 * before["throats/length"][:]).sum()
            ok(closed(after) == (True, True) and again("volumes=conserved")
               and abs(after["throats/volume"][:].sum() / volume - 1) < 1e-13,
               "closed, no volume lost, nothing left to merge",
               (closed(after), after["throats/volume"][:].sum() / volume - 1))

    # Random grains. Half of them in a layer.
    for label, size, periodic, how in [
            ("a box", (2.0, 1.7, 2.2), (True, True, True), []),
            ("a narrow box", (0.5, 1.1, 1.5), (True, True, True), []),
            ("a box open above", (2.0, 1.7, 2.2), (True, True, False), []),
            ("a layer", (4.0, 0.1, 4.0), (False, False, False), ["dimensions=2"]),
            ("a layer that repeats", (4.0, 0.1, 4.0), (True, False, False), ["dimensions=2"])]:
        n, box = 60, np.array(size)
        centres = box * random.random((n, 3))
        if how:
            centres[:, 1] = box[1] / 2
        for share in 0.06, 0.28, 0.6:
            merge = ["measure=fraction", f"threshold={share}", "volumes=conserved"]
            before, after = network(centres, [0.01] * n, box, periodic, how, merge)
            gone = 1 - len(after["throats/length"]) / len(before["throats/length"])
            volume = np.pi * (before["throats/radius"][:]**2 * before["throats/length"][:]).sum()
            ok(share - 0.02 < gone < share + 0.05
               and abs(after["throats/volume"][:].sum() / volume - 1) < 1e-13
               and (closed(after) if not how else (closed(after)[1],) * 2) == (True, True)
               and again(*merge), f"{label} that repeats along {periodic}: {share:.0%} merged",
               (gone, closed(after)))
            node, ends = after["nodes/position"][:], after["throats/nodes"][:]
            image = after["throats/image"][:] if any(periodic) else np.zeros((len(ends), 3))
            along = node[ends[:, 1]] - node[ends[:, 0]] + image * box
            ok(np.allclose(np.linalg.norm(along, axis=1), after["throats/length"], rtol=1e-13, atol=0)
               and (node >= -1e-15).all() and (node <= box * (1 + 1e-15)).all(),
               "lengths are the distances of the nodes, which are in the box")
        lengths = np.sort(after["throats/length"][:])
        moved = centres + np.array(periodic) * (0.31, 0.57, 0.83) * box
        _, other = network(moved, [0.01] * n, box, periodic, how, merge)
        ok(np.allclose(lengths, np.sort(other["throats/length"][:]), rtol=1e-9, atol=0),
           "the same where the box begins elsewhere")

    # One grain to eight in a box that repeats: throats around it.
    around = 0
    for n in range(1, 9):
        for share, sides in (0, (True, True, True)), (0.1, (True, False, True)), (0.6, (True,) * 3):
            box = random.uniform(0.3, 1.5, 3)
            merge = ["measure=fraction", f"threshold={share}", "volumes=conserved"]
            before, after = network(box * random.random((n, 3)), [0.01] * n, box, sides, (), merge)
            volume = np.pi * (before["throats/radius"][:]**2 * before["throats/length"][:]).sum()
            ok(closed(after) == (True, True) and again(*merge)
               and abs(after["throats/volume"][:].sum() / volume - 1) < 1e-12,
               f"{n} grains in a box that repeats along {sides}, {share:.0%} merged")
            around += (np.diff(after["throats/nodes"][:]) == 0).sum()
    ok(around > 0, "some throats join a node to its own image", around)

    # A square layer: squares of throats.
    across, up = 5, 4
    centres = np.array([(x + 0.5, 0.5, z + 0.5) for x in range(across) for z in range(up)])
    for around, nodes, throats in (False, 6 * 5, 5 * 5 + 4 * 6), (True, 5 * 5, 5 * 5 + 4 * 5):
        _, after = network(centres, [0.5] * 20, (across, 1, up), (around, False, False),
                           ["dimensions=2"])
        ok(len(after["nodes/kind"]) == nodes and len(after["throats/length"]) == throats
           and np.allclose(after["throats/length"], 1, rtol=1e-12)
           and (np.diff(after["faces/offset"]) == 4).all(),
           f"a square layer {['between walls', 'around'][around]} is of squares",
           (len(after["nodes/kind"]), len(after["throats/length"])))
done()
