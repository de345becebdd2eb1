#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Rings that throats leave in `dry`: their books against the datasets added up here, their volumes
# against `rings`, and drying without any against drying that has no rings.
import filecmp
import json
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from ring_books import stores
from tap import BIN, WATER, done, ok, refused, run, scratch_paths, sets

R = 1e-6
at = scratch_paths()


def network(packing, name="network"):
    run("tessellate", "-q", *sets("throat_volume=void", "throat_radius=entry"), packing, "-o", at("diagram"))
    run("merge-nodes", "-q", at("diagram"), "-o", at(name))
    return at(name)


def dry(path, *settings, name="drying"):
    run("dry", "-q", *sets("step_interval=0", *settings), path, "-o", at(name))
    return h5py.File(at(name))


def lattice(radius):
    grid = np.stack(np.meshgrid(*[np.arange(4)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    np.savetxt(at("lattice.txt"), np.column_stack([(2 * grid + 1) * R, np.full(64, radius)]), fmt="%.17g")
    run("pack", "-q", *sets("method=import", "lower=[0,0,0]", f"upper={[8 * R] * 3}", "bonds=none", "check=none",
                            "periodic=[true,true,false]"), at("lattice.txt"), "-o", at("lattice"))
    return at("lattice")


def books(file):
    """Largest difference between /history and its throats and rings, and between the part in rings and its sum."""
    volume, left, throats, nodes, kept = stores(file)
    total = (throats * (volume - left) + kept).sum(axis=1) / volume.sum()
    alone = np.where(throats == 0, kept, 0).sum(axis=1) / volume.sum()
    return (abs(total - file["history/saturation"][:]).max(), abs(alone - file["history/ring_saturation"][:]).max(),
            throats, nodes)


def slices_differ(file):
    """Largest difference of the liquid in slices, in throats and rings, from /profiles; the box is open at the top."""
    volume, left, throats, _, kept = stores(file)
    step = np.searchsorted(file["history/time"][:], file["profiles/time"][:])
    held = np.where(throats > 0, throats * (volume - left) + left, kept)[step]
    lower, upper = file["domain/lower"][2], file["domain/upper"][2]
    middle = file["nodes/position"][:, 2][file["throats/nodes"][:]].mean(axis=1)
    place = np.clip(20 * (upper - middle) / (upper - lower), 0, 19).astype(int)
    full = np.bincount(place, volume, 20)
    own = np.array([np.bincount(place, row, 20) for row in held]) / np.where(full > 0, full, 1)
    return abs(own - file["profiles/slice_saturation"][:]).max()


# ---- the books of random packings ---------------------------------------------------------

run("pack", "-q", *sets("method=soft_spheres", "count=100", f"radius={R}", "sizes.distribution=normal",
                        "sizes.spread=0.2", "periodic=[true,true,false]", "bonds=none"), "-o", at("packing"))
net = network(at("packing"))
for settings in ([], ["liquid=immobile"], ["contact_angle=50"], ["gravity=9.81"],
                 ["stop_saturation=0.3"], ["start_saturation=0.6"], ["air_vapour_pressure=2338.99"]):
    with dry(net, "rings=isolated", *WATER, *settings) as file:
        total, alone, throats, nodes = books(file)
        summary = dict(file["summary"].attrs)
        ok(total < 1e-12 and alone < 1e-12 and summary["balance_error"] < 1e-12 and summary["residual"] < 1e-12,
           f"{settings or 'inviscid'}: throats, rings and vapour add up at all steps", (total, alone, summary))
        ok(slices_differ(file) < 1e-12, f"{settings or 'inviscid'}: slices count throats and rings", slices_differ(file))
        ends = file["throats/nodes"][:]
        wet = (nodes < 1)[:, ends].any(axis=2) & (throats > 0)
        ok(not wet.any(), "no rings dry beside a throat that holds liquid", wet.sum())
        if not settings:
            inviscid = file["history/saturation"][:], file["history/time"][:], summary["residual_saturation"]
        if settings == ["air_vapour_pressure=2338.99"]:
            ok(np.allclose(file["history/saturation"][:], inviscid[0], rtol=0, atol=1e-9) and
               np.allclose(file["history/time"][:] / file["history/time"][-1],
                           inviscid[1] / inviscid[1][-1], rtol=1e-6),
               "vapour near saturation dries it in the same way, only slower", file["history/time"][-1] / inviscid[1][-1])
with dry(net, "rings=joined", *WATER) as file:
    total, alone, throats, nodes = books(file)
    summary, void = dict(file["summary"].attrs), file["throats/volume"][:].sum()
    fed = throats.any(axis=1)
    ok(total < 1e-12 and alone < 1e-12 and summary["balance_error"] < 1e-12 and summary["residual"] < 1e-12,
       "joined by films: throats, rings and vapour add up at all steps", (total, alone, summary))
    ok((nodes[fed] == 1).all() and abs(summary["residual_saturation"] * void / summary["ring_volume"] - 1) < 1e-12,
       "films feed all rings until the last throat has emptied", summary)
    then = np.searchsorted(-file["history/saturation"][:], -file["profiles/saturation"][:])
    there = file["history/clusters"][:][then], file["profiles/clusters"][:].sum(axis=1)
    ok(np.array_equal(*there), "profiles count what films join as one cluster, as the history does", there)
    order = file["events/throat"][:]
    run("invade", "-q", *sets("trapping=false"), net, "-o", at("invasion"))
    with h5py.File(at("invasion")) as invasion:
        ok(np.array_equal(order, invasion["events/throat"][:]), "in the order of invasion without trapping")
ok(0 < inviscid[2] < 0.2, "some is left when the last throat has emptied", inviscid[2])
run("dry", "-q", "--threads", "2", *sets("step_interval=0", "rings=isolated", *WATER), net, "-o", at("two"))
dry(net, "rings=isolated", *WATER).close()
ok(filecmp.cmp(at("drying"), at("two"), shallow=False), "one thread and two give the same bytes")

# ---- the rings ----------------------------------------------------------------------------

for radius, angle, what in (R, 0, "touch"), (1.02 * R, 30, "overlap"), (0.98 * R, 0, "are apart"), (R, 80, "touch, at 80 degrees"):
    packing = lattice(radius)
    with dry(network(packing), "rings=isolated", f"contact_angle={angle}", *WATER) as file:
        suction = 2 * 0.07274 * np.cos(np.radians(angle)) / file["throats/radius"][:].min()
        exact = json.loads(run("rings", "-q", *sets("fluid=other", "surface_tension=0.07274", f"contact_angle={angle}",
                                                    f"suctions=[{float(suction)!r}]"), packing))
        got = file["summary"].attrs["ring_volume"]
        ok(len(file["rings/face"]) == exact["rings"][0] and abs(got / exact["volume"][0] - 1) < 1e-9,
           f"grains that {what}: throats leave the rings of `rings`", (got, exact["volume"]))

with dry(network(lattice(R)), "rings=joined", *WATER) as file:
    rate, time = file["history/rate"][:], file["history/time"][:]
    fed = file["history/clusters"][:] > 0
    first = time[np.flatnonzero(~fed)[0]]
    lost = file["summary"].attrs["liquid_mass"] * (1 - file["summary"].attrs["residual_saturation"])
    ok(np.allclose(rate[fed], rate[0], rtol=1e-12, atol=0) and abs(first * rate[0] / lost - 1) < 1e-12,
       "rings at all nodes keep the first rate until the last throat has emptied", (rate.min(), first * rate[0] / lost))

# ---- in two parts -------------------------------------------------------------------------

net = network(at("packing"))
for settings in (["rings=isolated", "liquid=immobile"], ["rings=isolated"], ["rings=joined"], ["rings=films"]):
    with dry(net, *settings, name="whole") as whole:
        level = 1.5 * whole["history/ring_saturation"][:].max()
        before, left = whole["history/time"][:], whole["history/saturation"][:]
    cut = np.interp(-level, -left, before)
    with dry(at("whole"), *settings, f"start_saturation={level}") as late:
        time, saturation = late["history/time"][:], late["history/saturation"][:]
        dried = late["ring_changes/offset"][1]
        moments = np.linspace(cut, before[-1], 200)
        wrong = abs(np.interp(moments, before, left) - np.interp(moments - cut, time, saturation)).max()
        ok(abs(saturation[0] / level - 1) < 1e-12 and wrong < 1e-9 and abs((cut + time[-1]) / before[-1] - 1) < 1e-9
           and (dried > 0 or "rings=isolated" not in settings) and max(books(late)[:2]) < 1e-12,
           f"{settings}: what rings have lost stays lost where the drying goes on",
           (saturation[0] / level - 1, wrong, dried, books(late)[:2]))

# ---- none ---------------------------------------------------------------------------------

bare = network(lattice(0.8 * R))
for liquid in "inviscid", "immobile":
    with dry(bare, f"liquid={liquid}", name="without") as without, dry(bare, f"liquid={liquid}", "rings=isolated") as kept:
        same = [np.array_equal(without[name][:], kept[name][:]) for group in ("history", "events", "changes") for name in
                (f"{group}/{key}" for key in without[group])]
        ok(len(kept["rings/face"]) == 0 and all(same), f"{liquid}: across gaps beyond rupture drying is to the bit as without", same)

# ---- refusals -----------------------------------------------------------------------------

for settings, line in [(["liquid=viscous"], "rings: must be none where liquid is viscous"),
                       (["rings=joined", "liquid=immobile"], "rings: must not be joined where liquid is immobile"),
                       (["kelvin=true"], "rings: must be none where liquid is viscous or menisci are curved")]:
    refused(f"{settings} is refused", line, "dry", "-q", *sets("rings=isolated", *settings), net)

# What rings hold cannot go along with grains that move; without rings the same grains do.
run("dem-replay", "-q", *sets("engine=explicit", "bond.by=distance", "shrinkage.strain=1e-9", "shrinkage.steps=1",
                              "cycles=1", "most_cycles=1", "support=free"), at("packing"), "-o", at("moved"))
net = network(at("packing"))
for rings, status in ("isolated", 65), ("none", 0):
    dry(net, f"rings={rings}", "stop_saturation=0.3", name="half").close()
    tried = subprocess.run([f"{BIN}/deform", "-s", "on_change=keep", at("half"), at("moved"), "-o", at("after")],
                           capture_output=True, text=True, check=False)
    ok(tried.returncode == status and ("/rings: the liquid in rings cannot go along" in tried.stderr) == (status == 65),
       f"deform, rings={rings}: status {status}", tried.stderr)
done()
