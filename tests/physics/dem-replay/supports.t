#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# What dem-replay holds and what it bonds: by sides, list and region; listed, touching and by
# distance; strengths from a seed. The artifact says all of it.
import os
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, CYCLES, SCENE, done, ok, run, scratch_paths, sets

HELD = (*CYCLES, "support=fixed")

with scratch_paths() as at:
    small = ("pack", "-p", SCENE, "--set", "counts=[4,4,4]")
    network = run("merge-nodes", "-p", SCENE, input=run("tessellate", "-p", SCENE,
                                                        input=run(*small)))
    run("force-protocol", "-p", SCENE, "--set", "steps=4", "--set", "force_scale=1",
        "-o", at("forces"),
        input=run("dry", "-p", SCENE, input=network))
    force = h5py.File(at("forces"))["force"][:]

    def replay(*settings):
        run("dem-replay", "-q", "-p", SCENE, *sets(*HELD, "cycles=50", *settings), at("forces"),
            "-o", at("response"))
        return h5py.File(at("response"))

    def refused(*settings):
        tried = subprocess.run([f"{BIN}/dem-replay", "-p", SCENE, *sets(*HELD, *settings), at("forces"),
                                "-o", at("refused")], capture_output=True, text=True)
        return tried.returncode, tried.stderr

    # ---- supports
    place = h5py.File(at("forces"))["particles/position"][:] / 500e-9  # 0.5 to 3.5
    near = lambda *wanted: np.isin(np.arange(64), wanted).astype(int)
    for settings, held, what in (
            ((), place[:, 2] < 1, "the bottom, unless told otherwise"),
            (("held.walls=[\"-x\",\"+y\"]",), (place[:, 0] < 1) | (place[:, 1] > 3), "two sides"),
            (("held.walls=[]", "held.grains=[63,5,5]"), near(5, 63), "a list"),
            (("held.walls=[]", "held.lower=[0,0,4e-7]", "held.upper=[2e-6,5e-7,13e-7]"),
             (place[:, 1] < 1) & (abs(place[:, 2] - 2) < 1), "a region"),
            (("held.grains=[63]",), (place[:, 2] < 1) | near(63), "a side and a grain"),
            (("support=free",), near(), "none")):
        for engine in "explicit", "quasi-static":
            response = replay(f"engine={engine}", *settings)
            is_held = response["particles/held"][:].astype(bool)
            moved = abs(response["snapshots/displacement"][:]).max(axis=(0, 2)) > 0
            ok(np.array_equal(is_held, held) and np.array_equal(moved, ~is_held)
               and (settings == ("support=free",)
                    or f"{held.sum()} grains held" in str(response.attrs["model"])),
               f"{engine}: {what}", (is_held.nonzero(), response.attrs["model"]))
    response = replay("engine=quasi-static", "friction=0", "bond.normal_strength=1e9",
                      "bond.shear_strength=1e9")
    net = abs(force.sum(axis=1) + response["history/reaction_force"][:]).max(axis=1)
    ok((net <= 1e-10 * abs(force).sum(axis=(1, 2)).max()).all(), "held grains give the load back", net)
    arm = response["particles/position"][:] - response["domain/lower"][:]
    turn = abs(np.cross(arm, force).sum(axis=1) + response["history/reaction_moment"][:]).max()
    size = (np.linalg.norm(arm, axis=1) * np.linalg.norm(force, axis=2)).sum(axis=1).max()
    ok(turn <= 1e-10 * size, "and its moment", turn / size)
    # Forces that are net in force and moment, on a body that nothing holds.
    with h5py.File(at("forces"), "r+") as file:
        file["force"][:, :20] += 1e-8 * np.array([1, -2, 3])
        force = file["force"][:]
    for engine in "explicit", "quasi-static":
        response = replay(f"engine={engine}", "support=free", "bond.normal_strength=1e9",
                          "bond.shear_strength=1e9", "snapshots=[1]")
        off, left = response["history/reaction_force"][:], response["snapshots/force"][0]
        moved = arm + response["snapshots/displacement"][0] * (engine == "explicit")
        turn = abs(np.cross(moved, left).sum(axis=0)).max()
        ok(np.allclose(-off, force.sum(axis=1), rtol=1e-9, atol=1e-20)
           and abs(left.sum(axis=0)).max() < 1e-6 * abs(off).max()
           and turn < 1e-6 * size, f"{engine}: a net load is taken off, and what it was is said",
           (off[0], left.sum(axis=0), turn / size))
    # Where such a body is as one does not hang on rounding: grains renumbered move as before.
    with h5py.File(at("forces")) as file, h5py.File(at("backwards"), "w") as other:
        for name in file:
            file.copy(name, other)
        for name, value in file.attrs.items():
            other.attrs[name] = value
        for name in "particles/position", "particles/radius":
            other[name][...] = file[name][:][::-1]
        other["force"][...] = file["force"][:][:, ::-1]
        pairs = np.sort(63 - file["bonds/particles"][:], axis=1)
        other["bonds/particles"][...] = pairs[np.lexsort(pairs.T[::-1])]
    for large in "false", "true":
        moved = []
        for name in "forces", "backwards":
            run("dem-replay", "-q", "-p", SCENE, *sets(
                "engine=quasi-static", "support=free", "friction=0", "bond.normal_strength=1e9",
                "bond.shear_strength=1e9", "bond.normal_stiffness=8e13", "snapshots=[0.5]",
                f"quasi_static.large_displacements={large}"), at(name), "-o", at("response"))
            moved.append(h5py.File(at("response"))["snapshots/displacement"][0])
        size = abs(moved[0]).max()
        apart = abs(moved[0] - moved[1][::-1]).max() / size
        ok(apart < 1e-9 and abs(moved[0].sum(axis=0)).max() < 1e-12 * 64 * size,
           f"large_displacements={large}: the mean place is kept, whatever the numbers of grains",
           (apart, moved[0].sum(axis=0) / size))
    tried = subprocess.run([f"{BIN}/dem-replay", "-p", SCENE, *sets(*HELD, "held.walls=[]", "cycles=1"),
                            at("forces"), "-o", at("none")], capture_output=True, text=True)
    ok("holds no grain" in tried.stderr and tried.returncode == 0, "where none is held it is said")
    status, message = refused("held.walls=[]", "engine=quasi-static")
    ok(status == 65 and "none of the grains is held" in message, "and refused for equilibria", message)
    for settings, says in ((("held.grains=[64]",), "held.grains: must be whole numbers below 64"),
                           (("held.grains=[0.5]",), "held.grains: must be whole"),
                           (("held.lower=[0,0,0]",), "held.upper: must be given"),
                           (("held.lower=[0,0,1]", "held.upper=[1,1,0]"), "held.upper: z must")):
        status, message = refused(*settings)
        ok(status == 65 and says in message, f"refused: {says}", message)

    run("pack", *sets("method=cubic", "counts=[3,3,3]", "radius=1e-6", "periodic=[true,false,false]"), "-o", at("periodic"))
    for walls, status in ('["-x"]', 65), ('["-z","+x"]', 65), ('["-y","-z"]', 0):
        tried = subprocess.run([f"{BIN}/dem-replay", *sets("engine=explicit", "shrinkage.strain=1e-4", "shrinkage.steps=1",
                                "density=2500", "normal_stiffness=10", "shear_stiffness=5", "cycles=1", "held.walls=" + walls),
                                at("periodic"), "-o", at("response")], capture_output=True, text=True)
        ok(tried.returncode == status and ("periodic along x" in tried.stderr) == (status != 0),
           f"held.walls={walls} in a box that is periodic along x", tried.stderr)

    # ---- what does not come to rest: with this friction a load takes more than one step in time
    for most in 1, 40:
        words_of_it = sets(*HELD, "engine=quasi-static", "friction=2", f"quasi_static.most_iterations={most}")
        told = subprocess.run([f"{BIN}/dem-replay", "-p", SCENE, *words_of_it, at("forces"), "-o",
                               at("response")], capture_output=True, text=True).stderr
        count = h5py.File(at("response"))["summary"].attrs["steps_unsettled"]
        ok(f"under {count} of the loads not all grains came to rest" in told
           and "rounding may decide what breaks" in told if most == 1 else
           count == 0 and "rest" not in told, f"{count} loads without rest, as the message says",
           told)

    # ---- a wall that nothing is pressed on
    # Forces that press a body together and keep their directions turn it over, about which
    # both engines agree; with what turns it taken off nothing breaks.
    run("pack", "-p", SCENE, "--set", "counts=[3,3,3]", "-o", at("cube"))
    arm = h5py.File(at("cube"))["particles/position"][:] / 500e-9 - 1.5
    pull = -1e-7 * arm * (1 + 0.01 * (np.arange(27) * 7 % 5))[:, None]
    pull -= pull.mean(axis=0)
    with h5py.File(at("forces"), "r") as file, h5py.File(at("pressed"), "w") as pressed:
        for name in "bonds", "domain", "particles":
            with h5py.File(at("cube")) as cube:
                cube.copy(name, pressed)
        file.copy("summary", pressed)
        for key, value in file.attrs.items():
            pressed.attrs[key] = value
        for name, value in (("time", [0.]), ("saturation", [1.]),
                            ("force", pull[None])):
            pressed[name] = np.array(value)
            pressed[name].attrs["units"] = file[name].attrs["units"]
    for engine in (("engine=quasi-static", "quasi_static.large_displacements=true"),
                   ("cycles=200000",)):
        broken, told = [], []
        for support in "wall", "free":
            tried = subprocess.run([f"{BIN}/dem-replay", "-p", SCENE, *sets(*engine), "--set",
                                    f"support={support}", at("pressed"), "-o", at("response")],
                                   capture_output=True, text=True)
            told.append(tried.stderr)
            broken.append(len(h5py.File(at("response"))["cracks/bond"]))
        ok(broken[0] > 27 and broken[1] == 0 and "support=wall holds only" in told[0]
           and "support=wall" not in told[1], f"{engine[0]}: nothing is pressed on the wall",
           (broken, told))

    # ---- bonds
    response = replay("bond.by=touching")
    listed = h5py.File(at("forces"))["bonds/particles"][:]
    ok(np.array_equal(response["bonds/particles"][:], listed), "touching grains are those listed")
    response = replay("bond.by=distance", "bond.gap=0.42", "time_step_safety=0.009")
    apart = np.linalg.norm(place[:, None] - place, axis=2)
    wanted = np.argwhere(np.triu(apart < 1.42, 1))
    ok(np.array_equal(response["bonds/particles"][:], wanted) and len(wanted) > len(listed),
       "by distance, diagonals too", (len(wanted), len(response["bonds/particles"])))
    for engine in "explicit", "quasi-static":
        rows = [replay(f"engine={engine}", "bond.strength.distribution=weibull",
                       "bond.strength.modulus=2", f"bond.strength.seed={seed}",
                       f"bond.normal_strength={mean}", f"bond.shear_strength={mean}")
                ["bonds/relative_strength"][:] for seed, mean in ((1, 1e4), (1, 2e4), (2, 1e4))]
        ok(np.array_equal(rows[0], rows[1]) and not np.isclose(rows[0], rows[2], atol=0).any(),
           f"{engine}: strengths are those of the seed, whatever their mean")
    ok((replay()["bonds/relative_strength"][:] == 1).all(), "one strength unless told otherwise")

    # ---- strengths that the packing brings go with it, and are multiplied with those drawn
    run(*small, "-o", at("packing"))
    with h5py.File(at("packing"), "r+") as file:
        own = np.random.default_rng(7).uniform(0.5, 2, len(file["bonds/particles"]))
        own[40] = 0
        file["bonds/relative_strength"] = own
        pair = file["bonds/particles"][40]
    with open(at("packing"), "rb") as file:
        network = run("merge-nodes", "-p", SCENE, input=run("tessellate", "-p", SCENE, input=file.read()))
    run("force-protocol", "-p", SCENE, "--set", "steps=4", "--set", "force_scale=1", "-o", at("forces"),
        input=run("dry", "-p", SCENE, input=network))
    weibull = "bond.strength.distribution=weibull", "bond.strength.modulus=2"
    for engine in "explicit", "quasi-static":
        response = replay(f"engine={engine}")
        broken = response["cracks/bond"][:]
        ok(np.array_equal(response["bonds/relative_strength"][:], own) and len(broken) and broken[0] == 40,
           f"{engine}: bonds have the strengths of the packing, and one of none breaks first", broken)
    both = replay(*weibull, "keep_state=true")["bonds/relative_strength"][:]
    ok(np.allclose(both, own * rows[0], rtol=1e-14, atol=0), "times what is drawn")
    os.rename(at("response"), at("earlier"))
    run("dem-replay", "-q", "-p", SCENE, *sets(*HELD, "cycles=50", *weibull, "bond.strength.seed=9"), at("forces"), at("earlier"),
        "-o", at("response"))
    ok(np.array_equal(h5py.File(at("response"))["bonds/relative_strength"][:], both), "a replay that goes on keeps them")
    ok((replay("bond.by=touching")["bonds/relative_strength"][:] == 1).all(), "bonds found anew have none of them")
    with h5py.File(at("packing"), "r+") as file:
        file["particles/velocity"] = 1e-3 * np.random.default_rng(1).normal(size=(64, 3))
    run("simulate", "-q", *sets("bond.kind=parallel", "duration=1e-9", 'materials={"glass":{"density":3230,"young_modulus":7e10}}'),
        at("packing"), "-o", at("motion"))
    ok(h5py.File(at("motion"))["cracks/bond"][:].tolist() == [40], "simulate breaks the one of no strength")
done()
