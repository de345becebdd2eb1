#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Films of finite resistance in `dry`: their books, their two limits (rings that nothing joins, films without
# resistance), what sizes and rates do to their reach, and what is refused.
import filecmp
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from ring_books import stores
from tap import WATER, done, ok, refused, run, scratch_paths, sets

R = 1e-6
at = scratch_paths()


def network(name, radius):
    run("pack", "-q", *sets("method=soft_spheres", "count=60", f"radius={radius}", "sizes.distribution=normal",
                            "sizes.spread=0.2", "periodic=[true,true,false]", "bonds=none"), "-o", at("packing"))
    run("tessellate", "-q", *sets("throat_volume=void", "throat_radius=entry"), at("packing"), "-o", at("diagram"))
    run("merge-nodes", "-q", at("diagram"), "-o", at(name))
    return at(name)


def dry(path, *settings, name="drying", options=()):
    run("dry", "-q", *options, *sets("step_interval=0", *WATER, *settings), path, "-o", at(name))
    return h5py.File(at(name))


def books(file):
    """Largest difference between /history/saturation and its throats and rings, or its rates."""
    volume, left, throats, nodes, kept = stores(file)
    total = (throats * (volume - left) + kept).sum(axis=1) / volume.sum()
    saturation, time, rate = (file[f"history/{name}"][:] for name in ("saturation", "time", "rate"))
    lost = np.append(0, np.cumsum(rate[:-1] * np.diff(time))) * saturation[0] / file["summary"].attrs["liquid_mass"]
    return max(abs(total - saturation).max(), abs(saturation[0] - lost - saturation).max()), throats, nodes


def differences(one, other):
    """Names of what is not the same, to the bit, in two histories."""
    names = [f"{group}/{key}" for group in ("history", "events", "changes", "ring_changes") for key in other[group]
             if not key.startswith("film")]
    return [name for name in names if name not in one or not np.array_equal(one[name][:], other[name][:])]


def rate_at(file, levels):
    saturation, rate = file["history/saturation"][:], file["history/normalised_rate"][:]
    return np.array([rate[np.flatnonzero(saturation <= level)[0]] for level in levels])


HEAVY = ["gravity=4e7"]  # the height of the body weighs as much as the suction in its throats
LEVELS = [0.9, 0.7, 0.5, 0.3, 0.1]
net = network("network", R)

# ---- books --------------------------------------------------------------------------------

rates = {}
for settings in ([], ["films.conductance=0.03"], ["films.conductance=0.03", "films.step=0.01"], ["contact_angle=40"],
                 ["films.corners=4", "films.half_angle=45"], ["stop_saturation=0.4"], ["start_saturation=0.6"],
                 ["films.conductance=0.03", "vapour_tolerance=1e-6"], HEAVY, [*HEAVY, "films.conductance=0.03"]):
    with dry(net, "rings=films", *settings) as file:
        error, throats, nodes = books(file)
        summary = dict(file["summary"].attrs)
        ok(error < 1e-12 and summary["balance_error"] < 1e-12 and summary["residual"] < 1e-12,
           f"{settings or 'films'}: throats, rings and vapour add up at all steps", (error, summary))
        ends = file["throats/nodes"][:]
        ok(not ((nodes < 1)[:, ends].any(axis=2) & (throats > 0)).any(), "no rings dry beside a throat that holds liquid")
        history = {name: file[f"history/{name}"][:] for name in ("rate", "film_evaporation", "film_depth", "film_deepest")}
        ok((history["film_evaporation"] <= history["rate"] * (1 + 1e-12)).all() and
           (history["film_depth"] <= history["film_deepest"] * (1 + 1e-12)).all() and history["film_deepest"].max() > 0,
           "films bring no more than evaporates", {name: max(array) for name, array in history.items()})
        rates[tuple(settings)] = rate_at(file, [0.2, 0.15, 0.1]) if not settings or "=0.03" in settings[0] else None
one, default = rates[("films.conductance=0.03",)], rates[()]
ok((default > 1.2 * one).all(), "films that conduct more keep the rate up", (default, one))

# ---- limits -------------------------------------------------------------------------------

isolated = dry(net, "rings=isolated", name="isolated")
for settings in ["films.conductance=0"], ["films.half_angle=60", "contact_angle=30.1"]:
    other = isolated if len(settings) == 1 else dry(net, "rings=isolated", settings[1], name="at_angle")
    with dry(net, "rings=films", *settings) as file:
        ok(not differences(file, other) and not file["history/film_deepest"][:].any(),
           f"{settings}: without films the drying of isolated rings, to the bit", differences(file, other))
with dry(net, "rings=films", "films.conductance=1e-12") as file:
    ok(np.array_equal(file["events/throat"][:], isolated["events/throat"][:]) and
       np.allclose(file["events/time"][:], isolated["events/time"][:], rtol=1e-5, atol=0),
       "films that conduct next to nothing: nearly so", abs(file["events/time"][:] / isolated["events/time"][:] - 1).max())
# With 1e12 all levels are equal in the digits of one number. Under gravity liquid is at rest in such films.
order = {}
for heavy, factors in ([], ["1e5", "1e12"]), (HEAVY, ["1e5", "1e8"]):
    joined = dry(net, "rings=joined", *heavy, name="joined")
    order[bool(heavy)] = joined["events/throat"][:]
    for factor in factors:
        with dry(net, "rings=films", *heavy, f"films.conductance={factor}") as file:
            ok(np.allclose(rate_at(file, LEVELS), rate_at(joined, LEVELS), rtol=1e-6, atol=0) and
               abs(file["summary"].attrs["residual_saturation"] / joined["summary"].attrs["residual_saturation"] - 1) < 1e-6 and
               abs(file["history/time"][-1] / joined["history/time"][-1] - 1) < 1e-6,
               f"films that conduct well, {factor} {heavy}: the rates of films without resistance",
               (rate_at(file, LEVELS), rate_at(joined, LEVELS)))

# Between two solutions the cluster nearest to its least supplies: without resistance, that of the widest throat anywhere.
# Parts that no film joins at the last solution may come too early or too late.
for heavy in [], HEAVY:
    with dry(net, "rings=films", *heavy, "films.conductance=1e5", "films.step=0.5") as file:
        same = (file["events/throat"][:] == order[bool(heavy)]).mean()
        ok(same > 0.97 and file["summary"].attrs["film_solutions"] < 20,
           f"films that conduct well, flows found a few times {heavy}: throats empty in the same order",
           (same, file["summary"].attrs["film_solutions"]))

# Where films conduct little, clusters that lose a throat go on losing liquid, and do not live on what others lose.
def time_at(file):
    saturation, time = file["history/saturation"][:], file["history/time"][:]
    return np.interp(-np.arange(0.999, 0, -0.001), -saturation, time) / time[-1], time[-1]


def apart(conductance, step):
    """How far times are from those with the flow at each event, over the drying time, and how often it was found."""
    films = ["rings=films", f"films.conductance={conductance}"]
    with dry(net, *films, "films.step=0") as file:
        exact, end = time_at(file)
    with dry(net, *films, f"films.step={step}") as file:
        times, last = time_at(file)
        return abs(times * last / end - exact).max(), file["summary"].attrs["film_solutions"]


for step in 0.01, 0.02:
    error, solutions = apart(0.01, step)
    ok(error < step and solutions < 200,
       f"films that dry out, films.step={step}: times are right to that part of the drying time", (error, solutions))

# Between two solutions films bring no more than their capacity. Without it long steps dry bodies too fast, here by 0.016
# and 0.025 of the drying time.
for conductance, step, most in (0.003, 0.05, 0.01), (0.1, 0.1, 0.015):
    error, solutions = apart(conductance, step)
    ok(error < most, f"films.conductance={conductance}, films.step={step}: films bring what they can", error)

# Where they conduct well it does not matter which cluster supplies, and flows are found once a step.
error, solutions = apart(10, 0.02)
ok(error < 0.005 and solutions < 1.2 / 0.02,
   "films that conduct well: flows are found once a step, and times are right", (error, solutions))

# ---- similar ------------------------------------------------------------------------------

# Q = n C gamma / (3 beta nu) r^3 / L: with all lengths times 8 a body dries alike if nu / gamma is 8 times as large, as
# r^3 / L grows by 64 and the rate by 8. The factor, gamma and 1 / nu are one number. Grains of powers of two: to the bit.
reference = dry(net, "rings=films", "films.conductance=0.03", name="reference")
for heavy, what, path, settings in (
        ([], "all lengths times 8 and the viscosity too", network("larger", 8 * R),
         ["films.conductance=0.03", "viscosity=8.0272e-6", "boundary_layer.thickness=4e-5"]),
        ([], "an eighth of the conductance, and of the viscosity", net, ["films.conductance=0.00375", "viscosity=1.25425e-7"]),
        (HEAVY, "all lengths times 8 and a 64th of gravity", at("larger"),
         ["films.conductance=0.03", "viscosity=8.0272e-6", "boundary_layer.thickness=4e-5", "gravity=6.25e5"])):
    with dry(net, "rings=films", "films.conductance=0.03", "viscosity=1.0034e-6", *heavy, name="base") as base, \
         dry(path, "rings=films", *settings) as file:
        time = file["history/time"][:] / file["history/time"][-1]
        ok(np.array_equal(file["events/throat"][:], base["events/throat"][:]) and
           np.allclose(time, base["history/time"][:] / base["history/time"][-1], rtol=1e-9, atol=0),
           f"{what}: dries alike", len(time))

# ---- films of thousands of sites, most of whose sources come and go ---------------------------

for seed in 5, 6:
    run("pack", "-q", *sets("method=soft_spheres", "radius=250e-9", "sizes.distribution=normal", "sizes.spread=0.2",
                            "sizes.smallest=125e-9", "sizes.largest=375e-9", "upper=[5e-6,5e-6,5e-6]", "target=porosity",
                            "target_value=0.38", f"seed={seed}"), "-o", at("packing"))
    run("tessellate", "-q", *sets("throat_volume=void"), at("packing"), "-o", at("diagram"))
    run("merge-nodes", "-q", *sets("measure=fraction", "threshold=0.06"), at("diagram"), "-o", at("larger"))
    with dry(at("larger"), "rings=films", "step_interval=0.01", name="dried") as file:
        error = books(file)[0]
        ok(error < 1e-12 and file["history/saturation"][-1] == 0,
           f"draw {seed}: 11,000 throats with films dry, and add up", (error, len(file["throats/radius"])))

# ---- threads, refusals ----------------------------------------------------------------------

dry(net, "rings=films", "films.conductance=0.03", name="two", options=["--threads", "2"]).close()
ok(filecmp.cmp(at("reference"), at("two"), shallow=False), "one thread and two give the same bytes")
for settings, line in [(["liquid=viscous"], "rings: must be none where liquid is viscous"),
                       (["liquid=immobile"], "rings: must not be films where liquid is immobile"),
                       (["kelvin=true"], "rings: must be none where liquid is viscous or menisci are curved"),
                       (["films.half_angle=90"], "films.half_angle"), (["films.conductance=-1"], "films.conductance")]:
    refused(f"{settings} is refused", line, "dry", "-q", *sets("rings=films", *settings), net)
done()
