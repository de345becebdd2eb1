# SPDX-License-Identifier: GPL-3.0-or-later
"""A split-bottom cell made from closed forms, as a motion: no grain was ever moved.

Grains stand anywhere in a ring and turn as [G 13] wants, with centre and width linear in the
height. Contacts carry a stress whose pressure is that of a weight and whose shear stress is
friction times pressure plus cohesion; bridges pull less and less over a tenth of a diameter.
"""
import math

import numpy as np

from motions import Contacts, write_motion

INNER, OUTER, HEIGHT, RADIUS, RATE = 0.04, 0.20, 0.06, 0.001, 0.0628
CENTRE, WIDTH = (0.150, 0.138), (0.006, 0.012)  # m, at the bottom and at the top
FRICTION, COHESION, TORQUE, PULL = 0.13, 1.3, 0.05, 1e-4
WEIGHT = 900.0  # Pa m-1


def centre(z):
    return CENTRE[0] + (CENTRE[1] - CENTRE[0]) * z / HEIGHT


def width(z):
    return WIDTH[0] + (WIDTH[1] - WIDTH[0]) * z / HEIGHT


def turned(r, z):
    return 0.5 + 0.5 * np.vectorize(math.erf)((r - centre(z)) / width(z))


def ring(rng, n):
    """Places and local directions of N points that fill the ring evenly."""
    r = np.sqrt(rng.uniform(INNER ** 2, OUTER ** 2, n))
    angle, z = rng.uniform(0, 2 * np.pi, n), rng.uniform(0, HEIGHT, n)
    out = np.stack([np.cos(angle), np.sin(angle), 0 * angle], 1)
    along = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], 1)
    return r, z, out, along, r[:, None] * out + np.stack([0 * z, 0 * z, z], 1)


def stressed(z, out, along, volume):
    """Three contacts about each point, one along each local direction: (3, n, 3) directions and
    forces, whose products times the diameter are the stress of VOLUME."""
    up = np.zeros_like(out) + [0, 0, 1.0]
    pressure = (WEIGHT * (HEIGHT - z) + 5)[:, None]
    shear = FRICTION * pressure + COHESION
    force = [pressure * out + shear * along, pressure * along + shear * out, pressure * up]
    return np.array([out, along, up]), np.array(force) * volume / (2 * RADIUS)


def make(path, seed, n=6000, snapshots=6, noise=0.02, rate=RATE, inner=False, spread=1.0):
    """N grains, and for each contact two ends without weight. From run to run the band moves by
    SPREAD mm (standard deviation); NOISE is that of the share of the rate, grain by grain."""
    rng = np.random.default_rng(seed)
    shift, d = 1e-3 * spread * rng.normal(), 2 * RADIUS
    volume = np.pi * (OUTER ** 2 - INNER ** 2) * HEIGHT / n
    places, speeds, contacts = [], [], []
    for _ in range(snapshots):
        r, z, out, along, x = ring(rng, n)
        share = turned(r - shift, z)
        share = (1 - share if inner else share) + noise * rng.normal(size=n)
        branch, force = (a.reshape(-1, 3) for a in stressed(z, out, along, volume))
        middle = np.tile(x, (3, 1))
        places.append(np.concatenate([x, middle - RADIUS * branch, middle + RADIUS * branch]))
        speeds.append(np.concatenate([(rate * share * r)[:, None] * along, np.zeros((6 * n, 3))]))
        pair = n + np.stack([np.arange(3 * n), np.arange(3 * n, 6 * n)], 1)
        gap = rng.uniform(-0.02, 0.1, 3 * n) * d
        pull = np.where(gap > 0, PULL * (1 - gap / (0.1 * d)), 0.0)
        contacts.append(Contacts(pair, force, middle, -gap, 1e-12 * (gap > 0), pull))
    mass = np.concatenate([np.full(n, 1e-5), np.full(6 * n, 1e-30)])
    radius = np.concatenate([np.full(n, (0.6 * volume * 3 / 4 / np.pi) ** (1 / 3)),
                             np.full(6 * n, 1e-9)])
    rows = 40
    moment = np.zeros((rows, 2, 3))
    moment[:, 1, 2] = -np.sign(rate) * TORQUE * (1 + 0.1 * np.sin(2 * np.pi * np.arange(rows) / 10))
    return write_motion(path, places, speeds, radius, mass, contacts,
                        lower=(-1, -1, -1), upper=(1, 1, 1), walls=[(0, 0, 0), (0, 0, 0)],
                        history={"time": np.linspace(0, snapshots, rows), "wall_moment": moment},
                        scene={"walls": {"floor": {}, "outer": {}}})
