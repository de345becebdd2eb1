# SPDX-License-Identifier: GPL-3.0-or-later
"""What pictures and tables say of a drying, an open artifact."""
import numpy as np

from common import summary


def rates(drying):
    """Rows of saturation and rate, of the first."""
    return np.column_stack([drying["history/saturation"][:], drying["history/normalised_rate"][:]])


def thin(rows, step):
    """Of rows with a falling first column, those that are more than STEP below the last."""
    kept = []
    for row in rows:
        if not kept or kept[-1][0] - row[0] > step:
            kept.append(row)
    return kept


def rate_at(drying, level):
    """The last rate at a saturation of LEVEL or more; None where it began below that."""
    rows = rates(drying)
    above = rows[rows[:, 0] >= level]
    return above[-1, 1] if len(above) else None


def breakthrough(drying):
    """The saturation at which gas reached the bottom."""
    return summary(drying)["breakthrough_saturation"]


def profile(drying):
    """Rows of depth and the saturation there in each snapshot."""
    return np.column_stack([drying["profiles/depth"][:], drying["profiles/slice_saturation"][:].T])


def wet_throats(drying):
    """For each of the first four snapshots its throats with liquid: an end, what leads to the other,
    along x and z in micrometres, and the saturation."""
    first, last = (1e6 * drying["nodes/position"][:][ends][:, [0, 2]] for ends in drying["throats/nodes"][:].T)
    rows = np.column_stack([first, last - first])
    for saturation in drying["snapshots/throat_saturation"][:4]:
        yield np.column_stack([rows, saturation])[saturation > 0]
