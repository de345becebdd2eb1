#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Lattices, random packings, the inward spiral, dumps and the extra layer against what is
# known of them: closed forms, published jamming limits, counts of contacts.
import os
import subprocess
import sys
from math import pi, sqrt

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, run, scratch, sets

ALL = "periodic=[true,true,true]"


class Packing:
    def __init__(self, *settings, inputs=()):
        with scratch() as folder:
            path = os.path.join(folder, "packing")
            run("pack", "-q", *sets(*settings), *inputs, "-o", path)
            with h5py.File(path) as file:
                self.x, self.r = file["particles/position"][:], file["particles/radius"][:]
                self.lower, self.upper = file["domain/lower"][:], file["domain/upper"][:]
                self.periodic = file["domain/periodic"][:].astype(bool)
                self.bonds = file["bonds/particles"][:]
                self.porosity = float(file["summary"].attrs["porosity"])
                self.coordination = float(file["summary"].attrs["coordination"])
        self.edge = self.upper - self.lower

    def gaps(self, i=slice(None)):
        """Between the surfaces of some grains and all, by the nearest image."""
        apart = self.x[i][:, None] - self.x[None]
        apart -= np.where(self.periodic, self.edge * np.round(apart / self.edge), 0)
        gaps = np.linalg.norm(apart, axis=2) - self.r[i][:, None] - self.r[None]
        gaps[np.arange(len(gaps)), np.arange(len(self.r))[i]] = np.inf
        return gaps

    def overlap(self):
        """The largest, of the smallest radius; in slices, to save memory."""
        least = min(self.gaps(slice(k, k + 500)).min() for k in range(0, len(self.r), 500))
        return max(-least, 0) / self.r.min()

    def inside(self):
        return bool(((self.x >= self.lower) & (self.x <= self.upper)).all())


# ---- lattices ---------------------------------------------------------------------------

for method, in_cell, solid, contacts in [
        ("cubic", 1, pi / 6, 6), ("bcc", 2, sqrt(3) * pi / 8, 8),
        ("fcc", 4, sqrt(2) * pi / 6, 12), ("hexagonal", 4, sqrt(2) * pi / 6, 12),
        ("honeycomb", 4, 2 * pi / sqrt(243), 5)]:
    lattice = Packing(f"method={method}", "counts=[4,3,5]", ALL, "radius=3e-7")
    ok(len(lattice.r) == 60 * in_cell and abs(lattice.porosity - (1 - solid)) < 1e-12,
       f"porosity of the {method} lattice", lattice.porosity)
    number = np.bincount(lattice.bonds.ravel())
    ok((number == contacts).all() and lattice.overlap() < 1e-13 and lattice.inside(),
       f"each of its grains touches {contacts}")
    free = Packing(f"method={method}", "counts=[4,3,5]", "radius=3e-7")
    highest = free.x.max(axis=0) + free.r[0], free.x.min(axis=0) - free.r[0]
    ok(len(free.r) == 60 * in_cell and np.allclose(highest[0], free.upper, rtol=1e-14, atol=0)
       and np.abs(highest[1]).max() < 1e-20, "without periodic sides its box is around it")

for settings, in_cell, solid, contacts in [
        (["method=square"], 1, pi / 4, 4),
        (["method=hexagonal", "dimensions=2"], 2, pi / sqrt(12), 6),
        (["method=honeycomb", "dimensions=2"], 4, pi / sqrt(27), 3)]:
    layer = Packing(*settings, "counts=[6,1,4]", "radius=0.5", "periodic=[true,false,true]")
    area = pi / 4 * len(layer.r) / (layer.edge[0] * layer.edge[2])
    ok(len(layer.r) == 24 * in_cell and abs(area - solid) < 1e-12 and layer.edge[1] == 1
       and (np.bincount(layer.bonds.ravel()) == contacts).all(),
       f"{' '.join(settings)}: share of the plane, and {contacts} contacts")

filled = Packing("method=cubic", "radius=0.5", "lower=[-2,-2,-2]", "upper=[3.5,3,2]")
ok(len(filled.r) == 5 * 5 * 4, "a lattice fills the box it is given")
ball = Packing("method=fcc", "radius=0.1", "domain.shape=sphere", "domain.radius=1.5",
               "domain.cut.shape=sphere", "domain.cut.radius=0.4")
out = np.linalg.norm(ball.x - 1.5, axis=1)
ok((out + ball.r <= 1.5 + 1e-12).all() and (out - ball.r >= 0.4 - 1e-12).all()
   and len(ball.r) > 1000, "grains of a lattice that stick out of a hollow ball are left out")
solid = len(ball.r) * 4 / 3 * pi * 0.001
ok(abs(ball.porosity - (1 - solid / (4 / 3 * pi * (1.5**3 - 0.4**3)))) < 1e-12,
   "porosity is of the ball, not of the box around it")

# ---- random -----------------------------------------------------------------------------

points = Packing("method=poisson", "count=4000", "radius=1e-4", "upper=[1,1,1]", ALL,
                 "bonds=none")
counts = np.histogramdd(points.x, bins=5, range=[(0, 1)] * 3)[0].ravel()
scatter = ((counts - 32)**2 / 32).sum()  # chi-square with 124 degrees of freedom
ok(124 - 3 * sqrt(248) < scatter < 124 + 3 * sqrt(248), "random points are spread evenly", scatter)

# Random sequential addition jams at 0.3841 in space (Zhang & Torquato 2013) and at 0.5471 in
# the plane (Feder 1980; Torquato, Uche & Stillinger 2006), slowly: phi(t) ~ jam - t^(-1/d).
jam = Packing("method=random_sequential", "radius=0.5", "upper=[10,10,10]", ALL,
              "bonds=none", "most_trials=1000000")
ok(0.36 < 1 - jam.porosity < 0.3841 and jam.overlap() == 0 and jam.inside(),
   "spheres added at random come near their jamming", 1 - jam.porosity)
flat = Packing("method=random_sequential", "dimensions=2", "radius=0.5", "upper=[30,0,30]",
               "periodic=[true,false,true]", "bonds=none", "most_trials=1000000")
share = len(flat.r) * pi / 4 / 900
ok(0.53 < share < 0.552 and flat.overlap() == 0 and np.ptp(flat.x[:, 1]) == 0,
   "so do discs", share)

wide = Packing("method=random_sequential", "count=5000", "upper=[8,8,8]",
               "sizes.distribution=two_mode", "sizes.by=mass", "sizes.second_share=0.002",
               "radius=1", "sizes.second_radius=0.02", "bonds=none")
ok(len(wide.r) == 5000 and wide.overlap() == 0 and (wide.r == 1).sum() > 5
   and (wide.x - wide.r[:, None] >= 0).all() and (wide.x + wide.r[:, None] <= 8).all(),
   "spheres of 1:50 are added without overlap", (wide.r == 1).sum())
refused = subprocess.run([f"{BIN}/pack", "--set", "method=random_sequential", "--set",
                          "upper=[5,5,5]", "--set", "radius=0.5", "--set", "count=150",
                          "--set", "most_trials=1000"], capture_output=True, text=True)
fit = refused.stderr.split()
ok(refused.returncode == 3 and 50 < int(fit[2]) < 125 and fit[4] == "150"
   and abs(float(refused.stderr.split("share of ")[1][:6]) - int(fit[2]) * pi / 6 / 125) < 1e-4,
   "what does not fit is said", refused.stderr)
ring = Packing("method=random_sequential", "count=200", "radius=0.1", "domain.shape=ring",
               "domain.radius=1", "domain.inner_radius=0.5", "domain.height=2",
               "domain.centre=[5,6,7]", "periodic=[false,false,true]", "bonds=none")
out = np.hypot(ring.x[:, 0] - 5, ring.x[:, 1] - 6)
ok(out.max() <= 0.9 and out.min() >= 0.6 and ring.overlap() == 0
   and np.ptp(ring.x[:, 2]) > 1.8 and ring.inside(), "grains stay within a ring")

for method in ["method=random_sequential", "method=inward_spiral"]:
    same = [Packing(method, "sizes.distribution=uniform", "dimensions=2", "bonds=none",
                    *(f"{key}={value * scale!r}" for key, value in
                      [("radius", 1.), ("sizes.smallest", 0.5), ("sizes.largest", 1.)]),
                    f"upper=[{20 * scale!r},{scale!r},{20 * scale!r}]")
            for scale in (2.**-30, 2.**10)]
    ok(np.array_equal(same[0].x * 2.**40, same[1].x),
       f"{method[7:]}: nanometres and kilometres give the same digits")
seeds = [Packing("method=poisson", "count=5", "upper=[1,1,1]", f"seed={seed}", "bonds=none").x
         for seed in (1, 1, 2)]
ok(np.array_equal(seeds[0], seeds[1]) and not np.array_equal(seeds[0], seeds[2]),
   "places depend on the seed and nothing else")

# ---- the inward spiral ------------------------------------------------------------------


def check_spiral(title, densest, *settings, disc=False):
    spiral = Packing("method=inward_spiral", *settings)
    if disc:
        off = (spiral.x - (spiral.lower + spiral.upper) / 2)[:, [0, 2]]
        room = (spiral.edge[0] / 2 - np.hypot(*off.T) - spiral.r)[:, None]
    else:
        room = np.column_stack([
            side for axis in (0, 2) for side in
            (spiral.x[:, axis] - spiral.r - spiral.lower[axis],
             spiral.upper[axis] - spiral.x[:, axis] - spiral.r)])
    scale = spiral.r.min()
    ok(spiral.overlap() < 1e-12 and room.min() > -1e-12 * scale
       and np.ptp(spiral.x[:, 1]) == 0, f"{title}: no overlap",
       f"{spiral.overlap()} {room.min() / scale}")
    gaps = np.column_stack([spiral.gaps(), room])
    # two things laid before it: the method itself
    earlier = np.tri(len(gaps), k=-1, dtype=bool)
    earlier = np.column_stack([earlier, np.ones(room.shape, bool)])
    touch = ((gaps < 1e-10 * scale) & earlier).sum(axis=1)
    ok((touch[1:] >= 2).all(), f"{title}: each touches two that were there before",
       np.bincount(touch))
    area = pi * (spiral.r**2).sum() / (spiral.edge[0] * spiral.edge[2])
    area /= pi / 4 if disc else 1
    ok(densest[0] < area < densest[1], f"{title}: share of the area", area)
    return spiral, room, touch


# Equal discs cannot be denser than pi / sqrt(12); random ones lie loosely above 0.77.
hexagonal = pi / sqrt(12)
equal, room, _ = check_spiral("equal discs", (0.8, hexagonal), "radius=0.5", "upper=[30,1,20]")
front = (room.min(axis=1) < 1e-9).argmin()
ok(front >= 2 * (29 + 19) - 4, "the walls are lined first", front)
check_spiral("discs in a disc", (0.6, hexagonal), "radius=0.5", "domain.shape=sphere",
             "domain.radius=10", disc=True)
sizes = ["sizes.distribution=uniform", "sizes.smallest=0.3", "sizes.largest=0.7",
         "upper=[30,1,30]"]
loose, _, _ = check_spiral("unequal discs", (0.74, hexagonal), *sizes)
ok(abs(loose.r.mean() - 0.5) < 4 * 0.4 / sqrt(12 * len(loose.r)),
   "the discs have the sizes asked for", loose.r.mean())
dense, _, touch = check_spiral("densified", (0.78, 1), *sizes, "densify=true")
ok(len(dense.r) > len(loose.r) and np.array_equal(dense.r[:len(loose.r)], loose.r)
   and (touch[len(loose.r):] >= 3).mean() > 0.95,
   "densifying adds grains that touch three", np.bincount(touch[len(loose.r):]))
check_spiral("densified finely", (0.9, 1), "radius=0.5", "sizes.smallest=0.05",
             "densify=true", "upper=[12,1,12]")

# ---- LAMMPS dumps -----------------------------------------------------------------------

generator = np.random.default_rng(3)
position, radius = generator.uniform(-1, 2, (50, 3)), generator.uniform(0.01, 0.02, 50)
lower, edge = np.array([-1., -1, -1]), 3.


def dump(columns, rows, step, flags="pp ff pp", order=range(50)):
    return "\n".join(
        ["ITEM: TIMESTEP", str(step), "ITEM: NUMBER OF ATOMS", "50",
         f"ITEM: BOX BOUNDS {flags}", *["-1 2"] * 3, f"ITEM: ATOMS {columns}",
         *(" ".join(str(v) for v in rows(i)) for i in order), ""])


def imported(text, *settings):
    with scratch() as folder:
        path = os.path.join(folder, "dump")
        with open(path, "w") as file:
            file.write(text)
        return Packing("method=import", "bonds=none", *settings, inputs=[path])


plain = lambda i: (i + 1, 1, *position[i].tolist(), radius[i].item())
later = lambda i: (i + 1, 1, *(position[i] / 2).tolist(), radius[i].item())
frames = dump("id type x y z radius", plain, 0) + dump("id type x y z radius", later, 100)
last, first = imported(frames), imported(frames, "frame=0")
ok(np.array_equal(last.x, position / 2) and np.array_equal(first.x, position)
   and np.array_equal(first.r, radius), "frames of a dump: the last, or the one asked for")
ok(list(first.periodic) == [True, False, True] and np.array_equal(first.lower, lower)
   and np.array_equal(first.edge, [3, 3, 3]), "its box and periodic sides")
with scratch() as folder:
    path = os.path.join(folder, "dump")
    with open(path, "w") as file:
        file.write(frames)
    for given, warned in ("[true,true,true]", True), ("[true,false,true]", False), ("[false,false,false]", False):
        said = subprocess.run([f"{BIN}/pack", *sets("method=import", "bonds=none", "import.scale=1e-3", f"periodic={given}"), path],
                              capture_output=True).stderr.decode()
        ok(("periodic: has no effect: the box is that of " in said and "periodic = [true,false,true]" in said) == warned,
           f"periodic={given}, beside the dump's own", said)
mixed = dump("id element xs ys zs vx diameter",
             lambda i: (i + 1, "Si", *((position[i] - lower) / edge).tolist(), 0, 2 * radius[i]),
             0, order=generator.permutation(50))
scaled = imported(mixed)
ok(np.allclose(scaled.x, position, rtol=0, atol=1e-14) and np.allclose(scaled.r, radius, atol=0),
   "scaled places, diameters and words, in the order of the ids")
ok(np.array_equal(imported(mixed, "import.diameters=true").r, scaled.r),
   "import.diameters beside a column diameter halves once")
unwrapped = dump("id xu yu zu radius",
                 lambda i: (i, *(position[i] + [3 * (i % 3), 0, -6]).tolist(), radius[i]), 0)
ok(np.allclose(imported(unwrapped).x, position, rtol=0, atol=1e-14),
   "unwrapped places are put back into the box")

# ---- the extra layer --------------------------------------------------------------------

bare = Packing("radius=0.5", "counts=[4,3,5]", "periodic=[true,true,false]")
layered = Packing("radius=0.5", "counts=[4,3,5]", "periodic=[true,true,false]",
                  "extra_layer=true")
ok(np.array_equal(layered.x[:60], bare.x) and np.array_equal(layered.bonds, bare.bonds)
   and np.array_equal(layered.x[60:], bare.x[bare.x[:, 2] > 4] + [0, 0, 1])
   and layered.upper[2] == 6, "an extra layer continues a cubic lattice, without bonds")
for k, side in enumerate(["-x", "+x", "-y", "+y", "-z", "+z"]):
    axis, sign = k // 2, 2 * (k % 2) - 1
    end, all_along = bare.x[:, axis] * sign, np.eye(3)[axis] * sign
    layered = Packing("radius=0.5", "counts=[4,3,5]", "extra_layer=true", f"extra_side={side}")
    ok(np.array_equal(layered.x[:60], bare.x)
       and np.allclose(layered.x[60:], bare.x[end == end.max()] + all_along, rtol=0, atol=1e-15)
       and np.allclose(np.delete(layered.edge, axis), np.delete([4, 3, 5], axis))
       and layered.edge[axis] == [4, 3, 5][axis] + 1, f"it does so at {side}", layered.x[60:])
uneven = Packing("method=random_sequential", "upper=[10,10,10]", "count=300",
                 "sizes.distribution=uniform", "sizes.smallest=0.3", "sizes.largest=0.6",
                 "bonds=none", "extra_layer=true")
extra = slice(300, None)
ok(uneven.overlap() == 0 and np.ptp(uneven.x[extra, 2]) == 0
   and np.allclose(uneven.r[extra], uneven.r[:300].mean(), rtol=1e-14, atol=0)
   and len(uneven.r) - 300 == int(5 / uneven.r[-1])**2,
   "on unequal grains it has their mean radius and lies on the highest")
row = Packing("method=random_sequential", "dimensions=2", "upper=[10,0,10]", "count=40", ALL[:-5]
              + "false]", "sizes.distribution=two_mode", "radius=0.2", "sizes.second_radius=1",
              "sizes.second_share=0.1", "bonds=none", "extra_layer=true")
ok(np.ptp(row.x[:, 1]) == 0 and row.edge[1] == 2 and row.overlap() == 0
   and len(row.r) - 40 == int(5 / row.r[-1]), "in the plane it is one row")
done()
