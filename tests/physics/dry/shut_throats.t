#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Throats without clearance: networks dry, and are invaded, as if these throats were not there.
import os
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, run, scratch, sets

THROATS = ["nodes", "radius", "length", "kind", "volume", "diffusive_conductance",
           "hydraulic_conductance", "hydraulic_radius"]
random = np.random.default_rng(5)


def close(path, to, throats):
    """The network of PATH, written to TO, with THROATS closed."""
    with h5py.File(path) as old, h5py.File(to, "w") as new:
        for name in old:
            old.copy(name, new)
        new.attrs.update(old.attrs)
        new["throats/radius"][throats] = 0


def remove(path, to, gone):
    """The network of PATH, written to TO, without the throats GONE, nor faces, which dry and
    invade do not ask for."""
    with h5py.File(path) as old, h5py.File(to, "w") as new:
        for name in old:
            if name != "VTKHDF":
                old.copy(name, new)
        new.attrs.update(old.attrs)
        for name in THROATS:
            if name in new["throats"]:
                entry = new["throats"][name]
                rows, attributes = entry[()][~gone], dict(entry.attrs)
                del new["throats"][name]
                new["throats"][name] = rows
                new["throats"][name].attrs.update(attributes)
        for name, rows in (("offset", [0]), ("nodes", []), ("particles", np.zeros((0, 2)))):
            entry = new["faces"][name]
            kind, attributes = entry.dtype, dict(entry.attrs)
            del new["faces"][name]
            new["faces"][name] = np.array(rows, kind)
            new["faces"][name].attrs.update(attributes)


def read(path, *names):
    with h5py.File(path) as file:
        return [file[name][()] for name in names], file["summary"].attrs["shut_throats"], \
            file.attrs["model"].decode()


def same(a, b):
    return len(a) == len(b) and np.allclose(a, b, rtol=1e-9, atol=0)


def around(path, node):
    """Of all throats, those with an end at one of the nodes within two throats of NODE and the
    other end beyond; and those between the former."""
    with h5py.File(path) as file:
        ends = file["throats/nodes"][()]
    near = {node}
    for _ in range(2):
        near |= set(ends[np.isin(ends, list(near)).any(1)].flat)
    inside = np.isin(ends, list(near))
    return inside.any(1) & ~inside.all(1), inside.all(1)


LIQUIDS = {"inviscid": [], "immobile": ["kelvin=true"], "viscous": ["gravity=9.81"]}
with scratch() as folder:
    at = lambda name: os.path.join(folder, name + ".h5")
    run("pack", "-q", *sets("method=random_sequential", "radius=250e-9",
                            "upper=[3e-6,3e-6,3e-6]"), "-o", at("packing"))
    run("tessellate", "-q", at("packing"), "-o", at("whole"))
    run("merge-nodes", "-q", at("whole"), "-o", at("whole"))
    with h5py.File(at("whole")) as file:
        n, middle = len(file["throats/radius"]), file["nodes/position"][()] - 1.5e-6
    some = random.uniform(0, 1, n) < 0.2
    wall, pocket = around(at("whole"), int((middle**2).sum(1).argmin()))

    for title, shut, gone in (("a fifth of the throats shut", some, some),
                              ("a pocket of liquid shut in", wall, wall | pocket)):
        close(at("whole"), at("closed"), np.flatnonzero(shut))
        remove(at("whole"), at("less"), gone)
        for liquid, also in LIQUIDS.items():
            how = sets(f"liquid={liquid}", *also)
            for name in "closed", "less":
                run("dry", "-q", *how, at(name), "-o", at(name + "-drying"))
            names = ["history/time", "history/saturation", "history/rate"]
            mine, count, model = read(at("closed-drying"), *names)
            other, none, _ = read(at("less-drying"), *names)
            ok(all(map(same, mine, other)) and len(mine[0]) > 100,
               f"{title}, {liquid}: dries as without them", (len(mine[0]), len(other[0])))
            ok(count == shut.sum() and none == 0 and
               f"shut to liquid, vapour and gas: {count}\n" in model, "  and says so", model)
        with h5py.File(at("closed-drying")) as file:
            enclosed = file["summary"].attrs["enclosed_throats"]
            ok(enclosed >= (gone & ~shut).sum() and (file["throats/kind"][()][gone] == 2).all(),
               "  what is shut in is empty as well", enclosed)
        run("force-protocol", "-q", *sets("steps=3"), at("closed-drying"), "-o", at("forces"))
        with h5py.File(at("forces")) as file:
            ok(np.isfinite(file["force"][()]).all(), "  and its forces are numbers")

        for name in "closed", "less":
            run("invade", "-q", *sets("transport=true"), at(name), "-o", at(name + "-invasion"))
        names = ["events/pressure", "transport/gas_permeability", "transport/liquid_diffusivity"]
        if title.startswith("a fifth"):
            mine, count, model = read(at("closed-invasion"), *names)
            other, none, _ = read(at("less-invasion"), *names)
            ok(all(map(same, mine, other)) and count == shut.sum() and
               f"shut to gas and liquid: {count}\n" in model, "  gas comes in as without them")

    run("pack", "-q", *sets("method=poisson", "count=80", "radius=2e-6", "seed=2",
                            "sizes.distribution=lognormal", "sizes.spread=0.5", "sizes.largest=5e-6",
                            "upper=[15e-6,15e-6,15e-6]"), "-o", at("packing"))
    run("tessellate", *sets("diagram=voronoi"), at("packing"), "-o", at("voronoi"))
    run("merge-nodes", at("voronoi"), "-o", at("voronoi"))
    with h5py.File(at("voronoi")) as file:
        closed = (file["throats/radius"][()] == 0).sum()
    run("dry", "-q", at("voronoi"), "-o", at("drying"))
    with h5py.File(at("drying")) as file:
        ok(file["summary"].attrs["shut_throats"] == closed > 100 and
           file["history/saturation"][-1] == 0,
           f"a Voronoi diagram of grains that overlap, {closed} throats closed, dries")
done()
