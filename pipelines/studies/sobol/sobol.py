# SPDX-License-Identifier: GPL-3.0-or-later
"""Sobol indices by the estimators of Saltelli et al. (2010), Table 2 (b and f): first order
S_i = <f_B (f_ABi - f_A)> / V, total T_i = <(f_A - f_ABi)^2> / 2V, with A and B two samples and ABi
A with column i of B."""
import numpy as np


def sample(count, dimensions, seed=1):
    """Points of the unit cube, (count, dimensions + 2, dimensions): of each A, B and the ABi."""
    chance = np.random.default_rng(seed)
    both = [(np.column_stack([chance.permutation(count) for _ in range(dimensions)]) + chance.random((count, dimensions))) / count
            for _ in range(2)]
    mixed = np.repeat(both[0][:, None], dimensions, axis=1)
    for i in range(dimensions):
        mixed[:, i, i] = both[1][:, i]
    return np.concatenate([both[0][:, None], both[1][:, None], mixed], axis=1)


def estimates(f):
    """S and T, (2, dimensions), of values F (count, dimensions + 2)."""
    a, b, mixed = f[:, :1], f[:, 1:2] - f[:, :2].mean(), f[:, 2:]  # b less the mean scatters less
    variance = np.var(f[:, :2])
    return np.array([np.mean(b * (mixed - a), axis=0) / variance, np.mean((a - mixed)**2, axis=0) / (2 * variance)])


def intervals(f, draws=1000, seed=1):
    """Their 95 % intervals by the bootstrap, (2 ends, 2, dimensions)."""
    chance = np.random.default_rng(seed)
    return np.percentile([estimates(f[chance.integers(len(f), size=len(f))]) for _ in range(draws)], [2.5, 97.5], axis=0)
