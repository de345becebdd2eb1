# SPDX-License-Identifier: GPL-3.0-or-later
"""What portions of drying and shrinking came to.

Three blocks of lines, each beginning with the liquid left, of what the body held when full:
steps of the drying (time in s, rate and room for liquid, of the first), shrinkage of the body
where dem-replay took a snapshot (nan: too little of it is left to tell), and cracks so far.
Liquid that finds no room between two portions evaporates first, at the rate at which the
portion that follows begins.
"""
import math

from common import artifact, document, refuse, summary


def course(folder, portions):
    """The text of the three blocks, from the folders 1, 2 ... of FOLDER."""
    steps, moments, cracks = [], [], []
    began = expelled = count = left = 0
    for k in range(1, portions + 1):
        drying, response, network = (artifact(f"{folder}/{k}/{kind}.h5", kind) for kind in ("drying", "response", "network"))
        saturation, time, rate = (drying[f"history/{name}"][:] for name in ("saturation", "time", "rate"))
        full = summary(drying)["liquid_mass"] / saturation[0]
        if k == 1:
            first_full, first_rate = full, rate[0]
        elif abs(left - expelled - full * saturation[0]) > 1e-12 * first_full:
            refuse(70, f"{folder}/{k}: liquid was lost or made: {left - expelled} became {full * saturation[0]} kg")
        left, room = full * saturation[-1], full / first_full
        began += expelled / rate[0]
        steps += [(s * room, began + t, r / first_rate, room) for s, t, r in zip(saturation, time, rate)]
        began += time[-1]
        moments += [(d["saturation"] * room, math.nan if d["shrinkage"] is None else d["shrinkage"])
                    for d in document(f"{folder}/{k}/crackstats.json")["deformation"]]
        cracks += [(s * room, count + n) for s, n in
                   zip(response["history/saturation"][:], response["history/cracks"][:])]
        count += response["history/cracks"][-1]
        expelled = drying["liquid"].attrs["density"] * summary(network)["expelled_volume"]
    return "\n\n".join("".join("\t".join(f"{x:.9g}" for x in row) + "\n" for row in block)
                       for block in (steps, moments, cracks))
