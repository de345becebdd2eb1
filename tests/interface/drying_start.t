#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# A drying goes on from the middle of another under other air.
import os
import subprocess
import sys

import h5py
import numpy

sys.path.insert(0, "tests")
from tap import BIN, SCENE, done, ok, run, scratch


def dried(path, image):
    with open(path, "wb") as file:
        file.write(image)
    return h5py.File(path)


with scratch() as folder:
    network = b""
    for stage in ["pack", "tessellate", "merge-nodes"]:
        network = run(stage, "-p", SCENE, input=network)
    half = ["--set", "start_saturation=0.5"]
    humid = ["--set", "air_vapour_pressure=1000"]
    whole = run("dry", "-p", SCENE, input=network)
    first = dried(os.path.join(folder, "whole"), whole)
    rest = dried(os.path.join(folder, "rest"), run("dry", "-p", SCENE, *half, *humid, input=whole))
    n = len(rest["events/throat"])
    slower = numpy.log1p(2339 / (1e5 - 2339)) / numpy.log1p(1339 / (1e5 - 2339))
    ok(numpy.array_equal(first["events/throat"][-n:], rest["events/throat"][:]),
       "humid air from half on: the same throats in turn")
    steps = rest["events/time"][1:] - rest["events/time"][:-1]
    before = first["events/time"][-n + 1:] - first["events/time"][-n:-1]
    ok(numpy.allclose(steps, slower * before, rtol=1e-6, atol=1e-12 * first["history/time"][-1]),
       "slower by ln(1 - p_v/p_g) of the air")
    ok(abs(rest["history/saturation"][0] - 0.5) < 1e-13
       and abs(rest["summary"].attrs["balance_error"]) < 1e-12, "from half, and all of it")
    near = dried(os.path.join(folder, "near"),
                 run("dry", "-p", SCENE, *half, "--set", "vapour_tolerance=0.01", input=whole))
    exact = dried(os.path.join(folder, "exact"), run("dry", "-p", SCENE, *half, input=whole))
    ok(numpy.isclose(near["history/time"][-1], exact["history/time"][-1], rtol=0.01)
       and abs(near["summary"].attrs["balance_error"]) < 1e-12, "on with a tolerance of the vapour")
    invaded = dried(os.path.join(folder, "invaded"), run("dry", "-p", SCENE, *half, input=network))
    ok(abs(invaded["history/saturation"][0] - 0.5) < 1e-13
       and invaded["changes/offset"][1] > 100, "from a network: gas has come in")
    made = run("force-protocol", "-p", SCENE, input=open(rest.filename, "rb").read())
    ok(len(made) > 0, "forces are made from it")
    for title, image, more, says in [
            ("a drying that begins with less", open(rest.filename, "rb").read(), [],
             "must be at most that at which"),
            ("a packing", run("pack", "-p", SCENE), [], "must be a network, is a packing")]:
        end = subprocess.run([f"{BIN}/dry", "-p", SCENE, *more], input=image, capture_output=True)
        ok(end.returncode == 65 and says in end.stderr.decode(), f"refused: {title}",
           end.stderr.decode())
done()
