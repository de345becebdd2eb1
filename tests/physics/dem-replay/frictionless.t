#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Equilibria without friction in which thousands of contacts open at once: a cubic lattice that is pulled along
# x and z, whose chains of bonds stretch as springs in series do; and grains that settled, whose only
# equilibrium is found in one load and in twenty.
import sys
from math import pi

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, run, scratch_paths, sets

R, STIFFNESS = 1e-6, 1e14
BONDS = sets("bond.normal_strength=1e30", "bond.shear_strength=1e30", f"bond.normal_stiffness={STIFFNESS}",
             f"bond.shear_stiffness={STIFFNESS}", "bond.radius_fraction=0.5", "normal_stiffness=1e6", "friction=0",
             "engine=quasi-static", "quasi_static.tolerance=1e-11", "support=free", "gravity=0", "snapshots=[0]")
at = scratch_paths()


def equilibrium(pull, loads):
    """Response to forces (n, 3) on the grains of packing.h5 that grow in as many LOADS."""
    with h5py.File(at("packing.h5")) as packing, h5py.File(at("forces.h5"), "w") as file:
        for name in packing:
            if name != "VTKHDF":
                packing.copy(name, file)
        file.attrs["schema"] = "craquelure/forces/1"
        for name in list(file["summary"].attrs):
            del file["summary"].attrs[name]
        file["summary"].attrs.update(capillary_pressure=0., force_scale=1., first_period_end_time=0., largest_force=abs(pull).max())
        file["time"] = np.arange(loads + 1, dtype=float)
        file["saturation"] = np.linspace(1, 0, loads + 1)
        file["force"] = np.linspace(0, 1, loads + 1)[:, None, None] * pull
    run("dem-replay", "-q", *BONDS, at("forces.h5"), "-o", at("response.h5"))
    with h5py.File(at("response.h5")) as file:
        return file["snapshots/displacement"][-1], int(file["summary"].attrs["steps_unsettled"])


N, FORCE = 16, 1e-9
run("pack", "-q", *sets("method=cubic", f"counts=[{N},{N},{N}]", f"radius={R}", "bonds=touching"), "-o", at("packing.h5"))
with h5py.File(at("packing.h5")) as file:
    layer = np.rint((file["particles/position"][:] / R - 1) / 2)
pull = FORCE * ((layer == N - 1).astype(float) - (layer == 0)) * [1, 0, 1]
moved, unsettled = equilibrium(pull, 1)
wanted = FORCE / (STIFFNESS * pi * (R / 2)**2) * (layer - (N - 1) / 2) * [1, 0, 1]
error = abs(moved - wanted).max() / abs(wanted).max()
ok(unsettled == 0 and error < 1e-9, "7680 contacts of a lattice open at once; its chains are springs in series", (unsettled, error))

run("pack", "-q", *sets("method=deposition", "count=600", "radius=5e-5", "seed=2", "touching_gap=0.05", "bonds=touching",
                        'sizes={"distribution": "normal", "spread": 0.2, "smallest": 25e-6, "largest": 75e-6}'), "-o", at("packing.h5"))
with h5py.File(at("packing.h5")) as file:
    z, r = file["particles/position"][:, 2], file["particles/radius"][:]
low, high = z < 1.5e-4, z > z.max() - 1.5e-4
pull = np.zeros((len(z), 3))
pull[:, 2] = 1e-4 * (high * r**2 / r[high].dot(r[high]) - low * r**2 / r[low].dot(r[low]))
once, unsettled = equilibrium(pull, 1)
slowly, unsettled_too = equilibrium(pull, 20)
error = abs(once - slowly).max() / abs(slowly).max()
ok(unsettled + unsettled_too == 0 and error < 1e-7, "the equilibrium of an irregular body is the same in one load and in twenty",
   (unsettled, unsettled_too, error))
done()
