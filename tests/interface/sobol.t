#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Sobol indices of Ishigami and Homma's function, which has them in closed form, through the table of
# runs that a study reads and the one that it writes.
import csv
import os
import subprocess
import sys
from math import pi, sin

import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, read, scratch

folder = scratch()
at = lambda name: os.path.join(folder.name, name)


def tool(name, *words):
    return subprocess.run([f"pipelines/studies/sobol/{name}", *words], capture_output=True, text=True, check=False)


tool("design", "2000", at("design.tsv"), *(f"{key}={-pi},{pi}" for key in "abc"))
with open(at("design.tsv"), encoding="utf-8", newline="") as lines:
    runs = list(csv.DictReader(lines, delimiter="\t"))
with open(at("runs.tsv"), "w", encoding="utf-8") as file:
    print("run\tcracks", file=file)
    for run in runs:
        a, b, c = (float(run[key]) for key in "abc")
        print(run["run"], sin(a) + 7 * sin(b)**2 + 0.1 * c**4 * sin(a), sep="\t", file=file)
said = tool("indices", at("design.tsv"), at("runs.tsv"), "cracks", folder.name)
table = [[float(x) for x in line.split("\t")[1:]] for line in read(at("indices.tsv")).decode().splitlines()]
first, total = [0.3139, 0.4424, 0], [0.5576, 0.4424, 0.2437]
ok(len(runs) == 10000 and np.allclose([row[0] for row in table], first, atol=0.04)
   and np.allclose([row[3] for row in table], total, atol=0.04), "Ishigami's function has its indices", (table, said.stderr))
ok(all(low <= mean <= high and high - low < 0.2 for row in table for mean, low, high in (row[:3], row[3:])),
   "within their intervals", table)
least = [min(float(run[key]) for run in runs) for key in "abc"]
ok(all(-pi <= x < -pi + 0.01 for x in least), "the samples fill their ranges", least)
for words, status, line in [((at("design.tsv"), at("none.tsv"), "cracks", folder.name), 66, "no such file"),
                            ((at("design.tsv"), at("runs.tsv"), "bonds", folder.name), 65, "must have the 10000 runs")]:
    said = tool("indices", *words)
    ok(said.returncode == status and line in said.stderr and "Traceback" not in said.stderr, f"{line}: refused", said.stderr)
said = tool("design", "ten", at("other.tsv"), "a=1,2")
ok(said.returncode == 64 and "must be a count" in said.stderr and not os.path.exists(at("other.tsv")), "ten runs: refused", said.stderr)
planned = subprocess.run(["make", "-n", "sobol", f"RUNS={folder.name}/runs"], capture_output=True, text=True, check=False)
ok(planned.returncode == 0 and not planned.stderr and not os.path.exists(at("runs")), "make -n: says what it would run, and makes nothing",
   planned.stderr)
done()
