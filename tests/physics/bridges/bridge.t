#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The stage `bridge`: what it writes, checked against itself and against [G Table 1]."""
import json
import math
import subprocess
import sys

sys.path.insert(0, "tests")
from tap import BIN, done, ok, refused, run

W11 = {"radius": 2.381e-3, "volume": 13.6e-12, "surface_tension": 0.0206}
MODELS = ["weigert", "willett-full", "willett-reduced", "rabinovich", "rabinovich-lambert",
          "soulie"]


def bridge(**settings):
    sets = [f"--set={key}={json.dumps(value)}" for key, value in settings.items()]
    return json.loads(run("bridge", *sets))


def bridge_refuses(title, message, **settings):
    refused(title, message, "bridge", *(f"--set={key}={json.dumps(value)}" for key, value in settings.items()))


def revolved(height, radius):
    """Volume between the meridian's circles, by frusta."""
    return sum(math.pi / 3 * (b - a) * (r * r + r * s + s * s)
               for a, b, r, s in zip(height, height[1:], radius, radius[1:]))


def cap(radius, sphere):
    height = sphere - math.sqrt(sphere**2 - radius**2)
    return math.pi * height**2 * (3 * sphere - height) / 3


curve = bridge(**W11, profile=2001, points=21)
ok(abs(curve["rupture_distance"] / 0.000240564283113 - 1) < 1e-8,
   "rupture distance of case W11 as computed by others", curve["rupture_distance"])
ok(all(a > b for a, b in zip(curve["force"], curve["force"][1:])), "the force falls")
ok(not any(curve["flags"]), "the exact force needs no excuse up to rupture", curve["flags"])
worst = max(abs((revolved(p["height"], p["radius"]) - sum(cap(y, 2.381e-3) for y in at))
                / 13.6e-12 - 1)
            for p, at in zip(curve["profile"], curve["contact_radius"]))
ok(worst < 1e-5, "the meridians hold the liquid", worst)
worst = max(abs(2 * math.pi * 0.0206 * n + math.pi * n * n * s - f) / f
            for n, s, f in zip(curve["neck_radius"], curve["suction"], curve["force"]))
ok(worst < 1e-10, "the force at the neck is tension and suction [K 2.3]", worst)

beyond = bridge(**W11, separations=[-1e-5, 0, 1e-4, 1])
ok([bool(f) for f in beyond["force"]] == [True, True, True, False]
   and beyond["flags"] == [["overlaps"], [], [], ["ruptured"]]
   and beyond["suction"][3] is None,
   "overlap and rupture are flagged, and a ruptured bridge does not pull", beyond)

for model in MODELS:
    wild = bridge(radius=1e-3, other_radius=1e-7, volume=1e-18, contact_angle=120,
                  model=model, separations=[-1e-6, 0, 1e-12, 1e-6, 1e3])
    ok(all(map(math.isfinite, wild["force"])) and all(wild["flags"]),
       f"{model} is finite and flagged where it was not made for", wild)
    near = bridge(**W11, model=model, separations=[0, 1e-18])["force"]
    ok(abs(near[1] / near[0] - 1) < 1e-6, f"{model} is continuous at contact", near)

curve = bridge(**W11, points=41, to=0.999)
table = bridge(**W11, model="table", separations=curve["separation"])
worst = max(abs(a / b - 1) for a, b in zip(table["force"], curve["force"]))
ok(worst < 1e-5 and not any(table["flags"]), "the table holds the exact forces to 1e-5", worst)

small = bridge(radius=1e-9, volume=1e-30, contact_angle=20, points=5)
large = bridge(radius=1e3, volume=1e6, contact_angle=20, points=5)
ok(all(abs(1e12 * a - b) <= 1e-12 * b for a, b in zip(small["force"], large["force"])),
   "nanometres and kilometres give the same digits", (small["force"], large["force"]))

bridge_refuses("two kinds of second body are refused", "bridge.other_radius: a plane has none",
               radius=1, volume=1e-3, plane=True, other_radius=2)
bridge_refuses("a profile of an approximation is refused",
               "bridge.profile: only the exact model has one", radius=1, volume=1e-3, profile=9,
               model="soulie")
bridge_refuses("a volume of zero is refused", "bridge.volume: must be > 0 m3, got 0", radius=1, volume=0)
bridge_refuses("a contact angle of 180 degrees is refused",
               "bridge.contact_angle: must be from 0 to 170 degree, got 180", radius=1, volume=1e-3,
               contact_angle=180)
sample = subprocess.run([f"{BIN}/bridge", "-p", "samples/bridge.json"], capture_output=True, text=True)
ok(sample.returncode == 0 and not sample.stderr and json.loads(sample.stdout)["force"] == bridge(**W11)["force"],
   "the sample is W11, and its oil is not taken for water", sample.stderr)
done()
