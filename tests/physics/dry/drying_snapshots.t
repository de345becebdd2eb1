#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Snapshots of a drying that stops early: the pressures at the stop are those that the same
# drying has there when it goes on.
import sys

import h5py

sys.path.insert(0, "tests")
from tap import SCENE, done, ok, run, scratch_paths, sets

at = scratch_paths()
scene = ["-q", "-p", SCENE]
network = run("merge-nodes", *scene, input=run("tessellate", *scene, input=run("pack", *scene, *sets("counts=[3,3,4]"))))


def pressures(stop, snapshots, kelvin):
    run("dry", *scene, *sets("liquid=viscous", "viscosity=1e-6", f"kelvin={kelvin}", f"stop_saturation={stop}",
                             f"snapshots={snapshots}"), "-o", at("drying"), input=network)
    with h5py.File(at("drying")) as file:
        return file["snapshots/liquid_pressure"][:]


for kelvin in "false", "true":
    stopped, longer = pressures(0.5, [0.8, 0.5, 0.3], kelvin), pressures(0.4, [0.8, 0.5], kelvin)
    ok(longer[1].min() < 0 and (stopped[:2] == longer).all(), f"kelvin {kelvin}: pressures at the stop", abs(stopped[:2] - longer).max())
    ok((stopped[2] == stopped[1]).all(), "what lies below the stop is as at the stop")
done()
