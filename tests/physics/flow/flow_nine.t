#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# [C]'s equations evaluated here once more, from nothing but their text, for a cube of eight
# spheres around a ninth [C Table 2, Figs. 10 and 12]. `flow` must agree to rounding; and so must
# nine_spheres.csv, to its printed digits, once no conductance is more than a hundred times that of
# the whole, as in Yade. On this lattice pores coincide, and such a limit parts them: it moves the
# table by 2e-4 of the permeability and up to 2e-3 of the force on a small centre sphere.
import csv
import itertools
import math
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, run, scratch

CORNERS = [np.array(x) for x in itertools.product((.25, .75), repeat=3)]
GRAINS = CORNERS + [np.full(3, .5)]
ALONG, SIDES = [2, 3], [0, 1, 4, 5]


def plane(wall):
    return wall // 2, float(wall % 2)


def normal(wall):
    return np.eye(3)[wall // 2] * (1 if wall % 2 else -1)


def depth(wall, at):
    axis, place = plane(wall)
    return abs(at[axis] - place)


def cells():
    """Corners of all cells: grains 0 to 8; ~0 to ~5 for walls. Each face of the cube of centres
    is halved along a diagonal, and joined to the centre and to the wall."""
    near = [[i for i in range(8) if depth(wall, CORNERS[i]) < .5] for wall in range(6)]
    for wall in range(6):
        a, b, c, d = near[wall]
        for half in ((a, b, d), (a, c, d)):
            yield (8, *half)
            yield (~wall, *half)
    for grains in [(i,) for i in range(8)] + list(itertools.combinations(range(8), 2)):
        walls = [wall for wall in range(6) if set(grains) <= set(near[wall])]
        if len(grains) + len(walls) == 4:
            yield (*grains, *(~wall for wall in walls))


def power_centre(cell, radius):
    """Where the power to all corners is the same; to a wall, on it."""
    grains = [v for v in cell if v >= 0]
    first = GRAINS[grains[0]]
    rows, right = [], []
    for v in cell:
        if v < 0:
            axis, place = plane(~v)
            rows.append(np.eye(3)[axis])
            right.append(place - first[axis])
        elif v != grains[0]:
            to = GRAINS[v] - first
            rows.append(2 * to)
            right.append(to @ to - radius[v] ** 2 + radius[grains[0]] ** 2)
    return first + np.linalg.solve(rows, right)


def solid_angle(u, v, w):
    """Van Oosterom and Strackee (1983)."""
    u, v, w = (x / np.linalg.norm(x) for x in (u, v, w))
    return 2 * math.atan2(abs(np.linalg.det([u, v, w])), 1 + u @ v + v @ w + w @ u)


class Throat:
    def __init__(self, facet, pores, centre, cell, radius, sides):
        grains, walls = [v for v in facet if v >= 0], [~v for v in facet if v < 0]
        at = [GRAINS[g] for g in grains]
        if len(walls) == 2:
            area = np.cross(*(normal(wall) * depth(wall, at[0]) for wall in walls))
        elif len(walls) == 1:
            area = np.cross(at[1] - at[0], normal(walls[0]))
            area *= (depth(walls[0], at[0]) + depth(walls[0], at[1])) / 2
        else:
            area = np.cross(at[1] - at[0], at[2] - at[0]) / 2
        p, q = (centre[pore] for pore in pores)
        self.pores, self.size = pores, np.linalg.norm(area)
        self.coincide = np.linalg.norm(q - p) < 1e-9
        if self.coincide:  # parted by so little that it does not matter
            opposite = next(v for v in cell if v not in facet)
            area *= math.copysign(1, area @ (at[0] - GRAINS[opposite]))
            q = p + 1e-6 * area
        step = q - p
        area *= math.copysign(1, area @ step)
        self.normal = area / self.size
        self.length = np.linalg.norm(step)
        self.volume = area @ step / 3
        self.sector, self.surface = {}, {}
        for g in grains:
            u, v = (normal(~o) if o < 0 else GRAINS[o] - GRAINS[g] for o in facet if o != g)
            angle = math.acos(u @ v / np.linalg.norm(u) / np.linalg.norm(v))
            solid = sum(solid_angle(x, p - GRAINS[g], q - GRAINS[g]) for x in (u, v))
            self.sector[g] = radius[g] ** 2 * angle / 2
            self.surface[g] = radius[g] ** 2 * solid
            self.volume -= radius[g] ** 3 * solid / 3
        for wall in walls if sides == "no-slip" else ():
            to = at[1] - at[0] if len(walls) == 1 else q - at[0]
            self.surface[~wall] = abs(np.cross(step, to) @ normal(wall)) / 2
        self.fluid = self.size - sum(self.sector.values())
        hydraulic = self.volume / sum(self.surface.values())  # [C 9]
        if sides == "symmetric-yade":
            hydraulic *= 2 ** (-len(walls) / 4)
        self.conductance = self.fluid * hydraulic ** 2 / self.length / 2  # [C 8]


def limit(throats):
    """A hundred times the conductance of the whole, as Yade has it."""
    apart = [t for t in throats if not t.coincide]
    surface = sum(s for t in apart for v, s in t.surface.items() if ~v not in ALONG)
    length = sum(t.length for t in apart) / len(throats)
    most = 100 * length * sum(t.volume for t in apart) / surface / 8
    for t in throats:
        t.conductance = most if t.coincide else min(t.conductance, most)


def solve(pores, throats, known):
    row = {pore: k for k, pore in enumerate(p for p in pores if p not in known)}
    matrix, right = np.zeros((len(row), len(row))), np.zeros(len(row))
    for t in throats:
        for here, there in (t.pores, t.pores[::-1]):
            if here in known:
                continue
            matrix[row[here], row[here]] += t.conductance
            if there in known:
                right[row[here]] += t.conductance * known[there]
            else:
                matrix[row[here], row[there]] -= t.conductance
    solution = np.linalg.solve(matrix, right)
    return {**known, **{pore: solution[k] for pore, k in row.items()}}


def evaluate(ratio, sides, limited):
    """By the columns of the table: permeability, then forces over the drop times the section."""
    radius = [.25] * 8 + [ratio / 4]
    cell = list(cells())
    centre = [power_centre(c, radius) for c in cell]
    facets = {}
    for c, corners in enumerate(cell):
        for facet in itertools.combinations(sorted(corners), 3):
            facets.setdefault(facet, []).append(c)
    throats = [Throat(f, tuple(ends), centre, cell[ends[0]], radius, sides)
               for f, ends in facets.items() if len(ends) == 2]
    pore = list(range(len(cell)))
    if limited:
        limit(throats)
    else:
        for t in throats:
            if t.coincide:
                low, high = sorted(pore[c] for c in t.pores)
                pore = [low if p == high else p for p in pore]
        throats = [t for t in throats if not t.coincide]
        for t in throats:
            t.pores = tuple(pore[c] for c in t.pores)
    known = {pore[c]: float(~3 in corners) for c, corners in enumerate(cell)
             if ~2 in corners or ~3 in corners}
    pressure = solve(set(pore), throats, known)
    viscous, push = {}, {}
    flux = 0
    for t in throats:
        drop = pressure[t.pores[0]] - pressure[t.pores[1]]
        flux += t.conductance * drop * ((known.get(t.pores[0]) == 1) - (known.get(t.pores[1]) == 1))
        whole = sum(t.surface.values())
        for v, s in t.surface.items():  # [C 18]
            viscous[v] = viscous.get(v, 0) - t.fluid * drop * s / whole * t.normal[1]
        for v, s in t.sector.items():  # [C 14]
            push[v] = push.get(v, 0) - s * drop * t.normal[1]
    on_wall = 0
    for c, corners in enumerate(cell):
        if ~0 in corners:
            at = [GRAINS[v] for v in corners if v >= 0]
            others = [~v for v in corners if v < 0 and v != ~0]
            area = (abs(np.cross(at[1] - at[0], at[2] - at[0])[0]) / 2 if len(at) == 3
                    else math.prod(depth(wall, at[0]) for wall in others)
                    * np.linalg.norm(at[-1] - at[0]) ** (len(at) - 1))
            on_wall += area * pressure[pore[c]]
    return {"K_ref": flux, "big_visc": sum(viscous[g] for g in range(8)) / 8,
            "big_press": sum(push[g] for g in range(8)) / 8, "center_visc": viscous[8],
            "center_press": push[8],
            "wall_visc_y": sum(viscous.get(~wall, 0) for wall in SIDES) / 4,
            "wall_press_x": on_wall}


def measure(ratio, sides, folder):
    """The same from `flow`."""
    grains = [(*at, .25) for at in CORNERS] + [(.5, .5, .5, ratio / 4)]
    packing, out = folder + "/packing.h5", folder + "/flow.h5"
    run("pack", "-q", "--set=method=import", "--set=lower=[0,0,0]", "--set=upper=[1,1,1]",
        "--set=bonds=none", "-o", packing,
        input="\n".join(" ".join(f"{x:.17g}" for x in g) for g in grains).encode())
    run("flow", "-q", f"--set=sides={sides}", "--set=along=none", "--set=pressure.y_lower=0",
        "--set=pressure.y_upper=1", "--set=viscosity=1", packing, "-o", out)
    with h5py.File(out, "r") as result:
        viscous, push = (-result[f"particles/{kind}_force"][:, 1]
                         for kind in ("viscous", "pressure"))
        return {"K_ref": -result["walls/inflow"][2], "big_visc": viscous[:8].mean(),
                "big_press": push[:8].mean(), "center_visc": viscous[8], "center_press": push[8],
                "wall_visc_y": -result["walls/viscous_force"][:][SIDES, 1].mean(),
                "wall_press_x": -result["walls/pressure_force"][0, 0]}


def digits_off(value, printed, digits):
    """In units of the last digit that is printed."""
    return abs(value - float(printed)) / 10 ** (math.floor(math.log10(abs(value))) - digits + 1)


with scratch() as folder, open("tests/physics/flow/reference/nine_spheres.csv") as file:
    for entry in csv.DictReader(file):
        ratio = float(entry["d_over_D"])
        sides = "symmetric-yade" if entry["lateral"] == "symmetry" else "no-slip"
        name = f"nine spheres, d/D = {entry['d_over_D']}, {entry['lateral']}"
        ours, exact = measure(ratio, sides, folder), evaluate(ratio, sides, False)
        error = max(abs(ours[key] / exact[key] - 1) for key in exact if exact[key])
        ok(error < 1e-11, f"{name}: the equations, to rounding", (error, ours, exact))
        limited = evaluate(ratio, sides, True)
        off = {key: digits_off(value, entry[key], 6 if key == "K_ref" else 5)
               for key, value in limited.items() if value}
        ok(max(off.values()) < .55, f"{name}: the table, to its digits", (off, limited))
done()
