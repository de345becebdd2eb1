#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Soft spheres: below jamming none overlap, above it forces balance on every grain, in
# boxes that repeat and between walls; and slabs cut from packings.
import json
import os
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, read, run, scratch_paths, sets

R = 1e-6
EDGE = np.array([16 * R, 14 * R, 18 * R])
PACK = {"method": "soft_spheres", "radius": R, "upper": list(EDGE), "target": "porosity",
        "sizes": {"distribution": "uniform", "smallest": 0.8 * R, "largest": 1.2 * R}}


def overlaps(position, radius, periodic):
    """Forces of unit stiffness on the grains, those of contacts, with a pair's own loop."""
    apart = position[None] - position[:, None]
    apart -= np.where(periodic, EDGE * np.rint(apart / EDGE), 0)
    distance = np.linalg.norm(apart, axis=2)
    np.fill_diagonal(distance, np.inf)
    overlap = np.maximum(radius[None] + radius[:, None] - distance, 0)
    force = -(overlap[..., None] * apart / distance[..., None])
    force[~np.isfinite(force)] = 0
    net = force.sum(axis=1)
    low, high = (np.maximum(radius[:, None] - gap, 0) for gap in (position, EDGE - position))
    net += np.where(periodic, 0, 2 * (low - high))
    return net, overlap[overlap > 0]


def refused(*settings):
    process = subprocess.run([f"{BIN}/pack", "-q", "-p", scene, *sets(*settings), "-o", os.devnull],
                             capture_output=True, text=True)
    return process.returncode == 65 and process.stderr.count("\n") == 1


with scratch_paths() as at:
    scene = at("scene.json")
    with open(scene, "w") as file:
        json.dump({"pack": PACK}, file)

    def pack(name, *settings):
        run("pack", "-q", "-p", scene, *sets(*settings), "-o", at(name))
        return h5py.File(at(name))

    def told(*settings):
        process = subprocess.run([f"{BIN}/pack", "-p", scene, *sets(*settings), "-o", at("told.h5")],
                                 capture_output=True, text=True, check=True)
        return "asks for a porosity" in process.stderr

    # Rare grains have 125 times the volume of the others.
    large = ["radius=1e-6", "upper=[2e-5,2e-5,2e-5]", "sizes.distribution=two_mode", "sizes.smallest=null",
             "sizes.largest=null", "sizes.second_radius=5e-6", "sizes.second_share=0.01", "target_value=0.6"]
    off = [seed for seed in range(1, 7) if told(*large, f"seed={seed}") != (
        abs(h5py.File(at("told.h5"))["summary"].attrs["porosity"] - 0.6) > 0.01)]
    ok(not off, "a porosity far from the one asked for is told", off)
    ok(told("count=50", "target_value=0.6") and not told("target_value=0.6"), "so is that of too few grains")
    discs = ["method=explosive_repulsion", "dimensions=2", "target_value=0.5", "sizes.distribution=one"]
    ok(told(*discs, "count=30") and not told(*discs), "and that of discs, by their area")

    for periodic in [True] * 3, [True, False, True]:
        flags = "periodic=" + json.dumps(periodic)
        for porosity in 0.45, 0.33:
            file = pack("whole.h5", flags, f"target_value={porosity}")
            place, radius = file["particles/position"][:], file["particles/radius"][:]
            net, contact = overlaps(place, radius, periodic)
            what = f"porosity {porosity}, repeats along {periodic.count(True)} axes"
            solid = 4 / 3 * np.pi * (radius ** 3).sum()
            ok(abs(1 - solid / EDGE.prod() - porosity) < 4 / 3 * np.pi * (1.2 * R) ** 3 / EDGE.prod(),
               f"{what}: as many grains as the porosity asks for")
            if porosity == 0.45:
                ok(not len(contact) or contact.max() < 2e-6 * R, f"{what}: none overlap")
            else:
                ok(np.linalg.norm(net, axis=1).mean() < 1.1e-2 * contact.mean(),
                   f"{what}: forces balance", [np.linalg.norm(net, axis=1).mean(), contact.mean()])
    pack("again.h5", flags, "target_value=0.33", )
    ok(read(at("again.h5")) == read(at("whole.h5")), "the same bytes again")

    periodic = "periodic=[true,true,true]"
    whole = pack("whole.h5", periodic, "target_value=0.36")
    place, radius = whole["particles/position"][:], whole["particles/radius"][:]
    slab = pack("slab.h5", periodic, "target_value=0.36", f"slab.lower={4 * R}", f"slab.upper={13 * R}")
    inside = (place[:, 2] >= 4 * R) & (place[:, 2] <= 13 * R)
    ok((slab["particles/position"][:] == place[inside]).all()
       and (slab["particles/radius"][:] == radius[inside]).all(), "a slab has the grains between")
    ends = [(place - radius[:, None])[inside, 2].min(), (place + radius[:, None])[inside, 2].max()]
    ok([slab["domain/lower"][2], slab["domain/upper"][2]] == ends
       and list(slab["domain/periodic"][:]) == [1, 1, 0], "its box ends on them")
    walls = "periodic=[true,true,false]"
    whole = pack("whole.h5", walls, "target_value=0.36")
    slab = pack("slab.h5", walls, "target_value=0.36", f"slab.upper={13 * R}")
    ok(slab["domain/lower"][2] == whole["domain/lower"][2] and slab["domain/upper"][2] < whole["domain/upper"][2],
       "a floor that is not cut stays where it is")
    ok(refused("target_value=0.4", f"slab.lower={9 * R}", f"slab.upper={5 * R}"), "upside down: refused")
    ok(refused("target_value=0.4", f"slab.lower={90 * R}"), "without a grain: refused")
    ok(refused("dimensions=2"), "soft discs: refused")
    ok(refused("target=coordination", "target_value=6"), "to a coordination: refused")
    ok(refused(), "a porosity that is not said: refused")
    ok(refused("target=settled", "target_value=0.45"), "a porosity that is not the target: refused")
done()
