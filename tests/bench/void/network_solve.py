# SPDX-License-Identifier: GPL-3.0-or-later
"""What a network of conductances conducts along each axis of its box."""
import numpy as np

SHORT = 1e-6  # of the mean grain radius: throats no longer are no resistance


def united(network, short):
    """The number of each node, the same for nodes that short throats join."""
    root = np.arange(len(network.node))

    def find(a):
        while root[a] != a:
            root[a] = root[root[a]]
            a = root[a]
        return a
    for a, b in network.ends[short]:
        root[find(b)] = find(a)
    _, number = np.unique([find(a) for a in range(len(root))], return_inverse=True)
    return number


class Balance:
    """sum over the throats of a node of g (difference of potential) = 0."""

    def __init__(self, network, g):
        short = network.length <= SHORT * network.radius.mean()
        number = united(network, short)
        self.n = number.max() + 1
        self.first, self.second = number[network.ends].T
        self.g = np.where(short | ~np.isfinite(g), 0, g)
        self.network, self.number = network, number
        sums = np.bincount(self.first, self.g, self.n) + np.bincount(self.second, self.g,
                                                                     self.n)
        self.inverse = np.where(sums > 0, 1 / np.where(sums > 0, sums, 1), 0)

    def out(self, flux):
        return np.bincount(self.first, -flux, self.n) + np.bincount(self.second, flux, self.n)

    def flow(self, axis, tolerance=1e-10):
        """Fluxes of the throats, first node to second against the gradient, for a mean
        gradient of 1 along AXIS; and the conductivity."""
        drop = self.network.way[:, axis]
        free = np.ones(self.n, bool)
        if not self.network.periodic[axis]:
            walls = (self.network.kind >> (2 * axis)) & 3
            free[self.number[walls > 0]] = False
        residual = np.where(free, -self.out(self.g * drop), 0)
        x, p, rz = np.zeros(self.n), np.zeros(self.n), 1
        size = np.linalg.norm(np.bincount(self.first, self.g * abs(drop), self.n))
        while np.linalg.norm(residual) > tolerance * size:
            z = self.inverse * residual
            rz, last = residual @ z, rz
            p = z + rz / last * p
            ap = np.where(free, self.out(self.g * (p[self.second] - p[self.first])), 0)
            alpha = rz / (p @ ap)
            x += alpha * p
            residual -= alpha * ap
        total = drop + x[self.second] - x[self.first]
        return self.g * total, (self.g * total ** 2).sum()
