#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Grains of one's own in a cylinder, ring or sphere: the walls and the porosity are those of the
# domain, whether its shape comes with the grains or with the parameters, and moving grains stay
# within.
import json
import os
import subprocess
import sys
from math import pi

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, refused, run, scratch_paths, sets

at = scratch_paths()
R, H, r = 2e-3, 5e-3, 2e-4
SHAPES = {"cylinder": (["domain.shape=cylinder", f"domain.radius={R}", f"domain.height={H}"], pi * R**2 * H),
          "ring": (["domain.shape=ring", f"domain.radius={R}", "domain.inner_radius=8e-4", f"domain.height={H}"],
                   pi * (R**2 - 8e-4**2) * H),
          "sphere": (["domain.shape=sphere", f"domain.radius={R}"], 4 / 3 * pi * R**3),
          "box with a hole": (["upper=[4e-3,4e-3,5e-3]", "domain.cut.shape=cylinder", "domain.cut.radius=1e-3"],
                              (16 * R**2 / 4 - pi * 1e-6) * H)}


def domain_of(path):
    with h5py.File(path) as file:
        bodies = {k: v[:] for k, v in file["domain/bodies"].items()} if "domain/bodies" in file else {}
        return bodies, dict(file["summary"].attrs), file["particles/position"][:], file["particles/radius"][:], file["domain/lower"][:]


def same(a, b):
    return a.keys() == b.keys() and all(np.allclose(a[k], b[k], rtol=1e-14, atol=1e-16) for k in a)


for shape, (settings, volume) in SHAPES.items():
    made, again, own = at("made"), at("again"), at("own")
    run("pack", "-q", *sets("method=random_sequential", "count=150", f"radius={r}", *settings), "-o", made)
    bodies, summary, x, radius, lower = domain_of(made)
    porosity = 1 - len(radius) * 4 / 3 * pi * r**3 / volume
    run("pack", "-q", *sets("method=import"), made, "-o", again)
    kept, said, *_ = domain_of(again)
    ok(same(bodies, kept) and abs(said["porosity"] - porosity) < 1e-12,
       f"grains that are packed in a {shape} keep it and its porosity when they are imported", (porosity, said["porosity"]))
    facts = json.loads(subprocess.run([f"{BIN}/check", made, "-o", "-"], capture_output=True, text=True).stdout)
    ok(abs(facts["box"]["porosity"] - porosity) < 1e-12, f"check says the porosity of the {shape}", (porosity, facts["box"]["porosity"]))
    np.savetxt(own, np.column_stack([x, radius]), fmt="%.17g")
    middle = [] if "hole" in shape else [f"domain.centre={[R, R, R if shape == 'sphere' else H / 2]}"]
    lower_corner = ["lower=[0,0,0]"] if "hole" in shape else []
    run("pack", "-q", *sets("method=import", *settings, *middle, *lower_corner), own, "-o", again)
    given, said, *_ = domain_of(again)
    ok(same(bodies, given) and abs(said["porosity"] - porosity) < 1e-12, f"grains of a text are put in a {shape}",
       (bodies, given))

# A cylinder of grains around another place, far from it: its middle is that of the grains.
settings, volume = SHAPES["cylinder"]
run("pack", "-q", *sets("method=random_sequential", "count=300", f"radius={r}", *settings), "-o", at("made"))
_, _, x, radius, _ = domain_of(at("made"))
np.savetxt(at("own"), np.column_stack([x + [3, -2, 1], radius]), fmt="%.17g")
run("pack", "-q", *sets("method=import", *settings), at("own"), "-o", at("far"))
bodies, summary, y, _, _ = domain_of(at("far"))
extent = ((y - radius[:, None]).min(0) + (y + radius[:, None]).max(0)) / 2
ok(np.allclose((bodies["lower"][0] + bodies["upper"][0]) / 2, extent, rtol=0, atol=1e-12) and
   np.allclose(bodies["upper"][0] - bodies["lower"][0], [2 * R, 2 * R, H], rtol=0, atol=1e-12),
   "without a centre a cylinder stands in the middle of the grains", bodies)

for name, words in (("with the grains", [at("made")]), ("with the parameters", [*sets(*settings), at("own")])):
    run("pack", "-q", *sets("method=deposition"), *words, "-o", at("settled"))
    bodies, summary, x, radius, _ = domain_of(at("settled"))
    middle = (bodies["lower"][0] + bodies["upper"][0]) / 2
    out = (np.hypot(*(x - middle)[:, :2].T) + radius).max()
    room = pi * R**2 * (bodies["upper"][0] - bodies["lower"][0])[2]
    ok(out < R + 0.02 * r and abs(summary["porosity"] - (1 - len(radius) * 4 / 3 * pi * r**3 / room)) < 1e-9,
       f"grains fall within the cylinder that comes {name}", (out, R, summary["porosity"]))

run("pack", "-q", *sets("method=import", "extra_layer=true"), at("made"), "-o", at("layered"))
porosity = domain_of(at("made"))[1]["porosity"]
top = max(domain_of(at("made"))[2][:, 2] + r)
porosity = 1 - (1 - porosity) * H / (top - domain_of(at("made"))[4][2])
facts = json.loads(subprocess.run([f"{BIN}/check", at("layered"), "-o", "-"], capture_output=True, text=True).stdout)
ok(abs(domain_of(at("layered"))[1]["porosity"] - porosity) < 1e-9 and abs(facts["box"]["porosity"] - porosity) < 1e-9,
   "below an extra layer the porosity is that of the cylinder up to its grains", (porosity, facts["box"]["porosity"]))

low = at("low")
top = float(bodies["upper"][0][2])
run("pack", "-q", *sets("method=import", f"upper=[{bodies['upper'][0][0]},{bodies['upper'][0][1]},{0.9 * (top - bodies['lower'][0][2]) + bodies['lower'][0][2]}]",
                        "check=none"), at("settled"), "-o", low)
shorter = domain_of(low)[0]
ok(abs((shorter["upper"] - shorter["lower"])[0][2] / (bodies["upper"] - bodies["lower"])[0][2] - 0.9) < 1e-9,
   "a lower box cuts the cylinder off, too", shorter)

refused("a cylinder whose box is narrowed is refused", "/domain/bodies: must be at most one cylinder or sphere",
        "pack", "-q", *sets("method=import", "lower=[1e-3,0,0]"), at("made"))
refused("radius expansion of grains in a cylinder is refused", "pack.domain.shape: must be box",
        "pack", "-q", *sets("method=radius_expansion"), at("made"))
with h5py.File(at("made")) as file:
    x, radius = file["particles/position"][:], file["particles/radius"][:]
x[7, :2] = [R * (1 + 0.9), R * (1 + 0.9)] # in a corner of the box, outside the cylinder
np.savetxt(at("own"), np.column_stack([x, radius]), fmt="%.17g")
refused("a grain beyond the round wall is refused", "row 7: the grain is wholly outside",
        "pack", "-q", *sets("method=import", *settings, f"domain.centre={[R, R, H / 2]}"), at("own"))
done()
