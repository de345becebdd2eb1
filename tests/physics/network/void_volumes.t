#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Throat volumes that add up to the void between the grains, spheres cut exactly, and stay so
# when nodes are merged and the network dries.
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, refused, run, scratch_paths, sets

with scratch_paths() as at:
    def tessellate(*settings, text=None):
        """The network of a packing; TEXT holds the grains of an import."""
        packing = run("pack", "--quiet", *sets(*settings), input=text)
        run("tessellate", "--set", "throat_volume=void", "-o", at("network.h5"), input=packing)
        return h5py.File(at("network.h5"))

    def shares(network):
        """Void by throats, and by the box less all spheres, of the box."""
        box = np.prod(network["domain/upper"][:] - network["domain/lower"][:])
        solid = 4 / 3 * np.pi * (network["particles/radius"][:]**3).sum()
        return network["throats/volume"][:].sum() / box, 1 - solid / box

    for name, void in [("cubic", 1 - np.pi / 6), ("bcc", None), ("fcc", None)]:
        got, expected = shares(tessellate(f"method={name}", "counts=[3,3,3]"))
        ok(abs(got / (void or expected) - 1) < 1e-13, f"{name} lattice", got / expected - 1)
    for periodic in "[true,true,true]", "[true,false,true]":
        got, expected = shares(tessellate("method=fcc", "counts=[2,2,2]", f"periodic={periodic}"))
        ok(abs(got / expected - 1) < 1e-13, f"fcc lattice that repeats, {periodic}", got / expected - 1)
    for unit in "250e-9", "1e3":
        edge = 20 * float(unit)
        got, expected = shares(tessellate(
            "method=random_sequential", "count=300", f"radius={unit}", f"upper=[{edge},{edge},{edge}]",
            "sizes.distribution=lognormal", "sizes.spread=0.4"))
        ok(abs(got / expected - 1) < 1e-12, f"spheres of many sizes, {unit} m, none cut",
           got / expected - 1)

    # By symmetry: on the cubic lattice each inner throat has a third of a cell's void.
    tessellate("method=cubic", "counts=[4,4,4]", "radius=0.5")
    run("merge-nodes", at("network.h5"), "-o", at("merged.h5"))
    merged = h5py.File(at("merged.h5"))
    inner = (merged["nodes/kind"][:] == 0)[merged["throats/nodes"][:]].all(axis=1)
    ok(inner.sum() == 54 and np.allclose(merged["throats/volume"][:][inner], (1 - np.pi / 6) / 3,
                                         rtol=1e-13, atol=0), "each throat has its share")

    # Grains that overlap meet in the face between them; what sticks out of the box is not
    # in it. Two of radii a, b at distance d share a lens; a wall cuts off a cap.
    for a, b, d, title in [(1, 0.7, 1.3, "two grains that overlap"),
                           (1, 0.4, 0.9, "one with its centre in the other, beyond its own face")]:
        lens = np.pi * (a + b - d)**2 * (d**2 + 2 * d * (a + b) - 3 * (a - b)**2) / (12 * d)
        network = tessellate("method=import", "lower=[-2,-2,-2]", "upper=[3,2,0.6]",
                             text=f"0 0 -0.4 {a}\n{d} 0 -0.4 {b}\n".encode())
        void = 5 * 4 * 2.6 - (4 / 3 * np.pi * (a**3 + b**3) - lens)
        got = network["throats/volume"][:].sum()
        ok(abs(got / void - 1) < 1e-14, title, got / void - 1)
    network = tessellate("method=import", "lower=[-2,-2,-2]", "upper=[3,2,0.6]",
                         text=b"0 0 0.1 1\n")
    cap = np.pi / 3 * (1 - 0.5)**2 * (2 + 0.5)
    void = 5 * 4 * 2.6 - (4 / 3 * np.pi - cap)
    got = network["throats/volume"][:].sum()
    ok(abs(got / void - 1) < 1e-14, "one grain that sticks out of the box", got / void - 1)

    # Many overlaps of three and more: points thrown at random, four standard errors.
    network = tessellate("method=poisson", "count=200", "radius=0.4", "upper=[5,5,5]",
                         "sizes.distribution=lognormal", "sizes.spread=0.3", "bonds=none")
    points = 5 * np.random.default_rng(1).random((200000, 3))
    free = np.ones(len(points), bool)
    for x, r in zip(network["particles/position"][:], network["particles/radius"][:]):
        free &= ((points - x)**2).sum(1) > r * r
    error = np.sqrt(free.mean() * (1 - free.mean()) / len(points))
    got, _ = shares(network)
    ok(abs(got - free.mean()) < 4 * error, "random points fall between the grains as often",
       (got, free.mean(), error))

    # Merged, and dried: what evaporates is what the void holds.
    network = tessellate("method=random_sequential", "count=200", "upper=[5e-6,5e-6,5e-6]")
    got, expected = shares(network)
    run("merge-nodes", "--set", "measure=fraction", "--set", "threshold=0.2", at("network.h5"),
        "-o", at("merged.h5"))
    merged = h5py.File(at("merged.h5"))
    ok(abs(shares(merged)[0] / expected - 1) < 1e-12, "merging nodes keeps the sum")
    ok((merged["throats/volume"][:] > 0).all(), "every throat has some")
    run("dry", "--quiet", "--set", "liquid_density=998.2", at("merged.h5"), "-o", at("drying.h5"))
    mass = h5py.File(at("drying.h5"))["summary"].attrs["liquid_mass"]
    ok(abs(mass / (998.2 * expected * 125e-18) - 1) < 1e-12, "liquid fills the void when drying begins")
    run("dry", "--quiet", "--set", "liquid_density=998.2", "--set", "throat_radius.distribution=normal", at("merged.h5"), "-o", at("drawn.h5"))
    drawn = h5py.File(at("drawn.h5"))
    cylinders = np.pi * (drawn["throats/radius"][:]**2 * drawn["throats/length"][:]).sum()
    ok("throats/volume" not in drawn
       and abs(drawn["summary"].attrs["liquid_mass"] / (998.2 * cylinders) - 1) < 1e-12,
       "throats of drawn radii are cylinders")
    refused("a Voronoi diagram, out of whose cells grains stick, is refused", "diagram=power",
            "tessellate", "--set", "throat_volume=void", "--set", "diagram=voronoi", input=run("pack"))
done()
