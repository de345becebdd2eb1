#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Same input, same bytes: through files, through pipes, by any number of threads, twice.
import os
import sys

sys.path.insert(0, "tests")
from tap import SCENE, done, ok, read, run, scratch

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
    # A whole scene, or the stage's own section: the same parameters.
    import json
    with open(SCENE) as scene:
        section = json.load(scene)["dry"]
    own = os.path.join(one, "dry.json")
    with open(own, "w") as file:
        json.dump(dict(reversed(section.items())), file)
    ok(run("dry", "-p", own, input=first[2]) == first[3],
       "a section of its own, keys in another order, gives the same bytes")
done()
