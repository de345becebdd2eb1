# SPDX-License-Identifier: GPL-3.0-or-later
"""A study as its file says it, study.json or a table of runs, checked, and its runs spelled out."""
import csv
import itertools
import json
import math
import os
from dataclasses import dataclass, field

import stages
from common import LIBRARY, document, refuse
from plan import kinds_wanted
from schema import nearest, wrong

TREE = os.path.realpath(f"{LIBRARY}/../..")
MOST_RUNS = 100000
CRACKS = ["cracks.total", "cracks.normal", "cracks.shear", "fragments.count"]
# Columns of a table of runs that are no parameters.
SPECIAL = ("scene", "import", "run")


@dataclass
class Axis:
    """A name, and the values it takes: each with what it sets, by key."""
    name: str
    values: list
    sets: list
    title: str = ""
    unit: str = ""
    log: bool = False

    def numeric(self):
        return all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in self.values)


@dataclass
class Run:
    """A run: its point, values by axis, seed and grains (None: those of the scene), overrides by key. Runs of other points
    that have the same `twin` belong together: all seeds and the packing are the same."""
    number: int
    point: int
    values: dict
    seed: object
    grains: object
    overrides: dict
    twin: tuple
    scene: object = None
    label: str = ""


@dataclass
class Study:
    path: str
    name: str
    said: dict
    axes: list
    points: list
    runs: list
    measures: list
    seed_keys: list = field(default_factory=list)

    @property
    def liquid(self):
        """Whether something dries."""
        return self.said.get("liquid", True)


def located(name, beside):
    """The file NAME: beside the file that names it, here, or of the tree."""
    for path in (os.path.join(os.path.dirname(beside) or ".", name), name, os.path.join(TREE, name),
                 os.path.join(TREE, "samples", name), os.path.join(TREE, "samples", f"{name}.json")):
        if os.path.isfile(path):
            return os.path.realpath(path)
    return refuse(66, f"{beside}: {name}: no such file, nor a sample")


def label_of(value):
    return f"{value:g}" if isinstance(value, float) else str(value).lower() if isinstance(value, bool) else \
        os.path.basename(value).removesuffix(".json") if isinstance(value, str) else json.dumps(value)


def check_key(key, where):
    said = None if key in SPECIAL else stages.wrong_key(key)
    if said:
        refuse(65, f"{where}: {key}: {said}")


def check_value(key, value, where):
    """A VALUE of KEY, as a run takes it: of files the path."""
    if key in ("scene", "import"):
        return located(value, where.split(":")[0])
    said = stages.wrong_value(key, value)
    if said:
        refuse(65, f"{where}: {key}: {said}")
    return value


# ---- axes -------------------------------------------------------------------------------

def spaced(axis, where):
    """Values from the first to the last, evenly or by equal ratios."""
    missing = [name for name in ("from", "to", "count") if name not in axis]
    if missing:
        refuse(65, f"{where}: has neither values nor zip, nor {missing[0]}")
    first, last, count = axis["from"], axis["to"], axis["count"]
    if axis.get("scale") != "log":
        return [float(f"{first + (last - first) * k / (count - 1):.12g}") for k in range(count)]
    if first * last <= 0:
        refuse(65, f"{where}: from and to of a logarithmic axis must have one sign, and not be 0")
    return [float(f"{first * (last / first) ** (k / (count - 1)):.12g}") for k in range(count)]


def sets_of_axis(axis, where):
    """The values of an AXIS, and what each sets."""
    zipped = axis.get("zip")
    if zipped is not None and ("key" in axis or "keys" in axis):
        refuse(65, f"{where}: has zip beside key or keys")
    if zipped is None:
        keys = axis.get("keys") or ([axis["key"]] if "key" in axis else refuse(65, f"{where}: has no key, keys or zip"))
        values = axis.get("values") or spaced(axis, where)
        return values, [{key: value for key in keys} for value in values]
    lists = list(zipped.values())
    if not lists or not all(isinstance(each, list) and each for each in lists):
        refuse(65, f"{where}.zip: must have a list of values for each key")
    values = axis.get("values") or lists[0]
    for key, each in [*zipped.items(), ("values", values)]:
        if len(each) != len(lists[0]):
            refuse(65, f"{where}.zip.{key}: has {len(each)} values, {next(iter(zipped))} {len(lists[0])}")
    return values, [{key: each[k] for key, each in zipped.items() if each[k] is not None} for k in range(len(values))]


def read_axis(axis, where):
    values, sets = sets_of_axis(axis, where)
    for k, given in enumerate(sets):
        for key in given:
            check_key(key, where)
            given[key] = check_value(key, given[key], f"{where}, value {k + 1}")
    first = next((key for given in sets for key in given), "")
    name = axis.get("name") or first.split(".")[-1]
    if len(set(map(str, values))) < len(values):
        refuse(65, f"{where}: has a value twice")
    return Axis(name, values, sets, axis.get("title", name), axis.get("unit", ""), axis.get("scale") == "log")


def as_list(wanted):
    return wanted if isinstance(wanted, list) else [wanted]


def fits(values, choice):
    """Whether the VALUES of a point are among those of a CHOICE."""
    return all(values.get(name) in as_list(wanted) for name, wanted in choice.items())


def chosen(choice, axes):
    """The places on each axis of the values that CHOICE names; all of an axis that it does not name."""
    return [[k for k, value in enumerate(axis.values) if axis.name not in choice or value in as_list(choice[axis.name])]
            for axis in axes]


def choices(said, axes):
    """The places on each axis, for each choice that SAID makes: all values, if it makes none."""
    return [chosen(choice, axes) for choice in said.get("only", [{}])]


def check_choice(choice, axes, where):
    for name, wanted in choice.items():
        axis = next((a for a in axes if a.name == name), None)
        if not axis:
            refuse(65, f"{where}.{name}: no such axis{nearest(name, [a.name for a in axes])}")
        for value in as_list(wanted):
            if value not in axis.values:
                refuse(65, f"{where}.{name}: {label_of(value)} is no value of that axis")


def crossed(said, axes):
    """The points: values by axis, and what they set."""
    points = []
    for places in sorted({places for choice in choices(said, axes) for places in itertools.product(*choice)}):
        values, sets = {axis.name: axis.values[k] for axis, k in zip(axes, places)}, {}
        for axis, k in zip(axes, places):
            sets.update(axis.sets[k])
        points.append((values, sets))
    return points


# ---- a table of runs --------------------------------------------------------------------

def cell(text):
    try:
        return json.loads(text)
    except ValueError:
        return text


def read_table(path):
    """The rows of a table of runs, as values by column; blank cells are left out."""
    try:
        with open(path, encoding="utf-8", newline="") as file:
            lines = list(csv.reader((line for line in file if line.strip() and not line.startswith("#")), delimiter="\t"))
    except OSError as error:
        refuse(66, f"{path}: {error.strerror}")
    if len(lines) < 2:
        refuse(65, f"{path}: must have a line of keys and a line for each run, with tabs between")
    keys = [key.strip() for key in lines[0]]
    for k, key in enumerate(keys):
        check_key(key, f"{path}: column {k + 1}")
        if key in keys[:k]:
            refuse(65, f"{path}: column {k + 1}: {key}: is there twice")
    rows = []
    for number, line in enumerate(lines[1:], 1):
        if len(line) != len(keys):
            refuse(65, f"{path}: row {number}: has {len(line)} cells, the line of keys {len(keys)}")
        row = {key: cell(text.strip()) for key, text in zip(keys, line) if text.strip()}
        rows.append({key: value if key == "run" else check_value(key, value, f"{path}: row {number}") for key, value in row.items()})
    return keys, rows


def table_points(path, is_seed):
    """Axes and points of a table of runs. Rows that differ in seeds alone are one point."""
    keys, rows = read_table(path)
    plain = [key for key in keys if not is_seed(key) and key != "run"]
    varied = [key for key in plain if len({str(row.get(key)) for row in rows}) > 1]
    names = {key: key if [k.split(".")[-1] for k in varied].count(key.split(".")[-1]) > 1 else key.split(".")[-1] for key in varied}
    axes = [Axis(names[key], list(dict.fromkeys(row.get(key) for row in rows)), [], names[key]) for key in varied]
    points, seeds = {}, []
    for row in rows:
        point = tuple(json.dumps(row.get(key)) for key in plain)
        values = {names[key]: row.get(key) for key in varied}
        points.setdefault(point, (len(points), values))
        seeds.append((points[point][0], values, row))
    return axes, [values for _, values in points.values()], seeds


# ---- seeds ------------------------------------------------------------------------------

def drawn_key(scene_of, sets, grains, path, made):
    """The seed of what the scene draws in one of the stages MADE; GRAINS: the file that they come from, if there is one."""
    for key, used in stages.DRAWN.items():
        stage = key.split(".")[0]
        if stage not in made:
            continue
        section = json.loads(json.dumps(stages.sections(scene_of(stage)).get(stage, {})))
        for name, value in sets.items():
            if name.startswith(f"{stage}."):
                place = section
                *parts, last = name.split(".")[1:]
                for part in parts:
                    place = place.setdefault(part, {})
                place[last] = value
        if used(section, grains):
            return [key]
    return refuse(65, f"{path}: seeds: the scene draws nothing in the stages of this study (neither radii of throats nor grains nor strengths); "
                  "seeds.keys says what takes them, packings gives other grains; one run needs no seeds")


def seeds_of(said, replaced, path):
    """The seeds, [None] where there are none, and their keys where they are given."""
    seeds = replaced or said.get("seeds")
    given = said.get("seeds") if isinstance(said.get("seeds"), dict) else {}
    for key in given.get("keys", []):
        check_key(key, f"{path}: seeds.keys")
    if seeds is None:
        return [None], []
    if isinstance(seeds, dict):
        seeds = seeds.get("values") or seeds.get("count") or refuse(65, f"{path}: seeds: has neither count nor values")
    return list(range(1, seeds + 1)) if isinstance(seeds, int) else list(dict.fromkeys(seeds)), given.get("keys", [])


# ---- measures ---------------------------------------------------------------------------

@dataclass
class Measure:
    kind: str
    path: str
    name: str
    title: str
    unit: str
    scale: float


def read_measure(said, where):
    said = {"path": said} if isinstance(said, str) else said
    kind, colon, path = said["path"].rpartition(":")
    kind = kind if colon else "crackstats"
    if kind not in stages.MADE:
        refuse(65, f"{where}: {kind}: no such artifact{nearest(kind, stages.MADE)}")
    name = said.get("name", path.strip("/").replace("/", ".").replace(" ", "."))
    words = name if "name" in said else name.removeprefix("summary.").replace("_", " ")
    return Measure(kind, path, name, said.get("title", words), said.get("unit", ""), said.get("scale", 1))


# ---- the whole --------------------------------------------------------------------------

def read_file(path):
    """What the file of a study says, with a table of runs in its place."""
    if not os.path.isfile(path):
        refuse(66, f"{path}: no such file")
    if path.endswith((".tsv", ".txt")):
        return {"runs": os.path.basename(path)}
    try:
        said = document(path)
    except ValueError as error:
        refuse(65, f"{path}: is not JSON: {error}; a table of runs ends in .tsv")
    problem = wrong(said, document(f"{TREE}/schemas/study.json"))
    if problem:
        refuse(65, f"{path}: {problem.lstrip(': ')}")
    if "axes" in said and "runs" in said:
        refuse(65, f"{path}: has axes beside runs")
    if "packings" in said and "runs" in said:
        refuse(65, f"{path}: has packings beside runs: a column import has the grains of each")
    return said


def check_counts(said, path, most):
    """Numbers of values and seeds, made integers (JSON also writes 5.0); ends before lists of too many are made."""
    seeds = said.get("seeds")
    held = [(axis, "count", f"axes[{k}].count") for k, axis in enumerate(said.get("axes", []))]
    held += [(seeds, "count", "seeds.count") if isinstance(seeds, dict) else (said, "seeds", "seeds")]
    for holder, key, where in held:
        if not isinstance(holder.get(key), (int, float)):
            continue
        holder[key] = int(holder[key])
        if holder[key] > most:
            refuse(65, f"{path}: {where}: {holder[key]} are more than {most} runs: fewer, or MOST_RUNS={holder[key]}")


def count_first(said, axes, seeds, packings, path, most):
    """Ends where there are more runs than anyone means."""
    for k, choice in enumerate(said.get("only", [])):
        check_choice(choice, axes, f"{path}: only[{k}]")
    each = len(seeds) * len(packings)
    runs = sum(math.prod(map(len, places)) for places in choices(said, axes)) * each
    if runs > most:
        shape = "by only" if "only" in said else " x ".join([f"{len(axis.values)} {axis.name}" for axis in axes] + [f"{each} a point"])
        refuse(65, f"{path}: {runs} runs ({shape}), more than {most}: fewer values, or MOST_RUNS={runs}")


def table_runs(said, path, seeds, keys, scene, made):
    """Axes, points and runs of a table."""
    table = located(said["runs"], path)
    axes, points, rows = table_points(table, lambda key: key.endswith(".seed"))
    common, runs = said.get("import") and located(said["import"], path), []
    for number, (point, values, row) in enumerate(rows, 1):
        sets = {key: value for key, value in row.items() if key not in SPECIAL}
        of_row = row.get("scene", scene)
        if not of_row:
            refuse(65, f"{table}: row {number}: no scene: a column scene, or SCENE=")
        grains = row.get("import", common)
        here = keys or (drawn_key(lambda stage: of_row, sets, grains, path, made) if seeds != [None] else [])
        for seed in seeds:
            own = next((v for k, v in sets.items() if k.endswith(".seed")), None) if seed is None else seed
            mine = {**said.get("set", {}), **sets, **{k: seed for k in here}}
            twin = tuple(sorted((k, str(v)) for k, v in mine.items() if k.endswith(".seed")))
            runs.append(Run(len(runs) + 1, point, values, own, grains, mine, twin, of_row, str(row.get("run", ""))))
    return axes, points, runs


def axes_runs(said, path, seeds, keys, scene, made, most):
    """Axes, points and runs of crossed axes."""
    axes = [read_axis(axis, f"{path}: axes[{k}]") for k, axis in enumerate(said.get("axes", []))]
    for k, axis in enumerate(axes):
        if axis.name in [a.name for a in axes[:k]]:
            refuse(65, f"{path}: axes[{k}]: {axis.name}: another axis has this name")
    packings = [located(each, path) for each in said.get("packings", [])] or [said.get("import") and located(said["import"], path)]
    count_first(said, axes, seeds, packings, path, most)
    points, runs = crossed(said, axes), []
    for number, (values, sets) in enumerate(points):
        sets = {**said.get("set", {}), **sets}
        of_point = sets.pop("scene", scene) or refuse(65, f"{path}: has no scene")
        scene_of = lambda stage: of_point.get(stage, of_point.get("conditions")) if isinstance(of_point, dict) else of_point
        if not keys and seeds != [None]:
            keys = drawn_key(lambda s: scene_of(s) or next(iter(of_point.values())), sets, sets.get("import", packings[0]), path, made)
        for grains, seed in itertools.product(packings, seeds):
            mine = {**sets, **({key: seed for key in keys} if seed is not None else {})}
            runs.append(Run(len(runs) + 1, number, values, seed, mine.pop("import", grains), mine, (seed, grains), of_point))
    return axes, [values for values, _ in points], runs, keys


def take_grains(said, path, grains):
    """Puts the file GRAINS in place of those that a study names, which it may not vary then."""
    if not os.path.isfile(grains):
        refuse(66, f"{grains}: no such file")
    varied = [key for axis in said.get("axes", []) for key in (axis.get("key"), *axis.get("keys", []), *axis.get("zip", {}))]
    varied += read_table(located(said["runs"], path))[0] if "runs" in said else []
    if "packings" in said or "import" in varied:
        refuse(65, f"{path}: has grains of its own for several runs: --import (IMPORT) gives all the same")
    said["import"] = os.path.realpath(grains)


def read_study(path, seeds=None, scene=None, sets=(), most=MOST_RUNS, grains=None):
    """The study of the file PATH; SEEDS, SCENE, SETS (pairs) and GRAINS take the place of its own."""
    said = read_file(path)
    if grains:
        take_grains(said, path, grains)
    check_counts(said, path, most)
    said["set"] = {**said.get("set", {}), **dict(sets)}
    for key, value in said["set"].items():
        check_key(key, f"{path}: set")
        said["set"][key] = check_value(key, value, f"{path}: set")
    own = scene or said.get("scene")
    if isinstance(own, dict):
        for stage in own:
            if stage not in stages.STAGES:
                refuse(65, f"{path}: scene.{stage}: no such stage{nearest(stage, stages.STAGES)}")
        own = {stage: located(each, path) for stage, each in own.items()}
    elif own:
        own = located(own, path)
    measures = [read_measure(each, f"{path}: measure[{k}]") for k, each in enumerate(said.get("measure", CRACKS))]
    values, given = seeds_of(said, seeds, path)
    # One seed tells no runs apart: then it may be of what no stage of the study draws.
    made = {stages.MADE[kind][0] for kind in kinds_wanted(Study(path, "", said, [], [], [], measures))} \
        if len(values) > 1 else set(stages.STAGES)
    keys = []
    if "runs" in said:
        axes, points, runs = table_runs(said, path, values, given, own, made)
    else:
        axes, points, runs, keys = axes_runs(said, path, values, given, own, made, most)
    if len(runs) > most:
        refuse(65, f"{path}: {len(runs)} runs, more than {most}: fewer values, or MOST_RUNS={len(runs)}")
    for key in keys:
        for run in runs:
            check_value(key, run.seed, f"{path}: seeds")
    for k, each in enumerate(said.get("compare", [])):
        check_choice({each["axis"]: [each["with"], *([] if "of" not in each else each["of"] if isinstance(each["of"], list) else [each["of"]])]}, axes, f"{path}: compare[{k}]")
    for k, each in enumerate(said.get("reference", [])):
        check_choice(each.get("at", {}), axes, f"{path}: reference[{k}].at")
        if each["measure"] not in [m.name for m in measures]:
            refuse(65, f"{path}: reference[{k}].measure: {each['measure']}: is not measured")
    name = os.path.basename(path).rsplit(".", 1)[0]
    return Study(os.path.realpath(path), name, said, axes, points, runs, measures, keys)
