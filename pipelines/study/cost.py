# SPDX-License-Identifier: GPL-3.0-or-later
"""What a study takes: seconds of each stage, bytes and memory, as measured of its artifacts so far, else as
the stages foresee it (--estimate)."""
import functools
import json
import math
import os
import subprocess
from dataclasses import dataclass, field

import rules
import stages
from counts import three
from plan import Artifact

MOST_ASKED = 20  # artifacts of a kind that are asked for; others are taken for like them
INSTANT = {"check", "crackstats"}  # that take no longer than a program takes to start
RESULT_BYTES = 2.5e4  # which these write


def times(folder):
    """Mean seconds by label of the artifacts made so far."""
    sums = {}
    try:
        with open(os.path.join(folder, ".study/times"), encoding="utf-8") as file:
            for line in file:
                words = line.split()
                if len(words) == 5:
                    total, n = sums.get(words[0], (0, 0))
                    sums[words[0]] = total + float(words[2]) - float(words[1]), n + 1
    except OSError:
        pass
    return {label: total / n for label, (total, n) in sums.items()}


def memory(folder):
    """MiB of the largest program so far; 0: none was measured."""
    try:
        with open(os.path.join(folder, ".study/times"), encoding="utf-8") as file:
            return max((float(line.split()[4]) for line in file if len(line.split()) == 5), default=0) / 1024
    except (OSError, ValueError):
        return 0


def sizes(plan, folder):
    """Mean bytes by kind of the artifacts that are there."""
    sums = {}
    for path, artifact in plan.artifacts.items():
        try:
            size = os.path.getsize(os.path.join(folder, path))
        except OSError:
            continue
        total, n = sums.get(artifact.kind, (0, 0))
        sums[artifact.kind] = total + size, n + 1
    return {kind: total / n for kind, (total, n) in sums.items()}


# ---- what stages foresee ------------------------------------------------------------------

@functools.cache
def asked(stage, scene, sets, sizes, grains):
    """What a STAGE says that it will take (--estimate), of SIZES or of the file GRAINS; None: it does not
    say, or another program is in its place."""
    if stages.own_program(stage):
        return None
    words = [f"--estimate={sizes}" if sizes else "--estimate", "-p", scene, *(w for item in sets for w in ("--set", item)), *grains]
    said = subprocess.run([stages.program(stage), *words], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    return None if said.returncode else json.loads(said.stdout)


def foreseen(artifact):
    """What making ARTIFACT takes, foreseen from the scene: sizes go from stage to stage as artifacts do."""
    made = [each for each in artifact.inputs if isinstance(each, Artifact)]
    before = foreseen(made[0]) if made else {}
    if before is None:
        return None
    sizes = ",".join(f"{before.get(key, 0):.12g}" for key in ("grains", "loads", "throats")) if before else ""
    return asked(artifact.stage(), artifact.scene, artifact.sets, sizes, () if made else artifact.inputs)


def some_of(paths):
    return paths[::math.ceil(len(paths) / MOST_ASKED)]


def foreseen_bytes(artifact):
    """What ARTIFACT takes on disk; None: its stage does not say."""
    if artifact.stage() in INSTANT:
        return RESULT_BYTES
    said = foreseen(artifact)
    return said["disk_mebibytes"] * 2**20 if said else None


def bytes_of(plan, stale, large):
    """Of all STALE artifacts: of a kind in LARGE as there, of others as foreseen; None: not known."""
    of_kind, total = {}, 0
    for path in stale:
        of_kind.setdefault(plan.artifacts[path].kind, []).append(path)
    for kind, paths in of_kind.items():
        each = [large[kind]] if kind in large else [foreseen_bytes(plan.artifacts[path]) for path in some_of(paths)]
        if None in each:
            return None
        total += len(paths) * sum(each) / len(each)
    return total


def foresee(plan, paths):
    """Mean seconds, least and most, MiB of the PATHS, of which some are asked; and stages that do not say."""
    some = some_of(paths)
    parts = [(part, foreseen(part)) for path in some for part in plan.parts[path]]
    said = [each for _, each in parts if each]
    seconds = [sum(each["seconds"] for each in said), *(sum(each.get("range", [each["seconds"]] * 2)[k] for each in said) for k in (0, 1))]
    silent = {part.stage() for part, each in parts if not each} - INSTANT
    return [x / len(some) for x in seconds], max((each["mebibytes"] for each in said), default=0), silent


@dataclass
class Estimate:
    """Of one core: SECONDS, from LEAST to MOST; BYTES of disk, None: not known; MiB of the largest program.
    SILENT stages are left out."""
    seconds: float = 0
    least: float = 0
    most: float = 0
    bytes: object = 0
    mebibytes: float = 0
    silent: set = field(default_factory=set)
    measured: bool = True


def estimate(plan, stale, folder):
    """What the STALE artifacts take: by what was measured of their stages in this study, else as these foresee."""
    known, large = times(folder), sizes(plan, folder)
    total, of_label = Estimate(mebibytes=memory(folder)), {}
    for path in stale:
        of_label.setdefault(rules.label(plan, path), []).append(path)
    for label, paths in of_label.items():
        if label in known:
            each = [known[label]] * 3
        else:
            each, mebibytes, silent = foresee(plan, paths)
            total.measured = False
            total.mebibytes = max(total.mebibytes, mebibytes)
            total.silent |= silent
        total.seconds, total.least, total.most = (sum_ + len(paths) * x for sum_, x in
                                                  zip((total.seconds, total.least, total.most), each))
    total.bytes = bytes_of(plan, stale, large)
    return total


def words(expected):
    """For people."""
    text = f"about {duration(expected.seconds)} of one core"
    if expected.most > 1.01 * expected.least:
        text += f" ({duration(expected.least)} to {duration(expected.most)})"
    if not expected.measured:
        text += ", as stages foresee it"
    if expected.silent:
        text += f", without {', '.join(sorted(expected.silent))}"
    return text


def duration(seconds):
    for unit, length in (("days", 86400), ("h", 3600), ("min", 60)):
        if seconds >= 2 * length:
            return f"{three(seconds / length)} {unit}"
    return f"{three(seconds)} s"


def volume(bytes_):
    for unit, size in (("TB", 1e12), ("GB", 1e9), ("MB", 1e6)):
        if bytes_ >= size:
            return f"{three(bytes_ / size)} {unit}"
    return f"{three(bytes_ / 1e3)} kB"
