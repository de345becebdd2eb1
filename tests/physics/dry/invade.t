#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# What invade says of a random network, counted anew: pressures, saturations, curve, clusters;
# gravity; what it refuses.
import os
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, read, refused, run, scratch_paths, sets

TENSION, DENSITY = 0.07274, 998.2


def labels(n, ends):
    """The lowest node that each of N nodes is joined with."""
    label = np.arange(n)
    while True:
        new = label.copy()
        np.minimum.at(new, ends[:, 0], label[ends[:, 1]])
        np.minimum.at(new, ends[:, 1], label[ends[:, 0]])
        if (new == label).all():
            return label
        label = new


def pressures(file, rule, gravity):
    ends, radius = file["throats/nodes"][:], file["throats/radius"][:]
    z = file["nodes/position"][:, 2] - file["domain/lower"][2]
    if rule == "nodes":
        widest = np.zeros(len(z))
        np.maximum.at(widest, ends.ravel(), np.repeat(radius, 2))
        radius = widest
    else:
        z = z[ends].mean(axis=1)
    return 2 * TENSION / radius - DENSITY * gravity * z


def check(name, file, rule, trapping, gravity, pores):
    ends, kind = file["throats/nodes"][:], file["nodes/kind"][:]
    volume = np.pi * file["throats/radius"][:] ** 2 * file["throats/length"][:]
    entered = file["events/throat" if rule == "throats" else "events/node"][:]
    pressure, saturation = file["events/pressure"][:], file["events/saturation"][:]
    ok(np.allclose(pressure, pressures(file, rule, gravity)[entered], rtol=1e-12),
       f"{name}: pressures are those of Young and Laplace, and weight")

    throat, node = file["throats/event"][:], file["nodes/event"][:]
    part = node[ends] if pores else throat[:, None]  # when each part of a throat loses its liquid
    share = volume[:, None] / part.shape[1]
    left = [(share * ((part < 0) | (part > k + 1))).sum() for k in range(len(entered))]
    ok(np.allclose(saturation, np.array(left) / volume.sum(), rtol=0, atol=1e-13),
       f"{name}: saturations are what {'pores' if pores else 'throats'} hold that are still full")
    if rule == "throats":
        ok((throat[entered] == np.arange(len(entered)) + 1).all()
           and (node[kind & 32 > 0] == 0).all(), f"{name}: throats are numbered by their events")
    else:
        either = np.where(node[ends] < 0, 10 ** 9, node[ends]).min(axis=1)
        ok((throat == np.where(either == 10 ** 9, -1, either)).all(),
           f"{name}: throats empty with the first of their nodes")

    record = np.maximum.accumulate(pressure)
    rises = np.flatnonzero(np.r_[True, np.diff(record) > 0])
    ok(np.array_equal(file["curve/pressure"], record[rises])
       and np.array_equal(file["curve/saturation"], saturation[np.r_[rises[1:] - 1, -1]]),
       f"{name}: the curve is the record pressures and what is left before the next")

    wet, full = node < 0, (part < 0).any(axis=1)  # full: holds liquid, perhaps in one half
    label = labels(len(kind), ends[full & wet[ends].all(axis=1)])
    own = np.where(wet[ends[:, 0]], label[ends[:, 0]], label[ends[:, 1]])
    own = np.where(wet[ends].any(axis=1), own, len(kind) + np.arange(len(ends)))
    cluster = file["throats/cluster"][:]
    pairs = {(a, b) for a, b in zip(own[full], cluster[full])}
    count = len(file["clusters/throats"])
    ok(((cluster >= 0) == full).all() and len(pairs) == count == len({a for a, _ in pairs}),
       f"{name}: clusters are those of liquid that touches", f"{len(pairs)} {count}")
    ok(np.array_equal(np.bincount(cluster[full], minlength=count), file["clusters/throats"])
       and np.allclose(np.bincount(cluster[full], (share * (part < 0)).sum(axis=1)[full], count), file["clusters/volume"],
                       atol=1e-12 * volume.sum()),
       f"{name}: with their throats and volumes")
    held = file["clusters/volume"][:]
    ok((held > 0).all() and abs(held.sum() / volume.sum() - saturation[-1]) < 1e-12,
       f"{name}: all of them hold liquid, and together what is left", (held.min(initial=1), held.sum() / volume.sum(), saturation[-1]))
    out = set(label[wet & (kind & 16 > 0)])
    reaches = {b: a not in out for a, b in pairs}
    ok(all(file["clusters/trapped"][b] == trapped for b, trapped in reaches.items()),
       f"{name}: trapped are those that no liquid leads out of")

    summary = file["summary"].attrs
    first = summary["breakthrough_event"]
    reached = file["events/node"][:]
    ok(kind[reached[first - 1]] & 16
       and not (kind[reached[:first - 1][reached[:first - 1] >= 0]] & 16).any(),
       f"{name}: breakthrough is when gas first touches the outlet")
    ok(summary["breakthrough_pressure"] == pressure[:first].max()
       and summary["breakthrough_saturation"] == saturation[first - 1]
       and summary["residual_saturation"] == saturation[-1], f"{name}: its pressure and saturation")
    joined = np.ones(len(volume), bool) if rule == "throats" else np.isin(np.arange(len(kind)), ends)
    easy = pressures(file, rule, gravity)[joined] <= pressure[:first].max() + 1e-12 * abs(pressure[:first].max())
    ok(abs(summary["breakthrough_share"] - easy.mean()) < 1.5 / len(easy),
       f"{name}: and the share of all that are as easy")
    if not trapping:
        ok((node[np.isin(np.arange(len(kind)), ends)] >= 0).all() and saturation[-1] == 0,
           f"{name}: nothing stays where nothing is trapped")


with scratch_paths() as at:
    run("pack", "--quiet", "--set", "method=random_sequential", "--set", "count=150", "--set",
        "upper=[4e-6,4e-6,5e-6]", "-o", at("packing.h5"))
    run("tessellate", at("packing.h5"), "-o", at("tessellation.h5"))
    run("merge-nodes", "--set", "measure=fraction", "--set", "threshold=0.05",
        at("tessellation.h5"), "-o", at("network.h5"))
    for rule in "throats", "nodes":
        for trapping in True, False:
            for gravity, pores in (0, False), (1e7, False), (0, True):
                run("invade", "--set", f"rule={rule}", "--set", f"liquid_in={'pores' if pores else 'throats'}", "--set", f"trapping={str(trapping).lower()}",
                    "--set", f"gravity={gravity}", "--set", f"surface_tension={TENSION}", "--set",
                    f"liquid_density={DENSITY}", at("network.h5"), "-o", at("invasion.h5"))
                with h5py.File(at("invasion.h5")) as file:
                    check(f"{rule}{' with pores' if pores else ''}, {'trapping' if trapping else 'none trapped'}, "
                          f"gravity {gravity:g}", file, rule, trapping, gravity, pores)

    # In a lattice as easy throats are equal but for rounding.
    run("pack", "--quiet", "--set", "method=fcc", "--set", "counts=[4,3,5]", "-o", at("fcc.h5"))
    run("tessellate", at("fcc.h5"), "-o", at("cells.h5"))
    run("merge-nodes", at("cells.h5"), "-o", at("lattice.h5"))
    run("invade", "--set", "trapping=false", at("lattice.h5"), "-o", at("invasion.h5"))
    with h5py.File(at("invasion.h5")) as file:
        radius, share = file["throats/radius"][:], file["summary"].attrs["breakthrough_share"]
        widest = radius[file["events/throat"][:file["summary"].attrs["breakthrough_event"]]].min()
        ok(share == (radius > widest * (1 - 1e-9)).mean(), "equal throats are as easy at breakthrough", share)

    # Gas from above is held back by weight, from below driven on.
    at_breakthrough = {}
    for inlet, outlet in ("+z", "-z"), ("-z", "+z"):
        for gravity in 0, 1e10: # against weight radii are nothing
            run("invade", "--set", f'inlet=["{inlet}"]', "--set", f'outlet=["{outlet}"]', "--set",
                f"gravity={gravity}", "--set", "until=breakthrough", "--set", "trapping=false", "--set",
                f"surface_tension={TENSION}", "--set", f"liquid_density={DENSITY}", at("network.h5"), "-o",
                at("invasion.h5"))
            with h5py.File(at("invasion.h5")) as file:
                s = file["summary"].attrs
                at_breakthrough[inlet, gravity] = s["breakthrough_saturation"]
                volume = file["throats/radius"][:] ** 2 * file["throats/length"][:]
                below = pressures(file, "throats", gravity) > s["breakthrough_pressure"]
                level = volume[below].sum() / volume.sum()
                ok(s["breakthrough_event"] == len(file["events/node"])
                   and s["residual_saturation"] == s["breakthrough_saturation"],
                   f"from {inlet}, gravity {gravity:g}: ends at breakthrough")
                if (inlet, gravity) == ("+z", 1e10):
                    ok(abs(s["breakthrough_saturation"] - level) < 1e-3,
                       "weight flattens the front of gas from above: full is what lies below it")
    ok(at_breakthrough["-z", 1e10] > 0.9, "and draws gas from below straight up", at_breakthrough)

    # The curves of both phases, whose numbers tests/physics/dry/transport.c has.
    run("invade", "--set", "transport=true", "--set", "trapping=false", at("network.h5"),
        "-o", at("invasion.h5"))
    with h5py.File(at("invasion.h5")) as file:
        level = file["transport/saturation"][:]
        gas, liquid = ([file[f"transport/{phase}_{what}"][:] for what in
                        ("permeability", "diffusivity")] for phase in ("gas", "liquid"))
        ok(np.allclose(level, np.linspace(1, 0, 11), atol=0.01) and (np.diff(level) < 0).all(),
           "both phases are measured at multiples of 0.1", level)
        ok(all(abs(g[-1] - 1) < 1e-9 and g[0] == 0 and abs(l[0] - 1) < 1e-9 and l[-1] == 0
               and (np.diff(g) > -1e-9).all() and (np.diff(l) < 1e-9).all()
               for g, l in zip(gas, liquid)), "as one gains the other loses, from all to nothing")
        box = file["domain/upper"][:] - file["domain/lower"][:]
        s = file["summary"].attrs
        ok(abs(s["permeability"] / s["hydraulic_conductance"] * box[0] * box[1] / box[2] - 1) < 1e-12,
           "permeability is conductance times length over section")

    run("invade", "--set", "fluid=other", "--set", "surface_tension=0.05", at("network.h5"), "-o", at("other.h5"))
    with h5py.File(at("other.h5")) as file:
        ok(np.isfinite(file["events/pressure"][:]).all(), "a liquid without weight needs no density")

    drawn = []
    for stage in "dry", "invade":
        run(stage, "--quiet", "--set", "throat_radius.distribution=lognormal", "--set",
            'imposed_empty=["-x"]', at("network.h5"), "-o", at("drawn.h5"))
        with h5py.File(at("drawn.h5")) as file:
            drawn.append([file["throats"][name][:] for name in ("radius", "kind")])
    ok(all(np.array_equal(*pair) for pair in zip(*drawn)) and drawn[0][1].max() == 2,
       "drawn radii, and throats imposed empty, are those of dry")

    # Where pores hold the liquid, those of the inlet hold gas before the first event.
    for settings in ('outlet=["+x"]', "until=breakthrough"), ("transport=true",):
        run("invade", *sets("liquid_in=pores", *settings), at("network.h5"), "-o", at("start.h5"))
        with h5py.File(at("start.h5")) as file:
            held = np.pi * file["throats/radius"][:] ** 2 * file["throats/length"][:]
            dry = (file["nodes/kind"][:] & 32 > 0)[file["throats/nodes"][:]].mean(axis=1)
            s, at_first = file["summary"].attrs, 1 - (dry * held).sum() / held.sum()
            said = ([s["breakthrough_saturation"], s["residual_saturation"], file["clusters/volume"][:].sum() / held.sum()]
                    if "transport" not in file else [file["transport/saturation"][0]])
            ok(at_first < 0.99 and np.allclose(said, at_first, rtol=0, atol=1e-13),
               f"{settings[0]}: the saturation begins without the pores of the inlet", (said, at_first))

    # Throats imposed empty hold no liquid, whatever holds it in the others.
    for liquid_in in "throats", "pores":
        run("invade", *sets(f"liquid_in={liquid_in}", 'imposed_empty=["-x"]'), at("network.h5"), "-o", at("imposed.h5"))
        with h5py.File(at("imposed.h5")) as file:
            open_ = file["throats/kind"][:] == 0
            held = np.pi * file["throats/radius"][:] ** 2 * file["throats/length"][:]
            left = file["summary"].attrs["residual_saturation"] * held[open_].sum()
            ok((file["throats/cluster"][:][~open_] == -1).all() and left > 0
               and abs(file["clusters/volume"][:].sum() / left - 1) < 1e-12,
               f"clusters in {liquid_in} hold what is left, and no throat imposed empty is in one")

    # Only a network that ends on the sides of the box has numbers of the box.
    for layer, boundary, whole in ("false", "truncate", True), ("false", "eliminate", False), ("true", "truncate", False):
        run("pack", "--quiet", *sets("method=deposition", "count=150", f"extra_layer={layer}"), "-o", at("bed.h5"))
        run("tessellate", *sets(f"boundary={boundary}"), at("bed.h5"), "-o", at("cells.h5"))
        run("merge-nodes", at("cells.h5"), "-o", at("bed-network.h5"))
        run("invade", *sets("transport=true"), at("bed-network.h5"), "-o", at("invasion.h5"))
        with h5py.File(at("invasion.h5")) as file:
            given = [name in file["summary"].attrs for name in ("permeability", "diffusivity", "diffusive_conductance")]
            ok(given == [whole, whole, True],
               f"permeability and diffusivity of a body, extra layer {layer}, boundary {boundary}: {whole}", given)

    network = read(at("network.h5"))
    ok(run("invade", input=network) == run("invade", "--threads", "2", at("network.h5")),
       "the same bytes through a pipe and by two threads")

    def invade_refuses(title, says, *settings):
        refused(title, says, "invade", *sets(*settings), at("network.h5"), "-o", at("none.h5"))

    invade_refuses("no inlet is refused", "invade.inlet: must name a wall", "inlet=[]")
    invade_refuses("a wall for both is refused", "invade.outlet: must have no wall in common",
                   'outlet=["+z","-z"]')
    invade_refuses("trapping without an outlet is refused", "no throat reaches the outlet", "outlet=[]")
    run("pack", *sets("method=poisson", "count=60", "upper=[3e-6,3e-6,3e-6]", "periodic=[true,false,false]"), "-o", at("repeats.h5"))
    run("tessellate", at("repeats.h5"), "-o", at("around.h5"))
    os.replace(at("network.h5"), at("kept.h5"))
    os.replace(at("around.h5"), at("network.h5"))
    invade_refuses("an inlet where the box repeats is refused", "invade.inlet: must not name -x", 'inlet=["+z","-x"]')
    invade_refuses("an outlet there too", "invade.outlet: must not name +x", 'outlet=["-z","+x"]')
    for stage in "invade", "dry":
        said = subprocess.run([f"{BIN}/{stage}", *sets('imposed_empty=["-x","-z","+x"]'), at("network.h5"), "-o", at("some.h5")],
                              capture_output=True, text=True, check=True).stderr
        ok(f"{stage}.imposed_empty: leaves out -x +x, where the box of" in said, f"{stage} says which sides imposed empty it leaves out", said)
    os.replace(at("kept.h5"), at("network.h5"))
    # 100 +- 60 nm: Simpson's rule in tests/physics/network/throat_radius.c has what is left.
    words = sum((["--set", "throat_radius." + word] for word in
                 ("distribution=normal", "mean=100e-9", "standard_deviation=60e-9")), [])
    for stage in "invade", "dry":
        says = subprocess.run([f"{BIN}/{stage}", *words, at("network.h5"), "-o", at("cut.h5")],
                              capture_output=True, text=True).stderr
        told = "4.78 % of the normal ones of 1e-07 +- 6e-08 m would not be above 0 and are drawn " \
               "again, which leaves 1.063e-07 +- 5.417e-08 m"
        with h5py.File(at("cut.h5")) as file:
            model = file.attrs["model"].decode()
        ok(told in says and told in model, f"{stage} says what cutting radii at 0 leaves", says)
    with h5py.File(at("network.h5"), "a") as file:
        file["throats/radius"][:] = 0
    invade_refuses("a network with all throats closed is refused", "/throats/kind: no throat holds liquid")
done()
