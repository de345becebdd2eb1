#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# docs/papers.md: what it names is there, each function in the file it is said to be in, and no
# equation of what the discrete elements, the capillary force and the bridges follow is missing.
import glob
import os
import re
import sys

sys.path.insert(0, "tests")
from tap import done, ok, read

text = read("docs/papers.md").decode()
rows = [line for line in text.splitlines() if line.startswith("|")][2:]


def defines(path, name):
    """Whether PATH, or a file in that folder, has a function NAME: its head begins the line."""
    files = glob.glob(path + "/*.[ch]") if os.path.isdir(path) else [path]
    head = re.compile(rf"^[a-zA-Z][^;=\n]*\b{name}\(", re.M)
    return any(head.search(read(file).decode()) for file in files)


# "`a`, `b` in `path`" names functions; every other `path/...` is to be there.
words = re.sub(r"\s+", " ", text)
missing = [path for path in re.findall(r"`([\w./*-]+/[\w./*-]*)`", words) if not glob.glob(path)]
ok(not missing, "every file that is named is there", missing)
claims = [(name, path) for names, path in
          re.findall(r"((?:`\w+`(?:, (?:and )?)?)+) in `([\w./-]+)`", words)
          for name in re.findall(r"`(\w+)`", names)]
wrong = [f"{name} in {path}" for name, path in claims if not defines(path, name)]
ok(len(claims) > 60, "functions are found in the text", len(claims))
ok(not wrong, "every function is in its file", wrong)

goals = re.findall(r"`make ([\w-]+)`", words)
rules = "".join(read(path).decode() for path in ["Makefile", *glob.glob("pipelines/**/*.mk", recursive=True)])
ok(not [goal for goal in goals if not re.search(rf"^{goal}:", rules, re.M)],
   "every goal of make is there", goals)


def numbers_of(paper):
    """What of PAPER the first column names: "4.1-4.6" is each of the six."""
    found = set()
    for row in rows:
        cell = row.split("|")[1].strip()
        if not cell.startswith(paper + " "):
            continue
        for first, last in re.findall(r"(?<![\w.])(\d+(?:\.\d+)?)(?:-(\d+(?:\.\d+)?))?(?![\w.])", cell):
            *chapter, begin = first.split(".")
            end = (last or first).split(".")[-1]
            found |= {".".join([*chapter, str(k)]) for k in range(int(begin), int(end) + 1)}
    return found


for paper, equations in [
        ("K", [f"3.{k}" for k in range(12, 23)] + [f"4.{k}" for k in range(1, 48)] + ["5.1"]),
        ("G", [str(k) for k in range(1, 13)]),
        ("C", [str(k) for k in range(4, 21)])]:
    left = [equation for equation in equations if equation not in numbers_of(paper)]
    ok(not left, f"no equation of {paper} is missing", left)
done()
