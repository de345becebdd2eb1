# SPDX-License-Identifier: GPL-3.0-or-later
"""What the pictures and the table of a split-bottom cell share: artifacts of shearstats by title,
and the centre of the band by Unger et al. (2004, Phys. Rev. Lett. 92, 214301)."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.realpath(f"{__file__}/../../../lib"))
from common import artifact, refuse, titled


def cases(words, needs=None):
    """The artifacts of the words TITLE=FILE, by title, and the split radius in metres of a word
    unger=SPLIT_RADIUS, or None. NEEDS is a dataset that each must have."""
    found, unger = {}, None
    for word in words:
        title, path = titled(word)
        if title == "unger":
            try:
                unger = float(path)
                assert unger > 0
            except (ValueError, AssertionError):
                refuse(64, f"{word}: must be unger=SPLIT_RADIUS, in metres")
            continue
        file = artifact(path, "shearstats")
        if needs and needs not in file:
            refuse(65, f"{path}: has no {needs}: make it with shearstats.cell.rate")
        found[title or os.path.basename(path)] = file
    if not found:
        refuse(64, "no artifact of shearstats was named")
    return found, unger


def depth_of(file):
    """Where the volume fraction falls to half its median, in the middle of the ring; walls are glued."""
    centre, volume = file["grid/centre"][:], file["grid/volume"][:]
    filled = volume * file["fields/volume_fraction"][:]
    inner, outer = np.quantile(centre[:, 0], (0.2, 0.8))
    heights = np.unique(centre[:, 2])
    share = np.array([filled[there].sum() / volume[there].sum() for z in heights
                      for there in [(centre[:, 2] == z) & (centre[:, 0] > inner) & (centre[:, 0] < outer)]])
    half = 0.5 * np.median(share[share > 0.5 * share.max()])
    k = np.flatnonzero(share > half)[-1]
    return np.interp(half, share[[k + 1, k]], heights[[k + 1, k]])


def unger_centre(height, split, depth):
    """Where the band's centre r is at HEIGHT, by bisection of
    depth - height = r (1 - split/r (1 - (depth/split)^(5/2)))^(2/5).
    NaN above the bed, and where it is so deep that the band does not reach its top."""
    if not depth < split:
        return np.full_like(height, np.nan)
    top = split * (1 - (depth / split) ** 2.5)
    lower, upper = np.full_like(height, top), np.full_like(height, split)
    for _ in range(60):
        r = 0.5 * (lower + upper)
        above = r * np.maximum(1 - top / r, 0) ** 0.4 > depth - height  # too far out
        lower, upper = np.where(above, lower, r), np.where(above, r, upper)
    return np.where(height <= depth, 0.5 * (lower + upper), np.nan)


def levels(file):
    """Heights, centres and widths with half their intervals, where all runs have a fit; m."""
    every = file["levels/fitted"][:].all(axis=0)
    return [file[f"levels/{name}"][:][every]
            for name in ("height", "centre", "centre_half_width", "width", "width_half_width")]
