# SPDX-License-Identifier: GPL-3.0-or-later
"""The liquid in throats and rings of a drying, added up from its datasets."""
import numpy as np


def replayed(file, n, group, what):
    """What is in each of N throats, or nodes' rings, at each step."""
    row, state = np.ones(n), []
    offset, index, value = (file[f"{group}/{name}"][:] for name in ("offset", what, "saturation"))
    for begin, end in zip(offset, offset[1:]):
        row[index[begin:end]] = value[begin:end]
        state.append(row.copy())
    return np.array(state)


def stores(file):
    """Of throats (n): their volume, and what they leave in rings. At each step: saturations of throats, of the
    rings at nodes, and what is left in rings of each throat's part."""
    volume, ends = file["throats/volume"][:], file["throats/nodes"][:]
    throats = replayed(file, len(volume), "changes", "throat")
    nodes = replayed(file, len(file["nodes/kind"]), "ring_changes", "node")
    left = np.bincount(file["rings/throat"][:], file["rings/volume"][:], len(volume))
    return volume, left, throats, nodes, nodes[:, ends].mean(axis=2) * left
