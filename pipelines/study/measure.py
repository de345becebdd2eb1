# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers out of artifacts: [ARTIFACT:]PATH as study.json has them."""
import fcntl
import json
import os
import re

from common import artifact

TAKEN = ("first", "last", "least", "largest", "mean")


def take(values, taken):
    """What is TAKEN of VALUES; None: there are none."""
    import numpy as np  # which most studies do without
    values = np.asarray(values)
    if not values.size:
        return None
    if taken in ("first", "last"):
        return values.flat[0 if taken == "first" else -1].item()
    return {"least": np.nanmin, "largest": np.nanmax, "mean": np.nanmean}[taken](values).item()


def of_json(document, path):
    """The member at PATH, names and numbers with points or slashes between, or after a blank what is
    taken of a list; None: there is none."""
    where, _, taken = path.partition(" ")
    for name in re.split(r"[./]", where.strip("/")):
        if isinstance(document, list) and re.fullmatch(r"-?\d+", name) and -len(document) <= int(name) < len(document):
            document = document[int(name)]
        elif isinstance(document, dict) and name in document:
            document = document[name]
        else:
            return None
    if taken not in TAKEN or not isinstance(document, list):
        return document
    return take([x for x in document if isinstance(x, (int, float))], taken)


def of_hdf5(file, path):
    """The attribute or dataset at PATH; after a dataset's a blank and what is taken of it."""
    where, _, taken = path.partition(" ")
    where = where.strip("/").replace(".", "/")
    group, _, name = where.rpartition("/")
    if (group or "/") in file and name in file[group or "/"].attrs:
        return file[group or "/"].attrs[name].item()
    if where not in file or not hasattr(file[where], "shape"):
        return None
    if taken not in TAKEN and file[where].size != 1:
        return None
    return take(file[where][()], taken if taken in TAKEN else "first")


def number(value):
    """VALUE as a number, None where it is none."""
    if isinstance(value, bool):
        return float(value)
    return float(value) if isinstance(value, (int, float)) and value == value else None


def measured(path, measures):
    """The values of MEASURES, all of one kind, in the artifact at PATH; what it does not have is None."""
    if path.endswith(".json"):
        with open(path, encoding="utf-8") as file:
            document = json.load(file)
        each = document.get("each", [{}])[0]
        take = lambda measure: next((v for v in (of_json(each, measure.path), of_json(document, measure.path)) if v is not None), None)
        found = [number(take(measure)) for measure in measures]
    else:
        with artifact(path) as file:
            found = [number(of_hdf5(file, measure.path)) for measure in measures]
    return [None if value is None else value * measure.scale for value, measure in zip(found, measures)]


def being_made(path):
    """Whether another makes the file at PATH, and so holds the lock of its key (tools/memo)."""
    try:
        with open(f"{path}.key", "rb") as key:
            fcntl.flock(key, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:  # no key, or a file system without locks
        pass
    return False


def why(folder, path):
    """What the stage said that failed to make PATH; "" where nothing did."""
    note = os.path.join(folder, f"{path}.said")
    if not os.path.exists(note) or being_made(os.path.join(folder, path)):
        return ""
    with open(note, encoding="utf-8", errors="replace") as file:
        lines = [line.strip() for line in file if line.strip()]
    return lines[-1] if lines else "was interrupted"
