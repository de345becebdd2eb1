#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies as data: runs that share what they have in common, tables and statistics as numpy and crackstats
have them, what fails, and bad input."""
import csv
import fcntl
import json
import os
import re
import shutil
import subprocess
import sys

import h5py
import numpy as np

sys.path[:0] = ["tests", "pipelines/lib", "pipelines/study"]
from definition import read_measure
from tap import BIN, SCENE, done, ok, read, run, scratch

STUDY = os.path.abspath("pipelines/study/study")
folder = scratch()
at = lambda *names: os.path.join(folder.name, *names)


def write(name, content):
    with open(at(name), "w", encoding="utf-8") as file:
        file.write(content if isinstance(content, str) else json.dumps(content))
    return at(name)


def study(what, name, *words, status=0, **environment):
    """What the study of file NAME says; artifacts made, by kind."""
    jobs = [] if "MAKEFLAGS" in environment else ["-j2"]
    ended = subprocess.run([STUDY, what, at(name), "--runs=runs", *jobs, *words], text=True, capture_output=True,
                           cwd=folder.name, timeout=600, env={**os.environ, "MAKEFLAGS": "", "BIN": BIN, **environment})
    made = [line.split()[1].split("/")[0] for line in ended.stdout.splitlines() if line.startswith("  RUN")]
    counts = {kind: made.count(kind) for kind in dict.fromkeys(made)}
    if ended.returncode != status:
        print(f"# status {ended.returncode}: {ended.stderr}")
    return ended.returncode == status, counts, ended.stdout, ended.stderr


def table(name, file="runs.tsv"):
    with open(at("runs", name, file), encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(lines, delimiter="\t"))


def cracks_of(name, paths):
    with open(at("runs", name, paths["crackstats"]), encoding="utf-8") as lines:
        return json.load(lines)["cracks"]["total"]


def column(rows, name, **values):
    return [float(r[name]) for r in rows if all(r[k] == v for k, v in values.items())]


with open(SCENE, encoding="utf-8") as lines:
    scene = json.load(lines)
scene["pack"]["counts"] = [3, 3, 4]
scene["force-protocol"].update(steps=5, force_scale=2)
scene["dem-replay"].update(cycles=20, snapshots=[1, 0])
write("scene.json", scene)
small = {"scene": "scene.json",
         "axes": [{"key": "dry.liquid", "values": ["inviscid", "immobile"]},
                  {"name": "strength", "keys": ["dem-replay.bond.normal_strength", "dem-replay.bond.shear_strength"],
                   "values": [2000, 6000]}],
         "seeds": 2, "compare": [{"axis": "liquid", "with": "inviscid"}]}
write("small.json", small)

# ---- runs share what they have in common, and numbers are those of the stages by themselves ----------

fine, counts, said, _ = study("make", "small.json")
ok(fine and counts == {"packing": 1, "tessellation": 1, "network": 1, "drying": 4, "forces": 4, "response": 8, "crackstats": 8},
   "8 runs share packing, network, dryings and forces", counts)
ok("8 runs at 4 points; 27 of 27 artifacts to make" in said
   and re.search(r"of one core, as stages foresee it; [\d.]+ [kM]B of disk \(", said),
   "their number, time and disk are said before", said)
ok("\nMean ± standard deviation (95 % interval of the mean).\n" in said, "and what the numbers of the table are", said)
with open(at("runs/small/runs.json"), encoding="utf-8") as lines:
    counted = [json.loads(read(at("runs", "small", r["artifacts"]["crackstats"])))["mean"] for r in json.load(lines)["runs"]]
under, total = (sum(m[a][b] for m in counted) for a, b in (("unsettled", "cracks"), ("cracks", "total")))
ok(under > 0 and f"\nIn {sum(m['unsettled']['cracks'] > 0 for m in counted)} of 8 runs grains still moved at the end of loads; "
   f"{100 * under / total:.3g} % of all broken bonds broke under these." in said, "how many bonds broke under loads that did not come to rest", (under, total))
write("small.json", {**small, "confidence": 0.8})
said = study("table", "small.json")[2] + open(at("runs", "small", "summary.md"), encoding="utf-8").read()
ok(said.count("(80 % interval of the mean)") == 2 and "95 %" not in said, "also with another confidence", said)
write("small.json", {**small, "seeds": 1})
said = study("table", "small.json")[2]
ok("Not compared: a test takes two runs or more" in said and "t test" not in said, "why runs by themselves are not compared", said)
write("small.json", small)
said = study("table", "small.json")[2]
ok("| immobile, 2000 against inviscid, 2000 | cracks.total |" in said and "Not compared" not in said, "and what is compared with what", said)
with open(at("runs/small/runs.json"), encoding="utf-8") as lines:
    responses = [r["artifacts"]["response"] for r in json.load(lines)["runs"]]
notes = at("runs/small/.study/notes")
kept = read(notes) if os.path.exists(notes) else b""
with open(notes, "w", encoding="utf-8") as file:
    for k, path in enumerate(responses):
        file.write(f"{path} dem-replay: {9 + 4 * k} of 36 grains left, by 1e-{3 - k % 2} m\n{path} dem-replay: 7 of 36 stayed\n")
said = study("table", "small.json")[3].splitlines()
ok(said == ["8 times: dem-replay: 9 to 37 of 36 grains left, by 1e-3 to 1e-2 m", "8 times: dem-replay: 7 of 36 stayed"],
   "lines that differ in numbers alone are one, with the least and the largest", said)
with open(notes, "wb") as file:
    file.write(kept)
rows = table("small")
ok([r["status"] for r in rows] == ["done"] * 8, "a row a run")
source, chain = None, [("pack", []), ("tessellate", []), ("merge-nodes", []), ("dry", ["liquid=immobile", "throat_radius.seed=2"]),
                       ("force-protocol", []), ("dem-replay", ["bond.normal_strength=2000", "bond.shear_strength=2000"])]
for stage, sets in chain:
    words = [word for item in sets for word in ("--set", item)]
    run(stage, "-q", "-p", at("scene.json"), *words, *([source] if source else []), "-o", at(f"{stage}.h5"))
    source = at(f"{stage}.h5")
cracks = json.loads(run("crackstats", "-q", "-p", at("scene.json"), source))["cracks"]["total"]
ok(column(rows, "cracks.total", liquid="immobile", strength="2000", seed="2") == [cracks] and cracks > 0,
   "a run counts what the stages count by themselves", cracks)
fine, counts, said, _ = study("make", "small.json")
ok(fine and not counts, "nothing is made again", counts)
fine, _, said, _ = study("batch", "small.json")
ok(fine and "no file is written" in said and not os.path.exists(at("runs/small/study.sbatch")), "nor is there a batch to submit", said)

first = [r["cracks.total"] for r in rows if r["seed"] == "1"]
summary = [r for r in table("small", "summary.tsv") if r["measure"] == "cracks.total"]
values = column(rows, "cracks.total", liquid="immobile", strength="6000")
mean, half = np.mean(values), 12.706204736174698 * np.std(values, ddof=1) / np.sqrt(2)  # Student's t, 1 degree, 95 %: tan(0.475 pi)
ok(np.allclose([float(summary[3][k]) for k in ("mean", "low", "high")], [mean, mean - half, mean + half], rtol=1e-12),
   "means and their intervals are numpy's and Student's", summary[3])
with open(at("runs/small/runs.json"), encoding="utf-8") as lines:
    records = json.load(lines)["runs"]
groups = [[at("runs/small", r["artifacts"]["response"]) for r in records if r["liquid"] == liquid and r["strength"] == 6000]
          for liquid in ("immobile", "inviscid")]
tested = json.loads(run("crackstats", "-q", "--set", "first_group=2", "--set", "paired=true", *groups[0], *groups[1]))
with open(at("runs/small/summary.json"), encoding="utf-8") as lines:
    mine = json.load(lines)["tests"][1]["measures"]["cracks.total"]
theirs = tested["test"]["cracks"]["total"]
ok(mine["student_p"] == theirs["paired_t"]["p"] and mine["wilcoxon_p"] == theirs["wilcoxon"]["p"],
   "tests are those of crackstats", f"{mine} {theirs}")
ok(all(os.path.getsize(at("runs/small", name)) > 1000 for name in ("figure.svg", "study.html")), "a figure and a page")
with open(at("runs/small/study.html"), encoding="utf-8") as lines:
    named = set(re.findall(r">(liquid [^<]*)</text>", lines.read()))
ok(named == {f"liquid {liquid}, strength {strength}" for liquid in ("inviscid", "immobile") for strength in (2000, 6000)},
   "whose groups have the names of the axes", named)
ok([read_measure(m, "").title for m in ("drying:summary.breakthrough_saturation", "cracks.total", {"path": "cracks.total", "name": "n_c"})]
   == ["breakthrough saturation", "cracks.total", "n_c"], "titles in words")

# A table's points are in the order of its rows, which need not be that of its values.
cases = [("uniform", "fixed"), ("front", "free"), ("uniform", "free"), ("front", "fixed")]
write("mixed.tsv", "dem-replay.shrinkage.law\tdem-replay.support\n" + "".join("\t".join(row) + "\n" for row in cases))
write("shrinks.json", {"pack": {"counts": [3, 3, 3]}, "dem-replay": {
    "shrinkage": {"strain": 0.01, "steps": 2}, "cycles": 2, "most_cycles": 2, "unsettled": "count"}})
write("mixed.json", {"scene": "shrinks.json", "liquid": False, "runs": "mixed.tsv", "measure": ["cracks.total"]})
fine, *_ = study("make", "mixed.json")
names = re.findall(r">(uniform|front), (fixed|free)<", read(at("runs/mixed/figure.svg")).decode())
ok(fine and names == cases, "the figure names its points in their order", names)

# ---- what seeds draw ------------------------------------------------------------------------------------

# Throats that nothing dries have no radii to draw: seeds are those of the packing.
write("unused.json", {"scene": "mixture.json", "liquid": False, "seeds": 2, "measure": ["bonds"]})
write("mixture.json", {"pack": {"method": "soft_spheres", "upper": [3e-6, 3e-6, 3e-6], "bonds": "touching"},
                       "dry": {"throat_radius": {"distribution": "normal"}},
                       "dem-replay": {"shrinkage": {"strain": 0.01, "steps": 2}, "cycles": 2, "most_cycles": 2, "unsettled": "count"}})
fine, counts, *_ = study("make", "unused.json")
ok(fine and counts["packing"] == 2 and len({r["bonds"] for r in table("unused")}) == 2, "seeds draw what a stage of the study draws", counts)

# ---- which runs belong together ------------------------------------------------------------------------

# Packings of one file name in several folders, and a table with several seeds: each run with its own twin, so that
# what does not depend on the axis does not differ.
for name in "wide", "narrow":
    os.mkdir(at(name))
    run("pack", "-q", "--set", f"counts=[{'4' if name == 'wide' else '2'},3,3]", "-o", at(name, "grains.h5"))
write("layer.json", {"pack": {"method": "import"}, "dem-replay": {
    "shrinkage": {"strain": 0.01, "steps": 2}, "cycles": 2, "most_cycles": 2, "unsettled": "count"}})
twins = {"liquid": False, "compare": [{"axis": "friction", "with": 0.5}], "measure": ["bonds"]}
write("folders.json", {**twins, "scene": "layer.json", "packings": ["wide/grains.h5", "narrow/grains.h5"],
                       "axes": [{"key": "dem-replay.friction", "values": [0.5, 0.4]}]})
write("grown.json", {"pack": {"method": "soft_spheres", "upper": [3e-6, 3e-6, 3e-6], "bonds": "touching"}, "dem-replay": {
    "shrinkage": {"strain": 0.01, "steps": 2}, "cycles": 2, "most_cycles": 2, "unsettled": "count"}})
write("twins.tsv", "dem-replay.friction\tdem-replay.bond.strength.seed\tpack.seed\n"
      + "0.5\t1\t1\n0.5\t1\t2\n0.4\t1\t2\n0.4\t1\t1\n")
write("several.json", {**twins, "scene": "grown.json", "runs": "twins.tsv"})
for name in "folders", "several":
    fine, *_ = study("make", f"{name}.json")
    with open(at("runs", name, "summary.json"), encoding="utf-8") as lines:
        told = json.load(lines)
    bonds = [point["measures"]["bonds"] for point in told["points"]]
    ok(fine and bonds[0]["least"] < bonds[0]["largest"] and told["tests"][0]["measures"]["bonds"]["difference"] == 0
       and told["tests"][0]["measures"]["bonds"]["sd"] == 0, f"{name}: runs of the same grains are compared", told)
ok(sorted({r["grains"] for r in table("folders")}) == [at("narrow", "grains.h5"), at("wide", "grains.h5")],
   "files of one name are told apart by their folders", table("folders"))

# Seeds of strengths leave the packing as it is: two packings are two draws of it, in however many runs.
write("shared.json", {"scene": "layer.json", "liquid": False, "packings": ["wide/grains.h5", "narrow/grains.h5"],
                      "seeds": {"count": 3, "keys": ["dem-replay.bond.strength.seed"]},
                      "set": {"dem-replay.bond.strength.distribution": "normal"},
                      "axes": [{"key": "pack.touching_gap", "values": [1e-6, 0.5]}],
                      "measure": ["packing:summary/contacts", "response:summary/largest_displacement"],
                      "compare": [{"axis": "touching_gap", "with": 1e-6}, {"axis": "touching_gap", "with": 1e-6, "paired": False}]})
fine, *_ = study("make", "shared.json")
with open(at("runs/shared/summary.json"), encoding="utf-8") as lines:
    told = json.load(lines)
point = told["points"][0]["measures"]
contacts = [int(h5py.File(at("runs/shared", path))["summary"].attrs["contacts"]) for path in
            {r["artifacts"]["packing"] for r in json.loads(read(at("runs/shared/runs.json")))["runs"] if r["point"] == 1}]
ok(fine and len(contacts) == 2 and point["summary.contacts"]["runs"] == 2 and point["summary.largest_displacement"]["runs"] == 6
   and np.isclose(point["summary.contacts"]["sd"], np.std(contacts, ddof=1)),
   "what several runs share counts once", (contacts, point))
paired, alone = (test["measures"]["summary.contacts"] for test in told["tests"])
# Student's and Welch's p with 1 degree of freedom, or so, by the closed form of Cauchy's distribution
far = [run_["summary.contacts"] for run_ in json.loads(read(at("runs/shared/runs.json")))["runs"] if run_["point"] == 2]
far = list(dict.fromkeys(far))
apart = np.subtract(far, [next(c for c in contacts if (c > min(contacts)) == (f > min(far))) for f in far])
p = 1 - 2 / np.pi * np.arctan(abs(apart.mean()) / (apart.std(ddof=1) / np.sqrt(2)))
ok(np.isclose(paired["student_p"], p) and alone["welch_p"] > 0.1, "nor do tests count it more often", (paired, p, alone))

# Grains named when the study is called, in place of its own; in a table, and in one that a study names.
def grains_of(name):
    with open(at("runs", name, "runs.json"), encoding="utf-8") as lines:
        return [len(h5py.File(at("runs", name, r["artifacts"]["packing"]))["particles/radius"]) for r in json.load(lines)["runs"]]


here = {"liquid": False, "measure": ["bonds"], "scene": "layer.json"}
write("taken.json", {**here, "import": "wide/grains.h5", "axes": [{"key": "dem-replay.friction", "values": [0.5, 0.4]}]})
write("rows.tsv", "dem-replay.friction\n0.5\n0.4\n")
write("rows.json", {**here, "import": "wide/grains.h5", "runs": "rows.tsv"})
given = [(study("make", name, *words)[0], grains_of(name.split(".")[0])) for name, words in
         (("taken.json", []), ("rows.json", []), ("taken.json", ["--import=narrow/grains.h5"]), ("rows.json", ["--import=narrow/grains.h5"]))]
ok(given == [(True, [36, 36])] * 2 + [(True, [18, 18])] * 2, "grains are those of the study, or those it is called with", given)
fine, _, _, error = study("plan", "folders.json", "--import=narrow/grains.h5", status=65)
ok(fine and "has grains of its own for several runs" in error, "a study of several packings takes no other", error)

# ---- one value more, one value other, a table of runs -------------------------------------------------

fine, counts, *_ = study("make", "small.json", "--seeds=1,2,3")
ok(fine and counts == {"drying": 2, "forces": 2, "response": 4, "crackstats": 4}, "a seed more makes its runs alone", counts)
write("runs.tsv", "run\tdry.liquid\tdem-replay.bond.normal_strength\tdem-replay.bond.shear_strength\tdry.throat_radius.seed\n"
      + "".join(f"{liquid}-{strength}-{seed}\t{liquid}\t{strength}\t{strength}\t{seed}\n"
                for liquid in ("inviscid", "immobile") for strength in (2000, 6000) for seed in (1,)))
fine, *_ = study("make", "runs.tsv", "--scene=scene.json", "--name=table")
spelled = table("table")
ok(fine and [r["cracks.total"] for r in spelled] == first and spelled[0]["label"] == "inviscid-2000-1",
   "a table of runs is the same study", spelled[:1])
write("seeds.tsv", "dem-replay.friction\tdry.throat_radius.seed\n0.5\t1\n0.5\t2\n0.4\t1\n")
ok("3 runs at 2 points" in study("plan", "seeds.tsv", "--scene=scene.json")[2], "rows that differ in seeds alone are a point")
write("lean.json", {**small, "seeds": 1, "keep": []})
fine, counts, *_ = study("make", "lean.json")
kept = sorted(os.listdir(at("runs/lean")))
ok(fine and [r["cracks.total"] for r in table("lean")] == first and "response" not in kept,
   "results alone, where nothing else is kept, are the same", f"{kept} {counts}")
write("files.json", {"scene": "scene.json", "keep": [], "measure": [
    "drying:summary/breakthrough_saturation", "network:throats/radius largest", {"path": "cracks.total", "scale": 10, "name": "ten"}]})
fine, *_ = study("make", "files.json")
only = table("files")[0]
with open(at("runs/files/runs.json"), encoding="utf-8") as lines:
    paths = json.load(lines)["runs"][0]["artifacts"]
with h5py.File(at("runs/files", paths["drying"])) as drying, h5py.File(at("runs/files", paths["network"])) as network:
    wanted = [drying["summary"].attrs["breakthrough_saturation"], network["throats/radius"][:].max(), 10 * cracks_of("files", paths)]
ok(fine and [float(only[name]) for name in ("summary.breakthrough_saturation", "throats.radius.largest", "ten")] == wanted,
   "attributes and datasets are measured too", only)

# Lists of JSON artifacts, and a measure that nothing has: no picture of it, and the others are drawn.
write("rings.json", {"scene": "scene.json", "seeds": 1, "axes": [{"key": "rings.contact_angle", "values": [0, 30]}],
                     "set": {"rings.points": 3}, "measure": ["rings:stress last", "rings:rings mean", "rings:nothing"]})
fine, _, _, wrong = study("make", "rings.json")
with open(at("runs/rings/runs.json"), encoding="utf-8") as lines:
    found = json.load(lines)["runs"]
alone = []
for one in found:
    with open(at("runs/rings", one["artifacts"]["rings"]), encoding="utf-8") as lines:
        alone.append(json.load(lines))
ok(fine and [[r["stress.last"], r["rings.mean"], r["nothing"]] for r in found]
   == [[one["stress"][-1], np.mean(one["rings"]), None] for one in alone] and os.path.exists(at("runs/rings/figure.svg")),
   "lists are measured too, and what is nowhere is left out of the picture", (wrong, found))
ok("measure nothing: none of the 2 done runs has such a number" in wrong and wrong.count("measure ") == 1, "and is told", wrong)
write("misspelt-measure.json", {"scene": "scene.json", "seeds": 1, "axes": [{"key": "pack.radius", "from": 1e-7, "to": 2e-7, "count": 8}],
                                "measure": ["packing:summary/contcats"]})
wrong = study("make", "misspelt-measure.json")[3]
ok("measure summary.contcats: the run that is done does not have such a number\n" in wrong, "of eight runs after the first", wrong)

# A short logarithmic axis has labels 1, 2 and 5, however many values: labels of eight values lay over each other.
write("logarithmic.json", {"scene": "scene.json", "seeds": 1, "axes": [
    {"key": "dem-replay.bond.normal_strength", "from": 5e4, "to": 1e5, "count": 3, "scale": "log"}]})
fine, *_ = study("make", "logarithmic.json")
picture = read(at("runs/logarithmic/figure.svg")).decode() if fine else ""
ok(all(f">{label}<" in picture for label in ("50000", "100000")) and not re.search(">7[^<]*071|>7.07", picture),
   "round labels of a logarithmic axis", picture[-400:])

# ---- a run that fails ---------------------------------------------------------------------------------

write("replay", f"""#!/bin/bash
[[ $1 == --version ]] && exec {BIN}/dem-replay --version
if [[ -e {at('fails')} && "$*" == *normal_strength=6000* ]]; then echo 'dem-replay: no more' >&2; exit 3; fi
exec {BIN}/dem-replay "$@"
""")
os.chmod(at("replay"), 0o755)
write("fails", "")
fine, counts, said, error = study("make", "small.json", "--seeds=1", "--name=failing", status=1, DEM_REPLAY=at("replay"))
failing = table("failing")
ok(fine and [r["status"] for r in failing] == ["done", "failed"] * 2 and failing[1]["why"] == "dem-replay: no more"
   and failing[1]["cracks.total"] == "" and counts["crackstats"] == 2, "a failed run is a row that says why; the others are made", error)
ok("2 done, 2 failed of 4 runs" in said and "run 2 failed: dem-replay: no more" in error, "and is said", said)
os.remove(at("fails"))
fine, counts, *_ = study("make", "small.json", "--seeds=1", "--name=failing", DEM_REPLAY=at("replay"))
ok(fine and counts == {"response": 2, "crackstats": 2} and [r["cracks.total"] for r in table("failing")] == first,
   "then it is made alone", counts)
with open(at("runs/small/runs.json"), encoding="utf-8") as lines:
    lost = json.load(lines)["runs"][0]["artifacts"]["crackstats"]
os.remove(at("runs/small", lost))
fine, counts, *_ = study("table", "small.json")
ok(fine and not counts and table("small")[0]["status"] == "not yet" and table("small")[1]["status"] == "done",
   "tables of what is there", table("small")[0])
write(os.path.join("runs/small", lost + ".said"), "")
with open(at("runs/small", lost + ".key"), "ab") as key:
    fcntl.flock(key, fcntl.LOCK_EX)
    study("table", "small.json")
    ok(table("small")[0]["status"] == "not yet", "what is being made is not yet there", table("small")[0])
study("table", "small.json")
ok(table("small")[0]["why"] == "was interrupted", "what was killed half-way was interrupted", table("small")[0])

# ---- as rules of Makeflow ----------------------------------------------------------------------------

if shutil.which("makeflow"):
    fine, counts, said, _ = study("makeflow", "small.json", "--name=flow")
    subprocess.run(["makeflow", "--json", "study.makeflow.json", "-j2"], cwd=at("runs/flow"), capture_output=True, timeout=600)
    ok(fine and "27 rules" in said and "0 of 27 artifacts to make" in study("plan", "small.json", "--name=flow")[2],
       "Makeflow makes all of a study, and make knows it", said)
    alike = [read(at("runs/flow", r["artifacts"][kind])) == read(at("runs/small", r["artifacts"][kind]))
             for r in records for kind in ("drying", "response")]
    ok(len(alike) == 16 and all(alike), "by the same bytes")
    lost = records[0]["artifacts"]["response"]
    os.remove(at("runs/flow", lost))
    study("makeflow", "small.json", "--name=flow")
    with open(at("runs/flow/study.makeflow.json"), encoding="utf-8") as lines:
        left = [rule["outputs"] for rule in json.load(lines)["rules"]]
    ok(left == [[lost], [records[0]["artifacts"]["crackstats"]]], "rules are of what is missing, and of what is made from it", left)
else:
    ok(True, "rules of Makeflow # SKIP no makeflow is installed")

# ---- grains that shrink without liquid ------------------------------------------------------------------

with open("samples/craquelure-40.json", encoding="utf-8") as lines:
    layer = json.load(lines)
layer["pack"]["upper"] = [5.2e-6, 5.2e-6, 4.68e-6]
layer["dem-replay"].update(cycles=16, most_cycles=32, snapshots=[0])
layer["dem-replay"]["shrinkage"]["steps"] = 6
write("layer.json", layer)
write("shrinking.json", {"scene": "layer.json", "liquid": False, "axes": [{"key": "dem-replay.shrinkage.strain", "values": [0.03, 0.05]}],
                         "measure": [{"path": "cracks.total", "title": "cracks"}]})
fine, counts, said, _ = study("make", "shrinking.json")
run("pack", "-p", at("layer.json"), "-o", at("layer.h5"))
run("dem-replay", "-p", at("layer.json"), "--set", "shrinkage.strain=0.05", at("layer.h5"), "-o", at("shrunk.h5"))
with h5py.File(at("shrunk.h5")) as file:
    broken = len(file["cracks/saturation"])
ok(fine and counts == {"packing": 1, "response": 2, "crackstats": 2} and broken > 0
   and column(table("shrinking"), "cracks.total")[1] == broken, "liquid: false: a packing, replayed as it shrinks", f"{counts} {said} {broken}")

# ---- bad input: a line that says where, before anything is made ----------------------------------------

def refused(title, status, wanted, name, content, *words):
    write(name, content)
    fine, counts, said, error = study("make", name, *words, status=status)
    ok(fine and not counts and wanted in error and error.count("\n") == 1 and "Traceback" not in error, f"refused: {title}",
       f"{error} {said}")


values = list(range(1, 3201))
refused("10^7 runs", 65, "10240000 runs (3200 seed x 3200 seed2 x 1 a point), more than 100000", "large.json",
        {"scene": "scene.json", "axes": [{"key": "dry.throat_radius.seed", "values": values},
                                         {"name": "seed2", "key": "dem-replay.bond.strength.seed", "values": values}]})
# Of 10^9 combinations, which would take hours to go through, `only` names two.
wide = {"scene": "scene.json",
        "axes": [{"name": f"axis{k}", "key": key, "from": 0.1, "to": 1, "count": 1000}
                 for k, key in enumerate(["dem-replay.friction", "dem-replay.damping_ratio", "dem-replay.normal_stiffness"])]}
write("wide.json", {**wide, "only": [{"axis0": [0.1, 1], "axis1": 1, "axis2": 0.1}]})
fine, _, said, _ = study("plan", "wide.json")
ok(fine and "wide: 2 runs" in said, "two of 10^9 combinations", said)
refused("10^6 chosen runs", 65, "1000000 runs (by only), more than 100000", "large.json",
        {**wide, "only": [{"axis0": 1}]})
refused("10^9 values of an axis", 65, "axes[0].count: 1000000000 are more than 100000 runs", "large.json",
        {**small, "axes": [{"key": "dem-replay.friction", "from": 0.1, "to": 1, "count": 10**9}]})
refused("10^9 seeds", 65, "seeds: 1000000000 are more than 100000 runs", "large.json", {**small, "seeds": 1e9})
refused("a key that no stage has", 65, "wrong.json: axes[0]: dry.liqid: dry has no such parameter; 'liquid'?", "wrong.json",
        {**small, "axes": [{"key": "dry.liqid", "values": ["inviscid"]}]})
refused("a stage that is none", 65, "no such stage; 'dem-replay'?", "wrong.json", {**small, "set": {"dem-reply.friction": 1}})
refused("a key that a study has not", 65, "wrong.json: axis: no such key; 'axes'?", "wrong.json", {"scene": "scene.json", "axis": []})
refused("a value out of range", 65, "axes[0], value 2: dem-replay.friction: must be at least 0, is -1", "wrong.json",
        {**small, "axes": [{"key": "dem-replay.friction", "values": [0.1, -1]}]})
write("misspelt.json", {**scene, "dem-replay": {**scene["dem-replay"], "frictoin": 1}})
refused("a scene that a stage does not take", 65, "dem-replay.frictoin: unknown key", "wrong.json", {"scene": "misspelt.json"})
head = "dem-replay.friction\tdry.throat_radius.seed\n"
refused("a value in row 731", 65, "wrong.tsv: row 731: dem-replay.friction: must be at least 0, is -0.5", "wrong.tsv",
        head + "".join(f"{-0.5 if k == 731 else 0.5}\t{k}\n" for k in range(1, 801)), "--scene=scene.json")
refused("a missing column", 65, "wrong.tsv: row 2: has 1 cells, the line of keys 2", "wrong.tsv", head + "0.1\t1\n0.1\n", "--scene=scene.json")
refused("a column of no key", 65, "wrong.tsv: column 1: friction: no such stage", "wrong.tsv", "friction\n0.1\n", "--scene=scene.json")
refused("a table without a scene", 65, "row 1: no scene: a column scene, or SCENE=", "wrong.tsv", head + "0.1\t1\n")
refused("two studies in one folder", 73, "runs/small: holds the study", "other.json", small, "--name=small")
refused("a folder outside of that of the runs", 64, "--name=../x: must be the name of a folder", "other.json", small, "--name=../x")
refused("half a list", 64, "--set pack.counts=[3,3: [3,3 is not JSON", "other.json", small, "--set=pack.counts=[3,3")
refused("a measure of no artifact", 65, "measure[0]: dryin: no such artifact; 'drying'?", "wrong.json", {**small, "measure": ["dryin:x"]})
refused("lists of unequal length", 65, "has 1 values, dry.liquid 2", "wrong.json",
        {**small, "axes": [{"zip": {"dry.liquid": ["inviscid", "immobile"], "dry.viscosity": [1]}}]})
refused("an axis that is none", 65, "only[0].liqud: no such axis; 'liquid'?", "wrong.json", {**small, "only": [{"liqud": "inviscid"}]})
lattice = {**scene, "dry": {**scene["dry"], "throat_radius": {"distribution": "network"}}}
write("still.json", lattice)
refused("seeds of a scene that draws nothing", 65, "the scene draws nothing", "wrong.json", {"scene": "still.json", "seeds": 2})
refused("and of 2.0 seeds", 65, "the scene draws nothing", "wrong.json", {"scene": "still.json", "seeds": 2.0})
fallen = {**lattice, "pack": {"method": "deposition", "import": {"scale": 1e-6}}}
write("fallen.json", fallen)
write("grains.txt", "0 0 1 1\n")
refused("seeds of grains that come from a file", 65, "the scene draws nothing", "wrong.json",
        {"scene": "fallen.json", "import": "grains.txt", "seeds": 2})
refused("what is not JSON", 65, "is not JSON", "wrong.json", "{")
ok(study("make", "nowhere.json", status=66)[0], "refused: a file that is not there")

# ---- make -j1 says how many stages run at once, also where it has no jobserver ------------------------

write("alone", f"""#!/bin/sh
mkdir {at('busy')} || exit 70
sleep 0.3
{BIN}/dry "$@"
status=$?
rmdir {at('busy')}
exit $status
""")
os.chmod(at("alone"), 0o755)
fine, counts, said, why = study("make", "small.json", "--name=alone", MAKEFLAGS=" -j1 -- J=-j4", DRY=at("alone"))
ok(fine and counts["drying"] == 4, "one stage at once under make -j1", why)

# ---- a disk that is full half-way ---------------------------------------------------------------------

write("disk", f"""set -e
mount -t tmpfs -o size=$1 none {at('full')}
export MAKEFLAGS=
{STUDY} make {at('lean.json')} --runs={at('full')} --seeds=1,2 -j2 >{at('first')} 2>&1 && exit 9
mount -o remount,size=50m {at('full')}
{STUDY} make {at('lean.json')} --runs={at('full')} --seeds=1,2 -j2 >{at('second')} 2>&1
cp {at('full/lean/runs.tsv')} {at('after.tsv')}
""")
os.mkdir(at("full"))
able = subprocess.run(["unshare", "-rm", "mount", "-t", "tmpfs", "none", at("full")], capture_output=True).returncode == 0
if able:
    ended = subprocess.run(["unshare", "-rm", "bash", at("disk"), "200k"], capture_output=True, text=True, timeout=600)
    first = read(at("first")).decode() if os.path.exists(at("first")) else ""
    every = [line.split("\t") for line in read(at("after.tsv")).decode().splitlines()] if ended.returncode == 0 else []
    ok(ended.returncode == 0 and "Traceback" not in first and len(every) == 9 and all(r[-2] == "done" for r in every[1:]),
       "a disk that is full half-way: the same call goes on where there is room", f"{ended.returncode} {ended.stderr} {first[-600:]}")
else:
    print("# no name spaces here: the full disk is left out")
done()
