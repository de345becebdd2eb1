#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Packings made by moving grains, against what places and radii alone must then obey: forces
# from the overlaps in balance on every grain, their virial, counts of contacts that rigidity
# demands, weights on the floor, and published bounds.
import filecmp
import json
import os
import sys
from math import pi, sqrt

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, run, scratch, sets

ALL, SIDES = "periodic=[true,true,true]", "periodic=[true,true,false]"
SMOOTH, ROUGH = "dynamics.friction=0", "dynamics.friction=0.5"
# Discs of two sizes, 1 to 1.4: equal ones would crystallise.
PLANE = ["dimensions=2", "sizes.distribution=two_mode", "radius=1e-3",
         "sizes.second_radius=1.4e-3"]
folder = scratch()


def pack(path, *settings, options=(), inputs=()):
    run("pack", "-q", *options, "--set", "bonds=none", *sets(*settings), *inputs, "-o", path,
        "--report", path + ".json")


class Packing:
    """Grains as the artifact has them; forces from overlaps alone, of springs in series."""

    def __init__(self, *settings, **more):
        path = os.path.join(folder.name, "packing")
        pack(path, *settings, **more)
        with open(path + ".json") as file:
            said = json.load(file)
        self.said, self.reached = said["summary"], said["reached"]
        with h5py.File(path) as file:
            self.x, self.r = file["particles/position"][:], file["particles/radius"][:]
            self.lower, self.upper = file["domain/lower"][:], file["domain/upper"][:]
            self.periodic = file["domain/periodic"][:].astype(bool)
        self.edge = self.upper - self.lower
        self.flat = np.ptp(self.x[:, 1]) == 0
        self.dimensions = 2 if self.flat else 3
        self.k = self.reached["stiffness"]
        self.find_contacts()

    def find_contacts(self):
        apart = self.x[:, None] - self.x[None]
        apart -= np.where(self.periodic, self.edge * np.round(apart / self.edge), 0)
        distance = np.linalg.norm(apart, axis=2)
        np.fill_diagonal(distance, np.inf)
        self.touch = self.r[:, None] + self.r[None] > distance
        self.i, self.j = np.nonzero(np.triu(self.touch))
        self.branch = distance[self.i, self.j]
        self.normal = apart[self.i, self.j] / self.branch[:, None]
        self.overlap = self.r[self.i] + self.r[self.j] - self.branch
        self.force = self.k / 2 * self.overlap

    def net_forces(self):
        """Of the contacts between grains."""
        net = np.zeros_like(self.x)
        np.add.at(net, self.i, self.force[:, None] * self.normal)
        np.add.at(net, self.j, -self.force[:, None] * self.normal)
        return net

    def imbalance(self, more=0, walls=()):
        """Mean net force over mean contact force [K 4.20], with what else pulls."""
        net = np.linalg.norm(self.net_forces() + more, axis=1)
        forces = np.concatenate([self.force, *walls])
        return net.mean() / forces[forces > 0].mean()

    def stress(self):
        """Mean stress by the virial of the overlaps."""
        return (self.force * self.branch).sum() / self.dimensions / np.prod(self.edge)

    def solid(self):
        """Share of the space, or of the plane."""
        if self.flat:
            return pi * (self.r**2).sum() / (self.edge[0] * self.edge[2])
        return 4 / 3 * pi * (self.r**3).sum() / np.prod(self.edge)

    def backbone(self, least):
        """Mean contacts of what is left when grains with fewer are taken away, and how many."""
        firm = np.ones(len(self.r), bool)
        while ((self.touch[firm][:, firm].sum(axis=1)) < least).any():
            firm[firm] = self.touch[firm][:, firm].sum(axis=1) >= least
        return self.touch[firm][:, firm].sum() / max(firm.sum(), 1), firm.sum()

    def weights(self):
        """Of every grain, N."""
        return 2500 * 4 / 3 * pi * self.r**3 * 9.81

    def floor(self):
        """Overlaps with the floor as forces, N: its springs are the grains' alone."""
        return self.k * np.maximum(self.lower[2] + self.r - self.x[:, 2], 0)

    def deepest(self, *distance_to_wall):
        """The deepest overlap of all, over the smallest radius."""
        walls = [(self.r - d).max() for d in distance_to_wall]
        return max([self.overlap.max(initial=0), *walls]) / self.r.min()


# ---- jammed without friction ------------------------------------------------------------

for title, settings in [("space", ["count=400"]), ("plane", [*PLANE, "count=800"])]:
    two = title == "plane"
    for method in "radius_expansion", "domain_contraction":
        excess, pressures = [], []
        least = 3 if two else 4
        for overlap in [1e-2, 1e-3, 1e-4] if method == "radius_expansion" else [1e-3]:
            made = Packing(f"method={method}", *settings, ALL, SMOOTH,
                           f"dynamics.overlap={overlap}")
            ratio = made.imbalance()
            ok(ratio < 1.1e-4 and abs(ratio - made.reached["unbalanced_ratio"]) < 1e-5,
               f"{method} in {title} to {overlap}: overlaps alone balance every grain", ratio)
            stress = made.stress()
            ok(abs(stress / made.reached["pressure"] - 1) < 1e-3,
               f"{method} in {title} to {overlap}: the pressure is their virial",
               (stress, made.reached["pressure"]))
            volume = made.r**3
            scale = made.k / 2 / (2 * (volume * made.r).sum() / volume.sum())
            # in the plane the layer that carries the stress is as thick as the largest grain
            ok(abs(stress / scale / overlap - 1) < 0.05, "and the overlap asked for",
               stress / scale)
            contacts, firm = made.backbone(least)
            # over rigidity: d degrees of freedom a grain but for d of all together
            # [Goodrich, Liu & Nagel 2012]
            excess.append(contacts / 2 - made.dimensions + made.dimensions / firm)
            pressures.append(stress / scale)
            rattlers = len(made.r) - firm
            ok(rattlers == made.said["rattlers"]
               and abs(contacts - made.said["coordination_without_rattlers"]) < 1e-12,
               "rattlers and contacts are what places say")
            solid = made.solid()
        ok((0.81 if two else 0.615) < solid < (0.86 if two else 0.66),
           f"{method} in {title}: solid share", solid)
        if len(excess) > 1:
            slope = np.polyfit(np.log(pressures), np.log(excess), 1)[0]
            ok(0.35 < slope < 0.65 and 0 < excess[-1] < 0.12,
               f"{title}: contacts come down to isostaticity as the root of the pressure",
               (slope, excess))
            ok(rattlers / len(made.r) < 0.08, "rattlers are few", rattlers)
        else:
            ok((made.r == made.r.min()).sum() + (made.r == made.r.max()).sum()
               >= len(made.r) and made.reached["growth"] == 1,
               "a box that closes in leaves the radii as they were drawn")

# ---- other targets ----------------------------------------------------------------------

for porosity in 0.6, 0.45, 0.3:
    made = Packing("method=radius_expansion", "count=300", ALL, SMOOTH, "target=porosity",
                   f"target_value={porosity}")
    ok(abs(1 - made.solid() - porosity) < 1e-9 and abs(made.reached["value"] - porosity) < 1e-9,
       f"a porosity of {porosity}", 1 - made.solid())
    ok(made.imbalance() < 1.1e-4 if porosity < 0.36 else made.overlap.max(initial=0) < 1e-3,
       "at rest", made.overlap.max(initial=0))
disc = Packing("method=radius_expansion", *PLANE, "count=200", ALL, SMOOTH, "target=porosity",
               "target_value=0.3")
ok(abs(1 - disc.solid() - 0.3) < 1e-9, "in the plane it is that of the area", disc.solid())
made = Packing("method=radius_expansion", "count=300", ALL, SMOOTH, "target=coordination",
               "target_value=6.6")
contacts, firm = made.backbone(4)
ok(6.6 <= contacts < 6.9, "contacts asked for", contacts)
for settings in ["count=300"], [*PLANE, "count=200"]:
    made = Packing("method=radius_expansion", *settings, "radius=1e-3", ALL, SMOOTH,
                   "target=pressure", "target_value=2e4")
    ok(abs(made.stress() / 2e4 - 1) < 0.011, f"a pressure of 2e4 Pa, {settings[0]}",
       made.stress())

# ---- friction ---------------------------------------------------------------------------

# Song, Wang & Makse (2008): for Z contacts a packing is at least as dense as Z / (Z + 2 sqrt 3),
# and at random at most 6 / (6 + 2 sqrt 3) = 0.634; small packings scatter by about 0.01.
shares, numbers = [], []
for friction in 0, 0.1, 0.5:
    made = Packing("method=radius_expansion", "count=500", ALL, "dynamics.overlap=1e-4",
                   f"dynamics.friction={friction}")
    contacts, firm = made.backbone(2 if friction else 4)
    shares.append(made.solid())
    numbers.append(contacts)
    ok(contacts / (contacts + 2 * sqrt(3)) - 0.01 < made.solid() < 0.65
       and 4 < contacts < 6.3, f"friction {friction}: between loose and close packing",
       (contacts, made.solid()))
    ok(made.reached["unbalanced_ratio"] < 1e-4, "at rest")
ok(shares[0] > shares[1] + 0.01 > shares[2] + 0.03
   and numbers[0] > numbers[1] + 0.3 > numbers[2] + 0.6,
   "friction loosens, and takes fewer contacts", (shares, numbers))

# ---- deposition -------------------------------------------------------------------------

for title, settings in [("space", ["count=200", "sizes.distribution=normal"]),
                        ("plane", [*PLANE, "count=150"])]:
    made = Packing("method=deposition", *settings, "radius=1e-3", SIDES, SMOOTH)
    weight, floor = made.weights(), made.floor()
    ok(abs(floor.sum() / weight.sum() - 1) < 1e-3, f"{title}: the floor carries all grains",
       floor.sum() / weight.sum())
    up = np.zeros_like(made.x)
    up[:, 2] = floor - weight
    ok(made.imbalance(up, [floor]) < 2e-4, f"{title}: overlaps balance the weight of each",
       made.imbalance(up, [floor]))
    ok(abs((made.x[:, 2] + made.r).max() - made.upper[2]) < 1e-12
       and made.deepest(made.x[:, 2] - made.lower[2]) < 0.02
       and made.reached["unbalanced_ratio"] < 1e-4, f"{title}: the box ends on the highest",
       made.deepest())

# A few grains on a wide floor carry nothing but themselves: they sink in by half of dynamics.overlap.
made = Packing("method=deposition", "count=12", "radius=1e-3", "upper=[1,1,0.1]")
sunk = 1 - (made.x[:, 2] - made.lower[2]) / made.r
ok(np.allclose(sunk, 0.5e-3, rtol=1e-3, atol=0), "a few grains stay on a wide floor", sunk)

# Bonded grains fall as others do.
bonded = os.path.join(folder.name, "bonded.h5")
run("pack", "-q", *sets("method=cubic", "counts=[3,3,3]", "bonds=touching"), "-o", bonded)
fallen = Packing("method=deposition", inputs=[bonded])
with h5py.File(bonded) as before:
    ok(len(before["bonds/particles"]) == 54 and fallen.reached["unbalanced_ratio"] < 1e-4,
       "bonded grains fall, without their bonds")

# A tall silo: walls with friction carry grains, and without do not [Janssen 1895].
silo = ["method=deposition", "count=300", "radius=1e-3", "upper=[8e-3,8e-3,20e-3]", ROUGH]
carried = {}
for friction in 0, 0.5:
    made = Packing(*silo, f"dynamics.wall_friction={friction}")
    carried[friction] = made.floor().sum() / made.weights().sum()
    sides = [made.x[:, k] - made.lower[k] for k in (0, 1)]
    sides += [made.upper[k] - made.x[:, k] for k in (0, 1)]
    ok(made.deepest(*sides, made.x[:, 2] - made.lower[2]) < 0.02, "grains stay in their silo")
ok(abs(carried[0] - 1) < 2e-3 and carried[0.5] < 0.9,
   "rough walls carry part of the weight, smooth ones nothing", carried)

# ---- other rooms ------------------------------------------------------------------------

cylinder = ["domain.shape=cylinder", "domain.radius=5", "domain.height=12"]
ring = ["domain.shape=ring", "domain.radius=8", "domain.inner_radius=3", "domain.height=8"]
ball = ["domain.shape=sphere", "domain.radius=7"]
box, disc = ["upper=[12,12,12]"], ["dimensions=2", "domain.shape=sphere", "domain.radius=12"]
hole = ["domain.cut.shape=sphere", "domain.cut.radius=3"]
out = lambda made: np.hypot(*(made.x - (made.lower + made.upper) / 2)[:, :2].T)
far = lambda made: np.linalg.norm(made.x - (made.lower + made.upper) / 2, axis=1)
ends = lambda made: [made.x[:, 2] - made.lower[2], made.upper[2] - made.x[:, 2]]
planes = lambda made: [d for k in (0, 2) + (1,) * (not made.flat) for d in
                       (made.x[:, k] - made.lower[k], made.upper[k] - made.x[:, k])]


def beside_block(made):
    """From a cube of edge 4 in the middle of a box that began at the origin."""
    apart = np.maximum(np.abs(made.x - [6, made.x[0, 1] if made.flat else 6, 6]) - 2, 0)
    return np.linalg.norm(apart, axis=1)


for title, settings, walls in [
        ("a cylinder filled by gravity", ["method=deposition", *cylinder, "count=150"],
         lambda made: [5 - out(made), *ends(made)]),
        ("a cylinder that repeats", ["method=radius_expansion", *cylinder, "count=100",
                                     "periodic=[false,false,true]"], lambda made: [5 - out(made)]),
        ("a ring", ["method=radius_expansion", *ring, "count=150", SMOOTH],
         lambda made: [8 - out(made), out(made) - 3, *ends(made)]),
        ("a ring filled by gravity", ["method=deposition", *ring, "count=120"],
         lambda made: [8 - out(made), out(made) - 3, *ends(made)]),
        ("a ball", ["method=radius_expansion", *ball, "count=150"], lambda made: [7 - far(made)]),
        ("a ball half filled", ["method=deposition", *ball, "count=60"],
         lambda made: [7 - far(made)]),
        ("a ball with a hole", ["method=radius_expansion", *ball, *hole, "count=120", SMOOTH],
         lambda made: [7 - far(made), far(made) - 3]),
        ("a box with a cylinder cut out",
         ["method=radius_expansion", *box, "domain.cut.shape=cylinder", "domain.cut.radius=2",
          "count=150"], lambda made: [out(made) - 2, *planes(made)]),
        ("a box with a box cut out",
         ["method=radius_expansion", *box, "domain.cut.shape=box", "domain.cut.lower=[4,4,4]",
          "domain.cut.upper=[8,8,8]", "count=150", SMOOTH],
         lambda made: [beside_block(made), *planes(made)]),
        ("a ball above which grains settle",
         ["method=deposition", *box, *hole, "count=150"],
         lambda made: [np.linalg.norm(made.x - 6, axis=1) - 3, *planes(made)[:4]]),
        ("a disc", ["method=radius_expansion", *disc, "count=100", SMOOTH],
         lambda made: [12 - far(made)]),
        ("a disc filled by gravity", ["method=deposition", *disc, "count=50"],
         lambda made: [12 - far(made)]),
        ("a disc with a hole", ["method=radius_expansion", *disc, *hole, "count=90", SMOOTH],
         lambda made: [12 - far(made), far(made) - 3]),
        ("a square with a square cut out",
         ["method=radius_expansion", "dimensions=2", *box, "domain.cut.shape=box",
          "domain.cut.lower=[4,0,4]", "domain.cut.upper=[8,0,8]", "count=60"],
         lambda made: [beside_block(made), *planes(made)])]:
    made = Packing("radius=1", *settings)
    ok(made.deepest(*walls(made)) < 0.05 and made.reached["unbalanced_ratio"] < 1e-4
       and len(made.i) > len(made.r) / 2, title,
       (made.deepest(*walls(made)), len(made.i)))

# ---- radii of 1:20 ----------------------------------------------------------------------

# Small rough grains spin fast while large ones grow against them.
made = Packing("method=radius_expansion", "count=500", ALL, ROUGH, "sizes.distribution=two_mode",
               "radius=1", "sizes.second_radius=0.05", "sizes.second_share=0.95")
deepest = (made.overlap / np.minimum(made.r[made.i], made.r[made.j])).max()
ok(deepest < 0.01 and made.reached["unbalanced_ratio"] < 1e-4 and len(made.i) > 20,
   "rough grains of 1:20 come to rest", (deepest, made.reached))

# By steps near the stability limit, very small fines settle into another fabric (docs/packings.md):
# the step stays a tenth of the critical one.
steps = []
for second in 0.1, 0.2, 0.5:
    made = Packing("method=deposition", "count=30", "sizes.distribution=two_mode", "radius=1",
                   f"sizes.second_radius={second}", "sizes.second_share=0.5")
    lightest = 4 / 3 * pi * 2500 * second**3
    steps.append(made.reached["time_step"] / (2 * sqrt(lightest / made.k)))
ok(abs(steps[0] - 0.1) < 1e-6 and steps[1] > 0.2 and steps[2] > 0.2, "the step is fixed where radii are very wide",
   steps)

# Adapted steps and inertia come to the rest of plain dynamics, in fewer cycles. That less
# friction shows in as many packings says that the comparison can.
def over_seeds(*settings):
    made = [Packing("count=150", "sizes.distribution=normal", "sizes.spread=0.2", SIDES,
                    f"seed={seed}", *settings) for seed in range(1, 6)]
    facts = [[1 - m.said["bulk_porosity"], m.said["coordination_without_rattlers"]] for m in made]
    return np.array(facts), sum(m.reached["cycles"] for m in made)


def apart(a, b):
    """Differences of the means over their standard errors."""
    return (b.mean(axis=0) - a.mean(axis=0)) / np.sqrt((a.var(axis=0, ddof=1)
                                                        + b.var(axis=0, ddof=1)) / len(a))


for method in "deposition", "radius_expansion":
    plain, cycles = over_seeds(f"method={method}", ROUGH, "dynamics.time_step_safety=0.1")
    adapted, fewer = over_seeds(f"method={method}", ROUGH)
    slippery, _ = over_seeds(f"method={method}", "dynamics.friction=0.1")
    ok(np.abs(apart(plain, adapted)).max() < 3 and np.abs(apart(plain, slippery)).min() > 3
       and fewer < 0.75 * cycles, f"{method}: as dense and coordinated as by plain dynamics",
       (apart(plain, adapted), apart(plain, slippery), fewer, cycles))

# ---- explosive repulsion ----------------------------------------------------------------

for settings in ["upper=[10,10,10]", "count=300"], ["dimensions=2", "upper=[10,0,10]", "count=35"]:
    made = Packing("method=explosive_repulsion", "radius=0.7", *settings)
    ok(made.deepest(*planes(made)) < 0.01 and len(made.r) == int(settings[-1][6:]),
       f"grains that came on top of each other part, {settings[-1]}", made.deepest(*planes(made)))
# Below the share at which grains jam no overlap is left, whatever the friction; with it grains held each
# other by a third of a radius. Where some have many contacts at the start, the step is shorter.
for settings in (["count=500", "upper=[8,8,8]", "sizes.distribution=lognormal", "sizes.spread=0.2", "seed=327"],
                 ["count=500", "upper=[8,8,8]", "sizes.distribution=normal", "sizes.spread=0.3", ALL, "seed=614"],
                 ["count=300", "sizes.distribution=normal", "sizes.spread=0.3", ALL, "seed=614"]):
    made = Packing("method=explosive_repulsion", "radius=0.5", *settings)
    porosity = 1 - 4 / 3 * np.pi * (made.r**3).sum() / np.prod(made.edge)
    overlap = made.overlap.max(initial=0) / made.r.min()
    ok(overlap < (2e-6 if porosity > 0.42 else 0.03), "grains at random places are apart, or jammed with small overlaps",
       (porosity, overlap))
at = os.path.join(folder.name, "given.txt")
given = np.repeat(np.array([[2., 2, 2, 0.5], [2, 2, 5, 1], [5, 5, 5, 0.25]]), 4, axis=0)
np.savetxt(at, given)
made = Packing("method=explosive_repulsion", "lower=[0,0,0]", "upper=[7,7,7]", inputs=[at])
ok(np.array_equal(made.r, given[:, 3]) and made.deepest(*planes(made)) < 0.01
   and np.linalg.norm(made.x - given[:, :3], axis=1).max() < 4,
   "given grains, four in one place, part near where they were", made.deepest(*planes(made)))

# Grains of somebody's own, loose, of two sizes: they keep their sizes and order, and end as dense
# as spheres do: random close packing without friction (0.64 of equal ones, to 0.66 of these).
chance = np.random.default_rng(4)
lattice = np.stack(np.meshgrid(*[np.arange(6)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
loose = np.column_stack([2 + 3 * lattice + chance.uniform(-0.4, 0.4, (216, 3)),
                         chance.choice([0.7, 1], 216)])
np.savetxt(at, loose, fmt="%.17g")
WITHIN = "lower=[0,0,0]", "upper=[19,19,19]"
for words, least, most in [(["method=domain_contraction", ALL, SMOOTH], 0.34, 0.37),
                           (["method=radius_expansion", ALL, SMOOTH], 0.34, 0.37),
                           (["method=radius_expansion", SMOOTH], 0.36, 0.48)]:
    made = Packing(*words, *WITHIN, inputs=[at])
    ok(np.array_equal(made.r, loose[:, 3]), f"own grains by {' '.join(words)} keep their sizes")
    porosity = 1 - 4 / 3 * np.pi * (made.r**3).sum() / np.prod(made.edge)
    inside = ((made.x > made.lower) & (made.x < made.upper)).all()
    ok(least < porosity < most and inside and made.overlap.max() / made.r.min() < 0.03,
       "and are packed densely, in their box", (porosity, inside, made.overlap.max()))

# Let fall in a column, they lie at rest on the floor and on one another.
column = np.stack(np.meshgrid(*[np.arange(n) for n in (4, 4, 14)], indexing="ij"), axis=-1)
column = np.column_stack([2 + 3 * column.reshape(-1, 3) + chance.uniform(-0.4, 0.4, (224, 3)),
                          chance.choice([0.7, 1], 224)])
np.savetxt(at, column, fmt="%.17g")
made = Packing("method=deposition", "lower=[0,0,0]", "upper=[13,13,43]", inputs=[at])
ok(np.allclose(made.r, column[:, 3], rtol=1e-15, atol=0) and 0.36 < made.said["bulk_porosity"] < 0.47
   and abs(made.edge[2] - (made.x[:, 2] + made.r).max()) < 1e-9
   and made.said["rattlers"] < 15, "own grains settle under gravity, and the box ends on them",
   (made.said["bulk_porosity"], made.said["rattlers"]))

# ---- the same bytes ---------------------------------------------------------------------

for settings in [["method=radius_expansion", "count=1500", ALL, "dynamics.overlap=1e-2",
                  "dynamics.tolerance=1e-2"],
                 ["method=deposition", *PLANE, "count=300"],
                 ["method=explosive_repulsion", "count=200", "radius=0.5", "upper=[7,7,7]"]]:
    paths = [os.path.join(folder.name, f"threads-{n}") for n in (1, 2)]
    for threads, path in zip((1, 2), paths):
        pack(path, *settings, options=["--threads", threads])
    ok(filecmp.cmp(*paths, shallow=False)
       and filecmp.cmp(*(path + ".json" for path in paths), shallow=False),
       f"{settings[0]}: one thread and two give the same bytes")

shapes = []
for scale in 2.**-30, 2.**10:
    edge = 8.7 * scale
    made = Packing("method=radius_expansion", "count=100", f"radius={scale!r}", SMOOTH, ALL,
                   f"upper=[{edge!r},{edge!r},{edge!r}]")
    shapes.append(made.x / scale)
ok(np.array_equal(*shapes), "nanometres and kilometres give the same digits",
   np.abs(shapes[0] - shapes[1]).max())
done()
