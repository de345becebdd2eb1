#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes at random, all of them allowed: parameters drawn from what each stage's schema lets
through, grains through the whole pipeline. A stage does its work or says in one line why not;
what it writes is finite, and holds its balances. SCENES=1000 tries more, from other seeds with
SEED=2; KEEP=FOLDER keeps the files of scenes that failed there.
"""
import json
import os
import random
import shutil
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, scratch, sets

SCENES = int(os.environ.get("SCENES", 24))
SEED = int(os.environ.get("SEED", 1))
KEEP = os.environ.get("KEEP")
MOST_SECONDS = 60
ANSWERS = {0, 1, 3, 65}  # done, no, not converged, bad data
STAGES = ["tessellate", "merge-nodes", "invade", "flow", "dry", "force-protocol", "dem-replay",
          "deform", "crackstats"]
# What makes runs or files long when it is drawn from all that is allowed.
GIVEN = {"force-protocol.steps": 5, "force-protocol.largest_change": 0,
         "force-protocol.most_bytes": 4e9, "dem-replay.cycles": 20,
         "dem-replay.most_cycles": 1000000, "dem-replay.tolerance": None,
         "dem-replay.quasi_static.tolerance": 1e-8, "dem-replay.bridges.model": "willett-full",
         "dry.saturation_step": 1, "dry.boundary_layer.layers": 0}
PACKINGS = [
    ["counts=[2,2,3]"], ["counts=[3,3,4]", "periodic=[true,true,false]"],
    ["method=hexagonal", "counts=[2,2,3]"], ["method=square", "counts=[4,1,5]"],
    ["method=poisson", "count=30", "upper=[3e-6,3e-6,3e-6]"],
    ["method=random_sequential", "count=30", "upper=[3e-6,3e-6,3e-6]"],
    ["method=random_sequential", "count=40", "upper=[3e-6,3e-6,3e-6]",
     "sizes.distribution=lognormal", "sizes.spread=0.3"],
    ["method=random_sequential", "count=40", "domain.shape=ring", "domain.radius=2e-6",
     "domain.inner_radius=0.7e-6", "domain.height=2.5e-6"],
    ["method=random_sequential", "count=40", "upper=[3e-6,3e-6,3e-6]", "domain.cut.shape=cylinder",
     "domain.cut.radius=0.7e-6", "domain.cut.lower=[0,0,1.2e-6]"]]


def leaves(properties, prefix):
    """The parameters of a stage by name, those in groups too."""
    found = {}
    for name, entry in properties.items():
        if entry.get("type") == "object":
            found |= leaves(entry["properties"], f"{prefix}{name}.")
        elif name != "comment":
            found[prefix + name] = entry
    return found


PARAMETERS = {stage: leaves(json.loads(subprocess.check_output([f"{BIN}/{stage}", "--schema"]))
                            ["properties"], "") for stage in STAGES}


def number(entry, default, chance):
    least = entry.get("minimum", entry.get("exclusiveMinimum", -np.inf))
    most = entry.get("maximum", np.inf)
    if entry["type"] == "integer":
        return chance.randint(int(max(least, 0)), int(min(most, max(least, 0) + 5)))
    if np.isfinite(least + most) and chance.random() < 0.5:
        return chance.uniform(least, most)
    drawn = (default or chance.choice([1e-6, 1e-3, 0.1, 1, 10])) * 10 ** chance.choice(
        [0, chance.uniform(-0.5, 0.5), chance.uniform(-3, 3)])
    return min(max(drawn, least), most)


def draw(entry, default, chance):
    if "anyOf" in entry:
        some = next(each for each in entry["anyOf"] if each.get("type") != "null")
        return None if chance.random() < 0.3 else draw(some, default, chance)
    if "enum" in entry:
        return chance.choice(entry["enum"])
    if entry["type"] == "boolean":
        return chance.random() < 0.5
    if entry["type"] == "array":
        words = entry["items"].get("enum")
        return chance.sample(words, chance.randint(0, 3)) if words else default
    return number(entry, default, chance)


def settings(stage, chance):
    names = [name for name in PARAMETERS[stage] if f"{stage}.{name}" not in GIVEN]
    drawn = {name: draw(PARAMETERS[stage][name], PARAMETERS[stage][name].get("default"), chance)
             for name in chance.sample(names, min(len(names), chance.choice([0, 1, 2, 4])))}
    given = {name.removeprefix(stage + "."): value for name, value in GIVEN.items()
             if name.startswith(stage + ".")}
    return [word for name, value in (given | drawn).items()
            for word in ("--set", f"{name}={json.dumps(value)}")]


def look(path, stage):
    """What is wrong with the numbers of an artifact."""
    wrong = []

    def check(name, item):
        if not isinstance(item, h5py.Dataset) or item.dtype.kind != "f" or not item.size:
            return
        values = item[()]
        if not np.isfinite(values).all():
            wrong.append(f"{name}: not finite")
        if name.endswith("saturation") and (values.min() < 0 or values.max() > 1 + 1e-15):
            wrong.append(f"{name}: from {values.min()} to {values.max()}")

    with h5py.File(path) as file:
        file.visititems(check)
        if stage == "dry" and not abs(file["summary"].attrs["balance_error"]) <= 1e-12:
            wrong.append("mass is not balanced")
    return wrong


def follow(seed, folder):
    """One scene from grains to cracks: how it went wrong, and the stages that came to an end."""
    chance = random.Random(seed)
    wrong, ended = [], []

    def stage(name, output, *inputs, words=None):
        inputs = [f"{folder}/{each}" for each in inputs]
        words = settings(name, chance) if words is None else words
        command = [f"{BIN}/{name}", "-q", *inputs, *words, "-o", f"{folder}/{output}"]
        try:
            run = subprocess.run(command, capture_output=True, text=True, timeout=MOST_SECONDS)
        except subprocess.TimeoutExpired:
            wrong.append(f"{name} {words}: still runs after {MOST_SECONDS} s")
            return False
        if run.returncode not in ANSWERS or len(run.stderr.splitlines()) != (run.returncode > 0):
            wrong.append(f"{name} {words}: {run.returncode}: {run.stderr}")
        if run.returncode:
            return False
        ended.append(name)
        if name != "crackstats":
            wrong.extend(f"{name} {words}: {each}" for each in look(f"{folder}/{output}", name))
        return True

    chosen = chance.choice(PACKINGS) + ["bonds=none"] * (seed % 10 == 3)
    grains = sets(*chosen)
    stage("pack", "packing", words=[*grains, "--set", f"seed={seed % 2**32}"])
    if chance.random() < 0.5:
        stage("flow", "flow", "packing")
    if not (stage("tessellate", "raw", "packing") and stage("merge-nodes", "network", "raw")):
        return wrong, ended
    if chance.random() < 0.5:
        stage("invade", "invasion", "network")
    if (stage("dry", "drying", "network") and stage("force-protocol", "forces", "drying")
            and stage("dem-replay", "response", "forces")):
        stage("crackstats", "cracks.json", "response")
        stage("deform", "moved", "drying", "response")
    return wrong, ended


all_wrong, counts = [], {}
with scratch() as top:
    for seed in range(1000000 * SEED, 1000000 * SEED + SCENES):
        folder = f"{top}/{seed}"
        os.mkdir(folder)
        wrong, ended = follow(seed, folder)
        if wrong and KEEP:
            shutil.copytree(folder, f"{KEEP}/{seed}")
        shutil.rmtree(folder)
        all_wrong += [f"{seed}: {each}" for each in wrong]
        for each in ended:
            counts[each] = counts.get(each, 0) + 1
ok(not all_wrong, f"{SCENES} scenes at random end well or in one line", "\n".join(all_wrong))
ok(set(counts) == {"pack", *STAGES}, "and come through every stage", counts)
done()
