#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# A drying that records few steps: if it stops it ends in the same state, at the same time, as one that records
# each event, and its first period ends as soon.
import sys

import h5py
import numpy

sys.path.insert(0, "tests")
from tap import SCENE, done, ok, run, scratch_paths, sets


def end_of(step_interval, *settings):
    run("dry", *scene, *sets(*settings, f"step_interval={step_interval}", "stop_saturation=0.437"), at("network"),
        "-o", at("drying"))
    with h5py.File(at("drying")) as file:
        left = numpy.where(file["throats/kind"][:] == 0, 1.0, 0.0)
        for throat, saturation in zip(file["changes/throat"][:], file["changes/saturation"][:]):
            left[throat] = saturation
        return {"left": left, "time": file["history/time"][-1], "clusters": file["history/clusters"][-1],
                "emptied": file["events/throat"][:][file["events/kind"][:] == 0], "steps": len(file["history/time"])}


with scratch_paths() as at:
    scene = ["-q", "-p", SCENE]
    run("pack", *scene, *sets("counts=[3,3,5]"), "-o", at("packing"))
    run("tessellate", *scene, at("packing"), "-o", at("tessellation"))
    run("merge-nodes", *scene, at("tessellation"), "-o", at("network"))
    for settings in ([], ["liquid=immobile"], ["liquid=viscous", "viscosity=1e-3"], ["vapour_step=0.1"],
                     ["kelvin=true"], ["kelvin=true", "liquid=immobile"], ["kelvin=true", "liquid=viscous"]):
        name = ", ".join(settings) or "inviscid"
        few, all_steps = end_of(0.3, *settings), end_of(0, *settings)
        ok(few["steps"] < 7 < all_steps["steps"], f"{name}: few steps, and all", (few["steps"], all_steps["steps"]))
        ok((few["left"][few["emptied"]] == 0).all(), f"{name}: throats that have emptied are empty",
           few["left"][few["emptied"]].max())
        off = abs(few["left"] - all_steps["left"]).max()
        ok(off < 1e-12 and few["clusters"] == all_steps["clusters"] and abs(few["time"] / all_steps["time"] - 1) < 1e-12,
           f"{name}: the same state at the same time", (off, few["time"] / all_steps["time"] - 1))
        first = []
        for step_interval in 0.3, 0:
            run("dry", *scene, *sets(*settings, f"step_interval={step_interval}"), at("network"), "-o", at("drying"))
            with h5py.File(at("drying")) as file:
                first.append(file["summary"].attrs["first_period_end_time"] / file["history/time"][-1])
        ok(0 < first[1] < 1 and abs(first[0] - first[1]) < 1e-12, f"{name}: the first period ends at the same time", first)
done()
