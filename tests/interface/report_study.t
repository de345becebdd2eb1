#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of a study: a row a run with what its scene differs in, means and tests as numpy and crackstats
have them, links that lead to the runs' pages; and in a headless Chromium, sorting, and nothing leaves it."""
import html
import html.parser
import json
import os
import re
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from browser import MISSING, Browser
from tap import BIN, SCENE, done, ok, run, scratch

folder = scratch()
at = lambda name: os.path.join(folder.name, name)


def refused(*words):
    ended = subprocess.run([f"{BIN}/report", *words], capture_output=True, timeout=60)
    return ended.returncode, ended.stderr.decode()


# ---- two limits, three draws each, as `make demo` has them ---------------------------------

with open(SCENE) as file:
    scene = json.load(file)
scene["pack"]["counts"] = [3, 4, 5]
scene["force-protocol"].update(steps=40, force_scale=2)
scene["dem-replay"]["cycles"] = 200
with open(at("scene.json"), "w") as file:
    json.dump(scene, file)
os.makedirs(at("study"))
for stage, source, name in [("pack", "", "packing"), ("tessellate", "packing", "tessellation"), ("merge-nodes", "tessellation", "network")]:
    run(stage, "-q", "-p", at("scene.json"), *([at(f"study/{source}.h5")] if source else []), "-o", at(f"study/{name}.h5"))
names = [f"{limit}/seed {seed} <b>&" for limit in ["inviscid", "immobile"] for seed in [1, 2, 3]]
for name in names:
    limit, seed = name[:8], name.split()[1]
    here = lambda file: at(f"study/{name}/{file}")
    os.makedirs(at(f"study/{name}"))
    for stage, source, made, words in [("dry", "../../network.h5", "drying.h5", ["--set", f"liquid={limit}", "--set", f"throat_radius.seed={seed}"]),
                                       ("force-protocol", "drying.h5", "forces.h5", []), ("dem-replay", "forces.h5", "response.h5", [])]:
        run(stage, "-q", "-p", at("scene.json"), *words, here(source), "-o", here(made))
    run("crackstats", "-p", at("scene.json"), here("response.h5"), here("drying.h5"), "-o", here("crackstats.json"))
paths = [at(f"study/{name}") for name in names]
for path in paths[1:]:
    run("report", path, "-o", f"{path}/report.html")
run("report", *paths, "-o", at("study/study.html"))
page = open(at("study/study.html")).read()


class Table(html.parser.HTMLParser):
    """Texts of the cells of a table, a list a row, and the links in it."""

    def __init__(self, text):
        super().__init__()
        self.rows, self.links = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        if tag == "tr":
            self.rows.append([])
        if tag in ["td", "th"]:
            self.rows[-1].append("")
        if tag == "a":
            self.links.append(dict(attrs)["href"])

    def handle_data(self, data):
        if self.rows and self.rows[-1]:
            self.rows[-1][-1] += data


table = Table(re.search(r'<table id="runs">.*?</table>', page, re.S)[0])
head, rows = table.rows[0], table.rows[1:]
column = lambda name: [row[head.index(name)] for row in rows]
ok([row[0] for row in rows] == names, "a row a run, named by what differs in its path", [row[0] for row in rows])
ok(head[1:3] == ["dry.liquid", "dry.throat_radius.seed"] and column("dry.liquid") == ["inviscid"] * 3 + ["immobile"] * 3,
   "what the scenes differ in", head)
counts, first = [], []
for path in paths:
    with h5py.File(f"{path}/response.h5") as file:
        counts.append([len(file["cracks/mode"]), int((file["cracks/mode"][:] == 0).sum())])
        first.append(file["cracks/saturation"][0] if counts[-1][0] else np.nan)
counts = np.array(counts)
ok([int(v) for v in column("broken")] == counts[:, 0].tolist() and [int(v) for v in column("in tension")] == counts[:, 1].tolist(),
   "cracks by mode are those of the artifacts", (column("broken"), counts.tolist()))
ok(np.allclose([float(v) for v in column("saturation at the first break") if v], [v for v in first if not np.isnan(v)], rtol=1e-4), "and where the first opened")
links = [os.path.join(at("study"), re.sub(r"%(..)", lambda m: chr(int(m[1], 16)), link)) for link in table.links]
ok([os.path.realpath(link) for link in links] == [os.path.realpath(f"{path}/report.html") for path in paths[1:]],
   "names lead to the pages that are there", table.links)

# ---- statistics ---------------------------------------------------------------------------

pairs = [word for path in paths for word in (f"{path}/response.h5", f"{path}/drying.h5")]
counted = json.loads(run("crackstats", "-p", at("scene.json"), "--set", "first_group=3", *pairs))
tests = {row[0]: row[1:] for row in Table(re.search(r'<table id="tests">.*?</table>', page, re.S)[0]).rows}
wanted = counted["test"]["cracks"]["total"]
said = [float(v) for v in tests["broken"]]
ok(np.allclose(said[:2], [counts[:3, 0].mean(), counts[3:, 0].mean()], rtol=1e-3), "means of both groups", said)
flat = json.dumps(wanted)
ok(f"{wanted['welch']['p']:.2g}" == tests["broken"][2] and f"{wanted['mann_whitney']['p']:.2g}" == tests["broken"][3].strip(),
   "tests are those of crackstats", (flat, tests["broken"]))
mean, sd = counts[:3, 0].mean(), counts[:3, 0].std(ddof=1)
half = 4.302652729911275 * sd / np.sqrt(3)  # Student's t for 2 degrees of freedom
ok(f"liquid inviscid: {mean:.4g} bonds broke on average (95 % interval {max(0, mean - half):.4g} to {mean + half:.4g})" in html.unescape(page),
   "an interval for each group", (mean, half))
drawn = re.findall(r"<figure><figcaption>([^<]*)</figcaption><svg[^>]* aria-label=\"([^\"]*), a point a run\"", page)
ok(len(drawn) == page.count("<figure>") and drawn[0] == ("broken", "broken") and all(a == b and a in [name.strip() for name in head] for a, b in drawn),
   "every strip is headed by what it shows", drawn)
ok(page.count("<circle") % 6 == 0 and page.count("<circle") >= 18, "a point a run in every strip", page.count("<circle"))
run("report", "--set", "groups=" + json.dumps("\n".join(["slow & calm"] * 3 + ["fast"] * 3)), *paths, "-o", at("study/named.html"))
ok("slow & calm: " in html.unescape(open(at("study/named.html")).read()) and "liquid inviscid: " not in open(at("study/named.html")).read(),
   "groups have the names that are given")
ended = refused("--set", "groups=one", *paths, "-o", at("study/named.html"))
ok(ended == (65, "report: report.groups: must have a line for each of 6 runs, has 1\n"), "a name is missing: refused", ended)
run("report", *paths[:3], "-o", at("study/one.html"))
ok("here is one, of runs that differ in seeds at most" in open(at("study/one.html")).read(), "one group is not tested")
run("report", at("study/inviscid"), "-o", at("study/below.html"))
ok(re.findall(r"<tr><th scope=\"row\">(?:<a[^>]*>)?([^<]*)", open(at("study/below.html")).read()) == re.findall(
    r"<tr><th scope=\"row\">(?:<a[^>]*>)?([^<]*)", open(at("study/one.html")).read()), "a folder of runs stands for them")
for k, strength in enumerate([20000.0, 30000.0, 40000.0, 50000.0]):
    run("dem-replay", "-q", "-p", at("scene.json"), "--set", f"bond.normal_strength={strength}", f"{paths[0]}/forces.h5", "-o", at(f"response-{k}.h5"))
    os.makedirs(at(f"four/{k}"))
    os.rename(at(f"response-{k}.h5"), at(f"four/{k}/response.h5"))
run("report", at("four"), "-o", at("four.html"))

# Names of groups that do not fit beside the points stand above them, whole.
for k, strength in enumerate([20000.0, 30000.0]):
    os.makedirs(at(f"long/{k}"))
    run("dem-replay", "-q", "-p", at("scene.json"), "--set", f"bond.normal_strength={strength}", "--set", f"bond.shear_strength={strength + 1}",
        "--set", f"local_damping=0.{6 + k}", f"{paths[0]}/forces.h5", "-o", at(f"long/{k}/response.h5"))
run("report", at("long"), "-o", at("long.html"))
svgs = re.findall(r"<svg class=\"strip\".*?</svg>", open(at("long.html")).read(), re.S)
placed = [re.findall(r'<text x="(\d+)"[^>]* text-anchor="(start|end)">([^<]*)<', svg) for svg in svgs]
long = [("0", "start", f"normal_strength {s}, shear_strength {s + 1}, local_damping 0.{6 + k}") for k, s in enumerate([20000, 30000])]
ok(svgs and all(sorted(p[2].split(", ")) == sorted(q[2].split(", ")) and p[:2] == q[:2] for texts in placed for p, q in zip(texts, long, strict=True)),
   "long names of groups are whole", placed)
four = html.unescape(open(at("four.html")).read())
headline = re.search(r'id="headline">(.*?)</p>', four, re.S)[1]
ok("on average" not in headline and re.search(r": [\d.]+, 1 run[;<]", four) and "1 runs" not in four and "mean 1" not in four,
   "of a group of one run no mean", headline)
ok("4 runs in 4 groups: normal_strength 20000: " in headline and headline.count("bonds broke") == 3 and headline.endswith("; and so on below."),
   "a headline says that it leaves groups out, and whole numbers without a point", headline)
os.makedirs(at("study/empty"))
ended, error = refused(paths[0], at("study/empty"))
ok(ended == 66 and "holds no artifact" in error, "a folder without a run is refused", (ended, error))
ended, error = refused(paths[0], at("study/packing.h5"))
ok(ended == 64 and "second packing" in error, "folders and files together are one run", (ended, error))

# ---- runs without times -------------------------------------------------------------------

run("pack", "-q", "--set=counts=[3,3,3]", "-o", at("layer.h5"))
for strain in "0.01", "0.02":
    os.makedirs(at(f"layers/{strain}"))
    run("dem-replay", "-q", f"--set=shrinkage.strain={strain}", "--set=shrinkage.steps=5", "--set=cycles=1", "--set=most_cycles=1",
        at("layer.h5"), "-o", at(f"layers/{strain}/response.h5"))
run("report", at("layers/0.01"), at("layers/0.02"), "-o", at("layers.html"))
layers = Table(re.search(r'<table id="runs">.*?</table>', open(at("layers.html")).read(), re.S)[0]).rows
ok("bonds" in layers[0] and "dried after, s" in head and not any("dried after" in cell for cell in layers[0]),
   "steps of a packing that shrinks by itself are no seconds", layers)

# ---- in a browser -------------------------------------------------------------------------

if MISSING:
    ok(True, f"the page in a browser # SKIP {MISSING}")
    done()
browser = Browser()
browser.call("Page.navigate", url=f"file://{at('study/study.html')}")
for _ in range(100):
    if browser.evaluate("document.readyState === 'complete' && !!document.getElementById('runs')"):
        break
k = head.index("broken")
order = lambda: [int(v) for v in browser.evaluate(f"[...runs.tBodies[0].rows].map((row) => row.cells[{k}].textContent)")]
browser.evaluate(f"heads[{k}].firstElementChild.click()")
ok(order() == sorted(counts[:, 0].tolist()) and browser.evaluate(f"heads[{k}].ariaSort") == "ascending", "a heading sorts", order())
browser.evaluate(f"heads[{k}].firstElementChild.click()")
ok(order() == sorted(counts[:, 0].tolist(), reverse=True), "and turns round", order())
ok(not browser.errors and all(u.startswith("file:") for u in browser.requests), "no error, no request", (browser.errors, browser.requests))
ok(browser.evaluate("document.querySelectorAll('b').length") == 0, "names add no elements")
browser.close()
browser = Browser(width=360, height=700, dark=True)
browser.call("Page.navigate", url=f"file://{at('study/study.html')}")
browser.evaluate("new Promise((go) => setTimeout(go, 500))")
ok(browser.evaluate("document.documentElement.scrollWidth <= 360"), "a narrow screen needs no scrolling sideways")
browser.close()
done()
