# SPDX-License-Identifier: GPL-3.0-or-later
"""What a study takes, by what was measured of its artifacts so far: seconds of each stage and bytes."""
import os

import rules
from counts import three


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


def estimate(plan, stale, folder):
    """Seconds of one core and bytes that the STALE artifacts take; None where one of their kind was never
    made."""
    known, large = times(folder), sizes(plan, folder)
    labels = [rules.label(plan, path) for path in stale]
    kinds = [plan.artifacts[path].kind for path in stale]
    if any(label not in known for label in labels) or any(kind not in large for kind in kinds):
        return None
    return sum(known[label] for label in labels), sum(large[kind] for kind in kinds)


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
