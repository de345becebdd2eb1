#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# An aggregate that repeats to the sides [K 4.5, 5.9] is bonded across them, and cracks there as
# elsewhere: the same bonds break when the box begins elsewhere.
import shutil
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import CYCLES, SCENE, done, ok, run, scratch_paths, sets

with scratch_paths() as at:
    run("pack", "-p", SCENE, *sets("periodic=[true,true,false]", "counts=[4,4,5]"), "-o", at("p"))
    run("tessellate", "-p", SCENE, at("p"), "-o", at("t"))
    run("merge-nodes", "-p", SCENE, at("t"), "-o", at("n"))
    run("dry", "-p", SCENE, *sets('imposed_empty=["-z"]'), at("n"), "-o", at("d"))
    run("force-protocol", "-p", SCENE, *sets("steps=60", "force_scale=1"), at("d"), "-o", at("forces"))

    # The same forces on grains that are moved across the sides.
    shutil.copy(at("forces"), at("moved"))
    with h5py.File(at("moved"), "r+") as file:
        box = file["domain/upper"][:] - file["domain/lower"][:]
        shift = box * [0.5, 0.25, 0]
        place = file["particles/position"][:] + shift
        file["particles/position"][:] = place - box * [1, 1, 0] * np.floor(place / box)
    for forces, response in ("forces", "response"), ("moved", "other"):
        run("dem-replay", "-p", SCENE, *sets(*CYCLES, "support=fixed", "cycles=200"), at(forces), "-o", at(response))
    here, there = h5py.File(at("response")), h5py.File(at("other"))

    pairs, place = here["bonds/particles"][:], here["particles/position"][:]
    across = (abs(place[pairs[:, 1]] - place[pairs[:, 0]]) > box / 2).any(axis=1)
    ok(len(pairs) == 4 * 4 * (4 + 5 + 5) and across.sum() == 2 * 4 * 5, "bonds across the sides",
       (len(pairs), across.sum()))
    cracks = here["cracks/bond"][:]
    ok(across[cracks].any() and not across[cracks].all(), "some break, and some of the others",
       (len(cracks), across[cracks].sum()))
    same = np.array_equal(cracks, there["cracks/bond"][:])
    ok(same and np.array_equal(here["cracks/mode"][:], there["cracks/mode"][:]),
       "the same when the box begins elsewhere", (len(cracks), len(there["cracks/bond"])))
    if same:
        apart = (there["cracks/position"][:] - here["cracks/position"][:] - shift) / box
        apart -= np.round(apart) * [1, 1, 0]
        ok(abs(apart).max() < 1e-9, "and in the same places", abs(apart).max())
done()
