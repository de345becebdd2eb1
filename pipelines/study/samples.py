# SPDX-License-Identifier: GPL-3.0-or-later
"""The statistics of stages/lib/statistics, called from Python: intervals, and whether two groups of
values differ."""
import ctypes
import os

from common import BIN, refuse

double = ctypes.c_double


class Sample(ctypes.Structure):
    _fields_ = [("value", ctypes.POINTER(double)), ("n", ctypes.c_int)]


def numbers(*names):
    """A struct of doubles with these NAMES."""
    return type("Numbers", (ctypes.Structure,), {"_fields_": [(name, double) for name in names]})


def tested(*names):
    """The struct of a test: doubles, and whether it is exact."""
    return type("Tested", (ctypes.Structure,), {"_fields_": [*((n, double) for n in names), ("exact", ctypes.c_bool)]})


RESULTS = {"sample_mean": double, "sample_deviation": double, "half_width": double,
           "welch_test": numbers("t", "degrees", "p"), "mann_whitney_test": tested("u", "p"),
           "paired_t_test": numbers("mean", "sd", "t", "degrees", "p"), "wilcoxon_test": tested("v", "p")}


def load():
    """The library that `make all` builds, with the types of what its functions give."""
    for folder in ("../lib", "../../lib/craquelure"): # in the tree; installed
        path = os.path.join(BIN, folder, "samples.so")
        if os.path.exists(path):
            library = ctypes.CDLL(path)
            for name, result in RESULTS.items():
                getattr(library, name).restype = result
            return library
    return refuse(70, f"{BIN}/../lib/samples.so: is not there: make all")


LIBRARY = None


def call(name, *samples, confidence=None):
    """Function NAME of lists of numbers."""
    global LIBRARY
    LIBRARY = LIBRARY or load()
    given = [Sample((double * len(s))(*s), len(s)) for s in samples]
    return getattr(LIBRARY, name)(*given, *([] if confidence is None else [double(confidence)]))


def described(values, confidence=0.95):
    """Number, mean, standard deviation, the interval of the mean by Student's t, least and largest; None
    where there are too few."""
    known = lambda x: None if x != x else x
    if not values:
        return {"runs": 0} | dict.fromkeys(["mean", "sd", "low", "high", "least", "largest"])
    mean, half = call("sample_mean", values), call("half_width", values, confidence=confidence)
    return {"runs": len(values), "mean": mean, "sd": known(call("sample_deviation", values)),
            "low": known(mean - half), "high": known(mean + half), "least": min(values), "largest": max(values)}


def compared(one, other, paired):
    """Whether ONE and OTHER differ: as groups, or where their values belong together, by their
    differences."""
    known = lambda x: None if x != x else x
    if min(len(one), len(other)) < 2:
        return None
    if paired:
        t, ranks = call("paired_t_test", other, one), call("wilcoxon_test", other, one)
        return {"difference": known(t.mean), "sd": known(t.sd), "student_p": known(t.p), "wilcoxon_p": known(ranks.p)}
    t, ranks = call("welch_test", other, one), call("mann_whitney_test", other, one)
    difference = call("sample_mean", other) - call("sample_mean", one)
    return {"difference": difference, "welch_p": known(t.p), "mann_whitney_p": known(ranks.p)}
