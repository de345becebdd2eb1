#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Drying shrinkage of a layer on a floor, against closed forms. In a lattice that repeats
# along x and y no grain can move sideways, so a bond along x or y carries k^n A l e at
# the shrinkage e of its grains; upright ones carry nothing, and the layer sinks by e of
# its height. Bonds along the layer break at e = strength / (k^n l).
import json
import math
import shutil
import signal
import subprocess
import sys
import time

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, SCENE, done, ok, run, scratch_paths, sets

RADIUS, STIFFNESS, SHARE, SIDE, STRAIN = 0.26e-6, 5e13, 0.5, 6, 0.01
AREA = math.pi * (SHARE * RADIUS) ** 2
PACK = {"method": "cubic", "radius": RADIUS, "counts": [SIDE, SIDE, SIDE],
        "periodic": [True, True, False]}
REPLAY = {"density": 2500, "normal_stiffness": 10, "shear_stiffness": 10,
          "bond": {"normal_stiffness": STIFFNESS, "shear_stiffness": 2e13,
                   "normal_strength": 1e12, "shear_strength": 1e12,
                   "radius_fraction": SHARE},
          "shrinkage": {"strain": STRAIN, "steps": 4}, "cycles": 512, "ramp": 0,
          "tolerance": 1e-9, "snapshots": [0.5, 0]}


def replay(path, at, *settings):
    run("dem-replay", "-q", "-p", at("layer.json"), *settings, at("layer.h5"), "-o", path)
    return h5py.File(path)


def refused(*command):
    process = subprocess.run([f"{BIN}/{command[0]}", *command[1:]], capture_output=True,
                             text=True)
    return process.returncode == 65 and process.stderr.count("\n") == 1


def bonds_of_free(file):
    """Forces of all contacts of grains that are not held, at each snapshot; whether each
    lies along the layer; the height of its first grain."""
    pairs = file["contacts/particles"][:]
    place, held = file["particles/position"][:], file["particles/held"][:]
    free = (held[pairs] == 0).all(axis=1)
    first, second = place[pairs[free, 0]], place[pairs[free, 1]]
    flat = np.abs(second[:, 2] - first[:, 2]) < 0.1 * RADIUS
    force = np.linalg.norm(file["snapshots/contact_force"][:][:, free], axis=2)
    return force, flat, first[:, 2]


def near(got, wanted, tolerance):
    return np.max(np.abs(got - wanted)) <= tolerance * np.max(np.abs(wanted))


with scratch_paths() as at:
    with open(at("layer.json"), "w") as file:
        json.dump({"pack": PACK, "dem-replay": REPLAY}, file)
    run("pack", "-q", "-p", at("layer.json"), "-o", at("layer.h5"))
    full = STIFFNESS * AREA * 2 * RADIUS * STRAIN

    file = replay(at("uniform.h5"), at)
    force, flat, _ = bonds_of_free(file)
    ok(near(force[:, flat], np.array([[0.5], [1]]) * full, 1e-6),
       "uniform: bonds along the layer carry k A l e")
    ok(np.max(force[:, ~flat]) < 1e-5 * full, "upright bonds carry nothing")
    place, moved = file["particles/position"][:], file["snapshots/displacement"][1]
    layer = np.rint(place[:, 2] / RADIUS - 1) / 2
    sunk = np.where(layer > 0, (2 * layer - 1) * RADIUS * STRAIN, 0)
    ok(near(-moved[:, 2], sunk, 1e-5), "the layer sinks by its free shrinkage")
    box = file["domain/upper"][:] - file["domain/lower"][:]
    all_bonds = full * 2 * RADIUS * SIDE * SIDE * (SIDE - 1) / box.prod()
    ok(near(file["history/lateral_tension"][:], np.arange(1, 5) / 4 * all_bonds, 1e-5),
       "the lateral tension is that of these bonds, over the box")
    ok(file["history/settled"][:].all(), "steps without forces come to rest as well")

    file = replay(at("front.h5"), at, "-s", "shrinkage.law=front")
    force, flat, z = bonds_of_free(file)
    height = 2 * RADIUS * (SIDE - 1)
    behind = 1 - (place[:, 2].max() - z[flat]) / height
    ok(near(force[0, flat], behind * full, 1e-6), "front: less dry further down")
    file = replay(at("narrow.h5"), at, "-s", "shrinkage.law=front", "-s",
                  "shrinkage.front_width=1")
    force, flat, z = bonds_of_free(file)
    share = 1 / (SIDE - 1)
    behind = np.clip((0.5 * (1 + share) - (place[:, 2].max() - z[flat]) / height) / share,
                     0, 1)
    ok(near(force[0, flat], behind * full, 1e-6) and 0 < (behind == 0).sum()
       and 0 < (behind == 1).sum(), "a narrow front: dry above, wet below")

    broken = {}
    for factor in 0.99, 1.01:
        strength = STIFFNESS * 2 * RADIUS * STRAIN / factor
        file = replay(at("broken.h5"), at, "-s", f"bond.normal_strength={strength}")
        broken[factor] = len(file["cracks/bond"])
    ok(broken[0.99] == 0, "nothing breaks below the strain of the strength")
    ok(broken[1.01] == 2 * SIDE * SIDE * (SIDE - 1), "all along the layer breaks above")

    file = replay(at("floor.h5"), at, "-s", "bond.substrate_strength=4")
    held = file["particles/held"][:][file["bonds/particles"][:]].sum(axis=1)
    strength = file["bonds/relative_strength"][:]
    ok(all((strength[held == k] == (4 if k == 1 else 1)).all() for k in range(3)),
       "bonds to the substrate have a strength of their own")

    # A grain between two that are held, and two of them: no net force ever moves the
    # first, so that no cycle more than asked for follows the last of the strain.
    for count, settings in (3, ["tolerance=1e-3"]), (3, ["tolerance=null"]), (4, ["tolerance=1e-3"]):
        with open(at("bar.txt"), "w") as file:
            file.writelines(f"{2 * RADIUS * k} 0 0 {RADIUS}\n" for k in range(count))
        run("pack", "-q", "-s", "method=import", "-s", "check=none", at("bar.txt"), "-o", at("bar.h5"))
        for steps, cycles, ramp in (1, 64, 0), (1, 20, 0), (4, 100, 0), (3, 40, 7):
            bar = [f"shrinkage.steps={steps}", f"cycles={cycles}", f"ramp={ramp}", *settings, "held.walls=[]",
                   f"held.grains=[0,{count - 1}]", "engine=explicit", "snapshots=[0]"]
            run("dem-replay", "-q", "-p", at("layer.json"), *(word for setting in bar for word in ("-s", setting)),
                at("bar.h5"), "-o", at("barred.h5"))
            force = np.linalg.norm(h5py.File(at("barred.h5"))["snapshots/contact_force"][0], axis=1)
            ok(near(force, full * (count - 2) / (count - 1), 2e-3),
               f"a bar of {count} grains feels all strain: {steps} steps of {cycles} cycles, {settings[0]}", force / full)

    # Grains that overlap: bonds pull from centre to centre.
    with open(at("bar.txt"), "w") as file:
        file.writelines(f"{1.8 * RADIUS * k} 0 0 {RADIUS}\n" for k in range(3))
    run("pack", "-q", "-s", "method=import", "-s", "check=none", at("bar.txt"), "-o", at("bar.h5"))
    run("dem-replay", "-q", "-p", at("layer.json"), "-s", "held.walls=[]", "-s", "held.grains=[0,2]", at("bar.h5"), "-o",
        at("barred.h5"))
    file = h5py.File(at("barred.h5"))
    force = -file["snapshots/contact_force"][1, :, 0]
    box = file["domain/upper"][:] - file["domain/lower"][:]
    ok(len(force) == 2 and near(file["history/lateral_tension"][3], force.sum() * 1.8 * RADIUS / 2 / box.prod(), 1e-6),
       "the lateral tension of grains that overlap", force)

    # Scattered strengths, so that it cracks here and there.
    cracking = ["dem-replay", "-q", "-p", at("layer.json"), "-s",
                "bond.strength.distribution=normal", "-s", "bond.normal_strength=2e5",
                "-s", "shrinkage.steps=20", "-s", "snapshots=[0.95,0.5,0]", at("layer.h5")]
    began = time.monotonic()
    run(*cracking, "-o", at("whole.h5"))
    lasted = time.monotonic() - began
    run(*cracking, "--threads", "3", "-o", at("threads.h5"))
    with open(at("whole.h5"), "rb") as file:
        whole = file.read()
    with open(at("threads.h5"), "rb") as file:
        ok(file.read() == whole, "the same bytes with three threads")
    ok(0 < len(h5py.File(at("whole.h5"))["cracks/bond"]) < 648, "some bonds break")
    for n in range(20):
        process = subprocess.Popen([f"{BIN}/{cracking[0]}", *cracking[1:], "--checkpoint",
                                    at("kept"), "-o", at("pieces.h5")],
                                   stderr=subprocess.DEVNULL)
        try:
            process.wait(lasted / 3 * 1.2 ** n)  # so that it ends on a busy machine, too
            break
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGTERM)
            process.wait()
    with open(at("pieces.h5"), "rb") as file:
        ok(file.read() == whole, "the same bytes in pieces")

    # By the liquid: wherever it went first, the dry body is the same.
    chain = ["-p", SCENE]
    run("pack", "-q", *chain, "-s", "counts=[3,3,3]", "-o", at("p.h5"))
    run("tessellate", "-q", *chain, at("p.h5"), "-o", at("t.h5"))
    run("merge-nodes", "-q", *chain, at("t.h5"), "-o", at("n.h5"))
    run("dry", "-q", *chain, at("n.h5"), "-o", at("d.h5"))
    run("force-protocol", "-q", *chain, "-s", "gravity=1e-9", "-s", "force_scale=1e-9",
        "-s", "steps=20", at("d.h5"), "-o", at("f.h5"))
    ends = []
    for law in "uniform", "liquid":
        settings = [f"shrinkage.law={law}", "shrinkage.strain=1e-5", "support=fixed",
                    "engine=explicit", "normal_stiffness=20", "shear_stiffness=20",
                    "friction=0", "gravity=0", "damping_ratio=0.5", "local_damping=0",
                    "bond.normal_strength=1e12", "bond.shear_strength=1e12",
                    "time_step_safety=null", "cycles=1000", "tolerance=1e-7",
                    "unsettled=count", "most_cycles=20000", "snapshots=[0.5,0]"]
        run("dem-replay", "-q", *chain, *sets(*settings),
            at("f.h5"), "-o", at(f"{law}.h5"))
        ends.append(h5py.File(at(f"{law}.h5"))["snapshots/displacement"][:])
    ok(near(ends[1][-1], ends[0][-1], 1e-3), "liquid: when dry, as uniform")
    ok(not near(ends[1][0], ends[0][0], 1e-2), "half dry, not as uniform")

    ok(refused("dem-replay", "-p", at("layer.json"), "-s", "shrinkage.strain=0",
               at("layer.h5"), "-o", at("no.h5")), "a packing that does not shrink: refused")
    ok(refused("dem-replay", "-p", at("layer.json"), "-s", "bridges.volume=1e-22",
               at("layer.h5"), "-o", at("no.h5")), "with liquid bridges: refused")

    # In two replays, one from the state that the other kept.
    two = ["-p", SCENE, "-q", "-s", "support=fixed", "-s", "engine=explicit", "-s",
           "cycles=64", "-s", "tolerance=null"]
    run("dem-replay", *two, "-s", "keep_state=true", at("f.h5"), "-o", at("kept.h5"))
    ok(refused("dem-replay", *two, "-s", "shrinkage.strain=1e-5", at("f.h5"), at("kept.h5"),
               "-o", at("no.h5")), "from a state that had not shrunk: refused")
    two += ["-s", "shrinkage.strain=1e-5"]
    run("dem-replay", *two, "-s", "keep_state=true", at("f.h5"), "-o", at("kept.h5"))
    run("dem-replay", *two, at("f.h5"), at("kept.h5"), "-o", at("further.h5"))
    ends = [h5py.File(at(name))["engine/shrinkage"][:] if name == "kept.h5" else
            h5py.File(at(name))["snapshots/displacement"][:] for name in ("kept.h5", "further.h5")]
    ok(np.max(np.abs(ends[0])) == 1e-5 and np.isfinite(ends[1]).all(),
       "a later replay goes on from the shrunken grains")
    ok(refused("dem-replay", "-p", at("layer.json"), "-s", "shrinkage.law=liquid",
               at("layer.h5"), "-o", at("no.h5")), "no liquid to go by: refused")
    run("pack", "-q", "-p", at("layer.json"), "-s", "extra_layer=true", "-o", at("extra.h5"))
    ok(refused("dem-replay", "-p", at("layer.json"), at("extra.h5"), "-o", at("no.h5")),
       "auxiliary grains of a boundary layer: refused")

    # A step shrinks in 8 portions of 64 time steps, of STRAIN/32 each.
    def said(breaks):
        strength = breaks * STIFFNESS * 2 * RADIUS
        return subprocess.run(
            [f"{BIN}/dem-replay", "-p", at("layer.json"), "-s", f"bond.normal_strength={strength}", at("layer.h5"),
             "-o", at("sudden.h5")], capture_output=True, text=True).stderr

    ok(f"by up to {STRAIN / 32:.2g} at once" in said(3.9 * STRAIN / 32) and "at once" not in said(4.1 * STRAIN / 32),
       "shrinkage of more than a quarter of what breaks a bond at once: said")

    # A load in two pieces, of which the second knows nothing of the first but its state.
    def piece(name, first, last):
        shutil.copy(at("f.h5"), at(name))
        with h5py.File(at(name), "r+") as file:
            for rows in "time", "saturation", "force", "liquid_mass":
                value, units = file[rows][first:last], dict(file[rows].attrs)
                del file[rows]
                file.create_dataset(rows, data=value).attrs.update(units)

    steps = h5py.File(at("f.h5"))["time"].shape[0]
    piece("f1.h5", 0, steps // 2)
    piece("f2.h5", steps // 2, steps - 3)
    piece("f12.h5", 0, steps - 3)
    two += ["-s", "keep_state=true", "-s", "ramp=0", "-s", "snapshots=[0]", "-s", "gravity=0", "-s", "cycles=200"]
    for law in "uniform", "front", "liquid":
        lawful = ["dem-replay", *two, "-s", f"shrinkage.law={law}"]
        run(*lawful, at("f12.h5"), "-o", at("whole.h5"))
        run(*lawful, at("f1.h5"), "-o", at("half.h5"))
        run(*lawful, at("f2.h5"), at("half.h5"), "-o", at("rest.h5"))
        ok(all((h5py.File(at("whole.h5"))[name][:] == h5py.File(at("rest.h5"))[name][:]).all()
               for name in ("engine/shrinkage", "engine/velocity", "snapshots/displacement")),
           f"{law}: a load in two pieces ends at the same bits as in one")
done()
