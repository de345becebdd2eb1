#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Three grains in a column, the lowest held: what a fragment that came loose still bears, how the
# moment in a bond counts in its strength, and which engine engine=auto takes. Closed forms.
import math
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, SCENE, done, ok, refused, run, scratch_paths, sets

RADIUS = 250e-9
NECK = 0.5858 * RADIUS
AREA = math.pi * NECK ** 2
COMMON = ("support=fixed", "friction=0.5", "cycles=2000", "ramp=0", "tolerance=1e-6",
          "most_cycles=100000", "unsettled=count", "density_scaling=true")

with scratch_paths() as at:
    column = run("pack", "-p", SCENE, "--set", "counts=[1,1,3]")
    with open(at("column"), "wb") as file:
        file.write(column)
    # Attributes and units of a forces artifact, from a body that can be dried.
    network = run("merge-nodes", "-p", SCENE, input=run("tessellate", "-p", SCENE, input=run(
        "pack", "-p", SCENE, "--set", "counts=[2,2,2]")))
    run("force-protocol", "-p", SCENE, "--set", "steps=2", "-o", at("model"),
        input=run("dry", "-p", SCENE, input=network))

    def write_forces(name, force):
        """FORCE: (time, 3 grains, 3), N."""
        with h5py.File(at("model")) as model, h5py.File(at(name), "w") as file:
            with h5py.File(at("column")) as grains:
                for group in "bonds", "domain", "particles":
                    grains.copy(group, file)
            model.copy("summary", file)
            for key, value in model.attrs.items():
                file.attrs[key] = value
            steps = len(force)
            for key, value in (("time", np.arange(steps, dtype=float)),
                               ("saturation", np.linspace(1, 0.5, steps)), ("force", force)):
                file[key] = value
                file[key].attrs["units"] = model[key].attrs["units"]

    def replay(name, *settings):
        run("dem-replay", "-q", "-p", SCENE, *sets(*COMMON, *settings), at(name), "-o",
            at("response"))
        return h5py.File(at("response"))

    # ---- a fragment of two grains that came loose: inertia relief
    # The pull of 3 on the upper and 1 on the middle grain breaks the lower bond, which alone is
    # weak enough: it bears 4. What does not accelerate the pair is +1 and -1: its bond bears 1.
    unit = 1e-9
    pull = np.zeros((4, 3, 3))
    pull[:, 1, 2], pull[:, 2, 2] = unit, 3 * unit
    write_forces("pull", pull)
    breaks = (f"bond.normal_strength={3.5 * unit / AREA}", "bond.shear_strength=1e9")
    away, borne = {}, {}
    for loose in "unload", "keep":
        for cycles in 2000, 4000:
            response = replay("pull", "engine=explicit", *breaks, f"cycles={cycles}", "tolerance=null",
                              f"loose_grains={loose}", "snapshots=[0.5]")
            away[loose, cycles] = response["snapshots/displacement"][-1, 1:, 2].max()
            pairs = response["contacts/particles"][:].tolist()
            borne[loose, cycles] = response["snapshots/contact_force"][-1, pairs.index([1, 2]), 2]
            ok(response["cracks/bond"][:].tolist() == [0] and response["cracks/mode"][0] == 0,
               f"{loose}, {cycles} cycles: the lower bond breaks in tension, and no other")
    relieved = [borne["unload", n] / -unit for n in (2000, 4000)]
    ok(np.allclose(np.abs(relieved), 1, rtol=1e-3), "a loose pair bears what balances itself in it",
       relieved)
    ok(away["unload", 4000] < 1e-3 * RADIUS
       and abs(away["unload", 4000] - away["unload", 2000]) < 1e-5 * RADIUS,
       "it stays where it came loose, however long a step lasts", away)
    ok(away["keep", 4000] > 2 * away["keep", 2000] > 10 * away["unload", 4000],
       "with loose_grains=keep it flies", away)

    # ---- the same in a row along x, which turns about z as well: it does not, also if the row goes on
    # behind the side of a box that repeats
    turned = np.zeros((4, 3, 3))
    turned[:, 1:, 0], turned[:, 1:, 1] = (unit, 3 * unit), (unit, -unit)
    write_forces("turned", turned)
    side = 12 * RADIUS
    for repeats in 0, 1:
        with h5py.File(at("turned"), "a") as forces:
            forces["domain/upper"][:] = forces["domain/lower"][:] + side
            row = np.array([side - 3 * RADIUS, side - RADIUS, RADIUS if repeats else side + RADIUS])
            forces["particles/position"][:] = forces["domain/lower"][:] + np.column_stack(
                [row, np.full((3, 2), 5 * RADIUS)])
            forces["domain/periodic"][:] = repeats, repeats, 0
        response = replay("turned", "engine=explicit", *breaks, "bond.moment_contribution=0", "held.walls=[]",
                          "held.grains=[0]", "loose_grains=unload", "snapshots=[0.5]")
        left = response["snapshots/force"][-1, 1:] / unit
        ok(response["cracks/bond"][:].tolist() == [0] and np.abs(left - [[-1, 0, 0], [1, 0, 0]]).max() < 1e-3,
           f"a loose pair has no moment{' across a side that repeats' if repeats else ''}", left)

    # ---- equilibria: the pair leaves, and is said to bear nothing
    response = replay("pull", "engine=quasi-static", *breaks, "snapshots=[0.5]")
    listed, held_by = response["snapshots/force"][-1], response["history/reaction_force"][-1]
    ok(response["summary"].attrs["gone"] == 2 and not listed[1:].any() and
       np.abs(listed.sum(axis=0) + held_by).max() < 1e-9 * unit, "equilibria: grains that left have no force",
       (listed, held_by))

    # ---- who detached: the middle grain, whose bond breaks; the upper one never had any
    with h5py.File(at("pull"), "a") as forces:
        lower = forces["bonds/particles"][:1]
        del forces["bonds/particles"]
        forces["bonds/particles"] = lower
        forces["bonds/particles"].attrs["units"] = "1"
    for engine in "explicit", "quasi-static":
        said = subprocess.run([f"{BIN}/dem-replay", "-p", SCENE, *sets(*COMMON, *breaks, f"engine={engine}",
                               "bond.normal_strength=1", "loose_grains=unload"), at("pull"), "-o", at("response")],
                              stderr=subprocess.PIPE, text=True).stderr
        with h5py.File(at("response")) as response:
            gone = [int(response["summary"].attrs[key]) for key in ("gone", "gone_unbonded")]
        ok(gone == [1, 1] and "1 of 3 grains detached from the aggregate, grain 1 first" in said and
           "1 of 3 grains have no bond, and nothing held them" in said,
           f"{engine}: one grain detached, and one more was never bonded", (gone, said))

    # ---- the moment in a bond [K 4.41]: stress beta |M| R / I, with M = r F of a pull F across
    # the upper bond, whose grain may turn, and I = pi R^4 / 4. The lower bond has three times
    # that: its arm is 3 r.
    steps = 100
    across = np.zeros((steps, 3, 3))
    across[:, 2, 0] = np.linspace(unit / steps, unit, steps)
    write_forces("across", across)
    weakest = lambda share: share * 3 * RADIUS * unit * NECK / (math.pi * NECK ** 4 / 4)
    for engine in "explicit", "quasi-static":
        for beta in 1, 0.5:
            # Strong enough for 60.5 of the 100 steps.
            response = replay("across", f"engine={engine}", "tolerance=1e-5",
                              f"bond.normal_strength={weakest(0.605 * beta)}",
                              "bond.shear_strength=1e9", f"bond.moment_contribution={beta}")
            cracks = response["history/cracks"][:]
            first = int((cracks == 0).sum())
            ok(first == 60 and response["cracks/bond"][0] == 0 and response["cracks/mode"][0] == 0,
               f"{engine}, beta {beta}: the bond breaks at the load of the closed form", first)
        response = replay("across", f"engine={engine}", "tolerance=1e-5",
                          f"bond.normal_strength={weakest(0.01)}", "bond.shear_strength=1e9",
                          "bond.moment_contribution=0")
        tension = len(response["cracks/bond"])
        ok(tension == 0, f"{engine}, beta 0: a moment breaks nothing", tension)

    # ---- a grain a tenth as large as that beneath, which crosses a gap of 0.15 of the sum of its
    # radius and that of the one above: 0.075 mean radii, so that displacements are small
    small, gap, stiff, glue = 0.1 * RADIUS, 0.03 * RADIUS, 100, 1e15
    for n, name in enumerate(("near", "far")):
        push = np.zeros((1, 3, 3))
        push[:, 1, 2] = 0.035 * RADIUS * glue * AREA / 100
        write_forces(name, push)
        with h5py.File(at(name), "a") as forces:
            forces["particles/radius"][:] = RADIUS, small, small
            place = forces["particles/position"][0] + np.outer(
                [0, RADIUS + small, RADIUS + 3 * small + (1 + n) * gap], [0, 0, 1])
            forces["particles/position"][:] = place
            lower = forces["bonds/particles"][:1]
            del forces["bonds/particles"]
            forces["bonds/particles"] = lower
            forces["bonds/particles"].attrs["units"] = "1"
    neck = glue * AREA / 100
    held = ("held.walls=[]", "held.grains=[0,2]", "friction=0", f"normal_stiffness={2 * stiff}", "snapshots=[1]",
            f"bond.normal_stiffness={glue}", "bond.normal_strength=1e12", "bond.shear_strength=1e12")
    moves = {"near": (0.035 * RADIUS * neck + stiff * gap) / (neck + stiff), "far": 0.035 * RADIUS}
    for name, wanted in moves.items():
        response = replay(name, "engine=quasi-static", *held)
        moved = response["snapshots/displacement"][0, 1, 2]
        ok(abs(moved / wanted - 1) < 1e-6, f"equilibria: a small grain meets another if that is {name}", moved / wanted)

    # ---- a small grain that hangs between three on the wall, a twentieth of a radius above it
    push = np.zeros((1, 4, 3))
    push[0, :, 2] = -1e-6, -1e-6, -1e-6, -3e-9
    write_forces("hung", push)
    low = np.array([[0, 0, 1], [2, 0, 1], [1, math.sqrt(3), 1], [1, 1 / math.sqrt(3), 0.35]]) * RADIUS
    with h5py.File(at("hung"), "a") as forces:
        for name, values in (("particles/position", low), ("particles/radius", RADIUS * np.array([1, 1, 1, 0.3])),
                             ("bonds/particles", np.array([[i, j] for i in range(4) for j in range(i + 1, 4)], "i4"))):
            units = forces[name].attrs["units"]
            del forces[name]
            forces[name] = values
            forces[name].attrs["units"] = units
        forces["domain/lower"][:] = np.array([-1, -1, 0]) * RADIUS
        forces["domain/upper"][:] = np.array([3, 3, 2]) * RADIUS
    sunk = {}
    for engine in "explicit", "quasi-static":
        response = replay("hung", f"engine={engine}", "support=wall", "friction=0", "normal_stiffness=100", "snapshots=[1]",
                          "bond.normal_stiffness=3e13", "bond.shear_stiffness=3e13", "bond.normal_strength=1e12",
                          "bond.shear_strength=1e12", "quasi_static.large_displacements=false")
        sunk[engine] = response["snapshots/displacement"][0, :, 2] / RADIUS
    ok(-0.0515 < sunk["explicit"][3] < -0.05 and abs(sunk["quasi-static"][3] - sunk["explicit"][3]) < 1e-3,
       "a small grain comes to rest on the wall, in equilibria as by cycles", sunk)

    # ---- what equilibria would take for another body is refused, as by cycles
    def twice(file):
        del file["bonds/particles"]
        file["bonds/particles"] = np.array([[0, 1], [0, 1], [1, 2]], "i4")
        file["bonds/particles"].attrs["units"] = "1"

    def narrow(file):
        file["domain/periodic"][:] = 1, 0, 0

    def coincident(file):
        file["particles/position"][2] = file["particles/position"][1]

    for change, says in (twice, "3 bonds join only 2 pairs of grains"), (narrow, "periodic box is "), (
            coincident, "grains 1 and 2 coincide"):
        write_forces("bad", pull)
        with h5py.File(at("bad"), "a") as forces:
            change(forces)
        for engine in "explicit", "quasi-static":
            refused(f"{engine}: {says}", says, "dem-replay", "-p", SCENE, *sets(*COMMON, f"engine={engine}"),
                    at("bad"), "-o", at("refused"))

    write_forces("bad", pull)
    with h5py.File(at("bad"), "a") as forces:
        forces["domain/periodic"][:] = 0, 0, 1
    for engine in "explicit", "quasi-static":
        refused(f"{engine}: a wall where the box repeats", "dem-replay.support: must not be wall", "dem-replay", "-p", SCENE,
                *sets(*COMMON, f"engine={engine}", "support=wall"), at("bad"), "-o", at("refused"))

    # ---- engine=auto
    for settings, engine in ((("friction=0",), "quasi-static"), (("friction=0.5",), "explicit"),
                             (("friction=0", "support=wall"), "explicit"),
                             (("friction=0", "prestress=true"), "explicit")):
        response = replay("pull", "engine=auto", "bond.normal_strength=1e9", "bond.shear_strength=1e9",
                          *settings)
        model = response.attrs["model"].decode()
        ok(model.startswith("discrete elements") == (engine == "explicit") and "\nengine: " in model,
           f"engine=auto takes {engine} with {', '.join(settings)}", model)
done()
