#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Flows of viscous liquid that are kept for a while (flow_step) beside those found at each event: the
# same drying to a share that falls with the step, also next to
# both limits, and exact books.
import sys

import h5py
import numpy

sys.path.insert(0, "tests")
from drying_curves import farthest
from tap import done, ok, refused, run, scratch_paths, sets


def network(name, *settings):
    run("pack", "-q", *sets("sizes.distribution=normal", "sizes.spread=0.2", "sizes.smallest=125e-9",
                            "sizes.largest=375e-9", *settings), "-o", at("packing"))
    run("tessellate", "-q", *sets("conductance=cylinder"), at("packing"), "-o", at("tessellation"))
    run("merge-nodes", "-q", *sets("measure=fraction", "threshold=0.06"), at("tessellation"), "-o", at(name))


def emptied(file):
    """When each throat empties, over the drying time."""
    last = file["events/kind"][:] == 0
    times = numpy.zeros(len(file["throats/kind"]))
    times[file["events/throat"][last]] = file["events/time"][last] / file["history/time"][-1]
    return times


def dried(source, *settings):
    run("dry", "-q", *sets("liquid=viscous", *settings), at(source), "-o", at("drying"))
    with h5py.File(at("drying")) as file:
        return {"saturation": file["history/saturation"][:], "time": file["history/time"][:],
                "throats": file["events/throat"][:], "emptied": emptied(file),
                "books": file["summary"].attrs["balance_error"],
                "residual": file["summary"].attrs["liquid_residual"]}


with scratch_paths() as at:
    network("small", "method=radius_expansion", "count=250")
    exact = dried("small", "viscosity=1e-3", "flow_step=0")
    limits = [dried("small", "viscosity=1e-3", f"liquid={liquid}") for liquid in ("inviscid", "immobile")]
    ok(min(farthest(limit, exact) for limit in limits) > 0.03, "neither limit is this drying",
       [farthest(limit, exact) for limit in limits])
    kept = {step: dried("small", "viscosity=1e-3", f"flow_step={step}") for step in (0.001, 0.01, 0.1)}
    off = {step: farthest(drying, exact) for step, drying in kept.items()}
    ok(off[0.001] < 0.004 and off[0.01] < 0.01 and off[0.1] < 0.03, "flows that are kept: alike in time", off)
    ok(off[0.001] < off[0.1], "the more so the shorter they are kept", off)
    tiny = dried("small", "viscosity=1e-3", "flow_step=1e-9")
    apart = numpy.median(abs(tiny["emptied"] - exact["emptied"]))
    ok(apart < 6e-4, "steps so small that throats that empty or refill end them: times of throats nearly exact", apart)
    ok(all(sorted(set(drying["throats"])) == sorted(set(exact["throats"])) for drying in kept.values()),
       "the same throats empty")
    ok(all(drying["books"] < 1e-12 and 0 < drying["residual"] < 1e-4 for drying in kept.values()),
       "nothing is lost", [(drying["books"], drying["residual"]) for drying in kept.values()])
    for viscosity in 1e-12, 1e4:
        ends = [dried("small", f"viscosity={viscosity}", f"flow_step={step}") for step in (0, 0.05)]
        ok(farthest(*ends) < 1e-3, f"next to a limit, a viscosity of {viscosity}, flows hardly change",
           farthest(*ends))
        ok(ends[1]["books"] < 1e-12, "and nothing is lost, though more flows between menisci than evaporates",
           ends[1]["books"])
    for other in "kelvin=true", "saturation_step=0.5":
        refused(f"flow_step with {other}", "flow_step: must be 0", "dry", "-q",
                *sets("liquid=viscous", "flow_step=0.01", other), at("small"))

    network("large", "method=radius_expansion", "count=2200")
    exact, usual = (dried("large", "viscosity=1e-3", "stop_saturation=0.95", *step) for step in (["flow_step=0"], []))
    off = abs(usual["time"][-1] / exact["time"][-1] - 1)
    ok(exact["residual"] < 1e-11 < usual["residual"] and off < 5e-3,
       "a network of more than 20,000 throats keeps flows unless asked not to", (usual["residual"], off))
done()
