#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# A network between settled grains, nodes and throats renumbered at random: in every liquid the
# same throats empty at the same times, gas is pressed in in the same order, and grains that move
# leave the same liquid in every throat. Throats that are narrowest at a node they share are
# equally wide. Turning grains in a ring changes no saturation either.
import shutil
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, run, scratch_paths, sets


def renumber(source, target, random):
    """Returns where each throat of TARGET was in SOURCE."""
    shutil.copy(source, target)
    with h5py.File(target, "r+") as file:
        to = random.permutation(len(file["nodes/position"]))
        was = random.permutation(len(file["throats/nodes"]))
        ends = to[file["throats/nodes"][:]]
        faces = to[file["faces/nodes"][:]]
        for name in "nodes/position", "nodes/kind":
            file[name][...] = file[name][:][np.argsort(to)]
        for name in file["throats"]:
            file[f"throats/{name}"][...] = file[f"throats/{name}"][:][was]
        file["throats/nodes"][...] = np.sort(ends[was], axis=1)
        file["faces/nodes"][...] = faces
    return was


with scratch_paths() as at:
    run("pack", "--quiet", "--set", "method=deposition", "--set", "count=120", "--set",
        "radius=250e-9", "-o", at("packing.h5"))
    run("tessellate", at("packing.h5"), "-o", at("tessellation.h5"))
    run("merge-nodes", "--set", "measure=fraction", "--set", "threshold=0.06",
        at("tessellation.h5"), "-o", at("one.h5"))
    was = renumber(at("one.h5"), at("two.h5"), np.random.default_rng(6))
    with h5py.File(at("one.h5")) as file:
        radius = file["throats/radius"][:]
    different = {f"{r:.11e}" for r in radius}
    ok(len(radius) - len(different) > 20, "some throats are as wide as others",
       f"{len(different)} of {len(radius)}")

    def events(stage, name, *settings):
        run(stage, "--quiet", *sets(*settings), at(name),
            "-o", at("out.h5"))
        with h5py.File(at("out.h5")) as file:
            value = file["events/time" if stage == "dry" else "events/pressure"]
            return file["events/throat"][:], value[:]

    # The flow in films is found to 1e-6 of the rate.
    for stage, settings, tolerance in [
            ("dry", ["liquid=inviscid"], 1e-12), ("dry", ["liquid=immobile"], 1e-12),
            ("dry", ["liquid=viscous"], 1e-12),
            ("dry", ["start_saturation=0.9", "start_trapping=true"], 1e-12),
            ("dry", ["rings=films", "films.conductance=0.03", "films.step=0.05"], 1e-6),
            ("dry", ["rings=films", "films.conductance=0.003", "films.step=0.01"], 1e-6),
            ("invade", ["trapping=true"], 1e-12), ("invade", ["trapping=false"], 1e-12)]:
        throat, value = events(stage, "one.h5", *settings)
        other, again = events(stage, "two.h5", *settings)
        ok(np.array_equal(throat, was[other]) and np.allclose(again, value, rtol=tolerance, atol=0),
           f"{stage}, {' '.join(settings)}: whatever the numbers")

    # Grains move, and liquid with them: the same throats hold the same.
    for name in "one", "two":
        run("dry", "--quiet", *sets("stop_saturation=0.6"), at(name + ".h5"), "-o", at(name + "-dry.h5"))
    run("force-protocol", "--quiet", *sets("steps=20", "force_scale=0.02"), at("one-dry.h5"),
        "-o", at("forces.h5"))
    run("dem-replay", "--quiet", *sets("engine=quasi-static", "friction=0", "bond.by=touching",
                                       "bond.normal_strength=1e12", "bond.shear_strength=1e12"),
        at("forces.h5"), "-o", at("response.h5"))
    held = []
    for name in "one", "two":
        run("deform", "--quiet", at(name + "-dry.h5"), at("response.h5"), "-o", at("moved.h5"))
        with h5py.File(at("moved.h5")) as file:
            held.append(file["throats/saturation"][:])
    off = np.abs(held[0][was] - held[1]).max()
    ok(off < 1e-9, "deform: the same liquid in every throat", off)

    # Entry radii of throats on both sides of a gap, which loses its liquid as gas enters, are equal: whatever
    # rounding, the shorter one is first.
    for seed in 3, 4:
        ring = ["domain.shape=ring", "domain.radius=2.2e-6", "domain.inner_radius=8e-7", "domain.height=2.5e-6"]
        run("pack", "-q", *sets("method=random_sequential", "radius=250e-9", "sizes.distribution=normal", "sizes.spread=0.25",
                                f"seed={seed}", *ring), "-o", at("ring.h5"))
        with h5py.File(at("ring.h5")) as file:
            grain, size = file["particles/position"][:], file["particles/radius"][:]
            middle = (file["domain/lower"][:] + file["domain/upper"][:]) / 2
        saturation = []
        for angle in 0, 0.65:
            cosine, sine = np.cos(angle), np.sin(angle)
            turned = middle + (grain - middle) @ np.array([[cosine, sine, 0], [-sine, cosine, 0], [0, 0, 1]])
            np.savetxt(at("grains.txt"), np.column_stack([turned, size]), fmt="%.17g")
            run("pack", "-q", *sets("method=import", "bonds=none", "check=none", *ring, f"domain.centre={middle.tolist()}"),
                at("grains.txt"), "-o", at("turned.h5"))
            run("tessellate", "-q", *sets("throat_radius=entry"), at("turned.h5"), "-o", at("diagram.h5"))
            run("merge-nodes", "-q", at("diagram.h5"), "-o", at("network.h5"))
            run("dry", "-q", *sets("boundary_layer.layers=2"), at("network.h5"), "-o", at("out.h5"))
            with h5py.File(at("out.h5")) as file:
                saturation.append(file["history/saturation"][:])
        off = np.abs(saturation[0] - saturation[1]).max()
        ok(off < 1e-9, f"ring {seed} turned: the same saturations, one after the other", off)

done()
