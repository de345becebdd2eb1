# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard cases of moving grains (simulate)."""
import json
import subprocess

import h5py
import numpy as np

from cases import case, must
from tap import BIN

RADIUS, MASS = 1e-3, 2500 * 4 / 3 * np.pi * 1e-9
WEIGHT = 9.81 * MASS


def settings(values):
    return [word for key, value in values.items() for word in ("--set", f"{key}={json.dumps(value)}")]


def start(scene):
    scene.stage("pack", *settings({"check": "none"} if scene.json["pack"]["method"] == "import" else {}))


def simulate(scene, **values):
    """Runs the scene with VALUES, __ for a dot; gives what it says."""
    values = {key.replace("__", "."): value for key, value in values.items()}
    status, message = scene.try_stage("simulate", *settings(values), input=scene.at("pack"))
    must(status == 0, f"{values}: exit {status}: {message}")
    return message


def refused(scene, status, pattern, **values):
    values = {key.replace("__", "."): value for key, value in values.items()}
    return scene.refused("simulate", status, pattern, "-q", *settings(values), input=scene.at("pack"))


@case("simulate-no-grains")
def no_grains(scene):
    start(scene)
    with h5py.File(scene.at("pack"), "r+") as file:
        for name in ("particles/position", "particles/radius", "bonds/particles"):
            rows, attributes = file[name][:0], dict(file[name].attrs)
            del file[name]
            file[name] = rows
            file[name].attrs.update(attributes)
    return refused(scene, 65, "/particles: has no grains")


@case("simulate-one-grain")
def one_grain(scene):
    start(scene)
    free = {"walls": {}, "groups": {"one": {"initial": {"velocity": [0.1, -0.2, 0.3]}}}}
    simulate(scene, **free, gravity=[0, 0, 0])
    place = scene.get("simulate", "snapshots/position")[:, 0] - [0, 0, RADIUS]
    flown = scene.get("simulate", "snapshots/time")[:, None] * [0.1, -0.2, 0.3]
    error = np.abs(place - flown).max()
    steps = 0.5 / scene.summary("simulate", "time_step")
    must(error < steps * 2**-53 * np.abs(flown).max(), f"flies {error:.1e} m off in {steps:.0f} steps")
    simulate(scene)
    depth = RADIUS - scene.get("simulate", "snapshots/position")[-1, 0, 2]
    effective = 1e7 / (1 - 0.25**2)  # the wall is rigid
    hertz = (WEIGHT / (4 / 3 * effective * np.sqrt(RADIUS))) ** (2 / 3)
    off = abs(depth / hertz - 1)
    must(off < 1e-6, f"lies {depth:.6e} m deep, Hertz {hertz:.6e}")
    said = refused(scene, 3, "a grain or its surface would move more than 0.1 mean radii", walls={}, duration=9)
    return f"depth off by {off:.0e}; {said[:60]}..."


@case("simulate-crush")
def crush(scene):
    start(scene)
    message = r"at \S+ s two grains overlap by \S+ mean radii, above largest_overlap=0.5, under a mean pressure of "
    said = refused(scene, 3, message)
    pressure = []
    for speed in (-0.01, -0.1, -1):
        more = refused(scene, 3, message, walls__lid__velocity=[0, 0, speed])
        pressure.append(float(more.split("pressure of ")[1].split()[0]))
    # Two grains of 0.5 mean radii of overlap carry some F/(2 r)^2 of Hertz.
    force = 4 / 3 * 1e7 / (1 - 0.25**2) / 2 * np.sqrt(RADIUS / 2) * (RADIUS / 2) ** 1.5
    scale = force / (2 * RADIUS) ** 2
    must(all(0.05 < p / scale < 2 for p in pressure), f"pressures {pressure}, scale {scale:.3g}")
    refused(scene, 65, r"walls.lid: moves by \S+ mean radii in a time step", walls__lid__velocity=[0, 0, -100])
    with open(scene.at("one"), "w") as file:
        file.write("3e-3 3e-3 1e-3 1e-3\n")
    scene.stage("pack", *settings({"method": "import", "check": "none", "lower": [0, 0, 0],
                                   "upper": [6e-3, 6e-3, 6e-3]}), input=scene.at("one"))
    refused(scene, 3, r"at \S+ s wall \S+, pushed with \S+ N, and a grain overlap by \S+ mean radii")
    return said


@case("simulate-servo")
def servo(scene):
    start(scene)
    must(not simulate(scene), "it complains of a servo that holds")
    lost = r"walls.lid: ends with a force of 0 N, its servo is to reach 0.01 N: grains give way"
    away = {"point": [0, 0, 12e-3], "normal": [0, 0, -1], "servo": {"force": 0.01, "largest_speed": 0.1}}
    table = {"motion": {"times": [0, 0.01], "factors": [0, 1]}}
    for lid in (away, {**away, **table}):
        said = simulate(scene, walls={"lid": lid})
        must(lost in said and "\n" not in said, f"says {said!r}")
    refused(scene, 3, "overlap by", walls__lid__servo__force=1e3, duration=1)
    oblique = {"point": [0, 0, 12e-3], "normal": [0, 1, -1], "servo": {"pressure": 10, "largest_speed": 0.1}}
    refused(scene, 65, "walls.lid.servo.area: must be given", walls={"lid": oblique})
    return said.split(": ", 1)[1]


def exact(separations, **values):
    """Forces at SEPARATIONS and the distance of rupture, by the program bridge."""
    command = [f"{BIN}/bridge", *settings({**values, "surface_tension": 0.0728, "contact_angle": 20,
                                           "separations": list(separations)})]
    got = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    return np.array(got["force"]), got["rupture_distance"]


def pulled(scene, radii, volume, **values):
    """Largest relative error of the pull of the bridge between grains 0 and 1, as they part, short of
    the last hundredth before rupture, where the force falls as a root; and how many distances."""
    simulate(scene, bridges__volume=volume, **values)
    rows = (scene.get("simulate", "contacts/particles") == [0, 1]).all(axis=1)
    gap = np.maximum(-scene.get("simulate", "contacts/overlap")[rows], 0)
    pull = scene.get("simulate", "contacts/bridge_force")[rows]
    must(len(gap) < len(scene.get("simulate", "snapshots/time")), "it never ruptures")
    wanted, rupture = exact(gap, radius=radii[0], other_radius=radii[1], volume=volume)
    step = np.diff(gap).max()
    must(gap[-1] < rupture * (1 + 1e-3) < gap[-1] + 1.01 * step + 2e-3 * rupture,
         f"last seen at {gap[-1]:.6e} m, ruptures at {rupture:.6e} m")
    sure = gap < 0.99 * rupture
    must(sure.sum() > 20, f"{sure.sum()} distances")
    return np.abs(pull / wanted - 1)[sure].max(), len(gap)


@case("simulate-bridges")
def bridges(scene):
    start(scene)
    worst, distances = 0, 0
    for volume, speed, time in ((1e-9, 0.1, 3e-5), (0.5, 2, 6e-4)):
        error, n = pulled(scene, (RADIUS, RADIUS), volume * RADIUS**3, duration=time,
                          groups__upper__velocity=[0, 0, speed], record__snapshots_every=time / 300)
        must(error < 1e-5, f"V* = {volume}: off by {error:.1e}")
        worst, distances = max(worst, error), distances + n
    return f"{distances} distances, off by {worst:.0e} at most"


@case("simulate-ratio-20")
def ratio_20(scene):
    start(scene)
    error, n = pulled(scene, (RADIUS, RADIUS / 20), 1.25e-15)
    must(error < 1e-4, f"off by {error:.1e}")
    place = scene.get("simulate", "snapshots/position")[:, 2:]
    moved = np.abs(place - place[0]).max() / RADIUS
    must(moved < 5e-3, f"small grains left alone move by {moved:.1e} radii of the large one")
    return f"{n} distances, off by {error:.0e} at most"


@case("simulate-turning-wall")
def turning_wall(scene):
    start(scene)
    simulate(scene, gravity=[0, 0, 0])
    moment = np.abs(scene.get("simulate", "history/wall_moment")).max()
    must(moment == 0, f"torque {moment} of a wall that touches nothing")
    disc = {"point": [0, 0, -RADIUS], "spin": [0, 0, 30]}
    simulate(scene, walls={"disc": disc})
    force, moment = (scene.get("simulate", f"history/wall_{name}")[:, 0] for name in ("force", "moment"))
    must(np.abs(moment).max() < 1e-12 * RADIUS * WEIGHT, f"torque {np.abs(moment).max()} about a grain on the axis")
    must(abs(force[-1, 2] / WEIGHT + 1) < 1e-6, f"carries {force[-1]} N")
    simulate(scene, duration=2, local_damping=0.3)  # else it swings for ever
    torque = scene.get("simulate", "history/wall_moment")[:, 0, 1] / (4 * RADIUS * WEIGHT)
    early, late = np.abs(torque[:100]).max(), np.abs(torque[-20:]).max()
    must(early > 0.05 and late < 1e-3, f"torque over weight times lever {early:.1e} at first, {late:.1e} at last")
    return f"0; 0; {late:.0e} of weight times lever, after {early:.1g}"
