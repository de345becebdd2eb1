# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of the tessellation share: a network unfolded where the box repeats, and the
same cells by voro++."""
import os
import shutil
import subprocess

import h5py
import numpy as np

from tap import run, sets


class Diagram:
    """The faces of a network with all corners in one piece, as seen from their first grain."""

    def __init__(self, path):
        with h5py.File(path, "r") as file:
            get = lambda name: file[name][()]
            self.model = file.attrs["model"]
            self.centre, self.radius = get("particles/position"), get("particles/radius")
            self.lower, self.upper = get("domain/lower"), get("domain/upper")
            self.edge = self.upper - self.lower
            self.node, self.walls = get("nodes/position"), get("nodes/kind")
            self.ends, self.length = get("throats/nodes"), get("throats/length")
            self.clearance = get("throats/radius")
            self.offset, self.corner = get("faces/offset"), get("faces/nodes")
            self.sides = get("faces/particles")
            self.periodic = get("domain/periodic").any()
            shape = lambda n: np.zeros((n, 3), int)
            images = lambda name, n: get(name).astype(int) if self.periodic else shape(n)
            self.throat_image = images("throats/image", len(self.ends))
            self.face_image = images("faces/image", len(self.sides))
            self.corner_image = images("faces/node_image", len(self.corner))
        self.place = self.node[self.corner] + self.corner_image * self.edge
        self.size = np.diff(self.offset)
        self.face = np.repeat(np.arange(len(self.size)), self.size)
        self.inner = self.sides[:, 1] >= 0

    def next_corner(self):
        """For each corner of each loop, the one after it."""
        after = np.arange(len(self.corner)) + 1
        after[self.offset[1:] - 1] = self.offset[:-1]
        return after

    def areas(self):
        """Vector area of each face, towards its second side."""
        origin = self.place[self.offset[:-1]][self.face]
        at = self.place - origin
        return 0.5 * np.stack([np.bincount(self.face, weights=column) for column in
                               np.cross(at, at[self.next_corner()]).T], 1)

    def volumes(self):
        """Of the cells, and how far the area of each is from closed, of its whole area."""
        n, area = len(self.radius), self.areas()
        begin = self.place[self.offset[:-1]]
        first, second = self.sides[:, 0], self.sides[self.inner, 1]
        volume, leak, whole = np.zeros(n), np.zeros((n, 3)), np.zeros(n)
        np.add.at(volume, first, (area * (begin - self.centre[first])).sum(1) / 3)
        np.add.at(leak, first, area)
        np.add.at(whole, first, np.linalg.norm(area, axis=1))
        other = self.centre[second] + self.face_image[self.inner] * self.edge
        inner = area[self.inner]
        np.add.at(volume, second, -(inner * (begin[self.inner] - other)).sum(1) / 3)
        np.add.at(leak, second, -inner)
        np.add.at(whole, second, np.linalg.norm(inner, axis=1))
        return volume, np.linalg.norm(leak, axis=1) / np.where(whole, whole, 1)

    def box_error(self):
        box = np.prod(self.edge)
        return abs(self.volumes()[0].sum() - box) / box

    def euler(self):
        """Corners - edges + faces of every cell that has faces, as a set. Corners are told
        apart by node and image, seen from the cell."""
        n = len(self.radius)
        grain, corner, image = [], [], []
        for side in (0, 1):
            of = self.sides[self.face, side]
            keep = of >= 0
            grain.append(of[keep])
            corner.append(np.flatnonzero(keep))
            image.append((self.corner_image - side * self.face_image[self.face])[keep])
        grain, corner = np.concatenate(grain), np.concatenate(corner)
        image = np.concatenate(image)
        after = self.next_corner()
        step = self.corner_image[after] - self.corner_image
        name = lambda node, im: (im[:, 0] + 8) * 256 + (im[:, 1] + 8) * 16 + im[:, 2] + 8 \
            + 4096 * node.astype(np.int64)
        a = name(self.corner[corner], image)
        b = name(self.corner[after[corner]], image + step[corner])
        corners = np.unique(np.stack([grain, a], 1), axis=0)[:, 0]
        edges = np.unique(np.stack([grain, np.minimum(a, b), np.maximum(a, b)], 1), axis=0)[:, 0]
        count = lambda of: np.bincount(of, minlength=n)
        faces = count(self.sides[:, 0]) + count(self.sides[self.inner, 1])
        chi = count(corners) - count(edges) + faces
        return set(chi[faces > 0])

    def equidistance(self, power=True):
        """The largest difference of power between the grains around a node and the mean of
        them, as a distance, of the mean spacing."""
        spacing = (np.prod(self.edge) / len(self.radius)) ** (1 / 3)
        weight = self.radius**2 if power else 0 * self.radius
        node, value = [], []
        for side in (0, 1):
            of = self.sides[self.face, side]
            keep = of >= 0
            shift = side * self.face_image[self.face] * self.edge
            to = (self.place - self.centre[np.where(keep, of, 0)] - shift)[keep]
            node.append(self.corner[keep])
            value.append((to**2).sum(1) - weight[of[keep]])
        node, value = np.concatenate(node), np.concatenate(value)
        low, high = np.full(len(self.node), np.inf), np.full(len(self.node), -np.inf)
        np.minimum.at(low, node, value)
        np.maximum.at(high, node, value)
        return np.nanmax((high - low) / (2 * spacing * spacing))

    def neighbours(self):
        """Of each grain its faces, as sorted (other side, area)."""
        area = np.linalg.norm(self.areas(), axis=1)
        found = [[] for _ in self.radius]
        for (i, j), a in zip(self.sides.tolist(), area.tolist()):
            found[i].append((j, a))
            if j >= 0:
                found[j].append((i, a))
        return [sorted(f) for f in found]


def tessellate(grains, edge, folder, *options, periodic=(False,) * 3, radius=None, name="cells"):
    """The diagram of GRAINS (n,3) in a box from 0 to EDGE."""
    edge = np.broadcast_to(edge, 3)
    radius = np.broadcast_to(1e-6 * min(edge) if radius is None else radius, len(grains))
    text = "".join(f"{x!r} {y!r} {z!r} {r!r}\n"
                   for (x, y, z), r in zip(np.asarray(grains).tolist(), radius.tolist()))
    at = lambda end: os.path.join(folder, name + end)
    flag = str(list(map(bool, periodic))).lower()
    run("pack", "-q", "--set", "method=import", "--set", "lower=[0,0,0]", "--set",
        f"upper={edge.tolist()}", "--set", "bonds=none", "--set", f"periodic={flag}", "--set",
        "check=none", "-o", at("-packing.h5"), input=text.encode())
    run("tessellate", "-q", *options, at("-packing.h5"), "-o", at(".h5"))
    return Diagram(at(".h5"))


def of_packing(folder, *settings, options=(), name="own"):
    """The diagram of a packing of pack's own, by the SETTINGS."""
    path = os.path.join(folder, name)
    run("pack", "-q", *sets(*settings), "-o", path + "-packing.h5")
    run("tessellate", "-q", *options, path + "-packing.h5", "-o", path + ".h5")
    return Diagram(path + ".h5")


def has_voro():
    return shutil.which("voro++") is not None


def voro(grains, edge, folder, periodic=(False,) * 3, radius=None, wall=()):
    """Volume of each cell, and its faces as sorted (other side, area), by voro++, with WALL
    among its arguments."""
    path = os.path.join(folder, "points")
    columns = [np.arange(len(grains))[:, None], grains]
    if radius is not None:
        columns.append(np.asarray(radius)[:, None])
    np.savetxt(path, np.hstack(columns), fmt=["%d"] + ["%.17g"] * (3 + (radius is not None)))
    flags = [f"-p{axis}" for axis, on in zip("xyz", periodic) if on]
    flags += ["-r"] if radius is not None else []
    flags += map(str, wall)
    box = [str(v) for e in np.broadcast_to(edge, 3) for v in (0, float(e))]
    subprocess.run(["voro++", *flags, "-c", "%i|%v|%n|%f", *box, path], check=True,
                   stdout=subprocess.DEVNULL)
    volume, faces = np.zeros(len(grains)), [[] for _ in grains]
    with open(path + ".vol") as file:
        for line in file:
            i, v, others, areas = line.split("|")
            volume[int(i)] = float(v)
            faces[int(i)] = sorted(zip(map(int, others.split()), map(float, areas.split())))
    return volume, faces


def faces_differ(ours, theirs, least):
    """How many cells differ: by the neighbours beyond faces larger than LEAST, or by an area, of
    which voro++ writes six digits."""
    wrong = 0
    for mine, other in zip(ours, theirs):
        mine, other = ([f for f in faces if f[1] > least] for faces in (mine, other))
        wrong += [f[0] for f in mine] != [f[0] for f in other] or any(
            abs(a[1] - b[1]) > least + 1e-5 * b[1] for a, b in zip(mine, other))
    return wrong
