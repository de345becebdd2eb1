#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Snapshots of a drying that stops early, between two throats that empty: the pressures at the
# stop are those with which another drying begins there.
import sys

import h5py

sys.path.insert(0, "tests")
from tap import SCENE, done, ok, run, scratch_paths, sets

at = scratch_paths()
scene = ["-q", "-p", SCENE]
network = run("merge-nodes", *scene, input=run("tessellate", *scene, input=run("pack", *scene, *sets("counts=[3,3,4]"))))


def pressures(kelvin, target, source, stop, *settings):
    run("dry", *scene, *sets("liquid=viscous", "viscosity=1e-6", f"kelvin={kelvin}", f"stop_saturation={stop}",
                             *settings), at(source), "-o", at(target))
    with h5py.File(at(target)) as file:
        return file["snapshots/liquid_pressure"][:], file["snapshots/saturation"][:], file["snapshots/time"][:]


with open(at("network"), "wb") as file:
    file.write(network)
for kelvin in "false", "true":
    for stop in 0.5, 0.72:
        stopped, saturation, _ = pressures(kelvin, "stopped", "network", stop, f"snapshots=[0.8,{stop},0.3]")
        longer, _, _ = pressures(kelvin, "longer", "network", stop - 0.1, "snapshots=[0.8]")
        begun, start, time = pressures(kelvin, "begun", "longer", stop - 0.1, f"start_saturation={stop}",
                                 f"snapshots=[{stop}]")
        ok((stopped[0] == longer[0]).all(), f"kelvin {kelvin}: before the stop at {stop} pressures do not depend on it")
        off = abs(stopped[1] - begun[0]).max() / abs(begun[0]).max()
        ok(begun[0].min() < 0 and saturation[1] == stop and abs(start[0] - stop) < 1e-12 and time[0] == 0 and off < 1e-8,
           f"kelvin {kelvin}: at the stop they are those with which a drying begins there", off)
        ok((stopped[2] == stopped[1]).all(), "what lies below the stop is as at the stop")
done()
