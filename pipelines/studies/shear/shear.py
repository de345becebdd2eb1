# SPDX-License-Identifier: GPL-3.0-or-later
"""What the pictures and the table of a split-bottom cell share: artifacts of shearstats by title,
and the centre of the band by Unger et al. (2004, Phys. Rev. Lett. 92, 214301)."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.realpath(f"{__file__}/../../../lib"))
from common import artifact, refuse, titled


def cases(words, needs=None):
    """The artifacts of the words TITLE=FILE, by title, and (split radius, depth) in metres of a word
    unger=RADIUS,DEPTH, or None. NEEDS is a dataset that each must have."""
    found, unger = {}, None
    for word in words:
        title, path = titled(word)
        if title == "unger":
            try:
                unger = tuple(float(x) for x in path.split(","))
                assert len(unger) == 2 and 0 < unger[1] < unger[0]
            except (ValueError, AssertionError):
                refuse(64, f"{word}: must be unger=SPLIT_RADIUS,DEPTH with a depth below the radius")
            continue
        file = artifact(path, "shearstats")
        if needs and needs not in file:
            refuse(65, f"{path}: has no {needs}: make it with shearstats.cell.rate")
        found[title or os.path.basename(path)] = file
    if not found:
        refuse(64, "no artifact of shearstats was named")
    return found, unger


def unger_centre(height, split, depth):
    """Where the band's centre r is at HEIGHT, by bisection of
    depth - height = r (1 - split/r (1 - (depth/split)^(5/2)))^(2/5)."""
    top = split * (1 - (depth / split) ** 2.5)
    lower, upper = np.full_like(height, top), np.full_like(height, split)
    for _ in range(60):
        r = 0.5 * (lower + upper)
        above = r * np.maximum(1 - top / r, 0) ** 0.4 > depth - height  # too far out
        lower, upper = np.where(above, lower, r), np.where(above, r, upper)
    return 0.5 * (lower + upper)


def levels(file):
    """Heights, centres and widths with half their intervals, where all runs have a fit; m."""
    every = file["levels/fitted"][:].all(axis=0)
    return [file[f"levels/{name}"][:][every]
            for name in ("height", "centre", "centre_half_width", "width", "width_half_width")]
