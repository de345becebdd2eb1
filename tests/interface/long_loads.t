#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Forces at many times: force-protocol and dem-replay hold a band of them, not all."""
import os
import subprocess
import sys

import h5py
import numpy

sys.path.insert(0, "tests")
from tap import BIN, SCENE, CYCLES, done, ok, run, scratch, sets

FEW, MANY = 51, 10001  # times: of the many 60 MB of forces
MORE = 10e6  # bytes that bands, chunks and what is noted of each time may take


def peak(stage, *words):
    """Runs a stage; gives the most memory that it had, in bytes."""
    child = subprocess.Popen([f"{BIN}/{stage}", *words, "-p", SCENE, "-q", "--threads", "1"])
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    assert child.returncode == 0, (stage, words)
    return used.ru_maxrss * 1024


def forces(steps):
    return peak("force-protocol", *sets(f"steps={steps}", "gravity=9.81"), at("drying"), "-o", at(f"forces-{steps}"))


def replay(steps, *settings):
    return peak("dem-replay", *sets(*CYCLES, "cycles=1", "support=fixed", "snapshots=[0.9,0.5,0.1]", *settings),
                at(f"forces-{steps}"), "-o", at(f"response-{steps}"))


def at(name):
    return f"{folder}/{name}.h5"


with scratch() as folder:
    made = b""
    for stage in ["pack", "tessellate", "merge-nodes", "dry"]:
        made = run(stage, "-p", SCENE, "-q", input=made)
    with open(at("drying"), "wb") as file:
        file.write(made)
    few, many = forces(FEW), forces(MANY)
    ok(many < few + MORE, "force-protocol: memory does not grow with the times", (few, many))
    few, many = replay(FEW), replay(MANY)
    ok(many < few + MORE, "dem-replay: nor here", (few, many))
    liquid = ["shrinkage.strain=1e-4", "shrinkage.law=liquid"]
    few, many = replay(FEW, *liquid), replay(MANY, *liquid)
    ok(many < few + MORE, "dem-replay, with grains that shrink: nor here", (few, many))

    # Times of the few are among those of the many: the same numbers, bit for bit.
    with h5py.File(at(f"forces-{FEW}")) as short, h5py.File(at(f"forces-{MANY}")) as long:
        every = (MANY - 1) // (FEW - 1)
        here = numpy.flatnonzero(short["time"][:] == long["time"][::every])
        ok(len(here) > FEW / 2, "times are the same", short["time"][:] - long["time"][::every])
        for name in ["force", "liquid_mass", "saturation"]:
            ok((short[name][:][here] == long[name][::every][here]).all(), f"/{name}: rows are those of their times")
        force, summary = long["force"][:], long["summary"].attrs
        largest = numpy.linalg.norm(force, axis=2).max()
        change = numpy.linalg.norm(numpy.diff(force, axis=0), axis=2).max()
        sums = numpy.linalg.norm(force.sum(axis=1), axis=1).max() / numpy.linalg.norm(force, axis=2).sum(axis=1).max()
        for name, wanted in [("largest_force", largest), ("largest_change", change / largest), ("net_force", sums)]:
            ok(abs(summary[name] - wanted) <= 1e-12 * wanted, f"{name} is that of all rows", (summary[name], wanted))
        with h5py.File(at(f"response-{MANY}")) as response:
            rows = numpy.searchsorted(long["time"][:], response["snapshots/time"][:])
            applied = response["snapshots/force"][:]
            apart = applied - force[rows]
            # The weight of equal grains comes on top.
            ok(len(rows) == 3 and (abs(apart[:, :, :2]) == 0).all()
               and numpy.ptp(apart[:, :, 2]) < 1e-9 * largest and apart[0, 0, 2] < 0,
               "a step has the forces of its row", numpy.ptp(apart[:, :, 2]))
done()
