#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# A layer that gas drains from above while its grains move (capillary.suction), against
# closed forms. In a cubic lattice of touching grains of radius R that repeats sideways,
# menisci in its top facets pull every column down with P (2 R)^2 and nothing sideways;
# the liquid carries the lateral tension P; every throat has the radius (sqrt 2 - 1) R, so
# that gas enters all pores or none; and these hold 1 - pi/6 of their volume.
import json
import math
import os
import signal
import subprocess
import sys
import time

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, run, scratch_paths, sets

RADIUS, SIDE, TENSION = 0.26e-6, 6, 0.07
ENTRY = 2 * TENSION / ((math.sqrt(2) - 1) * RADIUS)
PACK = {"method": "cubic", "radius": RADIUS, "counts": [SIDE, SIDE, SIDE],
        "periodic": [True, True, False]}
REPLAY = {"density": 2500, "normal_stiffness": 1e4, "shear_stiffness": 1e4,
          "bond": {"normal_stiffness": 1e17, "shear_stiffness": 4e16,
                   "normal_strength": 1e12, "shear_strength": 1e12},
          "capillary": {"suction": 0.98 * ENTRY, "steps": 2, "surface_tension": TENSION},
          "cycles": 512, "ramp": 0, "tolerance": 1e-7, "most_cycles": 4000,
          "snapshots": [1]}


def refused(status, *command):
    process = subprocess.run([f"{BIN}/{command[0]}", *command[1:]], capture_output=True,
                             text=True)
    return process.returncode == status and process.stderr.count("\n") == 1


def near(got, wanted, tolerance):
    return np.max(np.abs(got - wanted)) <= tolerance * np.max(np.abs(wanted))


with scratch_paths() as at:
    def replay(name, *settings, packing="layer.h5"):
        run("dem-replay", "-q", "-p", at("layer.json"), *sets(*settings), at(packing), "-o", at(name))
        return h5py.File(at(name))

    with open(at("layer.json"), "w") as file:
        json.dump({"pack": PACK, "dem-replay": REPLAY}, file)
    run("pack", "-q", "-p", at("layer.json"), "-o", at("layer.h5"))

    file = replay("full.h5")
    suction = file["history/suction"][:]
    ok(near(suction, np.array([0.49, 0.98]) * ENTRY, 1e-12), "suction rises evenly")
    box = file["domain/upper"][:] - file["domain/lower"][:]
    pores = (2 * RADIUS) ** 3 * SIDE * SIDE * (SIDE - 1)
    room = (1 - math.pi / 6) * pores
    ok((file["history/gas_pores"][:] == 0).all(), "below its entry pressure no gas enters")
    ok(near(file["history/liquid_volume"][:], room, 1e-3), "the pores hold their void")
    ok(near(file["history/lateral_tension"][:], suction * pores / box.prod(), 1e-3),
       "the lateral tension is the suction")
    pairs, place = file["contacts/particles"][:], file["particles/position"][:]
    held = file["particles/held"][:]
    force = file["snapshots/contact_force"][0]
    free = (held[pairs] == 0).any(axis=1)
    upright = np.abs(place[pairs[:, 0], 2] - place[pairs[:, 1], 2]) > RADIUS
    column = suction[0] * (2 * RADIUS) ** 2
    ok(near(np.linalg.norm(force[upright & free], axis=1), column, 1e-4),
       "every column bears the suction on its top")
    ok(np.abs(force[~upright & free]).max() < 1e-3 * column, "nothing pushes sideways")

    file = replay("drained.h5", f"capillary.suction={2.04 * ENTRY}")
    ok((file["history/saturation"][:] == [0, 0]).all() and
       file["history/liquid_volume"][1] == 0, "above it gas enters all")
    ok(near(file["history/drained_volume"][:], room, 1e-3), "which held what there was")
    ok(near(file["history/lateral_tension"][:] + 1e6, 1e6, 1e-3), "and all load is gone")
    ok(np.abs(file["snapshots/displacement"][-1]).max() < 1e-5 * RADIUS,
       "the layer springs back")

    file = replay("dries.h5", "capillary.control=evaporation", "capillary.evaporated=0.5",
                  f"capillary.suction={2 * ENTRY}", "capillary.rounds=4")
    drained = file["history/drained_volume"][:] / room
    ok(np.abs(drained - [0.25, 0.5]).max() < 0.5 / 16 + 0.01,
       "evaporation takes its share in every step, to half a portion")
    # Facets inside cubes: along the long diagonal, and between three face diagonals.
    inside = [(math.sqrt(2) - 1) / (math.sqrt(square) - 1) for square in (3, 8 / 3)]
    off = np.abs(file["history/suction"][:][:, None] / ENTRY - [1, *inside]).min(axis=1)
    ok(off.max() < 0.01, "at the suction that throats need, outside or within cubes")

    one_way = replay("first.h5", "capillary.forces=first", "capillary.throats=first")
    ok(near(one_way["snapshots/displacement"][0],
            replay("full.h5")["snapshots/displacement"][0], 1e-3),
       "one way, nearly the same in a stiff layer")

    # Grains shrink as the pores around them empty, but for the held floor.
    strain = 1e-3
    file = replay("shrinks.h5", f"capillary.suction={2.04 * ENTRY}", "capillary.steps=3",
                  f"shrinkage.strain={strain}", "shrinkage.law=liquid", "snapshots=[0]")
    ok((file["snapshots/dryness"][0] == 1).all(), "all pores are dry in the second step")
    area = math.pi * (0.5858 * RADIUS) ** 2
    ok(near(file["history/lateral_tension"][2],
            1e17 * area * strain / (2 * RADIUS) * (SIDE - 1) / SIDE, 1e-3),
       "in the third grains are dry, and bonds carry k A l e")

    run("dem-replay", "-q", "-p", at("layer.json"), "--threads", "3", at("layer.h5"), "-o",
        at("threads.h5"))
    with open(at("threads.h5"), "rb") as a, open(at("full.h5"), "rb") as b:
        ok(a.read() == b.read(), "the same bytes with three threads")

    # A layer that cracks, shrinks and dries.
    with open("samples/craquelure-40.json") as file:
        scene = json.load(file)
    scene["pack"]["upper"] = [3.9e-6, 3.9e-6, 2.6e-6]
    scene["pack"]["slab"]["upper"] = 2.08e-6
    scene["dem-replay"]["shrinkage"] = {"strain": 0.02, "law": "liquid"}
    scene["dem-replay"]["capillary"] = {"suction": 4e6, "control": "evaporation", "steps": 6}
    with open(at("random.json"), "w") as file:
        json.dump(scene, file)
    run("pack", "-q", "-p", at("random.json"), "-o", at("random.h5"))
    cracking = ["dem-replay", "-q", "-p", at("random.json"), at("random.h5")]
    run(*cracking, "-o", at("whole.h5"))
    pieces = [*cracking, "--checkpoint", at("kept")]

    def kept():
        return os.stat(at("kept")).st_mtime_ns if os.path.exists(at("kept")) else 0

    stopped = 0
    for _ in range(3):
        before = kept()
        process = subprocess.Popen(
            [f"{BIN}/{pieces[0]}", *pieces[1:], "--checkpoint-every", "0", "-o", at("no.h5")],
            stderr=subprocess.DEVNULL)
        while process.poll() is None and kept() == before:
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
        stopped += process.wait() != 0
    run(*pieces, "-o", at("pieces.h5"))
    ok(stopped > 0, "it was stopped on the way")
    with open(at("whole.h5"), "rb") as a, open(at("pieces.h5"), "rb") as b:
        ok(a.read() == b.read(), "the same bytes in pieces")
    file = h5py.File(at("whole.h5"))
    ok(len(file["cracks/bond"]) > 0, "some bonds break")
    tension = file["history/lateral_tension"][:]
    ok(tension[:-1].max() > tension[-1] > 0, "the tension rises and falls")

    layer = ["dem-replay", "-p", at("layer.json")]
    end = [at("layer.h5"), "-o", at("no.h5")]
    ok(refused(65, *layer, "-s", "shrinkage.strain=0.01", *end), "another law of shrinkage: refused")
    ok(refused(65, *layer, "-s", "engine=quasi-static", *end), "equilibria: refused")
    ok(refused(65, *layer, "-s", "bridges.volume=1e-22", *end), "liquid bridges: refused")
    ok(refused(65, *layer, "-s", "keep_state=true", *end), "a state to go on from: refused")
    run("pack", "-q", "-p", at("layer.json"), "-s", f"counts=[{SIDE},{SIDE},1]", "-o", at("flat.h5"))
    ok(refused(65, *layer, "-s", "support=wall", at("flat.h5"), "-o", at("no.h5")),
       "a layer of one grain has no pore: refused")
    with open(at("loose.txt"), "w") as file:
        file.writelines(f"{i * 4e-6} {j * 4e-6} {k * 4e-6} 1e-6\n"
                        for i in range(3) for j in range(3) for k in range(3))
    run("pack", "-q", "-s", "method=import", "-s", "check=none", at("loose.txt"), "-o", at("loose.h5"))
    ok(refused(65, *layer, "-s", "bond.by=none", at("loose.h5"), "-o", at("no.h5")),
       "grains so far apart that gas is everywhere: refused")

    # What a run says.
    def said(*settings):
        process = subprocess.run([f"{BIN}/{layer[0]}", *layer[1:], *sets(*settings), *end],
                                 capture_output=True, text=True)
        return process.returncode, process.stderr

    ok("2 gamma cos(theta)/r" in said()[1], "a suction below that of the throats: told")
    dries = ["capillary.control=evaporation", "capillary.evaporated=0.5", "capillary.rounds=4"]
    ok("less than capillary.evaporated" in said(*dries)[1],
       "also where it is too small for what is to evaporate")
    ok("is too small" not in said(*dries, f"capillary.suction={2 * ENTRY}")[1] +
       said(f"capillary.suction={2.04 * ENTRY}")[1], "but not where it is enough")
    soft = ["normal_stiffness=20", "shear_stiffness=20", "bond.normal_stiffness=1e13", "bond.shear_stiffness=4e12"]
    whole = ["capillary.evaporated=1", "capillary.steps=8", f"capillary.suction={4 * ENTRY}", "tolerance=1e-4"]
    ok("is too small" not in said(*dries, *whole, *soft)[1], "nor where a soft layer has pressed the rest out")
    hasty = ["tolerance=1e-15", "cycles=16", "most_cycles=16"]
    ok("did not come to rest" in said(*hasty)[1] and "quasi-static" not in said(*hasty)[1],
       "steps that do not rest: no advice to use equilibria, which do not drain")
    ok("times as stiff as bonds" not in said(*hasty)[1]
       and "times as stiff as bonds" in said(*hasty, "normal_stiffness=2e6", "shear_stiffness=2e6")[1],
       "nor of softer grains, unless they are far stiffer than bonds")
    ok(said(*hasty, "unsettled=stop")[0] == 3, "unsettled=stop ends with status 3")
    ok("force-protocol" not in said("gravity=9.81")[1],
       "with gravity: no advice about forces that there are none of")
done()
