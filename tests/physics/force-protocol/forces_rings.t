#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Forces of the rings that a drying left (force-protocol, rings.left=drying): what they add to the
# forces without, against the exact bridge (the program `bridge`) of the volume that is left.
import filecmp
import json
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, WATER, done, ok, refused, run, scratch_paths, sets

R, TENSION = 1e-6, 0.07274
at = scratch_paths()


def dried(packing, *settings):
    run("tessellate", "-q", *sets("throat_volume=void", "throat_radius=entry"), packing, "-o", at("diagram"))
    run("merge-nodes", "-q", at("diagram"), "-o", at("network"))
    run("dry", "-q", *sets(*WATER, "step_interval=0", *settings), at("network"), "-o", at("drying"))


def added(times, *settings):
    """Times, and what rings add to the force on each grain then."""
    force = []
    for left in "none", "drying":
        run("force-protocol", "-q", *sets(f"rings.left={left}", f"steps={times}", *settings), at("drying"), "-o", at("forces-" + left))
        with h5py.File(at("forces-" + left)) as file:
            force.append(file["force"][:])
            time = file["time"][:]
    return time, force[1] - force[0], force[1]


def volumes(time):
    """Of each ring: grains, volume left, and the share that gas has bared, at TIME."""
    with h5py.File(at("drying")) as file:
        steps, ends = file["history/time"][:], file["throats/nodes"][:]
        states = []
        for group, what, n in ("changes", "throat", len(ends)), ("ring_changes", "node", len(file["nodes/kind"])):
            offset, index, value = (file[f"{group}/{name}"][:] for name in ("offset", what, "saturation"))
            before, k = np.ones(n), np.searchsorted(steps, time, side="right") - 1
            before[index[:offset[k + 1]]] = value[:offset[k + 1]]  # the last of each counts
            after = before.copy()
            if k + 1 < len(steps):
                after[index[offset[k + 1]:offset[k + 2]]] = value[offset[k + 1]:offset[k + 2]]
                before += (time - steps[k]) / (steps[k + 1] - steps[k]) * (after - before)
            states.append(before)
        throat, part, offset = file["rings/throat"][:], file["rings/volume"][:], file["rings/offset"][:]
        add = lambda of: np.add.reduceat(of, offset[:-1])
        return (file["faces/particles"][:][file["rings/face"][:]], add(part * states[1][ends].mean(axis=1)[throat]),
                1 - add(part * states[0][throat]) / add(part), file["rings/separation"][:])


def exact(volume, gap, angle):
    said = json.loads(run("bridge", "-q", *sets(f"radius={R}", f"volume={float(volume)!r}", "fluid=other", f"surface_tension={TENSION}",
                                                f"contact_angle={angle}", f"separations=[{float(gap)!r}]")))
    return said["force"][0]


# ---- one ring under each grain of the top --------------------------------------------------

grid = np.stack(np.meshgrid(*[np.arange(4)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
for radius, angle in (R, 0), (R, 50), (0.985 * R, 10):
    np.savetxt(at("lattice.txt"), np.column_stack([(2 * grid + 1) * R, np.full(64, radius)]), fmt="%.17g")
    run("pack", "-q", *sets("method=import", "lower=[0,0,0]", f"upper={[8 * R] * 3}", "bonds=none", "check=none",
                            "periodic=[true,true,false]"), at("lattice.txt"), "-o", at("packing"))
    dried(at("packing"), "rings=isolated", f"contact_angle={angle}")
    time, force, _ = added(60)
    worst, pulls = 0, 0
    for k in range(5, 60, 6):
        grain, volume, bare, gap = volumes(time[k])
        for r in np.flatnonzero((grid[grain].max(axis=1)[:, 2] == 3) & (grid[grain].min(axis=1)[:, 2] == 2)):
            top = grain[r][np.argmax(grid[grain[r]][:, 2])]
            if grid[top][:2].tolist() != [1, 2]:
                continue
            scaled = volume[r] * (R / radius)**3
            pull = bare[r] * radius / R * exact(scaled, max(gap[r], 0) * R / radius, angle) if volume[r] > 1e-6 * R**3 and bare[r] > 0 else None
            if pull is not None:
                worst, pulls = max(worst, abs(-force[k, top, 2] / pull - 1)), pulls + 1
    ok(pulls > 1 and worst < 2e-5, f"grains of {radius / R} at {angle} degrees: the bridge of what is left", (pulls, worst))

# ---- a random packing ---------------------------------------------------------------------

run("pack", "-q", *sets("method=soft_spheres", "count=60", f"radius={R}",
                        "periodic=[true,true,false]", "bonds=none"), "-o", at("packing"))
for supply in "isolated", "joined":
    dried(at("packing"), f"rings={supply}")
    time, force, _ = added(30)
    size = np.linalg.norm(force, axis=2).sum(axis=1)
    ok((np.linalg.norm(force.sum(axis=1), axis=1) <= 1e-12 * size.max()).all() and size.max() > 0 and size[0] == 0 and size[-1] == 0,
       f"{supply}: rings pull grains in pairs, from when gas comes to when they are dry", size)
for threads in "1", "2":
    run("force-protocol", "-q", "--threads", threads, *sets("rings.left=drying", "largest_change=0.1"), at("drying"), "-o", at("t" + threads))
ok(filecmp.cmp(at("t1"), at("t2"), shallow=False), "one thread and two give the same bytes")

# Films without resistance join all liquid: one suction, of the throat that empties next, wherever gas parts it.
force = {}
for rule in "uniform", "clusters":
    run("force-protocol", "-q", *sets(f"pressure={rule}", "steps=30", "balanced=false"), at("drying"), "-o", at("forces"))
    with h5py.File(at("forces")) as file:
        force[rule], time = file["force"][:], file["time"][:]
with h5py.File(at("drying")) as file:
    radius, kind, throat, when = (file[name][:] for name in ("throats/radius", "throats/kind", "events/throat", "events/time"))
following = np.searchsorted(when, time, side="right")
wet = following < len(when)
curved = radius[kind == 0].mean() / radius[throat[following[wet]]]
off = abs(force["clusters"][wet] - curved[:, None, None] * force["uniform"][wet]).max() / abs(force["clusters"]).max()
ok(wet.sum() > 5 and off < 1e-12, "joined: all liquid has the suction of the throat that empties next", (wet.sum(), off))

dried(at("packing"))
refused("a drying without rings is refused", "rings.left=drying needs it: dry with rings=isolated, joined or films",
        "force-protocol", "-q", *sets("rings.left=drying"), at("drying"))

# ---- rings of liquid in equilibrium that would be larger than bridges are solved for ------

# Between a large grain and a speck on it a ring of the cube of the effective radius still has a
# suction, above that of wide throats; between equal grains it has none (docs/bridges.md).
for speck in 0.01, 0.5:
    touching = np.full(3, R + (1 + speck) * R / 3**0.5)
    grains = np.column_stack([(2 * grid[grid.max(axis=1) < 3] + 1) * R, np.full(27, R)])
    np.savetxt(at("specks.txt"), np.vstack([grains, [*touching, speck * R]]), fmt="%.17g")
    run("pack", "-q", *sets("method=import", "lower=[0,0,0]", f"upper={[6 * R] * 3}", "bonds=none", "check=none"),
        at("specks.txt"), "-o", at("packing"))
    dried(at("packing"))
    said = subprocess.run([f"{BIN}/force-protocol", *sets("rings.left=suction", "steps=2"), at("drying"), "-o", at("forces")],
                          capture_output=True, text=True, check=True).stderr
    ok(("1 of 55 rings would hold more than the cube" in said) == (speck < 0.1), f"a speck of {speck} grains: whether its ring is cut off is said", said)
done()
