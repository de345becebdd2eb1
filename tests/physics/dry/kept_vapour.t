#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Vapour whose potentials are kept for a while (vapour_step) beside the exact vapour: the same drying, the
# closer the smaller the step, rates within the step, and exact books.
import sys

import h5py

sys.path.insert(0, "tests")
from drying_curves import farthest
from tap import done, ok, refused, run, scratch_paths, sets


def make_network(count):
    run("pack", "-q", *sets("sizes.distribution=normal", "sizes.spread=0.2", "sizes.smallest=125e-9",
                            "sizes.largest=375e-9", "method=radius_expansion", f"count={count}"), "-o", at("packing"))
    run("tessellate", "-q", at("packing"), "-o", at("tessellation"))
    run("merge-nodes", "-q", *sets("measure=fraction", "threshold=0.06"), at("tessellation"), "-o", at("network"))


def dried(*settings):
    run("dry", "-q", *sets(*settings), at("network"), "-o", at("drying"))
    with h5py.File(at("drying")) as file:
        return {"saturation": file["history/saturation"][:], "time": file["history/time"][:],
                "rate": file["history/rate"][:], "throats": sorted(file["events/throat"][:]),
                "books": file["summary"].attrs["balance_error"],
                "balance": file["summary"].attrs["residual"]}


def compare(*settings):
    """Two steps with the exact vapour."""
    name = ", ".join(settings) or "inviscid"
    exact = dried(*settings)
    kept = {step: dried(*settings, f"vapour_step={step}") for step in (0.01, 0.3)}
    off = {step: farthest(drying, exact) for step, drying in kept.items()}
    ok(off[0.01] < 1e-3 and off[0.3] < 0.03, f"{name}: vapour that is kept, alike in time", off)
    ok(off[0.01] < off[0.3], f"{name}: the more so the smaller the step", off)
    ok(all(drying["throats"] == exact["throats"] for drying in kept.values()), f"{name}: the same throats empty")
    ok(all(drying["books"] < 1e-11 and drying["balance"] < 1e-9 for drying in kept.values()),
       f"{name}: nothing is lost", [(drying["books"], drying["balance"]) for drying in kept.values()])


with scratch_paths() as at:
    make_network(600)
    for settings in ([], ["liquid=immobile"], ["rings=isolated"], ["boundary_layer.exchange=lumped"],
                     ['open=["-x","+z"]', "gravity=9.81"]):
        compare(*settings)
    for saturation in 1, 0.7, 0.4:  # where the same throats are empty
        start = [f"start_saturation={saturation}"]
        first = dried(*start)["rate"][0]
        for step in 0.2, 0.01:
            rate = dried(*start, f"vapour_step={step}")["rate"][0]
            ok(abs(rate / first - 1) < step, f"the rate at {saturation} is within {step}", rate / first - 1)
    for deviation in "3e-6", "1e-5":  # radii over eight and ten decades
        wide = ["throat_radius.distribution=lognormal", f"throat_radius.standard_deviation={deviation}"]
        exact = dried(*wide)
        for step in 0.2, 0.5:
            drying = dried(*wide, f"vapour_step={step}")
            ok(drying["throats"] == exact["throats"] and drying["books"] < 1e-11 and drying["balance"] < 1e-9,
               f"radii that deviate by {deviation} m, a step of {step}: all empties, nothing is lost",
               (len(drying["throats"]), drying["books"], drying["balance"]))
    # Their flow is kept as well: its step is an error of its own, and which throat empties next a matter of chance.
    for viscosity in "1e-6", "1e-3", "1":
        liquid = ["liquid=viscous", f"viscosity={viscosity}", "flow_step=0.01"]
        exact = dried(*liquid)
        kept = [dried(*liquid, f"vapour_step={step}") for step in (0.01, 0.2)]
        off = [farthest(drying, exact) for drying in kept]
        ok(max(off) < 0.02 and min(off) < 0.005, f"viscous liquid, {viscosity} m2/s: alike in time", off)
        ok(all(set(drying["throats"]) == set(exact["throats"]) and drying["books"] < 1e-11 for drying in kept),
           "the same throats empty, and nothing is lost", [drying["books"] for drying in kept])
    late = [dried(*liquid, "start_saturation=0.5", f"vapour_step={step}") for step in (0, 0.2)]
    ok(set(late[0]["throats"]) == set(late[1]["throats"]) and late[1]["books"] < 1e-11,
       "nor where nodes are dry at the start", late[1]["books"])
    for other in "kelvin=true", "liquid=viscous":
        refused(f"vapour_step with {other}", "vapour_step: must be 0", "dry", "-q",
                *sets("vapour_step=0.1", other), at("network"))

    run("pack", "-q", *sets("counts=[8,8,5]"), "-o", at("packing"))
    run("tessellate", "-q", at("packing"), "-o", at("tessellation"))
    run("merge-nodes", "-q", at("tessellation"), "-o", at("network"))
    drying = dried("vapour_step=0.2", "boundary_layer.thickness=1e-12", "boundary_layer.exchange=lumped")
    ok(drying["books"] < 1e-11 and drying["balance"] < 1e-12,
       "nor under air that takes a million times what comes from below", (drying["books"], drying["balance"]))

    make_network(150)
    compare("rings=films", "films.step=0")

    def model(*settings):
        run("dry", "-q", *sets("stop_saturation=0.99", *settings), at("wide"), "-o", at("drying"))
        with h5py.File(at("drying")) as file:
            return file.attrs["model"].decode()

    def is_kept(*settings):
        return "vapour found again when" in model(*settings)

    for edge, wide in (30, False), (31, True):  # edge + 1 nodes along x and y
        run("pack", "-q", *sets(f"counts=[{edge},{edge},1]"), "-o", at("packing"))
        run("tessellate", "-q", *sets("conductance=cylinder"), at("packing"), "-o", at("wide"))
        ok(is_kept() == wide, f"{(edge + 1)**2} nodes on the open face: by default kept from 1000 on")
    ok(not is_kept("vapour_tolerance=1e-6") and not is_kept("vapour_step=0"), "but not where an error is asked for")
    both = model("vapour_tolerance=1e-6", "vapour_step=0.2")
    ok("vapour found again when" in both and "errors add up to" not in both,
       "where both are, vapour is kept, and nothing smaller is promised", both)

done()
