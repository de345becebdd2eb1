#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Capillary forces in irregular networks: against patches integrated point by point,
# closed forms, balance, and drying histories made by hand.
import json
import os
import shutil
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, run, scratch, sets

R = 2.5e-7
SIDES = 'imposed_empty=["-x","+x","-y","+y","-z"]'
random = np.random.default_rng(11)


def drying(name, centres, radii, box, how, dry, merge=0.0, periodic=(0, 0, 0), lower=np.zeros(3)):
    """From grains to their drying."""
    np.savetxt("grains", np.column_stack([centres, radii]), fmt="%.17g")
    sides = "[" + ",".join(["false", "true"][p] for p in periodic) + "]"
    run("pack", *sets("method=import", f"lower={[float(x) for x in lower]}",
                      f"upper={[float(x) for x in lower + np.array(box)]}",
                      f"periodic={sides}"), "--quiet", "grains", "-o", "p")
    run("tessellate", *sets(*how), "p", "-o", "t")
    how = ["measure=fraction", f"threshold={merge}"] if merge else []
    run("merge-nodes", *sets(*how), "t", "-o", "n")
    run("dry", *sets("surface_tension=0.07274", *dry), "--quiet", "n", "-o", name)


def forces(name, *how, steps=40):
    run("force-protocol", "--quiet", *sets(f"steps={steps}", *how), name, "-o", "f")
    with h5py.File("f") as file:
        return file["force"][:], file["time"][:], dict(file["summary"].attrs)


def scatter(n, box, layer=False, spread=0.2):
    """Grains anywhere, no nearer to each other and to the walls than touching."""
    radii = R * (1 + spread * (random.random(n) - 0.5))
    centres = np.empty((0, 3))
    while len(centres) < n:
        radius = radii[len(centres)]
        new = radius + (np.array(box) - 2 * radius) * random.random(3)
        if layer:
            new[1] = box[1] / 2
        apart = np.linalg.norm(centres - new, axis=1)
        if (apart > radii[:len(centres)] + radius).all():
            centres = np.vstack([centres, new])
    return centres, radii


# ---- patches, point by point ----------------------------------------------------------

def triangle_points(level):
    """Middles of 4^level equal triangles, barycentric."""
    points = [np.eye(3)]
    for _ in range(level):
        points = [np.array(t) for p in points for t in (
            (p[0], p[0] + p[1], p[0] + p[2]), (p[1], p[0] + p[1], p[1] + p[2]),
            (p[2], p[0] + p[2], p[1] + p[2]), (p[0] + p[1], p[1] + p[2], p[0] + p[2]))]
        points = [p / p.sum(1, keepdims=True) for p in points]
    return np.array([p.mean(0) for p in points])


POINTS = {level: triangle_points(level) for level in (3, 4)}


def projected(corner):
    """Integral of the unit normal over a triangle's projection on the unit sphere around
    the origin: x/|x| (x.N)/|x|^3 over the triangle with its corners on the sphere, by two
    rules and Richardson."""
    corner = corner / np.linalg.norm(corner, axis=1)[:, None]
    area = np.cross(corner[1] - corner[0], corner[2] - corner[0]) / 2
    sums = []
    for level in (3, 4):
        x = POINTS[level] @ corner
        r = np.linalg.norm(x, axis=1)
        sums.append((x * ((x @ area) / r**4)[:, None]).mean(0))
    return sums[1] + (sums[1] - sums[0]) / 3


def grains_around(centre, radius, x, count):
    return np.argsort(((centre - x)**2).sum(1) - radius**2)[:count]


def foot(centre, radius, i, j):
    apart = centre[j] - centre[i]
    return centre[i] + (0.5 + (radius[i]**2 - radius[j]**2) / (2 * apart @ apart)) * apart


def point_by_point(file, layer):
    """Forces over p_c while all is wet, on all grains, by who is around each throat."""
    centre, radius = file["particles/position"][:], file["particles/radius"][:]
    node, total = file["nodes/position"][:], np.zeros((len(radius), 3))
    for ends, kind in zip(file["throats/nodes"][:], file["throats/kind"][:]):
        if kind != 0:
            continue
        ends = node[ends]
        if layer:
            centre[:, 1] = ends[0, 1]
        around = grains_around(centre, radius, ends.mean(0), 2 if layer else 3)
        for i in around:
            if layer:
                angle = [np.arctan2(*(end - centre[i])[[2, 0]]) for end in ends]
                turn = (angle[1] - angle[0] + np.pi) % (2 * np.pi) - np.pi
                a = angle[0] + turn * (np.arange(2000) + 0.5) / 2000
                n = np.array([np.cos(a), 0 * a, np.sin(a)]).mean(1) * abs(turn)
                total[i] += np.pi / 2 * radius[i]**2 * n
                continue
            for j in around[around != i]:
                k = around[(around != i) & (around != j)][0]
                corner = np.array([foot(centre, radius, i, j), *ends]) - centre[i]
                # the face ends at the throat, beyond which the third grain is nearer
                along = ends[1] - ends[0]
                beyond = centre[k] - corner[0] - centre[i]
                beyond -= beyond @ along / (along @ along) * along
                turned = np.cross(corner[1] - corner[0], corner[2] - corner[0]) @ (
                    centre[j] - centre[i]) < 0
                negative = (corner[0] - corner[1]) @ beyond > 0
                total[i] += radius[i]**2 * projected(corner) * (-1 if turned != negative else 1)
    return total


def full_networks():
    for label, n, box, how in [
            ("cells left out", 90, (3.1e-6, 3.1e-6, 3.6e-6), ["boundary=eliminate"]),
            ("cells left out of a layer", 80, (6e-6, 5e-7, 6e-6),
             ["boundary=eliminate", "dimensions=2"])]:
        layer = len(how) > 1
        centres, radii = scatter(n, box, layer)
        drying("d", centres, radii, box, how, ["liquid=immobile"])
        force, _, summary = forces("d", "balanced=false")
        unit = summary["capillary_pressure"] * radii[:, None]**2
        with h5py.File("d") as file:
            sides = file["faces/particles"][:]
            closed = np.unique(sides[:, 0]) if layer else np.array(
                [g for g in range(n) if cell_is_closed(file, g)])
            wanted = point_by_point(file, layer) * summary["capillary_pressure"]
        inner = abs(force[0] / unit)[closed].max()
        ok(len(closed) > 5 and inner < 1e-14,
           f"{label}: no force on the {len(closed)} grains with cells while all is wet", inner)
        error = abs((force[0] - wanted) / unit).max()
        ok(error < 1e-5 and abs(force[0] / unit).max() > 1,
           f"{label}: forces on the others as integrated point by point", error)
        force, _, _ = forces("d")
        inner = abs(force[0] / unit)[closed].max()
        ok(inner < 1e-13, f"{label}: balanced, those with cells still feel none", inner)


def cell_is_closed(file, grain):
    """Every throat of the cell is in two of its faces."""
    offset, nodes = file["faces/offset"][:], file["faces/nodes"][:]
    count = {}
    for f in np.flatnonzero((file["faces/particles"][:] == grain).any(1)):
        loop = nodes[offset[f]:offset[f + 1]]
        for pair in zip(loop, np.roll(loop, -1)):
            count[frozenset(pair)] = count.get(frozenset(pair), 0) + 1
    return bool(count) and set(count.values()) == {2}


# ---- balance ----------------------------------------------------------------------------

def imbalance(force, centres, middle):
    """Net force and moment at each time, of the magnitudes' sums then."""
    arm = centres - middle
    size = np.linalg.norm(force, axis=2)
    loaded = size.sum(1) > 1e-9 * size.sum(1).max()
    net = np.linalg.norm(force.sum(1), axis=1) / np.where(loaded, size.sum(1), 1)
    moment = np.linalg.norm(np.cross(arm, force).sum(1), axis=1) / np.where(
        loaded, (size * np.linalg.norm(arm, axis=1)).sum(1), 1)
    return net[loaded].max(), moment[loaded].max()


def balance():
    faces = ["form=faces", "balanced=false"]
    liquid = ["contact_angle=40", "pressure=clusters"]
    every = [*faces, *liquid, "rings.left=suction"]
    nearest = ["form=solid-angle", *liquid]
    for label, n, box, how, dry, merge, forms in [
            ("cells left out", 90, (3.1e-6, 3.1e-6, 3.6e-6), ["boundary=eliminate"], [], 0,
             [faces, every, nearest]),
            ("a box, empty sides", 60, (2.6e-6, 2.6e-6, 3e-6), [], [SIDES], 0,
             [faces, every, nearest]),
            ("merged", 60, (2.6e-6, 2.6e-6, 3e-6), [], [SIDES], 0.1,
             [[*nearest, "rings.left=suction"], ["form=faces"], ["form=centres"]]),
            ("a layer, empty sides", 60, (5e-6, 5e-7, 5e-6), ["dimensions=2"],
             ['imposed_empty=["-x","+x","-z"]'], 0, [faces, every, nearest, ["form=arcs"]])]:
        layer = "dimensions=2" in how
        centres, radii = scatter(n, box, layer)
        for limit in "inviscid", "immobile":
            drying("d", centres, radii, box, how, [f"liquid={limit}", *dry], merge)
            for also in forms:
                force, _, _ = forces("d", *also)
                net, moment = imbalance(force, centres, np.array(box) / 2)
                ok(net < 1e-10 and moment < 1e-10,
                   f"{label}, {limit}, {', '.join(also)}: forces and moments balance at "
                   "every step", (net, moment))


def unequal():
    """A grain of 100 among 200 of 1, all cells whole."""
    box = np.array((2.4e-5, 2.4e-5, 2.4e-5))
    radii = np.full(201, 1e-7)
    radii[0] = 1e-5
    centres = [box / 2]
    while len(centres) < len(radii):
        new = box * (0.02 + 0.96 * random.random(3))
        if np.linalg.norm(new - box / 2) > 1.02e-5 and min(
                np.linalg.norm(np.array(centres[1:]).reshape(-1, 3) - new, axis=1), default=1) > 2e-7:
            centres.append(new)
    drying("d", np.array(centres), radii, box, [], ["liquid=immobile"])
    with h5py.File("d") as file:
        sides = file["faces/particles"][:]
    inner = np.setdiff1d(np.arange(201), sides[sides[:, 1] < 0, 0])
    for form, reach in [("solid-angle", radii[0]), ("faces", radii[0]),
                        ("solid-angle balanced=false", radii)]:
        force, _, summary = forces("d", "open_surface=pulls", *f"form={form}".split())
        most = (np.linalg.norm(force[0], axis=1) / (
            summary["capillary_pressure"] * reach**2)).max()
        ok(np.isfinite(force).all() and most < 1e-14,
           f"1:100, {form}: no force on any of {len(inner)} inner grains while all is wet", most)


# ---- pressures --------------------------------------------------------------------------

def gradient():
    """A suction linear in height on the cubic lattice, written into a drying by hand."""
    scene = "samples/stiff-5x5x10.json"
    scene = os.path.join(TOP, scene)
    run("pack", "-p", scene, "-o", "p")
    run("tessellate", "-p", scene, "p", "-o", "t")
    run("merge-nodes", "-p", scene, "t", "-o", "n")
    run("dry", "-p", scene, "--quiet", "n", "-o", "d")
    low, slope, a = 1e6, 1e11, 2 * R
    with h5py.File("d", "a") as file:
        suction = low + slope * file["nodes/position"][:, 2]
        end = file["history/time"][-1]
        file["snapshots/time"] = [0.0, end]
        file["snapshots/saturation"] = [1.0, 0.0]
        file["snapshots/throat_saturation"] = np.zeros((2, len(file["throats/length"])))
        file["snapshots/liquid_pressure"] = -np.array([suction, 2 * suction])
        centres = file["particles/position"][:]
    inner = ((centres > 1.5 * a) & (centres < centres.max(0) - a)).all(1)
    share = 2 * np.sqrt(2) * np.arccos(1 / np.sqrt(3)) / 4  # 8 throats, above and below
    for form, wanted in [("faces", slope * a**3), ("solid-angle", slope * a**3 * share)]:
        force, _, _ = forces("d", "pressure=field", f"form={form}")
        error = abs(force[0, inner] - [0, 0, wanted]).max() / wanted
        ok(inner.sum() > 8 and error < 1e-10, f"{form}: a gradient pulls inner grains in its "
           "closed form", error)
    same = [forces("d", f"balanced={b}")[0] for b in ("true", "false")]
    ok((same[0] == same[1]).all() and same[0].any(),
       "on a cubic lattice balance changes no bit")
    # pressures that do not change in space are those of uniform suction
    with h5py.File("d", "a") as file:
        level = forces("d")[2]["capillary_pressure"]
        file["snapshots/liquid_pressure"][...] = -level
    error = abs(forces("d", "pressure=field")[0] - forces("d")[0]).max()
    ok(error < 1e-12 * R**2 * level, "an even field is a uniform suction", error)


# ---- times ------------------------------------------------------------------------------

def interpolated(time, force, at):
    k = np.clip(np.searchsorted(time, at, side="right") - 1, 0, len(time) - 2)
    share = ((at - time[k]) / (time[k + 1] - time[k]))[:, None, None]
    return force[k] + share * (force[k + 1] - force[k])


def times():
    centres, radii = scatter(40, (2.3e-6, 2.3e-6, 2.6e-6))
    drying("d", centres, radii, (2.3e-6, 2.3e-6, 2.6e-6), [], ["liquid=inviscid"])
    truth, when, _ = forces("d", steps=8001)
    largest = np.linalg.norm(truth, axis=2).max()
    for bound in 0.2, 0.02:
        force, time, summary = forces("d", f"largest_change={bound}")
        change = np.linalg.norm(np.diff(force, axis=0), axis=2).max()
        own = np.linalg.norm(force, axis=2).max()
        most = max(largest, own)  # even times miss the very largest
        ok(change <= bound * most * (1 + 1e-6) and len(time) < 3000,
           f"largest_change = {bound}: kept, in {len(time)} times", change / most)
        ok(abs(summary["largest_change"] / (change / own) - 1) < 1e-6, "and said",
           (summary["largest_change"], change / own))
        found = np.linalg.norm(interpolated(time, force, when) - truth, axis=2).max() / largest
        said = summary["interpolation_error"]
        ok(0.9 * said < found < 1.001 * said and said <= bound * (1 + 1e-6),
           "no force is farther from the one interpolated than said", (found, said))
    force, time, summary = forces("d", steps=100)
    found = np.linalg.norm(interpolated(time, force, when) - truth, axis=2).max() / largest
    said = summary["interpolation_error"]
    ok(0.95 * said < found < 1.001 * said and said > 0.05,
       "uniform times: the error of interpolation as said", (found, said))

    grains = len(radii)
    for how in "steps=100", "largest_change=0.05":
        count = len(forces("d", how)[1])
        limits = [24 * grains * count, 24 * grains * count - 1]
        ends = [subprocess.run([f"{BIN}/force-protocol", "--set", how, "--set", f"most_bytes={limit}", "d", "-o", "sized"],
                               capture_output=True) for limit in limits]
        ok([end.returncode for end in ends] == [0, 65] and f"takes {count:.3g} times, which are {limits[0]:.3g} bytes" in ends[1].stderr.decode(),
           f"{how}: more than most_bytes is refused, and what it takes is said", ends[1].stderr)

    shutil.copy("d", "equal")
    with h5py.File("equal", "a") as file:
        old = file["history/time"][:]
        old[20:24] = old[20]
        old[-1] = old[-2]
        file["history/time"][...] = old
    for how in [[], ["largest_change=0.05"], ["pressure=clusters", "largest_change=0.05"]]:
        force, time, _ = forces("equal", *how)
        ok(np.isfinite(force).all() and (np.diff(time) > 0).all() and not force[-1].any()
           and np.isclose(time[-1], old[-1]),
           f"two equal times, {' '.join(how) or 'uniform'}: times rise, and forces end at 0")


# ---- rings ------------------------------------------------------------------------------

def rings():
    """Two grains that touch, in a box of their own."""
    for small in 1, 0.01:
        radii = np.array([R, small * R])
        box = np.array([4 * R, 4 * R, 6 * R])
        centres = np.array([box / 2, box / 2])
        centres[1, 2] += radii.sum()
        drying("d", centres, radii, box, [], ["liquid=immobile"])
        exact = json.loads(run("bridge", *sets(f"radius={radii[0]}", f"other_radius={radii[1]}", "separations=[0]",
                                               f"volume={1e-3 * (2 * radii.prod() / radii.sum())**3}",
                                               "contact_angle=20", "surface_tension=0.07274")))["force"][0]
        force, _, summary = forces("d", "rings.left=volume", "contact_angle=20")
        error = abs(force[-1] / exact - [[0, 0, 1], [0, 0, -1]]).max()
        ok(error < 1e-6, f"1:{1 / small:g}: what is left in the end is the exact bridge", error)
        bare, _, _ = forces("d", "contact_angle=20")
        ring = (force - bare)[:, 0, 2] / exact
        ok(ring[0] == 0 and (np.diff(ring) >= -1e-9).all(),
           "it grows from nothing as throats empty", ring[:3])
    # in a layer, where the throat between two grains is the face
    drying("d", [[2 * R, R, 2 * R], [4 * R, R, 2 * R]], [R, R], (6 * R, 2 * R, 4 * R),
           ["dimensions=2"], ["liquid=immobile", 'imposed_empty=["-x","+x","-z"]'])
    exact = json.loads(run("bridge", *sets(f"radius={R}", "separations=[0]", f"volume={1e-3 * R**3}", "surface_tension=0.07274")))
    last = forces("d", "rings.left=volume")[0][-1] / exact["force"][0]
    ok(abs(last - [[1, 0, 0], [-1, 0, 0]]).max() < 1e-6, "and between two grains of a layer", last)
    with h5py.File("d") as file:
        x = file["nodes/position"][:, 0][file["throats/nodes"][:]]
        width = file["throats/radius"][abs(x - 3 * R).max(1) < 1e-6 * R]
    wet = forces("d", "form=faces", "contact_angle=30")[0][0]
    dry = forces("d", "form=faces")[0][0] * np.cos(np.pi / 6)
    line = (wet - dry)[:, 0] / (0.07274 * np.sin(np.pi / 6) * width)
    ok(len(width) == 1 and abs(line - [2, -2]).max() < 1e-9,
       "its upper meniscus pulls both grains with 2 r sigma sin(theta)", line)


def refusals():
    def refused(words, why, label):
        result = subprocess.run([f"{BIN}/force-protocol", *words, "-o", "x"],
                                capture_output=True, text=True)
        ok(result.returncode == 65 and why in result.stderr and not os.path.exists("x"),
           label, result.stderr)
    refused(["--set", "pressure=field", "d"], "dry with liquid=viscous and snapshots",
            "a field that is not there is asked for")
    refused(["--set", "form=arcs", "d"], "needs the network of a layer",
            "arcs in space are refused")
    shutil.copy("d", "one")
    with h5py.File("one", "a") as file:
        for name, rows in [("nodes/position", 1), ("nodes/kind", 1), ("faces/offset", 1)]:
            old = file[name][:rows]
            del file[name]
            file[name] = old
        gone = ["throats/nodes", "throats/radius", "throats/length", "throats/kind",
                "throats/diffusive_conductance", "throats/hydraulic_conductance",
                "throats/hydraulic_radius",
                "faces/nodes", "faces/particles", "events/time", "events/throat", "events/kind",
                "changes/throat", "changes/saturation"]
        for name in gone:
            old = file[name][:0]
            del file[name]
            file[name] = old
        file["changes/offset"][...] = 0
        if "boundary_layer" in file:
            del file["boundary_layer"]
        if "VTKHDF" in file:
            del file["VTKHDF"]
    refused(["one"], "no open throat to hold liquid", "a network of one node is refused")


def threads():
    centres, radii = scatter(60, (2.6e-6, 2.6e-6, 3e-6))
    drying("d", centres, radii, (2.6e-6, 2.6e-6, 3e-6), [], ["liquid=viscous",
           "snapshot_interval=0.05"], merge=0.1)
    both = []
    for n in 1, 2:
        run("force-protocol", "--threads", str(n), *sets("pressure=field", "contact_angle=30", "rings.left=suction", "form=faces",
                                                         "largest_change=0.1"), "d", "-o", f"f{n}")
        both.append(open(f"f{n}", "rb").read())
    ok(both[0] == both[1], "viscous liquid, everything on: the same bytes on two threads")
    with h5py.File("f1") as file:
        ok(np.isfinite(file["force"][:]).all() and not file["force"][0].max() == 0,
           "and forces")


def scaled():
    """From nanometres to kilometres: forces over surface tension and length."""
    box = np.array((2.3e-6, 2.3e-6, 2.6e-6))
    centres, radii = scatter(40, box)
    first = None
    for factor in 1, 2.0**-8, 2.0**32, 1 / 250:
        drying("d", centres * factor, radii * factor, box * factor, [],
               ["liquid=inviscid", "boundary_layer.from=thickness",
                f"boundary_layer.thickness={5e-6 * factor}"])
        force, _, _ = forces("d", "form=faces", "pressure=clusters", "contact_angle=30",
                             "rings.left=suction", "largest_change=0.05")
        if first is None:
            first = force
            continue
        same = force.shape == first.shape
        error = abs(force / factor - first).max() / abs(first).max() if same else "times"
        ok(same and error < (1e-9 if factor == 1 / 250 else 1e-15),
           f"lengths times {factor:g}: the same forces over lengths", error)


def hardly_viscous():
    """With hardly any viscosity a connected liquid has the pressure of its widest meniscus."""
    box = (2.6e-6, 2.6e-6, 3e-6)
    centres, radii = scatter(60, box)
    drying("d", centres, radii, box, [], ["liquid=viscous", "viscosity=1e-14", "snapshots=[1,0.5]",
                                          SIDES])
    field, clusters = (forces("d", f"pressure={p}")[0][0] for p in ("field", "clusters"))
    error = abs(field - clusters).max() / abs(clusters).max()
    ok(error < 1e-6 and abs(clusters).max() > 0,
       "hardly viscous: the field is that of clusters at the start", error)


def overlaps():
    """Grains that overlap their neighbours by a tenth, on a lattice of their own."""
    a = 2 * R
    centres = np.array([(i, j, k) for i in range(3) for j in range(3) for k in range(3)])
    drying("d", (centres + 0.5) * a, np.full(27, 1.1 * R), (3 * a,) * 3, [],
           ["liquid=inviscid", SIDES])
    force, _, summary = forces("d", "rings.left=volume", "form=faces", "contact_angle=20")
    exact = json.loads(run("bridge", *sets(f"radius={1.1 * R}", "separations=[0]", f"volume={1e-3 * (1.1 * R)**3}",
                                           "contact_angle=20", "surface_tension=0.07274")))["force"][0]
    inner = abs(force[0, 13]).max() / (summary["capillary_pressure"] * R**2)
    ok(np.isfinite(force).all() and inner < 1e-14,
       "grains that overlap: none on the inner one while all is wet", inner)
    last = force[-1].reshape(3, 3, 3, 3) / exact
    ok(abs(last[0, 1, 1] - [1, 0, 0]).max() < 1e-6 and abs(last[1, 1, 1]).max() < 1e-9,
       "rings between them pull as in contact", last[0, 1, 1])


def plain_arcs():
    """[K 3.20] is the lune of a layer over pi/2, and of a layer only."""
    box = (5e-6, 5e-7, 5e-6)
    centres, radii = scatter(40, box, layer=True)
    drying("d", centres, radii, box, ["dimensions=2"], ["liquid=inviscid"])
    lune, arc = (forces("d", "balanced=false", f"form={f}")[0] for f in ("solid-angle", "arcs"))
    error = abs(lune - np.pi / 2 * arc).max()
    ok(error < 1e-15 * 1e6 * R**2, "the arcs of a layer are its lunes over pi/2", error)


def moved():
    """A layer far from the origin, with the menisci, which are as high as it is thick."""
    box = np.array([5e-6, 5e-7, 5e-6])
    centres, radii = scatter(40, box, layer=True)
    here = []
    for away in np.zeros(3), np.array([-7e-6, 11e-6, 3e-6]):
        drying("d", centres + away, radii, box, ["dimensions=2"], ["liquid=immobile"], lower=away)
        here.append(forces("d", "form=faces")[0])
    error = abs(here[1] - here[0]).max() / abs(here[0]).max()
    ok(error < 1e-9, "a layer moved: the same forces", error)


def renumbered():
    # immobile: throats that a node between them makes equally wide tie in the other
    box = (2.6e-6, 2.6e-6, 3e-6)
    centres, radii = scatter(60, box)
    order = random.permutation(60)
    how = ["pressure=clusters", "contact_angle=30", "rings.left=suction"]
    drying("d", centres, radii, box, [], ["liquid=immobile", SIDES], merge=0.1)
    first, _, _ = forces("d", *how)
    drying("d", centres[order], radii[order], box, [], ["liquid=immobile", SIDES], merge=0.1)
    error = abs(forces("d", *how)[0] - first[:, order]).max() / abs(first).max()
    ok(error < 1e-9, "grains in another order: the same forces", error)
    # x, y, z become y, z, x: the open wall turns with the scene
    drying("d", centres[:, [2, 0, 1]], radii, np.array(box)[[2, 0, 1]], [],
           ["liquid=immobile", 'imposed_empty=["-x","-y","+y","-z","+z"]', 'open=["+x"]'],
           merge=0.1)
    error = abs(forces("d", *how)[0] - first[:, :, [2, 0, 1]]).max() / abs(first).max()
    ok(error < 1e-9, "the scene turned: forces turn", error)


# ---- packed ---------------------------------------------------------------------------


def packed():
    drying("long", *scatter(30, [12 * R] * 3), [12 * R] * 3, [], [SIDES])
    few, _, _ = forces("long", steps=41)
    many, _, _ = forces("long", steps=4001)
    with h5py.File("f") as file:
        size = file["force"].id.get_storage_size()
        ok(file["force"].compression == "gzip" and size < many.nbytes / 2,
           "a large table of forces is packed to less than half", size)
    ok(np.abs(few - many[::100]).max() < 1e-9 * np.abs(few).max(), "and holds the same forces as a small one")


TOP = os.getcwd()
BIN = os.environ.get("BIN", os.path.join(TOP, "build/bin"))
with scratch() as folder:
    os.chdir(folder)
    full_networks()
    balance()
    unequal()
    gradient()
    times()
    refusals()
    rings()
    scaled()
    hardly_viscous()
    overlaps()
    plain_arcs()
    moved()
    renumbered()
    threads()
    packed()
    os.chdir(TOP)
done()
