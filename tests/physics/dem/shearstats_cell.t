#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""shearstats on a split-bottom cell made from closed forms (tests/split_cell.py): bands, line, torque."""
import os
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
import split_cell as cell
from motions import Contacts, write_motion
from tap import done, ok, run, scratch_paths

at = scratch_paths()


def stats(motions, **settings):
    words = [w for key, value in settings.items() for w in ("--set", f"{key.replace('__', '.')}={value}")]
    run("shearstats", "-q", *motions, "-o", at("out"), *words)
    found = {}
    with h5py.File(at("out")) as file:
        file.visititems(lambda name, item: found.update({name: item[()]})
                        if isinstance(item, h5py.Dataset) else None)
        found.update(file["summary"].attrs)
    return found


def close(got, wanted, tolerance, title):
    worst = np.max(np.abs(np.asarray(got) - wanted))
    ok(worst <= tolerance, title, f"{np.asarray(got).tolist()} for {np.asarray(wanted).tolist()}")


SETTINGS = dict(smoothing_length=2e-3, grid__spacing=2e-3, cell__rate=cell.RATE, cell__lower=0.008,
                cell__upper=0.052, cell__walls="outer", cell__inner_radius=0.05, cell__outer_radius=0.19)
runs = [cell.make(at(f"run{k}"), seed=k) for k in range(4)]
f = stats(runs, **SETTINGS)
os.rename(at("out"), at("cell"))
z = f["levels/height"]
ok(len(z) == 13 and f["levels/fitted"].all(), "a band at each of 13 heights")
shift = np.array([1e-3 * np.random.default_rng(k).normal() for k in range(4)])
for k in range(4):
    close(f["levels/run_centre"][k], cell.centre(z) + shift[k], 5e-4, f"run {k}: centres")
    close(f["levels/run_width"][k], cell.width(z), 1e-3, f"run {k}: widths, without the smoothing")
close(f["levels/centre"], f["levels/run_centre"].mean(0), 1e-15, "centre is the mean over the runs")
t = 3.182446305284263  # Student's, 3 degrees of freedom, 95 %
sd = f["levels/run_centre"].std(0, ddof=1)
close(f["levels/centre_half_width"], t * sd / 2, 1e-12, "its interval is Student's")
ok((f["levels/run_centre_block_error"] > 0).all() and (f["levels/run_centre_block_error"] < 5e-4).all(),
   "blocks within a run scatter less than the runs do", f["levels/run_centre_block_error"].max())
middle = np.argmin(np.abs(f["profiles/radius"] - cell.centre(z[6])))
close(f["profiles/turned"][6, middle], 0.5, 0.2, "the profile is a half near the centre")

close(f["friction"], cell.FRICTION, 0.003, "friction")
close(f["cohesion"], cell.COHESION, 0.15, "cohesion")
ok((f["rheology/run_points"] > 50).all(), "from many cells", f["rheology/run_points"])
flowing = f["fields/flowing"] > 0
near = np.abs(f["grid/centre"][:, 0] - cell.centre(f["grid/centre"][:, 2])) < 0.02
ok(near[flowing].all(), "cells that flow lie in the band")
slope = cell.RATE / 2 * 0.15 / np.sqrt(np.pi)
ok(0.7 * slope / 0.012 < f["fields/shear_rate"][flowing].max() < 1.2 * slope / 0.006, "shear rate",
   f["fields/shear_rate"][flowing].max())
close(f["torque"], cell.TORQUE, 1e-12, "torque of the drive, above 0 where grains resist")
close(f["torque/run_block_error"], 0.1 * cell.TORQUE * np.std(
    [np.sin(2 * np.pi * np.arange(b * 8, b * 8 + 8) / 10).mean() for b in range(5)], ddof=1) / 5 ** 0.5,
      1e-12, "its block error")

# Contacts are spread evenly from -0.02 to 0.1 diameters.
wide = stats(runs[:1], **SETTINGS, separation__class=2e-5 * 10)
close(wide["separations/count"].sum(), 3 * 6000, 1e-9, "every pair of grains is counted once")
lower = wide["separations/from"]
share = wide["separations/count"].sum(1) / 18000
ok(len(lower) == 2 and lower[0] == -2e-4 and lower[1] == 0, "classes begin at multiples of their width", lower)
close(share, [1 / 6, 5 / 6], 0.01, "as many as are at these separations")
dense = wide["separations/count"].sum(0) / wide["separations/volume"]
close(dense[1] / dense[0], 1, 0.08, "as dense inside the band as outside, where nothing differs")
band = 4 * np.pi * 0.144 * 0.009 * cell.HEIGHT  # 2 W wide, all around
close(wide["separations/volume"][1] / band, 1, 0.1, "volume inside the band")

# The pictures and the table of these.
STUDY = os.path.join("pipelines", "studies", "shear")
for what in ["bands", "profiles", "rheology", "torque", "separations"]:
    words = ["unger=0.15"] if what == "bands" else []
    drawn = subprocess.run([f"{STUDY}/figure", what, f"four runs={at('cell')}", *words, at("figure.svg")],
                           stderr=subprocess.PIPE, text=True)
    picture = open(at("figure.svg")).read() if drawn.returncode == 0 else ""
    said = "height" if what == "profiles" else "four runs"
    ok(not drawn.stderr and "</svg>" in picture and said in picture, f"the picture of {what}", drawn.stderr)
subprocess.run([f"{STUDY}/table", f"four runs={at('cell')}", "unger=0.15", at("table.md")], check=True)
table = open(at("table.md")).read()
ok(f"| four runs | 4 | {f['friction']:.4f} ± {f['friction_half_width']:.4f} |" in table, "friction in the table",
   table)
sys.path.insert(0, STUDY)
from shear import unger_centre
close(unger_centre(np.array([0, 0.06]), 0.15, 0.06), [0.15, 0.15 * (1 - 0.4 ** 2.5)], 1e-12,
      "Unger's band begins at the split and ends at Fenistein's radius")
r = unger_centre(np.array([0.02]), 0.15, 0.06)[0]
close(r * (1 - 0.15 / r * (1 - 0.4 ** 2.5)) ** 0.4, 0.04, 1e-12, "and keeps its equation between")

# The inner part turning the other way round.
other = cell.make(at("inner"), seed=9, inner=True, rate=-cell.RATE, spread=0)
f = stats([other], **{**SETTINGS, "cell__rate": -cell.RATE, "cell__turning": "inner"})
close(f["levels/centre"], cell.centre(f["levels/height"]), 5e-4, "inner part turns: centres")
close(f["torque"], cell.TORQUE, 1e-12, "inner part turns: torque")
ok("torque_half_width" not in f and "standard_errors/density" not in f, "one run has no interval")
numbered = stats([other], **{**SETTINGS, "cell__walls": '"1"'})
close(numbered["torque"], -cell.TORQUE, 1e-12, "a wall by its number; of the other rate, it brakes")

# Intervals over runs hold the truth as often as they say: 90 % over 60 studies of three runs each.
held = total = 0
quick = {**SETTINGS, "cell__levels": 2, "blocks": 1, "confidence": 0.9, "grid__spacing": 4e-3}
for study in range(60):
    few = [cell.make(at(f"few{k}"), seed=1000 + 3 * study + k, n=500, snapshots=1) for k in range(3)]
    f = stats(few, **quick)
    held += abs(f["levels/centre"][0] - cell.centre(f["levels/height"][0])) < f["levels/centre_half_width"][0]
    total += 1
ok(abs(held / total - 0.9) < 3 * (0.9 * 0.1 / total) ** 0.5, "intervals hold the truth nine times in ten",
   f"{held} of {total}")

# Forces by separation, and a torque that needs the arm of the force.
pairs = Contacts([(0, 1), (1, 2)], [(0.5, 0, 0), (-0.25, 0, 0)], [(0.5, 0, 0), (1.6, 0, 0)], [0.01, -0.02],
                 [0, 1e-9], [0, 0.25])
row = np.array([[0, 0, 0], [1, 0, 0], [2.2, 0, 0]])
moment, force, moved = np.zeros((1, 1, 3)), np.zeros((1, 1, 3)), np.zeros((1, 1, 3))
force[0, 0] = (0, 3, 0)
moment[0, 0] = (0, 0, 1)
moved[0, 0] = (0.5, 0, 0)
arm = write_motion(at("arm"), [row], [0 * row], 0.5, 1.0, [pairs], walls=[(2, 0, 0)], lower=(-9,) * 3,
                   upper=(9,) * 3, history={"wall_force": force, "wall_moment": moment,
                                            "wall_displacement": moved})
f = stats([arm], cell__rate=1, cell__walls='"0"', cell__lower=-1, cell__upper=1, cell__levels=2,
          separation__class=0.015)
close(f["torque"], -(1 + 2.5 * 3), 1e-12, "a moment about a wall's point becomes one about the axis")
close(f["separations/from"], np.array([-1, 0, 1]) * 0.015, 1e-15, "three classes")
close(f["separations/force"][:, 0], [0.5, 0, -0.25], 1e-15, "mean normal forces push and pull")
close(f["separations/count"][:, 0], [1, 0, 1], 0, "one pair each")
done()
