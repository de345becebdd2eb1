#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# The stiff aggregate dries in K's two limits [K 5.4], and what that does to the forces.
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import SCENE, done, ok, run, scratch_paths

# [K Table 3.1], and beta = 5.1 m/s: a boundary layer of 5.04 um over 25 grains' width.
diffusivity, molar_mass, temperature, gas, vapour = 2.5685e-5, 18.02e-3, 293.15, 1e5, 2339
area = 25 * 500e-9**2
closed_form = (area * 5.1 * gas * molar_mass / (8.31446261815324 * temperature)
               * -np.log1p(-vapour / gas))

with scratch_paths() as at:
    network = run("merge-nodes", "-p", SCENE,
                  input=run("tessellate", "-p", SCENE, input=run("pack", "-p", SCENE)))
    history = {}
    for limit in "inviscid", "immobile":
        drying = at(limit + ".h5")
        run("dry", "-p", SCENE, "--set", f"liquid={limit}", "-o", drying, input=network)
        run("force-protocol", "-p", SCENE, drying, "-o", at(limit + "-forces.h5"))
        record = h5py.File(drying)
        time, saturation = record["history/time"][:], record["history/saturation"][:]
        rate, clusters = record["history/rate"][:], record["history/clusters"][:]
        history[limit] = saturation, rate, clusters
        kind = record["throats/kind"][:]
        volume = np.pi * record["throats/radius"][:]**2 * record["throats/length"][:]
        mass = 998.2 * volume[kind == 0].sum()

        ok((kind == 2).sum() == 460 and (kind == 0).sum() == 560,
           f"{limit}: 460 throats on sides and bottom imposed empty, 560 hold liquid")
        ok(abs(rate[0] / closed_form - 1) < 1e-12,
           f"{limit}: the first rate is that of a fully wet surface under 5.04 um",
           f"{rate[0]} {closed_form}")
        ok(abs((rate[:-1] * np.diff(time)).sum() / mass - 1) < 1e-12,
           f"{limit}: mass evaporated equals liquid lost to 1e-12")
        ok(record["summary"].attrs["residual"] < 1e-12,
           f"{limit}: the vapour balance closes to 1e-12 of the rate")
        left = (kind == 0).astype(float)
        left[record["changes/throat"][:]] = -1
        ok(saturation[0] == 1 and saturation[-1] == 0 and (np.diff(saturation) < 0).all()
           and (left[kind == 0] == -1).all(), f"{limit}: dries steadily, to the end")
        final = np.where(kind == 0, 1.0, 0.0)
        final[record["changes/throat"][:]] = record["changes/saturation"][:]  # the last counts
        ok((final == 0).all(), f"{limit}: and every throat ends empty")

        forces = h5py.File(at(limit + "-forces.h5"))
        force = forces["force"][:]
        unit = forces["summary"].attrs["capillary_pressure"] * 250e-9**2
        inner = force[0].reshape(5, 5, 10, 3)[1:-1, 1:-1, 1:-1]
        ok(np.abs(inner).max() < 1e-14 * unit,
           f"{limit}: a full network puts no force on inner grains", np.abs(inner).max() / unit)
        ok(np.abs(force[0]).max() > 0.5 * unit and (force[-1] == 0).all(),
           f"{limit}: it presses the outer ones, and at the end nothing is left")
        ok(forces["force"].shape == (550, 250, 3)
           and np.ptp(np.diff(forces["time"][:])) < 1e-12 * time[-1],
           f"{limit}: 550 uniform steps [K 5.2]")

    saturation, rate, clusters = history["immobile"]
    ok((np.diff(rate) <= 1e-9 * rate[0]).all() and rate[1] < rate[0],
       "immobile: the rate falls from the first moment", np.diff(rate).max() / rate[0])
    wet = saturation > 0.05  # the last layer falls apart throat by throat
    ok((clusters[wet] <= 2).all() and (clusters[wet] == 1).mean() > 0.8,
       "immobile: one cluster, but for a single throat left behind now and then",
       f"{clusters[wet].max()} {(clusters[wet] == 1).mean()}")
    saturation, rate, clusters = history["inviscid"]
    ok(clusters.max() > 50, "inviscid: the liquid splits into many clusters")
    ok(rate[saturation > 0.95].min() > 0.99 * rate[0],
       "inviscid: the rate is constant at first, within 1 % down to a saturation of 0.95")
    slower = history["immobile"]
    middle = lambda s, r: np.interp(-0.9, -s, r)
    ok(middle(saturation, rate) > 1.15 * middle(*slower[:2]),
       "inviscid: capillary pumping keeps the rate up where immobile liquid has lost it")
done()
