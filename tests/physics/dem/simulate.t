#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""simulate against closed forms: fall, rebound, rolling, servo, strain, energy, a silo's flow."""
import json
import math
import os
import shutil
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, refused, run, scratch_paths, sets

at = scratch_paths()
SOFT = {"glass": {"density": 2500, "young_modulus": 1e7, "poisson_ratio": 0.25, "friction": 0.5,
                  "restitution": 0.7}}


def packing(grains, lower=(-1, -1, -1), upper=(1, 1, 1), periodic=(False, False, False), bonds="none"):
    """Grains of rows x, y, z, r as a packing."""
    np.savetxt(at("grains"), np.atleast_2d(np.array(grains, float)), fmt="%.17g")
    scene = {"method": "import", "check": "none", "lower": list(lower), "upper": list(upper),
             "periodic": list(periodic), "bonds": bonds}
    with open(at("pack.json"), "w") as file:
        json.dump(scene, file)
    run("pack", "-q", "-p", at("pack.json"), at("grains"), "-o", at("packing"))
    return at("packing")


def simulate(source, scene, *options, forces=()):
    with open(at("scene.json"), "w") as file:
        json.dump({"materials": SOFT, **scene}, file)
    run("simulate", "-q", "-p", at("scene.json"), source, *forces, "-o", at("motion"), *options)
    return h5py.File(at("motion"))


def near(got, wanted, tolerance, title):
    ok(abs(got - wanted) <= tolerance * abs(wanted), title, f"{got} for {wanted}")


# --- one grain ---------------------------------------------------------------------------------------
motion = simulate(packing([0, 0, 0.9, 1e-3]), {"duration": 0.1})
time, z = motion["snapshots/time"][()], motion["snapshots/position"][:, 0, 2]
ok(np.abs(z - 0.9 + 0.5 * 9.81 * time**2).max() < 1e-12 and len(time) == 21,
   "a grain falls by g t^2 / 2 to rounding, at 21 snapshots", z)
near(motion["summary"].attrs["time"], 0.1, 1e-3, "for as long as was asked")

# Ten runs, each from the packing that the one before wrote, fall as one does.
fall = packing([0, 0, 0.9, 1e-3])
for k in range(10):
    end = simulate(fall, {"duration": 0.01, "time_step": 1e-4, "write": "packing"})
    place, speed = end["particles/position"][0, 2], end["particles/velocity"][0, 2]
    end.close()
    fall = shutil.copy(at("motion"), at("fallen"))
near(place - 0.9, -0.5 * 9.81 * 0.1**2, 1e-9, "a grain falls on from a packing as if it had not stopped")
near(speed, -0.981, 1e-9, "with the velocity of the time of its place")
end = simulate(packing([[0, 0, 0, 1e-3], [1.9e-3, 0, 0, 1e-3]]),
               {"duration": 0, "write": "packing", "groups": {"all": {"initial": {"velocity": [1, 2, 3]}}}})
ok((end["particles/velocity"][:] == [1, 2, 3]).all(), "a run of no duration writes the velocities that it was given")

motion = simulate(packing([0, 0, 0.05 + 1e-3, 1e-3]),
                  {"duration": 0.2, "walls": {"floor": {"point": [0, 0, 0]}}, "time_step_share": 0.02,
                   "record": {"snapshots_every": 1e-4}})
z = motion["snapshots/position"][:, 0, 2] - 1e-3
low = np.argmax(z < 0)
near(z[low + 5:].max(), 0.7**2 * 0.05, 5e-3, "it rebounds to e^2 of its height")

# A sphere on an incline rolls with 5/7 g sin(a) while friction > 2/7 tan(a), else it slides.
for angle, friction in [(0.3, 0.5), (1.0, 0.2)]:
    glass = {"glass": dict(SOFT["glass"], friction=friction)}
    g = [9.81 * math.sin(angle), 0, -9.81 * math.cos(angle)]
    motion = simulate(packing([0, 0, 1e-3, 1e-3]),
                      {"duration": 0.2, "gravity": g, "materials": glass,
                       "walls": {"floor": {"point": [0, 0, 0]}}})
    speed = motion["snapshots/velocity"][:, 0, 0]
    time = motion["snapshots/time"][()]
    rolls = friction > 2 / 7 * math.tan(angle)
    wanted = 5 / 7 * g[0] if rolls else g[0] + friction * g[2]
    slope = (speed[-1] - speed[10]) / (time[-1] - time[10])
    near(slope, wanted, 2e-3, f"on an incline of {angle} rad it {'rolls' if rolls else 'slides'}")

# With rolling friction mu_r it rolls 7/10 v^2 / (mu_r g) far and stands.
glass = {"glass": dict(SOFT["glass"], rolling_friction=0.05, rolling_damping=0.3)}
motion = simulate(packing([0, 0, 1e-3, 1e-3]),
                  {"duration": 0.4, "materials": glass, "walls": {"floor": {"point": [0, 0, 0]}},
                   "groups": {"ball": {"initial": {"velocity": [0.1, 0, 0], "spin": [0, 100, 0]}}}})
near(motion["snapshots/position"][-1, 0, 0], 0.7 * 0.1**2 / (0.05 * 9.81), 2e-2,
     "with rolling resistance a ball rolls as far as energy says")
ok(np.linalg.norm(motion["snapshots/velocity"][-1]) < 1e-4, "and stands then")

# --- walls -------------------------------------------------------------------------------------------
lattice = [[(i + .5) * 2e-3, (j + .5) * 2e-3, (k + .5) * 2e-3, 1e-3]
           for i in range(4) for j in range(4) for k in range(4)]
box = packing(lattice, (0, 0, 0), (8e-3, 8e-3, 8e-3))
sides = {"walls": ["-x", "+x", "-y", "+y", "-z"], "friction": 0}
servo = {"lid": {"point": [0, 0, 8e-3], "normal": [0, 0, -1], "friction": 0,
                 "servo": {"pressure": 500, "largest_speed": 0.01}}}
motion = simulate(box, {"duration": 0.1, "gravity": [0, 0, 0], "box": sides, "walls": servo,
                        "local_damping": 0.5, "law": "linear",
                        "materials": {"glass": {"normal_stiffness": 1e4, "density": 2500}}})
force = motion["history/wall_force"][-1]
near(force[5, 2], 500 * 64e-6, 1e-3, "a servo reaches its pressure times the area between the walls")
near(motion["history/stress"][-1, 2, 2], 500, 2e-3, "the stress of the grains is that pressure")
# Columns of 4 grains: three contacts of two springs in series, and one spring at either wall.
column = 500 * 4e-6 * (3 / (1e4 / 2) + 2 / 1e4)
near(-motion["history/wall_displacement"][-1, 5, 2], column, 2e-3, "the lid sinks as springs in series do")
ok(np.abs(force[4] + force[5]).max() < 1e-3 * force[5, 2], "lid and floor carry the same", force)

# A ball at the bottom of a cylinder swings as a pendulum, slower when it rolls: w^2 = 5/7 g / (R - r).
for friction, share in [(0, 1), (0.5, 5 / 7)]:
    glass = {"glass": dict(SOFT["glass"], friction=friction, restitution=0.2)}
    reach, angle = 20e-3 - 1e-3, 0.02
    motion = simulate(packing([reach * math.sin(angle), 0, -reach * math.cos(angle), 1e-3]),
                      {"duration": 1, "materials": glass, "record": {"snapshots_every": 1e-3},
                       "walls": {"pipe": {"shape": "cylinder", "point": [0, 0, 0], "normal": [0, 1, 0],
                                          "radius": 20e-3}}})
    x, time = motion["snapshots/position"][:, 0, 0], motion["snapshots/time"][()]
    falls = [k for k in range(len(x) - 1) if x[k] > 0 >= x[k + 1]]
    moments = [time[k] + (time[k + 1] - time[k]) * x[k] / (x[k] - x[k + 1]) for k in falls]
    near((moments[-1] - moments[0]) / (len(moments) - 1), 2 * math.pi * math.sqrt(reach / (9.81 * share)), 1e-3,
         f"a ball in a pipe with friction {friction} swings in the time of a pendulum")

# A pipe that turns carries it up to where friction and weight balance: tan(angle) = friction, sliding.
glass = {"glass": dict(SOFT["glass"], friction=0.3, restitution=0.2)}
motion = simulate(packing([[0, 0, -reach, 1e-3]]),
                  {"duration": 0.6, "materials": glass, "local_damping": 0.3,
                   "groups": {"paddle": {"initial": {"spin": [0, 0, 0]}}},
                   "walls": {"pipe": {"shape": "cylinder", "point": [0, 0, 0], "normal": [0, 1, 0],
                                      "radius": 20e-3, "spin": [0, 5, 0]}}})
spin = motion["snapshots/spin"][-1, 0, 1]
near(spin, 5 * 20, 2e-2, "a pipe that turns makes a ball roll on the spot")

# Adhesion holds a grain under a ceiling up to 3/2 pi w R, and a sticky heap has the same bytes on two threads.
ceiling = {"ceiling": {"point": [0, 0, 1e-3], "normal": [0, 0, -1]}}
holds = 2500 * 4 / 3 * math.pi * 1e-9 * 9.81 / (1.5 * math.pi * 1e-3)
for share in 1.05, 0.95:
    motion = simulate(packing([0, 0, 0, 1e-3]), {"duration": 0.1, "walls": ceiling, "adhesion": share * holds,
                                                 "local_damping": 0.9})
    falls = motion["snapshots/position"][-1, 0, 2] < -1e-3
    ok(falls == (share < 1), f"a grain of {1 / share:.2f} times the pull-off force {'falls' if share < 1 else 'hangs'}")
    ok("history/bridges" not in motion and "contacts/bridge_volume" not in motion, "and no liquid is recorded")

# An oedometer of elastic spheres: Hertz, F = 4/3 E* sqrt(R) U^1.5 at a wall of the same material.
press = {"lid": {"point": [0, 0, 2e-3], "normal": [0, 0, -1], "velocity": [0, 0, -1e-3], "material": "glass",
                 "motion": {"times": [0, 0.01, 0.01001], "factors": [1, 1, 0]}},
         "floor": {"point": [0, 0, 0], "material": "glass"}}
motion = simulate(packing([0, 0, 1e-3, 1e-3]), {"duration": 0.03, "gravity": [0, 0, 0], "walls": press})
sunk = -motion["history/wall_displacement"][-1, 1, 2]
modulus = 1e7 / (1 - 0.25**2) / 2
near(motion["history/wall_force"][-1, 1, 2], 4 / 3 * modulus * math.sqrt(1e-3) * (sunk / 2)**1.5, 1e-3,
     "an elastic grain between elastic plates pushes as Hertz says")
near(sunk, 1.0005e-5, 1e-3, "a wall that follows a table of time stops where the table says")

# Of a ball and a floor of two materials the smaller rolling friction counts, whichever comes first by name.
stops = {"density": 2500, "young_modulus": 1e7, "friction": 0.5, "rolling_friction": 0.05}
for names in ("ab", "ba"):
    motion = simulate(packing([0, 0, 1e-3, 1e-3]),
                      {"duration": 0.1, "materials": dict(zip(names, ({**stops, "rolling_friction": 0}, stops))), "material": names[1],
                       "walls": {"floor": {"point": [0, 0, 0], "material": names[0]}},
                       "groups": {"ball": {"grains": [0], "initial": {"velocity": [0.1, 0, 0], "spin": [0, 100, 0]}}}})
    near(motion["snapshots/velocity"][-1, 0, 0], 0.1, 1e-3, f"a floor that does not resist rolling, {names}")

# Before grains touch, their unbalanced ratio says nothing: they are not at rest.
motion = simulate(packing([0, 0, 5e-3, 1e-3]),
                  {"duration": 0.02, "gravity": [0, 0, 0], "walls": {"floor": {"point": [0, 0, 0]}},
                   "groups": {"ball": {"initial": {"velocity": [0, 0, -1]}}}, "stop": {"unbalanced_ratio": 1e-3}})
ok(motion["history/momentum"][-1, 2] > 0, "a grain that flies is not at rest", motion["summary"].attrs["time"])

# --- a box that repeats ------------------------------------------------------------------------------
sc = packing(lattice, (0, 0, 0), (8e-3, 8e-3, 8e-3), (True, True, True))
motion = simulate(sc, {"duration": 0.01, "gravity": [0, 0, 0], "box": {"strain_rate": [0, 0, -0.1]},
                       "law": "linear", "record": {"energy": False},
                       "materials": {"glass": {"normal_stiffness": 1e4, "density": 2500, "friction": 0}}})
height = motion["history/box_upper"][-1, 2] - motion["history/box_lower"][-1, 2]
near(height, 8e-3 * math.exp(-1e-3), 1e-5, "a strained box shrinks by exp(rate time)")
near(motion["history/stress"][-1, 2, 2], 1e4 / 2 * (8e-3 - height) / 4 / 4e-6, 1e-2,
     "and stresses the lattice by its stiffness")
ok("work" not in motion["history"], "record.energy=false keeps no balance")
# Where the box repeats, a plane aslant would be a saw, whose teeth throw grains out.
sc = packing([0.012, 0.005, 0.05, 1e-3], (0, 0, 0), (.02, .02, .06), (True, False, False))
for title, wall, says in [
        ("a slope along a box that repeats", {"normal": [0.3, 0, 1]}, "repeats along x: a plane must be parallel"),
        ("a lid across it", {"normal": [1, 0, 0]}, "repeats along x: a plane must be parallel"),
        ("a pipe aslant", {"shape": "cylinder", "radius": 0.1, "normal": [1, 1, 0]}, "must be along or across")]:
    refused(title, f"simulate.walls.wall: the box {says}" if "repeats" in says else says, "simulate", "-q", sc,
            *sets("duration=0.01", 'materials={"glass":{"young_modulus":1e7}}',
                  "walls=" + json.dumps({"wall": {"point": [0.01, 0, 0], **wall}})), "-o", at("refused"))

# The state at the start has the forces that it begins with, also where nothing follows.
sc = packing([[*place[:3], 1.01e-3] for place in lattice], (0, 0, 0), (8e-3, 8e-3, 8e-3), (True, True, False))
motion = simulate(sc, {"duration": 0, "gravity": [0, 0, 0], "law": "linear", "box": {"walls": ["-z", "+z"]},
                       "materials": {"glass": {"normal_stiffness": 1e4, "density": 2500}}})
near(motion["history/stress"][0, 0, 0], 1e4 / 2 * 2e-5 * 2e-3 / 8e-9, 1e-9, "at the start grains that overlap push each other")
near(motion["history/wall_force"][0, 1, 2], 16 * 1e4 * 1e-5, 1e-9, "and the walls")
ok(np.abs(np.linalg.norm(motion["contacts/force"][:], axis=1) - 0.1).max() < 1e-10, "with the forces of the contacts recorded")
motion = simulate(sc, {"duration": 0, "gravity": [0, 0, 0], "law": "linear", "box": {"walls": ["-z"]},
                       "walls": {"lid": {"point": [0, 0, 8e-3], "normal": [0, 0, -1], "velocity": [0, 0, -1],
                                         "motion": {"times": [0, 1], "factors": [0, 1]}}},
                       "materials": {"glass": {"normal_stiffness": 1e4, "density": 2500, "restitution": 0.1}}})
near(motion["history/wall_force"][0, 1, 2], 16 * 1e4 * 1e-5, 0.01, "a lid that a table of time sets in motion still stands then")

# Grains that overlap at rest, and a lattice that just touches: the strain presses both alike.
pressed = []
for radius in (1e-3, 1.01e-3):
    sc = packing([[*place[:3], radius] for place in lattice], (0, 0, 0), (8e-3, 8e-3, 8e-3), (True, True, True))
    motion = simulate(sc, {"duration": 0.01, "gravity": [0, 0, 0], "box": {"strain_rate": [0, 0, -0.1]},
                           "law": "linear", "prestress": False, "time_step": 1e-5,
                           "materials": {"glass": {"normal_stiffness": 1e4, "density": 2500, "friction": 0}}})
    pressed.append(motion["history/stress"][-1, 2, 2])
near(pressed[1], pressed[0], 1e-9, "prestress=false: a strain presses grains that overlapped at rest")
refused("but not beside walls", "simulate.prestress: must be true with box.strain_rate and walls", "simulate", "-q", sc,
        *sets("duration=0.01", 'materials={"glass":{"young_modulus":1e7}}', "box.strain_rate=[0,0,-0.1]", "prestress=false",
              'walls={"ball":{"shape":"sphere","radius":1e-6,"outside":true,"point":[0,0,0]}}'), "-o", at("refused"))


# A close-packed lattice: shear springs feel the strain of the box as they feel any other motion.
edge = 2e-3 * math.sqrt(2)
close = [[(i + x + .1) * edge, (j + y + .1) * edge, (k + z + .1) * edge, 1e-3]
         for i in range(3) for j in range(3) for k in range(3)
         for x, y, z in ((0, 0, 0), (.5, .5, 0), (.5, 0, .5), (0, .5, .5))]
sc = packing(close, (0, 0, 0), (3 * edge,) * 3, (True, True, True))
motion = simulate(sc, {"duration": 0.01, "gravity": [0, 0, 0], "box": {"strain_rate": [0, 0, -0.01]}, "law": "linear",
                       "materials": {"glass": {"normal_stiffness": 2e4, "shear_stiffness": 1e4, "density": 2500,
                                               "friction": 10, "damping_ratio": 0}}})
strain = np.diag([0, 0, motion["history/box_upper"][-1, 2] / (3 * edge) - 1])
wanted = np.zeros((3, 3))
for way in ((1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 0, -1), (0, 1, 1), (0, 1, -1)):
    n = np.array(way) / math.sqrt(2)
    apart = 2e-3 * strain @ n
    along = n * (n @ apart)
    wanted -= 4 / edge**3 * np.outer(2e-3 * n, 1e4 * along + 5e3 * (apart - along))
stress = motion["history/stress"][-1]
ok(np.abs(stress - wanted).max() < 1e-3 * wanted.max(), "a strain shears the contacts of a close-packed lattice", (stress, wanted))

# Grains that touch in two images at once would feel one of them.
narrow = packing([[1e-3, 1e-3, 1e-3, 1e-3]], (0, 0, 0), (5e-3, 5e-3, 5e-3), (True, True, True))
with open(at("scene.json"), "w") as file:
    json.dump({"materials": SOFT, "duration": 0.2, "gravity": [0, 0, 0], "box": {"strain_rate": [0.5, 0.5, -1]}}, file)
ended = subprocess.run([f"{BIN}/simulate", "-q", "-p", at("scene.json"), narrow, "-o", at("refused")], capture_output=True)
ok(ended.returncode == 3 and b"s: periodic box is 0.004" in ended.stderr, "a strain that makes the box too narrow ends the run", ended)

# Grains pressed together and sheared: the box does the work that their stress says.
wild = np.random.default_rng(3)
pressed = [[*((np.array([i, j, k]) + .5 + wild.uniform(-.12, .12, 3)) * 2e-3), wild.uniform(.9e-3, 1.2e-3)]
           for i in range(5) for j in range(5) for k in range(5)]
hertz = {"gravity": [0, 0, 0], "largest_overlap": 1,
         "materials": {"glass": {"young_modulus": 5e7, "density": 2500, "friction": 0.5, "restitution": 0.3}}}
simulate(packing(pressed, (0, 0, 0), (.01, .01, .01), (True, True, True)),
         {**hertz, "duration": 0.01, "local_damping": 0.3, "write": "packing"})
shutil.copy(at("motion"), at("rest"))
motion = simulate(at("rest"), {**hertz, "duration": 0.02, "box": {"strain_rate": [-1, .5, .5]}, "record": {"every": 2e-5}})
history = motion["history"]
power = ((history["box_upper"][:] - history["box_lower"][:]).prod(1) *
         (history["stress"][:, 0, 0] - .5 * history["stress"][:, 1, 1] - .5 * history["stress"][:, 2, 2]))[1:]
done_by_stress = (0.5 * (power[1:] + power[:-1]) * np.diff(history["time"][1:])).sum()
near(history["work"][-1] - history["work"][1], done_by_stress, 0.01, "the work of a strained box is that of its stress")
books = (history["kinetic_energy"][:] + history["elastic_energy"][:] + history["dissipation"][:].sum(1) - history["work"][:])
ok(abs(books[-1] - books[1]) < 0.01 * done_by_stress, "and is in the books", books[-1] - books[1])


# Grains that touch nothing move with the box: the velocity that is written says so, and a strain that goes on takes it back.
loose = np.array([[1e-3, 2e-3, 3e-3, 2e-4], [5e-3, 5e-3, 6e-3, 2e-4]])
box = {"gravity": [0, 0, 0], "duration": 0.01}
strained = {**box, "box": {"strain_rate": [0, 0, -0.1]}, "write": "packing"}
end = simulate(packing(loose, (0, 0, 0), (8e-3, 8e-3, 8e-3), (True, True, True)), strained)
place, velocity = end["particles/position"][:], end["particles/velocity"][:]
ok(np.allclose(velocity, [0, 0, -0.1] * place, rtol=1e-12, atol=0), "loose grains move with a strained box", velocity)
shutil.copy(at("motion"), at("strained"))
ok(np.allclose(simulate(at("strained"), strained)["particles/velocity"][:, 2], math.exp(-1e-3) * velocity[:, 2], rtol=1e-5, atol=0),
   "also where the strain goes on")
moved = simulate(at("strained"), {**box, "write": "packing"})["particles/position"][:, 2] - place[:, 2]
span = moved / velocity[:, 2]
ok(abs(span[1] / span[0] - 1) < 1e-9 and abs(span[0] - 0.01) < 2e-4, "and go on by themselves where it does not", span)

# --- bonds -------------------------------------------------------------------------------------------
# A ball breaks a bond at 0.02 s, then small grains close in on another ball and shorten the time step.
turns = [math.acos(1 - (2 * k + 1) / 24) for k in range(24)]
out = np.array([[math.sin(a) * math.cos(2.4 * k), math.sin(a) * math.sin(2.4 * k), math.cos(a)]
                for k, a in enumerate(turns)])
grains = [[0, 0, 0, 1e-3], [2e-3, 0, 0, 1e-3], [24e-3, 0, 0, 1e-3], [0.1, 0, 0, 1e-3]]
grains += [[0.1 + x, y, z, 2e-4] for x, y, z in 2e-3 * out]
starts = {"ball": {"grains": [2], "initial": {"velocity": [-1, 0, 0]}},
          **{f"small{k}": {"grains": [4 + k], "initial": {"velocity": list(-way / 50)}} for k, way in enumerate(out)}}
motion = simulate(packing(grains, bonds="touching"),
                  {"duration": 0.045, "gravity": [0, 0, 0], "groups": starts, "record": {"every": 1e-4},
                   "bond": {"kind": "parallel", "normal_strength": 1e3, "normal_stiffness": 1e9,
                            "shear_stiffness": 1e9}})
ran = motion["summary"].attrs
opened = motion["history/time"][np.argmax(motion["history/dissipation"][:, 3] > 0)]
ok(ran["cycles"] * ran["time_step"] < 0.9 * ran["time"] and 0 <= opened - motion["cracks/time"][0] < 1.1e-4,
   "a crack has its time, also where the time step is shortened later", (opened, motion["cracks/time"][()]))

# --- balance -----------------------------------------------------------------------------------------
def imbalance(step):
    rng = np.random.default_rng(7)
    grains = np.column_stack([rng.uniform(2e-3, 18e-3, (60, 2)), np.arange(60) * 2.5e-3 + 2e-3,
                              rng.uniform(0.8e-3, 1.2e-3, 60)])
    turning = {"floor": {"shape": "ring", "point": [10e-3, 10e-3, 0], "radius": 15e-3, "spin": [0, 0, 20]}}
    motion = simulate(packing(grains, (0, 0, 0), (20e-3, 20e-3, 160e-3)),
                      {"duration": 0.15, "time_step": step, "walls": turning,
                       "box": {"walls": ["-x", "+x", "-y", "+y"]}})
    h = motion["history"]
    return max(abs(h["kinetic_energy"] + h["elastic_energy"][()] + h["dissipation"][()].sum(axis=1) - h["work"]
                   - h["kinetic_energy"][0] - h["elastic_energy"][0])) / h["work"][-1]


errors = [imbalance(step) for step in (8e-6, 2e-6)]
ok(errors[0] < 1e-2 and errors[1] < errors[0] / 3, "work = energy + dissipation, the better the shorter the step",
   errors)

# --- a driven wet cell: a floor of glued grains and a shell turn about z, the core stands --------------
CELL = {"method": "random_sequential", "count": 300, "radius": 6e-4, "seed": 1, "bonds": "none", "check": "none",
        "domain": {"shape": "ring", "inner_radius": 3e-3, "radius": 9e-3, "height": 6e-3, "centre": [0, 0, 3e-3]}}
with open(at("pack.json"), "w") as file:
    json.dump(CELL, file)
run("pack", "-q", "-p", at("pack.json"), "-o", at("cell"))


def wet_cell(step, duration, **more):
    pipe = {"shape": "cylinder", "point": [0, 0, 0]}
    return simulate(at("cell"), {
        "duration": duration, "time_step": step,
        "walls": {"floor": {"point": [0, 0, 0]}, "core": {**pipe, "radius": 3e-3, "outside": True},
                  "shell": {**pipe, "radius": 9e-3, "spin": [0, 0, 20]}},
        "groups": {"rough": {"driven": True, "upper": [1, 1, 1.4e-3], "spin": [0, 0, -15]}},
        "bridges": {"volume": 2e-12, "surface_tension": 0.07, "model": "willett-full", "walls": True}, **more})


def books(step):
    """What is missing in the balance, over the work; and the shares of it that bridges and slip took."""
    h = wet_cell(step, 0.05)["history"]
    kept, lost = h["kinetic_energy"] + h["elastic_energy"][()], h["dissipation"][()]
    missing = kept + lost.sum(axis=1) - h["work"] - kept[0]
    return np.abs(missing).max() / h["work"][-1], lost[-1] / h["work"][-1]


(coarse, _), (fine, lost) = books(8e-6), books(2e-6)
ok(fine < 1e-3 and fine < coarse / 3 and min(lost[[0, 1, 4]]) > 10 * fine,
   "wet and driven: work of walls and groups = energy + dissipation, of first order", (coarse, fine, lost))

# Leapfrog keeps both momenta to rounding: what they change by is the sum of the loads of all steps.
step, steps = 5e-6, 4000
motion = wet_cell(step, step * steps, record={"every": step, "snapshots_every": step * steps})
h = motion["history"]
mass, radius = motion["particles/mass"][()], motion["particles/radius"][()]
free = motion["snapshots/position"][0, :, 2] > 1.4e-3
x, v, spin = (motion[f"snapshots/{name}"][:, free] for name in ("position", "velocity", "spin"))
weight = mass[free].sum() * np.array([0, 0, -9.81])
force = h["wall_force"][1:].sum(axis=1) + h["group_force"][1:].sum(axis=1)
impulse = (weight - force).sum(axis=0) * step
momentum = (mass[free, None] * v).sum(axis=1)
scale = np.abs(force).sum() * step
ok(len(force) == steps and np.abs(momentum[-1] - momentum[0] - impulse).max() < 1e-13 * scale,
   "its momentum changes by what walls, groups and weight give", (momentum, impulse))
turning = h["wall_moment"][1:, :, 2].sum(axis=1) + h["group_moment"][1:, :, 2].sum(axis=1)
angular = (mass[free] * (x[..., 0] * v[..., 1] - x[..., 1] * v[..., 0] + 0.4 * radius[free]**2 * spin[..., 2])).sum(axis=1)
given = -turning.sum() * step
ok(abs(angular[-1] - angular[0] - given) < 1e-13 * np.abs(turning).sum() * step and abs(given) > 1e-10,
   "its angular momentum about the axis by what they turn it with", (angular, given))

# --- the same however it is run ------------------------------------------------------------------------
sample = "samples/slump.json"
run("pack", "-q", "-p", sample, "-o", at("slump"))
short = ["-q", "-p", sample, "--set", "duration=0.02", "--set", "bridges.volume=2e-12", at("slump")]
bytes_of = lambda *more: run("simulate", *short, *more)
one = bytes_of()
ok(one == bytes_of("--threads", "2"), "two threads write the same bytes")
scene = json.load(open(sample))
scene["simulate"]["walls"] = dict(reversed(scene["simulate"]["walls"].items()))
json.dump(scene, open(at("turned.json"), "w"))
ok(one == run("simulate", "-q", "-p", at("turned.json"), *short[3:]),
   "the order in which walls are written does not count")

# --- what others make of it ----------------------------------------------------------------------------
run("simulate", *short, "--set", "write=packing", "-o", at("end"))
with h5py.File(at("end")) as end:
    run("simulate", *short, "-o", at("motion"))
    with h5py.File(at("motion")) as motion:
        ok((end["particles/position"][()] == motion["snapshots/position"][-1]).all(),
           "write=packing has the grains as they are at the end")
ok(len(run("tessellate", at("end"))) > 1000, "which tessellate takes")
with open(at("still.json"), "w") as file:
    json.dump({"materials": SOFT, "duration": 0, "write": "packing"}, file)
run("simulate", "-q", "-p", at("still.json"), at("cell"), "-o", at("still"))
for key in "porosity", "coordination", "max_overlap":
    near(h5py.File(at("still"))["summary"].attrs[key], h5py.File(at("cell"))["summary"].attrs[key], 1e-12,
         f"its {key} is that of pack, in a ring")

out = subprocess.run([os.path.join(BIN, "simulate"), "-p", at("still.json"), "--set", "duration=0.01",
                      packing([0, 0, 0, 1e-3], (-2e-3,) * 3, (2e-3, 2e-3, 4e-3)), "-o", at("out")], stderr=subprocess.PIPE)
ok(out.returncode == 0 and not out.stderr, "nothing is said of a grain that stays in its box", out)
out = subprocess.run([*out.args, "--set", "duration=0.1"], stderr=subprocess.PIPE)
ok(b"1 of 1 grains, grain 0 the first, end outside" in out.stderr, "a grain that ends outside of it is reported", out)

# Two grains that touch, and a bond between them.
pair = packing([[0, 0, 0, 1e-3], [2e-3, 0, 0, 1e-3]], (-2e-3,) * 3, (4e-3, 2e-3, 2e-3), bonds="touching")
for kind, bonds, said in ("none", 0, b"none of its 1 bonds are in the packing written"), ("parallel", 1, b""):
    out = subprocess.run([*out.args[:3], "--set", f"bond.kind={kind}", pair, "-o", at("out")], stderr=subprocess.PIPE)
    with h5py.File(at("out")) as file:
        ok(len(file["bonds/particles"]) == bonds and (said in out.stderr if said else not out.stderr),
           f"bond.kind={kind} writes {bonds} of 1 bonds and says so", out)

# Three grains that all touch, 0 and 1 across a side of a narrow box that repeats: no line runs through the box.
narrow = packing([[0.6e-3, 0, 0, 1e-3], [3.65e-3, 0, 0, 1e-3], [2.1e-3, 1.2e-3, 0, 1e-3]], (0, -5e-3, -5e-3),
                 (5e-3, 5e-3, 5e-3), (True, False, False))
with simulate(narrow, {"duration": 1e-6, "gravity": [0, 0, 0]}) as motion:
    ok(motion["contacts/particles"][:3].tolist() == [[0, 1], [0, 2], [1, 2]], "three grains touch")
run("inspect", "--vtk", at("narrow"), at("motion"))
with open(at("narrow-0000.vtu")) as file:
    lines = file.read().split('Name="connectivity"')[1].split("<")[0].split(">")[1].split()
ok(lines == ["0", "2", "1", "2"], "ParaView gets the contacts within the box", lines)
done()
