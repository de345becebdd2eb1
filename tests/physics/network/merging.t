#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Merging of random networks [K 3.3.7]: thresholds of every kind, closed faces, volumes, and
# what the report says.
import json
import os
import subprocess
import sys
from collections import Counter

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, read, run, scratch_paths, sets

with scratch_paths() as at:
    open_ = lambda name: h5py.File(at(name))
    radius = 250e-9

    def merge(origin, name, *settings):
        run("merge-nodes", *sets(*settings), at(origin), "--report", at("report.json"), "-o", at(name))
        return open_(name), json.loads(read(at("report.json")))

    run("pack", "--set", "method=poisson", "--set", "count=300", "--set", "seed=7",
        "--set", f"radius={radius}", "--set", "upper=[6e-6,6e-6,6e-6]", "-o", at("packing.h5"))
    run("tessellate", at("packing.h5"), "-o", at("before.h5"))
    before = open_("before.h5")
    n_throat = len(before["throats/length"])
    lengths = np.sort(before["throats/length"][:])

    # What each measure counts.
    mean = lengths.mean()
    for measure, threshold, limit in [("absolute", 3e-8, 3e-8), ("mean_length", 0.1, 0.1 * mean),
                                      ("grain_radius", 0.2, 0.2 * radius)]:
        after, report = merge("before.h5", "after.h5", f"measure={measure}", f"threshold={threshold}")
        kept = np.sort(after["throats/length"][:])
        ok((lengths < limit).any() and (kept[report["kept"]:] >= limit * (1 - 1e-12)).all()
           and report["merged"] > 0, f"{measure}: no shorter throat is left")
    for share in 0.06, 0.13, 0.28:
        after, report = merge("before.h5", f"{share}.h5", "measure=fraction", f"threshold={share}")
        gone = n_throat - len(after["throats/length"])
        ok(0 <= gone - int(share * n_throat) < 8 and gone == report["merged"] + report["fused"],
           f"{share:.0%} of the throats are removed, as K Fig. 3.23", gone)

    # Merging again changes nothing.
    for setting in (["measure=fraction", "threshold=0.28"], ["measure=mean_length", "threshold=0.3"],
                    ["measure=grain_radius", "threshold=0.3"], ["threshold=1e-7", "measure=absolute"]):
        once, _ = merge("before.h5", "once.h5", *setting, "volumes=conserved")
        twice, _ = merge("once.h5", "twice.h5", *setting, "volumes=conserved")
        same = all(once[f"{g}/{n}"][()].tobytes() == twice[f"{g}/{n}"][()].tobytes()
                   for g in ("nodes", "throats", "faces") for n in once[g])
        ok(same and dict(once["summary"].attrs) == dict(twice["summary"].attrs),
           f"{setting[0]}: merging again gives the same network")

    # A cell is a closed surface: each edge of its faces is passed once each way, and joined
    # by a throat.
    after = open_("0.28.h5")
    throats = {tuple(pair) for pair in after["throats/nodes"][:]}
    offset, sides = after["faces/offset"][:], after["faces/particles"][:]
    edges = [Counter() for _ in range(300)]
    joined = True
    for (first, second), begin, end in zip(sides, offset, offset[1:]):
        loop = after["faces/nodes"][begin:end]
        for a, b in zip(loop, np.roll(loop, -1)):
            joined &= (min(a, b), max(a, b)) in throats
            edges[first][a, b] += 1
            if second >= 0:
                edges[second][b, a] += 1
    ok(joined, "faces are loops of throats")
    ok(all(count == cell[b, a] for cell in edges for (a, b), count in cell.items()),
       "and close around every grain")
    ok(len(throats) == len(after["throats/length"]), "no two throats join the same nodes")
    ends = after["nodes/position"][:][after["throats/nodes"][:]]
    ok(np.allclose(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1), after["throats/length"][:],
                   rtol=1e-14, atol=0), "lengths are the distances of the nodes")
    kind, position = after["nodes/kind"][:], after["nodes/position"][:]
    ok(all((position[(kind >> wall & 1) == 1, wall // 2] == wall % 2 * 6e-6).all()
           for wall in range(6)), "nodes on walls stay exactly there")

    # Volumes.
    cylinders = np.pi * before["throats/radius"][:]**2 * before["throats/length"][:]
    kept, report = merge("before.h5", "kept.h5", "measure=fraction", "threshold=0.28",
                         "volumes=conserved")
    ok(abs(kept["throats/volume"][:].sum() / cylinders.sum() - 1) < 1e-13
       and (kept["throats/volume"][:] >= 0).all() and report["lost_volume"] == 0,
       "the sum of the volumes stays")
    ok(abs(report["before"]["volume"] / report["after"]["volume"] - 1) < 1e-13,
       "so says the report")
    ok("throats/volume" not in after, "cylinders stay cylinders unless asked for")
    last, report = merge("before.h5", "last.h5", "measure=absolute", "threshold=1",
                         "volumes=conserved")
    ok(abs(last["throats/volume"][:].sum() / cylinders.sum() - 1) < 1e-13,
       "also when all but what spans the box is merged", len(last["throats/length"]))

    # A picture: of these, and of a network without grains.
    run("import-network", "-o", at("bare.h5"), input=json.dumps({"graph": {
        "metadata": {"number_of_nodes": 2, "number_of_links": 1},
        "nodes": [{"id": str(k), "metadata": {"node_coordinates": {"x": k, "y": 0, "z": 0}}}
                  for k in range(2)],
        "edges": [{"id": "0", "source": "0", "target": "1",
                   "metadata": {"link_length": 1, "link_squared_radius": 0.01}}]}}).encode())
    for names in ["before.h5", "0.06.h5", "0.13.h5", "0.28.h5"], ["bare.h5"]:
        drawn = subprocess.run(["pipelines/figures/network", *map(at, names), at("figure.svg")],
                               capture_output=True, env=dict(os.environ, BIN=BIN))
        ok(drawn.returncode == 0 and not drawn.stderr and open(at("figure.svg")).read()
           .rstrip().endswith("</svg>"), f"a figure of {len(names)}", drawn.stderr.decode())

    # The report counts as numpy does.
    _, report = merge("before.h5", "kept.h5", "measure=fraction", "threshold=0.28")
    for moment, network in ("before", before), ("after", after):
        said = report[moment]
        count = np.bincount(np.bincount(network["throats/nodes"][:].ravel(),
                                        minlength=len(network["nodes/kind"])))
        ok(said["coordination"]["nodes"] == count.tolist(), f"coordination {moment}")
        for name in "length", "radius":
            value, classes = network[f"throats/{name}"][:], said[name]
            width = 2 * classes["middle"][0]
            mine = np.bincount(np.minimum(value / width, 39).astype(int), minlength=40)
            ok(abs(mine - classes["throats"]).sum() <= 2
               and sum(classes["throats"]) == len(value)
               and abs(classes["mean"] / value.mean() - 1) < 1e-12
               and abs(classes["standard_deviation"] / value.std(ddof=1) - 1) < 1e-12,
               f"{name} {moment}")
done()
