#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# artdiff finds what h5py has changed in an artifact, and nothing else.
import json
import os
import shutil
import subprocess
import sys

import h5py

sys.path.insert(0, "tests")
from tap import BIN, SCENE, done, ok, run, scratch


def artdiff(*arguments):
    """Its exit status, and the lines it prints."""
    done = subprocess.run([f"{BIN}/artdiff", *map(str, arguments)], stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, text=True)
    return done.returncode, done.stdout.splitlines()


with scratch() as folder:
    one, other = (os.path.join(folder, name) for name in ("one.h5", "other.h5"))
    network = run("merge-nodes", "-p", SCENE, input=run(
        "tessellate", "-p", SCENE, input=run("pack", "-p", SCENE)))
    run("dry", "-p", SCENE, "-o", one, input=network)

    def change(edit):
        shutil.copy(one, other)
        with h5py.File(other, "r+") as file:
            edit(file)

    ok(artdiff(one, one) == (0, []), "an artifact and itself: none")

    def rate(file):
        file["history/rate"][3] -= 1e-7 * file["history/rate"][:].max()
    change(rate)
    status, lines = artdiff(one, other)
    ok(status == 1 and len(lines) == 1 and lines[0].startswith("/history/rate: by up to 1.00e-07 ")
       and "at row 3:" in lines[0] and lines[0].endswith("1 of 476 differ"),
       "one rate, by how much, and where", lines)
    ok(artdiff("-t", "1.01e-7", one, other) == (0, []), "not with a larger tolerance")
    ok(artdiff("-t", "0.99e-7", one, other)[0] == 1, "but with a smaller")
    ok(artdiff("-q", one, other) == (1, []), "--quiet: the status alone")
    ok(artdiff(other, one)[0] == 1, "either way round")

    def clusters(file):
        file["history/clusters"][5] += 1
    change(clusters)
    ok(artdiff("-t", 1, one, other)[0] == 1, "whole numbers are equal or not, with any tolerance")

    def optional(file):
        del file["history/normalised_rate"]
    change(optional)
    ok(artdiff(one, other) == (1, [f"/history/normalised_rate: only in {one}"]),
       "what is in one alone")

    def summary(file):
        file["summary"].attrs["liquid_mass"] *= 1 + 1e-6
        file["summary"].attrs["residual"] = 1e-9
    change(summary)
    status, lines = artdiff("-t", "1e-7", one, other)
    ok(status == 1 and len(lines) == 1 and lines[0].startswith("/summary/liquid_mass: "),
       "a mass counts of itself, a residual of 1", lines)

    run("dry", "-p", SCENE, "--set", "throat_radius.seed=2", "-o", other, input=network)
    status, lines = artdiff(one, other)
    ok(status == 1 and "/history/time: 476 and 479 rows" in lines, "other numbers of rows", lines)

    path = os.path.join(folder, "network.h5")
    with open(path, "wb") as file:
        file.write(network)
    ok(artdiff(one, path) == (1, ["schema: craquelure/drying/1 and craquelure/network/1"]),
       "other schemas")

    forces = run("force-protocol", "-p", SCENE, "--set", "steps=5", one)
    response = run("dem-replay", "-p", SCENE, "--set", "cycles=10", input=forces)
    counts = json.loads(run("crackstats", input=response))
    paths = [os.path.join(folder, name) for name in ("one.json", "other.json")]

    def write(path, counts):
        with open(path, "w") as file:
            json.dump(counts, file)
        return path
    write(paths[0], counts)
    ok(artdiff(paths[0], paths[0]) == (0, []), "JSON and itself: none")
    counts["program"] = "another"
    counts["cracks"]["total"] += 1
    status, lines = artdiff("-t", "1e-3", paths[0], write(paths[1], counts))
    ok(status == 1 and len(lines) == 1 and lines[0].startswith("/cracks/total: "),
       "a count, but not the program that counted", lines)

    for arguments, expected, title in (
            ([one], 64, "one artifact alone"), ([one, one, one], 64, "three"),
            (["-t", "nan", one, one], 64, "no tolerance"), (["-t", "-1", one, one], 64, "below 0"),
            ([one, paths[0]], 65, "HDF5 and JSON"), ([one, SCENE], 65, "no artifact"),
            ([one, os.path.join(folder, "none")], 66, "no such file")):
        ok(artdiff(*arguments)[0] == expected, f"{title}: {expected}", artdiff(*arguments))
done()
