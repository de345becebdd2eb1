#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Contact bonds in dem-replay [K 4.2, 5.10]: a soft aggregate shrinks by its springs and comes
# back; the strength is a force.
import json
import re
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, run, scratch_paths, sets

SOFT = "samples/soft-10x5x5.json"

with scratch_paths() as at:
    network = run("merge-nodes", "-p", SOFT, input=run("tessellate", "-p", SOFT, input=run(
        "pack", "-p", SOFT, "--set", "counts=[4,3,3]")))
    drying = run("dry", "-p", SOFT, input=network)

    def replay(scale, *settings):
        forces = run("force-protocol", "-p", SOFT, "--set", "steps=40", "--set",
                     f"force_scale={scale}", input=drying)
        run("dem-replay", "-p", SOFT, "--set", "cycles=2000", *sets(*settings), "-o", at("response"), input=forces)
        return json.loads(run("crackstats", at("response")))["mean"], h5py.File(at("response"))

    stats, response = replay(0.01)
    ok(stats["cracks"]["total"] == 0, "no cracks")
    ok(0.999 < stats["shrinkage"]["spring_back"] < 1.001, "it springs back to where it was",
       stats["shrinkage"])

    # Every contact's normal force is its spring's: half a grain's stiffness times overlap.
    pair = response["contacts/particles"][:]
    place = response["particles/position"][:] + response["snapshots/displacement"][0]
    apart = np.diff(place[pair], axis=1)[:, 0]
    length = np.linalg.norm(apart, axis=1)
    force = (response["snapshots/contact_force"][0] * apart).sum(axis=1) / length
    spring = 0.5 * 10 * (500e-9 - length)
    ok(np.allclose(force, spring, atol=1e-4 * np.abs(spring).max()),
       "forces are those of the springs", np.abs(force - spring).max() / np.abs(spring).max())
    normal = -np.concatenate([response["snapshots/contact_force"][k].ravel()
                              for k in range(len(response["snapshots/time"]))])
    most = np.abs(normal).max()

    stats, response = replay(0.01, f"bond.contact_strength={3 * most}")
    ok(stats["cracks"]["total"] == 0, "none where the strength is above any force")
    stats, response = replay(0.01, f"bond.contact_strength={0.15 * most}")
    ok(stats["cracks"]["total"] > 0, "some where it is below most", stats["cracks"])

    # Equilibria on the geometry as it is, a tenth of the radius closer: back to the start but
    # for what is left of shear, none of it cycles' doing.
    stats, response = replay(1, 'engine="quasi-static"', "quasi_static.large_displacements=true",
                             "bond.contact_strength=null")
    shrinkage = stats["shrinkage"]
    ok(0.05 < shrinkage["largest"] < 0.3, "the full force shrinks it by percent", shrinkage)
    ok(abs(shrinkage["spring_back"] - 1) < 2e-3, "and equilibria spring back", shrinkage)
    held = shrinkage["largest"]
    stats, response = replay(1, 'engine="quasi-static"', "quasi_static.large_displacements=true",
                             "bond.contact_strength=null", "support=free")
    shrinkage = stats["shrinkage"]
    ok(1.1 * held < shrinkage["largest"] < 1.6 * held, "where nothing holds it, it shrinks further", shrinkage)
    ok(abs(shrinkage["spring_back"] - 1) < 1e-5, "and springs back closer", shrinkage)

    # A column three grains thick and ten high comes apart: so it does in cycles, which fling
    # its grains away.
    column = run("merge-nodes", "-p", SOFT, input=run("tessellate", "-p", SOFT, input=run(
        "pack", "-p", SOFT, "--set", "counts=[3,3,10]")))
    forces = run("force-protocol", "-p", SOFT, "--set", "steps=2",
                 input=run("dry", "-p", SOFT, input=column))

    def tried(forces, *settings):
        run = subprocess.run([f"{BIN}/dem-replay", "-p", SOFT, *sets(*settings)], input=forces,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60)
        return run.returncode, run.stderr.decode()

    large = "engine=quasi-static", "quasi_static.large_displacements=true"
    status, message = tried(forces, *large)
    ok(status == 0 and "has come apart" in message and
       re.search("the aggregate snapped through or buckled .* grain [0-9]+ moved most", message),
       "a column that topples is followed until it has come apart, and a grain named", message)
    status, message = tried(forces, "ramp=20000", "cycles=20000")
    ok(status == 3 and "diverged" in message, "cycles do not find it at rest either", message)

    loose = run("force-protocol", "-p", SOFT, "--set", "steps=12", input=run(
        "dry", input=run("merge-nodes", input=run("tessellate", input=run(
            "pack", "--set", "counts=[2,2,3]", "--set", "bonds=none")))))
    status, message = tried(loose, *large, "bond.by=none")
    ok(status == 0 and "8 of 12 grains have no bond, and nothing held them" in message,
       "loose grains with friction leave, where no increment however small is balanced", message)

    # 1 N on a bond of 0.1 N/m3 over pi 0.5858^2 m2 stretches it by 9.28 m.
    run("pack", "--set", "counts=[1,1,2]", "--set", "radius=1", "-o", at("pair"))
    with h5py.File(at("pair")) as packing, h5py.File(at("pull"), "w") as pull:
        for group in "particles", "domain", "bonds":
            packing.copy(group, pull)
        pull.attrs["schema"] = "craquelure/forces/1"
        pull["time"], pull["saturation"] = [0.0, 1.0], [1.0, 0.0]
        pull["force"] = [[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]] * 2
        pull.create_group("summary").attrs.update(
            capillary_pressure=0.0, force_scale=1.0, largest_force=1.0, first_period_end_time=0.0)
    soft = (f"{name}=0.1" for name in ("normal_stiffness", "shear_stiffness",
                                       "bond.normal_stiffness", "bond.shear_stiffness"))
    words = sets(*large, *soft, "bond.normal_strength=10", "bond.shear_strength=10")
    pulled = subprocess.run([f"{BIN}/dem-replay", *words, at("pull"), "-o", at("far")],
                            stderr=subprocess.PIPE, text=True, timeout=60)
    ok(pulled.returncode == 0 and "come apart" not in pulled.stderr and
       re.search(r"has given way: 1 of 2 grains .* by 9.28 of it; 0 of 1 bonds broke", pulled.stderr),
       "a soft bond that stretches far and holds is not said to have come apart", pulled.stderr)

    # One grain is torn off a body that stands: that is all that is said.
    run("pack", "--set", "counts=[2,2,2]", "--set", "radius=1", "-o", at("cube"))
    with h5py.File(at("cube")) as packing, h5py.File(at("tear"), "w") as tear:
        for group in "particles", "domain", "bonds":
            packing.copy(group, tear)
        tear.attrs["schema"] = "craquelure/forces/1"
        tear["time"], tear["saturation"] = [0.0, 1.0], [1.0, 0.0]
        tear["force"] = [[[0.0, 0.0, 0.0]] * 7 + [[1.0, 1.0, 1.0]]] * 2
        tear.create_group("summary").attrs.update(
            capillary_pressure=0.0, force_scale=1.0, largest_force=1.0, first_period_end_time=0.0)
    words = sets("held.grains=[1,2,3,4,5,6]", "time_step_safety=null", "cycles=4000",
                 "bond.normal_strength=0.1", "bond.shear_strength=0.1",
                 "normal_stiffness=10", "shear_stiffness=10", "bond.normal_stiffness=10",
                 "bond.shear_stiffness=10", "density=1e-3")
    for engine in "explicit", "quasi-static":
        torn = subprocess.run([f"{BIN}/dem-replay", *words, "--set", f"engine={engine}", at("tear"), "-o", at("torn")],
                              stderr=subprocess.PIPE, text=True, timeout=60)
        ok(torn.returncode == 0 and "come apart" not in torn.stderr and "1 of 8 grains" in torn.stderr,
           f"a single grain that comes off is not the aggregate coming apart ({engine})", torn.stderr)
done()
