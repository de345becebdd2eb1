# SPDX-License-Identifier: GPL-3.0-or-later
"""What came out: a table of all runs, and their summary."""
import json
import os
from types import SimpleNamespace

from common import number, row, write
from counts import probability, three
from definition import fits, label_of
from measure import measured, why
from samples import compared, described

# Of crackstats, beside what is measured: cracks under loads at the end of which grains still moved, and all.
MOVING = [SimpleNamespace(path=path, scale=1) for path in ("mean.unsettled.cracks", "mean.cracks.total")]


def read_runs(plan, folder, stale=()):
    """A row for each run: values of the axes, what was measured, and whether it is there: an artifact
    that is STALE is not."""
    study, cache = plan.study, {}
    grains = short_names({run.grains for run in study.runs if run.grains})
    kinds = list(dict.fromkeys(m.kind for m in study.measures))
    said = {path: why(folder, path) for path, artifact in plan.artifacts.items() if not artifact.folded}
    rows = []
    for run, made in zip(study.runs, plan.runs):
        line = {"run": run.number, "point": run.point + 1, **run.values}
        if run.label:
            line["label"] = run.label
        if run.grains:
            line["grains"] = grains[run.grains]
        if run.seed is not None:
            line["seed"] = run.seed
        results, missing = {}, ""
        for kind in kinds:
            path, mine = made[kind].path, [m for m in study.measures if m.kind == kind]
            more = MOVING if kind == "crackstats" else []
            if path not in cache:
                cache[path] = measured(os.path.join(folder, path), mine + more) if path not in stale else None
            if more and cache[path]:
                line["moving"] = cache[path][len(mine):]
            missing = missing or ("" if cache[path] else path)
            results.update(zip((m.name for m in mine), cache[path] or [None] * len(mine)))
        line.update({m.name: results[m.name] for m in study.measures})
        failed = next((said[a.path] for a in made.values() if said.get(a.path)), "") if missing else ""
        line["status"] = "failed" if failed else "not yet" if missing else "done"
        line["why"] = failed
        line["artifacts"] = {kind: a.path for kind, a in made.items() if not a.folded}
        rows.append(line)
    return rows


def short_names(paths):
    """The names of files, by path; with their folders, where two have the same."""
    names = [os.path.basename(path) for path in paths]
    return {path: name if names.count(name) == 1 else path for path, name in zip(paths, names)}


def text_of(value):
    if value is None:
        return ""
    return number(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else \
        str(value).replace("\t", " ").replace("\n", " ") if isinstance(value, str) else json.dumps(value)


def write_runs(rows, study, folder):
    """runs.tsv and runs.json, a row a run."""
    names = list(dict.fromkeys(name for line in rows for name in line if name not in ("artifacts", "moving")))
    names = [n for n in names if n not in ("status", "why")] + ["status", "why"]
    lines = ["\t".join(names)] + ["\t".join(text_of(line.get(name)) for name in names) for line in rows]
    save(folder, "runs.tsv", "".join(f"{line}\n" for line in lines))
    save(folder, "runs.json", json.dumps({"study": study.name, "runs": [{k: v for k, v in line.items() if k != "moving"} for line in rows]}, indent=1) + "\n")


def save(folder, name, text):
    """Whole, or not at all."""
    path = os.path.join(folder, name)
    with open(f"{path}.new", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(f"{path}.new", path)


# ---- summary ----------------------------------------------------------------------------

def summarise(rows, study):
    """For each point what its runs have in common, and each measure over them; for each comparison its
    tests."""
    confidence = study.said.get("confidence", 0.95)
    points = []
    by_point = [[] for _ in study.points]
    for line in rows:
        by_point[line["point"] - 1].append(line)
    for number_, (values, mine) in enumerate(zip(study.points, by_point), 1):
        points.append({"point": number_, "values": values, "runs": len(mine), "done": sum(r["status"] == "done" for r in mine),
                       "failed": sum(r["status"] == "failed" for r in mine),
                       "measures": {m.name: described(values_of(m, mine), confidence) for m in study.measures},
                       "reference": {r["measure"]: r["value"] for r in study.said.get("reference", []) if fits(values, r.get("at", {}))}})
    tests = [test for said in study.said.get("compare", []) for test in comparisons(said, study, by_point)]
    return {"study": study.name, "confidence": confidence, "points": points, "tests": tests, **moving(rows)}


def moving(rows):
    """How many runs broke bonds under loads at the end of which grains still moved, and the share of these bonds."""
    known = list({line["artifacts"]["crackstats"]: line["moving"] for line in rows
                  if line["status"] == "done" and None not in line.get("moving", [None])}.values())
    under, total = map(sum, zip(*known)) if known else (0, 0)
    return {"moving": {"runs": sum(m > 0 for m, _ in known), "of": len(known), "share": under / total}} if under else {}


def comparisons(said, study, by_point):
    """Each point of another value of the axis, with that which differs from it in this alone."""
    axis, paired = said["axis"], said.get("paired", True)
    for k, values in enumerate(study.points):
        base = {**values, axis: said["with"]}
        of = said.get("of", values[axis])
        if values[axis] == said["with"] or values[axis] not in (of if isinstance(of, list) else [of]) or base not in study.points:
            continue
        first, second = by_point[study.points.index(base)], by_point[k]
        yield {"point": k + 1, "with": study.points.index(base) + 1, "axis": axis, "paired": paired,
               "measures": {m.name: compared(*(pairs_of(m, first, second, study) if paired else (values_of(m, first), values_of(m, second))),
                                             paired) for m in study.measures}}


def source(measure, line):
    """The artifact that the value of MEASURE in a row is from: runs that share it are one draw of it."""
    return line["artifacts"][measure.kind]


def values_of(measure, rows):
    """The values of MEASURE, one of each artifact."""
    return list({source(measure, r): r[measure.name] for r in rows if r[measure.name] is not None}.values())


def pairs_of(measure, first, second, study):
    """The values of MEASURE in both groups of rows, of runs that have a twin in both; one of each pair of artifacts."""
    twin = lambda r: study.runs[r["run"] - 1].twin
    there = {twin(r): r for r in second if r[measure.name] is not None}
    pairs = [(r, there[twin(r)]) for r in first if r[measure.name] is not None and twin(r) in there]
    once = {(source(measure, a), source(measure, b)): (a[measure.name], b[measure.name]) for a, b in pairs}
    return [a for a, _ in once.values()], [b for _, b in once.values()]


def write_summary(summary, study, folder):
    """summary.json, summary.tsv (a row for each point and measure) and summary.md."""
    save(folder, "summary.json", json.dumps(summary, indent=1) + "\n")
    axes, statistics = [a.name for a in study.axes], ["runs", "mean", "sd", "low", "high", "least", "largest"]
    lines = ["\t".join(["point", *axes, "measure", *statistics, "reference"])]
    for point in summary["points"]:
        for name, values in point["measures"].items():
            lines.append("\t".join([str(point["point"]), *(text_of(point["values"].get(a)) for a in axes), name,
                                    *(text_of(values[s]) for s in statistics), text_of(point["reference"].get(name))]))
    save(folder, "summary.tsv", "".join(f"{line}\n" for line in lines))
    write(os.path.join(folder, "summary.md"), *markdown(summary, study))


def cell(values, reference):
    if values["mean"] is None:
        return "-"
    spread = "" if values["sd"] is None else f" ± {three(values['sd'])} ({three(values['low'])} to {three(values['high'])})"
    return three(values["mean"]) + spread + (f" [{three(reference)}]" if reference is not None else "")


def point_title(values, axes):
    return ", ".join(label_of(values.get(a.name)) + (f" {a.unit}" if a.unit else "") for a in axes) or "all runs"


def markdown(summary, study):
    """Means ± standard deviations (intervals of the means) [numbers of others]; then the tests."""
    axes = study.axes
    yield row(*(a.title + (f", {a.unit}" if a.unit else "") for a in axes), "runs",
              *(m.title + (f", {m.unit}" if m.unit else "") for m in study.measures))
    yield "|---" * (len(axes) + 1 + len(study.measures)) + "|"
    for point in summary["points"]:
        runs = f"{point['done']}" + (f" of {point['runs']}" if point["done"] < point["runs"] else "")
        yield row(*(label_of(point["values"].get(a.name)) for a in axes), runs,
                  *(cell(values, point["reference"].get(name)) for name, values in point["measures"].items()))
    if any(values["sd"] is not None for point in summary["points"] for values in point["measures"].values()):
        yield from ["", f"Mean ± standard deviation ({100 * summary['confidence']:g} % interval of the mean)"
                    + (" [published]." if any(point["reference"] for point in summary["points"]) else ".")]
    if summary.get("moving"):
        found = summary["moving"]
        yield from ["", f"In {found['runs']} of {found['of']} runs grains still moved at the end of loads; {100 * found['share']:.3g} % of all "
                    "broken bonds broke under these. Their number may change once grains come to rest: run again with "
                    "dem-replay.engine=explicit and twice the dem-replay.cycles and most_cycles, and compare."]
    if summary["tests"]:
        yield from ["", *tests_table(summary, study)]


def tests_table(summary, study):
    if not any(found for test in summary["tests"] for found in test["measures"].values()):
        yield "Not compared: a test takes two runs or more at both points (seeds, packings)."
        return
    yield "| compared | measure | difference, first less second | t test, p | ranks, p |"
    yield "|---|---|---|---|---|"
    for test in summary["tests"]:
        title = " against ".join(point_title(study.points[k - 1], study.axes) for k in (test["point"], test["with"]))
        for name, found in test["measures"].items():
            if found and found["difference"] is not None:
                spread = f" ± {three(found['sd'])}" if found.get("sd") is not None else ""
                p = [found[k] for k in found if k.endswith("_p")]
                yield row(title, name, three(found["difference"]) + spread, *("-" if x is None else probability(x) for x in p))
