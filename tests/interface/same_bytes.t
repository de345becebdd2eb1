#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Same input, same bytes: through files, through pipes, by any number of threads, twice.
import os
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, SCENE, done, ok, read, run, scratch

STAGES = ["pack", "tessellate", "merge-nodes", "dry", "force-protocol", "dem-replay",
          "crackstats"]
SHORT = {"dem-replay": ["--set", "cycles=20"]}

def files(folder, threads):
    made = []
    for number, stage in enumerate(STAGES):
        out = os.path.join(folder, f"{number}-{threads}")
        run(stage, "-p", SCENE, *SHORT.get(stage, []), "--threads", threads,
            *(made[-1:] if made else []), "-o", out)
        made.append(out)
    return [read(path) for path in made]

def pipes():
    made = [b""]
    for stage in STAGES:
        made.append(run(stage, "-p", SCENE, *SHORT.get(stage, []), input=made[-1]))
    return made[1:]

with scratch() as one, scratch() as two:
    first = files(one, 1)
    ways = {"twice": files(two, 1), "with two threads": files(two, 2), "through pipes": pipes()}
    for way, made in ways.items():
        for stage, a, b in zip(STAGES, first, made):
            ok(a == b, f"{stage} {way} gives the same bytes")
    # Threads share the work of dem-replay only where there is enough of it.
    large = os.path.join(one, "large.h5")
    run("pack", "--set", "counts=[12,12,14]", "-o", large)
    with h5py.File(large, "a") as forces:
        forces.attrs["schema"] = "craquelure/forces/1"
        forces["time"], forces["saturation"] = [0.0, 1.0, 2.0], [1.0, 0.5, 0.0]
        forces["force"] = 1e-7 * np.random.default_rng(1).normal(size=(3, 12 * 12 * 14, 3))
        for name in ("capillary_pressure", "force_scale", "largest_force",
                     "first_period_end_time"):
            forces["summary"].attrs[name] = 1.0
    made = [run("dem-replay", "-p", SCENE, "--threads", n, "--set", "cycles=30", large)
            for n in (1, 2, 3)]
    ok(made[0] == made[1] == made[2], "dem-replay of 2016 grains by 1, 2 and 3 threads")
    # Equilibria find their way alone: threads make no difference to them either.
    few, made = "tests/hard/scale.json", b""
    for stage in STAGES[:5]:
        made = run(stage, "-p", few, input=made)
    for more in "friction=0", "friction=0.5", "quasi_static.large_displacements=true":
        how = ["dem-replay", "-q", "-p", few, "--set", "engine=quasi-static", "--set", more]
        ok(len({run(*how, "--threads", n, input=made) for n in (1, 2, 3)}) == 1,
           f"equilibria, {more}, by 1, 2 and 3 threads")
    # A whole scene, or the stage's own section: the same parameters.
    import json
    with open(SCENE) as scene:
        scene = json.load(scene)
    section = {key: value for key, value in scene["conditions"].items() if key != "comment"} | scene["dry"]
    own = os.path.join(one, "dry.json")
    with open(own, "w") as file:
        json.dump(dict(reversed(section.items())), file)
    ok(run("dry", "-p", own, input=first[2]) == first[3],
       "a section of its own, keys in another order, gives the same bytes")
    with open(own, "w") as file:
        json.dump({program: {} for program in os.listdir(BIN)
                   if program not in ("artdiff", "inspect")}, file)  # these take none
    ok(run("pack", "-p", own) == run("pack"), "a scene has room for a section of every program")
    ok(run("pack", "--set", "seed=2e0", "--set", "radius=1") ==
       run("pack", "--set", "seed=2", "--set", "radius=1.0"), "so do numbers written otherwise")
done()
