#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Eight soft grains whose throats narrow as they shrink, so that suction rises: in closed form
# they lie at rest up to a critical load, and collapse beyond.
#
# With the stretch s of all lengths, throats of R (√2 s - 1) pull with 2γ/R(√2 s - 1), so that the
# contacts, of stiffness k, carry q m γ/k = (1 - s)(√2 s - 1) under the share q of the load. Each of
# the three throats inside a grain's cell pulls along two axes by m = arctan √2 / √2 (the unit
# normal over the patch of the unit sphere that faces it), which doubles m. The right side is
# largest, (√2 - 1)²/4√2, at s = (1 + √2)/2√2.
import json
import math
import os
import subprocess
import sys

import h5py

sys.path.insert(0, "tests")
from tap import BIN, done, ok, scratch

GAMMA, CONTACT = 0.07274, 5.0  # N/m; two grains of 10 N/m in series
pull = 2 * math.atan(math.sqrt(2)) / math.sqrt(2)
critical = (math.sqrt(2) - 1) ** 2 / (4 * math.sqrt(2)) * CONTACT / (pull * GAMMA)
lowest = (1 + math.sqrt(2)) / (2 * math.sqrt(2))

with scratch() as folder:
    at = lambda name: os.path.join(folder, name)
    with open("samples/soft-10x5x5.json", encoding="utf-8") as file:
        scene = json.load(file)
    scene["pack"]["counts"] = [2, 2, 2]
    scene["dry"] |= {"open": ["-z", "+z"], "imposed_empty": ["-x", "+x", "-y", "+y"]}
    del scene["dry"]["throat_radius"], scene["dem-replay"]["bond"]["contact_strength"]
    scene["force-protocol"]["steps"] = 2
    scene["dem-replay"] |= {"support": "free", "keep_state": True, "snapshots": [0],
                            "tolerance": 1e-7, "cycles": 200}
    with open(at("scene"), "w", encoding="utf-8") as file:
        json.dump(scene, file)

    def stage(name, *words):
        return subprocess.run([f"{BIN}/{name}", "-q", "-p", at("scene"), *words], capture_output=True)

    def settle(share, most):
        """Forces and grains in turns; the stretch in the end, or why there is none."""
        network, earlier = "network", []
        for k in range(1, most + 1):
            for name, *words in [
                    ("dry", "--set", f"stop_saturation={1 - 1e-5 * k}", at(network), "-o", at("drying")),
                    ("force-protocol", "--set", f"force_scale={share * critical}", at("drying"), "-o", at("forces")),
                    ("dem-replay", at("forces"), *earlier, "-o", at(f"response{k % 2}")),
                    ("deform", at("drying"), at(f"response{k % 2}"), "-o", at("moved"))]:
                end = stage(name, *words)
                if end.returncode:
                    return end.returncode, end.stderr.decode()
            network, earlier = "moved", [at(f"response{k % 2}")]
        with h5py.File(at("moved")) as moved:
            return 0, (moved["domain/upper"][:] - moved["domain/lower"][:]) / 1e-6

    for name, before, after in [("pack", [], "packing"), ("tessellate", [at("packing")], "cells"),
                                ("merge-nodes", [at("cells")], "network")]:
        stage(name, *before, "-o", at(after))

    # Near the critical load each turn takes only so much off what is left.
    for share, turns in (0.5, 10), (0.9, 20):
        status, stretch = settle(share, turns)
        wanted = lowest + (1 - lowest) * math.sqrt(1 - share)
        ok(status == 0 and max(abs(stretch - wanted)) < 3e-6, f"at {share} of the critical load they lie as in closed form",
           (status, stretch, wanted))
    # What goes beside OUT does not go beside what OUT leads to, nor to the root.
    os.symlink(at("moved"), at("link"))
    ends = [subprocess.run([os.path.abspath("pipelines/studies/collapse/table"), "no-such-scene", "1", "1", name], cwd=folder,
                           capture_output=True, text=True) for name in ("link", "/dev/stdout", "/dev/null")]
    ok(all(end.returncode == 73 and end.stderr.count("\n") == 1 for end in ends), "a link or a device is refused as OUT",
       [end.stderr for end in ends])
    status, says = settle(1.1, 30)
    ok(status in (3, 65) and ("diverged" in says or "close" in says), "at 1.1 of it they collapse", (status, says))
done()
