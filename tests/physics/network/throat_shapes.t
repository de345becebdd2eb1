#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# What throats conduct as open sections (tessellate conductance=section), through the whole chain:
# the empty box, closed forms and published values of lattices, and what must not matter.
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, run, scratch_paths, sets

SHAPES = "diffusive_conductance", "hydraulic_conductance", "hydraulic_radius"


def tessellated(at, grains, edge, *pairs, periodic="[false,false,false]"):
    """The network of GRAINS (x, y, z, radius) in a box with that EDGE (three numbers), in m."""
    np.savetxt(at + ".txt", grains, fmt="%.17g")
    upper = "[" + ",".join(f"{x:.17g}" for x in edge) + "]"
    run("pack", "--quiet", *sets("method=import", "lower=[0,0,0]", f"upper={upper}",
                                 "bonds=none", f"periodic={periodic}"),
        at + ".txt", "-o", at + ".packing.h5")
    run("tessellate", *sets(*pairs), at + ".packing.h5", "-o", at + ".h5")
    return at + ".h5"


def material(at, network, axis, merge=True):
    """Diffusivity and permeability of the box along AXIS, without what a fluid brings."""
    if merge:
        run("merge-nodes", *sets("measure=mean_length", "threshold=1e-6"), network, "-o", at)
    run("invade", *sets("transport=true", f'inlet=["+{axis}"]', f'outlet=["-{axis}"]',
                        "surface_tension=0.07", "liquid_density=1000"),
        at if merge else network, "-o", at + ".invasion")
    with h5py.File(at + ".invasion") as file:
        summary = file["summary"].attrs
        return summary["diffusivity"], summary["permeability"]


def lattice(cell, radius, n):
    """The grains of n^3 unit cells of edge 1."""
    corner = np.array([(i, j, k) for i in range(n) for j in range(n) for k in range(n)], float)
    places = np.concatenate([corner + point for point in cell])
    return np.c_[places, np.full(len(places), radius)]


# Places of grains in a cell of edge 1, their radius at contact, and what is published.
CELLS = {"simple cubic": ([(.5, .5, .5)], .5, {.8: .6435, .6: .8394}, 2.518e-3),
         "body-centred": ([(.25, .25, .25), (.75, .75, .75)], 3 ** .5 / 4,
                          {.8: .5543, .6: .7947}, 3.760e-4),
         "face-centred": ([(.25, .25, .25), (.75, .75, .25), (.75, .25, .75), (.25, .75, .75)],
                          2 ** .5 / 4, {.8: .5210, .6: .7778}, 8.62e-5)}


with scratch_paths() as at:
    random = np.random.default_rng(7)

    # Fluxes through Voronoi faces are exact for linear fields: points between walls conduct as
    # the empty box, along all axes, throats in walls and edges included.
    points = np.c_[random.random((200, 3)) * [1, 1.3, .8], np.full(200, 1e-6)]
    # Gas that enters between points sees no contact angle: 2 sigma cos(angle) / radius stays.
    entry = []
    for angle in 0, 60:
        with h5py.File(tessellated(at("points"), points, (1, 1.3, .8), "throat_radius=entry", f"contact_angle={angle}")) as file:
            entry.append(file["throats/radius"][:])
    off = abs(entry[1] / entry[0] * 2 - 1).max()
    ok(off < 1e-4, "points let gas in at one pressure at any contact angle", off)

    empty = tessellated(at("empty"), points, (1, 1.3, .8))
    for axis in "xyz":
        diffusivity, _ = material(at("m.h5"), empty, axis)
        ok(abs(diffusivity - 1) < 1e-7, f"an empty box diffuses as the fluid along {axis}",
           diffusivity)

    # A simple cubic lattice is a bundle of straight prisms: 1/D = int dz / (1 - pi (r^2 - z^2)+).
    for share in 1, .8, .5:
        r = .5 * share
        network = tessellated(at("cubic"), lattice(CELLS["simple cubic"][0], r, 3), (3, 3, 3))
        diffusivity, permeability = material(at("m.h5"), network, "z")
        x, w = np.polynomial.legendre.leggauss(200)
        z = r * (1 + x) / 2
        wanted = 1 / (2 * ((w * r / 2) / (1 - np.pi * (r * r - z * z))).sum() + 1 - 2 * r)
        ok(abs(diffusivity / wanted - 1) < 1e-9,
           f"cubic lattice of grains of {share} contact radii: prisms in series",
           f"{diffusivity} {wanted}")

    # Published: the series of Sangani & Acrivos (1983) for diffusion, Zick & Homsy (1982) for flow
    # between touching spheres; within the errors that docs/transport.md states.
    for name, (cell, contact, series, flow) in CELLS.items():
        for share, wanted in series.items():
            network = tessellated(at("published"), lattice(cell, contact * share, 4), (4, 4, 4),
                                  periodic="[true,true,false]")
            diffusivity, _ = material(at("m.h5"), network, "z")
            ok(abs(diffusivity / wanted - 1) < .1,
               f"{name}, {share} contact radii: published diffusivity", f"{diffusivity} {wanted}")
        network = tessellated(at("published"), lattice(cell, contact, 4), (4, 4, 4),
                              periodic="[true,true,false]")
        _, permeability = material(at("m.h5"), network, "z")
        ok(abs(permeability / flow - 1) < .2, f"{name} at contact: published permeability",
           f"{permeability} {flow}")

    # Neither the order of the grains nor axes matter; units scale exactly.
    grains = np.loadtxt(at("empty.txt"))
    grains[:, 3] = .02 + .06 * random.random(len(grains))
    grains = grains[np.all((grains[:, :3] > .08) & (grains[:, :3] < [.92, 1.22, .72]), axis=1)]
    apart = np.linalg.norm(grains[:, None, :3] - grains[None, :, :3], axis=2)
    apart[np.triu_indices(len(grains))] = 9
    grains = grains[(apart > grains[:, None, 3] + grains[None, :, 3]).all(axis=1)]
    edge = np.array([1, 1.3, .8])

    def shapes(name, grains, edge):
        with h5py.File(tessellated(at(name), grains, edge)) as file:
            return [np.sort(file[f"throats/{key}"][:]) for key in SHAPES]

    one = shapes("one", grains, edge)
    other = shapes("other", grains[random.permutation(len(grains))], edge)
    ok(all(np.allclose(a, b, rtol=1e-9, atol=0) for a, b in zip(one, other)),
       "grains in another order: the same conductances")
    # Grains with others' centres within them are others all the same.
    within = np.c_[np.loadtxt(at("empty.txt"))[:, :3], .02 + .1 * random.random(200)]
    near = np.linalg.norm(within[:, None, :3] - within[None, :, :3], axis=2) < within[:, 3]
    ok(near.sum() > 250, "centres lie within other grains", near.sum() - 200)
    one_of, other_of = (shapes("within", within[order], edge)
                        for order in (np.arange(200), random.permutation(200)))
    ok(all(np.allclose(a, b, rtol=1e-6, atol=1e-9 * a.max()) for a, b in zip(one_of, other_of)),
       "they conduct the same in another order", [np.abs(a - b).max() / a.max() for a, b in zip(one_of, other_of)])
    turned = shapes("turned", grains[:, [1, 2, 0, 3]], edge[[1, 2, 0]])
    ok(all(np.allclose(a, b, rtol=1e-9, atol=0) for a, b in zip(one, turned)),
       "axes in another order: the same conductances")
    small = shapes("small", grains * 2.0 ** -20, edge * 2.0 ** -20)
    ok(all(np.allclose(a * 2.0 ** (-20 * power), b, rtol=1e-9, atol=0)
           for a, b, power in zip(one, small, (1, 3, 1))),
       "grains of micrometres: conductances scale as length, and as its cube for flow")

    # The same at round walls, whose throats are chords: grains in another order.
    rounds = {"a cylinder": ["domain.shape=cylinder", "domain.radius=4", "domain.height=8"],
              "a sphere": ["domain.shape=sphere", "domain.radius=4.5"],
              "a box around a cylinder": ["upper=[9,8,7]", "domain.cut.shape=cylinder",
                                          "domain.cut.centre=[4.4,4.1,3]", "domain.cut.radius=1.5"]}
    for name, domain in rounds.items():
        run("pack", "--quiet", *sets("method=random_sequential", "count=120", "radius=0.6",
                                     "sizes.distribution=normal", "sizes.spread=0.2",
                                     "bonds=none", *domain), "-o", at("round.h5"))
        for key, pairs in {"conductances": [], "entry radii": ["throat_radius=entry"]}.items():
            with h5py.File(at("round.h5"), "r+") as file:
                order = random.permutation(120)
                found = []
                for again in False, True:
                    for data in ("position", "radius") if again else ():
                        file[f"particles/{data}"][...] = file[f"particles/{data}"][:][order]
                    file.flush()
                    run("tessellate", *sets(*pairs), at("round.h5"), "-o", at("around.h5"))
                    with h5py.File(at("around.h5")) as network:
                        found.append([np.sort(network[f"throats/{data}"][:]) for data in
                                      (["radius"] if pairs else SHAPES)])
            off = max(np.abs(a / b - 1).max() for a, b in zip(*found))
            ok(off < 1e-9, f"{name}, grains in another order: the same {key}", off)

done()
