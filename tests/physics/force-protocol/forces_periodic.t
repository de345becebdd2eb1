#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Capillary forces where the box repeats, and in layers: none while all is wet, the same
# wherever the box begins, and in a layer the sum over throats of [K 3.21].
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, run, scratch_paths, sets

with scratch_paths() as at:
    steps = 40

    every = ["form=faces", "contact_angle=30", "pressure=clusters", "rings.left=suction"]

    def forces(name, centres, radii, box, periodic, how, also=()):
        np.savetxt(at("grains"), np.column_stack([centres, radii]), fmt="%.17g")
        sides = "[" + ",".join(["false", "true"][p] for p in periodic) + "]"
        run("pack", *sets("method=import", "lower=[0,0,0]", f"upper={list(map(float, box))}",
                          f"periodic={sides}"), "--quiet", at("grains"), "-o", at("p"))
        run("tessellate", *sets(*how), at("p"), "-o", at("t"))
        run("merge-nodes", *sets("measure=fraction", "threshold=0.1"), at("t"), "-o", at("n"))
        run("dry", *sets("liquid=immobile"), at("n"), "-o", at(name + ".d"))
        run("force-protocol", *sets(f"steps={steps}", "open_surface=pulls", *also),
            at(name + ".d"), "-o", at(name))
        file = h5py.File(at(name))
        return file["force"][:], file["summary"].attrs["capillary_pressure"]

    random, R = np.random.default_rng(3), 2.5e-7
    for label, n, size, sides, how in [
            ("a box", 60, (2.2e-6, 2.0e-6, 2.8e-6), (1, 1, 0), []),
            ("a narrow box", 25, (1.2e-6, 1.1e-6, 2.5e-6), (1, 1, 0), []),
            ("a layer", 50, (4e-6, 5e-7, 4e-6), (0, 0, 0), ["dimensions=2"]),
            ("a layer that repeats", 50, (4e-6, 5e-7, 4e-6), (1, 0, 0), ["dimensions=2"])]:
        box = np.array(size)
        centres = box * (0.05 + 0.9 * random.random((n, 3)))
        if how:
            centres[:, 1] = R
        radii = np.full(n, R / 5)
        force, pressure = forces("one", centres, radii, box, sides, how)
        unit = pressure * radii[0]**2
        ok(abs(force[0]).max() < 1e-12 * unit and abs(force).max() > 0.5 * unit,
           f"{label}: no force while all is wet", abs(force[0]).max() / unit)
        if any(sides):
            moved = centres + np.array(sides) * (0.37, 0.61, 0) * box
            error = abs(forces("other", moved, radii, box, sides, how)[0] - force).max() / unit
            ok(error < 1e-8, f"{label} that begins elsewhere: the same forces", error)
            here = forces("one", centres, radii, box, sides, how, every)[0]
            error = abs(forces("other", moved, radii, box, sides, how, every)[0] - here).max()
            ok(error < 1e-8 * abs(here).max(), "and with everything that can act",
               error / abs(here).max())
        if not how:
            continue
        # [K 3.21] half way through the time, when saturations are between two steps.
        force = forces("one", centres, radii, box, sides, how, ["balanced=false"])[0]
        with h5py.File(at("one.d")) as d:
            saturation = np.ones(len(d["throats/length"]))
            offset, throat, value = (d[f"changes/{k}"][:] for k in ("offset", "throat", "saturation"))
            time, half = d["history/time"][:], steps // 2
            when = time[-1] * half / (steps - 1)
            before = np.searchsorted(time, when, side="right") - 1
            for k in range(offset[before + 1]):
                saturation[throat[k]] = value[k]
            later = saturation.copy()
            for k in range(offset[before + 1], offset[before + 2]):
                later[throat[k]] = value[k]
            saturation += (when - time[before]) / (time[before + 1] - time[before]) * (later - saturation)
            images = lambda name, rows: (d[name][:].astype(int) if name in d
                                         else np.zeros((rows, 3), int))
            ends = d["throats/nodes"][:]
            which = {(a, b, *image): t for t, ((a, b), image) in
                     enumerate(zip(ends.tolist(), images("throats/image", len(ends)).tolist()))}
            corner, node = d["faces/nodes"][:], d["nodes/position"][:]
            image = images("faces/node_image", len(corner))
            place, offset = node[corner] + image * box, d["faces/offset"][:]
            wanted = np.zeros((n, 2))
            for (grain, _), begin, end in zip(d["faces/particles"][:], offset, offset[1:]):
                apart = place[begin:end] - d["particles/position"][grain]
                angle = np.arctan2(apart[:, 2], apart[:, 0])
                for k in range(end - begin):
                    m = (k + 1) % (end - begin)
                    a, b = corner[begin + k], corner[begin + m]
                    way = image[begin + m] - image[begin + k]
                    t = which[(a, b, *way)] if (a, b, *way) in which else which[(b, a, *-way)]
                    turn = (angle[m] - angle[k] + np.pi) % (2 * np.pi) - np.pi
                    one, two = angle[k], angle[k] + turn
                    n_j = np.array([np.sin(two) - np.sin(one), np.cos(one) - np.cos(two)])
                    wanted[grain] += saturation[t] * np.sign(turn) * np.pi / 2 * n_j
        error = abs(force[half][:, [0, 2]] / unit - wanted).max()
        ok(error < 1e-9 and abs(force[:, :, 1]).max() == 0, f"{label}: the sums of [K 3.21]", error)
done()
