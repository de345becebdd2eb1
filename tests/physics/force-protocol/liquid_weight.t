#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# The weight of the liquid in forces: all of it at any saturation, each grain what its own cell
# holds, buoyancy in a full body at rest, and what the support of a replay bears.
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, refused, run, scratch_paths, sets

G, RHO = 9.81, 998.2
CLOSED = 'imposed_empty=["-x","+x","-y","+y","-z"]'

with scratch_paths() as at:
    def network(name, pack, volume="void", *merge):
        made = run("pack", "-q", *sets(*pack))
        made = run("tessellate", *sets(f"throat_volume={volume}"), input=made)
        run("merge-nodes", *sets(*merge), "-o", at(name), input=made)

    def dry(name, *settings, output="drying"):
        run("dry", "-q", *sets(CLOSED, f"liquid_density={RHO}", *settings), at(name), "-o", at(output))
        return h5py.File(at(output))

    def forces(*settings, input="drying", output="forces"):
        run("force-protocol", *sets("steps=9", *settings), at(input), "-o", at(output))
        return h5py.File(at(output))

    def liquid(drying, times):
        """Of all throats together, kg: saturations are linear between two steps."""
        kind, state = drying["throats/kind"][:], None
        state = np.where(kind == 0, 1.0, 0.0)
        volume = (drying["throats/volume"][:] if "volume" in drying["throats"] else
                  np.pi * drying["throats/radius"][:]**2 * drying["throats/length"][:])
        offset, throat = drying["changes/offset"][:], drying["changes/throat"][:]
        to, mass = drying["changes/saturation"][:], []
        for k in range(len(offset) - 1):
            state[throat[offset[k]:offset[k + 1]]] = to[offset[k]:offset[k + 1]]
            mass.append(RHO * (state * volume)[kind == 0].sum())
        return np.interp(times, drying["history/time"][:], mass)

    # ---- an irregular body --------------------------------------------------------------
    settled = ("method=deposition", "count=120", "radius=5e-4", "seed=3")
    rough = ("measure=fraction", "threshold=0.06")
    for volume in "void", "cylinder":
        network("irregular", settled, volume, *rough)
        for law, suction in (("inviscid", "uniform"), ("inviscid", "clusters"), ("immobile", "uniform")):
            drying = dry("irregular", f"liquid={law}", f"gravity={G}")
            weighed = forces(f"pressure={suction}", "force_scale=3")
            mass = liquid(drying, weighed["time"][:])
            total = weighed["force"][:].sum(axis=1)
            strength = np.linalg.norm(weighed["force"][:], axis=2).sum(axis=1).max()
            wrong = abs(total + np.outer(mass, [0, 0, G])).max() / (mass[0] * G)
            ok(wrong < 1e-9 and mass[0] * G / strength > 1e-3,
               f"{volume}, {law}, {suction}: all grains together bear the weight of all liquid, at any saturation",
               (wrong, mass[0] * G / strength))
            held = weighed["liquid_mass"][:].sum(axis=1)
            ok(abs(held - mass).max() < 1e-12 * mass[0]
               and abs(mass[0] / drying["summary"].attrs["liquid_mass"] - 1) < 1e-12
               and weighed["summary"].attrs["gravity"] == G and "weight of the liquid: gravity 9.81"
               in str(weighed.attrs["model"]), f"{volume}, {law}, {suction}: and the shares are all of it")
            if suction == "uniform":
                light = forces(f"pressure={suction}", "force_scale=3", "gravity=0", output="light")
                more = weighed["force"][:] - light["force"][:]
                more[..., 2] += G * weighed["liquid_mass"][:]
                ok(abs(more).max() < 1e-12 * strength and "liquid_mass" not in light,
                   f"{volume}, {law}: weight is on top of suction, whatever force_scale", abs(more).max())

    # Each inner grain carries what its own cell holds: the cell by the divergence theorem.
    network("irregular", settled, "void")
    dry("irregular", f"gravity={G}")
    weighed = forces("steps=2")
    with h5py.File(at("irregular")) as net:
        node, grain = net["nodes/position"][:], net["particles/position"][:]
        offset, loop, sides = net["faces/offset"][:], net["faces/nodes"][:], net["faces/particles"][:]
        radius, kind = net["particles/radius"][:], net["nodes/kind"][:]
    cell, inner = np.zeros(len(grain)), np.ones(len(grain), bool)
    for f, (first, second) in enumerate(sides):
        corner = loop[offset[f]:offset[f + 1]]
        if kind[corner].any():
            inner[[g for g in (first, second) if g >= 0]] = False
        middle = node[corner].mean(axis=0)
        for g in (first, second):
            if g < 0:
                continue
            a, b = node[corner] - grain[g], np.roll(node[corner], -1, axis=0) - grain[g]
            cell[g] += abs(np.einsum("ij,ij->i", np.cross(a, b), np.tile(middle - grain[g], (len(a), 1)))).sum() / 6
    apart = np.linalg.norm(grain[:, None] - grain, axis=2)
    depth = np.clip(radius[:, None] - apart / 2, 0, None) * (apart > 0)
    beyond = (np.pi * depth**2 * (3 * radius[:, None] - depth) / 3).sum(axis=1)  # overlaps, in the next cell
    wanted = RHO * (cell - 4 / 3 * np.pi * radius**3 + beyond)
    got = weighed["liquid_mass"][0]
    wrong = abs(got / wanted - 1)[inner].max()
    ok(inner.sum() > 5 and wrong < 1e-10, "a grain carries the liquid in its own cell", (inner.sum(), wrong))

    # Rings that throats have left weigh too, until they have dried.
    network("ringed", settled)
    for rings, law, start in (("isolated", "inviscid", 0.3), ("joined", "inviscid", 1), ("isolated", "immobile", 0.3)):
        drying = dry("ringed", f"liquid={law}", f"gravity={G}", f"rings={rings}", f"start_saturation={start}")
        weighed = forces("steps=40")
        history = drying["history"]
        share = np.interp(weighed["time"][:], history["time"][:], history["saturation"][:])
        first = drying["summary"].attrs["liquid_mass"]
        mass = first * share / history["saturation"][0]
        wrong = abs(weighed["liquid_mass"][:].sum(axis=1) - mass).max() / first
        weight = abs(weighed["force"][:].sum(axis=1)[:, 2] + mass * G).max() / (first * G)
        ok(wrong < 1e-12 and weight < 1e-9 and history["ring_saturation"][:].max() > 1e-3,
           f"{rings} rings, {law}, full to {start}: they weigh as well",
           (wrong, weight, history["ring_saturation"][:].max()))

    # Times are chosen by that weight as well.
    dry("ringed", "gravity=4e4", "rings=isolated")
    changes = {bound: forces(f"largest_change={bound}")["summary"].attrs["largest_change"] for bound in (0.05, 0.01)}
    ok(all(change < bound for bound, change in changes.items()), "no change is larger than asked for where rings weigh", changes)

    # ---- Archimedes ---------------------------------------------------------------------
    # The cells of a cubic lattice end in throats on all sides: still liquid presses on a full
    # one exactly as on a block of its volume.
    r = 5e-4
    network("lattice", ("counts=[4,4,4]", f"radius={r}"))
    dry("lattice", f"gravity={G}")
    for suction, lift in (("clusters", 8 * r**3), ("uniform", 0)):
        full = forces("form=faces", f"pressure={suction}")
        light = forces("form=faces", f"pressure={suction}", "gravity=0", output="light")
        place = full["particles/position"][:]
        inner = ((place > 2 * r) & (place < 6 * r)).all(axis=1)
        got = (full["force"][0] - light["force"][0])[inner]
        grain = 4 / 3 * np.pi * r**3
        wanted = RHO * G * (lift - (8 * r**3 - grain))
        ok(inner.sum() == 8 and abs(got - [0, 0, wanted]).max() < 1e-9 * abs(wanted),
           f"pressure={suction}: a grain in the midst of liquid " +
           ("floats with the weight of the liquid it displaces" if lift else "carries the liquid around it"),
           (got, wanted))

    # ---- replayed -----------------------------------------------------------------------
    network("irregular", settled, "void", *rough)
    drying = dry("irregular", f"gravity={G}")
    weighed = forces()
    sturdy = ("density=2500", "normal_stiffness=1e5", "shear_stiffness=1e5", "bond.by=distance",
              "bond.gap=0.05", "bond.normal_stiffness=1e13", "bond.shear_stiffness=1e13",
              "bond.normal_strength=1e9", "bond.shear_strength=1e9", "friction=0",
              "held.lower=[-1,-1,-1]", "held.upper=[1,1,2e-3]")
    run("dem-replay", "-q", *sets(*sturdy, "engine=quasi-static"), at("forces"), "-o", at("response"))
    response = h5py.File(at("response"))
    grains = 2500 * 4 / 3 * np.pi * (weighed["particles/radius"][:]**3).sum()
    wanted = G * (grains + liquid(drying, weighed["time"][:]))
    wrong = abs(response["history/reaction_force"][:] - np.outer(wanted, [0, 0, 1])).max() / wanted[0]
    gone = response["summary"].attrs["gone"]
    ok(wrong < 1e-8 and gone == 0, "the support bears grains and liquid, less as it dries", (wrong, gone))
    area = np.prod((weighed["domain/upper"][:] - weighed["domain/lower"][:])[:2])
    ratio = response["summary"].attrs["bond_number_body"] * area * weighed["summary"].attrs["capillary_pressure"]
    ok(abs(ratio / wanted[0] - 1) < 1e-12 and response["summary"].attrs["gravity"] == G
       and "weight of the grains and the liquid" in str(response.attrs["model"]),
       "gravity is that of the forces unless told otherwise", ratio / wanted[0])
    said = subprocess.run([f"{BIN}/dem-replay", *sets(*sturdy, "engine=quasi-static", "gravity=1.62"),
                           at("forces"), "-o", at("response")], capture_output=True, text=True)
    ok(said.returncode == 0 and "gravity = 1.62 m/s2 for the grains, but 9.81 for the liquid" in said.stderr,
       "another gravity for the grains is said", said.stderr)

    # ---- refused ------------------------------------------------------------------------
    network("repeats", ("counts=[4,4,4]", f"radius={r}", "periodic=[false,false,true]"))
    run("dry", "-q", "--set", f"liquid_density={RHO}", "--set", 'open=["+x"]', at("repeats"), "-o", at("drying"))
    refused("no gravity along a side that repeats", "force-protocol.gravity: must be 0 in a box that is periodic along z",
            "force-protocol", "--set", "gravity=9.81", at("drying"), "-o", at("none"))
done()
