#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# inspect shows what h5py finds in the same file, and checks JSON artifacts as well.
import hashlib
import json
import os
import re
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, SCENE, done, ok, run, scratch

with scratch() as folder:
    path = os.path.join(folder, "network.h5")
    packing = run("pack", "-p", SCENE)
    run("tessellate", "-p", SCENE, "-o", path, input=packing)
    shown, file = json.loads(run("inspect", path)), h5py.File(path)
    ok(shown["sha256"] == hashlib.sha256(open(path, "rb").read()).hexdigest(),
       "the digest is that of the file")
    ok(shown["inputs"] == [{"schema": "craquelure/packing/1",
                            "sha256": hashlib.sha256(packing).hexdigest()}],
       "the inputs are those of the call")
    ok(all(shown["summary"][k] == file["summary"].attrs[k] for k in file["summary"].attrs),
       "the summary is the group's attributes")
    names = []
    file.visititems(lambda name, item: names.append("/" + name)
                    if isinstance(item, h5py.Dataset) and not name.startswith("VTKHDF")
                    else None)
    found = {d["name"]: d for d in shown["datasets"]}
    # VTKHDF comes first in the file, so h5py visits what both share under that name only
    ok(set(names) <= set(found) and len(found) == 15, "every dataset is listed", names)
    ok(all(d["shape"] == list(file[n].shape) for n, d in found.items()), "with its shape")
    ok(all(d["units"] == file[n].attrs["units"].decode() if isinstance(file[n].attrs["units"], bytes)
           else d["units"] == file[n].attrs["units"] for n, d in found.items()), "and units")
    ok(all(d["minimum"] == file[n][:].min() and d["maximum"] == file[n][:].max()
           for n, d in found.items()), "and extremes")
    ok(all(d["sha256"] == hashlib.sha256(file[n][:].tobytes()).hexdigest()
           for n, d in found.items()), "and the digest of its values")
    data = json.loads(run("inspect", "--data", "throats/nodes", path))
    ok(np.array_equal(data, file["throats/nodes"]), "--data prints one, value for value")

    # Extended XYZ, read by its own header.
    def frames(name):
        lines = run("inspect", "--xyz", "-", "--frames", "3", os.path.join(folder, name)).decode().split("\n")
        while lines[0]:
            n, head = int(lines[0]), lines[1]
            columns = re.search(r"Properties=(\S+)", head)[1].split(":")
            rows, table, at = [line.split() for line in lines[2:2 + n]], {}, 0
            for key, width in zip(columns[::3], map(int, columns[2::3])):
                table[key] = np.array(rows, float).reshape(n, -1)[:, at:at + width].squeeze()
                at += width
            yield head, table
            lines = lines[2 + n:]

    small = ["--set", "counts=[2,2,3]"]
    for stage, source, made, words in [
            ("pack", "", "packing", small), ("tessellate", "packing", "raw", ()), ("merge-nodes", "raw", "merged", ()),
            ("dry", "merged", "drying", ()), ("force-protocol", "drying", "forces", ["--set", "steps=9", "--set", "force_scale=3"]),
            ("dem-replay", "forces", "response", ["--set", "cycles=50"])]:
        run(stage, "-q", "-p", SCENE, *words, *([os.path.join(folder, source)] if source else []),
            "-o", os.path.join(folder, made))
    own = {name: h5py.File(os.path.join(folder, name)) for name in ["packing", "forces", "response"]}
    same = lambda a, b: a.shape == b.shape and np.allclose(a, b, rtol=1e-8, atol=0)
    (head, table), = frames("packing")
    ok(same(table["pos"], own["packing"]["particles/position"][:]) and same(table["radius"], own["packing"]["particles/radius"][:])
       and 'pbc="F F F"' in head, "--xyz has the grains")
    found = [table["force"] for _, table in frames("forces")]
    ok(len(found) == 3 and all(same(a, b) for a, b in zip(found, own["forces"]["force"][:][[0, 4, 8]])), "their forces")
    found, moments = list(frames("response")), own["response"]["snapshots"]
    ok(len(found) == len(moments["time"]) > 1, "a frame for each snapshot of a response", len(found))
    broken = [np.bincount(own["response"]["bonds/particles"][:][whole == 0].ravel(), minlength=12) for whole in moments["bond_intact"][:]]
    ok(all(same(table["displacement"], moved) and np.array_equal(table["broken_bonds"], count)
           and same(table["pos"], own["packing"]["particles/position"][:] + moved)
           for (_, table), moved, count in zip(found, moments["displacement"][:], broken)) and np.any(broken),
       "with displacements and broken bonds", broken)

    def refused(document, says):
        done = subprocess.run([f"{BIN}/inspect"], input=json.dumps(document).encode(),
                              capture_output=True)
        return done.returncode == 65 and says in done.stderr.decode()

    ok(refused({"schema": "craquelure/crackstats/1"}, "/runs: is missing"),
       "a JSON artifact without a member is refused")
    ok(refused({"schema": "craquelure/tea/1"}, "is unknown"), "and one of an unknown schema")
    ok(refused({"schema": "craquelure/packing/1"}, "HDF5"), "and JSON that should be HDF5")
done()
