# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of a study, of the kind that fits its axes: curves with bands over a number, a map of two,
points by group, or points over each column of a table of runs."""
import copy
import itertools
import math
import os

from common import draw
from definition import fits, label_of

SCRIPT = f"{os.path.dirname(os.path.realpath(__file__))}/figure.gp"
MOST_PANELS, MOST_SERIES = 8, 12


def kind_of(study):
    """The kind of picture that fits."""
    said = study.said.get("figure", "auto")
    numeric = [a for a in study.axes if a.numeric() and len(a.values) > 1]
    if said != "auto":
        return said if numeric or said in ("none", "strip") else "strip"
    if "runs" in study.said and len(numeric) > 1:
        return "scatter"
    if len(numeric) > 1 and sorted(len(a.values) for a in numeric)[-2] > 4:
        return "map"
    return "curves" if numeric else "strip"


def titled(axis):
    return axis.title + (f", {axis.unit}" if axis.unit else "")


def named(values, axes):
    """What VALUES by axis are called."""
    return ", ".join(label_of(values[a.name]) + (f" {a.unit}" if a.unit else "") for a in axes)


def series_of(study, without):
    """The combinations of the other axes that the points have."""
    axes = [a for a in study.axes if a not in without]
    combined = [dict(zip((a.name for a in axes), values)) for values in itertools.product(*(a.values for a in axes))]
    combined = [c for c in combined if any(fits(p, {n: [v] for n, v in c.items()}) for p in study.points)]
    return [(named(c, axes), c) for c in combined[:MOST_SERIES]]


def of_series(summary, choice):
    return [p for p in summary["points"] if all(p["values"].get(n) == v for n, v in choice.items())]


def curves(rows, summary, study):
    """Means and intervals over the axis with most values, a curve for each combination of the others; and
    the numbers of others."""
    axis = max((a for a in study.axes if a.numeric()), key=lambda a: len(a.values))
    tables, series = {}, series_of(study, [axis])
    for m, measure in enumerate(study.measures):
        for s, (_, choice) in enumerate(series):
            found = [(p["values"][axis.name], p["measures"][measure.name], p["reference"].get(measure.name))
                     for p in of_series(summary, choice)]
            found = sorted((each for each in found if each[1]["mean"] is not None), key=lambda each: each[0])
            tables[f"curve-{m}-{s}"] = [(x, v["mean"], *(v["mean"] if v[e] is None else v[e] for e in ("low", "high")))
                                        for x, v, _ in found] or ["NaN NaN NaN NaN"]
            tables[f"reference-{m}-{s}"] = [(x, r) for x, _, r in found if r is not None] or ["NaN NaN"]
    return tables, {"names": "|".join(name for name, _ in series), "xtitle": titled(axis),
                    "step": step_of(axis.values), "logarithmic": int(axis.log), "xrange": span_of(axis), "xmarks": marks_of(axis)}


def strip(rows, summary, study):
    """A point for each run, side by side by point, with means and intervals."""
    tables = {}
    for m, measure in enumerate(study.measures):
        tables[f"runs-{m}"] = [(r["point"], r[measure.name]) for r in rows if r[measure.name] is not None] or ["NaN NaN"]
        found = [(p["point"], p["measures"][measure.name], p["reference"].get(measure.name)) for p in summary["points"]]
        tables[f"means-{m}"] = [(k, v["mean"], *(v["mean"] if v[e] is None else v[e] for e in ("low", "high")))
                                for k, v, _ in found if v["mean"] is not None] or ["NaN NaN NaN NaN"]
        tables[f"reference-{m}"] = [(k, r) for k, _, r in found if r is not None] or ["NaN NaN"]
    names = [named(point, study.axes) for point in study.points] if len(study.points) <= MOST_SERIES else []
    return tables, {"names": "|".join(names or [str(k + 1) for k in range(len(study.points))])}


def heat_map(rows, summary, study):
    """Means over two numbers, as boxes around them; of the first combination of the others."""
    first, second = sorted((a for a in study.axes if a.numeric()), key=lambda a: -len(a.values))[:2]
    (name, choice), *_ = series_of(study, [first, second])
    tables = {}
    for m, measure in enumerate(study.measures):
        value = {(p["values"][first.name], p["values"][second.name]): p["measures"][measure.name]["mean"]
                 for p in of_series(summary, choice)}
        tables[f"map-{m}"] = [(i, j, float("nan") if value.get((x, y)) is None else value[x, y])
                              for j, y in enumerate(second.values) for i, x in enumerate(first.values)]
    return tables, {"xtitle": titled(first), "ytitle": titled(second), "of": name,
                    "xnames": "|".join(f"{x:.3g}" for x in first.values), "ynames": "|".join(f"{y:.3g}" for y in second.values)}


def scatter(rows, summary, study):
    """The first measure over each column of numbers."""
    axes = [a for a in study.axes if a.numeric()][:MOST_PANELS]
    measure = study.measures[0]
    tables = {f"scatter-{k}": [(r[a.name], r[measure.name]) for r in rows if r[measure.name] is not None] or ["NaN NaN"]
              for k, a in enumerate(axes)}
    return tables, {"titles": "|".join(titled(a) for a in axes), "panels": len(axes),
                    "ytitle": measure.title + (f", {measure.unit}" if measure.unit else "")}


def span_of(axis):
    """The range of an axis for gnuplot: the same in all panels, with a margin."""
    first, last = min(axis.values), max(axis.values)
    if axis.log:
        margin = (last / first) ** 0.04 if last > first else 1.1
        return f"[{first / margin:.9g}:{last * margin:.9g}]"
    margin = 0.04 * (last - first) or 0.1 * abs(first) or 1
    return f"[{first - margin:.9g}:{last + margin:.9g}]"


def marks_of(axis):
    """Labels for gnuplot, which takes the text "5e+04" for no number, of a logarithmic axis on which there are
    hardly any powers of ten: 1, 2 and 5 times these, or its ends if fewer than two of them lie on it. "":
    gnuplot's own."""
    first, last = min(axis.values), max(axis.values)
    if not axis.log or last >= 30 * first:
        return ""
    powers = range(math.floor(math.log10(first)), math.ceil(math.log10(last)) + 1)
    marks = [x for x in (float(f"{k}e{power}") for power in powers for k in (1, 2, 5)) if 0.999 * first < x < 1.001 * last]
    marks = marks if len(marks) > 1 else [first, last]
    return "(" + ", ".join(f'"{x:.3g}" {x:.9g}' if x >= 1e6 or x < 1e-3 else f'"{x:.6g}" {x:.9g}' for x in marks) + ")"


def step_of(values):
    """Between the labels of an axis of VALUES: about four of them."""
    rough = (max(values) - min(values)) / 4 or 1
    power = 10.0 ** math.floor(math.log10(rough))
    return next(power * k for k in (1, 2, 2.5, 5, 10) if power * k >= rough * 0.999)


def range_of(measure, rows, summary):
    """A range for gnuplot where the values have none, or from 0 where they come near it and none, nor an
    interval, is below; else ""."""
    values = {p["measures"][measure.name][what] for p in summary["points"] for what in ("mean", "low", "high")} | \
        {r[measure.name] for r in rows} | {p["reference"].get(measure.name) for p in summary["points"]}
    values = sorted(x for x in values if x is not None) or [0]
    margin = 0.1 * abs(values[-1]) or 1
    if values[-1] - values[0] <= 1e-12 * abs(values[-1]):
        return f"[{values[-1] - margin if values[-1] else 0:.9g}:{values[-1] + margin:.9g}]"
    return "[0:*]" if 0 <= values[0] < 0.2 * values[-1] else ""


def draw_figure(rows, summary, study, folder):
    """figure.svg, of what was measured anywhere; gives its name, nothing where no run is there."""
    study = copy.copy(study)
    study.measures = [m for m in study.measures if any(r[m.name] is not None for r in rows)]
    kind = kind_of(study)
    if kind == "none" or not study.measures or not any(line["status"] == "done" for line in rows):
        return []
    tables, settings = {"curves": curves, "strip": strip, "map": heat_map, "scatter": scatter}[kind](rows, summary, study)
    panels = min(len(study.measures), MOST_PANELS)
    titles = "|".join(m.title + (f", {m.unit}" if m.unit else "") for m in study.measures)
    draw(os.path.join(folder, "figure.svg"), tables, SCRIPT,
         **{"kind": kind, "panels": panels, "titles": titles, "xtitle": "", "ytitle": "", "logarithmic": 0, "step": 1, "names": "",
            "of": "", "ranges": "|".join(range_of(m, rows, summary) for m in study.measures), "xnames": "", "ynames": "", "confidence": study.said.get("confidence", 0.95),
            "name": study.said.get("title", study.name), **settings})
    return ["figure.svg"]
