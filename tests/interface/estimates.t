#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""--estimate: the sizes are those of the artifacts that are then made, memory is what `time` measures, seconds
are those of the processor (widely: other programs run), disk is that of the files, and a study plans by them."""
import json
import os
import re
import resource
import subprocess
import sys

import h5py

sys.path.insert(0, "tests")
from tap import BIN, SCENE, done, ok, scratch, sets

CHAIN = ["pack", "tessellate", "merge-nodes", "dry", "force-protocol", "dem-replay"]
folder = scratch()
at = lambda name: os.path.join(folder.name, name)


def call(stage, *words):
    ended = subprocess.run([f"{BIN}/{stage}", *words], capture_output=True, text=True, timeout=300, cwd=folder.name)
    return ended.returncode, ended.stdout, ended.stderr


def estimate(stage, *words):
    status, said, error = call(stage, *words)
    if status:
        print(f"# {stage} {words}: {error}", file=sys.stderr)
    return json.loads(said)


def measured(stage, *words):
    """CPU seconds and MiB of a run."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(["/usr/bin/time", "-q", "-f", "%M", "-o", at("peak"), f"{BIN}/{stage}", "-q", *words], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(at("peak"), encoding="utf-8") as file:
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, float(file.read()) / 1024


def on_disk(said, name):
    """MiB foreseen over those of the file."""
    return said["disk_mebibytes"] * 2**20 / os.path.getsize(at(name))


def is_near(said, seconds, mebibytes):
    """Memory within a factor of two, seconds of a busy machine within six."""
    low, high = said.get("range", [said["seconds"]] * 2)
    return mebibytes / 2 < said["mebibytes"] < 2 * mebibytes and low / 6 < seconds < 6 * high


scene = ["-p", os.path.abspath(SCENE)]
jammed = ["-p", os.path.abspath("samples/irregular-50000.json"), *sets("count=400", "method=radius_expansion")]
small = {"pack": jammed, "force-protocol": [*jammed[:2], *sets("steps=20")],
         "dem-replay": [*jammed[:2], *sets("cycles=100", "time_step_safety=null", "loose_grains=unload")]}
for title, words_of in ("a lattice", {}), ("irregular grains", small):
    source, sizes, off, disk = [], "", [], []
    for stage in CHAIN:
        words = words_of.get(stage, scene if not words_of else jammed[:2])
        here, alone = estimate(stage, "--estimate", *words, *source), estimate(stage, f"--estimate={sizes}" if sizes else "--estimate", *words)
        seconds, mebibytes = measured(stage, *words, *source, "-o", at(f"{stage}.h5"))
        source, sizes = [at(f"{stage}.h5")], ",".join(f"{alone.get(k, 0):.12g}" for k in ("grains", "loads", "throats"))
        for said in here, alone:
            if not is_near(said, seconds, mebibytes):
                off.append((stage, said, seconds, mebibytes))
            disk.append(on_disk(said, f"{stage}.h5"))
    ok(not off, f"{title}: memory within a factor of two, seconds of a busy machine within six", off)
    most = 2 if words_of else 2.5  # fronts in lattices are flatter than the estimate has them
    ok(0.5 < min(disk) and max(disk) < most, f"{title}: disk within a factor of {most}", disk)
    with h5py.File(at("force-protocol.h5")) as forces:
        shape = forces["force"].shape
    ok((alone["grains"], alone["loads"]) == shape[:2][::-1], f"{title}: grains and loads are those that are made", f"{alone} {shape}")

# The last network is that of the irregular grains.
off = []
for setting in "rings=isolated", "rings=films", "vapour_step=0.2":
    words = [*jammed[:2], *sets(setting), at("merge-nodes.h5")]
    said, (seconds, mebibytes) = estimate("dry", "--estimate", *words), measured("dry", *words, "-o", at("set.h5"))
    if not is_near(said, seconds, mebibytes):
        off.append((setting, said, seconds, mebibytes))
ok(not off, "and with rings, films and vapour that is kept", off)

thick = [*jammed[:2], *sets("boundary_layer.mass_transfer=0.05", "stop_saturation=0.99"), at("merge-nodes.h5")]
said, (seconds, mebibytes) = estimate("dry", "--estimate", *thick), measured("dry", *thick, "-o", at("thick.h5"))
ok(is_near(said, seconds, mebibytes) and said["seconds"] > 2 * estimate("dry", "--estimate", *jammed[:2], at("merge-nodes.h5"))["seconds"],
   "hundreds of boundary layers take their time", f"{said} {seconds} {mebibytes}")

grown = [estimate("dry", f"--estimate={n}", *scene) for n in (1000, 10000, 100000)]
ok(all(a["seconds"] < b["seconds"] and a["mebibytes"] < b["mebibytes"] for a, b in zip(grown, grown[1:])), "more grains take more", grown)
status, said, error = call("dry", "--estimate", *scene)
ok(status == 64 and said == "" and error.count("\n") == 1 and "--estimate=1000" in error, "without input or number: 64, and what to say", error)
status, said, error = call("dem-replay", "--estimate=1000", *scene)
ok(status == 64 and "--estimate=1000,550" in error, "a replay needs the number of loads", error)
ok(call("dry", "--estimate=none", *scene)[0] == 64, "what is no number: 64")
ok(estimate("pack", "--estimate=500", *sets("method=import"))["grains"] == 500, "grains that are still to be read may be counted")
before = set(os.listdir(folder.name))
estimate("dry", "--estimate", *scene, at("merge-nodes.h5"), "-o", at("nothing.h5"))
ok(set(os.listdir(folder.name)) == before, "nothing is written")
ranged = estimate("dem-replay", "--estimate=1000,100", *scene, *sets("tolerance=1e-3", "cycles=100", "most_cycles=10000"))
exact = [estimate("dem-replay", "--estimate=1000,100", *scene, *sets(f"cycles={n}"))["seconds"] for n in (100, 10000)]
ok(ranged["range"] == exact, "until at rest: from the fewest cycles to the most", f"{ranged} {exact}")
ok("note" in ranged and "note" not in estimate("dem-replay", "--estimate=1000,100", *scene), "and it is said that this is rough", ranged)
wet = ["-p", os.path.abspath("samples/craquelure-wet-40.json"), "-s", "capillary.steps=3"]
call("pack", *wet[:2], *sets("upper=[4e-6,4e-6,4.68e-6]"), "-o", at("layer.h5"))
said = estimate("dem-replay", "--estimate", *wet, at("layer.h5"))
seconds, mebibytes = measured("dem-replay", *wet, at("layer.h5"), "-o", at("drained.h5"))
ok(said["loads"] == 3 and "range" in said and is_near(said, seconds, mebibytes),
   "a packing that drains has the loads of capillary.steps", f"{said} {seconds} {mebibytes}")
cost = {row["stage"]: row for row in json.loads(call("check", at("pack.h5"), "-o", "-")[1])["cost"]}
ok(cost["tessellate"]["seconds"] == estimate("tessellate", "--estimate=400")["seconds"], "check says what stages say", cost)
hasty, restless = (cost[f"dem-replay (100 loads of {n} cycles)"]["seconds"] for n in (100, 10000))
ok(restless > 10 * hasty, "also where no load comes to rest before the default of most_cycles", f"{hasty} {restless}")
told = call("check", at("pack.h5"))[1]
rows = re.findall(r"^(?:cost)? +(\S.*): (\S+) s(?: \(roughly, (\S+) to (\S+)\))?, (\S+) MB$", told, re.M)
ok(len(rows) == len(cost) and not any("e" in number for row in rows for number in row[1:]), "and writes seconds and MB without exponents", told)
ok([bool(row[2]) for row in rows] == ["range" in row for row in cost.values()] and "range" in cost["dem-replay (100 equilibria)"],
   "with the range of what is only known roughly", told)

# ---- a scene of discrete elements: the time step is that of its grains ---------------------------------

slump = ["-p", os.path.abspath("samples/slump.json")]
call("pack", *slump, *sets("count=500"), "-o", at("loose.h5"))
for title, more in ("beads", []), ("moist beads", sets("bridges.volume=2e-12")), ("one time step", sets("time_step=2e-6")):
    words = [*slump, *sets("duration=0.1", "record.snapshots_every=0.005"), *more, at("loose.h5")]
    said, (seconds, mebibytes) = estimate("simulate", "--estimate", *words), measured("simulate", *words, "-o", at("motion.h5"))
    ok(is_near(said, seconds, mebibytes) and 0.5 < on_disk(said, "motion.h5") < 2 and said["grains"] == 500
       and ("range" in said) == (title != "one time step"), f"{title} that move: as near", f"{said} {seconds} {mebibytes}")
status, said, error = call("simulate", "--estimate", *slump)
ok(status == 64 and said == "" and "name an input" in error, "without grains there is no time step: 64", error)
status, said, error = call("simulate", "--estimate", *slump, *sets("box.walls=-x"), at("loose.h5"))
ok(status == 65 and said == "" and error.count("\n") == 1, "what a run refuses, its estimate refuses", error)

# ---- a study that has no run yet --------------------------------------------------------------------

with open(at("study.json"), "w", encoding="utf-8") as file:
    json.dump({"scene": os.path.abspath(SCENE), "seeds": 40, "keep": []}, file)
environment = {**os.environ, "BIN": BIN, "MAKEFLAGS": ""}
study = lambda what: subprocess.run([os.path.abspath("pipelines/study/study"), what, at("study.json"), f"--runs={at('runs')}"],
                                    capture_output=True, text=True, env=environment, timeout=120)
said = study("plan").stdout
ok("40 runs" in said and re.search(r"of one core, as stages foresee it; [\d.]+ MB of disk", said), "plan says what stages foresee", said)
said = study("batch")
with open(at("runs/study/study.sbatch"), encoding="utf-8") as file:
    script = file.read()
alone = estimate("dem-replay", "--estimate=250,550", *scene)["mebibytes"]
memory = int(script.split("--mem-per-cpu=")[1].split("M")[0])
ok(said.returncode == 0 and "--time=" in script and memory >= 1.5 * alone, "batch asks for as much", f"{said.stderr} {script}")
done()
