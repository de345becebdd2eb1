# SPDX-License-Identifier: GPL-3.0-or-later
"""What the runs of a study are made of: artifacts, each named by what it is made from, so that runs
share what they have in common."""
import functools
import hashlib
import json
import os
import shlex
from dataclasses import dataclass

import stages
from common import LIBRARY

TREE = os.path.realpath(f"{LIBRARY}/../..")


@dataclass(eq=False)
class Artifact:
    """A kind of artifact, in file `path` of the folder of the study: made by its stage from `inputs`
    (artifacts, or names of files) with scene and overrides. One that is folded into another is made
    with it and does not stay."""
    kind: str
    path: str
    scene: str
    sets: tuple
    inputs: tuple
    folded: object = None

    def stage(self):
        return stages.MADE[self.kind][0]


def before(kind, liquid):
    """The kinds that KIND is made from, it last."""
    return [*dict.fromkeys(k for each in stages.made_from(kind, liquid) for k in before(each, liquid)), kind]


def kinds_wanted(study):
    """The kinds of artifacts that a study needs, in the order in which they are made."""
    ends = [m.kind for m in study.measures] + [k for r in study.said.get("reports", []) for k in r.get("takes", []) if k != "groups"]
    keep = study.said.get("keep", "all")
    ends += keep if keep != "all" else []
    ends += ["crackstats"] if study.said.get("groups") else []
    wanted = {kind for end in ends for kind in before(end, study.liquid)}
    return [kind for kind in stages.MADE if kind in wanted]


@functools.cache
def section_text(scene, stage):
    """The section of a STAGE of the file SCENE, and what it may take from conditions."""
    of = stages.sections(scene)
    return json.dumps([of.get(stage), of.get("conditions") if stage in stages.SHARING else None], sort_keys=True)


class Plan:
    """The artifacts of a study: `runs` has those of each run by kind, `artifacts` all, in the order in
    which they can be made."""

    def __init__(self, study):
        self.study, self.artifacts, self.runs = study, {}, []
        self.kinds = kinds_wanted(study)
        self.texts = {}
        for run in study.runs:
            self.runs.append(self.artifacts_of(run))
        self.groups = self.group_artifacts() if study.said.get("groups") else []
        self.fold()
        self.parts = self.find_parts()

    def add(self, kind, scene, sets, inputs):
        names = [each.path if isinstance(each, Artifact) else each for each in inputs]
        stage, _, end = stages.MADE[kind]
        own = stages.own_program(stage)
        text = json.dumps([section_text(scene, stage), sets, names, own])
        path = f"{kind}/{hashlib.sha256(text.encode()).hexdigest()[:16]}.{end}"
        if path not in self.artifacts:
            self.artifacts[path] = Artifact(kind, path, scene, sets, tuple(inputs))
        return self.artifacts[path]

    def artifacts_of(self, run):
        made = {}
        for kind in self.kinds:
            stage = stages.MADE[kind][0]
            scene = scene_of(run, stage)
            inputs = [made[source] for source in stages.made_from(kind, self.study.liquid)]
            if kind == "packing" and run.grains:
                inputs = [run.grains]
            made[kind] = self.add(kind, scene, stages.sets_of(stage, scene, run.overrides), inputs)
        return made

    def group_artifacts(self):
        """A crackstats of the runs of each point, in a file of its number."""
        groups = []
        for point in range(len(self.study.points)):
            mine = [(run, made) for run, made in zip(self.study.runs, self.runs) if run.point == point]
            inputs = tuple(made[kind] for _, made in mine for kind in stages.made_from("crackstats", self.study.liquid))
            run = mine[0][0]
            scene = scene_of(run, "crackstats")
            group = Artifact("crackstats", f"groups/{point + 1}.json", scene, stages.sets_of("crackstats", scene, run.overrides), inputs)
            groups.append(group)
            self.artifacts[group.path] = group
        return groups

    def fold(self):
        """What need not stay and goes into one artifact alone is made with that one."""
        keep = self.study.said.get("keep", "all")
        if keep == "all":
            return
        keep = {*keep, *(m.kind for m in self.study.measures), *(k for r in self.study.said.get("reports", []) for k in r.get("takes", []))}
        owners = {}
        for artifact in reversed(self.artifacts.values()):
            mine = owners.get(artifact.path, set())
            if artifact.kind not in keep and len(mine) == 1:
                artifact.folded = next(iter(mine))
            for each in artifact.inputs:
                if isinstance(each, Artifact):
                    owners.setdefault(each.path, set()).add(artifact.folded or artifact.path)

    def find_parts(self):
        """By the path of each kept artifact: those folded into it, it last."""
        parts = {}
        for artifact in self.artifacts.values():
            parts.setdefault(artifact.folded or artifact.path, []).append(artifact)
        return parts


def scene_of(run, stage):
    """The file that has the section of STAGE."""
    return run.scene.get(stage) or next(iter(run.scene.values())) if isinstance(run.scene, dict) else run.scene


# ---- what makes an artifact -------------------------------------------------------------

def place(folder, each):
    """The name of an input from FOLDER, where recipes work."""
    return each.path if isinstance(each, Artifact) else os.path.relpath(each, folder) if "\n" in each else each


@functools.cache
def version_of(stage):
    """Of the stage that comes with us; None: another program is in its place."""
    if stages.own_program(stage):
        return None
    return stages.ask(stage, "--version").split()[-1]


@functools.cache
def program_words(stage):
    return shlex.split(stages.program(stage))


def words_of(artifact, name, launcher, threads):
    """The command that makes ARTIFACT, by NAME of each file."""
    words = [*launcher, *program_words(artifact.stage()), "-p", artifact.scene]
    for item in artifact.sets:
        words += ["--set", item]
    if threads:
        words += ["--threads", threads]
    return [*words, *(name(each) for each in artifact.inputs), "-o", name(artifact)]


def recipe_of(parts, launcher, threads):
    """The words of tools/memo for the last of PARTS: what it is known by, and its command."""
    last = parts[-1]
    inner = {id(part) for part in parts[:-1]}
    outer = list(dict.fromkeys(each.path if isinstance(each, Artifact) else each for part in parts for each in part.inputs
                               if id(each) not in inner))
    key = [f"stage={last.stage()}"]
    if len(parts) == 1:
        key = [f"scene={last.scene}", *key]
    version = [version_of(part.stage()) for part in parts]
    key.append(f"version={' + '.join(version)}" if None not in version else
               f"program={stages.program(next(p for p, v in zip(parts, version) if v is None).stage())}")
    for part in parts:
        if len(parts) > 1:
            key.append(f"set={part.stage()} {section_text(part.scene, part.stage())}")
        key += [f"set={item}" for item in part.sets]
    key += [f"input={each}" for each in outer] + [f"output={last.path}"]
    if len(parts) == 1:
        return key, words_of(last, lambda each: each.path if isinstance(each, Artifact) else each, launcher, threads)
    # what is folded lies in a folder that memo makes and removes: @NAME
    short = lambda each: f"@{each.kind}.{each.path.rsplit('.', 1)[1]}" if id(each) in inner else \
        each.path if isinstance(each, Artifact) else each
    command = []
    for part in parts:
        command += [*words_of(part, short, launcher, threads), "--then"]
    return key, command[:-1]
