# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard cases of the replay: by cycles and in equilibrium."""
import json
import os
import re

import numpy as np

from cases import case, must
from scene import CHAIN, QUASI_STATIC, pull, write_forces
from tap import read, sets


@case("bond-strength")
def bond_strength(scene):
    scene.stages("pack")
    strength = 1e-6
    pull(scene, strength * np.pi * 0.25)

    def breaks(times, *engine):
        scene.stage("dem-replay", "-q", "--set", f"bond.normal_strength={strength / times!r}",
                    "--set", "bond.shear_strength=1e9", *engine)
        mode = scene.get("dem-replay", "cracks/mode").tolist()
        must(mode in ([], [0]), f"cracks in modes {mode}")
        return bool(mode)

    must(not breaks(1 - 1e-12), "breaks at (1 - 1e-12) of the strength")
    must(breaks(1 + 1e-12), "holds at (1 + 1e-12) of the strength")
    low, high = -1e-12, 1e-12
    while high - low > 1e-16:
        middle = (low + high) / 2
        low, high = (low, middle) if breaks(1 + middle) else (middle, high)
    must(not breaks(1 - 1e-8, *QUASI_STATIC), "equilibria: breaks at (1 - 1e-8) of the strength")
    for times in (1, 1 + 1e-12):
        must(breaks(times, *QUASI_STATIC), f"equilibria: holds at {times} of the strength")
    return f"breaks from 1 {high:+.1e} of the strength on, in equilibria too"


@case("stiffness-ratio")
def stiffness_ratio(scene):
    scene.stages("pack")
    area, contact, worst, at_rest = np.pi * 0.25, 1.0, 0, 0
    for exponent in range(-6, 7):
        bond = contact * 10.0**exponent
        for sign in (1, -1):
            stiffness = bond + (contact if sign < 0 else 0)
            force = sign * 1e-7 * stiffness
            pull(scene, force)
            scene.stage("dem-replay", "--set", f"bond.normal_stiffness={bond / area!r}",
                        "--set", f"damping_ratio={(stiffness / contact)**0.5!r}")
            moved = scene.get("dem-replay", "snapshots/displacement")[-1, 1, 2]
            error = abs(moved * stiffness / force - 1)
            must(error < 1e-9, f"1e{exponent}, {'pull' if sign > 0 else 'push'}: displacement "
                 f"off by {error:.1e}")
            worst = max(worst, error)
            scene.stage("dem-replay", "--set", f"bond.normal_stiffness={bond / area!r}",
                        *QUASI_STATIC)
            moved = scene.get("dem-replay", "snapshots/displacement")[-1, 1, 2]
            error = abs(moved * stiffness / force - 1)
            must(error < 1e-9, f"equilibria: 1e{exponent}, {sign:+d}: off by {error:.1e}")
            at_rest = max(at_rest, error)
    return f"off by {worst:.1e} at most, equilibria by {at_rest:.1e}"


@case("step-limit")
def step_limit(scene):
    scene.stages("pack")
    n = len(scene.get("pack", "particles/radius"))
    height = scene.get("pack", "particles/position")[:, 2]
    force = np.zeros((2, n, 3))
    force[1, height == height.max()] = 1e-10, 0, 2e-10  # no bond breaks
    write_forces(scene, [0, 1], force)

    def run(safety, *more):
        return scene.try_stage("dem-replay", "--set", f"time_step_safety={safety!r}", *more)

    def moved():
        return scene.get("dem-replay", "snapshots/displacement")[-1]

    must(run(0.04, "--set", "cycles=1")[0] == 0, "an ordinary step does not run")
    limit = 0.04 * scene.summary("dem-replay", "time_step_limit") / scene.summary(
        "dem-replay", "time_step")
    must(run(limit / 2)[0] == 0, "half the limit does not run")
    still = moved()
    must(np.abs(still).max() > 0 and scene.summary("dem-replay", "cracks") == 0,
         "the load is not one to compare with")

    must(run(0.04, "--set", "time_step_safety=null")[0] == 0, "the automatic step does not run")
    step, most = (scene.summary("dem-replay", name) for name in ("time_step", "time_step_limit"))
    must(abs(step - most / 2) < 1e-12 * most, f"the automatic step is {step / most} of the limit")
    error = np.abs(moved() - still).max() / np.abs(still).max()
    must(error < 1e-9, f"automatic: displacements off by {error:.1e}")

    status, message = run(limit * (1 - 1e-9))
    must(status == 0, f"just below: exit {status}: {message}")
    error = np.abs(moved() - still).max() / np.abs(still).max()
    must(error < 1e-6, f"just below: displacements off by {error:.1e}")
    scene.refused("dem-replay", 3, "past the stability limit of",
                  "--set", f"time_step_safety={limit * (1 + 1e-9)!r}")
    ends = []
    for times in (1.01, 1.1, 1.3, 1.5, 2, 3, 10, 1000):
        os.remove(scene.at("dem-replay"))
        status, message = run(limit * times, "--set", "allow_unstable=true")
        left = os.path.exists(scene.at("dem-replay"))
        must(status in (0, 3) and left == (status == 0), f"{times}: exit {status}: {message}")
        must(status == 0 or re.search("diverged in cycle .* past the stability limit of", message), message)
        must(status == 3 or np.isfinite(moved()).all(), f"{times}: numbers that are not finite")
        ends.append(status)
        if status:
            scene.stage("dem-replay")  # a file to find out whether the next leaves one
    must(ends[-2:] == [3, 3], f"far past it: exits {ends}")
    return f"limit at safety {limit:.3g}; just below off by {error:.1e}; past it exits {ends}"


@case("all-break")
def all_break(scene):
    scene.stages(*CHAIN[:5])
    bonds = len(scene.get("pack", "bonds/particles"))
    scene.stage("force-protocol", "--set", "force_scale=1e3")
    seen = []
    for what in ((), ("--set", "bond.normal_strength=0", "--set", "bond.shear_strength=0")):
        scene.stage("dem-replay", *what)
        scene.stage("crackstats")
        seen.append(json.loads(read(scene.at("crackstats")))["cracks"]["total"])
        at = scene.get("dem-replay", "cracks/bond")
        must(sorted(at) == list(range(bonds)) == list(range(int(seen[-1]))),
             f"{len(at)} of {bonds} bonds broke, {seen[-1]:g} counted")
        must(np.isfinite(scene.get("dem-replay", "snapshots/displacement")).all(),
             "displacements are not finite")
        scene.stage("force-protocol")
    # In equilibria suction presses loose grains on the held ones, so they stay; squeezed
    # by more than small displacements allow, they are refused.
    at_rest = []
    for support in ("fixed", "free"):
        scene.stage("force-protocol", "--set", "force_scale=500")
        scene.stage("dem-replay", "-q", *QUASI_STATIC, "--set", f"support={support}")
        pair, held = (scene.get("dem-replay", name) for name in ("bonds/particles", "particles/held"))
        intact = scene.get("dem-replay", "snapshots/bond_intact")[-1]
        broken = scene.get("dem-replay", "cracks/bond")
        must(np.array_equal(np.sort(broken), np.flatnonzero(intact == 0)), "cracks counted wrongly")
        must((intact == (held[pair].sum(1) == 2)).all(), "not every bond of a loose grain broke")
        must(scene.summary("dem-replay", "gone") == 0, "grains left that are pressed on others")
        at_rest.append(f"{len(broken)}")
    scene.stage("force-protocol", "--set", "force_scale=1e12")
    reasons = [scene.refused("dem-replay", 3, "diverged in cycle"),
               scene.refused("dem-replay", 3, "displacements are not small", *QUASI_STATIC)]
    return (f"{seen[0]:g} and {seen[1]:g} of {bonds} bonds counted; equilibria: "
            f"{' and '.join(at_rest)}; 1e12: {'; '.join(reasons)}")


@case("mechanism")
def mechanism(scene):
    scene.stages("pack")
    force = np.zeros((2, 4, 3))
    force[:, 1:, 0] = 1e-3
    write_forces(scene, [0, 1], force)
    status, message = scene.try_stage("dem-replay", *QUASI_STATIC)
    must(status == 0 and re.search(r"3 of \d+ grains have no bond, and nothing held them", message),
         f"exit {status}: {message}")
    must((scene.get("dem-replay", "snapshots/displacement")[-1, 0] == 0).all(), "the held grain moved")
    scene.stage("dem-replay")
    moved = scene.get("dem-replay", "snapshots/displacement")[-1]
    cycles = scene.get("dem-replay", "history/cycles").sum()
    mass = 1000 * 4 / 3 * np.pi * 0.5**3
    flight = 1e-3 / mass * scene.summary("dem-replay", "time_step")**2 * cycles * (cycles + 1) / 2
    error = np.abs(moved[1:, 0] / flight - 1).max()
    must(error < 1e-12 and (moved[0] == 0).all(), f"in cycles off by {error:.1e}")
    return f"{message.split(': ')[-2]}; flight off by {error:.1e}"


@case("equal-times")
def equal_times(scene):
    scene.stages("pack")
    write_forces(scene, [0, 1, 1, 2], np.zeros((4, 2, 3)))
    scene.refused("dem-replay", 65, "/time: row 2: must be > 1, got 1", *QUASI_STATIC)
    return scene.refused("dem-replay", 65, "/time: row 2: must be > 1, got 1")


@case("capillary")
def capillary(scene):
    scene.stages("pack")
    never, always = "bond.normal_strength=1e15", "bond.normal_strength=1"

    def softer(times):
        return [f"{key}={value / times}" for key, value in {
            "normal_stiffness": 20, "shear_stiffness": 10, "bond.normal_stiffness": 2.2e14,
            "bond.shear_stiffness": 8.8e13}.items()]

    scene.refused("dem-replay", 3, r"step \d+ of the load .* diverged in cycle", "-q", *sets(*softer(30)), input=scene.at("pack"))
    kinds = {"soft": softer(5), "no bonds": ["bond.by=none"],
             "never": [never, "bond.shear_strength=1e15"], "always": [always, "bond.shear_strength=1"]}
    said = []
    for kind, settings in kinds.items():
        status, message = scene.try_stage("dem-replay", *sets(*settings),
                                          input=scene.at("pack"))
        must(status == 0, f"{kind}: exit {status}: {message}")
        saturation, liquid, drained = (scene.get("dem-replay", f"history/{name}") for name in
                                       ("saturation", "liquid_volume", "drained_volume"))
        moved = scene.get("dem-replay", "snapshots/displacement")
        must(np.isfinite(moved).all() and (np.diff(saturation) <= 0).all(), f"{kind}: saturation {saturation}")
        first = liquid[0] / saturation[0]
        must((liquid + drained < 1.02 * first).all(), f"{kind}: liquid is made")
        far = np.linalg.norm(moved, axis=2).max() > 0.312e-6
        must(far == ("moved by more than the largest radius" in message), f"{kind}: says {message!r}")
        broken = len(scene.get("dem-replay", "cracks/bond"))
        bonds = len(scene.get("dem-replay", "bonds/particles"))
        must(broken == {"never": 0, "no bonds": 0}.get(kind, broken), f"{kind}: {broken} bonds broke")
        must(kind != "always" or broken > 0.8 * bonds, f"{kind}: {broken} of {bonds} broke")
        said.append(f"{kind}: to {saturation[-1]:.2f}, {broken} of {bonds} bonds")
    return "; ".join(said)
