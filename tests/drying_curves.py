# SPDX-License-Identifier: GPL-3.0-or-later
"""How far two dryings of one network are apart: each a dict with the arrays saturation and time."""
import numpy as np

LEVELS = np.linspace(0.95, 0.05, 19)


def times_of(drying):
    """When the saturation falls to each of LEVELS."""
    return np.interp(LEVELS, drying["saturation"][::-1], drying["time"][::-1])


def farthest(drying, other):
    """The largest difference of these times, over the time in which OTHER dries."""
    return np.abs(times_of(drying) - times_of(other)).max() / other["time"][-1]
