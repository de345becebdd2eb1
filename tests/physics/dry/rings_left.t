#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Rings that gas leaves behind in `invade`, against the sums that `rings` makes over all contacts and
# gaps of the packing, which knows no network.
import filecmp
import json
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, refused, run, scratch_paths, sets

R, TENSION = 1e-6, 0.07
LIQUID = "fluid=other", f"surface_tension={TENSION}"
at = scratch_paths()


def network(name, packing, angle=0):
    settings = sets("throat_volume=void", "throat_radius=entry", f"contact_angle={angle}")
    run("tessellate", "-q", *settings, packing, "-o", at("diagram"))
    run("merge-nodes", "-q", at("diagram"), "-o", at(name))
    return at(name)


def invade(path, *settings, angle=0):
    run("invade", "-q", *sets(*LIQUID, f"contact_angle={angle}", *settings), path, "-o", at("invasion"))
    with h5py.File(at("invasion")) as file:
        said = {name: file[name][:] for name in ("events/pressure", "events/saturation", "curve/pressure", "throats/volume")}
        said.update({name: file[name][:] for name in ("events/ring_saturation", "rings/volume", "rings/separation",
                                                      "curve/ring_saturation", "rings/face") if name in file})
        said["residual"] = file["summary"].attrs["residual_saturation"]
    said["void"] = said["throats/volume"].sum()
    return said


def rings(path, suctions, angle=0):
    return json.loads(run("rings", "-q", *sets(*LIQUID, f"contact_angle={angle}",
                                               "suctions=" + json.dumps(list(suctions))), path))


def imported(name, grains, upper, *settings):
    np.savetxt(at(name + ".txt"), grains, fmt="%.17g")
    run("pack", "-q", *sets("method=import", "lower=[0,0,0]", f"upper={list(upper)}", "bonds=none", "check=none",
                            *settings), at(name + ".txt"), "-o", at(name))
    return at(name)


# ---- a random packing -------------------------------------------------------------------

run("pack", "-q", *sets("method=soft_spheres", "count=200", f"radius={R}", "sizes.distribution=normal",
                        "sizes.spread=0.2", "periodic=[true,true,false]", "bonds=none"), "-o", at("packing"))
for angle in 0, 40:
    net = network("network", at("packing"), angle)
    said = invade(net, "rings=joined", "trapping=false", "liquid_in=pores", angle=angle)
    last, before = said["curve/pressure"][-1], said["curve/pressure"][-40]
    exact = rings(at("packing"), [before, last], angle)
    ok(len(said["rings/volume"]) == exact["rings"][1] and abs(said["rings/volume"].sum() / exact["volume"][1] - 1) < 1e-12
       and abs(said["residual"] * said["void"] / exact["volume"][1] - 1) < 1e-12,
       f"drained, at {angle} degrees, it holds the rings of all contacts and gaps",
       (len(said["rings/volume"]), exact["rings"], said["rings/volume"].sum(), exact["volume"]))
    between = said["curve/ring_saturation"][-40] * said["void"] / exact["volume"][0]
    ok(abs(between - 1) < 1e-3, "so it does in between, to a thousandth of 200 grains", between)

plain = invade(net, "trapping=false", angle=40)
kept = invade(net, "rings=isolated", "trapping=false", angle=40)
ok(np.array_equal(plain["events/pressure"], kept["events/pressure"]) and
   np.allclose(kept["events/saturation"] - kept["events/ring_saturation"], plain["events/saturation"], rtol=0, atol=1e-13),
   "rings change neither the order nor what throats hold")
ok(all(np.diff(kept["events/ring_saturation"]) >= 0) and all(np.diff(kept["events/saturation"]) < 1e-15) and
   abs(kept["rings/volume"].sum() / kept["void"] - kept["residual"]) < 1e-13, "isolated, they only add up")
for threads in "1", "2":
    for supply in "isolated", "joined":
        run("invade", "-q", "--threads", threads, *sets("trapping=false", f"rings={supply}"), net, "-o", at(supply + threads))
ok(all(filecmp.cmp(at(s + "1"), at(s + "2"), shallow=False) for s in ("isolated", "joined")),
   "one thread and two give the same bytes")

# ---- settled grains, with wide throats at the top: rings there do not grow as the suction falls ----

run("pack", "-q", *sets("method=deposition", "count=60", f"radius={R}"), "-o", at("settled"))
said = invade(network("network", at("settled"), 0), "rings=joined", "trapping=false", "liquid_in=pores")
rises = max(np.diff(said["events/saturation"]))
ok(said["events/pressure"][0] < 0.9 * TENSION / R and rises < 1e-15, "joined, they never fill as the pressure rises", rises)

# ---- lattices: all throats are alike, and empty at one suction ----------------------------

grid = np.stack(np.meshgrid(*[np.arange(4)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)


def lattice(radius, other=None):
    """Cubic, 2 R wide cells, every second grain of the radius OTHER."""
    sizes = np.where(grid.sum(axis=1) % 2, radius, other or radius)
    return imported("lattice", np.column_stack([(2 * grid + 1) * R, sizes]), [8 * R] * 3, "periodic=[true,true,false]")


for radius, angle, what in ((R, 0, "touch"), (1.02 * R, 20, "overlap"), (0.98 * R, 0, "are apart"),
                            (R, 60, "touch, at 60 degrees"), (R, 70, "touch, at 70 degrees")):
    packing = lattice(radius)
    said = invade(network("network", packing, angle), "rings=isolated", "trapping=false", angle=angle)
    exact = rings(packing, [said["events/pressure"].min() * (1 - 1e-12)], angle)
    missing = abs(said["rings/volume"].sum() / exact["volume"][0] - 1)
    ok(np.ptp(said["events/pressure"]) < 1e-9 * said["events/pressure"][0] and missing < 1e-9,
       f"grains that {what}: isolated rings are those at the one suction", missing)

said = invade(network("network", lattice(1.96 * R, 0.04 * R), 10), "rings=isolated", "trapping=false", angle=10)
ok(0.1 < said["residual"] <= 0.9,
   "radii 1 to 49, where rings would hold more than the void: throats keep nine tenths at most", said["residual"])

wide = invade(network("network", lattice(0.8 * R)), "rings=isolated", "trapping=false")
ok(len(wide["rings/volume"]) == 0 and wide["residual"] == 0, "across gaps beyond rupture there are none", wide["residual"])

# ---- refusals ---------------------------------------------------------------------------

for settings, line in [(["rings=joined"], "invade.trapping: must be false with rings=joined"),
                       (["rings=joined", "trapping=false", "gravity=9.81", "liquid_density=1000"],
                        "invade.gravity: must be 0 with rings=joined")]:
    refused(f"{settings} is refused", line, "invade", "-q", *sets(*settings), net)
done()
