#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pages of a flow and of a motion: numbers in the text are those of the artifact, and in a headless
Chromium grains are where straight lines lead them, contacts are those of their moment, colours and
curves have the numbers of the artifact."""
import json
import re
import shutil
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from browser import MISSING, Browser
from tap import BIN, done, ok, run, scratch_paths

at = scratch_paths()


def refused(*words):
    ended = subprocess.run([f"{BIN}/report", *words], capture_output=True, timeout=60)
    return ended.returncode, ended.stderr.decode()


run("pack", "-q", "--set", "counts=[4,4,5]", "--set", "radius=1e-3", "-o", at("packing.h5"))
run("flow", "-q", at("packing.h5"), "-o", at("flow.h5"))


# ---- a motion: grains that fly apart along straight lines --------------------------------

MOMENTS = np.array([0, 0.1, 0.25, 0.4, 1.0])
ROWS = np.linspace(0.0, 1.0, 41)
KEPT = ["position", "radius"]


def write_motion(path):
    """In MOMENTS grain i is at its place + velocity * time; its history is made of closed forms."""
    with h5py.File(at("packing.h5")) as packing, h5py.File(path, "w") as file:
        place, n = packing["particles/position"][:], len(packing["particles/radius"])
        for name in ["domain", "bonds"]:
            packing.copy(name, file)
        for name in KEPT:
            file[f"particles/{name}"] = packing[f"particles/{name}"][:]
        for name, text in {"schema": "craquelure/motion/1", "program": "simulate 1", "parameters": "{}", "inputs": "[]",
                           "model": "contact law: linear\nleft out: <b>rolling</b> friction"}.items():
            file.attrs[name] = np.bytes_(text)
        summary = file.create_group("summary").attrs
        summary.update({"time_step": 1e-5, "time_step_limit": 4e-5, "time": 1.0, "largest_overlap": 0.02})
        summary.update({name: np.int64(v) for name, v in {"cycles": 100000, "ended": 0, "cracks": 0}.items()})
        velocity = 0.01 * (place - place.mean(0)) / 1e-3
        file["particles/material"], file["particles/driven"] = np.zeros(n, "u1"), np.zeros(n, "u1")
        file["particles/group"], file["particles/mass"] = (np.arange(n) % 3).astype("u1"), np.ones(n)
        for name, shape, kind in [("shape", 2, "u1"), ("outside", 2, "u1"), ("radius", 2, "f8"), ("inner_radius", 2, "f8"),
                                  ("point", (2, 3), "f8"), ("normal", (2, 3), "f8"), ("half_edge", (2, 3), "f8")]:
            file[f"walls/{name}"] = np.zeros(shape, kind)
        for name, kind in [("bond", "i4"), ("time", "f8"), ("mode", "u1")]:
            file[f"cracks/{name}"] = np.zeros(0, kind)
        file["cracks/position"] = np.zeros((0, 3))
        rows = len(ROWS)
        columns = {"time": ROWS, "unbalanced_ratio": np.exp(-ROWS), "contacts": np.arange(rows), "coordination": 6 - ROWS,
                   "largest_overlap": 0.02 * np.exp(-ROWS), "kinetic_energy": np.exp(-2 * ROWS), "elastic_energy": 0.5 * ROWS,
                   "work": -0.25 * ROWS, "dissipation": np.outer(1 - np.exp(-2 * ROWS) - 0.75 * ROWS, [1, 0, 0, 0, 0])}
        shapes = {"stress": (3, 3), "momentum": (3,), "wall_moment": (2, 3), "wall_displacement": (2, 3), "box_lower": (3,),
                  "box_upper": (3,), "group_force": (2, 3), "group_moment": (2, 3), "group_displacement": (2, 3), "group_angle": (2,)}
        columns.update({name: np.zeros((rows, *shape)) for name, shape in shapes.items()})
        columns["wall_force"] = np.einsum("t,wc->twc", ROWS, [[0, 3, 4], [0, 0, -2]])
        for name, column in columns.items():
            file[f"history/{name}"] = column
        box = [file[f"domain/{side}"][:] for side in ["lower", "upper"]]
        shots = {"time": MOMENTS, "position": place + velocity * MOMENTS[:, None, None], "spin": np.zeros((5, n, 3)),
                 "velocity": np.repeat(velocity[None], 5, 0), "box_lower": np.tile(box[0], (5, 1)),
                 "box_upper": np.tile(box[1], (5, 1)), "contacts": np.array([3, 1, 0, 2, 0])}
        for name, values in shots.items():
            file[f"snapshots/{name}"] = values
        file["contacts/particles"] = np.array([[0, 1], [2, 3], [4, -1], [5, 6], [0, -2], [7, 8]], "i4")
        file["contacts/force"] = np.array([[0, 0, 2.0], [1, 0, 0], [0, 0.5, 0], [0, 4.0, 0], [0, 0, 1], [3, 0, 0]])
        file["contacts/position"] = np.tile(box[0] - 0.2, (6, 1))  # a wall far below
        file["contacts/overlap"], file["contacts/bond"] = np.zeros(6), np.full(6, -1, "i4")
    return place, velocity, box[0]


place, velocity, lower = write_motion(at("motion.h5"))
speed = np.linalg.norm(velocity, axis=1)

# ---- the text -----------------------------------------------------------------------------

for name in ["flow", "motion"]:
    run("report", at(f"{name}.h5"), "-o", at(f"{name}.html"))
text = {name: open(at(f"{name}.html")).read() for name in ["flow", "motion"]}
ok(run("report", "--threads", "3", at("motion.h5")).decode() == text["motion"], "the same bytes again")
with h5py.File(at("flow.h5")) as file:
    permeability = file["summary"].attrs["permeability"]
    drag = np.linalg.norm(file["particles/viscous_force"][:] + file["particles/pressure_force"][:], axis=1)
    pressure, pairs = file["pores/pressure"][:], file["throats/pores"][:]
ok(f"The permeability is {permeability:.4g} m²." in text["flow"], "a flow says its permeability first")
worst = int(re.search(r"on grain (\d+)", text["flow"])[1])
ok(np.isclose(drag[worst], drag.max(), rtol=1e-12, atol=0), "and which grain is dragged most")
ok("80 grains moved for 1 s." in text["motion"], "a motion says how long it was")
fastest = int(re.search(r"grain (\d+), [\d.]+ mm/s at 0 s", text["motion"])[1])
ok(np.isclose(speed[fastest], speed.max(), rtol=1e-12, atol=0), "and which grain was fastest")
rest = re.search(r"Energy unaccounted for at the end</dt><dd>([\d.e-]+) of the largest", text["motion"])
ok(rest and float(rest[1]) < 1e-12, "and that its energies balance", rest)
shutil.copy(at("motion.h5"), at("gain.h5"))
with h5py.File(at("gain.h5"), "r+") as file:
    file["history/work"][...] = 0.75 * ROWS  # a joule more than there is, of 1 J at the start
rest = re.search(r"Energy unaccounted for at the end</dt><dd>([\d.e-]+) of", run("report", at("gain.h5")).decode())
ok(rest and float(rest[1]) == 1, "or by how much they do not", rest)
ok("&lt;b&gt;rolling&lt;/b&gt; friction" in text["motion"], "its model stands there as text")
for title, words, status, said in [("a flow and a packing", ["flow.h5", "packing.h5"], 64, "by itself"),
                                   ("a motion twice", ["motion.h5", "motion.h5"], 64, "is a second motion")]:
    ended, error = refused(*map(at, words))
    ok(ended == status and said in error and error.count("\n") == 1, f"{title} is refused", (ended, error))

shutil.copy(at("motion.h5"), at("counts.h5"))
with h5py.File(at("counts.h5"), "r+") as file:
    file["snapshots/contacts"][...] = [3, 1, 0, 2, 9]
ended, error = refused(at("counts.h5"))
ok(ended == 65 and "must add up to the 6 rows" in error, "contacts that do not add up are refused", (ended, error))

# ---- in a browser -------------------------------------------------------------------------

if MISSING:
    ok(True, f"the pages in a browser # SKIP {MISSING}")
    done()
browser = Browser()
browser.open(at("flow.html"))
shown = browser.evaluate("[Array.from(page.body.throat.id), Array.from(page.body.arrays['pore.pressure'])]")
ok(np.allclose(np.array(shown[1]), pressure[pairs].mean(1), rtol=1e-6, atol=1e-7 * np.ptp(pressure)),
   "throats have the mean pressure of their pores")
ends = [int(k) for k in (np.argmin(pressure[pairs].mean(1)), np.argmax(pressure[pairs].mean(1)))]
tints = browser.evaluate(f"{json.dumps(ends)}.map((id) => page.tints.throat(page.body.throat.id.indexOf(id)))"
                         ".concat([page.colours.liquid, page.colours.shear])")
ok(np.allclose(tints[:2], tints[2:]), "colours run from the least to the most", tints)
ok(browser.evaluate("element('course').hidden && !element('curves-section').hidden && element('along-label').hidden"),
   "a flow has curves but no slider")
profile = browser.evaluate("page.body.meta.shown.charts[0].lines[2].y.filter((p) => p !== null)")
ok(np.allclose(profile, np.linspace(1, 0, 6), atol=1e-9), "pressure falls evenly along a lattice", profile)
browser.evaluate(f"choose(page, {{kind: 'grain', index: {worst}}})")
ok("drag" in browser.evaluate("element('picked').textContent"), "a grain says its drag")

browser.open(at("motion.html"))
for moment in [0.0, 0.05, 0.3, 0.7, 1.0]:
    browser.evaluate(f"page.course.set({moment} * page.course.last); draw(page)")
    now = browser.evaluate("page.course.at(page.course.time, page.course.key)")
    seen = np.array(browser.evaluate("Array.from(page.body.grain.at, (x, k) => x * page.body.unit + page.body.middle[k % 3])")).reshape(-1, 3)
    error = np.abs(seen - (place + velocity * now)).max() / 1e-3
    ok(abs(now - moment) < 1e-3 and error < 1.5e-3, f"grains are where straight lines lead them at {moment} s", (now, error))
    count = browser.evaluate("page.body.throat.n")
    snapshot = np.searchsorted(MOMENTS, now + 1e-9, "right") - 1
    ok(count == [3, 1, 0, 2, 0][snapshot], "and the contacts are those of the snapshot before", (count, snapshot))
browser.evaluate("page.course.set(0.3 * page.course.last); draw(page)")
browser.evaluate("page.course.set(0.1 * page.course.last + 1); draw(page); choose(page, {kind: 'throat', index: 0})")
ok("grain 5 with grain 6" in browser.evaluate("element('picked').textContent") and "4 N" in
   browser.evaluate("element('picked').textContent"), "a contact says its grains and its force", browser.evaluate("element('picked').textContent"))
browser.evaluate("page.course.set(0); draw(page)")
ok(browser.evaluate("describeContact(page.body, 2).rows[0][1]") == "grain 4 with a wall", "also that with a wall")
end = browser.evaluate("[0, 1, 2].map((k) => page.body.node.at[3 * page.body.throat.second[2] + k] * page.body.unit + page.body.middle[k])")
ok(np.allclose(end, lower - 0.2, atol=1e-5), "which ends at the wall", (end, lower))
browser.evaluate("element('colour').value = 'grain.group'; element('colour').dispatchEvent(new Event('change')); draw(page)")
groups = browser.evaluate("[0, 1, 2, 3, 4].map((i) => page.tints.grain(i).join())")
ok(groups[0] == groups[3] and groups[1] == groups[4] and len(set(groups)) == 3, "grains by group", groups)
titles = browser.evaluate("[...document.querySelectorAll('#curves figcaption')].map((e) => e.textContent)")
ok("Energy" in titles and "Force on each wall" in titles, "the history is drawn", titles)
forces = browser.evaluate("['wall 0', 'wall 1'].map((w) => page.body.arrays[`Force on each wall.${w}.${w[5]}`][page.body.meta.rows - 1])")
ok(np.allclose(forces, [5, 2], rtol=1e-6), "a wall's curve is the size of its force", forces)
browser.evaluate("for (const d of document.querySelectorAll('#curves details')) d.open = true; 0")
browser.evaluate("new Promise((go) => setTimeout(go, 200))")
energy = browser.evaluate("document.querySelectorAll('#curves textarea')[%d].value" % titles.index("Energy")).splitlines()
ok(np.allclose([float(v) for v in energy[-1].split("\t")], [1, np.exp(-2), 0.5, -0.25], rtol=1e-5), "with its numbers", energy[-1])
ok(not browser.errors, "no error on the console", browser.errors)
browser.close()

browser = Browser(webgl=False)
browser.open(at("motion.html"))
browser.evaluate("page.course.set(page.course.last); draw(page)")
drawn = browser.evaluate("page.things.filter((t) => t.kind === 'grain').length")
ok(drawn == len(place), "without WebGL it is drawn plainly", drawn)
browser.close()
done()
