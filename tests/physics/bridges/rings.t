#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Rings of liquid in packings: one ring against its differential equation integrated here, sums
# over a lattice in closed form, and the suction at which three rings meet.
import filecmp
import json
import subprocess
import sys
from math import asin, cos, pi, radians, sin

import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, refused, run, scratch_paths, sets

R, TENSION = 1e-6, 0.07
at = scratch_paths()


def packing(name, grains, upper, *settings):
    np.savetxt(at(name + ".txt"), grains, fmt="%.17g")
    run("pack", "-q", "-s", "method=import", "-s", "lower=[0,0,0]", "-s", f"upper={list(upper)}", "-s", "bonds=none",
        "-s", "check=none", *sets(*settings), at(name + ".txt"), "-o", at(name))
    return at(name)


def rings(path, suctions, angle=0, *options):
    said = run("rings", "-q", "-s", f"suctions={list(suctions)}", "-s", f"surface_tension={TENSION}", "-s",
               f"contact_angle={angle}", "-s", "fluid=other", *options, path)
    return json.loads(said)


# ---- one ring ---------------------------------------------------------------------------

def meridian(neck, suction, centre, steps=700):
    """From the neck of a ring to the sphere of radius 1 around CENTRE on the axis, lengths in R and
    suction in tension / R: angle under which it arrives, volume, half-filling; None: it does not."""
    def rate(state):
        r, slope = state[0], state[2]
        return np.array([sin(slope), cos(slope), suction + cos(slope) / r, pi * r * r * cos(slope)])
    state, h = np.array([neck, 0, 0, 0.]), 2.5 / suction / steps
    for _ in range(4 * steps):
        a = rate(state)
        b = rate(state + h / 2 * a)
        c = rate(state + h / 2 * b)
        new = state + h / 6 * (a + 2 * b + 2 * c + rate(state + h * c))
        inside = new[0]**2 + (centre - new[1])**2 - 1
        if inside < 0:
            before = state[0]**2 + (centre - state[1])**2 - 1
            state = state + (new - state) * before / (before - inside)
            filling = asin(min(1, state[0]))
            cap = pi * (1 - cos(filling))**2 * (2 + cos(filling)) / 3
            return pi / 2 - filling - state[2], 2 * (state[3] - cap), filling
        state = new
        if state[2] > pi / 2:
            return None
    return None


def ring(gap, suction, angle):
    """Force and volume (in R and tension) of the ring between equal spheres: the widest whose
    contact angle is right."""
    def miss(y, steps=700):
        arrival = meridian(y, suction, 1 + gap / 2, steps)
        return -1 if arrival is None else arrival[0] - angle
    wide = 0.8
    while miss(wide, 300) < 0:
        wide *= 0.95
    # the angle grows as the neck shrinks, until it is too narrow for the sphere to be met
    low, high = wide, wide / 0.95
    for _ in range(40):
        middle = (low + high) / 2
        if miss(middle) < 0:
            high = middle
        else:
            low = middle
    return 2 * pi * low + pi * low**2 * suction, *meridian(low, suction, 1 + gap / 2)[1:]


box = [4 * R, 4 * R, 6 * R]
for gap, suction, angle in (0, 5, 0), (0, 30, 40), (0.05, 8, 0), (0.02, 12, 30):
    two = packing("two", [[2 * R, 2 * R, 1.5 * R, R], [2 * R, 2 * R, (3.5 + gap) * R, R]], box)
    said = rings(two, [suction * TENSION / R], angle)
    force, volume, _ = ring(gap, suction, radians(angle))
    got = said["stress"][0] * 3 * np.prod(box) / ((2 + gap) * R) / (TENSION * R)
    ok(said["rings"] == [1] and abs(said["volume"][0] / R**3 / volume - 1) < 1e-4 and abs(got / force - 1) < 1e-5,
       f"a ring at suction {suction}, gap {gap}, {angle} degrees, is that of Young and Laplace",
       (said["volume"][0] / R**3, volume, got, force))

two = packing("two", [[2 * R, 2 * R, 1.5 * R, R], [2 * R, 2 * R, 3.5 * R, R]], box)
said = rings(two, [1e5 * TENSION / R], 20)
force = said["stress"][0] * 3 * np.prod(box) / (2 * R) / (TENSION * R)
ok(abs(force / (2 * pi * cos(radians(20))) - 1) < 5e-3, "a small ring pulls by 2 pi R tension cos(angle)", force)

# ---- sums -------------------------------------------------------------------------------

grid = np.stack(np.meshgrid(*[np.arange(4)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
lattice = packing("lattice", np.column_stack([(2 * grid + 1) * R, np.full(64, R)]), [8 * R] * 3,
                  "periodic=[true,true,true]")
suctions = [6 * TENSION / R, 60 * TENSION / R]
said, one = rings(lattice, suctions, 10), rings(two, suctions, 10)
pull = np.array(one["stress"]) * 3 * np.prod(box) / (2 * R)
ok(said["rings"] == [192, 192] and np.allclose(said["volume"], 192 * np.array(one["volume"]), rtol=1e-12, atol=0)
   and np.allclose(said["stress"], pull / (2 * R)**2, rtol=1e-12, atol=0),
   "a cubic lattice has three rings a grain and is pressed by a force over (2 R)^2", said)
ok(np.allclose(said["stress_tensor"], [np.eye(3) * s for s in said["stress"]], rtol=1e-12, atol=1e-9 * said["stress"][0]),
   "alike along all axes")
solid = 64 * 4 / 3 * pi * R**3
ok(np.allclose(said["content"], np.array(said["volume"]) / solid, rtol=1e-12) and np.allclose(
    said["saturation"], np.array(said["volume"]) / ((8 * R)**3 - solid), rtol=1e-12), "over grains and void")

# Narrow boxes: grains meet others, and themselves, across several sides.
cell = packing("cell", [[0.3 * R, R, R, R]], [2 * R] * 3, "periodic=[true,true,true]")
alone = rings(cell, suctions, 10)
ok(alone["rings"] == [3, 3] and all(
    np.allclose(alone[key], said[key], rtol=1e-12, atol=1e-9 * said["stress"][0] if key == "stress_tensor" else 0)
    for key in ("content", "saturation", "stress", "stress_tensor")), "one grain in its cell is the cubic lattice", alone)
rng = np.random.default_rng(4)
grains = np.column_stack([rng.random((5, 3)) * 4 * R, R * (0.7 + 0.6 * rng.random(5))])
corners = np.stack(np.meshgrid(*[[0, 4 * R]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
eight = np.vstack([grains + [*corner, 0] for corner in corners])
few = rings(packing("few", grains, [4 * R] * 3, "periodic=[true,true,true]"), suctions, 10)
many = rings(packing("many", eight, [8 * R] * 3, "periodic=[true,true,true]"), suctions, 10)
ok(all(np.array_equal(8 * np.array(few[key]), many[key]) for key in ("contacts", "rings", "meeting")) and all(
    np.allclose(few[key], many[key], rtol=1e-9, atol=0) for key in ("saturation", "stress")),
   "a few grains of many sizes are eight times as many in eight boxes", (few, many))

# What sticks out of the box takes none of its void.
half = packing("half", [[2 * R, 2 * R, 0.2 * R, R], [2 * R, 2 * R, 2.2 * R, R]], [4 * R] * 3)
out = rings(half, suctions)
void = 64 * R**3 - (2 * 4 / 3 * pi - pi * 0.8**2 * (3 - 0.8) / 3) * R**3
ok(np.allclose(np.array(out["saturation"]) * void, out["volume"], rtol=1e-9, atol=0), "void is that of the box where grains stick out", out)

# In a cylinder the void is that of the cylinder.
run("pack", "-q", *sets("method=random_sequential", "count=40", f"radius={R}", "domain.shape=cylinder", f"domain.radius={6 * R}",
                        f"domain.height={12 * R}", "bonds=none", "check=none"), "-o", at("cylinder"))
round_body = rings(at("cylinder"), [2 * TENSION / R])
void = 432 * pi * R**3 - 40 * 4 / 3 * pi * R**3
ok(round_body["rings"][0] > 0 and abs(round_body["saturation"][0] * void / round_body["volume"][0] - 1) < 1e-9 and abs(
    np.trace(round_body["stress_tensor"][0]) / 3 / round_body["stress"][0] - 1) < 1e-12
   and abs(round_body["box_volume"] / (432 * pi * R**3) - 1) < 1e-12, "in a cylinder saturations are of its void", round_body)

# Three grains that touch: rings meet where each fills 30 degrees.
low, high = 2., 8.
for _ in range(14):
    middle = (low + high) / 2
    low, high = (middle, high) if ring(0, middle, 0)[2] > pi / 6 else (low, middle)
three = packing("three", [[2 * R, 2 * R, 2 * R, R], [4 * R, 2 * R, 2 * R, R], [3 * R, (2 + 3**0.5) * R, 2 * R, R]],
                [6 * R] * 3)
said = rings(three, [0.99 * low * TENSION / R, 1.01 * low * TENSION / R])
ok(said["meeting"] == [3, 0] and said["rings"] == [3, 3], "three rings meet when each fills 30 degrees", (low, said["meeting"]))

# ---- a packing --------------------------------------------------------------------------

run("pack", "-q", "-s", "method=soft_spheres", "-s", "count=200", "-s", f"radius={R}", "-s", "sizes.distribution=uniform",
    "-s", f"sizes.smallest={0.5 * R}", "-s", f"sizes.largest={1.5 * R}", "-s", "bonds=none", "-o", at("random"))
for threads in "1", "2":
    run("rings", "-q", "--threads", threads, at("random"), "-o", at("said-" + threads))
ok(filecmp.cmp(at("said-1"), at("said-2"), shallow=False), "one thread and two give the same bytes")
with open(at("said-1"), encoding="utf-8") as file:
    said = json.load(file)
ok(all(np.diff(said["volume"]) < 0) and all(np.diff(said["rings"]) <= 0) and said["rings"][-1] >= said["contacts"] > 200,
   "with suction rings shrink, and those in gaps break", said)

for settings, line in [(["suctions=[2e5,1e5]"], "rings.suctions: must be above 0 and rise, got 100000 Pa"),
                       (["to=4"], "rings.to: must be above rings.from"),
                       (["contact_angle=90"], "rings.contact_angle")]:
    refused(f"{settings[0]} is refused", line, "rings", "-q", *sets(*settings), at("random"))

# A grain inside another is a mistake in the data, not a ring that was not found.
for radius, is_inside in (0.3 * R, True), (R, True), (1.1 * R, False):
    place = 3 * R if is_inside else 4 * R
    np.savetxt(at("inner.txt"), [[R, R, R, R], [3 * R, R, R, R], [place, R, R, radius]], fmt="%.17g")
    run("pack", "-q", *sets("method=import", "bonds=none", "check=none"), at("inner.txt"), "-o", at("inner"))
    ended = subprocess.run([f"{BIN}/rings", "-q", at("inner"), "-o", at("none")], capture_output=True, text=True, check=False)
    ok(ended.returncode == (65 if is_inside else 0) and (not is_inside or "lies inside grain" in ended.stderr and ended.stderr.count("\n") == 1),
       f"a grain of {radius / R:g} R {'inside another is refused' if is_inside else 'beside another is not'}", (ended.returncode, ended.stderr))

# Grains of an extra layer are not there: stages that take all for solid say so.
run("pack", "-q", *sets("counts=[3,3,3]", f"radius={R}", "extra_layer=true"), "-o", at("layered"))
for stage in "rings", "flow":
    refused(f"{stage} refuses an extra layer", f"{stage} takes packings without an extra layer",
            stage, "-q", at("layered"), "-o", at("refused"))
done()
