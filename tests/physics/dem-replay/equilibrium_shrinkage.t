#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Shrinkage in equilibria, with small and large displacements: closed forms as in shrinkage.t,
# and the engine of time steps for irregular grains.
import json
import math
import signal
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, run, scratch_paths, sets

RADIUS, STIFFNESS, SHARE, SIDE, STRAIN = 0.26e-6, 5e13, 0.5, 6, 0.008
AREA = math.pi * (SHARE * RADIUS) ** 2
FULL = STIFFNESS * AREA * 2 * RADIUS * STRAIN
SCENE = {"pack": {"method": "cubic", "radius": RADIUS, "counts": [SIDE, SIDE, SIDE],
                  "periodic": [True, True, False]},
         "dem-replay": {"engine": "quasi-static", "friction": 0.3,
                        "normal_stiffness": 10, "shear_stiffness": 10,
                        "bond": {"normal_stiffness": STIFFNESS, "shear_stiffness": 2e13,
                                 "normal_strength": 1e12, "shear_strength": 1e12,
                                 "radius_fraction": SHARE},
                        "shrinkage": {"strain": STRAIN, "steps": 4}, "snapshots": [0.5, 0]}}
IRREGULAR = "samples/craquelure-40.json"
WAYS = {"small": (), "large": ("quasi_static.large_displacements=true",)}


def near(got, wanted, tolerance):
    return np.max(np.abs(got - wanted)) <= tolerance * np.max(np.abs(wanted))


def bar(at, count, apart, name):
    with open(at("bar.txt"), "w") as file:
        file.writelines(f"{apart * k} 0 0 {RADIUS}\n" for k in range(count))
    run("pack", "-q", "-s", "method=import", "-s", "check=none", at("bar.txt"), "-o", at(name))


def replay(at, packing, *settings, scene=None):
    run("dem-replay", "-q", "-p", scene or at("layer.json"), *sets(*settings), at(packing), "-o", at("response.h5"))
    return h5py.File(at("response.h5"))


def forces(file):
    return np.linalg.norm(file["snapshots/contact_force"][:], axis=2)


with scratch_paths() as at:
    with open(at("layer.json"), "w") as file:
        json.dump(SCENE, file)
    run("pack", "-q", "-p", at("layer.json"), "-o", at("layer.h5"))
    bar(at, 4, 2 * RADIUS, "bar.h5")
    bar(at, 3, 1.8 * RADIUS, "overlap.h5")
    run("pack", "-q", "-p", IRREGULAR, *sets("upper=[3.12e-6,3.12e-6,3.64e-6]", "slab.upper=2.6e-6"), "-o", at("i.h5"))
    for way, more in WAYS.items():
        # In a lattice that repeats sideways bonds along the layer carry k A l e, others nothing.
        file = replay(at, "layer.h5", *more)
        pairs, place = file["contacts/particles"][:], file["particles/position"][:]
        free = (file["particles/held"][:][pairs] == 0).all(axis=1)
        flat = np.abs(place[pairs[:, 1], 2] - place[pairs[:, 0], 2]) < 0.1 * RADIUS
        force = forces(file)
        ok(near(force[:, free & flat], np.array([[0.5], [1]]) * FULL, 1e-9)
           and np.max(force[:, free & ~flat]) < 1e-9 * FULL, f"{way}: bonds along the layer carry k A l e, upright ones nothing")
        layer = np.rint(place[:, 2] / RADIUS - 1) / 2
        sunk = np.where(layer > 0, (2 * layer - 1) * RADIUS * STRAIN, 0)
        ok(near(-file["snapshots/displacement"][1][:, 2], sunk, 1e-9), f"{way}: the layer sinks by its free shrinkage")
        box = file["domain/upper"][:] - file["domain/lower"][:]
        bonds = FULL * 2 * RADIUS * SIDE * SIDE * (SIDE - 1) / box.prod()
        ok(near(file["history/lateral_tension"][:], np.arange(1, 5) / 4 * bonds, 1e-9), f"{way}: lateral tension")
        ok(near(file["snapshots/shrinkage"][0], 0.5 * STRAIN * (file["particles/held"][:] == 0), 1e-12),
           f"{way}: the shrinkage of each grain is written")
        # Each row parts once: what has broken relieves the rest of it.
        for factor, count in (0.99, 0), (1.01, 2 * SIDE * (SIDE - 1)):
            strength = STIFFNESS * 2 * RADIUS * STRAIN / factor
            file = replay(at, "layer.h5", *more, f"bond.normal_strength={strength}", "bond.shear_strength=1e12")
            ok(len(file["cracks/bond"]) == count, f"{way}: {count} bonds break at {factor} of their strain", len(file["cracks/bond"]))

        # A bar between two grains that are held: 2 of 3 lengths shrink.
        held = ["held.walls=[]", "held.grains=[0,3]"]
        for kind, full in ("parallel", FULL), ("contact", 5 * 2 * RADIUS * STRAIN):
            contact = () if kind == "parallel" else ("bond.kind=contact",)
            file = replay(at, "bar.h5", *more, *held, *contact)
            ok(near(forces(file)[1], full * 2 / 3, 1e-9), f"{way}: a held bar with {kind} bonds", forces(file)[1] / full)
        file = replay(at, "overlap.h5", *more, "held.walls=[]", "held.grains=[0,2]")
        pull = -file["snapshots/contact_force"][1, :, 0]
        box = file["domain/upper"][:] - file["domain/lower"][:]
        ok(near(pull, 0.9 * FULL / 2, 1e-9)
           and near(file["history/lateral_tension"][3], pull.sum() * 1.8 * RADIUS / 2 / box.prod(), 1e-9),
           f"{way}: grains that overlap in the packing")

        # A body that nothing holds carries nothing.
        file = replay(at, "bar.h5", *more, "support=free", "shrinkage.strain=0.02")
        moved = file["snapshots/displacement"][1][:, 0]
        ok(near(moved, 0.02 * 2 * RADIUS * (1.5 - np.arange(4)), 1e-9)
           and np.max(forces(file)) < 1e-8 * FULL, f"{way}: a free body shrinks without force", moved / RADIUS)

        # Irregular grains, until the first bond breaks, as the engine of time steps has them. Small
        # displacements leave out terms as large as the strain.
        close = 0.009 if way == "small" else 1e-3
        load = ["shrinkage.strain=0.009", "shrinkage.steps=9", "snapshots=[0.5]", "shrinkage.law=front"]
        steps = replay(at, "i.h5", *load, "cycles=512", "tolerance=1e-6", "most_cycles=20000", scene=IRREGULAR)
        moved, tension = steps["snapshots/displacement"][0], steps["history/lateral_tension"][:]
        file = replay(at, "i.h5", *load, *more, "engine=quasi-static", scene=IRREGULAR)
        ok(len(steps["cracks/bond"]) == len(file["cracks/bond"]) == 0
           and near(file["snapshots/displacement"][0], moved, close) and near(file["history/lateral_tension"][:], tension, close),
           f"{way}: irregular grains as in time steps",
           (np.max(np.abs(file["snapshots/displacement"][0] - moved)) / np.max(np.abs(moved)), file["history/lateral_tension"][:] / tension))

    # Cracks; in one piece and in several.
    crack = ["dem-replay", "-q", "-p", IRREGULAR, *sets("engine=quasi-static", *WAYS["large"], "snapshots=[0.5,0]"), at("i.h5")]
    run(*crack, "-o", at("whole.h5"))
    peak = h5py.File(at("whole.h5"))["history/lateral_tension"][:].max()
    file = replay(at, "i.h5", "cycles=512", "most_cycles=20000", "tolerance=1e-5", scene=IRREGULAR)
    ok(abs(peak / file["history/lateral_tension"][:].max() - 1) < 0.02, "the largest tension as in time steps", peak)
    both = [set(h5py.File(at(name))["cracks/bond"][:]) for name in ("whole.h5", "response.h5")]
    ok(len(both[0] & both[1]) > 0.7 * max(map(len, both)), "most cracks as in time steps", [*map(len, both), len(both[0] & both[1])])
    for n in range(20):
        process = subprocess.Popen([f"{BIN}/{crack[0]}", *crack[1:], "--checkpoint", at("kept"), "-o", at("pieces.h5")],
                                   stderr=subprocess.DEVNULL)
        try:
            process.wait(2 * 1.2 ** n)
            break
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGTERM)
            process.wait()
    with open(at("pieces.h5"), "rb") as pieces, open(at("whole.h5"), "rb") as whole:
        ok(pieces.read() == whole.read(), "the same bytes in pieces")

    process = subprocess.run([f"{BIN}/dem-replay", "-p", at("layer.json"), "-s", "keep_state=true", at("layer.h5"),
                              "-o", at("no.h5")], capture_output=True, text=True)
    ok(process.returncode == 65 and "engine=explicit" in process.stderr, "a state to go on from: refused", process.stderr)
done()
