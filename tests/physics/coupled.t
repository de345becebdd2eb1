#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Drying and shrinking in turns: parts that join to the whole, and no liquid lost between them.
import json
import os
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, run, scratch

SOFT = "samples/soft-10x5x5.json"
COUNTS = ["--set", "counts=[5,4,4]"]

with scratch() as folder:
    at = lambda name: os.path.join(folder, name)

    def stage(name, inputs, output, *settings):
        run(name, "-p", SOFT, "--quiet", *(w for s in settings for w in ("--set", s)),
            *map(at, inputs), "-o", at(output))
        return h5py.File(at(output))

    def same(a, b, entries):
        return all(a[e].shape == b[e].shape and a[e][:].tobytes() == b[e][:].tobytes() for e in entries)

    def volumes(network):
        cylinders = np.pi * network["throats/radius"][:]**2 * network["throats/length"][:]
        return np.where(network["throats/kind"][:] == 0, cylinders, 0)

    def last_saturations(drying):
        saturation = (drying["throats/kind"][:] == 0).astype(float)
        for t, s in zip(drying["changes/throat"][:], drying["changes/saturation"][:]):
            saturation[t] = s
        return saturation

    stage("pack", [], "packing", "counts=[5,4,4]")
    stage("tessellate", ["packing"], "tessellation")
    stage("merge-nodes", ["tessellation"], "network")

    # A drying that stops and goes on is the whole one.
    for liquid in "inviscid", "immobile", "viscous":
        setting = f"liquid={liquid}"
        whole = stage("dry", ["network"], "whole", setting)
        first = stage("dry", ["network"], "first", setting, "stop_saturation=0.6")
        second = stage("dry", ["first"], "second", setting, "start_saturation=0.6")
        end = first["history/time"][-1] + second["history/time"][-1]
        unstopped = np.interp(0.6, whole["history/saturation"][:][::-1], whole["history/time"][:][::-1])
        ok(first["history/saturation"][-1] == 0.6
           and abs(np.dot(last_saturations(first), volumes(first)) / volumes(first).sum() / 0.6 - 1) < 1e-12
           and abs(first["history/time"][-1] / unstopped - 1) < 1e-10
           and abs(end / whole["history/time"][-1] - 1) < (1e-10 if liquid != "viscous" else 0.01)
           and first["summary"].attrs["balance_error"] < 1e-12,
           f"drying in two parts, {liquid}", (end, whole["history/time"][-1]))
    refused = subprocess.run([f"{BIN}/dry", "-p", SOFT, "--set", "stop_saturation=0.7", "--set",
                              "start_saturation=0.6", at("whole")], capture_output=True)
    ok(refused.returncode == 65 and b"stop_saturation: must be below" in refused.stderr, "nothing to dry is refused")

    # So is a replay: cut between two steps of the forces.
    stage("dry", ["network"], "drying")
    stage("force-protocol", ["drying"], "forces", "steps=20", "force_scale=0.3")
    for name, rows in ("early", slice(0, 8)), ("late", slice(8, 20)):
        with open(at("forces"), "rb") as source, open(at(name), "wb") as target:
            target.write(source.read())
        with h5py.File(at(name), "r+") as part:
            for entry in "time", "saturation", "force":
                values, attributes = part[entry][rows], dict(part[entry].attrs)
                del part[entry]
                part.create_dataset(entry, data=values).attrs.update(attributes)
    strength = ["bond.contact_strength=1e-8", "cycles=100"]
    whole = stage("dem-replay", ["forces"], "response", *strength)
    one = stage("dem-replay", ["forces"], "one", *strength, "keep_state=true")
    early = stage("dem-replay", ["early"], "response-early", *strength, "keep_state=true")
    late = stage("dem-replay", ["late", "response-early"], "response-late", *strength, "keep_state=true")
    cracks = [f"cracks/{e}" for e in ("bond", "time", "saturation", "mode", "position")]
    ok(same(whole, one, cracks + ["snapshots/displacement", "snapshots/contact_force"]),
       "one portion that keeps its state is a replay as ever")
    ok(all((np.concatenate([early[e][:], late[e][:]]) == whole[e][:]).all() for e in cracks)
       and len(early["cracks/bond"]) and len(late["cracks/bond"])
       and (late["snapshots/displacement"][-1] == whole["snapshots/displacement"][-1]).all()
       and (late["snapshots/bond_intact"][-1] == whole["snapshots/bond_intact"][-1]).all(),
       "a replay in two parts: the same bits", (len(early["cracks/bond"]), len(whole["cracks/bond"])))
    for title, words, says in [
            ("without a state", [at("late"), at("response")], b"/engine: is not there"),
            ("of other grains", ["--set", "friction=0.1", "--set", "support=wall", at("late"),
                                 at("response-early")], b"this scene has"),
            ("by equilibria", ["--set", "bond.kind=parallel", "--set", "engine=quasi-static",
                               at("late"), at("response-early")], b"only an explicit replay")]:
        refused = subprocess.run([f"{BIN}/dem-replay", "-p", SOFT, *words], capture_output=True)
        ok(refused.returncode == 65 and says in refused.stderr, f"refused: {title}", refused.stderr.decode())

    # In turns: between the portions no liquid is lost, none comes.
    ends, worst, errors = [0.8, 0.6, 0.4, 0.2, 0], 0, []
    network, earlier, radii, expelled = "network", [], [], 0
    for k, end in enumerate(ends):
        drying = stage("dry", [network], f"drying-{k}", *radii, f"stop_saturation={end}")
        stage("force-protocol", [f"drying-{k}"], f"forces-{k}", "steps=20", "force_scale=0.3")
        stage("dem-replay", [f"forces-{k}", *earlier], f"response-{k}", "cycles=100", "keep_state=true")
        moved = stage("deform", [f"drying-{k}", f"response-{k}"], f"network-{k}")
        held = last_saturations(drying)
        before = np.dot(held, volumes(drying))
        saturation = moved["throats/saturation"][:]
        after = np.dot(saturation, volumes(moved))
        error = abs(before - after - moved["summary"].attrs["expelled_volume"]) / volumes(drying).sum()
        worst = max(worst, error)
        expelled += moved["summary"].attrs["expelled_volume"]
        # More fills menisci, less empties them: all that has changed, but one a piece, is full or empty.
        changed = (saturation != held) & (held > 0)
        partly = (changed & (saturation > 0) & (saturation < 1)).sum()
        if partly > drying["history/clusters"][-1] + 1:
            errors.append((k, partly))
        network, earlier, radii = f"network-{k}", [f"response-{k}"], ["throat_radius.distribution=network"]
    ok(worst < 1e-14 and expelled > 0, "no liquid lost or made between portions", worst)
    ok(not errors, "what changes is filled or emptied, menisci first", errors)

    # The whole loop, also where the grains are tessellated anew.
    def loop(title, scene, changes, anew):
        with open(scene, encoding="utf-8") as file:
            tiny = json.load(file)
        for name, section in changes.items():
            tiny[name].update(section)
        with open(at("tiny.json"), "w", encoding="utf-8") as file:
            json.dump(tiny, file)
        end = subprocess.run(["pipelines/coupled-run", at("tiny.json"), "3", at(f"{title}/course.tsv")],
                             env=os.environ | {"BIN": BIN}, capture_output=True)
        with open(at(f"{title}/course.tsv"), encoding="utf-8") as file:
            blocks = file.read().split("\n\n\n")
        left = float(blocks[0].splitlines()[-1].split()[0]) if blocks[0] else 1
        ok(end.returncode == 0 and len(blocks) == 3 and left == 0
           and any(os.path.exists(at(f"{title}/{k}/anew.h5")) for k in (1, 2, 3)) == anew,
           f"from a scene to its cracks in three portions, {title}", end.stderr.decode())

    quick = {"force-protocol": {"force_scale": 0.2, "steps": 30}, "dem-replay": {"cycles": 100}}
    loop("lattice", SOFT, quick | {"pack": {"counts": [4, 3, 3]}}, False)
    loop("irregular", "samples/soft-300.json", quick | {"pack": {"count": 120}}, True)
done()
