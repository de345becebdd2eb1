#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# A flat front of immobile liquid recedes into a deep bed as sqrt(t), with the diffusivity that the
# network of the bed's periodic cell has by a solver that is not ours.
#
# The bed is five copies of a jammed periodic cell on top of each other, so it has no wall layers.
# Per area, with z the depth of the front and Stefan flow,
#     rate = drive / (a + z),  z^2 / 2 + a z = drive t / (porosity density),
#     drive = D_eff (p M / R T) ln(p / (p - p_v)),
# a is what the air above resists. The slopes of 1/rate over z and of t over z^2 / 2 give D_eff.
import sys

import h5py
import numpy as np

sys.path[:0] = ["tests", "tests/bench/void"]
from network_rules import Network
from network_solve import Balance
from tap import done, ok, run, scratch_paths, sets

COPIES = 5
DIFFUSIVITY, PRESSURE, VAPOUR, MOLAR_MASS = 2.5685e-5, 1e5, 2339, 18.02e-3
TEMPERATURE, DENSITY, GAS_CONSTANT = 293.15, 998.2, 8.314462618
CONDITIONS = [f"diffusivity={DIFFUSIVITY}", f"gas_pressure={PRESSURE}", f"saturation_pressure={VAPOUR}",
              f"molar_mass={MOLAR_MASS}", f"temperature={TEMPERATURE}", f"liquid_density={DENSITY}",
              "surface_tension=0.07274"]


def triple(values):
    return "[" + ",".join(repr(float(v)) for v in values) + "]"


def stack(cell, out):
    """Writes the centres and radii of COPIES of the grains of CELL, each above the last, and gives
    lower and upper corner, and the porosity far from the ends."""
    with h5py.File(cell) as file:
        x, r = file["particles/position"][:], file["particles/radius"][:]
        lower, upper = file["domain/lower"][:], file["domain/upper"][:]
    height = upper[2] - lower[2]
    np.savetxt(out, np.concatenate([np.column_stack([x + [0, 0, k * height], r]) for k in range(COPIES)]),
               fmt="%.17g")
    porosity = 1 - (4 / 3 * np.pi * r**3).sum() / np.prod(upper - lower)
    return lower, upper + [0, 0, (COPIES - 1) * height], porosity


for seed in 1, 2:
    with scratch_paths() as at:
        run("pack", "-q", *sets("method=radius_expansion", "count=250", "radius=250e-9", "periodic=[true,true,true]",
                                "dynamics.friction=0", "bonds=none", f"seed={seed}"), "-o", at("cell.h5"))
        run("tessellate", "-q", at("cell.h5"), "-o", at("cell-network.h5"))
        lower, upper, porosity = stack(at("cell.h5"), at("bed.txt"))
        run("pack", "-q", *sets("method=import", "check=none", "periodic=[true,true,false]", "bonds=none",
                                f"lower={triple(lower)}", f"upper={triple(upper)}"), at("bed.txt"), "-o", at("bed.h5"))
        run("tessellate", "-q", *sets("throat_volume=void"), at("bed.h5"), "-o", at("network.h5"))
        run("dry", "-q", *sets("liquid=immobile", 'open=["+z"]', "boundary_layer.mass_transfer=50", *CONDITIONS),
            at("network.h5"), "-o", at("drying.h5"))
        with h5py.File(at("cell-network.h5")) as file:
            conductance = file["throats/diffusive_conductance"][:]
        cell = Network(at("cell-network.h5"))
        diffusivity = Balance(cell, conductance / cell.unit).flow(2)[1]
        with h5py.File(at("network.h5")) as file:
            void = file["throats/volume"][:].sum()
        with h5py.File(at("drying.h5")) as file:
            time, saturation, rate = (file[f"history/{name}"][:] for name in ("time", "saturation", "rate"))

    area = np.prod((upper - lower)[:2])
    depth = (1 - saturation) * void / (area * porosity)
    inside = (saturation < 0.85) & (saturation > 0.15) # more than a grain from both ends
    drive = DIFFUSIVITY * PRESSURE * MOLAR_MASS / (GAS_CONSTANT * TEMPERATURE) \
        * np.log(PRESSURE / (PRESSURE - VAPOUR))
    by_rate = 1 / (np.polyfit(depth[inside], 1 / rate[inside], 1)[0] * drive * area)
    by_time = porosity * DENSITY / (2 * np.polyfit(depth[inside], time[inside], 2)[0] * drive)
    ok(0.22 < diffusivity < 0.26, f"seed {seed}: the cell of porosity {porosity:.4f} diffuses", diffusivity)
    ok(abs(by_rate / diffusivity - 1) < 0.02, "  rates fall as 1 / depth, with its diffusivity",
       (by_rate, diffusivity))
    ok(abs(by_time / diffusivity - 1) < 0.02, "  the front recedes as the root of time",
       (by_time, diffusivity))
    print(f"# by rate {by_rate:.4f}, by time {by_time:.4f}, the cell {diffusivity:.4f}")
done()
