# SPDX-License-Identifier: GPL-3.0-or-later
"""Conductances of throats, from /faces and grains of a network alone.

Written from the formulas, apart from the stages: it is what they are checked by. Lengths are
in cube roots of the box's volume, the fluid's diffusivity is 1.

A throat of the power diagram runs along u through O, where its line pierces the plane of its
grains' centres, from z_a to z_b of that plane. A face of it with grains i and j, d apart, has
s, the distance from O to the line through both centres (positive where O is on the third
grain's side), and x_i = (O - c_i).n_ij. Of the polygon of centres, at height z,
    A_T = sum over faces of d s / 2,     al_i = sum over the two faces at i of atan2(s, x_i),
    A(z) = A_T - sum over grains of al_i/2 max(0, r_i^2 - z^2)
is open. In series, 1/g = integral of dz / A(z) (rule series).
"""
import h5py
import numpy as np

LEGENDRE = np.polynomial.legendre.leggauss(16)


class Network:
    """What a network's file holds, in cube roots of the box's volume."""

    def __init__(self, path):
        with h5py.File(path) as file:
            get = lambda name: file[name][:] if name in file else None
            lower, upper = get("domain/lower"), get("domain/upper")
            self.unit = np.prod(upper - lower) ** (1 / 3)
            self.box = (upper - lower) / self.unit
            self.periodic = get("domain/periodic").astype(bool)
            self.centre = (get("particles/position") - lower) / self.unit
            self.radius = get("particles/radius") / self.unit
            self.node = (get("nodes/position") - lower) / self.unit
            self.kind = get("nodes/kind")
            self.ends = get("throats/nodes")
            self.image = get("throats/image")
            self.throat_radius = get("throats/radius") / self.unit
            # Of diffusion in units of length, of flow in units of its cube.
            self.stored = [get("throats/diffusive_conductance"),
                           get("throats/hydraulic_conductance")]
            self.loops = [get(f"faces/{name}") for name in
                          ("offset", "nodes", "particles", "image", "node_image")]
        if self.image is None:
            self.image = np.zeros((len(self.ends), 3), int)
        self.way = self.node[self.ends[:, 1]] + self.image * self.box \
            - self.node[self.ends[:, 0]]
        self.length = np.linalg.norm(self.way, axis=1)


def corners_of_throats(network):
    """For each throat the faces at it: (grain, place), (grain or wall, place), of the grains
    where its first node is in its own box."""
    offset, nodes, pairs, images, node_images = network.loops
    images = np.zeros((len(pairs), 3), int) if images is None else images.astype(int)
    node_images = np.zeros((len(nodes), 3), int) if node_images is None \
        else node_images.astype(int)
    number = {(a, b, *map(int, image)): t
              for t, ((a, b), image) in enumerate(zip(network.ends.tolist(), network.image))}
    at = [[] for _ in network.ends]
    for f, (i, j) in enumerate(pairs.tolist()):
        loop = range(offset[f], offset[f + 1])
        for k, l in zip(loop, list(loop[1:]) + [loop[0]]):
            step = node_images[l] - node_images[k]
            a, b, shift = int(nodes[k]), int(nodes[l]), node_images[k]
            t = number.get((a, b, *step))
            if t is None or (a == b and (a, b, *step) not in number):
                t, shift = number[(b, a, *-step)], node_images[l]
            at[t].append((i, j, tuple(-shift), tuple(images[f] - shift) if j >= 0 else None))
    return at


class Triangles:
    """The three grains of each throat between grains; throats in walls are left out."""

    def __init__(self, network):
        at = corners_of_throats(network)
        rows, grain, image = [], [], []
        for t, faces in enumerate(at):
            found = sorted({(i, p) for i, j, p, q in faces} |
                           {(j, q) for i, j, p, q in faces if j >= 0})
            if len(found) != 3 or any(j < 0 for i, j, p, q in faces):
                continue
            rows.append(t)
            grain.append([g for g, _ in found])
            image.append([p for _, p in found])
        self.throat = np.array(rows)
        self.grain, image = np.array(grain), np.array(image)
        self.centre = network.centre[self.grain] + image * network.box
        self.radius = network.radius[self.grain]
        self.measure(network)

    def measure(self, network):
        c = self.centre
        normal = np.cross(c[:, 1] - c[:, 0], c[:, 2] - c[:, 0])
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        way = network.way[self.throat]
        along = np.sign(np.einsum("tk,tk->t", normal, way))
        normal *= np.where(along == 0, 1, along)[:, None]
        start = network.node[network.ends[self.throat, 0]]
        self.lower = np.einsum("tk,tk->t", start - c[:, 0], normal)
        self.upper = self.lower + np.einsum("tk,tk->t", way, normal)
        o = start - self.lower[:, None] * normal
        self.piercing = np.linalg.norm(c - o[:, None], axis=2)
        self.area = np.zeros(len(c))
        self.angle = np.zeros((len(c), 3))
        for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            edge = c[:, j] - c[:, i]
            d = np.linalg.norm(edge, axis=1)
            n = edge / d[:, None]
            inward = c[:, k] - c[:, i]
            inward -= np.einsum("tk,tk->t", inward, n)[:, None] * n
            inward /= np.linalg.norm(inward, axis=1)[:, None]
            s = np.einsum("tk,tk->t", o - c[:, i], inward)
            x = np.einsum("tk,tk->t", o - c[:, i], n)
            self.area += d * s / 2
            self.angle[:, i] += np.arctan2(s, x)
            self.angle[:, j] += np.arctan2(s, d - x)

    def heights(self):
        """Points z and weights for integrals along each throat, (throat, points)."""
        lower, upper = self.lower[:, None], self.upper[:, None]
        breaks = np.concatenate([lower, upper, self.radius, -self.radius, 0 * lower], axis=1)
        breaks = np.sort(np.clip(breaks, np.minimum(lower, upper), np.maximum(lower, upper)))
        half = np.diff(breaks)[:, :, None] / 2
        middle = (breaks[:, 1:, None] + breaks[:, :-1, None]) / 2
        z = middle + half * LEGENDRE[0]
        weight = half * LEGENDRE[1]
        return z.reshape(len(z), -1), weight.reshape(len(z), -1)

    def open_area(self, z):
        disc = np.maximum(0, self.radius[:, :, None] ** 2 - z[:, None] ** 2)
        return self.area[:, None] - 0.5 * np.einsum("tg,tgz->tz", self.angle, disc)


def series(network):
    """The open section in series, by quadrature."""
    t = Triangles(network)
    z, weight = t.heights()
    area = t.open_area(z)
    g = np.zeros(len(network.ends))
    with np.errstate(divide="ignore"):
        resistance = (weight / np.maximum(area, 1e-300)).sum(axis=1)
        g[t.throat] = np.where(area.min(axis=1) > 0, 1 / resistance, 0)
    return g


def section(network):
    """What tessellate found."""
    return written(network, 0) / network.unit


def section_flow(network):
    return written(network, 1) / network.unit ** 3


def written(network, which):
    if network.stored[which] is None:
        raise SystemExit("the network has no conductances: tessellate --set=conductance=section")
    return network.stored[which]


def cylinder(network):
    with np.errstate(divide="ignore"):
        return np.pi * network.throat_radius ** 2 / network.length


def cylinder_flow(network):
    return cylinder(network) * network.throat_radius ** 2 / 8


DIFFUSION = {"section": section, "series": series, "cylinder": cylinder}
FLOW = {"section": section_flow, "cylinder": cylinder_flow}
