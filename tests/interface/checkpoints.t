#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checkpoints whose numbers were changed, with a digest that is right again: numbers within their
bounds that do not fit each other. No program may crash, hang or blame itself. FUZZ=5000 tries more.
"""
import hashlib
import os
import random
import shutil
import signal
import struct
import subprocess
import sys
import time

import h5py
import numpy

sys.path.insert(0, "tests")
from tap import BIN, SCENE, done, ok, run, scratch

COUNT = int(os.environ.get("FUZZ", 100)) // 4
MOST_SECONDS = 60
# Done, diverged, bad data.
ALLOWED = {0, 3, 65}
scene = os.path.abspath(SCENE)


def datasets(file):
    """Engine's before stage's, each by name, as the digest takes them."""
    return [file[group][name] for group in ("engine", "stage") if group in file
            for name in sorted(file[group], key=str.encode)]


def digest(file):
    digest = hashlib.sha256()
    for dataset in datasets(file):
        name = dataset.name.rsplit("/", 1)[1].encode()
        digest.update(name + b"\0" + struct.pack("<q", dataset.size) + dataset[...].tobytes())
    return numpy.frombuffer(digest.digest(), "u1")


def another(values, k, chance):
    """In place of one value: one that a program may think of."""
    old, others = values[k], [values[chance.randrange(values.size)] for _ in range(3)]
    if values.dtype.kind == "f":
        return chance.choice([0, -1, -old, 2 * old, 1e3 * old, 1e-300, 1e100, -1e100, old + 1, *others])
    limits = numpy.iinfo(values.dtype)
    new = int(chance.choice([-1, 0, 1, int(old) + 1, int(old) - 1, limits.max, values.max(), *others]))
    return min(max(new, limits.min), limits.max)


def craft(name, chance):
    """Changes one to three numbers; says which."""
    said = []
    with h5py.File(name, "r+") as file:
        full = [dataset for dataset in datasets(file) if dataset.size]
        for _ in range(chance.choice([1, 1, 1, 2, 3])):
            dataset = chance.choice(full)
            values = dataset[...].reshape(-1)
            k = chance.randrange(values.size)
            old, values[k] = values[k], another(values, k, chance)
            dataset[...] = values.reshape(dataset.shape)
            said.append(f"{dataset.name}[{k}]: {old} -> {values[k]}")
        file["digest"][...] = digest(file)
    return "; ".join(said)


def keep_one(command):
    """A checkpoint about half way."""
    began = time.monotonic()
    subprocess.run([f"{BIN}/{command[0]}", *command[1:], "-o", "whole"], check=True)
    takes = time.monotonic() - began
    for share in [0.6, 0.5, 0.7, 0.4, 0.8, 0.3, 0.9] * 3:
        process = subprocess.Popen([f"{BIN}/{command[0]}", *command[1:], "-o", "cut", "--checkpoint", "good"],
                                   stderr=subprocess.DEVNULL)
        time.sleep(share * takes)
        process.send_signal(signal.SIGTERM)
        process.wait()
        if os.path.exists("good"):
            return


def problem_of(command, chance):
    shutil.copy("good", "crafted")
    how = craft("crafted", chance)
    try:
        end = subprocess.run([f"{BIN}/{command[0]}", *command[1:], "-o", "cut", "--checkpoint", "crafted"],
                             capture_output=True, timeout=MOST_SECONDS)
    except subprocess.TimeoutExpired:
        return f"{how}: still running"
    said = end.stderr.decode(errors="replace")
    if end.returncode not in ALLOWED or (end.returncode and len(said.splitlines()) != 1):
        return f"{how}: status {end.returncode}: {said}"
    if end.returncode == 0 and subprocess.run([f"{BIN}/inspect", "cut"], capture_output=True).returncode:
        return f"{how}: wrote what cannot be read"
    return None


def crafted(title, *command):
    keep_one(command)
    if not os.path.exists("good"):
        return ok(True, f"{title}: crafted states # SKIP on a busy machine no run could be cut half way")
    with h5py.File("good") as file:
        ok(bytes(digest(file)) == bytes(file["digest"][...]), f"{title}: the digest is as said")
    problems = [problem_of(command, random.Random(f"{title} {k}")) for k in range(COUNT)]
    ok(not any(problems), f"{title}: what does not fit is refused, or does no harm",
       "\n".join(filter(None, problems)))
    os.remove("good")


with scratch() as folder:
    os.chdir(folder)
    made = b""
    for step in [["pack", "--set", "counts=[6,6,6]"], ["tessellate"], ["merge-nodes"]]:
        made = run(*step, "-p", scene, input=made)
    with open("network", "wb") as file:
        file.write(made)
    for liquid in "inviscid", "immobile", "viscous":
        crafted(f"dry, {liquid} liquid", "dry", "-p", scene, "--set", f"liquid={liquid}", "network")
    for rings in "isolated", "joined", "films":
        crafted(f"dry, {rings} rings", "dry", "-p", scene, "--set", f"rings={rings}", "network")
    crafted("dry, curved menisci", "dry", "-p", scene, "--set", "kelvin=true", "network")
    with open("small", "wb") as file:
        file.write(run("merge-nodes", input=run("tessellate", input=run("pack", "--set", "counts=[3,3,4]"))))
    run("force-protocol", "-o", "forces", "--set", "steps=40", input=run("dry", "small"))
    replay = ["dem-replay", "--quiet", "forces", "--set", "bond.normal_strength=1e3"]
    crafted("dem-replay", *replay, "--set", "time_step_safety=0.02", "--set", "cycles=1000",
            "--set", "tolerance=null", "--set", "ramp=0")
    # Equilibria keep what they have after 256 loads at the latest.
    run("force-protocol", "-o", "forces", "--set", "steps=2000", input=run("dry", "small"))
    crafted("dem-replay by equilibria", *replay, "--set", "engine=quasi-static")
    crafted("pack", "pack", "--quiet", "--set", "method=deposition", "--set", "count=60", "--set",
            "radius=1e-3")
done()
