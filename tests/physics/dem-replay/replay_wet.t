#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Liquid bridges at the contacts of a bonded lattice that nothing else loads: each contact and its
# bond are pressed by what the bridge pulls with, and so the lattice shrinks evenly. Where grains
# fly apart the response lists the bridges between them, as the exact solution has them.
import glob
import json
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, SCENE, done, ok, refused, run, scratch_paths, sets

STIFFNESS, BOND, SHARE, TENSION, VOLUME = 100.0, 8e13, 0.5858, 0.07, 1e-24
wet = [f"normal_stiffness={STIFFNESS}", f"shear_stiffness={STIFFNESS}",
       f"bond.normal_stiffness={BOND}", f"bond.shear_stiffness={BOND}",
       f"bond.radius_fraction={SHARE}", "bond.normal_strength=1e12", "bond.shear_strength=1e12",
       f"bridges.volume={VOLUME}", f"bridges.surface_tension={TENSION}",
       "bridges.contact_angle=30", "support=free", "time_step_safety=0.02", "cycles=4000"]

with scratch_paths() as at:
    run("pack", "-p", SCENE, *sets("counts=[3,3,3]"), "-o", at("p"))
    run("tessellate", "-p", SCENE, at("p"), "-o", at("t"))
    run("merge-nodes", "-p", SCENE, at("t"), "-o", at("n"))
    run("dry", "-p", SCENE, at("n"), "-o", at("d"))
    run("force-protocol", "-p", SCENE, *sets("steps=5"), at("d"), "-o", at("forces"))
    with h5py.File(at("forces"), "r+") as file:
        file["force"][...] = 0
        place, radius = file["particles/position"][:], file["particles/radius"][0]
    run("dem-replay", "-p", SCENE, *sets(*wet + ["snapshots=[0]"]), at("forces"), "-o", at("r"))
    curve = json.loads(subprocess.run(
        [f"{BIN}/bridge", "-q", *sets(f"radius={radius}", f"volume={VOLUME}", "points=2",
                                      f"surface_tension={TENSION}", "contact_angle=30")],
        check=True, capture_output=True).stdout)
    pull = curve["force"][0]
    with h5py.File(at("r")) as file:
        moved = file["snapshots/displacement"][-1]
        ok(len(file["cracks/bond"]) == 0, "no bond breaks")
    overlap = pull / (STIFFNESS / 2 + BOND * np.pi * (SHARE * radius) ** 2)
    wanted = -(place - place.mean(axis=0)) / (2 * radius) * overlap
    moved = moved - moved.mean(axis=0)
    error = abs(moved - wanted).max() / overlap
    ok(error < 1e-4 and overlap > 1e-4 * radius, "shrinks by what bridges pull with", (error, overlap / radius))
    # Bonds without strength; the upper grains leave upwards.
    with h5py.File(at("forces")) as file, h5py.File(at("pulled"), "w") as copy:
        for name in file:
            file.copy(name, copy)
        for name, value in file.attrs.items():
            copy.attrs[name] = value
        force = file["force"][:]
        force[:, place[:, 2] > 4 * radius] = [0, 0, 4 * pull]
        copy["force"][...] = force
    loose = ["bond.normal_strength=0", "bond.shear_strength=0", "support=fixed", "cycles=6",
             "friction=0", "bridges.pull_in_contact=false", "snapshots=[1,0]"]
    run("dem-replay", "-p", SCENE, *sets(*wet + loose), at("pulled"), "-o", at("apart"))
    with h5py.File(at("apart")) as file:
        pair, names = file["contacts/particles"][:], ["volume", "force", "gap"]
        volume, force, gap = [file[f"snapshots/bridge_{name}"][-1] for name in names]
        now = place + file["snapshots/displacement"][-1]
        on_second = file["snapshots/contact_force"][-1]
    apart = now[pair[:, 1]] - now[pair[:, 0]]
    distance = np.linalg.norm(apart, axis=1)
    over = gap > 0.001 * radius
    ok(over.sum() == 9 and np.allclose(volume[over], VOLUME, rtol=1e-12, atol=0),
       "bridges over gaps are listed with their volumes", (over.sum(), volume, gap / radius))
    # As they were before the last time step of thirty: from rest, about (29/30)^2 of now.
    share = gap[over] / (distance - 2 * radius)[over]
    ok(share.min() > 0.92 and share.max() < 0.95, "with their gaps", share)
    along = (on_second * apart).sum(axis=1) / distance
    ok(np.allclose(along[over], -force[over], rtol=1e-6, atol=0), "their pull is the force of the contact")
    exact = json.loads(subprocess.run(
        [f"{BIN}/bridge", "-q", *sets(f"radius={radius}", f"volume={VOLUME}",
                                      f"surface_tension={TENSION}", "contact_angle=30",
                                      f"separations=[{gap[over][0]:.17g}]")],
        check=True, capture_output=True).stdout)["force"][0]
    ok(np.allclose(force[over], exact, rtol=1e-5, atol=0), "which is that of the exact solution",
       (force[over], exact))
    run("inspect", "--vtk", at("apart"), at("apart"))
    with open(sorted(glob.glob(at("apart*.vtu")))[-1]) as file:
        text = file.read()
    ok(all(f'"bridge_{name}"' in text for name in names), "ParaView gets them too")
    run("dem-replay", "-p", SCENE, *sets("cycles=1"), at("forces"), "-o", at("dry"))
    with h5py.File(at("dry")) as file:
        ok(not any("bridge" in name for name in file["snapshots"]), "without liquid there are none")

    refused("equilibria refuse them", "bridges", "dem-replay", "-q", "-p", SCENE, at("forces"), "-o", at("none"),
            *sets(*wet + ["engine=quasi-static"]))
done()
