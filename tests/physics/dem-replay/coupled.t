#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Drying and shrinking in turns: parts that join to the whole, and no liquid lost between them.
import json
import os
import signal
import subprocess
import sys
import time

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

sys.path.insert(0, "tests")
from tap import BIN, done, ok, refused, run, scratch, sets

SOFT = "samples/soft-10x5x5.json"

with scratch() as folder:
    at = lambda name: os.path.join(folder, name)

    def stage(name, inputs, output, *settings):
        run(name, "-p", SOFT, "--quiet", *sets(*settings),
            *map(at, inputs), "-o", at(output))
        return h5py.File(at(output))

    def same(a, b, entries):
        return all(a[e].shape == b[e].shape and a[e][:].tobytes() == b[e][:].tobytes() for e in entries)

    def goes_on(whole, early, late):
        """What broke in the early part stays broken in what is counted and drawn of the late one."""
        bond = [h5py.File(at(name))[entry][:].tolist()
                for name, entry in ((early, "cracks/bond"), (late, "earlier_cracks/bond"))]
        left = [json.loads(run("crackstats", at(name)))["each"][0]["fragments"] for name in (whole, early, late)]
        run("inspect", "--vtk", at(whole), at(whole))
        run("inspect", "--vtk", at(late), at(late))
        drawn = [sum(np.array(crack_states(at(f"{name}-{frame:04}.vtu"))) > 0)
                 for name, frame in ((whole, last_frame(whole)), (late, last_frame(late)))]
        return (bond[0] and bond[0] == bond[1] and left[2]["before"] == left[1]["count"]
                and all(left[2][k] == left[0][k] for k in ("count", "largest", "single"))
                and drawn[0] == drawn[1] > 0,
                f"{late}: what broke before stays broken", (len(bond[0]), left, drawn))

    def last_frame(name):
        return len(h5py.File(at(name))["snapshots/time"]) - 1

    def crack_states(path):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(path)
        reader.Update()
        return vtk_to_numpy(reader.GetOutput().GetCellData().GetArray("crack"))

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
    refused("nothing to dry is refused", "stop_saturation: must be below",
            "dry", "-p", SOFT, "--set", "stop_saturation=0.7", "--set", "start_saturation=0.6", at("whole"))

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
    ok(*goes_on("response", "response-early", "response-late"))
    # Equilibria go on too: parallel bonds, some of which break in either part.
    uneven = ["bond.strength.distribution=weibull", "bond.strength.modulus=2"]
    glue = ["engine=quasi-static", "bond.kind=parallel", "bond.normal_strength=1e6", "bond.shear_strength=1e6", *uneven]
    whole = stage("dem-replay", ["forces"], "response-still", *glue)
    early = stage("dem-replay", ["early"], "early-still", *glue, "keep_state=true")
    late = stage("dem-replay", ["late", "early-still"], "late-still", *glue, "keep_state=true")
    ok(all((np.concatenate([early[e][:], late[e][:]]) == whole[e][:]).all() for e in cracks)
       and len(early["cracks/bond"]) and len(late["cracks/bond"])
       and all((np.concatenate([early[e][:], late[e][:]]) == whole[e][:]).all()
               for e in ("history/unbalanced_ratio", "history/cycles", "history/reaction_force"))
       and (late["snapshots/displacement"][-1] == whole["snapshots/displacement"][-1]).all(),
       "equilibria in two parts: the same bits",
       (len(early["cracks/bond"]), len(late["cracks/bond"]), len(whole["cracks/bond"])))
    ok(*goes_on("response-still", "early-still", "late-still"))

    # One that goes on, stopped and gone on with.
    uneven = ["keep_state=true", "bond.contact_strength=3e-8", *uneven]
    early = stage("dem-replay", ["early"], "early-uneven", "cycles=100", *uneven)
    command = [f"{BIN}/dem-replay", "-p", SOFT, "--quiet", *sets(*uneven, "cycles=10000"),
               at("late"), at("early-uneven")]
    began = time.monotonic()
    subprocess.run([*command, "-o", at("unstopped")], check=True)
    whole = time.monotonic() - began
    stopped = kept = 0
    for turn in range(100):
        part = subprocess.Popen([*command, "--checkpoint", at("kept"), "-o", at("stopped")], stderr=subprocess.DEVNULL)
        try:
            if part.wait(whole / 4 * 1.05**turn if kept < 4 else None) == 0:
                break
        except subprocess.TimeoutExpired:
            part.terminate()
            stopped += part.wait() != 0
            kept += os.path.exists(at("kept"))
    same_bytes = open(at("stopped"), "rb").read() == open(at("unstopped"), "rb").read()
    ok(0 < kept and stopped < 99 and same_bytes and h5py.File(at("stopped"))["history/cracks"][-1] > 0
       and early["history/cracks"][-1] > 0,
       "one that goes on, stopped and gone on with: the same bytes", (stopped, kept, same_bytes))

    for title, words, says in [
            ("without a state", [at("late"), at("response")], "/engine: is not there"),
            ("of other grains", ["--set", "friction=0.1", "--set", "support=wall", at("late"),
                                 at("response-early")], "this scene has"),
            ("by the other engine", ["--set", "bond.kind=parallel", "--set", "engine=quasi-static",
                                     at("late"), at("response-early")], "was kept by engine=explicit"),
            ("cycles from equilibria", ["--set", "bond.kind=parallel", at("late"), at("early-still")],
             "was kept by engine=quasi-static")]:
        refused(f"refused: {title}", says, "dem-replay", "-p", SOFT, *words)

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

    # The whole loop, also where the grains are tessellated anew, and by equilibria.
    def loop(title, scene, changes, anew, portions="2"):
        with open(scene, encoding="utf-8") as file:
            tiny = json.load(file)
        for name, section in changes.items():
            tiny[name].update(section)
        with open(at("tiny.json"), "w", encoding="utf-8") as file:
            json.dump(tiny, file)
        command = ["pipelines/studies/coupled/run", at("tiny.json"), portions, at(f"{title}/course.tsv")]
        end = subprocess.run(command, env=os.environ | {"BIN": BIN}, capture_output=True)
        with open(at(f"{title}/course.tsv"), encoding="utf-8") as file:
            blocks = file.read().split("\n\n\n")
        left = float(blocks[0].splitlines()[-1].split()[0]) if blocks[0] else 1
        ok(end.returncode == 0 and len(blocks) == 3 and left == 0
           and any(os.path.exists(at(f"{title}/{k}/anew.h5")) for k in (1, 2, 3)) == anew,
           f"from a scene to its cracks in portions, {title}", end.stderr.decode())
        return command

    quick = {"force-protocol": {"force_scale": 0.2, "steps": 30}, "dem-replay": {"cycles": 100}}
    command = loop("lattice", SOFT, quick | {"pack": {"counts": [4, 3, 3]}}, False, "2+2")

    # Killed in any portion it goes on there; what another run left is not taken.
    def killed(k):
        part = subprocess.Popen(command, env=os.environ | {"BIN": BIN}, stderr=subprocess.DEVNULL,
                                start_new_session=True)
        while part.poll() is None and not os.path.exists(at(f"lattice/{k}/drying.h5")):
            time.sleep(0.001)
        os.killpg(part.pid, signal.SIGKILL)
        return part.wait() != 0

    names = [os.path.join(place, name) for place, _, files in os.walk(at("lattice")) for name in files]
    whole = {name: open(name, "rb").read() for name in names}
    for name in names:
        if name.endswith(".h5"):
            os.remove(name)
    stopped = [killed(1), killed(3)]
    made = os.stat(at("lattice/1/response.h5")).st_mtime_ns
    end = subprocess.run(command, env=os.environ | {"BIN": BIN}, capture_output=True)
    ok(stopped == [True, True] and end.returncode == 0 and made == os.stat(at("lattice/1/response.h5")).st_mtime_ns
       and all(open(name, "rb").read() == whole[name] for name in names),
       "killed and gone on with: the same bytes, and nothing is made twice", (stopped, end.stderr.decode()))
    # In portions as short as it takes for throats to keep their room, killed once.
    def room(path):
        with h5py.File(path) as network:
            return volumes(network).sum()

    def changes(folder, count):
        return [abs(room(at(f"{folder}/{k}/network.h5")) / room(at(f"{folder}/{k}/drying.h5")) - 1) for k in range(1, count + 1)]

    def count_portions(folder):
        return len([name for name in os.listdir(at(folder)) if name.isdigit()]) - 1

    free = [*command[:2], "1", "most_change=0", at("free/course.tsv")]
    bounded = [*command[:2], "1", "most_change=0.07", at("bounded/course.tsv")]
    ends = [subprocess.run(each, env=os.environ | {"BIN": BIN}, capture_output=True) for each in (free, bounded)]
    n = count_portions("bounded")
    found = changes("bounded", n)
    ok([end.returncode for end in ends] == [0, 0] and count_portions("free") == 1 and n > 3 and max(found) <= 0.07,
       "portions are halved until throats keep their room", (n, found))
    course = open(at("bounded/course.tsv"), "rb").read()
    for k in range(2, n + 1):
        for name in os.listdir(at(f"bounded/{k}")):
            if k > 3 or not name.startswith("drying.h5"):
                os.remove(at(f"bounded/{k}/{name}"))
    end = subprocess.run(bounded, env=os.environ | {"BIN": BIN}, capture_output=True)
    ok(end.returncode == 0 and open(at("bounded/course.tsv"), "rb").read() == course and count_portions("bounded") == n,
       "and gone on with in the middle: the same bytes", end.stderr.decode())

    end = subprocess.run([*command[:-1], "force-protocol.force_scale=0.1", command[-1]],
                         env=os.environ | {"BIN": BIN}, capture_output=True)
    ok(end.returncode == 0 and all((open(name, "rb").read() != whole[name]) == ("/0/" not in name)
                                   for name in names if name.endswith(("drying.h5", "response.h5", "0/network.h5"))
                                   and "1/drying" not in name),
       "another run is made anew", end.stderr.decode())

    # What is not of such a run is not touched, and what cannot be meant is not run.
    def refusal(status, word, folder, portions, *settings):
        end = subprocess.run(["pipelines/studies/coupled/run", at("tiny.json"), portions, *settings, at(f"{folder}/course.tsv")],
                             env=os.environ | {"BIN": BIN}, capture_output=True, text=True)
        return (end.returncode, end.stderr.count("\n"), word in end.stderr) == (status, 1, True)

    os.makedirs(at("other/1"))
    with open(at("other/1/drying.h5"), "w", encoding="utf-8"):
        pass
    refusals = [refusal(64, "portions", "none", word) for word in ("0", "0+0", "3+", "+3", "-1", "1+x")]
    refusals += [refusal(64, word, "none", "2", word) for word in ("demreplay.cycles=2", "dry=3")]
    refusals += [refusal(64, "most_change", "none", "2", f"most_change={word}") for word in ("abc", "-1", "")]
    refusals += [refusal(73, "other/1/drying.h5", "other", "2")]
    for device in "/dev/null", "/dev/stdout": # the second is a file here
        with open(at("printed"), "w", encoding="utf-8") as file:
            end = subprocess.run(["pipelines/studies/coupled/run", at("tiny.json"), "2", device],
                                 env=os.environ | {"BIN": BIN}, stdout=file, stderr=subprocess.PIPE, text=True)
        refusals += [end.returncode == 73 and end.stderr.count("\n") == 1 and "must be a file" in end.stderr]
    ok(all(refusals) and os.path.getsize(at("other/1/drying.h5")) == 0 and not os.path.exists(at("none")),
       "refused in a line, and nothing lost", refusals)

    still = {"engine": "quasi-static", "support": "fixed"}
    loop("water", SOFT, quick | {"pack": {"counts": [3, 3, 2]}, "conditions": {"liquid_density": None}}, False)
    loop("equilibria", "samples/stiff-5x5x10.json",
         {"pack": {"counts": [3, 3, 4]}, "force-protocol": {"steps": 30}, "dem-replay": still}, False)
    gone = still | {"support": "wall", "quasi_static": {"large_displacements": True}} # nothing presses it there
    loop("grains that all leave", "samples/stiff-5x5x10.json",
         {"pack": {"counts": [3, 3, 4]}, "force-protocol": {"steps": 12, "force_scale": 1}, "dem-replay": gone}, False)
    with open(at("grains that all leave/course.tsv"), encoding="utf-8") as file:
        ok("\tnan\n" in file.read().split("\n\n\n")[1], "and no body is left to tell its shrinkage")
    loop("irregular", "samples/soft-300.json", quick | {"pack": {"count": 80}, "dry": {"liquid_density": 800}}, True)
    drawn = {"throat_radius": {"distribution": "normal", "mean": 1e-7, "standard_deviation": 2e-8}}
    loop("irregular, radii drawn", "samples/soft-300.json", quick | {"pack": {"count": 80}, "dry": drawn}, True)
done()
