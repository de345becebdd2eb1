#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Drying where the box repeats to the sides, and of layers of grains: the first rate, and what
# must not change when the box begins elsewhere or is taken twice.
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import WATER, done, ok, run, scratch_paths, sets

with scratch_paths() as at:
    gas, fall = 8.31446261815324, np.log(1e5 / (1e5 - 2339))

    def network(name, centres, radii, box, periodic, *how):
        np.savetxt(at(name + ".txt"), np.column_stack([centres, radii]), fmt="%.17g")
        lower, upper = [0.0, 0.0, 0.0], list(map(float, box))
        sides = "[" + ",".join(["false", "true"][p] for p in periodic) + "]"
        run("pack", *sets("method=import", f"lower={lower}", f"upper={upper}",
                          f"periodic={sides}"), at(name + ".txt"), "-o", at(name + ".p"))
        run("tessellate", *sets(*how), at(name + ".p"), "-o", at(name + ".n"))

    def dry(name, *how):
        run("dry", *sets("boundary_layer.mass_transfer=5.1", *WATER, *how), at(name + ".n"),
            "-o", at(name + ".d"))
        file = h5py.File(at(name + ".d"))
        return {k: file[f"history/{k}"][:] for k in ("time", "saturation", "rate")}

    # Throats that empty together may do so in one step or in several.
    def apart(one, other):
        there = np.interp(one["time"], other["time"], other["saturation"])
        return max(abs(there - one["saturation"]).max(),
                   abs(other["time"][-1] / one["time"][-1] - 1))

    # Random grains under a wall: (name, box, sides that repeat, settings of tessellate).
    random, R = np.random.default_rng(11), 2.5e-7
    box = np.array([2.2, 2.0, 3.0]) * 1e-6
    grains = box * random.random((70, 3)) * [1, 1, 0.9] + [0, 0, 0.05 * box[2]]
    thick = 2 * R
    flat = np.array([6e-6, thick, 4e-6])
    layer = flat * random.random((40, 3)) * [1, 0, 0.9] + [0, R, 0.05 * flat[2]]
    mass = 2.5685e-5 * 1e5 * 0.01802 / gas / 293.15 * fall # per length
    for label, centres, size, how in [("a box", grains, box, []),
                                      ("a layer", layer, flat, ["dimensions=2"])]:
        sides = (True, not how, False)
        radii = np.full(len(centres), R / 5)
        network("one", centres, radii, size, sides, *how)
        shifted = centres + np.array([0.37, 0.61 if not how else 0, 0]) * size
        network("shifted", shifted, radii, size, sides, *how)
        doubled = np.vstack([centres, centres + [size[0], 0, 0]])
        network("double", doubled, np.tile(radii, 2), size * [2, 1, 1], sides, *how)
        for liquid in "inviscid", "immobile":
            one = dry("one", f"liquid={liquid}")
            with h5py.File(at("one.d")) as file:
                layers = size[0] * size[1] * mass / (2.5685e-5 / 5.1)
                ok(abs(one["rate"][0] / layers - 1) < 1e-12,
                   f"{label} that repeats, {liquid}: the first rate is that of the whole wall",
                   one["rate"][0] / layers - 1)
                ok(file["summary"].attrs["balance_error"] < 1e-12, "what evaporates was there")
            error = apart(one, dry("shifted", f"liquid={liquid}"))
            ok(error < 1e-9, f"{label} that begins elsewhere dries alike, {liquid}", error)
        error = apart(one, dry("double", "liquid=immobile"))
        ok(error < 1e-9, f"{label} twice as wide dries alike", error)
    # Correlated radii repeat with the box: across its side they are as alike as elsewhere.
    drawn = ["throat_radius.distribution=normal", "throat_radius.standard_deviation=3e-8",
             "throat_radius.correlation_length=6e-7"]
    flat, grains = flat * [2, 1, 2], random.random((300, 3)) * [1, 0, 0.9]
    grains = flat * grains + [0, R, 0.05 * flat[2]]
    network("one", grains, np.full(300, R / 5), flat, (True, False, False), "dimensions=2")
    dry("one", "liquid=immobile", *drawn)
    with h5py.File(at("one.d")) as file:
        ends, radius = file["throats/nodes"][:], file["throats/radius"][:]
        side = file["throats/image"][:, 0] != 0
        middle = ~side & (np.diff(file["nodes/position"][:, 0][ends] > flat[0] / 2)[:, 0])
    by_node = [np.nonzero((ends == node).any(1))[0] for node in range(ends.max() + 1)]

    def unlike(crossing): # throats that cross, and those beside them that do not
        return np.mean([abs(radius[a] - radius[b]) for throats in by_node for a in throats
                        for b in throats if crossing[a] and not crossing[b]])
    ratio = unlike(side) / unlike(middle)
    ok(0.7 < ratio < 1.4, "drawn radii are as alike across the side as across the middle", ratio)
done()
