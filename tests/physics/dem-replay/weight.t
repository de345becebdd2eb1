#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Weight in dem-replay: a column and a cantilever under their own weight against closed forms,
# what the support bears, that it is at rest before drying begins, what it breaks alone, and
# the Bond numbers.
import json
import os
import subprocess
import sys

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

sys.path.insert(0, "tests")
from tap import BIN, done, ok, run, scratch_paths, sets

R, RHO, G = 5e-4, 2500.0, 9.81
MASS = RHO * 4 / 3 * np.pi * R**3
BOND, FRACTION = 4e9, 0.5  # N/m3, of the radius
AREA, INERTIA = np.pi * (FRACTION * R)**2, np.pi / 4 * (FRACTION * R)**4
MATERIAL = (f"density={RHO}", "normal_stiffness=1e4", "shear_stiffness=1e4", f"gravity={G}",
            f"bond.normal_stiffness={BOND}", f"bond.shear_stiffness={BOND}",
            f"bond.radius_fraction={FRACTION}", "time_step_safety=null", "cycles=2000",
            "bond.normal_strength=1e9", "bond.shear_strength=1e9",
            "ramp=0", "tolerance=null", "local_damping=0", "damping_ratio=0.7", "density_scaling=false")
ENGINES = "explicit", "quasi-static"

with scratch_paths() as at:
    def pack(counts, *settings):
        run("pack", *sets(f"counts={counts}", f"radius={R}", *settings), "-o", at("packing"))

    def forces(force, name="forces", capillary_pressure=0.0, **extra):
        """FORCE (n_time, n_particle, 3) as an artifact; the grains are those of the packing."""
        with h5py.File(at("packing")) as packing, h5py.File(at(name), "w") as file:
            for group in "particles", "domain", "bonds":
                packing.copy(group, file)
            file.attrs["schema"] = "craquelure/forces/1"
            file["time"] = np.arange(len(force), dtype=float)
            file["saturation"] = np.linspace(1, 0, len(force))
            file["force"] = force
            file.create_group("summary").attrs.update(
                capillary_pressure=capillary_pressure, force_scale=1.0, largest_force=0.0,
                first_period_end_time=0.0, **extra)

    def tried(*settings, inputs=("forces",), output="response", options=()):
        return subprocess.run([f"{BIN}/dem-replay", *sets(*MATERIAL, *settings), *options,
                               *map(at, inputs), "-o", at(output)], capture_output=True, text=True,
                              timeout=120)

    def replay(*settings, **more):
        made = tried(*settings, **more)
        assert made.returncode == 0, made.stderr
        return h5py.File(at(more.get("output", "response"))), made.stderr

    # ---- a column -----------------------------------------------------------------------
    n = 12
    pack([1, 1, n])
    forces(np.zeros((3, n, 3)))
    above = MASS * G * np.arange(n - 1, 0, -1)  # on the contact above grain 0, 1, ...
    for engine in ENGINES:
        for support in "fixed", "wall":
            response, said = replay(f"engine={engine}", f"support={support}")
            case = f"{engine}, support={support}"
            pairs, carried = response["contacts/particles"][:], response["snapshots/contact_force"][:]
            wrong = abs(carried[:, :, 2] - above[pairs[:, 0]]).max() / above[0]
            ok(wrong < 1e-3 and (carried[..., :2] == 0).all(),
               f"{case}: contacts bear what is above, linear in height, before drying and after", wrong)
            reaction = response["history/reaction_force"][:]
            wrong = abs(reaction - [0, 0, n * MASS * G]).max() / (n * MASS * G)
            ok(wrong < (5e-4 if engine == "explicit" else 1e-9),
               f"{case}: the support bears the whole weight", reaction)
            stiffness = 1e4 / 2 + BOND * AREA
            sag = np.append(0, np.cumsum(above / stiffness))
            moved = -response["snapshots/displacement"][-1, :, 2]
            wall = n * MASS * G / 1e4 if support == "wall" else 0
            wrong = abs(moved - wall - sag).max() / sag[-1]
            ok(wrong < 1e-3, f"{case}: it shortens as springs in a row", wrong)
            ok(response["cracks/bond"].size == 0 and response["summary"].attrs["weight_cracks"] == 0
               and response["summary"].attrs["gravity"] == G
               and "weight of the grains: gravity 9.81" in str(response.attrs["model"])
               and "left out: gravity" not in str(response.attrs["model"]), f"{case}: nothing breaks",
               response.attrs["model"])

    response, said = replay("engine=quasi-static", "quasi_static.large_displacements=true")
    pairs, carried = response["contacts/particles"][:], response["snapshots/contact_force"][:]
    wrong = abs(carried[:, :, 2] - above[pairs[:, 0]]).max() / above[0]
    ok(wrong < 1e-6, "large displacements: contacts bear what is above", wrong)

    # ---- what breaks alone, and what does not -------------------------------------------
    # Bonds cannot pull: the row hangs from its upper end, and the highest bond bears n - 1 grains.
    hung = ("held.walls=[\"+z\"]",)
    stress = (n - 1) * MASS * G / AREA
    for engine in ENGINES:
        for share, cracks in ((1.01, 0), (0.99, 1)):
            response, said = replay(f"engine={engine}", *hung, f"bond.normal_strength={share * stress}")
            summary = response["summary"].attrs
            ok(summary["cracks"] == 0 and summary["weight_cracks"] == cracks
               and list(response["weight_cracks/bond"][:]) == [n - 2] * cracks
               and (response["history/cracks"][:] == 0).all()
               and ("broke under the weight alone" in said) == bool(cracks),
               f"{engine}: a bond of {share} times what hangs on it: {cracks} break, before drying",
               (dict(summary), said))
            last = response["snapshots/bond_intact"][-1]
            ok(last.sum() == n - 1 - cracks, f"{engine}: and are broken in all snapshots", last)
    run("inspect", "--vtk", at("hung"), at("response"))
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(at("hung-0000.vtu"))
    reader.Update()
    drawn = vtk_to_numpy(reader.GetOutput().GetCellData().GetArray("crack"))
    ok(sorted(drawn) == [0] * (n - 2) + [1], "inspect --vtk: drawn as broken in tension", drawn)
    counted = run("crackstats", at("response"))
    stats = json.loads(counted)
    ok(stats["cracks"]["total"] == 0 and stats["mean"]["fragments"]["before"] == 2
       and stats["mean"]["fragments"]["count"] == 2, "crackstats: no cracks of drying, two pieces before",
       stats["mean"]["fragments"])

    # ---- a cantilever -------------------------------------------------------------------
    # Rigid grains 0..L joined by bonds halfway between, each bent by the moment and sheared by
    # the weight of what is beyond: sums that tend to rho g A L^4 / (8 E I), here q L^4 / (8 E I).
    def tip(count):
        bond = np.arange(count - 1)
        beyond = count - 1 - bond
        arm = [np.sum(2 * R * (np.arange(b + 1, count) - b - 0.5)) for b in bond]
        return (MASS * G * (np.array(arm) / (BOND * INERTIA) * 2 * R * (count - 1 - bond - 0.5)
                            + beyond / (BOND * AREA))).sum()

    def euler(count):
        length = 2 * R * (count - 0.5)
        return MASS * G / (2 * R) * length**4 / (8 * BOND * INERTIA * 2 * R)

    for engine, count in (("explicit", 8), ("quasi-static", 8), ("quasi-static", 60)):
        pack([count, 1, 1])
        forces(np.zeros((2, count, 3)))
        response, said = replay(f"engine={engine}", "held.walls=[\"-x\"]", "friction=0",
                                "normal_stiffness=1e-6", "shear_stiffness=1e-6",
                                f"gravity={G / count**4}")
        got = count**4 * -response["snapshots/displacement"][0, -1, 2]
        wrong = abs(got / tip(count) - 1)
        ok(wrong < (2e-3 if engine == "explicit" else 1e-6),
           f"{engine}: the tip of a row of {count} grains hangs as its bonds bend and shear", wrong)
    ok(abs(got / euler(60) - 1) < 0.05, "60 grains: q L^4 / (8 E I)", got / euler(60))

    # ---- a body under capillary forces --------------------------------------------------
    # Weight and forces of a linear body add up; the weight is at rest before the first load.
    pack([3, 3, 4])
    generator = np.random.default_rng(5)
    force = np.zeros((3, 36, 3))
    force[:2] = 3e-5 * generator.standard_normal((2, 36, 3))
    for engine in ENGINES:
        # Contacts only push: they count for nothing, so that the body is linear.
        loose = (f"engine={engine}", "local_damping=0.7", "cycles=20000",
                 "normal_stiffness=1e-6", "shear_stiffness=1e-6")
        forces(np.zeros_like(force))
        alone = replay(*loose)[0]["snapshots/displacement"][-1]
        forces(force)
        pulled = replay(*loose, "gravity=0")[0]["snapshots/displacement"][:]
        both = replay(*loose)[0]
        moved = both["snapshots/displacement"][:]
        wrong = abs(moved - pulled - alone).max() / abs(moved).max()
        ok(wrong < 2e-2, f"{engine}: what weight does and what forces do add up", wrong)
        wrong = abs(moved[-1] - alone).max() / abs(alone).max()
        ok(wrong < 1e-3, f"{engine}: in the end weight alone is left", wrong)
        borne = both["history/reaction_force"][:] + force.sum(axis=1)
        wrong = abs(borne - [0, 0, 36 * MASS * G]).max() / (36 * MASS * G)
        ok(wrong < 1e-3, f"{engine}: and the support bears both at every step", borne)

    # ---- stopped and gone on with, and later --------------------------------------------
    # It goes on from wherever it was stopped, during the weight too, to the same bytes.
    for engine in ENGINES:
        settings = (f"engine={engine}", "friction=0")
        whole, said = replay(*settings, options=("--checkpoint", at("none")))
        name = at("state")
        made = tried(*settings, output="stopped", options=("--checkpoint", name, "--checkpoint-every", "1e-9"))
        ok(made.returncode == 0 and open(at("stopped"), "rb").read() == open(at("response"), "rb").read(),
           f"{engine}: the same bytes with the state kept on the way", made.stderr)
        first, later = force[:2], force[2:]
        forces(first, "first"), forces(later, "later")
        replay(*settings, "keep_state=true", inputs=("first",), output="kept")
        one, said = replay(*settings)
        two, said = replay(*settings, inputs=("later", "kept"), output="later-response")
        ok(np.allclose(one["snapshots/displacement"][-1], two["snapshots/displacement"][-1], rtol=0,
                       atol=1e-9 * abs(moved).max()),
           f"{engine}: a later replay goes on from a body that stands")

    # ---- refused, said ------------------------------------------------------------------
    made = tried("support=free")
    ok(made.returncode == 65 and "dem-replay.gravity: must be 0 with support=free" in made.stderr,
       "nothing holds a free body up", made.stderr)
    pack([3, 3, 4], "periodic=[false,false,true]")
    forces(force)
    made = tried('held.walls=["-x"]')
    ok(made.returncode == 65 and "must be 0 in a box that is periodic along z" in made.stderr,
       "no gravity along a side that repeats", made.stderr)

    # ---- whether it came to rest ----------------------------------------------------------
    pack([1, 1, n])
    forces(np.zeros((2, n, 3)))
    for tolerance, rests in (1e-2, True), (1e-3, False):
        response, said = replay("engine=explicit", f"tolerance={tolerance}", "cycles=2", "local_damping=0.7")
        ratio = response["summary"].attrs["weight_unbalanced_ratio"]
        response.close()
        page = run("report", at("response"), "-o", "-").decode()
        ok(1e-4 < ratio and (ratio < tolerance) == rests, f"ratio under the weight, tolerance={tolerance}", ratio)
        ok(("did not come to rest before drying" in said) != rests
           and ("did not come to rest before drying" in page) != rests,
           "replay and page complain only where it is not below the tolerance", said)

    # ---- Bond numbers -------------------------------------------------------------------
    pack([3, 3, 4])
    suction = 200.0
    forces(force, capillary_pressure=suction)
    largest = np.linalg.norm(force, axis=2).max()
    for gravity, g in (("0", 9.80665), ("2.5", 2.5)):
        response, said = replay(f"gravity={gravity}", "cycles=10")
        summary = response["summary"].attrs
        ok(abs(summary["bond_number_grain"] / (MASS * g / largest) - 1) < 1e-12
           and abs(summary["bond_number_body"] / (36 * MASS * g / (36 * R**2 * suction)) - 1) < 1e-12,
           f"Bond numbers, gravity={gravity}", dict(summary))
        ok(("gravity is left out, but the body weighs" in said) == (gravity == "0"),
           "a line when weight is left out and matters", said)
    forces(1000 * force, capillary_pressure=1000 * suction)
    ok("gravity is left out" not in replay("gravity=0", "cycles=10")[1], "and none where it does not")
    response, said = replay("gravity=null", "cycles=10")
    ok("gravity" not in response["summary"].attrs and "left out: gravity" in str(response.attrs["model"]),
       "without a word there is none, if the forces have none")

    # The area is that of the cylinder in which grains stand, not of the box around it.
    run("pack", *sets("method=import", "domain.shape=cylinder", f"domain.radius={5 * R}", f"domain.height={8 * R}"),
        at("packing"), "-o", at("column"))
    os.replace(at("column"), at("packing"))
    forces(force, capillary_pressure=suction)
    body = replay(f"gravity={G}", "cycles=10")[0]["summary"].attrs["bond_number_body"]
    ok(abs(body / (36 * MASS * G / (np.pi * (5 * R)**2 * suction)) - 1) < 1e-12, "Bond number of a body in a cylinder", body)

    # ---- defaults of 500 nm grains ------------------------------------------------------
    def defaults(*settings):
        return subprocess.run([f"{BIN}/dem-replay", *sets("cycles=1", "time_step_safety=null", *settings),
                               at("forces"), "-o", at("response")], capture_output=True, text=True).stderr

    said = defaults()
    ok("the defaults of normal_stiffness, bond.normal_stiffness, bond.normal_strength, "
       "bond.shear_strength are those of grains of 250 nm radius; these have 0.0005 m" in said,
       "defaults of 250 nm grains are said at 0.5 mm", said)
    said = defaults("normal_stiffness=1e4", "bond.normal_stiffness=1e9", "bond.normal_strength=1e5",
                    "bond.shear_strength=1e5")
    ok("defaults" not in said, "not where all are given", said)
done()
