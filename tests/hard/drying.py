# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard cases of drying."""
import numpy as np

from cases import case, must
from networks import Network
from scene import LIQUIDS, rewrite
from tap import read


@case("zero-throats")
def zero_throats(scene):
    scene.stages("pack", "tessellate", "merge-nodes")
    scene.refused("dry", 65, "/throats/length: row .*merge-nodes", input=scene.at("tessellate"))
    says = {"throats__radius": "/throats/kind: .*closed by grains",
            "throats__length": "/throats/length: row 0.*merge-nodes"}
    for name, words in says.items():
        bad = scene.at("bad")
        rewrite(scene.at("merge-nodes"), bad, **{name: 0})
        reason = scene.refused("dry", 65, words, input=bad)
    scene.stage("dry")
    must(scene.get("dry", "history/saturation")[-1] == 0, "merged, it does not end dry")
    return f"dry: {reason}"


def dries(scene, *arguments):
    scene.stage("dry", *arguments)
    saturation = scene.get("dry", "history/saturation")
    error, residual = scene.summary("dry", "balance_error"), scene.summary("dry", "residual")
    must(saturation[-1] == 0, f"ends with saturation {saturation[-1]:g}")
    must((np.diff(saturation) <= 0).all(), "the saturation rises")
    must(error < 1e-12, f"evaporated and lost differ by {error:.1e}")
    must(residual < 1e-12, f"the vapour balance is off by {residual:.1e}")
    return max(error, residual)


@case("ties")
def ties(scene):
    scene.stages("pack", "tessellate", "merge-nodes")
    worst = 0
    for liquid in LIQUIDS:
        bytes_seen = set()
        for threads in (1, 1, 2):
            worst = max(worst, dries(scene, "--set", f"liquid={liquid}", "--threads", threads))
            bytes_seen.add(read(scene.at("dry")))
        must(len(bytes_seen) == 1, f"{liquid}: {len(bytes_seen)} different files")
    return f"the same bytes, dry in the end, balances to {worst:.1e}"


@case("near-boiling")
def near_boiling(scene):
    scene.stages("pack", "tessellate", "merge-nodes")
    worst = max(dries(scene, "--set", f"liquid={liquid}") for liquid in LIQUIDS)
    scene.refused("dry", 65, "saturation_pressure: must be below gas_pressure",
                  "--set", "saturation_pressure=1e5")
    return f"dry in the end, balances to {worst:.1e}; at p_g refused"


@case("viscosity")
def viscosity(scene):
    scene.stages("pack", "tessellate", "merge-nodes")
    worst = max(dries(scene, "--set", f"viscosity=1e{power}") for power in range(-18, 1, 2))
    scene.refused("dry", 65, "viscosity", "--set", "viscosity=0")
    return f"dry in the end, balances to {worst:.1e}; at 0 refused"


@case("condensation")
def condensation(scene):
    scene.stages("pack", "tessellate", "merge-nodes")
    worst, refilled = 0, 0
    for liquid in LIQUIDS:
        worst = max(worst, *(dries(scene, "--set", f"liquid={liquid}", "--set", f"surface_tension={tension}")
                             for tension in (1e-9, 0.01, 0.07274, 0.2)))
        filled = (scene.get("dry", "events/kind") == 1).sum()
        must(filled > 0, f"{liquid}: nothing has condensed to the brim")
        refilled += filled
    scene.refused("dry", 65, "never dries", "--set", "air_vapour_pressure=2300")
    return f"{refilled} throats fill, dry in the end, balances to {worst:.1e}; narrow throats in humid air refused"


@case("every-side-open")
def every_side_open(scene):
    scene.stages("pack", "tessellate", "merge-nodes")
    worst = 0
    for liquid in LIQUIDS:
        worst = max(worst, dries(scene, "--set", f"liquid={liquid}"),
                    dries(scene, "--set", f"liquid={liquid}", "--set", "start_saturation=1e-6"))
    scene.refused("dry", 65, "open", "--set", "open=[]")
    return f"full or almost dry at first, balances to {worst:.1e}; no side refused"


@case("cut-off")
def cut_off(scene):
    scene.stages("pack", "tessellate", "merge-nodes")
    net = Network(scene, "merge-nodes")
    one = np.flatnonzero(net.inner[net.ends].all(1))[0]
    around = np.isin(net.ends, net.ends[one]).any(1)
    around[one] = False
    kind = np.where(around, 2, 0)
    closed = scene.at("closed")
    rewrite(scene.at("merge-nodes"), closed, throats__kind=kind)
    return [scene.refused("dry", 65, f"/throats/nodes: row {one}: no way leads",
                          "--set", f"liquid={liquid}", input=closed) for liquid in LIQUIDS][0]
