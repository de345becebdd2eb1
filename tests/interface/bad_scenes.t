#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input (tests/refusals.py): what the other stages are asked for and cannot do."""
import sys

sys.path.insert(0, "tests")
from refusals import BAD_DATA, UNSTABLE, damaged, done, make, refused, removed, setting, value
from tap import sets

DRY, REPLAY = ("dry", "network"), ("dem-replay", "forces")
setting("air wetter than saturated is refused", BAD_DATA, "air_vapour_pressure=3000",
        r"network: air_vapour_pressure: must be below saturation_pressure \(2339.19 Pa\), "
        "is 3000 Pa: nothing would dry", program=DRY)
setting("a boiling liquid is refused", BAD_DATA, "saturation_pressure=2e5",
        r"network: saturation_pressure: must be below gas_pressure \(100000 Pa\), "
        "is 200000 Pa: the liquid would boil", program=DRY)
setting("a draught beyond laminar flow is refused", BAD_DATA,
        'boundary_layer={"from":"plate","flow_length":10,"air_velocity":1}',
        r"dry.boundary_layer.air_velocity: must keep Re = u L / nu at or below 500000, .*, "
        "got Re = 655326", program=DRY)
setting("a boundary layer without end is refused", BAD_DATA,
        'boundary_layer={"from":"plate","air_velocity":0}',
        "dry.boundary_layer: must have a finite thickness above 0, got inf m",
        program=DRY)
setting("columns on an auxiliary layer need one", BAD_DATA, "boundary_layer.columns=auxiliary",
        "network: /throats/kind: no throat of the boundary layer begins at the network .*",
        program=DRY)
setting("an unknown way to find the boundary layer is refused", BAD_DATA,
        "boundary_layer.from=wind", r"dry.boundary_layer.from: .*", program=DRY)
setting("no open wall is refused", BAD_DATA, "open=[]",
        "network: open walls: must be one at least, or nothing would dry", program=DRY)
refused("a network without liquid is refused", BAD_DATA,
        ["dry", damaged("network", value("throats/kind", slice(None), 2))],
        "damaged: /throats/kind: no throat holds liquid, there is nothing to dry: "
        "all are imposed empty, or closed by grains")
setting("a share of throats above one is refused", BAD_DATA, "threshold=2",
        "merge-nodes.threshold: must be from 0 to 1 where it is a fraction, got 2",
        program=("merge-nodes", "--set", "measure=fraction", "network"))
setting("snapshots that rise are refused", BAD_DATA, "snapshots=[0.5,0.9]",
        "dem-replay.snapshots: must fall from one to the next, got 0.9 after 0.5",
        program=REPLAY)
for size in 1e140, 1e-100:
    refused(f"grains of {size} m are refused", BAD_DATA,
            [*REPLAY[:1], damaged("forces", value("particles/radius", 3, size))],
            rf"damaged: grain 3: radii must be from 1e-60 to 1e60 m, .* got {size:g}, .*"
            .replace("e+", r"e\+"))
# Bridges much larger than their bodies; those of the volume it names work.
ONE_BRIDGE = ("bridge", "--set", "radius=1e-6", "--set", "points=2")
setting("a bridge without rupture says what volumes have one", UNSTABLE, "volume=4e-17",
        r"no rupture found for 4e-17 m3, 40 times the cube of the effective radius: between "
        r"these bodies it is up to 24\.\d times \(2\.4\d*e-17 m3\)", program=ONE_BRIDGE)
make("bridge", *ONE_BRIDGE, "--set", "volume=2.4e-17")
setting("a time step past the stability limit is refused", UNSTABLE, "time_step_safety=10",
        r"forces: time step \S+ s is past the stability limit of \S+ s: .*must be below .*"
        "got 10", program=REPLAY)
setting("grains without mass to speak of are refused", BAD_DATA, "density=5e-324",
        "forces: density and stiffness must give a time step above 0, got 0 s",
        program=REPLAY)
setting("a tolerance that is not met is reported", UNSTABLE, "tolerance=1e-12",
        r"forces: step \d of the load .*: unbalanced ratio \S+ is not below 1e-12 after 9 "
        "cycles", program=(*REPLAY, "--set", "time_step_safety=0.02", "--set", "cycles=9",
                             "--set", "most_cycles=9", "--set", "unsettled=stop"))

setting("a table of too many slices and intervals is refused", BAD_DATA, "slices=100000",
        "crackstats.slices: times intervals must be at most 1000000, got 100000 times 11",
        program=("crackstats", "response", "--set", "intervals=11"))
refused("a drying that holds nothing any more does not go on", BAD_DATA,
        ["dry", "--set", "start_saturation=0.5",
         damaged("drying", value("history/saturation", slice(None), 1))],
        "damaged: /changes/saturation: no throat holds liquid any more at "
        "dry.start_saturation 0.5")
refused("a drying whose last liquid is in throats imposed empty does not go on", BAD_DATA,
        ["dry", "--set", "start_saturation=1e-9", "--set", 'imposed_empty=["+x"]', "drying"],
        "drying: /changes/saturation: no throat holds liquid any more at "
        "dry.start_saturation 1e-09")
make("viscous", "dry", "network", "--set", "liquid=viscous", "--set", "snapshots=[0.5]")
for name in ["liquid_pressure", "time"]:
    refused(f"pressures of viscous liquid need /snapshots/{name}", BAD_DATA,
            ["force-protocol", "--set", "pressure=field",
             damaged("viscous", removed(f"snapshots/{name}"))],
            f"damaged: /snapshots/{name}: pressure=field needs it: .*")
setting("stiffnesses too far apart for equilibria are reported", UNSTABLE,
        "bond.radius_fraction=1e-6", r"forces: step \d .*: the equilibrium of grain \d+ cannot "
        "be computed: stiffnesses differ by too many orders of magnitude .*",
        program=(*REPLAY, "--set", "engine=quasi-static", "--set", "bond.normal_stiffness=1e-20"))

# Sizes that are allowed one by one, and what comes of them is too large to write.
for program, name, changes in [
        ("dry", "history/rate", ["boundary_layer.from=thickness",
                                 "boundary_layer.thickness=1e-300"]),
        ("invade", "events/pressure", ["surface_tension=1e150"]),
        ("flow", "throats/conductance", ["viscosity=1e-300"]),
        ("flow", "particles/buoyancy", ["gravity=[0,0,1e150]", "density=1e150"])]:
    refused(f"{program} refuses results that overflow: {name}", BAD_DATA,
            [program, *sets(*changes),
             "packing" if program == "flow" else "network"],
            f"the results are out of range: /{name}: row 0: must be at most 1e150 in size, got .*")

done()
