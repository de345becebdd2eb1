#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# flow with conductance=section: the same void as a pore network of open sections, whose permeability is
# found here from tessellate's conductances; a lattice in a box of mirrors; published flow through beds.
import sys

import h5py
import numpy as np

sys.path[:0] = ["tests", "tests/bench/void"]
import published
from network_rules import Network
from network_solve import Balance
from tap import done, ok, run, scratch_paths, sets

LOGNORMAL = ["sizes.distribution=lognormal", "sizes.spread=0.3", "sizes.smallest=0.4e-6", "sizes.largest=2.2e-6"]
JAMMED = ["method=radius_expansion", "count=300", "radius=1e-6", "dynamics.friction=0", "bonds=none", "seed=5"]
PERIODIC = "periodic=[true,true,true]"
at = scratch_paths()


def pack(name, *settings):
    run("pack", "-q", *sets(*settings), "-o", at(name))
    return at(name)


def sections(packing, *settings):
    run("flow", "-q", *sets("conductance=section", "viscosity=1", *settings), packing, "-o", at("flow.h5"))
    return h5py.File(at("flow.h5"))


def tensor(packing):
    with sections(packing, "permeability_tensor=true") as file:
        return file["permeability"][:]


def of_network(packing, axes=range(3)):
    run("tessellate", "-q", packing, "-o", at("network.h5"))
    network = Network(at("network.h5"))
    balance = Balance(network, network.stored[1] / network.unit**3)
    return np.array([balance.flow(axis)[1] for axis in axes]) * network.unit**2


def imported(name, grains, upper, periodic):
    text = "\n".join(" ".join(f"{x:.17g}" for x in grain) for grain in grains)
    run("pack", "-q", *sets("method=import", "lower=[0,0,0]", f"upper={upper}", "bonds=none", periodic), "-o", at(name),
        input=text.encode())
    return at(name)


def grown(packing, factor, name):
    """The packing with its radii times FACTOR."""
    with h5py.File(packing) as file:
        grains = np.column_stack([file["particles/position"][:], factor * file["particles/radius"][:]])
        return imported(name, grains, file["domain/upper"][:].tolist(), PERIODIC)


jammed = pack("jammed.h5", *JAMMED, PERIODIC)
for title, packing in {"equal grains": jammed,
                       "unequal grains, loose": pack("loose.h5", *JAMMED, PERIODIC, *LOGNORMAL, "target=porosity", "target_value=0.45"),
                       "grains that overlap": grown(jammed, 1.04, "overlaps.h5")}.items():
    k, wanted = tensor(packing), of_network(packing)
    error = np.abs(np.diag(k) / wanted - 1).max()
    ok(error < 1e-10, f"{title}: permeability is that of the network of open sections", (np.diag(k), wanted))
    ok(np.abs(k - k.T).max() < 1e-9 * k.max(), "  the tensor is symmetric", k)

# Walls across the flow only: what flows in enters through them.
packing = pack("walled.h5", *JAMMED)
with sections(packing) as file:
    k = file["summary"].attrs["permeability"]
    inflow = file["walls/inflow"][:]
    forces = sum(file[name][:].sum(axis=0) for name in
                 ("particles/viscous_force", "particles/pressure_force", "walls/viscous_force", "walls/pressure_force"))
wanted = of_network(packing, [2])[0]
ok(abs(k / wanted - 1) < 1e-3, "in a box with walls: that of the network, within 0.1 %", (k, wanted))
ok(abs(inflow.sum()) < 1e-10 * np.abs(inflow).max() and np.abs(forces).max() < 1e-9, "  flows and forces balance", (inflow, forces))

# Eight grains in a box of mirrors are the simple cubic lattice.
corners = [[x, y, z, 0.9e-6] for x in (1e-6, 3e-6) for y in (1e-6, 3e-6) for z in (1e-6, 3e-6)]
both = {}
for name, periodic in (("mirrors", "periodic=[false,false,true]"), ("lattice", PERIODIC)):
    with sections(imported(name, corners, [4e-6] * 3, periodic), "sides=symmetric") as file:
        both[name] = file["summary"].attrs["permeability"]
ok(abs(both["mirrors"] / both["lattice"] - 1) < 1e-9, "between planes of symmetry a lattice conducts as it does without end", both)

# One layer of a square lattice between two walls: a throat from wall to wall is seen from both triangles of a square
# of grains, and is one. Its slices are open over 1 - pi (a^2 - u^2), lengths in edges of a square, and gas diffuses as 1 over
# the integral of 1 / open.
r, a = 0.5e-6, 0.45
layer = [[(2 * i + 1) * r, (2 * j + 1) * r, r, 2 * a * r] for i in range(3) for j in range(3)]
for name, periodic in ("endless", "periodic=[true,true,false]"), ("boxed", "periodic=[false,false,false]"):
    with sections(imported(name, layer, [6 * r, 6 * r, 2 * r], periodic)) as file:
        k = file["summary"].attrs["permeability"]
    run("tessellate", "-q", "-s", "throat_volume=void", at(name), "-o", at("network.h5"))
    run("invade", "-q", "-s", "transport=true", "-s", "trapping=false", at("network.h5"), "-o", at("invasion.h5"))
    with h5py.File(at("invasion.h5")) as file:
        summary = dict(file["summary"].attrs)
        volume = file["throats/volume"][:]
    p = 1 - np.pi * a**2
    closed = 1 / (2 / np.sqrt(p * np.pi) * np.arctan(a * np.sqrt(np.pi / p)) + 1 - 2 * a)
    ok(abs(summary["permeability"] / k - 1) < 1e-9 and abs(summary["diffusivity"] / closed - 1) < 1e-9 and volume.min() > 0,
       f"one square layer, {name}: each throat from wall to wall once", (summary["permeability"] / k, summary["diffusivity"] / closed))

# Shrunk in place, where hydraulic radii are 1.1 to 2.5 times off (docs/flow.md).
for factor, within in ((1, 0.1), (0.95, 0.15), (0.8, 0.2), (0.7, 0.2)):
    packing = grown(jammed, factor, "shrunk.h5")
    with h5py.File(packing) as file:
        porosity, diameter = file["summary"].attrs["porosity"], 2 * file["particles/radius"][0]
    ratio = np.trace(tensor(packing)) / 3 / published.permeability(porosity, diameter)
    ok(abs(ratio - 1) < within, f"radii times {factor}: published permeability within {100 * within:.0f} %", (porosity, ratio))
done()
