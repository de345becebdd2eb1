#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Diffusivity and permeability of random packings, equal and polydisperse, against published bounds
# and fits. The network is solved here, not by a stage.
import sys

import h5py
import numpy as np

sys.path[:0] = ["tests", "tests/bench/void"]
import published
from network_rules import Network
from network_solve import Balance
from tap import done, ok, run, scratch_paths, sets

LOGNORMAL = ["sizes.distribution=lognormal", "sizes.spread=0.3", "sizes.smallest=0.4e-6", "sizes.largest=2.2e-6"]
CASES = {"equal, jammed": [],
         "equal, loose": ["target=porosity", "target_value=0.45"],
         "lognormal, jammed": LOGNORMAL,
         "lognormal, loose": ["target=porosity", "target_value=0.45", *LOGNORMAL]}


for title, how in CASES.items():
    with scratch_paths() as at:
        run("pack", "-q", *sets("method=radius_expansion", "count=400", "radius=1e-6", "periodic=[true,true,true]",
                                "dynamics.friction=0", "bonds=none", "seed=3",
                                *how),
            "-o", at("packing.h5"))
        run("tessellate", "-q", at("packing.h5"), "-o", at("network.h5"))
        network = Network(at("network.h5"))
        with h5py.File(at("network.h5")) as file:
            diffusion = file["throats/diffusive_conductance"][:] / network.unit
            flow = file["throats/hydraulic_conductance"][:] / network.unit**3
            radius = file["particles/radius"][:]
        porosity = 1 - (4 / 3 * np.pi * network.radius**3).sum() / np.prod(network.box)
        diffusivity = [Balance(network, diffusion).flow(axis)[1] for axis in range(3)]
        permeability = np.mean([Balance(network, flow).flow(axis)[1] for axis in range(3)]) * network.unit**2
        low, high = porosity**1.5, porosity / (1.5 - porosity / 2)
        ok(all(low < d < high for d in diffusivity),
           f"{title}: diffuses more than Bruggeman, less than the bound of Hashin & Shtrikman",
           (low, *diffusivity, high))
        wanted = published.permeability(porosity, published.sauter_diameter(radius))
        ok(abs(permeability / wanted - 1) < 0.15, "  its permeability is the published one within 15 %",
           (permeability, wanted))
        print(f"# porosity {porosity:.4f}, D {np.mean(diffusivity):.4f} ({low:.4f} to {high:.4f}), "
              f"k {permeability / wanted - 1:+.3f}")
done()
