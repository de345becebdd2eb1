#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Pictures say what they show: cracks have one colour each wherever they are drawn, with a legend;
# the demo's ends when all is dry; saturations run from 1 to 0; none needs red told from green.
import base64
import glob
import json
import os
import re
import struct
import subprocess
import sys

import h5py
import numpy as np
from PIL import Image

sys.path.insert(0, "tests")
from tap import SCENE, done, ok, read, run, scratch
sys.path.insert(0, "pipelines/lib")
from common import with_unit

said = [with_unit(x, "s") for x in (0, 5e-7, 2.5, 1420)]
ok(said == ["0 s", "500 ns", "2.5 s", "1.42 ks"], "labels have units of a fitting size", said)

SMALL = {"pack": ["counts=[3,3,5]"], "force-protocol": ["steps=40"],
         "dem-replay": ["engine=explicit", "cycles=60", "tolerance=null", "bond.normal_strength=9e3",
                        "bond.shear_strength=5e3"]}


def stage(name, *files, sets=()):
    words = [word for key in [*SMALL.get(name, []), *sets] for word in ("--set", key)]
    run(name, "-q", "-p", SCENE, *words, *files[:-1], "-o", files[-1])


def draw(program, *words):
    drawn = subprocess.run([f"pipelines/{program}", *words], capture_output=True, text=True)
    ok(drawn.returncode == 0, f"{program} {len(words)}", drawn.stderr)
    return read(words[-1]).decode()


def colours(text):
    """All of TEXT, as (red, green, blue), whichever way they are written."""
    return {tuple(bytes.fromhex(c)) for c in re.findall(r"#([0-9a-fA-F]{6})", text)} | {
        tuple(map(int, c)) for c in re.findall(r"rgb\( *(\d+), *(\d+), *(\d+)\)", text)}


def modes(response):
    mode = json.loads(run("inspect", "-d", "/cracks/mode", response))
    return f"{mode.count(0)} in tension, {mode.count(1)} in shear"


palette = dict(re.findall(r'^([a-z]+) = "(#[0-9a-f]{6})"$', read("pipelines/lib/style.gp").decode(), re.M))
cracks = colours(palette["tension"] + palette["shear"])
ok(len(set(palette.values())) == len(palette) > 5, "style.gp has each colour once", palette)

with scratch() as folder:
    at = lambda *names: os.path.join(folder, *names)
    stage("pack", at("packing"))
    stage("tessellate", at("packing"), at("tessellation"))
    stage("merge-nodes", at("tessellation"), at("network"))
    for limit in "inviscid", "immobile":
        os.mkdir(at(limit))
        stage("dry", at("network"), at(limit, "drying.h5"), sets=[f"liquid={limit}"])
        stage("force-protocol", at(limit, "drying.h5"), at(limit, "forces.h5"))
        stage("dem-replay", at(limit, "forces.h5"), at(limit, "response.h5"))
    counts = [modes(at(limit, "response.h5")) for limit in ("inviscid", "immobile")]
    ok(re.match("[1-9].*, [1-9]", counts[0]) and counts[0] != counts[1], "cracks of both modes", counts)

    first = at("inviscid", "response.h5")
    drawn = [draw("run/picture", folder, at("picture.svg")),
             draw("figures/crack-patterns", f"wet={first}@0.5", f"dry={first}", at("patterns.svg")),
             draw("figures/crack-patterns", first, at("pattern.svg"))]
    for name, svg in zip(("picture", "patterns", "pattern"), drawn):
        ok(cracks <= colours(svg), f"{name}: cracks have the colours of style.gp", cracks - colours(svg))
        ok("broken in tension" in svg and "broken in shear" in svg, f"{name}: a legend says which is which")
    height = float(re.search(r'height="(\d+)"', drawn[1])[1])  # of two views from the front, a little from above and the left
    ok(abs(height - 36 - 58 - 269 * (5 + 0.22 * 3) / (3 + 0.45 * 3)) < 2, "views are as high as the body", height)
    ok(re.findall(r">dry</tspan>[^\n]*\n[^>]*>([^<]*)<", drawn[0]) == counts,
       "the last panel of each limit is dry and has all cracks")

    words = re.findall(r">([^<]*(?:iscosity|nviscid)[^<]*)<", drawn[0])
    ok(words and all("nviscid liquid" in w for w in words), "the limits have the names of dry.liquid", words)
    for limit in "inviscid", "immobile":
        counted = json.loads(run("crackstats", at(limit, "response.h5"), at(limit, "drying.h5")))
        counted["each"] = [{"cracks": {mode: n + k for mode, n in counted["each"][0]["cracks"].items()}} for k in range(3)]
        with open(at(limit, "twice.json"), "w", encoding="utf-8") as file:
            json.dump(counted, file)
    svg = draw("figures/limits", at("inviscid", "twice.json"), at("immobile", "twice.json"), at("limits.svg"))
    ok("p = " in svg and "Mann and Whitney" in svg, "a p names its test")

    # In a box that repeats no throat is drawn through the box from one side to the other.
    stage("pack", at("repeats"), sets=["periodic=[true,true,false]"])
    stage("tessellate", at("repeats"), at("unmerged"))
    stage("merge-nodes", at("unmerged"), at("merged"))
    for limit in "inviscid", "immobile":
        os.makedirs(at("around", limit))
        drying, forces, response = (at("around", limit, f"{name}.h5") for name in ("drying", "forces", "response"))
        stage("dry", at("merged"), drying, sets=[f"liquid={limit}"])
        stage("force-protocol", drying, forces)
        stage("dem-replay", forces, response)

    def longest(svg):
        """Of the throats, px."""
        paths = "".join(re.findall(r'class="(?:dry|wet)[^"]*" d="([^"]*)"', svg))
        ends = np.array(re.findall(r"M(-?[\d.]+) (-?[\d.]+)L(-?[\d.]+) (-?[\d.]+)", paths), float)
        return np.linalg.norm(ends[:, 2:] - ends[:, :2], axis=1).max()

    lengths = longest(draw("run/picture", at("around"), at("around.svg"))), longest(drawn[0])
    ok(lengths[0] < 1.5 * lengths[1], "throats are not drawn through a box that repeats", lengths)

# A layer without polygons: no map of when they opened, and gnuplot does not complain of an empty one.
with scratch() as folder:
    at = lambda *names: os.path.join(folder, *names)
    places = [(i, j, k) for i in range(4) for j in range(4) for k in range(4 if i or j else 9)]  # one column is a tower
    with open(at("grains.txt"), "w") as file:
        file.writelines(f"{2e-6 * i} {2e-6 * j} {2e-6 * k} 1e-6\n" for i, j, k in places)
    run("pack", "-q", "--set", "method=import", "--set", "check=none", at("grains.txt"), "-o", at("packing"))
    run("dem-replay", "-q", "--set", "shrinkage.strain=1e-6", "--set", "shrinkage.steps=2", "--set", "most_cycles=200",
        at("packing"), "-o", at("response"))
    run("crackstats", "-q", "--set", "polygons=true", at("response"), "-o", at("cracks.json"))
    drawn = subprocess.run(["pipelines/studies/craquelure/report", "polygons", at("response"), at("cracks.json"), at("none.png")],
                           capture_output=True, text=True)
    ok(drawn.returncode == 0 and drawn.stderr == "", "craquelure without polygons is drawn", drawn.stderr)
    subprocess.run(["pipelines/studies/craquelure/report", "table", at("response"), at("cracks.json"), at("table.md")], check=True)
    ok(read(at("table.md")).decode().endswith("\nNo polygons: too little damage.\n"), "its table says why", read(at("table.md")))
    seen = np.array(Image.open(at("none.png")).convert("L"))[40:540, 12:508]
    ok(abs((seen < 60).mean() - (1 - 13 / 16 * np.pi / 4)) < 0.03,
       "its grains are seen from above, but the three in the square of the tower", (seen < 60).mean())
    width, height = struct.unpack(">II", read(at("none.png"))[16:24])
    ok((width, height) == (2 * 520 + 70, 520 + 30), "as two pictures in a row", (width, height))

# Films: of the throats in the slice those with liquid are blue.
with scratch() as folder:
    at = lambda *names: os.path.join(folder, *names)
    run("pack", "-q", "--set", "method=soft_spheres", "--set", "count=60", "--set", "seed=1", "-o", at("packing"))
    run("tessellate", "-q", "--set", "throat_volume=void", "--set", "throat_radius=entry", at("packing"), "-o", at("tessellation"))
    run("merge-nodes", "-q", at("tessellation"), "-o", at("network"))
    for rings in "films", "isolated":
        stage("dry", at("network"), at(rings), sets=[f"rings={rings}", "snapshots=[0.8,0.4]", "gravity=9.81"])
    svg = draw("figures/films", at("isolated"), at("films"), at("films.svg"))
    with h5py.File(at("isolated")) as isolated, h5py.File(at("films")) as films:
        width = isolated["domain/upper"][0] - isolated["domain/lower"][0]
        ends = ((isolated["nodes/position"][:] - isolated["domain/lower"][:]) / width)[isolated["throats/nodes"][:]]
        inside = (abs(ends.mean(1)[:, 1] - 0.5) < 1 / 6) & (abs(ends[:, 0, 0] - ends[:, 1, 0]) < 0.5)
        inside &= np.hypot(*(ends[:, 1] - ends[:, 0])[:, [0, 2]].T) > 2e-4  # shorter ones are points
        wanted = sum(int((file["snapshots/throat_saturation"][:, inside] > 0).sum()) for file in (films, isolated))
    lines = re.findall(r"<path stroke='rgb\( 10,  74, 150\)' +d='([^']*)'", svg)
    drawn = sum(line.count("L") for line in lines)
    ok(drawn == wanted > 0, "as many throats are blue as have liquid", (drawn, wanted))
    ok("films.conductance 1" in svg and "isolated rings" in svg, "films and rings have their titles")

# Moving grains, at four moments: pixels, as polygons of circles take 3.5 kB each. The SVG has the same ones.
with scratch() as folder:
    at = lambda *names: os.path.join(folder, *names)
    run("pack", "-q", "--set", "counts=[6,6,6]", "--set", "bonds=none", "-o", at("packing"))
    run("simulate", "-q", "--set", 'materials={"glass":{"young_modulus":1e7}}', "--set", "duration=1e-6", at("packing"),
        "-o", at("motion"))
    for name in "motion.png", "motion.svg":
        subprocess.run(["pipelines/figures/motion", at("motion"), at(name)], check=True)
    pixels, svg = read(at("motion.png")), read(at("motion.svg"))
    seen = np.array(Image.open(at("motion.png")).convert("RGB")).astype(int)
    blue = (seen[..., 2] > seen[..., 0] + 20).mean(), 4 * (1100 * 0.87 / 4) ** 2 / seen[..., 0].size
    ok(0.4 * blue[1] < blue[0] < np.pi / 4 * blue[1], "a picture of moving grains has grains in its four frames", blue)
    ok(len(svg) < 1e6 and base64.b64encode(pixels) in svg, "its SVG is small, and has the same pixels", len(svg))

# ---- the scripts --------------------------------------------------------------------
old = colours("#0a2a7a #ffc20e #e0b000")
wrong = {"colours of their own for cracks": [], "red beside green": [], "saturations not from 1 to 0": []}
for script in sorted(glob.glob("pipelines/*/**", recursive=True)):
    if os.path.isdir(script) or script.endswith(".pyc"):
        continue
    text = read(script).decode()
    here = colours(text)
    red = any(c[0] > 120 and c[0] > 1.5 * max(c[1:]) for c in here)
    green = any(c[1] > 1.4 * max(c[0], c[2]) for c in here)
    against = [not script.endswith("style.gp") and here & (cracks | old), red and green,
               re.search(r'xlabel "(network )?saturation', text) and "xrange [1:0]" not in text]
    for which, is_so in zip(wrong.values(), against):
        if is_so:
            which.append(script)
for what, scripts in wrong.items():
    ok(not scripts, f"scripts have no {what}", scripts)
done()
