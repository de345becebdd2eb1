# SPDX-License-Identifier: GPL-3.0-or-later
"""What a study ends in beside its tables: programs that draw more, the page of its runs, and what is
said on the terminal."""
import json
import os
import re
import shlex
import subprocess
import sys

import stages
from common import refuse
from definition import fits, label_of
from plan import TREE
from results import point_title
from rules import quoted

MOST_ON_PAGE = 64
MOST_CHECKED = 200
PAGE_KINDS = ["packing", "tessellation", "network", "drying", "forces", "response", "crackstats"]


def check_together(plan):
    """Whether each stage takes its overrides together: asked of the stage, where they are few."""
    asked = {}
    for artifact in plan.artifacts.values():
        asked.setdefault((artifact.stage(), artifact.scene, artifact.sets), artifact)
    if len(asked) > MOST_CHECKED:
        asked = {key: asked[key] for key in {(s, scene): (s, scene, sets) for s, scene, sets in asked}.values()}
    for stage, scene, sets in asked:
        words = [os.path.join(stages.BIN, stage), "-p", scene, *(w for item in sets for w in ("--set", item)), "--parameters"]
        said = subprocess.run(words, capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if said.returncode:
            refuse(said.returncode, f"{plan.study.name}: {said.stderr.strip()}")


def firsts(plan, report):
    """By point the artifacts of its first run, of the points that a REPORT is of."""
    of = {}
    for run, made in zip(plan.study.runs, plan.runs):
        if fits(run.values, report.get("of", {})):
            of.setdefault(run.point, (run, made))
    return of.values()


def write_reports(plan, folder):
    """Calls the programs of the study whose artifacts are there; gives the names of what they wrote."""
    written = []
    for report in plan.study.said.get("reports", []):
        words, here = [], True
        for run, made in firsts(plan, report):
            for kind in report.get("takes", []):
                path = os.path.join(folder, plan.groups[run.point].path if kind == "groups" else made[kind].path)
                here = here and os.path.exists(path)
                words.append(f"{point_title(run.values, plan.study.axes)}={path}" if report.get("titled") else path)
        out = os.path.join(folder, report["out"])
        if not here:
            continue
        program = os.path.join(TREE, "pipelines", report["program"])
        if subprocess.run([*shlex.split(program), *dict.fromkeys(words), out]).returncode == 0:
            written.append(report["out"])
    return written


def link(target, path):
    if not os.path.islink(path) or os.readlink(path) != target:
        if os.path.lexists(path):
            os.remove(path)
        os.symlink(target, path)


def group_name(values, axes):
    """A point with the names of its axes: "liquid inviscid, strength 30000 Pa"."""
    return ", ".join(f"{a.title} {label_of(values.get(a.name))}" + (f" {a.unit}" if a.unit else "") for a in axes)


def write_page(plan, rows, folder):
    """study.html, a page of all runs that are there: each with a folder `run/N` of links to its
    artifacts, which `report` takes."""
    done = [line for line in rows if line["status"] == "done"]
    kinds = [kind for kind in PAGE_KINDS if all(kind in line["artifacts"] for line in done)]
    if not plan.study.said.get("page", True) or not 2 <= len(done) <= MOST_ON_PAGE or "response" not in kinds:
        return []
    folders, groups = [], []
    for line in done:
        groups.append(group_name(plan.study.points[line["point"] - 1], plan.study.axes))
        mine = os.path.join(folder, "run", f"{line['run']:0{len(str(len(rows)))}}")
        os.makedirs(mine, exist_ok=True)
        for kind in kinds:
            link(f"../../{line['artifacts'][kind]}", os.path.join(mine, f"{kind}.{stages.MADE[kind][2]}"))
        folders.append(mine)
    named = ["--set", "groups=" + json.dumps("\n".join(groups))] if plan.study.axes else []
    said = subprocess.run([os.path.join(stages.BIN, "report"), "-q", "--set", f'title="{plan.study.name}"', *named, *folders,
                           "-o", os.path.join(folder, "study.html")], capture_output=True, text=True)
    if said.returncode:
        print(f"no page: {said.stderr.strip()}", file=sys.stderr)
        return []
    return ["study.html"]


NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.]*\w)")


def spanned(texts):
    """One line for lines that differ in numbers alone: from the least to the largest of each."""
    columns = iter([min(column, key=float) if len(set(map(float, column))) == 1
                    else f"{min(column, key=float)} to {max(column, key=float)}" for column in zip(*map(NUMBER.findall, texts))])
    return NUMBER.sub(lambda _: next(columns), texts[0])


def notes(plan, folder):
    """What stages said of artifacts of the plan, once for lines that differ in numbers alone, and of how many."""
    said = {}
    try:
        with open(os.path.join(folder, ".study/notes"), encoding="utf-8", errors="replace") as file:
            for line in file:
                path, _, text = line.rstrip("\n").partition(" ")
                if path in plan.artifacts and text:
                    said.setdefault(text, set()).add(path)
    except OSError:
        pass
    alike = {}
    for text in said:
        alike.setdefault(NUMBER.sub("#", text), []).append(text)
    for texts in alike.values():
        paths = set().union(*(said[text] for text in texts))
        print((f"{len(paths)} times: " if len(paths) > 1 else "") + spanned(texts), file=sys.stderr)


def tell_empty(study, rows):
    """Names what is to be measured and is in none of the runs that are done: misspelt, or nothing to measure."""
    ready = [r for r in rows if r["status"] == "done"]
    none = f"none of the {len(ready)} done runs has" if len(ready) > 1 else "the run that is done does not have"
    for measure in study.measures if ready else []:
        if all(r[measure.name] is None for r in ready):
            print(f"measure {measure.name}: {none} such a number", file=sys.stderr)


def show(rows, folder, written):
    """The summary, what failed, and where everything is."""
    with open(os.path.join(folder, "summary.md"), encoding="utf-8") as file:
        print(file.read(), end="")
    for line in [r for r in rows if r["status"] == "failed"][:10]:
        print(f"run {line['run']} failed: {line['why']}", file=sys.stderr)
    counts = {status: sum(r["status"] == status for r in rows) for status in ("done", "failed", "not yet")}
    print(", ".join(f"{n} {status}" for status, n in counts.items() if n) + f" of {len(rows)} runs")
    print(f"written: {quoted([os.path.join(folder, name) for name in written])}")
